"""Numbers as a program for a machine writes them: rounded to its least increment, in the style of the program."""

from __future__ import annotations

import math
import re

from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rewrite.writing.style import PLAIN, Style

#: Digits behind the point of F, which no least increment rounds: per minute in mm, per minute in inch.
_FEED_DECIMALS = (3, 4)
_CODE = re.compile(r"([GM])0*+(\d*+)(\.\d++)?")


class Numbers:
    """
    Writes numbers of a program.

    machine: that reads them. style: how the program writes them. inch: its lengths are in inch.
    feed_inch: so is F; as `inch` where it is None. They differ behind a code of control.units_of_lengths_alone.
    line: of the original, from 1, that a refusal names.
    """

    def __init__(
        self, machine: Machine, style: Style = PLAIN, inch: bool = False, feed_inch: bool | None = None
    ) -> None:
        self.machine, self.style, self.inch = machine, style, inch
        self.feed_inch = inch if feed_inch is None else feed_inch
        self.feed_point = style.feed_point or machine.writing.feed_point
        self.line = 0
        control = machine.control
        self.least = control.least_increment_inch if inch else control.least_increment
        #: The least increment of a length [mm].
        self.step = self.least * (MM_PER_INCH if inch else 1.0)
        self._decimals = _decimals(self.least)
        #: The words that were written, by address and least increments: passes of a contour repeat them at each depth.
        self._words: dict[tuple[str, int], str] = {}

    def increments(self, length: float) -> int:
        """The least increments of a length [mm], rounded; lengths are the same where these are."""
        return round(length / self.step)

    def length(self, length: float) -> str:
        """A length [mm] as it is written, in mm or inch."""
        return self.of_increments(self.increments(length))

    def of_increments(self, count: int) -> str:
        """A length of so many least increments as it is written."""
        style, value = self.style, float(count * self.least)
        has_own = style.decimals is not None or value.is_integer()
        decimals = style.decimals if has_own else style.fraction_decimals
        return self._checked(f"{value:.{self._decimals}f}", decimals, style.point)

    def word(self, address: str, count: int) -> str:
        """A word of least increments; with = where its address is a name or ends with a digit, as C2=10."""
        key = address, count
        if key not in self._words:
            sign = "=" if len(address) > 1 and not address.endswith("=") else ""
            self._words[key] = address + sign + self.of_increments(count)
        return self._words[key]

    def angle(self, degrees: float) -> str:
        """An angle [deg] as it is written."""
        least = self.machine.control.least_increment
        fixed = f"{round(degrees / least) * least:.{_decimals(least)}f}"
        return self._checked(fixed, self.style.decimals, self.style.point)

    def rate(self, value: float) -> str:
        """F as a number in the units of the program, be it 1/min or deg/min: four decimals at most."""
        return self._checked(f"{value:.4f}", self.style.feed_decimals, self.feed_point, counts=self.feed_inch)

    def feed(self, feed: float) -> str:
        """F [mm/min] as it is written, in mm or inch per minute."""
        value = feed / (MM_PER_INCH if self.feed_inch else 1.0)
        text = f"{value:.{_FEED_DECIMALS[self.feed_inch]}f}"
        if not float(text) and feed > 0:
            text = f"{value:.9f}"
        return self._checked(text, self.style.feed_decimals, self.feed_point, counts=self.feed_inch)

    def code(self, code: str) -> str:
        """A G or M code as it is written: G1 or G01."""
        match = _CODE.fullmatch(code)
        if match is None:
            return code
        letter, number, rest = match.groups("")
        return letter + number.zfill(self.style.code_digits) + rest

    def code_for(self, key: str) -> str:
        """The first code of a list of the machine as it is written. Raises RefusedError where it has none."""
        codes = self.machine.codes(key)
        if not codes:
            text = f"no code of {self.machine.title} is known for that: {key.replace('_', ' ')}"
            raise RefusedError([Refusal(self.line, text)])
        return self.code(codes[0])

    def _checked(self, fixed: str, decimals: int | None, point: bool, counts: bool = True) -> str:
        """A number in the style of the program. counts: without a point the control may count it in increments."""
        whole, _, rest = fixed.lstrip("-").partition(".")
        rest = rest.rstrip("0")
        has_whole = whole.strip("0") != ""
        is_zero = not has_whole and not rest
        sign = "-" * (fixed.startswith("-") and not is_zero)
        if decimals is not None:
            rest = rest.ljust(decimals, "0")
        if len(whole + rest) > self.machine.control.digit_limit:
            raise RefusedError([Refusal(self.line, f"{fixed} has more digits than the control takes")])
        needs_point = counts and not is_zero and self.machine.control.number_without_point != "whole-unit"
        if not rest:
            return sign + whole + "." * (needs_point or (self.style.zero_point if is_zero else point))
        if not has_whole and not self.style.leading_zero:
            whole = ""
        return f"{sign}{whole}.{rest}"


def _decimals(least: float) -> int:
    """The digits behind the point of multiples of a least increment."""
    return max(0, math.ceil(-math.log10(least) - 1e-9))
