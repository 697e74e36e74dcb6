"""From bytes to findings: the one way that every command and every report goes."""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from itertools import groupby
from typing import TypeVar

import msgspec

from polarcheck.checking.called_files import in_the_file
from polarcheck.checking.causes import READ_OTHERWISE
from polarcheck.checking.channels import united
from polarcheck.checking.engine import Engine, in_order, with_following
from polarcheck.checking.not_evaluated import all_unevaluated, bounds_not_reported
from polarcheck.checking.other_machine import OtherMachine
from polarcheck.checking.polar_sections import polar_sections
from polarcheck.checking.rule import Hits, Rule, load_all
from polarcheck.checking.tables import Tables
from polarcheck.execution.run import is_code
from polarcheck.execution.runs import runs
from polarcheck.finding import ERROR, SEVERITIES, FileReport, Finding, NotEvaluated, PolarSection, Undecided
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.reading import source
from polarcheck.reading.words import Text
from polarcheck.silence.suppression import UNUSED, Used, divided, mentions_allow

_SKIP = re.compile(r"\s*(?:N\s*\d+\s*)?/", re.IGNORECASE)
#: At what is looked in any program.
LOOKED_AT = ("text", "flow", "position")


def read(
    data: bytes, machine: Machine, job: Job, path: str = "-", encoding: str | None = None
) -> list[tuple[str, Tables]]:
    """
    The tables of each run of a file, with the state of block skip ("" where that makes no difference).

    The runs of a channel stand together; `text.source.channel` names it, where the file has several.
    """
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
    inline: bool = True,
) -> FileReport:
    """
    All findings of the rules in one file, in the order of its lines; severities override those of the rules.

    inline: whether the allow comments of the program are heeded.
    """
    return check_runs(read(data, machine, job, path, encoding), rules, severities, inline)


def check_runs(
    found: Sequence[tuple[str, Tables]],
    rules: Sequence[Rule],
    severities: Mapping[str, str] | None = None,
    inline: bool = True,
) -> FileReport:
    """All findings of the rules in the runs of one file, of each of its channels."""
    channels = [list(runs_of_one) for _, runs_of_one in groupby(found, lambda run: _source(run[1]).channel)]
    checked = [_check_channel(one, rules, severities, inline) for one in channels]
    # What no run of any channel has needed is known only now.
    used = set[Used]().union(*(engine.used for _, engines in checked for engine in engines))
    reports = [(_source(engine.tables), _with_unused(report, engine, rules, used)) for report, (engine, *_) in checked]
    if len(reports) == 1:
        return reports[0][1]
    report = united(reports)
    findings = in_order(report.findings)
    return msgspec.structs.replace(report, findings=findings, verdict=verdict(findings, report.not_evaluated))


def _with_unused(report: FileReport, engine: Engine, rules: Sequence[Rule], used: Collection[Used]) -> FileReport:
    """The report with what is said of allow comments without effect. used: those that have one in any run."""
    asked = [rule for rule in rules if UNUSED in rule.parameters and rule.level(engine.severities) != "off"]
    if engine.allows is None or not asked:
        return report
    tables = engine.tables
    tables.give(UNUSED, engine.allows.unused(used, _could_silence(engine, report)))
    findings, silenced = divided(Engine(tables, engine.severities, asked, allows=engine.allows).findings())
    findings = in_order([*report.findings, *findings])
    return msgspec.structs.replace(
        report,
        findings=findings,
        silenced=in_order([*report.silenced, *silenced]),
        verdict=verdict(findings, report.not_evaluated),
    )


def _could_silence(engine: Engine, report: FileReport) -> set[str]:
    """
    The rules of which something would have been found: an allow comment for another one has no effect for now.

    Those that the machine has off are no reason to keep silent about the others of a group. A program that returns,
    and has no section of its own, is judged where it is called.
    """
    tables = engine.tables
    machine: Machine = tables["machine"]
    words = tables["words"]
    missing = {one.rule for one in report.not_evaluated if one.matters}
    returns = (
        is_code(words, machine.macro.program_returns).any() and not is_code(words, machine.m_codes.program_end).any()
    )
    if {found.rule for found in report.findings} & {*READ_OTHERWISE}:
        return set()
    if "all" in missing or engine.trace.run.broken_off is not None or (returns and not len(tables["sections"])):
        return set()
    off = {rule.name for rule in load_all().values() if rule.level(machine.severities) == "off"}
    return {*engine.rules, *off} - missing


