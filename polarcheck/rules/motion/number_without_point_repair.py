from __future__ import annotations

import numpy as np

from polarcheck.columns.words.unpointed import Unpointed
from polarcheck.program.reading.words import Text
from polarcheck.rules.repair import FEED, Mended, repair


@repair(FEED)
def number_without_point(text: Text, unpointed: Unpointed, index: int) -> Mended | None:
    """
    The missing decimal point is put behind the number.

    One finding stands for all of a program, and all of them get one: all coordinates, or all F. There is no fix for
    numbers of 1000 or more, for a program that is written in least increments throughout, nor for an F that would then
    be above all that the machine recommends: F200 in inch may well be meant as the 2 inch/min that it is. Unsafe: the
    number is 1000 times as large for the control.

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
    if _is_above_all(unpointed, int(text.words.start[index])):
        return None
    ends = [int(text.words.end[word]) for word in unpointed.stands_for(index)]
    return Mended("Write the decimal point", False, tuple((end, end, ".") for end in ends))


def _is_above_all(unpointed: Unpointed, start: int) -> bool:
    """Whether the word at a position is an F that with its point is above every range of the machine."""
    trace = unpointed.trace
    words = trace.run.words
    at = np.flatnonzero((words.start == start) & (words.address == ord("F")))
    feeds = trace.machine.feed
    return bool(
        np.any(trace.feedrate.feed[trace.run.row[at]] > np.fmax(feeds.cutting_maximum, feeds.positioning_maximum))
    )
