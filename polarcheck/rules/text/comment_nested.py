from __future__ import annotations

from polarcheck.checking.rule import WARNING, Mask, Text, rule


@rule(
    WARNING, "a parenthesis opens inside this comment; the control closes the comment at the first )", over="comments"
)
def comment_nested(text: Text) -> Mask:
    """
    Comment inside a comment.

    Comments do not nest. The first `)` ends the comment, and what follows it is read as words of the block. Use no
    parentheses inside a comment.

    Source: FANUC B-62754EN/01, configuration of a program, control-out and control-in.

    Bad:

        O0001 (FLATS (2 X) 180 DEG)   (expect: comment-nested, bad-number, program-end-missing)

    Bad:

        T0101 (MILL (NEW)             (expect: comment-nested)

    Good:

        T0101 (MILL) (NEW)
    """
    # Compares nothing: the reader says so of each comment.
    return text.nested
