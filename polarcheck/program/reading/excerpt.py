"""Text for terminals and logs. Text from programs and paths is data: no escape sequence or log command gets through."""

from __future__ import annotations

import re
import unicodedata

import msgspec

from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.reading.file_names import code, with_characters

_TAB = 4
_CUT = "..."
#: Commands in the log of a CI job: `::` at the head of a line, also behind blanks, and `##[` or `##vso[` anywhere.
_COMMAND = lazy_pattern(r"^([^\S\n]*+):(?=:)|##([A-Za-z]*+)\[", re.MULTILINE)
#: How many characters before the fault are shown of a line that is too long.
_BEFORE = 24


class Excerpt(msgspec.Struct, frozen=True):
    """
    A line cut to the width of a terminal.

    text: the text to show.
    first: the first underlined cell, from 0.
    marked: number of underlined cells.
    """

    text: str
    first: int
    marked: int


def visible(text: str) -> str:
    """Spell out every control, invisible or direction-changing character, as in `\\x1b`."""
    return text if text.isprintable() else "".join(map(_visible, with_characters(text)))


def without_commands(text: str) -> str:
    """Visible lines without commands for the log of a CI job: `::` at a head is `\\x3a:`, `##[` is `##\\x5b`."""
    return _COMMAND.sub(_spelled_command, text) if "::" in text or "##" in text else text


def head(path: str) -> str:
    """Return a path, visible, for the head of a line: one that a CI log would take for a command begins with `./`."""
    return without_commands(visible(f"./{path}" if path.lstrip().startswith("::") else path))


def shortened(text: str, length: int) -> str:
    """The text, cut to this length with dots behind it."""
    return text if len(text) <= length else f"{text[:length]} {_CUT}"


def cells(text: str) -> int:
    """The width of visible text [cells of a terminal]."""
    return len(text) if text.isascii() else sum(map(_cells, text))


def excerpt(line: str, start: int, end: int, room: int) -> Excerpt:
    """Cut a line to `room` cells around the characters from start (from 0) to end, which are underlined."""
    begin = _first_shown(line, start, room)
    lead = _CUT if begin else ""
    pieces: list[str] = []
    edges = [len(lead)]
    for character in line[begin:]:
        pieces.append(_expanded(character, edges[-1]))
        edges.append(edges[-1] + cells(pieces[-1]))
        if edges[-1] > room:
            break
    is_cut = edges[-1] > room
    while is_cut and edges[-1] > room - len(_CUT):
        pieces.pop()
        edges.pop()
    first = edges[min(max(start - begin, 0), len(pieces))]
    last = edges[min(max(end - begin, 0), len(pieces))]
    return Excerpt(lead + "".join(pieces) + (_CUT if is_cut else ""), first, max(last - first, 1))


def _first_shown(line: str, start: int, room: int) -> int:
    """The first character to show: in a line that is too long a little before the fault, by half the room at most."""
    if len(line) <= room and cells(visible(line)) <= room:
        return 0
    begin = max(start - _BEFORE, 0)
    while begin < start and cells(visible(line[begin:start])) > room // 2:
        begin += 1
    return begin


def _expanded(character: str, width: int) -> str:
    """Expand a tab to the next stop, and drop CR, which is part of the line end."""
    if character == "\t":
        return " " * (_TAB - width % _TAB)
    return "" if character == "\r" else _visible(character)


def _spelled_command(match: re.Match[str]) -> str:
    return f"##{match[2]}\\x5b" if match[1] is None else f"{match[1]}\\x3a"


def _visible(character: str) -> str:
    return character if character.isprintable() else code(character)


def _cells(character: str) -> int:
    if unicodedata.category(character) in ("Mn", "Me"):
        return 0
    return 2 if unicodedata.east_asian_width(character) in ("W", "F") else 1
