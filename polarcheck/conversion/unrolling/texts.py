"""Edits of the text of sections: blocks in the place of others, with N words and comments where they were."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.arrays import stretch
from polarcheck.checking.editing import Replace, content_of, line_without, parting, skip_sign, words_of, written_word
from polarcheck.columns.trace import Trace
from polarcheck.conversion.unrolling.stretches import Stretch
from polarcheck.execution.programs import find_programs


def edits_of(trace: Trace, each: Stretch, rows: Sequence[tuple[int, list[str] | None]]) -> list[Replace]:
    """The edits that put new blocks into the text of a section; None for a row that stays as it is."""
    if not each.runs_in_order:
        return [_all(trace, each, rows)]
    return [_in_place(trace, row, blocks) for row, blocks in rows if blocks is not None]


def _in_place(trace: Trace, row: int, blocks: list[str]) -> Replace:
    block = int(trace.run.block[row])
    begin, end = content_of(trace.text, block)
    lines = _with_heads(trace, row, blocks)
    if not lines:
        return line_without(trace.text.source, begin, end)
    return begin, end, parting(trace.text, block).join(lines)


def _with_heads(trace: Trace, row: int, blocks: list[str]) -> list[str]:
    """The blocks with block skip, and the first of them with what stands before its words, and its comments."""
    run, block = trace.run, int(trace.run.block[row])
    heads = [written_word(run, index) for index in words_of(run, row) if run.words.address[index] == ord("N")]
    comments = _comments(trace, block)
    if not blocks and not comments:
        return []
    sign = skip_sign(run, row)
    lines = [sign + block for block in blocks] or [""]
    lines[0] = " ".join(part for part in (sign, *heads, *blocks[:1], *comments) if part)
    return lines


def _comments(trace: Trace, block: int) -> list[str]:
    comments, source = trace.text.comments, trace.text.source
    low, high = stretch(comments.block, block, block + 1)
    return [source.excerpt(int(comments.start[at]), int(comments.end[at])).strip() for at in range(low, high)]


def _all(trace: Trace, each: Stretch, rows: Sequence[tuple[int, list[str] | None]]) -> Replace:
    """What runs in the section, in the order in which it runs; comments where they run first."""
    text = trace.text
    begin, end = content_of(text, each.first)[0], content_of(text, each.last)[1]
    seen: set[int] = set()
    lines: list[str] = []
    for row, blocks in rows:
        block = int(trace.run.block[row])
        is_first = block not in seen
        seen.add(block)
        if blocks is None:
            blocks = [_words(trace, row)]
        comments = _comments(trace, block) if is_first else []
        first = " ".join(part for part in (*blocks[:1], *comments) if part)
        lines += [first] * bool(first) + blocks[1:]
    return begin, end, parting(text, each.first).join(lines)


def _words(trace: Trace, row: int) -> str:
    run = trace.run
    return " ".join(written_word(run, index) for index in words_of(run, row) if run.words.address[index] != ord("N"))


def subprograms_left_out(trace: Trace, sections: Sequence[Stretch]) -> list[tuple[int, int]]:
    """The first and last blocks of programs of this file that run in sections alone, where those are written out."""
    if all(each.runs_in_order for each in sections):
        return []
    run, text = trace.run, trace.text
    written_out = np.zeros(len(trace), bool)
    for each in sections:
        if not each.runs_in_order:
            written_out[each.enter : each.leave + 1] = run.depth[each.enter : each.leave + 1] > run.depth[each.enter]
    inside, outside = (set(run.block[rows].tolist()) for rows in (written_out, ~written_out))
    left_out = []
    for program in find_programs(text).programs:
        blocks = range(program.first, program.end)
        if program.file or not any(block in inside for block in blocks) or any(block in outside for block in blocks):
            continue
        contents = [block for block in blocks if text.source.excerpt(*content_of(text, block)).strip(" \t%")]
        left_out.append((contents[0], contents[-1]))
    return left_out


def edit_without(trace: Trace, first: int, last: int) -> Replace:
    """The edit that takes out blocks with their lines."""
    begin, end = (line_without(trace.text.source, *content_of(trace.text, block)) for block in (first, last))
    return begin[0], end[1], ""
