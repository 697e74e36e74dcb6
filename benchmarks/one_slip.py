"""
One slip in a sound program: is it spoken about, and in one finding?

    python benchmarks/one_slip.py --slips 3000 [--kind "R wrong"] [--machine NAME] [--show-passing FOLDER]
    python benchmarks/one_slip.py --sound 1000

Programs come from tests/setter_programs.py, slips from tests/single_slips.py. tests/metal_simulation.py, which shares
no code with polarcheck, runs both; a slip that does nothing to metal or lathe is dropped, and so is one that nobody
could know without a drawing.
`--sound` checks programs without a slip, without a bar and with several, and prints those that are not passed.
"""

from __future__ import annotations

import argparse
import re
import sys
import time
from collections import Counter, defaultdict
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from metal_simulation import C_LIMIT
from programs import report_of
from setter_dialects import DIALECTS
from setter_programs import FAMILIES, Program, drawn
from single_slips import SLIPS, drawn_slip

#: Bars of --sound: how much larger than the bar that the program is for [mm]; None for no bar.
BARS = (None, 0.0, 0.5, 2.0, -0.5, -2.0)
#: What the shapes call for that reach out to the bar.
_FULL = "d_shape|double_d"
_WIDTHS = (44, 7, 8, 11, 7, 9)


class Verdict(NamedTuple):
    """What is said of a program: the rules at or above warning, those that are not evaluated, and the messages."""

    verdict: str
    rules: tuple[str, ...]
    open_rules: tuple[str, ...]
    says: tuple[str, ...]


class Result(NamedTuple):
    """A slip, its program, and what is said of it."""

    kind: str
    seed: int
    program: Program
    line: int
    verdict: Verdict


def verdict_of(program: Program, bar: float | None) -> Verdict:
    """Check a program in this process; bar: a diameter [mm]."""
    tools: list[str] = []
    job: dict[str, object] = {"units": "mm"}
    if selects_units(program):
        tools, job, bar = program.tools(), {}, bar and round(bar / program.scale, 5)
    else:
        job["tools"] = {str(offset): {"radius": radius, "nose": 0} for offset, radius in program.radii.items()}
    if bar:
        job["stock"] = {"diameter": bar}
    limits = {"limits": {"c_feed": C_LIMIT}}
    report = report_of(program.text(), program.machine, *tools, changes=limits, job=job)
    said = [finding for finding in report.findings if finding.severity != "note"]
    open_rules = tuple(f"{entry.rule}: {entry.reason}" for entry in report.not_evaluated if entry.matters)
    says = tuple(f"{finding.line}: {finding.severity}: {finding.message} [{finding.rule}]" for finding in said)
    return Verdict(report.verdict, tuple(finding.rule for finding in said), open_rules, says)


def selects_units(program: Program) -> bool:
    """Whether the program still says its unit, so that lengths of the job may stand in it."""
    code = program.dialect.inch if program.inch else program.dialect.metric
    return not code or any(code in line.text for line in program.lines)


def slip_of(seed: int, kinds: tuple[str, ...], machine: str) -> Result | None:
    """One slip, checked; None where none could be made."""
    slips = tuple(slip for slip in SLIPS if slip.name in kinds)
    slip = drawn_slip(seed, slips, machine, lambda program: verdict_of(program, program.stock).verdict == "pass")
    if slip is None:
        return None
    return Result(slip.slip, seed, slip.program, slip.line, verdict_of(slip.program, slip.program.stock))


def sound_of(seed: int, machine: str) -> list[tuple[Program, float | None, Verdict]]:
    """A sound program with each bar."""
    program = drawn(seed, machine)
    bars = [more for more in BARS if more is None or more >= 0 or not re.match(_FULL, program.family)]
    return [(program, more, verdict_of(program, None if more is None else program.bar + more)) for more in bars]


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--slips", type=int, default=3000)
    parser.add_argument("--seed", type=int, default=1, help="the first of them")
    parser.add_argument("--kind", default="", help="only the kinds whose name holds this")
    parser.add_argument("--machine", default="", choices=["", *DIALECTS])
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--sound", type=int, default=0, metavar="N", help="check N programs without a slip instead")
    parser.add_argument("--show-passing", type=Path, metavar="FOLDER", help="write the programs that pass to a folder")
    parser.add_argument("--show-many", type=Path, metavar="FOLDER", help="write those with more than one finding")
    options = parser.parse_args()
    began = time.perf_counter()
    with ProcessPoolExecutor(options.jobs) as pool:
        if options.sound:
            seeds = range(options.seed, options.seed + options.sound)
            bad = print_sound(list(pool.map(partial(sound_of, machine=options.machine), seeds, chunksize=5)))
        else:
            kinds = tuple(slip.name for slip in SLIPS if options.kind in slip.name)
            seeds = range(options.seed, options.seed + options.slips)
            work = partial(slip_of, kinds=kinds, machine=options.machine)
            results = [result for result in pool.map(work, seeds, chunksize=10) if result]
            bad = print_table(results)
            if options.show_passing:
                keep(options.show_passing, [result for result in results if result.verdict.verdict == "pass"])
            if options.show_many:
                keep(options.show_many, [result for result in results if len(result.verdict.rules) > 1])
    print(f"{time.perf_counter() - began:.0f} s")
    return int(bad)


