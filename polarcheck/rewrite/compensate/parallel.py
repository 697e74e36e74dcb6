"""
The contour beside a path of the tool center: parallel to it at distance R, with the corners that the control rounds.

On the inner side of a corner of the path, the contour has a corner, too, from which the control computes the corner of
the path again. On the outer side the parallels cross, and what lies beyond the crossing is no part of the contour. An
arc of the path with radius R about a corner of the part adds only that corner, and so does a line across it.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import msgspec

from polarcheck.foundation.errors import PolarcheckError
from polarcheck.rewrite.compensate.pieces import Piece, meeting_points, moved_aside

#: Ends of parallels within this distance meet, and an arc with no larger radius is a corner [mm]: points are written in
#: thousandths.
NEAR = 0.003
#: A stretch between two corners that is not longer than this is part of the corner [mm].
_LEAST = 2e-3
#: The most by which a line across the gap at a corner may shift the path of the tool center [mm].
_ASIDE = 5e-4


class NoContourError(PolarcheckError):
    """A path without a contour beside it. move: number of the move at fault."""

    def __init__(self, move: int, reason: str) -> None:
        super().__init__(reason)
        self.move = move


class _Parallel(msgspec.Struct, frozen=True):
    """The parallel of a move, and the point where the contour joins it."""

    whole: Piece
    begins: complex

    def remains(self, until: complex) -> bool:
        """Return True if more than the last digit of it remains between the joint and another point on it."""
        whole = self.whole
        if whole.center is None:
            return ((until - self.begins) * whole.leaving.conjugate()).real > _LEAST
        spokes = whole.start - whole.center, whole.end - whole.center
        sweep = whole.sweep - whole.turning * cmath.phase(spokes[0].conjugate() * (self.begins - whole.center))
        return (
            sweep + whole.turning * cmath.phase(spokes[1].conjugate() * (until - whole.center)) > _LEAST / whole.radius
        )


def contour_beside(path: Sequence[Piece], aside: float) -> list[Piece]:
    """
    Return the contour `aside` [mm] to the left of a path; to the right if that is negative.

    path: connected pieces. The contour starts and ends perpendicularly beside the ends of the path. Each of its pieces
    has the number of its parallel move; a move that adds nothing to the contour has no piece.
    Raises NoContourError where two parallels do not meet, or nothing remains.
    """
    contour: list[_Parallel] = []
    for piece in path:
        parallel = moved_aside(piece, aside)
        if parallel is not None and parallel.radius > NEAR:
            _join(contour, parallel, abs(aside))
    while contour and not contour[-1].remains(contour[-1].whole.end):
        contour.pop()
    if not contour:
        raise NoContourError(path[0].move, "its arcs are too small: beside them nothing is left of a contour")
    ends = [after.begins for after in contour[1:]] + [contour[-1].whole.end]
    return [element.whole.replaced(element.begins, end) for element, end in zip(contour, ends, strict=True)]


def _join(contour: list[_Parallel], following: Piece, aside: float) -> None:
    """Append a parallel to the contour, and remove previous ones of which a corner leaves nothing."""
    while contour:
        before = contour[-1]
        joint = _joint(before.whole, following)
        if joint is None and _leaves_gap(before.whole, following):
            turn = cmath.phase(following.leaving / before.whole.arriving)
            if aside * (1 - math.cos(turn / 2)) > _ASIDE:
                raise NoContourError(following.move, "beside it the contour has no corner with the move before")
            across = Piece(before.whole.end, following.start, move=following.move)
            contour += [_Parallel(across, across.start), _Parallel(following, following.start)]
            return
        if joint is None and following.length < before.whole.length:
            return
        if joint is not None and before.remains(joint):
            contour.append(_Parallel(following, joint))
            return
        contour.pop()
    contour.append(_Parallel(following, following.start))


def _leaves_gap(before: Piece, following: Piece) -> bool:
    """Return True if the second parallel starts ahead of the end of the first, on the inner side of a corner."""
    onward = before.arriving + following.leaving
    return ((following.start - before.end) * onward.conjugate()).real > 0


def _joint(before: Piece, following: Piece) -> complex | None:
    """Return the point where two parallels, extended if necessary, meet; None if they do not."""
    middle = (before.end + following.start) / 2
    apart = abs(before.end - following.start)
    has_arc = before.center is not None or following.center is not None
    if apart <= (NEAR if has_arc else 1e-7):
        return middle
    points = meeting_points(before, following)
    if not points:
        return middle if apart <= NEAR else None
    return min(points, key=lambda point: abs(point - middle))
