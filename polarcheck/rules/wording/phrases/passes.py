"""Phrases of the rules about arcs and contours that are almost right."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.crossings import Crossings
from polarcheck.columns.contour.pass_differences import PassDifferences
from polarcheck.columns.contour.tangency import Tangency
from polarcheck.columns.path.arc_words import ArcWords
from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.path.increments import Increments
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Motion, Units
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown
from polarcheck.rules.wording.phrases.common import executed_word, move_code, point, written

#: Digits behind the point that a program writes, in mm and in inch.
_DIGITS, _DIGITS_INCH = 3, 4
#: Points farther from each other than this are two [mm].
_APART = 1e-3
_ARC_LISTS = {int(Motion.CW): "arc_clockwise", int(Motion.CCW): "arc_counterclockwise"}


def written_arc(trace: Trace, arcs: Arcs, row: int) -> str:
    """The words of an arc that say where its center is: `R8.`, or `I-4. J0`."""
    if arcs.by_radius[row]:
        of_row = written(trace.blocks, trace.run, row, trace.machine.arcs.radius_word)
        return f"{_radius_word(trace.machine)}{of_row[1:]}" if of_row.startswith("=") else of_row
    words = [
        written(trace.blocks, trace.run, row, word) for word in trace.axes.center_words(row) if _has(trace, row, word)
    ]
    return " ".join(words)


def _radius_word(machine: Machine) -> str:
    """The address of R as the control's own language has it: R, or CR=."""
    return shown(machine.control.native_words, machine.arcs.radius_word)


def _has(trace: Trace, row: int, word: str) -> bool:
    return not np.isnan(trace.blocks.word(word)[row])


def needed_arc(trace: Trace, arcs: Arcs, tangency: Tangency, row: int) -> str:
    """The words with which the arc would be tangent to the blocks before and after it."""
    inch = bool(trace.lengths.units[row] == Units.INCH)
    scale, near = float(trace.lengths.scale[row]), float(tangency.radius_tolerance[row])
    if arcs.by_radius[row]:
        return _radius_word(trace.machine) + plain(float(tangency.radius_needed[row]) / scale, near / scale, inch)
    to_center = complex(tangency.center_needed[row] - trace.path.start[row])
    if trace.path.frames is not None:
        to_center /= complex(trace.path.frames.turn[row])
    values = plain(to_center.real / scale, near / scale, inch), plain(to_center.imag / scale, near / scale, inch)
    return " ".join(word + value for word, value in zip(trace.axes.center_words(row), values, strict=True))


def plain(value: float, near: float, inch: bool) -> str:
    """A number as a program writes it, with as few digits as it has within a tolerance, and a point."""
    most = _DIGITS_INCH if inch else _DIGITS
    digits = next((count for count in range(most) if abs(round(value, count) - value) <= near), most)
    text = f"{value:.{digits}f}" + "." * (digits == 0)
    return "0." if text.strip("-0.") == "" else text


def words_of_arc(run: Run, at: list[int]) -> str:
    """The words of an arc in a straight move, as they are written."""
    return " ".join(executed_word(run, index) for index in at)


def forgotten_arc(arc_words: ArcWords, machine: Machine, row: int, count: int) -> str:
    """G2 or G3, whichever the moves beside the row speak for; both where they do not, and how many blocks want it."""
    codes = {Motion.CW: move_code(machine, "arc_clockwise"), Motion.CCW: move_code(machine, "arc_counterclockwise")}
    sense = arc_words.sense(row)
    code = " or ".join(codes.values()) if sense is None else codes[sense]
    return f"{code} is missing" + (f", here and in {count - 1} more blocks" if count > 1 else "")


def crosses_line(trace: Trace, crossings: Crossings, row: int) -> str:
    """Which line a block crosses, or runs back along, and where."""
    into, place, back = crossings.of_row(row)
    shown, line = _point(trace, row, place), int(trace.blocks.line[into])
    return f"turns back along line {line} at {shown}" if back else f"crosses line {line} at {shown}"


def _point(trace: Trace, row: int, place: complex) -> str:
    """A plane point as the program writes it in a row."""
    return point(trace.axes, trace.lengths, place + complex(trace.path.center_shift[row]), row)


def end_of_pass(trace: Trace, row: int) -> str:
    """Where a pass ends, as words."""
    return _point(trace, row, complex(trace.path.end[row]))


def pass_difference(trace: Trace, arcs: Arcs, pass_differences: PassDifferences, row: int) -> str:
    """What is other in a row than in that of another pass."""
    other = pass_differences.found[row].other
    line = int(trace.blocks.line[other])
    if pass_differences.found[row].is_missing:
        return f"a block as in line {line} is missing before this one"
    here, there = (complex(trace.path.end[at]) for at in (row, other))
    if abs(here - there) > _APART:
        return f"this block ends at {_point(trace, row, here)}, line {line} at {_point(trace, row, there)}"
    if trace.path.is_arc[row] and trace.path.is_arc[other]:
        codes = [trace.machine.codes(_ARC_LISTS[int(trace.axes.motion[at])])[0] for at in (row, other)]
        shown = [f"{code} {written_arc(trace, arcs, at)}" for code, at in zip(codes, (row, other), strict=True)]
        return f"this block is {shown[0]}, line {line} {shown[1]}"
    return f"this block is another move than line {line}"


def other_pass(trace: Trace, pass_differences: PassDifferences, row: int) -> str:
    """The lines of the pass that a pass is compared with."""
    found = pass_differences.found[row]
    return f"lines {int(trace.blocks.line[found.first])} to {int(trace.blocks.line[found.last])}"


def drift(trace: Trace, increments: Increments, row: int) -> str:
    """Where a contour in increments began."""
    return f"which is {_point(trace, row, complex(increments.begins[row]))}"


def fit_of_arc(tangency: Tangency, row: int) -> str:
    """How the arc that is meant lies in the contour."""
    if tangency.on_circle[row]:
        return "lie on one circle with the other arcs"
    return "be tangent to the blocks before and after it"
