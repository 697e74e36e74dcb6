"""
Parts with one defect, each with its [[part]] or drawing: is it said? And is nothing said of sound ones?

    python benchmarks/part_defects.py --count 1000 [--seed N] [--kind "R wrong"] [--show FOLDER] [--jobs N]
    python benchmarks/part_defects.py --sound 1000 [--kind "flats"] [--show FOLDER]

Parts and sound programs come from tests/drawn_parts.py, defects from tests/part_slips.py. tests/part_judge.py, which
shares no code with polarcheck, compares the metal that is left with the part, by areas; a defect that changes it by no
more than twice the tolerance is dropped, and so is a program that is meant to be sound and does not make its part.
`--show` writes what is missed, or falsely said, as folders in which `polarcheck check O1000.NC` says the same.
"""

from __future__ import annotations

import argparse
import re
import sys
import tempfile
import time
from collections import Counter, defaultdict
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from drawn_parts import FAMILIES, Plan
from part_jobs import check, write
from part_slips import KINDS, drawn_defect, drawn_sound
from setter_programs import Program

RULE = "part-differs-from-drawing"
#: The share of defects that should be said.
GOAL = 0.99
#: `as sound`: the same rules say the same of the program without the defect.
MISSED = ("unverified", "pass", "as sound", "crash")


class Result(NamedTuple):
    """
    A program that was checked.

    name: kind of the defect, or family of the sound program. verdict: of Verdict. about: where and how much, by the
    judge. says: the findings, and what of the part was not evaluated.
    """

    name: str
    seed: int
    family: str
    machine: str
    verdict: str
    about: str
    says: tuple[str, ...]


def defect_of(seed: int, kinds: tuple[str, ...], show: Path | None) -> Result | None:
    """One defect, checked; None where none could be made."""
    defect = drawn_defect(seed, kinds)
    if defect is None:
        return None
    judgement = defect.judgement
    about = f"too much {judgement.extra:.3f} mm2, too little {judgement.missing:.3f} mm2 at Z{judgement.z:.2f}, "
    about += f"x {judgement.place.real:.3f} (radius) c {judgement.place.imag:.3f}"
    report = report_of(defect.plan, defect.program)
    verdict = verdict_of(report)
    if verdict in ("part", "other") and not rules_of(report) - rules_of(report_of(defect.plan, defect.sound)):
        verdict = "as sound"
    result = Result(defect.kind, seed, defect.plan.family, defect.program.machine, verdict, about, said(report))
    if show is not None and result.verdict in MISSED:
        write(show / f"{_slug(defect.kind)}_{seed}", defect.plan, defect.program, _head(result))
    return result


def sound_of(seed: int, families: tuple[str, ...], show: Path | None) -> Result:
    """One sound program, checked."""
    plan, program = drawn_sound(seed, families[seed % len(families)])
    report = report_of(plan, program)
    result = Result(plan.family, seed, plan.family, program.machine, verdict_of(report), "sound", said(report))
    if show is not None and result.verdict != "pass":
        write(show / f"{_slug(plan.family)}_{seed}", plan, program, _head(result))
    return result


def _slug(name: str) -> str:
    return re.sub("[^a-z0-9]+", "-", name.lower())


def _head(result: Result) -> str:
    lines = [f"{result.name}, seed {result.seed}, {result.family}", result.about, *result.says]
    return "".join(f"# {line}\n" for line in lines)


def report_of(plan: Plan, program: Program) -> dict[str, Any]:
    with tempfile.TemporaryDirectory() as folder:
        write(Path(folder), plan, program)
        return check(Path(folder))


def rules_of(report: dict[str, Any]) -> set[str]:
    """Of all findings of weight, and of those that follow from them."""
    weighty = [finding for finding in report["findings"] if finding["severity"] != "note"]
    rules = {finding["rule"] for finding in weighty}
    return rules | {follower["rule"] for finding in weighty for follower in finding.get("follows") or ()}


