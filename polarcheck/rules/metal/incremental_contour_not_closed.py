from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import OUT_OF_PLACE
from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.path.increments import Increments
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the increments of this contour do not add up: it ends {gap:length} beside its start, {drift}",
    values=("gap", "plane_x", "plane_c"),
    worse=("gap",),
    once="loop",
    subject="outline",
    doubts=(("compensation", "loop"),),
    follows={"loop": OUT_OF_PLACE},
)
def incremental_contour_not_closed(increments: Increments) -> Hits:
    """
    Contour in increments that ends beside its start.

    Increments, by U and H or with G91, add up. A wrong digit in one of them shifts all that follows, and the contour
    ends a little off the point where it began. Reported is a gap that is more than the rounding of all its words, and
    less than a tenth of the contour; a contour that runs on over its start is closed.

    Source: B-62764EN/01, p. 53 (a contour that ends where it begins); p. 51 (U and H are increments).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        H20.
        U-80.
        H-40.
        U79.
        H20.               (expect: incremental-contour-not-closed)
        G40 X100.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 G42 X40. F200
        H20.
        U-80.
        H-40.
        U80.
        H24.
        G40 X100. H2.
        G13.1
    """
    return Hits(increments.gap > 0, worst=increments.gap)


def details(hit: Hit, increments: Increments) -> Details:
    begins = complex(increments.begins[hit.row])
    return {
        "gap": increments.gap[hit.row],
        "plane_x": begins.real,
        "plane_c": begins.imag,
        "drift": f"which is {hit.point_off_center(begins)}",
    }
