"""The sections of the new program, read back: how far they are from the blocks that they stand for, F, and the time."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Rows, stretch
from polarcheck.columns.trace import Trace
from polarcheck.conversion.original import Original
from polarcheck.conversion.outcome import Refusal
from polarcheck.conversion.rolling.elements import Fit
from polarcheck.conversion.rolling.entries import Entry
from polarcheck.conversion.rolling.feeds import Feeds
from polarcheck.conversion.rolling.stretches import Stretch
from polarcheck.conversion.rolling.ways import Way
from polarcheck.conversion.rolling.writing import Writer
from polarcheck.geometry.plane import arc_sweep
from polarcheck.geometry.straight_axes.pieces import distances
from polarcheck.geometry.tolerances import ZERO
from polarcheck.machines.modal import FeedMode, Motion
from polarcheck.revisions.stretches import NOWHERE, turn_of
from polarcheck.table.moves import Moves
from polarcheck.time_limit import keep_time

#: F may differ from what was meant to be written by this share: its digits.
_SAME_FEED = 1e-3


class Section(msgspec.Struct, frozen=True):
    """
    A stretch and what becomes of it.

    unit: mm per unit of length that F counts. first_line: of the first block that is replaced, in the file.
    """

    stretch: Stretch
    way: Way
    fit: Fit
    feeds: Feeds
    unit: float
    entry: Entry | None
    text: Writer
    first_line: int


class Measured(msgspec.Struct, frozen=True):
    """
    What was read back.

    places: how far ends of blocks are from the new path at most [mm]. time: of the new blocks at feed [s].
    """

    differences: list[Refusal]
    places: float
    time: float


def measured_of(
    original: Original, new: Original, origin: Sequence[int], sections: Sequence[Section], tolerance: float
) -> Measured:
    """
    Read the sections of the new program.

    origin: for each of its lines the line in the original, from 1. tolerance: how far ends of blocks may be from them
    [mm].
    """
    trace, moves = new.trace, new.tables["tool_center"].moves
    stands_for = np.array([0, *origin])[np.minimum(trace.blocks.line_in_file, len(origin))]
    enters = stands_for[trace.mode.sections.enter].tolist()
    number_of = dict(zip(enters, range(len(enters)), strict=True))
    differences: list[Refusal] = []
    largest = time = 0.0
    lines = original.trace.blocks.line_in_file
    for each in sections:
        keep_time()
        row = each.stretch.first if each.entry is None else each.entry.behind
        number = number_of.get(int(lines[row]))
        if number is None:
            differences.append(Refusal(each.stretch.line, "the section is not found in the result"))
            continue
        low, high = np.searchsorted(moves.section, (number, number + 1)).tolist()
        own: Moves = moves[low:high]
        of_line = stands_for[own.row]
        away = _away(each, own, of_line, lines, turn_of(trace, number))
        worst = int(np.argmax(away))
        largest = max(largest, float(away[worst]))
        if not away[worst] <= tolerance:
            line = int(lines[each.way.row[worst]])
            differences.append(Refusal(line, f"the path would be {away[worst]:.4f} mm away from the end of this block"))
        behind = of_line >= each.stretch.line
        differences += _feeds(each, own[behind], of_line[behind], trace)
        time += float(np.nansum((own.length / own.feed)[behind])) * 60
        time += 60 * sum(
            float(each.way.rise[element.first]) / feed
            for element, feed in zip(each.fit.elements, each.feeds.of_element, strict=True)
            if element.kind == Motion.NONE
        )
    return Measured(differences, largest, time)


def _feeds(each: Section, moves: Moves, of_line: Rows, trace: Trace) -> list[Refusal]:
    """F of moves that none of the elements was to have."""
    meant = np.sort(each.feeds.of_element)
    at = np.clip(np.searchsorted(meant, moves.feed), 1, max(len(meant) - 1, 1))
    nearest = np.minimum(*(np.abs(moves.feed / meant[np.minimum(at - n, len(meant) - 1)] - 1) for n in (0, 1)))
    per_minute = trace.feedrate.feed_mode[moves.row] == FeedMode.PER_MINUTE
    wrong = (moves.kind != Motion.RAPID) & ~((nearest <= _SAME_FEED) & per_minute)
    return [Refusal(int(line), "F of the result is not the one that was meant") for line in of_line[wrong][:1]]


def _away(each: Section, moves: Moves, of_line: Rows, lines: Rows, turn: complex) -> Floats:
    """How far the end of each block on the plane is from the moves that stand for it [mm]; inf where none does."""
    way = each.way
    points = way.radius * np.exp(1j * way.angle)
    away = np.where(way.length > ZERO, np.inf, 0.0)
    start, end, center = moves.start * turn, moves.end * turn, moves.center * turn
    sweep = arc_sweep(start, end, np.where(np.isnan(center), 0, center), moves.kind)
    center = np.where(sweep == 0, NOWHERE, center)
    for element in each.fit.elements:
        line = int(lines[way.row[element.until - 1]])
        own = slice(*stretch(of_line, line, line + 1))
        if element.kind == Motion.NONE or own.start == own.stop:
            continue
        blocks = slice(element.first, element.until)
        place = np.broadcast_to(points[blocks], (own.stop - own.start, element.until - element.first))
        far = distances(place, start[own], end[own], center[own], sweep[own]).min(axis=0)
        away[blocks] = np.minimum(away[blocks], far)
    return away
