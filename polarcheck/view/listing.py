"""The lines of a program as a page shows them: long ones shortened, and a part of them if there are very many."""

from __future__ import annotations

from collections.abc import Iterable

from polarcheck.program.reading.excerpt import shortened
from polarcheck.program.reading.source import Source

#: The most lines and characters of a page, and characters of a line.
_LINES, _CHARACTERS, _WIDE = 100_000, 4_000_000, 400
#: Lines shown before the first one that matters, if not all are shown.
_BEFORE = 200


def listing(source: Source, wanted: Iterable[int]) -> tuple[list[str], int, int]:
    """
    Return lines of a file, the number of the first of them, and the number of all lines.

    wanted: the lines with findings and sections; if not all lines are shown, these begin shortly before the first one.
    """
    is_whole = len(source.code) <= _CHARACTERS
    text = source.text if is_whole else ""
    count = source.parts[0].first_line - 1 if source.parts else len(source.line_starts)
    first = 1
    if count > _LINES or not is_whole:
        first = max(1, min((line for line in wanted if line > 0), default=1) - _BEFORE)
    lines: list[str] = []
    left = _CHARACTERS
    for line in range(first, min(first + _LINES, count + 1)):
        shown = _line(source, line, text)
        left -= len(shown)
        if left < 0:
            break
        lines.append(shown)
    return lines, first, count


def _line(source: Source, line: int, text: str) -> str:
    """Return a line. text: all of the file, or nothing if it is long."""
    start = int(source.line_starts[line - 1])
    end = int(source.line_starts[line]) if line < len(source.line_starts) else len(source.code)
    end = min(end, start + 2 * _WIDE)
    return shortened((text[start:end] if text else source.excerpt(start, end)).rstrip("\r\n"), _WIDE)
