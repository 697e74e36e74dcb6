"""What of two programs cannot be compared, and why."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator

import numpy as np

from polarcheck.checking.not_evaluated import bounds_not_reported, unexecuted, unknown_value
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.unknown_words import UnknownItem
from polarcheck.rewrite.compare.comparison_report import NotCompared
from polarcheck.rewrite.compare.differences import Part
from polarcheck.rewrite.compare.order_differences import order_differences
from polarcheck.rewrite.compare.order_meanings import shift_steps
from polarcheck.rewrite.compare.orders import not_comparable
from polarcheck.rewrite.compare.same_words import spans_of
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rules.tables import Tables

#: What stands before the value of a word; nothing before `#2001=`.
_ADDRESS = re.compile(r"^,?[A-Z]+(?:[0-9]*=)?")


def incomparable(pair: tuple[Tables, Tables], terms: Terms) -> Iterator[NotCompared]:
    """Yield what of a run of each program cannot be compared."""
    traces: tuple[Trace, Trace] = pair[0]["trace"], pair[1]["trace"]
    for name, tables in zip(("old", "new"), pair, strict=True):
        for entry in (*unexecuted(tables), *bounds_not_reported(tables, ())):
            yield NotCompared(f"{name}: {entry.reason}", matters=entry.matters)
        unreadable = int(np.count_nonzero(tables["words"].is_unreadable))
        if unreadable:
            count = "a word" if unreadable == 1 else f"{unreadable} words"
            yield NotCompared(f"{name}: {count} that the control cannot read: polarcheck check names them")
        written = tables["written"]
        if any(count.any() for count in (written.stray_count, written.wrong_dash_count, written.letter_count)):
            reason = f"{name}: characters that the control cannot read: polarcheck check names them"
            yield NotCompared(reason, matters=not terms.is_kept)
    # In one program alone it is left to the lathe what F means.
    is_open = [
        bool((tables["feeds"].mode_is_unknown & trace.path.moves_at_feed).any())
        for tables, trace in zip(pair, traces, strict=True)
    ]
    if is_open[0] != is_open[1]:
        reason = f"{'old' if is_open[0] else 'new'}: no code says whether F is per minute or per revolution"
        yield NotCompared(reason, matters=not terms.is_kept)
    yield from _unknown_values(pair, terms)
    if traces[0].machine != traces[1].machine:
        yield from _of_machines(traces, terms)


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


def why_not(old: Part, new: Part) -> str:
    """Return why two sections cannot be compared; empty if they can."""
    known = {
        "Z": [part.stretch.knows_z for part in (old, new)],
        "C at its beginning": [_knows_entry(part) for part in (old, new)],
    }
    for what, is_known in known.items():
        if is_known[0] != is_known[1]:
            return f"{'new' if is_known[0] else 'old'}: {what} is not known"
    without = [part.stretch.as_programmed for part in (old, new)]
    if bool(without[0]) != bool(without[1]):
        return f"{'old' if without[0] else 'new'}: {without[0] or without[1]}"
    return ""


def not_known_in_both(old: Part) -> Iterator[str]:
    """Yield what neither of two sections says of the part: the angle or the depth at which the metal goes."""
    if not _knows_entry(old):
        yield "C at its beginning is not known in either: at which angle of the part it mills is not compared"
    if not old.stretch.knows_z:
        yield "Z is not known in either: how deep it mills is not compared"


def _knows_entry(part: Part) -> bool:
    return bool(part.trace.path.knows_section_entry[part.stretch.section])
