from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.center import Center
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.program.machines.machine import Machine


@rule(
    ERROR,
    "{rotary} axis would turn at {tool_center.c_feed:whole/tool_center.c_feed_limit} deg/min with {feed_word}, "
    "{verdict}; nearest distance {tool_center.nearest:length}; {advice}",
    values={
        "c_feed": "tool_center.c_feed",
        "limit": "machine.limits.c_feed",
        "feed": "feedrate.feed",
        "nearest": "tool_center.nearest",
        "highest_feed": "feed_by_c_feed",
        "slowed_feed": "feed_by_override",
    },
    worse=("c_feed",),
    at=("F",),
    needs=("tool_center.c_feed",),
    where="path.cuts",
    once="feed",
    worst="tool_center.c_feed",
    follows={"block": ("start-up-sweeps-contour",)},
)
def c_feed_above_limit(center: Center, tool_center: ToolCenter, machine: Machine) -> Hits:
    """
    Feed too high for the distance from the center.

    F is the speed of the tool center on the plane; where it is the speed in space (polar.feed_measures), a move with Z
    leaves a part of it for the plane. The nearer the tool center comes to the center of the C axis, the
    faster C must turn for it: F / L, where L is their smallest distance. Above the limit the control stops with an
    alarm or, with automatic override, slows down. Use F < L * R * pi / 180, with R the limit of C in deg/min, or keep
    away from the center; exactly at the limit it is a warning. limits.c_feed of the profile is R; without it only a
    rate that no C axis cuts with is reported. One finding stands for all blocks that an F word governs, at the one with
    the highest rate.

    Source: FANUC B-62764EN/01, p. 52; B-63324EN/03, p. 192.

    Bad, set limits.c_feed=3600:

        G98 G0 X60. C0
        G12.1
        G1 X4. C5. F100
        C-5. F500         (expect: c-feed-above-limit)
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 C.1 F50
        X-40. F1000       (expect: c-feed-above-limit)
        G13.1

    Bad, set limits.c_feed=3600, set limits.automatic_override=true:

        G98 G0 X60. C0
        G12.1
        G1 C1. F50
        X-40. F200        (expect: c-feed-above-limit)
        G13.1

    Bad, set limits.c_feed=3600:

        G98 G0 X60. C0
        G12.1
        G1 X4. C2. F500
        X-4.              (expect: c-feed-above-limit)
        C-2.
        X4.
        G13.1

    Bad, set limits.c_feed=1145.9155902616465:

        G98 G0 X60. C0
        G12.1
        G1 X10. C5. F60
        C-5. F100         (expect: c-feed-above-limit)
        G13.1

    Good, set limits.c_feed=3600:

        G98 G0 X60. C0
        G12.1
        G1 X4. C5. F100
        C-5. F120
        G13.1
    """
    limit = machine.limits.c_feed
    above = center.cuts_off_center & tool_center.exceeds_c_feed_limit
    at_limit = center.cuts_off_center & tool_center.is_at_c_feed_limit
    if machine.limits.automatic_override or limit != limit:
        return Hits(above, WARNING)
    return graded(error=above, warning=at_limit)
