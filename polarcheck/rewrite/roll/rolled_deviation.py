"""Reads the sections of the new program back: their distance from the original blocks, their F, and their time."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Rows, stretch
from polarcheck.foundation.states import FeedMode, Motion
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.straight_axes.spiral_pieces import along, distances
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.compare.compared_sections import NOWHERE
from polarcheck.rewrite.compare.terms import FEED_SHARE, lines_before
from polarcheck.rewrite.roll.entries import Entry
from polarcheck.rewrite.roll.rollable import Stretch
from polarcheck.rewrite.roll.rolled_blocks import Writer
from polarcheck.rewrite.roll.rolled_elements import Fit
from polarcheck.rewrite.roll.rolled_feeds import Feeds
from polarcheck.rewrite.roll.slowing import Parts
from polarcheck.rewrite.roll.ways import AxisMoves
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Figure, Measured, Refusal

#: Places on a block at which it is measured.
_PLACES = np.linspace(0.125, 1, 8)[None, :]


class Section(msgspec.Struct, frozen=True):
    """
    A stretch and what becomes of it.

    unit: mm per unit of length that F counts. first_line: of the first block that is replaced, in the file.
    """

    stretch: Stretch
    way: AxisMoves
    fit: Fit
    feeds: Feeds
    parts: Parts
    unit: float
    entry: Entry | None
    text: Writer
    first_line: int


def measured_of(
    original: Original, new: Original, origin: Sequence[int], sections: Sequence[Section], tolerance: float
) -> Measured:
    """
    Read the sections of the new program.

    origin: for each of its lines the line in the original, from 1. tolerance: how far ends of blocks may be from them
    [mm].
    """
    trace, moves = new.trace, new.tables["tool_center"].moves
    stands_for = lines_before(trace, origin)
    enters = stands_for[trace.mode.sections.enter].tolist()
    number_of = dict(zip(enters, range(len(enters)), strict=True))
    differences: list[Refusal] = []
    places = away_of_path = time = 0.0
    lines = original.trace.blocks.line_in_file
    for section in sections:
        keep_time()
        row = section.stretch.first if section.entry is None else section.entry.behind
        number = number_of.get(int(lines[row]))
        if number is None:
            differences.append(Refusal(section.stretch.line, "the section is not found in the result"))
            continue
        low, high = np.searchsorted(moves.section, (number, number + 1)).tolist()
        moves_of_section: Moves = moves[low:high]
        of_line = stands_for[moves_of_section.row]
        away = _away(section, moves_of_section, of_line, lines, complex(trace.path.section_turn[number]))
        at_ends = away[:, -1]
        worst = int(np.argmax(at_ends))
        places, away_of_path = max(places, float(at_ends[worst])), max(away_of_path, float(away.max()))
        if not at_ends[worst] <= tolerance:
            line = int(lines[section.way.row[worst]])
            text = f"the path would be {at_ends[worst]:.4f} mm away from the end of this block"
            if np.isinf(at_ends[worst]):
                text = "no move of the result leads to the end of this block"
            differences.append(Refusal(line, text))
        in_section = of_line >= section.stretch.line
        differences += _feeds(section, moves_of_section[in_section], of_line[in_section], trace)
        time += float(np.nansum((moves_of_section.length / moves_of_section.feed)[in_section])) * 60
        time += 60 * sum(
            float(section.way.rise[element.first]) / feed
            for element, feed in zip(section.parts.elements, section.parts.feeds, strict=True)
            if element.kind == Motion.NONE
        )
    was = 60 * sum(float(section.way.time.sum()) for section in sections)
    figures = [
        Figure("largest distance of the ends of the blocks from the new path", places, "mm"),
        Figure("largest distance between the old and the new path within a block", away_of_path, "mm"),
        Figure("time at feed before", was, "s"),
        Figure("time at feed after", time, "s"),
    ]
    return Measured(differences, figures)


def _feeds(section: Section, moves: Moves, of_line: Rows, trace: Trace) -> list[Refusal]:
    """Return a refusal if a move has an F that is not one of the intended ones."""
    intended = np.sort(section.parts.feeds)
    index = np.clip(np.searchsorted(intended, moves.feed), 1, max(len(intended) - 1, 1))
    nearest = np.minimum(*(np.abs(moves.feed / intended[np.minimum(index - n, len(intended) - 1)] - 1) for n in (0, 1)))
    per_minute = trace.feedrate.feed_mode[moves.row] == FeedMode.PER_MINUTE
    wrong = (moves.kind != Motion.RAPID) & ~((nearest <= FEED_SHARE) & per_minute)
    return [Refusal(int(line), "F of the result is not the one that was meant") for line in of_line[wrong][:1]]


def _away(section: Section, moves: Moves, of_line: Rows, lines: Rows, turn: complex) -> Floats:
    """
    Return the distance of each block on the plane from the moves that replace it [mm], at points along it, the last at
    its end.

    inf if no move replaces it.
    """
    original = section.way
    points = along(original.start_radius, original.radius, original.start_angle, original.angle, _PLACES)
    away = np.repeat(np.where(original.length > ZERO, np.inf, 0.0)[:, None], points.shape[1], axis=1)
    path = moves.turned_by(turn)
    sweep = path.sweep
    center = np.where(sweep == 0, NOWHERE, path.center)
    for element in section.parts.elements:
        line = int(lines[original.row[element.until - 1]])
        of_element = slice(*stretch(of_line, line, line + 1))
        if element.kind == Motion.NONE or of_element.start == of_element.stop:
            continue
        # A block at a joint lies beside the element before it, too.
        first, until = max(element.first - 1, 0), min(element.until + 1, len(original))
        samples = points[first:until].ravel()
        samples = np.broadcast_to(samples, (of_element.stop - of_element.start, len(samples)))
        far = distances(samples, path.start[of_element], path.end[of_element], center[of_element], sweep[of_element])
        away[first:until] = np.minimum(away[first:until], far.min(axis=0).reshape(until - first, -1))
    return away
