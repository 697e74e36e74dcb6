from __future__ import annotations

from polarcheck.checking.rule import WARNING, Feeds, Hits, Machine, Trace, rule


@rule(
    WARNING,
    "F is {trace.feed:feed/limit}, {machine.title} moves with {limit:feed/trace.feed} at most in the polar mode",
    at=("F",),
)
def feed_above_polar_limit(trace: Trace, feeds: Feeds, machine: Machine) -> Hits:
    """
    F above the highest feed of the polar mode.

    A parameter of the control limits the feed in the mode; a higher F is cut down to it, and the part takes longer
    than planned. limits.polar_feed of the profile is that parameter.

    Source: FANUC B-64120EN/01, p. 280, parameter 5462.

    Bad, set limits.polar_feed=1000:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1500     (expect: feed-above-polar-limit)
        C10. F200
        X60. F1500        (expect: feed-above-polar-limit)
        G13.1

    Good, set limits.polar_feed=1000:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1000
        C10. F200
        G13.1
    """
    limit = machine.limits.polar_feed
    return Hits(feeds.begins & (trace.feed > limit), values={"limit": limit})
