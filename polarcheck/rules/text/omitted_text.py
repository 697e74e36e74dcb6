from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.foundation.arrays import Mask


@rule(NOTE, "stands for blocks left out; what follows is judged as if nothing had happened there", over="dots")
def omitted_text(written: Written) -> Mask:
    """
    Line of points in place of blocks.

    Manuals print a line of points where blocks are left out. A control cannot read it. What follows is judged as if the
    blocks did not exist: positions, offsets and modes may be others. Of lines that follow each other the first is
    reported.

    Source: FANUC B-62764EN/01, p. 53.

    Bad:

        G98 G0 X60. C0
        .....             (expect: omitted-text)
        .....
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    # Compares nothing: the table takes lines of points that follow each other together.
    return written.is_first_dots
