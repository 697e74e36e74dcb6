"""
Where cuts run along the closed curves of a drawing; lengths in mm, in the frame of the part.

Import late: shapely takes its time.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.columns.metal.milled import Cuts
from polarcheck.foundation.arrays import Points, cached_property, side_by_side
from polarcheck.geometry.comparison.measured_path import MeasuredPath, path_of, path_of_curves
from polarcheck.geometry.comparison.metal_left import cleared_by, disc, empty, joined, polygon_of
from polarcheck.geometry.comparison.rounds import Rounds, is_cut_along, no_rounds, round_pieces, rounds_of
from polarcheck.geometry.polygons import areas

#: How far beside an edge its sides are looked at [mm].
_BESIDE = 0.02


class MilledRings:
    """
    The closed curves of a drawing beside the edges of what cuts clear.

    rings: the curves, by number. tolerance: up to this a cut runs along a curve [mm].
    """

    def __init__(self, rings: Mapping[int, Points], cuts: Cuts, tolerance: float) -> None:
        self._rings, self._cuts, self._tolerance = rings, cuts, tolerance
        self._reach = max(float(np.abs(curve).max()) for curve in rings.values())

    @cached_property
    def _edges(self) -> tuple[MeasuredPath, MeasuredPath] | None:
        """All edges, and those with the cleared area on the far side from the axis; None where nothing is cleared."""
        gone = cleared_by(self._cuts.curves, self._cuts.radius)
        lines = shapely.get_parts(shapely.boundary(gone))
        if not len(lines):
            return None
        points, of = shapely.get_coordinates(lines, return_index=True)
        corners = points @ np.array([1, 1j])
        follows = np.flatnonzero(np.diff(of) == 0)
        start, end = corners[follows], corners[follows + 1]
        middle = (start + end) / 2
        beyond = middle * (1 + _BESIDE / np.maximum(np.abs(middle), _BESIDE))
        shapely.prepare(gone)
        outward = np.asarray(shapely.contains_xy(gone, beyond.real, beyond.imag))
        number = np.arange(len(start))
        outer = path_of(start[outward], end[outward], number[outward]) if outward.any() else path_of(start, end, number)
        return path_of(start, end, number), outer

    @cached_property
    def rounds(self) -> Rounds:
        """The round of the drawing beside the cuts."""
        drawn = path_of_curves(list(self._rings.values()))
        if not (round_pieces(drawn, self._tolerance) >= 0).any() or self._edges is None:
            return no_rounds(drawn)
        return rounds_of(drawn, self._edges[1], self._tolerance)

    def is_cut(self, ring: int) -> bool:
        """A cut runs along a ring; along the outermost one from outside."""
        if self._edges is None:
            return False
        is_outermost = float(np.abs(self._rings[ring]).max()) == self._reach
        return is_cut_along(path_of_curves([self._rings[ring]]), self._edges[is_outermost], self._tolerance)

    def sectors(self, radius: float) -> Any:
        """The area within this radius that lies beyond pieces of the round along which a cut runs [mm]."""
        rounds = self.rounds
        if not rounds.milled.any() or not radius > rounds.radius:
            return empty()
        drawn = path_of_curves(list(self._rings.values()))
        far = 2 * radius / rounds.radius
        chords = side_by_side(drawn.start[rounds.milled], drawn.end[rounds.milled])
        wedges = [polygon_of(np.array([0, far * start, far * end, 0])) for start, end in chords]
        return areas.difference(areas.intersection(joined(wedges), disc(radius)), disc(rounds.radius))
