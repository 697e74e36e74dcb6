from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.allow_comments import UnusedAllows


@rule(
    NOTE,
    "{names}: there is nothing to silence here; delete it from the allow comment",
    values=("names",),
    over="allows",
)
def allow_without_effect(unused_allows: UnusedAllows) -> Hits:
    """
    Allow comment that silences nothing.

    The block has been mended since, or the comment has moved away from it. It would silence the next fault of this kind
    that somebody writes there, and nobody would see it. Take out the name, or the comment.

    Nothing is said where the rule was not asked (--select, --ignore, --severity) or could not be evaluated, nor in a
    program that returns to its caller and has no G12.1 of its own: a check of the programs that call it says more.

    Source: polarcheck, docs/silence.md.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C5. (POLARCHECK ALLOW RAPID-IN-POLAR PROVEN ON L7)   (expect: allow-without-effect)
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        (POLARCHECK ALLOW RAPID-IN-POLAR PROVEN ON L7)
        G0 C5.
        G1 C-5.
        G13.1
    """
    return Hits(unused_allows.names != "", values={"names": unused_allows.names})
