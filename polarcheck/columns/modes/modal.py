"""The modal states of each executed block: what its codes, or those above it, have put in force."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.filling import fill_down, happened
from polarcheck.columns.lookups import Lookups
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.foundation.arrays import Mask, Rows, States, cached_property, column_at, computed, is_among, repeated
from polarcheck.foundation.states import NO_MOVE, STATES, Distance, FeedMode, Motion, Side, Units
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.code_tables import code, modal_tables
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine

#: The state of a group before the program selects one.
_BEFORE = {"motion": Motion.NONE, "side": Side.OFF, "feed_mode": FeedMode.PER_MINUTE, "distance": Distance.ABSOLUTE}


class ModalStates(Lookups, frozen=True):
    """The state of each modal group, of the spindles and cycles, and what the axis words of a block are for."""

    run: Run
    machine: Machine
    job: Job
    blocks: ExecutedBlocks

    @cached_property
    def _modal(self) -> tuple[tuple[str, ...], NDArray[np.uint8], States]:
        """The names of the groups; by code the number of its group (from 1), and the state that it sets."""
        return modal_tables(self.machine)

    @cached_property
    def _groups_of_words(self) -> NDArray[np.uint8]:
        """The modal group of each G word, by its number."""
        return np.asarray(self._modal[1][self.blocks.g_codes])

    def state(self, group: str) -> States:
        """The state of a modal group in each row, after its own codes (modal.STATES)."""
        return self._column(f"state {group}", lambda: self._filled(group)[0])

    def has_state(self, group: str, codes: Sequence[str]) -> Mask:
        """True where the state of a modal group is one that these codes set."""
        _, _, state_of = self._modal
        return is_among(self.state(group), [state_of[code(word)] for word in codes])

    def sets(self, group: str) -> Mask:
        """True where the row has a code of the group."""
        return self._column(f"sets {group}", lambda: self._filled(group)[1])

    def _filled(self, group: str) -> tuple[States, Mask]:
        """The state of a group in each row, and the rows that set it."""
        names, _, state_of = self._modal
        chosen = (self._groups_of_words == names.index(group) + 1).nonzero()[0]
        before, power_on = _BEFORE.get(group, 0), getattr(self.machine.power_on, group, "")
        if not (len(chosen) or power_on or group in ("speed", "motion")):
            return repeated(np.int16(before), len(self.run)), self.blocks.nowhere
        written = np.zeros(len(self.run), bool)
        values = np.full(len(self.run), before, np.int16)
        if power_on:  # an excerpt may have been begun otherwise
            values[self.blocks.whole_program] = state_of[code(power_on)]
        rows = self.run.row[self.blocks.g_words[chosen]]
        values[rows] = state_of[self.blocks.g_codes[chosen]]
        written[rows] = True
        if group == "speed":
            # Where G94 and G96 share a group, G94 sets the feed mode and ends constant surface speed.
            ended = self.blocks.listed("constant_surface_speed_ended_by") & ~written
            values[ended] = 0
            written |= ended
        state = fill_down(values, written | self.blocks.starts, before)
        unknown = self.blocks.is_unknown("G")
        if group == "motion" and unknown.any():
            values[unknown] = Motion.UNKNOWN
            written |= unknown
        self.__dict__.update({f"sets {group}": written, f"state {group}": state})
        return state.astype(np.int16), written

    @cached_property
    def behind_unknown_code(self) -> Mask:
        """True from the first G word of unknown value to the end of its program: it may be any code."""
        unknown = self.blocks.is_unknown("G")
        return happened(unknown, self.blocks.starts) if unknown.any() else unknown

    @cached_property
    def is_unknown(self) -> Mask:
        """The state of some group is not known: a code at or above the row is not, and none has set the group since."""
        unknown = self.blocks.is_unknown("G")
        if not unknown.any():
            return unknown
        groups = ("units", "distance", "side", "feed_mode", "plane")
        is_open = [happened(unknown, self.sets(group) | self.blocks.starts) for group in groups]
        return np.asarray(np.logical_or.reduce([*is_open, self.state("motion") == Motion.UNKNOWN]))

    @cached_property
    def written_units(self) -> States:
        """Units.INCH or Units.MM as the program says; where it does not, as the job or the machine says."""
        assumed = self.job.program_units or self.machine.control.units
        default = Units.INCH if assumed == "inch" else Units.MM
        return computed(lambda state: np.where(state == 0, default, state).astype(np.int16), self.state("units"))

    @cached_property
    def motion_word(self) -> Rows:
        """First character in the file of the motion code in force; -1 before the first such code."""
        words = self.blocks.code_indices(*(code for key in STATES["motion"] for code in self.machine.codes(key)))
        start = column_at(len(self.run), self.run.row[words], self.run.words.start[words], -1)
        return fill_down(start, self.sets("motion") | self.blocks.starts, -1)

    def switched(self, on: list[str], off: list[str], spindle: str = "") -> Mask:
        """True while M codes have something on, after the codes of the row; a speed of 0 (S1=0) stops the spindle."""
        return self._column(
            f"switched {on} {off} {spindle}",
            lambda: happened(self.blocks.codes(*on), self._stops(self.blocks.codes(*off), spindle)),
        )

    def _stops(self, by_code: Mask, spindle: str) -> Mask:
        """Rows that stop a spindle, by a code or by a speed of 0, and rows where a program starts."""
        ends = by_code | self.blocks.starts
        for name, owner in self.machine.control.spindle_words.items():
            if owner == spindle:
                ends = ends | (self.blocks.word(name) == 0)
        return ends

    @cached_property
    def spindle(self) -> Mask:
        """The main spindle (on many lathes the live tool too) runs: M3, M4; not by a code listed for the live tool."""
        codes, is_main = self.machine.m_codes, self.main_is_master
        on = [word for word in codes.spindle_on if word not in codes.live_tool_on]
        if is_main.all():
            return self.switched(on, codes.spindle_off, "main")
        stops = self._stops(self.blocks.codes(*codes.spindle_off) & is_main, "main")
        return happened(self.blocks.codes(*on) & is_main, stops)

    @cached_property
    def main_is_master(self) -> Mask:
        """M3, M4, M5 and S mean the main spindle; SETMS(3) makes them mean another one."""
        number = self.blocks.word("@")
        if not self.machine.macro.master_spindle_word or np.isnan(number).all():
            return np.ones(len(self.run), bool)
        written = ~np.isnan(number)
        in_force = fill_down(np.where(written, number, 1.0), written | self.blocks.starts, 1.0)
        return np.asarray(in_force == 1)

    @cached_property
    def live_tool(self) -> Mask:
        """The live tool runs; always False where the profile names no code."""
        return self.switched(self.machine.m_codes.live_tool_on, self.machine.m_codes.live_tool_off, "live")

    @cached_property
    def on_sub_spindle(self) -> Mask:
        """The C axis is that of the sub-spindle, by the last code that says so."""
        codes, main = self.machine.m_codes, [*self.machine.m_codes.sub_c_axis_off, *self.machine.m_codes.c_axis_on]
        blocks = self.blocks
        engaged = happened(blocks.codes(*codes.sub_c_axis_on), blocks.codes(*main) | blocks.starts)
        return engaged | happened(blocks.listed("sub_spindle"), blocks.listed("sub_spindle_off") | blocks.starts)

    @cached_property
    def uses_axes(self) -> Mask:
        """The axis words of the row are coordinates of a move."""
        return ~self.blocks.listed(*NO_MOVE) & ~self.run.unknown

    @cached_property
    def presets_x(self) -> Mask:
        """The row takes back what G52 and G50 (G92) have shifted X by: the work offset alone counts."""
        return np.asarray(self.blocks.listed("coordinate_preset") & self.blocks.has("X", "U"))

    @cached_property
    def sets_coordinates(self) -> Mask:
        """G50 (G92): axis words say where the tool stands, or with S how fast the spindle may turn."""
        return self.blocks.listed("coordinate_setting")

    @cached_property
    def in_cycle(self) -> Mask:
        """A turning or drilling cycle is in force."""
        return np.asarray((self.state("motion") == Motion.CYCLE) | (self.drilling != 0))

    @cached_property
    def drilling(self) -> Rows:
        """The drilling cycle in force (83 for G83), 0 for none; G80 and the codes of group 01 end it (B-62754EN/01)."""
        written = self.sets("drilling")
        if not written.any():
            return repeated(np.int64(0), len(self.run))
        state = np.where(written, self.state("drilling"), 0).astype(np.int64)
        return fill_down(state, written | self.sets("motion") | self.blocks.starts, 0).astype(np.int64)

    @cached_property
    def incremental(self) -> Mask:
        """G91 in systems B and C."""
        return np.asarray(self.state("distance") == Distance.INCREMENTAL)

    def is_step(self, address: str) -> Mask:
        """True where the word of an address is an increment, by G91 or as the word itself says: X=IC(10)."""
        distance = self.blocks.distance(address)
        return (
            self.incremental
            if distance is None
            else np.where(distance, distance == Distance.INCREMENTAL, self.incremental)
        )
