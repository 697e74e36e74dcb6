"""Which axes, sections and contours are not followed, and in how many blocks, for the reader of a report."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

import numpy as np

from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.turning_tools import z_into_part
from polarcheck.columns.modes.other_mode import OtherMode
from polarcheck.columns.path.infeed import Infeed
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.machines.axis_table import NOT_NAMED
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.remedies import place
from polarcheck.rules.wording.written import block_and_line, executed_word, written

#: Names of axes that are listed one by one; a hostile file has any number of them.
_NAMES = 20


def axes_not_followed(trace: Trace) -> Iterator[tuple[str, int]]:
    """Which axes of the polar plane are not followed, and in how many blocks."""
    polar, names_of_axes = trace.machine.polar, trace.machine.control.axes
    other_axes = trace.mode.enters & trace.axes.enters_other_axes
    unknown = trace.mode.enters & ~trace.axes.linear_is_known & ~other_axes
    named = unknown & trace.blocks.has("P") & ("P" in polar.words_beside_switch)
    names = place(trace.machine, 'control.axes = ["X", "Z", "C"]')
    remedy = "look at it on the control" if names_of_axes else f"give their names in order, as {names}"
    for rows, what in (
        (named, f"P beside {polar.on[0]}"),
        (unknown & ~named, f"{polar.linear_axis}, the number in {_linear_axis_key(trace.machine)},"),
    ):
        yield f"{what} is a linear axis that is not known, nothing of the section is judged: {remedy}", int(rows.sum())
    words = [
        int(index) for index in trace.axes.words_not_simulated.nonzero()[0] if trace.mode.enters[trace.run.row[index]]
    ]
    for name, indices in itertools.groupby(words, lambda index: executed_word(trace.run, index)):
        effect = "makes another mode of it, which is not simulated: look at the section on the control"
        yield f"{name} beside {polar.on[0]} {effect}", len(list(indices))
    planes = (trace.axes.selects_plane_not_simulated & trace.mode.in_polar).nonzero()[0]
    if len(planes):
        where = block_and_line(trace, int(planes[0]))
        yield f"the plane of {where} is not simulated: look at the section on the control", len(planes)
    other_axes = trace.mode.enters & (trace.axes.rotary_number != polar.rotary_axis)
    effect = "its angle at the switch and its limits are not followed: look at them on the control"
    yield f"Q names another rotary axis than {polar.rotary_axis}; {effect}", int(other_axes.sum())


def _linear_axis_key(machine: Machine) -> str:
    """Where the number of the linear axis was given: `parameter 5460`, else the key of the profile."""
    key, number = "polar.linear_axis", machine.polar.linear_axis
    given = [name for name, value in machine.parameters.items() if value == number]
    names = [name for name in given if name in machine.known_parameters and machine.known_parameters[name].key == key]
    return f"parameter {names[0]}" if names else key


def names_not_known(trace: Trace) -> Iterator[tuple[str, int]]:
    """The names of axes that the machine does not have, as in C5=10., and in how many blocks each stands."""
    remedy = 'add it to control.named_axes with the address that it is, or with "" for an axis that does not matter'
    yield from _by_name(
        trace, trace.blocks.words_not_named, f"is an axis that this lathe is not known to have: {remedy}"
    )
    indices = trace.blocks.words_of_no_axis
    yield from _by_name(trace, indices, "is no word of this lathe, and not read: give --machine, or mend it")


def names_not_followed(trace: Trace) -> Iterator[tuple[str, int]]:
    """The axes of the machine that stand in sections and are not followed, and in how many of their blocks."""
    words = trace.blocks.words_not_followed
    words = words[trace.mode.section[trace.run.row[words]] >= 0]
    words = words[
        (trace.run.words.address[words] != NOT_NAMED) & ~trace.blocks.words_at(trace.axes.virtual_words)[words]
    ]
    is_judged = trace.mode.is_followed[trace.run.row[words]]
    remedy = "look at it on the control, or give it as polar.rotary_address where it is the axis of the mode"
    yield from _by_name(trace, words[is_judged], f"is not followed, its section is judged without it: {remedy}")
    yield from _by_name(trace, words[~is_judged], f"is not followed, nothing of its section is judged: {remedy}")


def _by_name(trace: Trace, words: Rows, what: str) -> Iterator[tuple[str, int]]:
    """The reason for each name of an axis among some words, with its first line; and the number of its blocks."""
    rows_by_name: dict[str, list[int]] = {}
    for index in words.tolist():
        name = executed_word(trace.run, index).partition("=")[0].upper()
        rows_by_name.setdefault(name, []).append(int(trace.run.row[index]))
    for name, rows in list(rows_by_name.items())[:_NAMES]:
        yield f"{name}, from line {int(trace.blocks.line[rows[0]])} on, {what}", len(set(rows))
    more = [row for rows in list(rows_by_name.values())[_NAMES:] for row in rows]
    yield f"each of {len(rows_by_name) - _NAMES} more axes {what}", len(set(more))


def on_sub_spindle(trace: Trace) -> Iterator[tuple[str, int]]:
    """Which sections stand on the sub-spindle, of which the machine does not say how it is programmed."""
    other_axes, open_sides = (
        trace.mode.enters & trace.axes.enters_other_axes,
        trace.compensation.sides_are_open & trace.compensation.compensates,
    )
    title = trace.machine.title
    for rows, what in (
        (other_axes, f"whose axes have other addresses on {title}; nothing of it is judged: look at it on the control"),
        (
            open_sides,
            'and on which side G41 and G42 are there is not known: polar.sub_spindle_plane = "as-main" in a file '
            "of your own says that it is programmed as the main spindle is",
        ),
    ):
        if rows.any():
            line = int(trace.blocks.line[trace.mode.sections.enter[trace.mode.section[rows.argmax()]]])
            yield f"the section of line {line} is on the sub-spindle, {what}", int(rows.sum())


def depths_not_known(trace: Trace) -> Iterator[tuple[str, int]]:
    """The sections of which nobody knows which way along Z the part lies: a sub-spindle has a Z of its own."""
    unknown = "what is above and below {} face is not known"
    if len(trace.mode.sections) and not z_into_part(trace):
        yield (
            f"control.z_into_part is {trace.machine.control.z_into_part}, and turning cuts the other way along Z: "
            + unknown.format("the"),
            len(trace.mode.sections),
        )
    rows = np.flatnonzero(trace.mode.enters & trace.modal.on_sub_spindle & ~trace.axes.enters_other_axes)
    if len(rows):
        line = int(trace.blocks.line[rows[0]])
        yield f"the section of line {line} is on the sub-spindle: {unknown.format('its')}", len(rows)


def face_not_known(trace: Trace, bar: Bar) -> Iterator[tuple[str, int]]:
    """The sections of a known bar whose face is not known, and of which none cuts below Z0."""
    if not len(trace.mode.sections) or bar.known.source == "none" or not np.isnan(bar.known.face):
        return
    z = bar.trace.path.z[trace.mode.in_polar & trace.path.cuts]
    if np.isfinite(z).any() and np.nanmin(z) >= -ROUNDING:
        yield (
            "the face of the bar is not known, and no section cuts below Z0: where cutters go into the bar was not "
            "looked at; give [stock] face",
            len(trace.mode.sections),
        )


def not_simulated(infeed: Infeed) -> Iterator[tuple[str, int]]:
    """Each part of an infeed cycle that is not simulated, and in how many blocks."""
    partly = int(infeed.is_simulated_in_part.sum())
    yield (
        "of an infeed cycle only the passes next to the contour are simulated: look at the others on the control",
        partly,
    )
    yield (
        "the infeed cycle of a section is simulated for its first contour only: program each contour in a section of "
        "its own",
        int(infeed.has_further_contour.sum()),
    )


def not_understood(trace: Trace, other_mode: OtherMode) -> tuple[str, int]:
    """Which code may begin the mode of another control, of which nothing is looked at, and in how many blocks."""
    rows = other_mode.may_be_macro.nonzero()[0]
    if not len(rows):
        return "", 0
    code, line = other_mode.switch(int(rows[0])).name, int(trace.blocks.line[rows[0]])
    reason = (
        f"{code} in line {line} begins the polar mode on another control, or is a macro of the builder: give --machine"
    )
    return f"{reason}, or take it out of polar.on_of_other_controls", len(rows)


def extrudes(trace: Trace) -> tuple[str, int]:
    """Where a move has an E, which no control of a lathe takes there, and in how many blocks."""
    rows = trace.mode.extrudes.nonzero()[0]
    if not len(rows):
        return "", 0
    where = f"{written(trace.blocks, trace.run, int(rows[0]), 'E')} in line {int(trace.blocks.line[rows[0]])}"
    return f"{where} is no word of a move on a lathe: convert the file, or delete E", len(rows)


def contours_outside(trace: Trace) -> tuple[str, int]:
    """Where a contour is cut outside the mode with C in degrees, which is not simulated, and in how many blocks."""
    rows = trace.mode.contours_outside.nonzero()[0]
    if not len(rows):
        return "", 0
    line = int(trace.blocks.line[rows[0]])
    reason = f"a contour outside the polar mode, with C in degrees, from line {line} on, is not simulated"
    return f"{reason}: look at it on the control", len(rows)


def left_by_caller(trace: Trace) -> tuple[str, int]:
    """Where M99 of a program that nothing here calls leaves the mode on, and how many sections it leaves so."""
    sections, code = trace.mode.sections, trace.machine.macro.program_returns
    open_at_end = trace.blocks.mask_of(sections.last[sections.returned] + 1) | trace.blocks.mask_of(sections.last)
    rows = (open_at_end & trace.blocks.codes(*code) & (trace.run.depth == 0)).nonzero()[0]
    if not len(rows):
        return "", 0
    reason = f"{block_and_line(trace, int(rows[0]))} leaves the polar mode on: {trace.machine.polar.off[0]} and what"
    return f"{reason} follows stand in no program here: check the program that calls this one", len(rows)


def on_cylinder(trace: Trace) -> tuple[str, int]:
    """Where cylindrical interpolation is begun, which is not simulated, and in how many blocks it is in force."""
    rows = trace.mode.on_cylinder.nonzero()[0]
    if not len(rows):
        return "", 0
    reason = f"cylindrical interpolation, from line {int(trace.blocks.line[rows[0]])} on, is not simulated"
    return f"{reason}: look at it on the control", len(rows)
