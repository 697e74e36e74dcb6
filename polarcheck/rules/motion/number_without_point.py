from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.unpointed import Unpointed


@rule(
    WARNING,
    "{text} has no decimal point: the control takes it as {taken_as}",
    values={"word": "text", "count": "unpointed_count"},
    worse=("count",),
    over="words",
    doubts=(("metal", "loop"),),
    follows={"block": ("too-many-digits", "stray-character", "bad-number")},
)
def number_without_point(unpointed: Unpointed) -> Hits:
    """
    Length without a decimal point.

    A number without a point counts least increments: C20 is 0.020 mm, in inch 0.0020 inch. With parameter 3401#0
    DPI = 1 it is 20 mm instead, so that one program cuts two shapes on two lathes. Write the point. Before G12.1 the
    blocks that position X and C are looked at, elsewhere numbers of 1000 or more. A section with more such numbers than
    others is reported once, and a number of 1000 or more in it.

    What is meant is taken from the program. Most are written with points: there C20 is judged as 20 mm, and only a
    number of 1000 or more as the control takes it, since no lathe moves a meter. A program that writes most of its
    coordinates without a point, throughout or in the mode, and most of those as 1000 or more, is written in least
    increments: all of them are judged so, and a note says it once in the program.

    Source: FANUC B-62754EN/01, decimal point programming; parameters 3401#0 and 1403#0.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20               (expect: number-without-point)
        X-40.
        G13.1

    Bad:

        G98 G0 X60 C0     (expect: number-without-point)
        G12.1
        G1 X40 C10 F200
        X-40
        X60.
        G13.1

    Bad:

        G20 G98 G0 X2.5 C0
        G12.1
        G1 X1.5 F8        (expect: number-without-point)
        C.5
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.
        Z1000             (expect: number-without-point)
        X-40.
        G13.1

    Bad:

        G98 G0 X60000 C0  (expect: number-without-point)
        G12.1
        G1 X40000 F200
        C20000
        C-500
        X-40000
        G13.1

    Bad:

        G10 P1 R4         (expect: number-without-point)
        T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.
        G13.1

    Good:

        G10 P1 R4.
        T0101
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C20.
        X-40.
        G13.1

    Good, set control.number_without_point="whole-unit":

        G98 G0 X60 C0
        G12.1
        G1 X40 F200
        C20
        G13.1
    """
    return graded(warning=unpointed.slips > 0, note=unpointed.in_increments > 0)
