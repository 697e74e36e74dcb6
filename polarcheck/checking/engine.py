"""The rule engine: what rules find becomes findings, each at its place, with its numbers."""

from __future__ import annotations

import bisect
import contextlib
from collections.abc import Iterable, Mapping
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeVar

import msgspec
import numpy as np

from polarcheck.arrays import Mask, Rows, is_uniform, repeated
from polarcheck.checking import places
from polarcheck.checking.places import PLACES, Place
from polarcheck.checking.rule import Hits, Rule
from polarcheck.checking.tables import OF_CAUSE, Tables
from polarcheck.columns.trace import Trace
from polarcheck.errors import TooHardError
from polarcheck.execution.programs import name_at_head
from polarcheck.execution.run import begins_program
from polarcheck.finding import NOTE, SEVERITIES, Finding, NotEvaluated, Severity, Silenced, Undecided
from polarcheck.machines.codes import code_numbers, code_set
from polarcheck.reading.excerpt import shortened
from polarcheck.silence.suppression import Used, allowed
from polarcheck.time_limit import keep_going

if TYPE_CHECKING:
    from polarcheck.silence.allow_comments import Allows

#: More findings of one rule in one file are counted, not listed: nobody reads them, and hostile files stay bounded.
LISTED = 1000
#: Of the name of a program [characters].
_NAME_LENGTH = 40
#: Programs with more rows share constant columns; below, that saves less memory than it takes time.
_MANY_ROWS = 10_000
Found = TypeVar("Found", bound=Finding)
#: A finding of a run: its rule, and its number among those of the rule.
_Number = tuple[str, int]


class _Listed(msgspec.Struct, frozen=True):
    """
    The findings of one rule. index: the elements hit, sorted. finding: for each of them the finding that stands for it.
    silent: for each of them whether an allow comment silences that. cause: for each finding the rule and the element
    that it follows from; None where it stands alone.
    """

    index: Rows
    finding: Rows
    silent: Mask
    findings: list[Finding]
    cause: list[tuple[str, int] | None]


