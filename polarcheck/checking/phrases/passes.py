"""Phrases of the rules about arcs and contours that are almost right."""

from __future__ import annotations

import numpy as np

from polarcheck.checking.phrases.common import executed_word, written
from polarcheck.columns.trace import Trace
from polarcheck.execution.run import Run
from polarcheck.machines.machine import Machine
from polarcheck.machines.modal import Motion, Units
from polarcheck.table.arc_words import ArcWords
from polarcheck.table.arcs import Arcs
from polarcheck.table.tangency import Tangency

#: Digits behind the point that a program writes, in mm and in inch.
_DIGITS, _DIGITS_INCH = 3, 4


def written_arc(trace: Trace, arcs: Arcs, row: int) -> str:
    """The words of an arc that say where its center is: `R8.`, or `I-4. J0`."""
    if arcs.by_radius[row]:
        return written(trace.blocks, trace.run, row, trace.machine.arcs.radius_word)
    words = [
        written(trace.blocks, trace.run, row, word) for word in trace.axes.center_words(row) if _has(trace, row, word)
    ]
    return " ".join(words)


def _has(trace: Trace, row: int, word: str) -> bool:
    return not np.isnan(trace.blocks.word(word)[row])


def needed_arc(trace: Trace, arcs: Arcs, tangency: Tangency, row: int) -> str:
    """The words with which the arc would be tangent to the blocks before and after it."""
    inch = bool(trace.lengths.units[row] == Units.INCH)
    scale, near = float(trace.lengths.scale[row]), float(tangency.radius_tolerance[row])
    if arcs.by_radius[row]:
        return trace.machine.arcs.radius_word + plain(float(tangency.radius_needed[row]) / scale, near / scale, inch)
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
    codes = {Motion.CW: machine.codes("arc_clockwise")[0], Motion.CCW: machine.codes("arc_counterclockwise")[0]}
    sense = arc_words.sense(row)
    code = " or ".join(codes.values()) if sense is None else codes[sense]
    return f"{code} is missing" + (f", here and in {count - 1} more blocks" if count > 1 else "")
