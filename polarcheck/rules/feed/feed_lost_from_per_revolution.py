from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "no F in the mode: the feed per revolution before G12.1 is not taken over",
    at=("line", "arc_clockwise", "arc_counterclockwise"),
)
def feed_lost_from_per_revolution(mode: PolarMode, path: ProgrammedPath, feeds: Feeds) -> Mask:
    """
    Feed per revolution before G12.1, and no F in the mode.

    Some controls take the F in force over into the mode only if it is per minute. After G99 (G95) the mode needs an F
    of its own, which then is per minute; without one the control stops at the first move at feed, be it Z alone. After
    G13.1 the feed per revolution is there again.

    Source: Mitsubishi M700V programming manual, p. 73: alarm P62.

    Bad, set feed.carried_into_polar="per-minute-only":

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        X40.              (expect: feed-lost-from-per-revolution)
        C10.
        G13.1

    Bad, set feed.carried_into_polar="per-minute-only":

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        G98
        X40.              (expect: feed-lost-from-per-revolution)
        C10. F200
        G13.1

    Bad, set feed.carried_into_polar="per-minute-only":

        G99 G0 X60. Z2. C0
        G1 Z1. F.2
        G12.1
        Z-5.              (expect: feed-lost-from-per-revolution)
        X40. F200
        C10.
        G13.1

    Good, set feed.carried_into_polar="per-minute-only":

        G99 G0 X60. C0
        G1 Z-5. F.2
        G12.1
        X40. F200
        C10.
        G13.1
    """
    return mode.first_in_section(path.moves_at_feed & feeds.lost & ~feeds.missing)
