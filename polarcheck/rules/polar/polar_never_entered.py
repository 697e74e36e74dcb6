from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion, Side
from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.procedure import Procedure
    from polarcheck.columns.modes.switch_slips import SwitchSlips
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} ends a polar mode that was never entered: {turned} as outside the mode, not on the contour; {instead}",
    values=("code", "other_line"),
    at=("off",),
    subject="mode",
)
def polar_never_entered(axes: PlaneAxes, procedure: Procedure, switch_slips: SwitchSlips) -> Hits:
    """
    G13.1 after a contour that no G12.1 began.

    Cutter compensation and moves of C at feed belong in the polar mode. Without its G12.1 the control takes C as an
    angle, and compensates in another plane or stops: the shape is not cut. Write G12.1 behind the positioning, before
    G41 or G42. Without them an arc of C tells the same, and so do moves of X and C at feed that lead right up to the
    G13.1, or to a retract before it where a block moves both, unless C would lie far outside X as a length, as in a
    groove round the diameter, or Z moves with C, as in a helix. A G13.1 for safety, at the head of a program or of a
    tool, ends nothing and is right.

    Source: FANUC B-62764EN/01, p. 50; builder's guide to G12.1, cutter compensation in the mode.

    Bad, tool 1:radius=4:

        O1
        T0101
        G98 G0 X60. C0
        G1 C-20. F500
        G42 X40. F200
        C20.
        G40 X60.
        G13.1             (expect: polar-never-entered)
        M30

    Bad, tool 1:radius=4:

        O1
        T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.
        X60.
        G13.1
        G1 G41 X40. C5.
        C20.
        G40 X60.
        G13.1             (expect: polar-never-entered)
        M30

    Bad:

        O1
        T0101
        G98 G0 X60. C0
        G1 C-20. F500
        X40. F200
        C20.
        X60.
        G13.1             (expect: polar-never-entered)
        M30

    Bad:

        O1
        T0101
        G98 G0 X60. Z2. C0
        Z-5.
        G1 X40. F200
        X20. C17.32
        X-20.
        X-40. C0
        X60.
        G0 Z2.
        G13.1             (expect: polar-never-entered)
        M30

    Good:

        O1
        T0101
        G98 G0 X42. Z2. C0
        G1 X38. F50
        Z-25. C720. F300
        G0 X60.
        G13.1
        M30

    Good:

        O1
        T0101
        G98 G0 X60. Z2. C0
        G1 X40. F50
        C90. F500
        C180.
        X60.
        G0 X100. Z50.
        G13.1
        M30

    Good:

        O1
        T0101
        G98 G0 X62. Z-20. C0
        G1 X58. F50
        C45. F800
        C-45.
        X62.
        G13.1
        M30

    Good, tool 1:radius=4:

        O1
        G40 G13.1
        T0101
        G98 G0 X60. Z2. C0
        G1 C30. F500
        G40 G13.1
        T0202
        G0 X50. Z2.
        G1 G42 X40. F200
        Z-20.
        G40 X60.
        G40 G13.1
        M30
    """
    never_entered = axes.switches_off & (procedure.contour_without_mode >= 0)
    goes_on = procedure.contour_goes_on_behind >= 0
    return Hits(never_entered, follows={"tool call": goes_on, "program": switch_slips.within})


def details(
    hit: Hit, procedure: Procedure, compensation: CutterCompensation, axes: PlaneAxes, machine: Machine
) -> Details:
    first = int(procedure.contour_without_mode[hit.row])
    axis, from_line = machine.polar.virtual_axis, f"from line {hit.line(first)} on"
    turned = f"{from_line} X and {axis} move at feed right up to it"
    if compensation.side[first] != Side.OFF:
        turned = f"{from_line} {axis} moves at feed with G41 or G42"
    elif axes.motion[first] != Motion.LINE:
        turned = f"{from_line} {axis} moves on an arc"
    early = int(procedure.contour_goes_on_behind[hit.row])
    instead = f"write {hit.switch_on} {_place(hit, first)}"
    if early >= 0:
        instead = f"take out {hit.switch} of line {hit.line(early)}, in the middle of the contour"
    return {"code": hit.switch, "other_line": hit.line(first), "turned": turned, "instead": instead}


def _place(hit: Hit, first: int) -> str:
    """
    Before which block the mode begins: the first one that moves or writes G41 or G42, behind the last rapid traverse
    without compensation that leads to the contour, and behind the section before.
    """
    import numpy as np

    from polarcheck.rules.wording.written import block_in_short

    trace = hit.trace
    same = trace.blocks.program == trace.blocks.program[first]
    moves = trace.axes.moves & same
    outside = (moves & (trace.axes.motion == Motion.RAPID) & (trace.compensation.side == Side.OFF)) | (
        trace.axes.switches_off & same
    )
    begins = np.flatnonzero(outside[:first])
    after = int(begins[-1]) + 1 if len(begins) else int(np.argmax(same))
    row = after + int(np.argmax((moves | (trace.compensation.writes_side & same))[after:]))
    return f"before line {hit.line(row)}, {block_in_short(trace.run, row)}"
