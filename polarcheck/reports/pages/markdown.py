"""Escapes the text of manual pages and profiles for Markdown."""

from __future__ import annotations

import re

#: Characters with a meaning in Markdown or HTML, outside code.
_SPECIAL = re.compile(r"[\\`*\[\]<|~]|(?<!\w)_|_(?!\w)|^[#>]")
_CODE = re.compile(r"(`[^`\n]+`)")


def prose(text: str) -> str:
    """Escape a paragraph; text between backticks stays code."""
    parts = _CODE.split(text)
    return "".join(part if index % 2 else _SPECIAL.sub(r"\\\g<0>", part) for index, part in enumerate(parts))
