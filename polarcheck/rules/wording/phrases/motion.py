"""Phrases of the rules about arcs, words and travel."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.regularity import Regularity
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.path.travel import Travel
from polarcheck.columns.words.unpointed import Unpointed
from polarcheck.foundation.states import MM_PER_INCH, Units
from polarcheck.geometry.shapes.shape import polygon_name
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.other_machine import OtherMachine
from polarcheck.rules.quantity import in_row
from polarcheck.rules.wording.phrases.common import centers, executed_word, linear

#: F without a point in an inch program [inch/min], parameter 1403#0 MIF = 0; in mm it is whole mm/min.
_FEED_INCREMENT_INCH = 0.01


def of_full_circle(axes: PlaneAxes, path: ProgrammedPath, run: Run, row: int) -> str:
    """What an arc by R needs to be a full circle; of a block that repeats the one before, that it stands twice."""
    before = np.flatnonzero(path.travels[:row])
    if len(before) and _words(run, int(before[-1])) == _words(run, row):
        return "the block stands twice, delete one"
    return f"a full circle needs {centers(axes, row)}, another arc another end"


def _words(run: Run, row: int) -> list[str]:
    """The words of a row as they are written, without its N word."""
    at = range(*np.searchsorted(run.row, (row, row + 1)).tolist())
    return [executed_word(run, index) for index in at if chr(int(run.words.address[index])) != "N"]


def or_short_arc(arcs: Arcs, blocks: ExecutedBlocks, machine: Machine, row: int) -> str:
    """The other reading of an arc by a negative R: without its sign it is the short one."""
    value = blocks.word(machine.arcs.radius_word)[row]
    if not (arcs.by_radius[row] and value < 0):
        return ""
    rest = 360 - float(arcs.sweep[row])
    return f", or without the sign of {machine.arcs.radius_word}, which makes it one of {rest:.0f} deg"


def least_radius(lengths: Lengths, arcs: Arcs, row: int) -> str:
    """The smallest R that reaches from start to end, rounded up to what the program can write."""
    inch = lengths.units[row] == Units.INCH
    least, places = float(arcs.chord[row]) / (2 * MM_PER_INCH if inch else 2), 4 if inch else 3
    text = f"{np.ceil(least * 10**places - 1e-6) / 10**places:.{places}f}".rstrip("0").rstrip(".")
    return f"{text} {'inch' if inch else 'mm'}"


def center(axes: PlaneAxes, row: int) -> str:
    """`I along X and J along C`."""
    along, across = axes.center_words(row)
    return f"{along} along {linear(axes, row)} and {across} along {axes.virtual_axis_of(row)}"


def fewer(machine: Machine) -> str:
    """Whether an arc must be smaller than the largest angle of one arc."""
    return "" if machine.arcs.takes_sweep_limit else "less than "


def reading(lengths: Lengths, row: int) -> str:
    """What X is in a row."""
    return "diameter" if lengths.x_factor[row] < 1 else "radius"


def misfit_of_x(
    arcs: Arcs,
    regularity: Regularity,
    mode: PolarMode,
    axes: PlaneAxes,
    lengths: Lengths,
    other_machine: OtherMachine,
    row: int,
) -> str:
    """How the section does not fit as X is read, how it would, and what to write."""
    read, meant = reading(lengths, row), other(lengths, row)
    found = None if arcs.x_is_misread[row] else regularity.x_readings.get(int(mode.section[row]))
    if found is None:
        text = f"no arc of this section fits with X read as a {read}, all fit with X as a {meant}"
        return f"{text}{_written_for(lengths, other_machine, row)}"
    axis = axes.virtual_axis_of(row)
    as_large = ("twice", "half") if found.factor > 1 else ("half", "twice")
    if found.becomes is None:
        text = f"no arc of this section is tangent as it is written, all are with X {as_large[0]} as large"
    elif found.becomes.is_regular:
        polygon = polygon_name(found.becomes.corners)
        text = f"with all X {as_large[0]} as large the contour would be a regular {polygon}, as it is written it is not"
    else:
        turn = f"{360 / found.becomes.order:g} deg"
        text = f"with all X {as_large[0]} as large the contour would be the same after each {turn}, now it is not"
    if (found.factor > 1) == (read == "diameter"):
        return f"{text}{_written_for(lengths, other_machine, row)}, or {axis} {as_large[1]} as large"
    return f"{text}; write X {as_large[0]} or {axis} {as_large[1]} as large"


def _written_for(lengths: Lengths, other_machine: OtherMachine, row: int) -> str:
    """The machines that the program may be for; where there is none, what to write."""
    return other_machine.text or f"; write X as a {reading(lengths, row)}"


def other(lengths: Lengths, row: int) -> str:
    """What X is not."""
    return "radius" if lengths.x_factor[row] < 1 else "diameter"


def taken_as(mode: PolarMode, lengths: Lengths, run: Run, machine: Machine, unpointed: Unpointed, index: int) -> str:
    """What the control takes a word of the file as, and how many more there are."""
    table, control = run.text.words, machine.control
    row = int(np.flatnonzero(run.block == table.block[index])[0])
    address, value = chr(int(table.address[index])), float(table.value[index])
    inch = bool(lengths.units[row] == Units.INCH)
    if address == "F":
        return f"{value * _FEED_INCREMENT_INCH:g} inch/min"
    is_angle = address in "CH" and not mode.in_polar[row]
    least = control.least_increment_inch if inch and not is_angle else control.least_increment
    unit = "deg" if is_angle else "inch" if inch else "mm"
    shown = f"{value * least:.4f}".rstrip("0").rstrip(".")
    return f"{shown} {unit}{_others(unpointed, index)}"


def _others(unpointed: Unpointed, index: int) -> str:
    """For which other coordinates a word without a point stands."""
    in_increments = int(unpointed.in_increments[index])
    if in_increments:
        return f"; the whole program is read in least increments, {in_increments} of its coordinates have no point"
    more = int(unpointed.slips[index]) - 1
    return f"; {more} more coordinates of this section have none" if more > 0 else ""


class BeyondTravel(NamedTuple):
    """An axis that leaves its travel: its form in messages, where it goes and where it may go [mm, X as a radius]."""

    axis: str
    form: str
    value: float
    limit: float


def beyond_travel(machine: Machine, travel: Travel, row: int) -> BeyondTravel | None:
    """The first axis that leaves its travel in a row."""
    limits = machine.limits
    ends = (
        ("X", "diameter", float(travel.most_x[row]), limits.x_maximum, 1),
        ("X", "diameter", float(travel.least_x[row]), limits.x_minimum, -1),
        ("Z", "length", float(travel.z[row]), limits.z_maximum, 1),
        ("Z", "length", float(travel.z[row]), limits.z_minimum, -1),
    )
    for axis, form, value, limit, sign in ends:
        if np.isfinite(value) and sign * value > sign * limit + ROUNDING:
            return BeyondTravel(axis, form, value, limit)
    return None


def travel(lengths: Lengths, machine: Machine, travel: Travel, row: int) -> str:
    """Where a row goes beyond the travel, and where that ends."""
    found = beyond_travel(machine, travel, row)
    if found is None:
        return ""
    goes, ends = (in_row(length, lengths, row) for length in (found.value, found.limit))
    return (
        f"{found.axis} would go to {goes.beside(ends, found.form)}, its travel ends at {ends.beside(goes, found.form)}"
    )


def more_arcs(count: int) -> str:
    """How many further arcs the finding stands for; empty for none."""
    return f"; so {'is' if count == 2 else 'are'} {count - 1} more up to the next code of motion" if count > 1 else ""
