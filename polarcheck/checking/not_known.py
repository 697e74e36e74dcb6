"""Why a column is not known in a row, and what to give."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from polarcheck.columns.filling import fill_down
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.errors import first_of
from polarcheck.program.execution.variable_names import FIRST_PARAMETER, FIRST_VARIABLE
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.places import block_in_line
from polarcheck.rules.tables import Tables
from polarcheck.rules.wording.offsets import called_tool, example, offset, to_give
from polarcheck.rules.wording.written import block_and_line

if TYPE_CHECKING:
    from polarcheck.rules.rule import Need

#: Why a column is not known in a row.
_Reason: TypeAlias = Callable[[Tables, int], str]

#: Remedies where a value of the program is not known.
_OF_VARIABLES = "give its variables as [run.variables] in polarcheck.toml, or write the number"
#: Variables of other languages have names, and no number for the job.
_OF_NAMED = "give its variables a value in the program, or write the number"
#: Of calls that a bound of the check runs once.
_RUN_WHOLE = "--max-blocks lets it run as often as it says"
#: Causes, beside the offset numbers, for which a move is not known.
_DEPTH, _POSITION, _NO_FEED, _FEED_OF_SPINDLE = -4, -3, -2, -1
#: Variables that are named; more are counted.
_LISTED = 4
#: Characters of a block that is quoted; more is cut off.
_BLOCK_LENGTH = 40


def why(need: Need, tables: Tables, row: int) -> str:
    """Why what a rule needs is not known in a row."""
    return _REASONS[need](tables, row)


def cause_of(trace: Trace, need: Need, rows: Any) -> Any:
    """A number for each row, the same for the same reason."""
    if need in ("radius", "diameter", "nose"):
        return trace.tools.offset_number[rows]
    if need == "rate":
        stands_nowhere, has_feed = (
            np.isnan(trace.path.start[rows] + trace.path.end[rows]),
            ~np.isnan(trace.feedrate.feed[rows]),
        )
        of_feed = np.where(trace.feedrate.per_minute[rows], _NO_FEED, _FEED_OF_SPINDLE)
        of_place = np.where(np.isnan(trace.path.rise[rows]), _DEPTH, _POSITION)
        of_tool = np.where(np.isnan(trace.compensation.radius[rows]), trace.tools.offset_number[rows], of_place)
        return np.where(stands_nowhere, _POSITION, np.where(has_feed, of_tool, of_feed))
    return np.zeros(len(rows), np.int64)


def _of_move(tables: Tables, row: int) -> str:
    """Why the tool center path or the speed along it is not known."""
    cause = int(cause_of(tables["trace"], "rate", np.array([row]))[0])
    if cause >= 0:
        return _REASONS["radius"](tables, row)
    if cause == _DEPTH:
        return (
            "the feed on the plane is not known: F is along the way with Z, and where Z stands before is not known; "
            "write G0 Z... before the polar mode"
        )
    return position_not_known(tables["trace"], row) if cause == _POSITION else _feed(tables, row)


def value_not_known(trace: Trace, variables: Sequence[int | None], word: str) -> str:
    """
    Why the value of a word is not known, and what to give.

    variables: on which the word, and further words, rest; None for what has no number.
    """
    macro, (variable, *more) = trace.machine.macro, variables
    if variable is None or macro.language != "custom-macro" or trace.run.blocks_run_once:
        others = f", nor that of {len(more)} more" if more else ""
        return f"the value of {word} is not known{others}: {of_variables(trace)}"
    if is_argument(trace.machine, variable):
        return f"#{variable} has no value for {word}: it is an argument; check the program that calls this one"
    if not more:
        return f"#{variable} has no value for {word}: give [run.variables] {variable} = ..., or write the number"
    names = [f"#{number}" for number in variables if number is not None]
    return f"{first_of(names, _LISTED)} have no value, as for {word}: give them in [run.variables]"


def is_argument(machine: Machine, variable: int) -> bool:
    """True for a local variable, and for one that has a name, where it has no value: a call would give it one."""
    is_local = any(first <= variable <= last for first, last in machine.macro.local_variables)
    return FIRST_VARIABLE <= variable < FIRST_PARAMETER or is_local


def of_variables(trace: Trace) -> str:
    """The remedy where a value is not known."""
    if blocks := trace.run.blocks_run_once:
        return f"line {int(trace.text.blocks.line[min(blocks)])}, which is run once here, may give it; {_RUN_WHOLE}"
    return _OF_VARIABLES if trace.machine.macro.language == "custom-macro" else _OF_NAMED


def _no_offset(what: str, key: str, of_program: Callable[[Trace], Rows] | None = None) -> _Reason:
    """of_program: gives the row in which the program has set it, -1 where it has not."""

    def reason(tables: Tables, row: int) -> str:
        trace: Trace = tables["trace"]
        number = int(trace.tools.offset_number[row])
        if trace.tools.is_unknown[row]:
            return f"no {what}: which tool offset is in force is not known; {of_variables(trace)}"
        if not number:
            remedy = f"call one before the polar mode, as in {example(trace.machine)}"
            return f"no {what}: no tool offset is in force; {_of_caller(trace, row)}{remedy}"
        setter = int(of_program(trace)[row]) if of_program else -1
        if setter >= 0:
            return _not_known_from_program(trace, row, setter, what, key)
        return f"no {what} for {called_tool(trace.tools, row)}: {to_give(trace.tools, trace.machine, row, key)}"

    return reason


def _not_known_from_program(trace: Trace, row: int, setter: int, what: str, key: str) -> str:
    """Why what the program itself sets of an offset is not known: by which block, and what to give."""
    unknown = trace.offsets.row_of_unknown_setting(int(trace.tools.offset_number[row]), setter, key)
    missing = f"no {what} for offset {offset(trace.tools, row)}"
    if unknown >= 0:
        block = block_and_line(trace, unknown)
        return f"{missing}: {block} sets it to a value that is not known; {of_variables(trace)}"
    setting = block_and_line(trace, setter)
    return f"{missing}: {setting} sets wear or a difference alone; {to_give(trace.tools, trace.machine, row, key)}"


def position_not_known(trace: Trace, row: int) -> str:
    """Return why the position in a row of a section is not known, and what to write."""
    if trace.path.frames is not None and not trace.path.frames.is_known[row]:
        return "the position is not known: the frame in force is not simulated"
    section = trace.mode.section == trace.mode.section[row]
    unknown = np.flatnonzero(trace.path.shape_is_unknown & section)
    if len(unknown) and not np.isnan(trace.path.start[row] + trace.path.end[row]):
        # A corner hangs on the block behind it.
        nearest = int(unknown[min(int(np.searchsorted(unknown, row)), len(unknown) - 1)])
        block = block_and_line(trace, nearest)
        return f"the way is not known: {block} leaves open how the tool goes; {_of_words(trace, nearest)}"
    open_ends = np.flatnonzero(trace.mode.in_polar & np.isnan(trace.path.end) & ~np.isnan(trace.path.start))
    at_or_before = open_ends[open_ends <= row]
    if not np.isnan(trace.path.end[row]) and (open_ends > row).any():
        row = int(open_ends[open_ends > row][0])  # a corner hangs on the block behind it
    elif len(at_or_before):
        row = int(at_or_before[-1])
    if row in open_ends and not trace.run.unknown[row]:
        block = block_and_line(trace, row)
        return f"the position is not known: {block} leaves open where the tool goes; {_of_words(trace, row)}"
    lost = np.flatnonzero((trace.run.unknown & (trace.blocks.program == trace.blocks.program[row]))[: row + 1])
    if not len(lost):
        axis = chr(trace.axes.linear_axis[row])
        loses = np.isnan(trace.path.x) & (
            ~np.isnan(trace.path.x_before) | (trace.modal.uses_axes & trace.blocks.has(axis))
        )
        loses &= (trace.blocks.program == trace.blocks.program[row]) & ~trace.mode.in_polar & ~trace.mode.enters
        if loses[: row + 1].any():
            setting = block_and_line(trace, int(np.flatnonzero(loses[: row + 1])[-1]))
            return f"the position is not known: {setting} leaves open where {axis} stands; write G0 {axis}... after it"
        missing = f"the position is not known: {axis} was not programmed before the polar mode"
        return f"{missing}; {_of_caller(trace, row)}write G0 {axis}... before it"
    return f"the position {_after_unexecuted(trace, int(lost[-1]), f'X and {trace.machine.polar.rotary_address}')}"


def _of_words(trace: Trace, row: int) -> str:
    """The remedy where words of a block have no value."""
    is_unreadable = trace.blocks.with_words(trace.run.words.is_unreadable)[row]
    return "write numbers that the control can read" if is_unreadable else of_variables(trace)


def _of_caller(trace: Trace, row: int) -> str:
    """What else to do about a program that M99 leaves: its caller may say what it does not."""
    returns = trace.blocks.codes(*trace.machine.macro.program_returns) & (trace.run.depth == 0)
    return "check the program that calls this one, or " if trace.blocks.anywhere_in_program(returns)[row] else ""


def _after_unexecuted(trace: Trace, row: int, axes: str) -> str:
    written = f"line {int(trace.blocks.line[row])}, {block_in_line(trace.run, row, _BLOCK_LENGTH)}"
    how, remedy = "not executed", "--subprograms FOLDER says where called programs lie"
    if int(trace.run.block[row]) in trace.run.blocks_run_once:
        how, remedy = "run once here", _RUN_WHOLE
    return f"is not known after {written}, which is {how}; {remedy}, or program {axes} after it"


def angles_not_known(trace: Trace) -> Iterator[tuple[str, int]]:
    """
    Yield why C at the beginning of sections is not known, where their X and Z are: after a block that is not executed.
    """
    enter = trace.mode.sections.enter[~trace.path.knows_section_entry]
    if not len(enter) or not trace.run.unknown.any():
        return
    known = ~np.isnan(trace.path.c_angle)
    follows = np.append(False, known[:-1]) & ~known
    lost = fill_down(np.where(follows, np.arange(len(trace)), -1), follows | trace.blocks.starts, -1)[enter]
    # Blocks that are not simulated are named by themselves.
    named = np.isin(trace.run.block[lost], [remark.block for remark in trace.run.remarks])
    for row, count in Counter(lost[(lost >= 0) & trace.run.unknown[lost] & ~named].tolist()).items():
        axis = trace.machine.polar.rotary_address
        yield f"{axis} at the beginning of a section {_after_unexecuted(trace, row, axis)}", count


def _origin(tables: Tables, row: int) -> str:
    causes = " and ".join(tables["entry"].origin.unknown_causes(row))
    remedy = of_variables(tables["trace"])
    return f"where X0 lies is not known: {causes} sets X to a value that is not known; {remedy}"


def _feed(tables: Tables, row: int) -> str:
    trace: Trace = tables["trace"]
    written = np.flatnonzero(trace.blocks.has("F")[: row + 1])
    if len(written) and trace.blocks.is_unknown("F")[written[-1]]:
        block = block_and_line(trace, int(written[-1]))
        return f"the feed is not known: F in {block} rests on a variable; {of_variables(trace)}"
    if trace.feedrate.per_minute[row]:
        return "the feed is not known: no F is in force; write one before the cutting move"
    codes = " or ".join(trace.machine.codes("feed_per_minute"))
    return f"the feed is not known: F is per revolution of a spindle; write feed per minute before it, {codes}"


_REASONS: dict[Need, _Reason] = {
    "radius": _no_offset("radius", "radius", lambda trace: trace.offsets.radius_set_in),
    "diameter": _no_offset("cutter diameter", "diameter"),
    "nose": _no_offset("nose type", "nose", lambda trace: trace.offsets.nose_set_in),
    "position": lambda tables, row: position_not_known(tables["trace"], row),
    "rate": _of_move,
    "travel": _of_move,
    "origin": _origin,
}
