"""Numbers without a decimal point, which a control reads in least increments and hardly anybody means so."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Mask, Rows
from polarcheck.machines.modal import FeedMode, Units
from polarcheck.table.trace import Trace


class Increments:
    """What the numbers of one trace that have no point are taken as."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    @cached_property
    def _sections(self) -> Rows:
        """The section of each row of the mode and of the rows that position X and C for it; -1 of all others."""
        trace = self.trace
        column = np.where(trace.in_polar, trace.section, -1)
        enter = trace.sections.enter
        for addresses in (("X", "U"), ("C", "H")):
            rows = np.append(-1, np.flatnonzero(trace.uses_axes & trace.has(*addresses) & ~trace.in_polar))
            last = rows[np.searchsorted(rows, enter) - 1]
            own = (last >= 0) & (trace.program[last] == trace.program[enter])
            column[last[own]] = np.flatnonzero(own)
        return column

    @cached_property
    def without_point(self) -> Rows:
        """
        Per word of the file: how many coordinates without a point are reported here, 0 where nothing is.

        Where more than half of the coordinates of a section are without, that is one habit, reported at the first of
        them. Nothing is reported where they are meant in least increments.
        """
        trace = self.trace
        reported = np.zeros(len(trace.text.words), np.int64)
        words, row = trace.run.words, trace.run.row
        if trace.in_increments or trace.machine.control.number_without_point == "whole-unit" or not len(words):
            return reported
        section = self._sections[row]
        bare = np.flatnonzero(trace.unpointed & (section >= 0))
        inch_feed = (words.address == ord("F")) & ~words.has_point & (words.value > 0) & (section >= 0)
        inch_feed &= (trace.units == Units.INCH)[row] & (trace.feed_mode == FeedMode.PER_MINUTE)[row]
        feed = np.flatnonzero(inch_feed)
        for index, count in (self._habits_as_one(bare, section), (feed, np.ones(len(feed), np.int64))):
            at, found = self._in_file(index)
            np.maximum.at(reported, at, count[found])
        return reported

    def _habits_as_one(self, bare: Rows, section: Rows) -> tuple[Rows, Rows]:
        """Of the words without a point those to report, and how many each stands for."""
        trace, own = self.trace, section[bare]
        if not len(bare):
            return bare, bare
        is_coordinate = trace.is_coordinate & (trace.run.words.value != 0) & (section >= 0)
        total = np.bincount(section[is_coordinate], minlength=len(trace.sections))
        count = np.bincount(own, minlength=len(trace.sections))
        is_habit = (2 * count > total)[own] & (count > 1)[own]
        first = np.append(True, own[1:] != own[:-1])
        shown = first | ~is_habit
        return bare[shown], np.where(is_habit, count[own], 1)[shown]

    def _in_file(self, index: Rows) -> tuple[Rows, Mask]:
        """Where executed words stand among the words of the file, and which do: calculated ones do not."""
        own = self.trace.text.words.start
        start = self.trace.run.words.start[index]
        at = np.minimum(np.searchsorted(own, start), len(own) - 1)
        found = own[at] == start
        return at[found], found
