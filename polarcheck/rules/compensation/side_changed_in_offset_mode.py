from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import UNIT
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} while {other_code} is in force; write G40 with a move between them",
    values=("code", "other_code"),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    subject="",
    doubts=(("compensation", UNIT), ("move", "loop"), ("offset", "section")),
)
def side_changed_in_offset_mode(compensation: CutterCompensation, ramps: Ramps) -> Mask:
    """
    Side of compensation changed without G40.

    From G41 to G42 the tool crosses the contour, and where it does so depends on the corner and on the control. Cancel
    with G40 in a move away from the part, and start up again on the other side.

    Source: FANUC B-63324EN/03, p. 405; B-63944EN-2, p. 158.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 C20. F500
        G41 X40. F200
        C5.
        G42 C-20.         (expect: side-changed-in-offset-mode)
        G40 X80.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 C20. F500
        G41 X40. F200
        C-20.
        G40 X80.
        G42 X40.
        C20.
        G40 X80.
        G13.1
    """
    return ramps.writes_side_again & (compensation.side != compensation.side_before)


def details(hit: Hit, compensation: CutterCompensation) -> Details:
    return {"code": hit.side, "other_code": f"G{compensation.side_before[hit.row]}"}
