"""Compares a program before and after fixes: its findings, and the path of the tool."""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.checking.check import check_runs, read
from polarcheck.checking.engine import LISTED
from polarcheck.checking.settings import Settings
from polarcheck.columns.path.moves import Moves, z_along
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Rows
from polarcheck.foundation.finding import SEVERITIES, FileReport, Finding
from polarcheck.foundation.states import Motion
from polarcheck.foundation.time_limit import seconds_for, time_limit
from polarcheck.program.machines.axis_table import FIRST_NAMED
from polarcheck.program.reading import source
from polarcheck.program.reading.source import Source
from polarcheck.rewrite.compare.order_differences import order_differences
from polarcheck.rewrite.compare.order_meanings import meaning_steps
from polarcheck.rewrite.compare.orders import steps
from polarcheck.rules.repair import FEED, WAY, Z
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

#: Lengths and feeds that differ by no more are equal [mm, mm/min].
_SAME = 1e-6
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


def state_of(data: bytes, settings: Settings, path: str, encoding: str | None) -> State:
    """
    Read and check a program.

    Raises SourceError for bytes that are not of the encoding, TooHardError if it takes too long.
    """
    all_rules = list(load_all().values())
    with time_limit(seconds_for(len(data), settings.job.run.max_seconds)):
        runs = read(data, settings.machine, settings.job, path, encoding)
        report = check_runs(runs, all_rules, settings.severities, settings.inline)
        is_chosen = len(settings.rules) < len(all_rules)
        selected = check_runs(runs, settings.rules, settings.severities, settings.inline) if is_chosen else report
        if settings.baseline is not None:
            from polarcheck.checking.block_outline import with_outline

            selected = with_outline(selected, runs)
    # Each channel has its own view of the text; the edits are made in the file.
    return State(source.read_source(data, path, encoding), runs, report, selected)


def objection(
    before: State, after: State, rules: Collection[str], changes: Sequence[tuple[Collection[str], range]]
) -> str:
    """
    Return why the fixed program must not replace the original one; empty if it may.

    rules: the rules whose findings are fixed.
    changes: what the fixes declare to change (CHANGES: WAY, Z, FEED), and in which lines.
    """
    return _worse(before.report, after.report, rules) or _moves_otherwise(before, after, changes)


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
    for finding in _all([*report.findings, *report.silenced]):
        by_rule[finding.rule].append(finding)
    return {rule: sorted(findings, key=_rank, reverse=True) for rule, findings in by_rule.items()}


def _all(findings: Iterable[Finding]) -> Iterator[Finding]:
    for finding in findings:
        yield finding
        yield from finding.follows


def _rank(finding: Finding) -> int:
    return SEVERITIES[finding.severity]


def _moves_otherwise(before: State, after: State, changes: Sequence[tuple[Collection[str], range]]) -> str:
    if [name for name, _ in before.runs] != [name for name, _ in after.runs]:
        return "the program would run otherwise"
    for (_, old), (_, new) in zip(before.runs, after.runs, strict=True):
        difference = (
            _in_sections(old, new, changes)
            or _outside(old, new, changes)
            or _orders(old["trace"], new["trace"], changes)
        )
        if difference:
            return difference
    return ""


def _in_sections(old: Tables, new: Tables, changes: Sequence[tuple[Collection[str], range]]) -> str:
    """Return the first difference in the moves of the tool center; empty if there is none."""
    trace, new_trace = old["trace"], new["trace"]
    was, now = (_fixed_moves(tables, changes) for tables in (old, new))
    if len(was) != len(now) or len(was.entry) != len(now.entry):
        return "the tool would make other moves in the polar mode"
    same = (was.section == now.section) & (was.kind == now.kind) & (was.known == now.known)
    for name in ("start", "end", "center"):
        same &= _alike(getattr(was, name), getattr(now, name))
    if not same.all() or not _alike(was.entry, now.entry).all():
        line = _line(trace, was, ~same)
        return f"the tool center would take another way{line}"
    z = [_alike(*pair) for pair in zip(z_along(trace, was), z_along(new_trace, now), strict=True)]
    if (wrong := ~(z[0] & z[1]) & ~_may_change(trace, was.row, changes, Z)).any():
        return f"Z would move otherwise{_line(trace, was, wrong)}"
    if (wrong := ~_alike(was.feed, now.feed) & ~_may_change(trace, was.row, changes, FEED)).any():
        return f"F would be another{_line(trace, was, wrong)}"
    return ""


