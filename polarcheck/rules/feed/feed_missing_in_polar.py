from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "cutting move without F: none is in force{likewise}",
    at=("line", "arc_clockwise", "arc_counterclockwise", "F"),
    once="program",
    subject="word",
)
def feed_missing_in_polar(mode: PolarMode, path: ProgrammedPath, feeds: Feeds) -> Mask:
    """
    Cutting move without a feed.

    No F stands above this block, or F0 or a negative one does. The control stops with an alarm at the first G1, G2 or
    G3 that moves, be it Z alone. It is reported once in a program, with the lines in which other sections lack it.

    Source: FANUC alarm 011; Mitsubishi alarm P62.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40.           (expect: feed-missing-in-polar)
        C10.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F0        (expect: feed-missing-in-polar)
        C10. F200
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F-200     (expect: feed-missing-in-polar)
        C10. F200
        G13.1

    Bad:

        G98 G0 X60. Z2. C0
        G12.1
        G1 Z-5.           (expect: feed-missing-in-polar)
        X40. F200
        C10.
        G13.1

    Good:

        G98 G0 X60. C0
        G1 Z-5. F200
        G12.1
        X40.
        C10.
        G13.1
    """
    return mode.first_in_section(path.moves_at_feed & feeds.missing)


def details(hit: Hit, mode: PolarMode, path: ProgrammedPath, feeds: Feeds) -> Details:
    return {"likewise": hit.likewise(mode.first_in_section(path.moves_at_feed & feeds.missing))}