def _source(tables: Tables) -> source.Source:
    """The file of a run, or the view of its channel."""
    text: Text = tables["text"]
    return text.source


def _check_channel(
    found: Sequence[tuple[str, Tables]], rules: Sequence[Rule], severities: Mapping[str, str] | None, inline: bool
) -> tuple[FileReport, list[Engine]]:
    """The findings in the runs of one channel, and what found them; what hangs on its text alone is looked for once."""
    (state, tables), *more = found
    engine = engine_of(tables, rules, severities, inline=inline)
    first = report_of(engine)
    if not more:
        return first, [engine]
    ((other, others),) = more
    of_text = {rule.name: engine.hits(rule) for rule in engine.rules.values() if rule.of_text}
    # A program that one run alone calls stands in the text of that run alone.
    known = of_text if others["text"] is tables["text"] else None
    again = engine_of(others, rules, severities, known, inline)
    return _merged((state, first), (other, report_of(again)), of_text), [engine, again]


def engine_of(
    tables: Tables,
    rules: Sequence[Rule],
    severities: Mapping[str, str] | None = None,
    known: Mapping[str, Hits] | None = None,
    inline: bool = True,
) -> Engine:
    """
    The rules that are not off, over the tables of one run.

    known: what is known already of some of them. inline: whether allow comments are heeded; without any there is
    nothing to ask the rules about them.
    """
    machine: Machine = tables["machine"]
    levels = {**machine.severities, **(severities or {})}
    tables.give("other_machine", OtherMachine(tables))
    asked = [rule for rule in rules if rule.level(levels) != "off" and UNUSED not in rule.parameters]
    of_dialect = [rule for rule in asked if "dialect" in rule.parameters]
    if of_dialect and tables["dialect"].recognised is not None:
        # Where that is told, nothing that the words of another language seem to say is worth telling.
        asked = of_dialect
    if inline and mentions_allow(tables["text"].source):
        from polarcheck.silence.allow_comments import Allows  # most files have none

        allows = Allows(tables["text"], {rule.name: rule.group for rule in load_all().values()})
        tables.give("allows", allows)
        return Engine(tables, levels, asked, known, allows)
    return Engine(tables, levels, [rule for rule in asked if "allows" not in rule.parameters], known)


def report_of(engine: Engine) -> FileReport:
    """All that is found in one run, and what of it could not be evaluated."""
    tables, trace = engine.tables, engine.trace
    findings, silenced = divided(in_order(in_the_file(engine.findings(), trace, engine.answered)))
    unevaluated = (*bounds_not_reported(tables, _all(findings)), *all_unevaluated(tables, engine.rules.values()))
    not_evaluated = list(dict.fromkeys((*unevaluated, *engine.unlisted)))
    text = trace.text
    own = [name for block, name in engine.heads if not text.source.part_of(int(text.blocks.line[block]))]
    return FileReport(
        path=text.source.path,
        programs=own,
        blocks=len(trace),
        sections=len(trace.mode.sections),
        verdict=verdict(findings, not_evaluated),
        polar_sections=polar_sections(tables),
        findings=findings,
        not_evaluated=not_evaluated,
        looked_at=looked_at(tables),
        silenced=silenced,
    )


def looked_at(tables: Tables) -> list[str]:
    """At what of a run is looked."""
    if tables["dialect"].recognised is not None:
        return []
    return ["polar sections", *LOOKED_AT] if len(tables["sections"]) else [*LOOKED_AT]


#: What tells a finding from others of the same file.
_Place = tuple[str, int, int]
Found = TypeVar("Found", bound=Finding)


