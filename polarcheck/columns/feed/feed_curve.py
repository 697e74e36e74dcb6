"""F and the rate of C over the time of the sections of a program."""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.foundation.arrays import Floats, Rows
from polarcheck.geometry.automatic_override import Spokes, c_per_way
from polarcheck.geometry.plane import lines_from_center, quiet

#: Points of each move besides the nearest of a line: shares of its way, its ends included.
_POINTS = 17
#: A change of the rate of C by less than this share of it is nearly even along a move, and its ends tell it.
_LITTLE = 0.1


class FeedCurve(msgspec.Struct, frozen=True):
    """
    Points of the moves of the tool center in their order.

    row: of the trace. time: since the beginning of the section [s]; NaN from where it is not known on. feed: F in force
    there as it runs, override included [mm/min]. c_feed: rate of C there [deg/min].
    """

    row: Rows
    time: Floats
    feed: Floats
    c_feed: Floats


@quiet
def feed_curve(dynamics: Dynamics) -> FeedCurve:
    """
    The curve of one run.

    Within a move time passes as the sum of way by F over the points says; from move to move, it is exact.
    """
    moves = dynamics.moves[dynamics.at_feed & dynamics.moves.is_of_tool]
    whole = dynamics.move_time[dynamics.at_feed & dynamics.moves.is_of_tool]
    spokes = Spokes.of(moves)
    foot = -lines_from_center(moves.start, moves.end).before
    nearest = np.where(spokes.is_arc, 0.0, np.clip(foot, 0.0, spokes.length))
    even = np.linspace(0.0, 1.0, _POINTS)[:, None] * spokes.length
    distance = np.sort(np.concatenate((even, nearest[None])), axis=0)
    turn = np.degrees(np.abs(c_per_way(*spokes.at(distance))))
    turn = np.where(distance == distance, turn, np.nan)
    allowed = np.where(np.isnan(dynamics.c_limit), np.inf, dynamics.c_limit / turn)
    feed = np.fmin(np.broadcast_to(moves.plane_feed, distance.shape), allowed)
    passed = np.diff(distance, axis=0) * (1 / feed[1:] + 1 / feed[:-1])
    share = np.concatenate((np.zeros((1, len(moves))), np.cumsum(passed, axis=0)))
    share = np.where(share[-1] > 0, share / share[-1], 0.0)
    rate = np.where(np.isnan(feed), np.nan, np.where(feed == 0, dynamics.c_limit, turn * feed))
    time = _begun(dynamics, moves.row, whole) + share * whole
    is_new = np.concatenate((np.ones((1, len(moves)), bool), np.diff(distance, axis=0) > 0))
    changes = (turn.max(axis=0) - turn.min(axis=0)) * moves.plane_feed > _LITTLE * rate.max(axis=0)
    is_new[1:-1] &= changes
    is_new = is_new.T
    row = np.repeat(moves.row, len(distance)).reshape(is_new.shape)
    feed = feed / np.where(moves.plane_share > 0, moves.plane_share, np.nan)
    return FeedCurve(row[is_new], time.T[is_new], feed.T[is_new], rate.T[is_new])


def _begun(dynamics: Dynamics, row: Rows, time: Floats) -> Floats:
    """When each move begins, since its section began [s]; blocks between that move nothing on the plane included."""
    trace = dynamics.trace
    if not len(row):
        return np.zeros(0)
    # Time of a row besides its moves: Z alone, dwells.
    rest = _Sums(np.where(dynamics.on_path | (trace.mode.section < 0), 0.0, dynamics.time))
    moving = _Sums(time)
    section = trace.mode.section[row]
    first, index = np.searchsorted(section, section), np.arange(len(row))
    return rest.between(trace.mode.sections.enter[section], row) + moving.between(first, index)


class _Sums:
    """Sums of times from one place to before another; NaN where one of them is not known."""

    def __init__(self, times: Floats) -> None:
        self.total = np.append(0.0, np.cumsum(np.nan_to_num(times)))
        self.missing = np.append(0, np.cumsum(np.isnan(times)))

    def between(self, first: Rows, until: Rows) -> Floats:
        unknown = self.missing[until] > self.missing[first]
        return np.where(unknown, np.nan, self.total[until] - self.total[first])
