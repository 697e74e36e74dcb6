from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.modal import ModalStates
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.mode_words import ModeWords
    from polarcheck.program.machines.job import Job
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.other_machine import OtherMachine


@rule(
    ERROR,
    "{word} is no coordinate of the polar plane: its second axis is {virtual} here{taken_by}",
    values=("word",),
    once="section",
    doubts=(("position", "loop"),),
)
def wrong_axis_address_in_polar(mode: PolarMode, mode_words: ModeWords) -> Hits:
    """
    Second axis of the polar plane under the address of another control.

    Controls that keep to the ISO dialect of lathes call it by the rotary axis, C; others give it the letter Y. A Y on
    a lathe that expects C is an unknown address, or moves a real Y axis. The machine's profile says which is right
    (polar.virtual_axis). One finding stands for the section.

    Source: FANUC B-62764EN/01, p. 51; Mitsubishi M700V programming manual, p. 73, parameter 1517.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        Y10.              (expect: wrong-axis-address-in-polar)
        G3 X30. Y15. R5.
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. Y0 C0
        G12.1
        G1 X40. F200
        C10.
        G3 X30. C15. R5.
        G1 X60.
        G13.1
        G28 V0
    """
    # Beside a switch it may be another word, as in G137 C0.
    within = mode.in_polar & ~mode.enters_again
    return Hits(within & mode_words.rows(mode_words.of_other_axis), at=mode_words.of_other_axis)


def details(hit: Hit, modal: ModalStates, job: Job, other_machine: OtherMachine) -> Details:
    return {"taken_by": _taken_by(hit, modal, job, other_machine)}


def _taken_by(hit: Hit, modal: ModalStates, job: Job, other_machine: OtherMachine) -> str:
    """
    Which machines read the whole program well; where none does, which word beside G12.1 or controls take it.

    Where somebody has chosen the machine, what to write on it. A word that positions the rotary axis under another name
    (SPOS=0) is none of the plane on any control.
    """
    from polarcheck.rules.remedies import is_chosen

    run, machine, polar = hit.trace.run, hit.trace.machine, hit.trace.machine.polar
    name, equals, _ = hit.word.upper().partition("=")
    if equals and not name.startswith(polar.rotary_address):
        is_main = modal.main_is_master[hit.row] or "[" in name
        turned = f"the spindle, which is the {polar.rotary_address} axis of the mode" if is_main else "another spindle"
        return f"; {name} positions {turned}: write it {hit.outside}"
    number, of_address = int(run.words.address[hit.words[0]]), machine.address_number
    choosing = next(
        (word for word, pair in polar.virtual_axis_by_word.items() if number in map(of_address, filter(None, pair))), ""
    )
    if choosing:
        return f"; beside {choosing} it would be"
    if is_chosen(machine, job):
        return f"; write {hit.virtual}"
    controls = polar.other_controls
    return other_machine.text or (f"; {controls} would take it" if controls else "")
