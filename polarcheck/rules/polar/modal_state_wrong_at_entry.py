from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode


@rule(
    ERROR,
    "{in_force} still in force at {switch}; write {ends} before it",
    values={"code": "in_force", "code_needed": "ends"},
    at=("on",),
    once="modal state",
    follows={"modal state": ("code-not-allowed-in-polar",)},
)
def modal_state_wrong_at_entry(modal: ModalStates, mode: PolarMode) -> Hits:
    """
    Cycle, scaling, rotation, mirror image or constant surface speed in force on entry.

    The control stops with an alarm if a drilling cycle (cancelled by G80 or by G0, G1, G2, G3), scaling, rotation or
    mirror image is still in force at G12.1. Constant surface speed (G96) makes the speed follow X, which in the mode
    moves with every turn of C; write G97 with S.

    Source: 30i alarm list, PS0146; FANUC B-62764EN/01, p. 51; Mitsubishi M700V programming manual, P485.

    Bad:

        G98 G0 X60. C0
        G83 X40. C90. Z-10. F100
        C180.
        G12.1             (expect: modal-state-wrong-at-entry)
        G1 X40. C0 F200
        C10.
        X60.
        G13.1

    Bad:

        G96 S120
        G98 G0 X60. C0
        G12.1             (expect: modal-state-wrong-at-entry)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good:

        G96 S120
        G97 S1000
        G83 X40. C90. Z-10. F100
        G80
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    transformed = (modal.state("scaling") != 0) | (modal.state("rotation") != 0) | (modal.state("mirror") != 0)
    return graded(
        error=mode.enters & (transformed | (modal.drilling != 0)),
        warning=mode.enters & (modal.state("speed") != 0),
    )
