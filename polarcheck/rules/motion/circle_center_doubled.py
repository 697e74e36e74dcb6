from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import NO_SUCH_ARC
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.full_circles import FullCircles
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "full circle with {arc} around {written_center}; with {word_needed} it is a circle around {intended_center}",
    values=("arc_radius", "arc_radius_needed", "word_needed", "other_line"),
    subject="shape",
    doubts=NO_SUCH_ARC,
    gouges=True,
)
def circle_center_doubled(full_circles: FullCircles) -> Mask:
    """
    I and J of a full circle twice, or half, as large as they were meant.

    A full circle ends where it begins whatever its I and J are, so that the control draws it without an alarm. I and J
    go from the start to the center and are radii, where X is a diameter: with I-34. from X34. the center is at X-34.,
    and the circle twice as large. It is reported where I and J of half, or twice, that size put the center on that of
    C, and the tool comes from inside the circle, or would go farther out than it has come from, or other circles are
    round the center of C; or to the point from which the tool comes and to which it goes back, as other circles of the
    tool have it. Where two others are as far from such a point, or one is and a slip of the pen explains I or J, they
    may be any others; so may they where two circles or more that begin at the same point at other depths are round
    another center.

    Source: FANUC B-62764EN/01, p. 51 (I and J in the polar plane).

    Bad, tool 1:radius=2.5:

        T0101
        G98 G0 X26. Z2. C0
        G12.1
        G1 X26. F500
        Z-4. F40
        G41 X34. F80
        G3 I-34.          (expect: circle-center-doubled)
        G1 G40 X26.
        Z2.
        G13.1

    Bad, tool 1:radius=2.5:

        T0101
        G98 G0 X40. Z2. C0
        G12.1
        G1 X40. F500
        Z-4. F40
        G41 X52. F80
        G3 I-6.
        G1 G40 X40.
        Z2. F500
        X0 C20.
        Z-4. F40
        G41 X12. F80
        G3 I-66.          (expect: circle-center-doubled)
        G1 G40 X0.
        Z2.
        G13.1

    Good, tool 1:radius=2.5:

        T0101
        G98 G0 X26. Z2. C0
        G12.1
        G1 X26. F500
        Z-4. F40
        G41 X34. F80
        G3 I-17.
        G1 G40 X26.
        Z2.
        G13.1
    """
    # Compares nothing: which center was meant is found from what stands round the circle.
    return full_circles.is_misplaced


def details(hit: Hit, arcs: Arcs, full_circles: FullCircles) -> Details:
    from polarcheck.rules.wording.arcs import written_arc

    path, row, intended = hit.trace.path, hit.row, full_circles.intended[hit.row]
    radius = abs(path.center[row] - path.start[row])
    words = [
        f"{address}{hit.number(value * intended.share)}"
        for address, value in zip(
            hit.trace.axes.center_words(row), (axis[row] for axis in path.written_to_center), strict=False
        )
        if abs(value) > 0
    ]
    like = f", as the circle of line {hit.line(intended.other)} is" if intended.other >= 0 else ""
    center = hit.point_off_center(intended.center) if intended.other >= 0 else "the center of C"
    return {
        "arc_radius": radius,
        "arc_radius_needed": radius * intended.share,
        "other_line": hit.line(intended.other) if intended.other >= 0 else None,
        "arc": written_arc(hit.trace, arcs, row),
        "written_center": hit.point_off_center(complex(path.center[row])),
        "word_needed": " ".join(words),
        "intended_center": f"{center}{like}",
    }
