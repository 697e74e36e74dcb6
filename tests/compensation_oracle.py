"""
Cutter compensation the slow way: one block after the other, one corner at a time, with plain complex numbers.

Drawn from the manuals' rules as a second opinion on polarcheck.compensation; it shares no code with it.
A program is a list of blocks; what comes out is the list of moves and, by name, the blocks that raised an alarm.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

STRAIGHT = 1e-6  # [rad] a turn below this is no corner
ZERO = 1e-9  # [mm] a length below this is no movement
ROUNDING = 1e-6  # [mm] what arithmetic may shift a point by


class Block(NamedTuple):
    """One block; `kind` is "line", "cw", "ccw" or "none" (no movement in the plane)."""

    kind: str
    end: complex = 0j
    center: complex | None = None
    word: str = ""  # "G40", "G41", "G42"
    radius: float = 5.0
    vector: complex | None = None  # I + jJ beside G40
    stops: bool = False  # M00, M30, ...


class Rules(NamedTuple):
    """How the control compensates."""

    start_up: str = "A"
    start_up_moving: str = "A"
    read_ahead: int = 3
    interference: str = "alarm"
    tangent: float = 1e-3


class Move(NamedTuple):
    """One move of the tool center; `row` is the block that it belongs to."""

    row: int
    kind: str
    start: complex
    end: complex
    center: complex | None
    phase: str
    corner: bool


@dataclass
class Element:
    """A block that moves, with everything that a corner needs to know of it."""

    row: int
    kind: str
    start: complex
    end: complex
    center: complex | None
    side: int  # +1 tool on the left, -1 on the right, 0 compensation off
    radius: float

    def tangent(self, point: complex) -> complex:
        if self.center is None:
            step = self.end - self.start
            return step / abs(step)
        spoke = (point - self.center) / abs(point - self.center)
        return spoke * (1j if self.kind == "ccw" else -1j)

    def curvature(self, point: complex) -> float:
        if self.center is None:
            return 0.0
        return (1 if self.kind == "ccw" else -1) / abs(point - self.center)

    def full(self) -> bool:
        return self.center is not None and abs(self.end - self.start) <= ZERO

    def sweep(self) -> float:
        """Angle [rad] that a programmed arc turns through, up to a full turn."""
        if self.full():
            return math.tau
        turn = cmath.phase((self.end - self.center) / (self.start - self.center))
        return (turn if self.kind == "ccw" else -turn) % math.tau

    def tool_circle(self, point: complex, side: int, radius: float) -> float:
        """Radius of the tool center's circle; below zero where the tool does not fit in."""
        inside = side == (1 if self.kind == "ccw" else -1)
        return abs(point - self.center) + (-radius if inside else radius)

    def fits(self, side: int, radius: float) -> bool:
        if self.center is None or radius == 0:
            return True
        return min(self.tool_circle(p, side, radius) for p in (self.start, self.end)) > ROUNDING


@dataclass
class Run:
    """What the control has done so far."""

    blocks: list[Block]
    rules: Rules
    elements: dict[int, Element] = field(default_factory=dict)
    moves: list[Move] = field(default_factory=list)
    alarms: dict[str, set[int]] = field(default_factory=dict)

    def line(self, row: int, start: complex, end: complex, phase: str, corner: bool = False) -> None:
        if abs(end - start) > ZERO:
            self.moves.append(Move(row, "line", start, end, None, phase, corner))

    def alarm(self, name: str, row: int) -> None:
        self.alarms.setdefault(name, set()).add(row)


def simulate(start: complex, blocks: list[Block], rules: Rules = Rules()) -> Run:  # noqa: B008
    """The tool center path of one polar section."""
    run = Run(blocks, rules)
    run.elements = read_elements(start, blocks, run)
    here = start
    entry = [start]  # the vectors at the start of the coming block
    mode = left_over = False
    for row, block in enumerate(blocks):
        if row not in run.elements:
            if block.word == "G40" and mode:
                mode, left_over = False, True
                if rules.start_up == "C":
                    run.line(row, entry[-1], here, "CANCEL")
                    entry, left_over = [here], False
            first = first_element_after(run, row)
            if block.word in ("G41", "G42") and not mode and rules.start_up == "C" and first and first.side:
                vector = here + first.radius * first.side * 1j * first.tangent(here)
                run.line(row, entry[-1], vector, "START_UP")
                entry, mode = [vector], True
            continue
        element = run.elements[row]
        here = element.end
        if not element.side and not mode:
            copy(run, element, entry[-1], left_over)
            entry, left_over = [element.end], False
        elif element.side and not mode:
            entry = start_up(run, element, entry[-1])
            mode, left_over = True, False
        elif element.side:
            entry = in_mode(run, element, entry)
        else:
            entry = cancel(run, element, entry)
            mode = False
    return run


