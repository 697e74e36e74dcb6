from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    NOTE,
    "{code} without a move on the plane: the offset begins with that of line {other_line}; write {code} there",
    values=("code", "other_line"),
    at=("compensation_left", "compensation_right"),
    is_advice=True,
    subject="",
    follows={"way": ("start-up-shorter-than-radius", "start-up-sweeps-contour")},
)
def start_up_without_move(ramps: Ramps) -> Mask:
    """
    Compensation begun in a block without a move on the plane.

    G41 or G42 alone, or with a move of Z only, does not start compensation yet: the next move on the plane is the
    start-up, whatever its purpose, and must be as long as a start-up. A reader of the program does not see this. Write
    G41 or G42 into the G1 that moves the tool onto the part: `G1 G41 X1.75 F7.`. If that start-up has a fault, this
    finding is listed under it.

    Source: builder's guide to G12.1, cutter compensation function.

    Bad, machine turning-center, tool 8:radius=0:

        T0808
        G98 G0 X2.15 Z.1 C0
        G12.1
        G1 C.5339 F60.
        G41               (expect: start-up-without-move)
        X1.75 F7.
        C-.5339
        G40 X2.15 F60.
        G13.1

    Bad, machine turning-center, tool 8:radius=0:

        T0808
        G98 G0 X2.15 Z.1 C0
        G12.1
        G1 C.5339 F60.
        G41 Z-.88 F7.     (expect: start-up-without-move)
        X1.75
        C-.5339
        G40 X2.15 F60.
        G13.1

    Good, machine turning-center, tool 8:radius=0:

        T0808
        G98 G0 X2.15 Z.1 C0
        G12.1
        G1 C.5339 F60.
        G41 X1.75 F7.
        C-.5339
        G40 X2.15 F60.
        G13.1
    """
    # Compares nothing: the start-up is a later row, which the table searches for.
    return ramps.start_up_later


def details(hit: Hit, path: ProgrammedPath) -> Details:
    import numpy as np

    return {"code": hit.side, "other_line": hit.line(hit.row + int(np.argmax(path.travels[hit.row :])))}