def _fixed_moves(tables: Tables, changes: Sequence[tuple[Collection[str], range]]) -> Moves:
    """Return the moves without those that a fix may change; such a fix inserts no lines, and is applied alone."""
    trace, moves = tables["trace"], tables["moves"]
    fixed: Moves = moves
    for names, edited in changes:
        if WAY in names:
            inside = (trace.blocks.line_in_file >= edited.start) & (trace.blocks.line_in_file < edited.stop)
            rows = np.unique(moves.row)
            changed = np.flatnonzero(inside[rows])
            free = np.isin(moves.row, rows[np.union1d(changed, np.maximum(changed - 1, 0))])
            fixed = fixed[~free]
    return fixed


def _may_change(trace: Trace, rows: Rows, changes: Sequence[tuple[Collection[str], range]], what: str) -> Mask:
    """
    Return a mask of the rows of moves that fixes declare to change: those of the edited lines.

    For the feed also those for which F words or G codes of motion in these lines are in force.
    """
    lines = trace.blocks.line_in_file
    may = np.zeros(len(trace), bool)
    for names, edited in changes:
        if what in names:
            inside = (lines >= edited.start) & (lines < edited.stop)
            may |= inside
            if what == FEED:
                may |= np.isin(trace.feedrate.feed_word, trace.feedrate.feed_word[inside & trace.blocks.has("F")])
                may |= np.isin(trace.modal.motion_word, trace.modal.motion_word[inside & trace.modal.sets("motion")])
    return may[rows]


def _outside(old: Tables, new: Tables, changes: Sequence[tuple[Collection[str], range]]) -> str:
    """Return the first difference in the moves outside the polar mode; empty if there is none."""
    trace, new_trace = old["trace"], new["trace"]
    was, now = (np.flatnonzero(revision.axes.moves & (revision.mode.section < 0)) for revision in (trace, new_trace))
    if len(was) != len(now):
        return "the axes would make other moves outside the polar mode"
    same = np.ones(len(was), bool)
    for was_at, now_at in (
        (trace.axes.motion, new_trace.axes.motion),
        (trace.path.x, new_trace.path.x),
        (trace.path.z, new_trace.path.z),
        (trace.path.c_angle, new_trace.path.c_angle),
    ):
        same &= _alike(was_at[was], now_at[now])
    if not same.all():
        line = int(trace.blocks.line_in_file[was[np.argmin(same)]])
        return f"the axes would move otherwise in line {line}, outside the polar mode"
    wrong = ~_alike(trace.feedrate.feed[was], new_trace.feedrate.feed[now]) & (trace.axes.motion[was] != Motion.RAPID)
    wrong &= ~_may_change(trace, was, changes, FEED)
    if wrong.any():
        line = int(trace.blocks.line_in_file[was[np.argmax(wrong)]])
        return f"F would be another in line {line}, outside the polar mode"
    return ""


def _orders(old: Trace, new: Trace, changes: Sequence[tuple[Collection[str], range]]) -> str:
    """
    Return the first order that the fixed program lacks or has otherwise; empty if there is none.

    A fix may give the place of a G code that does nothing beside the mode to another, and make words readable.
    """
    meant = {step.line for step in meaning_steps(old)}
    edited = {line for _, lines in changes for line in lines} - meant
    words = old.run.words
    addresses = {chr(number) for number in words.address[words.is_unreadable].tolist() if number < FIRST_NAMED}
    before, after = (steps(trace, is_same_machine=True, with_sides=False) for trace in (old, new))
    for difference in order_differences(before, after, _SAME):
        is_code = _ONE_CODE.fullmatch(str(difference.old)) is not None and difference.old_line in edited
        is_added = difference.old_line is None and addresses.issuperset(_ADDRESS.findall(difference.text))
        if not is_code and not is_added:
            return f"an order would be another: {difference.text}, in line {difference.old_line or difference.new_line}"
    return ""


def _alike(values: Floats, new_values: Floats) -> Mask:
    """Return a mask of the values that are equal, or unknown in both."""
    unknown = np.isnan(values) & np.isnan(new_values)
    with np.errstate(invalid="ignore"):
        return np.asarray(unknown | (values == new_values) | (np.abs(values - new_values) <= _SAME))


def _line(trace: Trace, moves: Moves, wrong: Mask) -> str:
    indices = np.flatnonzero(wrong)
    return f" from line {int(trace.blocks.line_in_file[moves.row[indices[0]]])} on" if len(indices) else ""
