"""The report of a program beside what is expected of it."""

from __future__ import annotations

import re
from collections.abc import Iterator

from polarcheck.foundation.finding import FileReport, Finding, Severity
from polarcheck.rewrite.certify.manifest import Case, ExpectedFinding

#: The number of a block, its comments, and blanks: what is no word of it.
_NO_WORDS = re.compile(r"^\s*+/?\s*+N\s*+\d++|\([^()]*+\)|;.*|\s++", re.IGNORECASE)
_NOTE = Severity.NOTE.name.lower()


def differences(case: Case, report: FileReport) -> Iterator[str]:
    """
    Yield what differs from the expected findings and verdict, each in one line.

    All warnings and errors must be expected. A verdict that differs because a finding does is not mentioned again.
    """
    remaining = list(report.findings)
    lacking: list[ExpectedFinding] = []
    for expected in sorted(case.findings, key=lambda finding: finding.line is None and finding.block is None):
        match = next((finding for finding in remaining if _matches(expected, finding)), None)
        if match is None:
            lacking.append(expected)
        else:
            remaining.remove(match)
    for expected in lacking:
        elsewhere = next((finding for finding in remaining if finding.rule == expected.rule), None)
        if elsewhere is None:
            yield f"expected {expected.rule}{_location(expected)}: it is not found"
        else:
            remaining.remove(elsewhere)
            yield f"expected {expected.rule}{_location(expected)}: it is in line {elsewhere.line}"
    unexpected = [finding for finding in remaining if finding.severity != _NOTE]
    for finding in unexpected:
        yield f"line {finding.line}: {finding.severity}: {finding.full_message} [{finding.rule}]"
    if not lacking and not unexpected and report.verdict != case.expected:
        reasons = [missing.reason for missing in report.not_evaluated if missing.matters]
        because = f": {'; '.join(dict.fromkeys(reasons))}" if reasons and report.verdict == "unverified" else ""
        yield f"expected the verdict {case.expected}, found {report.verdict}{because}"


def _location(expected: ExpectedFinding) -> str:
    if expected.block is not None:
        return f" in the block {expected.block}"
    return "" if expected.line is None else f" in line {expected.line}"


def _matches(expected: ExpectedFinding, finding: Finding) -> bool:
    return (
        finding.rule == expected.rule
        and (expected.line is None or finding.line == expected.line)
        and (expected.block is None or _words(finding.block) == _words(expected.block))
    )


def _words(block: str) -> str:
    return _NO_WORDS.sub("", block).upper()
