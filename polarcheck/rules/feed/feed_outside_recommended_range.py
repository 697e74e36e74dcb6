from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import SHARE
from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feed_ranges import FeedRanges
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    NOTE,
    "{feed_word} is {feed:feed/limit}, {against_ranges}; recommended in the polar mode: {recommended}",
    values=("feed", "limit"),
    worse=("feed:limit",),
    at=("F",),
    subject="rate",
)
def feed_outside_recommended_range(feed_ranges: FeedRanges, feeds: Feeds) -> Mask:
    """
    Feed outside what the builder recommends for the polar mode.

    Builders recommend one range of F for cutting and a higher one for positioning in the mode. Too high an F costs
    accuracy of the shape, as X and C do not follow. It is told once for each F of a section: below the one range, above
    the other, or above that for cutting in a move along the contour that cuts.

    Which moves cut is seen by the contour: the moves with G41 or G42 in force, and neither a ramp nor a lead in or out.
    Where stock and cutter are given, the cutter must get into the stock; else the move must come as near to the center
    as another one at an F for cutting, or all of the contour must be as fast. A way round the part, as the arc between
    two flats, is none. Positioning below its own range does no harm: an F between the two ranges is reported only
    where the move cuts, and in sections without compensation, where it is not known which moves cut.

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
        G41 X1.75 F20.
        C-.6              (expect: feed-outside-recommended-range)
        G40 X3. F40.
        G13.1

    Bad, machine turning-center, tool 8:radius=.375:

        T0808
        M5
        M35
        G28 H0
        G97 S2000 M33
        G98 G0 X3. C0
        G12.1
        G1 C.6 F20.
        G41 X1.75 F7.
        C-.6
        G2 X-1.75 R1.061 F60.
        G1 C.6 F40.       (expect: feed-outside-recommended-range)
        G40 X-3. F80.     (expect: feed-outside-recommended-range)
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
    between = feed_ranges.between & feed_ranges.without_contour
    outside = feed_ranges.too_low | feed_ranges.too_high | between | feed_ranges.too_high_for_cut
    return feeds.first_at_each(outside)


def details(hit: Hit, feed_ranges: FeedRanges) -> Details:
    from polarcheck.rules.wording.feeds import feed_word

    return {
        "feed": hit.trace.feedrate.programmed_feed[hit.row],
        "limit": feed_ranges.nearest_limit[hit.row],
        "feed_word": feed_word(hit),
        "against_ranges": _against_ranges(hit, feed_ranges),
        "recommended": _recommended(hit),
    }


def _against_ranges(hit: Hit, feed_ranges: FeedRanges) -> str:
    """Which of the ranges F is outside of, and why the move is taken to cut."""
    row, has_both = hit.row, len(feed_ranges.known_limits) > 2
    if feed_ranges.too_low[row] or feed_ranges.too_high[row]:
        side = "below" if feed_ranges.too_low[row] else "above"
        return f"{side} {'both ranges' if has_both else 'the range'}"
    if not feed_ranges.too_high_for_cut[row]:
        return "between the two ranges"
    fast = "a feed for positioning" if has_both else "above the range"
    where = "between the two ranges" if feed_ranges.between[row] else fast
    return f"{where}, and this move cuts: {_why_it_cuts(hit, feed_ranges)}"


def _why_it_cuts(hit: Hit, feed_ranges: FeedRanges) -> str:
    if feed_ranges.knows_stock[hit.row]:
        return f"it leads into the stock of {hit.length(hit.trace.lengths.stock_diameter[hit.row])}"
    if feed_ranges.is_of_fast_loop[hit.row]:
        return "no move along this contour is slower"
    return f"it is as near to the center as that of line {hit.line(feed_ranges.slow_row(hit.row))}"


def _recommended(hit: Hit) -> str:
    """The ranges of F that the builder recommends."""
    feeds = hit.trace.machine.feed
    ranges = (
        (feeds.cutting_minimum, feeds.cutting_maximum, "cutting"),
        (feeds.positioning_minimum, feeds.positioning_maximum, "positioning"),
    )
    return ", ".join(f"{_range(hit, least, most)} for {what}" for least, most, what in ranges if least == least)


def _range(hit: Hit, least: float, most: float) -> str:
    """Rounded to what lies within."""
    import numpy as np

    shown = hit.quantity(least).as_feed
    places = 10.0 ** (4 if shown.inch else 3)
    low = np.ceil(shown.length(least) * places * (1 - SHARE)) / places
    high = np.floor(shown.length(most) * places * (1 + SHARE)) / places
    return f"{low:.10g} to {high:.10g} {shown.unit}/min"
