"""The contours that a section of a tool center path runs along, and on which side of the path each has the part."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.conversion.compensating.moves import Move, runs
from polarcheck.conversion.compensating.parallel import NEAR, NoContourError, contour_beside
from polarcheck.conversion.compensating.pieces import Piece
from polarcheck.conversion.compensating.ramps import Contour
from polarcheck.conversion.compensating.rings import Ring, rings_of
from polarcheck.conversion.compensating.sides import Swept, stands
from polarcheck.conversion.outcome import Refusal, RefusedError
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.parts.tool_paths import above_the_face

#: On which side of all paths the cutter is, seen along them: left is G41, right is G42; or where their parts are.
SIDES = ("left", "right", "part-inside", "part-outside")


class Found(msgspec.Struct, frozen=True):
    """
    A contour before its side is known.

    first, last: numbers of moves. low, high: of its run. ring: None for a path that does not close. asides: where the
    part may be, to the left of the path [mm]; below 0 to the right.
    """

    first: int
    last: int
    low: int
    high: int
    ring: Ring | None
    asides: tuple[float, ...]

    def is_inside(self, aside: float) -> bool:
        """The part would be within the ring."""
        return self.ring is not None and self.ring.area * aside > 0


class Section(msgspec.Struct, frozen=True):
    """
    A section that programs the path of the tool center.

    number: of the section. moves: of it, in order. radius: R of its cutter [mm]. bar: diameter beyond which there is no
    material [mm]; NaN where it is not known.
    """

    number: int
    moves: Sequence[Move]
    radius: float
    bar: float


def contours_of(trace: Trace, section: Section, swept: Swept, side: str) -> list[tuple[Found, Contour]]:
    """
    Return the contours of a section in order.

    side: one of SIDES where the program does not say on which side the part is; empty to see what the program says.
    Raises RefusedError where there is none, or its side is not known.
    """
    moves = section.moves
    in_air = above_the_face(trace)
    spans = [span for span in runs(trace, moves) if moves[span[0]].feeds and not in_air[moves[span[0]].row]]
    found = [each for span in spans for each in _rings(section, swept, *span, side)]
    # Beside contours that close, other ways only lead to them.
    found = found or [each for span in spans if (each := _open(section, swept, *span, side)) is not None]
    if not found:
        line = _line(trace, moves[0].row)
        raise RefusedError([Refusal(line, "nothing of its path is a contour: it does not close, or is in the air")])
    asides = _chosen(trace, section, found, side)
    result: list[tuple[Found, Contour]] = []
    for each, aside in zip(found, asides, strict=True):
        closed = each.ring is not None and not each.ring.aside and _comes_back(moves, each)
        contour = Contour(each.first, each.last, aside, closed)
        if result and _goes_on(trace, moves, result[-1][1], contour):
            before, began = result.pop()
            each = msgspec.structs.replace(each, first=before.first, low=before.low)
            contour = msgspec.structs.replace(contour, first=began.first)
        result.append((each, contour))
    return result


def _goes_on(trace: Trace, moves: Sequence[Move], before: Contour, contour: Contour) -> bool:
    """A ring begins where the one above it has ended, with so few blocks between them that compensation stays on."""
    last, first = moves[before.last], moves[contour.first]
    between = range(last.row + 1, first.row)
    stops = trace.blocks.codes(*trace.machine.m_codes.stops_reading_ahead)
    return (
        before.closed
        and contour.closed
        and before.aside == contour.aside
        and before.last + 1 == contour.first
        and abs(last.piece.end - first.piece.start) <= ROUNDING
        and len(between) <= max(trace.machine.compensation.read_ahead, 3) - 2
        and not stops[list(between)].any()
    )


def _comes_back(moves: Sequence[Move], found: Found) -> bool:
    return abs(moves[found.last].piece.end - moves[found.first].piece.start) <= NEAR


def _rings(section: Section, swept: Swept, low: int, high: int, side: str) -> list[Found]:
    path = [section.moves[number].piece for number in range(low, high)]
    result = []
    for ring in rings_of(path, section.radius, NEAR):
        first, last = low + ring.first, low + ring.last
        result.append(Found(first, last, low, high, ring, _asides(section, swept, first, last, ring, side)))
    return result


def _open(section: Section, swept: Swept, low: int, high: int, side: str) -> Found | None:
    span = _open_span(section, low, high)
    if span is None:
        return None
    return Found(*span, low, high, None, _asides(section, swept, *span, None, side))


def _asides(section: Section, swept: Swept, first: int, last: int, ring: Ring | None, side: str) -> tuple[float, ...]:
    """The sides on which the part may be: all that leave a contour where one is given; else those that stand."""
    path = [section.moves[number].piece for number in range(first, last + 1)]
    whole = _from_middle(path) if ring is not None and not ring.aside else path
    asides = (ring.aside,) if ring is not None and ring.aside else (section.radius, -section.radius)
    z = min(section.moves[number].ends for number in range(first, last + 1))
    result = []
    for aside in asides:
        try:
            contour = contour_beside(whole, aside)
        except NoContourError:
            continue
        if side or len(asides) == 1 or stands(swept, contour, section.number, z, section.bar):
            result.append(aside)
    return tuple(result)


def _from_middle(path: Sequence[Piece]) -> list[Piece]:
    """A closed path from the middle of its first piece."""
    first, middle = path[0], path[0].at(0.5)
    return [first.replaced(start=middle), *path[1:], first.replaced(end=middle)]


def _open_span(section: Section, low: int, high: int) -> tuple[int, int] | None:
    """
    The moves of a run that are a contour which does not close; None where all are in the air.

    Where the bar is known, moves outside of it lead to the contour or away from it. Else a section that begins and ends
    with a move to and from its path has its ways in and out there.
    """
    moves, first, last = section.moves, low, high - 1
    if not np.isnan(section.bar):
        while first <= last and _is_in_air(section, moves[first].piece):
            first += 1
        while last >= first and _is_in_air(section, moves[last].piece):
            last -= 1
        return (first, last) if first <= last else None
    if first == 0 and last > first:
        first += 1
    if last == len(moves) - 1 and last > first:
        last -= 1
    return first, last


def _is_in_air(section: Section, piece: Piece) -> bool:
    shares = np.linspace(0, 1, 33).tolist()
    return min(abs(piece.at(share)) for share in shares) >= section.bar / 2 + section.radius - ROUNDING


# ---- which side ----


def _chosen(trace: Trace, section: Section, found: Sequence[Found], side: str) -> list[float]:
    """The side of each contour. Raises RefusedError where it is not known."""
    if side:
        return [_given(trace, section, each, side) for each in found]
    known = {each.is_inside(each.asides[0]) for each in found if each.ring is not None and len(each.asides) == 1}
    result = []
    refusals = []
    for each in found:
        asides = each.asides
        if len(asides) != 1 and each.ring is not None and len(known) == 1:
            is_inside = next(iter(known))
            asides = tuple(aside for aside in (section.radius, -section.radius) if each.is_inside(aside) == is_inside)
        if len(asides) == 1:
            result.append(asides[0])
            continue
        options = "--side part-inside or part-outside" if each.ring is not None else "--side left or right"
        why = (
            "the part may be on both sides of this path" if asides else "metal is taken away on both sides of this path"
        )
        refusals.append(Refusal(_line(trace, section.moves[each.first].row), f"{why}: choose with {options}"))
    if refusals:
        raise RefusedError(refusals)
    return result


def _given(trace: Trace, section: Section, found: Found, side: str) -> float:
    line = _line(trace, section.moves[found.first].row)
    if side in ("left", "right"):
        aside = -section.radius if side == "left" else section.radius
    elif found.ring is None:
        raise RefusedError([Refusal(line, f"this path does not close, so that {side} says nothing: left or right")])
    else:
        aside = section.radius if found.is_inside(section.radius) == (side == "part-inside") else -section.radius
    if aside not in found.asides:
        raise RefusedError([Refusal(line, "on that side of this path is no contour: its arcs are smaller than R")])
    return aside


def _line(trace: Trace, row: int) -> int:
    return int(trace.blocks.line_in_file[row])
