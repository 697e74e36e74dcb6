from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.switch_words import SwitchWords
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.rules.hit import Details, Hit


@rule(ERROR, "{word} beside {switch}: {axis_fault}", values=("word",))
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


def details(hit: Hit, switch_words: SwitchWords, axes: PlaneAxes) -> Details:
    return {"word": hit.word_list, "axis_fault": _axis_fault(hit, switch_words, axes)}


def _axis_fault(hit: Hit, switch_words: SwitchWords, axes: PlaneAxes) -> str:
    """Why P or Q of a G12.1 are no pair of axes."""
    from polarcheck.program.machines.axis_table import listed

    blocks, machine = hit.trace.blocks, hit.trace.machine
    if blocks.with_words(switch_words.names_axis_of_other_kind)[hit.row]:
        return f"P is the number of a linear axis and Q that of a rotary one, of {listed(machine.control.axes)}"
    if not blocks.with_words(switch_words.names_no_axis)[hit.row]:
        both = f"would be both the linear and the rotary axis; without P it is {machine.polar.linear_axis}"
        return f"axis {axes.axes_written[0][hit.row]:.0f} {both}, without Q {machine.polar.rotary_axis}"
    return f"no such axis; P and Q take whole numbers from 1 to {switch_words.trace.axes.most_axes}"
