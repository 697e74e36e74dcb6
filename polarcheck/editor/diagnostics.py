"""Findings as diagnostics of an editor, and what was not evaluated, so that a clean text really is clean."""

from __future__ import annotations

from lsprotocol import types

from polarcheck.editor.analysis import Analysis
from polarcheck.foundation.finding import Finding
from polarcheck.program.reading.excerpt import visible

SOURCE = "polarcheck"
NOT_EVALUATED, NOT_CHECKED = "not-evaluated", "not-checked"
#: The most related places of a finding.
_MOST_RELATED = 20
_SEVERITIES = {
    "error": types.DiagnosticSeverity.Error,
    "warning": types.DiagnosticSeverity.Warning,
    "note": types.DiagnosticSeverity.Information,
}


def diagnostics(analysis: Analysis, uri: str) -> list[types.Diagnostic]:
    """Return all diagnostics of a document."""
    if analysis.report is None:
        return [
            types.Diagnostic(
                range=analysis.text.line_range(1),
                severity=types.DiagnosticSeverity.Error,
                code=NOT_CHECKED,
                source=SOURCE,
                message=visible(f"This program is not checked. {analysis.error}"),
            )
        ]
    return [*(diagnostic(finding, analysis, uri) for finding in analysis.report.findings), *_not_evaluated(analysis)]


def diagnostic(finding: Finding, analysis: Analysis, uri: str) -> types.Diagnostic:
    """Return a finding as a diagnostic, with its G12.1 and the findings that follow from it."""
    alarm = f" (alarm {finding.alarm})" if finding.alarm else ""
    return types.Diagnostic(
        range=analysis.text.range_of(finding.line, finding.column, finding.end_line, finding.end_column),
        severity=_SEVERITIES[finding.severity],
        code=finding.rule,
        source=SOURCE,
        message=visible(f"{finding.full_message}{alarm}"),
        related_information=_related(finding, analysis, uri) or None,
    )


def _related(finding: Finding, analysis: Analysis, uri: str) -> list[types.DiagnosticRelatedInformation]:
    places = []
    if finding.section_line is not None and finding.section_line != finding.line:
        places.append((analysis.text.line_range(finding.section_line), "the polar section begins here"))
    for effect in finding.follows[:_MOST_RELATED]:
        effect_range = analysis.text.range_of(effect.line, effect.column, effect.end_line, effect.end_column)
        places.append((effect_range, f"follows from it: {effect.message} [{effect.rule}]"))
    return [
        types.DiagnosticRelatedInformation(types.Location(uri, effect_range), visible(message))
        for effect_range, message in places
    ]


def _not_evaluated(analysis: Analysis) -> list[types.Diagnostic]:
    """Return a diagnostic per reason for what matters and could not be judged, at the first polar section."""
    report = analysis.report
    assert report is not None
    rules: dict[str, list[str]] = {}
    for gap in report.not_evaluated:
        if gap.matters:
            rules.setdefault(gap.reason, []).append(gap.rule)
    return [
        types.Diagnostic(
            range=analysis.text.line_range(min((section.line for section in report.polar_sections), default=1)),
            severity=types.DiagnosticSeverity.Information,
            code=NOT_EVALUATED,
            source=SOURCE,
            message=visible(f"not evaluated: {reason} [{', '.join(dict.fromkeys(names))}]"),
        )
        for reason, names in rules.items()
    ]
