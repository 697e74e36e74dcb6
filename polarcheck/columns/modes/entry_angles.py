"""The angle of C at which each section begins, where C was not positioned since the section before."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.modes.spindles import Spindles
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, cached_property
from polarcheck.geometry.tolerances import ROUNDING

#: Angles that are nearer than this are one [deg]: the last point of a section is rounded.
_SAME_ANGLE = 0.2
#: Points of a contour nearer than this [mm] are one.
_SAME = 0.02
#: A section of more moves is compared with nothing.
_MOST_MOVES = 2000
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
    """The longest closed part of a path; the whole path where none closes."""
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
