"""How a program is written: what a machine does not care for and its reader does."""

from __future__ import annotations

from typing import Literal

import msgspec


class Style(msgspec.Struct, frozen=True):
    """
    How a program writes its words. The default is plain, as in `G1 X10. C-0.5`.

    blank: between the words of a block, a blank or nothing.
    lower_case: letters are small.
    code_digits: least digits of a G or M code, 2 for G01.
    decimals: digits behind the point of each length, zeros at the end included; None where these are left out.
    fraction_decimals: the same of lengths that are not whole: C8.660 beside X30.
    point: a whole number has a point, as in X10.
    zero_point: so has zero, as in X0.
    leading_zero: X0.5, not X.5.
    feed_decimals, feed_point: the same of F.
    numbered: which blocks have an N word.
    number_step: from one N word to the next.
    number_digits: least digits, 4 for N0010.
    repeats_motion: G1 stands in every block that moves.
    repeats_axes: X and the virtual axis stand in each, even where one does not change.
    repeats_feed: so does F.
    by_center: arcs are written by I and J (True) or by their radius (False); None where no arc says it.
    """

    blank: str = " "
    lower_case: bool = False
    code_digits: int = 1
    decimals: int | None = None
    fraction_decimals: int | None = None
    point: bool = True
    zero_point: bool = False
    leading_zero: bool = True
    feed_decimals: int | None = None
    feed_point: bool = False
    numbered: Literal["none", "some", "all"] = "none"
    number_step: int = 10
    number_digits: int = 1
    repeats_motion: bool = False
    repeats_axes: bool = False
    repeats_feed: bool = False
    by_center: bool | None = None


PLAIN = Style()
