from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import FeedMode
from polarcheck.rules.rule import NOTE, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.rules.hit import Details, Hit


@rule(
    NOTE,
    "{of_turns} of a spindle that turns as the {rotary} axis now; {to_per_minute}{likewise}",
    values=("feed_per_revolution",),
    at=("feed_per_revolution", "line", "arc_clockwise", "arc_counterclockwise"),
    once="program",
)
def feed_per_revolution_in_polar(mode: PolarMode, path: ProgrammedPath, feedrate: Feedrate, feeds: Feeds) -> Hits:
    """
    Feed per revolution in the polar mode.

    The spindle that F counts is the C axis now. Unless the lathe counts the turns of the live tool, the tool stands
    still or creeps. The manuals allow it, so that it is a note. An F of 5 mm or .2 inch and more is none per
    revolution: G98 (G94) is forgotten, and it is a warning. G98 (G94) gives the feed per minute, also for what comes
    after G13.1.

    Source: FANUC B-62764EN/01, p. 51; builder's guide to G12.1, feed command.

    Bad:

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        X40.              (expect: feed-per-revolution-in-polar)
        C10.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 G99 X40. F.2   (expect: feed-per-revolution-in-polar)
        C10.
        G13.1

    Bad:

        G99 G0 X60. C0
        G12.1
        G1 X40. F120      (expect: feed-per-revolution-in-polar)
        C10.
        G13.1

    Good:

        G99 G0 X60. C0
        G12.1
        G98 G1 X40. F200
        C10.
        G13.1
        G99 G0 X60.
    """
    per_revolution = path.cuts & (feedrate.feed_mode == FeedMode.PER_REVOLUTION) & ~feeds.missing
    high = mode.first_in_section(per_revolution & feeds.is_too_high_per_revolution)
    first = mode.first_in_section(per_revolution) & ~mode.anywhere_in_section(high)
    return graded(warning=high, note=first, worst=high.astype(float))


def details(hit: Hit, mode: PolarMode, path: ProgrammedPath, feedrate: Feedrate, feeds: Feeds) -> Details:
    per_revolution = path.cuts & (feedrate.feed_mode == FeedMode.PER_REVOLUTION) & ~feeds.missing
    if feeds.is_too_high_per_revolution[hit.row]:
        per_revolution &= feeds.is_too_high_per_revolution
    feed = hit.trace.feedrate.feed_number[hit.row]
    is_too_high = feeds.is_too_high_per_revolution[hit.row]
    return {
        "feed_per_revolution": feed,
        "of_turns": f"{hit.quantity(feed).as_feed:length} for each turn" if is_too_high else "feed per revolution",
        "to_per_minute": _to_per_minute(hit),
        "likewise": hit.likewise(mode.first_in_section(per_revolution)),
    }


def _to_per_minute(hit: Hit) -> str:
    """What has put feed per revolution in force, and what to write for feed per minute."""
    from polarcheck.columns.filling import last_row
    from polarcheck.rules.wording.written import code_of, executed_word

    trace = hit.trace
    if not trace.machine.codes("feed_per_minute"):
        return "write feed per minute"
    per_minute = code_of(trace.machine, "feed_per_minute")
    since = int(last_row(trace.modal.sets("feed_mode"), trace.blocks.starts)[hit.row])
    words = trace.blocks.code_indices(*trace.machine.codes("feed_per_revolution"))
    words = words[trace.run.row[words] == since]
    if since < 0 or not len(words):
        return f"no code of feed per minute stands before it: write {per_minute}"
    code = executed_word(trace.run, int(words[0]))
    if since == hit.row:
        return f"write {per_minute} for {code}"
    in_force = f"{code} of line {hit.line(since)} is in force"
    return f"{in_force}: write {per_minute} in its place, or behind it before the polar mode"
