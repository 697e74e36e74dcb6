"""Rows by what they contain, to look up what the blocks after a row depend on."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows
from polarcheck.foundation.states import Motion
from polarcheck.rewrite.writing.new_blocks import jump_numbers


class Following:
    """
    The rows of a program by what they contain, in order.

    moves, turns, on_plane, at_feed: rows that move; that move C; X or C; at feed.
    motion, feed_mode: rows with a code of that group.
    feed: rows with F.
    jump_targets: True for a row with an N word whose number stands in a statement, or beside P or Q.
    """

    def __init__(self, trace: Trace) -> None:
        axes, modal, blocks = trace.axes, trace.modal, trace.blocks
        rotary = trace.machine.polar.rotary_words
        moves = axes.motion != Motion.NONE
        self._count = len(trace)
        self._starts = np.flatnonzero(blocks.starts)
        self.moves, self.turns, self.on_plane, self.at_feed = (
            np.flatnonzero(mask)
            for mask in (
                moves,
                moves & blocks.has(*rotary),
                moves & blocks.has("X", "U", *rotary),
                moves & (axes.motion != Motion.RAPID),
            )
        )
        self.motion, self.feed_mode = (np.flatnonzero(modal.sets(group)) for group in ("motion", "feed_mode"))
        self.feed = np.flatnonzero(blocks.has("F"))
        self.jump_targets = _jump_targets(trace)

    def behind(self, row: int, rows: Rows) -> int:
        """Return the first of some rows after a row, in the same program; the number of all rows if there is none."""
        following, end = (self._next(row, ascending) for ascending in (rows, self._starts))
        return following if following < end else self._count

    def _next(self, row: int, rows: Rows) -> int:
        index = int(rows.searchsorted(row, "right"))
        return int(rows[index]) if index < len(rows) else self._count

    def takes_over(self, row: int, users: Rows, setters: Rows) -> bool:
        """Return True if after this row a user of a state comes before the next setter of that state."""
        return self.behind(row, users) < self.behind(row, setters)


def _jump_targets(trace: Trace) -> Mask:
    run, numbers = trace.run, jump_numbers(trace.text)
    if not numbers:
        return trace.blocks.nowhere
    n_words = (run.words.address == ord("N")) & np.isin(run.words.value, list(numbers))
    return trace.blocks.with_words(n_words)
