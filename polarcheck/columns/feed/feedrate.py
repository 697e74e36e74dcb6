"""F in force in each executed block, and what it means: per minute or per revolution, in the mode or outside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.filling import Scalar, fill_down
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.path.lengths import Lengths
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, States, cached_property, column_at
from polarcheck.foundation.states import NO_FEED, FeedMode
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine


class Feedrate(Columns, frozen=True):
    """F and the feed mode in force."""

    run: Run
    machine: Machine
    blocks: ExecutedBlocks
    modal: ModalStates
    mode: PolarMode
    lengths: Lengths

    @cached_property
    def modal_feed_mode(self) -> States:
        """FeedMode that the codes say."""
        return self.modal.state("feed_mode")

    @cached_property
    def written_feed(self) -> Floats:
        """The last F as a number [mm per min or per revolution]; NaN before the first."""
        written = self.blocks.has("F") & self._takes_feed
        value = np.where(written, self.blocks.word("F") * self.lengths.feed_scale, np.nan)
        return self._of_corners(fill_down(value, written | self.blocks.starts, np.nan))

    @cached_property
    def feed_word(self) -> Rows:
        """Where in the file the F in force is written, its first character; -1 before the first."""
        words = self.blocks.word_indices("F")
        start = column_at(len(self.run), self.run.row[words], self.run.words.start[words], -1)
        return self._of_corners(fill_down(start, (self.blocks.has("F") & self._takes_feed) | self.blocks.starts, -1))

    def _of_corners(self, column: NDArray[Scalar]) -> NDArray[Scalar]:
        """A column of F in which a corner that the control makes has what the move behind it has."""
        return column if self.run.corners is None else column[self.feed_row]

    @cached_property
    def feed_row(self) -> Rows:
        """The row whose F each row runs at: its own; of a corner that the control makes that of the move behind it."""
        rows = np.arange(len(self.run))
        if (corners := self.run.corners) is not None:
            rows[corners.row] = corners.following
        return rows

    @cached_property
    def _takes_feed(self) -> Mask:
        return ~self.blocks.listed(*NO_FEED)

    @cached_property
    def takes_over_per_minute_only(self) -> bool:
        """F of the mode is per minute, and one per revolution from before is not taken over (M700V p. 73)."""
        return self.machine.feed.carried_into_polar == "per-minute-only"

    @cached_property
    def feed_mode(self) -> States:
        """FeedMode by which the control moves: per minute in a mode that knows no other (M700V p. 73, note 1)."""
        mode = self.modal_feed_mode
        is_other = self.mode.in_polar & (mode == FeedMode.PER_REVOLUTION) & self.takes_over_per_minute_only
        return np.where(is_other, FeedMode.PER_MINUTE, mode).astype(np.int16)

    @cached_property
    def entered_per_revolution(self) -> Mask:
        """Rows of sections at whose G12.1 feed per revolution is in force."""
        if not len(self.mode.sections):
            return np.zeros(len(self.run), bool)
        per_revolution = self.modal_feed_mode[self.mode.sections.enter] == FeedMode.PER_REVOLUTION
        return np.asarray(self.mode.in_polar & per_revolution[self.mode.section])

    @cached_property
    def per_minute(self) -> Mask:
        """F in force, if there is one, is per minute."""
        per_minute = self.feed_mode == FeedMode.PER_MINUTE
        if self.takes_over_per_minute_only:
            has_f = self.mode.given_in_section(self.blocks.has("F"))
            per_minute = np.where(self.entered_per_revolution, has_f, per_minute | self.mode.in_polar)
        return np.asarray(per_minute)

    @cached_property
    def feed_number(self) -> Floats:
        """
        F in force as a number [mm per min or per revolution]; NaN before the first.

        On a control where F of the mode is per minute only and feed per revolution is in force at G12.1, the F of the
        mode ends with it: after G13.1 the one from before is in force again (M700V p. 73, both tables of item 8).
        """
        if not self.takes_over_per_minute_only or not len(self.mode.sections):
            return self.written_feed
        written_outside = (self.blocks.has("F") | self.blocks.starts) & ~self.entered_per_revolution
        outside = fill_down(self.written_feed, written_outside, np.nan)
        return np.where(self.entered_per_revolution, self.written_feed, outside)

    @cached_property
    def programmed_feed(self) -> Floats:
        """F in force as programmed [mm/min]; NaN where none is or where it depends on a spindle."""
        return np.where(self.per_minute, self.feed_number, np.nan)

    @cached_property
    def feed(self) -> Floats:
        """F in force with which the control moves [mm/min]: in the mode clamped, where its limit acts; NaN likewise."""
        limits, feed = self.machine.limits, self.programmed_feed
        if not limits.polar_feed_clamps or np.isnan(limits.polar_feed):
            return feed
        return np.where(self.mode.in_polar, np.minimum(feed, limits.polar_feed), feed)
