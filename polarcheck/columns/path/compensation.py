"""Cutter compensation as programmed: the side and the radius in force in each executed block, and its ramps."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before, fill_down
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.offsets import ToolOffsets
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.foundation.arrays import Columns, Floats, Mask, States, cached_property, computed, repeated
from polarcheck.foundation.states import Corner, Side
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine


class CutterCompensation(Columns, frozen=True):
    """Side, start-ups, offset cancels and the radius with which the control compensates."""

    run: Run
    machine: Machine
    blocks: ExecutedBlocks
    modal: ModalStates
    tools: CalledTools
    axes: PlaneAxes
    mode: PolarMode
    lengths: Lengths
    path: ProgrammedPath
    offsets: ToolOffsets

    @cached_property
    def writes_side(self) -> Mask:
        """G41 or G42 stands in the row."""
        return self.blocks.listed("compensation_left", "compensation_right")

    @cached_property
    def writes_cancel(self) -> Mask:
        """G40 stands in the row."""
        return self.blocks.listed("compensation_off")

    @cached_property
    def side(self) -> States:
        """
        Cutter compensation in force (Side).

        It is off when the mode is switched, be it that a G40 was forgotten: that has a finding, and what would be
        compensated wrongly up to the next G41 or G42 is no second mistake.
        """
        written = self.modal.sets("side")
        state = np.where(written, self.modal.state("side"), Side.OFF)
        switched = self.blocks.mask_of(self.mode.sections.leave) | self.mode.enters
        return fill_down(state, written | switched | self.blocks.starts, Side.OFF).astype(np.int16)

    @cached_property
    def corner(self) -> States:
        """How the control goes round outer corners (Corner), by the code in force or as the machine does without."""
        without = Corner[self.machine.compensation.corner.upper()]
        return computed(lambda state: np.where(state == 0, without, state).astype(np.int16), self.modal.state("corner"))

    @cached_property
    def side_before(self) -> States:
        """Cutter compensation in force before the row."""
        return before(self.side, self.blocks.starts, Side.OFF).astype(np.int16)

    @cached_property
    def compensates(self) -> Mask:
        """G41 or G42 is in force in the polar mode."""
        return np.asarray(self.mode.in_polar & (self.side != Side.OFF))

    @cached_property
    def starts_up(self) -> Mask:
        """The move in which compensation is built up."""
        return np.asarray(self.path.on_plane & (self.side != Side.OFF) & (self.side_of_move_before == Side.OFF))

    @cached_property
    def cancels(self) -> Mask:
        """The move in which compensation is taken back."""
        return np.asarray(self.path.on_plane & (self.side == Side.OFF) & (self.side_of_move_before != Side.OFF))

    @cached_property
    def side_of_move_before(self) -> States:
        """Compensation of the last row above that moved on the plane in this section."""
        fixed = self.path.travels | self.mode.enters
        side = fill_down(np.where(self.mode.enters, Side.OFF, self.side).astype(np.int16), fixed, Side.OFF)
        return before(side, self.blocks.starts, Side.OFF).astype(np.int16)

    @cached_property
    def offset_mode(self) -> Mask:
        """The move before was made with compensation."""
        return np.asarray(self.mode.in_polar & (self.side_of_move_before != Side.OFF))

    @cached_property
    def radius_of_move(self) -> Floats:
        """R by which the tool center is off the path [mm]: of the offset in force; in a cancel, of the move before."""
        used = self.compensates & self.axes.moves_plane
        last = fill_down(self.radius, used | self.blocks.starts, np.nan)
        return np.where(self.offset_mode & (self.side == Side.OFF), last, self.radius)

    @cached_property
    def is_path_of_center(self) -> Mask:
        """
        Rows of sections whose straight ramps are all shorter than the R that a comment gives.

        The comment tells the cutter, and not what stands in the offset table: with R 0 the program is that of the tool
        center, and then a ramp needs no length (builder's guide to G12.1, sample program).
        """
        ramps = (self.starts_up | self.cancels) & ~self.path.is_arc & self.offsets.radius_is_from_comment
        short = ramps & (self.path.length < self.offsets.radius_of_offset - ROUNDING)
        return np.asarray(self.mode.anywhere_in_section(short) & ~self.mode.anywhere_in_section(ramps & ~short))

    @cached_property
    def sides_are_open(self) -> Mask:
        """Rows of sections on the sub-spindle of which the machine does not say on which side G41 and G42 are there."""
        if self.machine.polar.sub_spindle_plane == "as-main" or not len(self.mode.sections):
            return np.zeros(len(self.run), bool)
        is_open = (self.modal.on_sub_spindle & ~self.axes.enters_other_axes)[self.mode.sections.enter]
        return np.asarray((self.mode.section >= 0) & is_open[self.mode.section])

    @cached_property
    def radius(self) -> Floats:
        """R with which the rows are compensated, allowance included [mm]; NaN where it is not known."""
        radius = np.where(self.is_path_of_center, 0.0, self.offsets.radius_of_offset) + self.allowance
        return np.where(self.sides_are_open, np.nan, radius) if self.sides_are_open.any() else radius

    @cached_property
    def allowance(self) -> Floats:
        """Allowance on R while cutter compensation is in force [mm]: OFFN, up to the next or the program's end."""
        word = self.machine.offsets.allowance_word
        written = self.blocks.has(word)
        if not written.any():
            return repeated(np.float64(0), len(self.run))
        return fill_down(np.where(written, self.lengths.length_of(word), 0.0), written | self.blocks.starts, 0.0)

    @cached_property
    def changes_allowance_in_offset_mode(self) -> Mask:
        """Another allowance is written where compensation is in force and stays so."""
        changes = self.allowance != before(self.allowance, self.blocks.starts, 0.0)
        return np.asarray(changes & self.offset_mode & (self.side != Side.OFF))

    @cached_property
    def calls_other_offset_in_polar(self) -> Mask:
        """Another offset than the one in force is called in the mode, where this control allows none."""
        calls = self.mode.in_polar & self.tools.calls_offset & (self.tools.tool_called != self.tools.tool_called_before)
        if self.machine.offsets.called_in_polar == "never":
            return np.asarray(calls)
        return np.asarray(calls & ((self.side != Side.OFF) | (self.side_before != Side.OFF)))
