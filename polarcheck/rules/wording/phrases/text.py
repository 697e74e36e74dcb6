"""Phrases of the rules about the text itself."""

from __future__ import annotations

import itertools
import re

import numpy as np

from polarcheck.columns.words.dialect import Dialect
from polarcheck.columns.words.written import Written
from polarcheck.foundation.arrays import stretch
from polarcheck.program.machines.codes import code_numbers, spelled
from polarcheck.program.machines.machine import Machine, OwnMachine
from polarcheck.program.reading.numbers import NumberFault
from polarcheck.program.reading.words import Text, Words
from polarcheck.rules.places import Place, squeezed
from polarcheck.rules.remedies import place as place_of_key
from polarcheck.rules.wording.phrases.common import short

#: From here on G codes call macros of the builder.
_MACROS_BEGIN = 100
#: Of many words of one address so many are listed, and the last.
_LISTED = 3
_NUMBER_FAULTS = {
    NumberFault.NO_DIGITS: "no digits after the address",
    NumberFault.TWO_POINTS: "two decimal points",
    NumberFault.TWO_SIGNS: "two signs",
    NumberFault.SIGN_AFTER_DIGITS: "a sign behind the digits",
    NumberFault.NO_ADDRESS: "a number without an address",
    NumberFault.WRONG_DASH: "a dash that is not a minus sign",
}
#: More of a line is not needed to find it.
_SIGN_LENGTH = 40
#: Of a text so much is looked at for its first words [characters].
_LOOKED_AT = 200
#: Digits on either side of a decimal comma, and most of them that are named.
_LAST_DIGITS, _FIRST_DIGITS = re.compile(r"(?<![0-9])[0-9]++\Z"), re.compile(r"[0-9]++")
_DIGITS = 12
_LINES_AND_BLANKS = " \t-|=:*#"
_TAG = re.compile(r"</?\w[^<>\n]*+>")
_TWO_LETTERS = re.compile(r"[^\W\d_]{2}")
#: Beside so many blocks, text is no remark but a column.
_DESCRIPTION = 5


def number_fault(words: Words, index: int) -> str:
    """What is wrong with the number of a word."""
    return _NUMBER_FAULTS[NumberFault(int(words.fault[index]))]


def or_known(words: Words, machine: Machine, index: int) -> str:
    """Where to add a code that the lathe has, be it a macro of its builder; nothing for what can only be a slip."""
    is_own = isinstance(machine, OwnMachine) and float(words.value[index] * 10).is_integer() and words.value[index] >= 0
    if not is_own and words.value[index] < _MACROS_BEGIN:
        return ""
    return f"; if the lathe has it, add it to {place_of_key(machine, 'control.known_codes')}"


def letter(text: Text, place: Place) -> str:
    """The letter that stands for a digit in a word, and the digit."""
    letters = text.letters
    at = int(letters[np.searchsorted(letters, place.start)])
    return "O for the digit 0" if text.source.excerpt(at, at + 1) in "oO" else "I for the digit 1"


def meant(text: Text, place: Place) -> str:
    """A word with its digits in the place of letters."""
    first, end = stretch(text.letters, place.start, place.end)
    found = list(text.source.excerpt(place.start, place.end))
    for at in (text.letters[first:end] - place.start).tolist():
        found[at] = "0" if found[at] in "oO" else "1"
    return short("".join(found).upper())


def code(text: Text, index: int) -> str:
    """A G code, as in G0; as it is written where it is none that a control could know."""
    words = text.words
    number = int(code_numbers(words.value[index : index + 1])[0])
    start, end = int(words.start[index]), int(words.end[index])
    return spelled("G", number) if number >= 0 else short(text.source.excerpt(start, end))


def other(text: Text, written: Written, index: int) -> str:
    """The code of the same group that stands before this one."""
    return code(text, int(written.overruled[index]))


def repeated(text: Text, index: int) -> str:
    """`X is written twice in this block: X10. and X20.`, with the words of the address as they are written."""
    words = text.words
    low, high = stretch(words.block, int(words.block[index]), int(words.block[index]) + 1)
    same = low + np.flatnonzero(words.address[low:high] == words.address[index])
    # A line of 50 MB may be one block: only what is listed is taken out of it.
    listed = same if len(same) <= _LISTED + 1 else np.append(same[:_LISTED], same[-1])
    spans = zip(words.start[listed].tolist(), words.end[listed].tolist(), strict=True)
    *others, last = (short(squeezed(text.source.excerpt(start, end))) for start, end in spans)
    others = others if len(listed) == len(same) else [*others, "..."]
    letter = chr(int(words.address[index]))
    address = f",{letter.upper()}" if letter.islower() else letter
    often = "twice" if len(same) == 2 else f"{len(same)} times"
    return f"{address} is written {often} in this block: {', '.join(others)} and {last}"


def times(written: Written, index: int) -> str:
    """How often the code stands in the file, where it is more than once."""
    count = int(written.unknown_code_count[index])
    return f" ({count} times in this file)" if count > 1 else ""


def written_for(dialect: Dialect) -> str:
    """For what a file in another language is written, and what shows it."""
    found = dialect.recognised
    if found is None:
        return "this file is a program in ISO code"
    return f"this file is written for {found.title}, as `{found.sign[:_SIGN_LENGTH]}` in line {found.line} shows"


def stray(text: Text, index: int) -> str:
    """What the control does with a stray character."""
    at = int(text.strays.start[index])
    character = text.source.excerpt(at, at + 1)
    if character == "%":
        return "% inside a block: for the control the program ends here"
    whole = _LAST_DIGITS.search(text.source.excerpt(max(at - _DIGITS, 0), at))
    decimals = _FIRST_DIGITS.match(text.source.excerpt(at + 1, at + 1 + _DIGITS))
    if character == "," and whole and decimals:
        return f", is no decimal point: write {whole[0]}.{decimals[0]}"
    return f"{character} is no character of a word"


def characters(written: Written, index: int) -> str:
    """How many characters of the line are foreign."""
    count = int(written.foreign_count[index])
    return "1 character that is" if count == 1 else f"{count} characters that are"


def prose(text: Text, written: Written, index: int) -> str:
    """What stands in no parentheses, beside how many blocks, and what it may be."""
    places = zip(text.prose.start[index:].tolist(), text.prose.end[index:].tolist(), strict=True)
    texts = (
        _TAG.sub(" ", text.source.excerpt(start, min(end, start + _LOOKED_AT))).strip(_LINES_AND_BLANKS)
        for start, end in itertools.islice(places, _LOOKED_AT)
    )
    first = short(" ".join(next(filter(_TWO_LETTERS.search, texts), "").split()))
    count = int(written.prose_count[index])
    where = f" in {count} blocks, first" if count > 1 else ":"
    what = "a description copied with the program: " if count >= _DESCRIPTION else ""
    return (
        f"text that stands in no parentheses{where} `{first}`; {what}the control reads each letter as an address and "
        "stops; put it in parentheses or delete it"
    )
