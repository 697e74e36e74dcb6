"""Reads the new program as its control would, and compares it with the original before anything is written."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from typing import Any

import msgspec
import numpy as np

from polarcheck.checking.settings import Settings
from polarcheck.foundation.finding import SEVERITIES, Finding, Severity
from polarcheck.geometry.comparison.path_deviation import path_deviation
from polarcheck.rewrite.compare.comparison_report import Comparison
from polarcheck.rewrite.compare.not_compared import findings_of
from polarcheck.rewrite.compare.revision_comparison import Revision, compared, default_tolerance
from polarcheck.rewrite.compare.terms import TIME, TIME_SHARE, Terms, lines_before
from polarcheck.rewrite.writing.order_refusals import changed_meanings, changed_orders, line_of, refusal_of
from polarcheck.rewrite.writing.original import Original, read
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError
from polarcheck.rewrite.writing.part_paths import CHORD, path_on_part
from polarcheck.rules.rule import Rule, load_all

#: Rules about orders to spindles, the C axis and tools: what another lathe needs is to be decided.
OF_ORDERS = frozenset(
    (
        *("c-axis-clamped-in-polar", "c-axis-not-engaged", "c-axis-not-referenced", "live-tool-never-stopped"),
        *("live-tool-stopped-in-cut", "live-tool-without-speed", "main-spindle-running-at-entry"),
        *("no-tool-offset-at-entry", "spindle-code-in-polar"),
    )
)
#: Rules about limits of a lathe, by which the same path is too fast on another one: notes.
_OF_LIMITS = frozenset(
    ("c-acceleration-above-limit", "c-feed-above-limit", "path-near-center", "x-acceleration-above-limit")
)
#: Rules about what displaces the contour in the mode: the new program is to have none, even where the original has.
_OF_CENTER = frozenset(("offset-changed-in-polar", "origin-shifted-in-polar"))
#: Chords of arcs and the end of the search add no more than this share to a measured distance.
_SHARE_OF_CHORDS = 0.05
#: Further differences than this are not listed.
_LISTED = 20


class ReadBack(msgspec.Struct, frozen=True):
    """
    The new program compared with the original.

    new: the program as it is read.
    differences: what differs, with lines of the original; empty if the new program may be written.
    deviation: the largest distance of the tool center paths [mm].
    open_orders: findings about spindles, the C axis or tools, and warnings, which the user has to decide.
    notes: what could not be compared and does not matter, and lesser findings that the original does not have.
    """

    new: Original
    differences: list[Refusal]
    deviation: float
    notes: list[str]
    open_orders: list[Refusal] = []


def read_back(
    original: Original,
    data: bytes,
    settings: Settings,
    origin: Sequence[int],
    decided: Collection[int] = (),
    *,
    rapid_as_line: bool = False,
    other_states: Collection[str] = (),
    added_speeds: Collection[int] = (),
) -> ReadBack:
    """
    Compare a program that has its polar sections on another control, or on the same one, with the original.

    Compared are, up to the least increment, the path of the tool center on the part with Z, its order, F, C, the state
    at the beginning of each section, the time of each section, the moves outside of sections, dwells, and what codes
    mean by the lists of both profiles. A check finds no error that the original does not have. What else it finds on
    another lathe is to be decided, or a note.

    settings: of the new program. origin: for each of its lines the line in the original, from 1.
    decided: lines of the original that are comments in the new program, for somebody to decide. Their moves and orders
    are not compared, but where the new program moves in their place.
    rapid_as_line: moves in rapid traverse in sections are lines in the new program, whose F and time are its own.
    other_states: states at the beginning of sections that are others on that machine, as `spindle`.
    added_speeds: lines of the original in whose place the new program names a speed that was in force there.

    Raises RefusedError where the new program cannot be run once, TooHardError.
    """
    new = read(original.path, data, settings)
    result = _comparison(original, new, left_out=_without_moves(new, origin, decided), is_rewritten=True)
    is_same_machine = original.settings.machine == settings.machine
    differences = [*_of_comparison(result, decided, rapid_as_line, other_states, origin)]
    differences += [] if rapid_as_line else _times(result)
    if not is_same_machine:
        differences += changed_meanings(original.trace, new.trace, decided, added_speeds, origin)
    open_orders, notes = list[Refusal](), list[str]()
    lowest = Severity.ERROR if is_same_machine else Severity.NOTE
    for rule, severity, refusal in _added_findings(original, new, origin, lowest):
        is_limit = rule.name in _OF_LIMITS and not is_same_machine
        # The original may start a live tool by a code that its profile does not name, or leave it to the operator.
        if rule.name in OF_ORDERS or (severity == Severity.WARNING and not is_limit):
            open_orders.append(refusal)
        elif severity == Severity.ERROR and not is_limit:
            differences.append(refusal)
        else:
            notes.append(f"line {refusal.line}: {refusal.text}")
    notes += [
        reason.reason for reason in result.not_compared if not reason.matters and "as programmed" in reason.reason
    ]
    return ReadBack(new, differences[:_LISTED], result.deviation or 0.0, notes, open_orders)


def read_back_on_part(
    original: Original,
    data: bytes,
    origin: Sequence[int],
    tolerance: float,
    chord: float = CHORD,
    left_out: Collection[int] = (),
    noted: Collection[str] = (),
    finer: Sequence[float] = (),
    *,
    of_sections: Mapping[str, Any] | None = None,
) -> ReadBack:
    """
    Compare a program whose sections have another form with the original: with the mode or without it, compensated or
    not, divided into moves differently.

    Compared are the path of the tool on the part inside and outside sections, with Z and its order, the meaning of
    codes, and the findings of a check. The caller compares F, unless sections are kept. The deviation includes that of
    chords from the true path of X and C.

    origin: for each line of the new program, which is for the same machine, the line in the original, from 1.
    tolerance: the largest distance of the paths [mm].
    chord: the largest distance of chords from the true path [mm].
    left_out: lines of the original that position the tool differently in the new program; the moves after them are
    compared.
    noted: groups of rules whose errors are notes: they are about states of the original that matter only in the mode.
    Warnings are notes.
    finer: ascending tolerances that are tried first [mm]: the deviation is measured up to the first one that the paths
    keep.
    of_sections: the terms by which sections that are kept are compared, with F outside of them and their state; then
    warnings of a check count as its errors do.

    Raises RefusedError where a position of the original is not known, or the new program cannot be run once.
    """
    new = read(original.path, data, original.settings)
    old_path, new_path = (path_on_part(program.tables, chord=chord) for program in (original, new))
    if left_out:
        stands_for = lines_before(new.trace, origin)
        old_path = old_path[~np.isin(original.trace.blocks.line_in_file[old_path.row], list(left_out))]
        new_path = new_path[~np.isin(stands_for[new_path.row], list(left_out))]
    for within in (*finer, tolerance):
        # What chords add comes on top of what is measured.
        measured_up_to = max(within - chord, within / 2) / (1 + _SHARE_OF_CHORDS)
        deviation = path_deviation(old_path, new_path, measured_up_to)
        largest = deviation.largest + deviation.rounding + chord
        if largest <= within:
            break
    differences = []
    if largest > tolerance:
        lines = [program.trace.blocks.line_in_file for program in (original, new)]
        line = new_line = 0
        if deviation.place is not None:
            line = int(lines[0][old_path.row[deviation.place.old_move]])
            new_line = int(lines[1][new_path.row[deviation.place.new_move]])
        text = f"the tool would be {largest:.4f} mm away from its path, above {tolerance:g} mm"
        differences.append(Refusal(line, f"{text} (line {new_line} of the result)"))
    differences += changed_orders(original.trace, new.trace, old_path, new_path, tolerance)
    notes: dict[str, str] = {}
    for rule, severity, refusal in _added_findings(original, new, origin, Severity.WARNING):
        if rule.group in noted or not (of_sections or severity >= Severity.ERROR):
            notes.setdefault(rule.name, f"line {refusal.line}: {refusal.text}")
        else:
            differences.append(refusal)
    if of_sections:
        differences += _of_comparison(_comparison(original, new, **of_sections))
    return ReadBack(new, list(dict.fromkeys(differences))[:_LISTED], largest, list(notes.values()))


def _comparison(original: Original, new: Original, **terms: Any) -> Comparison:
    """Return the comparison of two programs; terms: without a tolerance it is the least increment."""
    old_side, new_side = (
        Revision(program.path, program.settings.name, [("", program.tables)]) for program in (original, new)
    )
    return compared(old_side, new_side, Terms(**{"tolerance": default_tolerance(old_side, new_side), **terms}))


def require_equal(result: ReadBack) -> None:
    """Raise RefusedError if the new program differs from the original."""
    if result.differences:
        raise RefusedError(result.differences)


def _without_moves(new: Original, origin: Sequence[int], decided: Collection[int]) -> set[int]:
    """The decided lines in whose place the new program does not move."""
    trace = new.trace
    lines = trace.blocks.line_in_file[np.flatnonzero(trace.axes.moves)].tolist()
    moving = {origin[line - 1] for line in lines if 0 < line <= len(origin)}
    return set(decided) - moving


def _of_comparison(
    result: Comparison,
    decided: Collection[int] = (),
    rapid_as_line: bool = False,
    other_states: Collection[str] = (),
    origin: Sequence[int] = (),
) -> Iterator[Refusal]:
    """Yield why the programs cannot be compared, else what differs: without what is not known it may not."""
    if reasons := [Refusal(0, f"not comparable: {reason.reason}") for reason in result.not_compared if reason.matters]:
        yield from reasons
        return
    for section in result.sections:
        for difference in section.differences:
            is_rapid = rapid_as_line and difference.what == "feed" and difference.old == "rapid traverse"
            if not is_rapid and difference.what not in other_states:
                yield refusal_of(difference, section)
    for difference in result.outside:
        of_line = difference.old_line or (line_of(origin, difference.new_line) if difference.new_line else 0)
        if difference.what != "order" or of_line not in decided:
            yield refusal_of(difference)


def _times(result: Comparison) -> Iterator[Refusal]:
    """Yield sections whose time would change, as where F along an arc, or beside Z, has another meaning."""
    for section in result.sections:
        if section.old is None or section.new is None:
            continue
        was, is_now = section.old.time, section.new.time
        if was is not None and is_now is not None and abs(was - is_now) > max(TIME, TIME_SHARE * was):
            yield Refusal(section.old.line, f"the section takes {was:.2f} s, and would take {is_now:.2f} s")


def _added_findings(
    original: Original, new: Original, origin: Sequence[int], lowest: Severity
) -> Iterator[tuple[Rule, Severity, Refusal]]:
    """
    Findings of a check from a severity up that the original does not have, with their rules and severities; those that
    displace the contour in any case.
    """
    rules = load_all()
    before, after = (
        findings_of([("", program.tables)], program.settings.severities, lowest, inline=program.settings.inline)
        for program in (original, new)
    )
    of_rule: dict[tuple[str, Severity], list[Finding]] = {}
    for finding in after:
        # A note of one lathe is none of what fails a program on another one.
        least = min(SEVERITIES[finding.severity], Severity.WARNING)
        of_rule.setdefault((finding.rule, least), []).append(finding)
    for (rule, least), findings in of_rule.items():
        same = [finding.line for finding in before if finding.rule == rule and SEVERITIES[finding.severity] >= least]
        lines = set(same)
        added = [finding for finding in findings if line_of(origin, finding.line) not in lines]
        added = findings if rule in _OF_CENTER else added[: max(len(findings) - len(same), 0)]
        for finding in added:
            text = f"{finding.rule} in line {finding.line} of the result: {finding.message}"
            yield rules[rule], SEVERITIES[finding.severity], Refusal(line_of(origin, finding.line), text)
