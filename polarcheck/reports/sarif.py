"""SARIF 2.1.0, which GitHub code scanning, Azure DevOps and editors read from any linter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from msgspec import UNSET

from polarcheck.foundation.finding import ALLOW, BASELINE, UNREADABLE, Silenced
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports import settings_lines
from polarcheck.reports.ci import rule_help
from polarcheck.reports.ci.repository_paths import uri
from polarcheck.reports.json import encoded

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Finding, Fix, Report
    from polarcheck.reports import Background
    from polarcheck.rules.rule import Rule

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
#: The base of all paths, by the name that readers of SARIF know.
_ROOT = "%SRCROOT%"
_LEVELS = {"error": "error", "warning": "warning", "note": "note"}
_SEVERITIES = {"error": "error", "warning": "warning", "note": "recommendation"}
_SUPPRESSIONS = {ALLOW: "inSource", BASELINE: "external"}
#: The longest description that GitHub accepts [characters].
_MOST = 1024


def sarif(report: Report, background: Background) -> str:
    """Return a run with a result per finding, silenced or not, and a notification per reason for "not evaluated"."""
    has_silenced = any(file.silenced for file in report.files)
    names = sorted({finding.rule for file in report.files for finding in (*file.silenced, *file.findings)})
    indices = {name: index for index, name in enumerate(names)}
    failures = list(_failures(report, background))
    settings = [{"level": "note", "message": {"text": line}} for line in settings_lines(report)]
    notifications = [*failures, *_not_evaluated(report, background), *settings]
    run = {
        "tool": {
            "driver": {
                "name": report.tool.name,
                "version": report.tool.version,
                "semanticVersion": report.tool.version,
                "rules": [_rule(name, background.rules.get(name)) for name in names],
            }
        },
        "automationDetails": {"id": f"{report.tool.name}/"},
        "properties": {"machine": None if report.machine is None else visible(report.machine)},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"description": {"text": "The root of the repository."}}},
        "invocations": [{"executionSuccessful": not failures, "toolExecutionNotifications": notifications}],
        "results": [
            _result(finding, file, indices, background, has_silenced)
            for file in report.files
            for finding in sorted(
                (*file.findings, *file.silenced), key=lambda finding: (finding.line, finding.column, finding.rule)
            )
        ],
    }
    return encoded({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2) + "\n"


def _rule(name: str, rule: Rule | None) -> dict[str, Any]:
    """Return the entry of a rule with a result; a finding about the check itself has a rule without a page."""
    name = visible(name)
    if rule is None:
        about = {"text": name}
        return {"id": name, "shortDescription": about, "fullDescription": about, "help": about}
    severity = rule.severity.name.lower()
    return {
        "id": name,
        "shortDescription": {"text": rule.title[:_MOST]},
        "fullDescription": {"text": (rule_help.why(rule) or rule.title)[:_MOST]},
        "help": {"text": rule_help.plain(rule), "markdown": rule_help.markdown(rule)},
        "defaultConfiguration": {"level": _LEVELS[severity]},
        "properties": {"tags": [rule.group], "problem.severity": _SEVERITIES[severity]},
    }


def _artifact(file: FileReport, background: Background) -> dict[str, Any]:
    """Return the address of a file; only a relative one may have a base (SARIF1004 of the multitool)."""
    address = uri(file.path, background)
    return {"uri": address} if address.startswith("file:") else {"uri": address, "uriBaseId": _ROOT}


def _result(
    finding: Finding, file: FileReport, indices: Mapping[str, int], background: Background, has_silenced: bool
) -> dict[str, Any]:
    artifact = _artifact(file, background)
    section = finding.section_line if finding.section_line != finding.line else None
    result: dict[str, Any] = {
        "ruleId": visible(finding.rule),
        "ruleIndex": indices[finding.rule],
        "level": _LEVELS.get(finding.severity, "warning"),
        "message": {"text": _message(finding, section)},
        "locations": [
            {
                "physicalLocation": {"artifactLocation": artifact, "region": _region(finding)},
                **({"logicalLocations": [{"name": visible(finding.program)}]} if finding.program else {}),
            }
        ],
        "partialFingerprints": {"polarcheck/v1": visible(finding.fingerprint)},
        "properties": {
            "machine": visible(file.machine),
            "alarm": finding.alarm,
            "count": finding.count,
            "values": finding.values,
            "source": finding.source,
        },
    }
    if section is not None:
        location = {"artifactLocation": artifact, "region": {"startLine": section}}
        about = {"text": "the polar section begins here"}
        result["relatedLocations"] = [{"id": 1, "physicalLocation": location, "message": about}]
    if finding.fix is not None:
        result["fixes"] = [_fix(finding.fix, artifact)]
    if isinstance(finding, Silenced):
        suppression = {"kind": _SUPPRESSIONS.get(finding.by, "external"), "status": "accepted"}
        result["suppressions"] = [{**suppression, "justification": visible(finding.reason)}]
    elif has_silenced:
        result["suppressions"] = []  # without the key the state would be unknown
    if background.has_baseline:
        result["baselineState"] = "unchanged" if isinstance(finding, Silenced) and finding.by == BASELINE else "new"
    return result


def _message(finding: Finding, section: int | None) -> str:
    """Return the message; lists show its first sentence. `](` is broken up, since `[text](number)` would be a link."""
    text = visible(finding.full_message).replace("](", "] (")
    text = text.removesuffix(".") + "."
    text += f" The control shows alarm {visible(finding.alarm)}." if finding.alarm else ""
    return text + (f" The polar section begins at [line {section}](1)." if section is not None else "")


def _region(finding: Finding) -> dict[str, int]:
    return {
        "startLine": finding.line,
        "startColumn": finding.column,
        "endLine": finding.end_line,
        "endColumn": finding.end_column,
    }


def _fix(fix: Fix, artifact: Mapping[str, str]) -> dict[str, Any]:
    replacements = [
        {
            "deletedRegion": {
                "startLine": edit.line,
                "startColumn": edit.column,
                "endLine": edit.end_line,
                "endColumn": edit.end_column,
            },
            "insertedContent": {"text": edit.text},
        }
        for edit in fix.edits
    ]
    changes = [{"artifactLocation": artifact, "replacements": replacements}]
    return {"description": {"text": visible(fix.title)}, "artifactChanges": changes}


def _failures(report: Report, background: Background) -> Iterator[dict[str, Any]]:
    """Yield a notification for each file that was not checked, and for an interrupted run."""
    for file in report.files:
        if file.verdict == UNREADABLE:
            location = {"artifactLocation": _artifact(file, background)}
            about = {"text": visible(f"{file.path}: {file.reason}")}
            yield {"level": "error", "message": about, "locations": [{"physicalLocation": location}]}
    if report.interrupted is not UNSET:
        yield {"level": "error", "message": {"text": visible(report.interrupted.reason)}}


def _not_evaluated(report: Report, background: Background) -> Iterator[dict[str, Any]]:
    """Yield one per reason and file: without them a file without results would look clean."""
    for file in report.files:
        rules: dict[str, list[str]] = {}
        for gap in file.not_evaluated:
            if gap.matters:
                rules.setdefault(gap.reason, []).append(gap.rule)
        location = {"artifactLocation": _artifact(file, background)}
        for reason, names in rules.items():
            text = visible(f"not evaluated: {reason} ({', '.join(dict.fromkeys(names))})")
            yield {"level": "warning", "message": {"text": text}, "locations": [{"physicalLocation": location}]}
