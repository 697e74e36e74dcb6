"""A plain reader of words, one character after another, to test the fast one against."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field

DASHES = "\u2013\u2014\u2212"
SIGNS = "+-" + DASHES
IN_NUMBER = "0123456789." + SIGNS
BLANKS = "".join(map(chr, range(33))) + "\x7f\xa0"
LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz/"


@dataclass
class Word:
    """address: as in the table of words; parts: the characters of the number; last: where its last one stands."""

    address: str
    line: int
    start: int
    last: int
    parts: str = ""

    @property
    def digits(self) -> int:
        return sum(character.isdigit() for character in self.parts)

    @property
    def decimals(self) -> int:
        return sum(character.isdigit() for character in self.parts.rpartition(".")[2]) if "." in self.parts else 0

    @property
    def value(self) -> float:
        """NaN without digits; else of the digits and the last point, negative with any minus."""
        if not self.digits or not self.address:
            return math.nan
        whole = "".join(character for character in self.parts if character.isdigit())
        number = float(f"{whole}e-{self.decimals}")
        return -number if set(self.parts) & set("-" + DASHES) else number

    @property
    def fault(self) -> str:
        if not self.address:
            return "NO_ADDRESS"
        if not self.digits:
            return "NONE" if self.address == "/" and not self.parts else "NO_DIGITS"
        body = self.parts.lstrip(SIGNS)
        if self.parts.count(".") > 1:
            return "TWO_POINTS"
        if sum(character in SIGNS for character in self.parts) > 1:
            return "TWO_SIGNS"
        if any(character in SIGNS for character in body):
            return "SIGN_AFTER_DIGITS"
        return "WRONG_DASH" if set(self.parts) & set(DASHES) else "NONE"


@dataclass
class Reading:
    """What the oracle finds in a text."""

    words: list[Word] = field(default_factory=list)
    strays: list[int] = field(default_factory=list)
    comments: list[tuple[int, int, bool, bool]] = field(default_factory=list)
    dots: list[tuple[int, int]] = field(default_factory=list)


def read(text: str) -> Reading:
    """The words of a text without % and <, all of which is program."""
    found = Reading()
    place = 0
    for number, line in enumerate(text.split("\n"), 1):
        plain = _without_comments(line, place, found)
        semicolon = plain.find(";")
        if semicolon >= 0 and plain[semicolon + 1 :].strip(BLANKS) and not _reads_as_blocks(plain[semicolon + 1 :]):
            found.comments.append((place + semicolon, place + len(line), False, False))
            plain = plain[:semicolon]
        at = place
        for block in plain.split(";"):
            _read_block(block, at, number, found)
            at += len(block) + 1
        place += len(line) + 1
    return found


def _without_comments(line: str, place: int, found: Reading) -> str:
    shown = list(line)
    opened = -1
    nested = False
    for index, character in enumerate(line):
        if opened < 0 and character == "(":
            opened, nested = index, False
        elif opened >= 0 and character == "(":
            nested = True
        elif opened >= 0 and character == ")":
            found.comments.append((place + opened, place + index + 1, False, nested))
            shown[opened : index + 1] = " " * (index + 1 - opened)
            opened = -1
    if opened >= 0:
        found.comments.append((place + opened, place + len(line), True, nested))
        shown[opened:] = " " * (len(line) - opened)
    return "".join(shown)


def _reads_as_blocks(text: str) -> bool:
    at = 0
    while True:
        begin = at
        while at < len(text) and text[at] in " \t\r\x0b\x0c;/":
            at += 1
        if at == len(text):
            return "/" not in text[begin:at]
        if not (text[at].isascii() and text[at].isalpha()):
            return False
        at += 1
        while at < len(text) and text[at] in " \t\r\x0b\x0c":
            at += 1
        number = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+|[#\[][-+*/#\[\]\w.]*)", re.ASCII).match(text, at)
        if not number:
            return False
        at = number.end()


def _read_block(block: str, place: int, line: int, found: Reading) -> None:
    words: list[Word] = []
    strays: list[int] = []
    is_macro = False
    comma = -1
    empty = True
    for index, character in enumerate(block):
        at = place + index
        if character in BLANKS:
            continue
        following = block[index + 1 :].lstrip(BLANKS)[:1]
        if character in LETTERS or (character == ":" and empty):
            address = "O" if character == ":" else character.upper()
            words.append(Word(address.lower(), line, comma, at) if comma >= 0 else Word(address, line, at, at))
            comma = -1
        elif character in IN_NUMBER:
            if not words:
                words.append(Word("", line, at, at))
            words[-1].parts += character
            words[-1].last = at
        elif character == "," and following and following in "CRAcra":
            comma = at
        elif character in "#[]=*":
            is_macro = True
        else:
            strays.append(at)
        empty = False
    if len(words) == 1 and not words[0].address and set(words[0].parts) == {"."} and len(words[0].parts) > 2:
        found.dots.append((words[0].start, words[0].last + 1))
        words = []
    if len(words) > 1 and words[0].address == "O" and ":" in block.lstrip(BLANKS)[:1]:
        words[0].address = "N"
    if is_macro or _is_statement(words):
        found.strays += [at for at in strays[-1:] if not block[at - place + 1 :].strip(BLANKS)]
        return
    found.words += words
    found.strays += strays


def _is_statement(words: list[Word]) -> bool:
    """Letters at the head of the block, or behind N or /, spell a macro statement."""
    letters = "".join((word.address or "?") + ("1" if word.digits else "") for word in words)
    heads = [0, *(match.end() for match in re.finditer("[N/]1?", letters))]
    return any(re.compile("GOTO|GO1|DO1|END1|EN1|WHILE|POPEN|PCLOS").match(letters, head) for head in heads)
