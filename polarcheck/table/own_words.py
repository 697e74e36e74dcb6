"""What X, F and the words of arc centers come to where the control takes them in its own way."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.machines.modal import FeedMode
from polarcheck.table.filling import fill_down

if TYPE_CHECKING:
    from polarcheck.table.trace import Trace


_FACTOR = {"diameter": 0.5, "radius": 1.0}


class OwnWords:
    """Columns of one trace, one value per row."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    @property
    def center_words(self) -> tuple[str, str]:
        """Addresses of arc centers, along the linear and along the virtual axis."""
        return self.trace.machine.polar.center_words

    @property
    def other_center_word(self) -> str:
        """The address of arc centers that is of no axis of the polar plane."""
        return next(word for word in ("K", "I", "J") if word not in self.center_words)

    def other_center(self, row: int) -> str:
        """That word as it is written."""
        return self.trace.modes.written(self.other_center_word, row)

    def center_along(self, row: int) -> str:
        """`I along X and J along C`."""
        linear, virtual = self.center_words
        return f"{linear} along X and {virtual} along {self.trace.machine.polar.virtual_axis}"

    @property
    def virtual_factor(self) -> float:
        """Radius per written length of the virtual axis."""
        return _FACTOR[self.trace.machine.polar.virtual_axis_is]

    @cached_property
    def x_factor(self) -> Floats:
        """Radius per written X: a half where X is a diameter."""
        trace, control = self.trace, self.trace.machine.control
        factor = np.where(trace.section >= 0, _FACTOR[trace.machine.polar.x], _FACTOR[control.x])
        if not (control.x_radius_words or control.x_diameter_words):
            return factor
        radius, diameter = self._with(control.x_radius_words), self._with(control.x_diameter_words)
        switched = radius | diameter | trace.starts
        chosen = fill_down(np.where(radius, 1.0, np.where(diameter, 0.5, np.nan)), switched, np.nan)
        return np.asarray(np.where(np.isnan(chosen), factor, chosen), np.float64)

    def _with(self, words: Iterable[str]) -> Mask:
        """Rows with one of the codes and, where it asks for another word too, with that: `G10.9 X0`."""
        rows = np.zeros(len(self.trace), bool)
        for word in words:
            code, _, other = word.partition(" ")
            found = self.trace.codes(code)
            rows |= found & (self.trace.word(other[0]) == float(other[1:])) if other else found
        return rows

    def feed_number(self, as_written: Floats) -> Floats:
        """
        F in force, of the F that the words alone would give.

        On a control where F of the mode is per minute only and feed per revolution is in force at G12.1, the F of the
        mode ends with it: after G13.1 the one from before is in force again (M700V p. 73, both tables of item 8).
        """
        trace = self.trace
        if trace.machine.feed.inheritance != "per-minute-only" or not len(trace.sections):
            return as_written
        entered = trace.feed_mode[trace.sections.enter] == FeedMode.PER_REVOLUTION
        own = trace.in_polar & entered[trace.section]
        written_outside = (trace.has("F") | trace.starts) & ~own
        return np.where(own, as_written, fill_down(as_written, written_outside, np.nan))

    @cached_property
    def override(self) -> Floats:
        """
        Share of F that automatic override leaves in each row [%]; 100 where the machine has none or it does not act.

        It acts where C would turn faster than override_share of its limit, and leaves that (B-64120EN/01 p. 280).
        """
        trace, limits = self.trace, self.trace.machine.limits
        share = np.full(len(trace), 100.0)
        if limits.automatic_override and not np.isnan(limits.c_feed):
            np.divide(100 * trace.c_feed_limit, trace.c_feed, out=share, where=~(trace.c_feed <= trace.c_feed_limit))
        return share

    @cached_property
    def true_feed(self) -> Floats:
        """F that automatic override leaves [mm/min]."""
        return np.asarray(self.trace.feed * self.override / 100)
