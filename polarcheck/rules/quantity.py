"""Values of one row as messages show them: in the program's own units, with the digits that a program writes."""

from __future__ import annotations

from typing import Any

import numpy as np

from polarcheck.columns.path.lengths import Lengths
from polarcheck.foundation.states import MM_PER_INCH, Units

#: A member of an enum is looked up anew for each comparison with a number of NumPy.
_INCH = int(Units.INCH)
#: Digits behind the point that a program writes, in mm and in inch.
_DIGITS = {"length": (3, 4), "diameter": (3, 4), "feed": (3, 4), "whole": (0, 0)}
#: A nanometer, and as much of a degree.
_CONTRACT_DIGITS = 6
#: Values that agree in so many digits more are the same.
_MOST_DIGITS = 9


class Quantity:
    """
    A value of one row that knows how to show itself.

    Formats beyond Python's: `length` and `feed` turn mm and mm/min to the program's units, `diameter` doubles a radius
    where the program writes diameters, `highest` is a feed of three digits that is never above the value, `below` one
    that is not equal to it either, `whole` has no digits behind the point, `point` shows a plane point as X and C
    words, `blocks` tells a number of blocks above one. feed_inch: what F counts, where that is another unit.
    """

    def __init__(self, value: Any, inch: bool, diameter: bool, feed_inch: bool | None = None) -> None:
        self.value = value
        self.inch = inch
        self.feed_inch = inch if feed_inch is None else feed_inch
        self.diameter = diameter

    def __format__(self, form: str) -> str:
        if form in _DIGITS:
            return self.shown(form)
        value = self.value
        if form in ("highest", "below"):
            feed = self.as_feed
            return f"{_rounded_down(feed.length(value), form == 'below')} {feed.unit}/min"
        if form == "point":
            x, c = self.length(value.real) * (2 if self.diameter else 1), self.length(value.imag)
            digits = _DIGITS["length"][self.inch]
            return f"X{_short(x, digits)} C{_short(c, digits)}"
        if form == "blocks":
            return f" (in {value} blocks)" if value > 1 else ""
        return format(value, form)

    def shown(self, form: str, more: int = 0) -> str:
        """In the form `length`, `diameter`, `feed` or `whole`; more: digits beyond those that a program writes."""
        if form == "feed" and self.feed_inch != self.inch:
            return self.as_feed.shown(form, more)
        digits = _DIGITS[form][self.inch] + more
        if form == "whole":
            return _short(self.value, digits)
        factor = 2 if form == "diameter" and self.diameter else 1
        return f"{_short(self.length(self.value) * factor, digits)} {self.unit}{'/min' if form == 'feed' else ''}"

    def beside(self, other: Quantity, form: str) -> str:
        """With as many digits as it takes to tell it from another value that is shown in the same form."""
        texts = ((self.shown(form, more), other.shown(form, more)) for more in range(_MOST_DIGITS))
        return next((text for text, of_other in texts if text != of_other), self.shown(form))

    def highest_feed(self, form: str) -> float:
        """The feed that the forms `highest` and `below` show [mm/min]."""
        feed = self.as_feed
        return float(_rounded_down(feed.length(self.value), form == "below")) * (MM_PER_INCH if feed.inch else 1)

    @property
    def as_feed(self) -> Quantity:
        """The same in the unit that F counts."""
        return self if self.feed_inch == self.inch else Quantity(self.value, self.feed_inch, self.diameter)

    def length(self, value: float) -> float:
        """mm to the program's unit."""
        return value / MM_PER_INCH if self.inch else value

    @property
    def unit(self) -> str:
        """mm or inch."""
        return "inch" if self.inch else "mm"


def rounded(value: float) -> float | None:
    """A number of a contract as JSON can hold it, without the dust of the last bits; None where it is not known."""
    return round(float(value), _CONTRACT_DIGITS) + 0.0 if np.isfinite(value) else None


def _short(value: float, digits: int) -> str:
    """At most so many digits behind the point."""
    text = f"{value:.{digits}f}"
    text = text.rstrip("0").rstrip(".") if digits else text
    return "0" if text in ("-0", "") else text


def _rounded_down(value: float, below: bool) -> str:
    """Three significant digits, never above the value, nor equal to it where below: a highest F must be allowed."""
    if not np.isfinite(value) or value <= 0:
        return f"{value:g}"
    places = 2 - int(np.floor(np.log10(value)))
    whole = value * 10.0**places
    scaled = (np.ceil(whole - 1e-6) - 1 if below else np.floor(whole + 1e-9)) / 10.0**places
    return f"{scaled:.{max(places, 0)}f}".rstrip("0").rstrip(".") if places > 0 else f"{scaled:.0f}"


def in_row(value: Any, lengths: Lengths, row: int) -> Quantity:
    """A value [mm, mm/min, radius] as the program of a row of the trace would write it; row -1: in mm and diameters."""
    if row < 0:
        return Quantity(value, False, True)
    inch, feed_inch = (int(units[row]) == _INCH for units in (lengths.units, lengths.feed_units))
    return Quantity(value, inch, bool(lengths.x_factor[row] < 1), feed_inch)
