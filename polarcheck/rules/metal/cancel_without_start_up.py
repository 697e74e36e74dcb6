from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.misplaced_ramps import MisplacedRamps
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} takes back a compensation that nothing has begun: the contour before it is cut with the cutter center on "
    "the programmed path, {wrong_by}; write {left_or_right} into the block that leads to the contour, {lead}",
    values=("code", "radius"),
    worse=("radius",),
    gouges=True,
    at=("compensation_off",),
    once="section",
    subject="offset",
    doubts=(("position", "section"), ("compensation", "section"), ("metal", "section")),
    follows={"section": ("polar-switched-in-offset-mode",)},
    is_symptom=True,
)
def cancel_without_start_up(misplaced_ramps: MisplacedRamps) -> Mask:
    """
    G40 with a move behind a contour that is cut without compensation.

    Where G41 or G42 is missing at the start of a contour, the control runs the cutter center along the programmed path,
    and every wall is off by R: an outside shape comes out smaller by twice R. No alarm shows it. The G40 in the move
    that leaves the contour still tells that compensation was meant. A G40 for safety is common, so that it counts only
    with a second witness: the contour is closed, or the move leads back to where the tool came from, as a ramp does, or
    other sections of the program compensate. Where R is 0, or the contour is a round size only with R taken off it, the
    program gives the path of the cutter center, and nothing is reported.

    Source: builder's guide to G12.1, cutter compensation (ramp on and ramp off belong together).

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-5.
        X40. F200
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X60. F1500    (expect: cancel-without-start-up)
        Z2.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-5.
        G42 X40. F200
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X60. F1500
        Z2.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G40 G1 X60. F1500
        Z-5.
        X40. F200
        C20.
        X-40.
        C-20.
        X40.
        C0
        X60. F1500
        G40
        Z2.
        G13.1
    """
    # Compares nothing: what stands beside a G40 as a second witness is looked for along the contour.
    return misplaced_ramps.cancel_alone


def details(hit: Hit, offsets: ToolOffsets, misplaced_ramps: MisplacedRamps, machine: Machine) -> Details:
    from polarcheck.rules.wording.ramps import wrong_by
    from polarcheck.rules.wording.written import code_of

    return {
        "code": hit.cancel,
        "radius": abs(offsets.radius_of_offset[hit.row]),
        "wrong_by": wrong_by(hit),
        "lead": f"in or before line {hit.line(misplaced_ramps.lead_of(hit.row))}",
        "left_or_right": f"{code_of(machine, 'compensation_left')} or {code_of(machine, 'compensation_right')}",
    }
