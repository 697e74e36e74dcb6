"""Escapes text for Markdown: text from a program is data, and must not format anything."""

from __future__ import annotations

import re

from polarcheck.program.reading.excerpt import visible

#: Characters with a meaning. Not _ inside a word, nor * between blanks: some editors would show the backslash.
_SPECIAL = re.compile(
    r"([\\`\[\]<>~&]|(?<!\w)_|_(?!\w)|(?<!\s)\*|\*(?!\s))|^(\s*)([-+*]|#{1,6})(?=\s)|^(\s*\d+)([.)])(?=\s)"
)


def plain(text: str) -> str:
    """Escape a line of text from any source."""
    return _SPECIAL.sub(_escaped, visible(text))


def _escaped(match: re.Match[str]) -> str:
    """Put a backslash before a sign; keep blanks or a number before it at the head of the line."""
    sign, blanks, mark, number, point = match.groups()
    return f"\\{sign}" if sign else f"{blanks or number or ''}\\{mark or point}"


def page(text: str) -> str:
    """Escape a manual page; indented lines stay, which are code in Markdown, too."""
    return "\n".join(line if line.startswith("    ") else plain(line) for line in text.split("\n"))
