from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feeds import Feeds
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "{slow_feed} here{of_f_word}: this block alone takes {long_time}; {instead}",
    values={"feed": "feedrate.feed_number", "time": "feeds.block_time"},
    worse=("time",),
    at=("F", "feed_per_minute", "line", "arc_clockwise", "arc_counterclockwise"),
    once="program",
    worst="feeds.block_time",
    follows={
        "block": ("feed-missing-in-polar", "feed-lost-from-per-revolution"),
        "section": ("code-not-allowed-in-polar",),
    },
)
def feed_implausible(feeds: Feeds) -> Mask:
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
    return feeds.takes_too_long
