"""Phrases of the rules about the state of the lathe around the section."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.entry import Entry
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.offsets import ToolOffsets
from polarcheck.columns.modes.procedure import Procedure
from polarcheck.columns.modes.spindles import Spindles
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.quantity import in_row
from polarcheck.rules.remedies import place, unlisted_codes
from polarcheck.rules.wording.phrases.common import block_and_line, code_of, executed_word, short, written
from polarcheck.rules.wording.phrases.feed import feed_word as feed_word
from polarcheck.rules.wording.phrases.offsets import offset as offset
from polarcheck.rules.wording.phrases.offsets import option, shown_offset

#: Radii that differ by less than this share are one.
_SAME_SHARE = 0.02


def name(entry: Entry, row: int) -> str:
    """What shifts the origin: work offset, G52, G50, or several of them."""
    return " and ".join(entry.origin.causes(row))


def _sections_of_center(trace: Trace, row: int) -> tuple[list[int], bool]:
    """Lines of the G12.1 of the sections of a T word in which R is taken as 0; whether it has no others with ramps."""
    called = np.flatnonzero(trace.tools.calls_offset)
    until = int(np.append(called, len(trace))[np.searchsorted(called, row, side="right")])
    has_ramps = trace.mode.enters & trace.mode.anywhere_in_section(
        trace.compensation.starts_up | trace.compensation.cancels
    )
    enters = row + np.flatnonzero(has_ramps[row:until])
    of_center = trace.compensation.is_path_of_center[enters]
    return trace.blocks.line[enters[of_center]].tolist(), bool(of_center.all())


def taken(trace: Trace, row: int) -> float:
    """R that is taken for the offset of a T word [mm]."""
    lines, are_all = _sections_of_center(trace, row)
    return 0.0 if lines and are_all else float(trace.offsets.radius_of_offset[row])


def origin(trace: Trace, row: int) -> str:
    """The comment that R was taken from, and where it is taken as 0 instead."""
    comment = short(trace.offsets.radii_from_comments[int(trace.tools.offset_number[row])].comment)
    lines, are_all = _sections_of_center(trace, row)
    if not lines:
        return f"from the comment: {comment}"
    radius = f"{in_row(float(trace.offsets.radius_of_offset[row]), trace.lengths, row):length}"
    shorter = "every ramp is shorter there, as on a path of the tool center"
    remedy = f"give {option(trace.tools, row, 'radius')}"
    if are_all:
        return f"in place of {radius} of the comment {comment}: {shorter}; {remedy}"
    sections = f"{'line' if len(lines) == 1 else 'lines'} {', '.join(map(str, lines))}"
    return f"from the comment {comment}, but 0 in the polar mode of {sections}: {shorter}; {remedy}"


def comment(tools: CalledTools, offsets: ToolOffsets, row: int) -> str:
    """The comment that tells R of the offset that is called."""
    return short(offsets.radii_in_comments[int(tools.offset_number[row])].comment)


def is_given(blocks: ExecutedBlocks, tools: CalledTools, offsets: ToolOffsets, run: Run, entry: Entry, row: int) -> str:
    """Who gives R of the offset that is called: `is given for offset 8`, or set by a block of the program."""
    number = int(tools.offset_number[row])
    setter = int(offsets.radius_set_in[entry.first_in_mode[number]])
    return (
        f"is set for offset {offset(tools, row)} by {block_and_line(blocks, run, setter)}"
        if setter >= 0
        else f"is given for offset {offset(tools, row)}"
    )


def which_radius(tools: CalledTools, lengths: Lengths, machine: Machine, entry: Entry, row: int) -> str:
    """What may be wrong where R and the comment of an offset differ: the unit, the offset number, or one of both."""
    given, told = float(entry.radius_in_mode[row]), float(entry.radius_told[row])
    if abs(given / told - MM_PER_INCH) < _SAME_SHARE * MM_PER_INCH and lengths.scale[row] == 1.0:
        return f"in inch the comment fits: {code_of(machine, 'inch')} is missing"
    other = int(tools.tool[row])
    radius = tools.of_job[other].radius if other in tools.of_job else None
    scale = float(np.broadcast_to(lengths.job_scale, len(tools.tool))[row])
    if other != tools.offset_number[row] and radius and abs(radius * scale - told) < _SAME_SHARE * told:
        return f"offset {shown_offset(tools, other)} has the R of the comment"
    if abs(given / told - 2) < _SAME_SHARE:
        return "R may be given as the diameter: measure the cutter"
    return "measure the cutter, and correct the one that is wrong"


def x_changed_by(blocks: ExecutedBlocks, tools: CalledTools, lengths: Lengths, run: Run, row: int) -> str:
    """The word or the variable that sets X of a tool offset; else the wear of the job's table."""
    word = x_word(blocks, run, row)
    return word or f"the wear in X of the offset table, {in_row(x_wear(tools, lengths, row), lengths, row):length},"


