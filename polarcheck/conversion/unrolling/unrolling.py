"""A program with polar sections as one without them: plain moves of X and C along the tool center path."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import msgspec
import numpy as np

from polarcheck.arrays import Floats
from polarcheck.checking.editing import Replace
from polarcheck.columns.trace import Trace
from polarcheck.conversion.blocks import with_edits
from polarcheck.conversion.original import Original, read
from polarcheck.conversion.outcome import Figure, Outcome, Refusal, RefusedError
from polarcheck.conversion.unrolling import measuring, rates
from polarcheck.conversion.unrolling.rates import FEEDS as FEEDS
from polarcheck.conversion.unrolling.steps import Steps, steps_of
from polarcheck.conversion.unrolling.stretches import refusals, stretches
from polarcheck.conversion.unrolling.texts import edit_without, edits_of, subprograms_left_out
from polarcheck.conversion.unrolling.writing import Writer
from polarcheck.table.tool_center import ToolCenter


class Unrolling(msgspec.Struct, frozen=True):
    """
    How sections are unrolled.

    chord_error: how far the tool center may leave its path between two points [mm]. feed: what F is, one of FEEDS;
    empty for what the machine has (feed.with_rotary).
    """

    chord_error: float = 0.005
    feed: str = ""


def unrolled(original: Original, options: Unrolling) -> Outcome:
    """
    Write the polar sections of a program as plain moves of X and C along the tool center path.

    Raises RefusedError where that is not possible or where what is read back differs; TooHardError.
    """
    trace = original.trace
    found = stretches(trace)
    if not found:
        raise RefusedError([Refusal(0, "there is no polar section in it")])
    if reasons := refusals(original.tables, found):
        raise RefusedError(reasons)
    feed = rates.chosen(trace, options.feed)
    center: ToolCenter = original.tables["tool_center"]
    steps = steps_of(trace, center.moves, options.chord_error)
    if reasons := measuring.beyond_travel(trace, steps):
        raise RefusedError(reasons)
    time = rates.times(trace, steps)
    writer = Writer(trace, steps, rates.feeds(trace, steps, time, feed), rates.mode_of(feed))
    texts: dict[tuple[int, int], list[Replace]] = {}
    for each in found:
        edits = edits_of(trace, each, writer.of_section(each))
        known = texts.setdefault((each.first, each.last), edits)
        if known != edits:
            line = int(trace.blocks.line_in_file[each.enter])
            raise RefusedError([Refusal(line, "the section runs several times, and not from the same place")])
    left_out = subprograms_left_out(trace, found)
    edits = [edit for section in texts.values() for edit in section]
    edits = sorted([*edits, *(edit_without(trace, *blocks) for blocks in left_out)])
    data, origin = with_edits(original, edits)
    new = read(original.path, data, original.settings)
    places = _places(trace, texts, edits)
    measured = measuring.measured(original, new, places, steps, options.chord_error, feed)
    if measured.differences:
        raise RefusedError(measured.differences)
    notes = _notes(original, steps, time, feed)
    for first, _ in left_out:
        line = int(trace.text.blocks.line[first])
        notes.append(f"line {line}: the subprogram is written out where it ran, and left out here")
    return Outcome(data, origin, [], [*_sizes(original, data), *measured.figures], notes)


def _places(trace: Trace, sections: Iterable[tuple[int, int]], edits: Sequence[Replace]) -> list[tuple[int, int]]:
    """The characters of sections in the new text, by their first and last blocks."""
    blocks = trace.text.blocks
    starts = np.array([start for start, _, _ in edits] or [0])
    grown = np.cumsum([0, *(len(text) - (end - start) for start, end, text in edits)])

    def place(position: int) -> int:
        return int(position + grown[np.searchsorted(starts, position)]) if edits else position

    return [(place(int(blocks.start[first])), place(int(blocks.end[last]))) for first, last in sorted(sections)]


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
    slow, rows = rates.slowed(steps, time)
    if slow.any():
        where = ", ".join(str(line) for line in list(dict.fromkeys(lines[rows].tolist()))[:10])
        notes.append(f"slower than its F in {len(rows)} blocks, since C or X cannot turn faster: line {where}")
    if "feed.with_rotary" in original.settings.doubtful and feed in trace.machine.feed.with_rotary:
        notes.append(f"that F is {feed} on {trace.machine.title} is in doubt: try it above the part")
    elif feed not in trace.machine.feed.with_rotary:
        notes.append(f"F is {feed} as --feed says; the profile of {trace.machine.title} does not say so")
    return notes
