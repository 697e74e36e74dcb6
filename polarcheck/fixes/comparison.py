"""Whether a program with fixes is better than the one without: its findings, and the way of the tool."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterable, Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.arrays import Floats, Mask
from polarcheck.checking.check import check_runs, read
from polarcheck.checking.engine import LISTED
from polarcheck.checking.repair import FEED, WAY, Z
from polarcheck.checking.rule import load_all
from polarcheck.checking.settings import Settings
from polarcheck.checking.tables import Tables
from polarcheck.finding import SEVERITIES, FileReport, Finding
from polarcheck.reading import source
from polarcheck.reading.source import Source
from polarcheck.table.moves import Moves, z_along
from polarcheck.table.trace import Trace
from polarcheck.time_limit import seconds_for, time_limit

#: Lengths and feeds that agree so far are the same [mm, mm/min].
_SAME = 1e-6
_VERDICTS = ("pass", "unverified", "fail")


class State(msgspec.Struct, frozen=True):
    """
    A program as it is at some point, and all that is known of it.

    report: by all rules that are not off. asked: by those that the user chose; the same where he chose none.
    """

    source: Source
    found: Sequence[tuple[str, Tables]]
    report: FileReport
    asked: FileReport


def state_of(data: bytes, settings: Settings, path: str, encoding: str | None) -> State:
    """
    Read and check a program.

    Raises SourceError for bytes that are not of the encoding, TooHardError where it would take too long.
    """
    every = list(load_all().values())
    with time_limit(seconds_for(len(data), settings.job.run.max_seconds)):
        found = read(data, settings.machine, settings.job, path, encoding)
        report = check_runs(found, every, settings.severities, settings.inline)
        is_chosen = len(settings.rules) < len(every)
        asked = check_runs(found, settings.rules, settings.severities, settings.inline) if is_chosen else report
    # Of several channels each has a view of its own; what is edited is the file.
    return State(source.read(data, path, encoding), found, report, asked)


def objection(
    before: State, after: State, rules: Collection[str], changes: Sequence[tuple[Collection[str], range]]
) -> str:
    """
    Why the second must not take the place of the first; empty where it may.

    rules: those whose findings are mended.
    changes: what of the path of the tool center the fixes say they change (CHANGES), and in which lines.
    """
    return _worse(before.report, after.report, rules) or _moves_otherwise(before, after, changes)


def _worse(before: FileReport, after: FileReport, rules: Collection[str]) -> str:
    """What is found that was not there, or is there still."""
    old, new = _by_rule(before), _by_rule(after)
    for rule, found in new.items():
        known = old.get(rule, [])
        if len(found) > len(known) or any(_rank(one) > _rank(other) for one, other in zip(found, known, strict=False)):
            told = {(one.block, one.message) for one in known}
            one = next((one for one in found if (one.block, one.message) not in told), found[0])
            return f"the result would have {rule} in line {one.line}: {one.message}"
    for rule in rules:
        if len(old.get(rule, ())) <= len(new.get(rule, ())) < LISTED:
            return f"the finding would still be there, in line {new[rule][0].line}"
    missing = {one.rule for one in before.not_evaluated if one.matters}
    for left in after.not_evaluated:
        if left.matters and left.rule not in missing:
            return f"the result could not be judged: {left.reason}"
    if _VERDICTS.index(after.verdict) > _VERDICTS.index(before.verdict):
        return f"the verdict on the result would be {after.verdict}"
    return ""


def _by_rule(report: FileReport) -> dict[str, list[Finding]]:
    """All findings, what follows and what is silenced included, by rule, the worst first."""
    found = defaultdict[str, list[Finding]](list)
    for one in _all([*report.findings, *report.silenced]):
        found[one.rule].append(one)
    return {rule: sorted(findings, key=_rank, reverse=True) for rule, findings in found.items()}


def _all(findings: Iterable[Finding]) -> Iterator[Finding]:
    for found in findings:
        yield found
        yield from found.follows


def _rank(found: Finding) -> int:
    return SEVERITIES[found.severity]


def _moves_otherwise(before: State, after: State, changes: Sequence[tuple[Collection[str], range]]) -> str:
    if [name for name, _ in before.found] != [name for name, _ in after.found]:
        return "the program would run otherwise"
    for (_, old), (_, new) in zip(before.found, after.found, strict=True):
        said = _in_sections(old, new, changes) or _outside(old, new)
        if said:
            return said
    return ""


def _in_sections(old: Tables, new: Tables, changes: Sequence[tuple[Collection[str], range]]) -> str:
    """What differs in the moves of the tool center."""
    trace, other = old["trace"], new["trace"]
    was, now = (_but_free(tables, changes) for tables in (old, new))
    if len(was) != len(now) or len(was.entry) != len(now.entry):
        return "the tool would make other moves in the polar mode"
    same = (was.section == now.section) & (was.kind == now.kind) & (was.known == now.known)
    for name in ("start", "end", "center"):
        same &= _alike(getattr(was, name), getattr(now, name))
    if not same.all() or not _alike(was.entry, now.entry).all():
        line = _line(trace, was, ~same)
        return f"the tool center would take another way{line}"
    z = [_alike(*pair) for pair in zip(z_along(trace, was), z_along(other, now), strict=True)]
    if (wrong := ~(z[0] & z[1]) & ~_may(trace, was, changes, Z)).any():
        return f"Z would move otherwise{_line(trace, was, wrong)}"
    if (wrong := ~_alike(was.feed, now.feed) & ~_may(trace, was, changes, FEED)).any():
        return f"F would be another{_line(trace, was, wrong)}"
    return ""


def _but_free(tables: Tables, changes: Sequence[tuple[Collection[str], range]]) -> Moves:
    """The moves without those whose way may be another; fixes that say so put in no lines, and come alone."""
    trace, moves = tables["trace"], tables["moves"]
    found: Moves = moves
    for names, edited in changes:
        if WAY in names:
            inside = (trace.line_in_file >= edited.start) & (trace.line_in_file < edited.stop)
            rows = np.unique(moves.row)
            at = np.flatnonzero(inside[rows])
            free = np.isin(moves.row, rows[np.union1d(at, np.maximum(at - 1, 0))])
            kept = {name: getattr(found, name)[~free] for name in Moves.__struct_fields__ if name != "entry"}
            found = Moves(**kept, entry=moves.entry)
    return found


def _may(trace: Trace, moves: Moves, changes: Sequence[tuple[Collection[str], range]], what: str) -> Mask:
    """Moves of lines in which fixes say that they change this; what F and G words of these lines govern, too."""
    lines = trace.line_in_file
    found = np.zeros(len(trace), bool)
    for names, edited in changes:
        if what in names:
            inside = (lines >= edited.start) & (lines < edited.stop)
            found |= inside
            if what == FEED:
                found |= np.isin(trace.feed_word, trace.feed_word[inside & trace.has("F")])
                found |= np.isin(trace.motion_word, trace.motion_word[inside & trace.sets("motion")])
    return found[moves.row]


def _outside(old: Tables, new: Tables) -> str:
    """What differs in the moves outside the polar mode."""
    trace, other = old["trace"], new["trace"]
    was, now = (np.flatnonzero(one.moves & (one.section < 0)) for one in (trace, other))
    if len(was) != len(now):
        return "the axes would make other moves outside the polar mode"
    same = np.ones(len(was), bool)
    for name in ("motion", "x", "z", "c_angle"):
        same &= _alike(getattr(trace, name)[was], getattr(other, name)[now])
    if not same.all():
        line = int(trace.line_in_file[was[np.argmin(same)]])
        return f"the axes would move otherwise in line {line}, outside the polar mode"
    return ""


def _alike(one: Floats, other: Floats) -> Mask:
    """The same, or unknown in both."""
    unknown = np.isnan(one) & np.isnan(other)
    with np.errstate(invalid="ignore"):
        return np.asarray(unknown | (one == other) | (np.abs(one - other) <= _SAME))


def _line(trace: Trace, moves: Moves, wrong: Mask) -> str:
    at = np.flatnonzero(wrong)
    return f" from line {int(trace.line_in_file[moves.row[at[0]]])} on" if len(at) else ""
