from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.pass_depths import PassDepths
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the pass at Z{depth} {out_of_step}",
    values=("z", "z_needed"),
    worse=("z:z_needed",),
    follows={"section": ("cut-in-air",)},
)
def pass_depth_differs(pass_depths: PassDepths) -> Mask:
    """
    One pass of a contour far off the steps of the others.

    A contour is milled in several passes, each deeper than the last by the same step, and one of them is several steps
    deeper or out of order: a digit or the point of its Z is wrong. The cutter takes the whole depth at once, or the
    passes behind it take nothing. At least three passes of the same contour must show the step; of two, their digits.

    A pass is reported, too, that goes far below what the program turns, or to where the bar is wider, in one step that
    is several times as deep as the cutter is wide, if its Z with the point a digit to the left lies in what is turned.

    Source: builder's guide to G12.1, order of a section.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-2.
        G42 X20. C0 F200
        G3 I-10.
        G1 G40 X60.
        Z-40.             (expect: pass-depth-differs)
        G42 X20. C0
        G3 I-10.
        G1 G40 X60.
        Z-6.
        G42 X20. C0
        G3 I-10.
        G1 G40 X60.
        Z-8.
        G42 X20. C0
        G3 I-10.
        G1 G40 X60.
        Z2.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-2.
        G42 X20. C0 F200
        G3 I-10.
        G1 G40 X60.
        Z-4.
        G42 X20. C0
        G3 I-10.
        G1 G40 X60.
        Z-5.5
        G42 X20. C0
        G3 I-10.
        G1 G40 X60.
        Z2.
        G13.1
    """
    # Compares nothing: the passes of a contour have to be read together.
    return pass_depths.is_off


def details(hit: Hit, pass_depths: PassDepths) -> Details:
    import numpy as np

    from polarcheck.columns.words.slips import plain_number

    z, needed = hit.trace.path.z[hit.row], pass_depths.expected[hit.row]
    if pass_depths.is_beyond_turning[hit.row]:
        turned = hit.number(needed)
        out_of_step = f"goes in one step far below what is turned, which ends at Z{turned}: look at its digits"
    elif np.isnan(needed):
        out_of_step = "is out of step with the others of its contour: one of them has a wrong Z"
    else:
        # To be written, so with a point: without one some controls read an increment.
        in_step = plain_number(needed / float(hit.trace.lengths.scale[hit.row]))
        out_of_step = f"is out of step with the others of its contour: Z{in_step} would fit"
    return {"z": z, "z_needed": needed, "depth": hit.number(z), "out_of_step": out_of_step}
