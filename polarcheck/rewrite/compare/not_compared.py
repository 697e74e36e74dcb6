"""What of two programs cannot be compared, and why."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from polarcheck.checking.check import check_runs
from polarcheck.checking.not_evaluated import bounds_not_reported, unexecuted, unknown_value
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.unknown_words import UnknownItem
from polarcheck.foundation.finding import SEVERITIES, Finding, Severity, each_finding
from polarcheck.rewrite.compare.compared_sections import Stretch
from polarcheck.rewrite.compare.comparison_report import NotCompared
from polarcheck.rewrite.compare.order_differences import order_differences
from polarcheck.rewrite.compare.order_meanings import shift_steps
from polarcheck.rewrite.compare.orders import not_comparable, statements
from polarcheck.rewrite.compare.same_words import spans_of
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

#: A run of a file as checking.check.read gives it: the state of block skip, and its tables.
Run = tuple[str, Tables]
#: What stands before the value of a word; nothing before `#2001=`.
_ADDRESS = re.compile(r"^,?[A-Z]+(?:[0-9]*=)?")


def incomparable(pair: tuple[Tables, Tables], terms: Terms) -> Iterator[NotCompared]:
    """Yield what of a run of each program cannot be compared."""
    traces: tuple[Trace, Trace] = pair[0]["trace"], pair[1]["trace"]
    for name, tables in zip(("old", "new"), pair, strict=True):
        for entry in (*unexecuted(tables, of_metal=False), *bounds_not_reported(tables, ())):
            yield NotCompared(f"{name}: {entry.reason}", matters=entry.matters)
        unreadable = int(np.count_nonzero(tables["words"].is_unreadable))
        if unreadable:
            count = "a word" if unreadable == 1 else f"{unreadable} words"
            yield NotCompared(f"{name}: {count} that the control cannot read: polarcheck check names them")
        written = tables["written"]
        if any(count.any() for count in (written.stray_count, written.wrong_dash_count, written.letter_count)):
            reason = f"{name}: characters that the control cannot read: polarcheck check names them"
            yield NotCompared(reason, matters=not terms.is_kept)
    is_same_machine = traces[0].machine == traces[1].machine
    if not (is_same_machine or terms.is_kept):
        # Also those without weight for a check, as Z of an origin, may move metal; on one machine they are orders.
        of_sides = [Counter(step.text for step in statements(trace)) for trace in traces]
        for name, of_side, of_rival in zip(("old", "new"), of_sides, of_sides[::-1], strict=True):
            yield from (NotCompared(f"{name}: {text} is not simulated") for text in list(of_side - of_rival)[:1])
    # In one program alone it is left to the lathe what F means.
    is_open = [
        bool((tables["feeds"].mode_is_unknown & trace.path.moves_at_feed).any())
        for tables, trace in zip(pair, traces, strict=True)
    ]
    if is_open[0] != is_open[1]:
        reason = f"{'old' if is_open[0] else 'new'}: no code says whether F is per minute or per revolution"
        yield NotCompared(reason, matters=not terms.is_kept)
    yield from _unknown_values(pair, terms)
    if not is_same_machine:
        yield from _of_machines(traces, terms)


def added_findings(old: Sequence[Run], new: Sequence[Run]) -> Iterator[NotCompared]:
    """
    Yield the rules of which a check of one program has more findings than that of the other, errors and warnings.

    With an error a control stops or runs otherwise than written, so that the same moves are not yet the same metal. A
    warning in one alone comes of something that is not compared; where comments differ, it may be what they say.
    """
    texts = [runs[0][1]["text"] for runs in (old, new)]
    same_comments = spans_of(texts[0], texts[0].comments) == spans_of(texts[1], texts[1].comments)
    findings = [findings_of(runs, runs[0][1]["job"].severities, Severity.WARNING) for runs in (old, new)]
    counts = [Counter(finding.rule for finding in of_side) for of_side in findings]
    for name, of_side, more in zip(
        ("old", "new"), findings, (counts[0] - counts[1], counts[1] - counts[0]), strict=True
    ):
        for rule in more:
            first = next(finding for finding in of_side if finding.rule == rule)
            matters = same_comments or SEVERITIES[first.severity] >= Severity.ERROR
            reason = f"{name}: a check finds {rule} in line {first.line}, and not in the other: {first.message}"
            yield NotCompared(reason, matters=matters)


def findings_of(
    runs: Sequence[Run], severities: Mapping[str, str], lowest: Severity, *, inline: bool = True
) -> list[Finding]:
    """Return the findings of a check from a severity up, also those that follow from another one."""
    report = check_runs(runs, list(load_all().values()), severities, inline)
    return [finding for finding in each_finding(report.findings) if SEVERITIES[finding.severity] >= lowest]


def _of_machines(traces: tuple[Trace, Trace], terms: Terms) -> Iterator[NotCompared]:
    yield NotCompared("the machines differ: tool numbers, planes and G codes are not compared", matters=False)
    for name, trace in zip(("old", "new"), traces, strict=True):
        codes = not_comparable(trace)
        if codes:
            reason = f"{name}: {', '.join(codes)}: what another lathe needs in their place is not compared"
            yield NotCompared(reason, matters=False)
    shifts = [shift_steps(trace) for trace in traces]
    if (first := next(iter(order_differences(shifts[0], shifts[1], terms.tolerance)), None)) is not None:
        where = f"line {first.old_line} (old)" if first.old_line else f"line {first.new_line} (new)"
        reason = f"where codes as {first.old or first.new} of {where} put the coordinates on another lathe"
        yield NotCompared(f"{reason} is not compared", matters=not terms.is_rewritten)


def _unknown_values(pair: tuple[Tables, Tables], terms: Terms) -> Iterator[NotCompared]:
    """
    Yield an entry for the values of each program that are not known, and that the other may have otherwise.

    They are the same where all statements are, where a variable that has no value stands there itself, and where a
    rewriter has kept what is written.
    """
    traces: list[Trace] = [tables["trace"] for tables in pair]
    statements = [spans_of(trace.text, trace.text.blocks[trace.text.blocks.is_macro]) for trace in traces]
    if traces[0].machine == traces[1].machine and statements[0] == statements[1]:
        return
    items = [_unknown_items(pair[0], terms.left_out), _unknown_items(pair[1], ())]
    written = [Counter(text for text, _ in of_side) for of_side in items]
    for name, trace, of_side in zip(("old", "new"), traces, items, strict=True):
        unlike = [
            item
            for text, item in of_side
            if written[0][text] != written[1][text] or not (terms.is_kept or text == f"#{item.variable}")
        ]
        if unlike:
            value = unknown_value(trace, [unlike[0].variable], unlike, matters=True)
            yield NotCompared(f"{name}: {value.reason}")


def _unknown_items(tables: Tables, left_out: Collection[int]) -> list[tuple[str, UnknownItem]]:
    """Return the values of a program that are not known, each as it is written behind its address."""
    trace: Trace = tables["trace"]
    excerpt, line = trace.text.source.excerpt, trace.blocks.line_in_file
    return [
        (_ADDRESS.sub("", "".join(excerpt(item.start, item.end).split()).upper()), item)
        for item in tables["unknown_words"].items
        if int(line[item.row]) not in left_out
    ]


def why_not(old: Stretch, new: Stretch) -> str:
    """Return why two sections cannot be compared; empty if they can."""
    known = {
        "Z": [part.knows_z for part in (old, new)],
        "C at its beginning": [_knows_entry(part) for part in (old, new)],
    }
    for what, is_known in known.items():
        if is_known[0] != is_known[1]:
            return f"{'new' if is_known[0] else 'old'}: {what} is not known"
    without = [part.as_programmed for part in (old, new)]
    if bool(without[0]) != bool(without[1]):
        return f"{'old' if without[0] else 'new'}: {without[0] or without[1]}"
    return ""


def not_known_in_both(old: Stretch) -> Iterator[str]:
    """Yield what neither of two sections says of the part: the angle or the depth at which the metal goes."""
    if not _knows_entry(old):
        yield "C at its beginning is not known in either: at which angle of the part it mills is not compared"
    if not old.knows_z:
        yield "Z is not known in either: how deep it mills is not compared"


def _knows_entry(part: Stretch) -> bool:
    return bool(part.trace.path.knows_section_entry[part.section])