def read_elements(start: complex, blocks: list[Block], run: Run) -> dict[int, Element]:
    """The blocks that move, each with the side in force; an arc about its own start or end is taken as a line."""
    elements: dict[int, Element] = {}
    here, side = start, 0
    for row, block in enumerate(blocks):
        if block.word:
            side = {"G40": 0, "G41": 1, "G42": -1}[block.word]
        if block.kind == "none":
            continue
        kind, center = block.kind, block.center
        if center is not None and min(abs(center - here), abs(center - block.end)) <= ROUNDING:
            run.alarm("arc_center_on_path", row)
            kind, center = "line", None
        if center is None and abs(block.end - here) <= ZERO:
            continue
        signed = side if block.radius >= 0 else -side
        elements[row] = Element(row, kind, here, block.end, center, signed, abs(block.radius))
        here = block.end
    return elements


def first_element_after(run: Run, row: int) -> Element | None:
    for later in range(row + 1, len(run.blocks)):
        if later in run.elements:
            return run.elements[later]
        if run.blocks[later].word == "G40":
            return None
    return None


class Ahead(NamedTuple):
    """What stands behind a block: the next one that moves, and what the control saw on the way to it."""

    element: Element | None
    cancelled: bool
    read: bool
    written: bool


def look_ahead(run: Run, row: int) -> Ahead:
    """One block without movement counts one, a move of no length two; N - 2 are tolerated."""
    idle = 0
    read = not run.blocks[row].stops
    written = cancelled = False
    for later in range(row + 1, len(run.blocks)):
        block = run.blocks[later]
        written |= block.word in ("G41", "G42")
        if later in run.elements:
            return Ahead(run.elements[later], cancelled, read and idle <= run.rules.read_ahead - 2, written)
        cancelled |= block.word == "G40"
        idle += 1 if block.kind == "none" else 2
        read &= not block.stops
    return Ahead(None, cancelled, read, written)


# --- the four states ---------------------------------------------------------------------------------------------


def copy(run: Run, element: Element, start: complex, left_over: bool) -> None:
    if left_over and element.center is None:
        run.line(element.row, start, element.end, "CANCEL")
        return
    if left_over:
        run.line(element.row, start, element.start, "CANCEL")
    run.moves.append(Move(element.row, element.kind, element.start, element.end, element.center, "CANCELLED", False))


def start_up(run: Run, element: Element, start: complex) -> list[complex]:
    if element.center is None:
        leave = vectors_at_end(run, element, element.side, element.radius, starts_up=True)
        run.line(element.row, start, leave[0], "START_UP")
        corner_lines(run, element, leave)
        return leave
    vector = element.start + element.radius * element.side * 1j * element.tangent(element.start)
    run.line(element.row, start, vector, "START_UP")
    return in_mode(run, element, [vector])


def in_mode(run: Run, element: Element, entry: list[complex]) -> list[complex]:
    leave = vectors_at_end(run, element, element.side, element.radius, starts_up=False)
    entry, leave = along(run, element, element.side, element.radius, entry, leave)
    corner_lines(run, element, leave)
    return leave


def cancel(run: Run, element: Element, entry: list[complex]) -> list[complex]:
    if element.center is None:
        run.line(element.row, entry[-1], element.end, "CANCEL")
        return [element.end]
    former = run.elements[max(row for row in run.elements if row < element.row)]
    leave = [element.end + former.radius * former.side * 1j * element.tangent(element.end)]
    along(run, element, former.side, former.radius, entry, leave)
    run.line(element.row, leave[0], element.end, "CANCEL")
    return [element.end]


def corner_lines(run: Run, element: Element, vectors: list[complex]) -> None:
    later = look_ahead(run, element.row).element
    for start, end in pairwise(vectors):
        run.line(later.row, start, end, "OFFSET", corner=True)


# --- the block itself --------------------------------------------------------------------------------------------


