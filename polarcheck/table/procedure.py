"""The procedure around a polar section: the G12.1 that begins it."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Mask, Rows
from polarcheck.machines.modal import Motion, Side
from polarcheck.table.filling import before, fill_down
from polarcheck.table.trace import Trace

#: The rotary axis, as FANUC and others name it.
_ROTARY = "C"
#: So many moves of C at feed, with one of X among them, are a contour; one alone is a groove or a position.
_MOVES_OF_CONTOUR = 2
_AT_FEED = (Motion.LINE, Motion.CW, Motion.CCW)


class Procedure:
    """Columns of one trace, one value per row."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    # ---- a contour that no G12.1 has begun ----

    @cached_property
    def contour_without_mode(self) -> Rows:
        """
        The first row above in which C moves at feed as on a contour, outside the mode and known to be so; -1 for none.

        It is a contour with G41 or G42, on an arc, or where at least two moves of C and one of X lead at feed right up
        to the row. Looked for back to the last tool change, G12.1 or G13.1, and only if a G13.1 stands outside
        sections. Beside G7.1 C is the radius of a cylinder, on which offset mode may move C.
        """
        trace = self.trace
        if not np.any(trace.switches_off & ~trace.leaves):
            return np.full(len(trace), -1)
        since = trace.changes_tool | trace.switches_off | trace.starts
        turns = self._turns & ~_happened(self._may_begin, since | trace.starts)
        turns &= trace.whole_program | trace.has_called_tool
        compensated = turns & ((trace.side != Side.OFF) | self._is_arc)
        stops = since | self._may_begin | self._leaves_work
        first = _first(compensated, since | self._may_begin, trace.starts)
        # G40 G13.1 is written for safety.
        return np.where((first < 0) & ~trace.writes_cancel, self._stretch(turns, stops), first)

    @property
    def _turns(self) -> Mask:
        """Moves of the virtual axis at feed outside sections."""
        trace, mode = self.trace, self.trace.machine.polar
        turns = trace.has(mode.virtual_axis, mode.virtual_axis_incremental) & (trace.section < 0)
        return np.asarray(turns & np.isin(trace.motion, _AT_FEED))

    @property
    def _is_arc(self) -> Mask:
        """Arcs, where the virtual axis is the rotary one: a Y axis that moves on arcs is a real one."""
        is_rotary = self.trace.machine.polar.virtual_axis == _ROTARY
        return np.isin(self.trace.motion, (Motion.CW, Motion.CCW)) & is_rotary

    @cached_property
    def _may_begin(self) -> Mask:
        """Rows that begin the mode, that of another control, a cylinder, or nobody knows what."""
        trace, mode = self.trace, self.trace.machine.polar
        foreign = [code for code in mode.on_of_other_controls if code[1:2].isdigit()]
        begins = trace.switches_on | trace.codes(*foreign) | trace.run.unknown
        return np.asarray(begins | trace.listed("cylindrical_interpolation"))

    @property
    def _leaves_work(self) -> Mask:
        """Rapid traverse, reference returns, stops between tools: a G13.1 behind them ends no contour."""
        trace = self.trace
        away = trace.listed("reference_return", "machine_coordinates")
        return np.asarray((trace.motion == Motion.RAPID) | away | trace.codes(*trace.machine.m_codes.optional_stop))

    def _stretch(self, turns: Mask, stops: Mask) -> Rows:
        """The first row of C at feed of a stretch of moves at feed up to the row, if it is a contour; else -1."""
        trace = self.trace
        if trace.machine.polar.virtual_axis != _ROTARY:
            return np.full(len(trace), -1)
        plane = turns & ~self._is_arc
        along_x = np.isin(trace.motion, _AT_FEED) & trace.has("X", "U")
        turning, moving = (before(_count(mask, stops), trace.starts, 0) for mask in (plane, along_x))
        first = _first(plane, stops, trace.starts)
        return np.where((turning >= _MOVES_OF_CONTOUR) & (moving > 0), first, -1)


def _happened(mask: Mask, ends: Mask) -> Mask:
    """Whether a row at or above is in the mask, back to the last row of `ends`."""
    return fill_down(mask, mask | ends, False).astype(bool)


def _count(mask: Mask, ends: Mask) -> Rows:
    """How many rows of the mask stand at or above, back to the last row of `ends`."""
    count = np.cumsum(mask)
    return np.asarray(count - fill_down(count, ends, 0))


def _first(mask: Mask, ends: Mask, starts: Mask) -> Rows:
    """The first row of the mask above each row, back to the last row of `ends`; -1 for none."""
    happened = before(_happened(mask, ends), starts, False)
    first = mask & (~happened | before(ends, starts, True))
    return before(fill_down(np.where(first, np.arange(len(mask)), -1), first | ends, -1), starts, -1)
