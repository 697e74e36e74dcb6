"""Measures text, and breaks it into lines."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache
from typing import TYPE_CHECKING

from matplotlib.font_manager import FontProperties, findfont, get_font
from matplotlib.ft2font import LoadFlags

from polarcheck.program.reading.excerpt import visible

if TYPE_CHECKING:
    from matplotlib.ft2font import FT2Font

#: The font comes with matplotlib.
FONT = "DejaVu Sans"
#: Stands for a character that the font lacks.
_LACKING = "\ufffd"
#: The size at which characters are measured [points].
_SIZE = 100.0
#: Points in a millimeter.
_POINTS = 72 / 25.4


def printable(text: str) -> str:
    """Return text without control characters and without characters that the font lacks."""
    known = _glyphs(False)
    return "".join(sign if ord(sign) in known else _LACKING for sign in visible(text.replace("\t", " ")))


@cache
def _font(bold: bool) -> FT2Font:
    return get_font(findfont(FontProperties(family=FONT, weight="bold" if bold else "normal")))


@cache
def _glyphs(bold: bool) -> dict[int, int]:
    """Return the glyph of each character."""
    return dict(_font(bold).get_charmap())


@cache
def _advance(sign: str, bold: bool) -> float:
    """Return the width of a character of a font of one point [points]."""
    font = _font(bold)
    font.set_size(_SIZE, 72)
    return float(font.load_char(ord(sign), LoadFlags.NO_HINTING).linearHoriAdvance) / 65536 / _SIZE


def wrapped(text: str, width: float, size: float, most: int = 4, *, bold: bool = False) -> list[str]:
    """
    Break a text into lines.

    width: of a line [mm].
    size: of the font [points].
    most: the number of lines; what does not fit is cut, with dots.
    """
    room = width * _POINTS / size
    lines: list[str] = []
    line, used = "", 0.0
    for word in _words(printable(text), room, bold):
        wide = sum(_advance(sign, bold) for sign in word)
        blank = _advance(" ", bold)
        if not line or used + blank + wide <= room:
            line, used = (f"{line} {word}", used + blank + wide) if line else (word, wide)
            continue
        lines.append(line)
        line, used = word, wide
        if len(lines) == most:
            return [*lines[:-1], f"{lines[-1]} ..."]
    return [*lines, line] if line else lines


def _words(text: str, room: float, bold: bool) -> Iterator[str]:
    """Yield the words; one that is wider than a line is broken."""
    for word in text.split():
        begin, used = 0, 0.0
        for place, sign in enumerate(word):
            used += _advance(sign, bold)
            if used > room:
                yield word[begin:place]
                begin, used = place, _advance(sign, bold)
        yield word[begin:]
