"""The rule engine: what rules find becomes findings, each at its place, with its numbers."""

from __future__ import annotations

import bisect
from collections.abc import Mapping

import numpy as np

from polarcheck.arrays import Rows
from polarcheck.checking import places
from polarcheck.checking.finding import Finding, NotEvaluated, Severity
from polarcheck.checking.places import PLACES, Place
from polarcheck.checking.rule import Hits, Rule, load_all
from polarcheck.checking.tables import Tables
from polarcheck.errors import RuleError
from polarcheck.table.trace import Trace

#: More findings of one rule in one file are counted, not listed: nobody reads them, and hostile files stay bounded.
LISTED = 1000
_BLOCK_LENGTH = 200


class Engine:
    """The hits of one run, each rule run once. severities: by rule, where it is not the rule's own."""

    def __init__(self, tables: Tables, severities: Mapping[str, str]) -> None:
        self.tables = tables
        self.trace: Trace = tables["trace"]
        self.severities = severities
        self.unlisted: list[NotEvaluated] = []
        self._hits: dict[str, Hits] = {}
        self._heads = program_heads(self.trace)

    def hits(self, rule: Rule) -> Hits:
        """What the rule finds."""
        if rule.name not in self._hits:
            self._hits[rule.name] = rule.hits(self.tables)
        return self._hits[rule.name]

    def findings(self, rule: Rule) -> list[Finding]:
        """One finding per place."""
        hits = self.hits(rule)
        index = np.flatnonzero(hits.mask)
        if not len(index):
            return []
        for other in rule.unless:
            index = self._without(rule, index, other)
        index, count = self._merged(rule, index)
        if len(index) > LISTED:
            reason = f"only the first {LISTED} of {len(index)} findings are listed"
            self.unlisted.append(NotEvaluated(rule=rule.name, reason=reason, blocks=len(index) - LISTED))
            index, count = index[:LISTED], count[:LISTED]
        found = [PLACES[rule.over](self.tables, at) for at in index.tolist()]
        return [self._finding(rule, place, hits, runs) for place, runs in zip(found, count.tolist(), strict=True)]

    def _without(self, rule: Rule, index: Rows, name: str) -> Rows:
        """The elements that do not stand in a block in which the other rule fires."""
        rules = load_all()
        if name not in rules:
            raise RuleError(f"rule {rule.name}: no rule {name} to give way to")
        other = rules[name]
        elsewhere = places.blocks(other.over, self.tables)[np.flatnonzero(self.hits(other).mask)]
        return index[~np.isin(places.blocks(rule.over, self.tables)[index], elsewhere)]

    def _merged(self, rule: Rule, index: Rows) -> tuple[Rows, Rows]:
        """One row for each block that ran often, or for each section or program, and how many it stands for."""
        if rule.over != "rows":
            return index, np.ones(len(index), np.int64)
        trace = self.trace
        key = {"section": trace.section, "program": trace.program, "": trace.run.block}[rule.once][index]
        _, first, group, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
        chosen = index[first]
        if rule.worst and len(chosen) < len(index):
            value = self.tables.column(rule.worst)[index]
            order = np.lexsort((-np.arange(len(index)), value, group))
            chosen = index[order[np.cumsum(count) - 1]]
        if rule.once:
            count = np.ones_like(count)
        order = np.argsort(chosen, kind="stable")
        return chosen[order], count[order]

    def _finding(self, rule: Rule, place: Place, hits: Hits, count: int) -> Finding:
        from polarcheck.checking.message import fill

        trace = self.trace
        at = (
            places.words_at_fault(self.tables, place.row, rule.at, hits.at) if rule.over in ("rows", "sections") else []
        )
        start, end = places.span(self.tables, place, at)
        source = trace.text.source
        line, end_line = source.line_of(start), source.line_of(max(end - 1, start))
        text, values = fill(rule, hits, self.tables, place, at)
        block = _block_text(trace, place.block)
        section = int(trace.section[place.row]) if place.row >= 0 else -1
        return Finding(
            rule=rule.name,
            severity=self.severities.get(rule.name, _severity(rule, hits, place).name.lower()),
            message=text,
            line=line,
            column=start - int(source.line_starts[line - 1]) + 1,
            end_line=end_line,
            end_column=end - int(source.line_starts[end_line - 1]) + 1,
            block=block,
            program=self._program_name(place.block),
            section_line=int(trace.line[trace.sections.enter[section]]) if section >= 0 else None,
            alarm=trace.machine.alarms.get(rule.name) or None,
            values=values,
            count=count,
            source=rule.source,
            fingerprint=_fingerprint(rule.name, block),
        )

    def _program_name(self, block: int) -> str | None:
        at = bisect.bisect_right(self._heads, block, key=lambda head: head[0])
        return self._heads[at - 1][1] if at else None


def program_heads(trace: Trace) -> list[tuple[int, str]]:
    """The block and the name of each program that has an O number or <name>, in order."""
    text, table = trace.text, trace.text.words
    is_head = table.address == ord("O")
    numbered = is_head & ~np.isnan(table.value)
    heads = list(zip(table.block[numbered], table.start[numbered], table.end[numbered], strict=True))
    bare = set(table.block[is_head & np.isnan(table.value)].tolist())
    for start, end, block in zip(text.names.start, text.names.end, text.names.block, strict=True):
        if int(block) in bare:
            heads.append((block, start, end))
    return [
        (int(block), places.squeezed(text.source.excerpt(int(start), int(end)))) for block, start, end in sorted(heads)
    ]


def _severity(rule: Rule, hits: Hits, place: Place) -> Severity:
    given = rule.severity if hits.severity is None else hits.severity
    return Severity(int(given[place.index])) if isinstance(given, np.ndarray) else Severity(given)


def _fingerprint(rule: str, block: str) -> str:
    """The same for the same rule in the same block, wherever that stands."""
    import hashlib  # late: a program without findings does not need it

    return hashlib.sha256(f"{rule}\0{places.squeezed(block)}".encode("utf-8", "replace")).hexdigest()[:16]


def _block_text(trace: Trace, block: int) -> str:
    start, end = int(trace.text.blocks.start[block]), int(trace.text.blocks.end[block])
    return trace.text.source.excerpt(start, min(end, start + _BLOCK_LENGTH)).strip()
