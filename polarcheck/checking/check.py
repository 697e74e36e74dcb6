"""From bytes to findings: the one way that every command and every report goes."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import msgspec

from polarcheck.checking.engine import Engine, program_heads
from polarcheck.checking.finding import ERROR, FileReport, Finding, NotEvaluated, Severity
from polarcheck.checking.not_evaluated import unevaluated, unexecuted
from polarcheck.checking.other_machine import OtherMachine
from polarcheck.checking.rule import Rule
from polarcheck.checking.tables import Tables
from polarcheck.execution.runs import runs
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading import source
from polarcheck.table.trace import Trace

SEVERITIES = {"note": Severity.NOTE, "warning": Severity.WARNING, "error": Severity.ERROR}


def read(
    data: bytes, machine: Machine, job: Job, path: str = "-", encoding: str | None = None
) -> list[tuple[str, Tables]]:
    """The tables of each run of a file, with the state of block skip ("" where that makes no difference)."""
    found = runs(source.read(data, path, encoding), machine, job)
    return [(state, Tables(run, machine, job)) for state, run in found]


def check_file(
    data: bytes,
    machine: Machine,
    job: Job,
    rules: Sequence[Rule],
    path: str = "-",
    encoding: str | None = None,
    severities: Mapping[str, str] | None = None,
) -> FileReport:
    """All findings of the rules in one file, in the order of its lines; severities override those of the rules."""
    return check_runs(read(data, machine, job, path, encoding), rules, severities)


def check_runs(
    found: Sequence[tuple[str, Tables]], rules: Sequence[Rule], severities: Mapping[str, str] | None = None
) -> FileReport:
    """All findings of the rules in the runs of one file; what hangs on its text alone is looked for once."""
    (state, tables), *more = found
    first = check_run(tables, rules, severities)
    if not more:
        return first
    of_text = {rule.name for rule in rules if rule.of_text}
    of_run = [rule for rule in rules if not rule.of_text]
    ((other, tables),) = more
    return _merged((state, first), (other, check_run(tables, of_run, severities)), of_text)


def check_run(tables: Tables, rules: Sequence[Rule], severities: Mapping[str, str] | None = None) -> FileReport:
    """All findings of the rules in the tables of one run."""
    trace: Trace = tables["trace"]
    engine = Engine(tables, {**trace.machine.severities, **(severities or {})})
    findings: list[Finding] = []
    not_evaluated: list[NotEvaluated] = list(unexecuted(tables))
    asked = [rule for rule in rules if engine.severities.get(rule.name) != "off"]
    for rule in (rule for rule in asked if "other_machine" not in rule.parameters):
        findings += engine.findings(rule)
        not_evaluated += unevaluated(tables, rule)
    # Whether the program is one for another machine is asked last, of what this machine has made of it.
    for rule in (rule for rule in asked if "other_machine" in rule.parameters):
        tables.give("other_machine", OtherMachine(tables))
        findings += engine.findings(rule)
    findings = _sorted(_in_the_file(findings, trace))
    not_evaluated += engine.unlisted
    own = [name for block, name in program_heads(trace) if not _part(trace, int(trace.text.blocks.line[block]))]
    return FileReport(
        path=trace.text.source.path,
        programs=own,
        blocks=len(trace),
        sections=len(trace.sections),
        verdict=verdict(findings, not_evaluated),
        findings=findings,
        not_evaluated=not_evaluated,
    )


def _sorted(findings: Sequence[Finding]) -> list[Finding]:
    return sorted(findings, key=lambda found: (found.line, found.column, -SEVERITIES[found.severity], found.rule))


def _part(trace: Trace, line: int) -> tuple[str, int] | None:
    return trace.text.source.part_of(line)


def _in_the_file(findings: Sequence[Finding], trace: Trace) -> list[Finding]:
    """
    Findings in a called program that lies in another file are shown at the block that calls it.

    What its text alone has wrong is left to a check of that file.
    """
    if not trace.text.source.parts:
        return list(findings)
    found = []
    for finding in findings:
        part = _part(trace, finding.line)
        if part is None:
            found.append(finding)
            continue
        call = _call_of(trace, finding.line)
        if call is None:
            continue
        line, block = call
        text = trace.text.source.line_text(line)
        found.append(
            msgspec.structs.replace(
                finding,
                message=f"in {part[0]}, line {part[1]}, {finding.block}: {finding.message}",
                line=line,
                end_line=line,
                column=1 + len(text) - len(text.lstrip()),
                end_column=1 + len(text.rstrip()),
                block=block,
                section_line=None
                if finding.section_line and _part(trace, finding.section_line)
                else finding.section_line,
            )
        )
    return found


def _call_of(trace: Trace, line: int) -> tuple[int, str] | None:
    """The line and text of the block of this file that ran last before a line of a called program; None if none did."""
    rows = (trace.line == line).nonzero()[0]
    if not len(rows):
        return None
    first_part = trace.text.source.parts[0][0]
    own = (trace.line[: rows[0]] < first_part).nonzero()[0]
    if not len(own):
        return None
    found = int(trace.line[own[-1]])
    return found, trace.text.source.line_text(found).strip()


def _merged(first: tuple[str, FileReport], second: tuple[str, FileReport], of_text: Collection[str]) -> FileReport:
    """
    One report of the runs with block skip off and on; what only one of them shows says which.

    of_text: the rules that only the first run was asked for, since they hang on the text alone.
    """
    (skip_off, off), (skip_on, on) = first, second
    shown_off, shown_on = (
        {(found.rule, found.line, found.column) for found in report.findings} for report in (off, on)
    )

    def told(found: Finding, others: set[tuple[str, int, int]], state: str) -> Finding:
        if found.rule in of_text or (found.rule, found.line, found.column) in others:
            return found
        return msgspec.structs.replace(found, message=f"{found.message} (with block skip {state})")

    findings = [told(found, shown_on, skip_off) for found in off.findings]
    findings += [
        told(found, shown_off, skip_on)
        for found in on.findings
        if (found.rule, found.line, found.column) not in shown_off
    ]
    not_evaluated = list(dict.fromkeys((*off.not_evaluated, *on.not_evaluated)))
    findings = _sorted(findings)
    return msgspec.structs.replace(
        off,
        blocks=max(off.blocks, on.blocks),
        sections=max(off.sections, on.sections),
        findings=findings,
        not_evaluated=not_evaluated,
        verdict=verdict(findings, not_evaluated),
    )


def verdict(findings: Sequence[Finding], not_evaluated: Sequence[NotEvaluated], fail_on: str = "warning") -> str:
    """pass, fail, or unverified where something that matters was not evaluated."""
    limit = SEVERITIES.get(fail_on, ERROR + 1)
    if any(SEVERITIES[finding.severity] >= limit for finding in findings):
        return "fail"
    return "unverified" if not_evaluated else "pass"
