from __future__ import annotations

from polarcheck.checking.repair import FEED, Mended, repair
from polarcheck.reading.words import Text
from polarcheck.table.unpointed import Unpointed


@repair(FEED)
def number_without_point(text: Text, unpointed: Unpointed, index: int) -> Mended | None:
    """
    The missing decimal point is put behind the number.

    Where one finding stands for all coordinates of a section, all of them get one. There is no fix for numbers of 1000
    or more, nor for a program that is written in least increments throughout. Unsafe: the number is 1000 times as
    large for the control.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20 (NO POINT)
        X-40.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20. (NO POINT)
        X-40.
        G13.1

    Bad:

        G20 G98 G0 X2.5 C0
        G12.1
        G1 X1.5 F8
        C.5
        G13.1

    Good:

        G20 G98 G0 X2.5 C0
        G12.1
        G1 X1.5 F8.
        C.5
        G13.1
    """
    ends = [int(text.words.end[word]) for word in unpointed.stands_for(index)]
    return Mended("Write the decimal point", False, tuple((end, end, ".") for end in ends))
