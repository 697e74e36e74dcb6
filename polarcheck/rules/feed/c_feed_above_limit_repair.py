from __future__ import annotations

import math

import numpy as np

from polarcheck.columns.feed.programmed_feeds import Feeds
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.rules.editing import Replace, in_place_of, is_plain, with_word, written_word
from polarcheck.rules.feed_words import feed_below, feed_in_force, takes_feed
from polarcheck.rules.repair import FEED, Mended, repair


@repair(FEED)
def c_feed_above_limit(trace: Trace, tool_center: ToolCenter, feeds: Feeds, row: int, hit: Mask) -> Mended | None:
    """
    F is lowered to the highest that the message names, rounded down, and restored behind the blocks that need it.

    Only with the machine's own limit of C, and not for a ramp that strays to the center from a contour farther out, of
    which a coordinate may be wrong. Unsafe: another feed cuts otherwise.

    Bad, set limits.c_feed=3600:

        G98 G0 X60. C0
        G12.1
        G1 X40. C5. F500
        X4. (NEAR THE CENTER)
        C-5.
        X40.
        C-10.
        G13.1

    Good, set limits.c_feed=3600:

        G98 G0 X60. C0
        G12.1
        G1 X40. C5. F500
        X4. F125 (NEAR THE CENTER)
        C-5.
        X40.
        C-10. F500
        G13.1
    """
    feed = feed_in_force(trace.blocks, trace.feedrate, trace.run, row)
    if feed is None or math.isnan(trace.machine.limits.c_feed) or feeds.strays_to_center[row]:
        return None
    low = feed_below(trace.blocks, trace.lengths, trace.run, row, float(tool_center.feed_allowed[row]))
    if low is None:
        return None
    old = written_word(trace.run, feed)
    edits: set[Replace] = set()
    is_low = False
    governed = np.flatnonzero(takes_feed(trace.axes) & (trace.feedrate.feed_word == trace.feedrate.feed_word[row]))
    for moving in governed.tolist():
        if bool(hit[moving]) == is_low:
            continue
        is_low = not is_low
        if not is_plain(trace.run, moving):
            return None
        if trace.blocks.has("F")[moving]:
            edits |= {in_place_of(trace.run, feed, low)} if is_low else set()
        else:
            edits.add(with_word(trace.run, moving, low if is_low else old))
    places = [start for start, _, _ in edits]
    if len(set(places)) < len(places):
        return None  # a block of a loop that needs one F here and the other there
    restores = f" and restore {old} behind" if any(text.strip() == old for _, _, text in edits) else ""
    return Mended(f"Lower {old} to {low}{restores}", False, tuple(edits))
