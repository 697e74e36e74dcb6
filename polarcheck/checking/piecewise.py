"""One report of a large program that is checked in pieces: what that of all of it as one table would be."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from itertools import compress
from typing import NamedTuple

import numpy as np

from polarcheck.arrays import Rows
from polarcheck.checking.check import engine_of, looked_at, verdict
from polarcheck.checking.engine import LISTED, Engine, in_order
from polarcheck.checking.not_evaluated import NAMED, SAID, Missing, told, unevaluated, unexecuted
from polarcheck.checking.pieces import Piece, in_pieces
from polarcheck.checking.polar_sections import polar_sections
from polarcheck.checking.rule import Rule
from polarcheck.errors import IsOneError
from polarcheck.finding import FileReport
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading.source import Source
from polarcheck.table.radius_comments import Found
from polarcheck.table.trace import Trace

#: Spans that end with their section, so that no other piece has more of it.
_WITHIN = {"", "block", "section", "loop", "pause", "way", "wall", "slot", "mesh", "tight arc", "narrow loop", "row"}
#: Spans that go on through all pieces.
_WHOLE = {"file", "program"}
#: Tables that look at all of the program at once: what a piece finds in them may stand elsewhere, or not at all.
_OF_PROGRAM = {"coverage"}


class _Judged(NamedTuple):
    """
    What came of a piece.

    found: the names of the rules that have found something; continued: of those that have in what began before.
    missing: where each rule could not look. called: the offsets that it calls, by key, and the R that comments give
    them.
    """

    report: FileReport
    found: set[str]
    continued: set[str]
    missing: dict[str, list[Missing]]
    called: dict[str, Found | None]


def check_in_pieces(
    source: Source, machine: Machine, job: Job, rules: Sequence[Rule], severities: Mapping[str, str] | None
) -> tuple[FileReport, set[str]]:
    """
    All findings in a program, and the keys of the offsets that it calls.

    Raises IsOneError where all of the program has to be known at once.
    """
    judged: list[_Judged] = []
    shown: dict[str, Rows] = {}
    for piece in in_pieces(source, machine, job):
        engine = engine_of(piece.tables, rules, severities, inline=False, own=piece.own)
        judged.append(_judged(piece, engine))
        if judged[1:] and not _agree(shown, engine.shown, piece):
            raise IsOneError
        # At the very end of what it knows a piece finds that the program goes no further.
        last = piece.tables["trace"].line[-1:]
        shown = {name: lines[lines < last] for name, lines in engine.shown.items()} if len(last) else {}
        piece.tables.forget()
    if _hang_together(judged, rules):
        raise IsOneError
    return _united(judged, machine), set[str]().union(*(one.called for one in judged))


def _judged(piece: Piece, engine: Engine) -> _Judged:
    tables = piece.tables
    trace: Trace = tables["trace"]
    if trace.is_large_unpointed.any() or tables["dialect"].recognised is not None or any(unexecuted(tables)):
        raise IsOneError
    findings = engine.findings()
    if engine.unlisted:
        raise IsOneError
    rows = piece.own_rows
    missing = {name: [*unevaluated(tables, rule, rows)] for name, rule in engine.rules.items()}
    begun = [row in rows for row in trace.sections.enter.tolist()]
    report = FileReport(
        path=trace.text.source.path,
        programs=[name for block, name in engine.heads if block in piece.own],
        blocks=len(rows),
        sections=sum(begun),
        verdict="",
        polar_sections=[*compress(polar_sections(tables), begun)],
        findings=findings,
        not_evaluated=[],
        looked_at=looked_at(tables),
    )
    every = {one.rule for found in findings for one in (found, *found.follows)}
    comments = trace.radius_told
    called = {trace.offset_key(number): comments.get(number) for number in trace.called_offsets}
    return _Judged(report, every, engine.continued, missing, called)


def _agree(before: Mapping[str, Rows], now: Mapping[str, Rows], piece: Piece) -> bool:
    """
    Whether two pieces find the same in what both have: in the blocks of the one that still count for the other, and in
    those of the other that the one has looked ahead at.
    """
    trace: Trace = piece.tables["trace"]
    first = trace.line[piece.own_rows.start]
    none = np.zeros(0, np.int64)
    for name in {*before, *now}:
        known, found = before.get(name, none), now.get(name, none)
        if not np.isin(found[found < first], known).all() or not np.isin(known[known >= first], found).all():
            return False
    return True


def _hang_together(judged: Sequence[_Judged], rules: Sequence[Rule]) -> bool:
    """Whether what one piece has found would be another finding, or none, beside what the others have found."""
    comments: dict[str, Found | None] = {}
    for one in judged:
        for key, comment in one.called.items():
            if comments.setdefault(key, comment) != comment:
                return True  # what a comment tells of an offset holds for all of the program
    found = Counter(name for one in judged for name in one.found)
    continued = set[str]().union(*(one.continued for one in judged))
    missing = Counter(
        rule
        for rule, kind, _ in {one[:3] for part in judged for many in part.missing.values() for one in many}
        if kind == SAID
    )
    for rule in rules:
        if missing[rule.name] > NAMED or (found[rule.name] and _OF_PROGRAM.intersection(rule.parameters)):
            return True
        of_text = rule.over not in ("rows", "sections")
        if found[rule.name] and of_text and rule.name in continued:
            return True
        if found[rule.name] > 1:
            if rule.once in _WHOLE or of_text or rule.name in continued:
                return True
            if sum(finding.rule == rule.name for one in judged for finding in one.report.findings) > LISTED:
                return True
        causes = {name for span, names in rule.follows.items() if span not in _WITHIN for name in names}
        if found[rule.name] and any(
            rule.name in one.found and name in other.found
            for name in causes
            if found[name]
            for one in judged
            for other in judged
            if one is not other
        ):
            return True
    return False


def _united(judged: Sequence[_Judged], machine: Machine) -> FileReport:
    reports = [one.report for one in judged]
    findings = in_order(found for report in reports for found in report.findings)
    not_evaluated = [
        one
        for name in judged[0].missing
        for one in told((missing for part in judged for missing in part.missing[name]), machine)
    ]
    not_evaluated = list(dict.fromkeys(not_evaluated))
    return FileReport(
        path=reports[0].path,
        programs=[name for report in reports for name in report.programs],
        blocks=sum(report.blocks for report in reports),
        sections=sum(report.sections for report in reports),
        verdict=verdict(findings, not_evaluated),
        polar_sections=[section for report in reports for section in report.polar_sections],
        findings=findings,
        not_evaluated=not_evaluated,
        looked_at=max((report.looked_at for report in reports), key=len),
    )
