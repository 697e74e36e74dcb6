"""
Moves of the polar plane in spans along which the distance from the center only grows or only falls.

Points are complex, x + 1j*c [mm, X as a radius]. A place on a span is its share t of the way, 0 to 1.
"""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, Table, cached_property
from polarcheck.geometry.plane import arc_sweep, cross, dot, quiet

#: Points of a span at which density and turn are evaluated.
PLACES = 33


class Spans(Table, frozen=True, dict=True):
    """
    One element per span, in the order of the moves.

    move: the move that it belongs to. start, end: plane points; exactly 0 at the center of C. first, last: its share of
    the way of the move. center: of an arc, NaN for lines. sweep: of an arc about its center [rad], 0 for lines. An arc
    whose end is a little off its circle comes evenly nearer to its center, or away from it.
    """

    move: Rows
    start: Points
    end: Points
    first: Floats
    last: Floats
    center: Points
    sweep: Floats

    @cached_property
    def is_arc(self) -> Mask:
        return ~np.isnan(self.center)

    @cached_property
    def length(self) -> Floats:
        """Way [mm]."""
        return np.where(
            self.is_arc, np.abs(self.start - self.center) * np.abs(self.sweep), np.abs(self.end - self.start)
        )

    def share(self, span: Rows, shares: Floats) -> Floats:
        """Shares of the length of the move, from shares of the length of these spans."""
        return np.asarray(self.first[span] + (self.last - self.first)[span] * shares)

    def points(self, shares: Floats) -> Points:
        """
        Plane points at these shares of the length of each span, float64[spans, n].

        The ends are `start` and `end` exactly.
        """
        start, end = self.start[:, None], self.end[:, None]
        center = self.center[:, None]
        points = start + (end - start) * shares
        arcs = self.is_arc
        if arcs.any():
            grown = (1 + (self._growth[:, None] - 1) * shares)[arcs]
            points[arcs] = center[arcs] + (start - center)[arcs] * grown * np.exp(
                1j * self.sweep[arcs, None] * shares[arcs]
            )
        return np.where(shares == 0, start, np.where(shares == 1, end, points))

    def directions(self, shares: Floats) -> Points:
        """Directions of travel, of length 1."""
        direction = np.broadcast_to((self.end - self.start)[:, None], shares.shape).copy()
        arcs = self.is_arc
        if arcs.any():
            spoke = (self.start - self.center)[arcs, None] * np.exp(1j * self.sweep[arcs, None] * shares[arcs])
            direction[arcs] = spoke * np.where(self.sweep[arcs, None] > 0, 1j, -1j)
        return np.asarray(direction / np.abs(direction))

    @cached_property
    def _growth(self) -> Floats:
        """Radius of an arc at its end by that at its start."""
        return np.abs(self.end - self.center) / np.abs(self.start - self.center)

    @property
    def bend(self) -> Floats:
        """Curvature, above 0 to the left [1/mm]."""
        radius = np.abs(self.start - self.center)
        return np.where(self.is_arc, np.sign(self.sweep) / radius, 0.0)


@quiet
def spans_of(start: Points, end: Points, center: Points, kind: States, at_center: float, level: float = 0.0) -> Spans:
    """
    Divide moves where they are nearest to the center of C and farthest from it. Moves without a length have no span.

    at_center: a path that comes nearer to the center than that goes through it [mm]. level: a move is not divided where
    it is nearer than both of its ends, or farther, by no more than that [mm]: the distance hardly changes there.
    """
    sweep = arc_sweep(start, end, center, kind)
    is_arc = sweep != 0
    center = np.where(is_arc, center, complex("nan+nanj"))
    vector = end - start
    foot = -dot(start, vector) / np.abs(vector) ** 2
    near, far = (_share(start - center, sweep, side * center) for side in (-1, 1))
    around = np.abs(center) <= at_center
    radius = np.abs(start - center)
    nearest = np.where(is_arc, np.abs(np.abs(center) - radius), np.abs(cross(start, vector)) / np.abs(vector))
    dips = (np.minimum(np.abs(start), np.abs(end)) - nearest > level) | (nearest <= at_center)
    rises = np.abs(center) + radius - np.maximum(np.abs(start), np.abs(end)) > level
    shares = np.stack(
        (
            np.zeros(len(start)),
            np.where(dips & ~(is_arc & around), np.where(is_arc, near, foot), np.nan),
            np.where(is_arc & ~around & rises, far, np.nan),
            np.ones(len(start)),
        ),
        axis=1,
    )
    shares = np.sort(np.where((shares >= 0) & (shares <= 1), shares, np.nan), axis=1)  # NaN stands last
    move, index = np.nonzero(~np.isnan(shares[:, 1:]))
    first, last = shares[move, index], shares[move, index + 1]
    reach = np.abs(vector) + np.abs(sweep) * np.where(is_arc, np.abs(start - center), 0)
    has_way = (last - first) * reach[move] > 1e-9
    move, first, last = move[has_way], first[has_way], last[has_way]
    whole = Spans(move, start[move], end[move], first, last, center[move], sweep[move])
    ends = whole.points(np.stack((first, last), axis=1))
    ends[np.abs(ends) <= at_center] = 0
    return Spans(move, ends[:, 0], ends[:, 1], first, last, center[move], sweep[move] * (last - first))


def _share(spoke: Points, sweep: Floats, direction: Points) -> Floats:
    """Where an arc from a spoke on passes a direction from its center, as a share of its way; above 1: nowhere."""
    turn = np.sign(sweep) * np.arctan2(cross(spoke, direction), dot(spoke, direction))
    return np.asarray((turn + 2 * np.pi * (turn < 0)) / np.abs(sweep))


@quiet
def places(spans: Spans) -> Floats:
    """
    Shares of the way, float64[spans, PLACES], closer to each other near the center of C.

    With s the way from the end that is nearer to the center, at the distance m, they are even in arsinh(s / m): a line
    that runs by the center turns C about evenly in that, however near it passes.
    """
    near = np.minimum(np.abs(spans.start), np.abs(spans.end))
    near = np.maximum(near, 1e-6 * spans.length)[:, None]
    length = spans.length[:, None]
    shares = near / length * np.sinh(np.linspace(0, 1, PLACES)[None, :] * np.arcsinh(length / near))
    shares[:, 0], shares[:, -1] = 0, 1
    falls = np.abs(spans.end) < np.abs(spans.start)
    return np.where(falls[:, None], 1 - shares[:, ::-1], shares)
