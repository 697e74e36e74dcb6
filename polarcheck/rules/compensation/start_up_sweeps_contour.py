from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.overcuts import Overcuts
    from polarcheck.columns.contour.slots import Slots
    from polarcheck.columns.feed.programmed_feeds import Feeds
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "the ramp goes {depth:length} deep into {swept}{begins}{ramp_at_rest}{increments}",
    values=("depth", "radius", "plane_x", "plane_c", "other_line"),
    worse=("depth",),
    gouges=True,
    at=("compensation_off", "compensation_left", "compensation_right"),
    once="loop",
    doubts=(("metal", "X before"), ("speed", "block")),
    follows={
        "block": ("path-through-center",),
        "X before": ("uncompensated-cut-into-part", "path-through-center", "c-feed-above-limit"),
        "loop": ("overcut", "slot-narrower-than-cutter"),
    },
    is_symptom=True,
)
def start_up_sweeps_contour(slots: Slots, feeds: Feeds, compensation: CutterCompensation) -> Hits:
    """
    Start-up or offset cancel that cuts the contour.

    With start-up type A the ramp ends perpendicular to the first block of the contour. Where it comes from the other
    side of a corner, the straight way there leads over the corner and takes it off; the offset cancel likewise. Start
    from the side that the contour runs to, or let the ramp end where the contour goes straight on. A ramp that cuts the
    contour of another loop of the section, at the same Z, is found as well.

    Source: FANUC B-63944EN-2, start-up and cancel of cutter compensation; parameter 5003#0, #1.

    Bad, tool 1:radius=5:

        T0101
        G98 G0 X20. C0
        G12.1
        G1 G41 X60. C0 F200   (expect: start-up-sweeps-contour)
        C-30.
        X20.
        G40 C-50.
        G13.1

    Good, tool 1:radius=5:

        T0101
        G98 G0 X120. C0
        G12.1
        G1 G41 X60. C0 F200
        C-30.
        X20.
        G40 C-50.
        G13.1
    """
    sweeps = slots.ramp_depth > 0
    if not sweeps.any():
        return Hits(sweeps, values={"depth": slots.ramp_depth})
    # The ramp of the next pass begins where an offset cancel has ended that cuts the contour: both are one mistake.
    sweeps = sweeps & ~(compensation.starts_up & feeds.before_on_plane(sweeps & compensation.cancels))
    # A high F says nothing of the end of its move, nor does the ramp with which the last pass of a loop has ended.
    by_approach = ~feeds.before_on_plane(sweeps | feeds.is_only_fast)
    return Hits(sweeps, values={"depth": slots.ramp_depth}, follows={"X before": by_approach}, worst=slots.ramp_depth)


def details(hit: Hit, overcuts: Overcuts, slots: Slots) -> Details:
    from polarcheck.rules.wording.ramps import increments_in_force, ramp_at_rest, start_of_ramp

    own = overcuts.sweep_depth[hit.row] >= slots.sweep_depth[hit.row]
    into, place = (overcuts if own else slots).sweeps.deepest(hit.row)
    return {
        "plane_x": place.real,
        "plane_c": place.imag,
        "other_line": hit.line(into),
        "swept": f"the contour of line {hit.line(into)} at {hit.point(place)}",
        "begins": start_of_ramp(hit),
        "ramp_at_rest": ramp_at_rest(hit),
        "increments": increments_in_force(hit),
    }
