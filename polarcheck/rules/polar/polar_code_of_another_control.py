from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.other_mode import OtherMode
    from polarcheck.program.machines.job import Job
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} begins no polar mode on {title}, where {on_of_this} does; {instead}{else_a_macro}",
    values=("code",),
    once="program",
    doubts=(("word", "file"), ("mode", "program")),
)
def polar_code_of_another_control(other_mode: OtherMode) -> Hits:
    """
    Polar mode begun by the code of another control.

    The codes that switch the polar mode differ from control to control: G12.1, G112, G137, TRANSMIT, G16 XC. A control
    that does not know the code stops at it or, worse, takes it for something else, and turns C by degrees where a
    length is intended. The section itself is not checked. Write the codes of this lathe and, if the section has
    another second axis or another X, its words; or check the program with the machine that it is for. A G code without
    the code that ends the mode, and without a later move of the second axis at feed, may be a macro of the builder: it
    is a warning. A word such as TRANSMIT cannot be a macro. G101 and G105, the polar maps of one builder, are macros of
    so many others that they are reported only with both signs. There is one finding per program.

    Source: FANUC B-62764EN/01, p. 51; Haas codes, G112; Okuma OSP-P300 post, G137; Siemens manual, TRANSMIT;
    public posts for Hurco TMX8 and Fagor 8055i-TC.

    Bad, machine haas-lathe:

        O1
        G98 G0 X60. C0
        G12.1             (expect: polar-code-of-another-control)
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Bad:

        O1
        G98 G0 X100. C0
        G137 C0           (expect: polar-code-of-another-control)
        G101 X20. F200
        G103 X10. Y10. L10.
        G136
        M30

    Bad:

        O1
        T0101
        G98 G0 X40. C45.
        G101              (expect: polar-code-of-another-control)
        G17
        G1 X20. Y10. F200
        Y-10.
        G109
        M30

    Good:

        O1
        G101
        G0 X20. Z2.
        M30

    Bad, machine okuma-osp:

        O1
        G112              (expect: polar-code-of-another-control)
        G0 Z5.
        M30

    Bad:

        O1
        TRANSMIT          (expect: polar-code-of-another-control)
        G0 Z5.
        M30

    Good, machine haas-lathe:

        O1
        G17 G98
        M5
        M154
        G28 H0
        T0101
        M133 P1000
        G0 X80. C0
        G112
        G1 X20. F20.
        Y10.
        X-20.
        G113
        M135
        M155
        M30

    Good, machine okuma-osp:

        O1
        G0 X20. Z2.
        G112 X24. Z-8. L4. F1.5
        M30
    """
    # Compares nothing: the blocks after the code show what it is for, and the table looks at them.
    may_be_macro = other_mode.may_be_macro
    return graded(error=other_mode.is_meant, warning=may_be_macro, at=other_mode.words, undecided=may_be_macro)


def details(hit: Hit, other_mode: OtherMode, machine: Machine, job: Job) -> Details:
    from polarcheck.program.machines.own_language import shown

    return {
        "code": other_mode.switch(hit.row).name,
        "on_of_this": " or ".join(shown(machine.control.native_words, code) for code in machine.polar.on),
        "instead": _instead(hit, other_mode, machine, job),
        "else_a_macro": "" if other_mode.is_meant[hit.row] else ", unless it is a macro of the builder",
    }


def _instead(hit: Hit, other_mode: OtherMode, machine: Machine, job: Job) -> str:
    """
    The remedy: `write G112 for G12.1, G113 for G13.1 and Y for C`.

    If the machine is only the default, it names those that know the code: `check it with --machine fanuc or gsk-988`.
    """
    from polarcheck.foundation.errors import enumerated
    from polarcheck.program.machines.own_language import shown
    from polarcheck.rules.other_machine import NAMED
    from polarcheck.rules.remedies import is_chosen

    machines = other_mode.machines(hit.row)
    if not is_chosen(machine, job):
        return f"check it with --machine {enumerated([profile.name for profile in machines[:NAMED]], 'or')}"
    polar, native = machine.polar, machine.control.native_words
    angle = f" {polar.direction_word}0" if polar.direction_word else ""
    words = [f"{shown(native, polar.on[0])}{angle} for {other_mode.switch(hit.row).name}"]
    words += [f"{shown(native, polar.off[0])} for {name}" for name in other_mode.ends_written(hit.row)]
    axes = other_mode.other_axes_written(hit.row)
    words += [f"{polar.virtual_axis} for {axis}" for axis in axes]
    if axes and all(profile.machine.polar.x != polar.x for profile in machines):
        words.append(f"X as a {polar.x}")
    return f"write {enumerated(words, 'and')}"
