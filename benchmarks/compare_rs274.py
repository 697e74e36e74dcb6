"""
Compare the tool center path with that of LinuxCNC's interpreter rs274, on random contours of lines and arcs.

    python benchmarks/compare_rs274.py --rs274 path/to/rs274 --programs 600 --seed 1

For developers; needs rs274 on the search path, in the variable RS274 or in the option, and does nothing without it.
An rs274 unpacked but not installed finds its libraries by LD_LIBRARY_PATH.

Both controls agree, or should, on the vertices of inside corners, on the radius of arcs and on contours in which the
tool does not fit. They differ by intention at outside corners (lines here, arcs there), in the start-up and the cancel,
and on turns below 0.05 rad, which LinuxCNC takes as straight; those are left out.
"""

from __future__ import annotations

import argparse
import cmath
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path as FilePath
from typing import NamedTuple

import numpy as np

from polarcheck.foundation.states import Corner, Motion, Side
from polarcheck.geometry.cutter_compensation.offset_path import Method, Path, Phase, ToolPath, tool_center_path

NAN = complex(math.nan, math.nan)

#: rs274 prints four decimals: a thousand times larger contours give 1e-7 mm.
SCALE = 1000

#: Points nearer than this [mm] are the same; words are rounded to 1e-7 mm, which nearly tangent curves magnify.
TOLERANCE = 1e-4

NUMBER = r"(-?[\d.]+)"
STRAIGHT = re.compile(rf"STRAIGHT_FEED\({NUMBER}, {NUMBER},")
ARC = re.compile(rf"ARC_FEED\({NUMBER}, {NUMBER}, {NUMBER}, {NUMBER}, (-?\d+),")


class Move(NamedTuple):
    """One block of a contour."""

    motion: Motion
    start: complex
    end: complex
    center: complex

    def tangent(self, point: complex) -> complex:
        """Direction of travel at one of the two ends."""
        if self.motion == Motion.LINE:
            return (self.end - self.start) / abs(self.end - self.start)
        return (point - self.center) / abs(point - self.center) * (1j if self.motion == Motion.CCW else -1j)


class Contour(NamedTuple):
    """A start-up, some moves, all with the same radius [mm] on the same side."""

    side: Side
    radius: float
    moves: list[Move]


class Other(NamedTuple):
    """What rs274 made of a contour: vertices, (center, radius, turning) of arcs, and its message if it stopped."""

    vertices: np.ndarray
    arcs: list[tuple[complex, float, int]]
    error: str


def random_contour(chance: random.Random) -> Contour:
    """Lines and arcs at any angle; some of them do not leave room for the tool."""
    radius = round(chance.uniform(1, 5), 3)
    longest = chance.choice((4, 12, 40)) * radius
    here, tangent = 0j, cmath.exp(1j * chance.uniform(-math.pi, math.pi))
    moves = []
    for number in range(chance.randint(4, 9)):
        if number > 1:
            turn = math.radians(chance.uniform(4, 140)) * chance.choice((-1, 1))
            tangent *= cmath.exp(1j * turn)
        size = chance.uniform(1.2 * radius, longest)
        motion = Motion.LINE if number < 2 else chance.choice((Motion.LINE, Motion.CW, Motion.CCW))
        end, center = rounded(here + size * tangent), NAN
        if motion != Motion.LINE:
            turning = 1 if motion == Motion.CCW else -1
            center = rounded(here + 1j * turning * size * tangent)
            sweep = turning * chance.uniform(0.5, 3)
            end = rounded(center + (here - center) * cmath.exp(1j * sweep))
        moves.append(Move(motion, here, end, center))
        here, tangent = end, moves[-1].tangent(end)
    return Contour(chance.choice((Side.LEFT, Side.RIGHT)), radius, moves)


def rounded(point: complex) -> complex:
    """The point as the program for rs274 writes it."""
    return complex(round(point.real, 7), round(point.imag, 7))


def ours(contour: Contour) -> ToolPath:
    """The contour through the code under test."""
    count = len(contour.moves)
    path = Path(
        section=np.zeros(count, dtype=np.int64),
        motion=np.array([move.motion for move in contour.moves], dtype=np.int8),
        moves=np.ones(count, dtype=np.bool_),
        start=np.array([move.start for move in contour.moves]),
        end=np.array([move.end for move in contour.moves]),
        center=np.array([move.center for move in contour.moves]),
        side=np.full(count, contour.side, dtype=np.int8),
        side_written=np.arange(count) == 0,
        radius=np.full(count, contour.radius),
        cancel_vector=np.full(count, NAN),
        stops_reading=np.zeros(count, dtype=np.bool_),
        corner=np.full(count, Corner.LINES, dtype=np.int16),
    )
    return tool_center_path(path, Method())


