"""Where the polar mode begins and ends, as it is programmed and as it was meant."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Mask, Rows


class Marks(msgspec.Struct, frozen=True):
    """
    Per row, what tells where the mode can and cannot be on.

    on, off: the switching codes. starts: a program begins. outside: codes that can only stand outside (reference
    return). planes: a plane is selected that cannot be selected in the mode. tool_ends: tool change, program end.
    tools_in_mode: tool changes that can stand in the mode as well, of a section that its G13.1 ends.
    stops: M1, between two tools or in the work of one. rapid: G0 is written. cuts: a cutting move with a word of the
    virtual axis, or an arc without Z. moves: any move in the plane that can stand in the mode. returns: M99 of a
    program that something elsewhere may call, or what may be G13.1. broken_off: the last row of a program that a bound
    has ended. rapid_stands: G0 can stand in the mode, whose axes have addresses of their own.
    """

    on: Mask
    off: Mask
    starts: Mask
    outside: Mask
    planes: Mask
    tool_ends: Mask
    tools_in_mode: Mask
    stops: Mask
    rapid: Mask
    cuts: Mask
    moves: Mask
    returns: Mask
    broken_off: Mask
    rapid_stands: bool


class Sections(msgspec.Struct, frozen=True):
    """
    The polar sections in order, one element each.

    enter: the row of the G12.1. leave: the row of the G13.1 or, where that is missing, the first row that was meant to
    stand after it. left: whether the G13.1 is there. returned: left open by M99, for the caller to leave, or by a bound
    of the check, behind which its G13.1 may stand.
    again: rows with a G12.1 inside a section.
    """

    enter: Rows
    leave: Rows
    left: Mask
    returned: Mask
    again: Rows

    def __len__(self) -> int:
        return len(self.enter)

    @property
    def last(self) -> Rows:
        """The last row of each: its G13.1 or, where that is missing or the caller's, the row before `leave`."""
        return np.where(self.left & ~self.returned, self.leave, self.leave - 1)


def find_sections(marks: Marks) -> Sections:
    """
    A section reaches from a G12.1 to its G13.1.

    Where that was forgotten, the section ends as it was meant: before the first G0, reference return, choice of a plane
    or tool change after the last cut, so that one missing word is one fault. But G0 before any cut was meant to stand
    in the section: nobody leaves what he has just begun. Whether the G13.1 was forgotten is seen by what follows the
    last move of the virtual axis: a tool change, the end of the program, or rapid traverse before another G12.1. M1
    says so only behind a reference return: it then stands between two tools, and the G13.1 after it is one for safety.
    Where G0 can stand in the mode, one above the first cut says nothing: the G12.1 behind it is one too many.
    A caller can leave what M99 returns with, but not before a G0 that stands above it.
    """
    count = len(marks.on)
    enter = marks.on.nonzero()[0]
    if not len(enter):
        return Sections(enter, enter, np.zeros(0, bool), np.zeros(0, bool), enter)
    closers = (marks.on | marks.off | marks.starts).nonzero()[0]
    end = _first_after(closers, enter, count)
    # A program that begins with a switch, as in `O2 G12.1`, begins first of all.
    closed_by = np.append(np.select([marks.starts, marks.off], [3, 1], 2), 3)[end]
    by_off, by_on, by_end = closed_by == 1, closed_by == 2, closed_by == 3
    by_bound = by_end & marks.broken_off[end - 1]
    by_end &= ~by_bound

    last_cut = np.maximum(enter, _last_before(marks.cuts.nonzero()[0], end))
    tool_end = _first_after(marks.tool_ends.nonzero()[0], last_cut, count)
    tool_end = np.where(
        by_off, _first_after((marks.tool_ends & ~marks.tools_in_mode).nonzero()[0], last_cut, count), tool_end
    )
    outside = _first_after((marks.tool_ends | marks.outside).nonzero()[0], last_cut, count)
    rapid = _first_after((marks.tool_ends | marks.outside | marks.rapid).nonzero()[0], last_cut, count)
    if marks.rapid_stands:
        rapid = np.where(by_on & (last_cut <= enter), outside, rapid)
    # Before any cut a plane is that of the section.
    plane = np.where(last_cut > enter, _first_after(marks.planes.nonzero()[0], last_cut, count), count)
    stop = _first_after(marks.stops.nonzero()[0], outside, count)
    forgotten = ((by_off | by_bound) & (np.minimum(tool_end, stop) < end)) | by_end
    forgotten |= by_on & (np.minimum(rapid, plane) < end)
    limit = np.minimum(np.minimum(np.where(by_on, rapid, outside), plane), end)
    # Where G0 cannot stand in the mode, what follows it without the second axis is turned.
    last_move = np.maximum(enter, _last_before(marks.moves.nonzero()[0], limit))
    if not marks.rapid_stands:
        last_move = np.where(last_cut > enter, last_cut, last_move)
    repeated = np.append(False, by_on & ~forgotten)[:-1]
    final = np.append(np.flatnonzero(~repeated)[1:] - 1, len(enter) - 1)
    is_empty = (last_move <= enter) & ~repeated & ~by_on
    rapid_after = _first_after((marks.tool_ends | marks.outside | marks.rapid).nonzero()[0], last_move, count)
    intended = np.minimum(np.where(is_empty, outside, rapid_after), limit)
    last_return = _last_before(marks.returns.nonzero()[0], end)
    returned = ((forgotten & (last_return >= last_cut) & (intended > last_return)) | (by_bound & ~forgotten))[final]
    return Sections(
        enter[~repeated],
        np.where(forgotten, intended, end)[final],
        ~forgotten[final] | returned,
        returned,
        enter[repeated],
    )


def section_column(sections: Sections, count: int) -> Rows:
    """Number of the section of each row, from its G12.1 to the row before `leave`; -1 outside."""
    column = np.full(count + 1, -1, np.int64)
    step = np.zeros(count + 1, np.int64)
    np.add.at(step, sections.enter, 1)
    np.add.at(step, sections.leave, -1)
    inside = np.cumsum(step)[:count] > 0
    number = np.searchsorted(sections.enter, np.arange(count), side="right") - 1 if len(sections) else column[:count]
    return np.where(inside, number, -1)


def _first_after(rows: Rows, start: Rows, none: int) -> Rows:
    """For each of `start` the first of the sorted rows after it."""
    return np.concatenate((rows, (none,)))[rows.searchsorted(start, side="right")]


def _last_before(rows: Rows, end: Rows) -> Rows:
    """For each of `end` the last of the sorted rows before it, -1 where none is."""
    return np.concatenate(((-1,), rows))[rows.searchsorted(end)]
