"""Phrases of the rules about entering and leaving the mode, and what may stand between."""

from __future__ import annotations

import itertools
from collections.abc import Iterator

from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.other_mode import OtherMode
from polarcheck.columns.modes.procedure import Procedure
from polarcheck.columns.modes.switch_slips import SwitchSlips
from polarcheck.columns.modes.switch_words import SwitchWords
from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.compensation import CutterCompensation
from polarcheck.columns.path.infeed import Infeed
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.words.angles import Angles
from polarcheck.foundation.arrays import Floats, Rows
from polarcheck.foundation.states import Motion, Side
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.axes import NOT_NAMED, listed
from polarcheck.program.machines.codes import spelled
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown
from polarcheck.rules.other_machine import NAMED, OtherMachine
from polarcheck.rules.places import block_in_line
from polarcheck.rules.quantity import in_row
from polarcheck.rules.remedies import enumerated, is_chosen, place
from polarcheck.rules.wording.phrases.common import (
    block_and_line,
    codes,
    executed_word,
    line_code,
    linear,
    outside,
    switch_off,
    written,
)

#: What the codes of a list of G-code system B are in system A, and what stands for them there.
_IN_SYSTEM_A = {
    "absolute": "a turning cycle in G-code system A, where {axes} are absolute and {increments} incremental",
    "incremental": "no code of G-code system A, where {increments} incremental",
    "feed_per_minute": "a facing cycle in G-code system A, where {codes} is feed per minute",
    "feed_per_revolution": "no code of G-code system A, where {codes} is feed per revolution",
}
#: What Z does in one block with axes of the plane, by polar.other_axes.
_OF_Z = {
    "independent": "Z moves on its own there, not on the line in space",
    "together": "compensation may take it for one more corner",
    "forbidden": "this lathe cannot move Z together with the plane",
}
#: More words of a block are counted, not listed.
_LISTED = 6
#: Names of axes that are told one by one; a hostile file has any number of them.
_NAMES = 20
#: Of a block that is named; more is cut off [characters].
_BLOCK_LENGTH = 60
#: Modal groups that must have ended at G12.1, by the list of the codes that begin them.
_ENDED = {"scaling": "scaling", "rotation": "rotation", "mirror_image": "mirror", "constant_surface_speed": "speed"}


def instead_of_rapid(compensation: CutterCompensation, machine: Machine, row: int) -> str:
    """What to write for G0 in the mode: within a contour G1 with its F, else a high one."""
    line = line_code(machine)
    if compensation.compensates[row] and not compensation.starts_up[row]:
        return f"this block lies in a contour with G{compensation.side[row]}: write {line} and leave F as it is"
    return f"write {line} with a high F"


def missing_before(blocks: ExecutedBlocks, mode: PolarMode, run: Run, machine: Machine, index: int) -> str:
    """Where the G13.1 of a section is missing."""
    sections = mode.sections
    row = int(sections.leave[index])
    off = switch_off(blocks, machine, int(sections.enter[index]))
    if row >= len(blocks) or blocks.starts[row]:
        return f"{off} is missing at the end of the program"
    return f"{off} is missing before line {int(blocks.line[row])}, {block_in_line(run, row, _BLOCK_LENGTH)}"


def others(run: Run, at: list[int]) -> str:
    """The words at fault as they are written."""
    more = f" and {len(at) - _LISTED} more" if len(at) > _LISTED else ""
    return " ".join(executed_word(run, index) for index in at[:_LISTED]) + more


def what_z_does(machine: Machine) -> str:
    """What Z does in one block with the axes of the plane, or what comes of it."""
    return _OF_Z[machine.polar.other_axes]


def since(blocks: ExecutedBlocks, mode: PolarMode, row: int) -> int:
    """The line of the G12.1 of this row's section."""
    return int(blocks.line[mode.sections.enter[mode.section[row]]])


def plane(modal: ModalStates, row: int) -> str:
    """The plane in force, as in G18."""
    return f"G{modal.state('plane')[row]}"


def wanted(machine: Machine) -> str:
    """The planes that the profile wants."""
    return " or ".join(machine.polar.plane_before)


def side(compensation: CutterCompensation, row: int) -> str:
    """G41 or G42, whichever was in force before."""
    return f"G{compensation.side_before[row]}"


