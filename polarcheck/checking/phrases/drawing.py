"""Phrases about the part beside its drawing."""

from __future__ import annotations

import math

from polarcheck.checking.phrases.common import short
from polarcheck.checking.quantity import in_row
from polarcheck.table.deviations import Comparison, Deviations, Fit, title_of
from polarcheck.table.trace import Trace

#: A turn below this is none [rad].
_NO_TURN = 1e-5


def deviation(trace: Trace, deviations: Deviations, row: int) -> str:
    """How the part of a row differs from what it should be, where, and how it would fit."""
    return told(trace, deviations.of_row(row))


def told(trace: Trace, one: Comparison) -> str:
    """The same of a comparison, in the units of the program."""
    tolerance = in_row(one.tolerance, trace, one.row)
    found, row = one.difference, one.row
    title = short(one.title)
    if one.is_other_way_round:
        kinds = ("a boss", "a pocket")
        should, does = kinds if not one.part.is_pocket else kinds[::-1]
        return f"the contour makes {does} where {title} is {should}: the tool is on the wrong side"
    if one.agrees:
        size = f"{in_row(found.largest, trace, row):length}"
        if found.largest <= 0:
            return f"agrees with {title}, tolerance {tolerance:length}"
        return (
            f"agrees with {title} within {size}, tolerance {tolerance:length}, worst at {_where(trace, one, found.at)}"
        )
    sides = [
        (found.proud, found.proud_at, "too much stays"),
        (found.deep, found.deep_at, "too much is cut away"),
    ]
    sides = [side for side in sorted(sides, key=lambda side: -side[0]) if side[0] > one.tolerance]
    places = ", and ".join(
        f"{in_row(size, trace, row).beside(tolerance, 'length')} {what} at {_where(trace, one, at)}"
        for size, at, what in sides
    )
    return f"the part differs from {title}: {places}; {tolerance:length} is allowed{_fit(trace, one, one.fit)}"


def _where(trace: Trace, one: Comparison, point: complex) -> str:
    return f"{in_row(point, trace, one.row):point}"


def _fit(trace: Trace, one: Comparison, fit: Fit | None) -> str:
    """How the drawing would have to be placed to fit."""
    if fit is None:
        return ""
    ways = ["mirrored, with C of the other sign"] if fit.mirrored else []
    if abs(fit.turned) > _NO_TURN:
        ways.append(f"turned by {math.degrees(fit.turned):.3f}".rstrip("0").rstrip(".") + " deg")
    if fit.factor != 1:
        ways.append(f"with {'twice' if fit.factor > 1 else 'half of'} its X, as diameter and radius are mixed up")
    return f". The part would fit {' and '.join(ways)}: within {in_row(fit.largest, trace, one.row):length}"


def compared_with(deviations: Deviations, number: int) -> str:
    """What the contours are compared with: part.dxf, the hexagon asked for by [[part]] 2."""
    part = deviations.parts[number]
    of_several = f" by [[part]] {number + 1}" if part.drawing is None and len(deviations.parts) > 1 else ""
    return f"{short(title_of(part))}{of_several}"
