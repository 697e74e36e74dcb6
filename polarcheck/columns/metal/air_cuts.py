"""
Sections and passes that take nothing off: above the metal, beside it, or where the same section has cut before.

Each reason needs a witness: the words of the section itself, the face, the bar, or the other sections of the program.
"""

from __future__ import annotations

from enum import IntEnum
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.contour.passes import numbered
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.workpiece import Workpiece
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Rows,
    States,
    cached_property,
    column_at,
    folded,
    mask_at,
)
from polarcheck.foundation.states import Motion, plain
from polarcheck.geometry.tolerances import ROUNDING

#: Z is above something if it is so by more than this [mm]: rounding of words, and finishing passes over a face.
_ABOVE = 0.01
#: An approach that stands higher shows nothing of the path: it is one of many in manuals [mm].
_FARTHEST = 10.0
#: A section at the height of its entry is in air beside others that cut below Z0, if it is as high as this [mm].
_CLEAR = 0.9
#: A cut goes far out if its end lies this many times as far from X0 as the bar, and as all before it.
_FAR_OUT = 2.0
#: Points that are nearer than this are one, and angles [mm, deg].
_SAME, _SAME_ANGLE = 2e-3, 1e-3


@plain
class Reason(IntEnum):
    """Why a section cuts nothing: NOT_IN_AIR, and the witnesses."""

    NOT_IN_AIR = 0
    DEPTH_MISSING = 1
    SIGN_WRONG = 2
    ABOVE_FACE = 3
    OTHERS_BELOW = 4
    REPEATED = 5
    OUTSIDE_BAR = 6
    BLOCKS_REPEATED = 7
    POINT_OUTSIDE = 8


