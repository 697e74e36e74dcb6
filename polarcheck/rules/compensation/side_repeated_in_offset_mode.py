from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.ramps import Ramps
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} is in force already: written again, it keeps the tool center from turning into the corner before this "
    "block; delete it, or write {cancel} into the earlier block that leaves the contour",
    values=("code",),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    once="section",
    subject="",
    doubts=(("compensation", "section"), ("offset", "section")),
)
def side_repeated_in_offset_mode(compensation: CutterCompensation, ramps: Ramps) -> Mask:
    """
    G41 or G42 written again while it is in force.

    The control sets up the tool center perpendicular to the end of the block before, whether the corner is an inside or
    an outside one: an inside corner is cut into, and an arc next to it gets the wrong radius. Delete the second code.
    The first one of a section is reported.

    Source: FANUC B-63944EN-2, p. 158.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 C20. F500
        G41 X40. F200
        C5.
        G41 C-20.         (expect: side-repeated-in-offset-mode)
        G40 X80.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X80. C0
        G12.1
        G1 C20. F500
        G41
        G41 X40. F200
        C-20.
        G40 X80.
        G41 X40. C20.
        C-20.
        G40 X80.
        G13.1
    """
    return ramps.writes_side_again & (compensation.side == compensation.side_before)


def details(hit: Hit) -> Details:
    return {"code": hit.side}
