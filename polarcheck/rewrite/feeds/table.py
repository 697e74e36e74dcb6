"""
The feed table of a program: for each cutting block of its sections the highest F that keeps the limits of the machine.

A block that runs several times in a section stands there once, with the lowest F of its runs. F is rounded down to what
a program writes, as messages do; so it is what can be written.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.feed.dynamics import Dynamics, Times
from polarcheck.columns.feed.highest_feeds import LIMITS, HighestFeeds
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows
from polarcheck.foundation.states import Units
from polarcheck.rules.feed_words import LEAST_WHOLE, writes_points
from polarcheck.rules.quantity import rounded
from polarcheck.rules.tables import Tables

#: What stands in the place of a limit.
PROGRAMMED, CENTER, UNKNOWN = "programmed", "center", "not known"
LIMITED_BY = (*LIMITS, PROGRAMMED, CENTER, UNKNOWN)
#: Digits of F, as in messages (quantity).
_DIGITS = 3


class FeedRow(msgspec.Struct, frozen=True, kw_only=True):
    """
    One cutting block of a section; a contract.

    line, block: where it stands, and its text. section: from 0. runs: how often it is run there. feed: F as programmed,
    the highest of the runs [mm/min]. highest: the highest F up to that which keeps the limits, rounded down; null where
    it is not known, or no F is low enough. limited_by: C, acceleration of C, X, acceleration of X, limit of F in the
    mode; programmed where F may stay; center where the tool center meets the center of C; not known. allowed: F that
    the limits allow, beyond the programmed one, too [mm/min]; null where nothing limits it. c_feed: rate of C at F as
    programmed [deg/min]. time: of all runs at the F that runs today, highest_time: at the highest [s]. chip_load: what
    a tooth takes at the highest F [mm], null without S or teeth. several: its runs have different F, or need it.
    """

    line: int
    block: str
    section: int
    runs: int
    feed: float | None
    highest: float | None
    limited_by: str
    allowed: float | None
    c_feed: float | None
    time: float | None
    highest_time: float | None
    chip_load: float | None
    several: bool


class Unknown(msgspec.Struct, frozen=True, kw_only=True):
    """Blocks whose time is not known: why, how many, and the line of the first."""

    reason: str
    blocks: int
    line: int


class FeedTotal(msgspec.Struct, frozen=True, kw_only=True):
    """
    What a section or the whole program takes.

    line: of its G12.1; 1 of the program. time: of all its blocks as far as it is known, Z alone, dwells and rapids
    included [s]; unknown: the others. cutting: of the cutting blocks as the program runs today, highest_cutting: with
    the feed table; each leaves out blocks that are not known with the table [s]. one_feed: the F to which all cutting
    blocks above it would be lowered, were it one for the section [mm/min]; null where none needs to be, and for the
    program. one_feed_cutting: the time with it [s]. lost: what the table costs against the program; won: what it saves
    against one F for all [s].
    """

    line: int
    time: float
    unknown: list[Unknown]
    cutting: float
    highest_cutting: float
    one_feed: float | None
    one_feed_cutting: float
    lost: float
    won: float


class FeedLimits(msgspec.Struct, frozen=True, kw_only=True):
    """
    The limits that were applied [deg/min, deg/s2; X as a radius mm/min, mm/s2; mm/min]; null where none is known.

    c_feed_given: False where c_feed is no limit of the lathe, but a rate that no C axis cuts with.
    """

    c_feed: float | None
    c_feed_given: bool
    c_acceleration: float | None
    x_feed: float | None
    x_acceleration: float | None
    polar_feed: float | None


class FeedTable(msgspec.Struct, frozen=True, kw_only=True):
    """
    Of one program, or of one channel of a file with several; a contract. units: those of the program; the numbers are
    in mm, deg and min, X as a radius.
    """

    units: str
    limits: FeedLimits
    rows: list[FeedRow]
    sections: list[FeedTotal]
    program: FeedTotal
    channel: str | msgspec.UnsetType = msgspec.UNSET


class FeedReport(msgspec.Struct, frozen=True, kw_only=True):
    """`polarcheck feeds --format json`; a contract. machine: its id, as in the report of a check."""

    schema: int
    path: str
    machine: str
    tables: list[FeedTable]


def rounded_down(trace: Trace, feed: Floats, left_out: Mask) -> Floats:
    """
    F per row [mm/min] rounded down to three digits of the program's units, to whole ones where it writes no points.

    left_out: where the result must not be F itself. NaN where no F above 0 is left.
    """
    with np.errstate(all="ignore"):
        value = np.where((feed > 0) & np.isfinite(feed), feed / trace.lengths.feed_scale, np.nan)
        factor = 10.0 ** (_DIGITS - 1 - np.floor(np.log10(value)))
        whole = value * factor
        feeds = np.where(left_out, np.ceil(whole - 1e-6) - 1, np.floor(whole + 1e-9)) / factor
        is_whole = ~writes_points(trace.blocks, trace.lengths, trace.run) & (feeds >= LEAST_WHOLE)
        return np.where(is_whole, np.floor(feeds), feeds) * trace.lengths.feed_scale


def highest(trace: Trace, feeds: HighestFeeds) -> Floats:
    """Highest F per row up to the programmed one, as it can be written [mm/min]; NaN unknown, or none is low enough."""
    lower = rounded_down(trace, np.where(feeds.must_be_lower, feeds.allowed, np.nan), feeds.is_left_out)
    keeps = ~feeds.meets_center & ~np.isnan(feeds.allowed)
    return np.where(feeds.must_be_lower, lower, np.where(keeps, trace.feedrate.programmed_feed, np.nan))


def feed_table(tables: Tables) -> FeedTable:
    """The feed table of one run."""
    trace: Trace = tables["trace"]
    feeds: HighestFeeds = tables["highest_feeds"]
    dynamics: Dynamics = tables["dynamics"]
    columns = _Columns(trace, feeds, dynamics)
    sections = [columns.total(number, enter) for number, enter in enumerate(trace.mode.sections.enter.tolist())]
    limits = trace.machine.limits
    inch = bool(len(trace) and np.all(trace.lengths.feed_units[feeds.cuts] == Units.INCH) and feeds.cuts.any())
    return FeedTable(
        units="inch" if inch else "mm",
        limits=FeedLimits(
            c_feed=rounded(dynamics.tool_center.c_feed_limit),
            c_feed_given=not np.isnan(limits.c_feed),
            c_acceleration=rounded(limits.c_acceleration),
            x_feed=rounded(limits.x_feed),
            x_acceleration=rounded(limits.x_acceleration),
            polar_feed=rounded(limits.polar_feed),
        ),
        rows=columns.rows(),
        sections=sections,
        program=columns.whole(sections),
        channel=trace.text.source.channel or msgspec.UNSET,
    )


class _Columns:
    """What the table is made of, per row of the trace."""

    def __init__(self, trace: Trace, feeds: HighestFeeds, dynamics: Dynamics) -> None:
        self.trace, self.feeds, self.dynamics = trace, feeds, dynamics
        self.feed = trace.feedrate.programmed_feed
        self.highest = highest(trace, feeds)
        self.names = np.array(LIMITED_BY)[self._reason()]
        self.highest_time = self.time_with(self.highest)

    def _reason(self) -> Rows:
        """What limits F of each row: an index into LIMITS and what follows them."""
        feeds, kinds = self.feeds, len(LIMITS)
        reason = np.where(feeds.must_be_lower, feeds.limited_by, kinds)
        reason = np.where(np.isnan(feeds.allowed) | np.isnan(self.feed), kinds + 2, reason)
        return np.asarray(np.where(feeds.meets_center, kinds + 1, reason), np.int64)

    def time_with(self, feed: Floats) -> Floats:
        """How long each row takes at another F, which override leaves alone [s]; NaN unknown."""
        runs = np.minimum(feed, self.trace.feedrate.feed)  # the control may clamp F
        with np.errstate(all="ignore"):
            return np.where(self.feeds.time == 0, 0.0, self.feeds.time * self.trace.feedrate.feed / runs)

    def rows(self) -> list[FeedRow]:
        """The blocks of the table, in the order in which they are first run."""
        trace, rows = self.trace, np.flatnonzero(self.feeds.cuts)
        if not len(rows):
            return []
        block = trace.run.block[trace.feedrate.feed_row]
        key = trace.mode.section[rows] * (int(block.max()) + 1) + block[rows]
        _, first, of_row, runs = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
        ordinal = np.argsort(np.argsort(first))[of_row]
        first, runs = np.sort(first), runs[np.argsort(first)]
        # The run that needs the lowest F says what limits it; an unknown one stands for all.
        lowest = np.lexsort((np.where(np.isnan(self.highest[rows]), -1, self.highest[rows]), ordinal))
        worst = rows[lowest[np.append(0, np.cumsum(runs)[:-1])]]

        def of_block(fold: np.ufunc, values: Floats) -> Floats:
            folded: Floats = fold.reduceat(values[rows[np.argsort(ordinal, kind="stable")]], starts)
            return folded

        starts = np.append(0, np.cumsum(runs)[:-1])
        corners = of_block(np.add, trace.axes.makes_corner.astype(np.float64))
        with np.errstate(all="ignore"):
            feed, slowest = of_block(np.maximum, self.feed), of_block(np.minimum, self.feed)
            most = of_block(np.maximum, np.where(np.isnan(self.highest), np.inf, self.highest))
            load = self.highest / self.feeds.cuts_of_teeth
        c_feeds = np.where(self.dynamics.on_path, self.dynamics.tool_center.c_feed, 0.0)
        allowed, c_feed = of_block(np.minimum, self.feeds.allowed), of_block(np.maximum, c_feeds)
        time, highest_time = of_block(np.add, self.dynamics.time), of_block(np.add, self.highest_time)
        several = (feed != slowest) | (most != self.highest[worst])
        several &= ~np.isnan(feed) & ~np.isnan(self.highest[worst])
        return [
            FeedRow(
                line=trace.line(trace.feedrate.feed_row[row]),
                block=_text(trace, int(trace.feedrate.feed_row[row])),
                section=int(trace.mode.section[row]),
                runs=int(runs[index] - corners[index]),
                feed=rounded(feed[index]),
                highest=rounded(self.highest[row]),
                limited_by=str(self.names[row]),
                allowed=rounded(allowed[index]),
                c_feed=rounded(c_feed[index]),
                time=rounded(time[index]),
                highest_time=rounded(highest_time[index]),
                chip_load=rounded(load[row]),
                several=bool(several[index]),
            )
            for index, row in enumerate(worst.tolist())
        ]

    def total(self, number: int, enter: int) -> FeedTotal:
        """What a section takes."""
        trace = self.trace
        inside = np.arange(enter, trace.mode.sections.leave[number])
        today, best, highest = (column[inside] for column in (self.dynamics.time, self.highest_time, self.highest))
        is_comparable = self.feeds.cuts[inside] & ~np.isnan(best) & ~np.isnan(today)
        lowered = self.feeds.must_be_lower[inside] & ~np.isnan(highest)
        one_feed = float(highest[lowered].min()) if lowered.any() else np.nan
        with np.errstate(all="ignore"):
            # Time and F of a block are in inverse proportion.
            slow = best * np.where(best == 0, 1.0, np.minimum(highest, trace.feedrate.feed[inside]))
            slow = np.where(best == 0, 0.0, slow / np.fmin(np.minimum(highest, trace.feedrate.feed[inside]), one_feed))
        cutting = tuple(float(column[is_comparable].sum()) for column in (today, best, slow))
        return _total(trace, self.dynamics.times(inside), enter, cutting, one_feed)

    def whole(self, sections: list[FeedTotal]) -> FeedTotal:
        """What the program takes, blocks outside its sections included."""
        every = np.arange(len(self.trace))
        sums = tuple(
            float(sum(getattr(section, name) for section in sections))
            for name in ("cutting", "highest_cutting", "one_feed_cutting")
        )
        return _total(self.trace, self.dynamics.times(every), 0, sums, np.nan)


def _total(trace: Trace, times: Times, row: int, cutting: tuple[float, ...], one_feed: float) -> FeedTotal:
    today, best, slow = cutting
    return FeedTotal(
        line=trace.line(row) if len(trace) else 1,
        time=round(times.known, 6),
        unknown=[
            Unknown(reason=reason, blocks=count, line=trace.line(first)) for reason, count, first in times.unknown
        ],
        cutting=round(today, 6),
        highest_cutting=round(best, 6),
        one_feed=rounded(one_feed),
        one_feed_cutting=round(slow, 6),
        lost=round(best - today, 6),
        won=round(slow - best, 6),
    )


def _text(trace: Trace, row: int) -> str:
    blocks, block = trace.text.blocks, int(trace.run.block[row])
    return trace.text.written(blocks, block).strip()


def feed_number(value: float, points: bool) -> str:
    """A number of F as the program writes it, with a point where it does, or needs one."""
    text = np.format_float_positional(value, precision=6, trim="-")
    if "." not in text:
        return text + "." * points
    return text.lstrip("0") if text.startswith("0.") else text
