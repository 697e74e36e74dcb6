"""The rotary axis, C on most lathes: its angle outside the polar mode, and what the polar plane makes of it inside."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.geometry import polar
from polarcheck.table.filling import positions
from polarcheck.table.plane_moves import PlaneMoves


class RotaryAxis(PlaneMoves):
    """The columns of the rotary axis; see the properties."""

    @cached_property
    def c_angle(self) -> Floats:
        """C angle of the machine after the row [deg], continuous along a section; NaN while unknown."""
        axis, increment = self.machine.polar.rotary_words
        moving = self.uses_axes & (self.section < 0)
        written, stepped = self.has(axis) & moving, self.has(increment) & moving
        is_step = self.is_step(axis)
        absolute = np.where(written & ~is_step, self.angle_of(axis), np.nan)
        turn = np.where(written & is_step, self.angle_of(axis), 0.0)
        turn += np.where(stepped, self.angle_of(increment), 0.0)
        on_plane = self.in_polar & self.moves_plane
        turn[on_plane] = polar.c_sweep(*self._move(on_plane))
        # G28 H0 takes C to its reference point, the zero of its angle (builder's guide: "zero return C-axis").
        referenced = self.listed("c_axis_reference") & self.has(axis, increment)
        values = np.where(referenced, 0.0, np.where(self.sets_coordinates, self.angle_of(axis), np.nan))
        resets, direction = self._forgets(axis, increment), self.machine.polar.direction_word
        turns_plane = self.enters & self.has(direction)
        if turns_plane.any():
            # Where the tool stands is not told by it, but in which direction of C the first axis of the plane points.
            resets, values = resets | turns_plane, np.where(turns_plane, self.angle_of(direction), values)
        return positions(absolute, turn, resets, values)

    @cached_property
    def rotary_is_followed(self) -> Mask:
        """The section is followed, and is one of the rotary axis of the machine: Q may name another one."""
        return np.asarray(self.is_followed & (self.rotary_number == self.machine.polar.rotary_axis))

    @cached_property
    def section_entry(self) -> Floats:
        """C angle [deg] of the linear axis of each section's plane: that at its G12.1, or C0; 0 where not known."""
        return np.nan_to_num(self.c_angle[self.sections.enter]) - self.kept_angle[self.sections.enter]
