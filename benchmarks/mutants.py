"""
Would a test notice? Plants one small fault at a time in rules, compensation, metal, geometry and tables, and runs the
tests on it.

    python benchmarks/mutants.py --count 100 --seed 1 [--only rules --only columns/path/ramps.py:158] [--jobs 2]
    python benchmarks/mutants.py --count 100 --only metal --only tables --write docs/reliability.md
    python benchmarks/mutants.py --list --only geometry/cutter_compensation/corner.py

Which faults there are says mutations.py; a sample is taken of each room or file, the same for the same seed. First run
the tests that are named as the module, the modules above it or their rules, then all of TESTS, until one fails or
--budget seconds of processor time are spent, twice. What is not found by then has survived; so the true score is never
less than what is printed. Without a fault the tests must pass.

It runs in copies of the checkout, niced. Ends with 1 where less than --at-least per cent are killed. Survivors that no
program can tell from the original stand in equivalent_mutants.toml, each with its reason, and do not count. --write
puts the figures of the rooms that were measured into the table of a page; the rows of other rooms stay as they are.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib
import itertools
import os
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import tomllib
import traceback
from collections import Counter, defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mutant_rooms import ROOMS, ROOT, batches, modules, promising, room_of
from mutations import Mutation, compiles, mutations

HERE = Path(__file__).resolve().parent
EQUIVALENT = HERE / "equivalent_mutants.toml"
#: Seconds of processor time above the budget after which a test counts as hanging; of the clock, for one that waits.
PATIENCE, LONGEST = 60, 1800.0
MEMORY = 6_000_000_000
OUTPUT = "output.txt"
NICE = 5
#: What pytest ends with for a file that is not there.
USAGE = 4
#: File, line of the source, what is written, what would be, which of those alike in that line.
Key = tuple[str, str, str, str, int]
#: What stands around the table of figures in a page.
BEGIN, END = "<!-- mutation scores: begin -->", "<!-- mutation scores: end -->"
OUTCOMES = ("killed", "timeout", "survived", "equivalent")


def main() -> int:
    """Choose, run, tell."""
    asked = arguments()
    if asked.write and not set(asked.only or ROOMS) <= set(ROOMS):
        sys.exit(f"--write: only for whole rooms ({', '.join(ROOMS)})")
    samples = [sample(name, asked.count, asked.seed) for name in asked.only or ROOMS]
    chosen = list(dict.fromkeys(itertools.chain.from_iterable(samples)))
    if asked.list:
        print(*chosen, sep="\n")
        return 0
    with contextlib.suppress(AttributeError, OSError):
        os.nice(NICE)
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(143))
    for name in [name for name in os.environ if name.startswith("SLIPCOVER_")]:
        del os.environ[name]  # a run that measures its coverage, as that of our own test does
    known = equivalent()
    counts: dict[str, Counter[str]] = defaultdict(Counter)
    began = time.perf_counter()
    plans: list[Mutation] = []
    for one in chosen:
        if key(one) in known:
            counts[room_of(one.file)]["equivalent"] += 1
        else:
            plans.append(one)
    if asked.sound:
        sound = [replace(plans[0], new=plans[0].old)]
        for _, outcome, by in run_all(sound, asked.budget, 1):
            if outcome != "survived":
                print(f"without a fault the tests fail: {by}", file=sys.stderr)
                return 2
    for number, (one, outcome, by) in enumerate(run_all(plans, asked.budget, asked.jobs), 1):
        counts[room_of(one.file)][outcome] += 1
        if outcome == "survived" or asked.verbose:
            print(f"{number}/{len(plans)} {outcome}: {one}  {by}", flush=True)
    score = print_table(counts)
    if asked.write:
        asked.write.write_text(with_figures(asked.write.read_text("utf-8"), counts, asked.seed), "utf-8", newline="\n")
    print(f"{len(chosen)} faults in {time.perf_counter() - began:.0f} s")
    return int(score < asked.at_least)


def arguments() -> argparse.Namespace:
    """What is asked for."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", action="append", metavar="ROOM|PATH[:LINE]", help=f"{', '.join(ROOMS)} or files")
    parser.add_argument("--count", type=int, default=100, help="faults of each room or file; 0 for all")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--budget", type=float, default=60.0, help="seconds of processor time for one fault")
    parser.add_argument("--at-least", type=float, default=95.0, help="per cent killed")
    parser.add_argument(
        "--trust", dest="sound", action="store_false", help="do not first run the tests without a fault"
    )
    parser.add_argument("--list", action="store_true", help="print the faults of the sample, run nothing")
    parser.add_argument("--write", type=Path, metavar="PAGE", help="put the figures into the table of this page")
    parser.add_argument("--verbose", action="store_true", help="print what is killed, too")
    return parser.parse_args()


# ---- which faults ----


