"""Applies the fixes of a program in rounds, until no fix is left that improves it."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from polarcheck.checking.edits import applied, line_written, origins, overlap, spans
from polarcheck.checking.settings import Settings
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.errors import SourceError, TooHardError
from polarcheck.foundation.finding import FileReport, Finding, Fix
from polarcheck.foundation.time_limit import current_limit, seconds_for, time_limit
from polarcheck.program.reading.source import Source
from polarcheck.rewrite.compare.terms import Change
from polarcheck.rewrite.fixes.fix_comparison import State, objection, state_of
from polarcheck.rules.editing import Replace
from polarcheck.rules.repair import WAY, repair_of

#: The most checks of one program for its fixes; further fixes wait for the next run.
MOST_CHECKS = 200
#: After this many refused fixes of a rule, no more fixes of that rule are tried in the program.
MOST_REFUSED = 20

#: Removes from a report the findings that must not be fixed, since a baseline suppresses them.
Suppress = Callable[[FileReport], FileReport]


class Fixed(msgspec.Struct, frozen=True):
    """
    A fix that was applied.

    rule: the rule whose finding it fixes.
    line: the line in the original file (from 1).
    title: the title of the fix.
    """

    rule: str
    line: int
    title: str


class Written(Fixed, frozen=True):
    """
    An unsafe fix that was applied.

    new_line: the line in the result (from 1).
    block: what stands there.
    """

    new_line: int
    block: str


class Refused(Fixed, frozen=True):
    """A fix that was not applied, and the reason."""

    reason: str


class Outcome(msgspec.Struct, frozen=True):
    """
    A program with its fixes.

    data: the program, as bytes.
    fixed, refused: the fixes that were applied, and those that were not.
    assumed: the unsafe fixes that were applied, once for each block that they write.
    left: the number of unsafe fixes that remain, since they were not requested.
    origin: for each line of the result its line in the original file (from 1).
    is_whole: there was time for all fixes.
    """

    data: bytes
    fixed: list[Fixed]
    assumed: list[Written]
    refused: list[Refused]
    left: int = 0
    origin: list[int] = []
    is_whole: bool = True


class _Candidate(msgspec.Struct, frozen=True):
    """
    A fix to try.

    finding: the finding that it fixes.
    fix: the fix.
    spans: its edits by character position.
    """

    finding: Finding
    fix: Fix
    spans: list[Replace]


#: Identifies a fix in a version of a program: rule, line, title.
_Key = tuple[str, int, str]


def with_fixes(
    data: bytes,
    settings: Settings,
    path: str,
    unsafe: bool = False,
    suppress: Suppress = lambda report: report,
) -> Outcome:
    """
    Return a program with the fixes of its findings.

    unsafe: apply unsafe fixes, too.
    suppress: removes findings that must not be fixed from a report.

    A fix that would cause another finding, or another tool path than it declares, is refused. Fixes that overlap are
    applied in successive rounds. All rounds share the time limit of one check; further fixes wait for the next run.
    Raises what state_of raises for the original program.
    """
    with time_limit(seconds_for(len(data), settings.job.run.max_seconds)):
        state = state_of(data, settings, path)
        work = _Work(settings, path, unsafe, suppress, len(state.source.line_starts))
        while not work.is_over and (candidates := work.candidates(state)):
            state = work.best(state, candidates) or state
        fixes = [finding.fix for finding in suppress(state.selected).findings if finding.fix is not None]
        return Outcome(
            state.source.data,
            work.fixed,
            sorted(work.assumed, key=lambda written: written.new_line),
            list(work.refused.values()),
            0 if unsafe else sum(not fix.safe for fix in fixes),
            work.origin.tolist(),
            not work.is_over,
        )


class _Work:
    """
    The state of the rounds.

    fixed: the fixes applied so far.
    assumed: the unsafe ones, with their lines in the present program.
    refused: the fixes refused since the last one that was applied.
    last: the program with the fixes accepted in this round; None before the first.
    checks: the number of checks so far.
    origin: for each line of the present program its line in the original file (from 1).
    """

    def __init__(self, settings: Settings, path: str, unsafe: bool, suppress: Suppress, lines: int) -> None:
        self.settings, self.path, self.unsafe, self.suppress = settings, path, unsafe, suppress
        self.fixed: list[Fixed] = []
        self.assumed: list[Written] = []
        self.refused: dict[_Key, Refused] = {}
        self.last: State | None = None
        self.checks = 0
        self.origin: Rows = np.arange(1, lines + 1)

    @property
    def is_over(self) -> bool:
        """Return True once the time or the number of checks is used up."""
        limit = current_limit()
        return self.checks >= MOST_CHECKS or (limit is not None and limit.is_over())

    def candidates(self, state: State) -> list[_Candidate]:
        """Return the fixes to try next, in the order of the lines; none of them overlap."""
        chosen: list[_Candidate] = []
        taken: list[Replace] = []
        for finding in self.suppress(state.selected).findings:
            fix = finding.fix
            if fix is None or not (fix.safe or self.unsafe) or _key(finding, fix) in self.refused:
                continue
            if self._is_exhausted(finding.rule):
                continue
            edits = spans(state.source, fix)
            if not overlap(edits, taken):
                chosen.append(_Candidate(finding, fix, edits))
                taken += edits
        # A fix that may change the tool path is tried alone.
        plain = [candidate for candidate in chosen if WAY not in _change(candidate).names]
        return plain or chosen[:1]

    def best(self, state: State, candidates: Sequence[_Candidate]) -> State | None:
        """Return the program with as many of these fixes as possible; None if all are refused."""
        self.last = None
        accepted = self._accepted(state, [], candidates)
        if self.last is None:
            return None
        # Refused fixes are tried again, since the accepted ones may have removed the reason.
        self.refused = {}
        self.fixed += [
            Fixed(candidate.finding.rule, self._line(candidate), candidate.fix.title) for candidate in accepted
        ]
        edits = [span for candidate in accepted for span in candidate.spans]
        after, before = self.last.source, origins(state.source, self.last.source, edits)
        self.assumed = [_moved(written, after, before) for written in self.assumed]
        for candidate in accepted:
            if not candidate.fix.safe:
                fixed = candidate.finding.rule, self._line(candidate), candidate.fix.title
                for line in dict.fromkeys(line_written(after, edits, span) for span in candidate.spans):
                    self.assumed.append(Written(*fixed, line, after.line_text(line).strip()))
        self.origin = self.origin[before - 1]
        return self.last

    def _accepted(self, state: State, accepted: list[_Candidate], candidates: Sequence[_Candidate]) -> list[_Candidate]:
        """Return the accepted fixes and as many of the candidates as possible: refused together, they are split."""
        candidates = [candidate for candidate in candidates if not self._is_exhausted(candidate.finding.rule)]
        if not candidates or self.is_over:
            return accepted
        after, reason = self._try(state, [*accepted, *candidates])
        if after is not None:
            self.last = after
            return [*accepted, *candidates]
        if len(candidates) == 1:
            (refused,) = candidates
            finding, fix = refused.finding, refused.fix
            self.refused[_key(finding, fix)] = Refused(finding.rule, self._line(refused), fix.title, reason)
            return accepted
        for part in _parts(candidates):
            accepted = self._accepted(state, accepted, part)
        return accepted

    def _is_exhausted(self, rule: str) -> bool:
        """Return True once too many fixes of the rule were refused."""
        return sum(refused.rule == rule for refused in self.refused.values()) >= MOST_REFUSED

    def _line(self, candidate: _Candidate) -> int:
        return int(self.origin[candidate.finding.line - 1])

    def _try(self, state: State, candidates: Sequence[_Candidate]) -> tuple[State | None, str]:
        """Apply fixes and check the result; returns it, or None and the reason why it is refused."""
        edits = [span for candidate in candidates for span in candidate.spans]
        data = applied(state.source, edits)
        if data is None:
            return None, f"its encoding, {state.source.encoding}, does not give all characters back as they are"
        self.checks += 1
        try:
            after = state_of(data, self.settings, self.path)
            rules = {candidate.finding.rule for candidate in candidates}
            origin = origins(state.source, after.source, edits).tolist()
            reason = objection(state, after, rules, [_change(candidate) for candidate in candidates], origin)
        except (SourceError, TooHardError) as error:
            return None, f"the result could not be judged: {error}"
        return (None, reason) if reason else (after, "")


def _moved(written: Written, after: Source, before: Rows) -> Written:
    """Return a fix with its line and block after further edits; before: for each line now the line it comes from."""
    lines = (np.flatnonzero(before == written.new_line) + 1).tolist()
    line = next((line for line in lines if after.line_text(line).strip() == written.block), lines[0])
    return msgspec.structs.replace(written, new_line=line, block=after.line_text(line).strip())


def _parts(candidates: Sequence[_Candidate]) -> list[list[_Candidate]]:
    """Split candidates by rule, or in two if all are of one rule: refused fixes are often of the same rule."""
    rules = dict.fromkeys(candidate.finding.rule for candidate in candidates)
    if len(rules) > 1:
        return [[candidate for candidate in candidates if candidate.finding.rule == rule] for rule in rules]
    half = len(candidates) // 2
    return [list(candidates[:half]), list(candidates[half:])]


def _key(finding: Finding, fix: Fix) -> _Key:
    return finding.rule, finding.line, fix.title


def _change(candidate: _Candidate) -> Change:
    """Return what a fix declares to change in the tool path, and in which lines."""
    repair = repair_of(candidate.finding.rule)
    lines = [line for edit in candidate.fix.edits for line in (edit.line, edit.end_line)]
    return Change(repair.changes if repair is not None else (), range(min(lines), max(lines) + 1))
