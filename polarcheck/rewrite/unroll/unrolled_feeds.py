"""Computes F for blocks in which X and C move together outside the mode, so that the tool is as fast as in the mode."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Rows
from polarcheck.program.machines.feed_keys import WITH_ROTARY
from polarcheck.rewrite.unroll.axis_blocks import Steps, x_factor
from polarcheck.rewrite.writing.outcome import Refusal, refusal_at
from polarcheck.rewrite.writing.rotary_feed import block_feeds, feed_not_known, per_minute

#: Values of --feed: the meanings of F; and stepwise, per minute as on the machine, with one F for several blocks.
FEEDS = (*WITH_ROTARY, "stepwise")
#: F of several blocks is lower than that of any of them by no more than this share.
_STEP = 0.1
#: Largest F that is written; where it would be larger, the block takes longer.
_LARGEST = 99999.0
#: X may pass its travel limit by rounding [mm].
_ROUNDING = 1e-6
#: Digits of F that count.
_DIGITS = 5


def chosen(trace: Trace, feed: str) -> str:
    """
    Return the meaning of F; feed: value of the option, empty for that of the machine.

    Raises RefusedError if it is not known.
    """
    of_machine: Sequence[str] = trace.machine.feed.with_rotary
    if feed == "stepwise" and not per_minute(trace.machine):
        raise feed_not_known(trace.machine, "how X and C share F per minute")
    if not feed and not of_machine:
        raise feed_not_known(trace.machine, "what F is where X and C move together")
    return feed or of_machine[0]


def method_of(trace: Trace, feed: str) -> str:
    """Return the meaning of F, one of WITH_ROTARY."""
    return per_minute(trace.machine)[0] if feed == "stepwise" else feed


def times(trace: Trace, steps: Steps) -> Floats:
    """
    How long each block takes [s]: by the F of the section, or longer where C or X would be too fast.
    """
    limits = trace.machine.limits
    share = min(limits.override_share, 100) / 100 if limits.automatic_override else 1.0
    # Where nobody knows how fast C may turn, it turns on the spot as fast as on every lathe.
    spot = np.where(steps.move < 0, limits.c_feed_harmless, np.inf)
    c_feed = np.fmin(limits.c_feed * share, spot)
    longest = np.fmax(steps.time, 60 * np.abs(steps.turn) / c_feed)
    return np.fmax(longest, np.nan_to_num(60 * np.abs(steps.radius_step) / limits.x_feed))


def feeds(trace: Trace, steps: Steps, time: Floats, feed: str) -> Floats:
    """F of each block as it is written, in the units of the program."""
    unit = trace.lengths.feed_scale[steps.row]
    exact = block_feeds(method_of(trace, feed), steps.radius_step, steps.turn, steps.rise, time / 60, unit)
    exact = np.minimum(exact, _LARGEST)
    if feed == "stepwise":
        exact = _stepwise(exact)
    return _rounded(exact)


def _rounded(feed: Floats) -> Floats:
    """Five digits, no more than four behind the point, rounded down."""
    with np.errstate(divide="ignore", invalid="ignore"):
        digits = np.clip(_DIGITS - 1 - np.floor(np.log10(feed)), 0, 4)
    scale = 10.0 ** np.nan_to_num(digits, nan=0.0, posinf=4.0)
    # Down, so that no limit is passed; F0 would not move.
    return np.where(feed > 0, np.maximum(np.floor(feed * scale * (1 + 1e-12)), 1) / scale, feed)


def _stepwise(feed: Floats) -> Floats:
    """Give runs of blocks their lowest F, as long as that is no more than a tenth below any of them."""
    values = feed.tolist()
    begin = 0
    while begin < len(values):
        lowest = highest = values[begin]
        end = begin + 1
        while end < len(values):
            low, high = min(lowest, values[end]), max(highest, values[end])
            if not low >= high * (1 - _STEP):
                break
            lowest, highest, end = low, high, end + 1
        values[begin:end] = [lowest] * (end - begin)
        begin = end
    return np.array(values, np.float64)


def slowed(steps: Steps, time: Floats) -> Rows:
    """The rows in the trace of blocks that take longer than the F of the section says."""
    return steps.row[(time > steps.time * (1 + 1e-9)) & (steps.move >= 0)]


def beyond_travel(trace: Trace, steps: Steps) -> list[Refusal]:
    """Blocks beyond the travel of X, the first in each direction."""
    limits = trace.machine.limits
    scale = (x_factor(trace) * trace.lengths.least_step)[steps.row]
    radius = steps.x * scale
    return [
        refusal_at(trace, row, f"X would go {name} its travel limit of {limit:g} mm as a radius")
        for hits, name, limit in (
            (radius < limits.x_minimum - _ROUNDING, "below", limits.x_minimum),
            (radius > limits.x_maximum + _ROUNDING, "above", limits.x_maximum),
        )
        for row in steps.row[hits][:1].tolist()
    ]