def sample(name: str, count: int, seed: int) -> list[Mutation]:
    """
    Some of the mutations of a room or file, in order of file and place; all if count is 0 or more than there are.

    Ends the program for a name that is neither a room nor a file of the package.
    """
    path, _, line = name.partition(":")
    files = [file for file in modules() if (room_of(file) == name if name in ROOMS else file.endswith(path))]
    if not files:
        sys.exit(f"{name}: neither a room ({', '.join(ROOMS)}) nor a file of the package")
    found = {}
    for file in files:
        for one in mutations((ROOT / file).read_bytes(), file):
            if not line or one.line == int(line):
                found[one.file, one.begin, one.end, one.new] = one
    everything = [found[place] for place in sorted(found)]
    random.Random(seed).shuffle(everything)  # noqa: S311
    sound = (one for one in everything if compiles(one.applied((ROOT / one.file).read_bytes())))
    return sorted(itertools.islice(sound, count or None), key=lambda one: (one.file, one.begin, one.new))


def key(one: Mutation) -> Key:
    """What is left of a mutation when lines above it come and go."""
    return one.file, one.row, one.old, one.new, one.nth


def equivalent() -> dict[Key, str]:
    """The reasons for which no program can tell a mutant from the original."""
    table = tomllib.loads(EQUIVALENT.read_text("utf-8"))
    return {
        (file, one["row"], one["old"], new, one.get("nth", 1)): one["why"]
        for file, group in table.items()
        for one in group
        for new in ([one["new"]] if isinstance(one["new"], str) else one["new"])
    }


# ---- running ----


@dataclass
class Run:
    """A run of pytest on a mutant; batch: which of its batches of tests. ends: when it is given up, by the clock."""

    mutation: Mutation
    batch: int
    process: int
    ends: float


def run_all(chosen: Sequence[Mutation], budget: float, jobs: int) -> Iterator[tuple[Mutation, str, str]]:
    """Each mutation, its outcome and the test that found it, as they end."""
    preload()
    left = list(reversed(chosen))
    sources = {
        one.file: (ROOT / one.file).read_bytes() for one in chosen
    }  # as they are now, whatever is edited meanwhile
    with contextlib.ExitStack() as stack:
        free = [stack.enter_context(copied()) for _ in range(min(jobs, len(chosen)))]
        running: dict[Path, Run] = {}
        stack.callback(lambda: [stop(run.process) for run in running.values()])
        while left or running:
            while left and free:
                checkout, one = free.pop(), left.pop()
                plant(checkout, one.file, one.applied(sources[one.file]))
                running[checkout] = start(checkout, one, 0, budget)
            time.sleep(0.02)
            for checkout, run in list(running.items()):
                outcome = outcome_of(run)
                if outcome == "survived" and not run.batch:
                    running[checkout] = start(checkout, run.mutation, 1, budget)
                elif outcome:
                    del running[checkout]
                    by = found_by(checkout)
                    plant(checkout, run.mutation.file, sources[run.mutation.file])
                    free.append(checkout)
                    yield run.mutation, outcome, by


def preload() -> None:
    """What every run needs and no mutation touches is loaded once; runs are forks."""
    for name in ("hypothesis.strategies", "msgspec", "numpy", "pytest", "rich.console", "shapely"):
        importlib.import_module(name)


def plant(checkout: Path, file: str, source: bytes) -> None:
    """Write a module; what was compiled of it before goes, since a fault of the same second and size looks alike."""
    path = checkout / file
    path.write_bytes(source)
    for compiled in (path.parent / "__pycache__").glob(f"{path.stem}.*"):
        compiled.unlink()


def start(checkout: Path, mutation: Mutation, batch: int, budget: float) -> Run:
    """Begin a run in a process of its own, with its children in one group."""
    process = os.fork()
    if process:
        return Run(mutation, batch, process, time.monotonic() + LONGEST)
    try:
        code = child(checkout, mutation, batch, budget)
    except BaseException:  # a fault can raise anything anywhere
        traceback.print_exc()
        code = 1
    os._exit(code)


def child(checkout: Path, mutation: Mutation, batch: int, budget: float) -> int:
    """Run these tests here; the exit code of pytest."""
    import resource

    os.setsid()
    spent = time.process_time()
    limit = int(spent + budget) + PATIENCE
    resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
    os.chdir(checkout)
    told = {
        "MUTANT_NAMES": "\n".join(promising(mutation.file)),
        "MUTANT_BATCH": str(batch),
        "MUTANT_SECONDS": str(spent + budget),
    }
    os.environ.update(surroundings(checkout) | told)
    sys.path[:0] = [str(checkout), str(HERE)]
    with (checkout / OUTPUT).open("wb") as output:
        os.dup2(output.fileno(), 1)
        os.dup2(output.fileno(), 2)
    import pytest

    # What is preloaded is not rewritten; it holds no asserts of ours.
    rewriting = ["-W", "ignore::pytest.PytestAssertRewriteWarning"]
    plugins = ["-p", "mutant_tests", "-p", "no:xdist", "-p", "no:cacheprovider"]
    # The options of pyproject.toml leave tests out, and ask for several processes.
    options = ["-o", "addopts=", "-x", "-q", "--hypothesis-seed=0", "--snapshot-warn-unused", *plugins, *rewriting]
    files = batches(mutation)[batch]
    if not files:
        return 5
    return int(pytest.main([*options, *files]))


