from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.other_mode import OtherMode
    from polarcheck.columns.words.written import Written
    from polarcheck.program.machines.machine import Machine
    from polarcheck.program.reading.words import Words
    from polarcheck.rules.hit import Details, Hit
    from polarcheck.rules.other_machine import OtherMachine

_FAULTS = {
    "NO_DIGITS": "no digits after the address",
    "TWO_POINTS": "two decimal points",
    "TWO_SIGNS": "two signs",
    "SIGN_AFTER_DIGITS": "a sign behind the digits",
    "NO_ADDRESS": "a number without an address",
    "BLANK_INSIDE": "a blank inside the number",
    "WRONG_DASH": "a dash that is not a minus sign",
}
#: Characters before and behind a number that are searched for words of other controls; lines by hand are shorter.
_NEAR = 4000


@rule(
    ERROR,
    "{word}: {number_fault}{count:blocks}",
    values=("word", "count"),
    worse=("count",),
    over="words",
    once="name",
    follows={"structure": ("macro-syntax",)},
    subject="word",
    doubts=(("word", "block"),),
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


def details(hit: Hit, words: Words, machine: Machine, other_machine: OtherMachine) -> Details:
    from polarcheck.program.reading.numbers import NumberFault

    fault = NumberFault(int(words.fault[hit.index]))
    of_other = _of_other_control(hit, words, machine, other_machine) if fault == NumberFault.NO_DIGITS else ""
    return {"number_fault": f"{_FAULTS[fault.name]}{of_other}"}


def _of_other_control(hit: Hit, words: Words, machine: Machine, other_machine: OtherMachine) -> str:
    """
    `; WAITM is a word of siemens-iso (--machine)`, where letters begin a word of other controls, or stand in it; which
    machines read the program well, where some do.
    """
    from polarcheck.foundation.errors import enumerated
    from polarcheck.program.machines import profiles
    from polarcheck.rules.other_machine import NAMED, without_comments, words_of

    if other_machine.text:
        return other_machine.text
    text, start = hit.trace.text, int(words.start[hit.index])
    number = int(text.blocks.line[words.block[hit.index]])
    first = max(start - int(text.source.line_starts[number - 1]) - _NEAR, 0)
    line = without_comments(text.source.line_text(number)[first : first + 2 * _NEAR])
    if words_of(machine, line):
        return ""
    rest = text.source.excerpt(start, start + len(line)).upper()
    known_by: dict[str, list[str]] = {}
    for profile in profiles.built_in():
        for word in words_of(profile.machine, line):
            if rest.startswith(next(filter(str.isalpha, word.split()), "=")):
                known_by.setdefault(word, []).append(profile.name)
    for word, names in known_by.items():
        return f"; {word} is a word of {enumerated(names[:NAMED], 'and')} (--machine)"
    return ""
