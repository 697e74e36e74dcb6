"""
How often one slip gives one finding, and two slips in other sections, loops or aspects two.

    python benchmarks/two_slips.py --pairs 1000

The sections and the slips come from tests/drawn_sections.py and tests/drawn_slips.py.
"""

from __future__ import annotations

import argparse
import random
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from drawn_slips import SLIPS, gives_two_findings, loops, pairs, planted, rules_of, sound_sections


def main() -> None:
    """Print the shares."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n\n")[0])
    parser.add_argument("--pairs", type=int, default=1000)
    parser.add_argument("--sections", type=int, default=50)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    drawn = sound_sections(options.sections, options.seed)
    print(f"{len(drawn)} of {options.sections} sections are sound")
    for slip in SLIPS:
        draw, counts = random.Random(options.seed), Counter[int]()  # noqa: S311
        for number, one in enumerate(drawn):
            section = planted(slip, one, draw.randrange(len(loops(one))), draw)
            if section is not None:
                stock = one.stock if slip.name == "approach inside the bar" else None
                counts[len(rules_of(number, section, stock=stock))] += 1
        print(f"{slip.name:30} one finding: {counts[1]} of {counts.total()}")
    both, numbered = Counter[tuple[str, bool | None]](), [*enumerate(pairs(drawn, options.pairs, options.seed))]
    missed = Counter[tuple[str, str]]()
    with ProcessPoolExecutor() as pool:
        for (_, pair), two in zip(numbered, pool.map(gives_two_findings, numbered, chunksize=10), strict=True):
            both[pair.place, two] += 1
            missed[pair.names] += two is False
    known = sum(count for (_, two), count in both.items() if two is not None)
    print(f"two findings: {sum(count for (_, two), count in both.items() if two) / known:.1%} of {known} pairs")
    for names, count in (+missed).most_common(10):
        print(f"{count:6} {' and '.join(names)}")


if __name__ == "__main__":
    main()
