from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.coverage import Coverage
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "the contour ends at {end}, {gap:length} before it is closed: write {start} here, or "
    "{end} in line {other_line}, where it begins",
    values=("gap", "plane_x", "plane_c", "other_line"),
    worse=("gap",),
    once="loop",
    subject="compensation",
    doubts=(("metal", "loop"),),
)
def contour_not_closed(coverage: Coverage) -> Hits:
    """
    Contour that comes back to its start but for a gap.

    The contour goes all round and ends before the point at which it began, nearer than the diameter of the cutter. No
    tool goes through such a gap on purpose: a coordinate is wrong, or the last block is missing. How much material
    stays there depends on the leads. End the contour where it began, or beyond.

    Source: B-62764EN/01, p. 53 (a contour that ends where it begins).

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
        C-1.              (expect: contour-not-closed)
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
    return Hits(coverage.gap > 0, worst=coverage.gap)


def details(hit: Hit, coverage: Coverage) -> Details:
    import numpy as np

    path, first = hit.trace.path, int(coverage.begins_in[hit.row])
    before = np.flatnonzero(path.travels[:first])
    end = complex(path.end[hit.row])
    return {
        "gap": coverage.gap[hit.row],
        "plane_x": end.real,
        "plane_c": end.imag,
        "other_line": hit.line(before[-1] if len(before) else first),
        "end": hit.point(end),
        "start": hit.point(complex(coverage.begins[hit.row])),
    }
