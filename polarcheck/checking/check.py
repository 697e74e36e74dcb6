"""From the bytes of a file to its findings: every command and every report uses these functions."""

from __future__ import annotations

import functools
import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping, Sequence
from itertools import groupby
from typing import TYPE_CHECKING, TypeVar

import msgspec

from polarcheck.checking.called_files import in_the_file
from polarcheck.checking.engine import Engine, in_order, with_following
from polarcheck.checking.not_evaluated import bounds_not_reported, unevaluated_by, unexecuted
from polarcheck.checking.polar_sections import known_stock, polar_sections
from polarcheck.checking.suppression import UNUSED, divided
from polarcheck.checking.written_for import stated_by
from polarcheck.columns.words.allow_mention import Used, mentions_allow
from polarcheck.foundation.arrays import cached_property
from polarcheck.foundation.finding import (
    DESELECTED,
    ERROR,
    FAIL,
    PASS,
    SEVERITIES,
    UNVERIFIED,
    FileReport,
    Finding,
    KnownStock,
    NotEvaluated,
    PolarSection,
    Undecided,
    each_finding,
)
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.execution.run import is_code
from polarcheck.program.execution.runs import runs
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.reading import source
from polarcheck.program.reading.words import Text
from polarcheck.rules.causes import READ_OTHERWISE
from polarcheck.rules.other_machine import OtherMachine
from polarcheck.rules.rule import Hits, Rule, load_all
from polarcheck.rules.tables import Tables

if TYPE_CHECKING:
    from polarcheck.columns.contour.correction import Correction
    from polarcheck.foundation.arrays import Rows

_SKIP = lazy_pattern(r"\s*(?:N\s*\d+\s*)?/", re.IGNORECASE)
#: The rule that reports codes that may be a builder's own switches of the mode.
_OF_SWITCH = "polar-switch-unknown"
#: Areas checked in every program.
LOOKED_AT = ("text", "flow", "position")
#: In longer programs a table is forgotten behind its last reader [rows].
_LONG = 100_000


def read(
    data: bytes, machine: Machine, job: Job, path: str = "-", encoding: str | None = None
) -> list[tuple[str, Tables]]:
    """
    Return the state of block skip and the tables for each run of a file; the state is "" if it makes no difference.

    The runs of a channel are adjacent; `text.source.channel` names it if the file has several.
    """
    states = runs(source.read_source(data, path, encoding), machine, job)
    return [(state, Tables(run, machine, job)) for state, run in states]


def check_file(
    data: bytes,
    machine: Machine,
    job: Job,
    rules: Sequence[Rule],
    path: str = "-",
    encoding: str | None = None,
    severities: Mapping[str, str] | None = None,
    inline: bool = True,
) -> FileReport:
    """
    Check one file with these rules. Findings are in the order of its lines; `severities` override those of the rules.

    inline: False to ignore the allow comments of the program.
    """
    return check_runs(read(data, machine, job, path, encoding), rules, severities, inline)


def check_runs(
    runs: Sequence[tuple[str, Tables]],
    rules: Sequence[Rule],
    severities: Mapping[str, str] | None = None,
    inline: bool = True,
    deselected: Sequence[str] = (),
) -> FileReport:
    """
    Check the runs of all channels of one file with these rules.

    deselected: lines on what keeps rules of weight from running; with any of them no file passes.
    """
    channels = [list(channel) for _, channel in groupby(runs, lambda run: _source(run[1]).channel)]
    checked = [_check_channel(channel, rules, severities, inline) for channel in channels]
    # An allow comment is unused only if no run of any channel used it.
    used = set[Used]().union(*(engine.used for _, engines in checked for engine in engines))
    reports = [(_source(engine.tables), _with_unused(report, engine, rules, used)) for report, (engine, *_) in checked]
    if len(reports) == 1 and not deselected:
        return reports[0][1]
    report = reports[0][1]
    if len(reports) > 1:
        from polarcheck.checking.channel_reports import united

        report = united(reports)
    findings = in_order(report.findings)
    missing = [NotEvaluated(rule=DESELECTED, reason=line, blocks=report.blocks) for line in deselected]
    not_evaluated = [*report.not_evaluated, *missing]
    given = {"findings": findings, "not_evaluated": not_evaluated, "verdict": verdict(findings, not_evaluated)}
    return msgspec.structs.replace(report, **given)


