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
    "tool center would run backwards here: {misfit}",
    values=("radius",),
    worse=("radius",),
    gouges=True,
    once="mesh",
    doubts=(("metal", "narrow loop"),),
    follows={"loop": ("start-up-shorter-than-radius",)},
    is_symptom=True,
)
def interference(tool_center: ToolCenter, ramps: Ramps) -> Mask:
    """
    Contour too narrow for the cutter.

    In a groove narrower than the cutter, or beside a step or block shorter than it, the path of the tool center crosses
    itself: it would run against the direction of the program, and cut into what is left standing before and behind.
    The control finds this by its interference check and stops with an alarm. Take a smaller cutter, or leave the
    narrow place out. Of neighbouring blocks the first is reported.

    Posts that write curves as lines can make blocks so short that the last digit of their ends turns them by more than
    the curve does. Then the contour is full of inside corners that it does not mean, each too tight for the cutter, and
    the control stops at the first. That is one finding for all of them: write longer blocks, arcs, or more digits.

    Source: FANUC 30i B-63944EN-2, interference check; B-63664EN, p. 184; alarm 041.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C20. F500
        G41 X60. F200
        C3.
        X40.
        C-3.               (expect: interference)
        X60.
        C-20.
        G40 X100.
        G13.1

    Good, tool 1:radius=2.5:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C20. F500
        G41 X60. F200
        C3.
        X40.
        C-3.
        X60.
        C-20.
        G40 X100.
        G13.1
    """
    return tool_center.interferes & ~tool_center.no_intersection & ~ramps.is_consequence


def details(hit: Hit, tool_center: ToolCenter) -> Details:
    radius, others = hit.length(hit.radius), f" and {hit.count - 1} more" if hit.count > 1 else ""
    if not tool_center.interferes_by_rounding[hit.row]:
        return {"misfit": f"the contour is too narrow or too short for R {radius}"}
    return {
        "misfit": f"blocks shorter than their rounding allows with R {radius}, this one{others}; "
        "write longer blocks or arcs, as with a coarser chord tolerance of the post, or more digits"
    }


def needs(compensation: CutterCompensation, ramps: Ramps) -> Needs:
    return ramps.compensated, {"radius": compensation.radius}
