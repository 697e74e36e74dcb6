from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.coverage import Coverage
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{left}",
    values=("height", "radius", "plane_x", "plane_c"),
    worse=("height",),
    once="loop",
    follows={"twin": ("passes-differ",)},
)
def material_left(coverage: Coverage) -> Hits:
    """
    Material that no tool takes off, though the contour asks for it.

    In offset mode the tool stops R before the corner between a lead and the contour. Where it comes to the contour and
    leaves it in such leads, a rib stays on the part, unless the contour goes on beyond its start: by 2R and more if
    both leads are perpendicular to it. Or come and leave on arcs that are tangent to the contour, or ramp directly onto
    it. Between passes that are farther apart than 2R a ring or strip stays. What other tools take off at this Z or
    deeper is not left; grooves and islands wider than R are taken as meant, and so are inside corners of the part,
    where no cutter of that radius reaches more.

    Source: FANUC B-63944EN-1, p. 216 (the tool stops at the intersection on the inner side of a corner).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C-4. F500
        G42 X60. C0 F200
        X40.
        C20.
        X-40.
        C-20.
        X40.
        C1.               (expect: material-left)
        X60.
        G40 X80. C5.
        G13.1

    Good, tool 1:radius=3:

        T0101
        G98 G0 X100. C0
        G12.1
        G1 C-4. F500
        G42 X60. C0 F200
        X40.
        C20.
        X-40.
        C-20.
        X40.
        C6.
        X60.
        G40 X80. C10.
        G13.1
    """
    return Hits(coverage.height > 0, worst=coverage.height)


def details(hit: Hit, coverage: Coverage) -> Details:
    row, ribs, strips = hit.row, coverage.ribs, coverage.strips
    is_strip = strips.height[row] > ribs.height[row]
    radius, place = abs(hit.trace.compensation.radius_of_move[row]), complex((strips if is_strip else ribs).place[row])
    return {
        "height": max(ribs.height[row], strips.height[row]),
        "radius": radius,
        "plane_x": place.real,
        "plane_c": place.imag,
        "left": (_strip if is_strip else _rib)(hit, coverage, radius, hit.point(place)),
    }


def _strip(hit: Hit, coverage: Coverage, radius: float, point: str) -> str:
    """What is left standing between passes, and what to write."""
    thickness = coverage.strips.height[hit.row]
    return (
        f"a strip {hit.length(thickness)} thick stays at {point} between passes {hit.length(2 * radius + thickness)} "
        f"apart: with R {hit.length(radius)} write passes that are {hit.length(2 * radius)} apart at most"
    )


def _rib(hit: Hit, coverage: Coverage, radius: float, point: str) -> str:
    """What is left standing on the contour, and what to write."""
    height, width = coverage.ribs.height[hit.row], coverage.ribs.width[hit.row]
    more = "more than " if height >= 2 * radius else ""
    return (
        f"a rib {more}{hit.length(height)} high stays on the contour at {point}, "
        f"where no tool touches it: let the contour go on {hit.length(width)} farther beyond its start before the tool "
        "leaves it"
    )
