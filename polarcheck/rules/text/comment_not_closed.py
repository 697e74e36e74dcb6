from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written


@rule(
    ERROR,
    "this comment is not closed on its line{count:blocks}",
    values=("count",),
    worse=("count",),
    over="comments",
    doubts=(("word", "block"),),
)
def comment_not_closed(written: Written) -> Hits:
    """
    Comment without its closing parenthesis.

    The control looks for the `)` beyond the end of the line: it stops with an alarm, or swallows blocks up to the next
    one. Here the comment is taken to end with its line.

    Source: FANUC B-62754EN/01, configuration of a program, control-out and control-in.

    Bad:

        O0001 (TWO FLATS  (expect: comment-not-closed)
        T0101 (MILL)
        M30

    Good:

        O0001 (TWO FLATS)
        T0101 (MILL)
        M30
    """
    return Hits(written.unclosed_count > 0, values={"count": written.unclosed_count})
