"""Measures of the rules about F and the C axis: feeds [mm/min]."""

from __future__ import annotations

import math

from polarcheck.columns.feed.feeds import Feeds
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.foundation.arrays import Floats
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.quantity import in_row


def feed_by_c_feed(lengths: Lengths, machine: Machine, tool_center: ToolCenter, feeds: Feeds, row: int) -> float:
    """The highest F within the limit of C; NaN where that is not known, or a wrong coordinate is the fault."""
    is_told = not math.isnan(machine.limits.c_feed) and not feeds.strays_to_center[row]
    return _highest(lengths, tool_center.feed_allowed, row, "below") if is_told else math.nan


def feed_by_override(machine: Machine, tool_center: ToolCenter, row: int) -> float:
    """F that automatic override leaves; NaN where the machine has none."""
    return float(tool_center.true_feed[row]) if machine.limits.automatic_override else math.nan


def feed_by_c_acceleration(lengths: Lengths, feeds: Feeds, row: int) -> float:
    """The highest F within the acceleration of C."""
    return _highest(lengths, feeds.allowed_by_acceleration, row)


def feed_by_x_acceleration(lengths: Lengths, feeds: Feeds, row: int) -> float:
    """The highest F within the acceleration of X."""
    return _highest(lengths, feeds.allowed_by_x_acceleration, row)


def feed_of_series(lengths: Lengths, feeds: Feeds, row: int) -> float:
    """The F to which a series of short blocks falls."""
    return _highest(lengths, feeds.feed_of_series, row)


def _highest(lengths: Lengths, column: Floats, row: int, form: str = "highest") -> float:
    return in_row(float(column[row]), lengths, row).highest_feed(form)
