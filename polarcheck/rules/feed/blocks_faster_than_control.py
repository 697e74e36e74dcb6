from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.geometry.tolerances import SHARE
from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "a block takes {time:.3g} s here, ten in a row, and {title} needs "
    "{limit:g} s for one: F falls to {feed_of_series:highest}, and the tool may halt between "
    "blocks",
    values=("time", "limit", "highest_feed"),
    worse=("-time",),
    once="section",
    subject="rate",
)
def blocks_faster_than_control(feeds: Feeds) -> Hits:
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
    return Hits(feeds.blocks_too_fast > 1 + SHARE, worst=feeds.blocks_too_fast)


def details(hit: Hit, feeds: Feeds, machine: Machine) -> Details:
    feed = hit.quantity(feeds.feed_of_series[hit.row])
    return {
        "time": feeds.time_of_series[hit.row],
        "limit": machine.limits.block_time,
        "highest_feed": feed.highest_feed("highest"),
        "feed_of_series": feed,
    }
