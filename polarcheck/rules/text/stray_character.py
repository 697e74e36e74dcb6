from __future__ import annotations

import re
from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.other_mode import OtherMode
    from polarcheck.columns.words.written import Written
    from polarcheck.program.reading.words import Text
    from polarcheck.rules.hit import Details, Hit

#: Most digits on either side of a decimal comma that are named.
_DIGITS = 12


@rule(
    ERROR,
    "{stray}{count:blocks}",
    values=("count",),
    worse=("count",),
    over="strays",
    subject="word",
    doubts=(("word", "block"),),
)
def stray_character(written: Written, other_mode: OtherMode) -> Hits:
    """
    Character that is no part of a word.

    A block holds letters with their numbers, and nothing else outside comments. The control stops at any other
    character. A % inside a block is the end of the program to it. Of several in a block the first is reported, each
    character once in a file, as a $ or * at the end of every block; what can be read around them is read. The quotes of
    print, which programs copied from manuals and mails have around a text, are read as the plain ones.

    Source: FANUC alarms 009 and 5010.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200 & !  (expect: stray-character)
        C10.,5            (expect: stray-character)
        X60. C0
        G13.1

    Bad:

        O0001
        G0 X60. % M3      (expect: stray-character)
        M30

    Bad, machine siemens-transmit:

        MSG(“ROUGHING”)   (expect: stray-character)
        G94 G0 X60 C0
        M30

    Good:

        %
        O0001
        T0101
        G98 G0 X60. C0 (50% & MORE)
        G1 Z-1. ,R1. F200;
        G12.1
        /2 G1 X40. F200
        C10.
        X60.
        G13.1
        M30 %
    """
    count = written.stray_count
    return Hits(
        count > 0,
        values={"count": count},
        follows={"file": other_mode.explained_strays},
    )


def details(hit: Hit, text: Text) -> Details:
    from polarcheck.program.reading.source import PRINTED_QUOTES

    at = int(text.strays.start[hit.index])
    character = text.source.excerpt(at, at + 1)
    if character == "%":
        return {"stray": "% inside a block: for the control the program ends here"}
    code = int(text.source.code[at])
    if text.blocks.is_macro[text.strays.block[hit.index]] and code in PRINTED_QUOTES:
        printed = bytes([code]).decode("cp1252")
        return {"stray": f"{printed} is a quote of print: write {PRINTED_QUOTES[code]}"}
    whole = re.search(r"(?<![0-9])[-+]?[0-9]++\Z", text.source.excerpt(max(at - _DIGITS, 0), at))
    decimals = re.match(r"[0-9]++", text.source.excerpt(at + 1, at + 1 + _DIGITS))
    if character == "," and whole and decimals:
        return {"stray": f", is no decimal point: write {whole[0]}.{decimals[0]}"}
    return {"stray": f"{character} is no character of a word"}
