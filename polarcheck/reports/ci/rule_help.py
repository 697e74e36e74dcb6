"""The manual page of a rule for code scanning, in plain text and in Markdown."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import TYPE_CHECKING

from polarcheck.reports.pages.markdown import prose

if TYPE_CHECKING:
    from polarcheck.rules.rule import Rule

_EXAMPLE = re.compile(r"(Bad|Good)\b[^\n]*:")
_INDENT = "    "


def why(rule: Rule) -> str:
    """Return the first paragraph below the title: what happens at the machine, and what to do about it."""
    return " ".join(rule.page.partition("\n")[2].strip().partition("\n\n")[0].split())


def plain(rule: Rule) -> str:
    """Return the page in plain text, without its examples."""
    return "\n\n".join(" ".join(part.split()) for part in _paragraphs(rule.page) if not _is_of_example(part))


def markdown(rule: Rule) -> str:
    """Return the page in Markdown, with the first example of each kind."""
    return "\n\n".join(_in_markdown(rule.page))


def _paragraphs(page: str) -> list[str]:
    return page.strip().split("\n\n")


def _is_of_example(paragraph: str) -> bool:
    return paragraph.startswith(_INDENT) or _EXAMPLE.fullmatch(paragraph) is not None


def _in_markdown(page: str) -> Iterator[str]:
    title, *rest = _paragraphs(page)
    yield f"**{prose(title)}**"
    headings: set[str] = set()
    is_shown = True
    for part in rest:
        heading = _EXAMPLE.fullmatch(part)
        if heading:
            is_shown = heading[1] not in headings
            headings.add(heading[1])
        if is_shown:
            yield part if part.startswith(_INDENT) else prose(" ".join(part.split()))
