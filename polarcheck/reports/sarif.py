"""SARIF 2.1.0: what GitHub code scanning, Azure DevOps and editors read of any linter."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

from polarcheck.finding import ALLOW, BASELINE, Silenced
from polarcheck.reading.excerpt import visible
from polarcheck.reports.ci import rule_help
from polarcheck.reports.ci.paths import uri
from polarcheck.reports.json import encoded

if TYPE_CHECKING:
    from polarcheck.checking.rule import Rule
    from polarcheck.finding import FileReport, Finding, Fix, Report
    from polarcheck.reports import Background

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
#: To whom all paths are relative, as readers of SARIF name it.
_ROOT = "%SRCROOT%"
_LEVELS = {"error": "error", "warning": "warning", "note": "note"}
_SEVERITIES = {"error": "error", "warning": "warning", "note": "recommendation"}
_SUPPRESSIONS = {ALLOW: "inSource", BASELINE: "external"}
#: Characters of a description that GitHub takes.
_MOST = 1024


def sarif(report: Report, background: Background) -> str:
    """One run with a result for each finding, silenced ones included, and a notification for what was not evaluated."""
    silenced = {one.rule: one for file in report.files for one in file.silenced}
    found = {one.rule: one for file in report.files for one in file.findings}
    names = sorted({*silenced, *found})
    indices = {name: index for index, name in enumerate(names)}
    notifications = [*_failures(background.failures), *_not_evaluated(report, background)]
    run = {
        "tool": {
            "driver": {
                "name": report.tool.name,
                "version": report.tool.version,
                "semanticVersion": report.tool.version,
                "rules": [_rule(name, background.rules.get(name), {**silenced, **found}[name]) for name in names],
            }
        },
        "automationDetails": {"id": f"{report.tool.name}/"},
        "columnKind": "unicodeCodePoints",
        "originalUriBaseIds": {_ROOT: {"description": {"text": "The root of the repository."}}},
        "invocations": [{"executionSuccessful": not background.failures, "toolExecutionNotifications": notifications}],
        "results": [
            _result(one, file, indices, background, bool(silenced))
            for file in report.files
            for one in sorted((*file.findings, *file.silenced), key=lambda one: (one.line, one.column, one.rule))
        ],
    }
    return encoded({"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}, indent=2) + "\n"


def _rule(name: str, rule: Rule | None, found: Finding) -> dict[str, Any]:
    """A rule that has a result; of one that is not known, as of a finding about the check itself, there is no page."""
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


def _result(
    found: Finding, file: FileReport, indices: Mapping[str, int], background: Background, has_silenced: bool
) -> dict[str, Any]:
    artifact = {"uri": uri(file.path, background), "uriBaseId": _ROOT}
    section = found.section_line if found.section_line != found.line else None
    result: dict[str, Any] = {
        "ruleId": visible(found.rule),
        "ruleIndex": indices[found.rule],
        "level": _LEVELS.get(found.severity, "warning"),
        "message": {"text": _message(found, section)},
        "locations": [
            {
                "physicalLocation": {"artifactLocation": artifact, "region": _region(found)},
                **({"logicalLocations": [{"name": visible(found.program)}]} if found.program else {}),
            }
        ],
        "partialFingerprints": {"polarcheck/v1": visible(found.fingerprint)},
        "properties": {"alarm": found.alarm, "count": found.count, "values": found.values, "source": found.source},
    }
    if section is not None:
        place = {"artifactLocation": artifact, "region": {"startLine": section}}
        about = {"text": "the polar section begins here"}
        result["relatedLocations"] = [{"id": 1, "physicalLocation": place, "message": about}]
    if found.fix is not None:
        result["fixes"] = [_fix(found.fix, artifact)]
    if isinstance(found, Silenced):
        suppression = {"kind": _SUPPRESSIONS.get(found.by, "external"), "status": "accepted"}
        result["suppressions"] = [{**suppression, "justification": visible(found.reason)}]
    elif has_silenced:
        result["suppressions"] = []  # left out would mean that nobody knows
    if background.has_baseline:
        result["baselineState"] = "unchanged" if isinstance(found, Silenced) and found.by == BASELINE else "new"
    return result


def _message(found: Finding, section: int | None) -> str:
    """The first sentence is what lists show. A text in brackets with a number in parentheses would be a link."""
    text = visible(found.told).replace("](", "] (")
    text = text.removesuffix(".") + "."
    text += f" The control shows alarm {visible(found.alarm)}." if found.alarm else ""
    return text + (f" The polar section begins at [line {section}](1)." if section is not None else "")


def _region(found: Finding) -> dict[str, int]:
    return {
        "startLine": found.line,
        "startColumn": found.column,
        "endLine": found.end_line,
        "endColumn": found.end_column,
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


def _failures(failures: Sequence[str]) -> Iterator[dict[str, Any]]:
    for failure in failures:
        yield {"level": "error", "message": {"text": visible(failure)}}


def _not_evaluated(report: Report, background: Background) -> Iterator[dict[str, Any]]:
    """One for each reason and file: without them a file without results would look as if all was well."""
    for file in report.files:
        rules: dict[str, list[str]] = {}
        for gap in file.not_evaluated:
            if gap.matters:
                rules.setdefault(gap.reason, []).append(gap.rule)
        place = {"artifactLocation": {"uri": uri(file.path, background), "uriBaseId": _ROOT}}
        for reason, names in rules.items():
            text = visible(f"not evaluated: {reason} ({', '.join(dict.fromkeys(names))})")
            yield {"level": "warning", "message": {"text": text}, "locations": [{"physicalLocation": place}]}
