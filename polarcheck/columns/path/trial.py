"""Loops as they would run with another R, or on the other side, to see what is wrong with them as they are."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.contour.skipped_loops import SkipReason
from polarcheck.columns.path.infeed import Infeed
from polarcheck.columns.path.tool_center import OtherRadius, ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, cached_property


class Trial(Overcuts):
    """
    Overcuts of some rows with another R, as columns of the whole trace; the walls of the other rows stay as they are.

    The table of the tool center is made again with that R (ToolCenter.other_radius), and the cuts from it; what the
    trace says stays as programmed.
    """

    def __init__(self, trace: Trace, trial_radius: OtherRadius) -> None:
        super().__init__(trace, ToolCenter(trace, Infeed(trace), other_radius=trial_radius))

    @property
    def bar(self) -> float:
        """A ramp through the part comes through it wherever the bar ends."""
        return np.nan

    @cached_property
    def faulty(self) -> Mask:
        """Rows that the control would refuse, that would cut into the part, or of which this is unknown."""
        faulty = self.trace.blocks.mask_of(self.sweeps.row)
        return faulty | self.fails

    @cached_property
    def fails(self) -> Mask:
        """The same without the ramps."""
        faulty = self.skipped.rows(self.loop, SkipReason.CROSSES) | self.objects
        faulty[self.cuts.row] = True
        return faulty

    @cached_property
    def objects(self) -> Mask:
        """Rows that the control would refuse, or of which this is unknown; cuts not included."""
        tool = self.tool_center
        faulty = tool.inside_arc_too_small | tool.interferes | tool.no_intersection
        faulty |= tool.movement_missing | tool.arc_center_on_path
        faulty[tool.moves.row[~tool.moves.known]] = True
        return faulty
