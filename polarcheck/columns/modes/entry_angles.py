"""The angle of C at which each section begins: where nobody has positioned it, and where it has no effect."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.modes.spindles import Spindles
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, cached_property
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.machines.code_lists import FRAME_LISTS

#: Angles that are nearer than this are one [deg]: the last point of a section is rounded.
_SAME_ANGLE = 0.2
#: Points of a contour nearer than this [mm] are one.
_SAME = 0.02
#: A section of more moves is compared with nothing.
_MOST_MOVES = 2000
#: The lists of codes that change the zero.
_ZEROS = ("work_offset", "work_offset_extended", "data_input", "coordinate_setting")
#: A contour without compensation begins within so many moves.
_MOST_LEADS = 20


class EntryAngles(Columns, frozen=True):
    """One value per polar section."""

    trace: Trace
    spindles: Spindles

    @cached_property
    def turned_by(self) -> Floats:
        """
        Difference of C at the G12.1 from its angle at the G12.1 before [deg], where no block has positioned C.

        NaN where it is the same, where C was positioned, or where the cut is the same turned by that angle.
        Only where the plane begins at the switch, and both sections cut.
        """
        trace, sections = self.trace, self.trace.mode.sections
        turned = np.full(len(sections), np.nan)
        if len(sections) < 2 or trace.machine.polar.zero_angle != "at-switch":
            return turned
        enter = sections.enter
        last = np.minimum(sections.last, len(trace) - 1)
        places = last_row(trace.path.travels & trace.mode.in_polar, trace.mode.enters)
        row = places[np.maximum(last - 1, 0)]
        row = np.where(trace.path.travels[last] & trace.mode.in_polar[last], last, row)
        end = np.where(row >= 0, trace.path.end[row], np.nan)
        begin = trace.path.end[enter]
        with np.errstate(invalid="ignore", divide="ignore"):
            angle = np.degrees(np.angle(end / begin))
        angle = np.where(np.minimum(np.abs(end), np.abs(begin)) > ROUNDING, angle, np.nan)
        settled = np.append(0, np.cumsum(self._positions))
        cuts = trace.mode.count_in_section(trace.path.cuts) > 0
        same = np.zeros(len(sections), bool)
        same[1:] = (
            (settled[enter[1:]] == settled[last[:-1]])
            & (trace.blocks.program[enter[1:]] == trace.blocks.program[enter[:-1]])
            & cuts[1:]
            & cuts[:-1]
            & (sections.left & ~sections.returned)[:-1]
            & trace.mode.rotary_is_followed[enter[1:]]
            & ~trace.mode.enters_with_direction[enter[1:]]
            & trace.mode.rotary_is_followed[enter[:-1]]
        )
        before = np.append(np.nan, angle[:-1])
        for number in np.flatnonzero(same & (np.abs(before) > _SAME_ANGLE)).tolist():
            if not self._is_invariant(number, float(before[number])):
                turned[number] = before[number]
        return turned

    @cached_property
    def without_effect(self) -> Floats:
        """
        C before the section less C before the section before [deg], where both cut the same contour at one place, as C
        does not turn the plane. NaN elsewhere, and where the contour turned by that angle is the same.

        Not where a frame, another zero or a block of unknown effect stands between them: that may turn the plane.
        """
        trace, sections = self.trace, self.trace.mode.sections
        found = np.full(len(sections), np.nan)
        if len(sections) < 2 or not trace.machine.polar.plane_is_fixed:
            return found
        enter, last = sections.enter, np.minimum(sections.last, len(trace) - 1)
        turns_zero = trace.blocks.listed(*_ZEROS, *FRAME_LISTS) | trace.run.unknown | trace.blocks.starts
        may_turn, positioned = np.cumsum(turns_zero), np.cumsum(self._names_c)
        turn = np.mod(np.diff(trace.path.c_angle[enter]) + 180, 360) - 180
        tool = trace.tools.tool[enter]
        chosen = (positioned[enter] > positioned[np.append(0, last[:-1])])[1:] & (tool[1:] == tool[:-1])
        chosen &= (may_turn[enter[1:]] == may_turn[enter[:-1]]) & (np.abs(turn) > _SAME_ANGLE)
        unread = np.sort([remark.block for remark in trace.run.remarks if remark.kind == "not-simulated"])
        block = trace.run.block
        behind, ahead = (np.searchsorted(unread, block[rows]) for rows in (last[:-1], enter[1:]))
        chosen &= behind == ahead
        for number in np.flatnonzero(chosen).tolist():
            if self._are_same(number, number + 1) and not self._is_invariant(number + 1, float(turn[number])):
                found[number + 1] = turn[number]
        return found

    def _are_same(self, one: int, other: int) -> bool:
        """Both sections cut the same moves, at the same heights."""
        trace = self.trace
        rows = [np.flatnonzero(trace.path.cuts & (trace.mode.section == number)) for number in (one, other)]
        if len(rows[0]) != len(rows[1]) or not 0 < len(rows[0]) <= _MOST_MOVES:
            return False
        pairs = [(column[rows[0]], column[rows[1]]) for column in (trace.path.start, trace.path.end, trace.path.z)]
        same_kind = np.array_equal(trace.axes.motion[rows[0]], trace.axes.motion[rows[1]])
        return same_kind and all(bool(np.all(np.abs(here - there) <= _SAME)) for here, there in pairs)

    @property
    def _names_c(self) -> Mask:
        """Rows outside the mode that position C."""
        trace = self.trace
        return trace.blocks.has(*trace.machine.polar.rotary_words) & trace.modal.uses_axes & (trace.mode.section < 0)

    @property
    def _positions(self) -> Mask:
        """Rows outside the mode in which C is positioned, lost, or may be."""
        trace = self.trace
        named = trace.blocks.has(*trace.machine.polar.rotary_words) & (trace.mode.section < 0)
        codes = trace.machine.m_codes
        lost = trace.blocks.codes(*codes.spindle_on, *codes.sub_spindle_on, *codes.c_axis_off, *codes.sub_c_axis_off)
        lost = lost | self.spindles.engages_c_axis | trace.run.unknown | trace.blocks.moves_unnamed
        return np.asarray((named | lost | trace.blocks.starts) & (trace.mode.section < 0))

    def _is_invariant(self, number: int, angle: float) -> bool:
        """The cut of a section is the same turned by this angle [deg]."""
        trace = self.trace
        rows = np.flatnonzero(trace.path.cuts & (trace.mode.section == number))
        if len(rows) > _MOST_MOVES:
            return True
        compensated = rows[(trace.compensation.compensates & ~trace.compensation.starts_up)[rows]]
        rows = compensated if len(compensated) else _ring(rows, trace.path.start[rows], trace.path.end[rows])
        start, end, center = trace.path.start[rows], trace.path.end[rows], trace.path.center[rows]
        if len(rows) and np.all(np.abs(center) <= _SAME):
            return True
        turn = np.exp(-1j * np.radians(angle))
        return all(_maps(of, of * turn) for of in (_corners(start, end, center), center[~np.isnan(center)]))


def _corners(start: Points, end: Points, center: Points) -> Points:
    """The ends of moves, without those at which a line goes straight on; of a closed path the last goes on first."""
    if len(end) and np.abs(end[-1] - start[0]) > _SAME:
        return np.append(start[:1], end)
    is_line = np.isnan(center)
    with np.errstate(invalid="ignore", divide="ignore"):
        direction = (end - start) / np.abs(end - start)
    goes_on = is_line & np.roll(is_line, -1) & (np.abs(np.roll(direction, -1) - direction) <= _SAME)
    return end[~goes_on]


def _ring(rows: Rows, start: Points, end: Points) -> Rows:
    """The longest closed part of a path, without leads that come back the same way; the whole path where none is."""
    while len(rows) > 2 and abs(start[0] - end[-1]) <= _SAME and abs(end[0] - start[-1]) <= _SAME:
        rows, start, end = rows[1:-1], start[1:-1], end[1:-1]
    places = np.append(start[:1], end)
    begins, length = 0, 0
    for first in range(min(len(rows), _MOST_LEADS)):
        again = np.flatnonzero(np.abs(places[first + 1 :] - places[first]) <= _SAME)
        if len(again) and int(again[-1]) + 1 > length:
            begins, length = first, int(again[-1]) + 1
    return rows[begins : begins + length] if length else rows


def _maps(points: Points, turned: Points) -> bool:
    """Each of the turned points is one of the points."""
    return not len(points) or bool(np.all(np.abs(turned[:, None] - points[None, :]).min(axis=1) <= _SAME))
