"""The fixes of a program: round after round, until none is left that makes it better."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import msgspec
import numpy as np

from polarcheck.arrays import Rows
from polarcheck.checking.editing import Replace
from polarcheck.checking.repair import WAY, repair_of
from polarcheck.checking.settings import Settings
from polarcheck.errors import SourceError, TooHardError
from polarcheck.finding import FileReport, Finding, Fix
from polarcheck.fixes.comparison import State, objection, state_of
from polarcheck.fixes.edits import applied, origins, overlap, spans
from polarcheck.time_limit import current_limit, seconds_for, time_limit

#: The checks of one program for its fixes; what is left then is left for the next time.
MOST_CHECKS = 200
#: Where so many fixes of a rule are refused, no more of that rule are tried in the program.
MOST_REFUSED = 20

Answered = Callable[[FileReport], FileReport]


class Fixed(msgspec.Struct, frozen=True):
    """A fix that was made: the rule whose finding it mends, its line in the file as it was (from 1), its title."""

    rule: str
    line: int
    title: str


class Refused(Fixed, frozen=True):
    """A fix that was not made, and why."""

    reason: str


class Outcome(msgspec.Struct, frozen=True):
    """
    The bytes with the fixes; what was made, and what not.

    left: how many are only made where unsafe ones are. is_whole: there was time for all of them. origin: for each line
    of the result that of the file (from 1).
    """

    data: bytes
    fixed: list[Fixed]
    refused: list[Refused]
    left: int = 0
    origin: list[int] = []
    is_whole: bool = True


class _Candidate(msgspec.Struct, frozen=True):
    """A fix that may be made. spans: its edits by position."""

    found: Finding
    fix: Fix
    spans: list[Replace]


#: Of a fix of a program as it is.
_Key = tuple[str, int, str]


def with_fixes(
    data: bytes,
    settings: Settings,
    path: str,
    encoding: str | None = None,
    unsafe: bool = False,
    answered: Answered = lambda report: report,
) -> Outcome:
    """
    A program with the fixes of its findings: the safe ones, or the unsafe ones, too.

    answered: takes the findings out of a report that somebody has answered for: they are not fixed. A fix that would
    bring another finding, or another way of the tool than it says, is not made. Those that touch each other come one
    round after the other. All of it may take as long as a check; what is left then is left for the next time. Raises
    what state_of raises for the program as it is.
    """
    with time_limit(seconds_for(len(data), settings.job.run.max_seconds)):
        return _fixed(data, settings, path, encoding, unsafe, answered)


def _fixed(
    data: bytes, settings: Settings, path: str, encoding: str | None, unsafe: bool, answered: Answered
) -> Outcome:
    state = state_of(data, settings, path, encoding)
    work = _Work(settings, path, encoding, unsafe, answered, len(state.source.line_starts))
    while not work.is_over:
        candidates = work.candidates(state)
        if not candidates:
            break
        state = work.best(state, candidates) or state
    left = sum(one.fix is not None and not one.fix.safe and not unsafe for one in answered(state.asked).findings)
    return Outcome(
        state.source.data, work.fixed, list(work.refused.values()), left, work.origin.tolist(), not work.is_over
    )


class _Work:
    """
    What was made so far, and refused since then. origin: for each line of the program as it is now that of the file
    (from 1).
    """

    def __init__(
        self,
        settings: Settings,
        path: str,
        encoding: str | None,
        unsafe: bool,
        answered: Answered,
        lines: int,
    ) -> None:
        self.settings, self.path, self.encoding = settings, path, encoding
        self.unsafe, self.answered = unsafe, answered
        self.fixed: list[Fixed] = []
        self.refused: dict[_Key, Refused] = {}
        self.last: State | None = None
        self.checks = 0
        self.origin: Rows = np.arange(1, lines + 1)

    @property
    def is_over(self) -> bool:
        """What is left is left for the next time."""
        limit = current_limit()
        return self.checks >= MOST_CHECKS or (limit is not None and limit.is_over())

    def candidates(self, state: State) -> list[_Candidate]:
        """The fixes to try next, in the order of the lines: of which none touches another."""
        chosen: list[_Candidate] = []
        taken: list[Replace] = []
        for found in self.answered(state.asked).findings:
            fix = found.fix
            if fix is None or not (fix.safe or self.unsafe) or _key(found, fix) in self.refused:
                continue
            if self._is_given_up(found.rule):
                continue
            own = spans(state.source, fix)
            if not overlap(own, taken):
                chosen.append(_Candidate(found, fix, own))
                taken += own
        # What may change the way of the tool is looked at by itself.
        plain = [one for one in chosen if WAY not in _changes(one)[0]]
        return plain or chosen[:1]

    def best(self, state: State, candidates: Sequence[_Candidate]) -> State | None:
        """The program with as many of these fixes as it takes; None where it takes none of them."""
        self.last = None
        made = self._accepted(state, [], candidates)
        if self.last is None:
            return None
        # What was refused is tried again: these may have made room for it, and the next time would find it.
        self.refused = {}
        self.fixed += [Fixed(one.found.rule, self._line(one), one.fix.title) for one in made]
        spans_made = [span for one in made for span in one.spans]
        self.origin = self.origin[origins(state.source, self.last.source, spans_made) - 1]
        return self.last

    def _accepted(self, state: State, made: list[_Candidate], candidates: Sequence[_Candidate]) -> list[_Candidate]:
        """Those that were made, with as many of the candidates as the program takes beside them."""
        candidates = [one for one in candidates if not self._is_given_up(one.found.rule)]
        if not candidates or self.is_over:
            return made
        after, reason = self._tried(state, [*made, *candidates])
        if after is not None:
            self.last = after
            return [*made, *candidates]
        if len(candidates) == 1:
            (one,) = candidates
            self.refused[_key(one.found, one.fix)] = Refused(one.found.rule, self._line(one), one.fix.title, reason)
            return made
        for part in _parts(candidates):
            made = self._accepted(state, made, part)
        return made

    def _is_given_up(self, rule: str) -> bool:
        """So many fixes of the rule were refused that no more are tried."""
        return sum(refused.rule == rule for refused in self.refused.values()) >= MOST_REFUSED

    def _line(self, one: _Candidate) -> int:
        return int(self.origin[one.found.line - 1])

    def _tried(self, state: State, candidates: Sequence[_Candidate]) -> tuple[State | None, str]:
        data = applied(state.source, [span for one in candidates for span in one.spans])
        if data is None:
            return None, f"its encoding, {state.source.encoding}, does not give all characters back as they are"
        self.checks += 1
        try:
            after = state_of(data, self.settings, self.path, self.encoding)
            rules = {one.found.rule for one in candidates}
            reason = objection(state, after, rules, [_changes(one) for one in candidates])
        except (SourceError, TooHardError) as error:
            return None, f"the result could not be judged: {error}"
        return (None, reason) if reason else (after, "")


def _parts(candidates: Sequence[_Candidate]) -> list[list[_Candidate]]:
    """Those of each rule, or the halves of those of a single one: what is refused often is so of one rule."""
    rules = dict.fromkeys(one.found.rule for one in candidates)
    if len(rules) > 1:
        return [[one for one in candidates if one.found.rule == rule] for rule in rules]
    half = len(candidates) // 2
    return [list(candidates[:half]), list(candidates[half:])]


def _key(found: Finding, fix: Fix) -> _Key:
    return found.rule, found.line, fix.title


def _changes(one: _Candidate) -> tuple[Sequence[str], range]:
    """What of the path a fix says it changes, and in which lines."""
    way = repair_of(one.found.rule)
    lines = [line for edit in one.fix.edits for line in (edit.line, edit.end_line)]
    return way.changes if way is not None else (), range(min(lines), max(lines) + 1)
