"""Allow comments: writes one for a finding, and completes one while it is typed."""

from __future__ import annotations

import re

from lsprotocol import types

from polarcheck.columns.words import allow_mention
from polarcheck.columns.words.allow_syntax import ALLOW, FILE, OFF, ON
from polarcheck.editor.analysis import Analysis
from polarcheck.editor.open_text import OpenText
from polarcheck.editor.program_markdown import page
from polarcheck.foundation.finding import Edit, Finding
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.rule import Rule, load_all

WORD = allow_mention.WORD.decode("ascii")
_KEYWORDS = {
    ALLOW: "in this block; alone on its line, in the next one",
    FILE: "in the whole file; at its head",
    ON: "from here on",
    OFF: "up to here",
}
#: Blanks after a keyword, with an optional colon.
_BLANKS = r"(?:\s*+:)?+\s++"
_KEYWORD = re.compile(rf"[(;]\s*+{WORD}{_BLANKS}([A-Z-]*+)$", re.IGNORECASE)
#: Names are separated by commas; after a name with a hyphen a blank will do. Other words begin the reason.
_NAME = re.compile(
    rf"[(;]\s*+{WORD}{_BLANKS}ALLOW(?:-FILE|-ON|-OFF)?+{_BLANKS}"
    r"(?:[A-Z0-9-]++\s*+,\s*+|[A-Z0-9]++-[A-Z0-9-]*+\s++)*+([A-Z0-9-]*+)$",
    re.IGNORECASE,
)


def comment(rule: str, machine: Machine) -> str:
    """Return the comment in the syntax of this control, in characters that it keeps."""
    if machine.control.line_comments:
        return f"{machine.control.line_comments[0]} {WORD} {ALLOW} {rule.upper()} "
    return f"({WORD} {ALLOW} {rule.upper()} )"


def allow(finding: Finding, analysis: Analysis) -> Edit:
    """
    Return the edit that allows a finding: a comment at the end of its block, or on a line before the block.

    The latter if the block ends in a comment that would swallow the new one.
    """
    assert analysis.settings is not None
    machine, line = analysis.settings.machine, analysis.text.line_text(finding.line)
    written = comment(finding.rule, machine)
    if _is_open(line, machine) or finding.end_line != finding.line:
        ends = _line_end(analysis.text)
        return Edit(line=finding.line, column=1, end_line=finding.line, end_column=1, text=f"{written}{ends}")
    column = len(line.rstrip()) + 1
    return Edit(line=finding.line, column=column, end_line=finding.line, end_column=column, text=f" {written}")


def _is_open(line: str, machine: Machine) -> bool:
    """Return True if a comment is still open at the end of a line."""
    if line.rfind("(") > line.rfind(")"):
        return True
    marks = machine.control.line_comments
    return bool(marks) and any(mark in line for mark in marks)


def _line_end(text: OpenText) -> str:
    return "\r\n" if "\r\n" in text.text else "\n" if "\n" in text.text else "\r" if "\r" in text.text else "\n"


def completions(text: OpenText, position: types.Position, analysis: Analysis | None) -> list[types.CompletionItem]:
    """Return the completions in an allow comment: the keywords, then the names of rules and groups."""
    offset = text.offset(position)
    line = text.line_of(position)
    before = text.text[text.offset_of(line) : offset]
    keyword = _KEYWORD.search(before)
    if keyword:
        range_typed = text.range(offset - len(keyword[1]), offset)
        return [
            types.CompletionItem(
                label=name,
                kind=types.CompletionItemKind.Keyword,
                detail=detail,
                sort_text=f"{number}",
                text_edit=types.TextEdit(range_typed, f"{name} "),
            )
            for number, (name, detail) in enumerate(_KEYWORDS.items())
        ]
    name = _NAME.search(before)
    if not name:
        return []
    range_typed = text.range(offset - len(name[1]), offset)
    rules = load_all()
    near = _near(analysis, line)
    groups = dict.fromkeys(rule.group for rule in rules.values())
    return [_of_rule(rule, range_typed, rule.name in near) for rule in rules.values()] + [
        types.CompletionItem(
            label=group.upper(),
            kind=types.CompletionItemKind.Module,
            detail=f"all rules of {group}",
            sort_text=f"2{group}",
            text_edit=types.TextEdit(range_typed, f"{group.upper()} "),
        )
        for group in groups
    ]


def _near(analysis: Analysis | None, line: int) -> set[str]:
    """Return the rules with a finding in a line or the next one."""
    if analysis is None or analysis.report is None:
        return set()
    return {finding.rule for finding in analysis.report.findings if line <= finding.line <= line + 1}


def _of_rule(rule: Rule, range_typed: types.Range, is_near: bool) -> types.CompletionItem:
    name = rule.name.upper()
    return types.CompletionItem(
        label=name,
        kind=types.CompletionItemKind.EnumMember,
        detail=rule.title,
        data=rule.name,
        sort_text=f"{'0' if is_near else '1'}{rule.name}",
        preselect=is_near or None,
        text_edit=types.TextEdit(range_typed, f"{name} "),
    )


def with_page(item: types.CompletionItem, with_markdown: bool) -> types.CompletionItem:
    """Return the item of a rule with its manual page, which the list of all items leaves out."""
    rule = load_all().get(str(item.data))
    if rule is not None:
        text = rule.page.strip()
        kind = types.MarkupKind.Markdown if with_markdown else types.MarkupKind.PlainText
        item.documentation = types.MarkupContent(kind, page(text) if with_markdown else text)
    return item
