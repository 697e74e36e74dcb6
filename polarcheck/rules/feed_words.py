"""F words put in, lowered and restored, as they are written in the program."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.feed.feedrate import Feedrate
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.states import Motion, Units
from polarcheck.program.execution.run import Run
from polarcheck.rules.editing import Replace, is_plain, with_word, written_word
from polarcheck.rules.quantity import in_row

#: Below this a number of F without a point is not rounded down to whole ones.
LEAST_WHOLE = 10.0


def takes_feed(axes: PlaneAxes) -> Mask:
    """Rows that move at the F in force, inside the mode and outside."""
    return np.asarray(axes.moves & (axes.motion != Motion.RAPID))


def feed_in_force(blocks: ExecutedBlocks, feedrate: Feedrate, run: Run, row: int) -> int | None:
    """The executed F word in force at a row; None where none is, or a macro gives its number."""
    words = blocks.word_indices("F")
    found = words[run.words.start[words] == feedrate.feed_word[row]]
    if not len(found):
        return None
    index = int(found[0])
    return index if is_plain(run, int(run.row[index])) else None


def feed_below(blocks: ExecutedBlocks, lengths: Lengths, run: Run, row: int, feed: float) -> str | None:
    """
    The F word below a feed [mm/min], as the message says it, with a point where the program writes one or needs it.

    None where no feed is left.
    """
    shown = in_row(feed, lengths, row).as_feed
    text = f"{shown:below}".split()[0]
    if not float(text) > 0 or "e" in text:
        return None
    has_point = bool(writes_points(blocks, lengths, run)[row])
    if "." not in text:
        return f"F{text}{'.' * has_point}"
    if not has_point and float(text) >= LEAST_WHOLE:
        return f"F{float(text):.0f}" if float(text).is_integer() else f"F{int(float(text))}"
    return f"F{text.lstrip('0')}" if text.startswith("0.") else f"F{text}"


def feed_text(blocks: ExecutedBlocks, lengths: Lengths, run: Run, row: int, feed: float) -> str:
    """The F word of a feed [mm/min] in whole units of the program."""
    shown = in_row(feed, lengths, row).as_feed
    return f"F{round(shown.length(feed))}{'.' * bool(writes_points(blocks, lengths, run)[row])}"


def writes_points(blocks: ExecutedBlocks, lengths: Lengths, run: Run) -> Mask:
    """Rows in which F is written with a point: in inch, and where one of the program is."""
    words = blocks.word_indices("F")
    return np.asarray((lengths.feed_units == Units.INCH) | bool(run.words.has_point[words].any()))


def restored(trace: Trace, row: int) -> list[Replace] | None:
    """
    The F in force at a row written again where a move after it relies on it.

    Nothing where another F comes before that; None where the move has to be slow, and nobody knows how slow.
    """
    later = np.flatnonzero(takes_feed(trace.axes) & (np.arange(len(trace)) > row))
    begins = np.flatnonzero((trace.blocks.has("F") | trace.blocks.starts) & (np.arange(len(trace)) > row))
    if not len(later) or (len(begins) and begins[0] <= later[0]):
        return []
    index, first = feed_in_force(trace.blocks, trace.feedrate, trace.run, row), int(later[0])
    if index is None or not is_plain(trace.run, first):
        return None
    return [with_word(trace.run, first, written_word(trace.run, index))]
