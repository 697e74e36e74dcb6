from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit

#: Modal groups that must have ended at G12.1, by the list of the codes that begin them.
_ENDED = {"scaling": "scaling", "rotation": "rotation", "mirror_image": "mirror", "constant_surface_speed": "speed"}


@rule(
    ERROR,
    "{code} still in force at {switch}; write {code_needed} before it",
    values=("code", "code_needed"),
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


def details(hit: Hit, modal: ModalStates, machine: Machine) -> Details:
    from polarcheck.program.machines.code_tables import spelled

    cycle = int(modal.drilling[hit.row])
    states = [(spelled("G", cycle * 10), " or ".join(machine.codes("drilling_cycle_off")))] if cycle else []
    for key, group in _ENDED.items():
        pairs = zip(machine.codes(key), machine.codes(f"{key}_off"), strict=False)
        states += [(on, off) for on, off in pairs if modal.has_state(group, [on])[hit.row]]
    return {"code": ", ".join(on for on, _ in states), "code_needed": ", ".join(off for _, off in states)}
