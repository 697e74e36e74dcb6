"""Finds the polar sections in the text, and why some cannot be written as plain moves."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec
import numpy as np

from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.states import FeedMode, Motion, Side
from polarcheck.program.execution.variable_names import FIRST_VARIABLE
from polarcheck.rewrite.writing.outcome import Refusal, radius_not_known, refusal_at
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


def refusals(tables: Tables, sections: list[Stretch]) -> list[Refusal]:
    """Return the reasons why sections cannot be unrolled, each once per line."""
    trace: Trace = tables["trace"]
    reasons = [refusal_at(trace, row, text) for row, text in _of_rows(tables)]
    for section in sections:
        reasons += _of_section(trace, section)
    return list(dict.fromkeys(sorted(reasons, key=lambda reason: reason.line)))


def _of_rows(tables: Tables) -> Iterator[tuple[int, str]]:
    """Yield rows that cannot be unrolled and the reasons; of each reason the first row in a section."""
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
    order = np.append(False, np.diff(moves.row) < 0)[: len(moves)]
    backwards = trace.blocks.mask_of(moves.row[order])
    infeed = trace.blocks.has(trace.machine.polar.infeed_word) & mode.enters
    unknown_moves = UnknownMoves(trace)
    lost = unknown_moves.lost("X") | unknown_moves.lost(trace.machine.polar.rotary_address)
    corner_words = (*trace.machine.arcs.corners_not_made, ",A")
    checks: list[tuple[Mask, str]] = [
        (infeed | backwards, "the passes of an infeed cycle are not unrolled"),
        (trace.run.unknown & within, "what this block does is not known"),
        (within & ~mode.rotary_is_followed, "the axes of this section are not followed"),
        (within & (trace.axes.linear_axis != ord("X")), "the linear axis of this section is not X"),
        (trace.modal.on_sub_spindle & mode.enters & (trace.machine.polar.sub_spindle_plane != "as-main"),
         "which way C turns on the sub-spindle is not known"),
        (np.abs(path.center_shift) > 0, "the center of C is not at X0 of the program"),
        (within & trace.modal.in_cycle & trace.axes.moves, "a cycle in the mode is not unrolled"),
        ((trace.modal.state("modal_call") != 0) & within, "a program that is called after each move is not unrolled"),
        (within & trace.blocks.listed(*_ELSEWHERE), "a code in the mode leads to other coordinates"),
        (within & unknown_moves.is_skip, "axis words beside this code are no end of a move"),
        (lost & mode.enters, "where the tool stands is not known, behind a block whose axis words a macro may take"),
        (within & trace.blocks.has(*corner_words), "a corner or an angle by ,R ,C or ,A is not followed"),
        (center.interferes, "the tool center would run against the program"),
        (center.no_intersection, "the paths of the tool center do not meet"),
        (center.movement_missing, "the control does not know the next move in time"),
        (center.inside_arc_too_small, "the cutter does not fit into this arc"),
        ((trace.compensation.side != Side.OFF) & mode.enters, "cutter compensation is in force before the mode"),
        (unknown, "where the tool center goes is not known"),
        ((without_feed | alone) & ~per_minute, "F is not per minute, so that the speed of the tool is not known"),
        (without_feed | alone, "F is missing"),
    ]  # fmt: skip
    for row in np.flatnonzero(mode.first_in_section(without_radius)).tolist():
        yield row, radius_not_known(trace, row)
    for row in np.flatnonzero(mode.first_in_section(within & (unknown_moves.word >= 0))).tolist():
        word = written_word(trace.run, int(unknown_moves.word[row]))
        yield row, f"{word} may be a macro that takes these axis words: the profile does not say what it does"
    for hits, text in checks:
        yield from ((row, text) for row in np.flatnonzero(mode.first_in_section(hits)).tolist())


def _of_section(trace: Trace, section: Stretch) -> Iterator[Refusal]:
    enter, sections = section.enter, trace.mode.sections
    if not sections.left[section.number] or sections.returned[section.number] or section.leave >= len(trace):
        yield refusal_at(trace, enter, "the polar mode is never left")
        return
    if (trace.compensation.side[section.leave - 1 : section.leave + 1] != Side.OFF).any():
        yield refusal_at(trace, section.leave, "cutter compensation is in force where the mode ends")
    if np.isnan(trace.path.c_angle[section.enter]):
        yield refusal_at(trace, enter, "C is not known where the mode begins: position it before, as C0")
    if np.isnan(trace.path.x_before[section.enter]):
        yield refusal_at(trace, enter, "X is not known where the mode begins")
    if sections.again[(sections.again > section.enter) & (sections.again < section.leave)].size:
        yield refusal_at(trace, enter, "the polar mode is switched on again within")
    depth = trace.run.depth[section.enter : section.leave + 1]
    if depth[0] != depth[-1] or depth.min() < depth[0] or section.last < section.first:
        yield refusal_at(trace, enter, "the polar mode is switched on in one program and left in another")
        return
    source = trace.text.source
    part = source.part_of(int(trace.blocks.line[section.enter]))
    if part is not None and not source.is_own(part):
        yield refusal_at(trace, enter, "the section stands in another file")
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
