"""
Findings that another one hides: what it says to write is written, and the program is checked again.

A mistake makes doubtful what is found beside it, so that a second one is listed under it, or not found at all. What is
found without the first mistake is no consequence of it.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial

import msgspec
import numpy as np

from polarcheck.checking.edits import applied, spans
from polarcheck.checking.engine import Engine
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import WORD
from polarcheck.foundation.finding import (
    SEVERITIES,
    WARNING,
    Finding,
    NotEvaluated,
    Silenced,
    Undecided,
    each_finding,
)
from polarcheck.foundation.states import Motion, Side
from polarcheck.program.execution.runs import runs
from polarcheck.program.reading.source import read_source
from polarcheck.rules.editing import Replace, in_place_of, is_plain, without, words_of
from polarcheck.rules.rule import Rule
from polarcheck.rules.tables import Tables

#: The rule that reports an edit which explains findings; it is no symptom.
REPORTS = "nearly-regular-contour"
#: Programs with an edit that are checked for what is found in one section, and in all of a run; one counts for each of
#: so many of its rows.
OF_SECTION, OF_RUN, _ROWS = 64, 512, 300
#: Of these, those for what is hidden in a program.
_MOST_CHECKS = 6
#: Addresses that are not written for the second axis by mistake: the linear axis, codes.
_NOT_MISTAKEN = "XUGM"

#: Explains the findings of an engine.
Explain = Callable[[Engine, list[Finding]], list[Finding]]
#: A rule and a line at which it fires.
Symptom = tuple[str, int]


class TrialCount:
    """
    The programs with an edit that are checked in a run: they are counted, so that each machine gives the same report.

    trace: of the program as it is written. counts: by the line where a section begins. stopped: such lines of sections
    in which not all was searched.
    """

    def __init__(self, trace: Trace) -> None:
        self.trace = trace
        self.counts = Counter[int]()
        self.stopped: set[int] = set()

    def counted(self, section_line: int) -> bool:
        """Count one more program for a section; False where that is beyond a bound."""
        cost = -(-len(self.trace) // _ROWS)
        fits = self.counts[section_line] + cost <= OF_SECTION and self.counts.total() + cost <= OF_RUN
        if fits:
            self.counts[section_line] += cost
        else:
            self.stopped.add(section_line)
        return fits

    def not_searched(self) -> list[NotEvaluated]:
        """What is said of the sections in which not all was searched."""
        mode, line = self.trace.mode, self.trace.blocks.line
        reason = f"was not searched to the end (at most {OF_SECTION} edits of a section and {OF_RUN} of all are tried)"
        enters = line[mode.sections.enter]
        return [
            NotEvaluated(
                rule=REPORTS,
                reason=f"what explains the findings in the section of line {first} {reason}",
                blocks=int(np.isin(mode.section, np.flatnonzero(enters == first)).sum()),
                matters=False,
            )
            for first in sorted(self.stopped)
        ]


def edited(engine: Engine, number: int, edits: Sequence[Replace], rules: Sequence[Rule]) -> Engine | None:
    """The engine of a run of the program with these edits; None where they cannot be written. number: of the run."""
    source, machine, job = engine.trace.text.source, engine.trace.machine, engine.tables["job"]
    data = applied(source, edits)
    if data is None:
        return None
    states = runs(read_source(data, source.path, source.encoding), machine, job)
    # Without its last sign of block skip a program runs once.
    tables = Tables(states[min(number, len(states) - 1)][1], machine, job)
    tables.give("other_machine", engine.tables["other_machine"])  # an edit makes it no program for another machine
    tables["regularity"].known.update(engine.tables["regularity"].known)
    return Engine(tables, engine.severities, rules)


def with_hidden(
    engine: Engine,
    findings: list[Finding],
    hiding: Sequence[Finding],
    number: int,
    edits: Sequence[Replace],
    explain: Explain,
    count: TrialCount,
) -> list[Finding]:
    """
    Return the findings, with those of the same sections that are found without what hides them.

    hiding: those that may hide others. number: of the run. edits: they explain findings, and leave others. explain:
    lists under explanations what they explain. count: of the run.
    """
    hiding = [finding for finding in hiding if is_told(finding) and engine.rules[finding.rule].doubts]
    if engine.allows is not None or not (hiding or edits):
        return findings
    trials = _Trials(engine, number, explain, count)
    source = engine.trace.text.source
    lines = {source.line_of(start) for start, _, _ in edits}
    sections = {finding.section_line for finding in findings if finding.line in lines}
    edits, left = [*edits], trials.findings(edits, min(filter(None, sections), default=0)) if edits else findings
    for finding in hiding:
        if left is None:
            return findings
        tried, before = [], symptoms(left)
        for repair in _repairs(engine, finding):
            may_count = partial(_may_be_gone, finding, before)
            others = trials.findings([*edits, *repair], finding.section_line or 0, may_count)
            if others is not None and _is_gone(finding, before, symptoms(others)):
                repaired = {source.line_of(start) for start, _, _ in repair}
                tried.append((sum(other.line in repaired for other in others), len(others), repair, others))
        if tried:
            *_, repair, left = min(tried, key=lambda trial: trial[:2])
            edits += repair
            sections.add(finding.section_line)
    lines = {source.line_of(start) for start, _, _ in edits}
    known = {(finding.rule, finding.line) for finding in findings}
    told = {
        (finding.rule, finding.section_line) for finding in findings if engine.rules[finding.rule].once == "section"
    }
    hidden = [
        msgspec.structs.replace(finding, fix=None)
        for finding in left or ()
        if is_told(finding)
        and finding.section_line in sections
        and finding.line not in lines
        and (finding.rule, finding.line) not in known
        and (finding.rule, finding.section_line) not in told
    ]
    return [*_without(findings, symptoms(hidden)), *hidden]


def is_told(finding: Finding) -> bool:
    """A warning or an error in a polar section."""
    if isinstance(finding, Silenced | Undecided) or finding.section_line is None:
        return False
    return SEVERITIES[finding.severity] >= WARNING


def symptoms(findings: Sequence[Finding]) -> set[Symptom]:
    """Where rules fire, in findings and those that follow from them."""
    return {(finding.rule, finding.line) for finding in each_finding(findings)}


def _is_gone(finding: Finding, before: set[Symptom], after: set[Symptom]) -> bool:
    """A finding is gone, its rule fires nowhere else instead, and no more is found."""
    is_elsewhere = any(rule == finding.rule for rule, _ in after - before)
    return _count(after) <= _count(before) and (finding.rule, finding.line) not in after and not is_elsewhere


def _count(found: set[Symptom]) -> int:
    return sum(rule != REPORTS for rule, _ in found)


def _may_be_gone(finding: Finding, before: set[Symptom], after: set[Symptom]) -> bool:
    """What is listed under an explanation stays a symptom: only what reports explanations may still go or come."""
    return _count(after) <= _count(before) if finding.rule == REPORTS else _is_gone(finding, before, after)


class _Trials:
    def __init__(self, engine: Engine, number: int, explain: Explain, count: TrialCount) -> None:
        self.engine, self.number, self.explain, self.count = engine, number, explain, count
        self.left = _MOST_CHECKS

    def findings(
        self,
        edits: Sequence[Replace],
        section_line: int,
        may_count: Callable[[set[Symptom]], bool] | None = None,
    ) -> list[Finding] | None:
        """
        The findings of the program with these edits; None where its lines are others then, or too many are tried.

        section_line: of the section that is counted.
        may_count: for symptoms that are not explained yet; they are explained where it is True.
        """
        if any("\n" in text for _, _, text in edits) or not self.count.counted(section_line):
            return None
        self.left -= 1
        if self.left < 0:
            self.count.stopped.add(section_line)
            return None
        trial = edited(self.engine, self.number, edits, [*self.engine.rules.values()])
        lines = self.engine.trace.text.source.line_starts
        if trial is None or len(trial.trace.text.source.line_starts) != len(lines):
            return None
        findings = trial.findings()
        return self.explain(trial, findings) if may_count is None or may_count(symptoms(findings)) else None


def _repairs(engine: Engine, finding: Finding) -> Iterator[list[Replace]]:
    """What may be written for a finding: its fix, or another word in the place of that at fault."""
    trace = engine.trace
    run, machine, source = trace.run, trace.machine, trace.text.source
    doubts = {what for what, _ in engine.rules[finding.rule].doubts}
    rows = np.flatnonzero((trace.blocks.line == finding.line) & (trace.mode.section >= 0))
    motion = trace.modal.motion_word[rows[:1]] if "rapid" in doubts else rows[:0]
    codes = np.flatnonzero(np.isin(run.words.start, motion))[:1]
    # Where G0 stands above the section, the block of which G1 is missing may have had more; where it is alone, less.
    if any(trace.mode.section[run.row[code]] < 0 or len(words_of(run, int(run.row[code]))) < 2 for code in codes):
        return
    if finding.fix is not None:
        yield spans(source, finding.fix)
        return
    if not len(rows) or not is_plain(run, int(rows[0])):
        return
    row = int(rows[0])
    start = int(source.line_starts[finding.line - 1])
    first, last = (start + column - 1 for column in (finding.column, finding.end_column))
    words = words_of(run, row)
    at = [word for word in words if first <= int(run.words.start[word]) < last]
    needed = WORD.fullmatch(str(finding.values.get("word_needed", "")))
    if needed is not None and len(at) == 1:
        yield [in_place_of(run, at[0], needed[0])]
        return
    if trace.axes.motion[row] == Motion.RAPID:
        yield from ([in_place_of(run, int(word), line)] for word in codes for line in list(machine.codes("line"))[:1])
    sides = trace.blocks.code_indices(*machine.codes("compensation_left"), *machine.codes("compensation_right"))
    for word in at if "compensation" in doubts else ():
        if word in sides:
            other = "compensation_left" if trace.compensation.side[row] == Side.RIGHT else "compensation_right"
            off = trace.blocks.code_indices(*machine.codes("compensation_off"))
            yield from ([in_place_of(run, word, code)] for code in list(machine.codes(other))[:1])
            yield from (without(run, int(run.row[code]), [int(code)]) for code in off[run.row[off] > row][:1])
    if "position" in doubts and len(at) == 1:
        address = run.words.address
        alike = [word for word in words if address[word] == address[at[0]]]
        letter = trace.axes.virtual_addresses(row)[0]
        if len(alike) > 1 and chr(address[at[0]]) not in "GM":
            # One more than are tried tells that the search was not ended.
            yield from (without(run, row, [word]) for word in alike[: _MOST_CHECKS + 1])
        elif chr(address[at[0]]) not in {letter, *trace.axes.virtual_addresses(row), *_NOT_MISTAKEN}:
            yield [in_place_of(run, at[0], letter + run.written(at[0]).strip()[1:])]


def _without(findings: list[Finding], symptoms: set[Symptom]) -> list[Finding]:
    """The findings without those that follow from them and are given."""
    kept = []
    for finding in findings:
        follows = [other for other in finding.follows if (other.rule, other.line) not in symptoms]
        is_same = len(follows) == len(finding.follows)
        kept.append(finding if is_same else msgspec.structs.replace(finding, follows=follows))
    return kept