def print_sound(checked: list[list[tuple[Program, float | None, Verdict]]]) -> bool:
    """Counts for each bar, and each program that is not passed."""
    table: dict[str, Counter[str]] = defaultdict(Counter)
    printed: set[tuple[int, tuple[str, ...]]] = set()
    for program, more, verdict in (one for several in checked for one in several):
        name = "no bar" if more is None else f"bar {more:+g}"
        table[name][verdict.verdict] += 1
        if verdict.verdict == "pass" or (program.seed, verdict.rules or verdict.open_rules) in printed:
            continue
        printed.add((program.seed, verdict.rules or verdict.open_rules))
        why = verdict.says[:1] or verdict.open_rules[:1]
        print(f"seed {program.seed} {program.machine} {program.family}, {name} {program.bar:g}: {why[0]}")
    for name, row in table.items():
        print(f"{name:9} pass {row['pass']}, unverified {row['unverified']}, fail {row['fail']}")
    print(f"families: {len({program.family for several in checked for program, _, _ in several})} of {len(FAMILIES)}")
    return any(row["fail"] for row in table.values())


def print_table(results: list[Result]) -> bool:
    """A line for each kind, and one for all; whether the goal is missed."""
    rows: dict[str, Counter[str]] = {slip.name: Counter() for slip in SLIPS}
    for result in results:
        verdict = result.verdict
        one = {"unverified": verdict.verdict == "unverified", "pass": verdict.verdict == "pass"}
        rows[result.kind].update(["all", *(name for name, is_so in one.items() if is_so)])
        rows[result.kind]["spoken"] += verdict.verdict != "pass"
        rows[result.kind]["several"] += len(verdict.rules) > 1
    total: Counter[str] = Counter()
    for row in rows.values():
        total.update(row)
    heads = ("kind", "slips", "spoken", "unverified", "pass", "several")
    print(_row(heads))
    for name, row in [*((name, row) for name, row in rows.items() if row), ("all", total)]:
        print(_row((name, *(str(row[key]) for key in ("all", "spoken", "unverified", "pass", "several")))))
    count = max(total["all"], 1)
    print(
        f"spoken about {total['spoken'] / count:.1%} (goal 95 %), unverified alone {total['unverified'] / count:.1%} "
        f"(goal 5 % at most), in several findings {total['several'] / count:.1%} (goal 3 % at most)"
    )
    together = Counter(" + ".join(sorted(result.verdict.rules)) for result in results if len(result.verdict.rules) > 1)
    for names, number in together.most_common(12):
        print(f"{number:6} {names}")
    return total["spoken"] < 0.95 * count or total["several"] > 0.03 * count


def _row(cells: tuple[str, ...]) -> str:
    return "".join(
        cell.ljust(width) if not i else cell.rjust(width)
        for i, (cell, width) in enumerate(zip(cells, _WIDTHS, strict=True))
    )


def keep(folder: Path, results: list[Result]) -> None:
    """Write programs to a folder, the block with the slip marked."""
    folder.mkdir(parents=True, exist_ok=True)
    counts: Counter[str] = Counter()
    for result in results:
        counts[result.kind] += 1
        name = re.sub("[^a-z0-9]+", "-", result.kind.lower())
        (folder / f"{name}_{counts[result.kind]}.nc").write_text(marked(result))


def marked(result: Result) -> str:
    """The program; a comment near its head says how it is checked, one at the slip where it is."""
    program = result.program
    first, last = program.dialect.remark
    tools = " ".join(f"--tool {tool}" for tool in program.tools())
    parts = [result.kind, f"seed {result.seed}", program.family, f"--machine {program.machine} {tools}"]
    parts += [f"job.stock.diameter={program.stock / program.scale:g}"] if program.stock else []
    parts += [f"says {' '.join(result.verdict.rules)}"] if result.verdict.rules else []
    lines = program.text().splitlines()
    lines.insert(result.line - 1, f"{first}SLIP{last}")
    lines.insert(int(lines[0] == "%"), f"{first}{', '.join(parts)}{last}")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