def x_word(blocks: ExecutedBlocks, run: Run, row: int) -> str:
    """The word or the variable that sets X of a tool offset; empty for the wear of the job's table."""
    if row in run.assigned:
        return run.assigned[row].name
    address = next((address for address in "XU" if blocks.has(address)[row]), "")
    return written(blocks, run, row, address) if blocks.listed("data_input")[row] and address else ""


def x_wear(tools: CalledTools, lengths: Lengths, row: int) -> float:
    """The wear in X of the job's table [mm]."""
    of_job = tools.of_job[int(tools.offset_number[row])]
    return float(of_job.x_wear * np.broadcast_to(lengths.job_scale, len(tools.tool))[row])


def offset_of_block(tools: CalledTools, offsets: ToolOffsets, row: int) -> int | str:
    """The tool offset that a block sets, or calls."""
    numbers = offsets.offset_settings.number[offsets.offset_settings.row == row]
    return shown_offset(tools, int(numbers[0] if len(numbers) else tools.offset_number[row]))


def to_clear(lengths: Lengths, offsets: ToolOffsets, entry: Entry, row: int) -> str:
    """What X has to clear: stock and cutter, and the clearance where the job wants one."""
    stock, cutter, clearance = (
        f"{in_row(float(value[row]), lengths, row):length}"
        for value in (entry.stock_diameter, offsets.cutter_diameter, entry.clearance)
    )
    if entry.clearance[row] > 0:
        return f"stock {stock}, cutter {cutter} and clearance {clearance} need"
    return f"stock {stock} and cutter {cutter} need"


def since_x(blocks: ExecutedBlocks, row: int) -> str:
    """`, since line 7`, where X was programmed."""
    at = int(last_row(blocks.has("X", "U"), blocks.starts)[row])
    return f", since line {int(blocks.line[at])}" if at >= 0 else ""


def as_diameter(entry: Entry, lengths: Lengths, row: int) -> str:
    """`, X1 as a diameter`: what puts X0 off the spindle axis as it is written; empty where that is the distance."""
    written, distance = float(entry.origin_shift[row]), float(entry.origin_distance[row])
    return "" if written == distance else f", X {in_row(written, lengths, row):length} as a diameter,"


def to_reference(machine: Machine) -> str:
    """What takes the rotary axis to its reference point: G28 H0, G28 A0, or G28 C2=0."""
    mode = machine.polar
    address = mode.rotary_incremental or f"{mode.rotary_address}{'=' * (len(mode.rotary_address) > 1)}"
    return f"{code_of(machine, 'c_axis_reference')} {address}0"


def axes(path: ProgrammedPath, machine: Machine, row: int) -> str:
    """What is to be positioned: X, and C where that is not known either."""
    return f"X and {machine.polar.rotary_address}" if np.isnan(path.c_angle[row]) else "it"


def of_unknown_angle(machine: Machine) -> str:
    """What comes of a section at an angle of C that is not known."""
    if machine.polar.plane_is_fixed:
        return f"where the first move begins is not known: begin with G0 that writes X and {machine.polar.virtual_axis}"
    return "the shape stands wherever the spindle stopped"


def unknown_since(blocks: ExecutedBlocks, run: Run, entry: Entry, row: int) -> str:
    """`is not known since T0404 in line 7`, or that X was never positioned."""
    first = int(np.flatnonzero(blocks.starts[: row + 1])[-1]) if blocks.starts[: row + 1].any() else 0
    lost = first + np.flatnonzero(entry.loses_x[first : row + 1])
    if not len(lost):
        return "has not been positioned in this program"
    at = int(lost[-1])
    named = "T" if blocks.has("T")[at] else "GXU"
    low, high = np.searchsorted(run.row, (at, at + 1))
    words = [index for index in range(low, high) if chr(int(run.words.address[index])) in named]
    written = " ".join(executed_word(run, word) for word in words)
    return f"is not known since {written} in line {int(blocks.line[at])}"


def started(blocks: ExecutedBlocks, run: Run, machine: Machine, procedure: Procedure, row: int) -> str:
    """The code that started the live tool that still runs, and its line."""
    at = int(procedure.live_tool_runs_on[row])
    words = blocks.code_indices(*machine.m_codes.live_tool_on)
    code = executed_word(run, int(words[run.row[words] == at][0]))
    return f"{code} of line {int(blocks.line[at])}"