def _with_unused(report: FileReport, engine: Engine, rules: Sequence[Rule], used: Collection[Used]) -> FileReport:
    """Add the findings on unused allow comments to the report. used: the allow comments that some run used."""
    unused_rules = [rule for rule in rules if UNUSED in rule.parameters and rule.level(engine.severities) != "off"]
    if engine.allows is None or not unused_rules:
        return report
    tables = engine.tables
    tables.give(UNUSED, engine.allows.unused(used, _could_silence(engine, report)))
    engine_of_unused = Engine(tables, engine.severities, unused_rules, allows=engine.allows)
    findings, silenced = divided(engine_of_unused.findings())
    findings = in_order([*report.findings, *findings])
    return msgspec.structs.replace(
        report,
        findings=findings,
        silenced=in_order([*report.silenced, *silenced]),
        verdict=verdict(findings, report.not_evaluated),
    )


def _could_silence(engine: Engine, report: FileReport) -> set[str]:
    """
    Return the rules that were fully evaluated: only their allow comments can be called unused.

    Rules that the machine turns off count as evaluated, so that they do not excuse the others of a group. A program
    that returns and has no section is judged where it is called.
    """
    tables = engine.tables
    machine: Machine = tables["machine"]
    words = tables["words"]
    missing = {entry.rule for entry in report.not_evaluated if entry.matters}
    returns = (
        is_code(words, machine.macro.program_returns).any() and not is_code(words, machine.m_codes.program_end).any()
    )
    if {finding.rule for finding in report.findings} & {*READ_OTHERWISE}:
        return set()
    if "all" in missing or engine.trace.run.broken_off is not None or (returns and not len(tables["sections"])):
        return set()
    off = {rule.name for rule in load_all().values() if rule.level(machine.severities) == "off"}
    return {*engine.rules, *off} - missing


def _source(tables: Tables) -> source.Source:
    """Return the file of a run, or the view of its channel."""
    text: Text = tables["text"]
    return text.source


def _check_channel(
    channel: Sequence[tuple[str, Tables]], rules: Sequence[Rule], severities: Mapping[str, str] | None, inline: bool
) -> tuple[FileReport, list[Engine]]:
    """
    Check the runs of one channel; returns the report and the engines. Rules of the text alone run once.

    Where the program is written for another control, what this one would make of its words is not worth reporting.
    """
    names = next(filter(None, (stated_by(tables) for _, tables in channel)), ())
    if saying := [rule for rule in rules if rule.name in names]:
        report, engines = _check_runs_of_channel(channel, saying, severities, inline)
        if report.findings or report.silenced:
            findings = report.findings[:1]
            rest = {"not_evaluated": [], "looked_at": [], "verdict": verdict(findings, [])}
            return msgspec.structs.replace(report, findings=findings, **rest), engines
    report, engines = _check_runs_of_channel(channel, rules, severities, inline)
    if any(finding.rule == _OF_SWITCH for finding in report.findings):
        from polarcheck.checking.builders_switch import supposition, with_supposed  # imported late: it is rare

        supposed = supposition(channel[0][1])
        if supposed is not None:
            of_mode, more = _check_runs_of_channel(supposed.channel, rules, severities, inline)
            engines = [*engines, *more]
            report = with_supposed(report, of_mode, supposed)
            report = msgspec.structs.replace(report, verdict=verdict(report.findings, report.not_evaluated))
    return report, engines


def _check_runs_of_channel(
    channel: Sequence[tuple[str, Tables]], rules: Sequence[Rule], severities: Mapping[str, str] | None, inline: bool
) -> tuple[FileReport, list[Engine]]:
    (state, tables), *more = channel
    engine = engine_of(tables, rules, severities, inline=inline)
    first = report_of(engine, 0)
    if not more:
        return first, [engine]
    ((second_state, second_tables),) = more
    of_text = {rule.name: engine.hits(rule) for rule in engine.rules.values() if rule.of_text}
    # The texts differ if one run calls a program that the other does not.
    reusable = of_text if second_tables["text"] is tables["text"] else None
    second = engine_of(second_tables, rules, severities, reusable, inline)
    return _merged((state, first), (second_state, report_of(second, 1)), of_text), [engine, second]


def engine_of(
    tables: Tables,
    rules: Sequence[Rule],
    severities: Mapping[str, str] | None = None,
    known_hits: Mapping[str, Hits] | None = None,
    inline: bool = True,
) -> Engine:
    """
    Build the engine for one run, with the rules that are not off.

    known_hits: hits that are known already, by rule name.
    inline: False to ignore allow comments. Without allow comments the rules on them are left out.
    """
    machine: Machine = tables["machine"]
    levels = {**machine.severities, **(severities or {})}
    tables.setdefault("other_machine", OtherMachine(tables))
    active = [rule for rule in rules if rule.level(levels) != "off" and UNUSED not in rule.parameters]
    of_dialect = [rule for rule in active if "dialect" in rule.parameters]
    if of_dialect and tables["dialect"].recognised is not None:
        # The file is in another language: what its words seem to say is not worth reporting.
        active = of_dialect
    if inline and mentions_allow(tables["text"].source):
        from polarcheck.columns.words.allow_comments import Allows  # imported late: most files have no allow comment

        allows = Allows(tables["text"], {rule.name: rule.group for rule in load_all().values()})
        tables.give("allows", allows)
        return Engine(tables, levels, active, known_hits, allows)
    return Engine(tables, levels, [rule for rule in active if "allows" not in rule.parameters], known_hits)


