"""A program with plain moves of X and C as one with polar sections of lines and arcs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Motion
from polarcheck.geometry import polar
from polarcheck.rewrite.roll.entries import entry_of
from polarcheck.rewrite.roll.following import Following, x_factor
from polarcheck.rewrite.roll.rollable import LEAST, Stretch, stretches
from polarcheck.rewrite.roll.rolled_blocks import Writer
from polarcheck.rewrite.roll.rolled_deviation import Measured, Section, measured_of
from polarcheck.rewrite.roll.rolled_elements import Fit, fit_of
from polarcheck.rewrite.roll.rolled_feeds import feeds_of
from polarcheck.rewrite.roll.slowing import parts_of
from polarcheck.rewrite.roll.ways import Way, per_minute_rule, through_center, way_of
from polarcheck.rewrite.writing.new_blocks import edit_behind, edits_of, with_edits
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Figure, Outcome, Refusal, RefusedError, refused_at
from polarcheck.rewrite.writing.reading_back import ReadBack, read_back_on_part
from polarcheck.rewrite.writing.style import Style
from polarcheck.rewrite.writing.style_of import style_of
from polarcheck.rules.editing import in_place_of

#: How often the program is written again without what differed when it was read back.
_TRIALS = 5
#: The rule of ways through the center.
_THROUGH_CENTER = "path-through-center"
#: Feeds that a note names.
_LISTED = 5
#: Less than this share of the way that C slowed down is not told.
_MOST_SLOWED = 0.02
#: C nearer to full turns than this is at 0 [deg].
_AT_ZERO = 1e-9
#: How far rounding can move a point and a center together, in steps of the new words.
_ROUNDING = 1.7
#: Share of the tolerance by which chords may leave the way where it is compared as a whole, and what that adds to it.
_CHORD, _OF_CHORDS = 0.02, 1.1


#: Why F is lower, by Parts.by.
_WHY_LOWER = {
    "limit": "so that C turns no faster than its limit allows",
    "before": "so that C turns no faster than in the plain moves, since its limit is not known",
    "feed": "the highest F of the mode (limits.polar_feed)",
}


class Rolling(msgspec.Struct, frozen=True):
    """
    How stretches are rolled.

    tolerance: how far the ends of the blocks may be from the new path [mm]. feed: what F per minute is, one of
    WITH_ROTARY; empty for what the machine has (feed.with_rotary). keep_c: C is never positioned at 0 for the mode.
    """

    tolerance: float = 0.01
    feed: str = ""
    keep_c: bool = False


def rolled(original: Original, options: Rolling) -> Outcome:
    """
    Write the plain moves of X and C of a program as polar sections.

    What cannot be one stays as it is, with a note. Raises RefusedError where nothing becomes a section, or what is read
    back differs; TooHardError.
    """
    trace = original.trace
    following = Following(trace)
    candidates, left = stretches(trace, following)
    if not candidates:
        nothing = f"nothing to roll: no {LEAST} blocks one behind the other move X and C at feed without the mode"
        raise RefusedError(left or [Refusal(0, nothing)])
    rule = per_minute_rule(trace, candidates, options.feed)
    style = style_of(trace)
    sections: list[Section] = []
    for each in candidates:
        try:
            sections.append(_section(original, following, each, rule, options, style))
        except RefusedError as error:
            left += error.refusals
    for _ in range(_TRIALS):
        if not sections:
            break
        data, origin, result = _written(original, sections, style, options.tolerance)
        measured = measured_of(original, result.new, origin, sections, options.tolerance)
        differences = result.differences or measured.differences
        if not differences:
            notes = [*_notes(original, sections, rule, options), *(f"{each}" for each in result.notes), *_left(left)]
            return Outcome(data, origin, [], _figures(sections, measured), notes)
        wrong = [each for each in sections if _is_at_fault(each, differences)]
        if not wrong:
            raise RefusedError(differences)
        left += differences
        sections = [each for each in sections if each not in wrong]
    raise RefusedError(sorted(set(left)))


def _section(
    original: Original, following: Following, each: Stretch, rule: str, options: Rolling, style: Style
) -> Section:
    trace = original.trace
    machine, tolerance = trace.machine, options.tolerance
    way = through_center(way_of(trace, each, rule))
    step = float(np.broadcast_to(trace.lengths.least_step, len(trace))[each.first])
    reserve = _ROUNDING * step
    if tolerance - reserve < step:
        text = f"a tolerance of {tolerance:g} mm is too little: rounding alone takes {reserve:.4f} mm"
        raise RefusedError([Refusal(each.line, text)])
    widest = float(np.abs(way.radius).max(initial=0.0))
    noise = np.hypot(step * x_factor(trace, each.first), widest * np.radians(machine.control.least_increment)) / 2
    fit = fit_of(way, tolerance, reserve, 1.5 * float(noise))
    unit = float(np.broadcast_to(trace.lengths.feed_scale, len(trace))[each.first])
    _require_off_center(original, way, fit, step)
    feeds = feeds_of(way, fit.elements, machine, unit)
    entry = None if options.keep_c else entry_of(trace, each, way, following)
    writer = Writer(trace, each, way, entry, style, following)
    parts = parts_of(way, fit.elements, feeds, machine, unit)
    writer.write(parts.elements, parts.feeds)
    if writer.count >= len(way):
        text = f"the section would have {writer.count} blocks in the place of {len(way)}"
        raise RefusedError([Refusal(each.line, text)])
    return Section(each, way, fit, feeds, parts, unit, entry, writer, int(trace.blocks.line_in_file[writer.first]))


def _require_off_center(original: Original, way: Way, fit: Fit, step: float) -> None:
    """Raise RefusedError for a way through the center of C, where a check of the result would find an error."""
    severities = {**original.settings.machine.severities, **original.settings.severities}
    if severities.get(_THROUGH_CENTER, "error") != "error":
        return
    for element in fit.elements:
        start, end, center = (np.array([point], complex) for point in (element.start, element.end, element.center))
        nearest = polar.nearest(start, end, center, np.array([element.kind], np.int16))[0]
        if element.kind != Motion.NONE and nearest < step:
            title = original.settings.machine.title
            raise refused_at(
                original.trace,
                way.row[element.first],
                f"the way goes through the center of C, which the mode cannot: {title}",
            )


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
    chord = _CHORD * tolerance
    # The ends of blocks are measured by themselves; here the order of the whole way counts.
    bow = max(each.fit.bow for each in sections)
    allowed = _OF_CHORDS * (tolerance + bow) + _ROUNDING * float(np.max(original.trace.lengths.least_step))
    return (
        data,
        origin,
        read_back_on_part(original, data, original.settings, origin, allowed, chord, left_out, noted=("setup",)),
    )


def _is_at_fault(each: Section, differences: Sequence[Refusal]) -> bool:
    return any(each.first_line <= refusal.line <= each.stretch.last_line for refusal in differences)


def _figures(sections: Sequence[Section], measured: Measured) -> list[Figure]:
    return [
        Figure("sections", len(sections)),
        Figure("blocks before", sum(len(each.way) for each in sections)),
        Figure("blocks after", sum(each.text.count for each in sections)),
        Figure("largest distance of the ends of the blocks from the new path", measured.places, "mm"),
        Figure("largest distance between the old and the new path within a block", measured.way, "mm"),
        Figure("time at feed before", 60 * sum(float(each.way.time.sum()) for each in sections), "s"),
        Figure("time at feed after", measured.time, "s"),
    ]


def _left(refusals: Sequence[Refusal]) -> list[str]:
    return [f"line {each.line}: left as it is: {each.text}" for each in dict.fromkeys(refusals)]


def _notes(original: Original, sections: Sequence[Section], rule: str, options: Rolling) -> list[str]:
    trace, notes = original.trace, []
    for each in sections:
        stretch, elements = each.stretch, each.fit.elements
        where = f"line {stretch.line} to {stretch.last_line}"
        count = sum(element.kind != Motion.NONE for element in elements)
        curves = f"{count} lines and arcs" if count > 1 else "one line or arc"
        notes.append(f"{where}: {len(each.way)} blocks become {curves} with {_feeds(each)}")
        notes += [f"{where}: {text}" for text in _on_feed(each)]
        notes += [f"{where}: {text}" for text in _on_entry(trace, each)]
    known = trace.machine.feed.with_rotary
    if rule and rule not in known:
        notes.append(f"F is {rule} as --feed says; the profile of {trace.machine.title} does not say so")
    elif rule and "feed.with_rotary" in original.settings.doubtful:
        notes.append(f"that F is {rule} on {trace.machine.title} is in doubt: compare the times, or give --feed")
    notes.append("the path is that of the tool center: `polarcheck compensate` gives it G41 or G42")
    return notes


def _feeds(each: Section) -> str:
    unit = each.unit
    texts = [f"F{feed / unit:g}" for feed in each.feeds.by_way[:_LISTED]]
    return ", ".join(texts) + " and others" * (len(each.feeds.by_way) > _LISTED)


def _on_feed(each: Section) -> Iterator[str]:
    feeds, unit = each.feeds, each.unit
    if not feeds.is_even:
        low, high = (f"{speed / unit:.3g}" for speed in (feeds.slowest, feeds.fastest))
        yield f"the speed of the tool changed along it from {low} to {high}: F is that of the middle of the way"
    if feeds.slowed > _MOST_SLOWED:
        yield f"C was at its limit in {feeds.slowed:.0%} of the way: F is that of the rest"
    parts = each.parts
    if parts.limited:
        lowest = f"F{parts.lowest / unit:g}"
        yield f"F is lower in {parts.limited} of them, down to {lowest}, {_WHY_LOWER[parts.by]}"


def _on_entry(trace: Trace, each: Section) -> Iterator[str]:
    axis = trace.machine.polar.rotary_address
    if each.entry is not None:
        line = int(trace.blocks.line_in_file[each.entry.behind])
        yield f"behind line {line} {axis} goes to 0 above the part, and back in the mode: --keep-c leaves it there"
    elif not trace.machine.polar.plane_is_fixed:
        angle = float(trace.path.c_angle_before[each.stretch.first])
        if abs(angle - 360 * round(angle / 360)) > _AT_ZERO:
            yield f"its coordinates are turned by {axis}{angle:g}, where {axis} stands when the mode is switched on"
