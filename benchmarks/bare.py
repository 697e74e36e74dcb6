"""
The peer that does the least: one regular expression that finds the words of a program and knows nothing about them.

    python benchmarks/bare.py polar.nc

No checker written in Python reads words with less work than this, so other times are given as a ratio to it: a ratio
carries over to another machine, seconds do not.
"""

from __future__ import annotations

import argparse
import re
import statistics
import time
from pathlib import Path

WORD = re.compile(rb"([A-Z])([-+]?[0-9.]+)")
RUNS = 5


def bare_findall(path: Path) -> float:
    """Median time [s] of five times finding all words of the program at `path`; reading the file is not counted."""
    data = path.read_bytes()
    times = []
    for _ in range(RUNS):
        start = time.perf_counter()
        words = WORD.findall(data)
        times.append(time.perf_counter() - start)
        # Freed here, so that the next run does not pay for it.
        del words
    return statistics.median(times)


def main() -> None:
    """Print the time and the throughput for one program."""
    parser = argparse.ArgumentParser(description="Time a bare regular expression on an NC program.")
    parser.add_argument("path", type=Path, help="the program, as benchmarks/generate.py writes it")
    path = parser.parse_args().path
    seconds = bare_findall(path)
    print(f"{seconds:.3f} s  {path.stat().st_size / seconds / 1e6:.1f} MB/s")


if __name__ == "__main__":
    main()
