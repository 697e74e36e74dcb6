from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.feed.dynamics import Dynamics
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.path.center import Center
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.quantity import Quantity
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "{rotary} axis would turn at {c_feed:whole/effective_limit} deg/min with {feed_word}, "
    "{verdict}; nearest distance {nearest:length}; {advice}",
    values=("c_feed", "limit", "feed", "nearest", "highest_feed", "slowed_feed"),
    worse=("c_feed",),
    at=("F",),
    once="feed",
    is_symptom=True,
    subject="speed",
    doubts=(("rate", "feed"),),
)
def c_feed_above_limit(center: Center, tool_center: ToolCenter, machine: Machine) -> Hits:
    """
    Feed too high for the distance from the center.

    F is the speed of the tool center on the plane; where it is the speed in space (polar.feed_measures), a move with Z
    leaves a part of it for the plane. The nearer the tool center comes to the center of the C axis, the
    faster C must turn for it: F / L, where L is their smallest distance. Above the limit the control stops with an
    alarm or, with automatic override, slows down. Use F < L * R * pi / 180, with R the limit of C in deg/min, or keep
    away from the center; exactly at the limit it is a warning. R is limits.c_feed of the profile; without it only a
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
        return Hits(above, WARNING, worst=tool_center.c_feed)
    return graded(error=above, warning=at_limit, worst=tool_center.c_feed)


def details(hit: Hit, tool_center: ToolCenter, dynamics: Dynamics, feeds: Feeds) -> Details:
    import numpy as np

    from polarcheck.rules.wording.feeds import feed_word

    limits, allowed = hit.trace.machine.limits, hit.quantity(tool_center.feed_allowed[hit.row])
    is_given = not np.isnan(limits.c_feed) and not feeds.strays_to_center[hit.row]
    return {
        "c_feed": tool_center.c_feed[hit.row],
        "limit": limits.c_feed,
        "feed": hit.trace.feedrate.feed[hit.row],
        "nearest": tool_center.nearest[hit.row],
        "highest_feed": allowed.highest_feed("below") if is_given else None,
        "slowed_feed": tool_center.true_feed[hit.row] if limits.automatic_override else None,
        "effective_limit": tool_center.c_feed_limit,
        "feed_word": feed_word(hit),
        "verdict": _verdict(hit, tool_center, dynamics),
        "advice": _advice(hit, tool_center, feeds, allowed),
    }


def needs(tool_center: ToolCenter, path: ProgrammedPath) -> Needs:
    return path.cuts, {"rate": tool_center.c_feed}


def _verdict(hit: Hit, tool_center: ToolCenter, dynamics: Dynamics) -> str:
    """What the machine allows of C, as far as the profile knows."""
    import numpy as np

    limits, row = hit.trace.machine.limits, hit.row
    if np.isnan(limits.c_feed):
        turns, most = tool_center.c_feed[row] / 360, limits.c_feed_suspicious / 360
        known = f"no {hit.rotary} axis is known to cut with more than {most:.0f}"
        return f"which is {turns:.0f} turns a minute, and {known}"
    if tool_center.is_at_c_feed_limit[row]:
        return f"the limit of {hit.title}, below which it must stay"
    limit = hit.quantity(float(limits.c_feed)).beside(hit.quantity(tool_center.c_feed[row]), "whole")
    allows = f"{hit.title} allows {limit}"
    if not limits.automatic_override:
        return allows
    slowed = hit.quantity(tool_center.true_feed[row])
    slows = f"{allows} and slows the feed down to {tool_center.override[row]:.2g} %, {slowed:highest}"
    of_row = dynamics.moves.row == row
    time, without = (float(times[of_row].sum()) for times in (dynamics.move_time, dynamics.time_without_override))
    return f"{slows}, so that the block takes {time:.3g} s instead of {without:.3g} s" if time > without else slows


def _advice(hit: Hit, tool_center: ToolCenter, feeds: Feeds, allowed: Quantity) -> str:
    """The highest F, or what to give to learn it; of a way that strays from its contour that X or C may be wrong."""
    import numpy as np

    from polarcheck.rules.remedies import option_or_place

    if feeds.strays_to_center[hit.row]:
        return (
            "the contour of this section lies farther out: look for a wrong coordinate of this move or the one before"
        )
    where = (f"for its {hit.count} blocks" if hit.count > 1 else "here") + _on_pass(hit, tool_center)
    if np.isnan(hit.trace.machine.limits.c_feed):
        return f"{option_or_place(hit.trace.machine, 'limits.c_feed')} would give the highest F {where}"
    return f"highest F {where}: {allowed:below}"


def _on_pass(hit: Hit, tool_center: ToolCenter) -> str:
    """Which pass of an infeed cycle turns C fastest in a row; empty for the contour itself, and without a cycle."""
    import numpy as np

    moves = tool_center.moves
    at = np.flatnonzero(moves.row == hit.row)
    allowance = float(moves.allowance[at[np.argmax(moves.c_feed[at])]])
    return f", on the pass {hit.length(allowance)} off the contour" if allowance > 0 else ""
