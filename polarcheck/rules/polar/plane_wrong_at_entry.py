from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} is in force at {switch}, and {code_needed} must be: write it before {switch} or right behind",
    values=("code", "code_needed"),
    at=("on",),
    once="plane",
)
def plane_wrong_at_entry(mode: PolarMode, entry: Entry) -> Mask:
    """
    Polar mode entered in another plane than the lathe wants.

    Most controls set the plane in force aside at G12.1. Some lathes are set up for one plane, and stop or read arcs
    and compensation in the wrong one. Write that plane code before G12.1, or as the first block behind it; it is in the
    machine's profile (polar.plane_before). Where the program selects no plane, the one after power-on is taken to be
    right.

    Source: builder's guide to G12.1, plane selection.

    Bad, machine turning-center:

        G17 G98 G0 X2.4 C0
        G12.1             (expect: plane-wrong-at-entry)
        G1 C.4 F40.
        G1 G41 X.8 F5.
        C-.4
        G40 X2.4
        G13.1

    Good, machine turning-center:

        G17
        G18 G98 G0 X2.4 C0
        G12.1
        G1 C.4 F40.
        G1 G41 X.8 F5.
        C-.4
        G40 X2.4
        G13.1

    Good, machine turning-center:

        G17 G98 G0 X2.4 C0
        G12.1
        G18
        G1 C.4 F40.
        G1 G41 X.8 F5.
        C-.4
        G40 X2.4
        G13.1

    Good:

        G17 G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    return mode.enters & ~entry.plane_is_right


def details(hit: Hit, modal: ModalStates, machine: Machine) -> Details:
    return {"code": f"G{modal.state('plane')[hit.row]}", "code_needed": " or ".join(machine.polar.plane_before)}
