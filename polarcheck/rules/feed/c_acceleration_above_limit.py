from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.feed.feeds import Feeds
    from polarcheck.columns.path.center import Center
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "{rotary} axis would need {tool_center.c_acceleration:whole/machine.limits.c_acceleration} deg/s2, {machine.title} "
    "has {machine.limits.c_acceleration:whole/tool_center.c_acceleration}; "
    "nearest distance {tool_center.nearest:length}, highest F here: {feeds.allowed_by_acceleration:highest}",
    values={
        "c_acceleration": "tool_center.c_acceleration",
        "limit": "machine.limits.c_acceleration",
        "feed": "feedrate.feed",
        "nearest": "tool_center.nearest",
        "highest_feed": "feed_by_c_acceleration",
    },
    worse=("c_acceleration",),
    at=("F",),
    needs=("tool_center.c_acceleration",),
    where="feeds.is_limited_in_acceleration",
    once="feed",
    worst="tool_center.c_acceleration",
    follows={"feed": ("c-feed-above-limit",), "block": ("start-up-sweeps-contour",)},
)
def c_acceleration_above_limit(feedrate: Feedrate, center: Center, feeds: Feeds) -> Mask:
    """
    Feed too high for the acceleration of the C axis.

    Where the tool comes to the center and leaves it again, C must speed up and slow down in a short way. The servo lags
    behind, the shape is not true, or the drive stops with an alarm. On a line C needs 0.65 * F^2 / d^2, with d the
    distance of the line from the center: half of F is a quarter of that.

    Source: the second derivative of the angle along the path; the limit is limits.c_acceleration of the profile.

    Bad, set limits.c_acceleration=500, set limits.c_feed=20000:

        G98 G0 X60. C0
        G12.1
        G1 X2. C10. F200
        C-10. F300        (expect: c-acceleration-above-limit)
        X60. F200
        G13.1

    Good, set limits.c_acceleration=500, set limits.c_feed=20000:

        G98 G0 X60. C0
        G12.1
        G1 X2. C10. F200
        C-10. F200
        X60.
        G13.1
    """
    return center.cuts_off_center & (feedrate.feed > feeds.allowed_by_acceleration)
