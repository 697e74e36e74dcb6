from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ARC, ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "G40 takes effect on an arc; cancel in a G1 block after the arc",
    at=("compensation_off", "arc_clockwise", "arc_counterclockwise"),
    subject="move",
    doubts=(("metal", "block"), ("metal", "X before")),
    follows={"compensation": ("compensation-without-contour",)},
    is_symptom=True,
    only_with=(ARC,),
)
def cancel_on_arc(path: ProgrammedPath, compensation: CutterCompensation) -> Mask:
    """
    Cutter compensation cancelled on an arc.

    G40 takes effect with the next move, which must be straight: the control stops with an alarm at G2 or G3. Finish the
    arc with compensation, and cancel in G1.

    Source: FANUC B-63324EN/03, p. 402; alarm 034; builder's guide to G12.1.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 G2 X30. C-15. I-5. J0   (expect: cancel-on-arc)
        G1 X60.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G2 X30. C-15. I-5. J0
        G1 G40 C-25.
        G13.1
    """
    return compensation.cancels & path.is_arc
