from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.words.angles import Angles
    from polarcheck.rules.hit import Details, Hit

#: A length that many times as far out as the rest of the section is taken for an angle, and with G0 beside it.
_FAR, _FAR_IN_RAPID = 2.0, 1.5


@rule(
    WARNING,
    "{word} {begins} a length of {farthest:length} in the polar mode and looks like an angle: the rest of the "
    "section lies within {reach:length} of the center; write the point of the contour",
    values=("word", "farthest", "reach"),
    worse=("farthest",),
    once="section",
    doubts=(("position", "block"), ("position", "C before"), ("metal", "section")),
)
def degrees_in_polar(blocks: ExecutedBlocks, axes: PlaneAxes, angles: Angles) -> Hits:
    """
    Angle written where the polar mode takes a length.

    In the mode C is no angle but a coordinate of the face, in mm or inch like X. C180. does not turn the part by half a
    turn: it sends the tool 180 mm away from the center. Write the point on the contour, half as large as a diameter, or
    turn C before G12.1. Suspected are 30, 45, 60, 90 and other usual angles more than twice as far out as anything else
    in the section, half as far with G0 beside them, unless the same length stands there with both signs, and C that
    goes from 0 steadily to 180, 270 or 360 as far out while X stays where it is; so is C that rises or falls by half a
    turn or more while X is that of one circle at these angles. A G0 C60. behind G12.1 is the
    positioning of an approach: write it before G12.1, where C is an angle.

    Source: FANUC B-62764EN/01, p. 51; builder's guide to G12.1, layout of the plane.

    Bad:

        G98 G0 X40. C0
        G12.1
        G1 X25. F200
        C-180.            (expect: degrees-in-polar)
        X40.
        G13.1

    Bad:

        G98 G0 X30. C0
        G12.1
        G1 X20. F200
        C90.              (expect: degrees-in-polar)
        C180.
        C270.
        C360.
        G13.1

    Bad:

        G98 G0 X50. C0
        G12.1
        G1 X40. F200
        C72.              (expect: degrees-in-polar)
        C144.
        C216.
        C288.
        C360.
        X50.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X30. F200
        C36.              (expect: degrees-in-polar)
        X-11.459 C108.
        X-37.082 C180.
        X-11.459 C252.
        X30. C324.
        G13.1

    Bad:

        G98 G0 X60. Z2. C0
        G12.1
        G0 C120.          (expect: degrees-in-polar)
        G1 Z-5. F200
        X30.
        X60.
        G0 C240.
        G1 X30.
        X60.
        G13.1

    Good:

        G98 G0 X120. C-60.
        G12.1
        G1 X100. F200
        C-40.
        C-20.
        C0
        C20.
        C40.
        C60.
        X120.
        G13.1

    Good:

        G98 G0 X150. C0
        G12.1
        G1 X80. F200
        C30.
        X150.
        G13.1
        G0 C180.
        G12.1
        G1 X8. F200
        C45.
        C-45.
        X150.
        G13.1
    """
    is_angle = angles.in_series | angles.beside_points | (angles.is_usual & ~angles.has_both_signs)
    far_out = (angles.reach > 0) & (angles.farthest > _FAR * angles.reach)
    far_out |= angles.is_positioning & (angles.reach > 0) & (angles.farthest > _FAR_IN_RAPID * angles.reach)
    in_stock = angles.farthest <= angles.trace.lengths.stock_diameter / 2
    words = blocks.words_at(axes.followed_virtual_words)
    return Hits(is_angle & far_out & ~in_stock & ~angles.in_misplaced_cycle, at=words)


def details(hit: Hit, angles: Angles) -> Details:
    begins, series = "is", angles.series
    if angles.in_series[hit.row]:
        count, on_circle = (
            int(series.in_rows(column.astype(float), len(angles.trace))[hit.row])
            for column in (series.count, series.on_circle)
        )
        steps = "on a circle, were C an angle, with" if on_circle else "at nearly the same X to"
        begins = f"is one of {count} steps {steps}"
    return {"farthest": angles.farthest[hit.row], "reach": angles.reach[hit.row], "begins": begins}
