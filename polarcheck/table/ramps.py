"""How cutter compensation begins and ends in the polar mode, and what it takes its radius from."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.machines.modal import Side
from polarcheck.table.filling import before, fill_down
from polarcheck.table.modes import Modes
from polarcheck.table.tool_center import ToolCenter
from polarcheck.table.trace import Trace


class Ramps:
    """Columns of one trace, one value per row."""

    def __init__(self, trace: Trace, tool_center: ToolCenter, modes: Modes) -> None:
        self.modes = modes
        self.trace = trace
        self.tool_center = tool_center

    # ---- state ----

    @cached_property
    def switched_in_offset_mode(self) -> Mask:
        """
        G12.1 with compensation in force, or G13.1 after a move with compensation and no G40 since.

        A G41 after which nothing moved is no offset mode yet (start-up-shorter-than-radius).
        """
        trace = self.trace
        used = trace.enters | (trace.leaves & (self.trace.side_of_move_before != Side.OFF))
        return np.asarray(used & (trace.side_before != Side.OFF) & ~trace.codes("G40"))

    @cached_property
    def side_changes(self) -> Mask:
        """G41 in offset mode with G42, or the other way round."""
        trace = self.trace
        return np.asarray(self._sides & (trace.side != trace.side_before))

    @cached_property
    def side_repeats(self) -> Mask:
        """G41 in offset mode with G41, or G42 with G42."""
        trace = self.trace
        return np.asarray(self._sides & (trace.side == trace.side_before))

    @cached_property
    def _sides(self) -> Mask:
        trace = self.trace
        active = (trace.side != Side.OFF) & (trace.side_before != Side.OFF)
        return np.asarray(self.trace.offset_mode & active & trace.codes("G41", "G42"))

    # ---- ramps ----

    @cached_property
    def begins_standing(self) -> Mask:
        """G41 or G42 after which nothing moves on the plane before G40 or the end of the mode."""
        trace = self.trace
        begins = trace.in_polar & trace.codes("G41", "G42") & ~trace.moves_plane & (trace.side_before == Side.OFF)
        ends = trace.codes("G40") | ~trace.in_polar
        return self._without_move(begins & ~self.trace.offset_mode, ends, trace.starts_up)

    @cached_property
    def ends_standing(self) -> Mask:
        """A G40 after which nothing moves on the plane before the mode is left or compensation begins again."""
        trace = self.trace
        ends = trace.codes("G40") & ~trace.moves_plane & (trace.side_before != Side.OFF)
        return self._without_move(
            ends & self.trace.offset_mode, trace.codes("G41", "G42") | ~trace.in_polar, trace.cancels
        )

    def _without_move(self, rows: Mask, ends: Mask, ramp: Mask) -> Mask:
        """Of these rows those after which one of `ends` comes before a move of the ramp."""
        if not rows.any():
            return rows
        trace = self.trace
        events = np.flatnonzero((trace.in_polar & trace.moves_plane) | ends)
        at = np.flatnonzero(rows)
        found = np.append(events, len(trace))[np.searchsorted(events, at, side="right")]
        alone = np.zeros(len(trace), bool)
        alone[at] = ~np.append(ramp, False)[found]
        return alone

    @cached_property
    def has_radius(self) -> Mask:
        """R is not known to be 0: with R 0 a ramp needs no length."""
        return np.asarray(self.trace.radius != 0)

    @cached_property
    def too_short(self) -> Mask:
        """The row moves less than R on the plane."""
        trace = self.trace
        standing = (trace.length == 0) & self.has_radius
        return np.asarray(standing | (trace.length < np.abs(trace.radius) - ROUNDING))

    @cached_property
    def on_of_length(self) -> Mask:
        """Ramps on that can be judged by R: straight, and of some length or an unknown one."""
        return np.asarray(self.trace.starts_up & ~self.on_arc & (self.trace.length != 0))

    @cached_property
    def off_of_length(self) -> Mask:
        """Ramps off likewise."""
        return np.asarray(self.trace.cancels & ~self.on_arc & (self.trace.length != 0))

    @cached_property
    def on_arc(self) -> Mask:
        """A ramp on or off in an arc."""
        return self.trace.is_arc & (self.trace.starts_up | self.trace.cancels)

    # ---- where the tool does not fit ----

    @cached_property
    def compensated(self) -> Mask:
        """Moves on the plane with compensation in force."""
        trace = self.trace
        return np.asarray(trace.in_polar & trace.moves_plane & (trace.side != Side.OFF))

    @cached_property
    def arc_too_small(self) -> Mask:
        """An arc on whose inner side the tool does not fit; a ramp on an arc has its own rule."""
        return self.tool_center.found("inside_arc_too_small") & ~self.on_arc

    @cached_property
    def arc_radius(self) -> Floats:
        """Radius of an arc [mm], the smaller one where start and end differ."""
        trace = self.trace
        return np.minimum(np.abs(trace.start - trace.center), np.abs(trace.end - trace.center))

    @cached_property
    def does_not_meet(self) -> Mask:
        """The paths of the tool center do not meet at the end of the row."""
        return self._first_of_run(self.tool_center.found("no_intersection"))

    @cached_property
    def runs_backwards(self) -> Mask:
        """The tool center would run against the program."""
        return self._first_of_run(self.tool_center.found("interferes")) & ~self.does_not_meet

    def _first_of_run(self, rows: Mask) -> Mask:
        """
        Of neighbouring moves that do not fit the first: what follows hangs on it.

        Those at an arc that is too small, at a ramp on an arc or at another G41 or G42 are none of their own.
        """
        trace = self.trace
        moving = np.flatnonzero(trace.in_polar & trace.moves_plane)
        if not rows.any():
            return rows
        faulty = rows | self.tool_center.found("no_intersection") | self.tool_center.found("interferes")
        cause = (self.arc_too_small | self.on_arc | self.side_changes | self.side_repeats)[moving]
        found, faulty, section = rows[moving], faulty[moving], trace.section[moving]
        joined = section[1:] == section[:-1]
        hangs = cause.copy()
        hangs[1:] |= joined & (cause | faulty)[:-1]
        hangs[:-1] |= joined & cause[1:]
        first = np.zeros(len(trace), bool)
        first[moving] = found & ~hangs
        return first

    @cached_property
    def next_not_read(self) -> Mask:
        """The control does not know the next move in time."""
        return self.tool_center.found("movement_missing")

    # ---- sections ----

    @cached_property
    def uncompensated(self) -> Mask:
        """Per section: it cuts and never uses G41 or G42."""
        trace = self.trace
        cuts, uses = (np.zeros(len(trace.sections), bool) for _ in range(2))
        cuts[trace.section[trace.cuts]] = True
        uses[trace.section[trace.in_polar & (trace.side != Side.OFF)]] = True
        return cuts & ~uses

    # ---- offsets ----

    @cached_property
    def tool_is_called(self) -> Mask:
        """A T word stands above, or would have to in a whole program; before an excerpt it may have been called."""
        trace = self.trace
        called = fill_down(trace.has("T"), trace.has("T") | trace.starts, False).astype(bool)
        return np.asarray(called | trace.whole_program)

    @cached_property
    def nose_wrong(self) -> Mask:
        """The nose type of the offset in force is known and shifts the programmed point off the cutter center."""
        trace = self.trace
        return ~np.isnan(trace.nose) & ~np.isin(trace.nose, trace.machine.compensation.nose_types)

    @cached_property
    def offset_changes(self) -> Mask:
        """Rows in the mode with a T word that calls another tool or offset, or with a G10 that changes one."""
        trace = self.trace
        called = trace.tool * 10**trace.machine.control.offset_digits + trace.offset_number
        other = trace.has("T") & (called != before(called, trace.starts, 0))
        return np.asarray((trace.in_polar & other) | self.modes.data_input[1])
