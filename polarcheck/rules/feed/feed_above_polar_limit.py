from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "F is {feed:feed/limit}, {title} {clamps} {limit:feed/feed} in the polar mode",
    values=("feed", "limit"),
    worse=("feed",),
    at=("F",),
)
def feed_above_polar_limit(feedrate: Feedrate, feeds: Feeds, machine: Machine) -> Hits:
    """
    F above the highest feed of the polar mode.

    A parameter of the control limits the feed in the mode: a higher F is clamped at it, and the part takes longer than
    planned. All rates and times are those of the clamped F. That parameter is limits.polar_feed of the profile. On some
    controls another parameter switches the clamp, limits.polar_feed_clamps; where it is off, the higher F runs as
    programmed, which is a note. The clamp does not keep C below its own limit: near the center that is an alarm still.

    Source: FANUC B-64120EN/01, p. 280, parameter 5462; GSK 988, description of G12.1, parameters 5450#1 and 5462.

    Bad, set limits.polar_feed=1000:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1500     (expect: feed-above-polar-limit)
        C10. F200
        X60. F1500        (expect: feed-above-polar-limit)
        G13.1

    Bad, machine gsk-988, set limits.polar_feed=1000:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1500     (expect: feed-above-polar-limit)
        C10. F200
        G13.1

    Good, set limits.polar_feed=1000:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1000
        C10. F200
        G13.1
    """
    limit, feed = machine.limits.polar_feed, feedrate.programmed_feed
    severity = WARNING if machine.limits.polar_feed_clamps else NOTE
    return Hits(feeds.begins & (feed > limit), severity, values={"limit": limit, "feed": feed})


def details(hit: Hit, machine: Machine) -> Details:
    if machine.limits.polar_feed_clamps:
        return {"clamps": "clamps it at"}
    return {"clamps": "runs it as programmed, since limits.polar_feed_clamps is off: no clamp at"}
