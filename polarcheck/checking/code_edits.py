"""
Codes and blocks of a contour that may stand a block too early or too late, or be left out.

These edits change no number, so that nothing is solved: each is only tried (checking/explanations.py).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from polarcheck.checking.engine import Engine
from polarcheck.columns.contour.loop_edits import Edit, order_edit
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows, is_among, side_by_side
from polarcheck.foundation.states import Motion, Side
from polarcheck.rules.editing import Replace, content_of, is_head, is_plain, separator, without, words_of

#: Moves of a path from either end within which a finding may come from the ramp there.
_NEAR = 2
#: Blocks between a path and the code of its ramp.
_AWAY = 3


class CodeEdit(NamedTuple):
    """An edit of a path that changes no number: the row of its block, what is said of it, and the edits of the text."""

    row: int
    edit: Edit
    edits: list[Replace]


def exchanged(trace: Trace, row: int, following: int) -> list[Replace]:
    """The edits that exchange the blocks of two rows."""
    run = trace.run
    (start, end), (other_start, other_end) = (content_of(run.text, int(run.block[at])) for at in (row, following))
    excerpt = run.text.source.excerpt
    return [(start, end, excerpt(other_start, other_end)), (other_start, other_end, excerpt(start, end))]


def ramp_edits(trace: Trace, own: Rows, rows: Rows) -> Iterator[list[CodeEdit]]:
    """
    The edits at the ends of a path near which there are findings; those of a list say the same, the first is simplest.

    own: the rows of the path. rows: those of the findings.
    """
    machine = trace.machine
    if not len(rows):
        return
    if rows.min() <= own[min(_NEAR, len(own)) - 1]:
        codes = [*machine.codes("compensation_left"), *machine.codes("compensation_right")]
        yield from _around(trace, _last(trace, codes, int(own[0]) - _AWAY, int(own[0])))
    if rows.max() >= own[-min(_NEAR, len(own))]:
        word = _last(trace, [*machine.codes("compensation_off")], int(own[-1]) - 1, int(own[-1]) + _AWAY)
        yield from _absolute(trace, word)
        yield from _around(trace, word)


def _last(trace: Trace, codes: list[str], first: int, last: int) -> int:
    """The last executed word with one of these codes in rows from the first to the last; -1 for none."""
    words = trace.blocks.code_indices(*codes)
    rows = trace.run.row[words]
    return int(words[(rows >= first) & (rows <= last)].max(initial=-1))


def _around(trace: Trace, word: int) -> Iterator[list[CodeEdit]]:
    """The code in the block before or behind its own, and both blocks exchanged."""
    row, code = int(trace.run.row[word]), trace.run.written(word).strip()
    for other in (row - 1, row + 1):
        if word >= 0 and _are_beside(trace, row, other):
            first, second = sorted((row, other))
            slip = f"it stands a block too {'late' if other < row else 'early'}"
            how = f"with {code} not here but in line {int(trace.blocks.line[other])}"
            moved = [_at_head(trace, other, code), *without(trace.run, row, [word])]
            yield [
                CodeEdit(row, Edit("code", 0, (word,), code, slip, 0.0, how=how), moved),
                CodeEdit(first, order_edit(0, 0.0), exchanged(trace, first, second)),
            ]


def _absolute(trace: Trace, word: int) -> Iterator[list[CodeEdit]]:
    """G90 in the block of a code where G91 is in force."""
    row, codes = int(trace.run.row[word]), [*trace.machine.codes("absolute")]
    if word >= 0 and codes and trace.modal.is_step("X")[row] and is_plain(trace.run, row):
        edit = Edit("code", 0, (), codes[0], f"{codes[0]} is missing", 0.0)
        yield [CodeEdit(row, edit, [_at_head(trace, row, codes[0])])]


def unneeded_sides(trace: Trace, own: Rows) -> Iterator[list[CodeEdit]]:
    """
    Without a code of compensation in the middle of a path, or alone in a block beside it.

    The one code that begins the compensation of a path is needed: without it nothing could be told of its ramps. One
    that begins it on an arc, where no G40 takes it back, is not.
    """
    words = _codes(trace, "compensation_left", "compensation_right")
    of_side = trace.run.row[words]
    is_in_force = trace.compensation.side_before[of_side] != Side.OFF
    comes_again = np.arange(len(words)) < np.searchsorted(of_side, own[-1], side="right") - 1
    ramps = np.append(np.flatnonzero(trace.compensation.starts_up), own[0])
    ramp = ramps[np.searchsorted(ramps[:-1], of_side)]
    has_cancel = (trace.compensation.writes_cancel & (trace.mode.section == trace.mode.section[own[0]]))[own[0] :].any()
    is_on_arc = ~has_cancel & trace.path.is_arc[ramp]
    yield from _without(trace, own, words[is_in_force | comes_again | is_on_arc])


def unneeded_steps(trace: Trace, own: Rows) -> Iterator[list[CodeEdit]]:
    """Without a code of increments in the middle of a path, or alone in a block beside it."""
    yield from _without(trace, own, _codes(trace, "incremental", "absolute"))


def _codes(trace: Trace, *keys: str) -> Rows:
    return trace.blocks.code_indices(*(code for key in keys for code in trace.machine.codes(key)))


def _without(trace: Trace, own: Rows, words: Rows) -> Iterator[list[CodeEdit]]:
    """The edits that leave out one of these codes each, where it is inside of a path, or alone beside it."""
    for word, row in side_by_side(words, trace.run.row[words]):
        is_inside = own[0] < row < own[-1]
        is_alone = own[0] - _NEAR <= row <= own[-1] + _NEAR and not trace.path.travels[row]
        if (is_inside or is_alone) and is_plain(trace.run, row):
            code = trace.run.written(word).strip()
            edit = Edit("code", 0, (word,), "", "it is a code too many", 0.0, how=f"without {code}")
            yield [CodeEdit(row, edit, without(trace.run, row, [word]))]


def missing_steps(trace: Trace, own: Rows) -> Iterator[list[CodeEdit]]:
    """G91 in the first block of a path behind which a G90 changes nothing."""
    row, codes = int(own[0]), [*trace.machine.codes("incremental")]
    rows = trace.run.row[trace.blocks.code_indices(*trace.machine.codes("absolute"))]
    ends = (rows > row) & (rows <= own[-1] + 1)
    if codes and ends.any() and not trace.modal.is_step("X")[row] and is_plain(trace.run, row):
        edit = Edit("code", 0, (), codes[0], f"{codes[0]} is missing", 0.0)
        yield [CodeEdit(row, edit, [_at_head(trace, row, codes[0])])]


def unskipped(trace: Trace, own: Rows) -> Iterator[list[CodeEdit]]:
    """The sign of block skip taken away from a block that is skipped in the path, or beside it."""
    run, text = trace.run, trace.run.text
    rows = np.arange(max(int(own[0]) - 1, 0), min(int(own[-1]) + 2, len(trace)))
    for row in rows[1:][np.diff(run.block[rows]) > 1].tolist():
        start, end = content_of(text, int(run.block[row]) - 1)
        content = text.source.excerpt(start, end)
        if content.startswith("/") and run.depth[row] == run.depth[row - 1]:
            how = f"without the / of line {text.source.line_of(start)}"
            edit = Edit("code", 0, (), "", "a block before it is skipped", 0.0, how=how)
            sign = len(content) - len(content[1:].lstrip("0123456789"))
            yield [CodeEdit(row, edit, [(start, start + sign, "")])]


def before_arcs(trace: Trace, own: Rows) -> Iterator[list[CodeEdit]]:
    """A line exchanged with the arc behind it, whose code is still in force in a block that says no center."""
    motion, path = trace.axes.motion, trace.path
    rows = np.flatnonzero(is_among(motion, (Motion.CW, Motion.CCW)) & path.travels & np.isnan(path.center))
    for row in rows[(rows > own[0] + 1) & (rows <= own[-1] + 2)].tolist():
        line, arc = row - 2, row - 1
        if motion[line] == Motion.LINE and motion[arc] == motion[row] and _are_beside(trace, line, arc):
            yield [CodeEdit(line, order_edit(0, 0.0), exchanged(trace, line, arc))]


def as_in_passes(engine: Engine, own: Rows) -> Iterator[list[CodeEdit]]:
    """The block in which a path differs from another pass written as it stands there."""
    run = engine.trace.run
    for difference in engine.tables["pass_differences"].found.values():
        row, other = difference.row, difference.other
        if own[0] <= row <= own[-1] + 1 and difference.beside is None and is_plain(run, row) and is_plain(run, other):
            start, end = content_of(run.text, int(run.block[row]))
            content = run.text.source.excerpt(*content_of(run.text, int(run.block[other])))
            replaced = (start, start, f"{content}\n") if difference.is_missing else (start, end, content)
            yield [CodeEdit(row, Edit("other pass", 0, (), "", "", 0.0), [replaced])]


def _at_head(trace: Trace, row: int, code: str) -> Replace:
    """A code put before the words of a row, behind N and /."""
    run, blank = trace.run, separator(trace.run, row)
    heads = [index for index in words_of(run, row) if is_head(run, index)]
    if heads:
        end = int(run.words.end[heads[-1]])
        return end, end, blank + code
    start = content_of(run.text, int(run.block[row]))[0]
    return start, start, code + blank


def _are_beside(trace: Trace, row: int, other: int) -> bool:
    """Two rows are blocks of one program and section that stand one behind the other, and can be edited."""
    run, section = trace.run, trace.mode.section
    if not 0 <= other < len(trace) or run.depth[row] != run.depth[other] or section[row] != section[other]:
        return False
    is_switch = trace.mode.enters[max(row, other)] or trace.mode.enters[min(row, other)]
    is_next = abs(int(run.block[row]) - int(run.block[other])) == 1
    return bool(is_next and not is_switch and is_plain(run, row) and is_plain(run, other))
