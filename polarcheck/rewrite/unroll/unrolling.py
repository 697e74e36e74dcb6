"""A program with polar sections as one without them: plain moves of X and C along the tool center path."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.checking.not_evaluated import unexecuted
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats
from polarcheck.foundation.states import FeedMode
from polarcheck.rewrite.unroll import unrolled_deviation, unrolled_feeds
from polarcheck.rewrite.unroll.axis_blocks import Steps, steps_of
from polarcheck.rewrite.unroll.texts import NewText, new_text
from polarcheck.rewrite.unroll.unrollable import Stretch, refusals, stretches
from polarcheck.rewrite.unroll.unrolled_blocks import Writer
from polarcheck.rewrite.unroll.unrolled_feeds import FEEDS as FEEDS
from polarcheck.rewrite.writing.new_blocks import with_edits
from polarcheck.rewrite.writing.original import Original, read
from polarcheck.rewrite.writing.outcome import Figure, Outcome, Refusal, RefusedError
from polarcheck.rewrite.writing.rotary_feed import INVERSE_TIME, notes_on_feed
from polarcheck.rewrite.writing.style_of import style_of

#: How far the tool center may leave its path [mm].
DEFAULT_CHORD_ERROR = 0.005


class Unrolling(msgspec.Struct, frozen=True):
    """
    How sections are unrolled.

    chord_error: how far the tool center may leave its path between two points [mm]. feed: what F is, one of FEEDS;
    empty for what the machine has (feed.with_rotary).
    """

    chord_error: float = DEFAULT_CHORD_ERROR
    feed: str = ""


def unrolled(original: Original, options: Unrolling) -> Outcome:
    """
    Write the polar sections of a program as plain moves of X and C along the tool center path.

    Raises RefusedError where that is not possible or where what is read back differs; TooHardError.
    """
    trace = original.trace
    sections = stretches(trace)
    if not sections:
        raise RefusedError([Refusal(0, "there is no polar section in it")])
    not_judged = (Refusal(0, entry.reason) for entry in unexecuted(original.tables) if entry.matters)
    faults = original.faults()
    if reasons := [*faults, *refusals(original.tables, sections, faults), *not_judged]:
        raise RefusedError(reasons)
    feed = unrolled_feeds.chosen(trace, options.feed)
    center: ToolCenter = original.tables["tool_center"]
    steps = steps_of(trace, center.moves, options.chord_error)
    if reasons := unrolled_feeds.beyond_travel(trace, steps):
        raise RefusedError(reasons)
    time = unrolled_feeds.times(trace, steps)
    style = style_of(trace)
    mode = FeedMode.INVERSE_TIME if feed == INVERSE_TIME else FeedMode.PER_MINUTE
    writer = Writer(trace, steps, unrolled_feeds.feeds(trace, steps, time, feed), mode, style)
    text = new_text(original, sections, writer, style)
    data, origin = with_edits(original, text.edits)
    new = read(original.path, data, original.settings)
    measured = unrolled_deviation.measured(original, new, text.spans, steps, options.chord_error, feed)
    if measured.differences:
        raise RefusedError(measured.differences)
    notes = [*measured.notes, *_notes(original, steps, time, feed), *_notes_of_text(trace, sections, writer, text)]
    return Outcome(data, origin, [], [*_sizes(original, data), *measured.figures], notes)


def _sizes(original: Original, data: bytes) -> Sequence[Figure]:
    return [Figure("bytes before", len(original.data)), Figure("bytes after", len(data))]


def _notes(original: Original, steps: Steps, time: Floats, feed: str) -> list[str]:
    trace, notes = original.trace, []
    lines = trace.blocks.line_in_file
    spots = steps.row[(steps.move < 0) & (steps.x == 0)]
    if len(spots):
        where = ", ".join(str(line) for line in dict.fromkeys(lines[spots].tolist()))
        notes.append(f"through the center of C, where C turns on the spot: line {where}")
    spots = steps.row[(steps.move < 0) & (steps.x != 0)]
    notes += [f"line {line}: C is turned to where the section begins" for line in dict.fromkeys(lines[spots].tolist())]
    rows = unrolled_feeds.slowed(steps, time)
    if len(rows):
        where = ", ".join(str(line) for line in list(dict.fromkeys(lines[rows].tolist()))[:10])
        notes.append(f"slower than its F in {len(rows)} blocks, since C or X would pass its limit: line {where}")
    control = trace.machine.control
    turns = steps.c * control.least_increment
    is_beyond = bool(np.any((turns < 0) | (turns > 360)))
    if is_beyond and not control.rotary_rolls_over and "control.rotary_rolls_over" in original.settings.doubtful:
        notes.append("C is written below 0 or above 360 deg: that it does not roll over there is in doubt")
    return notes + notes_on_feed(
        original.settings, unrolled_feeds.method_of(trace, feed), feed, "try it above the part"
    )


def _notes_of_text(trace: Trace, sections: Sequence[Stretch], writer: Writer, text: NewText) -> Iterator[str]:
    lines = trace.text.blocks.line
    for section in sections:
        row = section.enter
        if not writer.says_feed_mode[row] and not trace.modal.sets("feed_mode")[row : section.leave].any():
            yield f"line {trace.blocks.line_in_file[row]}: no code says that F is per minute, as it is taken here"
    for block in text.skipped:
        yield f"line {lines[block]}: written for this position of the switch of block skip alone"
    for first, _ in text.left_out:
        yield f"line {lines[first]}: the subprogram is written out where it ran, and left out here"
