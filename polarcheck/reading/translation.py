"""Words of a control's own language, read as the codes that they stand for; every position stays."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Collection, Mapping

import numpy as np
from msgspec.structs import replace

from polarcheck.machines.code_lists import is_code
from polarcheck.reading.source import Positions, Source

_BLANKS = re.compile(rb"[ \t]+")


def translated(source: Source, native_words: Mapping[str, str], language: str = "custom-macro") -> Source:
    """
    The source with its own words (TRANSMIT) read as others (G12.1); what is shown stays as it is written.

    A blank in such a word stands for any number of them, or none: `G17 XC` is `G17XC`, too.
    language: of its statements. What a high-level language writes with arguments, or with more than a number behind =,
    is left to who reads its statements.
    """
    if not native_words:
        return source
    pattern, put = _translation(tuple(native_words.items()), language == "high-level")
    code = pattern.sub(put, source.code.tobytes())
    return replace(source, code=np.frombuffer(code, np.uint8))


@functools.cache
def _translation(
    words: tuple[tuple[str, str], ...], has_more: bool
) -> tuple[re.Pattern[bytes], Callable[[re.Match[bytes]], bytes]]:
    """Longer words are looked for first; a word ends where its last letter is not followed by another one."""
    own = {word.upper().encode("latin-1"): text.encode("latin-1") for word, text in words}
    meant = {_BLANKS.sub(b"", word): text for word, text in own.items()}
    found = [_pattern(word) + _end(word) * has_more for word in sorted(own, key=len, reverse=True)]

    def put(match: re.Match[bytes]) -> bytes:
        return _filled(meant[_BLANKS.sub(b"", match[0].upper())], len(match[0]))

    return re.compile(_beginning(meant) + b"(?:" + b"|".join(found) + b")", re.IGNORECASE), put


def _beginning(words: Collection[bytes]) -> bytes:
    """Return the first two characters that match: they alone rule out nearly every place of a program."""
    first, second = (b"".join({re.escape(word[at : at + 1]) for word in words}) for at in (0, 1))
    return b"(?=[" + first + b"][" + second + b"])" if all(len(word) > 1 for word in words) else b""


def spans(source: Source, word: str) -> tuple[Positions, Positions]:
    """Where a word of a control's own language stands in a source, from each place to the one behind it."""
    pattern = re.compile(_pattern(word.upper().encode("latin-1")), re.IGNORECASE)
    found = [match.span() for match in pattern.finditer(source.code.tobytes())]
    begins, ends = np.array(found, np.int64).reshape(-1, 2).T
    return begins, ends


def _pattern(word: bytes) -> bytes:
    word = word.strip()
    begins = rb"(?<![A-Z_])" if word[:1].isalpha() else b""
    ends = rb"(?![A-Z0-9_])" if word[-1:].isalnum() else b""
    return begins + rb"[ \t]*+".join(map(re.escape, _BLANKS.split(word))) + ends


def _end(word: bytes) -> bytes:
    """Return the pattern that must follow a word with arguments or a calculated value."""
    if word[-1:] == b"=":
        return rb"(?=[ \t]*+[-+]?+[0-9.]++[ \t]*+(?:[A-Z;\r\n]|\Z))"
    return rb"(?![ \t]*+[(=])"


def _filled(text: bytes, length: int) -> bytes:
    """A code with zeros before its number, which mean nothing; other text at the end, where its number follows."""
    return text[:1] + text[1:].rjust(length - 1, b"0") if is_code(text.decode("latin-1")) else text.rjust(length)
