"""
Contours by the thousand: does polarcheck call a sound program scrap, and does it find every cut into the part?

    python benchmarks/geometry_generator.py --count 5000 --seed 1 [--jobs 2] [--keep FOLDER]

The programs and the finished part come from tests/contour_families.py, the judgement from tests/part_reference.py,
which shares no code with polarcheck. Every fifth sound program is checked again turned, mirrored, in inch, incremental.
Ends with 1 where the two disagree; --keep writes each such program to a folder, with both judgements in a comment.

Told but no disagreement, where only a cut is missed: an R up to 0.254 mm, which polarcheck takes as the adjustment of a
path of the tool center; a block in offset mode that is programmed through the part; and the wrong side of compensation.
Of the last two the program itself asks for another part: a rib where a slot was meant. --strict counts them, too.
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

from contour_families import FAMILIES
from contour_verdicts import KINDS, TOLD, Comparison, compare_seed

COLUMNS = ("programs", "sound", "unsound", "alarm", "undecided", *KINDS, *TOLD)


def main() -> int:
    """Compare, print the table; 1 where there is a disagreement."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=5000, help="seeds, without twins")
    parser.add_argument("--seed", type=int, default=1, help="the first of them")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--family", default="", choices=["", *FAMILIES])
    parser.add_argument("--keep", type=Path, help="folder for programs on which the two disagree")
    parser.add_argument("--strict", action="store_true", help="end with 1 for what is only told, too")
    asked = parser.parse_args()
    began = time.perf_counter()
    seeds = range(asked.seed, asked.seed + asked.count)
    table: dict[str, Counter[str]] = defaultdict(Counter)
    others: Counter[str] = Counter()
    with ProcessPoolExecutor(asked.jobs) as pool:
        for found in pool.map(partial(compare_seed, family=asked.family), seeds, chunksize=20):
            for number, comparison in enumerate(found):
                row = table[comparison.program.family]
                row.update(["programs", comparison.judged, comparison.disagreement])
                others.update(comparison.other)
                if asked.keep and comparison.disagreement:
                    keep(asked.keep, comparison, number)
    print_table(table)
    if others:
        print("errors about something else:", ", ".join(f"{name} {count}" for name, count in others.most_common()))
    print(f"{sum(row['programs'] for row in table.values())} programs in {time.perf_counter() - began:.0f} s")
    kinds = (*KINDS, *TOLD) if asked.strict else KINDS
    return int(any(row[kind] for row in table.values() for kind in kinds))


def keep(folder: Path, comparison: Comparison, number: int) -> None:
    """Write a program to the folder, under what the disagreement is about."""
    folder.mkdir(parents=True, exist_ok=True)
    program = comparison.program
    kind = comparison.disagreement.replace(", ", "-").replace(" ", "-")
    twin = f"-twin{number}" if number else ""
    bar = "" if program.bar is None else f" BAR {program.bar:.3f}"
    says = comparison.says.replace("(", "").replace(")", "")
    head, _, rest = program.text.partition("\n")
    text = f"{head} ({program.family} SEED {program.seed} R {program.radius}{bar})\n({says})\n{rest}"
    (folder / f"{kind}-{program.family}-{program.seed}{twin}.nc").write_text(text)


def print_table(table: dict[str, Counter[str]]) -> None:
    """A line for each family and one for all."""
    total: Counter[str] = Counter()
    for row in table.values():
        total.update(row)
    widths = [max(len(name), 6) for name in COLUMNS]
    print(" " * 12, *(name.rjust(width) for name, width in zip(COLUMNS, widths, strict=True)))
    for family, row in [*table.items(), ("all", total)]:
        print(family.ljust(12), *(str(row[name]).rjust(width) for name, width in zip(COLUMNS, widths, strict=True)))


if __name__ == "__main__":
    sys.exit(main())
