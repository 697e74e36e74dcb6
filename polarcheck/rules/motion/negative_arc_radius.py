from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.tangency import Tangency
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "negative radius of an arc: more than 180 deg, or an alarm",
    at=("R",),
    subject="arc",
    follows={"block": ("arc-sweep-above-limit",)},
    doubts=(("compensation", "loop"),),
    gouges=True,
)
def negative_arc_radius(arcs: Arcs, tangency: Tangency) -> Mask:
    """
    Arc with a negative R.

    Where the control takes it, a negative R means the longer of the two arcs, of more than 180 degrees. Older lathe
    controls stop with an alarm. Two arcs of less than 180 degrees, or I and J, are understood by all. Where the control
    takes it and the arc is tangent to the blocks on both sides, or about the center of C, the longer one is meant, and
    nothing is reported.

    Source: FANUC alarm 023; B-62754EN/01, p. 67.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. R-10.  (expect: negative-arc-radius)
        G1 X60.
        G13.1

    Bad, machine fanuc-16i:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G2 X20. C20. R-15.  (expect: negative-arc-radius)
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. C10. F200
        G3 X20. C20. I0. J10.
        G1 X60.
        G13.1

    Good, tool 1:radius=4, machine gsk-988:

        T0101
        G98 G0 X70. C0
        G12.1
        G1 G42 X30.6 F200
        C11.265
        G3 X30.6 C-11.265 R-19.
        G1 C0
        G40 X70.
        G13.1
    """
    negative = (arcs.radius < 0) & ~arcs.is_larger_by_word & ~arcs.is_about_center
    return arcs.negative_stops | (negative & ~tangency.is_tangent & ~tangency.misfits)
