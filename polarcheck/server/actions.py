"""What an editor offers at a finding: its fix, and a comment that allows it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lsprotocol import types

from polarcheck.checking.rule import load_all
from polarcheck.finding import Edit, Finding
from polarcheck.reading.excerpt import visible
from polarcheck.server.allowing import allow
from polarcheck.server.diagnostics import diagnostic
from polarcheck.server.judged import Judged

#: Findings of a selection that actions are offered for.
_MOST = 50


def actions(
    judged: Judged, uri: str, version: int | None, selected: types.Range, with_versions: bool
) -> list[types.CodeAction]:
    """
    The actions for the findings in a selection, those of one finding one after the other.

    version: of the document, which an edit is for. with_versions: whether the editor knows what that is.
    """
    return [
        types.CodeAction(
            title=visible(title),
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[diagnostic(found, judged, uri)],
            is_preferred=is_preferred or None,
            edit=_edit(edits, judged, uri, version, with_versions),
        )
        for found in _in(judged, selected)[:_MOST]
        for title, is_preferred, edits in _offered(found, judged)
    ]


def _in(judged: Judged, selected: types.Range) -> list[Finding]:
    if judged.report is None:
        return []
    text = judged.text
    first, last = text.offset(selected.start), text.offset(selected.end)
    return [
        found
        for found in judged.report.findings
        if text.offset_of(found.line, found.column) <= last
        and text.offset_of(found.end_line, found.end_column) >= first
    ]


def _offered(found: Finding, judged: Judged) -> Iterator[tuple[str, bool, list[Edit]]]:
    if found.fix is not None:
        # An editor may take what is preferred without showing it: nothing that moves an axis.
        note = "" if found.fix.safe else " (moves an axis: look at it)"
        yield f"{found.fix.title}{note}", found.fix.safe, found.fix.edits
    rule = load_all().get(found.rule)
    if judged.settings is not None and judged.settings.inline and (rule is None or rule.group != "silence"):
        yield f"Allow {found.rule} here", False, [allow(found, judged)]


def _edit(
    edits: Iterable[Edit], judged: Judged, uri: str, version: int | None, with_versions: bool
) -> types.WorkspaceEdit:
    changes = [
        types.TextEdit(judged.text.range_of(one.line, one.column, one.end_line, one.end_column), one.text)
        for one in edits
    ]
    if with_versions:
        document = types.OptionalVersionedTextDocumentIdentifier(uri, version)
        return types.WorkspaceEdit(document_changes=[types.TextDocumentEdit(document, list(changes))])
    return types.WorkspaceEdit(changes={uri: changes})
