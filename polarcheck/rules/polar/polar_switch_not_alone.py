from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.columns.modes.switch_words import SwitchWords
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} shares its block with {word}; it must stand in a block of its own",
    values=("code", "word"),
    doubts=(("metal", "section"),),
)
def polar_switch_not_alone(mode_words: ModeWords, switch_words: SwitchWords) -> Hits:
    """
    G12.1 or G13.1 not in a block of its own.

    What the control does with other words beside them is not specified: they may be ignored, or be read already on the
    polar plane or no longer there. Only a sequence number, the block skip sign and comments may share the block, and
    beside G12.1 the words that this control takes there (polar.words_beside_switch). A G13.1 outside the mode, as at
    the head of a program for safety, is not meant.

    Source: FANUC B-62764EN/01, p. 50; GSK 988, description of G12.1 IP P Q E.

    Bad:

        G98 G0 X60. C0
        G12.1 M8          (expect: polar-switch-not-alone)
        G1 X40. F200
        C10.
        X60.
        G13.1 G0 Z50.     (expect: polar-switch-not-alone)

    Bad, machine gsk-988:

        G98 G0 X60. C0
        G12.1 P1 Q3
        G1 X40. F200
        C10.
        X60.
        G13.1 P1 Q3       (expect: polar-switch-not-alone)

    Good:

        G40 G80 G13.1
        G98 G0 X60. C0 M8
        N10 G12.1 (ON)
        G1 X40. F200
        C10.
        X60.
        /N20 G13.1
        G13.1
        G0 Z50.
    """
    beside = mode_words.in_rows(mode_words.switches) & ~mode_words.may_stand_beside_switch
    beside &= ~switch_words.shifts_incrementally
    return Hits(mode_words.rows(beside), at=beside)


def details(hit: Hit) -> Details:
    return {"code": hit.switch, "word": hit.word_list}
