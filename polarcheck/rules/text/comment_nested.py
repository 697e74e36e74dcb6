from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written


@rule(
    WARNING,
    "a parenthesis opens inside this comment; the control closes the comment at the first ){count:blocks}",
    values=("count",),
    worse=("count",),
    over="comments",
    doubts=(("word", "block"),),
)
def comment_nested(written: Written) -> Hits:
    """
    Comment inside a comment.

    Comments do not nest. The first `)` ends the comment, and what follows it is read as words of the block. Use no
    parentheses inside a comment. More than five in a file are reported once.

    Source: FANUC B-62754EN/01, configuration of a program, control-out and control-in.

    Bad:

        O0001 (FLATS (2 X) 180 DEG)   (expect: comment-nested)
        M30

    Bad:

        T0101 (MILL (NEW)             (expect: comment-nested)

    Good:

        T0101 (MILL) (NEW)
    """
    return Hits(written.nested_count > 0, values={"count": written.nested_count})
