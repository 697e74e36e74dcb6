"""
Programs that could take hours: does their check end in time and memory, and does it say what it has given up?

    python benchmarks/hard_programs.py [--only NAME] [--size 1000] [--seconds 60] [--megabytes 1500] [--json]
    python benchmarks/hard_programs.py --command plot --without-compensation --kilobytes 200 --seconds 20

Each family is written in each of the sizes (its moves, about) and checked by a process of its own, under a limit of
address space and a time-out. A line for each: moves, seconds, peak of memory, how many times the seconds of the size
before, the verdict, findings, and what was not evaluated. Ends with 1 where one crosses a bound, ends by anything but
a report, or passes although something that matters was given up. `--command` runs another command, of which only the
exit code is judged; `--without-compensation` leaves out G40, G41 and G42; `--kilobytes` writes each program once, as
large as that. `--write FOLDER` leaves the programs there instead.
"""

from __future__ import annotations

import argparse
import cmath
import json
import math
import os
import random
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
SIZES = 1000, 4000, 16000
HEAD = ["%", "O1", "G21 G40 G97 G98 G18", "T0101"]
ENTRY, LEAVE = ["G0 X250. Z2. C0", "G12.1"], ["G13.1"]
#: One process: the command, then its processor time [ms] and its peak of memory [kB]; that which wait4 tells begins
#: with the peak of the parent.
CHILD = """
import atexit, os, sys
def tell():
    peak = next(line for line in open("/proc/self/status") if line.startswith("VmHWM"))
    os.write(2, b"took %d %d" % (1000 * sum(os.times()[:2]), int(peak.split()[1])))
atexit.register(tell)
from polarcheck.commands import main
main()
"""


# ---- words and loops ----


def at(point: complex, digits: int = 4) -> str:
    """X as a diameter and C of a plane point."""
    return f"X{2 * point.real:.{digits}f} C{point.imag:.{digits}f}"


def lines(points: Iterable[complex], digits: int = 4) -> Iterator[str]:
    """A block to each of the points."""
    return (at(point, digits) for point in points)


def loop(points: Iterable[str], first: complex, side: str = "G42", away: float = 12.0) -> list[str]:
    """A contour between its own ramps, which come from and go outwards."""
    far = first * (1 + away / max(abs(first), 1e-3))
    if side == "G41":
        far = first - first / max(abs(first), 1e-3) * min(away, abs(first))
    return [f"G1 {at(far)} F100", f"{side} {at(first)}", *points, f"G40 {at(far)}"]


def in_mode(blocks: Iterable[str], head: Iterable[str] = ()) -> str:
    """These blocks in one polar section of a program that is sound otherwise."""
    return "\n".join([*HEAD, *head, *ENTRY, *blocks, *LEAVE, "M30", "%", ""])


def around(corners: int, radius: float, middle: complex = 0j) -> list[complex]:
    """Points of a closed polygon, counterclockwise, the first once more."""
    return [middle + cmath.rect(radius, math.tau * i / corners) for i in range(corners + 1)]


def contour(corners: int, radius: float, middle: complex = 0j, side: str = "G42") -> list[str]:
    """One closed contour in a loop."""
    points = around(corners, radius, middle)
    out = middle + (points[0] - middle) * (1 + 12 / radius) if side == "G42" else middle
    return [f"G1 {at(out)} F100", f"{side} {at(points[0])}", *lines(points[1:]), f"G40 {at(out)}"]


# ---- one loop ----


def zigzag(moves: int) -> str:
    """Random points of a disk."""
    chance = random.Random(1)  # noqa: S311 - a program that can be written again
    points = [cmath.rect(50 * math.sqrt(chance.random()), math.tau * chance.random()) for _ in range(moves)]
    return in_mode(loop(lines(points), 60 + 0j))


def spiral(moves: int) -> str:
    """Inwards in twenty turns."""
    points = [cmath.rect(60 - 40 * i / moves, math.tau * 20 * i / moves) for i in range(moves + 1)]
    return in_mode(loop(lines(points[1:]), points[0]))


def tight_spiral(moves: int) -> str:
    """As many turns as there are corners of six blocks each, a hair apart."""
    points = [cmath.rect(60 - 40 * i / moves, math.tau * i / 6) for i in range(moves + 1)]
    return in_mode(loop(lines(points[1:]), points[0]))


