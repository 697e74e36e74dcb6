"""
A large program in pieces, so that memory does not grow with it: each ends outside the polar mode, and begins with the
blocks before it that still count.

Nothing of the tables knows of this: the blocks that still count are blocks of the file, which set in order what is in
force. Whether they do is looked at: a piece that does not begin as the one before it has ended is none.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from polarcheck.arrays import Floats, Mask, Rows, is_among
from polarcheck.checking.tables import Tables
from polarcheck.errors import IsOneError
from polarcheck.execution.programs import needs_flow, read_text
from polarcheck.execution.run import straight
from polarcheck.machines.codes import modal_tables
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading.source import Bytes, Source
from polarcheck.reading.stretches import between, can_be_parted, joined, only, read_stretch
from polarcheck.reading.words import Text
from polarcheck.silence.suppression import mentions_allow
from polarcheck.table.filling import happened
from polarcheck.table.trace import Trace

#: The characters of a piece, about.
SIZE = 1 << 20
#: Words that every move may have: of those before a piece the last of each counts, with what else is in its block.
_OF_MOVES = b"NXYZCUVWHABEIJKRFDQ"
#: No piece is smaller than one part in so many, since each has to look at what is in force anew.
_LEAST_SHARE = 4
#: So many blocks of the head of a file, and right before a piece, are kept as they stand.
NEAR = 64
#: Of what is kept of a polar section so many blocks before it, which say what it begins with.
_ENTRY = 16
#: More blocks that still count are not carried on: the file is one table.
_MOST_CARRIED = 4000
#: So many rows behind a piece are looked at.
_AHEAD = 500
#: So many places are tried for the end of a piece.
_TRIES = 3
#: What the trace has in force behind a row, beside its modal groups.
_IN_FORCE = (
    *("in_polar", "x", "z", "c_angle", "units", "side", "feed_mode", "feed", "written_feed", "drilling"),
    *("spindle", "live_tool", "tool", "offset_number", "radius_of_offset", "nose", "allowance", "local_shift"),
    *("center_shift", "kept_angle"),
)


class Piece(NamedTuple):
    """The tables of a piece; of its blocks only those of `own` are its own."""

    tables: Tables
    own: range

    @property
    def own_rows(self) -> range:
        """The rows of its own."""
        trace: Trace = self.tables["trace"]
        return range(*np.searchsorted(trace.run.block, (self.own.start, self.own.stop)).tolist())


def in_pieces(source: Source, machine: Machine, job: Job) -> Iterator[Piece]:
    """
    The pieces of a program, each of about SIZE characters, or more where a polar section is longer.

    Raises IsOneError as soon as it shows that the program is to be one table: with macros, jumps, calls, block skip,
    channels, allow comments, offsets that it sets itself, or text between programs.
    """
    control = machine.control
    if control.native_words or machine.macro.language != "custom-macro" or job.part or not can_be_parted(source):
        raise IsOneError
    if control.channel_mark and control.channel_mark.encode("latin-1") in source.data:
        raise IsOneError

    def read(part: Source) -> Text:
        if mentions_allow(part):
            raise IsOneError
        return read_text(part, machine)

    carried = pending = None
    begin = at = 0
    while True:
        # What has no end yet is read twice as far: so much is looked at again, and no more.
        end = _line_start(source, at + max(SIZE, at - begin))
        text = read_stretch(source, at, end, read)
        if needs_flow(text, machine.macro.flow_codes):
            raise IsOneError
        at, pending = end, _both(pending, text)
        known = _both(carried, pending)
        own = len(known.blocks) - len(pending.blocks)
        if at == len(source.code):
            yield Piece(_tables(known, machine, job), range(own, len(known.blocks)))
            return
        ended = _ended(known, own, machine, job)
        if ended is not None:
            piece, carried = ended
            pending = between(known, piece.own.stop, len(known.blocks))
            begin = int(pending.blocks.start[0])
            yield piece


def _both(first: Text | None, second: Text) -> Text:
    return second if first is None else joined(first, second)


def _line_start(source: Source, position: int) -> int:
    """The first start of a line at or behind a position, or the end of the file."""
    line = int(np.searchsorted(source.line_starts, position))
    return int(source.line_starts[line]) if line < len(source.line_starts) else len(source.code)


def _tables(text: Text, machine: Machine, job: Job) -> Tables:
    return Tables(straight(text, machine.m_codes.program_end), machine, job)


def _ended(text: Text, own: int, machine: Machine, job: Job) -> tuple[Piece, Text] | None:
    """A piece of a text, and what of it still counts behind that; None where it can end nowhere, or is too small."""
    run = straight(text, machine.m_codes.program_end)
    trace = Trace(run, machine, job)
    if len(text.outside) or trace.listed("data_input").any():
        raise IsOneError
    for row in _ends(trace, own) if len(trace) else ():
        end = int(run.block[row])
        if text.blocks.start[end] - text.blocks.start[own] < SIZE // _LEAST_SHARE:
            continue
        known = between(text, 0, _ahead(trace, row))
        tables = _tables(known, machine, job)
        of_piece: Trace = tables["trace"]
        kept = _still_counts(of_piece, end)
        if np.count_nonzero(kept) > _MOST_CARRIED:
            raise IsOneError
        carried = only(known, kept)
        begins = Trace(straight(carried, machine.m_codes.program_end), machine, job)
        if _in_force(of_piece, row - 1) == _in_force(begins, len(begins) - 1):
            return Piece(tables, range(own, end)), carried
    return None


def _ahead(trace: Trace, row: int) -> int:
    """
    The block behind those that a piece looks at behind its end: up to the next G12.1 what is cut is judged by the
    contours of the section before; at least one, since a program does not end there.
    """
    enters = np.append(trace.codes(*trace.machine.polar.on)[row:], True)
    rows = np.append(trace.run.block, len(trace.text.blocks))
    return int(rows[row + max(min(int(np.argmax(enters)), _AHEAD), 1)])


def _ends(trace: Trace, own: int) -> Iterator[int]:
    """
    The rows before which a piece may end: those first where a tool is called or C is set anew, the last of each kind.

    C that runs through several turns in a section is known by its next word, or a reference return, behind that.
    """
    mode, starts = trace.machine.polar, trace.starts
    on, off = trace.codes(*mode.on), trace.codes(*mode.off, *mode.ended_by)
    is_open = happened(on, off | starts)
    is_open |= happened(trace.writes_side & ~trace.writes_cancel, trace.writes_cancel | starts)
    may_end = np.append(False, ~is_open[:-1])
    may_end[: int(np.searchsorted(trace.run.block, own)) + 1] = False
    blocks, source = trace.text.blocks, trace.text.source
    may_end &= blocks.start[trace.run.block] == source.line_starts[trace.line - 1]
    is_set = happened(trace.has(*mode.rotary_words), on | off | starts)
    begins = np.append(False, is_set[:-1] & ~np.append(False, is_set[:-2]))
    is_set = np.append(False, is_set[:-1])
    for preferred in (is_set & trace.has("T"), begins & ~on, is_set & ~on, begins, ~on, on):
        yield from np.flatnonzero(may_end & preferred)[::-1][:_TRIES].tolist()


def _still_counts(trace: Trace, end: int) -> Mask:
    """Per block: what of those before a block is still to be known behind it."""
    text = trace.text
    kept = np.zeros(len(text.blocks), bool)
    kept[:NEAR] = kept[max(end - NEAR, 0) : end] = True
    words = text.words
    before = np.arange(np.searchsorted(words.block, end))
    address = words.address[before]
    is_of_move = is_among(address, list(_OF_MOVES))
    for one in np.unique(address).tolist():
        kept[words.block[np.flatnonzero(address == one)[-1]]] = True
    others = before[~is_of_move]
    kept[_first_and_last(words.block[others], address[others], words.value[others])] = True
    blocks = trace.run.block
    calls, enters = blocks[trace.has("T")], blocks[trace.codes(*trace.machine.polar.on)]
    outside = np.ones(len(kept), bool)
    outside[blocks[trace.whole_section >= 0]] = False
    for around, first, last in ((calls, -1, 1), (enters, -_ENTRY, 0)):
        around = around[kept[around] & (around < end)]
        for by in range(first, last + 1):
            beside = np.clip(around + by, 0, end - 1)
            kept[beside[outside[beside]]] = True
    kept[end:] = False
    return kept


def _first_and_last(block: Rows, address: Bytes, value: Floats) -> Rows:
    """Of the blocks of some words the first and the last of those with the same words."""
    if not len(block):
        return block
    begins = np.flatnonzero(np.append(True, np.diff(block) != 0))
    bits = np.ascontiguousarray(value).view(np.uint64) * np.uint64(256) + address.astype(np.uint64)
    place = np.arange(len(block)) - np.repeat(begins, np.diff(np.append(begins, len(block))))
    mixed = (bits ^ (bits >> np.uint64(29))) * np.uint64(0x9E3779B97F4A7C15) * (2 * place.astype(np.uint64) + 1)
    key = np.add.reduceat(mixed, begins)
    order = np.argsort(key, kind="stable")
    changes = np.diff(key[order]) != 0
    at = block[begins][order]
    found: Rows = np.concatenate((at[np.append(True, changes)], at[np.append(changes, True)]))
    return found


def _in_force(trace: Trace, row: int) -> list[str]:
    """What is in force behind a row, so that it can be compared; NaN is equal to itself."""
    if row < 0:
        return []
    groups, _, _ = modal_tables(trace.machine)
    columns = [*(trace.state(group) for group in groups), *(getattr(trace, name) for name in _IN_FORCE)]
    return [repr(column[row].item()) for column in columns]
