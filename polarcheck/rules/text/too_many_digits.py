from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.words.written import Written
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{word} has more than {limit} digits",
    values=("word", "digits", "limit"),
    over="words",
    doubts=(("word", "block"),),
)
def too_many_digits(written: Written, machine: Machine) -> Hits:
    """
    Number with too many digits.

    A word can hold eight or nine digits, counted in least increments: X100000.000 has nine. The control stops at a
    longer one. Leading zeros do not count here, nor do decimals beyond the least increment, which the control drops.
    Mostly the point or the blank between two words is lost.

    Source: FANUC alarm 003.

    Bad, set control.digit_limit=8:

        G98 G0 X60. C0
        G12.1
        G1 X40000000000 F200   (expect: too-many-digits)
        C100000.000            (expect: too-many-digits)
        X60. C0
        G13.1

    Good, set control.digit_limit=8:

        G98 G0 X0000000060. C0
        G12.1
        G1 X40.123456789 F200
        C10.
        X60.
        G13.1
    """
    limit = machine.control.digit_limit
    return Hits(written.long_number_digits > limit, values={"limit": limit})


def details(hit: Hit, written: Written) -> Details:
    return {"digits": written.long_number_digits[hit.index]}
