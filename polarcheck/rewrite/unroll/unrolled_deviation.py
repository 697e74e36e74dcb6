"""Reads the new program back: how far the tool center is from its path, and how fast C and X move."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from polarcheck.columns.path.moves import Moves
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows, mask_at
from polarcheck.foundation.errors import counted
from polarcheck.foundation.states import FeedMode, Motion
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.straight_axes.spiral_pieces import along, distances
from polarcheck.rewrite.compare.terms import EXACT, FEED_SHARE
from polarcheck.rewrite.unroll.axis_blocks import Steps, x_factor
from polarcheck.rewrite.unroll.unrolled_feeds import method_of
from polarcheck.rewrite.writing.order_refusals import changed_moves, changed_orders
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Figure, Measured, Refusal
from polarcheck.rewrite.writing.part_paths import path_on_part
from polarcheck.rewrite.writing.rotary_feed import block_times

#: How many differences are listed.
_LISTED = 10
#: Samples of each block, and blocks per batch.
_PLACES = np.linspace(0, 1, 17)[None, :]
_TOGETHER = 20_000
#: How far apart the tool may stand at an order [mm].
_AT_ORDERS = 0.1


def measured(
    original: Original, new: Original, spans: Sequence[tuple[int, int]], steps: Steps, chord_error: float, feed: str
) -> Measured:
    """
    Read the new program as the control would, and compare it with the original.

    spans: the characters of the sections in the new text.
    """
    old, after = original.trace, new.trace
    if len(after.mode.sections):
        return Measured([Refusal(0, "the result still has a polar section")])
    within = _within(after, spans)
    rotary = after.machine.polar.rotary_address
    rows = np.flatnonzero(within & after.blocks.has("X", rotary) & after.modal.uses_axes)
    if len(rows) != len(steps):
        return Measured([Refusal(0, f"the result has {len(rows)} blocks of X and C, not {len(steps)}")])
    paths = [path_on_part(program.tables, chord=np.inf) for program in (original, new)]
    stays = (old.mode.whole_section < 0) | (old.path.moves_z & ~old.path.travels), ~mask_at(len(after), rows)
    differences = [*changed_moves((old, after), (paths[0], paths[1]), stays)]
    differences += changed_orders(old, after, paths[0], paths[1], _AT_ORDERS)
    center: ToolCenter = original.tables["tool_center"]
    run = _Run(after, rows, method_of(old, feed))
    unknown = np.flatnonzero(np.isnan(run.x_before) | np.isnan(run.turn))
    if len(unknown):
        text = "where the tool is before this move is not known: a tool is called, or an axis referenced"
        return Measured([Refusal(_line(old, steps, int(unknown[0])), text)])
    distance = _distance(center.moves, run, steps)
    differences += _of_blocks(old, run, steps, distance, chord_error)
    moves = center.moves
    at_feed = old.axes.motion[moves.row] != Motion.RAPID
    times = float(np.nansum(moves.time[at_feed])), float(run.time[~steps.is_rapid].sum())
    notes = [*_too_short(old, run, steps), *_too_fast(old, run, steps), *_wound_up(old, run, steps)]
    return Measured(differences[:_LISTED], _figures(old, run, times, float(distance.max(initial=0.0))), notes)


def _too_short(old: Trace, run: _Run, steps: Steps) -> Iterator[str]:
    limit = old.machine.limits.block_time
    short = np.flatnonzero(run.time < limit)
    if len(short):
        first = _line(old, steps, int(short[0]))
        yield (
            f"{len(short)} blocks are shorter than the {limit:g} s that the control needs, the first in line {first}: "
            "it slows down there; a larger --chord-error makes them longer"
        )


def _too_fast(old: Trace, run: _Run, steps: Steps) -> Iterator[str]:
    limits = old.machine.limits
    if np.isnan(limits.c_feed) and len(run.c_rate) and run.c_rate.max() > limits.c_feed_suspicious:
        line = _line(old, steps, int(np.argmax(run.c_rate)))
        yield f"C turns at {run.c_rate.max():.0f} deg/min in line {line}: its limit, limits.c_feed, is not known"


def _wound_up(old: Trace, run: _Run, steps: Steps) -> Iterator[str]:
    """Yield a note if C ends a section full turns away from where it started."""
    if old.machine.control.rotary_rolls_over or not len(run.c):
        return
    section = old.mode.whole_section[steps.row]
    last = np.flatnonzero(np.append(np.diff(section) != 0, True))
    first = np.append(0, last[:-1] + 1)
    turned = np.round((run.c[last] - (run.c - run.turn)[first]) / 360)
    if np.abs(turned).max() >= 1:
        worst = int(np.argmax(np.abs(turned)))
        index = int(last[worst])
        yield (
            f"line {_line(old, steps, index)}: C has turned on by {counted(int(abs(turned[worst])), 'turn')}, to "
            f"{run.c[index]:g} deg: positioning it turns it back"
        )


def _line(trace: Trace, steps: Steps, index: int) -> int:
    return trace.line(steps.row[index])


def _within(trace: Trace, spans: Sequence[tuple[int, int]]) -> Mask:
    """Rows whose blocks stand in these characters of the text."""
    start = trace.text.blocks.end[trace.run.block]
    begins = np.array([begin for begin, _ in spans], np.int64)
    ends = np.array([end for _, end in spans], np.int64)
    index = np.searchsorted(begins, start, side="left") - 1
    return np.asarray((index >= 0) & (start <= ends[np.maximum(index, 0)]))


class _Run:
    """The blocks of X and C of the new program as the control runs them, with the distances and the time of each."""

    def __init__(self, trace: Trace, rows: Rows, method: str) -> None:
        path = trace.path
        self.x_before, self.x = path.x_before[rows], path.x[rows]
        self.c = path.c_angle[rows]
        self.turn = path.c_turn_from(path.c_angle_before[rows], rows)
        self.z = path.z[rows]
        self.rise = np.abs(np.nan_to_num(path.z[rows] - path.z_before[rows]))
        self.is_rapid = trace.axes.motion[rows] == Motion.RAPID
        unit = trace.lengths.feed_scale[rows]
        feed = trace.feedrate.written_feed[rows] / unit
        mode = trace.feedrate.modal_feed_mode[rows]
        step = self.x - self.x_before
        time = 60 * block_times(method, step, self.turn, self.rise, feed, unit)
        is_meant = mode == (FeedMode.INVERSE_TIME if method == "inverse-time" else FeedMode.PER_MINUTE)
        self.time = np.where(is_meant, time, np.nan)
        with np.errstate(divide="ignore", invalid="ignore"):
            self.c_rate = np.where(self.turn == 0, 0.0, 60 * np.abs(self.turn) / self.time)
            self.x_rate = np.where(step == 0, 0.0, 60 * np.abs(step) / self.time)


def _distance(moves: Moves, run: _Run, steps: Steps) -> Floats:
    """
    Return the largest distance of the tool center from its path in each block [mm], computed from the actual C, not
    from the division.
    """
    runs = np.flatnonzero(steps.move >= 0)
    distance = np.zeros(len(steps))
    of_move = steps.move[runs]
    sweep = moves.sweep
    center = np.where(sweep == 0, complex("nan+nanj"), moves.center)
    c_from, c_to = moves.c_angles
    sense = moves.c_axis.sense
    is_far = np.abs(moves.start) >= np.abs(moves.end)
    seen = np.where(is_far, moves.start, moves.end)
    # C of the machine at which the first axis of the plane points, by the end of each move that is farther out.
    zero = np.where(is_far, c_from, c_to) - sense * np.degrees(np.angle(seen))
    angle = sense * np.radians(run.c[runs] - zero[of_move])
    turn = sense * np.radians(run.turn[runs])
    for first in range(0, len(runs), _TOGETHER):
        keep_time()
        part = slice(first, first + _TOGETHER)
        move = of_move[part]
        points = along(run.x_before[runs][part], run.x[runs][part], (angle - turn)[part], angle[part], _PLACES)
        far = distances(points, moves.start[move], moves.end[move], center[move], sweep[move])
        distance[runs[part]] = far.max(axis=1)
    # The last block of a move leads to its end.
    last = np.append(np.diff(steps.move[runs]) != 0, True)[: len(runs)]
    ends = run.x[runs][last] * np.exp(1j * angle[last])
    distance[runs[last]] = np.maximum(distance[runs[last]], np.abs(ends - moves.end[of_move[last]]))
    return distance


def _of_blocks(old: Trace, run: _Run, steps: Steps, distance: Floats, chord_error: float) -> Iterator[Refusal]:
    """
    Yield the blocks that end elsewhere than intended or lead the tool off its path, in which the tool would be faster
    than the F of the section, or an axis faster than its limit: of each kind the first, of distances the largest.
    """
    limits, least_step = old.machine.limits, old.lengths.least_step[steps.row]
    x, z = steps.x * x_factor(old)[steps.row] * least_step, steps.z * least_step
    elsewhere = ~(np.abs(run.x - x) <= EXACT) | ~(np.abs(run.turn - steps.turn) <= EXACT) | run.is_rapid
    elsewhere |= ~np.isnan(z) & ~(np.abs(run.z - z) <= EXACT)
    # The largest, or one that is not known.
    far = ~(distance <= chord_error + EXACT) & (np.arange(len(distance)) == np.argmax(np.append(distance, 0.0)))
    away = f"the tool would be {distance[far].sum():.4f} mm away from its path, above {chord_error:.4f} mm"
    checks = (
        (elsewhere, "X, C or Z would not be where the tool center goes"),
        (far, away),
        (~(run.time > 0), "how long this takes is not known"),
        (run.time < steps.time * (1 - FEED_SHARE), "the tool would be faster than in the mode"),
        (run.c_rate > limits.c_feed * (1 + FEED_SHARE), "C would be above its limit"),
        (run.x_rate > limits.x_feed * (1 + FEED_SHARE), "X would be above its limit"),
    )
    for hits, text in checks:
        for index in np.flatnonzero(hits)[:1].tolist():
            yield Refusal(_line(old, steps, index), text)


def _figures(old: Trace, run: _Run, times: tuple[float, float], distance: float) -> list[Figure]:
    figures = [
        Figure("largest distance of the tool center from its path", distance, "mm"),
        Figure("blocks of X and C", len(run.time)),
        Figure("most of them in one second", _most_in_a_second(run.time)),
        Figure("shortest block", float(run.time.min()) if len(run.time) else 0.0, "s"),
    ]
    if not np.isnan(old.machine.limits.block_time):
        figures.append(Figure("shortest block that the control runs", old.machine.limits.block_time, "s"))
    return [
        *figures,
        Figure("largest rate of C", float(run.c_rate.max(initial=0.0)), "deg/min"),
        Figure("largest rate of X, as a radius", float(run.x_rate.max(initial=0.0)), "mm/min"),
        Figure("time at feed in the mode", times[0], "s"),
        Figure("time at feed now", times[1], "s"),
    ]


def _most_in_a_second(time: Floats) -> int:
    """The largest number of blocks that begin within a second."""
    begin = np.cumsum(np.append(0.0, time))[:-1]
    return int(np.max(np.searchsorted(begin, begin + 1 - 1e-9) - np.arange(len(begin)), initial=0))
