from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import C_ACCELERATION, WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.feedrate import Feedrate
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.path.center import Center
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    WARNING,
    "{rotary} axis would need {c_acceleration:whole/limit} deg/s2, {title} "
    "has {limit:whole/c_acceleration}; "
    "nearest distance {nearest:length}, highest F here: {allowed:highest}",
    values=("c_acceleration", "limit", "feed", "nearest", "highest_feed"),
    worse=("c_acceleration",),
    at=("F",),
    once="feed",
    subject="rate",
    only_with=(C_ACCELERATION,),
)
def c_acceleration_above_limit(feedrate: Feedrate, center: Center, feeds: Feeds) -> Hits:
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
    return Hits(
        center.cuts_off_center & (feedrate.feed > feeds.allowed_by_acceleration), worst=feeds.tool_center.c_acceleration
    )


def details(hit: Hit, tool_center: ToolCenter, feeds: Feeds) -> Details:
    allowed = hit.quantity(feeds.allowed_by_acceleration[hit.row])
    return {
        "c_acceleration": tool_center.c_acceleration[hit.row],
        "limit": hit.trace.machine.limits.c_acceleration,
        "feed": hit.trace.feedrate.feed[hit.row],
        "nearest": tool_center.nearest[hit.row],
        "highest_feed": allowed.highest_feed("highest"),
        "allowed": allowed,
    }


def needs(tool_center: ToolCenter, feeds: Feeds) -> Needs:
    return feeds.is_limited_in_acceleration, {"rate": tool_center.c_acceleration}
