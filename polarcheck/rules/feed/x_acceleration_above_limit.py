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
    "{linear} axis would need {tool_center.x_acceleration:whole/machine.limits.x_acceleration} mm/s2, {machine.title} "
    "has {machine.limits.x_acceleration:whole/tool_center.x_acceleration}; "
    "nearest distance {tool_center.nearest:length}, highest F here: {feeds.allowed_by_x_acceleration:highest}",
    values={
        "x_acceleration": "tool_center.x_acceleration",
        "limit": "machine.limits.x_acceleration",
        "feed": "feedrate.feed",
        "nearest": "tool_center.nearest",
        "highest_feed": "feed_by_x_acceleration",
    },
    worse=("x_acceleration",),
    at=("F",),
    needs=("tool_center.x_acceleration",),
    where="feeds.is_limited_in_x_acceleration",
    once="feed",
    worst="tool_center.x_acceleration",
    follows={"feed": ("c-feed-above-limit", "c-acceleration-above-limit"), "block": ("start-up-sweeps-contour",)},
)
def x_acceleration_above_limit(feedrate: Feedrate, center: Center, feeds: Feeds) -> Mask:
    """
    Feed too high for the acceleration of X.

    Where the tool passes the center, X comes in, turns back, and goes out again, be the contour ever so straight. The
    nearer it passes, the shorter is the way in which it does: on a line X needs F^2 / d, with d the distance of the
    line from the center. The slide lags behind, and the middle of the line is not straight. Half of F is a quarter of
    that.

    Source: the second derivative of the distance from the center along the path; the limit is limits.x_acceleration
    of the profile.

    Bad, set limits.x_acceleration=50, set limits.c_feed=200000:

        G98 G0 X60. C0
        G12.1
        G1 X2. C10. F200
        C-10. F900        (expect: x-acceleration-above-limit)
        X60. F200
        G13.1

    Good, set limits.x_acceleration=50, set limits.c_feed=200000:

        G98 G0 X60. C0
        G12.1
        G1 X2. C10. F200
        C-10. F400
        X60.
        G13.1
    """
    return center.cuts_off_center & (feedrate.feed > feeds.allowed_by_x_acceleration)
