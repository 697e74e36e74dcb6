from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.switch_slips import Slip, SwitchSlips
    from polarcheck.rules.hit import Details, Hit


@rule(WARNING, "{slip}", values=("code_needed",), doubts=(("word", "block"), ("mode", "program")))
def polar_switch_unknown(switch_slips: SwitchSlips) -> Hits:
    """
    Code that is meant to switch the polar mode and does not.

    G121 is G12.1 without its point, and G12 is G12.1 without its last digit. The control stops at the code, or knows it
    as something else: the mode does not begin, and C of the contour is an angle. The same holds for G13.1, with which
    the mode does not end. Write the code with its point.

    Where G121 is answered by G120, the builder may have given the mode codes of its own: then polar.on and polar.off of
    a machine profile name them. Until then the contour is judged as if they did, and its findings are conditional.

    Source: FANUC B-62764EN/01, p. 51; alarm 010; G100 to G199 are free for macros of the builder.

    Bad:

        G98 G0 X60. C0
        G121              (expect: polar-switch-unknown)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13               (expect: polar-switch-unknown)
        G0 Z50.
        M30

    Bad:

        O1
        T0808
        G98 G0 X60. C0
        G121              (expect: polar-switch-unknown)
        G1 X40. F200
        C10.
        X60.
        G120
        M30

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    certain, begins = switch_slips.is_certain, switch_slips.begins
    return graded(error=certain, warning=begins & ~certain, at=switch_slips.words)


def details(hit: Hit, switch_slips: SwitchSlips) -> Details:
    slip = switch_slips.slips[hit.row]
    return {"code_needed": "" if slip.is_of_builder else slip.meant, "slip": _effect(hit, switch_slips, slip)}


def _effect(hit: Hit, switch_slips: SwitchSlips, slip: Slip) -> str:
    """What a misspelled switch of the mode does, and what to write; or where the codes of the builder belong."""
    from polarcheck.rules.remedies import place
    from polarcheck.rules.wording.written import executed_word

    run, machine, mode = hit.trace.run, hit.trace.machine, hit.trace.machine.polar
    words = [index for index in switch_slips.words.nonzero()[0].tolist() if run.row[index] in (hit.row, slip.answer)]
    names = [executed_word(run, index) for index in words]
    if slip.is_of_builder:
        on, off = (
            ", ".join(f'"{one}"' for one in (*codes, code))
            for codes, code in ((mode.on[:1], names[0]), (mode.off[:1], names[-1]))
        )
        keys = place(machine, f"polar.on = [{on}] and polar.off = [{off}]")
        effect = f"begins and {names[-1]} ends no polar mode that {machine.title} has"
        return f"{names[0]} {effect}: if they do on this lathe, write {keys}; what is said of the contour rests on that"
    if slip.meant in mode.off:
        return f"{names[0]} does not end the polar mode; write {slip.meant}"
    answer = ""
    if slip.answer >= 0:
        answer = f", and {switch_slips.meant_in(slip.answer)} for {names[-1]} in line {hit.line(slip.answer)}"
    return f"{names[0]} begins no polar mode, and the contour behind it is not looked at; write {slip.meant}{answer}"