def _states(modal: ModalStates, machine: Machine, row: int) -> list[tuple[str, str]]:
    """The codes in force in a row that should have ended, each with the code that ends it."""
    cycle = int(modal.drilling[row])
    found = [(spelled("G", cycle * 10), " or ".join(machine.codes("drilling_cycle_off")))] if cycle else []
    for key, group in _ENDED.items():
        pairs = zip(machine.codes(key), machine.codes(f"{key}_off"), strict=False)
        found += [(on, off) for on, off in pairs if modal.has_state(group, [on])[row]]
    return found


def in_force(modal: ModalStates, machine: Machine, row: int) -> str:
    """What should have ended before G12.1."""
    return ", ".join(name for name, _ in _states(modal, machine, row))


def ends(modal: ModalStates, machine: Machine, row: int) -> str:
    """What ends it."""
    return ", ".join(name for _, name in _states(modal, machine, row))


def meaning(run: Run, machine: Machine, at: list[int]) -> str:
    """The first word at fault and what it means in this G-code system."""
    word = run.words
    address = chr(int(word.address[at[0]]))
    name = spelled("G", round(float(word.value[at[0]]) * 10)) if address == "G" else address
    axis, increment = machine.polar.rotary_words
    both = f"U and {increment} are" if increment else "U is"
    of_axes = {"axes": f"X and {axis}", "increments": both}
    for key, text in _IN_SYSTEM_A.items():
        if name in getattr(machine.g_code_system_b, key):
            return f"{name} is {text.format_map(of_axes | {'codes': next(iter(machine.codes(key)), '')})}"
    system, axes = machine.control.g_code_system, of_axes["axes"]
    return f"{name} is no incremental word of G-code system {system}, where G91 makes {axes} incremental"


def taken_by(
    blocks: ExecutedBlocks,
    run: Run,
    axes: PlaneAxes,
    modal: ModalStates,
    mode: PolarMode,
    machine: Machine,
    job: Job,
    other_machine: OtherMachine,
    at: list[int],
    row: int,
) -> str:
    """
    Which machines read the whole program well; where none does, which word beside G12.1 or controls take it.

    Where somebody has chosen the machine, what to write on it. A word that positions the rotary axis under another name
    (SPOS=0) is none of the plane on any control.
    """
    polar = machine.polar
    name, equals, _ = executed_word(run, at[0]).upper().partition("=")
    if equals and not name.startswith(polar.rotary_address):
        is_main = modal.main_is_master[row] or "[" in name
        turned = f"the spindle, which is the {polar.rotary_address} axis of the mode" if is_main else "another spindle"
        what = f"{name} positions {turned}"
        return f"; {what}: write it {outside(blocks, mode, machine, row)}"
    number, of_address = int(run.words.address[at[0]]), machine.address_number
    choosing = next(
        (word for word, pair in polar.virtual_axis_by_word.items() if number in map(of_address, filter(None, pair))), ""
    )
    if choosing:
        return f"; beside {choosing} it would be"
    if is_chosen(machine, job):
        return f"; write {axes.virtual_axis_of(row)}"
    controls = polar.other_controls
    return other_machine.text or (f"; {controls} would take it" if controls else "")


def begun_by(other_mode: OtherMode, row: int) -> str:
    """The code or word of another control that begins its mode."""
    return other_mode.switch(row).name


def on_of_this(machine: Machine) -> str:
    """What begins the mode on this machine, in its own language."""
    return " or ".join(shown(machine.control.native_words, code) for code in machine.polar.on)


def instead(other_mode: OtherMode, machine: Machine, job: Job, row: int) -> str:
    """
    What is to be written for the code of another control: `write G112 for G12.1, G113 for G13.1 and Y for C`.

    Where nobody has chosen the machine, the machines that know the code: `check it with --machine fanuc or gsk-988`.
    """
    machines = other_mode.machines(row)
    if not is_chosen(machine, job):
        return f"check it with --machine {enumerated([profile.name for profile in machines[:NAMED]], 'or')}"
    polar, native = machine.polar, machine.control.native_words
    angle = f" {polar.direction_word}0" if polar.direction_word else ""
    words = [f"{shown(native, polar.on[0])}{angle} for {other_mode.switch(row).name}"]
    words += [f"{shown(native, polar.off[0])} for {name}" for name in other_mode.ends_written(row)]
    axes = other_mode.other_axes_written(row)
    words += [f"{polar.virtual_axis} for {axis}" for axis in axes]
    if axes and all(profile.machine.polar.x != polar.x for profile in machines):
        words.append(f"X as a {polar.x}")
    return f"write {enumerated(words, 'and')}"


def else_a_macro(other_mode: OtherMode, row: int) -> str:
    """What else it may be, where nothing behind it tells."""
    return "" if other_mode.is_meant[row] else ", unless it is a macro of the builder"


