from __future__ import annotations

from polarcheck.checking.rule import ERROR, NOTE, Hits, Lexical, Machine, graded, rule


@rule(ERROR, "{code} is no code of this control{times}", over="words")
def unknown_code(lexical: Lexical, machine: Machine) -> Hits:
    """
    G code that the control does not have.

    The control stops at a G code that it does not know, or whose option it lacks. From G200 on it may be a macro of the
    builder, called by a code that a parameter sets, and is a warning: add it to `known_codes` of a machine profile of
    your own. It is a note where the whole list of a control was not at hand. Each code is reported once, at its first
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

    Good:

        G098 G00 X60. C0
        G012.1
        G01 X40. F200
        C10.
        X60.
        G13.10
    """
    if not machine.control.unknown_codes_are_errors:
        return Hits(lexical.is_unknown_code, NOTE)
    may_call_macro = lexical.is_unknown_code & lexical.may_call_macro
    return graded(error=lexical.is_unknown_code & ~lexical.may_call_macro, warning=may_call_macro)
