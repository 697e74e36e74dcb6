"""Values of one row as messages show them: in the program's own units, with the digits that a program writes."""

from __future__ import annotations

from typing import Any

import numpy as np

from polarcheck.machines.modal import MM_PER_INCH, Units
from polarcheck.table.trace import Trace


class Quantity:
    """
    A value of one row that knows how to show itself.

    Formats beyond Python's: `length` and `feed` turn mm and mm/min to the program's units, `diameter` doubles a radius
    where the program writes diameters, `point` shows a plane point as X and C words.
    """

    def __init__(self, value: Any, inch: bool, diameter: bool) -> None:
        self.value = value
        self.inch = inch
        self.diameter = diameter

    def __format__(self, form: str) -> str:
        value = self.value
        if form == "length":
            return f"{_short(self.length(value), self.inch)} {self.unit}"
        if form == "diameter":
            return f"{_short(self.length(value) * (2 if self.diameter else 1), self.inch)} {self.unit}"
        if form == "feed":
            return f"{_rounded_down(self.length(value))} {self.unit}/min"
        if form == "point":
            x = self.length(value.real) * (2 if self.diameter else 1)
            return f"X{_short(x, self.inch)} C{_short(self.length(value.imag), self.inch)}"
        return format(value, form)

    def length(self, value: float) -> float:
        """mm to the program's unit."""
        return value / MM_PER_INCH if self.inch else value

    @property
    def unit(self) -> str:
        """mm or inch."""
        return "inch" if self.inch else "mm"

    @property
    def data(self) -> Any:
        """The value as JSON can hold it, inside units (mm, deg, min)."""
        value = self.value
        if isinstance(value, complex):
            return [_finite(value.real), _finite(value.imag)]
        if isinstance(value, float):
            return _finite(value)
        return value


def _finite(value: float) -> float | None:
    return round(value, 9) if np.isfinite(value) else None


def _short(value: float, inch: bool) -> str:
    """At most the digits that a program writes."""
    text = f"{value:.{4 if inch else 3}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def _rounded_down(value: float) -> str:
    """Three significant digits, never above the value: a highest F must be allowed itself."""
    if not np.isfinite(value) or value <= 0:
        return f"{value:g}"
    places = 2 - int(np.floor(np.log10(value)))
    scaled = np.floor(value * 10.0**places + 1e-9) / 10.0**places
    return f"{scaled:.{max(places, 0)}f}".rstrip("0").rstrip(".") if places > 0 else f"{scaled:.0f}"


def in_row(value: Any, trace: Trace, row: int) -> Quantity:
    """A value [mm, mm/min, radius] as the program of a row of the trace would write it; row -1: in mm and diameters."""
    if row < 0:
        return Quantity(value, False, True)
    return Quantity(value, bool(trace.units[row] == Units.INCH), bool(trace.x_factor[row] < 1))
