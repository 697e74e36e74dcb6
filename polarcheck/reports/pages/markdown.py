"""Text of manual pages and profiles as Markdown, in which nothing of it acts."""

from __future__ import annotations

import re

#: What Markdown or HTML would take for more than a character, outside of code.
_ACTING = re.compile(r"[\\`*\[\]<|~]|(?<!\w)_|_(?!\w)|^[#>]")
_CODE = re.compile(r"(`[^`\n]+`)")

MADE = "<!-- Made by `python -m polarcheck.reports.pages.site docs`: change what it is made from, not this page. -->"


def prose(text: str) -> str:
    """A paragraph; what stands between backticks stays code."""
    parts = _CODE.split(text)
    return "".join(part if index % 2 else _ACTING.sub(r"\\\g<0>", part) for index, part in enumerate(parts))


def row(*cells: str) -> str:
    """A row of a table."""
    return f"| {' | '.join(cells)} |"


def rule_under(*heads: str) -> list[str]:
    """The first two rows of a table."""
    return [row(*heads), row(*["---"] * len(heads))]
