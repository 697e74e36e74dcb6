from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written


@rule(
    WARNING,
    "{repeated}; the control takes the last: write one of them, or a block for each{count:blocks}",
    values={"count": "count"},
    worse=("count",),
    over="words",
)
def word_repeated(written: Written) -> Hits:
    """
    Same address twice in a block.

    The control takes the last of the two or, with parameter 3403#6 set, stops with an alarm. Mostly two blocks have
    lost the line end between them. G and M words may stand together, and I J K in macro calls. An address that is
    repeated in more than five blocks is reported once.

    Source: FANUC alarm 5074.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10. X60. C0      (expect: word-repeated)
        G13.1

    Good:

        O0001
        G98 G0 X60. C0 M8 M10
        G1 X50. R4. ,R1. F200
        G65 P9000 I1. J2. I3. J4.
        M30
        O9000
        G4 U1.
        M99
    """
    return Hits(written.repeat_count > 0, values={"count": written.repeat_count})