class AirCuts(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    bar: Bar
    workpiece: Workpiece

    @property
    def goes_outside(self) -> Mask:
        """Rows whose end lies far outside the bar."""
        return np.asarray(self.reason == Reason.POINT_OUTSIDE)

    @property
    def is_outside_bar(self) -> Mask:
        """Rows of sections that cut nothing since they run outside the bar."""
        return np.asarray(self.reason == Reason.OUTSIDE_BAR)

    @cached_property
    def walls(self) -> Mask:
        """Rows that cut the contour: in offset mode, or all cuts of sections without compensation."""
        trace = self.trace
        compensated = (
            trace.compensation.compensates & trace.path.travels & ~trace.compensation.starts_up & ~self._lifted
        )
        bare = trace.path.cuts & trace.path.travels & ~trace.mode.anywhere_in_section(trace.compensation.compensates)
        cuts = (compensated | bare) & (trace.mode.section >= 0) & ~trace.modal.on_sub_spindle & trace.mode.is_followed
        return np.asarray(cuts & ~trace.mode.anywhere_in_section(cuts & np.isnan(trace.path.z)))

    @property
    def _lifted(self) -> Mask:
        """Rows above Z0 between two cuts of one G41 or G42, and faster than all of its cuts."""
        trace, z = self.trace, self.trace.path.z
        row: Rows = np.arange(len(trace))
        stretch: Rows = np.cumsum(trace.compensation.starts_up, dtype=np.int64)
        low = trace.compensation.compensates & trace.path.travels & (z < -_ABOVE)
        columns = (np.minimum, row, len(trace)), (np.maximum, row, -1), (np.fmax, trace.feedrate.feed, -np.inf)
        first, last, fastest = (
            folded(fold, stretch[low], values[low], int(stretch[-1]) + 1, none)[stretch]
            for fold, values, none in columns
        )
        return np.asarray((z > _ABOVE) & (first < row) & (row < last) & (trace.feedrate.feed > fastest))

    @cached_property
    def _entry(self) -> Floats:
        """Z at the G12.1 of the section of each row [mm]."""
        enter = self.trace.mode.sections.enter
        return np.append(self.trace.path.z[enter], np.nan)[self.trace.mode.section]

    @cached_property
    def approach(self) -> Floats:
        """The Z of the approach to the section of each row [mm]: that of its G12.1, or less where Z has risen to it."""
        z, before, enter = self.trace.path.z, self.trace.path.z_before, self.trace.mode.sections.enter
        moves = np.flatnonzero(np.abs(z - before) > ROUNDING)
        last = np.searchsorted(moves, enter) - 1
        row = np.append(moves, -1)[last]
        rises = (last >= 0) & (before[row] < z[enter]) & (before[row] > _ABOVE)
        return np.append(np.where(rises, before[row], z[enter]), np.nan)[self.trace.mode.section]

    def _of_section(self, values: Floats, fold: np.ufunc, none: float) -> Floats:
        """The least or largest of the values of the walls of each section, for each row of the section."""
        section, count = self.trace.mode.section, len(self.trace.mode.sections) + 1
        result = folded(fold, section[self.walls], values[self.walls], count, none)
        result[-1] = none
        return np.asarray(result[section])

    def _behind(self, mask: Mask) -> Rows:
        """The first row of the mask behind each section; -1 for none."""
        rows = np.flatnonzero(mask)
        return np.asarray(np.append(rows, -1)[np.searchsorted(rows, self.trace.mode.sections.last, side="right")])

    @cached_property
    def reason(self) -> States:
        """
        Per row a Reason, at the first cut of a section or pass that takes nothing off; at its Z where that is wrong.
        """
        trace = self.trace
        reason = np.zeros(len(trace), np.int16)
        if not self.walls.any():
            return reason
        for mask, why in (
            (self._blocks_repeated, Reason.BLOCKS_REPEATED),
            (self._point_outside, Reason.POINT_OUTSIDE),
            (self._outside_bar, Reason.OUTSIDE_BAR),
            (self._is_repeated, Reason.REPEATED),
            (self._others_below, Reason.OTHERS_BELOW),
            (self._above_face, Reason.ABOVE_FACE),
            (self._sign_wrong, Reason.SIGN_WRONG),
            (self._depth_missing | self._depth_of_pass_missing, Reason.DEPTH_MISSING),
        ):
            reason[mask & self.walls] = why
        # A bar that is too small, or another unit, is one mistake of the whole program.
        outside = np.flatnonzero(reason == Reason.OUTSIDE_BAR)
        reason[outside[1:]] = Reason.NOT_IN_AIR
        first = trace.mode.first_in_section(reason > 0)
        reason = np.where(first, reason, 0).astype(np.int16)
        for row in np.flatnonzero(reason == Reason.SIGN_WRONG).tolist():
            reason[row] = Reason.NOT_IN_AIR
            reason[row_of_infeed(trace, row)] = Reason.SIGN_WRONG
        return reason

    @cached_property
    def _lowest(self) -> Floats:
        return self._of_section(self.trace.path.z, np.minimum, np.inf)

    @cached_property
    def _idle_behind(self) -> Mask:
        """Rows behind which the next Z word, the retract in the mode or behind it, stands alone and moves nowhere."""
        trace = self.trace
        idle = (np.abs(trace.path.z - trace.path.z_before) <= ROUNDING) & ~trace.axes.moves_plane
        words = np.flatnonzero(trace.axes.commands_z)
        follows = np.append(words, -1)[np.searchsorted(words, np.arange(len(trace)), side="right")]
        return np.asarray(idle[follows] & (follows >= 0))

    @property
    def _depth_missing(self) -> Mask:
        """Z stays at its entry above Z0, nothing of Z is written before the cuts, and the retract moves nowhere."""
        trace = self.trace
        inside = trace.mode.in_polar
        still = ~trace.mode.anywhere_in_section(inside & (np.abs(trace.path.z - self._entry) > ROUNDING))
        rows = np.arange(len(trace), dtype=np.float64)
        first = self._of_section(rows, np.minimum, np.inf)
        last = self._of_section(rows, np.maximum, -1).astype(np.int64)
        earlier = trace.mode.anywhere_in_section(inside & trace.axes.commands_z & (rows < first))
        near = (self._entry > _ABOVE) & (self._entry < _FARTHEST)
        return np.asarray(still & near & self._idle_behind[last] & ~earlier)

    @property
    def _depth_of_pass_missing(self) -> Mask:
        """
        Without compensation the cut stands at the entry of its section above Z0, the retract moves nowhere, and the
        section cuts the same way at the same F below.
        """
        trace, path, section = self.trace, self.trace.path, self.trace.mode.section
        high = self.walls & self._idle_behind & (path.z > _ABOVE) & (path.z >= self._entry - ROUNDING)
        high &= ~trace.compensation.compensates & ~path.moves_z
        if not high.any():
            return high
        rows = np.flatnonzero(self.walls)
        points = path.start[rows], path.end[rows], np.nan_to_num(path.center[rows])
        # Words of thousandths lie off the limits between two numbers.
        parts = [np.rint(part / _SAME + 0.25) for point in points for part in (point.real, point.imag)]
        way = numbered([*parts, section[rows].astype(np.float64), trace.feedrate.feed[rows]])
        is_cut_below = np.bincount(way, path.z[rows] < -_ABOVE) > 0
        return high & mask_at(len(trace), rows[is_cut_below[way]])

    @property
    def _sign_wrong(self) -> Mask:
        """The cut stands above the approach of its section, above Z0, and Z goes down behind it."""
        trace = self.trace
        z, entry = trace.path.z, self.approach
        above = (z > entry + _ABOVE) & (entry > -_ABOVE) & self.walls
        if not above.any():
            return above
        # Z goes down behind it, in the section or with its first move afterwards.
        falls = z < trace.path.z_before - ROUNDING
        down, section = np.flatnonzero(falls & (trace.mode.section >= 0)), trace.mode.section
        latest = folded(np.maximum, section[down], down, len(trace.mode.sections) + 1, -1)
        behind = self._behind(np.abs(z - trace.path.z_before) > ROUNDING)
        latest[:-1] = np.maximum(latest[:-1], np.where(falls[behind], behind, -1))
        return np.asarray(above & (latest[section] > np.arange(len(trace))))

    @property
    def _above_face(self) -> Mask:
        """The face is known, and the cut stands above it; without compensation all cuts of the section do."""
        face = self.bar.known.face
        if np.isnan(face):
            return np.zeros(len(self.trace), bool)
        return np.asarray(np.where(self._is_contour, self.trace.path.z, self._lowest) > face + _ABOVE)

    @cached_property
    def _is_contour(self) -> Mask:
        """Rows in offset mode, and full circles: others without compensation may lead to the contour."""
        path = self.trace.path
        is_circle = ~np.isnan(path.center) & (np.abs(path.end - path.start) <= _SAME)
        return np.asarray(self.trace.compensation.compensates | is_circle)

    @property
    def _others_below(self) -> Mask:
        """
        The cut stands no lower than the entry of its section above Z0, and other cuts or the turning go below Z0.

        Without compensation that counts of all cuts of the section but full circles at the height of its entry: others
        may be on the way to it.
        """
        z, compensates = self.trace.path.z, self.trace.compensation.compensates
        is_at_entry = self._is_contour & (z <= self._entry + ROUNDING)
        height = np.where(compensates | is_at_entry, z, self._lowest)
        stays = (height >= self._entry - ROUNDING) & (height > _CLEAR)
        below = bool((self._lowest[self.walls] < -_ABOVE).any()) or self.bar.deepest_turned < -_ABOVE
        return np.asarray(stays & below)

    @property
    def is_cut_below(self) -> Mask:
        """Rows at whose Z with the other sign the program cuts elsewhere."""
        depths = np.sort(self.trace.path.z[self.walls])
        mirrored = -self.trace.path.z
        near = [np.searchsorted(depths, mirrored + sign * ROUNDING) for sign in (-1, 1)]
        return np.asarray((near[1] > near[0]) & (self.trace.path.z > ROUNDING))

    @property
    def _outside_bar(self) -> Mask:
        """All cuts of the section run outside the circle that holds the bar at their depth."""
        trace = self.trace
        if self.bar.known.source == "none":
            return np.zeros(len(trace), bool)
        rows = np.flatnonzero(self.walls)
        # Where G41 and G42 only correct a tool center path, the cutter reaches R farther in, too.
        reach = trace.path.moves_of(rows).nearest - self.workpiece.radius[rows]
        outside = np.nan_to_num(reach - self.bar.outer(rows, trace.path.z[rows]), nan=-np.inf)
        beyond = column_at(len(trace), rows, outside, np.inf)
        return np.asarray(self._of_section(beyond, np.minimum, np.inf) > ROUNDING)

    @property
    def _point_outside(self) -> Mask:
        """The cut goes far out of the bar, and much farther than anything before it at depth in the section."""
        trace, mask = self.trace, np.zeros(len(self.trace), bool)
        if self.bar.known.source == "none":
            return mask
        outer, size = np.full(len(trace), np.nan), np.abs(trace.path.end)
        rows = np.flatnonzero(self.walls)
        outer[rows] = self.bar.outer(rows, trace.path.z[rows])
        far = self.walls & (size > _FAR_OUT * (outer + np.nan_to_num(self.workpiece.radius)))
        is_low = trace.mode.in_polar & (trace.path.z < self.workpiece.top)
        for row in np.flatnonzero(far).tolist():
            first = int(trace.mode.sections.enter[trace.mode.section[row]])
            low = is_low[first:row]
            if low.any() and size[row] > _FAR_OUT * np.fmax.reduce(size[first:row][low]):
                mask[row] = True
                break
        return mask

    # ---- the same section again ----

    @cached_property
    def _is_repeated(self) -> Mask:
        """
        The section has been cut before at the same angle of C with the same tool, feed and depths.

        It is no spring pass: its like are cut at other angles, and not each of them as often; or a block that indexes C
        alone and moves nothing stands before it.
        """
        trace = self.trace
        repeated = np.zeros(len(trace.mode.sections) + 1, bool)
        if len(trace.mode.sections) < 2:
            return repeated[trace.mode.section]
        angle = self._angle_of_plane
        for members in self._alike:
            angles = angle[members]
            _, number, count = np.unique(angles, return_inverse=True, return_counts=True)
            later = np.array([index not in number[:position] for position, index in enumerate(number)]) == 0
            if len(count) > 1 and count.min() < count.max():
                repeated[members[later]] = True
            repeated[members[later & self._idle_index[members]]] = True
        repeated[:-1] &= trace.path.knows_section_entry
        return repeated[trace.mode.section]

    @property
    def _blocks_repeated(self) -> Mask:
        """
        The same blocks of a section, as of a subprogram or a loop, cut the same for the second time of three or more,
        and each time they write a Z: the depth was meant to grow. A spring pass is one more, and writes none; where
        sections are repeated, each may be on another bar.
        """
        trace, mask = self.trace, np.zeros(len(self.trace), bool)
        rows = np.flatnonzero(self.walls)
        block = trace.run.block[rows]
        order = np.argsort(block, kind="stable")
        again = np.append(False, np.diff(block[order]) == 0)
        if not again.any():
            return mask
        period = column_at(len(rows), order[again], order[again] - order[np.flatnonzero(again) - 1], 0)
        earlier = rows[np.arange(len(rows)) - period]
        path, section = trace.path, trace.mode.section
        apart = np.abs(path.end[rows] - path.end[earlier]) + np.abs(path.start[rows] - path.start[earlier])
        same = (period > 0) & (apart + np.abs(path.z[rows] - path.z[earlier]) <= _SAME)
        radius = trace.compensation.radius
        same &= (section[rows] == section[earlier]) & ~(np.abs(radius[rows] - radius[earlier]) > ROUNDING)
        begins = np.flatnonzero(np.diff(np.where(same, period, 0), prepend=0))
        count = np.diff(np.append(begins, len(rows)))
        repeats = same[begins] & (count >= 2 * period[begins])
        # What moves the origin or an offset may give each of them a depth of its own.
        sets = trace.blocks.listed("data_input", "local_shift", "coordinate_setting", "work_offset") | trace.run.unknown
        sets |= trace.blocks.mask_of(sorted(trace.run.assigned))
        writes_z, has_set = np.cumsum(trace.axes.commands_z), np.cumsum(sets)
        first = rows[begins[repeats]]
        origin = earlier[begins[repeats]]
        mask[first[(writes_z[first] > writes_z[origin]) & (has_set[first] == has_set[origin])]] = True
        return mask

    @property
    def _angle_of_plane(self) -> Floats:
        """The angle of the plane of each section, so that equal angles are equal numbers."""
        angle = np.rint(np.mod(self.trace.path.section_entry, 360) / _SAME_ANGLE)
        return np.mod(angle, round(360 / _SAME_ANGLE))

    @property
    def _alike(self) -> list[Rows]:
        """Sections that cut the same, relative to their planes, by tool, feed and depth; two or more of a kind."""
        trace = self.trace
        rows = np.flatnonzero(self.walls)
        section, count = trace.mode.section[rows], len(trace.mode.sections)
        moves = np.bincount(section, minlength=count)
        tool = trace.tools.tool_called[trace.mode.sections.enter]

        def sums(section: Rows, *columns: NDArray[Any]) -> list[Floats]:
            parts = [
                part
                for column in columns
                for part in ((column.real, column.imag) if np.iscomplexobj(column) else (column,))
            ]
            return [np.rint(np.bincount(section, weights=part, minlength=count) / _SAME) for part in parts]

        # Most sections differ in the number or the depth of their moves: the others alone are compared by their places.
        keys = np.stack([moves, tool, *sums(section, trace.path.z[rows] * _direction(section))], axis=1).astype(
            np.float64
        )
        alike = _groups(keys)
        if not alike:
            return []
        kept = mask_at(count, np.concatenate(alike))
        rows, section = rows[kept[section]], section[kept[section]]
        path, direction = trace.path, _direction(section)
        more = sums(
            section,
            path.start[rows],
            path.end[rows] * direction,
            np.nan_to_num(path.center[rows]) * direction,
            np.nan_to_num(trace.feedrate.feed[rows]) * direction,
            trace.axes.motion[rows] * direction,
        )
        return _groups(np.concatenate([keys, np.stack(more, axis=1)], axis=1))

    @cached_property
    def _idle_index(self) -> Mask:
        """Per section: a block of G0 and C alone stands between it and the section before, and C does not move."""
        trace = self.trace
        axis, increment = trace.machine.polar.rotary_words
        c = trace.path.c_angle
        alone = trace.blocks.has(axis) & (trace.mode.section < 0) & trace.blocks.consists_of("G", axis, increment)
        alone &= (trace.axes.motion == Motion.RAPID) & (np.abs(c - trace.path.c_angle_before) <= _SAME_ANGLE)
        idle = np.concatenate([[0], np.cumsum(alone)])
        turns = np.concatenate([[0], np.cumsum(np.abs(c - trace.path.c_angle_before) > _SAME_ANGLE)])
        enter, last = trace.mode.sections.enter, trace.mode.sections.last
        since = np.append(-1, np.minimum(last, len(trace) - 1)[:-1]) + 1
        result = (idle[enter] > idle[since]) & (turns[enter] == turns[since])
        result[:1] = False
        return np.asarray(result)


def row_of_infeed(trace: Trace, row: int) -> int:
    """The row of a section that goes to the Z of a cut, which may stand before a call; the cut where none does."""
    first = int(trace.mode.sections.enter[trace.mode.section[row]])
    infeeds = np.flatnonzero(trace.path.moves_z[first : row + 1])
    return first + int(infeeds[-1]) if len(infeeds) else row


def _direction(section: Rows) -> Rows:
    """The number of each element within its section, from 1; section rises."""
    return np.arange(1, len(section) + 1) - np.searchsorted(section, section)


def _groups(keys: Floats) -> list[Rows]:
    """The sections with equal keys, two or more of them, that cut anything."""
    _, number, count = np.unique(keys, axis=0, return_inverse=True, return_counts=True)
    number = number.ravel()
    order = np.argsort(number, kind="stable")
    groups = np.split(order, np.cumsum(count)[:-1])
    return [group for group in groups if len(group) > 1 and keys[group[0], 0] > 0]
