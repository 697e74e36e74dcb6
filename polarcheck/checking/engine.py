"""The rule engine: masks to findings, each at its place, with its numbers."""

from __future__ import annotations

import bisect
import re
from collections.abc import Callable, Mapping
from operator import attrgetter
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Rows
from polarcheck.checking import message
from polarcheck.checking.finding import Finding, NotEvaluated, Severity
from polarcheck.checking.rule import Rule, load_all
from polarcheck.errors import RuleError
from polarcheck.machines.codes import code_numbers, spelled
from polarcheck.table.trace import Trace

#: More findings of one rule in one file are counted, not listed: nobody reads them, and hostile files stay bounded.
LISTED = 1000
_BLOCK_LENGTH = 200


class Hit(msgspec.Struct, frozen=True):
    """One element of a mask: its place in the file and its row in the trace (-1 where it has none)."""

    start: int
    end: int
    block: int
    row: int
    index: int


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
    return [(int(block), squeezed(text.source.excerpt(int(start), int(end)))) for block, start, end in sorted(heads)]


def _fingerprint(rule: str, block: str) -> str:
    """The same for the same rule in the same block, wherever that stands."""
    import hashlib

    return hashlib.sha256(f"{rule}\0{squeezed(block)}".encode("utf-8", "replace")).hexdigest()[:16]


def squeezed(text: str) -> str:
    """Without blanks; `:` is O."""
    return re.sub(r"\s+", "", text).replace(":", "O")


class Engine:
    """The masks of one check, each computed once."""

    def __init__(self, trace: Trace, severities: Mapping[str, str]) -> None:
        self.trace = trace
        self.severities = severities
        self.unlisted: list[NotEvaluated] = []
        self.hits: dict[str, tuple[NDArray[Any], dict[str, Any]]] = {}
        self.heads = program_heads(trace)

    def mask(self, rule: Rule) -> tuple[NDArray[Any], dict[str, Any]]:
        """What the function of the rule returns, and its own columns."""
        if rule.name not in self.hits:
            trace = self.trace
            known: dict[str, Any] = {
                "trace": trace,
                "machine": trace.machine,
                "job": trace.job,
                "text": trace.text,
                "words": trace.text.words,
            }
            result = rule.function(*(known[name] for name in rule.parameters))
            self.hits[rule.name] = result if isinstance(result, tuple) else (result, {})
        return self.hits[rule.name]

    def findings(self, rule: Rule) -> list[Finding]:
        """One finding per place."""
        mask, columns = self.mask(rule)
        hit = np.flatnonzero(mask)
        if not len(hit):
            return []
        for other in rule.unless:
            hit = self._without(hit, other)
        hit, count = self._merged(rule, hit)
        if len(hit) > LISTED:
            self.unlisted.append(
                NotEvaluated(
                    rule=rule.name,
                    reason=f"only the first {LISTED} of {len(hit)} findings are listed",
                    blocks=len(hit) - LISTED,
                )
            )
            hit, count = hit[:LISTED], count[:LISTED]
        place = _PLACES[rule.over]
        return [
            self._finding(rule, place(self.trace, int(index)), mask, columns, int(runs))
            for index, runs in zip(hit, count, strict=True)
        ]

    def _without(self, hit: Rows, name: str) -> Rows:
        rules = load_all()
        if name not in rules:
            raise RuleError(f"no rule {name} to give way to")
        other, _ = self.mask(rules[name])
        block = self.trace.run.block
        return hit[~np.isin(block[hit], block[np.flatnonzero(other)])]

    def _merged(self, rule: Rule, hit: Rows) -> tuple[Rows, Rows]:
        """One element for each block that ran often, or for each section or program, and how many it stands for."""
        if rule.over not in ("rows",):
            return hit, np.ones(len(hit), np.int64)
        key = {
            "section": self.trace.section,
            "program": self.trace.program,
            "": self.trace.run.block,
        }[rule.once][hit]
        _, first, group, count = np.unique(key, return_index=True, return_inverse=True, return_counts=True)
        chosen = hit[first]
        if rule.worst and len(chosen) < len(hit):
            value = attrgetter(rule.worst)(self.trace)[hit]
            order = np.lexsort((-np.arange(len(hit)), value, group))
            chosen = hit[order[np.cumsum(count) - 1]]
        if rule.once:
            count = np.ones_like(count)
        order = np.argsort(chosen, kind="stable")
        return chosen[order], count[order]

    def _finding(self, rule: Rule, hit: Hit, mask: NDArray[Any], columns: dict[str, Any], count: int) -> Finding:
        trace = self.trace
        names = columns["at"](hit.index) if "at" in columns else rule.at
        start, end = _words_at_fault(trace, rule, hit, names)
        found = trace.text.source
        line, end_line = found.line_of(start), found.line_of(max(end - 1, start))
        text, values = message.fill(rule.message, self._look_up(rule.over, hit, columns))
        given = mask[hit.index]
        severity = Severity(int(given)) if mask.dtype != bool else rule.severity
        block = _block_text(trace, hit.block)
        section = int(trace.section[hit.row]) if hit.row >= 0 else -1
        return Finding(
            rule=rule.name,
            severity=self.severities.get(rule.name, severity.name.lower()),
            message=text,
            line=line,
            column=start - int(found.line_starts[line - 1]) + 1,
            end_line=end_line,
            end_column=end - int(found.line_starts[end_line - 1]) + 1,
            block=block,
            program=self._program_name(hit.block),
            section_line=int(trace.line[trace.sections.enter[section]]) if section >= 0 else None,
            alarm=trace.machine.alarms.get(rule.name) or None,
            values=values,
            count=count,
            source=rule.source,
            fingerprint=_fingerprint(rule.name, block),
        )

    def _program_name(self, block: int) -> str | None:
        at = bisect.bisect_right(self.heads, block, key=lambda head: head[0])
        return self.heads[at - 1][1] if at else None

    def _look_up(self, over: str, hit: Hit, columns: dict[str, Any]) -> Callable[[str], Any]:
        trace, row = self.trace, hit.row

        def value(name: str) -> Any:
            if name in ("machine", "job"):
                return getattr(trace, name)
            if name == "text":
                return trace.text.source.excerpt(hit.start, hit.end)
            if len(name) == 1 and name.isupper():
                return _written(trace, name, row)
            if name in columns:
                column, index = columns[name], hit.index
            elif over == "words" and hasattr(trace.text.words, name):
                column, index = getattr(trace.text.words, name), hit.index
            else:
                column, index = getattr(trace, name), row
            element = column(index) if callable(column) else column
            element = column[index] if isinstance(column, np.ndarray | list) else element
            units = int(trace.units[row]) if row >= 0 else 0
            return message.quantity(element, units, bool(trace.x_factor[row] < 1) if row >= 0 else True)

        return value


