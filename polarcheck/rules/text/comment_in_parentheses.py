from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written


@rule(
    WARNING,
    "text in parentheses is no comment in this language{count:blocks}: the control stops here; write ; before it",
    values=("count",),
    worse=("count",),
    over="comments",
)
def comment_in_parentheses(written: Written) -> Hits:
    """
    Comment in parentheses on a control that has none.

    In the language of Siemens controls parentheses hold arguments and expressions, and a comment begins with `;`. Text
    in parentheses, as FANUC programs and the ISO mode have it, stops the control. The first place in a file is
    reported, with the number of such comments.

    Source: NC programming 840D sl 12/2019 p. 52.

    Bad, machine siemens-transmit:

        (HEXAGON, 24 ACROSS)   (expect: comment-in-parentheses)
        G94 S2=1000 M2=3
        G0 X60 C0
        M30

    Good, machine siemens-transmit:

        ; HEXAGON, 24 ACROSS
        R1=(2+3)*4
        MSG("(ROUGHING)")
        G94 S2=1000 M2=3
        G0 X60 C0
        M30
    """
    return Hits(written.parentheses_count > 0, values={"count": written.parentheses_count})
