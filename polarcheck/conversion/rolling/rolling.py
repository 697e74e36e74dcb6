"""A program with plain moves of X and C as one with polar sections of lines and arcs."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.checking.editing import in_place_of
from polarcheck.columns.trace import Trace
from polarcheck.conversion.blocks import edit_behind, edits_of, with_edits
from polarcheck.conversion.original import Original
from polarcheck.conversion.outcome import Figure, Outcome, Refusal, RefusedError
from polarcheck.conversion.reading_back import ReadBack, read_back_on_part
from polarcheck.conversion.rolling.elements import Fit, fit_of
from polarcheck.conversion.rolling.entries import Entry, entry_of
from polarcheck.conversion.rolling.feeds import Feeds, feeds_of
from polarcheck.conversion.rolling.stretches import LEAST, Stretch, stretches, x_factor
from polarcheck.conversion.rolling.ways import Way, per_minute_rule, through_center, way_of
from polarcheck.conversion.rolling.writing import Writer
from polarcheck.conversion.style import Style
from polarcheck.conversion.style_of import style_of

#: Of a step of the new words: so far may rounding move a point and a center together.
_ROUNDING = 1.7


class Rolling(msgspec.Struct, frozen=True):
    """
    How stretches are rolled.

    tolerance: how far the ends of the blocks may be from the new path [mm]. feed: what F per minute is, one of
    WITH_ROTARY; empty for what the machine has (feed.with_rotary). keep_c: C is never positioned at 0 for the mode.
    """

    tolerance: float = 0.01
    feed: str = ""
    keep_c: bool = False


class Section(msgspec.Struct, frozen=True):
    """A stretch and what becomes of it."""

    stretch: Stretch
    way: Way
    fit: Fit
    feeds: Feeds
    entry: Entry | None
    text: Writer


def rolled(original: Original, options: Rolling) -> Outcome:
    """
    Write the plain moves of X and C of a program as polar sections.

    What cannot be one stays as it is, with a note. Raises RefusedError where nothing becomes a section, or what is read
    back differs; TooHardError.
    """
    trace = original.trace
    candidates, left = stretches(trace)
    if not candidates:
        nothing = f"nothing to roll: no {LEAST} blocks one behind the other move X and C at feed without the mode"
        raise RefusedError(left or [Refusal(0, nothing)])
    rule = per_minute_rule(trace, candidates, options.feed)
    style = style_of(trace)
    sections: list[Section] = []
    for each in candidates:
        try:
            sections.append(_section(trace, each, rule, options, style))
        except RefusedError as error:
            left += error.refusals
    while sections:
        data, origin, result = _written(original, sections, style, options.tolerance)
        wrong = [each for each in sections if _is_at_fault(each, result.differences)]
        if result.differences and not wrong:
            raise RefusedError(result.differences)
        if not wrong:
            figures = _figures(sections, result)
            return Outcome(data, origin, [], figures, _notes(original, sections, left))
        left += [each for each in result.differences if each.line]
        sections = [each for each in sections if each not in wrong]
    raise RefusedError(sorted(set(left)))


def _section(trace: Trace, each: Stretch, rule: str, options: Rolling, style: Style) -> Section:
    machine, tolerance = trace.machine, options.tolerance
    way = through_center(way_of(trace, each, rule))
    step = float(np.broadcast_to(trace.lengths.least_step, len(trace))[each.first])
    reserve = _ROUNDING * step
    if tolerance < 2 * reserve:
        text = f"a tolerance of {tolerance:g} mm is too little: the least increment alone takes {reserve:.4f} mm"
        raise RefusedError([Refusal(each.line, text)])
    widest = float(np.abs(way.radius).max(initial=0.0))
    noise = np.hypot(step * x_factor(trace, each.first), widest * np.radians(machine.control.least_increment)) / 2
    fit = fit_of(way, tolerance, reserve, 1.5 * float(noise))
    unit = float(np.broadcast_to(trace.lengths.feed_scale, len(trace))[each.first])
    feeds = feeds_of(way, fit.elements, machine, unit)
    entry = None if options.keep_c else entry_of(trace, each, way)
    writer = Writer(trace, each, way, entry, style)
    writer.write(fit.elements, feeds.of_element)
    if writer.count >= len(way):
        text = f"the section would have {writer.count} blocks in the place of {len(way)}"
        raise RefusedError([Refusal(each.line, text)])
    return Section(each, way, fit, feeds, entry, writer)


def _written(
    original: Original, sections: Sequence[Section], style: Style, tolerance: float
) -> tuple[bytes, list[int], ReadBack]:
    run, machine = original.trace.run, original.settings.machine
    blocks = {index: new for each in sections for index, new in each.text.replaced.items()}
    edits = edits_of(original, blocks, style, machine)
    left_out = []
    for each in sections:
        if each.entry is not None:
            row = each.entry.behind
            left_out.append(int(original.trace.blocks.line_in_file[row]))
            edits.append(edit_behind(original, int(run.block[row]), each.text.inserted, style, machine))
            if each.text.positions:
                edits.append(in_place_of(run, each.entry.c_word, each.text.positions))
    data, origin = with_edits(original, sorted(edits))
    chord = tolerance / 50
    allowed = tolerance + max(each.fit.bow for each in sections) + 3 * chord
    return data, origin, read_back_on_part(original, data, original.settings, origin, allowed, chord, left_out)


def _is_at_fault(each: Section, differences: Sequence[Refusal]) -> bool:
    stretch = each.stretch
    return any(stretch.line <= refusal.line <= stretch.last_line for refusal in differences)


def _figures(sections: Sequence[Section], result: ReadBack) -> list[Figure]:
    before = sum(len(each.way) for each in sections)
    return [
        Figure("sections", len(sections)),
        Figure("blocks before", before),
        Figure("blocks after", sum(each.text.count for each in sections)),
        Figure("largest distance of the tool center from its path", result.deviation, "mm"),
    ]


def _notes(original: Original, sections: Sequence[Section], left: Sequence[Refusal]) -> list[str]:
    notes = []
    for each in sections:
        feeds = ", ".join(f"F{feed:g}" for feed in each.feeds.meant[:5])
        notes.append(f"line {each.stretch.line}: {feeds}")
    notes += [f"line {each.line}: left as it is: {each.text}" for each in left]
    notes.append("the path is that of the tool center: `polarcheck compensate` gives it G41 or G42")
    return notes
