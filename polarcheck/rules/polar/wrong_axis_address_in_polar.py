from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.mode_words import ModeWords


@rule(
    ERROR,
    "{word} is no coordinate of the polar plane: its second axis is {virtual} here{taken_by}",
    values={"word": "word"},
    once="section",
    doubts=(("position", "loop"),),
    follows={"block": ("polar-entered-twice",)},
)
def wrong_axis_address_in_polar(mode: PolarMode, mode_words: ModeWords) -> Hits:
    """
    Second axis of the polar plane under the address of another control.

    Controls that keep to the ISO dialect of lathes call it by the rotary axis, C; others give it the letter Y. A Y on
    a lathe that expects C is an unknown address, or moves a real Y axis. The machine's profile says which is right
    (polar.virtual_axis). One finding stands for the section.

    Source: FANUC B-62764EN/01, p. 51; Mitsubishi M700V programming manual, p. 73, parameter 1517.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        Y10.              (expect: wrong-axis-address-in-polar)
        G3 X30. Y15. R5.
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. Y0 C0
        G12.1
        G1 X40. F200
        C10.
        G3 X30. C15. R5.
        G1 X60.
        G13.1
        G28 V0
    """
    return Hits(mode.in_polar & mode_words.rows(mode_words.of_other_axis), at=mode_words.of_other_axis)
