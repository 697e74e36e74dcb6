"""The single moves of polar sections, for functions that follow a path from corner to corner."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import groupby

import msgspec
import numpy as np

from polarcheck.columns.path.moves import Moves, z_along
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.compensate.pieces import Piece

_TURNING = {int(Motion.CW): -1, int(Motion.CCW): 1}


class Move(msgspec.Struct, frozen=True):
    """
    A move on the polar plane.

    row: row of the trace.
    piece: its line or arc; piece.move is the number of the move in its list.
    begins, ends: Z before and after it [mm]; NaN if it is not known.
    feeds: True at feed, False in rapid traverse.
    """

    row: int
    piece: Piece
    begins: float
    ends: float
    feeds: bool = True

    @property
    def is_level(self) -> bool:
        """True if Z does not move."""
        return not abs(self.ends - self.begins) > ZERO


def of_section(trace: Trace, moves: Moves, section: int) -> list[Move]:
    """Return the moves of one section in order."""
    chosen = np.flatnonzero((moves.section == section) & ~np.isnan(moves.start + moves.end))
    begins, ends = z_along(trace, moves)
    motion = trace.axes.motion[moves.row]
    columns = (moves.row, moves.start, moves.end, moves.center, moves.kind, begins, ends, motion)
    result = []
    for number, values in enumerate(zip(*(column[chosen].tolist() for column in columns), strict=True)):
        row, start, end, center, kind, begin, until, code = values
        turning = _TURNING.get(kind, 0)
        piece = Piece(start, end, center if turning else None, turning, number)
        result.append(Move(row, piece, begin, until, code != Motion.RAPID))
    return result


def consecutive(numbers: Sequence[int]) -> list[list[int]]:
    """Return the runs of ascending numbers in which each is the next one."""
    groups = groupby(enumerate(numbers), lambda pair: pair[1] - pair[0])
    return [[number for _, number in group] for _, group in groups]


def runs(trace: Trace, moves: Sequence[Move]) -> list[tuple[int, int]]:
    """Return the first move and the end of each run of connected moves at feed, without moves of only Z in between."""
    alone = np.cumsum(trace.path.moves_z & ~trace.path.travels)
    result: list[tuple[int, int]] = []
    for number, move in enumerate(moves):
        before = moves[number - 1] if number else None
        joins = before is not None and alone[before.row] == alone[move.row] and before.feeds and move.feeds
        if joins and abs(move.piece.start - moves[number - 1].piece.end) <= ZERO:
            result[-1] = (result[-1][0], number + 1)
        else:
            result.append((number, number + 1))
    return result
