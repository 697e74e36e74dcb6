"""A program with plain moves of X and C as one with polar sections of lines and arcs."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Motion
from polarcheck.rewrite.roll.entries import entry_of
from polarcheck.rewrite.roll.following import Following
from polarcheck.rewrite.roll.rollable import LEAST, Stretch, stretches
from polarcheck.rewrite.roll.rolled_blocks import Writer
from polarcheck.rewrite.roll.rolled_deviation import Section, measured_of
from polarcheck.rewrite.roll.rolled_elements import Fit, fit_of
from polarcheck.rewrite.roll.rolled_feeds import feeds_of
from polarcheck.rewrite.roll.slowing import parts_of
from polarcheck.rewrite.roll.ways import AxisMoves, axis_moves, per_minute_rule, through_center
from polarcheck.rewrite.writing.new_blocks import edit_behind, edits_of, with_edits
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Figure, Measured, Outcome, Refusal, RefusedError, refused_at
from polarcheck.rewrite.writing.reading_back import ReadBack, read_back_on_part
from polarcheck.rewrite.writing.rotary_feed import notes_on_feed
from polarcheck.rewrite.writing.style import Style
from polarcheck.rewrite.writing.style_of import style_of
from polarcheck.rules.editing import in_place_of

#: How often the program is written again without what differed when it was read back.
_TRIALS = 5
#: The rule of paths through the center.
_THROUGH_CENTER = "path-through-center"
#: Feeds that a note names.
_LISTED = 5
#: The share of the path on which C was at its limit is noted above this value.
_MOST_SLOWED = 0.02
#: C nearer to full turns than this is at 0 [deg].
_AT_ZERO = 1e-9
#: How far rounding can move a point and a center together, in steps of the new words.
_ROUNDING = 1.7
#: When whole paths are compared: the distance of chords from a path, as a share of the tolerance, and the factor that
#: makes up for it.
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
    candidates, refusals = stretches(trace, following)
    if not candidates:
        nothing = f"nothing to roll: no {LEAST} blocks one behind the other move X and C at feed without the mode"
        raise RefusedError([*(refusals or [Refusal(0, nothing)]), *original.unknown])
    rule = per_minute_rule(trace, candidates, options.feed)
    style = style_of(trace)
    sections: list[Section] = []
    for candidate in candidates:
        try:
            sections.append(_section(original, following, candidate, rule, options, style))
        except RefusedError as error:
            refusals += error.refusals
    for _ in range(_TRIALS):
        if not sections:
            break
        data, origin, result = _written(original, sections, style, options.tolerance)
        measured = measured_of(original, result.new, origin, sections, options.tolerance)
        differences = result.differences or measured.differences
        if not differences:
            notes = [
                *_notes(original, sections, rule),
                *result.notes,
                *(f"line {refusal.line}: left as it is: {refusal.text}" for refusal in dict.fromkeys(refusals)),
            ]
            return Outcome(data, origin, [], _figures(sections, measured), notes)
        wrong = [
            section
            for section in sections
            if any(section.first_line <= refusal.line <= section.stretch.last_line for refusal in differences)
        ]
        if not wrong:
            raise RefusedError(differences)
        refusals += differences
        sections = [section for section in sections if section not in wrong]
    raise RefusedError(sorted({*refusals, *original.unknown}))


def _section(
    original: Original, following: Following, candidate: Stretch, rule: str, options: Rolling, style: Style
) -> Section:
    trace = original.trace
    machine, tolerance = trace.machine, options.tolerance
    moves = through_center(axis_moves(trace, candidate, rule))
    step = float(trace.lengths.least_step[candidate.first])
    reserve = _ROUNDING * step
    if tolerance - reserve < step:
        text = f"a tolerance of {tolerance:g} mm is too little: rounding alone takes {reserve:.4f} mm"
        raise RefusedError([Refusal(candidate.line, text)])
    widest = float(np.abs(moves.radius).max(initial=0.0))
    x_step, c_step = (
        step * trace.lengths.x_factor[candidate.first],
        widest * np.radians(machine.control.least_increment),
    )
    noise = np.hypot(x_step, c_step) / 2
    fit = fit_of(moves, tolerance, reserve, 1.5 * float(noise))
    unit = float(trace.lengths.feed_scale[candidate.first])
    _require_off_center(original, moves, fit, step)
    feeds = feeds_of(moves, fit.elements, machine, unit)
    entry = None if options.keep_c else entry_of(trace, candidate, moves, following)
    writer = Writer(trace, candidate, moves, entry, style, following)
    parts = parts_of(moves, fit.elements, feeds, machine, unit)
    writer.write(parts.elements, parts.feeds)
    if writer.count >= len(moves):
        text = f"the section would have {writer.count} blocks in the place of {len(moves)}"
        raise RefusedError([Refusal(candidate.line, text)])
    return Section(candidate, moves, fit, feeds, parts, unit, entry, writer, trace.line(writer.first))


def _require_off_center(original: Original, moves: AxisMoves, fit: Fit, step: float) -> None:
    """Raise RefusedError for a path through the center of C if a check of the result would report an error."""
    severities = {**original.settings.machine.severities, **original.settings.severities}
    if severities.get(_THROUGH_CENTER, "error") != "error":
        return
    for element in fit.elements:
        if element.kind != Motion.NONE and element.path.nearest[0] < step:
            title = original.settings.machine.title
            raise refused_at(
                original.trace,
                moves.row[element.first],
                f"the way goes through the center of C, which the mode cannot: {title}",
            )


def _written(
    original: Original, sections: Sequence[Section], style: Style, tolerance: float
) -> tuple[bytes, list[int], ReadBack]:
    run, machine = original.trace.run, original.settings.machine
    blocks = {index: new for section in sections for index, new in section.text.replaced.items()}
    edits = edits_of(original, blocks, style, machine)
    left_out = []
    for section in sections:
        if section.entry is not None:
            row = section.entry.behind
            left_out.append(original.trace.line(row))
            edits.append(edit_behind(original, int(run.block[row]), section.text.inserted, style, machine))
            if section.text.positions:
                edits.append(in_place_of(run, section.entry.c_word, section.text.positions))
    data, origin = with_edits(original, sorted(edits))
    chord = _CHORD * tolerance
    # The ends of blocks are measured by themselves; here the order of the whole path counts.
    bow = max(section.fit.bow for section in sections)
    allowed = _OF_CHORDS * (tolerance + bow) + _ROUNDING * float(np.max(original.trace.lengths.least_step))
    return (
        data,
        origin,
        read_back_on_part(original, data, origin, allowed, chord, left_out, noted=("setup",)),
    )


def _figures(sections: Sequence[Section], measured: Measured) -> list[Figure]:
    return [
        Figure("sections", len(sections)),
        Figure("blocks before", sum(len(section.way) for section in sections)),
        Figure("blocks after", sum(section.text.count for section in sections)),
        *measured.figures,
    ]


def _notes(original: Original, sections: Sequence[Section], rule: str) -> list[str]:
    trace, notes = original.trace, []
    for section in sections:
        stretch, elements = section.stretch, section.fit.elements
        where = f"line {stretch.line} to {stretch.last_line}"
        count = sum(element.kind != Motion.NONE for element in elements)
        curves = f"{count} lines and arcs" if count > 1 else "one line or arc"
        notes.append(f"{where}: {len(section.way)} blocks become {curves} with {_feeds(section)}")
        notes += [f"{where}: {text}" for text in _on_feed(section)]
        notes += [f"{where}: {text}" for text in _on_entry(trace, section)]
    notes += notes_on_feed(original.settings, rule, rule, "compare the times, or give --feed") if rule else []
    notes.append("the path is that of the tool center: `polarcheck compensate` gives it G41 or G42")
    return notes


def _feeds(section: Section) -> str:
    unit = section.unit
    texts = [f"F{feed / unit:g}" for feed in section.feeds.by_way[:_LISTED]]
    return ", ".join(texts) + " and others" * (len(section.feeds.by_way) > _LISTED)


def _on_feed(section: Section) -> Iterator[str]:
    feeds, unit = section.feeds, section.unit
    if not feeds.is_even:
        low, high = (f"{speed / unit:.3g}" for speed in (feeds.slowest, feeds.fastest))
        yield f"the speed of the tool changed along it from {low} to {high}: F is that of the middle of the way"
    if feeds.slowed > _MOST_SLOWED:
        yield f"C was at its limit in {feeds.slowed:.0%} of the way: F is that of the rest"
    parts = section.parts
    if parts.limited:
        lowest = f"F{parts.lowest / unit:g}"
        yield f"F is lower in {parts.limited} of them, down to {lowest}, {_WHY_LOWER[parts.by]}"


def _on_entry(trace: Trace, section: Section) -> Iterator[str]:
    axis = trace.machine.polar.rotary_address
    if section.entry is not None:
        line = trace.line(section.entry.behind)
        yield f"behind line {line} {axis} goes to 0 above the part, and back in the mode: --keep-c leaves it there"
    elif not trace.machine.polar.plane_is_fixed:
        angle = float(trace.path.c_angle_before[section.stretch.first])
        if abs(angle - 360 * round(angle / 360)) > _AT_ZERO:
            yield f"its coordinates are turned by {axis}{angle:g}, where {axis} stands when the mode is switched on"
