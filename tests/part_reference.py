"""
What a program does to the part: the slow and plain way, sharing no code with polarcheck.

    verdict = judge(text, radius, part)
    verdict.depth       # how deep the cutter goes into the part [mm]
    verdict.alarms      # or what the control would object to

The text is read word by word; compensation_oracle compensates one corner after the other (type A); and R minus the
distance from a move of the tool center to the part is the depth of the cut. The part lies below Z0 where its contour
does, and the tool takes away all that is above its end: a move at Z0 or higher cuts nothing.
"""

from __future__ import annotations

import math
import re
from typing import Any, NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]
from compensation_oracle import Block, Element, Move, Run, simulate

ALARMS = ("inside_arc_too_small", "interferes", "no_intersection", "movement_missing", "arc_center_on_path")

_COMMENT, _WORD = re.compile(r"\([^)]*\)"), re.compile(r"([A-Z])([-+]?[0-9]*\.?[0-9]*)")
_MOTIONS = {"G1": "line", "G2": "cw", "G3": "ccw"}
_SAGITTA = 2e-4  # [mm]
_CLEAR = 0.02  # [mm] inside the part by more than this is no rounding


class Section(NamedTuple):
    """The polar section of a program: its blocks, and for each its line and the height of the tool in it."""

    start: complex
    blocks: list[Block]
    lines: list[int]
    heights: list[float]


class Verdict(NamedTuple):
    """
    What a program does to the part.

    alarms: what the control objects to, by line; then the depths are those of a path that is never run.
    short_ramp: a ramp is shorter than R by this share; below 0 none is. contour, ramps: depth [mm] of the worst cut in
    offset mode and on ramps. line, place: of the worst. through: a block in offset mode is programmed through the part.
    wrong_side: one has the part on its tool side. other_loop: the worst cut is into what another loop has made.
    """

    alarms: dict[str, list[int]]
    short_ramp: float
    contour: float
    ramps: float
    line: int
    place: complex
    through: bool
    wrong_side: bool
    other_loop: bool

    @property
    def depth(self) -> float:
        """Of the worst cut [mm]."""
        return max(self.contour, self.ramps)


def judge(text: str, radius: float, part: Any) -> Verdict:
    """What the program does to the part with a cutter."""
    section = read_section(text, radius)
    run = simulate(section.start, section.blocks)
    alarms = {name: [section.lines[row] for row in sorted(run.alarms[name])] for name in ALARMS if name in run.alarms}
    loops = loops_of(run)
    on_arc = [
        section.lines[row] for row, element in run.elements.items() if loops[row].ramp and element.center is not None
    ]
    alarms |= {"ramp_on_arc": on_arc} if on_arc else {}
    in_mode = [element for row, element in run.elements.items() if element.side and not loops[row].ramp]
    top = 0.0 if min((section.heights[element.row] for element in in_mode), default=0.0) < 0 else math.inf
    shapely.prepare(part)
    contour, ramps, place, worst = 0.0, 0.0, 0j, None
    for move in run.moves:
        if move.phase == "CANCELLED" or section.heights[move.row] >= top:
            continue
        deepest, at = cut_of(move, radius, part)
        if deepest > max(contour, ramps):
            worst, place = move, at
        if move.phase == "OFFSET":
            contour = max(contour, deepest)
        else:
            ramps = max(ramps, deepest)
    line = 0 if worst is None else section.lines[worst.row]
    other_loop = worst is not None and _cuts_another_loop(loops, worst, place, part, in_mode)
    boundary = part.boundary
    shapely.prepare(boundary)
    through = any(_runs_inside(element, part, boundary) for element in in_mode)
    wrong = any(_on_wrong_side(element, part, boundary) for element in in_mode)
    return Verdict(alarms, _short_ramp(run, loops, radius), contour, ramps, line, place, through, wrong, other_loop)


def cut_of(move: Move, radius: float, part: Any) -> tuple[float, complex]:
    """How deep a move of the tool center cuts, below 0 if it stays clear, and where the tool center is then."""
    way = shapely.LineString([_pair(point) for point in along(move)])
    shapely.prepare(way)
    nearest = shapely.get_coordinates(shapely.shortest_line(way, part))[0]
    return radius - float(shapely.distance(part, way)), complex(*nearest)


def along(move: Move | Element) -> list[complex]:
    """Both ends of a line, and points on an arc so near to each other that a chord leaves it by 0.0002 mm at most."""
    if move.center is None:
        return [move.start, move.end]
    largest = max(abs(move.start - move.center), abs(move.end - move.center))
    count = max(math.ceil(abs(_sweep(move)) / math.sqrt(8 * _SAGITTA / largest)), 8) if largest > 1e-6 else 1
    return list(_points(move, np.linspace(0, 1, count + 1)))


def _sweep(move: Move | Element) -> float:
    center = move.center
    assert center is not None
    turn = math.tau
    if abs(move.end - move.start) > 1e-9:
        ratio = (move.end - center) / (move.start - center)
        turn = math.atan2(ratio.imag, ratio.real)
        turn = (turn if move.kind == "ccw" else -turn) % math.tau
    return turn if move.kind == "ccw" else -turn


