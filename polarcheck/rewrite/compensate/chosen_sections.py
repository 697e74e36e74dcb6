"""The polar sections that get or lose compensation, with R of their cutters."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec
import numpy as np

from polarcheck.columns.path.moves import Moves
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import ArcFeed, Side
from polarcheck.geometry.tolerances import ADJUSTMENT, ROUNDING
from polarcheck.program.machines.code_lists import expanded
from polarcheck.rewrite.compensate.section_moves import Move, of_section
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError, radius_not_known, refusal_at, refused_at
from polarcheck.rewrite.writing.refused_sections import checks_of_switches, refusals_in_sections
from polarcheck.rules.wording.offsets import called_tool, example, to_give


class Section(msgspec.Struct, frozen=True):
    """
    A section that programs the path of the tool center.

    number: number of the section.
    moves: its moves in order.
    radius: R of its cutter [mm].
    bar: diameter beyond which there is no material [mm]; NaN if it is not known.
    """

    number: int
    moves: Sequence[Move]
    radius: float
    bar: float


def sections_of(trace: Trace, moves: Moves, bar: float) -> list[Section]:
    """
    Return the sections that cut along the path of the tool center.

    Raises RefusedError where there is none, the control does not compensate in the mode, or R is not known.
    """
    _require_sections(trace)
    _require_sound_switches(trace)
    with_side = trace.mode.anywhere_in_section(trace.compensation.compensates)
    numbers: list[int] = np.unique(trace.mode.section[trace.path.cuts & ~with_side & trace.mode.in_polar]).tolist()
    if not numbers:
        text = "all polar sections have G41 or G42" if with_side.any() else "no polar section cuts"
        raise RefusedError([Refusal(0, f"there is no path of the tool center to write as a contour: {text}")])
    _require_control(trace, numbers[0])
    return [Section(number, of_section(trace, moves, number), _radius(trace, number), bar) for number in numbers]


def compensated_sections(trace: Trace) -> list[int]:
    """Return the numbers of the sections with G41 or G42. Raises RefusedError where there is none."""
    _require_sections(trace)
    _require_sound_switches(trace)
    compensated = trace.mode.anywhere_in_section(trace.compensation.compensates)
    numbers: list[int] = np.unique(trace.mode.section[compensated & trace.mode.in_polar]).tolist()
    if not numbers:
        raise RefusedError([Refusal(0, "no polar section has G41 or G42: its path is that of the tool center already")])
    return numbers


def _require_sections(trace: Trace) -> None:
    if not len(trace.mode.sections):
        raise RefusedError([Refusal(0, "the program has no polar section")])


def _require_sound_switches(trace: Trace) -> None:
    """
    Raise RefusedError where G41 or G42 is in force when the mode is switched, it is switched on twice or not off, or
    offsets are set in it.
    """
    compensation, mode = trace.compensation, trace.mode
    sets = trace.blocks.listed("data_input") | trace.blocks.assigns(trace.machine.macro.tool_offset_variables)
    is_open = trace.blocks.mask_of(mode.sections.enter[mode.sections.returned])
    checks = [
        checks_of_switches(trace)[0],
        (is_open, "what leaves the polar mode is not in this program"),
        (mode.in_polar & sets, "offsets are set in the polar mode: write that before the section"),
    ]
    if refusals := list(refusals_in_sections(trace, checks)):
        raise RefusedError(refusals)
    side = trace.modal.state("side")
    on = mode.enters & ~compensation.writes_cancel & ((side == Side.LEFT) | (side == Side.RIGHT))
    off = mode.leaves & (compensation.side_of_move_before != Side.OFF)
    wrong = np.flatnonzero(on | off)
    if len(wrong):
        text = "G41 or G42 is in force where the mode is switched: cancel it by G40 and a move before"
        raise RefusedError([refusal_at(trace, int(row), text) for row in wrong.tolist()])


def _require_control(trace: Trace, section: int) -> None:
    """Raise RefusedError where the control takes no cutter compensation in the mode."""
    machine = trace.machine
    row = int(np.flatnonzero(trace.mode.section == section)[0])
    allowed = expanded(machine.polar.allowed_codes)
    for key in ("compensation_left", "compensation_right", "compensation_off"):
        codes = machine.codes(key)
        if not codes or (allowed and codes[0] not in allowed):
            what = f"{codes[0]} in the polar mode" if codes else "cutter compensation"
            raise refused_at(trace, row, f"{machine.title} takes no {what}: leave the path of the tool center")


def _radius(trace: Trace, section: int) -> float:
    """Return R of the tool offset in force in a section [mm]. Raises RefusedError where it is not known."""
    rows = np.flatnonzero((trace.mode.section == section) & trace.path.travels)
    row = int(rows[0])
    if not trace.tools.offset_number[row]:
        how = f"call one before the section, as {example(trace.machine)}"
        raise refused_at(trace, row, f"no tool offset is in force, from which the control would take R: {how}")
    radius = np.unique(trace.offsets.radius_of_offset[rows])
    tool = called_tool(trace.tools, row)
    if np.isnan(radius).any():
        raise refused_at(trace, row, radius_not_known(trace, row))
    if len(radius) > 1:
        raise refused_at(trace, row, "another tool offset is called in the section")
    if radius[0] <= ADJUSTMENT + ROUNDING:
        missing = to_give(trace.tools, trace.machine, row, "radius")
        text = f"R of {tool} is {radius[0]:g} mm, which is not the radius of its cutter: {missing}"
        raise refused_at(trace, row, text)
    if trace.compensation.sides_are_open[row]:
        raise refused_at(trace, row, "on the sub-spindle nobody knows which of G41 and G42 is meant")
    if trace.compensation.allowance[rows].any():
        word = trace.machine.offsets.allowance_word
        raise refused_at(trace, row, f"{word} is in force, which the control would add to R: set it to 0 before")
    of_contour = rows[trace.path.is_arc[rows] & (trace.modal.state("arc_feed")[rows] > ArcFeed.CENTER)]
    if len(of_contour):
        text = (
            "with the code in force F would be that of the contour along this arc, and the cutter run at another speed"
        )
        raise refused_at(trace, int(of_contour[0]), text)
    return float(radius[0])
