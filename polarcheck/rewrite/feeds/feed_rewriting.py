"""The feed table written into its program: F lowered where it has to be, and restored behind."""

from __future__ import annotations

import re

import msgspec
import numpy as np

from polarcheck.columns.feed.highest_feeds import HighestFeeds
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows, column_at
from polarcheck.foundation.errors import TooHardError
from polarcheck.rewrite.feeds.table import feed_number, highest
from polarcheck.rules.editing import Replace, in_place_of, is_plain, with_word, words_of, written_word
from polarcheck.rules.feed_words import takes_feed, writes_points
from polarcheck.rules.tables import Tables

_NUMBER = re.compile(r"F\+?[0-9.]+", re.IGNORECASE)
#: So often blocks are looked for whose runs need one F each; each time at least one more gets the lowest.
_ROUNDS = 50


class FeedWords(msgspec.Struct, frozen=True):
    """
    edits: of the text. lowest: lines of blocks that run with different F, or need it, and get the lowest of them.
    left: lines of blocks in which F cannot be written: it is an expression, or they are of another language or file.
    """

    edits: tuple[Replace, ...]
    lowest: tuple[int, ...]
    left: tuple[int, ...]


def feed_words(tables: Tables) -> FeedWords:
    """What to write into the program of one run."""
    trace: Trace = tables["trace"]
    feeds: HighestFeeds = tables["highest_feeds"]
    highest_feed = highest(trace, feeds)
    lowered = feeds.must_be_lower & ~np.isnan(highest_feed)
    if not lowered.any():
        return FeedWords((), (), ())
    # As a number of F in force, whatever it is per: outside the mode it stays as it was.
    requested = np.where(lowered, highest_feed, trace.feedrate.written_feed)
    # A corner that the control makes runs at the F of the move behind it.
    np.fmin.at(requested, trace.feedrate.feed_row, requested)
    return _Plan(trace, requested).words()


class _Plan:
    """Which rows move at F or write it, with the F that each is to have [mm]; blocks stand for their runs."""

    def __init__(self, trace: Trace, requested: Floats) -> None:
        self.trace = trace
        self.wanted = requested
        self.moving = takes_feed(trace.axes) & ~trace.axes.makes_corner
        words = trace.blocks.word_indices("F")
        rows, offsets = trace.run.row[words], trace.run.words.start[words]
        own_word = column_at(len(trace), rows, offsets, -2)
        self.writes = trace.blocks.has("F") & (trace.feedrate.feed_word == own_word)
        self.lowest: set[int] = set()
        self.writes_points = writes_points(trace.blocks, trace.lengths, trace.run)
        #: The F words of each row, and the first one at each place of the text.
        self.words_of_row: dict[int, list[int]] = {}
        self.word_at: dict[int, int] = {}
        for index, row, offset in zip(words.tolist(), rows.tolist(), offsets.tolist(), strict=True):
            self.words_of_row.setdefault(row, []).append(index)
            self.word_at.setdefault(offset, index)

    def words(self) -> FeedWords:
        """
        The edits: F in the first run of each block that needs another one than is in force there.

        What cannot be written leaves the F in force to the blocks behind it, so that others may need one.
        """
        trace, block = self.trace, self.trace.run.block
        unchanged = set[int]()
        for _ in range(_ROUNDS):
            written = np.isin(block, block[self._needs()]) & self.moving
            several = self._differ(np.flatnonzero(written))
            if len(several):
                self._take_lowest(several)
                continue
            rows = np.flatnonzero(written)
            edits = {row: self._edit(row) for row in rows[np.unique(block[rows], return_index=True)[1]].tolist()}
            fixed = [row for row, edit in edits.items() if edit is None]
            if not fixed:
                replacements = {edit for edit in edits.values() if edit is not None}
                return FeedWords(tuple(sorted(replacements)), tuple(sorted(self.lowest)), tuple(sorted(unchanged)))
            unchanged |= {trace.line(row) for row in fixed}
            self.moving &= ~np.isin(block, block[fixed])
        raise TooHardError("F of too many blocks hangs on that of others")

    def _needs(self) -> Mask:
        """Rows that move with another F than the one that is in force before them, or write another one."""
        events = np.flatnonzero(self.moving | self.writes)
        after = np.where(self.moving[events], self.wanted[events], self.trace.feedrate.written_feed[events])
        starts = np.cumsum(self.trace.blocks.starts)[events]
        before = np.append(np.nan, after[:-1])
        before[1:][starts[1:] != starts[:-1]] = np.nan
        has_word = self.writes[events]
        in_force = np.where(has_word, self.trace.feedrate.written_feed[events], before)
        needs = self.moving[events] & (in_force != after) & ~(np.isnan(in_force) & np.isnan(after))
        return column_at(len(self.trace), events, needs, False)

    def _differ(self, rows: Rows) -> Rows:
        """Of these rows the blocks whose runs are to have different F."""
        block = self.trace.run.block[rows]
        order = np.argsort(block, kind="stable")
        block, requested = block[order], self.wanted[rows[order]]
        return np.unique(block[1:][(block[1:] == block[:-1]) & (requested[1:] != requested[:-1])])

    def _take_lowest(self, blocks: Rows) -> None:
        """All runs of these blocks have the lowest F of any."""
        for block in blocks.tolist():
            rows = np.flatnonzero((self.trace.run.block == block) & self.moving)
            self.wanted[rows] = np.nanmin(self.wanted[rows])
            self.lowest.add(self.trace.line(rows[0]))

    def _edit(self, row: int) -> Replace | None:
        trace = self.trace
        value = float(self.wanted[row])
        source, block = trace.text.source, int(trace.run.block[row])
        of_others = int(source.line_starts[source.parts[0].first_line - 1]) if source.parts else len(source.code)
        is_own = int(trace.text.blocks.end[block]) <= of_others
        words = self.words_of_row.get(row, [])
        takes = is_plain(trace.run, row) or (
            _is_as_written(trace, row) and all(_is_number(trace, word) for word in words)
        )
        if not is_own or not takes or not value > 0:
            return None
        text = self._text(row, value)
        return in_place_of(trace.run, words[-1], text) if words else with_word(trace.run, row, text)

    def _text(self, row: int, value: float) -> str:
        """The F word: as it stands in the program, where it is the one that was in force."""
        trace = self.trace
        word = self.word_at.get(int(trace.feedrate.feed_word[row]))
        if value == trace.feedrate.written_feed[row] and word is not None and _is_number(trace, word):
            return written_word(trace.run, word)
        return f"F{feed_number(round(value / float(trace.lengths.feed_scale[row]), 6), bool(self.writes_points[row]))}"


def _is_as_written(trace: Trace, row: int) -> bool:
    """Each word of a block of a macro stands in it under its address, be it with an expression."""
    words, source = trace.run.words, trace.text.source
    return all(
        source.excerpt(int(words.start[index]), int(words.end[index])).upper().startswith(chr(words.address[index]))
        for index in words_of(trace.run, row)
    )


def _is_number(trace: Trace, index: int) -> bool:
    """An F word is written as a number."""
    return _NUMBER.fullmatch(written_word(trace.run, index)) is not None
