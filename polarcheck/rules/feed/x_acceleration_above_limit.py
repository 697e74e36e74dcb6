from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, X_ACCELERATION, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.path.center import Center
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    WARNING,
    "{linear} axis would need {x_acceleration:whole/limit} mm/s2, {title} "
    "has {limit:whole/x_acceleration}; "
    "nearest distance {nearest:length}, highest F here: {allowed:highest}",
    values=("x_acceleration", "limit", "feed", "nearest", "highest_feed"),
    worse=("x_acceleration",),
    at=("F",),
    once="feed",
    follows={"feed": ("c-acceleration-above-limit",)},
    subject="rate",
    only_with=(X_ACCELERATION,),
)
def x_acceleration_above_limit(feedrate: Feedrate, center: Center, feeds: Feeds) -> Hits:
    """
    Feed too high for the acceleration of X.

    Where the tool passes the center, X comes in, turns back and goes out again, even on a straight line. The nearer it
    passes, the shorter is the way in which it does: on a line X needs F^2 / d, with d the distance of the line from the
    center. The slide lags behind, and the middle of the line is not straight. Half of F is a quarter of that.

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
    return Hits(
        center.cuts_off_center & (feedrate.feed > feeds.allowed_by_x_acceleration),
        worst=feeds.tool_center.x_acceleration,
    )


def details(hit: Hit, tool_center: ToolCenter, feeds: Feeds) -> Details:
    allowed = hit.quantity(feeds.allowed_by_x_acceleration[hit.row])
    return {
        "x_acceleration": tool_center.x_acceleration[hit.row],
        "limit": hit.trace.machine.limits.x_acceleration,
        "feed": hit.trace.feedrate.feed[hit.row],
        "nearest": tool_center.nearest[hit.row],
        "highest_feed": allowed.highest_feed("highest"),
        "allowed": allowed,
    }


def needs(tool_center: ToolCenter, feeds: Feeds) -> Needs:
    return feeds.is_limited_in_x_acceleration, {"rate": tool_center.x_acceleration}