def _merged(first: tuple[str, FileReport], second: tuple[str, FileReport], of_text: Collection[str]) -> FileReport:
    """
    One report of the runs with block skip off and on; what only one of them shows says which.

    of_text: the rules that hang on the text alone, so that both runs show the same of them.
    """
    (skip_off, off), (skip_on, on) = first, second
    shown_off, shown_on = (
        {_place(found) for found in _all([*report.findings, *report.silenced])} for report in (off, on)
    )

    fixes_off, fixes_on = (
        {_place(found): found.fix for found in _all([*report.findings, *report.silenced])} for report in (off, on)
    )

    def told(found: Found, others: set[_Place], state: str) -> Found:
        place = _place(found)
        # What mends the one run must not change the other.
        agrees = fixes_off[place] == fixes_on[place] if place in fixes_off.keys() & fixes_on.keys() else _skips(found)
        if found.fix is not None and found.rule not in of_text and not agrees:
            found = msgspec.structs.replace(found, fix=None)
        # What stands by itself in the first run is no second time listed under what only the other one shows.
        own = (one for one in found.follows if others is shown_on or _place(one) not in others)
        follows = [told(one, others, state) for one in own]
        if found.rule in of_text or _place(found) in others:
            return msgspec.structs.replace(found, follows=follows)
        return msgspec.structs.replace(found, message=f"{found.message} (with block skip {state})", follows=follows)

    following = {_place(found): found.follows for found in on.findings}
    findings = []
    for found in off.findings:
        more = [
            told(one, shown_off, skip_on) for one in following.get(_place(found), ()) if _place(one) not in shown_off
        ]
        shown = told(found, shown_on, skip_off)
        findings.append(with_following(shown, [*shown.follows, *more]))
    findings += [told(found, shown_off, skip_on) for found in on.findings if _place(found) not in shown_off]
    silenced = [told(found, shown_on, skip_off) for found in off.silenced]
    silenced += [told(found, shown_off, skip_on) for found in on.silenced if _place(found) not in shown_off]
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
    """The sections of both runs, those of the same G12.1 as one with the worst of each."""
    of_run: dict[tuple[int, int], PolarSection] = {}
    for sections in (off, on):
        begun = Counter[int]()
        for section in sections:
            key = section.line, begun[section.line]  # a program that is called twice begins a section each time
            begun[section.line] += 1
            of_run[key] = _worse(of_run[key], section) if key in of_run else section
    return [of_run[key] for key in sorted(of_run)]


def _worse(one: PolarSection, other: PolarSection) -> PolarSection:
    fastest = max(one, other, key=lambda section: math.inf if section.c_feed is None else section.c_feed)
    return msgspec.structs.replace(
        fastest,
        nearest=_fold(min, one.nearest, other.nearest),
        ramp_used=max((used for used in (one.ramp_used, other.ramp_used) if used is not None), default=None),
        time=_fold(max, one.time, other.time),
    )


def _fold(worst: Callable[..., float], one: float | None, other: float | None) -> float | None:
    """What one run does not know is not known."""
    return None if one is None or other is None else worst(one, other)


def _place(found: Finding) -> _Place:
    return found.rule, found.line, found.column


def _skips(found: Finding) -> bool:
    """The block has block skip at its head, so that one run alone executes it."""
    return _SKIP.match(found.block) is not None


def _all(findings: Sequence[Finding]) -> Iterator[Finding]:
    """The findings and what follows from them."""
    for found in findings:
        yield found
        yield from found.follows


def verdict(findings: Sequence[Finding], not_evaluated: Sequence[NotEvaluated], fail_on: str = "warning") -> str:
    """
    pass, fail, or unverified where something that matters was not evaluated, or nobody can say what it is.

    fail_on has no say in the latter: a program that was not executed to its end is not verified, whoever asks.
    """
    if any(reaches(finding, fail_on) and not isinstance(finding, Undecided) for finding in findings):
        return "fail"
    is_open = any(isinstance(finding, Undecided) for finding in findings) or any(one.matters for one in not_evaluated)
    return "unverified" if is_open else "pass"


def reaches(finding: Finding, fail_on: str) -> bool:
    """Return True if a finding is at or above the severity that fails."""
    return SEVERITIES[finding.severity] >= SEVERITIES.get(fail_on, ERROR + 1)
