"""Finds the contours that tool center paths run along, and the side of the path on which each part lies."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rewrite.compensate.candidates import Candidate, candidates_of
from polarcheck.rewrite.compensate.chosen_sections import Section
from polarcheck.rewrite.compensate.parallel import NEAR
from polarcheck.rewrite.compensate.ramp_moves import Contour
from polarcheck.rewrite.compensate.section_moves import Move
from polarcheck.rewrite.compensate.sides import Swept, points_along
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError, refusal_at, refused_at

#: The side of the cutter, the same for all paths: left is G41, right is G42; or the side of the parts.
SIDES = ("left", "right", "part-inside", "part-outside")
#: The sizes of passes round the same part differ by no more than this factor.
_SAME_SIZE = 2.0

#: The contours of a section, in order.
Chosen = list[tuple[Candidate, Contour]]


class _Path(msgspec.Struct, frozen=True):
    """
    A candidate and its section.

    frame: frame of the part.
    center: center of the ring in that frame [mm].
    size: its largest distance from the center [mm].
    """

    section: Section
    candidate: Candidate
    frame: int
    center: complex
    size: float

    def is_about_part_of(self, second: _Path) -> bool:
        """Return True if both may be passes round the same part."""
        near = abs(self.center - second.center) <= max(self.section.radius, second.section.radius)
        sizes = self.size <= _SAME_SIZE * second.size and second.size <= _SAME_SIZE * self.size
        return self.frame == second.frame and near and sizes


def contours_of(trace: Trace, sections: Sequence[Section], swept: Swept, side: str) -> list[Chosen]:
    """
    Return the contours of each section.

    side: one of SIDES if the program does not determine the side of the part; empty to take it from the program.
    Raises RefusedError where there is no contour, or its side is not known.
    """
    paths = [list(_paths(trace, section, swept, side)) for section in sections]
    rings = [path for section_paths in paths for path in section_paths if path.candidate.ring is not None]
    unambiguous = [path for path in rings if len(path.candidate.part_sides) == 1]
    refusals: list[Refusal] = []
    result = []
    for section, section_paths in zip(sections, paths, strict=True):
        part_sides = []
        for path in section_paths:
            aside = _given(trace, path, side) if side else _aside(path, unambiguous)
            if not aside:
                refusals.append(_ambiguous(trace, path))
            part_sides.append(aside)
        result.append(_joined(trace, section.moves, [path.candidate for path in section_paths], part_sides))
    if refusals:
        raise RefusedError(refusals)
    return result


def _paths(trace: Trace, section: Section, swept: Swept, side: str) -> Iterator[_Path]:
    """Yield the candidates of a section. Raises RefusedError where there is none."""
    candidates = candidates_of(trace, section, swept, side)
    if not candidates:
        text = "nothing of its path is a contour: it does not close, and has no moves to it and away from it"
        row = section.moves[0].row if section.moves else int(trace.mode.sections.enter[section.number])
        raise refused_at(trace, row, text)
    frame, turn = swept.frame_of(section.number)
    for candidate in candidates:
        pieces = [move.piece for move in section.moves[candidate.first : candidate.last + 1]]
        points = points_along(pieces) * turn
        center = complex(points.mean())
        yield _Path(section, candidate, frame, center, float(np.abs(points - center).max()))


def _joined(
    trace: Trace, moves: Sequence[Move], candidates: Sequence[Candidate], part_sides: Sequence[float]
) -> list[tuple[Candidate, Contour]]:
    """Return the contours; consecutive turns of a ring at several depths are one contour."""
    result: list[tuple[Candidate, Contour]] = []
    for candidate, aside in zip(candidates, part_sides, strict=True):
        gap = abs(moves[candidate.last].piece.end - moves[candidate.first].piece.start)
        closed = candidate.ring is not None and not candidate.ring.aside and gap <= NEAR
        contour = Contour(candidate.first, candidate.last, aside, closed)
        if result and _goes_on(trace, moves, result[-1][1], contour):
            before, began = result.pop()
            candidate = msgspec.structs.replace(candidate, first=before.first, low=before.low)
            contour = msgspec.structs.replace(contour, first=began.first)
        result.append((candidate, contour))
    return result


def _goes_on(trace: Trace, moves: Sequence[Move], before: Contour, contour: Contour) -> bool:
    """
    Return True if a ring starts where the previous one ends, with so few blocks between them that compensation stays
    on.
    """
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


# ---- which side ----


def _aside(path: _Path, unambiguous: Sequence[_Path]) -> float:
    """
    Return the distance of the contour to the left of a path [mm]; 0 if its side is not known.

    All passes round the same part have it on the same side. If the side of a ring is ambiguous, rings round the same
    part decide, then the other rings of the section, then those of the program.
    """
    candidate, radius = path.candidate, path.section.radius
    if candidate.ring is None:
        sides = candidate.part_sides or candidate.fallback_sides
        return sides[0] if len(sides) == 1 else 0.0
    if len(candidate.part_sides) == 1:
        return candidate.part_sides[0]
    groups = (
        [ring for ring in unambiguous if path.is_about_part_of(ring)],
        [ring for ring in unambiguous if ring.section is path.section],
        unambiguous,
    )
    for group in groups:
        is_inside = {ring.candidate.is_inside(ring.candidate.part_sides[0]) for ring in group}
        if len(is_inside) == 1:
            inner = radius if candidate.is_inside(radius) else -radius
            return inner if is_inside.pop() else -inner
        if is_inside:
            return 0.0
    return candidate.fallback_sides[0] if len(candidate.fallback_sides) == 1 and not candidate.part_sides else 0.0


def _ambiguous(trace: Trace, path: _Path) -> Refusal:
    candidate = path.candidate
    options = "--side part-inside or part-outside" if candidate.ring is not None else "--side left or right"
    why = "no side of this path is known to be the part: metal is taken away there, or arcs are smaller than R"
    if candidate.is_single_move:
        why = "no other move leads to this one and away from it"
    elif candidate.part_sides:
        why = "the part may be on both sides of this path"
    return refusal_at(trace, path.section.moves[candidate.first].row, f"{why}: choose with {options}")


def _given(trace: Trace, path: _Path, side: str) -> float:
    """
    Return the distance to the left of a path [mm] that --side asks for. Raises RefusedError where there is no contour.
    """
    section, candidate = path.section, path.candidate
    row = section.moves[candidate.first].row
    if side in ("left", "right"):
        aside = -section.radius if side == "left" else section.radius
    elif candidate.ring is None:
        raise refused_at(trace, row, f"this path does not close, so that {side} says nothing: left or right")
    else:
        aside = section.radius if candidate.is_inside(section.radius) == (side == "part-inside") else -section.radius
    if aside not in candidate.part_sides:
        raise refused_at(trace, row, "on that side of this path is no contour: its arcs are smaller than R")
    return aside
