"""Regular polygons that a section has cut into before another section of the same depth finishes them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, different
from polarcheck.geometry.segments import Curves
from polarcheck.geometry.tolerances import CORNER, ROUNDING

#: Walls of a contour and of what has been cut before differ by wear and rounding [mm]; C differs by rounding [deg].
_SAME_SIZE, _SAME_ANGLE = 0.05, 0.5
#: Two sections of one floor end at the same Z within this [mm].
_SAME_FLOOR = 0.2
#: A polygon larger or smaller by this share is another part of the workpiece.
_OTHER_SIZE = 0.25
#: By half of a pitch, a polygon with walls so much farther out, or that loses less of its corners, makes chamfers [mm].
_MOST_LEFT, _CHAMFER = 1.0, 0.5
#: A program with more contours than this is not searched.
_MOST_POLYGONS = 100


class Polygon(NamedTuple):
    """
    A regular polygon around X0 that is kept.

    row: int[walls]. section: its number. sides: how many. distance: of the walls from X0 [mm]. angle: of one normal in
    the frame of the part, from 0 to one pitch [deg]. reach: the farthest point of the walls from X0 [mm]. z: of the
    contour [mm]. left: metal that R leaves for another tool [mm].
    """

    row: Rows
    section: int
    sides: int
    distance: float
    angle: float
    reach: float
    z: float
    left: float


class EarlierContours(Columns, frozen=True):
    """What earlier sections have taken off the contours of one trace; rows of the later contour."""

    trace: Trace
    overcuts: Overcuts
    bar: Bar

    @cached_property
    def loss(self) -> Floats:
        """By row of a contour, how much of its corners an earlier section has cut off [mm]; 0 for nothing."""
        column = np.zeros(len(self.trace))
        for row, (_, loss) in self._hits.items():
            column[row] = loss
        return column

    def earlier(self, row: int) -> int:
        """The first row of the contour that has cut into the one of this row."""
        return self._hits[row][0]

    @cached_property
    def _hits(self) -> dict[int, tuple[int, float]]:
        """By the first row of a later contour, the first row of the earlier one, and what is lost [mm]."""
        polygons = [*self._polygons()]
        hits: dict[int, tuple[int, float]] = {}
        for number, later in enumerate(polygons):
            losses = [
                (self._loss(polygon, later), int(polygon.row[0]))
                for polygon in polygons[:number]
                if self._is_one_part(polygon, later)
            ]
            loss, row = max(losses, default=(0.0, -1))
            if loss > _SAME_SIZE:
                hits[int(later.row[0])] = row, loss
        return hits

    def _polygons(self) -> Iterator[Polygon]:
        """The polygons at the floor of each section, in the order of the program."""
        walls, left = self.overcuts.walls
        trace = self.trace
        section = trace.mode.section[walls.row]
        long = walls.is_known & ~walls.is_arc & (np.abs(walls.end - walls.start) > CORNER)
        z = trace.path.z[walls.row]
        floor = np.full(len(trace.mode.sections), np.inf)
        np.fmin.at(floor, section, z)
        long &= trace.path.knows_section_entry[section] & (z <= floor[section] + ROUNDING)
        walls, left = walls[long], left[long]
        begins = np.flatnonzero(np.diff(walls.loop, prepend=-1))
        if not 0 < len(begins) <= _MOST_POLYGONS:
            return
        for first, end in zip(begins, np.append(begins[1:], len(walls)), strict=True):
            polygon = self._polygon(walls[first:end], left[first:end])
            if polygon is not None:
                yield polygon

    def _polygon(self, walls: Curves, left: Mask) -> Polygon | None:
        """The regular polygon of the walls of one loop, leads left out."""
        along = walls.end - walls.start
        normal = along / np.abs(along) * np.where(left, 1j, -1j)
        distance = (walls.start * normal.conj()).real
        # Leads lie at other distances than the sides.
        sides = np.array([np.abs(distance - one) <= _SAME_SIZE / 2 for one in distance])
        side = sides[np.argmax(sides.sum(axis=1))]
        angle = np.degrees(np.angle(normal[side])) % 360
        directions = different(np.rint(angle / _SAME_ANGLE) * _SAME_ANGLE % 360)
        count = len(directions)
        if count < 3 or np.ptp(np.diff(directions)) > 2 * _SAME_ANGLE or distance[side][0] <= 0:
            return None
        pitch = 360 / count
        if abs(directions[1] - directions[0] - pitch) > _SAME_ANGLE:
            return None
        row, size = walls.row[side], float(distance[side].mean())
        corner = size / np.cos(np.pi / count)
        ends = np.abs(np.append(walls.start[side], walls.end[side]))
        # Leads may continue a side beyond its corners, and the bar may cut them off.
        reach = min(float(np.max(ends, initial=0.0, where=ends <= corner + _SAME_SIZE)), corner)
        if not np.isnan(self.overcuts.bar):
            reach = max(min(reach, self.overcuts.bar / 2), size)
        trace, section = self.trace, int(self.trace.mode.section[row[0]])
        turned = float(angle[0] + trace.path.section_entry[section]) % pitch
        metal_left = float(trace.offsets.metal_left[row[0]])
        return Polygon(row, section, count, size, turned, reach, float(trace.path.z[row[0]]), metal_left)

    def _is_one_part(self, earlier: Polygon, later: Polygon) -> bool:
        """Two sections finish the same part of the workpiece, and no turning tool has made another face between."""
        trace = self.trace
        first, last = int(earlier.row[0]), int(later.row[0])
        origin = trace.modal.state("work_offset")
        return bool(
            earlier.section != later.section
            and earlier.sides == later.sides
            and abs(earlier.z - later.z) <= _SAME_FLOOR
            and abs(earlier.distance / later.distance - 1) <= _OTHER_SIZE
            and trace.blocks.program[first] == trace.blocks.program[last]
            and origin[first] == origin[last]
            and trace.modal.on_sub_spindle[first] == trace.modal.on_sub_spindle[last]
            and not self.bar.tools.turns[first:last].any()
        )

    def _loss(self, earlier: Polygon, later: Polygon) -> float:
        """How far corners or walls of the later polygon lie beyond the walls of the earlier one [mm]."""
        pitch = 360 / later.sides
        # The angle between the normals, from 0 to half of a pitch.
        turn = abs((later.angle - earlier.angle + pitch / 2) % pitch - pitch / 2)
        wall = earlier.distance + earlier.left
        if turn <= _SAME_ANGLE:
            return later.distance - wall
        # The corner of the later one nearest to the normal of the earlier one.
        to_corner = np.arccos(min(later.distance / later.reach, 1.0))
        loss = float(later.reach * np.cos(max(0.0, abs(np.radians(turn) - to_corner))) - wall)
        is_smaller = earlier.distance - later.distance > _SAME_SIZE
        if turn < pitch / 2 - _SAME_ANGLE:
            is_another_tool = self.trace.tools.tool[earlier.row[0]] != self.trace.tools.tool[later.row[0]]
            return loss if is_smaller or is_another_tool else 0.0
        # Half of a pitch makes twice as many sides, or chamfers, where it is meant to.
        is_finish = is_smaller and earlier.distance - later.distance <= _MOST_LEFT
        return loss if is_finish and loss >= _CHAMFER * (later.reach - later.distance) else 0.0
