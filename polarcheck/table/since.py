"""Since which block a state is in force, a coordinate holds: what it makes wrong is one mistake, in that block."""

from __future__ import annotations

from functools import cached_property
from itertools import chain

import numpy as np

from polarcheck.arrays import Mask, Rows
from polarcheck.columns.filling import before, fill_down
from polarcheck.columns.trace import Trace
from polarcheck.machines.code_lists import FRAME_LISTS


class Since:
    """Columns of one trace; of a state the same number in all rows from one block that sets it to the next."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    # ---- which row has written a coordinate ----

    @property
    def row(self) -> Rows:
        """The row itself."""
        return np.arange(len(self.trace))

    @cached_property
    def linear_word_before(self) -> Rows:
        """The row above that wrote X last; -1 for none."""
        return self._written_before(self.trace.blocks.has("X", "U"))

    @cached_property
    def virtual_word_before(self) -> Rows:
        """The row above that wrote the virtual axis last; -1 for none."""
        return self._written_before(self.trace.axes.programs_virtual_axis)

    def _written_before(self, written: Mask) -> Rows:
        starts = self.trace.blocks.starts
        return before(fill_down(self.row, written | starts, -1), starts, -1)

    # ---- since when a state is in force ----

    def _last(self, sets: Mask) -> Rows:
        return np.cumsum(sets | self.trace.blocks.starts)

    @cached_property
    def tool_call(self) -> Rows:
        """From one call of a tool offset to the next: T, and D where tools have edges."""
        return self._last(self.trace.tools.calls_offset)

    @cached_property
    def modal_state(self) -> Rows:
        """Of scaling, rotation, mirror image, drilling cycles and constant surface speed."""
        groups = ("scaling", "rotation", "mirror", "drilling", "speed")
        return self._last(np.logical_or.reduce([self.trace.modal.sets(group) for group in groups]))

    @cached_property
    def plane(self) -> Rows:
        """From one G17, G18 or G19 to the next."""
        return self._last(self.trace.modal.sets("plane"))

    @cached_property
    def feed_mode(self) -> Rows:
        """From one code of feed per minute or per revolution to the next."""
        return self._last(self.trace.modal.sets("feed_mode"))

    @cached_property
    def origin(self) -> Rows:
        """From one block to the next that sets or selects a coordinate system."""
        trace = self.trace
        written = (
            trace.blocks.listed("local_shift", "data_input", "coordinate_preset", *FRAME_LISTS)
            | trace.modal.sets("work_offset")
            | trace.modal.sets_coordinates
        )
        written[list(trace.run.assigned)] = True
        return self._last(written)

    @cached_property
    def compensation(self) -> Rows:
        """From one G41 or G42 to the next."""
        return self._last(self.trace.compensation.writes_side)

    @cached_property
    def spindle_code(self) -> Rows:
        """Of a spindle."""
        codes = self.trace.machine.m_codes
        of_both = (codes.spindle_on, codes.spindle_off, codes.sub_spindle_on, codes.sub_spindle_off)
        return self._last(self.trace.blocks.codes(*chain.from_iterable(of_both)))

    @cached_property
    def c_axis_code(self) -> Rows:
        """Of the C axis."""
        codes = self.trace.machine.m_codes
        of_both = (codes.c_axis_on, codes.c_axis_off, codes.sub_c_axis_on, codes.sub_c_axis_off)
        return self._last(self.trace.blocks.codes(*chain.from_iterable(of_both)))

    @cached_property
    def live_tool_code(self) -> Rows:
        """Of the live tool."""
        codes = self.trace.machine.m_codes
        return self._last(self.trace.blocks.codes(*codes.live_tool_on, *codes.live_tool_off))
