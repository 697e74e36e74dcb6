"""The code actions of a finding: its fix, and a comment that allows it."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from lsprotocol import types

from polarcheck.editor.allowing import allow
from polarcheck.editor.analysis import Analysis
from polarcheck.editor.diagnostics import diagnostic
from polarcheck.foundation.finding import Edit, Finding
from polarcheck.program.reading.excerpt import visible
from polarcheck.rules.rule import load_all

#: The most findings of a selection for which actions are offered.
_MOST = 50


def actions(
    analysis: Analysis, uri: str, version: int | None, selected: types.Range, with_versions: bool
) -> list[types.CodeAction]:
    """
    Return the actions for the findings in a selection, grouped by finding.

    version: the version of the document that the edits apply to.
    with_versions: the editor supports versions of documents.
    """
    return [
        types.CodeAction(
            title=visible(title),
            kind=types.CodeActionKind.QuickFix,
            diagnostics=[diagnostic(finding, analysis, uri)],
            is_preferred=is_preferred or None,
            edit=_edit(edits, analysis, uri, version, with_versions),
        )
        for finding in analysis.findings_in(selected.start, selected.end)[:_MOST]
        for title, is_preferred, edits in _offered(finding, analysis)
    ]


def _offered(finding: Finding, analysis: Analysis) -> Iterator[tuple[str, bool, list[Edit]]]:
    if finding.fix is not None:
        # An editor may apply a preferred action unseen, so a fix that moves an axis is not preferred.
        note = "" if finding.fix.safe else " (moves an axis: look at it)"
        yield f"{finding.fix.title}{note}", finding.fix.safe, finding.fix.edits
    rule = load_all().get(finding.rule)
    if analysis.settings is not None and analysis.settings.inline and (rule is None or rule.group != "silence"):
        yield f"Allow {finding.rule} here", False, [allow(finding, analysis)]


def _edit(
    edits: Iterable[Edit], analysis: Analysis, uri: str, version: int | None, with_versions: bool
) -> types.WorkspaceEdit:
    changes = [
        types.TextEdit(analysis.text.range_of(edit.line, edit.column, edit.end_line, edit.end_column), edit.text)
        for edit in edits
    ]
    if with_versions:
        document = types.OptionalVersionedTextDocumentIdentifier(uri, version)
        return types.WorkspaceEdit(document_changes=[types.TextDocumentEdit(document, list(changes))])
    return types.WorkspaceEdit(changes={uri: changes})
