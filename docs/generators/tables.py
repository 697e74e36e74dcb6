"""What generated pages begin with, and tables in Markdown."""

from __future__ import annotations

GENERATED = "<!-- Made by `python docs/make.py`: change what it is made from, not this page. -->"


def row(*cells: str) -> str:
    """Return a row of a table."""
    return f"| {' | '.join(cells)} |"


def rule_under(*heads: str) -> list[str]:
    """Return the first two rows of a table."""
    return [row(*heads), row(*["---"] * len(heads))]
