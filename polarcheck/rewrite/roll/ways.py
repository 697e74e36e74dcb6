"""The path of a stretch as the machine runs it: radii, angles, depths and times of its blocks."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Rows, Table
from polarcheck.foundation.states import FeedMode
from polarcheck.geometry.plane import quiet
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rewrite.roll.rollable import Stretch
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rewrite.writing.rotary_feed import INVERSE_TIME, block_times, feed_not_known, per_minute

#: A turn of C on the spot within this of half turns counts as half turns [rad].
_HALF_TURN = 1e-4
#: Nearer to the center than this, C turns on the spot [mm].
_SPOT = 1e-6


class AxisMoves(Table, frozen=True):
    """
    The moves of a stretch in order; after move k the tool is at radius[k] exp(i angle[k]).

    row: the row of the trace.
    start_radius, radius: X as a radius before and after the move, of either sign [mm].
    start_angle, angle: direction of the tool on the part before and after it, not reduced to one turn [rad].
    z_before, z: Z before and after it [mm], 0 where it is not known.
    length: distance on the plane [mm]. rise: distance along Z [mm]. turn: turn of C [deg]. time: [min].
    feed: F per minute as written, NaN for inverse time.
    """

    row: Rows
    start_radius: Floats
    radius: Floats
    start_angle: Floats
    angle: Floats
    z_before: Floats
    z: Floats
    length: Floats
    rise: Floats
    turn: Floats
    time: Floats
    feed: Floats


def per_minute_rule(trace: Trace, stretches: list[Stretch], feed: str) -> str:
    """
    Return what F per minute means in blocks of X and C; empty if no block has F per minute.

    feed: the option; empty for what the machine has. Raises RefusedError if the meaning is needed and not known.
    """
    rows = np.concatenate([np.arange(candidate.first, candidate.last + 1) for candidate in stretches])
    moving = rows[(trace.path.moves_c | trace.path.moves_x)[rows]]
    mode = trace.feedrate.modal_feed_mode[moving]
    if not (mode == FeedMode.PER_MINUTE).any():
        return ""
    line = trace.line(moving[np.argmax(mode == FeedMode.PER_MINUTE)])
    if feed == INVERSE_TIME:
        code = trace.machine.codes("feed_inverse_time")[0]
        raise RefusedError([Refusal(line, f"F is per minute here, and not inverse time: no {code} is in force")])
    if not feed and not per_minute(trace.machine):
        raise feed_not_known(trace.machine, "what F per minute is where X and C move together", line)
    return feed or per_minute(trace.machine)[0]


def axis_moves(trace: Trace, candidate: Stretch, rule: str) -> AxisMoves:
    """Return the moves of a stretch, without blocks that move nothing; rule: what F per minute means."""
    path = trace.path
    rows = candidate.rows(trace)
    rows = rows[(path.moves_x | path.moves_c | path.moves_z)[rows]]
    start_radius, radius = path.x_before[rows], path.x[rows]
    turn = np.where(path.moves_c[rows], path.c_turn[rows], 0.0)
    start = float(path.c_angle_before[rows[0]])
    if np.isnan(start):
        raise RefusedError([Refusal(candidate.line, "C is not known where it begins: position it before, as C0")])
    sense = path.c_axis.sense
    angle = np.radians(sense * (start + np.cumsum(turn)))
    start_angle = np.append(np.radians(sense * start), angle[:-1])
    z_before, z = np.nan_to_num(path.z_before[rows]), np.nan_to_num(path.z[rows])
    z_before = np.where(np.isnan(path.z_before[rows]), z, z_before)
    rise = np.abs(z - z_before)
    unit = trace.lengths.feed_scale[rows]
    number = trace.feedrate.written_feed[rows] / unit
    step = radius - start_radius
    time = block_times(INVERSE_TIME, step, turn, rise, number)
    per_minute = trace.feedrate.modal_feed_mode[rows] == FeedMode.PER_MINUTE
    if per_minute.any():
        along = np.abs(turn) + np.abs(step) > 0
        of_rule = block_times(rule or "per-minute", step, turn, rise, number, unit)
        time = np.where(per_minute, np.where(along, of_rule, rise / unit / number), time)
    return AxisMoves(
        row=rows,
        start_radius=start_radius,
        radius=radius,
        start_angle=start_angle,
        angle=angle,
        z_before=z_before,
        z=z,
        length=_lengths(start_radius, radius, angle - start_angle),
        rise=rise,
        turn=turn,
        time=time,
        feed=np.where(per_minute, number, np.nan),
    )


@quiet
def _lengths(start: Floats, end: Floats, turn: Floats) -> Floats:
    """Lengths of spirals of linear r and angle w: the integral of hypot(r', r w'), by Gauss with eight points."""
    node, weight = np.polynomial.legendre.leggauss(8)
    radius = start[:, None] + (end - start)[:, None] * (node + 1)[None, :] / 2
    return np.asarray(np.hypot((end - start)[:, None], radius * turn[:, None]) @ weight / 2)


def runs_of(moves: AxisMoves) -> Iterator[tuple[int, int, bool]]:
    """
    Yield each run of moves: its first move, the one after its last, and True if it moves on the plane.

    A run on the plane ends at a move of Z alone, which is a run by itself, and where C turns on the spot at the center.
    """
    on_plane, alone = moves.length > ZERO, (moves.length <= ZERO) & (moves.rise > ZERO)
    kind = np.where(on_plane, 1, 0)
    begins = np.flatnonzero((np.diff(kind, prepend=-1) != 0) | ~on_plane)
    for begin, end in zip(begins.tolist(), [*begins[1:].tolist(), len(moves)], strict=True):
        if on_plane[begin] or alone[begin]:
            yield begin, end, bool(on_plane[begin])


def through_center(moves: AxisMoves) -> AxisMoves:
    """
    Return the way without half turns of C at the center; from each of them on, X has the opposite sign.

    A tool that comes to X0, turns C by 180 deg on the spot and goes on runs straight through the center.
    """
    spot = (moves.length <= _SPOT) & (moves.rise <= ZERO)
    if not spot.any():
        return moves
    # Only half turns are taken out; other turns on the spot end a run.
    turn = np.where(spot, moves.angle - moves.start_angle, 0.0)
    halves = np.round(turn / np.pi)
    is_half = spot & (np.abs(turn - halves * np.pi) < _HALF_TURN)
    taken = np.cumsum(np.where(is_half, halves, 0.0))
    sign = np.where(taken % 2 == 0, 1.0, -1.0)
    before = np.append(0.0, taken[:-1])
    sign_before = np.where(before % 2 == 0, 1.0, -1.0)
    changed = msgspec.structs.replace(
        moves,
        radius=moves.radius * sign,
        start_radius=moves.start_radius * sign_before,
        angle=moves.angle - taken * np.pi,
        start_angle=moves.start_angle - before * np.pi,
    )
    return changed[~is_half]
