from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.uncompensated_cuts import UncompensatedCuts


@rule(
    ERROR,
    "{bare}{from_point} {goes} {cut_part}; {way_round}",
    values={
        "depth": "uncompensated_cuts.depth",
        "plane_x": "place_of_cut.real",
        "plane_c": "place_of_cut.imag",
        "z": "path.z",
        "other_line": "line_of_cut",
    },
    worse=("depth",),
    gouges=True,
    worst="uncompensated_cuts.graveness",
    once="loop",
    follows={
        "motion": ("rapid-in-polar",),
        "loop": ("x-not-positive-at-entry",),
        "section": ("start-up-on-arc", "nearly-regular-contour", "no-offset-intersection"),
        "tool call": ("rapid-plunge-into-stock",),
    },
)
def uncompensated_cut_into_part(uncompensated_cuts: UncompensatedCuts) -> Hits:
    """
    Move without compensation through the finished part.

    A contour is milled with G41 or G42, and a move with G40 in the same section leads through what it leaves, or nearer
    to it than R: on the way to the next contour, back to the start, or out after G13.1. It counts at the Z of the
    contour and deeper; above that it is a slot or a facing pass. In rapid traverse it is an error. At feed it is a
    warning, since a slot may be milled without compensation on purpose: mill it in a section of its own, or allow it.

    Source: builder's guide to G12.1 (approach and retract outside the part); FANUC B-63664EN, p. 170 (what the path
    of the tool center is without compensation).

    Bad, tool 1:radius=5:

        T0101
        G98 G0 X80. Z2. C0
        G12.1
        G1 X80. C5. F500
        Z-3.
        G42 X40. C0. F200
        X20. C17.32
        X-20.
        X-40. C0.
        X-20. C-17.32
        X20.
        X40. C0.
        G40 X80. C5.
        X-80.             (expect: uncompensated-cut-into-part)
        G13.1

    Bad, tool 1:radius=5:

        T0101
        G98 G0 X80. Z2. C0
        G12.1
        G1 X80. C5. F500
        Z-3.
        G42 X40. C0. F200
        X20. C17.32
        X-20.
        X-40. C0.
        X-20. C-17.32
        X20.
        X40. C0.
        G40 X80. C5.
        G13.1
        G0 X0.            (expect: uncompensated-cut-into-part)

    Good, tool 1:radius=5:

        T0101
        G98 G0 X80. Z2. C0
        G12.1
        G1 X80. C5. F500
        Z-3.
        G42 X40. C0. F200
        X20. C17.32
        X-20.
        X-40. C0.
        X-20. C-17.32
        X20.
        X40. C0.
        G40 X80. C5.
        Z2. F1000
        X-80.
        G13.1
    """
    cuts = uncompensated_cuts.depth > 0
    return graded(error=uncompensated_cuts.is_rapid, warning=cuts)
