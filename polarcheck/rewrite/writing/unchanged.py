"""What stays when sections of a program are rewritten for the same machine: other words, other moves, depths."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats
from polarcheck.rewrite.writing.outcome import Refusal, refusal_at

#: Places that differ by less are the same [mm].
_SAME = 1e-6


def changed_words(old: Trace, new: Trace) -> Iterator[Refusal]:
    """Yield the first M, S or T word, but for calls and returns, that the new program does not have in its place."""
    before, after = _words(old), _words(new)
    for (line, word), (_, new_word) in zip(before, after, strict=False):
        if word != new_word:
            yield Refusal(line, f"{word} would be {new_word}")
            return
    if len(before) != len(after):
        line = before[len(after)][0] if len(before) > len(after) else 0
        yield Refusal(line, "the result has other M, S or T words")


def _words(trace: Trace) -> list[tuple[int, str]]:
    macro, words = trace.machine.macro, trace.run.words
    calls = trace.blocks.words_at(trace.blocks.code_indices(*macro.flow_codes, *macro.subprogram_calls))
    chosen = np.isin(words.address, np.frombuffer(b"MST", np.uint8)) & ~calls
    rows = zip(
        trace.run.row[chosen].tolist(), words.address[chosen].tolist(), words.value[chosen].tolist(), strict=True
    )
    lines = trace.blocks.line_in_file
    return [(int(lines[row]), f"{chr(address)}{value:g}") for row, address, value in rows]


def changed_outside(old: Trace, new: Trace) -> Iterator[Refusal]:
    """Yield the first block outside of sections that leads elsewhere, and the first section with another depth."""
    rows = [np.flatnonzero(trace.mode.whole_section < 0) for trace in (old, new)]
    if len(rows[0]) != len(rows[1]):
        yield Refusal(0, "the result runs other blocks outside of the sections")
        return
    for name, before, after in (("X", old.path.x, new.path.x), ("Z", old.path.z, new.path.z)):
        was, becomes = before[rows[0]], after[rows[1]]
        differs = ~(np.abs(was - becomes) <= _SAME) & ~(np.isnan(was) & np.isnan(becomes))
        # A section may end elsewhere by the last digit.
        differs &= old.blocks.has(name)[rows[0]]
        if differs.any():
            row = int(rows[0][np.argmax(differs)])
            yield refusal_at(old, row, f"{name} would be another one there")
    for number, (depth, new_depth) in enumerate(zip(_depths(old), _depths(new), strict=False)):
        if abs(depth - new_depth) > _SAME:
            yield refusal_at(
                old,
                old.mode.sections.enter[number],
                f"the depth of the section was Z{depth:g} and would be Z{new_depth:g}",
            )


def _depths(trace: Trace) -> Floats:
    """The least Z of each section [mm]; NaN where none is known."""
    section, z = trace.mode.section, trace.path.z
    depths = np.full(len(trace.mode.sections), np.inf)
    is_known = (section >= 0) & ~np.isnan(z)
    np.minimum.at(depths, section[is_known], z[is_known])
    return np.where(np.isinf(depths), np.nan, depths)
