"""Names of files as text: some contain bytes that are no characters, or none in the locale."""

from __future__ import annotations

import re

from polarcheck.foundation.errors import escaped
from polarcheck.foundation.patterns import lazy_pattern

#: Bytes that the locale has no character for, as Python holds them.
_BYTES = lazy_pattern("[\udc80-\udcff]+")
_FIRST_BYTE = 0xDC00
#: Looks like a character that was spelled out.
_SPELLED = lazy_pattern(r"\\[xuU]")
#: A character that was spelled out in a name.
_PARTS = lazy_pattern(r"\\(?:(\\)|x([0-9a-f]{2})|u([0-9a-f]{4}))")


def spelled(name: str) -> str:
    """
    Spell out the bytes of a name that are no characters, as `\\xff`.

    Different names stay different, also when they are made visible: backslashes double in a name with something to
    spell out, or that looks like one.
    """
    text = with_characters(name)
    return text if text.isprintable() and not _SPELLED.search(text) else "".join(map(_in_text, text))


def unspelled(name: str) -> str:
    """The inverse of spelled(): bytes that are no characters are as Python represents them."""
    return name if name.isprintable() and not _SPELLED.search(name) else _PARTS.sub(_as_it_was, name)


def with_characters(name: str) -> str:
    """A name with the characters of its bytes in UTF-8, for a locale with ASCII only."""
    return name if name.isascii() else _BYTES.sub(_decoded, name)


def code(character: str) -> str:
    """A character that cannot be shown, or a byte, as its number: `\\x1b`, `\\u202e`."""
    number = ord(character)
    if _BYTES.match(character):
        number -= _FIRST_BYTE
    return escaped(number)


def _in_text(character: str) -> str:
    return character * 2 if character == "\\" else code(character) if "\ud800" <= character <= "\udfff" else character


def _as_it_was(match: re.Match[str]) -> str:
    backslash, byte, number = match.groups()
    return backslash or chr(int(byte, 16) + _FIRST_BYTE if byte else int(number, 16))


def _decoded(match: re.Match[str]) -> str:
    return match[0].encode("utf-8", "surrogateescape").decode("utf-8", "surrogateescape")
