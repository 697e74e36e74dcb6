from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.allow_comments import Allows


@rule(WARNING, "this allow comment has no effect: {fault}", over="allows")
def allow_not_understood(allows: Allows) -> Hits:
    """
    Allow comment that means nothing.

    ALLOW takes the name of a rule, or of a group of rules; commas part several names. There is no allow without a name.
    A post or a control may have cut the comment or dropped its lower case letters: then the name is gone or is another
    one. What the comment was to silence is told as if it were not there; of several names those that are known count.
    ALLOW-FILE stands at the head of a program, before its first block.

    Source: polarcheck, docs/silence.md.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        (POLARCHECK ALLOW RAPID-IN-POLR PROVEN ON L7)   (expect: allow-not-understood)
        G0 C5.                                          (expect: rapid-in-polar)
        G1 C-5.
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
    return Hits(allows.is_in_main_file & (allows.faults != ""), values={"fault": allows.faults})