class _Remainder:
    """What a report says beside its findings, each made when it is first read (turns.READ names its tables)."""

    def __init__(self, engine: Engine) -> None:
        self.engine = engine
        self._missing: dict[str, list[NotEvaluated]] = {}

    @cached_property
    def sections(self) -> list[PolarSection]:
        """The polar sections that the verdict rests on."""
        return polar_sections(self.engine.tables)

    @cached_property
    def stock(self) -> KnownStock | None:
        """The bar; None where nothing is known of it."""
        return known_stock(self.engine.tables)

    @cached_property
    def less_regular(self) -> list[tuple[Rows, Correction]]:
        """The rows of contours that may be less regular than they were meant to be, and what would mend each."""
        engine = self.engine
        rule = engine.rules.get("nearly-regular-contour")
        if rule is None or engine.trace.run.unknown_words or not len(engine.hits(rule).mask):
            return []
        likely: list[tuple[Rows, Correction]] = engine.tables["regularity"].likely
        return likely

    @cached_property
    def unexecuted(self) -> list[NotEvaluated]:
        """The blocks that were not executed, or without full knowledge."""
        return [*unexecuted(self.engine.tables)]

    def missing(self, rule: Rule) -> list[NotEvaluated]:
        """Return what a rule could not evaluate."""
        if rule.name not in self._missing:
            self._missing[rule.name] = unevaluated_by(self.engine.tables, rule)
        return self._missing[rule.name]


def report_of(engine: Engine, number: int = 0) -> FileReport:
    """Report the findings of one run, and what could not be evaluated. number: of the run, of those of its file."""
    tables, trace = engine.tables, engine.trace
    remainder = _Remainder(engine)
    if len(trace) > _LONG:
        from polarcheck.checking.turns import read_in_turn  # imported late: most programs are short

        read_in_turn(engine, remainder.missing, functools.partial(getattr, remainder))
    found = engine.findings()
    if remainder.less_regular or found:
        from polarcheck.checking.explanations import explained  # imported late: most files have no finding

        found = explained(engine, found, number, lambda trial: _Remainder(trial).less_regular)
    findings, silenced = divided(in_order(in_the_file(found, trace, engine.answered, engine.rows_in_calls)))
    missing = [entry for rule in engine.rules.values() for entry in remainder.missing(rule)]
    bounds = bounds_not_reported(tables, each_finding(findings))
    not_evaluated = list(dict.fromkeys((*bounds, *remainder.unexecuted, *missing, *engine.unlisted)))
    text = trace.text
    programs = [name for block, name in engine.heads if not text.source.part_of(int(text.blocks.line[block]))]
    return FileReport(
        path=text.source.path,
        programs=programs,
        blocks=trace.run.block_count,
        sections=len(trace.mode.sections),
        verdict=verdict(findings, not_evaluated),
        polar_sections=remainder.sections,
        findings=findings,
        not_evaluated=not_evaluated,
        looked_at=looked_at(tables),
        silenced=silenced,
        stock=remainder.stock,
    )


def looked_at(tables: Tables) -> list[str]:
    """Return the areas that are checked in a run."""
    if tables["dialect"].recognised is not None:
        return []
    return ["polar sections", *LOOKED_AT] if len(tables["sections"]) else [*LOOKED_AT]


#: Identifies a finding within a file: rule, line, column.
_Position = tuple[str, int, int]
AnyFinding = TypeVar("AnyFinding", bound=Finding)


