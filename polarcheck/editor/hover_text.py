"""The hover: pages of findings, the meaning of the word at the cursor, and the state behind its block."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
from lsprotocol import types

from polarcheck.checking.polar_sections import radius_source
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.editor.analysis import Analysis
from polarcheck.editor.program_markdown import page, plain
from polarcheck.editor.words.at_cursor import CursorWord, word_at
from polarcheck.editor.words.explained import explained
from polarcheck.editor.words.in_force import codes_in_force
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import Finding, radius_origin
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.foundation.time_limit import time_limit
from polarcheck.reports.pages import manual
from polarcheck.rules.quantity import Quantity, in_row
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables
from polarcheck.rules.wording.offsets import key_of

#: The time limit of a hover, which may need tables that no rule has used [s].
_PATIENCE = 5.0
_UNKNOWN = "not known"
#: The rate of C in a move through its center.
_AT_ONCE = "would have to turn by 180 deg at once, at the center"
_SIDES = {Side.LEFT: "G41, to the left", Side.RIGHT: "G42, to the right"}
_MOTIONS = {
    Motion.RAPID: "rapid traverse",
    Motion.LINE: "straight line",
    Motion.CW: "arc, clockwise",
    Motion.CCW: "arc, counterclockwise",
    Motion.CYCLE: "cycle",
}
_FEED_MODES = {FeedMode.PER_MINUTE: "/min", FeedMode.PER_REVOLUTION: "/rev", FeedMode.INVERSE_TIME: "inverse time"}


def hover(analysis: Analysis, position: types.Position, with_markdown: bool) -> types.Hover | None:
    """Return the pages of the findings at a position, its word, and the state of its block; None without any."""
    if analysis.report is None:
        return None
    findings, word = analysis.findings_in(position, position), word_at(analysis, position)
    parts: list[str] = []
    line = analysis.text.line_of(position)
    range_of_hover = analysis.text.line_range(line)
    if word is not None:
        range_of_hover = analysis.text.range(analysis.text.place_of(word.start), analysis.text.place_of(word.end))
    if findings:
        parts.append(_pages(analysis, findings, with_markdown))
        first = findings[0]
        range_of_hover = analysis.text.range_of(first.line, first.column, first.end_line, first.end_column)
    try:
        with time_limit(_PATIENCE):
            parts += [
                _listed(title, facts, with_markdown) for title, facts in _facts_at(analysis, line, word, findings)
            ]
    except TooHardError as error:
        parts.append(_listed("", [("not evaluated", str(error))], with_markdown))
    if not parts:
        return None
    text = ("\n\n---\n\n" if with_markdown else "\n\n").join(parts)
    kind = types.MarkupKind.Markdown if with_markdown else types.MarkupKind.PlainText
    return types.Hover(types.MarkupContent(kind, text), range_of_hover)


def _facts_at(
    analysis: Analysis, line: int, word: CursorWord | None, findings: list[Finding]
) -> Iterator[tuple[str, list[tuple[str, str]]]]:
    """Yield the title and the facts of a word, then those of its block; beside findings the word alone."""
    execution = analysis.row_of(line)
    if word is not None:
        trace, row = (execution[0]["trace"], execution[1]) if execution is not None else (None, None)
        if trace is None and analysis.runs:
            trace = analysis.runs[0][1]["trace"]
        title, facts = explained(word, analysis, trace, row)
        if title:
            yield title, facts
    if not findings:
        title, facts = state(analysis, line)
        if facts:
            yield title, facts


def _pages(analysis: Analysis, findings: list[Finding], with_markdown: bool) -> str:
    assert analysis.settings is not None
    rules = load_all()
    names = [name for name in dict.fromkeys(finding.rule for finding in findings) if name in rules]
    if not with_markdown:
        return manual.pages((rules[name] for name in names), analysis.settings.machine)
    texts = []
    for name in names:
        _, _, body = manual.pages([rules[name]], analysis.settings.machine).partition("\n\n")
        alarms = [finding.alarm for finding in findings if finding.rule == name and finding.alarm]
        alarm = f", alarm {plain(alarms[0])}" if alarms else ""
        texts.append(f"**{name}**{alarm}\n\n{page(body.strip())}")
    return "\n\n---\n\n".join(texts)


def _listed(title: str, facts: list[tuple[str, str]], with_markdown: bool) -> str:
    if with_markdown:
        head = [f"**{plain(title)}**\n"] if title else []
        return "\n".join([*head, *(f"- {plain(name)}: {plain(fact)}" for name, fact in facts)])
    return "\n".join([*([title] if title else []), *(f"{name}: {fact}" for name, fact in facts)])


def state(analysis: Analysis, line: int) -> tuple[str, list[tuple[str, str]]]:
    """
    Return the state after the first run of a block: a title, and facts by name, in the units of the program.

    Both are empty for a line that is not executed.
    """
    execution = analysis.row_of(line)
    if execution is None:
        return "", []
    tables, row, count = execution
    trace: Trace = tables["trace"]
    title = _title(trace, row)
    facts = list(_facts(tables, trace, row))
    codes = codes_in_force(trace, row)
    if codes:
        facts.append(("in force", " ".join(codes)))
    if count > 1:
        facts.append(("runs", f"{count} times; this is the first"))
    return title, facts


def _title(trace: Trace, row: int) -> str:
    if trace.mode.enters[row]:
        return "The polar mode begins"
    if row in trace.mode.sections.leave[trace.mode.sections.left]:
        return "The polar mode ends"
    motion = _MOTIONS.get(Motion(int(trace.axes.motion[row])), "")
    what = f"{motion[:1].upper()}{motion[1:]}" if trace.axes.moves[row] and motion else "No movement"
    if not trace.mode.in_polar[row]:
        return f"{what}, outside the polar mode"
    enter = int(trace.mode.sections.enter[trace.mode.section[row]])
    return f"{what}, in the polar mode since line {int(trace.blocks.line_in_file[enter])}"


def _facts(tables: Tables, trace: Trace, row: int) -> Iterator[tuple[str, str]]:
    inside = bool(trace.mode.in_polar[row])
    # Outside the mode unknown values are left out.
    if inside or np.isfinite([trace.path.x[row], trace.path.z[row], trace.path.c_angle[row]]).any():
        yield "position behind it", ", ".join(_position(trace, row))
    yield "tool offset", _offset(trace, row)
    if inside:
        yield "compensation", _SIDES.get(Side(int(trace.compensation.side[row])), "off (G40)")
    feed = _feed(trace, row)
    if inside or feed != _UNKNOWN:
        yield "feed", feed
    if inside and trace.axes.moves_plane[row]:
        yield from _of_tool_center(tables["tool_center"], trace, row)
    seconds = float(tables["dynamics"].time[row])
    if inside and seconds > 0 and math.isfinite(seconds):
        yield "time", f"{seconds:.2f} s"


def _position(trace: Trace, row: int) -> Iterator[str]:
    """Yield each axis with its kind of value (diameter, length, angle), since these are often confused."""
    inside = bool(trace.mode.in_polar[row])
    is_diameter = bool(trace.lengths.x_factor[row] < 1)
    linear = chr(trace.axes.linear_axis[row])
    x = trace.path.end[row].real if inside else trace.path.x[row]
    yield f"{linear} {_text(in_row(x, trace.lengths, row), 'diameter')}{' (diameter)' if is_diameter else ' (radius)'}"
    if inside:
        virtual = in_row(trace.path.end[row].imag, trace.lengths, row)
        yield f"{trace.axes.virtual_axis_of(row)} {_text(virtual, 'length')} (length)"
    yield f"Z {_text(in_row(trace.path.z[row], trace.lengths, row), 'length')}"
    angle = float(trace.path.c_angle[row])
    yield f"{trace.machine.polar.rotary_address} axis {f'{angle:.3f} deg' if math.isfinite(angle) else _UNKNOWN}"


def _text(value: Quantity, form: str) -> str:
    return value.shown(form) if np.isfinite(value.value) else _UNKNOWN


def _offset(trace: Trace, row: int) -> str:
    key = key_of(trace.tools, int(trace.tools.offset_number[row]))
    if key is None:
        return "none in force"
    radius = in_row(float(trace.compensation.radius[row]), trace.lengths, row)
    source = f" ({radius_origin(radius_source(trace, row))})" if np.isfinite(radius.value) else ""
    return f"{key}, R {_text(radius, 'length')}{source}"


def _feed(trace: Trace, row: int) -> str:
    mode = FeedMode(int(trace.feedrate.feed_mode[row]))
    value = in_row(
        float((trace.feedrate.feed if mode == FeedMode.PER_MINUTE else trace.feedrate.feed_number)[row]),
        trace.lengths,
        row,
    )
    if not np.isfinite(value.value):
        return _UNKNOWN
    if mode == FeedMode.PER_MINUTE:
        return f"F {value.shown('feed')}"
    return f"F {value.shown('length')}{_FEED_MODES[mode]}"


def _of_tool_center(tool_center: ToolCenter, trace: Trace, row: int) -> Iterator[tuple[str, str]]:
    """Yield the rate of C in the move, its smallest distance to the center, and the highest F."""
    c_feed = float(tool_center.c_feed[row])
    limit = trace.machine.limits.c_feed
    of_limit = f" of {limit:.0f}" if math.isfinite(limit) else ""
    rate = _AT_ONCE if math.isinf(c_feed) else _UNKNOWN
    yield "C axis", f"{c_feed:.0f}{of_limit} deg/min" if math.isfinite(c_feed) else rate
    yield "nearest to the center", _text(in_row(float(tool_center.nearest[row]), trace.lengths, row), "length")
    allowed = in_row(float(tool_center.feed_allowed[row]), trace.lengths, row)
    if of_limit and np.isfinite(allowed.value):
        yield "highest F here", f"{allowed:highest}"