def along(
    run: Run, element: Element, side: int, radius: float, entry: list[complex], leave: list[complex]
) -> tuple[list[complex], list[complex]]:
    """The move of a block between its vectors, and what the interference check makes of it."""
    kind, center = element.kind, element.center
    if not element.fits(side, radius):
        run.alarm("inside_arc_too_small", element.row)
        kind, center = "line", None
    elif backwards(element, entry[-1], leave[0]):
        if run.rules.interference == "erase":
            entry, leave = erase(run, element, entry, leave)
        elif run.rules.interference == "alarm":
            run.alarm("interferes", element.row)
        kind, center = "line", None
    if center is None:
        run.line(element.row, entry[-1], leave[0], "OFFSET")
    elif compensated_sweep(element, entry[-1], leave[0]) * abs(leave[0] - center) > ZERO:
        points = [entry[-1], leave[0]]
        # Of more than a full circle both ends alone do not tell how much it is.
        if compensated_sweep(element, *points) > math.tau and abs(points[1] - points[0]) > ZERO:
            points.insert(1, 2 * center - points[0])
        for start, end in pairwise(points):
            run.moves.append(Move(element.row, kind, start, end, center, "OFFSET", False))
    return entry, leave


def compensated_sweep(element: Element, start: complex, end: complex) -> float:
    turned = cmath.phase((end - element.center) / (element.end - element.center))
    turned -= cmath.phase((start - element.center) / (element.start - element.center))
    return element.sweep() + (turned if element.kind == "ccw" else -turned)


def backwards(element: Element, start: complex, end: complex) -> bool:
    """Does the tool center run against the program?"""
    if element.center is None:
        return ((end - start) * element.tangent(element.start).conjugate()).real < -ROUNDING
    return compensated_sweep(element, start, end) * abs(end - element.center) < -ROUNDING


def erase(
    run: Run, element: Element, entry: list[complex], leave: list[complex]
) -> tuple[list[complex], list[complex]]:
    """Drop pairs of vectors from the inside out; the last one of a corner always stays."""
    kept_entry, kept_leave = list(entry), list(leave)
    chord = element.end - element.start
    while len(kept_entry) > 1 or len(kept_leave) > 1:
        kept_entry = kept_entry[:-1] or kept_entry
        kept_leave = kept_leave[1:] or kept_leave
        if ((kept_leave[0] - kept_entry[-1]) * chord.conjugate()).real >= -ROUNDING * abs(chord):
            break
    else:
        run.alarm("interferes", element.row)
    # The corner lines at the start of the block are already drawn: take back those that led to a dropped vector.
    dropped = entry[len(kept_entry) :]
    while (
        dropped
        and run.moves
        and run.moves[-1].corner
        and run.moves[-1].row == element.row
        and run.moves[-1].end in dropped
    ):
        run.moves.pop()
    return kept_entry, kept_leave


# --- the corner --------------------------------------------------------------------------------------------------


def vectors_at_end(run: Run, first: Element, side: int, radius: float, starts_up: bool) -> list[complex]:
    """The ends of the offset vectors at the end of a block, in the order in which the tool takes them."""
    ahead = look_ahead(run, first.row)
    point = first.end
    perpendicular = [point + radius * side * 1j * first.tangent(point)]
    if ahead.element is None or ahead.cancelled:
        return perpendicular
    second = ahead.element
    if second.side and second.side != side:
        return [*perpendicular, point + radius * second.side * 1j * second.tangent(point)]
    name, vectors = known_corner(run, first, second, side, radius, starts_up, ahead.written)
    if not ahead.read:
        if name != "perpendicular":
            run.alarm("movement_missing", first.row)
        return perpendicular
    if name == "none":
        run.alarm("no_intersection", first.row)
    return vectors


