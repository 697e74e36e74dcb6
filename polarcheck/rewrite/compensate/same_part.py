"""Reads a program with G41 or G42 back and proves that the part is the one of the tool center path."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.columns.metal.milled import Milled
from polarcheck.columns.path.moves import Moves
from polarcheck.foundation.arrays import Floats, Points
from polarcheck.rewrite.compensate.chosen_sections import Section
from polarcheck.rewrite.compensate.pieces import Piece
from polarcheck.rewrite.compensate.ramp_moves import Contour, Ramped
from polarcheck.rewrite.compensate.sides import Swept
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Figure, Refusal, RefusedError, refused_at
from polarcheck.rewrite.writing.reading_back import read_back_on_part, require_equal

#: The number of points compared along each contour, and the points near corners, as shares of a piece.
_POINTS, _NEAR_CORNERS = 400, (0.0, 0.02, 0.1, 0.9, 0.98)
#: Tolerance of a wall: in least increments, and for the chords of arcs [mm].
_INCREMENTS, _CHORDS = 2.0, 5e-4
#: The largest distance of the tool center from the path at an acute corner, in R.
_FARTHEST = 3.0
#: The largest distance of the tool center from an arc with R about a corner, in R: the square root of 2, less 1.
_AT_CORNERS = 0.42
#: Smaller distances that are tried first, in R.
_FINER = (0.003, 0.15, 0.45, 0.9)


class CompensatedContour(msgspec.Struct, frozen=True):
    """
    A contour of a section with its ramps.

    path: the moves of the tool center beside the contour.
    """

    section: Section
    path: Contour
    ramped: Ramped


def require_same_part(
    original: Original, swept: Swept, data: bytes, origin: Sequence[int], contours: Sequence[CompensatedContour]
) -> list[Figure]:
    """
    Return the differences of the part and of the tool center path between the programs with and without G41 and G42.

    swept: what the cutters of the original clear.
    origin: for each line of the new program the line of the original.
    Raises RefusedError where the walls along a contour would differ, or the control would object; TooHardError.
    """
    trace = original.trace
    radius = max(contour.section.radius for contour in contours)
    step = float(np.max(trace.lengths.least_step))
    finer = [share * radius for share in _FINER]
    farthest = _FARTHEST * radius
    result = read_back_on_part(original, data, origin, farthest, finer=finer, of_sections={"has_other_moves": True})
    require_equal(result)
    new_moves: Moves = result.new.tables["tool_center"].moves
    new_milled: Milled = result.new.tables["milled"]
    now = Swept(result.new.trace, new_moves, new_milled.radius[new_moves.row])
    tolerance = _INCREMENTS * step + _CHORDS
    largest = 0.0
    for contour in contours:
        moves, section = contour.section.moves, contour.section
        numbers, points = _points(contour.ramped.contour)
        z = min(moves[number].ends for number in range(contour.path.first, contour.path.last + 1))
        was, becomes = (sweep.distance(points, section.number, z) for sweep in (swept, now))
        # What other moves take away is no wall.
        differs = np.where(was > -tolerance, np.abs(becomes - was), 0.0)
        worst = int(np.argmax(differs))
        largest = max(largest, float(differs[worst]))
        if differs[worst] > tolerance:
            raise refused_at(trace, moves[numbers[worst]].row, _text(was, becomes, worst))
    path = 0.0
    for number, own_radius in dict.fromkeys((contour.section.number, contour.section.radius) for contour in contours):
        apart, row = now.farthest_from(swept, number)
        path = max(path, apart)
        if apart > _AT_CORNERS * own_radius + tolerance:
            line = origin[result.new.trace.line(row) - 1]
            text = f"the tool center would leave its path by {apart:.4f} mm, which no corner explains"
            raise RefusedError([Refusal(line, text)])
    return [
        Figure("largest difference of the part", largest, "mm"),
        Figure("largest distance of the tool center from its path", path, "mm"),
    ]


def _text(was: Floats, becomes: Floats, worst: int) -> str:
    away = "cut" if becomes[worst] < was[worst] else "left standing"
    return f"with G41 or G42 {abs(becomes[worst] - was[worst]):.4f} mm would be {away} beside this path"


def _points(contour: Sequence[Piece]) -> tuple[list[int], Points]:
    """Return points along a contour, more of them near its corners, and the number of the move of each."""
    whole = sum(piece.length for piece in contour) or 1.0
    numbers: list[int] = []
    points: list[complex] = []
    for piece in contour:
        count = max(1, int(_POINTS * piece.length / whole))
        shares = [*_NEAR_CORNERS, *((number + 0.5) / count for number in range(count))]
        points += [piece.at(share) for share in shares]
        numbers += [piece.move] * len(shares)
    return numbers, np.array(points)