def star(moves: int) -> str:
    """A star polygon: each side crosses nearly all others."""
    points = [cmath.rect(60, math.tau * i * (moves // 2) / moves) for i in range(moves | 1)]
    return in_mode(loop(lines(points[1:]), points[0]))


def comb(moves: int) -> str:
    """Teeth side by side, each thinner than the cutter."""
    teeth = moves // 4
    step = 100 / teeth
    points: list[complex] = []
    for i in range(teeth):
        x = -50 + i * step
        points += [complex(x, 0), complex(x, 40), complex(x + step / 2, 40), complex(x + step / 2, 0)]
    return in_mode(loop(lines([*points, 50 - 20j, -50 - 20j, -50 + 0j]), -50 + 0j))


def raster(moves: int) -> str:
    """To and fro over a pocket, in one loop."""
    rows = moves // 2
    points = [complex(40 * (1 if (i // 2) % 2 else -1), -40 + 80 * (i + 1) // 2 / rows) for i in range(moves)]
    return in_mode(loop(lines(points[1:]), points[0], "G41", 3))


def grid_lines(moves: int) -> str:
    """A raster along X and one along C: as many crossings as the square of the moves."""
    half = moves // 4
    along = [complex(40 * (-1 if (i // 2) % 2 else 1), -40 + 80 * ((i + 1) // 2) / half) for i in range(2 * half)]
    return in_mode(loop(lines([*along[1:], *(point * 1j for point in along)]), along[0]))


def again(moves: int) -> str:
    """One contour again and again, in one loop."""
    points = around(50, 40)
    return in_mode(loop([*lines(points[1:])] * (moves // 50), points[0]))


def nearly_again(moves: int) -> str:
    """The same, each time turned by a little, so that all turns cross each other."""
    points = [cmath.rect(40, math.tau * i / 50 + 1e-4 * (i // 50)) for i in range(moves + 1)]
    return in_mode(loop(lines(points[1:]), points[0]))


def arcs(moves: int) -> str:
    """Circles in three arcs each, from point to point of a disk."""
    chance = random.Random(2)  # noqa: S311 - a program that can be written again
    blocks, here = [], 60 + 0j
    for _ in range(moves):
        there = cmath.rect(50 * math.sqrt(chance.random()), math.tau * chance.random())
        blocks.append(
            f"{chance.choice(('G2', 'G3'))} {at(there)} R{abs(there - here) / 2 + 1 + 20 * chance.random():.3f}"
        )
        here = there
    return in_mode(loop(blocks, 60 + 0j))


def half_circles(moves: int) -> str:
    """One circle again and again."""
    return in_mode(loop(["G3 X-80. C0 R40.", "G3 X80. C0 R40."] * (moves // 2), 40 + 0j))


def growing_circles(moves: int) -> str:
    """Half circles, each a little larger than the one before."""
    blocks, x = [], 40.0
    for _ in range(moves):
        there = -math.copysign(abs(x) + 20 / moves, x)
        blocks.append(f"G3 X{2 * there:.5f} C0 R{abs(there - x) / 2:.6f}")
        x = there
    return in_mode(loop(blocks, 40 + 0j))


def still(moves: int) -> str:
    """All points the same."""
    return in_mode(loop(["X100. C5."] * moves, 50 + 0j))


def no_length(moves: int) -> str:
    """Every other move has no length."""
    points = around(moves // 2, 40)
    return in_mode(loop((block for point in points[1:] for block in (at(point), at(point))), points[0]))


def tiny(moves: int) -> str:
    """Moves of 1e-7 mm."""
    points = [50 + 1e-7j * i + 1e-7 * (i % 3) for i in range(moves)]
    return in_mode(loop(lines(points, 8), 50 + 0j))


def huge(moves: int) -> str:
    """Moves of 1e6 to 1e12 mm."""
    chance = random.Random(3)  # noqa: S311 - a program that can be written again
    points = [cmath.rect(10 ** chance.uniform(6, 12), math.tau * chance.random()) for _ in range(moves)]
    return in_mode(loop(lines(points, 1), 60 + 0j))


def mixed_scales(moves: int) -> str:
    """Moves of 1e-6 to 1e9 mm."""
    chance = random.Random(4)  # noqa: S311 - a program that can be written again
    points = [cmath.rect(10 ** chance.uniform(-6, 9), math.tau * chance.random()) for _ in range(moves)]
    return in_mode(loop(lines(points, 6), 60 + 0j))


def huge_arcs(moves: int) -> str:
    """Arcs with an R of up to 1e12 mm, by R and by I and J."""
    chance = random.Random(5)  # noqa: S311 - a program that can be written again
    blocks = []
    for i in range(moves // 2):
        radius = 10 ** chance.uniform(3, 12)
        blocks.append(f"G3 X{100 + i % 7}. C{i % 11}. R{radius:.1f}")
        blocks.append(f"G2 X{100 + i % 5}. C{i % 13}. I{-radius:.1f} J0")
    return in_mode(loop(blocks, 50 + 0j))


def huge_circles(moves: int) -> str:
    """Whole circles with an R of 1e9 mm: a sagitta of a micrometre is 70 million chords."""
    return in_mode(loop(["G3 X100. C0 I-1000000000. J0"] * moves, 50 + 0j))


def wide_circles(moves: int) -> str:
    """Whole circles with an R of 1,000 to 10,000 mm, all different."""
    return in_mode(loop([f"G3 X100. C0 I{-1000 - 9000 * i / moves:.3f} J0" for i in range(moves)], 50 + 0j))


def long_digits(moves: int) -> str:
    """Words of 150 digits: their squares are no numbers."""
    nines = "9" * 150
    return in_mode(loop([f"G3 X{nines} C{i}. R{nines}" if i % 2 else f"G1 X{i}. C-{nines}" for i in range(moves)], 50j))


def long_arcs(moves: int) -> str:
    """Arcs whose I and J have 150 digits."""
    return in_mode(loop([f"G3 X100. C{i % 3}. I-{'7' * 150} J{'3' * 150}" for i in range(moves)], 50j))


def many_degrees(moves: int) -> str:
    """C words of 1e9 as if they were degrees."""
    return in_mode(loop([f"X{90 + i % 9}. C{1000000000 + 360 * i}." for i in range(moves)], 50 + 0j))


# ---- many loops ----


def sections(moves: int) -> str:
    """A contour of five blocks in each section."""
    return "\n".join([*HEAD, *([*ENTRY, *contour(4, 30), *LEAVE] * (moves // 8)), "M30", "%", ""])


def levels(moves: int) -> str:
    """One contour at many depths, each with a loop of its own."""
    blocks = []
    for i in range(moves // 60):
        blocks += ["G1 Z2. F500", "X250. C0", f"G1 Z{-0.01 * (i + 1):.3f}", *contour(56, 30)]
    return in_mode([*blocks, "G1 Z2."])


def tapered_levels(moves: int) -> str:
    """The same with a contour that grows with the depth."""
    blocks = []
    for i in range(moves // 60):
        blocks += ["G1 Z2. F500", "X250. C0", f"G1 Z{-0.01 * (i + 1):.3f}", *contour(56, 30 + 0.005 * i)]
    return in_mode([*blocks, "G1 Z2."])


def spirals_of_z(moves: int) -> str:
    """Z in each block of a contour, so that each block is a loop by itself."""
    points = [cmath.rect(30, math.tau * i / 50) for i in range(moves)]
    return in_mode(loop((f"{at(point)} Z{-0.001 * i:.3f}" for i, point in enumerate(points[1:])), points[0]))


def concentric(moves: int) -> str:
    """Circles inside each other, in two arcs and a loop each, at one depth."""
    count = moves // 5
    blocks = []
    for i in range(count):
        r = 60 - 40 * i / count
        arcs_ = [f"G3 {at(complex(-r))} R{r:.4f}", f"G3 {at(complex(r))} R{r:.4f}", "G1"]
        blocks += loop(arcs_, complex(r))
    return in_mode(blocks)


def nested_squares(moves: int) -> str:
    """Squares inside each other, in a loop each, at one depth."""
    count = moves // 7
    return in_mode(block for i in range(count) for block in contour(4, 60 - 40 * i / count))


def crossing_loops(moves: int) -> str:
    """Squares of one depth, each turned by a little: every loop crosses every other."""
    count = moves // 7
    blocks = []
    for i in range(count):
        turn = cmath.rect(1, math.tau / 4 * i / count)
        points = [point * turn for point in around(4, 40)]
        blocks += loop(lines(points[1:]), points[0])
    return in_mode(blocks)


def pockets(moves: int) -> str:
    """A grid of small pockets in one section."""
    count = moves // 7
    side = math.isqrt(count) + 1
    blocks = []
    for i in range(count):
        middle = complex((i % side - side / 2) * 20, (i // side - side / 2) * 20)
        blocks += [
            "G1 Z2. F500",
            f"X{2 * middle.real:.3f} C{middle.imag:.3f}",
            "G1 Z-1.",
            *contour(4, 8, middle, "G41"),
        ]
    return in_mode([*blocks, "G1 Z2."])


def bosses(moves: int) -> str:
    """A grid of bosses so near to each other that the tool does not fit between them."""
    count = moves // 7
    side = math.isqrt(count) + 1
    blocks = []
    for i in range(count):
        middle = complex((i % side - side / 2) * 17, (i // side - side / 2) * 17)
        blocks += contour(4, 10, middle)
    return in_mode(blocks)


def copies(moves: int) -> str:
    """One contour in as many loops, at one depth."""
    return in_mode(contour(5, 30) * (moves // 8))


def tools(moves: int) -> str:
    """A section and an offset for each contour."""
    count = moves // 10
    blocks = [
        block for i in range(count) for block in (f"T{1 + i % 99:02d}{1 + i % 99:02d}", *ENTRY, *contour(4, 30), *LEAVE)
    ]
    return "\n".join([*HEAD, *blocks, "M30", "%", ""])


def calls(moves: int) -> str:
    """One subprogram with a section, called by as many programs of a file."""
    count = moves // 10
    programs = [
        line for i in range(count) for line in (f"O{1000 + i:04d}", *HEAD[2:], "G0 X250. Z2. C0", "M98 P9000", "M30")
    ]
    return "\n".join(["%", *programs, "O9000", "G12.1", *contour(4, 30), *LEAVE, "M99", "%", ""])


def repeats(moves: int) -> str:
    """One subprogram with a section, called again and again."""
    called = ["O9000", "G12.1", *contour(4, 30), *LEAVE, "M99", "%", ""]
    return "\n".join([*HEAD, "G0 X250. Z2. C0", f"M98 P9000 L{moves // 8}", "M30", *called])


def overcut(moves: int) -> str:
    """A wave that is narrower than the cutter, which is run again with other R to find the one that fits."""
    points = [cmath.rect(50 + 2 * math.cos(math.tau * i / 8), math.tau * i / moves) for i in range(moves + 1)]
    return in_mode(loop(lines(points[1:]), points[0]))


def overcut_loops(moves: int) -> str:
    """Many contours with a groove that is too narrow, at different depths and of different sizes."""
    blocks = []
    for i in range(moves // 14):
        r = 30 + 20 * i / (moves // 14)
        square = [complex(r, 0), complex(r, r), complex(2, r), 2 + 20j, -2 + 20j, complex(-2, r)]
        square += [complex(-r, r), complex(-r, -r), complex(r, -r), complex(r, 0)]
        blocks += ["G1 Z2. F500", "X250. C0", f"G1 Z{-0.01 * (i + 1):.3f}", *loop(lines(square[1:]), square[0])]
    return in_mode([*blocks, "G1 Z2."])


def bare_moves(moves: int) -> str:
    """Many moves without compensation over a section with many contours."""
    chance = random.Random(6)  # noqa: S311 - a program that can be written again
    points = [cmath.rect(50 * math.sqrt(chance.random()), math.tau * chance.random()) for _ in range(moves // 2)]
    boxes = [block for i in range(moves // 14) for block in contour(4, 20 + 20 * i / moves)]
    return in_mode(["G1 Z-1. F100", *boxes, "G1 F100", *lines(points), "G1 Z2."])


def bare_levels(moves: int) -> str:
    """The same with a depth for each contour."""
    blocks = []
    for i in range(moves // 14):
        blocks += ["G1 X250. C0 F100", f"G1 Z{-0.01 * (i + 1):.3f}", *contour(4, 20 + 20 * i / moves), "G1 X60. C3."]
        blocks += ["X-60. C2.", "X10. C-20."]
    return in_mode([*blocks, "G1 Z2."])


def passes(moves: int) -> str:
    """Passes farther apart than the cutter is wide, at many depths: a strip between all of them."""
    blocks = []
    for i in range(moves // 60):
        z = f"G1 Z{-0.1 * (i + 1):.2f}"
        blocks += ["G1 Z2. F500", "X250. C0", z, *contour(24, 60 + 0.001 * i), *contour(24, 50 + 0.001 * i)]
    return in_mode([*blocks, "G1 Z2."])


def slanted_leads(moves: int) -> str:
    """Contours whose leads leave a rib, at many depths."""
    blocks = []
    for i in range(moves // 10):
        r = 30 + 10 * i / moves
        square = [complex(r, 0), complex(r, r), complex(-r, r), complex(-r, -r), complex(r, -r), complex(r, 0)]
        blocks += ["G1 Z2. F500", "X250. C0", f"G1 Z{-0.01 * (i + 1):.3f}", f"G1 {at(complex(r + 12, 0))} F100"]
        blocks += [
            f"G42 {at(complex(r + 10, 0))}",
            *lines(square),
            at(complex(r + 10, 0)),
            f"G40 {at(complex(r + 30, 0))}",
        ]
    return in_mode([*blocks, "G1 Z2."])


@dataclass(frozen=True, slots=True)
class Family:
    """How a program of so many moves is written, and how many tool offsets it calls."""

    make: Callable[[int], str]
    offsets: int = 1


FAMILIES = {
    function.__name__.replace("_", "-"): Family(function, 99 if function is tools else 1)
    for function in (
        *(zigzag, spiral, tight_spiral, star, comb, raster, grid_lines, again, nearly_again, arcs, half_circles),
        *(growing_circles, still, no_length, tiny, huge, mixed_scales, huge_arcs, huge_circles, wide_circles),
        *(long_digits, long_arcs, many_degrees, sections, levels, tapered_levels, spirals_of_z, concentric),
        *(nested_squares, crossing_loops, pockets, bosses, copies, tools, calls, repeats, overcut, overcut_loops),
        *(bare_moves, bare_levels, passes, slanted_leads),
    )
}


# ---- a check in a process of its own ----


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one check took [s of the processor, MB], what it said, and what is wrong with that ("" for nothing)."""

    seconds: float
    megabytes: float
    verdict: str
    findings: int
    not_evaluated: tuple[str, ...]
    fault: str


#: The arguments of a command before the file and behind it; {page} is a file that may be written.
COMMANDS: dict[str, tuple[list[str], list[str]]] = {
    "check": (["check"], ["--format", "json"]),
    "check-part": (["check", "--part"], ["--format", "html"]),
    "part": (["part"], []),
    "plot": (["plot"], ["-o", "{page}"]),
    "feeds": (["feeds"], []),
    "trace": (["trace", "--path", "tool"], []),
    "fix": (["check", "--diff", "--unsafe-fixes"], []),
}


def run(
    path: Path,
    seconds: float,
    megabytes: int,
    offsets: int = 1,
    options: Iterable[str] = (),
    tree: Path = ROOT,
    name: str = "check",
) -> Outcome:
    """Run the command of this name on one file; `tree` is the checkout whose polarcheck does."""
    import resource  # late: the programs are written on Windows, too

    def limit_memory() -> None:
        resource.setrlimit(resource.RLIMIT_AS, (megabytes * 1_000_000,) * 2)

    given = (part for number in range(1, offsets + 1) for part in ("--tool", f"{number}:radius=4"))
    before, behind = COMMANDS[name]
    behind = [word.format(page=path.with_suffix(".html")) for word in behind]
    command = [sys.executable, "-c", CHILD, *before, str(path), "--machine", "fanuc-30i", *given, *behind]
    try:
        done = subprocess.run(
            [*command, *options],
            capture_output=True,
            text=True,
            timeout=seconds,
            preexec_fn=limit_memory,
            check=False,
            env={**os.environ, "PYTHONPATH": str(tree), "OPENBLAS_NUM_THREADS": "1", "POLARCHECK_NO_CACHE": "1"},
        )
    except subprocess.TimeoutExpired:
        return Outcome(seconds, math.nan, "", 0, (), "takes too long")
    said, _, told = done.stderr.rpartition("took ")
    taken, used = (int(number) / 1000 for number in told.split()) if told else (math.nan, math.nan)
    if done.returncode not in (0, 1):
        return Outcome(taken, used, "", 0, (), f"exit {done.returncode}: {said.strip()[-200:]}")
    if name != "check":
        return Outcome(taken, used, f"exit {done.returncode}", 0, (), "")
    (report,) = json.loads(done.stdout)["files"]
    missing = tuple(f"{one['rule']}: {one['reason']}" for one in report["not_evaluated"] if one["matters"])
    verdict = report["verdict"]
    fault = f"stderr: {said.strip()[-200:]}" if said.strip() else ""
    if verdict == "pass" and missing:
        fault = "passes, though something was given up"
    return Outcome(taken, used, verdict, len(report["findings"]), missing, fault)


def main() -> int:
    """Measure and print; 1 where something is wrong."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", choices=FAMILIES, action="append", metavar="NAME", help=", ".join(FAMILIES))
    parser.add_argument("--size", type=int, action="append", metavar="MOVES", help="instead of those of the family")
    parser.add_argument("--seconds", type=float, default=60, help="time-out of each check")
    parser.add_argument("--megabytes", type=int, default=2500, help="address space of each check")
    parser.add_argument("--tree", type=Path, default=ROOT, help="another checkout, to compare with")
    parser.add_argument("--command", choices=COMMANDS, default="check")
    parser.add_argument("--without-compensation", action="store_true")
    parser.add_argument("--kilobytes", type=int, help="the size of each program, instead of those of the family")
    parser.add_argument("--json", action="store_true", help="a JSON object a line")
    parser.add_argument("--write", type=Path, metavar="FOLDER")
    asked = parser.parse_args()
    bad = 0
    with tempfile.TemporaryDirectory() as temporary:
        for name in asked.only or FAMILIES:
            before = math.nan
            make = FAMILIES[name].make
            for size in [moves_in(make, asked.kilobytes)] if asked.kilobytes else asked.size or SIZES:
                path = (asked.write or Path(temporary)) / f"{name}-{size}.nc"
                text = make(size)
                path.write_text(
                    re.sub(r"G4[012] ?", "", text) if asked.without_compensation else text, encoding="ascii"
                )
                if asked.write:
                    continue
                offsets = FAMILIES[name].offsets
                found = run(path, asked.seconds, asked.megabytes, offsets, tree=asked.tree, name=asked.command)
                path.unlink()
                bad += bool(found.fault)
                print(line_of(name, size, found, before, asked.json), flush=True)
                before = found.seconds
    return int(bad > 0)


def moves_in(make: Callable[[int], str], kilobytes: int) -> int:
    """With how many moves a program of a family has about this size, and not more."""
    size = 1000
    for _ in range(20):
        length = len(make(size))
        if 0.9 * kilobytes * 1000 <= length <= kilobytes * 1000:
            break
        size = min(max(int(size * 0.95 * kilobytes * 1000 / length), 1), 20_000)
    while len(make(size)) > kilobytes * 1000 and size > 1:
        size = size * 9 // 10
    return size


def line_of(name: str, size: int, found: Outcome, before: float, as_json: bool) -> str:
    """One line of the table."""
    if as_json:
        columns = {field: getattr(found, field) for field in Outcome.__slots__}
        return json.dumps({"family": name, "moves": size, **columns})
    times = "" if math.isnan(before) else f"{found.seconds / before:.1f}x"
    head = f"{name:<16} {size:7} {found.seconds:7.2f} s {times:>6} {found.megabytes:7.0f} MB"
    gave_up = "; ".join(reason[:90] for reason in found.not_evaluated[:2])
    return f"{head} {found.verdict:<10} {found.findings:5} {found.fault and f'** {found.fault} **'} {gave_up}"


if __name__ == "__main__":
    sys.exit(main())
