from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import OUT_OF_PLACE
from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.strokes import Strokes
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{block} goes down into metal at {feed:feed/other_feed}{f_word}; {witness} at {other_feed:feed/feed}: write an F",
    values=("feed", "other_line"),
    worse=("feed",),
    gouges=True,
    once="feed",
    subject="stock",
    follows={
        "section": OUT_OF_PLACE,
        "start-up ahead": ("start-up-sweeps-contour",),
    },
)
def plunge_at_positioning_feed(strokes: Strokes) -> Hits:
    """
    Plunge into metal with the F of positioning.

    A block of Z alone takes the tool down into metal, and has no F: that with which the tool was positioned is still in
    force. The cutter breaks. What was meant is said by the like plunges of the tool, of which two or more have an F, or
    by the F of the cut behind it where the bar is known and stands there. A plunge beside the bar, from one depth to
    the next, or into what is cut already, is not meant.

    Source: builder's guide to G12.1, feed command.

    Bad, tool 1:radius=2.5, set job.stock.diameter=60:

        T0101
        G98 G0 X20. Z2. C0
        G12.1
        G1 X20. F1500
        Z-4.              (expect: plunge-at-positioning-feed)
        G41 X34. F200
        G3 I-17.
        G1 G40 X20.
        Z2. F1500
        G13.1

    Bad, tool 1:radius=1.5:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X30. C-12. F1500
        Z-3. F60
        X-30. F200
        Z2. F1500
        X30. C-8.
        Z-3.              (expect: plunge-at-positioning-feed)
        X-30. F200
        Z2. F1500
        X30. C-4.
        Z-3. F60
        X-30. F200
        Z2. F1500
        G13.1

    Good, tool 1:radius=2.5, set job.stock.diameter=60:

        T0101
        G98 G0 X20. Z2. C0
        G12.1
        G1 X20. F1500
        Z-4. F60
        G41 X34. F200
        G3 I-17.
        G1 G40 X20.
        Z2. F1500
        G13.1
    """
    # Compares nothing: the strokes of a tool have to be read together.
    return Hits(strokes.is_too_fast)


def details(hit: Hit, strokes: Strokes) -> Details:
    from polarcheck.rules.wording.feeds import f_word

    rows = strokes.too_fast[hit.row]
    first = int(rows[0])
    word, feed = f_word(hit), hit.trace.feedrate.feed_number
    is_cut = bool(hit.trace.path.travels[first])
    return {
        "feed": feed[hit.row],
        "other_feed": feed[first],
        "other_line": hit.line(first),
        "f_word": f", by {word}",
        "witness": f"the cut of line {hit.line(first)} runs" if is_cut else f"line {hit.line(first)} goes down",
    }
