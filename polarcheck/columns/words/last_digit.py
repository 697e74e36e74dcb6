"""What the last digit of the coordinates leaves open: how finely X and the virtual axis are written."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Points, Rows, folded

#: Nobody means a coarser digit than this many least increments: X20. is 20, and no number between 19.5 and 20.5.
_COARSEST = 10
#: Least and greatest distance that counts as the same place [mm], in halves of the last digit.
_SAME, _SAME_AT_MOST, _DIGITS = 0.005, 0.03, 5


def half_of_last_digit(trace: Trace) -> Points:
    """
    Per row of a section half of the last digit in X, as a radius, and in the virtual axis [mm]; NaN outside.

    It is that of the number with the most decimals in the section, since posts leave out zeros at the end. Numbers
    without any are taken as exact to the least increment.
    """
    x = _last_digit(trace, trace.blocks.word_indices("X", "U")) * trace.lengths.x_factor
    virtual = _last_digit(trace, trace.axes.virtual_words)
    return np.asarray(
        np.where(trace.mode.section >= 0, (x + 1j * virtual) * trace.lengths.scale / 2, complex("nan+nanj"))
    )


def same_place(half_of_digit: complex) -> float:
    """How far two points may be apart that are the same place [mm]. half_of_digit: of X and the virtual axis [mm]."""
    return float(np.clip(_DIGITS * abs(half_of_digit), _SAME, _SAME_AT_MOST))


def _last_digit(trace: Trace, words: Rows) -> Floats:
    """Of these words the finest digit in each section, per row."""
    section = trace.mode.section[trace.run.row[words]]
    own = trace.run.words.decimals[words]
    decimals = folded(np.maximum, section, np.where(section >= 0, own, 0), len(trace.mode.sections) + 1, 0)
    finest, least = 10.0**-decimals, trace.lengths.least_increment
    is_written = (decimals > 0)[trace.mode.section]
    return np.where(is_written, np.minimum(finest[trace.mode.section], _COARSEST * least), least)
