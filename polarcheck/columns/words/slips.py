"""Slips in the writing of a number: which other number was meant, if it is one slip away from what is written."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from polarcheck.foundation.patterns import lazy_pattern

#: A word as it is written: its address and its number.
WORD = lazy_pattern(r"([A-Za-z]+=?)([+-]?+(?:\d++\.?+\d*+|\.\d++))")
_NUMBER = lazy_pattern(r"([+-]?)(\d*+)(\.?)(\d*+)")
#: Factors by which a point at another place, or a radius for a diameter, changes a number.
_POINTS, _FACTORS = (10.0, 0.1, 100.0, 0.01, 1000.0, 0.001), (2.0, 0.5)


class Slip(NamedTuple):
    """
    What a number may be instead of what is written.

    text: as it would be written. kind: in the words of a shop. plain: no other design is likely to differ by it.
    is_common: it is often made.
    """

    text: str
    kind: str
    plain: bool
    is_common: bool = True


def parts_of(word: str) -> tuple[str, str]:
    """The address and the number of a word as it is written; both empty where it is no plain number."""
    match = WORD.fullmatch("".join(word.split()))
    return (match[1], match[2]) if match is not None else ("", "")


def slip_of(written: str, meant: float, tolerance: float) -> Slip | None:
    """The slip that makes what is written of a number near the one that is meant; None where none does."""
    best: tuple[float, Slip] | None = None
    for slip in slips_of(written):
        off = abs(float(slip.text) - meant)
        if off <= tolerance and (best is None or (not slip.plain, off) < (not best[1].plain, best[0])):
            best = off, slip
    return best[1] if best else None


def slips_of(written: str) -> Iterator[Slip]:
    """All numbers that are one slip away from what is written of a number."""
    match = _NUMBER.fullmatch(written)
    if match is not None and (match[2] or match[4]):
        yield from (slip for slip in _slips(*match.groups()) if slip.text.strip("+-.") not in ("", "."))


def _slips(sign: str, whole: str, point: str, rest: str) -> Iterator[Slip]:
    digits, places = whole + rest, len(rest)

    def number(digits: str, places: int) -> str:
        digits = digits.rjust(places + 1, "0")
        text = f"{digits[: len(digits) - places]}.{digits[len(digits) - places :]}"
        return sign + (text.lstrip("0") if not text.startswith("0.") else text)

    yield Slip(("" if sign == "-" else "-") + number(digits, places).lstrip("+-"), "the sign is wrong", True)
    for at in range(len(digits) - 1):
        swapped = digits[:at] + digits[at + 1] + digits[at] + digits[at + 2 :]
        yield Slip(number(swapped, places), "two digits are swapped", True)
    value = float(f"{sign}{whole or '0'}.{rest}")
    for factor in _POINTS:
        yield Slip(plain_number(value * factor), "the point is at the wrong place", True)
    for at in range(len(digits)):
        doubled = at not in (0, len(whole)) and digits[at] == digits[at - 1]
        less = places - (at >= len(whole))
        yield Slip(number(digits[:at] + digits[at + 1 :], less), "a digit is too many", bool(doubled))
        for other in "0123456789":
            yield Slip(number(digits[:at] + other + digits[at + 1 :], places), "a digit is wrong", False, False)
    for at in range(len(digits) + 1):
        for other in "0123456789":
            longer = digits[:at] + other + digits[at:]
            if at <= len(whole):
                yield Slip(number(longer, places), "a digit is missing", at < len(whole))
            if at >= len(whole):
                yield Slip(number(longer, places + 1), "a digit is missing", at < len(digits), at < len(digits))
    for factor in _FACTORS:
        yield Slip(plain_number(value * factor), "it is half or twice as large", False)


def plain_number(value: float) -> str:
    """A number as programs write it, with a point."""
    text = f"{value:.4f}".rstrip("0")
    return "0" if float(text) == 0 else text
