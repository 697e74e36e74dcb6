"""
Random sections by the hundred, written for several controls: path, rates, times and C against their own geometry.

    python benchmarks/twins.py --count 100 --seed 1 [--control okuma-osp]

The sections and what they have to give come from tests/twin_sections.py, which samples positions and shares no formula
with polarcheck. Ends with 1 where a program gives something else, and prints its seed and what differs.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "tests"))

from twin_sections import CONTROLS, compare


def main() -> int:
    """Compare and print; 1 where there is a disagreement."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100, help="seeds")
    parser.add_argument("--seed", type=int, default=1, help="the first of them")
    parser.add_argument("--control", action="append", choices=CONTROLS, help="only these; may be given several times")
    arguments = parser.parse_args()
    began, wrong = time.perf_counter(), 0
    controls = arguments.control or CONTROLS
    for seed in range(arguments.seed, arguments.seed + arguments.count):
        for name in controls:
            try:
                compare(seed, name)
            except AssertionError as difference:
                wrong += 1
                print(f"seed {seed}, {name}: {str(difference).strip()}")
    print(f"{arguments.count * len(controls)} programs in {time.perf_counter() - began:.0f} s, {wrong} differ")
    return int(wrong > 0)


if __name__ == "__main__":
    sys.exit(main())
