"""Edits of the text of a program: new blocks in the place of those of its sections."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import TypeVar

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.program.execution.programs import find_programs
from polarcheck.rewrite.unroll.unrollable import Stretch
from polarcheck.rewrite.unroll.unrolled_blocks import Writer
from polarcheck.rewrite.writing.new_blocks import NewBlock, edits_of, edits_of_ranges
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rewrite.writing.style import Style
from polarcheck.rules.editing import Replace, content_of, line_without

_Key = TypeVar("_Key", int, tuple[int, int])


class NewText(msgspec.Struct, frozen=True):
    """
    The new text of a program.

    edits: in order. spans: the characters of the sections in it. skipped: blocks with block skip in sections.
    left_out: first and last blocks of the subprograms that are written out where they ran.
    """

    edits: list[Replace]
    spans: list[tuple[int, int]]
    skipped: list[int]
    left_out: list[tuple[int, int]]


def new_text(original: Original, sections: Sequence[Stretch], writer: Writer, style: Style) -> NewText:
    """
    Return the edits that write the sections.

    Raises RefusedError for a section that runs several times and would be another one each time.
    """
    trace, machine = original.trace, original.settings.machine
    blocks: dict[int, list[NewBlock]] = {}
    ranges: dict[tuple[int, int], list[NewBlock]] = {}
    skipped: list[int] = []
    for section in sections:
        rows = writer.of_section(section)
        if not section.runs_in_order:
            written = [block for _, new in rows for block in new or ()]
            _put(trace, section, ranges, (section.first, section.last), written)
            continue
        for row, new in rows:
            if new is not None:
                _put(trace, section, blocks, int(trace.run.block[row]), new)
        for block in _skipped_moves(trace, section):
            blocks.setdefault(block, [])
            skipped.append(block)
    left_out = _subprograms_left_out(trace, sections)
    edits = [
        *edits_of(original, blocks, style, machine, frozenset(skipped)),
        *edits_of_ranges(original, ranges, style, machine),
        *(_edit_without(trace, *pair) for pair in left_out),
    ]
    edits.sort()
    places = {(section.first, section.last) for section in sections}
    return NewText(edits, _spans(trace, places, edits), sorted(set(skipped)), left_out)


def _put(trace: Trace, section: Stretch, new: dict[_Key, list[NewBlock]], key: _Key, blocks: list[NewBlock]) -> None:
    if new.setdefault(key, blocks) != blocks:
        raise refused_at(trace, section.enter, "the section runs several times, and not from the same place")


def _skipped_moves(trace: Trace, section: Stretch) -> list[int]:
    """Blocks of a section with block skip that move or that switch something of moves, whether they run or not."""
    words = trace.text.words
    low, high = np.searchsorted(words.block, (section.first, section.last + 1))
    block, address = words.block[low:high], words.address[low:high]
    moving = block[~np.isin(address, np.frombuffer(b"MSTN/", np.uint8))]
    blocks: list[int] = np.intersect1d(block[address == ord("/")], moving).tolist()
    return blocks


def _subprograms_left_out(trace: Trace, sections: Sequence[Stretch]) -> list[tuple[int, int]]:
    """Return the first and last blocks of the programs in this file that run only in sections that are written out."""
    if all(section.runs_in_order for section in sections):
        return []
    run, text = trace.run, trace.text
    written_out = np.zeros(len(trace), bool)
    for section in sections:
        if not section.runs_in_order:
            rows = slice(section.enter, section.leave + 1)
            written_out[rows] = run.depth[rows] > run.depth[section.enter]
    inside, outside = (set(run.block[rows].tolist()) for rows in (written_out, ~written_out))
    left_out = []
    for program in find_programs(text).programs:
        blocks = range(program.first, program.end)
        if program.file or not any(block in inside for block in blocks) or any(block in outside for block in blocks):
            continue
        contents = [block for block in blocks if text.source.excerpt(*content_of(text, block)).strip(" \t%")]
        left_out.append((contents[0], contents[-1]))
    return left_out


def _edit_without(trace: Trace, first: int, last: int) -> Replace:
    """The edit that takes out blocks with their lines."""
    begin, end = (line_without(trace.text.source, *content_of(trace.text, block)) for block in (first, last))
    return begin[0], end[1], ""


def _spans(trace: Trace, sections: Collection[tuple[int, int]], edits: Sequence[Replace]) -> list[tuple[int, int]]:
    """The characters of sections in the new text, by their first and last blocks."""
    blocks = trace.text.blocks
    starts = np.array([start for start, _, _ in edits] or [0])
    grown = np.cumsum([0, *(len(text) - (end - start) for start, end, text in edits)])

    def moved(position: int) -> int:
        return int(position + grown[np.searchsorted(starts, position)]) if edits else position

    return [(moved(int(blocks.start[first])), moved(int(blocks.end[last]))) for first, last in sorted(sections)]
