from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.pass_ends import PassEnds
    from polarcheck.columns.metal.bar import Bar
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the pass begins outside the bar ({bar}) and ends inside it, at {end_of_pass}: metal stays beyond its end",
    values=("stock", "plane_x", "plane_c"),
    subject="metal",
    once="section",
    is_symptom=True,
)
def pass_ends_inside_bar(pass_ends: PassEnds) -> Mask:
    """
    Pass that ends inside the bar.

    A flat or a slot that is open to the side is cut from outside the bar, ends in the middle of it, and the next move
    leads the tool out another way. What the wall would go on beside stays: the last coordinate is too short, or that of
    another block. The bar is that of `[stock]`, or what the program itself turns, or what a comment says.

    Source: builder's guide to G12.1, approach and retract outside the part.

    Bad, tool 1:radius=4, set job.stock.diameter=40:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. C28. F1500
        Z-5.
        G41 X20. C28. F200
        C-2.              (expect: pass-ends-inside-bar)
        G40 X60. F1500
        Z2.
        G13.1

    Good, tool 1:radius=4, set job.stock.diameter=40:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. C28. F1500
        Z-5.
        G41 X20. C28. F200
        C-28.
        G40 X60. F1500
        Z2.
        G13.1
    """
    # Compares nothing: begin and end of a pass have to be read together.
    return pass_ends.leaves_metal


def details(hit: Hit, bar: Bar) -> Details:
    from polarcheck.rules.wording.metal import bar_diameter, bar_in_words

    end, height = complex(hit.trace.path.end[hit.row]), float(bar.trace.path.z[hit.row])
    return {
        "stock": bar_diameter(hit, bar, height),
        "plane_x": end.real,
        "plane_c": end.imag,
        "bar": bar_in_words(hit, bar, height),
        "end_of_pass": hit.point_off_center(end),
    }