class Engine:
    """
    The hits of one run, each rule run once.

    severities: by rule, where it is not the rule's own. rules: those that are asked; none that is off. known: the hits
    of some of them. allows: the allow comments that are heeded. used: the names of allow comments that have
    silenced something, each with the position of its comment. heads: the block and the name of each program.
    """

    def __init__(
        self,
        tables: Tables,
        severities: Mapping[str, str],
        rules: Iterable[Rule],
        known: Mapping[str, Hits] | None = None,
        allows: Allows | None = None,
    ) -> None:
        self.tables = tables
        self.trace: Trace = tables["trace"]
        self.severities = severities
        self.rules = {rule.name: rule for rule in rules}
        self.unlisted: list[NotEvaluated] = []
        self.allows = allows
        self.used: set[Used] = set()
        self._hits: dict[str, Hits] = dict(known or {})
        self._nothing: dict[int, Hits] = {}
        self._columns_seen: dict[str, int] = {}
        self._constant_masks: dict[tuple[int, bool], Mask] = {}
        self._found: dict[str, _Listed | None] = {}
        self._asking: set[str] = set()
        self.heads = program_heads(self.trace)

    def hits(self, rule: Rule) -> Hits:
        """What the rule finds; nothing where one of its tables would take more than its bounds."""
        if rule.name not in self._hits:
            keep_going()
            try:
                self._hits[rule.name] = self._kept(rule.hits(self.tables))
                if len(self.trace) > _MANY_ROWS:
                    self._share_constant_columns()
            except TooHardError as error:
                self._give_up(rule, error)
        return self._hits[rule.name]

    def _kept(self, hits: Hits) -> Hits:
        """The hits as they are kept: most rules find nothing, and what they would have said of it is not needed."""
        if hits.mask.any():
            return hits
        count = len(hits.mask)
        if count not in self._nothing:
            self._nothing[count] = Hits(np.zeros(count, np.bool_))
        return self._nothing[count]

    def _share_constant_columns(self) -> None:
        """
        Free the columns computed since the last call that hold a single value: a fifth of the memory of a large check.

        Most masks of a program are all False or all True; those of one length and value become one array.
        """
        for name, table in self.tables.computed():
            columns: dict[str, Any] = getattr(table, "__dict__", {})
            first = self._columns_seen.get(name, 0)
            self._columns_seen[name] = len(columns)
            for key in list(islice(columns, first, None)):
                columns[key] = self._shared(columns[key])

    def _shared(self, column: Any) -> Any:
        """A column without memory of its own if it holds a single value, else the column itself."""
        if not isinstance(column, np.ndarray) or column.ndim != 1 or not column.size or column.dtype.hasobject:
            return column
        if not is_uniform(column):
            return column
        if column.dtype == np.bool_:
            return self._constant_masks.setdefault((len(column), bool(column[0])), column)
        return repeated(column[0], len(column))

    def _give_up(self, rule: Rule, error: TooHardError) -> None:
        self._hits[rule.name] = Hits(np.zeros(0, np.bool_))
        self.unlisted.append(too_hard(rule, error, self.trace))

    def findings(self) -> list[Finding]:
        """One finding per cause; what follows from it is listed in it, and raises its severity."""
        listed = None
        while listed is None:
            listed = self._all_listed()
        roots = _roots(listed)
        following: dict[_Number, list[Finding]] = {}
        for number, root in roots.items():
            if number != root:
                following.setdefault(root, []).append(_finding_of(listed, number))
        return [
            with_following(_finding_of(listed, number), following.get(number, []))
            for number, root in roots.items()
            if number == root
        ]

    def _all_listed(self) -> dict[str, _Listed] | None:
        """The findings by rule; None where one was given up only now, so that nothing follows from it any more."""
        self._found.clear()
        self._asking.clear()
        listed = {}
        for rule in self.rules.values():
            try:
                found = self._listed(rule)
            except TooHardError as error:
                self._give_up(rule, error)
                return None
            if found is not None:
                listed[rule.name] = found
        return listed

    def answered(self, finding: Finding, block: int) -> Finding:
        """A finding that is shown at a block; silenced where that allows it."""
        if self.allows is None or isinstance(finding, Silenced):
            return finding
        at = np.array([block])
        if not self.allows.silenced(finding.rule, at)[0]:
            return finding
        self.used |= self.allows.used(finding.rule, at)
        return allowed(finding, self.allows.reason(finding.rule, block))

    def _listed(self, rule: Rule) -> _Listed | None:
        if rule.name not in self._found:
            self._found[rule.name] = self._looked_for(rule)
        return self._found[rule.name]

    def _looked_for(self, rule: Rule) -> _Listed | None:
        hits = self.hits(rule)
        if hits is self._nothing.get(len(hits.mask)):
            return None
        index = np.flatnonzero(hits.mask)
        if not len(index):
            return None
        self._asking.add(rule.name)
        cause, element = self._causes(rule, index)
        self._asking.remove(rule.name)
        finding = np.zeros(len(index), np.int64)
        silent = np.zeros(len(index), bool)
        findings: list[Finding] = []
        causes: list[tuple[str, int] | None] = []
        for follows in (False, True):
            at = np.flatnonzero((cause >= 0) == follows)
            if not len(at):
                continue
            chosen, group, count = self._merged(rule, index[at])
            is_silent = self._silenced(rule, index[at[chosen]])
            silent[at] = is_silent[group]
            for quiet in (False, True) if is_silent.any() else (False,):
                # Each for itself: what is allowed must not take the place of what is told in a list that is cut.
                own = np.flatnonzero(is_silent == quiet)
                number_of = np.full(len(chosen), -1)
                number_of[own] = np.minimum(np.arange(len(own)), LISTED - 1) + len(findings)
                finding[at[is_silent[group] == quiet]] = number_of[group[is_silent[group] == quiet]]
                for number, runs in zip(chosen[own][:LISTED].tolist(), count[own].tolist(), strict=False):
                    first = at[number]
                    place = PLACES[rule.over](self.tables, int(index[first]))
                    found = self._finding(rule, place, hits, runs)
                    findings.append(self._allowed(found, place) if quiet else found)
                    is_one_more = follows and not quiet
                    causes.append((self._names[cause[first]], int(element[first])) if is_one_more else None)
                if len(own) > LISTED:
                    self.unlisted.append(_unlisted(rule, len(own)))
        return _Listed(index, finding, silent, findings, causes)

    def _silenced(self, rule: Rule, index: Rows) -> Mask:
        """Which of these elements an allow comment silences, where they stand."""
        if self.allows is None or not self.allows.names(rule.name):
            return np.zeros(len(index), bool)
        blocks = places.blocks(rule.over, self.tables)[index]
        found = self.allows.silenced(rule.name, blocks)
        self.used |= self.allows.used(rule.name, blocks)
        return found

    def _allowed(self, finding: Finding, place: Place) -> Finding:
        return finding if self.allows is None else allowed(finding, self.allows.reason(finding.rule, place.block))

    def _told(self, rule: Rule, index: Rows) -> Rows:
        """Those of the elements of a rule that are told: none that an allow comment silences."""
        if self.allows is None or not len(index) or not self.allows.names(rule.name):
            return index
        if rule.name not in self._asking:
            with contextlib.suppress(TooHardError):  # it is given up when it is its turn
                found = self._listed(rule)
                return index if found is None else found.index[~found.silent]
        # What its own findings follow from hangs on the one that asks: each element counts for itself.
        return index[~self.allows.silenced(rule.name, places.blocks(rule.over, self.tables)[index])]

    @cached_property
    def _names(self) -> list[str]:
        return list(self.rules)

    def _causes(self, rule: Rule, index: Rows) -> tuple[Rows, Rows]:
        """
        For each of these elements the number of the rule that it follows from, -1 for none, and the element of that.

        Only a cause that is itself reported counts: that of a rule which is not asked explains nothing to the reader.
        """
        cause, element = np.full(len(index), -1), np.full(len(index), -1)
        may_follow = self.hits(rule).follows
        for span, names in rule.causes(self.rules).items():
            for name in names:
                if name not in self.rules:
                    continue
                other = self.rules[name]
                hit = self._told(other, np.flatnonzero(self.hits(other).mask))
                if not len(hit):
                    continue
                try:
                    theirs = places.span_of(OF_CAUSE.get(span, span), other.over, self.tables)[hit]
                    own = places.span_of(span, rule.over, self.tables)[index]
                except TooHardError:
                    continue  # how far the cause reaches is not known: the finding stands alone
                order = np.argsort(theirs, kind="stable")
                at = order[np.minimum(np.searchsorted(theirs[order], own), len(hit) - 1)]
                found = (theirs[at] == own) & (own >= 0) & (cause < 0)
                if span in OF_CAUSE:
                    rows_of_cause = places.rows(other.over, self.tables)[hit[at]]
                    found &= rows_of_cause < places.rows(rule.over, self.tables)[index]
                if span in may_follow:
                    found &= may_follow[span][index]
                cause[found], element[found] = self._names.index(name), hit[at[found]]
        return cause, element

    def _merged(self, rule: Rule, index: Rows) -> tuple[Rows, Rows, Rows]:
        """
        Which of the elements are reported, by their number in `index`, for each element the one that stands for it, by
        its number among those, and for each of those how many it stands for.

        It is one for each block, which counts its runs, or for each section, program or the like, which counts blocks.
        """
        if rule.over not in ("rows", "sections") and not rule.once:
            every = np.arange(len(index))
            return every, every, np.ones(len(index), np.int64)
        block = places.blocks(rule.over, self.tables)[index]
        group = block
        if rule.once:
            key = places.span_of(rule.once, rule.over, self.tables)[index]
            key = np.where(key < 0, -1 - np.arange(len(index)), key)  # outside of all, each is by itself
            _, first, group = np.unique(key, return_index=True, return_inverse=True)
            if rule.over in ("rows", "sections"):
                # What begins in the same block runs again, as in a program that is called twice.
                group = block[first][group]
        _, first, group, count = np.unique(group, return_index=True, return_inverse=True, return_counts=True)
        if rule.worst and len(first) < len(index):
            value = self.tables.column(rule.worst)[index]
            order = np.lexsort((-np.arange(len(index)), value, group))
            first = order[np.cumsum(count) - 1]
        if rule.once:
            count = np.bincount(np.unique(np.stack((group, block)), axis=1)[0], minlength=len(first))
        order = np.argsort(first, kind="stable")
        return first[order], np.argsort(order)[group], count[order]

    def _finding(self, rule: Rule, place: Place, hits: Hits, count: int) -> Finding:
        from polarcheck.checking.fingerprints import fingerprint
        from polarcheck.checking.message import fill
        from polarcheck.checking.repair import fix_of

        trace = self.trace
        at = (
            places.words_at_fault(self.tables, place.row, rule.at, hits.at) if rule.over in ("rows", "sections") else []
        )
        start, end = places.span(self.tables, place, at)
        source = trace.text.source
        line, end_line = source.line_of(start), source.line_of(max(end - 1, start))
        own = _severity(rule, hits, place).name.lower()
        is_note = trace.machine.severities.get(rule.name, own) == NOTE.name.lower()
        text, values = fill(rule, hits, self.tables, place, at, count)
        block = places.block_text(trace.text, place.block)
        section = int(trace.mode.section[place.row]) if place.row >= 0 else -1
        kind = Undecided if hits.undecided is not None and hits.undecided[place.index] else Finding
        return kind(
            rule=rule.name,
            severity=self.severities.get(rule.name, own),
            message=text,
            line=line,
            column=start - int(source.line_starts[line - 1]) + 1,
            end_line=end_line,
            end_column=end - int(source.line_starts[end_line - 1]) + 1,
            block=block,
            program=self._program_name(place.block),
            section_line=int(trace.blocks.line[trace.mode.sections.enter[section]]) if section >= 0 else None,
            alarm=None if is_note else self._alarm(rule, at),
            values=values,
            count=count,
            source=rule.source,
            fingerprint=fingerprint(rule, trace.text, place),
            fix=fix_of(rule, hits, self.tables, place, count),
        )

    def _alarm(self, rule: Rule, at: list[int]) -> str | None:
        """What the control shows; not where the text of the alarm names codes, and those at fault are others."""
        machine, table = self.trace.machine, self.trace.run.words
        alarm = machine.alarms.get(rule.name) or None
        if alarm not in machine.alarm_codes:
            return alarm
        written = code_numbers(table.value[[index for index in at if table.address[index] == ord("G")]])
        return alarm if not len(written) or code_set(machine.codes_of_alarm(alarm))[written].any() else None

    def _program_name(self, block: int) -> str | None:
        at = bisect.bisect_right(self.heads, block, key=lambda head: head[0])
        return self.heads[at - 1][1] if at else None


