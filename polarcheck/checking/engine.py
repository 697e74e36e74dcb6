"""The rule engine: turns the hits of rules into findings, each with its place and its values."""

from __future__ import annotations

import bisect
from collections.abc import Iterable, Mapping
from itertools import islice
from typing import TYPE_CHECKING, Any, TypeVar
from weakref import WeakValueDictionary

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.checking.called_files import in_call
from polarcheck.checking.suppression import allowed
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.allow_mention import Used
from polarcheck.foundation.arrays import Floats, Mask, Rows, cached_property, different, is_uniform, repeated
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import (
    NOTE,
    SEVERITIES,
    SEVERITY_NAMES,
    Finding,
    NotEvaluated,
    Severity,
    Silenced,
    Undecided,
)
from polarcheck.foundation.time_limit import keep_going
from polarcheck.program.execution.programs import name_at_head
from polarcheck.program.execution.run import begins_program
from polarcheck.program.machines.code_tables import code_numbers, code_set
from polarcheck.program.reading.excerpt import shortened
from polarcheck.rules import places
from polarcheck.rules.places import PLACES, Place
from polarcheck.rules.rule import Hits, Rule
from polarcheck.rules.tables import OF_CAUSE, Tables

if TYPE_CHECKING:
    from polarcheck.columns.words.allow_comments import Allows

#: Findings listed per rule and file. Further ones are only counted, which bounds memory.
LISTED = 1000
#: Longest program name in a finding [characters].
_NAME_LENGTH = 40
#: Longer programs share constant columns [rows]. In shorter ones the memory saved is not worth the time.
_MANY_ROWS = 10_000
AnyFinding = TypeVar("AnyFinding", bound=Finding)
#: Identifies a finding of a run: the name of its rule, and its index in Listed.findings of that rule.
_Number = tuple[str, int]


class Listed(msgspec.Struct, frozen=True):
    """
    The findings of one rule in one run; the table `listed` has them by rule.

    index: the elements hit, sorted (hits).
    finding: the index in `findings` of the finding that covers each hit (hits).
    findings: the findings of the rule.
    cause: the rule name and the element that each finding follows from, None for a root finding (findings).
    """

    index: Rows
    finding: Rows
    findings: list[Finding]
    cause: list[tuple[str, int] | None]