def _merged(first: tuple[str, FileReport], second: tuple[str, FileReport], of_text: Collection[str]) -> FileReport:
    """
    Merge the reports with block skip off and on; a finding of only one of them names its state in the message.

    of_text: the rules that depend on the text only, and therefore report the same in both runs.
    """
    (skip_off, off), (skip_on, on) = first, second
    shown_off, shown_on = (
        {_position(finding) for finding in each_finding([*report.findings, *report.silenced])} for report in (off, on)
    )

    fixes_off, fixes_on = (
        {_position(finding): finding.fix for finding in each_finding([*report.findings, *report.silenced])}
        for report in (off, on)
    )

    def labelled(finding: AnyFinding, rival_places: set[_Position], state: str) -> AnyFinding:
        key = _position(finding)
        # A fix for one run must not change the other.
        agrees = fixes_off[key] == fixes_on[key] if key in fixes_off.keys() & fixes_on.keys() else _skips(finding)
        if finding.fix is not None and finding.rule not in of_text and not agrees:
            finding = msgspec.structs.replace(finding, fix=None)
        # A finding of the first run is not listed again under one that only the second run has.
        followers = (
            follower
            for follower in finding.follows
            if rival_places is shown_on or _position(follower) not in rival_places
        )
        follows = [labelled(follower, rival_places, state) for follower in followers]
        if finding.rule in of_text or _position(finding) in rival_places:
            return msgspec.structs.replace(finding, follows=follows)
        return msgspec.structs.replace(finding, message=f"{finding.message} (with block skip {state})", follows=follows)

    following = {_position(finding): finding.follows for finding in on.findings}
    findings = []
    for finding in off.findings:
        more = [
            labelled(follower, shown_off, skip_on)
            for follower in following.get(_position(finding), ())
            if _position(follower) not in shown_off
        ]
        labelled_finding = labelled(finding, shown_on, skip_off)
        findings.append(with_following(labelled_finding, [*labelled_finding.follows, *more]))
    findings += [
        labelled(finding, shown_off, skip_on) for finding in on.findings if _position(finding) not in shown_off
    ]
    silenced = [labelled(finding, shown_on, skip_off) for finding in off.silenced]
    silenced += [
        labelled(finding, shown_off, skip_on) for finding in on.silenced if _position(finding) not in shown_off
    ]
    not_evaluated = list(dict.fromkeys((*off.not_evaluated, *on.not_evaluated)))
    findings = in_order(findings)
    return msgspec.structs.replace(
        off,
        blocks=max(off.blocks, on.blocks),
        sections=max(off.sections, on.sections),
        polar_sections=_worst(off.polar_sections, on.polar_sections),
        findings=findings,
        not_evaluated=not_evaluated,
        looked_at=max(off.looked_at, on.looked_at, key=len),
        verdict=verdict(findings, not_evaluated),
        silenced=in_order(silenced),
    )


def _worst(off: Sequence[PolarSection], on: Sequence[PolarSection]) -> list[PolarSection]:
    """Merge the sections of both runs; a section of both runs takes the worse values."""
    of_run: dict[tuple[int, int], PolarSection] = {}
    for sections in (off, on):
        begun = Counter[int]()
        for section in sections:
            key = (
                section.line,
                begun[section.line],
            )  # each call of a program begins a section of its own at the same line
            begun[section.line] += 1
            of_run[key] = _worse(of_run[key], section) if key in of_run else section
    return [of_run[key] for key in sorted(of_run)]


def _worse(first: PolarSection, second: PolarSection) -> PolarSection:
    fastest = max(first, second, key=lambda section: math.inf if section.c_feed is None else section.c_feed)
    reasons = dict.fromkeys(reason for section in (first, second) for reason in section.time_not_known or ())
    time_known = max(section.time_known or section.time or 0.0 for section in (first, second))
    return msgspec.structs.replace(
        fastest,
        nearest=_fold(min, first.nearest, second.nearest),
        center_line=first.center_line or second.center_line,
        ramp_used=max((used for used in (first.ramp_used, second.ramp_used) if used is not None), default=None),
        time=_fold(max, first.time, second.time),
        time_known=time_known if reasons else msgspec.UNSET,
        time_not_known=list(reasons) or msgspec.UNSET,
    )


def _fold(worst: Callable[..., float], first: float | None, second: float | None) -> float | None:
    """Return the worst value; None if one run does not know it."""
    return None if first is None or second is None else worst(first, second)


def _position(finding: Finding) -> _Position:
    return finding.rule, finding.line, finding.column


def _skips(finding: Finding) -> bool:
    """True if the block begins with block skip, so that only one run executes it."""
    return _SKIP.match(finding.block) is not None


#: A finding of this severity or worse fails its file; what fails a run is `fail_on`, which does not change verdicts.
FAILING = "warning"


def verdict(findings: Sequence[Finding], not_evaluated: Sequence[NotEvaluated]) -> str:
    """
    Return pass, fail or unverified.

    A file fails with a warning or an error, whatever the exit code will be. It is unverified if something that matters
    was not evaluated, or if a finding may be intended.
    """
    if any(reaches(finding, FAILING) and not isinstance(finding, Undecided) for finding in findings):
        return FAIL
    is_open = any(isinstance(finding, Undecided) for finding in findings) or any(
        entry.matters for entry in not_evaluated
    )
    return UNVERIFIED if is_open else PASS


def reaches(finding: Finding, fail_on: str) -> bool:
    """Return True if a finding is at or above the severity that fails."""
    return SEVERITIES[finding.severity] >= SEVERITIES.get(fail_on, ERROR + 1)
