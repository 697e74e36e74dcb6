from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.switch_words import SwitchWords
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{word} beside {switch} is incremental: the shift of the center is taken in absolute words only, {absolute}",
    values=("word",),
)
def polar_shift_incremental(blocks: ExecutedBlocks, switch_words: SwitchWords) -> Hits:
    """
    Center of the polar plane shifted by an incremental word.

    Some controls take the position of the center of the rotary axis beside G12.1, by words of X and of the rotary axis.
    Only absolute words count there. U or H, or X and C while G91 is in force, shift nothing or by what nobody meant.
    Write X and C, or leave them out where the origin is the center.

    Source: GSK 988, description of G12.1 IP P Q E.

    Bad, machine gsk-988:

        G98 G0 X60. C0
        G12.1 U5.         (expect: polar-shift-incremental)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad, machine gsk-988, set control.g_code_system="B":

        G94 G90 G0 X60. C0
        G91
        G12.1 X0 C0       (expect: polar-shift-incremental)
        G1 X-20. F200
        C10.
        X20.
        G13.1

    Good, machine gsk-988:

        G98 G0 X60. C0
        G12.1 X0 C0
        G1 X40. F200
        U-5. H10.
        X60.
        G13.1
    """
    # Compares nothing: polar-switch-not-alone leaves these words to this rule.
    found = switch_words.shifts_incrementally
    return Hits(blocks.with_words(found), at=found)


def details(hit: Hit, switch_words: SwitchWords) -> Details:
    return {"word": hit.word_list, "absolute": " and ".join(switch_words.shifts)}
