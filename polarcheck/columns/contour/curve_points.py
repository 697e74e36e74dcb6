"""Curves that are written as many short lines: the one point that is off the curve of the points beside it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.correction import Correction
from polarcheck.columns.contour.written_loop import AxisWords, axis_words, directions
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import Slip, parts_of, plain_number, slips_of
from polarcheck.foundation.arrays import Floats, Points, Rows, runs
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ROUNDING

#: Points of a curve; how far from a point others show how smooth the curve is (half of them are, beside a corner all
#: are not), and as many of them as must do so.
_FEWEST, _REACH, _WITNESSES = 12, 8, 6
#: By how much a point of its own is off in the fourth differences round it.
_FOURTH = np.array([1.0, -4.0, 6.0, -4.0, 1.0])
#: Fourth differences that are as smooth as the rest, in those of the rest and in halves of the last digit; how much
#: rougher a wrong point is. Of a corner in an even row of points a sixth is left, whatever its point is moved to.
_AS_SMOOTH, _DIGITS, _ROUGHER = 2.0, 16.0, 8.0
#: Points off the curves of a program, of which more are teeth or marks; rough points that are searched.
_MOST, _MOST_SEARCHED = 2, 200


class _Curves(NamedTuple):
    """
    Runs of lines, each with _REACH points more at either end: those of its other end if it is closed, NaN if not.

    point: complex128[n] [mm]. row: int[n], whose end is the point, -1 for those beside a run and for its start.
    """

    point: Points
    row: Rows


def off_the_curve(trace: Trace) -> list[Correction]:
    """The corrections of single words that lead to a point off the curve."""
    curves = _curves(trace)
    if not len(curves.row):
        return []
    is_own = curves.row >= 0
    digit = _DIGITS * np.where(is_own, np.abs(trace.lengths.half_of_last_digit(curves.row)), 0.0)
    rough = np.zeros(len(curves.point), np.complex128)
    rough[2:-2] = np.convolve(curves.point, _FOURTH, "valid")
    size = np.abs(rough)
    odd = np.flatnonzero(is_own & (size > _ROUGHER * np.maximum(digit, _AS_SMOOTH * _beside(size))))
    found: list[Correction] = []
    for index in odd[:_MOST_SEARCHED].tolist():
        around = np.append(size[index - _REACH : index - 2], size[index + 3 : index + _REACH + 1])
        around = around[~np.isnan(around)]
        if len(around) < _WITNESSES:
            continue
        smooth = max(float(digit[index]), _AS_SMOOTH * float(np.sort(around)[len(around) // 2]))
        if size[index] > _ROUGHER * smooth:
            correction = _correction(trace, curves, index, rough[index - 2 : index + 3], smooth)
            found += [] if correction is None else [correction]
    return found if len(found) <= _MOST else []


def _beside(size: Floats) -> Floats:
    """Per point the least of how rough the curve is three and four points away from it."""
    beside = np.full(len(size), np.inf)
    for shift in (3, 4):
        beside[shift:] = np.fmin(beside[shift:], size[:-shift])
        beside[:-shift] = np.fmin(beside[:-shift], size[shift:])
    return beside


def _curves(trace: Trace) -> _Curves:
    path, compensation = trace.path, trace.compensation
    moves = np.flatnonzero(path.travels)
    ramp = (compensation.starts_up | compensation.cancels)[moves]
    is_line = (trace.axes.motion[moves] == Motion.LINE) & path.on_plane[moves] & ~ramp & ~np.isnan(path.end[moves])
    first, last = runs(is_line)
    is_long = is_line[first] & (last + 1 - first >= _FEWEST)
    first, last = first[is_long], last[is_long]
    # A line that leads to a closed curve, and one that leads away from it, are none of it.
    start, end = path.start[moves[first]], path.end[moves]
    leads_to = (np.abs(start - end[last]) > ROUNDING) & (
        np.minimum(np.abs(end[first] - end[last]), np.abs(end[first] - end[last - 1])) <= ROUNDING
    )
    first, start = first + leads_to, np.where(leads_to, end[first], start)
    last -= (np.abs(start - end[last]) > ROUNDING) & (np.abs(start - end[last - 1]) <= ROUNDING)
    count, is_closed = last + 1 - first, np.abs(start - end[last]) <= ROUNDING
    # Per point of a run with those beside it: its place in the run, 0 for the start.
    total = count + 1 + 2 * _REACH
    run = np.repeat(np.arange(len(first)), total)
    place = np.arange(len(run)) - np.repeat(np.cumsum(total) - total, total) - _REACH
    number = count[run]
    is_own = (place > 0) & (place <= number)
    place = np.where(is_closed[run], (place - 1) % number + 1, place)
    is_known = (place > 0) & (place <= number)
    row = moves[first[run] + np.clip(place - 1, 0, number - 1)]
    point = np.where(is_known, path.end[row], np.where(place == 0, start[run], complex("nan+nanj")))
    return _Curves(point, np.where(is_own, row, -1))


def _correction(trace: Trace, curves: _Curves, index: int, rough: Points, smooth: float) -> Correction | None:
    """The word that leads to a point, if it is a slip of the pen and the curve is smooth without it."""
    rows = curves.row[index : index + 2]
    rows = rows[rows >= 0]
    for number, direction in enumerate(directions(trace, int(rows[-1]))):
        shift = -complex(rough[2] / direction).real / _FOURTH[2]
        if not np.abs(rough + _FOURTH * shift * direction).max() <= smooth:
            continue
        axis = axis_words(trace, rows)[number]
        if axis.is_step.any() or (axis.word[1:] < 0).any():
            continue
        numbers = (curves.point / axis.direction).real / float(axis.scale[0])
        value = float(numbers[index]) + shift / float(axis.scale[0])
        neighbors, others = numbers[[index - 1, index + 1]], np.abs(np.delete(numbers, index))
        return _of_word(trace, int(rows[0]), axis, value, smooth / (_FOURTH[2] * axis.scale[0]), neighbors, others)
    return None


def _of_word(
    trace: Trace, row: int, axis: AxisWords, value: float, tolerance: float, neighbors: Floats, others: Floats
) -> Correction | None:
    """The correction of the word of an axis whose number is nearly a value, best one of the others of the curve."""
    word = int(axis.word[0])
    address, written = parts_of(trace.run.written(word)) if word >= 0 else ("", "")
    slips = [slip for slip in slips_of(written) if abs(float(slip.text) - value) <= tolerance]
    if slips:

        def unlikely(slip: Slip) -> tuple[bool, bool, float]:
            number = float(slip.text)
            is_other = bool(np.nanmin(np.abs(others - abs(number))) <= ROUNDING)
            return len(slip.text) > len(written) + 1, not is_other, abs(number - value)

        slip = min(slips, key=unlikely)
        text, why, remedy = address + slip.text, slip.kind, f"with {address}{slip.text}"
    else:
        if word >= 0 and np.abs(neighbors - axis.value[0]).min() > ROUNDING:
            return None
        text = f"{axis.address}{plain_number(round(value, 3))}"
        why = "it is that of the block beside it" if word >= 0 else "a word is missing"
        remedy = f"with about {text}"
    return Correction(row, word, text, why, remedy, "the curve of the points beside it would go on", "curve")
