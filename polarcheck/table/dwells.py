"""How long the control waits at a dwell, by the words that the machine has for it (feed.dwell_words)."""

from __future__ import annotations

import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.columns.trace import Trace
from polarcheck.machines.modal import FeedMode

#: Seconds that the number 1 stands for, with a decimal point and without; turns of a spindle are no time of their own.
_SECONDS = {
    "seconds": (1.0, 1.0),
    "hundredths": (0.01, 0.01),
    "thousandths": (np.nan, 0.001),
    "thousandths-or-seconds": (1.0, 0.001),
    "turns": (np.nan, np.nan),
}
#: Further words that are a time on some control.
_OF_ANY_CONTROL = ("X", "U", "P", "F", "K", "S")


def dwells(trace: Trace) -> Mask:
    """Rows with a dwell."""
    return trace.blocks.listed("dwell")


def in_turns(trace: Trace) -> Mask:
    """Rows with a dwell that counts turns of a spindle: by its word, or since feed per revolution is in force."""
    feed = trace.machine.feed
    by_word = [address for address, unit in feed.dwell_words.items() if unit == "turns"]
    by_mode = trace.modal.state("feed_mode") == FeedMode.PER_REVOLUTION
    by_mode &= (feed.dwell_per_revolution == "turns") & trace.blocks.has(*feed.dwell_words)
    return np.asarray(dwells(trace) & (trace.blocks.has(*by_word) | by_mode))


def time_of_dwells(trace: Trace) -> Floats:
    """
    How long each dwell takes [s]; NaN where no word of this machine says it, two do, or it counts turns.

    Without any word that is a time somewhere there is none, but an exact stop. Of other rows it means nothing.
    """
    words = trace.machine.feed.dwell_words
    if not dwells(trace).any():
        return np.zeros(len(trace))
    time, count = np.zeros(len(trace)), np.zeros(len(trace), np.int64)
    for address in dict.fromkeys((*words, *_OF_ANY_CONTROL)):
        at = trace.blocks.word_indices(address)
        row = trace.run.row[at]
        with_point, without_point = _seconds(trace, words.get(address, ""))
        time[row] = np.where(trace.run.words.has_point[at], with_point, without_point) * trace.run.words.value[at]
        np.add.at(count, row, 1)
    return np.where((count > 1) | in_turns(trace), np.nan, time)


def _seconds(trace: Trace, unit: str) -> tuple[float, float]:
    control = trace.machine.control
    if unit == "as-lengths":
        return 1.0, 1.0 if control.number_without_point == "whole-unit" else control.least_increment
    return _SECONDS.get(unit, (np.nan, np.nan))
