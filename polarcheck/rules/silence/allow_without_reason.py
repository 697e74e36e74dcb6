from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.allow_comments import Allows
    from polarcheck.foundation.arrays import Mask


@rule(NOTE, "write the reason behind the names: the next reader must decide whether it still holds", over="allows")
def allow_without_reason(allows: Allows) -> Mask:
    """
    Allow comment without a reason.

    The comment silences its rules, and does not say why that is right. Whoever finds it in a year cannot tell a
    proven exception from a finding that somebody wanted to be rid of. A few words behind the names are enough: PROVEN
    ON L7, STOCK IS 40.

    Source: polarcheck, docs/silence.md.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G0 C5. (POLARCHECK ALLOW RAPID-IN-POLAR)   (expect: allow-without-reason)
        G1 C-5.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G0 C5. (POLARCHECK ALLOW RAPID-IN-POLAR PROVEN ON L7)
        G1 C-5.
        G13.1
    """
    return allows.is_in_main_file & allows.silences & ~allows.has_reason
