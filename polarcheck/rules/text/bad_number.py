from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.other_mode import OtherMode
    from polarcheck.columns.words.written import Written
    from polarcheck.program.reading.words import Words
    from polarcheck.rules.hit import Details, Hit

_FAULTS = {
    "NO_DIGITS": "no digits after the address",
    "TWO_POINTS": "two decimal points",
    "TWO_SIGNS": "two signs",
    "SIGN_AFTER_DIGITS": "a sign behind the digits",
    "NO_ADDRESS": "a number without an address",
    "BLANK_INSIDE": "a blank inside the number",
    "WRONG_DASH": "a dash that is not a minus sign",
}


@rule(
    ERROR,
    "{word}: {number_fault}{count:blocks}",
    values=("word", "count"),
    worse=("count",),
    over="words",
    once="name",
    follows={
        "file": ("polar-code-of-another-control",),
        "block": ("comment-nested", "comment-not-closed"),
        "structure": ("macro-syntax",),
    },
)
def bad_number(written: Written, other_mode: OtherMode) -> Hits:
    """
    A number that a control cannot read.

    An address without digits, a number with two points or two signs or a sign behind its digits, digits without an
    address: the control stops at this block. So does a Siemens control in its own language at a blank inside a number
    (`X-10 10`), which others ignore. The rest of the block is read as if the word were not there. What is wrong in the
    same way with more than five words of an address is reported once.

    Source: FANUC alarms 004 to 007.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X F100        (expect: bad-number)
        X40.5.           (expect: bad-number)
        C--5.            (expect: bad-number)
        G13.1

    Good:

        G98 G0 X+60. C0
        G12.1
        G1 X40. F100
        C-5.
        G13.1
    """
    count = written.unreadable_count
    return Hits(count > 0, values={"count": count}, follows={"file": other_mode.explained})


def details(hit: Hit, words: Words) -> Details:
    from polarcheck.program.reading.numbers import NumberFault

    return {"number_fault": _FAULTS[NumberFault(int(words.fault[hit.index])).name]}