def _points(move: Move | Element, shares: Any) -> Any:
    if move.center is None:
        return move.start + (move.end - move.start) * shares
    first, last = abs(move.start - move.center), abs(move.end - move.center)
    spoke = (move.start - move.center) / first
    return move.center + spoke * (first + (last - first) * shares) * np.exp(1j * _sweep(move) * shares)


class InLoop(NamedTuple):
    """Which start-up a block is behind, an offset cancel included, and whether it is a ramp."""

    number: int
    ramp: bool


def loops_of(run: Run) -> dict[int, InLoop]:
    """For each block that moves."""
    found, number, before = {}, 0, 0
    for row in sorted(run.elements):
        side = run.elements[row].side
        number += bool(side and not before)
        found[row] = InLoop(number, bool(side) != bool(before))
        before = side
    return found


def _short_ramp(run: Run, loops: dict[int, InLoop], radius: float) -> float:
    """How much of R the shortest ramp lacks, as a share."""
    ramps = [element for row, element in run.elements.items() if loops[row].ramp]
    return max((1 - abs(ramp.end - ramp.start) / radius for ramp in ramps), default=-math.inf)


def _cuts_another_loop(loops: dict[int, InLoop], move: Move, at: complex, part: Any, walls: list[Element]) -> bool:
    """Whether the wall of the part next to a place was programmed in another loop than the move's own."""
    wall = shapely.Point(shapely.get_coordinates(shapely.shortest_line(shapely.Point(_pair(at)), part.boundary))[-1])
    apart: dict[bool, float] = {True: math.inf, False: math.inf}
    for element in walls:
        own = loops[element.row].number == loops[move.row].number
        way = shapely.LineString([_pair(point) for point in along(element)])
        apart[own] = min(apart[own], shapely.distance(way, wall))
    return bool(apart[False] < _CLEAR < apart[True])


def _inner_points(element: Element) -> Any:
    return _points(element, np.linspace(0.04, 0.96, 24))


def _runs_inside(element: Element, part: Any, boundary: Any) -> bool:
    points = shapely.points(_inner_points(element).real, _inner_points(element).imag)
    return bool(np.any(shapely.contains(part, points) & (shapely.distance(points, boundary) > _CLEAR)))


def _on_wrong_side(element: Element, part: Any, boundary: Any) -> bool:
    """Whether a block that lies on the boundary of the part, for some way at least, has the part on its tool side."""
    points = _inner_points(element)
    on = points[shapely.distance(shapely.points(points.real, points.imag), boundary) < _CLEAR / 4]
    if len(on) < 3:
        return False
    middle = complex(on[len(on) // 2])
    normal = element.tangent(middle) * 1j * element.side * _CLEAR
    beside, other = shapely.Point(_pair(middle + normal)), shapely.Point(_pair(middle - normal))
    return bool(part.contains(beside) and not part.contains(other))


def _pair(point: complex) -> tuple[float, float]:
    return point.real, point.imag


# --- reading -----------------------------------------------------------------------------------------------------


def read_section(text: str, radius: float) -> Section:
    """The polar section of a program as the generator writes it: X a diameter, U and H and W incremental."""
    scale, x, height, inside = 1.0, 0.0, 0.0, False
    here, kind = 0j, "line"
    section = Section(0j, [], [], [])
    for line, block in enumerate(text.splitlines(), 1):
        words = [(letter, number) for letter, number in _WORD.findall(_COMMENT.sub("", block)) if number]
        codes = [f"G{float(number):g}" for letter, number in words if letter == "G"]
        values = {letter: float(number) * scale for letter, number in words if letter != "G"}
        scale = 25.4 if "G20" in codes else 1.0 if "G21" in codes else scale
        if "G12.1" in codes:
            here, inside = complex(x / 2), True
            section = section._replace(start=here)
            continue
        if "G13.1" in codes:
            break
        x, height = values.get("X", x), values.get("Z", height) + values.get("W", 0.0)
        if not inside or not words:
            continue
        kind = next((_MOTIONS[code] for code in codes if code in _MOTIONS), kind)
        end = complex(
            values["X"] / 2 if "X" in values else here.real + values.get("U", 0.0) / 2,
            values.get("C", here.imag + values.get("H", 0.0)),
        )
        center = None if kind == "line" else _center(kind, here, end, values)
        moves = center is not None or any(letter in values for letter in "XUCH")
        side = next((code for code in codes if code in ("G40", "G41", "G42")), "")
        section.blocks.append(Block(kind if moves else "none", end if moves else here, center, side, radius))
        section.lines.append(line)
        section.heights.append(height)
        here = end
    return section


def _center(kind: str, start: complex, end: complex, values: dict[str, float]) -> complex:
    if "R" not in values:
        return start + complex(values.get("I", 0.0), values.get("J", 0.0))
    chord = end - start
    across = math.sqrt(max(values["R"] ** 2 - abs(chord) ** 2 / 4, 0.0)) * math.copysign(1, values["R"])
    return start + chord / 2 + chord / abs(chord) * across * (1j if kind == "ccw" else -1j)
