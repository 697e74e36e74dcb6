from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.misplaced_ramps import MisplacedRamps
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{code} begins late: {block_before} cuts the contour without compensation, with the cutter center on the "
    "programmed path, {wrong_by}; {where_to_begin}",
    values=("code", "radius", "other_line"),
    worse=("radius",),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    once="section",
    subject="",
    doubts=(("compensation", "section"), ("metal", "section"), ("offset", "section")),
)
def start_up_after_contour(path: ProgrammedPath, misplaced_ramps: MisplacedRamps) -> Mask:
    """
    G41 or G42 one or more blocks late.

    G41 and G42 belong in the move that leads to the contour. One block later that move has run without them, the cutter
    stands with its center on the contour and is R deep in the part, and the first side of the contour serves as the
    ramp. It shows where the contour ends at a point that a block before G41 or G42 has reached, or where the block
    before them is the mirror image of the way out.

    Source: builder's guide to G12.1, cutter compensation (ramp on with the move onto the part).

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-5.
        X40. F200
        C20.
        G42 X-40.         (expect: start-up-after-contour)
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
    # A start-up on an arc has a rule of its own.
    return (misplaced_ramps.begun_without >= 0) & ~path.is_arc


def details(hit: Hit, offsets: ToolOffsets, misplaced_ramps: MisplacedRamps) -> Details:
    from polarcheck.rules.wording.ramps import ramp_at_rest, wrong_by
    from polarcheck.rules.wording.written import block_and_line

    begun = int(misplaced_ramps.begun_without[hit.row])
    at_rest = ramp_at_rest(hit).removeprefix("; ")
    return {
        "code": hit.side,
        "radius": abs(offsets.radius_of_offset[hit.row]),
        "other_line": hit.line(begun),
        "block_before": block_and_line(hit.trace, begun),
        "wrong_by": wrong_by(hit),
        "where_to_begin": f"{at_rest}: begin outside the contour"
        if at_rest
        else f"write {hit.side} into the block that leads to the contour",
    }
