"""
One slip in a sound program: does what a finding advises lead back to it?

    python benchmarks/remedies.py --slips 400 [--seed 1] [--kind "F "] [--machine NAME] [--show elsewhere] [--rule NAME]
    python benchmarks/remedies.py --drawn 200      slips of tests/drawn_slips.py

Programs come from tests/setter_programs.py, slips from tests/single_slips.py and, of words that need no drawing, from
tests/remedy_slips.py, which also says what is right. For each finding:

    right       it names the word or block of the sound program, or its fix makes the sound path
    place       it stands at the slip or names its line, and says no other value to write
    else there  it stands at the slip or names its line, and what it says to write is something else
    no advice   it stands elsewhere, and says what is wrong without anything to write
    elsewhere   it stands elsewhere, and says what to write there
"""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter, defaultdict
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from remedy_slips import GRADES, KINDS, Judged, judged_slip


def main() -> int:
    """Print the shares, by rule."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--slips", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1, help="the first of them")
    parser.add_argument("--kind", default="", help="only the kinds whose name holds this")
    parser.add_argument("--machine", default="")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--show", default="", help="print findings of these grades, comma between them, or all")
    parser.add_argument("--rule", default="", help="print those of this rule only")
    options = parser.parse_args()
    began = time.perf_counter()
    kinds = tuple(name for name in KINDS if options.kind in name)
    work = partial(judged_slip, kinds=kinds, machine=options.machine)
    with ProcessPoolExecutor(options.jobs) as pool:
        seeds = range(options.seed, options.seed + options.slips)
        results = [result for result in pool.map(work, seeds, chunksize=5) if result]
    grades = GRADES if options.show == "all" else tuple(options.show.split(","))
    for result in results:
        _show(result, grades, options.rule)
    _table(results)
    print(f"{time.perf_counter() - began:.0f} s")
    return int(any(result.safe_fix_is_wrong for result in results))


def _show(result: Judged, grades: tuple[str, ...], rule: str) -> None:
    for advice in result.advice:
        if advice.grade in grades and rule in ("", advice.rule):
            print(f"-- {result.kind}, seed {result.seed}, {result.machine}, {result.family}: {advice.grade}")
            print(f"   line {result.line}: {result.written!r} for {result.sound!r}")
            print(f"   {advice.line}: {advice.severity}: {advice.message} [{advice.rule}]")
            if advice.fix:
                print(f"   fix: {advice.fix}")


def _table(results: list[Judged]) -> None:
    """A line for each rule, those that mislead most at the head; then the shares."""
    rows: dict[str, Counter[str]] = defaultdict(Counter)
    fixes: Counter[str] = Counter()
    for result in results:
        for advice in result.advice:
            rows[advice.rule][advice.grade] += 1
            if advice.fix:
                fixes[advice.fix] += 1
    total = sum(rows.values(), Counter[str]())
    print("rule".ljust(40) + "".join(grade.rjust(12) for grade in GRADES))
    worst = sorted(rows, key=lambda name: (-rows[name]["elsewhere"] - rows[name]["else there"], name))
    for name, row in [*((name, rows[name]) for name in worst), ("all", total)]:
        print(name.ljust(40) + "".join(str(row[grade]).rjust(12) for grade in GRADES))
    count = max(sum(total.values()), 1)
    print(", ".join(f"{grade} {total[grade] / count:.1%}" for grade in GRADES))
    spoken = [result for result in results if result.advice]
    best = Counter(min((advice.grade for advice in result.advice), key=GRADES.index) for result in spoken)
    print(f"{len(results)} slips, {len(spoken)} with findings; their best: {dict(best)}")
    print(f"fixes: {dict(fixes)}; wrong safe ones: {sum(result.safe_fix_is_wrong for result in results)}")


if __name__ == "__main__":
    sys.exit(main())