def theirs(contour: Contour, rs274: str, folder: FilePath) -> Other:
    """The contour through rs274; D is a diameter in the units of the program."""
    lines = ["G21 G17 G90 G40", "G0 X0 Y0", f"G{contour.side}.1 D{2 * SCALE * contour.radius:.4f}", "F1000"]
    for move in contour.moves:
        end = f"X{SCALE * move.end.real:.4f} Y{SCALE * move.end.imag:.4f}"
        if move.motion == Motion.LINE:
            lines.append(f"G1 {end}")
        else:
            spoke = SCALE * (move.center - move.start)
            lines.append(f"G{move.motion:d} {end} I{spoke.real:.4f} J{spoke.imag:.4f}")
    program, table = folder / "contour.ngc", folder / "empty.tbl"
    program.write_text("\n".join([*lines, "G40", "M2", ""]))
    table.touch()
    run = subprocess.run([rs274, "-t", table, "-g", program], capture_output=True, text=True, check=False)
    vertices, arcs = [], []
    for line in run.stdout.splitlines():
        if found := STRAIGHT.search(line):
            vertices.append(complex(*map(float, found.groups())) / SCALE)
        elif found := ARC.search(line):
            *numbers, turning = map(float, found.groups())
            end, center = complex(*numbers[:2]) / SCALE, complex(*numbers[2:]) / SCALE
            vertices.append(end)
            arcs.append((center, abs(end - center), int(turning)))
    error = "" if run.returncode == 0 else (run.stderr.splitlines() + ["?"] * 2)[1]
    return Other(np.array(vertices), arcs, error)


def inside_corners(contour: Contour) -> list[tuple[int, str]]:
    """Rows at whose end the tool passes an inside corner, and the kinds of the two moves, as "LA"."""
    corners = []
    left = 1 if contour.side == Side.LEFT else -1
    for row in range(1, len(contour.moves) - 1):
        before, after = contour.moves[row : row + 2]
        turn = cmath.phase(after.tangent(after.start) / before.tangent(before.end))
        if 0 < left * turn < math.pi - TOLERANCE:
            corners.append((row, "".join("L" if m.motion == Motion.LINE else "A" for m in (before, after))))
    return corners


def compare(contour: Contour, tool: ToolPath, other: Other, totals: Counter[str]) -> float:
    """Count what agrees and what does not; the largest distance [mm] between vertices of inside corners that agree."""
    worst = 0.0
    for row, kinds in inside_corners(contour):
        move = np.flatnonzero((tool.row == row) & ~tool.corner & (tool.phase == Phase.OFFSET))
        if not len(move):  # a groove of twice R, whose floor has no path
            continue
        apart = np.abs(other.vertices - tool.end[move[0]]).min()
        totals[f"inside {kinds} {'agree' if apart <= TOLERANCE else 'DIFFER'}"] += 1
        worst = max(worst, apart if apart <= TOLERANCE else 0.0)
    for move in np.flatnonzero((tool.kind != Motion.LINE) & (tool.phase == Phase.OFFSET)):
        center, turning = tool.center[move], 1 if tool.kind[move] == Motion.CCW else -1
        radius = abs(tool.end[move] - center)
        same = any(
            abs(at - center) <= TOLERANCE and abs(size - radius) <= TOLERANCE and turning == turns
            for at, size, turns in other.arcs
        )
        totals[f"arc radius {'agree' if same else 'DIFFER'}"] += 1
    return worst


def objects(tool: ToolPath) -> bool:
    """Would the control raise an alarm?"""
    return bool((tool.inside_arc_too_small | tool.interferes | tool.no_intersection).any())


def main() -> int:
    """Run the comparison and print the figures; 1 if a vertex or an arc differs, 2 without rs274."""
    parser = argparse.ArgumentParser(description="Compare cutter compensation with LinuxCNC's rs274.")
    parser.add_argument("--rs274", default=os.environ.get("RS274") or shutil.which("rs274"), help="the binary")
    parser.add_argument("--programs", type=int, default=600, help="contours to try")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--show", action="store_true", help="print the contours on whose alarms the two differ")
    options = parser.parse_args()
    if not options.rs274:
        print("rs274 not found; give --rs274 or set RS274", file=sys.stderr)
        return 2
    chance, totals, worst = random.Random(options.seed), Counter[str](), 0.0  # noqa: S311
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(options.programs):
            contour = random_contour(chance)
            tool, other = ours(contour), theirs(contour, options.rs274, FilePath(folder))
            alarms = ("neither", "only rs274", "only polarcheck", "both")[bool(other.error) + 2 * objects(tool)]
            totals[f"programs with alarm: {alarms}"] += 1
            if alarms == "neither":
                worst = max(worst, compare(contour, tool, other, totals))
            elif alarms != "both" and options.show:
                print(contour, other.error, [int(row) for row in np.flatnonzero(tool.interferes)])
    for name in sorted(totals):
        print(f"{name:40} {totals[name]:6}")
    print(f"{'largest distance of inside vertices [mm]':40} {worst:.1e}")
    return int(any("DIFFER" in name for name in totals))


if __name__ == "__main__":
    sys.exit(main())
