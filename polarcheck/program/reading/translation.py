"""Replaces native words of a control by the codes that they stand for; positions do not change."""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Collection, Mapping

import numpy as np
from msgspec.structs import replace

from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.code_lists import is_code
from polarcheck.program.reading.source import Positions, Source

_BLANKS = lazy_pattern(rb"[ \t]+")


def translated(source: Source, native_words: Mapping[str, str], language: str = "custom-macro") -> Source:
    """
    The source with its native words (TRANSMIT) as codes (G12.1); its text, which reports quote, does not change.

    A blank in such a word matches any number of blanks, also none: `G17 XC` is `G17XC`. language: of its statements.
    Words of a high-level language with arguments, or with more than a number behind =, are not replaced.
    """
    # An address with a comma is read as part of a statement.
    words = tuple((word, text) for word, text in native_words.items() if text[:1] != ",")
    if not words:
        return source
    pattern, put = _translation(words, language == "high-level")
    code = pattern.sub(put, source.code.tobytes())
    return replace(source, code=np.frombuffer(code, np.uint8))


@functools.cache
def _translation(
    words: tuple[tuple[str, str], ...], has_more: bool
) -> tuple[re.Pattern[bytes], Callable[[re.Match[bytes]], bytes]]:
    """The pattern and its replacement. Longer words match first; a word ends where no further letter follows."""
    native = {word.upper().encode("latin-1"): text.encode("latin-1") for word, text in words}
    texts = {_BLANKS.sub(b"", word): text for word, text in native.items()}
    patterns = [_pattern(word) + _end(word) * has_more for word in sorted(native, key=len, reverse=True)]

    def put(match: re.Match[bytes]) -> bytes:
        return _filled(texts[_BLANKS.sub(b"", match[0].upper())], len(match[0]))

    return re.compile(_beginning(native) + b"(?:" + b"|".join(patterns) + b")", re.IGNORECASE), put


def _beginning(words: Collection[bytes]) -> bytes:
    """A pattern of the first two characters, which alone rules out nearly every place of a program."""
    spelled = [_BLANKS.sub(b"", word) for word in words]
    first, second = (b"".join({re.escape(word[index : index + 1]) for word in spelled}) for index in (0, 1))
    if any(word[1:2] in (b" ", b"\t") for word in words):
        second += rb" \t"
    return b"(?=[" + first + b"][" + second + b"])" if all(len(word) > 1 for word in spelled) else b""


def spans(source: Source, word: str) -> tuple[Positions, Positions]:
    """The starts and ends (exclusive) of a native word in a source."""
    native, code = word.upper().encode("latin-1").strip(), source.code.tobytes()
    if _BLANKS.split(native)[0] not in code.upper():  # a hundred times as fast as the pattern
        return np.zeros(0, np.int64), np.zeros(0, np.int64)
    places = [match.span() for match in re.compile(_pattern(native), re.IGNORECASE).finditer(code)]
    begins, ends = np.array(places, np.int64).reshape(-1, 2).T
    return begins, ends


def stands_in(text: str, word: str) -> bool:
    """A native word stands in a text."""
    native, code = word.upper().encode("latin-1").strip(), text.upper().encode("latin-1", "replace")
    return _BLANKS.split(native)[0] in code and re.search(_pattern(native), code) is not None


def _pattern(word: bytes) -> bytes:
    word = word.strip()
    begins = rb"(?<![A-Z_])" if word[:1].isalpha() else b""
    ends = rb"(?![A-Z0-9_])" if word[-1:].isalnum() else b""
    return begins + rb"[ \t]*+".join(map(re.escape, _BLANKS.split(word))) + ends


def _end(word: bytes) -> bytes:
    """A pattern of what must follow a word that may have arguments or a calculated value."""
    if word[-1:] == b"=":
        return rb"(?=[ \t]*+[-+]?+[0-9.]++[ \t]*+(?:[A-Z;\r\n]|\Z))"
    return rb"(?![ \t]*+[(=])"


def _filled(text: bytes, length: int) -> bytes:
    """Pad a code with leading zeros, and other text with blanks on the left, since its number follows."""
    return text[:1] + text[1:].rjust(length - 1, b"0") if is_code(text.decode("latin-1")) else text.rjust(length)
