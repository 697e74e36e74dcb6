from __future__ import annotations

from polarcheck.checking.causes import FAULTS_OF_CONTOUR, FAULTS_OF_METAL
from polarcheck.checking.rule import ERROR, Deviations, Mask, rule


@rule(
    ERROR,
    "the part differs from {drawing} by {deviations.largest:length/deviations.tolerance}, "
    "{deviations.tolerance:length} is allowed: {deviation}",
    needs=("compensation.radius",),
    where="deviations.asked",
    follows={"file": (*FAULTS_OF_CONTOUR, *FAULTS_OF_METAL)},
)
def part_differs_from_drawing(deviations: Deviations) -> Mask:
    """
    Part that is not the one of the drawing.

    What the contours in offset mode leave standing differs from what the job asks for by more than its tolerance,
    0.02 mm unless that says another one. The drawing (--drawing, or drawing in a [[part]] of polarcheck.toml) has its
    origin on the spindle axis, and its x runs towards C0 as a radius; a [[part]] may also give a shape with its
    numbers. Deviations are measured from the part to the drawing and back. The block that is named is the one whose
    wall lies nearest to the largest of them. Where the part would fit if it were turned, mirrored, or had X as a
    diameter, that is said as well. Correct the coordinates, or the drawing.

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
    # Compares nothing: each part has a tolerance of its own, and a pocket in the place of a boss differs by no length.
    return deviations.differs
