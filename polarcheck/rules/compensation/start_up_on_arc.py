from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ARC, ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} begins on an arc; begin it in a G1 block before the arc",
    values=("code",),
    at=("compensation_left", "compensation_right", "arc_clockwise", "arc_counterclockwise"),
    subject="move",
    doubts=(("metal", "block"),),
    is_symptom=True,
    only_with=(ARC,),
)
def start_up_on_arc(path: ProgrammedPath, compensation: CutterCompensation) -> Mask:
    """
    Cutter compensation begun on an arc.

    G41 or G42 takes effect with the next move, and that must be a straight one: the control stops with an alarm at G2
    or G3. Start up in G1, and make the arc after it.

    Source: FANUC B-63324EN/03, p. 402; alarm 034; builder's guide to G12.1.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 X50. F200
        G42 G3 X40. C5. I-5. J0   (expect: start-up-on-arc)
        G1 X20.
        G40 C20.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 G42 X50. F200
        G3 X40. C5. I-5. J0
        G1 X20.
        G40 C20.
        G13.1
    """
    return compensation.starts_up & path.is_arc


def details(hit: Hit) -> Details:
    return {"code": hit.side}
