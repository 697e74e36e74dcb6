"""JUnit's XML: a test for each file and group of rules, so that a group without findings shows as passed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING, NamedTuple

from msgspec import UNSET

from polarcheck.checking.check import FAILING, reaches
from polarcheck.foundation.finding import FAIL, UNREADABLE, Undecided
from polarcheck.reports.ci import xml
from polarcheck.reports.ci.repository_paths import from_root
from polarcheck.reports.concise import line
from polarcheck.reports.pages.resting import resting

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Finding, NotEvaluated, Report
    from polarcheck.reports import Background

#: The test of a file without a polar section.
_NOTHING = "no-polar-section"
_UNREAD = "files"


class _Case(NamedTuple):
    """
    A test.

    group: the group of rules.
    failing: the findings that fail the file, or the check.
    others: the other findings.
    missing: reasons why something could not be judged.
    is_strict: `missing` is a failure, too.
    """

    group: str
    failing: Sequence[Finding]
    others: Sequence[Finding]
    missing: Sequence[str]
    is_strict: bool

    @property
    def outcome(self) -> str:
        if self.failing or (self.missing and self.is_strict):
            return "failure"
        return "skipped" if self.missing else ""


class _Groups:
    """The groups of the rules that ran over each file, cached by the settings, which many files share."""

    def __init__(self, background: Background) -> None:
        self._settings = background.settings
        self._all = list(dict.fromkeys(rule.group for rule in background.rules.values()))
        self._cached: dict[int, list[str]] = {}

    def over(self, file: FileReport) -> list[str]:
        """Return the names of the groups, in the order of the catalogue."""
        settings = self._settings.get(file.path)
        if settings is None:
            return self._all
        if id(settings) not in self._cached:
            levels = {**settings.machine.severities, **settings.severities}
            ran = (rule.group for rule in settings.rules if rule.level(levels) != "off")
            self._cached[id(settings)] = list(dict.fromkeys(ran))
        return self._cached[id(settings)]


def junit_pieces(report: Report, background: Background) -> Iterator[str]:
    """
    Yield a suite for each file, with a test for each group of rules that ran.

    A test fails by warnings and errors, and by notes if the check ends with 1 for them; it is skipped if something that
    matters could not be judged, and passes else. A file that could not be read is an error. Two passes over the files,
    since the head holds the counts.
    """
    ran = _Groups(background)
    outcomes = Counter(case.outcome for file in report.files for case in _cases(file, background, ran))
    errors = report.summary.unreadable + (report.interrupted is not UNSET)
    counts: dict[str, str | int] = {
        "name": "polarcheck",
        "tests": outcomes.total() + errors,
        "failures": outcomes["failure"],
        "errors": errors,
    }
    yield xml.HEAD
    inside = (part for file in report.files for part in _suite(file, background, ran))
    interrupted = report.interrupted
    end = () if interrupted is UNSET else _not_checked("interrupted", "interrupted", interrupted.reason)
    yield from xml.element("testsuites", counts, chain(inside, end))


def _not_checked(path: str, kind: str, reason: str) -> Iterator[str]:
    """Yield a suite with one test that is an error: of a file that was not checked, or of the rest of the run."""
    counts: dict[str, str | int] = {"name": path, "tests": 1, "failures": 0, "errors": 1, "skipped": 0}
    inside = xml.of_text("error", {"type": kind, "message": reason}, [reason], depth=3)
    test = xml.element("testcase", {"classname": f"polarcheck.{_UNREAD}", "name": path}, [inside], depth=2)
    return xml.element("testsuite", counts, test, depth=1)


def _cases(file: FileReport, background: Background, ran: _Groups) -> Iterator[_Case]:
    """Yield the tests of a file; none for an unreadable one, which is an error."""
    if file.verdict == UNREADABLE:
        return
    settings = background.settings.get(file.path)
    fail_on, is_strict = (settings.fail_on, settings.strict) if settings else ("warning", False)
    findings: dict[str, list[Finding]] = {}
    missing: dict[str, list[NotEvaluated]] = {}
    for finding in file.findings:
        findings.setdefault(_group(finding.rule, background), []).append(finding)
    for gap in file.not_evaluated:
        if gap.matters:
            missing.setdefault(_group(gap.rule, background), []).append(gap)
    groups = ran.over(file) if file.sections else [_NOTHING]
    for group in dict.fromkeys((*groups, *sorted({*findings, *missing}))):
        reaching = [
            finding for finding in findings.get(group, ()) if reaches(finding, FAILING) or reaches(finding, fail_on)
        ]
        failing = [finding for finding in reaching if not isinstance(finding, Undecided)]
        reasons = [finding.message for finding in reaching if isinstance(finding, Undecided)]
        reasons += [gap.reason for gap in missing.get(group, ())]
        not_failing = [finding for finding in findings.get(group, ()) if finding not in failing]
        yield _Case(group, failing, not_failing, list(dict.fromkeys(reasons)), is_strict)


def _group(rule: str, background: Background) -> str:
    return background.rules[rule].group if rule in background.rules else rule


def _suite(file: FileReport, background: Background, ran: _Groups) -> Iterator[str]:
    path = from_root(file.path, background)
    if file.verdict == UNREADABLE:
        return _not_checked(path, UNREADABLE, file.reason or "")
    cases = list(_cases(file, background, ran))
    outcomes = [case.outcome for case in cases]
    counts: dict[str, str | int] = {
        "name": path,
        "tests": len(cases),
        "failures": outcomes.count("failure"),
        "errors": 0,
        "skipped": outcomes.count("skipped"),
    }
    inside = [part for case in cases for part in _test(case, path, file)]
    rests_on = list(resting(file)) if file.verdict != FAIL else []
    if rests_on:
        inside.append(xml.of_text("system-out", {}, rests_on, depth=2))
    return xml.element("testsuite", counts, inside, depth=1)


def _test(case: _Case, path: str, file: FileReport) -> Iterator[str]:
    """Return a test with the path as its name and the group as its class: readers split class names at the last dot."""
    inside = []
    if case.outcome:
        messages = [finding.full_message for finding in case.failing] or list(case.missing)
        more = f" (and {len(messages) - 1} more)" if len(messages) > 1 else ""
        kind = case.failing[0].severity if case.failing else "unverified"
        lines = [
            *(line(file, finding) for finding in case.failing),
            *(f"not evaluated: {finding}" for finding in case.missing),
        ]
        inside.append(xml.of_text(case.outcome, {"type": kind, "message": messages[0] + more}, lines, depth=3))
    if case.others:
        inside.append(xml.of_text("system-out", {}, (line(file, finding) for finding in case.others), depth=3))
    return xml.element("testcase", {"classname": f"polarcheck.{case.group}", "name": path}, inside, depth=2)
