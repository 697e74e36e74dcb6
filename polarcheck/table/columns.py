"""The columns that a row has by itself or from the rows above it: modal states, units, feed."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask, Rows, States, computed, is_among, repeated
from polarcheck.execution.programs import find_programs
from polarcheck.execution.run import Run
from polarcheck.machines.codes import code, modal_tables
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.machines.modal import MM_PER_INCH, NO_FEED, NO_MOVE, STATES, Distance, FeedMode, Motion, Side, Units
from polarcheck.table.filling import fill_down, happened
from polarcheck.table.row_words import RowWords

_BEFORE = {"motion": Motion.NONE, "side": Side.OFF, "feed_mode": FeedMode.PER_MINUTE, "distance": Distance.ABSOLUTE}


class Columns(RowWords):
    """Words and states of the rows of one file on one machine for one job."""

    def __init__(self, run: Run, machine: Machine, job: Job) -> None:
        super().__init__(run, machine)
        self.job = job

    # ---- modal states ----

    @cached_property
    def _modal(self) -> tuple[tuple[str, ...], NDArray[np.uint8], States]:
        return modal_tables(self.machine)

    def state(self, group: str) -> States:
        """The state of a modal group in each row, after its own codes (modal.STATES)."""
        return self._column(f"state {group}", lambda: self._filled(group)[0])

    def has_state(self, group: str, codes: Sequence[str]) -> Mask:
        """Whether the state of a modal group is one that these codes set."""
        _, _, state_of = self._modal
        return is_among(self.state(group), [state_of[code(word)] for word in codes])

    def sets(self, group: str) -> Mask:
        """Whether a row has a code of the group."""
        return self._column(f"sets {group}", lambda: self._filled(group)[1])

    def _filled(self, group: str) -> tuple[States, Mask]:
        names, group_of, state_of = self._modal
        written = np.zeros(len(self), bool)
        values = self._at_power_on(group)
        if group in names:
            chosen = group_of[self.g_codes] == names.index(group) + 1
            rows = self.run.row[self.g_words[chosen]]
            values[rows] = state_of[self.g_codes[chosen]]
            written[rows] = True
        state = fill_down(values, written | self.starts, _BEFORE.get(group, 0))
        self._columns[f"sets {group}"] = written
        self._columns[f"state {group}"] = state
        return state.astype(np.int16), written

    def _at_power_on(self, group: str) -> States:
        """The state that holds before a program has selected one, per row; of an excerpt it is what is usual."""
        states = np.full(len(self), _BEFORE.get(group, 0), np.int16)
        known = getattr(self.machine.power_on, group, "")
        if known:
            states[self.whole_program] = self._modal[2][code(known)]
        return states

    # ---- place in the file ----

    @property
    def starts(self) -> Mask:
        """Rows at which a program begins."""
        return self.run.starts

    @cached_property
    def line(self) -> Rows:
        """Line in the file, from 1."""
        return self.text.blocks.line[self.run.block]

    @cached_property
    def row_of_block(self) -> Rows:
        """Per block of the file the first row that runs it, -1 where none does."""
        rows = np.full(len(self.text.blocks), -1, np.int64)
        rows[self.run.block[::-1]] = np.arange(len(self) - 1, -1, -1)
        return rows

    @cached_property
    def program(self) -> Rows:
        """Number of the program in the file, from 0."""
        return np.cumsum(self.starts) - 1

    @cached_property
    def whole_program(self) -> Mask:
        """
        The row belongs to a main program that is there from its head on: with O number, <name> or %, not left by M99.

        Of an excerpt, and of a subprogram, it is not known what was in force before its first block.
        """
        programs = find_programs(self.text).programs
        first = np.array([program.first for program in programs], np.int64)
        has_head = np.array([program.has_head for program in programs], bool)
        start = self.run.block[np.flatnonzero(self.starts)]
        whole = has_head[np.maximum(np.searchsorted(first, start, side="right") - 1, 0)]
        whole |= len(self.text.tape_marks) > 0
        whole[self.program[self.codes(*self.machine.macro.program_returns) & (self.run.depth == 0)]] = False
        if self.run.broken_off is not None:
            whole[self.program[self.run.broken_off]] = False  # an M99 may come behind the bound
        return whole[self.program]

    def anywhere_in_program(self, mask: Mask) -> Mask:
        """Rows of programs in which any row is in the mask."""
        found = np.zeros(int(np.count_nonzero(self.starts)) + 1, bool)
        found[self.program[mask]] = True
        return found[self.program]

    @cached_property
    def ends_program(self) -> Mask:
        """M02, M30."""
        return self.codes(*self.machine.m_codes.program_end)

    # ---- units, feed ----

    @cached_property
    def units(self) -> States:
        """Units.INCH or Units.MM; where the program does not say, those of the job or the machine."""
        assumed = self.job.program_units or self.machine.control.units
        given = Units.INCH if assumed == "inch" else Units.MM
        return computed(lambda state: np.where(state == 0, given, state).astype(np.int16), self.state("units"))

    @cached_property
    def scale(self) -> Floats:
        """mm per unit of length."""
        return computed(lambda units: np.where(units == Units.INCH, MM_PER_INCH, 1.0), self.units)

    @cached_property
    def modal_feed_mode(self) -> States:
        """FeedMode that the codes say."""
        return self.state("feed_mode")

    @cached_property
    def written_feed(self) -> Floats:
        """The last F as a number [mm per min or per revolution]; NaN before the first."""
        written = self.has("F") & self._takes_feed
        value = np.where(written, self.word("F") * self.scale, np.nan)
        return fill_down(value, written | self.starts, np.nan)

    @cached_property
    def feed_word(self) -> Rows:
        """Where in the file the F in force is written, its first character; -1 before the first."""
        words = self.word_indices("F")
        at = np.full(len(self), -1, np.int64)
        at[self.run.row[words]] = self.run.words.start[words]
        return fill_down(at, (self.has("F") & self._takes_feed) | self.starts, -1)

    @cached_property
    def motion_word(self) -> Rows:
        """Where in the file the code of motion in force is written, its first character; -1 before the first."""
        words = self.code_indices(*(code for key in STATES["motion"] for code in self.machine.codes(key)))
        at = np.full(len(self), -1, np.int64)
        at[self.run.row[words]] = self.run.words.start[words]
        return fill_down(at, self.sets("motion") | self.starts, -1)

    @cached_property
    def _takes_feed(self) -> Mask:
        return ~self.listed(*NO_FEED)

    @cached_property
    def job_scale(self) -> Floats | float:
        """mm per unit of the lengths of the job."""
        return {"mm": 1.0, "inch": MM_PER_INCH}[self.job.units] if self.job.units else self.scale

    # ---- M codes ----

    def switched(self, on: list[str], off: list[str]) -> Mask:
        """What M codes have switched on, in each row after its own."""
        return self._column(f"switched {on} {off}", lambda: self._switched(on, off))

    def _switched(self, on: list[str], off: list[str]) -> Mask:
        return happened(self.codes(*on), self.codes(*off) | self.starts)

    @cached_property
    def spindle(self) -> Mask:
        """The main spindle (on many lathes the live tool too) runs: M3, M4; not by a code listed for the live tool."""
        codes = self.machine.m_codes
        return self.switched([word for word in codes.spindle_on if word not in codes.live_tool_on], codes.spindle_off)

    @cached_property
    def live_tool(self) -> Mask:
        """The live tool runs; always False where the profile names no code."""
        return self.switched(self.machine.m_codes.live_tool_on, self.machine.m_codes.live_tool_off)

    # ---- what the axis words are for ----

    @cached_property
    def uses_axes(self) -> Mask:
        """The axis words of the row are coordinates of a move."""
        return ~self.listed(*NO_MOVE) & ~self.run.unknown

    @cached_property
    def presets_x(self) -> Mask:
        """X is that of the work offset again: what G52 and G50 (G92) have moved is taken back."""
        return np.asarray(self.listed("coordinate_preset") & self.has("X", "U"))

    @cached_property
    def in_cycle(self) -> Mask:
        """A turning or drilling cycle is in force."""
        return np.asarray((self.state("motion") == Motion.CYCLE) | (self.drilling != 0))

    @cached_property
    def drilling(self) -> Rows:
        """The drilling cycle in force (83 for G83), 0 for none; G80 and the codes of group 01 end it (B-62754EN/01)."""
        written = self.sets("drilling")
        if not written.any():
            return repeated(np.int64(0), len(self))
        state = np.where(written, self.state("drilling"), 0).astype(np.int64)
        return fill_down(state, written | self.sets("motion") | self.starts, 0).astype(np.int64)
