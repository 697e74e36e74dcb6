from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import SECTION_READ_OTHERWISE
from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.center import Center
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit

#: One arc or one way across the center may be a slip of its own.
_SEVERAL = 2


@rule(
    ERROR,
    "no {axis} word in this section: the tool moves along X alone, {what}; write {axis} in every block that moves it",
    values=("axis",),
    over="sections",
    at=("on",),
    subject="",
    doubts=SECTION_READ_OTHERWISE,
)
def second_axis_never_programmed(
    axes: PlaneAxes, mode: PolarMode, path: ProgrammedPath, arcs: Arcs, center: Center
) -> Mask:
    """
    Section without any word of the second axis.

    A post that leaves out the second axis makes a line of a contour: the tool goes to and fro along X, through the
    center of the C axis, and no arc ends on its circle. The control stops with an alarm at the first of them. Have the
    post write the second axis; one finding stands for all that is wrong with the path.

    Source: B-62764EN/01, p. 51: the contour is programmed with the linear axis and the rotary axis.

    Bad:

        G98 G0 X60. C0
        G12.1              (expect: second-axis-never-programmed)
        G1 X40. F100
        G3 X20. I-20. J5.
        G1 X-20.
        G3 X-40. I10. J-5.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F100
        G3 I-20. J0
        G1 X50.
        G13.1
    """
    without = mode.nowhere_in_section(axes.programs_virtual_axis)[mode.sections.enter]
    no_circle = mode.count_in_section(arcs.is_no_circle) >= _SEVERAL
    across = mode.count_in_section(path.cuts & center.meets_center) >= _SEVERAL
    return without & (no_circle | across)


def details(hit: Hit, mode: PolarMode, arcs: Arcs) -> Details:
    off = int(mode.count_in_section(arcs.is_no_circle)[hit.index])
    through = f"through the center of the {hit.rotary} axis"
    return {"axis": hit.virtual, "what": f"and {off} arcs are no circles" if off > 1 else through}
