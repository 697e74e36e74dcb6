from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import FAULTS_OF_CONTOUR, FAULTS_OF_METAL
from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.foundation.arrays import Mask
    from polarcheck.parts.deviations import Deviations
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.rule import Needs


@rule(
    ERROR,
    "the part differs from {drawing} by {largest:length/tolerance}, {tolerance:length} is allowed: {deviation}",
    values=("drawing", "largest", "tolerance", "too_much", "cut_away"),
    worse=("largest", "too_much", "cut_away"),
    gouges=True,
    follows={"file": (*FAULTS_OF_CONTOUR, *FAULTS_OF_METAL)},
)
def part_differs_from_drawing(deviations: Deviations) -> Mask:
    """
    Part that is not the one of the drawing.

    The machined part differs from the part of the job by more than the tolerance: 0.02 mm, unless the job or
    --tolerance gives another one. The drawing (--drawing, or drawing in a [[part]]) has its origin on the spindle axis,
    and its x runs towards C0 as a radius; a [[part]] may also give a shape with its dimensions. Contours in offset mode
    are measured to the drawing and back. Then the metal that the cutters clear, in all sections and at each depth, is
    compared with the part. Two things count: metal that should be gone and still stands, as a wall that is never
    milled, and metal that is cut away where the part must stand. C at G12.1 is added to each section. The finding names
    the block nearest to the largest difference. It also says if the part would fit turned, mirrored, shifted, in other
    units, or with X as a diameter. Correct the coordinates, or the drawing.

    Source: B-62764EN/01, p. 51-53 (X as a diameter, C as a length, and C0 where the mode begins).

    Bad, tool 1:radius=3, set job.part=[{shape = "square", across_flats = 40.0}]:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C-4. F500
        G42 X40. C0 F200
        C20.
        X-40.1
        C-20.             (expect: part-differs-from-drawing)
        X40.
        C0
        G40 X80. C5.
        G13.1

    Bad, tool 1:radius=4, set job.part=[{shape = "flats", across_flats = 24.0, diameter = 30.0, turned = 0.0}]:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 C-25. F500
        G42 X24. C-20. F200
        C20.
        G40 X60. C25.
        G13.1
        G0 C170.
        G12.1
        G1 C-25. F500
        G42 X24. C-20. F200
        C20.              (expect: part-differs-from-drawing)
        G40 X60. C25.
        G13.1

    Good, tool 1:radius=3, set job.part=[{shape = "square", across_flats = 40.0}]:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C-4. F500
        G42 X40. C0 F200
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X80. C5.
        G13.1
    """
    # Compares nothing: each part has its own tolerance, and a pocket in the place of a boss differs by no length.
    return deviations.differs


def details(hit: Hit, deviations: Deviations) -> Details:
    from polarcheck.rules.wording.drawing import deviation
    from polarcheck.rules.wording.written import short

    result = deviations.of_row(hit.row)
    is_compared = result.is_made and not result.is_other_way_round
    return {
        "drawing": short(result.title),
        "largest": deviations.largest[hit.row],
        "tolerance": deviations.tolerance[hit.row],
        "too_much": result.difference.proud if is_compared else None,
        "cut_away": result.difference.deep if is_compared else None,
        "deviation": deviation(deviations.trace, result),
    }


def needs(compensation: CutterCompensation, deviations: Deviations) -> Needs:
    return deviations.where, {"radius": compensation.radius}
