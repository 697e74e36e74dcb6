from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import OUT_OF_PLACE
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.contour_depths import ContourDepths
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "Z goes from {z_before:length} to {z:length} in the middle of a closed contour: one part of it is cut at "
    "another depth than the rest",
    values=("z", "z_before"),
    worse=("z:z_before",),
    at=("Z", "W"),
    once="compensation",
    subject="side",
    doubts=(("compensation", "loop"),),
    follows={"block": ("z-with-plane-axis", "helical-arc-in-polar"), "loop": OUT_OF_PLACE},
    is_symptom=True,
)
def contour_at_two_depths(contour_depths: ContourDepths) -> Mask:
    """
    Z move in the middle of a closed contour.

    One part of the contour is cut at one depth and the rest at another, so that the part has a step in its wall: the Z
    block stands too late, or too early. Not reported are passes that close their contour at each depth, a ramp that
    goes down along the contour, one along its first or last block, and a hop over what stands in the way.

    Source: B-62764EN/01, p. 53 (depth first, then the contour).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. Z2. C0
        G12.1
        G1 G42 X40. F200
        C20.
        X-40.
        Z-5.               (expect: contour-at-two-depths)
        C-20.
        X40.
        C0
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. Z2. C0
        G12.1
        G1 Z-5. F200
        G42 X40.
        C20.
        X-40.
        C-20.
        X40.
        C0
        Z-10.
        C20.
        X-40.
        C-20.
        X40.
        C0
        G40 X100.
        G13.1
    """
    # Compares nothing: the table compares Z along each contour, where it closes only with all of its passes.
    return contour_depths.changes


def details(hit: Hit, path: ProgrammedPath) -> Details:
    return {"z": path.z[hit.row], "z_before": path.z_before[hit.row]}