def too_hard(rule: Rule, error: TooHardError, trace: Trace) -> NotEvaluated:
    """A rule that was given up; what takes long is the geometry of the polar sections."""
    return NotEvaluated(
        rule=rule.name, reason=str(error), blocks=int(np.count_nonzero(trace.mode.in_polar)) or len(trace)
    )


def _unlisted(rule: Rule, count: int) -> NotEvaluated:
    reason = f"only the first {LISTED} of {count} findings are listed"
    return NotEvaluated(rule=rule.name, reason=reason, blocks=count - LISTED, matters=False)


def program_heads(trace: Trace) -> list[tuple[int, str]]:
    """The block and the name of each program that has an O number or <name>, in order."""
    text, table = trace.text, trace.text.words
    is_head = begins_program(table)
    numbered = is_head & ~np.isnan(table.value)
    heads = list(zip(table.block[numbered], table.start[numbered], table.end[numbered], strict=True))
    bare = set(table.block[is_head & np.isnan(table.value)].tolist())
    for start, end, block in zip(text.names.start, text.names.end, text.names.block, strict=True):
        if int(block) in bare or text.source.excerpt(int(start), int(start) + 1) != "<":
            heads.append((block, start, end))
    return [
        (int(block), shortened(places.squeezed(name_at_head(text.source.excerpt(int(start), int(end)))), _NAME_LENGTH))
        for block, start, end in sorted(heads)
    ]


