"""Phrases of the rules about the text itself."""

from __future__ import annotations

from polarcheck.machines.codes import code_numbers, spelled
from polarcheck.reading.numbers import NumberFault
from polarcheck.reading.words import Text, Words
from polarcheck.table.written import Written

_NUMBER_FAULTS = {
    NumberFault.NO_DIGITS: "no digits after the address",
    NumberFault.TWO_POINTS: "two decimal points",
    NumberFault.TWO_SIGNS: "two signs",
    NumberFault.SIGN_AFTER_DIGITS: "a sign behind the digits",
    NumberFault.NO_ADDRESS: "a number without an address",
    NumberFault.WRONG_DASH: "a dash that is not a minus sign",
}


def number_fault(words: Words, index: int) -> str:
    """What is wrong with the number of a word."""
    return _NUMBER_FAULTS[NumberFault(int(words.fault[index]))]


def code(text: Text, index: int) -> str:
    """A G code, as in G0; as it is written where it is none that a control could know."""
    words = text.words
    number = int(code_numbers(words.value[index : index + 1])[0])
    return spelled("G", number) if number >= 0 else text.source.excerpt(int(words.start[index]), int(words.end[index]))


def other(text: Text, written: Written, index: int) -> str:
    """The code of the same group that stands before this one."""
    return code(text, int(written.overruled[index]))


def times(written: Written, index: int) -> str:
    """How often the code stands in the file, where it is more than once."""
    count = int(written.unknown_code_count[index])
    return f" ({count} times in this file)" if count > 1 else ""


def stray(text: Text, index: int) -> str:
    """What the control does with a stray character."""
    at = int(text.strays.start[index])
    character = text.source.excerpt(at, at + 1)
    if character == "%":
        return "% inside a block: for the control the program ends here"
    return f"{character} is no character of a word"


def characters(written: Written, index: int) -> str:
    """How many characters of the line are foreign."""
    count = int(written.foreign_count[index])
    return "1 character that is" if count == 1 else f"{count} characters that are"
