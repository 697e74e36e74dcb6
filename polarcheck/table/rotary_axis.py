"""The rotary axis: the angle of C outside the polar mode, and what the polar plane makes of it inside."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats
from polarcheck.geometry import polar
from polarcheck.table.filling import positions
from polarcheck.table.positions import Positions


class RotaryAxis(Positions):
    """The columns of the rotary axis; see the properties."""

    @cached_property
    def c_angle(self) -> Floats:
        """C angle of the machine after the row [deg], continuous along a section; NaN while unknown."""
        moving = self.uses_axes & (self.section < 0)
        written, stepped = self.has("C") & moving, self.has("H") & moving
        absolute = np.where(written & ~self.incremental, self.angle_of("C"), np.nan)
        turn = np.where(written & self.incremental, self.angle_of("C"), 0.0)
        turn += np.where(stepped, self.angle_of("H"), 0.0)
        on_plane = self.in_polar & self.moves_plane
        turn[on_plane] = polar.c_sweep(*self._move(on_plane))
        # G28 H0 takes C to its reference point, the zero of its angle (builder's guide: "zero return C-axis").
        referenced = self.listed("c_axis_reference") & self.has("C", "H")
        values = np.where(referenced, 0.0, np.where(self.sets_coordinates, self.angle_of("C"), np.nan))
        return positions(absolute, turn, self._forgets("C", "H"), values)

    @cached_property
    def section_entry(self) -> Floats:
        """C angle [deg] of the linear axis of each section's plane: that at its G12.1, or C0; 0 where not known."""
        return np.nan_to_num(self.c_angle[self.sections.enter]) - self.kept_angle[self.sections.enter]
