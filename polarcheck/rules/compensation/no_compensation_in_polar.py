from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask


@rule(
    NOTE,
    "this section cuts without G41 or G42, so that R of the tool offset cannot set the size of the part",
    over="sections",
    at=("on",),
    follows={"section": ("polar-switched-in-offset-mode",)},
    is_advice=True,
)
def no_compensation_in_polar(mode: PolarMode, path: ProgrammedPath, compensation: CutterCompensation) -> Mask:
    """
    Contour cut without cutter compensation.

    Where the program gives the path of the cutter center, a worn cutter or a part out of size means a new program: the
    X offset must not be used for it, since it turns the contour into another one. With G41 or G42, and R of the offset
    at 0 to begin with, the size is set by R.

    Source: builder's guide to G12.1, cutter compensation function and adjusting the part size.

    Bad, machine turning-center:

        G98 G0 X2.4 C0
        G12.1             (expect: no-compensation-in-polar)
        G1 C.4 F40.
        X1.2 F5.
        C-.4
        X2.4
        G13.1

    Good, machine turning-center:

        G98 G0 X2.4 C0
        G12.1
        G1 C.4 F40.
        G41 X1.2 F5.
        C-.4
        G40 X2.4
        G13.1
    """
    without = mode.anywhere_in_section(path.cuts) & mode.nowhere_in_section(compensation.compensates)
    return without[mode.sections.enter]
