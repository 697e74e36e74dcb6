"""
The contour beside a path of the tool center: parallel to it at R, its corners where the control rounds them.

Where the tool turns on the inner side of a corner the contour has a corner, too, from which the control finds that of
the path again. On the outer side the parallels cross: what lies behind the crossing bounds no part. An arc of the path
with R about a corner of the part leaves that corner alone, and so does a line across it.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import msgspec

from polarcheck.foundation.errors import PolarcheckError
from polarcheck.rewrite.compensate.pieces import Piece, meeting_points, moved_aside

#: Ends of parallels that are so near meet [mm], and an arc so small is a corner: points are written in thousandths.
NEAR = 0.003
#: A shorter stretch between two corners is one corner [mm].
_LEAST = 2e-3
#: What a line across the gap at a corner may turn the path of the tool center aside [mm].
_ASIDE = 5e-4


class NoContourError(PolarcheckError):
    """A path beside which there is no contour. move: the number of its move."""

    def __init__(self, move: int, reason: str) -> None:
        super().__init__(reason)
        self.move = move


class _Parallel(msgspec.Struct, frozen=True):
    """A parallel as it lies beside its move, and where the contour comes to it."""

    whole: Piece
    begins: complex

    def remains(self, until: complex) -> bool:
        """More than the last digit is left of it from where the contour comes to it up to a point of it."""
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
    Return the contour `aside` [mm] to the left of a path; to the right where that is negative.

    path: pieces that join. The contour begins and ends perpendicularly beside the ends of the path. Each of its pieces
    has the number of the move that it is parallel to; moves that bound no part have none.
    Raises NoContourError where two parallels do not meet, or nothing is left.
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
    """Put a parallel behind the others; those that are used up by a corner go."""
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
    """The second parallel begins ahead of the end of the first, at the inner side of a corner."""
    onward = before.arriving + following.leaving
    return ((following.start - before.end) * onward.conjugate()).real > 0


def _joint(before: Piece, following: Piece) -> complex | None:
    """Where two parallels meet, beyond their ends, too; None where they do not."""
    middle = (before.end + following.start) / 2
    apart = abs(before.end - following.start)
    has_arc = before.center is not None or following.center is not None
    if apart <= (NEAR if has_arc else 1e-7):
        return middle
    points = meeting_points(before, following)
    if not points:
        return middle if apart <= NEAR else None
    return min(points, key=lambda point: abs(point - middle))
