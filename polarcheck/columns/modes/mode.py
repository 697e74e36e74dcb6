"""The polar mode: the section of each executed block, where sections begin and end, and whether they are followed."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before, fill_down, happened
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.sections import Marks, Sections, find_sections, section_column
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, first_in_run, is_among, mask_at
from polarcheck.foundation.states import STATES, Motion, Side
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.code_tables import code_numbers, code_set
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading.words import NumberFault

#: Addresses that name the rotary axis of a cylinder with its radius, or the radius itself; beside that of the machine.
_CYLINDER_WORDS = ("A", "B", "C", "H", "Q", "R")


class PolarMode(Columns, frozen=True):
    """The polar sections, and what else cuts contours with C outside of them."""

    run: Run
    machine: Machine
    blocks: ExecutedBlocks
    modal: ModalStates
    tools: CalledTools
    axes: PlaneAxes

    @cached_property
    def sections(self) -> Sections:
        """The polar sections."""
        m_codes = self.machine.m_codes
        polar = self.machine.polar
        planes = {code for key in STATES["plane"] for code in self.machine.codes(key)}
        # Where G0 can stand in the mode, one with the second axis does.
        rapid_stands = "G0" in polar.allowed_codes and polar.virtual_axis != polar.rotary_address
        in_rapid = (self.axes.motion == Motion.RAPID) & self.axes.programs_virtual_axis & rapid_stands
        changes_tool = self.tools.changes_tool | self.blocks.codes(*m_codes.tool_change)
        is_circle = is_among(self.axes.motion, (Motion.CW, Motion.CCW)) & self.axes.moves_plane & ~self.axes.programs_z
        marks = Marks(
            on=self.axes.switches_on & ~self.axes.ends_mode,
            off=self.axes.ends_mode,
            starts=self.blocks.starts,
            outside=self.blocks.listed("reference_check", "reference_return", "machine_coordinates")
            | self.blocks.codes(*m_codes.c_axis_off),
            planes=self.blocks.codes(*planes.difference(polar.plane_before, polar.allowed_codes)),
            tool_ends=changes_tool | self.blocks.ends_program,
            tools_in_mode=changes_tool & self._takes_tools,
            stops=self.blocks.codes(*m_codes.optional_stop),
            rapid=self.blocks.listed("rapid"),
            cuts=self.axes.at_feed & self.axes.programs_virtual_axis | is_circle,
            moves=(self.axes.at_feed | in_rapid) & self.axes.moves_plane,
            returns=self._returns | self.blocks.is_unknown("G"),
            broken_off=np.zeros(len(self.run), bool) if self.run.broken_off is None else self.run.broken_off,
            rapid_stands=rapid_stands,
        )
        return find_sections(marks)

    @property
    def _takes_tools(self) -> Mask:
        """Rows where this control takes another tool in the mode: where no compensation is in force."""
        if self.machine.offsets.called_in_polar == "never":
            return np.zeros(len(self.run), bool)
        side = self.modal.state("side")
        return np.asarray(is_among(side, (0, Side.OFF)) & is_among(before(side, self.blocks.starts, 0), (0, Side.OFF)))

    @property
    def _returns(self) -> Mask:
        """M99 of a program that nothing here calls; at the end of the main program of a channel it begins it again."""
        returns = self.blocks.codes(*self.machine.macro.program_returns) & (self.run.depth == 0)
        if self.run.text.source.channel and returns.any():
            returns = returns & (self.blocks.program != self.blocks.program[np.argmin(self.run.block)])
        return np.asarray(returns)

    @cached_property
    def section(self) -> Rows:
        """Number of the polar section, its G12.1 included; -1 outside."""
        return section_column(self.sections, len(self.run))

    @cached_property
    def whole_section(self) -> Rows:
        """The same, with its G13.1."""
        return np.where(self.leaves, before(self.section, self.blocks.starts, -1), self.section)

    def anywhere_in_section(self, mask: Mask) -> Mask:
        """Rows of sections in which any row is in the mask."""
        hit = mask_at(len(self.sections) + 1, self.section[mask & (self.section >= 0)])
        return hit[self.section]

    def nowhere_in_section(self, mask: Mask) -> Mask:
        """Rows of sections in which no row is in the mask, and none of unknown effect, which might be."""
        return ~self.anywhere_in_section(mask | self.run.unknown)

    def count_in_section(self, mask: Mask) -> Rows:
        """Per section how many of its rows are in the mask."""
        return np.bincount(self.section[mask & (self.section >= 0)], minlength=len(self.sections))

    @cached_property
    def enters(self) -> Mask:
        """The G12.1 that begins a section."""
        return self.blocks.mask_of(self.sections.enter)

    @cached_property
    def leaves(self) -> Mask:
        """The G13.1 that ends a section."""
        return self.blocks.mask_of(self.sections.leave[self.sections.left & ~self.sections.returned])

    @cached_property
    def enters_with_direction(self) -> Mask:
        """A G12.1 with the word that gives its plane the direction: C need not be positioned before it."""
        word = self.machine.polar.direction_word
        return np.asarray(self.enters & self.blocks.has(word)) if word else np.zeros(len(self.run), bool)

    @cached_property
    def enters_again(self) -> Mask:
        """A G12.1 inside a section."""
        return self.blocks.mask_of(self.sections.again)

    def first_in_section(self, mask: Mask) -> Mask:
        """The first row of a mask in each section."""
        rows = (mask & (self.section >= 0)).nonzero()[0]
        return mask_at(len(mask), rows[first_in_run(self.section[rows])])

    @cached_property
    def in_polar(self) -> Mask:
        """Between a G12.1 and its G13.1, neither included."""
        return (self.section >= 0) & ~self.enters

    @cached_property
    def comes_before_section(self) -> Mask:
        """Rows above a section of the same program, its G12.1 included."""
        return self._comes_before(self.sections.enter)

    @cached_property
    def comes_before_open_end(self) -> Mask:
        """Rows above a contour with the virtual axis that no switch begins, and a switch ends."""
        ends = self._comes_before(np.flatnonzero(self.axes.ends_mode & (self.section < 0)))
        contours = self.axes.at_feed & self.axes.programs_virtual_axis & (self.section < 0)
        return self._comes_before(np.flatnonzero(contours & ends))

    def _comes_before(self, rows: Rows) -> Mask:
        """Rows at or above one of these rows, which ascend, in the same program."""
        ahead = np.searchsorted(rows, np.arange(len(self.run)))
        program = np.append(self.blocks.program[rows], -1)[ahead]
        return np.asarray(program == self.blocks.program)

    def given_in_section(self, rows: Mask) -> Mask:
        """True from the first of these rows to the end of its section."""
        return np.asarray(happened(rows & self.in_polar, self.enters) & self.in_polar)

    @cached_property
    def is_followed(self) -> Mask:
        """
        Where the tool goes on the plane is followed: its linear axis is known, the mode is simulated, and both axes are
        followed. Where another axis stands in a section that does not program both of its own, it may be that of the
        plane.
        """
        simulated = self.axes.linear_is_known & self.axes.is_simulated
        if not len(self.blocks.words_not_followed):
            return simulated
        not_followed = self.anywhere_in_section(self.blocks.with_words(self.blocks.words_not_followed))
        linear, virtual = self.axes.programs_linear_axis, self.axes.programs_virtual_axis
        both = self.anywhere_in_section(linear) & self.anywhere_in_section(virtual)
        return np.asarray(simulated & (~not_followed | both))

    @cached_property
    def rotary_is_followed(self) -> Mask:
        """The section is followed, and is one of the rotary axis of the machine: Q may name another one."""
        return np.asarray(self.is_followed & (self.axes.rotary_number == self.machine.polar.rotary_axis))

    @cached_property
    def on_cylinder(self) -> Mask:
        """Cylindrical interpolation is in force: from G7.1 with a radius to G7.1 C0 or another tool."""
        written = self.blocks.listed("cylindrical_interpolation")
        if not written.any():
            return written
        names = dict.fromkeys((*_CYLINDER_WORDS, self.machine.polar.rotary_address))
        radius = np.array([self.blocks.has(address) & ~(self.blocks.word(address) == 0) for address in names])
        ends = self.tools.changes_tool | self.blocks.ends_program | self.blocks.starts
        return fill_down(written & radius.any(axis=0), written | ends, False).astype(bool)

    @cached_property
    def contours_outside(self) -> Mask:
        """Blocks outside the mode with a code that cuts a contour there, and C beside it."""
        codes = self.machine.polar.contours_outside
        if not codes:
            return np.zeros(len(self.run), bool)
        written = code_numbers(self.run.words.value[self.blocks.g_words])
        return (
            self.blocks.with_words(self.blocks.g_words[code_set(codes)[written]])
            & self.blocks.has(self.machine.polar.rotary_address)
            & (self.section < 0)
        )

    @cached_property
    def extrudes(self) -> Mask:
        """
        G0 or G1 with a number in E, as printers feed their filament.

        On a lathe E is a word beside threads and beside the switch of the mode, and of no move.
        """
        e = self.blocks.word_indices("E")
        e = e[self.run.words.fault[e] == NumberFault.NONE]
        if not len(e):
            return np.zeros(len(self.run), bool)
        is_straight = is_among(self.modal.state("motion"), (Motion.RAPID, Motion.LINE))
        moves = is_straight & self.modal.uses_axes & ~self.modal.in_cycle
        calls_tool = self.blocks.has("T")  # E beside it is an angle on Citizen lathes
        return np.asarray(self.blocks.with_words(e) & moves & ~self.axes.switches_on & ~calls_tool)


def sections_of(mode: PolarMode) -> Sections:
    """The polar sections, as a table of its own."""
    return mode.sections
