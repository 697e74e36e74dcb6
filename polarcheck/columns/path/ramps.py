"""How cutter compensation begins and ends in the polar mode, and which of its faults are consequences of others."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, column_at, folded
from polarcheck.foundation.states import Side
from polarcheck.geometry.tolerances import ROUNDING


class Ramps(Columns, frozen=True):
    """Columns of one trace, one value per row. A ramp is a start-up or an offset cancel."""

    trace: Trace
    tool_center: ToolCenter

    # ---- how far a fault reaches ----

    @cached_property
    def loop(self) -> Rows:
        """Number of the loop of each row of a section: from its start-up, or G12.1, to the next; -1 outside."""
        trace = self.trace
        return np.where(trace.mode.whole_section >= 0, np.cumsum(trace.compensation.starts_up | trace.mode.enters), -1)

    @cached_property
    def pause(self) -> Rows:
        """The same number for a move on the plane and the rows after it that do not move there; -1 outside sections."""
        moves = self.trace.mode.in_polar & self.trace.path.travels
        return np.where(self.trace.mode.whole_section >= 0, np.cumsum(moves), -1)

    @cached_property
    def way(self) -> Rows:
        """The same number for a move on the plane and the rows that lead up to it; -1 outside sections."""
        moves = self.trace.mode.in_polar & self.trace.axes.moves_plane
        return np.where(self.trace.mode.whole_section >= 0, np.cumsum(moves) - moves, -1)

    @cached_property
    def mesh(self) -> Rows:
        """The section of moves that do not fit because of the rounding of their ends; -1 for other rows."""
        return np.where(self.tool_center.interferes_by_rounding, self.trace.mode.whole_section, -1)

    @cached_property
    def narrow_loop(self) -> Rows:
        """As loop, for what does not fit there; -1 for moves that do not fit because of their rounding alone."""
        return np.where(self.tool_center.interferes_by_rounding, -1, self.loop)

    @cached_property
    def start_up_ahead(self) -> Rows:
        """The same number for a start-up and the rows of its section that lead up to it; -1 outside sections."""
        trace = self.trace
        number: Rows = np.cumsum(trace.compensation.starts_up | trace.mode.enters) - trace.compensation.starts_up
        return np.where(trace.mode.whole_section >= 0, number, -1)

    # ---- start-up and offset cancel ----

    @cached_property
    def start_up_missing(self) -> Mask:
        """G41 or G42 after which nothing moves on the plane before G40 or the end of the mode."""
        trace = self.trace
        return self._without_move(
            self._begins_at_rest, trace.compensation.writes_cancel | ~trace.mode.in_polar, trace.compensation.starts_up
        )

    @cached_property
    def start_up_later(self) -> Mask:
        """G41 or G42 without a move on the plane, alone or with Z; the next one there is the start-up."""
        return self._begins_at_rest & ~self.start_up_missing

    @cached_property
    def _begins_at_rest(self) -> Mask:
        trace = self.trace
        begins = (
            trace.mode.in_polar
            & trace.compensation.writes_side
            & ~trace.path.travels
            & (trace.compensation.side_before == Side.OFF)
        )
        return np.asarray(begins & ~trace.compensation.offset_mode)

    @cached_property
    def cancel_missing(self) -> Mask:
        """A G40 after which nothing moves on the plane before the mode is left or compensation begins again."""
        trace = self.trace
        ends = trace.compensation.writes_cancel & ~trace.path.travels & (trace.compensation.side_before != Side.OFF)
        return self._without_move(
            ends & trace.compensation.offset_mode,
            trace.compensation.writes_side | ~trace.mode.in_polar,
            trace.compensation.cancels,
        )

    def _without_move(self, rows: Mask, ends: Mask, ramp: Mask) -> Mask:
        """Rows after which a row of `ends` comes before any ramp move or row of unknown effect."""
        if not rows.any():
            return rows
        trace = self.trace
        ramp = ramp | trace.run.unknown
        events = np.flatnonzero(trace.path.travels | ends | ramp)
        index = np.flatnonzero(rows)
        next_event = np.append(events, len(trace))[np.searchsorted(events, index, side="right")]
        return column_at(len(trace), index, ~np.append(ramp, False)[next_event], False)

    @cached_property
    def shorter_than_radius(self) -> Mask:
        """The row moves, and less than R on the plane."""
        trace = self.trace
        return np.asarray(trace.path.travels & (trace.path.length < np.abs(trace.compensation.radius) - ROUNDING))

    @cached_property
    def suffices_for_smaller_cutter(self) -> Mask:
        """The row is long enough for a cutter that fits into the inside arcs of its loop, which R does not."""
        tight = np.flatnonzero(self.tool_center.inside_arc_too_small & (self.loop >= 0))
        if not len(tight):
            return self.trace.blocks.nowhere
        largest = folded(np.fmin, self.loop[tight], self.arc_radius[tight], int(self.loop.max(initial=0)) + 1, np.nan)
        return np.asarray((self.loop >= 0) & (self.trace.path.length >= largest[self.loop]))

    @cached_property
    def start_up_judged_by_radius(self) -> Mask:
        """Start-ups that nothing can be said of without R: straight ones."""
        return np.asarray(self.trace.compensation.starts_up & ~self.trace.path.is_arc)

    @cached_property
    def cancel_judged_by_radius(self) -> Mask:
        """Offset cancels likewise."""
        return np.asarray(self.trace.compensation.cancels & ~self.trace.path.is_arc)

    @cached_property
    def used(self) -> Floats:
        """R as a share of the length of the ramp move, 1 where it just suffices; NaN for other or unknown rows."""
        trace = self.trace
        is_ramp = (trace.compensation.starts_up | trace.compensation.cancels) & (trace.path.length > 0)
        used = np.full(len(trace), np.nan)
        np.divide(np.abs(trace.compensation.radius), trace.path.length, out=used, where=is_ramp)
        return used

    # ---- in offset mode ----

    @cached_property
    def writes_side_again(self) -> Mask:
        """G41 or G42 in offset mode while one of them is in force."""
        trace = self.trace
        in_force = (trace.compensation.side != Side.OFF) & (trace.compensation.side_before != Side.OFF)
        return np.asarray(trace.compensation.offset_mode & in_force & trace.compensation.writes_side)

    @cached_property
    def compensated(self) -> Mask:
        """Moves on the plane with compensation in force."""
        return np.asarray(self.trace.compensation.compensates & self.trace.path.travels)

    @cached_property
    def arc_radius(self) -> Floats:
        """Radius of an arc [mm], the smaller one where start and end differ."""
        trace = self.trace
        return np.minimum(np.abs(trace.path.start - trace.path.center), np.abs(trace.path.end - trace.path.center))

    @cached_property
    def tight_arc(self) -> Rows:
        """The same number for arcs of one radius in a section, too small for the same R; -1 for other rows."""
        trace, number = self.trace, np.full(len(self.trace), -1)
        rows = np.flatnonzero(self.tool_center.inside_arc_too_small)
        if len(rows):
            sizes = np.stack(
                (trace.mode.section[rows], self.arc_radius[rows].round(2), trace.compensation.radius[rows])
            )
            number[rows] = np.unique(sizes, axis=1, return_inverse=True)[1].reshape(-1)
        return number

    @cached_property
    def is_consequence(self) -> Mask:
        """
        Moves whose interference or missing intersection, if there is one, is the consequence of another fault.

        Of neighbouring moves that do not fit the first counts: what follows hangs on it, unless rounding is all that is
        wrong with the first. An arc that is too small, a
        ramp on an arc, and another G41 or G42 have rules of their own, and explain what does not fit beside them.
        """
        trace, tool_center = self.trace, self.tool_center
        moving = np.flatnonzero(trace.path.travels)
        on_arc = trace.path.is_arc & (trace.compensation.starts_up | trace.compensation.cancels)
        cause = (tool_center.inside_arc_too_small | on_arc | self.writes_side_again)[moving]
        interferes = tool_center.interferes & ~tool_center.interferes_by_rounding
        first = np.flatnonzero(cause | (tool_center.no_intersection | interferes)[moving])
        hangs = cause.copy()
        if len(first):
            rows = np.arange(len(moving))
            above = first[np.maximum(np.searchsorted(first, rows) - 1, 0)]
            near = np.diff((tool_center.stretch[moving][above], tool_center.stretch[moving]), axis=0)[0] <= 1
            hangs |= near & (above < rows) & (trace.mode.section[moving[above]] == trace.mode.section[moving])
        hangs[:-1] |= (np.diff(trace.mode.section[moving]) == 0) & cause[1:]
        return trace.blocks.mask_of(moving[hangs])