def known_corner(
    run: Run, first: Element, second: Element, side: int, radius: float, starts_up: bool, written: bool
) -> tuple[str, list[complex]]:
    """The corner between two blocks that the control has both read."""
    point = first.end
    t1, t2 = first.tangent(point), second.tangent(point)
    n1, n2 = side * 1j * t1, side * 1j * t2
    perpendicular = ("perpendicular", [point + radius * n1])
    cancels = second.side == 0 and second.center is None
    type_a = (run.rules.start_up_moving if run.rules.start_up == "C" else run.rules.start_up) == "A"
    if radius == 0:
        return perpendicular
    if cancels and not starts_up and run.blocks[second.row].vector:
        return slanted_cancel(first, run.blocks[second.row].vector, side, radius) or perpendicular
    turn = cmath.phase(t2 / t1)
    if abs(turn) < STRAIGHT or (written and not starts_up and not cancels):
        return perpendicular
    angle = workpiece_angle(first, second, side, turn)
    if starts_up and (type_a or angle > 180):
        return "next", [point + radius * n2]
    if cancels and (type_a or angle > 180):
        return perpendicular
    if angle > 180:
        found = meeting_point(first, second, side, radius)
        if found is not None:
            return "meet", [found]
        too_small = not (first.fits(side, radius) and second.fits(side, radius))
        quiet = too_small or abs(turn) < run.rules.tangent
        return "both" if quiet else "none", [point + radius * n1, point + radius * n2]
    vectors = [point + radius * n1] if starts_up or first.center is not None else []
    if angle >= 90:
        vectors.append(point + radius * (n1 + n2) / (1 + (n1 * n2.conjugate()).real))
    else:
        vectors += [point + radius * (n1 + t1), point + radius * (n2 - t2)]
    if cancels or second.center is not None:
        vectors.append(point + radius * n2)
    return "outside", vectors


def workpiece_angle(first: Element, second: Element, side: int, turn: float) -> float:
    """Angle [deg] on the side of the workpiece; a full reversal is a valley or a ridge."""
    if math.pi - abs(turn) >= STRAIGHT:
        return 180 + math.degrees(side * turn)
    k1, k2 = first.curvature(first.end), second.curvature(second.start)
    return 360.0 if side * (k1 + k2) < -1e-6 * (abs(k1) + abs(k2)) else 0.0


def meeting_point(first: Element, second: Element, side: int, radius: float) -> complex | None:
    """Where the two offset curves meet, nearest to the corner."""
    point = first.end
    t1, t2 = first.tangent(point), second.tangent(point)
    curves = []
    for element, tangent in ((first, t1), (second, t2)):
        if element.center is None:
            curves.append((point + radius * side * 1j * tangent, tangent))
        elif not element.fits(side, radius):
            return None
        else:
            curves.append((element.center, element.tool_circle(point, side, radius)))
    found = meet(*curves)
    retreat = (t2 - t1).conjugate()
    return min(found, key=lambda p: abs(p - point) - 1e-6 * ((p - point) * retreat).real, default=None)


def slanted_cancel(first: Element, vector: complex, side: int, radius: float) -> tuple[str, list[complex]] | None:
    """G40 with I and J: the last offset path cut with a line of that direction through the corner, offset alike."""
    slope = vector / abs(vector)
    point = first.end
    line = (point + radius * side * 1j * slope, slope)
    if first.center is None:
        found = meet((point + radius * side * 1j * first.tangent(point), first.tangent(point)), line)
    elif first.fits(side, radius):
        found = meet((first.center, first.tool_circle(point, side, radius)), line)
    else:
        found = []
    retreat = (slope - first.tangent(point)).conjugate()
    if not found:
        return None
    return "meet", [min(found, key=lambda p: abs(p - point) - 1e-6 * ((p - point) * retreat).real)]


Curve = tuple[complex, complex | float]  # a line: point and direction; a circle: center and radius


def meet(one: Curve, two: Curve) -> list[complex]:
    """Points common to two curves."""
    if isinstance(one[1], complex) and isinstance(two[1], complex):
        across = (one[1].conjugate() * two[1]).imag
        if abs(across) < 1e-12:
            return []
        return [one[0] + one[1] * ((two[0] - one[0]).conjugate() * two[1]).imag / across]
    if isinstance(two[1], complex):
        one, two = two, one
    if isinstance(one[1], complex):
        foot = one[0] + one[1] * ((two[0] - one[0]) * one[1].conjugate()).real
        half = two[1] ** 2 - abs(two[0] - foot) ** 2
        return pair(foot, one[1], half, two[1])
    apart = abs(two[0] - one[0])
    if apart < ROUNDING:
        return []
    direction = (two[0] - one[0]) / apart
    reach = (apart**2 + one[1] ** 2 - two[1] ** 2) / (2 * apart)
    return pair(one[0] + direction * reach, 1j * direction, one[1] ** 2 - reach**2, one[1])


def pair(foot: complex, direction: complex, half_squared: float, scale: float) -> list[complex]:
    if half_squared < -1e-12 * scale**2:
        return []
    half = math.sqrt(max(half_squared, 0.0))
    return [foot - direction * half, foot + direction * half]
