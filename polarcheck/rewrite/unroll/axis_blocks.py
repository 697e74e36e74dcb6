"""The blocks of X and C that take the place of the moves of the tool center, as numbers."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.path.lengths import RADIUS_FACTOR
from polarcheck.columns.path.moves import Moves, z_along
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import angle_between
from polarcheck.geometry.straight_axes.division import Pieces, divide
from polarcheck.geometry.straight_axes.spans import Spans, spans_of
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
    spans_of_pieces = spans[pieces.span]
    leaves = _seen(pieces.start, spans_of_pieces.directions(pieces.first[:, None])[:, 0])
    arrives = _seen(pieces.end, -spans_of_pieces.directions(pieces.last[:, None])[:, 0])
    jump = np.append(0.0, sense * np.degrees(angle_between(arrives[:-1], leaves[1:])))[: len(turn)]
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
    """Z after each piece [mm], NaN if it does not move, and the distance that Z travels in it [mm]."""

    after: Floats
    way: Floats


def depths_of(trace: Trace, moves: Moves, move: Rows, begin: Floats, end: Floats) -> Depths:
    z_from, z_to = z_along(trace, moves)
    lost = np.isnan(z_from) & ~np.isnan(z_to)
    if lost.any():
        raise refused_at(trace, moves.row[np.argmax(lost)], "Z moves beside X and C from a place that is not known")
    depth_change = np.nan_to_num(z_to - z_from)
    after = np.where(np.abs(depth_change[move]) <= ZERO, np.nan, z_from[move] + depth_change[move] * end)
    return Depths(after, np.abs(depth_change[move]) * (end - begin))


#: Most blocks of a new program.
MOST = 1_000_000
#: Largest turn of C in one block [deg]; where C reaches an angle the shorter way, it must be less than half a turn.
_HALF, _ROLLING = 180.0, 120.0
#: A path nearer to the center than half the increment of X counts as through the center; that increment is at least
#: this [mm].
_NOTHING = 1e-6


class Steps(Table, frozen=True):
    """
    One element per new block of X and C, in order.

    row: the row of the trace that it replaces.
    move: the move of the tool center; -1 if C turns on the spot.
    x: the X word in least increments.
    c: C after the block in least increments, counted on over full turns.
    z: the Z word in least increments; NaN if Z does not move.
    rise: distance that Z travels [mm].
    radius_step: travel of X as a radius, as rounded [mm].
    turn: turn of C, as rounded [deg].
    length: length of the tool center path on the plane [mm].
    time: the shortest time in which the tool is nowhere faster than the F of the section [s].
    is_rapid: rapid traverse in the mode. Its F is that of the machine for positioning: G0 would not keep the path,
    since X and C need not arrive together.
    """

    row: Rows
    move: Rows
    x: Rows
    c: Rows
    z: Floats
    rise: Floats
    radius_step: Floats
    turn: Floats
    length: Floats
    time: Floats
    is_rapid: Mask


def x_factor(trace: Trace) -> Floats:
    """Radius per written X in each row as it would be outside of the mode."""
    outside, at_start = trace.mode.section < 0, RADIUS_FACTOR[trace.machine.control.x]
    factor = np.where(outside, trace.lengths.x_factor, at_start)
    return fill_down(factor, outside | trace.blocks.starts, at_start)


def steps_of(trace: Trace, moves: Moves, chord_error: float) -> Steps:
    """
    Divide the moves of the tool center [mm].

    With the rounding of X and C the tool leaves its path by no more than the chord error.
    Raises RefusedError where Z is not known, or rounding takes most of the chord error; TooHardError for too many
    blocks.
    """
    x_step = (x_factor(trace) * trace.lengths.least_step)[moves.row]
    c_step = trace.machine.control.least_increment
    spans = spans_of(*moves.shape, float(np.max(x_step, initial=_NOTHING)) / 2, chord_error / 2)
    largest = _ROLLING if trace.machine.control.rotary_rolls_over else _HALF
    allowed, is_short = _chord_errors(trace, moves, spans, x_step, chord_error)
    pieces = divide(spans, allowed, np.radians(largest), MOST)
    move = spans.move[pieces.span]
    begin, end = spans.share(pieces.span, pieces.first), spans.share(pieces.span, pieces.last)
    c, z = turns_of(trace, moves, spans, pieces), depths_of(trace, moves, move, begin, end)
    scale, share = x_step[move], end - begin
    x_before, x_after = np.rint(np.abs(pieces.start) / scale), np.rint(np.abs(pieces.end) / scale)
    c_before, c_after = np.rint((c.after - c.turn) / c_step), np.rint(c.after / c_step)
    is_rapid = trace.axes.motion[moves.row[move]] == Motion.RAPID
    length = moves.length[move] * share
    positioning = 60 * np.hypot(length, z.way) / (trace.machine.writing.rapid_feed or np.nan)
    runs = Steps(
        row=moves.row[move],
        move=move,
        x=x_after.astype(np.int64),
        c=c_after.astype(np.int64),
        z=np.rint(z.after / trace.lengths.least_step[moves.row[move]]),
        rise=z.way,
        radius_step=(x_after - x_before) * scale,
        turn=(c_after - c_before) * c_step,
        length=length,
        time=np.where(is_rapid, positioning, moves.time[move] * share),
        is_rapid=is_rapid,
    )
    # Where C turns on the spot, a block of its own stands before the piece that it leads to.
    jumps = np.flatnonzero(np.abs(c.jump) > c_step / 2)
    c_first = np.rint((c.after - c.turn - c.jump) / c_step)
    none = np.zeros(len(jumps))
    spots = msgspec.structs.replace(
        runs[jumps],
        move=np.full(len(jumps), -1),
        x=x_before[jumps].astype(np.int64),
        c=c_before[jumps].astype(np.int64),
        z=none * np.nan,
        rise=none,
        radius_step=none,
        turn=(c_before - c_first)[jumps] * c_step,
        length=none,
        time=none,
    )
    order = np.argsort(np.append(np.arange(len(move)), jumps - 0.5), kind="stable")
    steps = Steps.concatenated((runs, spots))[order]
    steps = _without_nothing(steps, _passed_on(moves, steps, np.append(is_short[pieces.span], none > 0)[order]))
    return msgspec.structs.replace(steps, time=_times(steps, x_factor(trace) * trace.lengths.least_step))


def _chord_errors(trace: Trace, moves: Moves, spans: Spans, x_step: Floats, chord_error: float) -> tuple[Floats, Mask]:
    """
    Return the part of the chord error that rounding leaves for each span [mm], and True for spans too short for their
    own block.

    Raises RefusedError if rounding takes more than half of the chord error.
    """
    farthest = np.maximum(np.abs(spans.start), np.abs(spans.end))
    c_way = np.radians(trace.machine.control.least_increment) * farthest
    rounding = np.hypot(x_step[spans.move], c_way) / 2
    if (least := 2 * float(np.max(rounding, initial=0.0))) > chord_error:
        text = f"rounding of X and C alone moves the tool by up to {least / 2:.4f} mm here"
        raise refused_at(
            trace,
            moves.row[spans.move[np.argmax(rounding)]],
            f"{text}: the chord error has to be {least:.4f} mm or more",
        )
    # Spans of about a least increment, as rounding leaves them between others: no block is worth its time for them.
    is_short = spans.length <= np.minimum(np.maximum(x_step[spans.move], c_way), chord_error / 4)
    # The block that takes over the path of a short span may leave its own path by that, too.
    taken = np.append(0.0, np.where(is_short, spans.length, 0.0))[: len(spans)]
    return chord_error - rounding - taken, np.asarray(is_short)


def _times(steps: Steps, x_step: Floats) -> Floats:
    """
    Return the time of each block [s] in which the tool is nowhere faster than F.

    X and C move at constant rates, so the tool is fastest where it is farthest from the center: sqrt(dr^2 + (r dC)^2) /
    time with the larger r of both ends. If that is more than the length of the path, the block takes longer.
    """
    x = steps.x * x_step[steps.row]
    largest = np.maximum(np.abs(x), np.abs(x - steps.radius_step))
    length = np.hypot(steps.radius_step, largest * np.radians(steps.turn))
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(steps.length > 0, length / steps.length, 1.0)
    return np.asarray(steps.time * np.fmax(share, 1.0))


def _passed_on(moves: Moves, steps: Steps, is_short: Mask) -> Mask:
    """
    Return a mask of the short blocks whose path the next block of the section can take over; that one is not short.
    """
    following, last = np.append(steps.move[1:], -1), np.append(is_short[1:], True)
    section = np.append(moves.section, -1)  # a section may have no move at all
    same = (steps.move >= 0) & (following >= 0) & (section[following] == section[steps.move])
    same &= np.append(steps.is_rapid[1:], True) == steps.is_rapid
    return np.asarray(is_short & ~last & same & np.isnan(steps.z))


def _without_nothing(steps: Steps, is_short: Mask) -> Steps:
    """
    Remove short blocks, and blocks in which nothing moves after rounding; the next block takes over their path and
    time.

    Blocks after the last one that moves count in that one.
    """
    has_way = ((steps.radius_step != 0) | (steps.turn != 0) | ~np.isnan(steps.z)) & ~is_short
    count = int(np.count_nonzero(has_way))
    if has_way.all() or not count:
        return steps[has_way]
    group = np.minimum(np.cumsum(has_way) - has_way, count - 1)
    sums = (steps.length, steps.time, steps.radius_step, steps.turn)
    length, time, radius_step, turn = (np.bincount(group, np.nan_to_num(column), count) for column in sums)
    remaining = steps[has_way]
    return msgspec.structs.replace(remaining, length=length, time=time, radius_step=radius_step, turn=turn)
