from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.spindles import Spindles
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{rotary} has not gone to its reference point since it was engaged; write {code_needed} before {switch}",
    values=("code_needed",),
    at=("on",),
    once="c axis code",
)
def c_axis_not_referenced(
    blocks: ExecutedBlocks, mode: PolarMode, machine: Machine, entry: Entry, spindles: Spindles
) -> Mask:
    """
    C axis engaged but not referenced.

    When the spindle becomes the C axis, its angle is wherever the spindle stopped. G28 H0 takes C to its reference
    point; without it the control stops with an alarm, or the shape stands at a chance angle on the part.

    Source: builder's guide to G12.1, sample program; 30i alarm list, PS0303.

    Bad, set m_codes.c_axis_on=["M35"], set m_codes.c_axis_off=["M34"]:

        M35
        G97 S2000 M33
        G98 G0 X60. C0
        G12.1             (expect: c-axis-not-referenced)
        G1 C10. F1500
        X60.
        G13.1

    Bad, set m_codes.c_axis_on=["M35"], set m_codes.c_axis_off=["M34"]:

        M35
        G28 H0
        M34
        M35
        G97 S2000 M33
        G98 G0 X60. C0
        G12.1             (expect: c-axis-not-referenced)
        G1 C10. F1500
        X60.
        G13.1

    Good, set m_codes.c_axis_on=["M35"], set m_codes.c_axis_off=["M34"]:

        M35 G28 H0
        G97 S2000 M33
        G98 G0 X60. C0
        G12.1
        G1 C10. F1500
        X60.
        G13.1
    """
    # C of a sub-spindle has another name on many lathes.
    of_sub_spindle = blocks.has("A", "B") & spindles.on_sub_spindle
    named = blocks.has(*machine.polar.rotary_words) | of_sub_spindle | blocks.moves_unnamed
    referenced = blocks.listed("c_axis_reference") & named
    entered = mode.enters & mode.rotary_is_followed & spindles.c_axis
    return entered & ~entry.happened(referenced, since=spindles.engages_c_axis)


def details(hit: Hit, machine: Machine) -> Details:
    from polarcheck.rules.wording.written import code_of

    polar = machine.polar
    address = polar.rotary_incremental or f"{polar.rotary_address}{'=' * (len(polar.rotary_address) > 1)}"
    return {"code_needed": f"{code_of(machine, 'c_axis_reference')} {address}0"}