def _roots(listed: Mapping[str, _Listed]) -> dict[_Number, _Number]:
    """
    The finding at the end of each chain of causes, for all findings in order; one that stands alone is its own.

    Where a chain leads back to itself, the finding that stands first in the program is its cause.
    """
    roots: dict[_Number, _Number] = {}
    for name, of_rule in listed.items():
        for number in range(len(of_rule.findings)):
            roots[name, number] = name, number
    done = set[_Number]()
    for start in roots:
        chain: dict[_Number, None] = {}
        last = start
        while last not in done and last not in chain:
            chain[last] = None
            cause = listed[last[0]].cause[last[1]]
            if cause is None:
                break
            of_rule = listed[cause[0]]
            last = cause[0], int(of_rule.finding[np.searchsorted(of_rule.index, cause[1])])
        root = roots[last]
        if last in chain and listed[last[0]].cause[last[1]] is not None:
            circle = list(chain)[list(chain).index(last) :]
            root = min(circle, key=lambda number: _order(_finding_of(listed, number)))
        roots.update(dict.fromkeys(chain, root))
        done.update(chain)
    return roots


def _finding_of(listed: Mapping[str, _Listed], number: _Number) -> Finding:
    return listed[number[0]].findings[number[1]]


def with_following(finding: Finding, following: list[Finding]) -> Finding:
    """The finding with what follows from it, as severe as the worst of that."""
    if not following:
        return finding
    severity = max((finding.severity, *(found.severity for found in following)), key=SEVERITIES.__getitem__)
    return msgspec.structs.replace(finding, severity=severity, follows=in_order(following))


def in_order(findings: Iterable[Found]) -> list[Found]:
    """In the order of the lines; at one place the worst first."""
    return sorted(findings, key=_order)


def _order(finding: Finding) -> tuple[int, int, int, str]:
    return finding.line, finding.column, -SEVERITIES[finding.severity], finding.rule


def _severity(rule: Rule, hits: Hits, place: Place) -> Severity:
    given = rule.severity if hits.severity is None else hits.severity
    return Severity(int(given[place.index])) if isinstance(given, np.ndarray) else Severity(given)
