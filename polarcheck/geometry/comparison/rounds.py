"""
The outermost round about the axis that a drawing shows: what of it is milled, and what is turned; lengths in mm.

A round between two walls is turned as long as no cut runs along it. A curve along which a cut runs is milled whole.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, first_in_run, runs, side_by_side
from polarcheck.geometry.comparison.measured_path import MeasuredPath

#: A curve that leaves the round by no more than the tolerance and this [mm] is no wall.
_NO_WALL = 0.02
#: The arcs of a round are at least so long, and a cut that runs along them, as shares of its radius.
_LEAST_ARC, _LEAST_CUT = 0.01, 0.04
#: A curve is milled whole where no larger share of it is without a cut.
_UNCUT = 0.02
#: What chords add to the distance of a cut from a curve [mm], and to the angle between them [rad].
_CHORDS, _TURN = 0.004, 2e-3


class Rounds(NamedTuple):
    """
    The round of a drawing beside the cuts.

    radius: of the round [mm], inf for none. piece: int[segments of the drawing], the number of the piece of the round
    that each is part of, -1 for none. milled: bool[segments], those of pieces along which a cut runs. is_broken: a cut
    runs along a share of such a piece only.
    """

    radius: float
    piece: Rows
    milled: Mask
    is_broken: bool

    @property
    def turned(self) -> Mask:
        """bool[segments], those of pieces along which no cut runs."""
        return (self.piece >= 0) & ~self.milled

    @property
    def turned_radius(self) -> float:
        """The radius of what is turned [mm]; inf for nothing."""
        return self.radius if self.turned.any() else np.inf


def rounds_of(drawn: MeasuredPath, edge: MeasuredPath, tolerance: float) -> Rounds:
    """
    The round of a drawing beside the edge that cuts leave. A drawing that is nothing but a circle counts as milled, be
    it turned or not.
    """
    piece = round_pieces(drawn, tolerance)
    if not (piece >= 0).any():
        return no_rounds(drawn)
    along, points, which = _sampled(drawn)
    share = np.gradient(along)
    is_cut, is_near = runs_along(drawn, (points, which), edge, tolerance)
    count, number = int(piece.max()) + 1, piece[which]
    total, cut, near = (
        np.bincount(number[chosen], weights=share[chosen], minlength=count)
        for chosen in (number >= 0, (number >= 0) & is_cut, (number >= 0) & is_near)
    )
    reach = float(np.abs(drawn.start).max())
    is_milled = cut > np.minimum(_LEAST_CUT * reach, total / 2)
    is_broken = bool((is_milled & (near < (1 - _UNCUT) * total)).any())
    if (piece >= 0).all():
        return Rounds(np.inf, piece, np.ones(len(piece), bool), is_broken)
    return Rounds(reach, piece, (piece >= 0) & is_milled[piece], is_broken)


def no_rounds(drawn: MeasuredPath) -> Rounds:
    """Those of a drawing without a round."""
    return Rounds(np.inf, np.full(len(drawn.start), -1), np.zeros(len(drawn.start), bool), False)


def round_pieces(drawn: MeasuredPath, tolerance: float) -> Rows:
    """The number of the piece of the outermost round about the axis that each segment is part of, -1 for none."""
    middle = np.abs(drawn.start + drawn.end) / 2
    reach = float(np.abs(drawn.start).max(initial=0))
    limit = tolerance + _NO_WALL
    # A chord that is seen under a large angle is no part of an arc.
    on = (np.abs(drawn.start) >= reach - limit) & (np.abs(drawn.end) >= reach - limit) & (middle >= reach - limit)
    begins = first_in_run(drawn.of) | ~np.append(False, on[:-1])
    piece = np.where(on, np.cumsum(on & begins) - 1, -1)
    for begin, end in side_by_side(*runs(drawn.of)):
        if on[begin] and on[end] and drawn.start[begin] == drawn.end[end]:
            piece[piece == piece[end]] = piece[begin]
    length = np.abs(drawn.end - drawn.start)
    for number in range(int(piece.max(initial=-1)) + 1):
        members = np.flatnonzero(piece == number)
        if len(members) and not _is_arc(drawn, members, reach - limit / 2):
            piece[members] = -1
    is_round = length[piece >= 0].sum() > reach * _LEAST_ARC
    return piece if is_round else np.full(len(piece), -1)


def _is_arc(drawn: MeasuredPath, members: Rows, least: float) -> bool:
    """
    False for the top of a rounded corner, which comes down to the limit at both of its ends. least: [mm] from the axis.
    """
    start, end = drawn.start[members], drawn.end[members]
    first, last = ~np.isin(start, end), ~np.isin(end, start)
    ends = np.concatenate([start[first], end[last]])
    return not len(ends) or float(np.abs(ends).max()) >= least


def is_cut_along(drawn: MeasuredPath, edge: MeasuredPath, tolerance: float) -> bool:
    """A cut runs along a share of a curve that counts."""
    along, points, which = _sampled(drawn)
    is_cut, _ = runs_along(drawn, (points, which), edge, tolerance)
    size = float(np.abs(points - points.mean()).max())
    return bool(np.gradient(along)[is_cut].sum() > _LEAST_CUT * size)


def runs_along(
    drawn: MeasuredPath, places: tuple[Points, Rows], edge: MeasuredPath, tolerance: float
) -> tuple[Mask, Mask]:
    """
    The points of a drawing along which the edge runs that cuts leave: it is near, and has the same direction; and all
    points to which it is near. places: the points, and the segment of each.
    """
    points, which = places
    far, _, nearest = edge.nearest(points)
    direction, of_edge = (drawn.end - drawn.start)[which], (edge.end - edge.start)[nearest]
    turn = np.abs((direction.conj() * of_edge).imag) / np.abs(direction * of_edge)
    # A wall that lies inside of a round by more than the tolerance leaves it at a larger angle.
    size: Floats = np.maximum(np.abs(points - points.mean()), tolerance)
    is_near = far <= tolerance + _CHORDS
    return is_near & (turn <= np.sqrt(2 * tolerance / size) + _TURN), is_near


def _sampled(drawn: MeasuredPath) -> tuple[Floats, Points, Rows]:
    """Points along a drawing: their distances along it, the points, and the segment of each."""
    along = drawn.samples()
    return along, *drawn.at(along)