def axes_not_followed(
    blocks: ExecutedBlocks, axes: PlaneAxes, mode: PolarMode, run: Run, machine: Machine
) -> Iterator[tuple[str, int]]:
    """Which axes of the polar plane are not followed, and in how many blocks."""
    polar, names_of_axes = machine.polar, machine.control.axes
    other = mode.enters & axes.enters_other_axes
    unknown = mode.enters & ~axes.linear_is_known & ~other
    named = unknown & blocks.has("P") & ("P" in polar.words_beside_switch)
    names = place(machine, 'control.axes = ["X", "Z", "C"]')
    remedy = "look at it on the control" if names_of_axes else f"give their names in order, as {names}"
    for rows, what in (
        (named, f"P beside {polar.on[0]}"),
        (unknown & ~named, f"{polar.linear_axis}, the number in {_linear_axis_key(machine)},"),
    ):
        yield f"{what} is a linear axis that is not known, nothing of the section is judged: {remedy}", int(rows.sum())
    beside = [int(index) for index in axes.words_not_simulated.nonzero()[0] if mode.enters[run.row[index]]]
    for name, indices in itertools.groupby(beside, lambda index: executed_word(run, index)):
        effect = "makes another mode of it, which is not simulated: look at the section on the control"
        yield f"{name} beside {polar.on[0]} {effect}", len(list(indices))
    planes = (axes.selects_plane_not_simulated & mode.in_polar).nonzero()[0]
    if len(planes):
        where = block_and_line(blocks, run, int(planes[0]))
        yield f"the plane of {where} is not simulated: look at the section on the control", len(planes)
    other = mode.enters & (axes.rotary_number != polar.rotary_axis)
    effect = "its angle at the switch and its limits are not followed: look at them on the control"
    yield f"Q names another rotary axis than {polar.rotary_axis}; {effect}", int(other.sum())


def _linear_axis_key(machine: Machine) -> str:
    """Where the number of the linear axis was given: `parameter 5460`, else the key of the profile."""
    key, number = "polar.linear_axis", machine.polar.linear_axis
    given = [name for name, value in machine.parameters.items() if value == number]
    names = [name for name in given if name in machine.known_parameters and machine.known_parameters[name].key == key]
    return f"parameter {names[0]}" if names else key


def names_not_known(blocks: ExecutedBlocks, run: Run) -> Iterator[tuple[str, int]]:
    """The names of axes that the machine does not have, as in C5=10., and in how many blocks each stands."""
    remedy = 'add it to control.named_axes with the address that it is, or with "" for an axis that does not matter'
    yield from _by_name(
        blocks, run, blocks.words_not_named, f"is an axis that this lathe is not known to have: {remedy}"
    )
    other = blocks.words_of_no_axis
    yield from _by_name(blocks, run, other, "is no word of this lathe, and not read: give --machine, or mend it")


def names_not_followed(blocks: ExecutedBlocks, axes: PlaneAxes, mode: PolarMode, run: Run) -> Iterator[tuple[str, int]]:
    """The axes of the machine that stand in sections and are not followed, and in how many of their blocks."""
    words = blocks.words_not_followed
    words = words[mode.section[run.row[words]] >= 0]
    words = words[(run.words.address[words] != NOT_NAMED) & ~blocks.words_at(axes.virtual_words)[words]]
    is_judged = mode.is_followed[run.row[words]]
    remedy = "look at it on the control, or give it as polar.rotary_address where it is the axis of the mode"
    yield from _by_name(blocks, run, words[is_judged], f"is not followed, its section is judged without it: {remedy}")
    yield from _by_name(blocks, run, words[~is_judged], f"is not followed, nothing of its section is judged: {remedy}")


def _by_name(blocks: ExecutedBlocks, run: Run, words: Rows, what: str) -> Iterator[tuple[str, int]]:
    """What is said of each name of an axis among some words, from the line where it stands first; and its blocks."""
    rows_by_name: dict[str, list[int]] = {}
    for index in words.tolist():
        name = executed_word(run, index).partition("=")[0].upper()
        rows_by_name.setdefault(name, []).append(int(run.row[index]))
    for name, rows in list(rows_by_name.items())[:_NAMES]:
        yield f"{name}, from line {int(blocks.line[rows[0]])} on, {what}", len(set(rows))
    more = [row for rows in list(rows_by_name.values())[_NAMES:] for row in rows]
    yield f"each of {len(rows_by_name) - _NAMES} more axes {what}", len(set(more))


