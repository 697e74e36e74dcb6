from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.words.unpointed import Unpointed
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{feed:feed} here{of_f_word}: this block alone takes {long_time}; {instead}",
    values=("feed", "time"),
    worse=("time",),
    at=("F", "feed_per_minute", "line", "arc_clockwise", "arc_counterclockwise"),
    once="program",
    subject="size",
    follows={"program": ("number-without-point",)},
    doubts=(("rate", "section"),),
)
def feed_implausible(feeds: Feeds, unpointed: Unpointed) -> Hits:
    """
    F with which a block takes hours.

    F.1 is a feed per revolution. Read per minute it is a tenth of a millimeter in a minute: the cutter rubs at one
    place, and the block takes hours. Where no block has written G98 or G99 (G94, G95) it may be per revolution, of a
    spindle that is the C axis now: the tool hardly moves at all. Write feed per minute, and F for it: the feed per
    tooth times the teeth times the speed of the tool.

    Source: FANUC B-62764EN/01, p. 51, feed per minute in the mode; builder's guide to G12.1, feed command.

    Bad:

        G21 G98 G0 X60. C0
        G12.1
        G1 X40. F.1       (expect: feed-implausible)
        C10.
        X60.
        G13.1

    Bad:

        O1
        G21 G97 T0101
        G0 X60. C0
        G12.1
        G1 X40. F.1       (expect: feed-implausible)
        C10.
        X60.
        G13.1
        M30

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F100
        C10.
        X60.
        G13.1
    """
    # Compares nothing: how long a block takes is a formula.
    return Hits(feeds.takes_too_long, worst=feeds.block_time, follows={"program": unpointed.is_in_meters})


def details(hit: Hit, feeds: Feeds) -> Details:
    from polarcheck.rules.wording.feeds import f_word
    from polarcheck.rules.wording.written import code_of

    word, minutes = f_word(hit), feeds.block_time[hit.row] / 60
    is_above = " of line " in word
    code = code_of(hit.trace.machine, "feed_per_minute")
    return {
        "feed": hit.trace.feedrate.feed_number[hit.row],
        "time": feeds.block_time[hit.row],
        "of_f_word": f", by {word}" if is_above else "",
        "long_time": f"{minutes:.0f} minutes" if minutes < 120 else f"{minutes / 60:.0f} hours",
        "instead": f"no code has said what F is: write {code} and an F per minute"
        if feeds.mode_is_unknown[hit.row]
        else f"write an F per minute{' there' if is_above else ''}",
    }
