"""
Compares two revisions of a program section by section, compares the blocks between sections, and lists what was not
compared.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple, TypeVar

import msgspec
import numpy as np

from polarcheck.checking.polar_sections import polar_sections
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.finding import PolarSection
from polarcheck.foundation.time_limit import keep_time
from polarcheck.rewrite.compare.compared_sections import Stretch, of_sections
from polarcheck.rewrite.compare.comparison_report import (
    DIFFERS,
    NOT_COMPARED,
    SAME_METAL,
    SAME_WORDS,
    Comparison,
    Difference,
    NotCompared,
    Program,
    SectionPair,
    Side,
)
from polarcheck.rewrite.compare.differences import depth_of
from polarcheck.rewrite.compare.entry_state import entry_differences
from polarcheck.rewrite.compare.not_compared import Run, added_findings, incomparable, not_known_in_both, why_not
from polarcheck.rewrite.compare.orders import steps
from polarcheck.rewrite.compare.pairing import paired
from polarcheck.rewrite.compare.parts_compared import Measured, measured, outside_compared
from polarcheck.rewrite.compare.same_words import has_same_words
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rules.quantity import rounded
from polarcheck.rules.tables import Tables

Item = TypeVar("Item")


class Revision(NamedTuple):
    """
    One of the two files.

    path: as it is reported.
    machine: name of its machine.
    runs: the runs of all channels and states of block skip.
    """

    path: str
    machine: str
    runs: Sequence[Run]

    @property
    def trace(self) -> Trace:
        """The trace of the first run."""
        trace: Trace = self.runs[0][1]["trace"]
        return trace


def default_tolerance(old: Revision, new: Revision) -> float:
    """Return the least increment of the coarser of both [mm]: neither program can say a length more closely."""
    steps_of = (float(np.max(revision.trace.lengths.least_step, initial=0.0)) for revision in (old, new))
    return max(*steps_of, 1e-6)


def compared(old: Revision, new: Revision, terms: Terms) -> Comparison:
    """Compare two revisions."""
    pairs = list(pairs_of_runs(old, new))
    runs = [RunPair(*pair, terms) for pair in pairs]
    sections = [section for run in runs for section in run.sections()]
    between = [difference for run in runs for difference in run.outside()]
    reasons = [
        reason
        for pair, run in zip(pairs, runs, strict=True)
        for reason in (*incomparable(pair, terms), *run.not_compared)
    ]
    is_same_setup = old.trace.machine == new.trace.machine and old.trace.job == new.trace.job
    same_words = is_same_setup and has_same_words(old.trace, new.trace)
    differs = bool(between) or any(section.change not in ("same", "not compared") for section in sections)
    if is_same_setup and not (same_words or differs or terms.is_kept):
        reasons += added_findings(old.runs, new.runs)
    reasons.sort(key=lambda reason: not reason.matters)
    missing = list({reason.reason: reason for reason in reversed(reasons)}.values())[::-1]
    verdict = SAME_METAL
    if any(run.is_broken_off for run in runs):
        verdict = NOT_COMPARED  # what was not reached is not missing
    elif differs:
        verdict = DIFFERS
    elif same_words:
        verdict = SAME_WORDS
    elif any(reason.matters for reason in missing):
        verdict = NOT_COMPARED
    if verdict == SAME_WORDS:
        missing = [NotCompared(reason.reason, matters=False) for reason in missing]
    measured = [value for run in runs for value in run.measured]
    largest = max(measured, default=None, key=lambda largest_of_pair: largest_of_pair[0])
    return Comparison(
        old=_program(old),
        new=_program(new),
        verdict=verdict,
        tolerance=terms.tolerance,
        deviation=None if largest is None else rounded(largest[0]),
        is_exact=largest is None or largest[1],
        sections=_once(sections),
        outside=_once(between),
        not_compared=missing,
    )


def _once(items: Sequence[Item]) -> list[Item]:
    """Return the items without duplicates: both states of block skip often give the same ones."""
    return list({msgspec.json.encode(item): item for item in items}.values())


def _program(revision: Revision) -> Program:
    trace = revision.trace
    return Program(revision.path, revision.machine, len(trace), len(trace.mode.sections))


def pairs_of_runs(old: Revision, new: Revision) -> Iterator[tuple[Tables, Tables]]:
    """Yield pairs of runs of the same channel and state of block skip; a file without / has one run for both states."""
    channels = [_by_channel(revision) for revision in (old, new)]
    names = list(dict.fromkeys([*channels[0], *channels[1]]))
    for name in names:
        of_old, of_new = (by_name.get(name) or next(iter(by_name.values())) for by_name in channels)
        for state in dict.fromkeys([*of_old, *of_new]):
            pair = [runs.get(state) or next(iter(runs.values())) for runs in (of_old, of_new)]
            yield pair[0], pair[1]


def _by_channel(revision: Revision) -> dict[str, dict[str, Tables]]:
    channels: dict[str, dict[str, Tables]] = {}
    for state, tables in revision.runs:
        channels.setdefault(tables["text"].source.channel or "", {})[state] = tables
    return channels


class RunPair:
    """Compares one run of each revision."""

    def __init__(self, old: Tables, new: Tables, terms: Terms) -> None:
        self._tables = old, new
        self._terms = terms
        self._traces: tuple[Trace, Trace] = old["trace"], new["trace"]
        self._is_same_machine = is_same_machine = self._traces[0].machine == self._traces[1].machine
        old_steps, new_steps = (
            steps(trace, is_same_machine=is_same_machine, with_sides=not terms.changes) for trace in self._traces
        )
        self._steps = old_steps, new_steps
        self._old = of_sections(self._traces[0], old["tool_center"], old_steps, terms.of_old)
        self._new = of_sections(self._traces[1], new["tool_center"], new_steps, terms.of_new)
        is_in_order = terms.is_kept and len(self._old) == len(self._new)
        numbers = np.arange(len(self._old))
        self._partner, self._ordered = (numbers, numbers) if is_in_order else paired(self._old, self._new)
        #: Largest deviations [mm], and whether they are exact.
        self.measured: list[tuple[float, bool]] = []
        #: What of the paths was not compared.
        self.not_compared: list[NotCompared] = []

    @property
    def is_broken_off(self) -> bool:
        """True if one of the runs ended at a bound."""
        return any(len(tables["faults"].is_bound) and tables["faults"].is_bound.any() for tables in self._tables)

    # ---- sections ----

    def sections(self) -> list[SectionPair]:
        """Return the pairs in the order of the old revision, then the sections that were added."""
        reports = [polar_sections(tables) for tables in self._tables]
        reported: set[tuple[str, object, object]] = set()
        pairs = []
        for number, partner in enumerate(self._partner.tolist()):
            keep_time()
            side = _side(self._old[number], reports[0])
            if partner < 0:
                text = f"the section of line {side.line} is missing"
                gone = Difference("section", text, old_line=side.line)
                pairs.append(SectionPair(side, None, "missing", None, True, [gone]))
                continue
            new_side = _side(self._new[partner], reports[1])
            pairs.append(self._pair(number, partner, side, new_side, reported))
        taken = set(self._partner.tolist())
        for number, section in enumerate(self._new):
            if number not in taken:
                side = _side(section, reports[1])
                more = Difference("section", f"the section of line {side.line} is added", new_line=side.line)
                pairs.append(SectionPair(None, side, "added", None, True, [more]))
        return pairs

    def _pair(
        self, number: int, partner: int, side: Side, new_side: Side, reported: set[tuple[str, object, object]]
    ) -> SectionPair:
        old, new = self._old[number], self._new[partner]
        state = [*_left_open(old, new)]
        state += [
            difference
            for difference in entry_differences(old, new, is_same_machine=self._is_same_machine, terms=self._terms)
            # What holds for all sections stands in the first.
            if (difference.what, difference.old, difference.new) not in reported
        ]
        reported.update(
            (difference.what, difference.old, difference.new) for difference in state if difference.what != "c_angle"
        )
        why = why_not(old, new)
        result = Measured(why) if why else measured(old, new, self._terms)
        why = result.reason
        self._take(result, f"section of line {side.line} (old) and {new_side.line} (new)")
        if not why and old.as_programmed:
            reason = f"section of line {side.line}: {old.as_programmed}: compared as programmed, for any R"
            self.not_compared.append(NotCompared(reason, matters=False))
        if not why:
            self.not_compared += [
                NotCompared(f"section of line {side.line}: {reason}", matters=not self._terms.is_kept)
                for reason in not_known_in_both(old)
            ]
        differences = [*result.differences, *state]
        change = "changed" if differences else "not compared" if why or result.not_known else "same"
        if number not in self._ordered:
            change = "moved"
            text = f"the section of line {side.line} runs at another place in the order, in line {new_side.line}"
            differences.insert(0, Difference("section", text, None, None, "", side.line, new_side.line))
        deviation = result.deviation
        largest = None if deviation is None else rounded(result.length)
        return SectionPair(side, new_side, change, largest, deviation is None or deviation.is_exact, differences)

    # ---- between sections ----

    def outside(self) -> list[Difference]:
        """Return the differences between those sections that have the same order in both revisions."""
        differences: list[Difference] = []
        partners: Rows = self._partner[self._ordered]
        for gap, new_gap in zip(_gaps(self._traces[0], self._ordered), _gaps(self._traces[1], partners), strict=True):
            keep_time()
            result = outside_compared(self._traces, self._steps, (np.arange(*gap), np.arange(*new_gap)), self._terms)
            differences += result.differences
            self._take(result, "outside of sections")
        return differences

    def _take(self, result: Measured, name: str) -> None:
        """Note the deviation of a path, or why it was not measured."""
        if result.reason:
            self.not_compared.append(NotCompared(f"{name}: {result.reason}"))
        if result.not_known:
            self.not_compared.append(NotCompared(f"{name}: {result.not_known}", matters=not self._terms.changes))
        if result.deviation is not None and np.isfinite(result.deviation.largest):
            self.measured.append((result.length, result.deviation.is_exact))


def _left_open(old: Stretch, new: Stretch) -> Iterator[Difference]:
    """Yield a difference if only one of the revisions switches the polar mode off after the section."""
    is_left = [bool(part.trace.mode.sections.left[part.section]) for part in (old, new)]
    if is_left[0] != is_left[1]:
        lines = [part.line(part.enter) for part in (old, new)]
        text = "the polar mode is left no more" if is_left[0] else "the polar mode is left now, and was not"
        yield Difference(
            "section", text, "left" if is_left[0] else "open", "left" if is_left[1] else "open", "", *lines
        )


def _gaps(trace: Trace, sections: Rows) -> list[tuple[int, int]]:
    """Return the first row and the end of each range before, between and after sections; a G13.1 stands in one."""
    enter, leave = trace.mode.sections.enter[sections], trace.mode.sections.leave[sections]
    return list(zip([0, *leave.tolist()], [*enter.tolist(), len(trace)], strict=True))


def _side(section: Stretch, reports: Sequence[PolarSection]) -> Side:
    trace, number = section.trace, section.section
    report = reports[number] if number < len(reports) else None
    return Side(
        line=section.line(section.enter),
        end_line=section.line(min(int(trace.mode.sections.last[number]), len(trace) - 1)),
        depth=depth_of(section),
        time=report.time if report else None,
        c_feed=report.c_feed if report else None,
    )
