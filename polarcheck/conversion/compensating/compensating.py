"""Paths of the tool center written as contours of the part with G41 or G42."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.checking.phrases.offsets import called_tool, example, to_give
from polarcheck.columns.trace import Trace
from polarcheck.conversion.blocks import edits_of, with_edits
from polarcheck.conversion.compensating.centering import centered
from polarcheck.conversion.compensating.contours import SIDES, Found, Section, contours_of
from polarcheck.conversion.compensating.moves import Move, of_section
from polarcheck.conversion.compensating.parallel import NoContourError
from polarcheck.conversion.compensating.pieces import Piece
from polarcheck.conversion.compensating.ramps import Contour, with_ramps
from polarcheck.conversion.compensating.same_part import Made, Proof, require_same_part
from polarcheck.conversion.compensating.sides import Swept
from polarcheck.conversion.compensating.writing import Stroke, new_blocks
from polarcheck.conversion.original import Original
from polarcheck.conversion.outcome import Figure, Outcome, Refusal, RefusedError
from polarcheck.conversion.style_of import style_of
from polarcheck.geometry.tolerances import ADJUSTMENT, ROUNDING
from polarcheck.machines.machine import Machine
from polarcheck.table.bar import Bar
from polarcheck.table.milled import Milled
from polarcheck.table.moves import Moves

__all__ = ["SIDES", "Compensating", "centered", "compensated"]


class Compensating(msgspec.Struct, frozen=True):
    """side: one of SIDES where the program does not say on which side of its paths the part is; else empty."""

    side: str = ""


def compensated(original: Original, options: Compensating = Compensating()) -> Outcome:  # noqa: B008
    """
    Return the program with G41 or G42 and the contour of the part in the place of the paths of the tool center.

    R of the cutter is that of its tool offset in the job. The result is read back: the part is the same.
    Raises RefusedError where a section has no contour, the side of the part or R is not known, or the control would not
    make the same part; TooHardError.
    """
    trace = original.trace
    moves: Moves = original.tables["tool_center"].moves
    milled: Milled = original.tables["milled"]
    bar: Bar = original.tables["bar"]
    numbers = _sections(trace)
    swept = Swept(trace, moves, milled.radius[moves.row])
    sections = [
        Section(number, of_section(trace, moves, number), _radius(trace, number), bar.known.largest)
        for number in numbers
    ]
    chosen = [contours_of(trace, section, swept, options.side) for section in sections]
    try:
        data, origin, made, proof = _written(original, swept, sections, chosen, by_moves=True)
    except RefusedError as error:
        # Where a move to a contour is no good start-up, the contour's first stretch is.
        try:
            data, origin, made, proof = _written(original, swept, sections, chosen, by_moves=False)
        except RefusedError:
            raise error from None
    figures = [
        Figure("sections with G41 or G42 and the contour", len(sections)),
        Figure("contours", len(made)),
        Figure("largest difference of the part", proof.part, "mm"),
        Figure("largest distance of the tool center from its path, at corners", proof.path, "mm"),
    ]
    return Outcome(data, origin, [], figures, _notes(trace, made))


def _written(
    original: Original,
    swept: Swept,
    sections: Sequence[Section],
    chosen: Sequence[Sequence[tuple[Found, Contour]]],
    by_moves: bool,
) -> tuple[bytes, list[int], list[Made], Proof]:
    """The new program, read back. by_moves: moves to a contour and away from it become ramps."""
    trace, machine = original.trace, original.settings.machine
    made = [each for pair in zip(sections, chosen, strict=True) for each in _made(trace, *pair, by_moves)]
    style = style_of(trace)
    blocks = new_blocks(trace, _strokes(trace, made, machine), style)
    data, origin = with_edits(original, edits_of(original, blocks, style, machine))
    return data, origin, made, require_same_part(original, swept, data, origin, made)


def _sections(trace: Trace) -> list[int]:
    """The sections that cut along the path of the tool center. Raises RefusedError where there is none."""
    cuts = trace.path.cuts & ~trace.mode.anywhere_in_section(trace.compensation.compensates)
    numbers: list[int] = np.unique(trace.mode.section[cuts & trace.mode.in_polar]).tolist()
    if not numbers:
        raise RefusedError([Refusal(0, "no polar section programs the path of the tool center: all have G41 or G42")])
    return numbers


def _radius(trace: Trace, section: int) -> float:
    """R of the tool offset in force in a section [mm]. Raises RefusedError where it is not known."""
    rows = np.flatnonzero((trace.mode.section == section) & trace.path.travels)
    row, line = int(rows[0]), int(trace.blocks.line_in_file[rows[0]])
    if not trace.tools.offset_number[row]:
        how = f"call one before the section, as {example(trace.machine)}"
        raise RefusedError([Refusal(line, f"no tool offset is in force, from which the control would take R: {how}")])
    radius = np.unique(trace.offsets.radius_of_offset[rows])
    tool = called_tool(trace.tools, row)
    if np.isnan(radius).any():
        missing = to_give(trace.tools, trace.machine, row, "radius")
        raise RefusedError([Refusal(line, f"R of {tool} is not known: {missing}")])
    if len(radius) > 1:
        raise RefusedError([Refusal(line, "another tool offset is called in the section")])
    if radius[0] <= ADJUSTMENT + ROUNDING:
        missing = to_give(trace.tools, trace.machine, row, "radius")
        text = f"R of {tool} is {radius[0]:g} mm, which is not the radius of its cutter: {missing}"
        raise RefusedError([Refusal(line, text)])
    if trace.compensation.sides_are_open[row]:
        raise RefusedError([Refusal(line, "on the sub-spindle nobody knows which of G41 and G42 is meant")])
    return float(radius[0])


def _made(trace: Trace, section: Section, chosen: Sequence[tuple[Found, Contour]], by_moves: bool) -> list[Made]:
    """The contours of a section with their ramps."""
    result: list[Made] = []
    free = 0
    for index, (each, contour) in enumerate(chosen):
        following = chosen[index + 1][0].first if index + 1 < len(chosen) else each.high
        low, high = max(each.low, free), min(each.high, following)
        try:
            ramped = with_ramps(
                section.moves, contour, *((low, high) if by_moves else (contour.first, contour.last + 1))
            )
        except NoContourError as error:
            line = int(trace.blocks.line_in_file[section.moves[max(error.move, 0)].row])
            raise RefusedError([Refusal(line, str(error))]) from None
        result.append(Made(section, contour, ramped))
        free = max(contour.last, ramped.leaves, *(piece.move for piece in ramped.contour)) + 1
    return result


# ---- to blocks ----


def _strokes(trace: Trace, made: Sequence[Made], machine: Machine) -> dict[int, list[Stroke]]:
    """The new moves of all contours, by the rows in whose place they stand."""
    result: dict[int, list[Stroke]] = {}
    for each in made:
        moves, ramped = each.section.moves, each.ramped
        key = "compensation_right" if each.contour.aside > 0 else "compensation_left"
        on, off = machine.codes(key)[0], machine.codes("compensation_off")[0]
        numbers = range(*_span(each))
        for number in numbers:
            result[moves[number].row] = []
        start = ramped.contour[0].start
        if ramped.enters >= 0:
            move = moves[ramped.enters]
            result[move.row] = [Stroke(Piece(move.piece.start, start), (on,), _depth(move))]
        else:
            first = moves[ramped.contour[0].move]
            _require_level(trace, first)
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


def _span(made: Made) -> tuple[int, int]:
    """The numbers of the moves of a contour, with the arcs that lead to it and away from it."""
    numbers = [piece.move for piece in made.ramped.contour]
    return min(made.contour.first, *numbers), max(made.contour.last, *numbers) + 1


def _depth(move: Move) -> float | None:
    return None if move.is_level else move.ends


def _require_level(trace: Trace, move: Move) -> None:
    """Raise RefusedError for a move that is left out, or is a ramp, and goes down."""
    if not move.is_level:
        line = int(trace.blocks.line_in_file[move.row])
        raise RefusedError([Refusal(line, "Z moves here, where the contour has no move of its own: move Z alone")])


def _notes(trace: Trace, made: Sequence[Made]) -> list[str]:
    """What to enter in the offset table, and on which side of which contours the tool is."""
    result = []
    for each in made:
        row = each.section.moves[each.contour.first].row
        scale = float(trace.lengths.scale[row])
        tool = called_tool(trace.tools, row)
        result.append(f"{tool}: enter R {each.section.radius / scale:.4f} in its tool offset, nose type 0 or 9")
    return list(dict.fromkeys(result))
