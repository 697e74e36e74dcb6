from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.misplaced_ramps import MisplacedRamps
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the start-up ends at {ramp_end}, and the contour at {contour_end}: with {x_meant} here, or {x_of_ramp} in "
    "line {other_line}, the contour would be closed; as it stands the ramp {leads_where}",
    values=("plane_x", "plane_c", "x_needed", "other_line"),
    gouges=True,
    at=("X", "U"),
    is_symptom=True,
    once="loop",
    subject="",
    follows={"loop": ("bad-number",)},
    doubts=(("position", "X"), ("position", "X before"), ("compensation", "loop"), ("metal", "loop")),
)
def start_up_off_contour(misplaced_ramps: MisplacedRamps) -> Mask:
    """
    Start-up that ends at another X than the contour.

    The ramp ends where the contour begins. With a slip in its X, as a radius in place of the diameter, the ramp goes
    through the part, or stops short of it, and the contour begins somewhere else than it ends. It is reported where the
    contour would be closed with the X that it ends with, and the way out leads back to where the ramp began: X is half
    or twice as large, or the contour goes round the center and overlaps at neither end.

    Source: builder's guide to G12.1, layout of the plane (X on diameter).

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-5.
        G42 X20. F200     (expect: start-up-off-contour)
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X60. F1500
        Z2.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-5.
        G42 X40. F200
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X60. F1500
        Z2.
        G13.1
    """
    # NaN where a start-up ends on its contour.
    return misplaced_ramps.x_of_contour == misplaced_ramps.x_of_contour


def details(hit: Hit, path: ProgrammedPath, misplaced_ramps: MisplacedRamps) -> Details:
    import numpy as np

    from polarcheck.rules.wording.ramps import next_row

    end, x = complex(path.end[hit.row]), float(misplaced_ramps.x_of_contour[hit.row])
    cancel = next_row(hit.trace.compensation.cancels, hit.row)
    writes = np.flatnonzero(hit.trace.blocks.has("X", "U")[:cancel])
    begins, ends, meant = abs(path.start[hit.row].real), abs(end.real), abs(x)
    goes_past = (ends - meant) * (meant - begins) > 0
    return {
        "plane_x": end.real,
        "plane_c": end.imag,
        "x_needed": x,
        "other_line": hit.line(int(writes[-1]) if len(writes) else hit.row),
        "ramp_end": hit.point(end),
        "contour_end": hit.point(complex(x, end.imag)),
        "x_meant": hit.point(complex(x, 0.0)).split()[0],
        "x_of_ramp": hit.point(complex(end.real, 0.0)).split()[0],
        "leads_where": "leads through what the contour keeps" if goes_past else "ends before the contour",
    }
