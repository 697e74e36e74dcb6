from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "start-up {fault}{begins}{ramp_at_rest}",
    values=("code", "length", "radius", "length_needed"),
    worse=("-length", "length_needed"),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    doubts=(("metal", "loop"), ("rapid", "tool call")),
    follows={"loop": ("inside-arc-smaller-than-radius",), "X before": ("uncompensated-cut-into-part",)},
    is_symptom=True,
)
def start_up_shorter_than_radius(path: ProgrammedPath, compensation: CutterCompensation, ramps: Ramps) -> Hits:
    """
    Start-up shorter than the cutter radius.

    Cutter compensation is built up in the G1 block with G41 or G42, or in the next one that moves. That block must move
    at least the R of the tool offset: along X twice R where X is a diameter, along the virtual axis once R, at an angle
    R on the plane. A shorter one starts inside the offset and cuts into the contour, or turns the tool back. A G41
    after which nothing moves before G40 or G13.1 builds up nothing; a block that names the present position is no move.

    Source: builder's guide to G12.1, cutter compensation function.

    Bad, tool 8:radius=9.525:

        T0808
        G98 G0 X54. C0
        G12.1
        G1 C13. F1500
        G1 G41 X44. F180   (expect: start-up-shorter-than-radius)
        C-13.
        G40 X65. F1500
        G13.1

    Bad, tool 8:radius=9.525:

        T0808
        G98 G0 X65. C0
        G12.1
        G1 C13. F1500
        G41                (expect: start-up-shorter-than-radius)
        G13.1

    Good, tool 1:radius=6:

        T0101
        G98 G0 X140. C0
        G112
        G1 G41 X140. C0 F500
        X40.
        C-13.
        G40 X140.
        G113

    Good, tool 8:radius=9.525:

        T0808
        G98 G0 X65. C0
        G12.1
        G1 C13. F1500
        G41
        Z-5.
        X44. F180
        C-13.
        G40 X65. F1500
        G13.1
    """
    short = compensation.starts_up & ~path.is_arc & ramps.shorter_than_radius
    # With R 0 a start-up needs no length; an R that is not known is not 0.
    missing = ramps.start_up_missing & (compensation.radius != 0)
    return Hits(short | missing, follows={"loop": ramps.suffices_for_smaller_cutter})


def details(hit: Hit) -> Details:
    from polarcheck.rules.wording.ramps import ramp_at_rest, ramp_length, short_ramp, start_of_ramp

    length = ramp_length(hit)
    return {
        "code": hit.side,
        "length": length,
        "length_needed": hit.radius,
        "fault": short_ramp(hit),
        "begins": start_of_ramp(hit),
        "ramp_at_rest": ramp_at_rest(hit),
    }


def needs(compensation: CutterCompensation, path: ProgrammedPath, ramps: Ramps) -> Needs:
    return ramps.start_up_judged_by_radius, {"radius": compensation.radius, "position": path.length}
