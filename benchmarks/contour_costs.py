"""
What a cutter radius costs: processor time and peak memory of contours that are hard to judge, beside those without it.

    python benchmarks/contour_costs.py [--only NAME] [--rounds 3] [--time-limit 120] [--memory-limit 8]

Each figure comes from a process of its own, with and without in turn, the median of the rounds. `ratio` is the time
with the radius over that without; `bytes/block` what the radius adds to the peak of memory. A run above one of the
limits is not repeated, and printed so. `--write FOLDER` leaves the programs there instead of measuring.
"""

from __future__ import annotations

import argparse
import cmath
import json
import math
import random
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from generate import CUTTER_RADIUS, Contour, around, program, word

MACHINE = "fanuc-30i"
TOOLS = range(1, 13)
OUTSIDE = 75.0
"""Distance from the center [mm] at which nothing is touched."""


@dataclass(frozen=True, slots=True)
class Case:
    """A program, R of its cutter [mm], and what is hard about it."""

    make: Callable[[], bytes]
    radius: float
    about: str


def at(point: complex) -> str:
    """X as a diameter and C of a plane point."""
    return f"{word('X', 2 * point.real)} {word('C', point.imag)}"


def lines(points: Iterable[complex]) -> Iterator[str]:
    """A G1 to each of the points."""
    return (f"G1 {at(point)}" for point in points)


def in_mode(blocks: Iterable[str]) -> bytes:
    """These blocks in the polar mode of a program that is sound otherwise."""
    head = ("%", "O0001", "G21 G40 G97 G98 G18", "T0101", "G0 X150. Z2. C0", "G12.1")
    return "\n".join([*head, *blocks, "G13.1", "M30", "%", ""]).encode("ascii")


def in_loop(side: str, start: complex, contour: Iterable[str], first: complex, end: complex) -> bytes:
    """A contour in one loop: its start-up leads from `start` to `first`, its cancel to `end`."""
    way = [f"G1 {at(start)} F500.", "G1 Z-3.", f"G1 {side} {at(first)} F200.", *contour, f"G1 G40 {at(end)}", "G1 Z2."]
    return in_mode([*way, f"G1 {at(complex(OUTSIDE))}"])


def along(begin: float, end: float, turns: int, share: float) -> float:
    """From one size to another in all turns but the last one, which has the end's: a closed contour is left."""
    return begin + (end - begin) * min(1, share * turns / (turns - 1))


def spiral(side: str, inner: float = 10, outer: float = 20, turns: int = 20, blocks: int = 200_000) -> bytes:
    """Counter-clockwise: outwards in a pocket at G41, inwards round a boss at G42."""
    begin, until = (inner, outer) if side == "G41" else (outer, inner)
    share = [i / blocks for i in range(blocks + 1)]
    points = [cmath.rect(along(begin, until, turns, i), math.tau * turns * i) for i in share]
    free = complex(1 if side == "G41" else outer + 10)
    return in_loop(side, free, lines(points[1:]), points[0], free)


