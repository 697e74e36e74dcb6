from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.foundation.arrays import Mask


@rule(
    ERROR,
    "tool length offset cannot be switched in the polar mode; write it {outside}",
    at=("tool_length_offset", "tool_length_offset_off"),
)
def tool_length_offset_in_polar(mode_words: ModeWords) -> Mask:
    """
    Tool length offset switched in the polar mode.

    G43, G44 and G49 belong before G12.1 or after G13.1; in the mode the control stops with an alarm. Lathes take the
    length from the tool offset that T calls, and need none of them.

    Source: FANUC B-62764EN/01, p. 52.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        G43               (expect: tool-length-offset-in-polar)
        X60.
        G49               (expect: tool-length-offset-in-polar)
        G13.1

    Good:

        G49
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        G49
    """
    return mode_words.rows(mode_words.not_allowed & mode_words.sets_length_offset)
