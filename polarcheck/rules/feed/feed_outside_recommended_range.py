from __future__ import annotations

from polarcheck.checking.rule import NOTE, Feeds, Hits, Machine, Trace, rule


@rule(NOTE, "F is {feed:feed}; recommended in the polar mode: {recommended}", at=("F",))
def feed_outside_recommended_range(trace: Trace, feeds: Feeds, machine: Machine) -> Hits:
    """
    Feed outside what the builder recommends for the polar mode.

    Builders recommend one range of F for cutting and a higher one for positioning in the mode. Too high an F costs
    accuracy of the shape, as X and C do not follow. This F lies in neither range; it is told once in
    each section.

    Source: builder's guide to G12.1, feed and positioning command.

    Bad, machine turning-center, tool 8:radius=.375:

        T0808
        M5
        M35
        G28 H0
        G97 S2000 M33
        G98 G0 X3. C0
        G12.1
        G1 C.6 F40.
        G41 X1.75 F20.    (expect: feed-outside-recommended-range)
        C-.6
        G40 X3. F40.
        G13.1

    Good, machine turning-center, tool 8:radius=.375:

        T0808
        M5
        M35
        G28 H0
        G97 S2000 M33
        G98 G0 X3. C0
        G12.1
        G1 C.6 F40.
        G41 X1.75 F7.
        C-.6
        G40 X3. F40.
        G13.1
    """
    feed, recommended = trace.programmed_feed, machine.feed
    not_cutting = (feed < recommended.cutting_minimum) | (feed > recommended.cutting_maximum)
    not_positioning = (feed < recommended.positioning_minimum) | (feed > recommended.positioning_maximum)
    return Hits(feeds.first_at_each(feeds.begins & not_cutting & not_positioning), values={"feed": feed})
