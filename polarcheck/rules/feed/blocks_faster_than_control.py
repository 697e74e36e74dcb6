from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import SHARE
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feeds import Feeds
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "a block takes {feeds.time_of_series:.3g} s here, ten in a row, and {machine.title} needs "
    "{machine.limits.block_time:g} s for one: F falls to {feeds.feed_of_series:highest}, and the tool may halt between "
    "blocks",
    values={"time": "feeds.time_of_series", "limit": "machine.limits.block_time", "highest_feed": "feed_of_series"},
    worse=("-time",),
    once="section",
    worst="feeds.blocks_too_fast",
    follows={"section": ("feed-implausible",)},
)
def blocks_faster_than_control(feeds: Feeds) -> Mask:
    """
    Blocks shorter than the control can read at this feed.

    A control needs some time to read and prepare a block. Where a post has broken arcs into short lines, F asks for
    blocks in quicker succession than that. The tool then runs more slowly than F, and unevenly: it halts between
    blocks and leaves marks. A single short block does no harm, for the control reads in advance; ten in a row are
    more than that makes up for. Let the post write arcs, or a coarser tolerance, or lower F.

    Source: limits.block_time of the machine profile; the builder's data of the control.

    Bad, set limits.block_time=0.01:

        G98 G0 X60. C0
        G12.1
        G1 X40. F1200
        C.1               (expect: blocks-faster-than-control)
        C.2
        C.3
        C.4
        C.5
        C.6
        C.7
        C.8
        C.9
        C1.
        X60.
        G13.1

    Good, set limits.block_time=0.01:

        G98 G0 X60. C0
        G12.1
        G1 X40. F500
        C.1
        C.2
        C.3
        C.4
        C.5
        C.6
        C.7
        C.8
        C.9
        C1.
        X60.
        G13.1
    """
    return feeds.blocks_too_fast > 1 + SHARE
