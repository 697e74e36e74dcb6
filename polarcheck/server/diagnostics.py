"""Findings as an editor shows them, and what was not evaluated: no mark must mean looked at, and good."""

from __future__ import annotations

from lsprotocol import types

from polarcheck.finding import FileReport, Finding
from polarcheck.reading.excerpt import visible
from polarcheck.server.judged import Judged

SOURCE = "polarcheck"
NOT_EVALUATED, NOT_CHECKED = "not-evaluated", "not-checked"
#: Places beside a finding that are listed.
_MOST_RELATED = 20
_SEVERITIES = {
    "error": types.DiagnosticSeverity.Error,
    "warning": types.DiagnosticSeverity.Warning,
    "note": types.DiagnosticSeverity.Information,
}


def diagnostics(judged: Judged, uri: str) -> list[types.Diagnostic]:
    """All that is to be marked in a document."""
    if judged.report is None:
        return [
            types.Diagnostic(
                range=judged.text.line_range(1),
                severity=types.DiagnosticSeverity.Error,
                code=NOT_CHECKED,
                source=SOURCE,
                message=visible(f"This program is not checked. {judged.told}"),
            )
        ]
    return [*(diagnostic(found, judged, uri) for found in judged.report.findings), *_not_evaluated(judged)]


def diagnostic(found: Finding, judged: Judged, uri: str) -> types.Diagnostic:
    """A finding; beside it the G12.1 that it belongs to, and what follows from it."""
    alarm = f" (alarm {found.alarm})" if found.alarm else ""
    return types.Diagnostic(
        range=judged.text.range_of(found.line, found.column, found.end_line, found.end_column),
        severity=_SEVERITIES[found.severity],
        code=found.rule,
        source=SOURCE,
        message=visible(f"{found.told}{alarm}"),
        related_information=_related(found, judged, uri) or None,
    )


def _related(found: Finding, judged: Judged, uri: str) -> list[types.DiagnosticRelatedInformation]:
    places = []
    if found.section_line is not None and found.section_line != found.line:
        places.append((judged.text.line_range(found.section_line), "the polar section begins here"))
    for one in found.follows[:_MOST_RELATED]:
        place = judged.text.range_of(one.line, one.column, one.end_line, one.end_column)
        places.append((place, f"follows from it: {one.message} [{one.rule}]"))
    return [
        types.DiagnosticRelatedInformation(types.Location(uri, place), visible(message)) for place, message in places
    ]


def _not_evaluated(judged: Judged) -> list[types.Diagnostic]:
    """What matters and could not be judged: each reason once, at the first polar section."""
    report = judged.report
    assert report is not None
    rules: dict[str, list[str]] = {}
    for missing in report.not_evaluated:
        if missing.matters:
            rules.setdefault(missing.reason, []).append(missing.rule)
    return [
        types.Diagnostic(
            range=judged.text.line_range(_first_section(report)),
            severity=types.DiagnosticSeverity.Information,
            code=NOT_EVALUATED,
            source=SOURCE,
            message=visible(f"not evaluated: {reason} [{', '.join(dict.fromkeys(names))}]"),
        )
        for reason, names in rules.items()
    ]


def _first_section(report: FileReport) -> int:
    return min((section.line for section in report.polar_sections), default=1)
