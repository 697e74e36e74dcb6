from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{word} in rapid traverse outside the polar mode goes across the center, to {x:diameter} in X, the other "
    "side of the spindle; write an X above 0",
    values=("word", "x"),
    gouges=True,
    at=("X", "U"),
    follows={"block": ("travel-limit",)},
)
def rapid_through_center(
    blocks: ExecutedBlocks, axes: PlaneAxes, mode: PolarMode, path: ProgrammedPath, entry: Entry
) -> Mask:
    """
    Rapid traverse to X below 0 after the polar mode.

    In the mode X below 0 is a point of the face, to which C turns the part. After G13.1 it is a place of the machine
    axis on the other side of the center, and many lathes do not travel so far: the tool goes through the part, or the
    control stops at the travel limit. Where the mode ended with X below 0 the machine stands at X above 0. X0, where a
    drill begins, is not meant; nor is what comes after the next tool change.

    Source: FANUC B-62764EN/01, p. 51, X of the machine is never negative in the mode.

    Bad:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C10.
        X-60.
        G13.1
        G0 X-60.          (expect: rapid-through-center)
        Z50.

    Good:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C10.
        X-60.
        G13.1
        G0 X60.
        X0
        T0202
        G0 X-1.

    Good:

        G98 G0 X60. Z2. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        G1 X-1. F100
    """
    is_rapid = (axes.motion == Motion.RAPID) & blocks.has("X", "U") & ~mode.in_polar
    return entry.after_section & is_rapid & (path.x < -ROUNDING) & ~(path.x_before < -ROUNDING)


def details(hit: Hit, path: ProgrammedPath) -> Details:
    return {"x": path.x[hit.row]}
