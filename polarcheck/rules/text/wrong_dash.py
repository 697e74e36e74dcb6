from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written


@rule(
    ERROR,
    "{word} is written with a dash of print; write a minus sign{count:blocks}",
    values=("word", "count"),
    worse=("count",),
    over="words",
)
def wrong_dash(written: Written) -> Hits:
    """
    Dash where a minus sign is meant.

    Programs copied from web pages or manuals have the dashes of print, U+2013, U+2014 or U+2212, in place of the minus
    sign. They look alike on the screen. The control does not know the character and stops, or loses it and moves to the
    other side. Here the word is read as negative. More than five in a file are reported once.

    Source: FANUC alarm 009; tape code list of B-63524EN/01.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C–10.             (expect: wrong-dash)
        X60. C0
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C-10.
        X60. C0
        G13.1
    """
    return Hits(written.wrong_dash_count > 0, values={"count": written.wrong_dash_count})