def outcome_of(run: Run) -> str:
    """How a run ended; nothing while it goes on."""
    process, status = os.waitpid(run.process, os.WNOHANG)
    if not process:
        if time.monotonic() < run.ends:
            return ""
        stop(run.process)
        return "timeout"
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(run.process, signal.SIGKILL)  # what tests have started
    if os.WIFEXITED(status) and os.WEXITSTATUS(status) == USAGE:
        sys.exit(f"pytest was called in a wrong way for {run.mutation}")
    if os.WIFEXITED(status):
        return "survived" if os.WEXITSTATUS(status) in (0, 5) else "killed"
    return "timeout" if os.WTERMSIG(status) in (signal.SIGXCPU, signal.SIGKILL) else "killed"


def found_by(checkout: Path) -> str:
    """The test that failed last, from what pytest printed."""
    text = (checkout / OUTPUT).read_text("utf-8", errors="replace") if (checkout / OUTPUT).exists() else ""
    failed = re.findall(r"^(?:FAILED|ERROR) (.*?)(?: - .*)?$", text, re.MULTILINE)
    return failed[-1] if failed else text.strip().rpartition("\n")[2]


def stop(process: int) -> None:
    """End a run and what it has started."""
    with contextlib.suppress(ProcessLookupError, PermissionError):
        os.killpg(process, signal.SIGKILL)
    with contextlib.suppress(ChildProcessError):
        os.waitpid(process, 0)


@contextlib.contextmanager
def copied() -> Iterator[Path]:
    """A copy of the checkout as it stands, with the folder of real programs beside it; gone at the end."""
    command = ["git", "ls-files", "-co", "--exclude-standard", "-z"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
    with tempfile.TemporaryDirectory(prefix="polarcheck-mutant-") as folder:
        checkout = Path(folder) / "checkout"
        for name in filter(None, listed):
            if (ROOT / name).is_file():
                (checkout / name).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(ROOT / name, checkout / name)
        if (ROOT.parent / "shared").exists():
            (Path(folder) / "shared").symlink_to((ROOT.parent / "shared").resolve())
        subprocess.run([sys.executable, "-m", "compileall", "-q", "polarcheck"], cwd=checkout, check=True)
        yield checkout


def surroundings(checkout: Path) -> dict[str, str]:
    """The environment in which the copy is the package."""
    path = os.pathsep.join([str(checkout), str(HERE)])
    return {**os.environ, "PYTHONPATH": path, "OPENBLAS_NUM_THREADS": "1"}


# ---- figures ----


def print_table(counts: dict[str, Counter[str]]) -> float:
    """A line for each room and one for all; the score of all [per cent]."""
    total: Counter[str] = Counter()
    for row in counts.values():
        total.update(row)
    print(f"{'':14}" + "".join(f"{name:>11}" for name in (*OUTCOMES, "score")))
    for name, row in [*counts.items(), ("all", total)]:
        print(f"{name:14}" + "".join(f"{row[outcome]:>11}" for outcome in OUTCOMES) + f"{score_of(row):>10.1f}%")
    return score_of(total)


def score_of(row: Counter[str]) -> float:
    """The share of killed faults among those that a program can show [per cent]."""
    killed = row["killed"] + row["timeout"]
    judged = killed + row["survived"]
    return 100.0 * killed / judged if judged else 100.0


def with_figures(page: str, counts: dict[str, Counter[str]], seed: int) -> str:
    """A page with the rows of these rooms in its table between the two markers, in the order of ROOMS."""
    before, begin, rest = page.partition(BEGIN)
    table, end, after = rest.partition(END)
    if not (begin and end):
        sys.exit(f"the page has no {BEGIN} and {END}")
    rows = {row.split("|")[1].strip(): row for row in table.strip().splitlines() if row.startswith("| ")}
    head = "| package | faults | seed | killed | equivalent | survived | score |"
    for room, row in counts.items():
        killed = row["killed"] + row["timeout"]
        figures = (row.total(), seed, killed, row["equivalent"], row["survived"], f"{score_of(row):.1f} %")
        rows[room] = f"| {room} | {' | '.join(map(str, figures))} |"
    lines = [head, "|---|---|---|---|---|---|---|", *(rows[room] for room in ROOMS if room in rows)]
    return "\n".join([before + begin, *lines, end + after])


if __name__ == "__main__":
    sys.exit(main())
