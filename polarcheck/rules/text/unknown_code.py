from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, NOTE, Hits, graded, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.other_mode import OtherMode
    from polarcheck.columns.modes.switch_slips import SwitchSlips
    from polarcheck.columns.words.written import Written
    from polarcheck.program.machines.machine import Machine
    from polarcheck.program.reading.words import Words
    from polarcheck.rules.hit import Details, Hit

#: From this number on few codes belong to the control; programs call macros of the builder (parameter 6050).
OWN_CODES_END = 100


@rule(
    ERROR,
    "{code} is no code of this control{times}{or_known}",
    values=("code", "count"),
    worse=("count",),
    over="words",
    subject="word",
    follows={"file": ("polar-switch-unknown",)},
)
def unknown_code(
    words: Words, written: Written, machine: Machine, other_mode: OtherMode, switch_slips: SwitchSlips
) -> Hits:
    """
    G code that the control does not have.

    The control stops at a G code that it does not know, or whose option it lacks. From G100 on it may be a macro of the
    builder, called by a code that a parameter sets, and is a warning: add it to `known_codes` of a machine profile of
    your own. It is a note if the list of codes of the control is not complete. Each code is reported once, at its first
    place.

    Source: FANUC alarm 010.

    Bad:

        G98 G0 X60. C0
        G12.11            (expect: unknown-code)
        G1 X40. F200

    Bad:

        G98 G0 X60. C0
        G505 X1.          (expect: unknown-code)
        G505 X2.
        G150 X2.          (expect: unknown-code)

    Bad, set control.unknown_codes_are_errors=false:

        G98 G0 X60. C0
        G12.11            (expect: unknown-code)
        G505 X1.          (expect: unknown-code)

    Good:

        G098 G00 X60. C0
        G012.1
        G01 X40. F200
        C10.
        X60.
        G13.10
    """
    unknown = written.unknown_code_count > 0
    follows = {"file": other_mode.explained | switch_slips.explained}
    if not machine.control.unknown_codes_are_errors:
        return Hits(unknown, NOTE, follows=follows)
    may_call_macro = (words.value >= OWN_CODES_END) & (words.decimals == 0)
    return graded(error=unknown & ~may_call_macro, warning=unknown & may_call_macro, follows=follows)


def details(hit: Hit, written: Written) -> Details:
    from polarcheck.rules.wording.written import g_code

    count = int(written.unknown_code_count[hit.index])
    return {
        "code": g_code(hit.trace.text, hit.index),
        "count": count,
        "times": f" ({count} times in this file)" if count > 1 else "",
        "or_known": _or_known(hit),
    }


def _or_known(hit: Hit) -> str:
    """Where to add a code that the lathe does have, such as a builder's macro; empty if it can only be a slip."""
    from polarcheck.program.machines.machine import OwnMachine
    from polarcheck.rules.remedies import place

    value, machine = hit.trace.text.words.value[hit.index], hit.trace.machine
    is_own = isinstance(machine, OwnMachine) and float(value * 10).is_integer() and value >= 0
    if not is_own and value < OWN_CODES_END:
        return ""
    return f"; if the lathe has it, add it to {place(machine, 'control.known_codes')}"
