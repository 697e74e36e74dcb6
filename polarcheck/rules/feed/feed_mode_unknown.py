from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "no code of feed per minute or per revolution stands before this F: where the lathe powers on with feed per "
    "revolution it is {feed_per_revolution:length} for each turn; write {per_minute} at the head of the program",
    values=("feed_per_revolution",),
    worse=("feed_per_revolution",),
    at=("F",),
    once="program",
)
def feed_mode_unknown(path: ProgrammedPath, feeds: Feeds) -> Mask:
    """
    F without feed per minute or per revolution.

    What F means is modal, and no block of the program has said it. Most lathes power on with feed per revolution; else
    the program before this one decides. F200 is then no 200 mm a minute but 200 mm for each turn of a spindle that is
    the C axis now. Write G98 (G94 in systems B and C) at the head of the program. An F below 5 mm or .2 inch may be
    meant per revolution; nothing is said of it here, nor of programs that are shown without their head.

    Source: FANUC B-62764EN/01, p. 51, feed per minute in the mode; builder's guide to G12.1, feed command.

    Bad:

        O1
        G97 T0101
        G0 X60. C0
        G12.1
        G1 X40. F200      (expect: feed-mode-unknown)
        C10.
        X60.
        G13.1
        M30

    Bad, machine haas-lathe:

        O1
        G20 G97 T0101
        M154
        M133 P1500
        G17
        G0 X2.5 C0
        G112
        G1 X1. F10.       (expect: feed-mode-unknown)
        Y.4
        X1.25
        G113
        M30

    Good:

        O1
        G97 T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Good:

        O1
        G97 T0101
        G0 X60. C0
        G12.1
        G1 X40. F2.
        C10.
        X60.
        G13.1
        M30
    """
    return path.moves_at_feed & feeds.mode_is_unknown & feeds.is_too_high_per_revolution


def details(hit: Hit, feedrate: Feedrate, machine: Machine) -> Details:
    from polarcheck.rules.wording.written import code_of

    return {"feed_per_revolution": feedrate.feed_number[hit.row], "per_minute": code_of(machine, "feed_per_minute")}
