"""Numbers of words in another measure, as they were written: their digits, point and zeros."""

from __future__ import annotations

import re
from fractions import Fraction
from math import ceil, log10

#: A word with a plain number, as X-1.5, X=20, Z=IC(5) and SB=2000; what stands before the number, and the number.
_CONSTANT = re.compile(
    r"(?:[^-+.\d=()#]++(?:\d++=|=)?|=)?(?:(?:AC|IC|DC|ACP|ACN)\()?([-+]?(?:\d++\.?\d*+|\.\d++))\)?", re.IGNORECASE
)


def number_of(written: str) -> str | None:
    """The number of a word as it is written, without blanks; None where it is computed, or is none."""
    match = _CONSTANT.fullmatch("".join(written.split()))
    return match[1] if match else None


def rescaled(number: str, ratio: Fraction, least: Fraction, needs_point: bool) -> str:
    """
    A number multiplied by a ratio, rounded to a multiple of `least`; zeros at its end stay where the ratio is 1.

    needs_point: without a point the control would count a whole number in least increments.
    """
    had = len(number.partition(".")[2]) if ratio == 1 else 0
    has_zero = not re.match(r"[-+]?\.", number)
    return rounded(Fraction(number) * ratio, least, had, "." in number or needs_point, has_zero)


def rounded(value: Fraction, least: Fraction, digits: int = 0, has_point: bool = True, has_zero: bool = True) -> str:
    """
    A value rounded to a multiple of `least`.

    digits: behind the point at least. has_point: a whole number has a point. has_zero: 0.5, not .5.
    """
    count = round(value / least)
    most = max(0, ceil(-log10(least) - 1e-9))
    whole, decimals = divmod(round(abs(count * least) * 10**most), 10**most)  # of any length, which a float has not
    rest = f"{decimals:0{most}d}".rstrip("0").ljust(digits, "0")
    sign = "-" if count < 0 else ""
    if not rest:
        return f"{sign}{whole}{'.' if has_point and count else ''}"
    return f"{sign}{'' if not whole and not has_zero and count else whole}.{rest}"
