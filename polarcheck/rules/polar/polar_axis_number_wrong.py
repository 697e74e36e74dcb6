from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.blocks import ExecutedBlocks
    from polarcheck.columns.modes.switch_words import SwitchWords


@rule(ERROR, "{others} beside {switch}: {axis_fault}", values={"word": "others"})
def polar_axis_number_wrong(blocks: ExecutedBlocks, switch_words: SwitchWords) -> Hits:
    """
    P or Q of G12.1 that gives no pair of axes.

    Beside G12.1 some controls take the number of the linear axis in P and that of the rotary axis in Q; without them
    those of the parameters count, polar.linear_axis and polar.rotary_axis of the profile. Both are whole numbers from 1
    to the number of axes, and one axis cannot be both. Where control.axes gives the names of the axes, P must be one of
    X, Y, Z, U, V, W, and Q one of A, B, C.

    Source: GSK 988, description of G12.1 IP P Q E, table of ranges; parameters 5460 and 5461.

    Bad, machine gsk-988:

        G98 G0 X60. C0
        G12.1 P0          (expect: polar-axis-number-wrong)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad, machine gsk-988, set polar.rotary_axis=3:

        G98 G0 X60. C0
        G12.1 P3          (expect: polar-axis-number-wrong)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good, machine gsk-988:

        G98 G0 X60. C0
        G12.1 P1 Q3
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    found = switch_words.names_no_axis | switch_words.names_axis_of_other_kind | switch_words.names_axis_twice
    return Hits(blocks.with_words(found), at=found)
