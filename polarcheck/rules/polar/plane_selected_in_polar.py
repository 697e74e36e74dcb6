from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} in the polar mode: its plane is always that of {linear} and {virtual}; delete it or write it {outside}",
    values=("code",),
    at=("plane_xy", "plane_zx", "plane_yz"),
)
def plane_selected_in_polar(mode_words: ModeWords, machine: Machine) -> Mask:
    """
    Plane selected in the polar mode.

    In the mode the plane is the polar plane, whatever G17, G18 or G19 was in force before; that one comes back at
    G13.1. Selecting a plane in the mode stops the control with an alarm. Delete the code, or write it before G12.1. On
    lathes that are set up for one plane, selecting that one is right in the mode, too (polar.plane_before).

    Source: FANUC B-62764EN/01, p. 50; 30i alarm list, PS0146; Mitsubishi M700V programming manual, P485.

    Bad:

        G98 G0 X60. C0
        G12.1
        G17               (expect: plane-selected-in-polar)
        G1 X40. F200
        G17 G3 X30. C5. I-5. J0   (expect: plane-selected-in-polar)
        G1 X60.
        G13.1

    Bad, machine turning-center:

        G98 G18 G0 X2.4 C0
        G12.1
        G1 G17 X1.6 F40.  (expect: plane-selected-in-polar)
        G1 G41 X.8 C.4 F5.
        C-.4
        G40 X2.4
        G13.1

    Good, machine turning-center:

        G98 G18 G0 X2.4 C0
        G12.1
        G18
        G1 X1.6 F40.
        G1 G41 X.8 C.4 F5.
        C-.4
        G40 X2.4
        G13.1

    Good:

        G98 G18 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 X30. C5. I-5. J0
        G1 X60.
        G13.1
        G17
    """
    is_wanted = mode_words.codes(*machine.polar.plane_before)
    return mode_words.rows(mode_words.not_allowed & mode_words.selects_plane & ~is_wanted)


def details(hit: Hit, modal: ModalStates) -> Details:
    return {"code": f"G{modal.state('plane')[hit.row]}"}
