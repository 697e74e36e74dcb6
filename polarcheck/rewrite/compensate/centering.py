"""Writes contours with G41 or G42 as paths of the tool center, for a control without compensation in the polar mode."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from polarcheck.columns.path.moves import Moves
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask
from polarcheck.geometry.cutter_compensation.offset_path import Phase
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.compensate.chosen_sections import compensated_sections
from polarcheck.rewrite.compensate.compensated_blocks import Stroke, Strokes, new_blocks
from polarcheck.rewrite.compensate.section_moves import Move, of_section
from polarcheck.rewrite.writing.new_blocks import NewBlock, edit_before, edits_of, with_edits
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Figure, Outcome, RefusedError, radius_not_known
from polarcheck.rewrite.writing.reading_back import read_back_on_part, require_equal
from polarcheck.rewrite.writing.refused_sections import Check, refusals_in_sections, unknown_positions
from polarcheck.rewrite.writing.style_of import style_of
from polarcheck.rules.wording.offsets import called_tool

#: The most by which rounding and chords may shift the path, in least increments.
_INCREMENTS = 1.5
#: Rules that find a contour of which the control makes another path, or an alarm; they say nothing without G41 and G42.
_OF_COMPENSATION = (
    *(
        "cancel-shorter-than-radius",
        "inside-arc-smaller-than-radius",
        "interference",
        "movement-missing-in-offset-mode",
    ),
    *("no-offset-intersection", "overcut", "start-up-shorter-than-radius", "start-up-sweeps-contour"),
)


def centered(original: Original) -> Outcome:
    """
    Return the program with the path of the tool center in the place of its contours, without G41, G42 and G40.

    The result is read back and checked: its tool center must run on the path of the original.
    Raises RefusedError where a path is not known or the control would object to it; TooHardError.
    """
    trace = original.trace
    tool_center: ToolCenter = original.tables["tool_center"]
    compensated = trace.mode.anywhere_in_section(trace.compensation.compensates)
    sections = compensated_sections(trace)
    _require_path(original, tool_center.moves, compensated)
    style, machine = style_of(trace), original.settings.machine
    strokes = _strokes(trace, tool_center.moves, compensated)
    blocks = new_blocks(trace, strokes, style)
    cutters = list(_cutters(trace, sections))
    edits = edits_of(original, blocks, style, machine)
    first = {
        int(trace.run.block[trace.mode.sections.enter[section]]): f"TOOL CENTER PATH OF {tool} WITH R{radius}"
        for section, tool, radius in cutters
    }
    edits += [edit_before(original, block, [NewBlock(comment=text)], style, machine) for block, text in first.items()]
    data, origin = with_edits(original, sorted(edits))
    step = float(np.max(trace.lengths.least_step))
    tolerance = _INCREMENTS * step + 1e-3
    terms = {"tolerance": tolerance, "is_rewritten": True}
    result = read_back_on_part(original, data, origin, tolerance, of_sections=terms)
    require_equal(result)
    figures = [
        Figure("sections written as the path of the tool center", len(sections)),
        Figure("largest distance of the path from that of the original", result.deviation, "mm"),
    ]
    notes = [
        f"{tool} with R {radius}: another R in the offset table changes nothing any more" for _, tool, radius in cutters
    ]
    return Outcome(data, origin, [], figures, list(dict.fromkeys(notes)))


def _require_path(original: Original, moves: Moves, compensated: Mask) -> None:
    """Raise RefusedError where the path of the tool center is not known, or not that of the contour."""
    trace = original.trace
    is_unknown = trace.compensation.compensates & trace.path.travels & np.isnan(trace.compensation.radius)
    if refusals := list(refusals_in_sections(trace, [(is_unknown, radius_not_known)])):
        raise RefusedError(refusals[:1])
    faults = original.faults(*_OF_COMPENSATION)
    of_contour = trace.blocks.mask_of(moves.row[moves.arc_share != 1])
    checks: list[Check] = [
        unknown_positions(trace, trace.blocks.mask_of(moves.row[~moves.known]) & compensated, faults),
        (trace.blocks.mask_of(moves.row[moves.allowance != 0]), "an infeed cycle makes the passes"),
        (of_contour & compensated, "F along this arc is that of the contour, not of the tool center: switch that off"),
    ]
    if refusals := [*faults, *refusals_in_sections(trace, checks)]:
        raise RefusedError(sorted(refusals, key=lambda refusal: refusal.line))


def _strokes(trace: Trace, moves: Moves, compensated: Mask) -> Strokes:
    """
    Return the new moves of the rows whose path differs from the programmed one, and empty entries for rows whose codes
    are left out.
    """
    writes = trace.compensation.writes_side | trace.compensation.writes_cancel
    result: dict[int, list[Stroke]] = {row: [] for row in np.flatnonzero(writes & compensated).tolist()}
    changed = trace.blocks.mask_of(moves.row[moves.phase != Phase.CANCELLED])
    for row in np.flatnonzero(changed & compensated & trace.path.on_plane).tolist():
        result.setdefault(row, [])
    for section in np.unique(trace.mode.section[list(result)]).tolist():
        new = [move for move in of_section(trace, moves, section) if move.row in result]
        for move in _without_short(new, trace.lengths.least_step):
            result[move.row].append(Stroke(move.piece, z=None if move.is_level else move.ends))
    return dict(sorted(result.items()))


def _without_short(moves: Sequence[Move], shortest: Floats) -> list[Move]:
    """
    Return the moves without lines between two others that are shorter than that, as at almost smooth corners.

    shortest: of each row [mm].
    """
    result: list[Move] = []
    for move, following in zip(moves, [*moves[1:], None], strict=False):
        piece = move.piece
        if result and following is not None and piece.center is None and move.is_level:
            is_between = abs(following.piece.start - piece.end) <= ZERO
            if is_between and abs(piece.end - result[-1].piece.end) < shortest[move.row] and piece.length > ZERO:
                continue
        result.append(move)
    return result


def _cutters(trace: Trace, sections: list[int]) -> Iterator[tuple[int, str, str]]:
    """Yield the number of each section, its tool as the program calls it, and R in the units of the program."""
    for section in sections:
        rows = np.flatnonzero((trace.mode.section == section) & trace.compensation.compensates & trace.path.travels)
        if not len(rows):
            continue
        row = int(rows[0])
        radius = abs(float(trace.compensation.radius[row])) / float(trace.lengths.scale[row])
        yield section, called_tool(trace.tools, row), f"{radius:.4f}".rstrip("0")
