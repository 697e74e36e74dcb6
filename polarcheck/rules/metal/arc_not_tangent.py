from __future__ import annotations

import math
from typing import TYPE_CHECKING

from polarcheck.foundation.states import Units
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.tangency import Tangency
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit

#: Numbers that differ by less are one [mm].
_SAME_NUMBER = 1e-6


@rule(
    WARNING,
    "{word} turns a corner of {corner:whole} deg at an end of the arc; {word_needed} would {fit}{likewise}",
    values=("corner", "arc_radius", "arc_radius_needed", "word", "word_needed"),
    worse=("corner",),
    at=("R", "I", "J"),
    once="misfit",
    subject="side",
    doubts=(("compensation", "loop"), ("move", "loop"), ("metal", "section")),
    follows={"block": ("arc-sweep-above-limit",)},
    is_symptom=True,
)
def arc_not_tangent(tangency: Tangency, arcs: Arcs) -> Mask:
    """
    Arc of a contour that is not tangent where the others are.

    An arc between two blocks rounds the corner between them if it is tangent to both. With another R, another center or
    the other sign of R it still ends where it should, and no control objects: the part has a corner at either end of
    the arc. It is reported where one word explains it: the other arcs of the contour are tangent, or all arcs have
    twice the R that would be, and with the R that is named this one is tangent, too; so is an arc that leads to or from
    the contour and would be tangent to it with the R of another lead that is. Arcs about the center of C, as
    those of a bar with flats, and contours whose corners are meant are not concerned.

    Source: FANUC B-62754EN/01, p. 67 (R of an arc).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C16.
        G3 X32. C20. R4.
        G1 X-32.
        G3 X-40. C16. R8.   (expect: arc-not-tangent)
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X32. F200
        X12.5 C7.806
        G3 X12.5 C-7.806 R10.   (expect: arc-not-tangent)
        G1 X32. C0
        G40 X100.
        G13.1

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 X70. C-6. F200
        G42 X52.
        G2 X40. C0 R6.
        G1 C20.
        X-40.
        C-20.
        X40.
        C0
        G2 X52. C6. R9.     (expect: arc-not-tangent)
        G1 G40 X70.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        C16.
        G3 X32. C20. R4.
        G1 X-32.
        G3 X-40. C16. R4.
        G1 C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X30. F200
        C13.229
        G3 X-30. C13.229 R20.
        G1 C-13.229
        G3 X30. C-13.229 R20.
        G1 C0
        G40 X100.
        G13.1
    """
    return tangency.misfits & ~arcs.negative_stops


def details(hit: Hit, arcs: Arcs, tangency: Tangency) -> Details:
    from polarcheck.rules.wording.arcs import written_arc

    by_radius = arcs.by_radius[hit.row]
    return {
        "corner": tangency.corner[hit.row],
        "arc_radius": arcs.radius[hit.row] if by_radius else None,
        "arc_radius_needed": abs(tangency.radius_needed[hit.row]) if by_radius else None,
        "word": written_arc(hit.trace, arcs, hit.row),
        "word_needed": _needed(hit, by_radius, arcs, tangency),
        "fit": _fit(hit.row, tangency),
        "likewise": hit.likewise(tangency.alike(hit.row)) if by_radius else "",
    }


def _fit(row: int, tangency: Tangency) -> str:
    """What an arc would do with the words that are named."""
    if tangency.on_circle[row]:
        return "lie on one circle with the other arcs"
    if tangency.of_leads[row]:
        return "be tangent to the contour, as another lead is"
    return "be tangent to the blocks before and after it"


def _needed(hit: Hit, by_radius: bool, arcs: Arcs, tangency: Tangency) -> str:
    """The words with which the arc would be tangent to the blocks before and after it."""
    from polarcheck.rules.wording.arcs import radius_word

    trace, row = hit.trace, hit.row
    inch = bool(trace.lengths.units[row] == Units.INCH)
    scale, near = float(trace.lengths.scale[row]), float(tangency.radius_tolerance[row])
    if by_radius:
        needed = float(tangency.radius_needed[row])
        # The R of another arc is meant, with all its digits.
        others = arcs.radius[arcs.by_radius & (abs(abs(arcs.radius) - abs(needed)) <= near)]
        if len(others):
            needed, near = math.copysign(float(others[0]), needed), _SAME_NUMBER
        return radius_word(trace.machine) + _plain(needed / scale, near / scale, inch)
    to_center = complex(tangency.center_needed[row] - trace.path.start[row])
    if trace.path.frames is not None:
        to_center /= complex(trace.path.frames.turn[row])
    values = (_plain(value / scale, near / scale, inch) for value in (to_center.real, to_center.imag))
    return " ".join(word + value for word, value in zip(trace.axes.center_words(row), values, strict=True))


def _plain(value: float, near: float, inch: bool) -> str:
    """A number as a program writes it, with as few digits as it has within a tolerance, and a point."""
    most = 4 if inch else 3
    digits = next((count for count in range(most) if abs(round(value, count) - value) <= near), most)
    text = f"{value:.{digits}f}" + "." * (digits == 0)
    return "0." if text.strip("-0.") == "" else text