def on_sub_spindle(
    blocks: ExecutedBlocks, axes: PlaneAxes, mode: PolarMode, compensation: CutterCompensation, machine: Machine
) -> Iterator[tuple[str, int]]:
    """Which sections stand on the sub-spindle, of which the machine does not say how it is programmed."""
    other, open_sides = (
        mode.enters & axes.enters_other_axes,
        compensation.sides_are_open & compensation.compensates,
    )
    title = machine.title
    for rows, what in (
        (other, f"whose axes have other addresses on {title}; nothing of it is judged: look at it on the control"),
        (
            open_sides,
            'and on which side G41 and G42 are there is not known: polar.sub_spindle_plane = "as-main" in a file '
            "of your own says that it is programmed as the main spindle is",
        ),
    ):
        if rows.any():
            line = int(blocks.line[mode.sections.enter[mode.section[rows.argmax()]]])
            yield f"the section of line {line} is on the sub-spindle, {what}", int(rows.sum())


def not_simulated(infeed: Infeed) -> Iterator[tuple[str, int]]:
    """What of an infeed cycle is not simulated, and in how many blocks."""
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


def absolute(switch_words: SwitchWords) -> str:
    """The absolute words of a shift, those of the linear and the rotary axis."""
    return " and ".join(switch_words.shifts)


def axis_fault(blocks: ExecutedBlocks, axes: PlaneAxes, machine: Machine, switch_words: SwitchWords, row: int) -> str:
    """Why P or Q of a G12.1 are no pair of axes."""
    if blocks.with_words(switch_words.names_axis_of_other_kind)[row]:
        return f"P is the number of a linear axis and Q that of a rotary one, of {listed(machine.control.axes)}"
    if not blocks.with_words(switch_words.names_no_axis)[row]:
        both = f"would be both the linear and the rotary axis; without P it is {machine.polar.linear_axis}"
        return f"axis {axes.axes_written[0][row]:.0f} {both}, without Q {machine.polar.rotary_axis}"
    return f"no such axis; P and Q take whole numbers from 1 to {switch_words.trace.axes.most_axes}"


def infeed_fault(lengths: Lengths, switch_words: SwitchWords, row: int) -> str:
    """What the control makes of an infeed that its word cannot hold."""
    infeed = switch_words.infeed
    if switch_words.infeed_too_large[row]:
        return f"is too large: {_every_digit(switch_words.infeed_limit, lengths, row)} is the most"
    least, taken = (_every_digit(column, lengths, row) for column in (lengths.least_step, infeed.depth))
    once = "" if infeed.depth[row] > 0 else ", which is a single pass"
    return f"is finer than the least increment, {least}: {taken} is taken{once}"


def _every_digit(column: Floats, lengths: Lengths, row: int) -> str:
    """A length with all the digits that a control can hold."""
    shown = in_row(float(column[row]), lengths, row)
    return f"{shown.length(shown.value):.10g} {shown.unit}"


def misfit_of_pass(
    blocks: ExecutedBlocks, lengths: Lengths, compensation: CutterCompensation, run: Run, infeed: Infeed, row: int
) -> str:
    """From where on the passes of an infeed cycle do not fit, and into what."""
    offset, at = infeed.least_unfit[row]
    radius = abs(float(compensation.radius[at]))
    tool = f" with R {in_row(radius, lengths, row):length}" if radius > 0 and compensation.compensates[at] else ""
    where = f"line {int(blocks.line[at])}, {block_in_line(run, at, _BLOCK_LENGTH)}"
    return f"already {in_row(offset, lengths, row):length} off it{tool} there is no way along {where}"


def first_axis(axes: PlaneAxes, mode: PolarMode, index: int) -> str:
    """The linear axis of a section."""
    return linear(axes, int(mode.sections.enter[index]))


def what(mode: PolarMode, machine: Machine, arcs: Arcs, index: int) -> str:
    """What becomes of a section without the second axis."""
    off = int(mode.count_in_section(arcs.is_no_circle)[index])
    return (
        f"and {off} arcs are no circles"
        if off > 1
        else f"through the center of the {machine.polar.rotary_address} axis"
    )


