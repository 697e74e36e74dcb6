from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry_angles import EntryAngles
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{rotary} is positioned {turns} from its angle at the section before, which cuts the same contour: on this control "
    "{rotary} does not turn the plane (polar.zero_angle), and both cut at the same place of the part; {to_turn}",
    values=("between",),
    worse=("between",),
    over="sections",
    at=("on",),
    doubts=(("metal", "section"), ("position", "section")),
)
def c_angle_without_effect(entry_angles: EntryAngles) -> Mask:
    """
    The same contour twice, with another angle of C before each, where C does not turn the plane.

    On some controls the plane of the mode stands still on the part (polar.zero_angle): G0 C90 before TRANSMIT brings
    the tool to another place of the same plane, and the contour behind it is cut where it was cut before. To cut it at
    another angle, turn the plane: by a frame (ROT RPL=90) in the mode, or by another zero of C. Where a frame or a zero
    is programmed between both sections, where the depth differs, or where the contour turned by that angle is the same,
    nothing is reported.

    Source: SINUMERIK Job Planning, example of TRANSMIT, which turns each slot by ROT RPL.

    Bad, machine siemens-transmit, tool MILL:radius=2:

        G54 G90 G71 G94
        T="MILL" D1
        S2=2000 M2=3
        G0 X60 Z2 C0
        TRANSMIT
        G0 X30 Y0
        G1 Z-2 F200
        X10
        G0 Z2
        TRAFOOF
        G0 X60 C90
        TRANSMIT           (expect: c-angle-without-effect)
        G0 X30 Y0
        G1 Z-2 F200
        X10
        G0 Z2
        TRAFOOF
        M30

    Good, machine siemens-transmit, tool MILL:radius=2:

        G54 G90 G71 G94
        T="MILL" D1
        S2=2000 M2=3
        G0 X60 Z2 C0
        TRANSMIT
        G0 X30 Y0
        G1 Z-2 F200
        X10
        G0 Z2
        TRAFOOF
        G0 X60 C90
        TRANSMIT
        ROT RPL=90
        G0 X30 Y0
        G1 Z-2 F200
        X10
        G0 Z2
        ROT
        TRAFOOF
        M30
    """
    # NaN where C has its effect.
    return entry_angles.without_effect == entry_angles.without_effect


def details(hit: Hit, entry_angles: EntryAngles) -> Details:
    from polarcheck.program.machines.own_language import shown

    machine, by = hit.trace.machine, abs(float(entry_angles.without_effect[hit.index]))
    words = [shown(machine.control.native_words, code) for code in machine.codes("frame_rotation")[:1]]
    to_turn = f"turn the plane by {words[0]}" if words else f"give {hit.rotary} another zero"
    return {"between": by, "turns": f"{by:.4g} deg", "to_turn": to_turn}