class Engine:
    """
    Runs each rule once over the tables of one run and caches its hits.

    tables: the tables of the run.
    severities: severity by rule name, where it differs from the default of the rule.
    rules: the rules to run, by name, without those that are off.
    known: hits that are known already, by rule name.
    allows: the allow comments in effect; None if they are ignored.
    used: the names of allow comments that silenced a hit, each with the position of its comment.
    unlisted: rules that were given up, and findings beyond LISTED.
    heads: the block and the name of each program.
    rows_in_calls: the row of each finding in a called program, by its rule, line and column.
    """

    def __init__(
        self,
        tables: Tables,
        severities: Mapping[str, str],
        rules: Iterable[Rule],
        known_hits: Mapping[str, Hits] | None = None,
        allows: Allows | None = None,
    ) -> None:
        self.tables = tables
        self.trace: Trace = tables["trace"]
        self.severities = severities
        self.rules = {rule.name: rule for rule in rules}
        self.unlisted: list[NotEvaluated] = []
        self.allows = allows
        self.used: set[Used] = set()
        self._is_long = len(self.trace) > _MANY_ROWS
        self._hits: dict[str, Hits] = dict(known_hits or {})
        self._empty_hits: dict[int, Hits] = {}
        self._columns_seen: dict[str, int] = {}
        self._constant_masks: dict[tuple[int, bool], Mask] = {}
        self._columns: WeakValueDictionary[tuple[np.dtype[Any], int, int], NDArray[Any]] = WeakValueDictionary()
        self.heads = program_heads(self.trace)
        self.rows_in_calls: dict[tuple[str, int, int], int] = {}

    def hits(self, rule: Rule) -> Hits:
        """Run the rule and cache its hits; empty if one of its tables exceeds its bounds."""
        if rule.name not in self._hits:
            keep_going()
            try:
                self._hits[rule.name] = self._evaluated(rule)
                if self._is_long:
                    self._share_constant_columns()
            except TooHardError as error:
                self._give_up(rule, error)
        return self._hits[rule.name]

    def _evaluated(self, rule: Rule) -> Hits:
        if not self.tables.has(rule.only_with):
            return self._empty(0)
        hits = rule.hits(self.tables)
        if self.trace.run.unknown_words and not rule.of_text and hits.mask.any():
            rows = places.rows(rule.over, self.tables)
            unknown = self.trace.modal.behind_unknown_code
            if rule.of_contours:
                unknown = unknown | self.tables["unknown_words"].around_section
            hits = msgspec.structs.replace(hits, mask=hits.mask & ~((rows >= 0) & unknown[rows]))
        return self._shared_if_empty(hits)

    def _shared_if_empty(self, hits: Hits) -> Hits:
        """Replace hits that are all False by a shared empty object: their values are not needed."""
        # For a few rows, `any` takes ten times as long.
        return hits if np.count_nonzero(hits.mask) else self._empty(len(hits.mask))

    def _empty(self, count: int) -> Hits:
        """The hits of all rules that hit none of so many elements."""
        if count not in self._empty_hits:
            self._empty_hits[count] = Hits(np.zeros(count, np.bool_))
        return self._empty_hits[count]

    def _share_constant_columns(self) -> None:
        """
        Share the constant and the equal columns computed since the last call: a third of the memory of a large check.

        Most masks of a program are all False or all True; those of one length and value become one array. Of the others
        many are equal where nothing is turned, shifted or given in another unit.
        """
        for name, table in self.tables.computed():
            columns: dict[str, Any] = getattr(table, "__dict__", {})
            first = self._columns_seen.get(name, 0)
            if first == len(columns):
                continue
            first = first if first <= len(columns) else 0  # the table has forgotten its columns
            self._columns_seen[name] = len(columns)
            for key in list(islice(columns, first, None)):
                columns[key] = self._shared(columns[key])

    def _shared(self, column: Any) -> Any:
        """Return a shared or zero-stride copy of a constant column, one column for equal ones, any other unchanged."""
        if not isinstance(column, np.ndarray) or column.ndim != 1 or not column.size or column.dtype.hasobject:
            return column
        if not is_uniform(column):
            return self._first_equal(column)
        if column.dtype == np.bool_:
            return self._constant_masks.setdefault((len(column), bool(column[0])), column)
        return repeated(column[0], len(column))

    def _first_equal(self, column: NDArray[Any]) -> NDArray[Any]:
        """Return the first column seen that equals this one bit by bit and is still used, which may be this one."""
        if column.dtype.kind not in "biufc" or not column.flags.c_contiguous:
            return column
        bits = column.view(np.uint8)
        key = column.dtype, len(column), int(bits[: len(bits) // 8 * 8].view(np.uint64).sum())
        first = self._columns.setdefault(key, column)
        return first if first is column or np.array_equal(first.view(np.uint8), bits) else column

    def _give_up(self, rule: Rule, error: TooHardError) -> None:
        self._hits[rule.name] = Hits(np.zeros(0, np.bool_))
        self.unlisted.append(too_hard(rule, error, self.trace))

    def findings(self) -> list[Finding]:
        """Return one finding per root cause; it lists those that follow from it and has their highest severity."""
        listed = None
        while listed is None:
            listed = self._all_listed()
        # Pictures show the other places of a finding. Rules of a second engine, on allow comments, come to the first.
        self.tables.give("listed", {**self.tables.get("listed", {}), **listed})
        self.tables.give("rows_in_calls", {**self.tables.get("rows_in_calls", {}), **self.rows_in_calls})
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

    def _all_listed(self) -> dict[str, Listed] | None:
        """List the findings of each rule; None if a rule was given up, since findings may have followed from it."""
        listed = {}
        for rule in self.rules.values():
            try:
                of_rule = self._list_findings(rule)
            except TooHardError as error:
                self._give_up(rule, error)
                return None
            if of_rule is not None:
                listed[rule.name] = of_rule
        return listed

    def answered(self, finding: Finding, block: int) -> Finding:
        """Return the finding as shown at a block: silenced if an allow comment of that block names its rule."""
        if self.allows is None or isinstance(finding, Silenced):
            return finding
        block_index = np.array([block])
        if not self.allows.silenced(finding.rule, block_index)[0]:
            return finding
        self.used |= self.allows.used(finding.rule, block_index)
        return allowed(finding, self.allows.reason(finding.rule, block))

    def _list_findings(self, rule: Rule) -> Listed | None:
        hits = self.hits(rule)
        if hits is self._empty_hits.get(len(hits.mask)):
            return None
        index = np.flatnonzero(hits.mask)
        if not len(index):
            return None
        cause, element = self._causes(rule, index)
        if rule.over == "rows" and (cause < 0).any() and (cause >= 0).any():
            self._share_causes(places.blocks(rule.over, self.tables)[index], cause, element)
        finding = np.zeros(len(index), np.int64)
        findings: list[Finding] = []
        causes: list[tuple[str, int] | None] = []
        for follows in (False, True):
            listed = np.flatnonzero((cause >= 0) == follows)
            if not len(listed):
                continue
            chosen, group, count = self._merged(rule, index[listed], hits.worst)
            is_silent = self._silenced(rule, index[listed[chosen]])
            for quiet in (False, True) if is_silent.any() else (False,):
                # Cut each list separately: silenced findings must not displace reported ones.
                groups = np.flatnonzero(is_silent == quiet)
                number_of = np.full(len(chosen), -1)
                number_of[groups] = np.minimum(np.arange(len(groups)), LISTED - 1) + len(findings)
                finding[listed[is_silent[group] == quiet]] = number_of[group[is_silent[group] == quiet]]
                for number, runs in zip(chosen[groups][:LISTED].tolist(), count[groups].tolist(), strict=False):
                    first = listed[number]
                    located = PLACES[rule.over](self.tables, int(index[first]))
                    one_finding = self.finding(rule, located, hits, runs)
                    findings.append(self._allowed(one_finding, located) if quiet else one_finding)
                    has_cause = follows and not quiet
                    causes.append((self._names[cause[first]], int(element[first])) if has_cause else None)
                if len(groups) > LISTED:
                    self.unlisted.append(_unlisted(rule, len(groups)))
        return Listed(index, finding, findings, causes)

    def _silenced(self, rule: Rule, index: Rows) -> Mask:
        """True for the elements that an allow comment silences."""
        if self.allows is None or not self.allows.names(rule.name):
            return np.zeros(len(index), bool)
        blocks = places.blocks(rule.over, self.tables)[index]
        silenced = self.allows.silenced(rule.name, blocks)
        self.used |= self.allows.used(rule.name, blocks)
        return silenced

    def _allowed(self, finding: Finding, element: Place) -> Finding:
        return finding if self.allows is None else allowed(finding, self.allows.reason(finding.rule, element.block))

    @cached_property
    def _names(self) -> list[str]:
        return list(self.rules)

    def _causes(self, rule: Rule, index: Rows) -> tuple[Rows, Rows]:
        """
        Find the cause of each of these elements.

        Returns two arrays of the length of `index`:
        cause: the index of the causing rule in `_names`, -1 for none.
        element: the element that the causing rule hit, -1 for none.

        A hit that an allow comment silences is a cause, too: what follows from it is silenced with it.
        """
        cause, element = np.full(len(index), -1), np.full(len(index), -1)
        may_follow = self.hits(rule).follows
        for span, names in rule.causes(self.rules).items():
            for name in names:
                if name not in self.rules:
                    continue
                rule_of_cause = self.rules[name]
                other_hits = np.flatnonzero(self.hits(rule_of_cause).mask)
                if not len(other_hits):
                    continue
                try:
                    other_spans = places.span_of(OF_CAUSE.get(span, span), rule_of_cause.over, self.tables)[other_hits]
                    spans = places.span_of(span, rule.over, self.tables)[index]
                except TooHardError:
                    continue  # the reach of the cause is not known: the finding stays a root finding
                order = np.argsort(other_spans, kind="stable")
                index_of_cause = order[np.minimum(np.searchsorted(other_spans[order], spans), len(other_hits) - 1)]
                is_caused = (other_spans[index_of_cause] == spans) & (spans >= 0) & (cause < 0)
                if span in OF_CAUSE:
                    rows_of_cause = places.rows(rule_of_cause.over, self.tables)[other_hits[index_of_cause]]
                    is_caused &= rows_of_cause < places.rows(rule.over, self.tables)[index]
                if span in may_follow:
                    is_caused &= may_follow[span][index]
                cause[is_caused], element[is_caused] = self._names.index(name), other_hits[index_of_cause[is_caused]]
        return cause, element

    @staticmethod
    def _share_causes(block: Rows, cause: Rows, element: Rows) -> None:
        """Give the cause of a run of a block to its other runs: one mistake in a subprogram is told once."""
        caused, alone = np.flatnonzero(cause >= 0), np.flatnonzero(cause < 0)
        blocks, first = np.unique(block[caused], return_index=True)
        number = np.minimum(np.searchsorted(blocks, block[alone]), len(blocks) - 1)
        is_same = blocks[number] == block[alone]
        model = caused[first[number[is_same]]]
        cause[alone[is_same]], element[alone[is_same]] = cause[model], element[model]

    def _merged(self, rule: Rule, index: Rows, worst: Floats | None) -> tuple[Rows, Rows, Rows]:
        """
        Group the elements: one finding is reported per group.

        Returns three arrays:
        chosen: the positions in `index` of the reported elements (groups).
        group: the position in `chosen` of the element that represents each element (elements).
        count: the number of runs or blocks in each group (groups).

        A rule without `once` has a group per block and counts its runs. A rule with `once` has a group per section,
        program or other span, and counts blocks.
        """
        if rule.over not in ("rows", "sections") and not rule.once:
            all_positions = np.arange(len(index))
            return all_positions, all_positions, np.ones(len(index), np.int64)
        block = places.blocks(rule.over, self.tables)[index]
        group = block
        if rule.once:
            key = places.span_of(rule.once, rule.over, self.tables)[index]
            if rule.over == "words":
                key = np.where(self._silenced(rule, index), -1, key)  # a silenced word stands for no other
            key = np.where(key < 0, -1 - np.arange(len(index)), key)  # elements outside every span are not grouped
            _, first, group = np.unique(key, return_index=True, return_inverse=True)
            if rule.over in ("rows", "sections"):
                # Spans that begin in the same block are repeats of it, as in a program that is called twice.
                group = block[first][group]
        _, first, group, count = np.unique(group, return_index=True, return_inverse=True, return_counts=True)
        if worst is not None and len(first) < len(index):
            order = np.lexsort((-np.arange(len(index)), worst[index], group))
            first = order[np.cumsum(count) - 1]
        if rule.once:
            blocks = int(block.max(initial=0)) + 1
            count = np.bincount(different(group * blocks + block) // blocks, minlength=len(first))
        order = np.argsort(first, kind="stable")
        return first[order], np.argsort(order)[group], count[order]

    def finding(self, rule: Rule, element: Place, hits: Hits, count: int) -> Finding:
        """Return the finding of a rule at an element. count: how many runs or blocks it stands for."""
        from polarcheck.checking.fingerprints import fingerprint
        from polarcheck.rules.hit import Hit
        from polarcheck.rules.message import fill
        from polarcheck.rules.repair import fix_of

        trace = self.trace
        word_list = (
            places.words_at_fault(self.tables, element.row, rule.at, hits.at)
            if rule.over in ("rows", "sections")
            else []
        )
        start, end = places.span(self.tables, element, word_list)
        source = trace.text.source
        line, end_line = source.line_of(start), source.line_of(max(end - 1, start))
        severity = SEVERITY_NAMES[_severity(rule, hits, element)]
        is_note = trace.machine.severities.get(rule.name, severity) == SEVERITY_NAMES[NOTE]
        text, values = fill(rule, hits, self.tables, Hit(trace, element, word_list, count))
        if rule.over in ("rows", "sections") and element.row >= 0 and trace.run.depth[element.row]:
            self.rows_in_calls[rule.name, line, start - int(source.line_starts[line - 1]) + 1] = element.row
            text += in_call(trace, places.rows(rule.over, self.tables)[hits.mask], element.row)
        block = places.block_text(trace.text, element.block)
        section = int(trace.mode.section[element.row]) if element.row >= 0 else -1
        enter = int(trace.mode.sections.enter[section]) if section >= 0 else -1
        if section >= 0 and enter == element.row and trace.run.block[enter] != element.block:
            enter = -1  # the first row behind the block of a fault, which has none, begins a section
        kind = Undecided if hits.undecided is not None and hits.undecided[element.index] else Finding
        return kind(
            rule=rule.name,
            severity=self.severities.get(rule.name, severity),
            message=text,
            line=line,
            column=start - int(source.line_starts[line - 1]) + 1,
            end_line=end_line,
            end_column=end - int(source.line_starts[end_line - 1]) + 1,
            block=block,
            program=self._program_name(element.block),
            section_line=int(trace.blocks.line[enter]) if enter >= 0 else None,
            alarm=None if is_note else self._alarm(rule, word_list),
            values=values,
            count=count,
            source=rule.source,
            fingerprint=fingerprint(rule, trace.text, element),
            fix=fix_of(rule, hits, self.tables, element, count),
        )

    def _alarm(self, rule: Rule, indices: list[int]) -> str | None:
        """Return the alarm of the control; None if the alarm names G codes and the words at fault are others."""
        machine, table = self.trace.machine, self.trace.run.words
        alarm = machine.alarms.get(rule.name) or None
        if alarm not in machine.alarm_codes:
            return alarm
        written = code_numbers(table.value[[index for index in indices if table.address[index] == ord("G")]])
        return alarm if not len(written) or code_set(machine.codes_of_alarm(alarm))[written].any() else None

    def _program_name(self, block: int) -> str | None:
        index = bisect.bisect_right(self.heads, block, key=lambda head: head[0])
        return self.heads[index - 1][1] if index else None


def too_hard(rule: Rule, error: TooHardError, trace: Trace) -> NotEvaluated:
    """Report a rule that was given up. It counts the polar blocks, whose geometry takes the time."""
    return NotEvaluated(
        rule=rule.name, reason=str(error), blocks=int(np.count_nonzero(trace.mode.in_polar)) or len(trace)
    )


def _unlisted(rule: Rule, count: int) -> NotEvaluated:
    reason = f"only the first {LISTED} of {count} findings are listed"
    return NotEvaluated(rule=rule.name, reason=reason, blocks=count - LISTED, matters=False)


def program_heads(trace: Trace) -> list[tuple[int, str]]:
    """Return the block and the name of each program that has an O number or <name>, in file order."""
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


def _roots(listed: Mapping[str, Listed]) -> dict[_Number, _Number]:
    """
    Map each finding to the root of its chain of causes; a finding without a cause is its own root.

    The root of a cycle is its first finding in the program.
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
            cycle = list(chain)[list(chain).index(last) :]
            root = min(cycle, key=lambda number: _order(_finding_of(listed, number)))
        roots.update(dict.fromkeys(chain, root))
        done.update(chain)
    return roots


def _finding_of(listed: Mapping[str, Listed], number: _Number) -> Finding:
    return listed[number[0]].findings[number[1]]


def with_following(finding: Finding, following: list[Finding]) -> Finding:
    """Attach the findings that follow, and raise the severity to their highest."""
    if not following:
        return finding
    severity = max((finding.severity, *(follower.severity for follower in following)), key=SEVERITIES.__getitem__)
    return msgspec.structs.replace(finding, severity=severity, follows=in_order(following))


def in_order(findings: Iterable[AnyFinding]) -> list[AnyFinding]:
    """Sort by line and column; at one place the most severe first."""
    return sorted(findings, key=_order)


def _order(finding: Finding) -> tuple[int, int, int, str]:
    return finding.line, finding.column, -SEVERITIES[finding.severity], finding.rule


def _severity(rule: Rule, hits: Hits, element: Place) -> Severity:
    severity = rule.severity if hits.severity is None else hits.severity
    return Severity(int(severity[element.index])) if isinstance(severity, np.ndarray) else Severity(severity)
