from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import FeedMode
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{feed:feed} here: {left_over}; write an F per minute",
    values=("feed",),
    worse=("-feed",),
    at=("F", "feed_per_minute", "line", "arc_clockwise", "arc_counterclockwise"),
    once="feed",
    doubts=(("rate", "feed"),),
)
def feed_of_revolution_per_minute(path: ProgrammedPath, feeds: Feeds) -> Mask:
    """
    F of feed per revolution, read per minute.

    F is a number, and what it means is modal. After G98 (G94) the number of a feed per revolution stays in force, and
    F.1 is a tenth of a millimeter for each minute: the cutter rubs at one place for hours. Some controls read every F
    of the mode per minute, whichever was in force before: there, F.1 written again in the mode is a tenth of a
    millimeter, too. It is reported where the F in force was written for feed per revolution. On controls that read
    every F per minute it is also reported where F of the mode is as small as a feed per revolution, and the program has
    one, or G99 (G95) is in force in the mode.

    Source: Mitsubishi M700V programming manual, p. 73: item 8 and note 1; FANUC B-62764EN/01, p. 51.

    Bad:

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        G98 X40.          (expect: feed-of-revolution-per-minute)
        C10.
        G13.1

    Bad, set feed.carried_into_polar="per-minute-only":

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        X40. F.2          (expect: feed-of-revolution-per-minute)
        C10.
        G13.1

    Good:

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        G98 X40. F200
        C10.
        G13.1
        G99 G1 X60. F.2

    Good, set feed.carried_into_polar="per-minute-only":

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        X40. F200
        C10.
        G13.1
    """
    return path.moves_at_feed & ~feeds.missing & (feeds.is_left_per_revolution | feeds.looks_per_revolution)


def details(hit: Hit, feedrate: Feedrate, feeds: Feeds) -> Details:
    from polarcheck.rules.wording.feeds import feed_word

    row, written = hit.row, feed_word(hit)
    is_asked = feedrate.entered_per_revolution[row] or feedrate.modal_feed_mode[row] == FeedMode.PER_REVOLUTION
    left_over = f"{written} is per minute now, and as small as one per revolution"
    if feeds.is_left_per_revolution[row]:
        left_over = f"{written} was written for feed per revolution and is still in force"
    elif is_asked and feedrate.takes_over_per_minute_only:
        left_over = f"{written} is per minute, as every F of the mode on this control, whatever code is in force"
    return {"feed": feedrate.feed[row], "left_over": left_over}
