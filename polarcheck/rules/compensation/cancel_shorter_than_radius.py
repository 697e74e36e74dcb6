from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "offset cancel {fault}",
    values=("length", "radius", "length_needed"),
    worse=("-length", "length_needed"),
    gouges=True,
    at=("compensation_off",),
    doubts=(("metal", "block"), ("rapid", "tool call")),
    follows={
        "loop": ("inside-arc-smaller-than-radius", "start-up-shorter-than-radius"),
        "section": ("incremental-word-of-other-code-system",),
    },
    is_symptom=True,
)
def cancel_shorter_than_radius(
    path: ProgrammedPath, compensation: CutterCompensation, ramps: Ramps, machine: Machine
) -> Hits:
    """
    Offset cancel shorter than the cutter radius.

    Cutter compensation is taken back in the G1 block with G40, or in the next one that moves. That block must move at
    least the R of the tool offset: along X twice R where X is a diameter, along the virtual axis once R, at an angle R
    on the plane. After a shorter one, or a G40 after which nothing moves on the plane, the tool is not where the
    program takes it to be, and it may turn back into the contour. A block that names the present position is no move.
    Where the manual of the control leaves the mode so, a G40 without a move is a note.

    Source: builder's guide to G12.1, cutter compensation function and sample program.

    Bad, tool 8:radius=9.525:

        T0808
        G98 G0 X65. C0
        G12.1
        G1 C13. F1500
        G1 G41 X44. F180
        C-13.
        G40 X50. F1500     (expect: cancel-shorter-than-radius)
        G13.1

    Bad, tool 8:radius=9.525:

        T0808
        G98 G0 X65. C0
        G12.1
        G1 C13. F1500
        G1 G41 X44. F180
        C-13.
        G40                (expect: cancel-shorter-than-radius)
        G13.1

    Bad, machine gsk-988, tool 2:radius=4:

        T0202
        G0 X60. C0
        G12.1
        G1 G42 X40. F200
        C10.
        X-40.
        C0
        G40 X-40.          (expect: cancel-shorter-than-radius)
        G13.1

    Good, tool 8:radius=9.525:

        T0808
        G98 G0 X65. C0
        G12.1
        G1 C13. F1500
        G1 G41 X44. F180
        C-13.
        G40
        Z2.
        X65. F1500
        G13.1
    """
    short = compensation.cancels & ~path.is_arc & ramps.shorter_than_radius
    # With R 0 an offset cancel needs no length; an R that is not known is not 0.
    missing = ramps.cancel_missing & (compensation.radius != 0)
    # R is too large for both ramps, or for an arc between them.
    follows = {"loop": short | ramps.suffices_for_smaller_cutter, "section": missing}
    if machine.compensation.leaving_cancels:
        return graded(error=short, note=missing, follows=follows)
    return graded(error=short | missing, follows=follows)


def details(hit: Hit) -> Details:
    from polarcheck.rules.wording.ramps import ramp_length, short_ramp

    length = ramp_length(hit)
    return {"length": length, "length_needed": hit.radius, "fault": short_ramp(hit)}


def needs(compensation: CutterCompensation, path: ProgrammedPath, ramps: Ramps) -> Needs:
    return ramps.cancel_judged_by_radius, {"radius": compensation.radius, "position": path.length}
