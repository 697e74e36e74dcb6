"""Text as Markdown that shows it: what comes from a program is data, and formats nothing."""

from __future__ import annotations

import re

from polarcheck.reading.excerpt import visible

_MEANS_SOMETHING = re.compile(r"([\\`*_{}\[\]<>#|~&!])|^(\s*)([-+]|\d+[.)])(?=\s)")


def plain(text: str) -> str:
    """Words that come from anywhere, in one line."""
    return _MEANS_SOMETHING.sub(lambda found: f"\\{found[1]}" if found[1] else f"{found[2]}\\{found[3]}", visible(text))


def page(text: str) -> str:
    """A manual page: indented lines stay as they are, which is code in Markdown, too."""
    return "\n".join(line if line.startswith("    ") else plain(line) for line in text.split("\n"))
