"""Writes paths of the tool center as contours of the part with G41 or G42."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.milled import Milled
from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.compensate.candidates import Candidate, uncovered
from polarcheck.rewrite.compensate.centering import centered
from polarcheck.rewrite.compensate.chosen_sections import Section, sections_of
from polarcheck.rewrite.compensate.compensated_blocks import Stroke, new_blocks
from polarcheck.rewrite.compensate.contours import SIDES, contours_of
from polarcheck.rewrite.compensate.parallel import NoContourError
from polarcheck.rewrite.compensate.pieces import Piece
from polarcheck.rewrite.compensate.ramp_moves import Contour, with_ramps
from polarcheck.rewrite.compensate.same_part import CompensatedContour, require_same_part
from polarcheck.rewrite.compensate.section_moves import Move
from polarcheck.rewrite.compensate.sides import Swept
from polarcheck.rewrite.writing.new_blocks import NewBlock, decision_comment, edit_before, edits_of, with_edits
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Decision, Figure, Outcome, RefusedError, refused_at
from polarcheck.rewrite.writing.style_of import style_of
from polarcheck.rules.wording.offsets import called_tool

#: A ramp stays at one depth if the move that it replaces descends by no more than this [mm].
_SAME_DEPTH = 0.01

__all__ = ["SIDES", "Compensating", "centered", "compensated"]


class Compensating(msgspec.Struct, frozen=True):
    """side: one of SIDES if the program does not say on which side of its paths the part is; empty otherwise."""

    side: str = ""


def compensated(original: Original, options: Compensating = Compensating()) -> Outcome:  # noqa: B008
    """
    Return the program with G41 or G42 and the contour of the part in the place of the paths of the tool center.

    R of the cutter comes from its tool offset in the job. The result is read back and checked: the part must be the
    same.
    Raises RefusedError where a section has no contour, the side of the part or R is not known, or the control would
    make another part; TooHardError.
    """
    if reasons := original.faults():
        raise RefusedError(reasons)
    trace = original.trace
    moves: Moves = original.tables["tool_center"].moves
    milled: Milled = original.tables["milled"]
    bar: Bar = original.tables["bar"]
    sections = sections_of(trace, moves, bar.known.largest)
    swept = Swept(trace, moves, milled.radius[moves.row])
    chosen = contours_of(trace, sections, swept, options.side)
    try:
        data, origin, contours, proof = _written(original, swept, sections, chosen, by_moves=True)
    except RefusedError as error:
        # Where a move to a contour is no good start-up, the contour's first stretch is.
        try:
            data, origin, contours, proof = _written(original, swept, sections, chosen, by_moves=False)
        except RefusedError:
            raise error from None
    figures = [
        Figure("sections with G41 or G42 and the contour", len(sections)),
        Figure("contours", len(contours)),
        *proof,
    ]
    lines = trace.blocks.line_in_file
    decisions = [Decision(int(lines[row]), text) for row, text in _remaining(trace, sections, contours)]
    return Outcome(data, origin, decisions, figures, _notes(trace, contours))


def _written(
    original: Original,
    swept: Swept,
    sections: Sequence[Section],
    chosen: Sequence[Sequence[tuple[Candidate, Contour]]],
    by_moves: bool,
) -> tuple[bytes, list[int], list[CompensatedContour], list[Figure]]:
    """Return the new program, read back. by_moves: moves to and from a contour become its ramps."""
    trace, machine = original.trace, original.settings.machine
    contours = [ramped for pair in zip(sections, chosen, strict=True) for ramped in _ramped(trace, *pair, by_moves)]
    style = style_of(trace)
    blocks = new_blocks(trace, _strokes(trace, contours, machine), style)
    edits = edits_of(original, blocks, style, machine)
    for row, text in _remaining(trace, sections, contours):
        remark = NewBlock((), decision_comment(text))
        edits.append(edit_before(original, int(trace.run.block[row]), [remark], style, machine))
    data, origin = with_edits(original, edits)
    return data, origin, contours, require_same_part(original, swept, data, origin, contours)


def _ramped(
    trace: Trace, section: Section, chosen: Sequence[tuple[Candidate, Contour]], by_moves: bool
) -> list[CompensatedContour]:
    """Return the contours of a section with their ramps."""
    result: list[CompensatedContour] = []
    free = 0
    for index, (candidate, contour) in enumerate(chosen):
        following = chosen[index + 1][0].first if index + 1 < len(chosen) else candidate.high
        low, high = max(candidate.low, free), min(candidate.high, following)
        try:
            ramped = with_ramps(
                section.moves, contour, *((low, high) if by_moves else (contour.first, contour.last + 1))
            )
        except NoContourError as error:
            raise refused_at(trace, section.moves[max(error.move, 0)].row, str(error)) from None
        result.append(CompensatedContour(section, contour, ramped))
        free = max(contour.last, ramped.leaves, *(piece.move for piece in ramped.contour)) + 1
    return result


def _remaining(
    trace: Trace, sections: Sequence[Section], contours: Sequence[CompensatedContour]
) -> Iterator[tuple[int, str]]:
    """
    Yield the first rows of paths that stay those of the tool center, each with what is to be decided.

    Moves to a contour, away from it and between two of them are no path of their own.
    """
    lines = trace.blocks.line_in_file
    for section in sections:
        covered = set[int]()
        for contour in contours:
            if contour.section is section:
                covered |= {*range(*_span(contour)), contour.ramped.enters, contour.ramped.leaves}
        for first, last in uncovered(trace, section, covered - {-1}):
            begin, end = (int(lines[section.moves[number].row]) for number in (first, last))
            text = f"lines {begin} to {end} stay the path of the tool center: no contour was recognized there: write"
            yield section.moves[first].row, f"{text} its G41 or G42 by hand, or leave it"


# ---- to blocks ----


def _strokes(trace: Trace, contours: Sequence[CompensatedContour], machine: Machine) -> dict[int, list[Stroke]]:
    """Return the new moves of all contours by the row that they replace."""
    result: dict[int, list[Stroke]] = {}
    for contour in contours:
        moves, ramped = contour.section.moves, contour.ramped
        key = "compensation_right" if contour.path.aside > 0 else "compensation_left"
        on, off = machine.codes(key)[0], machine.codes("compensation_off")[0]
        numbers = range(*_span(contour))
        for number in numbers:
            result[moves[number].row] = []
        start = ramped.contour[0].start
        if ramped.enters >= 0:
            move = moves[ramped.enters]
            result[move.row] = [Stroke(Piece(move.piece.start, start), (on,), _depth(move))]
        else:
            first = moves[ramped.contour[0].move]
            _require_level(trace, first, ramped.contour[0])
            result[moves[numbers[0]].row].append(Stroke(Piece(first.piece.start, start), (on,)))
        for piece, following in zip(ramped.contour, [*ramped.contour[1:], None], strict=True):
            move = moves[piece.move]
            is_last = following is None or following.move != piece.move
            result[move.row].append(Stroke(piece, z=_depth(move) if is_last else None))
        for number in numbers:
            if not result[moves[number].row]:
                _require_level(trace, moves[number])
        last = moves[numbers[-1]]
        end = ramped.contour[-1].end
        if ramped.leaves >= 0:
            move = moves[ramped.leaves]
            result[move.row] = [Stroke(Piece(end, move.piece.end), (off,), _depth(move))]
        else:
            result[last.row].append(Stroke(Piece(end, ramped.back), (off,)))
    return dict(sorted(result.items()))


def _span(contour: CompensatedContour) -> tuple[int, int]:
    """Return the first move of a contour and the end of its moves, its lead arcs included."""
    numbers = [piece.move for piece in contour.ramped.contour]
    return min(contour.path.first, *numbers), max(contour.path.last, *numbers) + 1


def _depth(move: Move) -> float | None:
    return None if move.is_level else move.ends


def _require_level(trace: Trace, move: Move, rest: Piece | None = None) -> None:
    """
    Raise RefusedError if Z moves in a move that is left out, or whose start becomes a ramp.

    rest: what remains of the contour beside the move. The descent of the part that is left out must be negligible.
    """
    share = 1.0
    if rest is not None and move.piece.sweep:
        share = 1 - rest.sweep / move.piece.sweep
    if not move.is_level and abs(move.ends - move.begins) * share > _SAME_DEPTH:
        raise refused_at(trace, move.row, "Z moves here, where the contour has no move of its own: move Z alone")


def _notes(trace: Trace, contours: Sequence[CompensatedContour]) -> list[str]:
    """Return a note for each tool: the R to enter in its offset."""
    result = []
    for contour in contours:
        row = contour.section.moves[contour.path.first].row
        scale = float(trace.lengths.scale[row])
        tool = called_tool(trace.tools, row)
        result.append(f"{tool}: enter R {contour.section.radius / scale:.4f} in its tool offset, nose type 0 or 9")
    return list(dict.fromkeys(result))
