"""Phrases of the rules about F and the C axis."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.feed.feed_ranges import FeedRanges
from polarcheck.columns.feed.feeds import Feeds
from polarcheck.columns.filling import last_row
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.path.center import Center
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import FeedMode
from polarcheck.geometry.tolerances import SHARE
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.quantity import in_row
from polarcheck.rules.remedies import option_or_place
from polarcheck.rules.wording.phrases.common import code_of, executed_word

if TYPE_CHECKING:
    from polarcheck.columns.feed.dynamics import Dynamics


def recommended(lengths: Lengths, machine: Machine, row: int) -> str:
    """The ranges of F that the builder recommends."""
    feeds = machine.feed
    ranges = (
        (feeds.cutting_minimum, feeds.cutting_maximum, "cutting"),
        (feeds.positioning_minimum, feeds.positioning_maximum, "positioning"),
    )
    return ", ".join(
        f"{_range(lengths, row, least, most)} for {what}" for least, most, what in ranges if least == least
    )


def _range(lengths: Lengths, row: int, least: float, most: float) -> str:
    """Rounded to what lies within."""
    shown = in_row(least, lengths, row).as_feed
    places = 10.0 ** (4 if shown.inch else 3)
    low = np.ceil(shown.length(least) * places * (1 - SHARE)) / places
    high = np.floor(shown.length(most) * places * (1 + SHARE)) / places
    return f"{low:.10g} to {high:.10g} {shown.unit}/min"


def against_ranges(blocks: ExecutedBlocks, lengths: Lengths, feed_ranges: FeedRanges, row: int) -> str:
    """Which of the ranges F is outside of, and why the move is taken to cut."""
    has_both = len(feed_ranges.known_limits) > 2
    if feed_ranges.too_low[row] or feed_ranges.too_high[row]:
        side = "below" if feed_ranges.too_low[row] else "above"
        return f"{side} {'both ranges' if has_both else 'the range'}"
    if not feed_ranges.too_high_for_cut[row]:
        return "between the two ranges"
    fast = "a feed for positioning" if has_both else "above the range"
    where = "between the two ranges" if feed_ranges.between[row] else fast
    return f"{where}, and this move cuts: {_why_it_cuts(blocks, lengths, feed_ranges, row)}"


def _why_it_cuts(blocks: ExecutedBlocks, lengths: Lengths, feed_ranges: FeedRanges, row: int) -> str:
    if feed_ranges.knows_stock[row]:
        return f"it leads into the stock of {in_row(float(lengths.stock_diameter[row]), lengths, row):length}"
    if feed_ranges.is_of_fast_loop[row]:
        return "no move along this contour is slower"
    line = int(blocks.line[feed_ranges.slow_row(row)])
    return f"it is as near to the center as that of line {line}"


def clamps(machine: Machine) -> str:
    """What the control makes of an F above the limit of the mode."""
    if machine.limits.polar_feed_clamps:
        return "clamps it at"
    return "runs it as programmed, since limits.polar_feed_clamps is off: no clamp at"


def feed_word(trace: Trace, row: int) -> str:
    """The F word in force in a row, its line where that is another, and at what it is clamped."""
    written, taken = _feed_word(trace, row), float(trace.feedrate.feed[row])
    return (
        f"{written} clamped at {in_row(taken, trace.lengths, row):feed}"
        if taken < trace.feedrate.programmed_feed[row]
        else written
    )


def _feed_word(trace: Trace, row: int) -> str:
    words = trace.blocks.word_indices("F")
    at = words[trace.run.words.start[words] == trace.feedrate.feed_word[row]]
    if not len(at):
        return f"F {in_row(float(trace.feedrate.programmed_feed[row]), trace.lengths, row):feed}"
    line = int(trace.blocks.line[trace.run.row[at[0]]])
    written = executed_word(trace.run, int(at[0]))
    return written if line == trace.blocks.line[row] else f"{written} of line {line}"


def left_over(trace: Trace, feeds: Feeds, row: int) -> str:
    """Why an F that is one per revolution is read per minute in a row."""
    written = feed_word(trace, row)
    if feeds.is_left_per_revolution[row]:
        return f"{written} was written for feed per revolution and is still in force"
    is_asked = (
        trace.feedrate.entered_per_revolution[row] or trace.feedrate.modal_feed_mode[row] == FeedMode.PER_REVOLUTION
    )
    if is_asked and trace.feedrate.takes_over_per_minute_only:
        return f"{written} is per minute, as every F of the mode on this control, whatever code is in force"
    return f"{written} is per minute now, and as small as one per revolution"


def verdict(lengths: Lengths, machine: Machine, tool_center: ToolCenter, dynamics: Dynamics, row: int) -> str:
    """What the machine allows of C, as far as the profile knows."""
    limits = machine.limits
    if np.isnan(limits.c_feed):
        turns, most = float(tool_center.c_feed[row]) / 360, limits.c_feed_suspicious / 360
        known = f"no {machine.polar.rotary_address} axis is known to cut with more than {most:.0f}"
        return f"which is {turns:.0f} turns a minute, and {known}"
    if tool_center.is_at_c_feed_limit[row]:
        return f"the limit of {machine.title}, below which it must stay"
    rate, limit = (in_row(float(value), lengths, row) for value in (tool_center.c_feed[row], limits.c_feed))
    allows = f"{machine.title} allows {limit.beside(rate, 'whole')}"
    if not limits.automatic_override:
        return allows
    slowed = in_row(float(tool_center.true_feed[row]), lengths, row)
    slows = f"{allows} and slows the feed down to {tool_center.override[row]:.2g} %, {slowed:highest}"
    of_row = dynamics.moves.row == row
    time, without = (float(times[of_row].sum()) for times in (dynamics.move_time, dynamics.time_without_override))
    return f"{slows}, so that the block takes {time:.3g} s instead of {without:.3g} s" if time > without else slows


def advice(lengths: Lengths, machine: Machine, tool_center: ToolCenter, feeds: Feeds, row: int, count: int) -> str:
    """The highest F, or what to give to learn it; of a way that strays from its contour that X or C may be wrong."""
    if feeds.strays_to_center[row]:
        return (
            "the contour of this section lies farther out: look for a wrong coordinate of this move or the one before"
        )
    where = (f"for its {count} blocks" if count > 1 else "here") + _on_pass(tool_center, row)
    if np.isnan(machine.limits.c_feed):
        return f"{option_or_place(machine, 'limits.c_feed')} would give the highest F {where}"
    return f"highest F {where}: {in_row(float(tool_center.feed_allowed[row]), lengths, row):below}"


def _on_pass(tool_center: ToolCenter, row: int) -> str:
    """Which pass of an infeed cycle turns C fastest in a row; empty for the contour itself, and without a cycle."""
    moves = tool_center.moves
    at = np.flatnonzero(moves.row == row)
    allowance = float(moves.allowance[at[np.argmax(moves.c_feed[at])]])
    return (
        f", on the pass {in_row(allowance, tool_center.trace.lengths, row):length} off the contour"
        if allowance > 0
        else ""
    )


def meeting(lengths: Lengths, machine: Machine, center: Center, tool_center: ToolCenter, row: int) -> str:
    """How the tool center meets the center of C in a row that does."""
    moves, stops, least = tool_center.moves, center.stops_at_center, lengths.least_step[row]
    at = np.flatnonzero((moves.row == row) & (stops | (moves.nearest < least)))[-1]
    axis = machine.polar.rotary_address
    if stops[at]:
        return f"stops at the center of the {axis} axis, where {axis} has no angle"
    if abs(moves.start[at]) < least:
        return f"starts at the center of the {axis} axis, where {axis} has no angle"
    return f"passes through the center of the {axis} axis, where {axis} would have to turn by 180 deg at once"


def per_minute(machine: Machine) -> str:
    """The code of feed per minute."""
    return code_of(machine, "feed_per_minute")


def slow_feed(lengths: Lengths, trace: Trace, row: int) -> str:
    """F in force, as feed per minute."""
    return f"{in_row(float(trace.feedrate.feed_number[row]), lengths, row):feed}"


def of_f_word(trace: Trace, row: int) -> str:
    """`, by F0.1 of line 24`, where the F in force stands in another block."""
    written = _feed_word(trace, row)
    return f", by {written}" if " of line " in written else ""


def long_time(feeds: Feeds, row: int) -> str:
    """How long the block takes."""
    minutes = float(feeds.block_time[row]) / 60
    return f"{minutes:.0f} minutes" if minutes < 120 else f"{minutes / 60:.0f} hours"


def instead(trace: Trace, machine: Machine, feeds: Feeds, row: int) -> str:
    """What to write."""
    if feeds.mode_is_unknown[row]:
        return f"no code has said what F is: write {per_minute(machine)} and an F per minute"
    return f"write an F per minute{' there' if of_f_word(trace, row) else ''}"


def to_per_minute(trace: Trace, machine: Machine, row: int) -> str:
    """What has put feed per revolution in force, and what to write for feed per minute."""
    wanted = per_minute(machine)
    if not machine.codes("feed_per_minute"):
        return "write feed per minute"
    since = int(last_row(trace.modal.sets("feed_mode"), trace.blocks.starts)[row])
    words = trace.blocks.code_indices(*machine.codes("feed_per_revolution"))
    words = words[trace.run.row[words] == since]
    if since < 0 or not len(words):
        return f"no code of feed per minute stands before it: write {wanted}"
    code = executed_word(trace.run, int(words[0]))
    if since == row:
        return f"write {wanted} for {code}"
    line = int(trace.blocks.line[since])
    return f"{code} of line {line} is in force: write {wanted} in its place, or behind it before the polar mode"


def of_turns(lengths: Lengths, trace: Trace, feeds: Feeds, row: int) -> str:
    """Feed per revolution; F as one, where it is none."""
    if not feeds.is_too_high_per_revolution[row]:
        return "feed per revolution"
    return f"{in_row(float(trace.feedrate.feed_number[row]), lengths, row).as_feed:length} for each turn"
