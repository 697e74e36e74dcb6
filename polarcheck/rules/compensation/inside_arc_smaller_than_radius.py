from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.columns.path.tool_center import ToolCenter
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "arc of {arc_radius:length/signed_radius} with the tool on its inner side; "
    "R {signed_radius:length/arc_radius} must be smaller",
    values=("arc_radius", "radius"),
    worse=("-arc_radius", "radius"),
    gouges=True,
    at=("arc_clockwise", "arc_counterclockwise", "R", "I", "J"),
    once="tight arc",
    doubts=(("metal", "narrow loop"),),
    is_symptom=True,
)
def inside_arc_smaller_than_radius(compensation: CutterCompensation, tool_center: ToolCenter) -> Mask:
    """
    Arc into which the cutter does not fit.

    With the tool on the inner side of an arc the tool center runs on a radius smaller by R. Where the radius of the
    arc is not above R nothing is left of it, and the control stops with an alarm before this block. Take a smaller
    cutter, or make the radius of the contour larger. Often G41 stands where G42 is meant. Arcs of the same radius in a
    section are one finding.

    Source: FANUC B-63664EN, p. 184; alarm 041.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 C20. F500
        G41 X40. F200
        C0.
        G3 X46. C-3. R3.   (expect: inside-arc-smaller-than-radius)
        G1 X60.
        G40 X80.
        G13.1

    Good, tool 1:radius=2.5:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 C20. F500
        G41 X40. F200
        C0.
        G3 X46. C-3. R3.
        G1 X60.
        G40 X80.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 C20. F500
        G41 X40. F200
        C0.
        G2 X34. C-3. R3.
        G1 X20.
        G40 C-20.
        G13.1
    """
    # A start-up or an offset cancel on an arc has a rule of its own.
    return tool_center.inside_arc_too_small & ~compensation.starts_up & ~compensation.cancels


def details(hit: Hit, ramps: Ramps) -> Details:
    return {"arc_radius": ramps.arc_radius[hit.row]}


def needs(compensation: CutterCompensation, ramps: Ramps) -> Needs:
    return ramps.compensated, {"radius": compensation.radius}