def _written(trace: Trace, address: str, row: int) -> str:
    """The last word of an address in a row as it is written."""
    indices = trace.word_indices(address)
    at = indices[trace.run.row[indices] == row]
    if not len(at):
        return address
    table = trace.run.words
    return squeezed(trace.text.source.excerpt(int(table.start[at[-1]]), int(table.end[at[-1]])))


def _row_of_block(trace: Trace, block: int) -> int:
    return int(trace.row_of_block[block])


def _place_of_row(trace: Trace, index: int) -> Hit:
    block = int(trace.run.block[index])
    start, end = int(trace.text.blocks.start[block]), int(trace.text.blocks.end[block])
    table, run = trace.run.words, trace.run
    low, high = np.searchsorted(run.row, (index, index + 1))
    if low < high:
        start, end = int(table.start[low:high].min()), int(table.end[low:high].max())
    else:
        text = trace.text.source.excerpt(start, end)
        start += len(text) - len(text.lstrip())
        end -= len(text) - len(text.rstrip())
    return Hit(start, max(end, start + 1), block, index, index)


def _place_of_word(trace: Trace, index: int) -> Hit:
    table = trace.text.words
    block = int(table.block[index])
    return Hit(int(table.start[index]), int(table.end[index]), block, _row_of_block(trace, block), index)


def _place_of_section(trace: Trace, index: int) -> Hit:
    place = _place_of_row(trace, int(trace.sections.enter[index]))
    return Hit(place.start, place.end, place.block, place.row, index)


def _place_of_program(trace: Trace, index: int) -> Hit:
    """The last row of the program, where its end is missing."""
    place = _place_of_row(trace, int(np.flatnonzero(trace.program == index)[-1]))
    return Hit(place.start, place.end, place.block, place.row, index)


def _place_of_file(trace: Trace, index: int) -> Hit:
    return Hit(0, 0, 0, -1, index)


def _place_of_fault(trace: Trace, index: int) -> Hit:
    fault = trace.run.faults[index]
    row = min(fault.row, len(trace) - 1)
    return Hit(fault.start, fault.end, fault.block, row if fault.row >= 0 else -1, index)


def _place_in(name: str) -> Callable[[Trace, int], Hit]:
    def place(trace: Trace, index: int) -> Hit:
        spans = getattr(trace.text, name)
        block = int(spans.block[index])
        start = int(spans.start[index])
        end = int(spans.end[index])
        line_end = int(trace.text.blocks.end[block])
        if name == "outside":
            end = min(end, max(line_end, start + 1))
        return Hit(start, end, block, _row_of_block(trace, block), index)

    return place


_PLACES: dict[str, Callable[[Trace, int], Hit]] = {
    "rows": _place_of_row,
    "words": _place_of_word,
    "sections": _place_of_section,
    "programs": _place_of_program,
    "faults": _place_of_fault,
    "files": _place_of_file,
    **{name: _place_in(name) for name in ("comments", "strays", "foreign", "dots", "outside")},
}


def _words_at_fault(trace: Trace, rule: Rule, hit: Hit, names: tuple[str, ...]) -> tuple[int, int]:
    """From the first to the last word at fault: those that the rule names, else the whole block."""
    if hit.row < 0 or not names or rule.over not in ("rows", "sections"):
        return hit.start, hit.end
    low, high = np.searchsorted(trace.run.row, (hit.row, hit.row + 1))
    table = trace.run.words
    chosen = [index for index in range(low, high) if _is_named(trace, index, names)]
    if not chosen:
        return hit.start, hit.end
    return int(min(table.start[i] for i in chosen)), int(max(table.end[i] for i in chosen))


def _is_named(trace: Trace, index: int, names: tuple[str, ...]) -> bool:
    address = chr(int(trace.run.words.address[index]))
    if address in names or (address.islower() and f",{address.upper()}" in names):
        return True
    number = int(code_numbers(trace.run.words.value[index : index + 1])[0])
    spelled_code = spelled(address, number) if address in "GM" and number >= 0 else ""
    polar_mode = trace.machine.polar
    return (
        spelled_code in names
        or ("on" in names and spelled_code in polar_mode.on)
        or ("off" in names and spelled_code in polar_mode.off)
    )


def _block_text(trace: Trace, block: int) -> str:
    start, end = int(trace.text.blocks.start[block]), int(trace.text.blocks.end[block])
    return trace.text.source.excerpt(start, min(end, start + _BLOCK_LENGTH)).strip()