def half_circles(arcs: int = 18_000, radius: float = 20) -> bytes:
    """Round one circle again and again, in two arcs each."""
    twice = [f"G3 {at(complex(-radius))} R{radius:g}.", f"G3 {at(complex(radius))} R{radius:g}."]
    return in_loop("G42", complex(40, -20), twice * (arcs // 2), complex(radius), complex(40, 20))


def short_arcs(passes: int = 300, lobes: int = 6, pieces: int = 5, radius: float = 20, allowance: float = 3) -> bytes:
    """Inwards round lobes of tangent arcs, round and hollow in turn; on the last pass all are of one radius."""
    half = math.pi / lobes
    # Circles that touch each other: their centers lie 2R apart.
    away = radius * (math.cos(half) + math.sqrt(3 + math.cos(half) ** 2))
    width = cmath.phase(cmath.rect(away, half) - radius)
    ends = []
    for arc in range(2 * lobes * passes):
        middle, is_round = half * arc, arc % 2 == 0
        sense, begins, sweep = (1, -width, 2 * width) if is_round else (-1, math.pi + width - half, 2 * (half - width))
        center = cmath.rect(radius if is_round else away, middle)
        for piece in range(1, pieces + 1):
            left = along(allowance, 0, passes, (arc + piece / pieces) / (2 * lobes * passes))
            end = center + cmath.rect(radius + sense * left, middle + begins + sweep * piece / pieces)
            ends.append(f"{'G3' if is_round else 'G2'} {at(end)} {word('R', radius + sense * left)}")
    normal = cmath.rect(1, -width)
    first = radius + (radius + allowance) * normal
    return in_loop("G42", first + 20 * normal, ends, first, first + 20 * normal)


def repeated(times: int = 1000, blocks: int = 200) -> bytes:
    """One contour with lobes, round and round again."""
    contour = Contour(20.0, ((5, 1.0),))
    first = complex(contour.radius(0.0))
    return in_loop("G42", complex(40, -20), list(around(contour, blocks, "G42", 200)) * times, first, complex(40, 20))


def ramps(passes: int = 240, blocks: int = 200_000, radius: float = 160) -> bytes:
    """An open contour in many passes, each deeper; both ramps run along its tangents and so nick its ends."""
    count = blocks // passes - 7
    first, last = math.radians(10), math.radians(350)
    contour = [cmath.rect(radius, first + (last - first) * i / count) for i in range(count + 1)]
    before, after = contour[0] + cmath.rect(1, first - math.pi / 2), contour[-1] + cmath.rect(1, last + math.pi / 2)
    way = []
    for number in range(passes):
        way += [
            "G1 Z2. F500.",
            f"G1 {at(complex(1.2 * radius))}",
            f"G1 {at(before)}",
            f"G1 Z{-0.01 * (number + 1):.2f}",
        ]
        way += [f"G1 G42 {at(contour[0])} F200.", *lines(contour[1:]), f"G1 G40 {at(after)}"]
    return in_mode([*way, "G1 Z2.", f"G1 {at(complex(1.2 * radius))}"])


def zigzag(moves: int) -> bytes:
    """A path that crosses itself again and again."""
    chance = random.Random(1)  # noqa: S311 - a program that can be written again, not a secret
    points = [cmath.rect(30 * math.sqrt(chance.random()), math.tau * chance.random()) for _ in range(moves)]
    return in_loop("G42", complex(50, -20), lines(points), complex(40), complex(50, 20))


def hexagon(passes: int = 400, outer: float = 40, inner: float = 20) -> bytes:
    """Inwards round a hexagon, each corner a little nearer than the one before."""
    count = 6 * passes
    points = [cmath.rect(along(outer, inner, passes, i / count), math.pi / 3 * i) for i in range(count + 1)]
    return in_loop("G42", complex(60, -20), lines(points[1:]), points[0], complex(60, 20))


CASES = {
    "spiral-out": Case(lambda: spiral("G41"), 5, "200,000 blocks, 20 turns r10 to r20 in a pocket"),
    "spiral-in": Case(lambda: spiral("G42"), 5, "200,000 blocks, 20 turns r20 to r10 round a boss"),
    "half-circles": Case(half_circles, 5, "18,000 arcs of R20, 9,000 times the same circle"),
    "short-arcs": Case(short_arcs, 5, "18,000 arcs of R20 in lobes, 300 turns"),
    "repeated": Case(repeated, 2, "a contour of 200 blocks 1,000 times in one loop"),
    "ramps": Case(ramps, 0.3, "480 ramps that nick the ends of their passes, 200,000 blocks"),
    "zigzag-1000": Case(lambda: zigzag(1_000), 4, "1,000 random moves in one loop"),
    "zigzag-20000": Case(lambda: zigzag(20_000), 4, "20,000 random moves in one loop"),
    "hexagon": Case(hexagon, 5, "400 turns round a hexagon in one loop"),
    "shaft": Case(program, CUTTER_RADIUS, "200,000 blocks of generate.py"),
}


@dataclass(frozen=True, slots=True)
class Cost:
    """What one run took, and how many findings it has [s, bytes]."""

    time: float
    peak: float
    findings: int


def measure(path: Path, radius: float) -> Cost:
    """What a check costs in this process; without a radius at 0."""
    import shapely  # type: ignore[import-untyped] # noqa: F401 - that its import is not measured

    from polarcheck.checking import check
    from polarcheck.program.machines import profiles
    from polarcheck.program.machines.job import Job, Tool
    from polarcheck.rules.rule import load_all

    data = path.read_bytes()
    lathe, rules = profiles.load(MACHINE).machine, list(load_all().values())
    job = Job(tools={str(number): Tool(radius=radius) for number in TOOLS} if radius else {})
    began = time.process_time()
    result = check.check_file(data, lathe, job, rules)
    taken = time.process_time() - began
    status = Path("/proc/self/status").read_text().splitlines()  # ru_maxrss would begin with that of the parent
    peak = next(int(line.split()[1]) for line in status if line.startswith("VmHWM"))
    return Cost(taken, peak * 1024, len(result.findings))


def cost(path: Path, radius: float, seconds: float, gigabytes: float) -> Cost | None:
    """What a check costs in a process of its own; None above a limit."""

    def limit_memory() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (int(gigabytes * 1e9),) * 2)

    command = [sys.executable, __file__, "--measure", str(path), str(radius)]
    try:
        done = subprocess.run(
            command, capture_output=True, text=True, timeout=seconds, preexec_fn=limit_memory, check=False
        )
    except subprocess.TimeoutExpired:
        return None
    if done.returncode:
        if "MemoryError" in done.stderr or "bad_alloc" in done.stderr or done.returncode < 0:
            return None
        raise RuntimeError(done.stderr)
    return Cost(**json.loads(done.stdout))


def line_of(name: str, path: Path, radius: float, asked: argparse.Namespace) -> str:
    """Measure one case: the line of the table."""
    limits = asked.time_limit, asked.memory_limit
    runs: dict[bool, list[Cost]] = {False: [], True: []}
    for _ in range(asked.rounds):
        for with_radius, found in runs.items():
            one = cost(path, radius if with_radius else 0, *limits)
            if one is None:
                return f"{name:<14} > limit ({'with' if with_radius else 'without'} a radius)"
            found.append(one)
    without, using = (
        Cost(*(statistics.median(getattr(run, field) for run in found) for field in ("time", "peak", "findings")))
        for found in runs.values()
    )
    blocks = path.read_bytes().count(b"\n")
    return (
        f"{name:<14} {blocks:7} {without.time:8.2f} {using.time:8.2f} {using.time / without.time:6.2f}"
        f" {without.peak / 1e6:8.0f} {using.peak / 1e6:8.0f} {(using.peak - without.peak) / blocks:11.0f}"
        f" {using.findings:8.0f}"
    )


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=CASES, action="append", metavar="NAME", help=", ".join(CASES))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--time-limit", type=float, default=120, help="of each run [s]")
    parser.add_argument("--memory-limit", type=float, default=8, help="of each run [GB]")
    parser.add_argument("--write", type=Path, metavar="FOLDER")
    parser.add_argument("--measure", nargs=2, metavar=("FILE", "RADIUS"), help=argparse.SUPPRESS)
    asked = parser.parse_args()
    if asked.measure:
        one = measure(Path(asked.measure[0]), float(asked.measure[1]))
        print(json.dumps({"time": one.time, "peak": one.peak, "findings": one.findings}))
        return
    names = asked.only or CASES
    if not asked.write:
        print(
            f"{'':<14} {'blocks':>7} {'s':>8} {'s with R':>8} {'ratio':>6} {'MB':>8} {'with R':>8} bytes/block findings"
        )
    with tempfile.TemporaryDirectory() as temporary:
        for name in names:
            path = (asked.write or Path(temporary)) / f"{name}.nc"
            path.write_bytes(CASES[name].make())
            if not asked.write:
                print(line_of(name, path, CASES[name].radius, asked), CASES[name].about, flush=True)


if __name__ == "__main__":
    main()
