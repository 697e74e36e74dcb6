"""
Finds where a section of a tool center path may run along a contour: on closed paths, and on open ones with moves to and
from them.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Container, Iterator, Sequence
from itertools import pairwise

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.reports.made_parts.tool_paths import above_the_face
from polarcheck.rewrite.compensate.chosen_sections import Section
from polarcheck.rewrite.compensate.contour_rings import Ring, rings_of
from polarcheck.rewrite.compensate.parallel import NEAR, NoContourError, contour_beside
from polarcheck.rewrite.compensate.pieces import Piece
from polarcheck.rewrite.compensate.section_moves import Move, consecutive, runs
from polarcheck.rewrite.compensate.sides import Swept, points_along, standing_share

#: A line that turns by more at its end leads to what follows [rad].
_CORNER = math.radians(60)
#: A lead-in or lead-out is looked for among this many moves at each end of a path.
_MOVES_OF_LEAD = 3
#: The least share of a wall that must lie in the bar: farther out than the path, and elsewhere.
_WALL, _LEAST = 0.5, 1e-9


class Candidate(msgspec.Struct, frozen=True):
    """
    A contour before its side is known.

    first, last: numbers of its moves.
    low, high: first and end of the moves of its run.
    ring: None for a path that does not close.
    part_sides: possible distances to the part, to the left of the path [mm]; below 0 to the right.
    fallback_sides: distances on sides where only a share of the wall remains standing.
    """

    first: int
    last: int
    low: int
    high: int
    ring: Ring | None
    part_sides: tuple[float, ...]
    fallback_sides: tuple[float, ...]

    @property
    def is_single_move(self) -> bool:
        """
        True for an open path of a single move that is its whole run: it may itself be a lead, since no move leads to
        it.
        """
        return self.ring is None and self.first == self.low == self.last == self.high - 1

    def is_inside(self, aside: float) -> bool:
        """Return True if the part would be inside the ring."""
        return self.ring is not None and self.ring.area * aside > 0


def candidates_of(trace: Trace, section: Section, swept: Swept, side: str) -> list[Candidate]:
    """
    Return the paths of a section that may have a contour beside them, in order.

    side: if it is given, both sides of a path count wherever there is a contour; otherwise only sides where a wall
    remains standing.
    """
    spans = _at_depth(trace, section.moves)
    rings = [ring for span in spans for ring in _rings(section, swept, span, bool(side))]
    # If contours close, the other paths only lead to them.
    return rings or [path for span in spans for path in _open(section, swept, span, bool(side))]


def _at_depth(trace: Trace, moves: Sequence[Move]) -> list[tuple[int, int]]:
    """Return the runs of moves at feed, without moves above the face at their start."""
    in_air = above_the_face(trace)
    result = []
    for low, high in runs(trace, moves):
        while low < high and in_air[moves[low].row]:
            low += 1
        if low < high and moves[low].feeds:
            result.append((low, high))
    return result


def uncovered(trace: Trace, section: Section, covered: Container[int]) -> Iterator[tuple[int, int]]:
    """
    Yield the first and the last move of each path at depth that is no contour and does not only lead to one.

    covered: the numbers of the moves of contours, with their ramps.
    """
    for low, high in _at_depth(trace, section.moves):
        numbers = [n for n in range(low, high) if n not in covered and not _is_in_air(section, section.moves[n].piece)]
        leads = _MOVES_OF_LEAD if any(number in covered for number in range(low, high)) else 1
        for path in consecutive(numbers):
            # Between two contours one move leads away and another one to the next.
            ends = (path[0] - 1 in covered) + (path[-1] + 1 in covered)
            if len(path) > leads * max(ends, 1):
                yield path[0], path[-1]


def _rings(section: Section, swept: Swept, run: tuple[int, int], any_side: bool) -> list[Candidate]:
    low = run[0]
    path = [section.moves[number].piece for number in range(*run)]
    result: list[Candidate] = []
    for ring in rings_of(path, section.radius, NEAR):
        first, last = low + ring.first, low + ring.last
        candidate = _candidate(section, swept, run, (first, last), ring, any_side)
        pieces = path[ring.first : ring.last + 1]
        if not any_side and len(candidate.part_sides) != 1 and _has_leads(section, pieces):
            # It closes only because it comes back to where it has left for the part.
            paths = _open(section, swept, (first, last + 1), any_side)
            if paths and all(len(path.part_sides) == 1 for path in paths):
                result += [msgspec.structs.replace(path, low=run[0], high=run[1]) for path in paths]
                continue
        result.append(candidate)
    return result


def _open(section: Section, swept: Swept, run: tuple[int, int], any_side: bool) -> list[Candidate]:
    paths = [_candidate(section, swept, run, span, None, any_side) for span in _open_spans(section, *run)]
    return [
        msgspec.structs.replace(path, part_sides=(), fallback_sides=())
        if path.is_single_move and not any_side
        else path
        for path in paths
    ]


def _candidate(
    section: Section, swept: Swept, run: tuple[int, int], span: tuple[int, int], ring: Ring | None, any_side: bool
) -> Candidate:
    """Return a candidate with the sides on which the part may be; any_side: all sides on which there is a contour."""
    path = [section.moves[number].piece for number in range(span[0], span[1] + 1)]
    whole = _from_middle(path) if ring is not None and not ring.aside else path
    both = (ring.aside,) if ring is not None and ring.aside else (section.radius, -section.radius)
    z = min(section.moves[number].ends for number in range(span[0], span[1] + 1))
    part_sides, fallback_sides = [], []
    for aside in both:
        try:
            contour = contour_beside(whole, aside)
        except NoContourError:
            continue
        share = standing_share(swept, contour, section.number, z, section.bar)
        is_outside = ring.area * aside < 0 if ring is not None else _middle(contour) > _middle(path)
        if any_side or len(both) == 1 or share >= (_WALL if is_outside else _LEAST):
            part_sides.append(aside)
        elif share:
            fallback_sides.append(aside)
    return Candidate(*span, *run, ring, tuple(part_sides), tuple(fallback_sides))


def _middle(path: Sequence[Piece]) -> float:
    """Return the mean distance of a path from the center of C [mm]."""
    return float(np.abs(points_along(path)).mean())


def _from_middle(path: Sequence[Piece]) -> list[Piece]:
    """Return a closed path that starts in the middle of its first piece."""
    first, middle = path[0], path[0].at(0.5)
    return [first.replaced(start=middle), *path[1:], first.replaced(end=middle)]


def _open_spans(section: Section, low: int, high: int) -> list[tuple[int, int]]:
    """
    Return the first and the last move of each open contour in a run.

    With a known bar, moves outside it lead to a contour or away from it. Without a bar, leads are the first and the
    last move of the section, and lines that come from farther out, or leave outward, at a corner.
    """
    pieces = [move.piece for move in section.moves[low:high]]
    leads = [_is_in_air(section, piece) for piece in pieces]
    if np.isnan(section.bar):
        arrives = [_comes_from_outside(section, *pair) for pair in pairwise(pieces)] + [False]
        backwards = [piece.back for piece in pieces]
        leaves = [False] + [_comes_from_outside(section, after, before) for before, after in pairwise(backwards)]
        is_outside = False
        for index in range(len(pieces)):
            is_outside = (is_outside or leaves[index]) and not (index and arrives[index - 1])
            leads[index] = is_outside or arrives[index]
        ends = (0, len(section.moves) - 1)
        for index in (0, len(pieces) - 1):
            leads[index] |= low + index in ends and len(pieces) > 1
    numbers = [low + index for index, is_lead in enumerate(leads) if not is_lead]
    return [(group[0], group[-1]) for group in consecutive(numbers)]


def _has_leads(section: Section, pieces: Sequence[Piece]) -> bool:
    """
    Return True if a path starts with a line that leads to it and ends with one that leads away; moves aside may precede
    them.
    """
    backwards = [piece.back for piece in reversed(pieces)]
    return all(
        any(_comes_from_outside(section, *pair) for pair in pairwise(path[:_MOVES_OF_LEAD]))
        for path in (pieces, backwards)
    )


def _comes_from_outside(section: Section, piece: Piece, following: Piece) -> bool:
    """Return True for a line that approaches the center of C by at least R and ends at a corner."""
    nearer = abs(piece.start) - abs(piece.end) >= section.radius
    turn = cmath.phase(following.leaving / (piece.arriving or 1.0)) if piece.center is None else 0.0
    return nearer and abs(turn) >= _CORNER


def _is_in_air(section: Section, piece: Piece) -> bool:
    if np.isnan(section.bar):
        return False
    shares = np.linspace(0, 1, 33).tolist()
    return min(abs(piece.at(share)) for share in shares) >= section.bar / 2 + section.radius - ROUNDING
