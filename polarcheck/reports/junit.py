"""JUnit's XML: a test for each file and group of rules, so that what was looked at and is clean shows as passed."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from polarcheck.checking.check import is_told
from polarcheck.finding import Undecided
from polarcheck.reports.ci import xml
from polarcheck.reports.ci.paths import from_root
from polarcheck.reports.concise import line
from polarcheck.reports.pages.resting import resting

if TYPE_CHECKING:
    from polarcheck.finding import FileReport, Finding, NotEvaluated, Report
    from polarcheck.reports import Background

#: The test of a file in which there was nothing to judge.
_NOTHING = "no-polar-section"
_UNREAD = "files"


class _Case(NamedTuple):
    """
    A test: of which group; findings that fail, those that do not, what could not be judged, and whether that fails.
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


class _Ran:
    """The groups of the rules that ran over a file: of many files few differ."""

    def __init__(self, background: Background) -> None:
        self._settings = background.settings
        self._every = list(dict.fromkeys(rule.group for rule in background.rules.values()))
        self._known: dict[int, list[str]] = {}

    def over(self, file: FileReport) -> list[str]:
        """The names of the groups, in the order of the catalogue."""
        settings = self._settings.get(file.path)
        if settings is None:
            return self._every
        if id(settings) not in self._known:
            levels = {**settings.machine.severities, **settings.severities}
            ran = (rule.group for rule in settings.rules if rule.level(levels) != "off")
            self._known[id(settings)] = list(dict.fromkeys(ran))
        return self._known[id(settings)]


def junit(report: Report, background: Background) -> str:
    """
    A suite for each file, in which each group of rules that ran is a test: passed, failed by findings of the severity
    that fails, or skipped where something that matters could not be judged. What could not be read is an error.
    """
    return "".join(junit_pieces(report, background))


def junit_pieces(report: Report, background: Background) -> Iterator[str]:
    """The same, file by file; they are gone through twice, since the counts stand at the head."""
    ran = _Ran(background)
    outcomes = Counter(case.outcome for file in report.files for case in _cases(file, background, ran))
    counts: dict[str, str | int] = {
        "name": "polarcheck",
        "tests": outcomes.total() + len(background.failures),
        "failures": outcomes["failure"],
        "errors": len(background.failures),
    }
    yield xml.HEAD
    inside = (part for file in report.files for part in _suite(file, background, ran))
    yield from xml.element("testsuites", counts, _all(inside, background))


def _all(suites: Iterator[str], background: Background) -> Iterator[str]:
    yield from suites
    failures = background.failures
    if failures:
        counts: dict[str, str | int] = {"name": _UNREAD, "tests": len(failures), "failures": 0, "errors": len(failures)}
        yield from xml.element("testsuite", counts, (part for one in failures for part in _unread(one)), depth=1)


def _unread(failure: str) -> Iterator[str]:
    inside = xml.of_text("error", {"type": "error", "message": failure}, [failure], depth=3)
    return xml.element("testcase", {"classname": f"polarcheck.{_UNREAD}", "name": failure}, [inside], depth=2)


def _cases(file: FileReport, background: Background, ran: _Ran) -> Iterator[_Case]:
    settings = background.settings.get(file.path)
    fail_on, is_strict = (settings.fail_on, settings.strict) if settings else ("warning", False)
    found: dict[str, list[Finding]] = {}
    missing: dict[str, list[NotEvaluated]] = {}
    for one in file.findings:
        found.setdefault(_group(one.rule, background), []).append(one)
    for gap in file.not_evaluated:
        if gap.matters:
            missing.setdefault(_group(gap.rule, background), []).append(gap)
    groups = ran.over(file) if file.sections else [_NOTHING]
    for group in dict.fromkeys((*groups, *sorted({*found, *missing}))):
        told = [one for one in found.get(group, ()) if is_told(one, fail_on)]
        failing = [one for one in told if not isinstance(one, Undecided)]
        reasons = [one.message for one in told if isinstance(one, Undecided)]
        reasons += [gap.reason for gap in missing.get(group, ())]
        others = [one for one in found.get(group, ()) if one not in failing]
        yield _Case(group, failing, others, list(dict.fromkeys(reasons)), is_strict)


def _group(rule: str, background: Background) -> str:
    return background.rules[rule].group if rule in background.rules else rule


def _suite(file: FileReport, background: Background, ran: _Ran) -> Iterator[str]:
    path = from_root(file.path, background)
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
    rests_on = list(resting(file)) if file.verdict != "fail" else []
    if rests_on:
        inside.append(xml.of_text("system-out", {}, rests_on, depth=2))
    return xml.element("testsuite", counts, inside, depth=1)


def _test(case: _Case, path: str, file: FileReport) -> Iterator[str]:
    """Files are the names of tests and groups their classes: readers split the name of a class at its last point."""
    inside = []
    if case.outcome:
        messages = [one.told for one in case.failing] or list(case.missing)
        more = f" (and {len(messages) - 1} more)" if len(messages) > 1 else ""
        kind = case.failing[0].severity if case.failing else "unverified"
        lines = [*(line(file, one) for one in case.failing), *(f"not evaluated: {one}" for one in case.missing)]
        inside.append(xml.of_text(case.outcome, {"type": kind, "message": messages[0] + more}, lines, depth=3))
    if case.others:
        inside.append(xml.of_text("system-out", {}, (line(file, one) for one in case.others), depth=3))
    return xml.element("testcase", {"classname": f"polarcheck.{case.group}", "name": path}, inside, depth=2)
