"""Phrases about the part beside its drawing."""

from __future__ import annotations

import cmath
import math

from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import MM_PER_INCH, Units
from polarcheck.parts.deviations import Deviations
from polarcheck.parts.part_comparison import Comparison, Fit, title_of
from polarcheck.rules.quantity import Quantity, in_row
from polarcheck.rules.wording.part import Sizes, shape_in_words
from polarcheck.rules.wording.written import point, short

#: A turn below this is none [rad].
_NO_TURN = 1e-5
#: A smaller difference is none that anybody measures: the last digit of a size in mm, and in inch [mm].
_LEAST = 1e-3, 1e-4 * MM_PER_INCH


def told(trace: Trace, one: Comparison) -> str:
    """A comparison in words, in the units of the program; also one that agrees."""
    title, found = short(one.title), one.difference
    largest, tolerance = in_row(found.largest, trace.lengths, one.row), in_row(one.tolerance, trace.lengths, one.row)
    if not one.agrees:
        by = f"by {largest.beside(tolerance, 'length')}, {tolerance:length} is allowed"
        return f"differs from {title} {by}: {deviation(trace, one)}"
    least, shown = _LEAST[largest.inch], _least(trace.lengths, one, found.largest)
    where = ""
    if found.largest > least and not cmath.isnan(found.at):
        where = f", largest at {_where(trace, one, found.at)} by line {int(trace.blocks.line[one.row])}"
    angle = f"; its angle was not compared: {one.angle_not_compared}" if one.angle_not_compared else ""
    within = f"within {shown:length} (tolerance {tolerance:length})"
    return f"agrees with {title} {within}{where}{_turned_round(trace, one)}{angle}"


def _turned_round(trace: Trace, comparison: Comparison) -> str:
    """What of a drawing is not milled: its round."""
    radius = comparison.difference.turned
    if comparison.part.drawing is None or not math.isfinite(radius):
        return ""
    across = Sizes(bool(trace.lengths.units[comparison.row] == Units.INCH))(2 * radius)
    return f"; its round of {across} is not milled"


def deviation(trace: Trace, one: Comparison) -> str:
    """How a part differs from what it should be, where, and how it would fit."""
    found = one.difference
    if one.is_other_way_round:
        does, should = ("a boss", "a pocket") if one.part.is_pocket else ("a pocket", "a boss")
        return f"it is {does}, and {should} is asked for: the tool is on the wrong side"
    if not one.is_made:
        return f"nothing mills its walls{_fit(trace.lengths, one, one.fit)}{_made(trace, one)}"
    sides = [(found.proud, found.proud_at, "too much stays"), (found.deep, found.deep_at, "too much is cut away")]
    (_, worst, what), (size, place, other) = sorted(sides, key=lambda side: -side[0])
    more = ""
    if size > one.tolerance:
        more = f", and {in_row(size, trace.lengths, one.row):length} {other} at {_where(trace, one, place)}"
    return f"{what} at {_where(trace, one, worst)}{more}{_fit(trace.lengths, one, one.fit)}{_made(trace, one)}"


def _made(trace: Trace, one: Comparison) -> str:
    """What is made in the place of the part."""
    sizes = Sizes(bool(trace.lengths.units[one.row] == Units.INCH))
    shapes = (shape_in_words(shape, lambda row: int(trace.blocks.line_in_file[row]), sizes) for shape in one.made)
    return "".join(f"; it makes: {shape}" for shape in shapes)


def _least(lengths: Lengths, one: Comparison, size: float) -> Quantity:
    """A difference, but no smaller than what anybody measures."""
    return in_row(max(size, _LEAST[in_row(size, lengths, one.row).inch]), lengths, one.row)


def _where(trace: Trace, one: Comparison, place: complex) -> str:
    return point(trace, one.written(place), one.row)


def _fit(lengths: Lengths, one: Comparison, fit: Fit | None) -> str:
    """How the part, or what it is compared with, would have to be placed to fit."""
    if fit is None:
        return ""
    placement = fit.placement
    is_drawn, is_any_angle = one.part.drawing is not None, not math.isnan(one.turned)
    if placement.scale != 1 or (placement.shift and is_drawn):
        what = "drawing" if is_drawn else f"{one.part.shape}"
        ways = [*_scaled(placement.scale), *_mirrored(placement.mirrored), *_stretched(placement.x_factor)]
        ways += [*_turned(0 if is_any_angle else placement.turned), *_shifted(lengths, one.row, placement.shift)]
    else:
        # The opposite change of the part; a mirrored one is turned to the same side.
        what, angle = "part", placement.turned if placement.mirrored else -placement.turned
        ways = [*_shifted(lengths, one.row, -placement.shift), *_mirrored(placement.mirrored)]
        ways += [*_turned(0 if is_any_angle else angle), *_stretched(1 / placement.x_factor)]
    return f". The {what} would fit {' and '.join(ways)}: within {_least(lengths, one, fit.largest):length}"


def _scaled(scale: float) -> list[str]:
    if scale == 1:
        return []
    return [f"{MM_PER_INCH} times as {'large (as one in inch)' if scale > 1 else 'small (as one in mm)'}"]


def _mirrored(mirrored: bool) -> list[str]:
    return ["mirrored, with C of the other sign"] if mirrored else []


def _stretched(factor: float) -> list[str]:
    if factor == 1:
        return []
    return [f"with {'twice' if factor > 1 else 'half of'} its X, as diameter and radius are mixed up"]


def _turned(angle: float) -> list[str]:
    if abs(angle) <= _NO_TURN:
        return []
    return ["turned by " + f"{math.degrees(angle):.2f}".rstrip("0").rstrip(".") + " deg"]


def _shifted(lengths: Lengths, row: int, shift: complex) -> list[str]:
    if not shift:
        return []
    sizes = Sizes(bool(lengths.units[row] == Units.INCH))
    return [f"shifted by x {sizes(shift.real)} c {sizes(shift.imag)}"]


def compared_with(deviations: Deviations, number: int) -> str:
    """What the contours are compared with: part.dxf, the hexagon asked for by [[part]] 2."""
    part = deviations.parts[number]
    of_several = f" by [[part]] {number + 1}" if part.drawing is None and len(deviations.parts) > 1 else ""
    return f"{short(title_of(part))}{of_several}"
