"""Since which block a state is in force, a coordinate holds: what it makes wrong is one mistake, in that block."""

from __future__ import annotations

import re
from itertools import chain

import numpy as np

from polarcheck.columns.filling import before, fill_down
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, column_at
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.code_lists import FRAME_LISTS

#: The head of a structure of several blocks, its other branches and its end; no IF with a jump or an assignment.
_STRUCTURE = lazy_pattern(rb"^[/0-9N ]*(IF(?![^\n]*(?:GOTO|THEN[ ]*[^\s]))|ELSEIF|ELSE|ENDIF)(?![A-Z])", re.MULTILINE)


class Since(Columns, frozen=True):
    """Columns of one trace; of a state the same number in all rows from one block that sets it to the next."""

    trace: Trace

    # ---- which row has written a coordinate ----

    @property
    def row(self) -> Rows:
        """The row itself."""
        return np.arange(len(self.trace))

    @cached_property
    def linear_word(self) -> Rows:
        """The row that wrote the X in force, itself or above; -1 for none."""
        return self._written(self.trace.blocks.has("X", "U"))

    @cached_property
    def virtual_word(self) -> Rows:
        """The same of the virtual axis."""
        return self._written(self.trace.axes.programs_virtual_axis)

    @cached_property
    def linear_word_before(self) -> Rows:
        """The row above that wrote the X with which a row begins; -1 for none."""
        return before(self.linear_word, self.trace.blocks.starts, -1)

    @cached_property
    def virtual_word_before(self) -> Rows:
        """The same of the virtual axis."""
        return before(self.virtual_word, self.trace.blocks.starts, -1)

    @cached_property
    def arc_before(self) -> Rows:
        """The axis row above under the same G2 or G3 word; -1 for none."""
        trace = self.trace
        axes = np.flatnonzero(trace.modal.uses_axes & (trace.modal.motion_word >= 0))
        same = trace.modal.motion_word[axes[1:]] == trace.modal.motion_word[axes[:-1]]
        return column_at(len(trace), axes[1:][same], axes[:-1][same], -1)

    def _written(self, written: Mask) -> Rows:
        return fill_down(self.row, written | self.trace.blocks.starts, -1)

    # ---- since when a state is in force ----

    @cached_property
    def structure_of_block(self) -> Rows:
        """Per block of the file the same number for IF, ELSE and ENDIF that belong together; -1 for other blocks."""
        source, blocks = self.trace.text.source, self.trace.text.blocks
        numbers: list[int] = []
        opened: list[int] = []
        marks = list(_STRUCTURE.finditer(source.code.tobytes()))
        for number, mark in enumerate(marks):
            if mark[1] == b"IF" or not opened:
                opened.append(number)
            numbers.append(opened[-1])
            if mark[1] == b"ENDIF":
                opened.pop()
        return column_at(
            len(blocks), np.searchsorted(blocks.start, [mark.start(1) for mark in marks], side="right") - 1, numbers, -1
        )

    def _last(self, sets: Mask) -> Rows:
        return np.cumsum(sets | self.trace.blocks.starts)

    def _code(self, *keys: str) -> Rows:
        """From one M code of these lists to the next."""
        codes = chain.from_iterable(getattr(self.trace.machine.m_codes, key) for key in keys)
        return self._last(self.trace.blocks.codes(*codes))

    @cached_property
    def tool_call(self) -> Rows:
        """From one call of a tool offset to the next: T, and D where tools have edges."""
        return self._last(self.trace.tools.calls_offset)

    @cached_property
    def modal_state(self) -> Rows:
        """From one code of scaling, rotation, mirror image, drilling cycles or constant surface speed to the next."""
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
        """From one M code of a spindle to the next."""
        return self._code("spindle_on", "spindle_off", "sub_spindle_on", "sub_spindle_off")

    @cached_property
    def c_axis_code(self) -> Rows:
        """From one M code of the C axis to the next."""
        return self._code("c_axis_on", "c_axis_off", "sub_c_axis_on", "sub_c_axis_off")

    @cached_property
    def live_tool_code(self) -> Rows:
        """From one M code of the live tool to the next."""
        return self._code("live_tool_on", "live_tool_off")
