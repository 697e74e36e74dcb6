"""Spindles with a number in their words, as S2=2000 and M2=3: which of them has a speed and is started by nothing."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows, repeated
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.axis_table import OF_SPINDLE

_FUNCTION = lazy_pattern(r"([MS])\s*(\d+)\s*=")
#: Longest text up to the = of such a word [characters].
_LENGTH = 16
_STARTS = (3, 4)
_NONE = -1


def unstarted_speeds(trace: Trace) -> Rows:
    """
    Per row the executed word with a speed above 0 for a spindle by its number that the run never starts; -1 for none.

    Where a program makes another spindle the master, or starts another one by its number that has a speed, which of
    them is the live tool is not known, and nothing is returned; nor is anything below a row of unknown effect.
    """
    words, none = trace.run.words, repeated(np.int64(_NONE), len(trace))
    indices = np.flatnonzero(words.address == OF_SPINDLE)
    if not len(indices) or not trace.modal.main_is_master.all():
        return none
    speeds: dict[int, list[int]] = {}
    started: set[int] = set()
    for index in indices.tolist():
        start = int(words.start[index])
        match = _FUNCTION.match(trace.text.source.excerpt(start, start + _LENGTH).upper())
        if match and match[1] == "S":
            speeds.setdefault(int(match[2]), []).append(index)
        elif match and words.value[index] in _STARTS:
            started.add(int(match[2]))
    if started & set(speeds):
        return none
    # S2= of a dwell counts turns, and that of G26 is a limit.
    is_speed = ~trace.blocks.listed("dwell", "axis_words_no_move")[trace.run.row] & (words.value > 0)
    unstarted = [index for of_spindle in speeds.values() for index in of_spindle if is_speed[index]]
    if not unstarted:
        return none
    of_row = none.copy()
    of_row[trace.run.row[unstarted]] = unstarted
    row = last_row(of_row >= 0, trace.blocks.starts | trace.run.unknown)
    is_whole = trace.blocks.whole_program | trace.tools.has_called_tool
    return np.where(is_whole & (row >= 0), of_row[row], _NONE)
