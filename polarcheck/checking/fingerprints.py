"""
The fingerprint of a finding: its rule and its block as the control reads it.

It stays the same where a program is renumbered, punched out, moved, or changed elsewhere. The same block twice has the
same fingerprint; equal fingerprints are counted.
"""

from __future__ import annotations

import re

from polarcheck.foundation.arrays import stretch
from polarcheck.foundation.digest import sha256_of
from polarcheck.program.reading.words import Text
from polarcheck.rules.places import Place
from polarcheck.rules.rule import Rule

#: Characters of a block that count; no block written by hand is longer.
_LONGEST = 4000
_BLANKS = re.compile(r"[\0-\x20\x7f\xa0;]+")
_SEQUENCE_NUMBER = re.compile(r"^(/?)N\d+")
_NUMBER = re.compile(r"(\d*)\.(\d*)|(\d+)")
#: A sign that changes nothing: behind an address, not between two terms.
_PLUS = re.compile(r"(?<=[A-Z=])\+(?=[\d.])")


def fingerprint(rule: Rule, text: Text, element: Place) -> str:
    """16 hexadecimal digits, the same for the same rule in the same block, wherever that stands."""
    words = "" if rule.over == "files" else _words(text, element)
    return sha256_of(f"{rule.name}\0{words}".encode("utf-8", "replace"))[:16]


def _words(text: Text, element: Place) -> str:
    """The words of the block; where it has none, as before a comment, the characters at fault."""
    start, end = int(text.blocks.start[element.block]), int(text.blocks.end[element.block])
    end = min(end, start + _LONGEST)
    normalized = normal(_without_comments(text, start, end))
    return normalized or normal(text.source.excerpt(element.start, min(element.end, element.start + _LONGEST)))


def _without_comments(text: Text, start: int, end: int) -> str:
    comments = text.comments
    pieces, copied = [], start
    for number in range(*stretch(comments.start, start, end)):
        pieces.append(text.source.excerpt(copied, max(int(comments.start[number]), copied)))
        copied = max(copied, int(comments.end[number]))
    return "".join([*pieces, text.source.excerpt(copied, end) if copied < end else ""])


def normal(words: str) -> str:
    """A block without comments in one spelling: N G01 X+05.0 is G1X5. in any case, with or without blanks."""
    shortened = _BLANKS.sub("", words).upper().replace(":", "O")
    return _NUMBER.sub(_shortest, _PLUS.sub("", _SEQUENCE_NUMBER.sub(r"\1", shortened)))


def _shortest(number: re.Match[str]) -> str:
    """Without zeros that mean nothing. The point stays: without it the number is one of increments."""
    if number[3] is not None:
        return number[3].lstrip("0") or "0"
    return f"{number[1].lstrip('0')}.{number[2].rstrip('0')}"