def to_stop(trace: Trace, spindles: Spindles, procedure: Procedure, row: int) -> str:
    """
    Where to write the code that stops the live tool.

    It may stand there already, but behind the tool change; or an M code that is in no list stands in its place.
    """
    blocks, run, codes = trace.blocks, trace.run, trace.machine.m_codes
    stop = " or ".join(codes.live_tool_off) or "the code that stops it"
    stops = np.flatnonzero(blocks.codes(*codes.live_tool_off))
    late = stops[stops >= row]
    starts = np.flatnonzero(blocks.codes(*codes.live_tool_on) & (np.arange(len(blocks)) > row))
    if len(late) and blocks.program[late[0]] == blocks.program[row] and not np.any(starts < late[0]):
        words = blocks.code_indices(*codes.live_tool_off)
        written = executed_word(run, int(words[run.row[words] == late[0]][0]))
        where = "stands beside it" if late[0] == row else f"of line {int(blocks.line[late[0]])} comes behind it"
        return f"{written} {where}: write it before the tool change"
    since = max(int(procedure.section_before[row]), int(procedure.live_tool_runs_on[row]))
    others = spindles.unlisted[(run.row[spindles.unlisted] > since) & (run.row[spindles.unlisted] <= row)]
    if not len(others):
        return f"write {stop} on the retract"
    code = f"{executed_word(run, int(others[0]))} of line {int(blocks.line[run.row[others[0]]])}"
    return f"write {stop} on the retract, in place of {code} if that is meant for it"


def or_engaged_by(blocks: ExecutedBlocks, run: Run, spindles: Spindles, machine: Machine, row: int) -> str:
    """Where to add an M code that may have engaged the C axis; empty where the program has none that is not known."""
    return _or_by(unlisted_codes(blocks, run, machine, spindles, row), "engages it", machine, "m_codes.c_axis_on")


def or_started_by(blocks: ExecutedBlocks, run: Run, spindles: Spindles, machine: Machine, row: int) -> str:
    """The same of the live tool."""
    return _or_by(unlisted_codes(blocks, run, machine, spindles, row), "starts it", machine, "m_codes.live_tool_on")


def _or_by(codes: str, what: str, machine: Machine, key: str) -> str:
    return f"; if {codes} {what}, add that to {place(machine, key)}" if codes else ""


def spindle_codes(spindles: Spindles, machine: Machine, row: int) -> str:
    """The codes that start the spindle whose C axis a section has."""
    codes = machine.m_codes
    return " or ".join(codes.sub_spindle_on if spindles.on_sub_spindle[row] else codes.spindle_on)


def spindle_remedy(
    mode: PolarMode, modal: ModalStates, path: ProgrammedPath, spindles: Spindles, machine: Machine, row: int
) -> str:
    """
    How that is stopped before a section; where it may be the live tool, that it is asked about. Where that does
    not run in the section, the code of the main spindle may stand in the place of that of the live tool.
    """
    codes = machine.m_codes
    if not spindles.are_no_live_tool[row] and not machine.polar.main_spindle_must_stop:
        return ": if that is the main spindle, stop it"
    off = codes.sub_spindle_off if spindles.on_sub_spindle[row] else codes.spindle_off
    stop = (
        f"; write {next(iter(off), 'the code that stops it')} before the {machine.polar.rotary_address} axis is engaged"
    )
    cuts = path.cuts & (mode.section == mode.section[row])
    is_live_tool = bool(codes.live_tool_on) and cuts.any() and not np.any(cuts & modal.live_tool)
    return f"{stop}, and {' or '.join(codes.live_tool_on)} for the live tool" if is_live_tool else stop


def release(spindles: Spindles, machine: Machine, row: int) -> str:
    """The code that releases the clamp of the C axis of a section."""
    codes = machine.m_codes
    off = codes.sub_c_axis_unclamp if spindles.on_sub_spindle[row] else codes.c_axis_unclamp
    return next(iter(off), "the code that releases it")


def carried_mode(blocks: ExecutedBlocks, modal: ModalStates, machine: Machine, row: int) -> str:
    """The code of feed per minute that is still in force, and its line."""
    rows = np.flatnonzero(modal.sets("feed_mode")[: row + 1])
    return f"{code_of(machine, 'feed_per_minute')} of line {int(blocks.line[rows[-1]])}"


def per_revolution(machine: Machine) -> str:
    """The code of feed per revolution."""
    return code_of(machine, "feed_per_revolution")
