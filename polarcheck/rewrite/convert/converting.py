"""A program for another control: `converted` writes it anew by the facts of both profiles, and reads it back."""

from __future__ import annotations

import re
from collections.abc import Container, Iterator, Mapping, Sequence

import numpy as np
from msgspec.structs import replace

from polarcheck.checking.settings import Settings
from polarcheck.foundation.states import Units
from polarcheck.program.machines.job import Job
from polarcheck.rewrite.convert.around import write_around
from polarcheck.rewrite.convert.channel_marks import write_channel_marks
from polarcheck.rewrite.convert.converted_sections import write_sections
from polarcheck.rewrite.convert.doubtful_values import SENSE_OF_Z, doubts, note_on_units, said, unaccepted
from polarcheck.rewrite.convert.new_program import NewProgram
from polarcheck.rewrite.convert.translating import Translation
from polarcheck.rewrite.writing.new_blocks import (
    NewBlock,
    decision_comment,
    edit_before,
    edit_behind,
    edits_of,
    edits_of_signs,
    with_edits,
)
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Decision, Figure, Outcome, Refusal, RefusedError
from polarcheck.rewrite.writing.reading_back import OF_ORDERS, ReadBack, read_back, require_equal
from polarcheck.rewrite.writing.style import Style
from polarcheck.rewrite.writing.style_of import style_of
from polarcheck.rules.editing import Replace

#: A decision on an M code.
_M_CODE = re.compile(r"M\d+\b")


def converted(original: Original, target: Settings, accepted: Container[str] = ()) -> Outcome:
    """
    Return a program as the machine of `target` reads it: its polar sections, and as much around them as both profiles
    know. The others are comments in it, and decisions of the outcome.

    target: machine, job and encoding of the new program; offsets of the job are those that the original calls.
    accepted: keys of the profiles whose values in doubt numbers may rest on, where they differ.

    Raises RefusedError where the new program would not do the same, or cannot be written; TooHardError.
    """
    trace = original.trace
    translation = Translation(original, target)
    style = style_of(trace)
    new = NewProgram()
    write_sections(original, target.machine, style, translation, new)
    write_around(original, target, translation, new)
    notes_on_marks = write_channel_marks(original, target, new)
    edits = edits_of(original, new.blocks, style, target.machine)
    edits += [edit_before(original, block, blocks, style, target.machine) for block, blocks in new.before.items()]
    edits += [edit_behind(original, block, blocks, style, target.machine) for block, blocks in new.behind.items()]
    edits += [*new.edits, *edits_of_signs(original, target.machine)]
    in_doubt = list(doubts(translation.measures.basis, trace, original.settings, target))
    if reasons := unaccepted(in_doubt, accepted):
        raise RefusedError(reasons)
    data, origin = with_edits(original, edits)
    settings = replace(target, job=_job(original, target, translation))
    if sense := next((doubt.value for doubt in in_doubt if doubt.key == SENSE_OF_Z), ""):
        # Somebody has said that Z as it stands is right there.
        control = replace(target.machine.control, z_into_part=sense)
        settings = replace(settings, machine=replace(target.machine, control=control))
    # Speeds are compared word by word: S of before stays in force beside P of M133.
    is_other_spindle = bool(new.decided) or bool(translation.roles.of_live_tool.any())
    states = {"speed", *(("spindle", "live_tool") if is_other_spindle else ())}
    result = read_back(
        original,
        data,
        settings,
        origin,
        new.decided,
        rapid_as_line=new.rapid_as_line,
        other_states=states,
        added_speeds=translation.added_speeds,
    )
    _require_equal(result, original, target)
    decisions = sorted(dict.fromkeys(new.decisions), key=lambda decision: decision.line)
    # What an M code is that is to be decided says whether the live tool runs.
    is_explained = any(_M_CODE.match(decision.text) for decision in decisions)
    open_orders = [
        order for order in result.open_orders if not (is_explained and order.text.partition(" ")[0] in OF_ORDERS)
    ]
    if open_orders:
        edits += _remarks(original, target, style, open_orders)
        data, origin = with_edits(original, edits)
        decisions += [Decision(order.line, order.text) for order in open_orders]
    figures = [
        Figure("blocks before", float(trace.run.block_count)),
        Figure("blocks after", float(result.new.trace.run.block_count)),
        Figure("largest distance of the tool center paths", result.deviation, "mm"),
    ]
    notes = [f"line {doubt.line}: {said(doubt)}: accepted" for doubt in in_doubt]
    notes += [*note_on_units(trace, original.settings, target), *notes_on_marks, *_notes(translation.notes)]
    notes += [*new.notes, *result.notes]
    notes += [
        f"line {line}: O{number} is not in the file: convert it, too"
        for number, line in translation.calls.missing.items()
    ]
    return Outcome(data, origin, decisions, figures, notes, in_doubt)


def _remarks(original: Original, target: Settings, style: Style, open_orders: Sequence[Refusal]) -> Iterator[Replace]:
    """Yield edits that put comments on orders that are to be decided before the sections that need them."""
    trace = original.trace
    for order in open_orders:
        row = int(np.argmax(trace.blocks.line_in_file == order.line))
        section = int(trace.mode.whole_section[row])
        row = int(trace.mode.sections.enter[section]) if section >= 0 else row
        _, _, text = order.text.partition(" of the result: ")
        remark = NewBlock((), decision_comment(text.replace("this cutting move", "the section")))
        yield edit_before(original, int(trace.run.block[row]), [remark], style, target.machine)


def _require_equal(result: ReadBack, original: Original, target: Settings) -> None:
    """Raise RefusedError if the new program differs; with what helps where only the way round corners does."""
    ours, theirs = original.settings.machine, target.machine
    is_compensated = bool(original.trace.compensation.compensates.any())
    if is_compensated and ours.compensation.corner != theirs.compensation.corner:
        how = "goes round outer corners otherwise: `polarcheck compensate --center` writes the path of the tool center,"
        corners = f"{theirs.title} {how} which can be converted"
        reasons = [
            Refusal(difference.line, f"{difference.text}: {corners}")
            for difference in result.differences
            if "path differs" in difference.text
        ]
        if reasons:
            raise RefusedError(reasons)
    require_equal(result)


def _job(original: Original, target: Settings, translation: Translation) -> Job:
    """The job of the new program: lengths in the units of the original, offsets as the new T words call them."""
    job = translation.tools.job(target.job)
    if job.units or not len(original.trace):
        return job
    # Lengths of a job are in the units of the program: those in force at its end.
    is_inch = bool(original.trace.lengths.units[-1] == Units.INCH)
    return replace(job, units="inch" if is_inch else "mm")


def _notes(notes: Mapping[str, int]) -> list[str]:
    return [f"line {line}: {text}" for text, line in notes.items()]
