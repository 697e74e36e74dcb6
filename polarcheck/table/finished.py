"""The finished part: what contours that are programmed in offset mode leave standing at each depth of each section."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from polarcheck.arrays import Columns, Mask, Rows
from polarcheck.columns.trace import Trace
from polarcheck.table.overcuts import Overcuts, level_of

if TYPE_CHECKING:
    from polarcheck.geometry.outline import Outline
    from polarcheck.geometry.polygons.finished_part import FinishedParts
    from polarcheck.geometry.segments import Curves


class Level(NamedTuple):
    """
    What the contours at one Z of one section leave standing.

    section: its number. z: [mm], NaN where it is not known. radius: |R| of the cutter, the largest [mm]. polygon: what
    stands (shapely, mm, x and c as its x and y), with chords for arcs; empty where nothing does. open: the polygon ends
    somewhere beyond the walls, where nobody knows what the part is like. gap: what was closed [mm], 0 for none.
    tangled: the walls cross so often that they are no contour. outline: what of the polygon is programmed, as lines and
    arcs. walls: the programmed contours, leads in offset mode included; left: bool, the tool runs left of each.
    """

    section: int
    z: float
    radius: float
    polygon: Any
    open: bool
    gap: float
    tangled: bool
    outline: Outline
    walls: Curves
    left: Mask


class Finished(Columns, frozen=True):
    """The finished part of one trace."""

    trace: Trace
    overcuts: Overcuts

    @cached_property
    def levels(self) -> list[Level]:
        """
        One for each section and Z with contours in offset mode whose R is known, in the order of the program.

        Raises TooHardError where their faces cannot be computed.
        """
        return self._levels_of(*self.overcuts.walls)

    @cached_property
    def meant(self) -> list[Level]:
        """The same of contours whose R is not known, which is 0 in them: what the program is meant to make."""
        return self._levels_of(*self.overcuts.walls_of_unknown_radius)

    def _levels_of(self, walls: Curves, left: Mask) -> list[Level]:
        if not len(walls):
            return []
        from polarcheck.geometry.polygons.finished_part import Contours, finished_parts

        trace, level = self.trace, level_of(self.trace, walls)
        # Levels in the order in which the program comes to them.
        _, first, level = np.unique(level, return_index=True, return_inverse=True)
        place = np.argsort(np.argsort(first))[level]
        radius = np.zeros(len(first))
        np.maximum.at(radius, place, np.nan_to_num(np.abs(trace.compensation.radius[walls.row])))
        begins = np.flatnonzero(np.diff(walls.loop, prepend=-1))
        order = np.argsort(place[begins], kind="stable")
        loops, groups = walls.loop[begins][order], place[begins][order]
        tolerance = trace.machine.compensation.overcut_tolerance
        parts = finished_parts(Contours(walls, left, loops, groups, radius, self.overcuts.bar, tolerance, True))
        rows = [np.flatnonzero(place == number) for number in range(len(radius))]
        return [self._level(parts, number, radius, walls, left, chosen) for number, chosen in enumerate(rows)]

    def _level(self, parts: FinishedParts, number: int, radius: Any, walls: Curves, left: Mask, chosen: Rows) -> Level:
        import shapely  # type: ignore[import-untyped]

        from polarcheck.geometry.outline import outline_of

        own, shift = parts.group == number, parts.pitch * number
        row = int(walls.row[chosen[0]])
        return Level(
            section=int(self.trace.mode.section[row]),
            z=float(self.trace.path.z[row]),
            radius=float(radius[number]),
            polygon=shapely.transform(parts.polygon[number], lambda points: points - [shift, 0.0]),
            open=bool(parts.open[number]),
            gap=float(max(parts.gap[number], parts.beside[number])),
            tangled=bool(parts.tangled[number]),
            outline=outline_of(parts.start[own] - shift, parts.end[own] - shift, parts.move[own], walls),
            walls=walls[chosen],
            left=left[chosen],
        )
