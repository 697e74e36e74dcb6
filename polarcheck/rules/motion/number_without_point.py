from __future__ import annotations

from polarcheck.checking.rule import WARNING, Increments, Mask, rule


@rule(WARNING, "{text} has no decimal point: the control takes it as {taken_as}", over="words")
def number_without_point(increments: Increments) -> Mask:
    """
    Length without a decimal point.

    A number without a point counts least increments: C20 is 0.020 mm, in inch 0.0020 inch. With parameter 3401#0
    DPI = 1 it is 20 mm instead, so that one program cuts two shapes on two lathes. Write the point. Before G12.1 the
    blocks that position X and C are looked at. A program that is written in least increments throughout is not
    reported, and a section with more such numbers than others is once.

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

    Good:

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
    return increments.without_point > 0
