"""Finds the polar sections in the text, and why some cannot be written as plain moves."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np

from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.program.execution.variable_names import FIRST_VARIABLE
from polarcheck.rewrite.writing.outcome import Refusal, radius_not_known, refusal_at
from polarcheck.rewrite.writing.refused_sections import (
    Check,
    checks_of_sections,
    never_left,
    refusals_in_sections,
    unknown_positions,
)
from polarcheck.rewrite.writing.unknown_moves import UnknownMoves
from polarcheck.rules.editing import written_word
from polarcheck.rules.tables import Tables

#: Numbers of variables that do something when they are set; names have the numbers behind them.
_SYSTEM = range(1000, FIRST_VARIABLE)
#: Lists of G codes behind which the tool is elsewhere.
_ELSEWHERE = ("reference_return", "machine_coordinates", "local_shift", "coordinate_preset")


class Stretch(msgspec.Struct, frozen=True):
    """
    A polar section in the text.

    number: number of the section.
    enter, leave: the rows that switch the mode on and off.
    first, last: their blocks.
    runs_in_order: each of its blocks runs once, in the order of the text, so that blocks can be replaced one by one.
    Otherwise the executed blocks are written in the order in which they run.
    """

    number: int
    enter: int
    leave: int
    first: int
    last: int
    runs_in_order: bool


def stretches(trace: Trace) -> list[Stretch]:
    """Return the polar sections; one that runs several times is returned for each run."""
    result = []
    sections = trace.mode.sections
    for section, (enter, leave) in enumerate(zip(sections.enter.tolist(), sections.leave.tolist(), strict=True)):
        end = min(leave, len(trace) - 1)
        blocks = trace.run.block[enter : end + 1]
        in_order = (
            bool(np.all(np.diff(blocks) > 0)) and not trace.text.blocks.is_macro[blocks[0] : blocks[-1] + 1].any()
        )
        in_order &= len(np.unique(trace.run.depth[enter : end + 1])) == 1
        result.append(Stretch(section, enter, leave, int(blocks[0]), int(blocks[-1]), in_order))
    return result


def refusals(tables: Tables, sections: list[Stretch], faults: list[Refusal]) -> list[Refusal]:
    """Return the reasons why sections cannot be unrolled, each once per line. faults: those that are told already."""
    trace: Trace = tables["trace"]
    reasons = list(refusals_in_sections(trace, _checks(tables, faults)))
    is_open = never_left(trace)
    for section in sections:
        reasons += () if is_open[section.number] else _of_section(trace, section)
    return list(dict.fromkeys(sorted(reasons, key=lambda reason: reason.line)))


def _checks(tables: Tables, faults: list[Refusal]) -> list[Check]:
    """Return the rows that cannot be unrolled, with the reasons."""
    trace: Trace = tables["trace"]
    center: ToolCenter = tables["tool_center"]
    moves, mode, path = center.moves, trace.mode, trace.path
    within = mode.in_polar
    without_radius = within & (trace.compensation.side != Side.OFF) & np.isnan(trace.offsets.radius_of_offset)
    unknown = trace.blocks.mask_of(moves.row[~moves.known | np.isnan(moves.length)])
    # The reason stands before its consequences.
    unknown &= ~mode.anywhere_in_section(without_radius)
    without_feed = trace.blocks.mask_of(moves.row[~(moves.feed > 0)])
    without_feed &= trace.axes.motion != Motion.RAPID
    alone = path.moves_z & within & (trace.axes.motion != Motion.RAPID) & ~(trace.feedrate.feed > 0)
    per_minute = trace.feedrate.per_minute | (trace.feedrate.feed_mode == FeedMode.PER_MINUTE)
    unknown_moves = UnknownMoves(trace)
    lost = unknown_moves.lost("X") | unknown_moves.lost(trace.machine.polar.rotary_address)
    corner_words = (*trace.machine.arcs.corners_not_made, ",A")

    def may_be_macro(trace: Trace, row: int) -> str:
        word = written_word(trace.run, int(unknown_moves.word[row]))
        return f"{word} may be a macro that takes these axis words: the profile does not say what it does"

    return [
        *checks_of_sections(trace, mode.rotary_is_followed),
        (trace.modal.on_sub_spindle & mode.enters & (trace.machine.polar.sub_spindle_plane != "as-main"),
         "which way C turns on the sub-spindle is not known"),
        (np.abs(path.center_shift) > 0, "the center of C is not at X0 of the program"),
        ((trace.modal.state("modal_call") != 0) & within, "a program that is called after each move is not unrolled"),
        (within & trace.blocks.listed(*_ELSEWHERE), "a code in the mode leads to other coordinates"),
        (within & unknown_moves.is_skip, "axis words beside this code are no end of a move"),
        (within & (unknown_moves.word >= 0), may_be_macro),
        (lost & mode.enters, "where the tool stands is not known, behind a block whose axis words a macro may take"),
        (within & trace.blocks.has(*corner_words), "a corner or an angle by ,R ,C or ,A is not followed"),
        (center.interferes, "the tool center would run against the program"),
        (center.no_intersection, "the paths of the tool center do not meet"),
        (center.movement_missing, "the control does not know the next move in time"),
        (center.inside_arc_too_small, "the cutter does not fit into this arc"),
        ((trace.compensation.side != Side.OFF) & mode.enters, "cutter compensation is in force before the mode"),
        (without_radius, radius_not_known),
        unknown_positions(trace, unknown, faults),
        ((without_feed | alone) & ~per_minute, "F is not per minute, so that the speed of the tool is not known"),
        (without_feed | alone, "F is missing"),
    ]  # fmt: skip


def _of_section(trace: Trace, section: Stretch) -> Iterator[Refusal]:
    enter = section.enter
    if (trace.compensation.side[section.leave - 1 : section.leave + 1] != Side.OFF).any():
        yield refusal_at(trace, section.leave, "cutter compensation is in force where the mode ends")
    if np.isnan(trace.path.c_angle[section.enter]):
        yield refusal_at(trace, enter, "C is not known where the mode begins: position it before, as C0")
    if np.isnan(trace.path.x_before[section.enter]):
        yield refusal_at(trace, enter, "X is not known where the mode begins")
    depth = trace.run.depth[section.enter : section.leave + 1]
    if depth[0] != depth[-1] or depth.min() < depth[0] or section.last < section.first:
        yield refusal_at(trace, enter, "the polar mode is switched on in one program and left in another")
        return
    if section.runs_in_order:
        return
    blocks = trace.run.block[section.enter : section.leave + 1][depth == depth[0]]
    if blocks.min() < section.first or blocks.max() > section.last:
        yield refusal_at(trace, enter, "a jump leads out of the section")
    following = trace.run.block[section.leave + 1 :]
    outside = np.flatnonzero(trace.text.blocks.is_macro)
    outside = outside[(outside > section.last) & np.isin(outside, following)]
    values = [value for value in trace.run.values if section.enter <= value.row <= section.leave]
    if values and len(outside):
        yield Refusal(_line_of_block(trace, int(outside[0])), "a variable that the section sets may be read here")
    for value in values:
        if value.number in _SYSTEM:
            yield Refusal(_line_of_block(trace, value.block), f"#{value.number} is set: what it does would be lost")


def _line_of_block(trace: Trace, block: int) -> int:
    return int(trace.text.blocks.line[block])
