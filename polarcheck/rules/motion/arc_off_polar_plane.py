from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import NO_SUCH_ARC
from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.trace import Trace
    from polarcheck.rules.hit import Details, Hit

#: Points nearer than this [mm] are one.
_SAME = 0.02


@rule(
    ERROR,
    "arc along Z; in the polar mode arcs lie in the plane of {linear} and {virtual}{still_in_force}",
    at=("arc_clockwise", "arc_counterclockwise", "Z", "W"),
    subject="offset",
    doubts=NO_SUCH_ARC,
    follows={"arc before": ("arc-without-center",), "section": ("polar-switched-in-offset-mode",)},
)
def arc_off_polar_plane(arcs: Arcs, compensation: CutterCompensation) -> Hits:
    """
    Arc along Z in the polar mode.

    In the mode G2 and G3 are arcs of the polar plane. A block of theirs with Z and no axis of the plane is no such arc,
    and the control stops with an alarm. Often it is a move of Z behind an arc, where G1 was forgotten. With Z and only
    one axis of the plane it is an arc of another plane, too, unless an arc of the polar plane fits it: then it is a
    helix, and the axis that stays where it is was left out.

    Source: FANUC alarm 021; B-62764EN/01, p. 51.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R10.
        Z5.               (expect: arc-off-polar-plane)
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G2 Z-5. R10.      (expect: arc-off-polar-plane)
        G1 X60.
        G13.1

    Bad:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. C16. F200
        Z-8.
        G2 C0. Z-10. R5.  (expect: arc-off-polar-plane)
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R10.
        G1 Z5.
        G13.1
    """
    # Compares nothing: whether an arc of the plane fits is a formula, on which helical-arc-in-polar hangs as well.
    # In offset mode the block that leads away with G1 and G40 is missing before it.
    return Hits(arcs.is_off_plane, follows={"section": compensation.compensates})


def details(hit: Hit, upright: Trace) -> Details:
    from polarcheck.rules.wording.arcs import still_in_force

    return {"still_in_force": still_in_force(hit.trace, hit.row, says_line=not _is_within_contour(upright, hit.row))}


def _is_within_contour(upright: Trace, row: int) -> bool:
    """It ends below the face where no other block moves Z: a line there would leave a contour at two depths."""
    path, mode, line = upright.path, upright.mode, upright.blocks.line
    moves_there = path.moves_z & (mode.section == mode.section[row]) & (abs(path.end - path.end[row]) <= _SAME)
    return bool(path.z[row] < 0 and not moves_there[line != line[row]].any())
