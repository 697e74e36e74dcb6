"""Main spindle and sub-spindle: which of them is the C axis of a section, what they do there, whether C is clamped."""

from __future__ import annotations

import numpy as np
from msgspec.structs import astuple

from polarcheck.columns.filling import before, happened, last_row
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows, cached_property
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.machines.axis_table import OF_SPINDLE
from polarcheck.program.machines.code_tables import NO_CODE
from polarcheck.program.machines.m_codes import OF_EVERY_LATHE


class Spindles:
    """Columns of one trace, one value per row. A lathe whose profile names no code of a sub-spindle has none."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace
        self._codes = trace.machine.m_codes

    # ---- the C axis ----

    @cached_property
    def c_axis_codes(self) -> list[str]:
        """The codes that engage the C axis, of either spindle."""
        return [*self._codes.c_axis_on, *self._codes.sub_c_axis_on]

    @cached_property
    def _main_c_axis(self) -> Mask:
        return self.trace.modal.switched(self._codes.c_axis_on, self._codes.c_axis_off)

    @cached_property
    def _sub_c_axis(self) -> Mask:
        return self.trace.modal.switched(self._codes.sub_c_axis_on, self._codes.sub_c_axis_off)

    @property
    def c_axis(self) -> Mask:
        """A spindle is engaged as C axis; always False where the profile names no code."""
        return np.asarray(self._main_c_axis | self._sub_c_axis)

    @cached_property
    def engages_c_axis(self) -> Mask:
        """A C axis is engaged here and was not before."""
        return self._begins(self._main_c_axis) | self._begins(self._sub_c_axis)

    def _begins(self, state: Mask) -> Mask:
        return np.asarray(state & ~before(state, self.trace.blocks.starts, False).astype(bool))

    @cached_property
    def on_sub_spindle(self) -> Mask:
        """
        The sub-spindle is the C axis; throughout a section, the state at its G12.1 counts.

        Where both spindles are engaged, it is the one that was engaged last (LinearAxis.on_sub_spindle).
        """
        trace, is_sub = self.trace, self.trace.modal.on_sub_spindle
        if not is_sub.any() or not len(trace.mode.sections):
            return is_sub
        at_entry = is_sub[trace.mode.sections.enter][trace.mode.section]
        return np.asarray(np.where(trace.mode.section >= 0, at_entry, is_sub))

    @property
    def turns(self) -> Mask:
        """A move at feed in the mode that turns C: any but those along a line through the center."""
        trace = self.trace
        area = np.abs((np.conj(trace.path.start) * trace.path.end).imag)
        return np.asarray(trace.path.cuts & (trace.path.is_arc | (area > ROUNDING)))

    @cached_property
    def clamped(self) -> Mask:
        """
        The C axis is known to be clamped: a code has clamped it, and none has released it since.

        After the spindle is engaged or disengaged, or a block of unknown effect, the clamp is no longer known.
        """
        codes, ends = self._codes, self.trace.blocks.starts | self.trace.run.unknown
        main, sub = (
            happened(self.trace.blocks.codes(*on), self.trace.blocks.codes(*off) | ends)
            for on, off in (
                (codes.c_axis_clamp, [*codes.c_axis_unclamp, *codes.c_axis_on, *codes.c_axis_off]),
                (codes.sub_c_axis_clamp, [*codes.sub_c_axis_unclamp, *codes.sub_c_axis_on, *codes.sub_c_axis_off]),
            )
        )
        return np.where(self.on_sub_spindle, sub, main)

    # ---- codes that the profile does not know ----

    @cached_property
    def unlisted(self) -> Rows:
        """The M words that are in no list of the machine and do not mean the same on every lathe."""
        trace, machine = self.trace, self.trace.machine
        listed = [word for words in astuple(self._codes) for word in words]
        listed += [
            word for word in (*machine.macro.flow_codes, *machine.polar.on, *machine.polar.off) if word[0] == "M"
        ]
        is_listed = trace.blocks.words_at(trace.blocks.code_indices(*OF_EVERY_LATHE, *listed))
        return np.asarray(trace.blocks.m_words[~is_listed[trace.blocks.m_words] & (trace.blocks.m_codes != NO_CODE)])

    # ---- the spindle itself ----

    @cached_property
    def runs(self) -> Mask:
        """The spindle that has the C axis runs as a spindle; on many lathes M3 and M4 start the live tool, too."""
        sub = self.trace.modal.switched(self._codes.sub_spindle_on, self._codes.sub_spindle_off, "sub")
        return np.where(self.on_sub_spindle, sub, self.trace.modal.spindle)

    @cached_property
    def unstarted_speed(self) -> Rows:
        """Per row the executed word with the speed of a spindle by its number that nothing starts; -1 for none."""
        from polarcheck.columns.modes.numbered_spindles import unstarted_speeds

        return unstarted_speeds(self.trace)

    @cached_property
    def stopped_by(self) -> Rows:
        """
        Per row that of the M5 with which nothing turns any more: it has stopped a spindle, and neither since then nor
        since the tool was called has a code that may start one been read; -1 where something may turn, and where the
        profile names codes of the live tool, whose state is known.
        """
        trace, codes, blocks = self.trace, self._codes, self.trace.blocks
        if codes.live_tool_on:
            return np.full(len(trace), -1)
        may_start = [*self.unlisted, *np.flatnonzero(trace.run.words.address == OF_SPINDLE)]
        starts = blocks.codes(*codes.spindle_on, *codes.sub_spindle_on) | trace.run.unknown
        starts |= blocks.mask_of(trace.run.row[may_start])
        stops = blocks.codes(*codes.spindle_off) & happened(blocks.codes(*codes.spindle_on), blocks.starts)
        of_tool = happened(starts, blocks.has("T") | blocks.starts)
        return np.where(of_tool, -1, last_row(stops, starts | blocks.starts))

    @property
    def are_no_live_tool(self) -> Mask:
        """The codes that start and stop the spindle of the C axis do not start the live tool, which has its own."""
        return self.on_sub_spindle | bool(self._codes.live_tool_on)

    @cached_property
    def words(self) -> Mask:
        """Per executed word: a code of the spindle that has the C axis, or of that axis, not of the live tool."""
        trace, codes = self.trace, self._codes
        of_main = (
            *codes.spindle_on,
            *codes.spindle_off,
            *codes.spindle_orientation,
            *codes.c_axis_on,
            *codes.c_axis_off,
        )
        of_sub = (*codes.sub_spindle_on, *codes.sub_spindle_off, *codes.sub_c_axis_on, *codes.sub_c_axis_off)
        main, sub, live = (
            trace.blocks.words_at(trace.blocks.code_indices(*listed))
            for listed in (of_main, of_sub, (*codes.live_tool_on, *codes.live_tool_off))
        )
        return np.where(self.on_sub_spindle[trace.run.row], sub, main) & ~live

    @cached_property
    def has_code(self) -> Mask:
        """Rows with a code of `words`."""
        return self.trace.blocks.with_words(self.words)
