"""
Programs that turn first and mill then: false words in sound ones, and what is said of slips against the metal.

    python benchmarks/turned_bars.py --sound 1500 [--seed 0]
    python benchmarks/turned_bars.py --slips 20 [--seed 5000] [--kind "depth ten times"]

Programs and slips come from tests/turned_programs.py. `[stock]` is the bar before it is turned: round, a hexagon or a
tube, as large as the spigot or 6 and 12 mm more. A slip counts as told with any error or warning.
"""

from __future__ import annotations

import argparse
import sys
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from programs import report_of
from turned_programs import KINDS, Program, drawn, slipped

#: Programs that are drawn for each one that has a place for a slip.
_MOST_TRIALS = 60


def said_of(program: Program) -> list[tuple[str, int]]:
    """Rule and line of the errors and warnings of a program."""
    report = report_of(program.text(), "fanuc-30i", *program.tools, job={"stock": program.stock})
    return [(one.rule, one.line) for one in report.findings if one.severity != "note"]


def sound(count: int, seed: int) -> None:
    told = {number: words for number in range(seed, seed + count) if (words := said_of(drawn(number)))}
    print(f"{count} sound programs, {len(told)} with a false word")
    for number, words in told.items():
        print(f"    {number}: {', '.join(f'{rule} in line {line}' for rule, line in words)}")


def slips(count: int, seed: int, names: list[str]) -> None:
    total: Counter[str] = Counter()
    for name in names:
        of_kind, silent, number = 0, [], seed
        while of_kind < count and number < seed + _MOST_TRIALS * count:
            slip = slipped(drawn(number), name)
            if slip is not None:
                of_kind += 1
                silent += [] if said_of(slip) else [number]
            number += 1
        total += Counter(slips=of_kind, told=of_kind - len(silent))
        print(
            f"{name:34} {of_kind - len(silent):4} of {of_kind:4} {'silent: ' if silent else ''}{silent or ''}",
            flush=True,
        )
    print(f"{len(names)} kinds, {total['told']} of {total['slips']} told")


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("--sound", type=int, default=0)
    parser.add_argument("--slips", type=int, default=0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kind", choices=list(KINDS))
    arguments = parser.parse_args()
    if arguments.sound:
        sound(arguments.sound, arguments.seed)
    if arguments.slips:
        slips(arguments.slips, arguments.seed, [arguments.kind] if arguments.kind else list(KINDS))


if __name__ == "__main__":
    main()
