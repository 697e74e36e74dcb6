"""C of the machine and Z along the pieces of moves."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.moves import Moves, z_along
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Points, Rows, Table
from polarcheck.geometry.plane import angle_between
from polarcheck.geometry.straight_axes.division import Pieces
from polarcheck.geometry.straight_axes.spans import Spans
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.writing.outcome import refused_at


class Turns(Table, frozen=True):
    """Per piece C after it and how far it turns, and what C turns on the spot before it [deg]."""

    after: Floats
    turn: Floats
    jump: Floats


def turns_of(trace: Trace, moves: Moves, spans: Spans, pieces: Pieces) -> Turns:
    """C of the machine, counted on from where it stands before the section."""
    sense, move = moves.c_axis.sense, spans.move[pieces.span]
    turn = sense * np.degrees(pieces.turn)
    ways = spans[pieces.span]
    leaves = _seen(pieces.start, ways.directions(pieces.first[:, None])[:, 0])
    arrives = _seen(pieces.end, -ways.directions(pieces.last[:, None])[:, 0])
    jump = np.zeros(len(turn))
    jump[1:] = sense * np.degrees(angle_between(arrives[:-1], leaves[1:]))
    section = moves.section[move]
    begins = np.flatnonzero(np.append(True, np.diff(section) != 0)[: len(section)])
    c_from, _ = moves.c_angles
    jump[begins] = 0
    total = np.cumsum(turn + jump)
    base = np.zeros(len(turn))
    if len(begins):
        first = c_from[move[begins]]
        stands = _stands_at(trace)[section[begins]]
        # The path knows C but for full turns.
        first = first + 360 * np.round((stands - first) / 360)
        jump[begins] = first - stands
        offset = first - (total - turn)[begins]
        base = np.repeat(offset, np.diff(np.append(begins, len(turn))))
    return Turns(base + total, turn, jump)


def _stands_at(trace: Trace) -> Floats:
    """C of the machine before each section [deg]; where nobody says it, that at which the section begins."""
    enter = trace.mode.sections.enter
    before = trace.path.c_angle_before[enter]
    return np.where(np.isnan(before), trace.path.c_angle[enter], before)


def _seen(point: Points, direction: Points) -> Points:
    return np.where(point == 0, direction, point)


class Depths(Table, frozen=True):
    """Per piece Z after it [mm], NaN where it does not move, and its way."""

    after: Floats
    way: Floats


def depths_of(trace: Trace, moves: Moves, move: Rows, begin: Floats, end: Floats) -> Depths:
    z_from, z_to = z_along(trace, moves)
    lost = np.isnan(z_from) & ~np.isnan(z_to)
    if lost.any():
        raise refused_at(trace, moves.row[np.argmax(lost)], "Z moves beside X and C from a place that is not known")
    way = np.nan_to_num(z_to - z_from)
    after = np.where(np.abs(way[move]) <= ZERO, np.nan, z_from[move] + way[move] * end)
    return Depths(after, np.abs(way[move]) * (end - begin))