def verdict_of(report: dict[str, Any]) -> str:
    """`part`, or `other` for another finding of weight; else `unverified` where the part is not compared, or `pass`."""
    rules = rules_of(report)
    if "crash" in rules:
        return "crash"
    if RULE in rules:
        return "part"
    if rules:
        return "other"
    return "unverified" if any(entry["rule"] == RULE for entry in report["not_evaluated"]) else "pass"


def said(report: dict[str, Any]) -> tuple[str, ...]:
    findings = [one for one in report["findings"] if one["severity"] != "note"]
    says = [f"line {one['line']}: {one['severity']}: {one['message']} [{one['rule']}]" for one in findings]
    return (*says, *(f"not evaluated: {one['reason']}" for one in report["not_evaluated"] if one["rule"] == RULE))


def main(arguments: Sequence[str] | None = None) -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=1000, help="how many defects")
    parser.add_argument("--sound", type=int, default=0, metavar="N", help="check N sound programs instead")
    parser.add_argument("--seed", type=int, default=1, help="the first of them")
    parser.add_argument("--kind", default="", help="only the kinds, or families of sound parts, whose name holds this")
    parser.add_argument("--show", type=Path, metavar="FOLDER", help="write what is missed, or falsely said")
    parser.add_argument("--jobs", type=int, default=2)
    options = parser.parse_args(arguments)
    began = time.perf_counter()
    show = options.show.resolve() if options.show else None
    with ProcessPoolExecutor(options.jobs) as pool:
        if options.sound:
            seeds = range(options.seed, options.seed + options.sound)
            families = tuple(family for family in FAMILIES if options.kind in family)
            is_bad = print_sound(pool.map(partial(sound_of, families=families, show=show), seeds, chunksize=4))
        else:
            seeds = range(options.seed, options.seed + options.count)
            kinds = tuple(kind for kind in KINDS if options.kind in kind)
            is_bad = print_table(pool.map(partial(defect_of, kinds=kinds, show=show), seeds, chunksize=4))
    print(f"{time.perf_counter() - began:.0f} s")
    return int(is_bad)


def print_sound(results: Iterable[Result]) -> bool:
    """Counts by family, and each program of which something is said."""
    rows: dict[str, Counter[str]] = defaultdict(Counter)
    for result in results:
        rows[result.name][result.verdict] += 1
        if result.verdict != "pass":
            print(f"seed {result.seed} {result.machine} {result.family}: {' | '.join(result.says)[:300]}", flush=True)
    columns = ("pass", "part", "other", "unverified", "crash")
    return _print(rows, "sound part", columns, lambda row: row["pass"], 1.0)


def print_table(results: Iterable[Result | None]) -> bool:
    """Counts by kind, and each defect that is missed."""
    rows: dict[str, Counter[str]] = defaultdict(Counter)
    for result in results:
        if result is None:
            continue
        rows[result.name][result.verdict] += 1
        if result.verdict in MISSED:
            says = " | ".join(result.says)[:200]
            print(
                f"{result.name}: seed {result.seed} {result.machine} {result.family}: {result.about} {says}", flush=True
            )
    columns = ("part", "other", *MISSED)
    return _print(rows, "defect", columns, lambda row: row["part"] + row["other"], GOAL)


def _print(rows: dict[str, Counter[str]], head: str, columns: Sequence[str], good: Any, goal: float) -> bool:
    """A line for each row, and one for all; whether the goal is missed."""
    print(head.ljust(26) + "count".rjust(7) + "".join(column.rjust(12) for column in columns))
    total: Counter[str] = Counter()
    for name, row in sorted(rows.items()):
        total.update(row)
        print(name.ljust(26) + f"{row.total():7}" + "".join(f"{row[column]:12}" for column in columns))
    print("all".ljust(26) + f"{total.total():7}" + "".join(f"{total[column]:12}" for column in columns))
    share = good(total) / max(total.total(), 1)
    print(f"good {share:.1%} (goal {goal:.0%})")
    return share < goal


if __name__ == "__main__":
    sys.exit(main())
