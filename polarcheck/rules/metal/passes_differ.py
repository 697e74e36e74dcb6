from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import FAULTS_OF_CONTOUR
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.contour.pass_differences import PassDifferences
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "{pass_difference}; all else in this pass is as in {other_pass}",
    values={"difference": "distance_of_passes", "other_line": "line_of_other_pass"},
    worse=("difference",),
    subject="side",
    follows={"twin": FAULTS_OF_CONTOUR},
)
def passes_differ(pass_differences: PassDifferences) -> Mask:
    """
    Pass of a contour that differs from another pass of it in one block.

    The same contour is cut at several depths, or in several sections, and one word of one pass is another: a digit, a
    sign, a block that is missing. The wall has a step there. Of several passes the one that differs from the others is
    reported, of two the later one. Passes that differ as a whole, as with an allowance, are not compared, and a side
    that is moved on one level may be meant.

    Source: B-62764EN/01, p. 53 (a contour in several passes).

    Bad, tool 1:radius=3:

        T0101
        G98 G0 X100. Z2. C0
        G12.1
        G1 Z-5. F200
        G42 X40.
        C9.
        X12. C22.
        X-34. C14.
        X-28. C-11.
        X10. C-19.
        X40. C-8.
        C0
        G40 X100.
        Z-10.
        G42 X40.
        C9.
        X12. C22.
        X-34. C14.
        X-28. C-11.
        X10. C-16.         (expect: passes-differ)
        X40. C-8.
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
        G40 X100.
        Z-10.
        G42 X40.
        C20.
        X-50.
        C-20.
        X40.
        C0
        G40 X100.
        G13.1
    """
    # Compares nothing: the table compares the moves of passes that begin and end at the same points.
    return pass_differences.differs
