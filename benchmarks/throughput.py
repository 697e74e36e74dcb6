"""
Blocks per second and peak memory of each stage, beside a bare regex over the same file: the ratio carries over.

    python benchmarks/throughput.py [--blocks 200000] [--file FILE] [--rounds 5]

Each figure is the median of the rounds; the regex runs in turn with the rest, so that both see the same machine.
"""

from __future__ import annotations

import argparse
import resource
import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from bare import WORD
from generate import program

from polarcheck.checking import check
from polarcheck.columns.trace import Trace
from polarcheck.program.execution.run import straight
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, Tool
from polarcheck.program.reading import source
from polarcheck.program.reading.words import read_words
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

CUTTERS = range(4, 13)


def stages(data: bytes) -> dict[str, Callable[[], Any]]:
    """What is measured, by name; each stage does all that it needs."""
    lathe = profiles.load(profiles.DEFAULT).machine
    rules = list(load_all().values())
    without = Job()
    with_cutter = Job(tools={str(number): Tool(radius=2) for number in CUTTERS})

    def read() -> Any:
        return read_words(source.read_source(data))

    def trace(job: Job) -> Trace:
        table: Trace = Tables(straight(read(), lathe.m_codes.program_end), lathe, job)["trace"]
        _ = table.mode.section, table.path.c_angle, table.path.center
        return table

    return {
        "bare regex": lambda: WORD.findall(data),
        "read": read,
        "read, trace": lambda: trace(without),
        "read, trace, all rules": lambda: check.check_file(data, lathe, without, rules),
        "the same with a 4 mm cutter": lambda: check.check_file(data, lathe, with_cutter, rules),
    }


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--blocks", type=int, default=200_000)
    parser.add_argument("--file", type=Path)
    parser.add_argument("--rounds", type=int, default=5)
    asked = parser.parse_args()
    data = asked.file.read_bytes() if asked.file else program(asked.blocks)
    blocks = data.count(b"\n")
    taken: dict[str, list[float]] = {}
    parts = stages(data)
    for _ in range(asked.rounds):
        for name, run in parts.items():
            began = time.perf_counter()
            result = run()
            taken.setdefault(name, []).append(time.perf_counter() - began)
            del result  # freed here, so that the next does not pay for it
    bare = statistics.median(taken["bare regex"])
    print(f"{blocks} blocks, {len(data) / 1e6:.1f} MB, median of {asked.rounds}")
    for name, times in taken.items():
        median = statistics.median(times)
        print(f"{name:<30} {median:7.3f} s {blocks / median:12,.0f} blocks/s {median / bare:6.2f} regex passes")
    for name in parts:
        print(f"{name:<30} {peak_of(name, data):7.0f} MB peak of a process of its own")


def peak_of(name: str, data: bytes) -> float:
    """The peak memory [MB] of a fresh process that runs one stage."""
    import multiprocessing

    with tempfile.NamedTemporaryFile(suffix=".nc") as file:
        Path(file.name).write_bytes(data)
        context = multiprocessing.get_context("spawn")
        with context.Pool(1) as pool:
            return pool.apply(_peak, (name, file.name))


def _peak(name: str, path: str) -> float:
    stages(Path(path).read_bytes())[name]()
    status = Path("/proc/self/status")
    if status.exists():  # ru_maxrss would begin with that of the parent
        return next(int(line.split()[1]) for line in status.read_text().splitlines() if line.startswith("VmHWM")) / 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


if __name__ == "__main__":
    main()
