"""Compares a program before and after fixes: its findings, and the path of the tool."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Sequence

import msgspec

from polarcheck.checking.check import check_runs, read
from polarcheck.checking.engine import LISTED
from polarcheck.checking.settings import Settings
from polarcheck.columns.trace import Trace
from polarcheck.foundation.finding import SEVERITIES, FileReport, Finding, each_finding
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.machines.axis_table import FIRST_NAMED
from polarcheck.program.reading import source
from polarcheck.program.reading.source import Source
from polarcheck.rewrite.compare.comparison_report import Difference
from polarcheck.rewrite.compare.order_meanings import meaning_steps
from polarcheck.rewrite.compare.revision_comparison import RunPair
from polarcheck.rewrite.compare.terms import EXACT, Change, Terms
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

#: A G code, and nothing else.
_ONE_CODE = re.compile(r"G[\d.]+")
#: The address of a word.
_ADDRESS = re.compile(r"\b[A-Z](?=[\d.+-])")
_VERDICTS = ("pass", "unverified", "fail")


class State(msgspec.Struct, frozen=True):
    """
    A version of a program, read and checked.

    source: the text of the file.
    runs: each run of the program by its name, with its tables.
    report: the report of all rules that are not off.
    selected: the report of the rules that the user selected; the same if none were selected.
    """

    source: Source
    runs: Sequence[tuple[str, Tables]]
    report: FileReport
    selected: FileReport


def state_of(data: bytes, settings: Settings, path: str) -> State:
    """
    Read and check a program.

    Raises SourceError for bytes that are not of the encoding, TooHardError if it takes too long.
    """
    all_rules = list(load_all().values())
    with time_limit(seconds_for(len(data), settings.job.run.max_seconds)):
        runs = read(data, settings.machine, settings.job, path, settings.encoding)
        report = check_runs(runs, all_rules, settings.severities, settings.inline)
        is_chosen = len(settings.rules) < len(all_rules)
        selected = check_runs(runs, settings.rules, settings.severities, settings.inline) if is_chosen else report
        if settings.baseline is not None:
            from polarcheck.checking.block_outline import with_outline

            selected = with_outline(selected, runs)
    # Each channel has its own view of the text; the edits are made in the file.
    return State(source.read_source(data, path, settings.encoding), runs, report, selected)


def objection(
    before: State, after: State, rules: Collection[str], changes: Sequence[Change], origin: Sequence[int]
) -> str:
    """
    Return why the fixed program must not replace the original one; empty if it may.

    rules: the rules whose findings are fixed.
    changes: what the fixes declare to change. origin: for each line of the fixed program that of the original one.
    """
    return _worse(before.report, after.report, rules) or _moves_otherwise(before, after, changes, origin)


def _worse(before: FileReport, after: FileReport, rules: Collection[str]) -> str:
    """Return a finding that is new, or that is still there after its fix; empty if there is none."""
    old, new = _by_rule(before), _by_rule(after)
    for rule, findings in new.items():
        old_findings = old.get(rule, [])
        worse = any(_rank(now) > _rank(was) for now, was in zip(findings, old_findings, strict=False))
        if len(findings) > len(old_findings) or worse:
            messages = {(finding.block, finding.message) for finding in old_findings}
            added = (finding for finding in findings if (finding.block, finding.message) not in messages)
            first = next(added, findings[0])
            return f"the result would have {rule} in line {first.line}: {first.message}"
    for rule in rules:
        if len(old.get(rule, ())) <= len(new.get(rule, ())) < LISTED:
            return f"the finding would still be there, in line {new[rule][0].line}"
    missing = {gap.rule for gap in before.not_evaluated if gap.matters}
    for gap in after.not_evaluated:
        if gap.matters and gap.rule not in missing:
            return f"the result could not be judged: {gap.reason}"
    if _VERDICTS.index(after.verdict) > _VERDICTS.index(before.verdict):
        return f"the verdict on the result would be {after.verdict}"
    return ""


def _by_rule(report: FileReport) -> dict[str, list[Finding]]:
    """Return all findings by rule, the worst first; including those that follow from others and silenced ones."""
    by_rule = defaultdict[str, list[Finding]](list)
    for finding in each_finding([*report.findings, *report.silenced]):
        by_rule[finding.rule].append(finding)
    return {rule: sorted(findings, key=_rank, reverse=True) for rule, findings in by_rule.items()}


def _rank(finding: Finding) -> int:
    return SEVERITIES[finding.severity]


def _moves_otherwise(before: State, after: State, changes: Sequence[Change], origin: Sequence[int]) -> str:
    """Return the first difference that no fix declares; empty if there is none."""
    if [name for name, _ in before.runs] != [name for name, _ in after.runs]:
        return "the program would run otherwise"
    terms = Terms(EXACT, EXACT, EXACT, changes=changes, origin=origin)
    for (_, old), (_, new) in zip(before.runs, after.runs, strict=True):
        pair = RunPair(old, new, terms)
        differences = [difference for section in pair.sections() for difference in section.differences]
        for difference in (*differences, *pair.outside()):
            if not _is_of_fix(difference, old["trace"], changes):
                return f"the result would be another: {difference.text}, in line {_line_of(difference, origin)}"
        for reason in pair.not_compared:
            if reason.matters:
                return f"the result cannot be compared: {reason.reason}"
    return ""


def _is_of_fix(difference: Difference, old: Trace, changes: Sequence[Change]) -> bool:
    """
    Return True for a difference that a fix may make: the polar mode is left, a G code gives its place to another where
    it does nothing beside the mode, words become readable.
    """
    if difference.what == "section":
        return difference.old == "open"
    if difference.what != "order":
        return False
    words = old.run.words
    addresses = {chr(number) for number in words.address[words.is_unreadable].tolist() if number < FIRST_NAMED}
    if difference.old_line is None:
        return addresses.issuperset(_ADDRESS.findall(difference.text))
    is_edited = any(difference.old_line in change.lines for change in changes)
    is_meant = any(step.line == difference.old_line for step in meaning_steps(old))
    return _ONE_CODE.fullmatch(str(difference.old)) is not None and is_edited and not is_meant


def _line_of(difference: Difference, origin: Sequence[int]) -> int:
    return difference.old_line or (origin[difference.new_line - 1] if difference.new_line else 0)
