"""How long the control waits at a dwell, by the words that the machine has for it (feed.dwell_words)."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows
from polarcheck.foundation.states import FeedMode

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
    How long each dwell takes [s]; NaN where no word of this machine says it, several do, or it counts turns.

    A dwell without any such word is an exact stop, with no time. The value of other rows means nothing.
    """
    words = trace.machine.feed.dwell_words
    time, word_count = _sums(trace, words)
    _, foreign = _sums(trace, dict.fromkeys((word for word in _OF_ANY_CONTROL if word not in words), ""))
    is_open = (word_count > 1) | (
        (word_count == 0) & ((foreign > 0) | _has_other_words(trace, word_count + foreign == 0))
    )
    return np.where(is_open | in_turns(trace) | (time < 0), np.nan, time)


def _sums(trace: Trace, words: Mapping[str, str]) -> tuple[Floats, Rows]:
    """Per row the time of the last of these words [s], and how many of them there are."""
    time, count = np.zeros(len(trace)), np.zeros(len(trace), np.int64)
    for address, unit in words.items():
        index = trace.blocks.word_indices(address)
        row = trace.run.row[index]
        time[row] = _seconds(trace, unit, index)
        np.add.at(count, row, 1)
    return time, count


def _seconds(trace: Trace, unit: str, index: Rows) -> Floats:
    """The values of these words in seconds."""
    words, control = trace.run.words, trace.machine.control
    with_point, without_point = _SECONDS.get(unit, (np.nan, np.nan))
    if unit == "as-lengths":
        with_point = 1.0
        without_point = 1.0 if control.number_without_point == "whole-unit" else control.least_increment
    seconds = np.where(words.has_point[index], with_point, without_point) * words.value[index]
    # A calculated value has no point to be looked at: P#1 is a whole number of thousandths.
    is_calculated = words.has_point[index] & (words.digits[index] == 0)
    if unit == "thousandths":
        seconds = np.where(is_calculated, 0.001 * np.rint(words.value[index]), seconds)
    return np.where(is_calculated & (unit == "thousandths-or-seconds"), np.nan, seconds)


def _has_other_words(trace: Trace, rows: Mask) -> Mask:
    """Dwells in these rows with a word that is not read, as S2=30."""
    blocks, has_equals = trace.text.blocks, np.zeros(len(trace), bool)
    for row in np.flatnonzero(dwells(trace) & rows).tolist():
        block = int(trace.run.block[row])
        has_equals[row] = "=" in trace.text.written(blocks, block)
    return has_equals
