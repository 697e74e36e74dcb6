"""A path in the polar plane with its words, so that its points can be found for other words, too."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from polarcheck.columns.path.lengths import same_place
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, stretch
from polarcheck.foundation.states import STATES, Motion
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.axis_table import INCREMENTS

#: Blocks of a path that is looked at.
_FEWEST, _MOST = 2, 64


class AxisWords(NamedTuple):
    """
    The words of one axis in a path of n blocks and the move before, a value for each of its n + 1 points.

    address, step_address: X and U. scale: float64, mm per unit. direction: where the axis points on the plane. value:
    float64, NaN without a word. is_step: it is incremental. word: int, the executed word, -1 for none; of the first
    point one of an earlier block where that is in force.
    """

    address: str
    step_address: str
    scale: Floats
    direction: complex
    value: Floats
    is_step: Mask
    word: Rows


class WrittenLoop(NamedTuple):
    """
    A path of n blocks at feed between two ramps, or between two moves of Z without compensation.

    row: int[n + 1], the first of them is the move before, -1 without. start: where the path begins [mm].
    turns: int[n], -1 for a clockwise arc, 0 for a line, 1. radius: float64[n], R of an arc with its sign [mm], NaN
    without. to_center: complex128[n], from the start of an arc [mm]. code: int[n], the executed word with the motion
    code of a block, -1 for none. arc_words: by address the executed word of each block, -1 for none. tolerance: what is
    the same place [mm].
    """

    row: Rows
    start: complex
    axes: tuple[AxisWords, AxisWords]
    turns: Rows
    radius: Floats
    to_center: Points
    code: Rows
    arc_words: dict[str, Rows]
    tolerance: float

    def row_of(self, run: Run, corner: int, words: Sequence[int]) -> int:
        """The row of the words, or of the block without any."""
        return int(run.row[words[0]] if words else self.row[corner])

    def points(self, values: Sequence[Floats], is_step: Sequence[Mask]) -> Points:
        """
        Where the blocks end for other words.

        values: float64[k, n + 1] for each axis, NaN without a word. is_step: bool[k, n + 1] for each axis.
        Returns complex128[k, n + 1] [mm].
        """
        point = np.zeros(values[0].shape, np.complex128)
        for axis, value, step in zip(self.axes, values, is_step, strict=True):
            length, has = value * axis.scale, ~np.isnan(value)
            way = np.cumsum(np.where(has & step, length, 0.0), axis=1) if step.any() else np.zeros((1, has.shape[1]))
            last = np.maximum.accumulate(np.where(has & ~step, np.arange(value.shape[1]), -1), axis=1)
            at = np.maximum(last, 0)
            base = np.take_along_axis(np.nan_to_num(length), at, 1)
            base -= np.take_along_axis(way, at, 1) if step.any() else 0.0
            start = (self.start / axis.direction).real - way[:, :1]
            point += (np.where(last >= 0, base, start) + way) * axis.direction
        return point


def written_loops(trace: Trace, sections: Sequence[int]) -> Iterator[WrittenLoop]:
    """
    The paths of these sections, each block of the file once, in the order of the program.

    One with a block of which it is not known where or how it goes is none: those beside it would follow each other.
    """
    at_feed, compensation = trace.axes.at_feed, trace.compensation
    ramp = compensation.starts_up | compensation.cancels
    travels = trace.path.travels
    lifts = trace.path.moves_z & ~travels & ~compensation.compensates
    begins = ramp | trace.mode.enters | lifts | (travels & ~at_feed)
    has_word = trace.blocks.mask_of(trace.run.row[trace.axes.virtual_words]) | trace.blocks.has(*"XU")
    is_known = ~(np.isnan(trace.path.end + trace.path.start) | trace.path.shape_is_unknown)
    is_inside = np.isin(trace.mode.section, sections) & trace.mode.in_polar
    rows = np.flatnonzero(is_inside & at_feed & ~ramp & (travels | has_word))
    stretch = np.cumsum(begins)[rows]
    blocks: set[bytes] = set()
    for first in np.flatnonzero(np.diff(stretch, prepend=-1)).tolist():
        own = rows[first : first + int(np.searchsorted(stretch[first:], stretch[first], "right"))]
        key = trace.run.block[own].tobytes()
        if _FEWEST <= len(own) <= _MOST and key not in blocks and is_known[own].all():
            blocks.add(key)
            before = np.flatnonzero(travels[: own[0]])
            yield written_loop(trace, np.append(before[-1] if len(before) else -1, own))


def written_loop(trace: Trace, row: Rows) -> WrittenLoop:
    """The path of these rows of one section, the first of them the move before it, -1 for none."""
    own = row[1:]
    kind, arcs = trace.axes.motion[own], trace.machine.arcs
    turns = np.where(kind == Motion.CW, -1, np.where(kind == Motion.CCW, 1, 0)).astype(np.int64)
    codes = [code for key in STATES["motion"] for code in trace.machine.codes(key)]
    linear, virtual = axis_words(trace, row)
    of_arcs = {address: _words(trace, own, address) for address in (arcs.radius_word, "I", "J")}
    return WrittenLoop(
        row,
        complex(trace.path.start[own[0]]),
        (_with_start(trace, int(row[0]), linear), _with_start(trace, int(row[0]), virtual)),
        turns,
        np.where(turns != 0, trace.lengths.length_of(arcs.radius_word)[own], np.nan),
        np.nan_to_num(trace.path.center - trace.path.start)[own],
        _last(trace, own, trace.blocks.code_indices(*codes)),
        {address: np.where(turns != 0, words, -1) for address, words in of_arcs.items()},
        same_place(complex(trace.lengths.half_of_last_digit(row[-1:])[0])),
    )


def directions(trace: Trace, row: int) -> tuple[complex, complex]:
    """The directions of the linear and of the virtual axis on the plane in a row."""
    turn = complex(trace.path.frames.turn[row]) if trace.path.frames is not None else 1 + 0j
    return turn, 1j * turn


def axis_words(trace: Trace, row: Rows) -> tuple[AxisWords, AxisWords]:
    """The words of both axes in these rows of one section; -1 for a row is none."""
    last = int(row[-1])
    linear, direction = chr(trace.axes.linear_axis[last]), directions(trace, last)
    scale = trace.lengths.scale[row]
    of_virtual = 0.5 if trace.machine.polar.virtual_axis_programming == "diameter" else 1.0
    return (
        _axis(trace, row, (linear, INCREMENTS[linear]), scale * trace.lengths.x_factor[row], direction[0]),
        _axis(trace, row, trace.axes.virtual_addresses(last), scale * of_virtual, direction[1]),
    )


def _with_start(trace: Trace, row: int, axis: AxisWords) -> AxisWords:
    """The words of an axis; where the move before the path has none, with that of its section which is in force."""
    section = int(trace.mode.section[row])
    if row < 0 or axis.word[0] >= 0 or section < 0:
        return axis
    rows = stretch(trace.run.row, int(trace.mode.sections.enter[section]), row)
    last, step = (
        words[slice(*stretch(words, *rows))][-1:].max(initial=-1)
        for words in map(trace.blocks.word_indices, (axis.address, axis.step_address))
    )
    if step > last or last < 0 or trace.modal.is_step(axis.address)[trace.run.row[last]]:
        return axis
    value, word = axis.value.copy(), axis.word.copy()
    value[0], word[0] = trace.run.words.value[last], last
    return axis._replace(value=value, word=word)


def _words(trace: Trace, row: Rows, address: str) -> Rows:
    """The last executed word of an address in each of these rows, -1 for none."""
    return _last(trace, row, trace.blocks.word_indices(address))


def _last(trace: Trace, row: Rows, words: Rows) -> Rows:
    """The last of these executed words in each row, -1 for none."""
    words = words[slice(*stretch(words, *stretch(trace.run.row, int(row.min()), int(row.max()) + 1)))]
    last = np.searchsorted(trace.run.row[words], row, "right") - 1
    found = words[np.maximum(last, 0)] if len(words) else np.full(len(row), -1)
    return np.where((last >= 0) & (trace.run.row[found] == row), found, -1)


def _axis(trace: Trace, row: Rows, addresses: tuple[str, str], scale: Floats, direction: complex) -> AxisWords:
    absolute, step = (_words(trace, row, address) for address in addresses)
    word = np.where(step >= 0, step, absolute)
    is_step = np.where(step >= 0, True, trace.modal.is_step(addresses[0])[row])
    value = np.where(word >= 0, trace.run.words.value[word], np.nan)
    return AxisWords(*addresses, scale, direction, value, is_step, word)