def slip(switch_slips: SwitchSlips, blocks: ExecutedBlocks, run: Run, machine: Machine, row: int) -> str:
    """What a misspelled switch of the mode does, and what to write; or where the codes of the builder belong."""
    found = switch_slips.slips[row]
    words = [index for index in switch_slips.words.nonzero()[0].tolist() if run.row[index] in (row, found.answer)]
    names = [executed_word(run, index) for index in words]
    mode, line = machine.polar, int(blocks.line[found.answer])
    if found.is_of_builder:
        on, off = (
            ", ".join(f'"{one}"' for one in (*known, code))
            for known, code in ((mode.on[:1], names[0]), (mode.off[:1], names[-1]))
        )
        keys = place(machine, f"polar.on = [{on}] and polar.off = [{off}]")
        effect = f"begins and {names[-1]} ends no polar mode that {machine.title} has"
        return f"{names[0]} {effect}: if they do on this lathe, write {keys}; the contour is not looked at till then"
    if found.meant in mode.off:
        return f"{names[0]} does not end the polar mode; write {found.meant}"
    answer = f", and {switch_slips.meant_in(found.answer)} for {names[-1]} in line {line}" if found.answer >= 0 else ""
    return f"{names[0]} begins no polar mode, and the contour behind it is not looked at; write {found.meant}{answer}"


def not_understood(blocks: ExecutedBlocks, other_mode: OtherMode) -> tuple[str, int]:
    """Which code may begin the mode of another control, of which nothing is looked at, and in how many blocks."""
    rows = other_mode.may_be_macro.nonzero()[0]
    if not len(rows):
        return "", 0
    code, line = other_mode.switch(int(rows[0])).name, int(blocks.line[rows[0]])
    reason = (
        f"{code} in line {line} begins the polar mode on another control, or is a macro of the builder: give --machine"
    )
    return f"{reason}, or take it out of polar.on_of_other_controls", len(rows)


def extrudes(blocks: ExecutedBlocks, mode: PolarMode, run: Run) -> tuple[str, int]:
    """Where a move has an E, which no control of a lathe takes there, and in how many blocks."""
    rows = mode.extrudes.nonzero()[0]
    if not len(rows):
        return "", 0
    where = f"{written(blocks, run, int(rows[0]), 'E')} in line {int(blocks.line[rows[0]])}"
    return f"{where} is no word of a move on a lathe: convert the file, or delete E", len(rows)


def contours_outside(blocks: ExecutedBlocks, mode: PolarMode) -> tuple[str, int]:
    """Where a contour is cut outside the mode with C in degrees, which is not simulated, and in how many blocks."""
    rows = mode.contours_outside.nonzero()[0]
    if not len(rows):
        return "", 0
    line = int(blocks.line[rows[0]])
    reason = f"a contour outside the polar mode, with C in degrees, from line {line} on, is not simulated"
    return f"{reason}: look at it on the control", len(rows)


def on_cylinder(blocks: ExecutedBlocks, mode: PolarMode) -> tuple[str, int]:
    """Where cylindrical interpolation is begun, which is not simulated, and in how many blocks it is in force."""
    rows = mode.on_cylinder.nonzero()[0]
    if not len(rows):
        return "", 0
    reason = f"cylindrical interpolation, from line {int(blocks.line[rows[0]])} on, is not simulated"
    return f"{reason}: look at it on the control", len(rows)


def shifted_by(run: Run, row: int, at: list[int]) -> str:
    """What shifts the origin: codes, as in G55, or the variable of a work offset."""
    return codes(run, at) if at else run.assigned[row].name


def where(blocks: ExecutedBlocks, mode: PolarMode, machine: Machine, row: int) -> str:
    """Where a code belongs that the mode does not take; beside a drilling cycle C is an angle there."""
    is_cycle = blocks.listed("drilling_cycle")[row]
    axis = machine.polar.rotary_address
    return outside(blocks, mode, machine, row) + (f", where its {axis} is an angle again" if is_cycle else "")


def begins(angles: Angles, row: int) -> str:
    """What a word that looks like an angle does: it is one length, or a step to one."""
    if not angles.in_series[row]:
        return "is"
    series = angles.series
    count = int(series.in_rows(series.count.astype(float), len(angles.trace))[row])
    return f"is one of {count} steps at nearly the same X to"


def turned(
    blocks: ExecutedBlocks,
    axes: PlaneAxes,
    compensation: CutterCompensation,
    machine: Machine,
    procedure: Procedure,
    row: int,
) -> str:
    """From which line on the virtual axis moves as on a contour, and what tells so."""
    first = int(procedure.contour_without_mode[row])
    axis, line = machine.polar.virtual_axis, int(blocks.line[first])
    if compensation.side[first] != Side.OFF:
        return f"from line {line} on {axis} moves at feed with G41 or G42"
    if axes.motion[first] != Motion.LINE:
        return f"from line {line} on {axis} moves on an arc"
    return f"from line {line} on X and {axis} move at feed right up to it"
