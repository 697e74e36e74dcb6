"""Text as Markdown that shows it: what comes from a program is data, and formats nothing."""

from __future__ import annotations

import re

from polarcheck.reading.excerpt import visible

#: Not _ inside a word, nor * between blanks: some editors show what stands before a sign to make it one.
_MEANS_SOMETHING = re.compile(
    r"([\\`\[\]<>~&]|(?<!\w)_|_(?!\w)|(?<!\s)\*|\*(?!\s))|^(\s*)([-+*]|#{1,6})(?=\s)|^(\s*\d+)([.)])(?=\s)"
)


def plain(text: str) -> str:
    """Words that come from anywhere, in one line."""
    return _MEANS_SOMETHING.sub(_escaped, visible(text))


def _escaped(found: re.Match[str]) -> str:
    """A sign behind a backslash; what stands before it at the head of the line stays."""
    sign, blanks, mark, number, point = found.groups()
    return f"\\{sign}" if sign else f"{blanks or number or ''}\\{mark or point}"


def page(text: str) -> str:
    """A manual page: indented lines stay as they are, which is code in Markdown, too."""
    return "\n".join(line if line.startswith("    ") else plain(line) for line in text.split("\n"))
