"""Passes written with the same numbers but for a code, a letter or the order of two blocks; or all but one word."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.contour.passes import numbered
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Rows
from polarcheck.foundation.states import Side

#: Blocks of a pass, and of those the least that are alike; blocks with other words, or other compensation.
_FEWEST, _MOST, _ALIKE, _DIFFERING = 5, 200, 3, 2
#: Passes of as many blocks that are compared with each other.
_SHAPES = 12
#: Ends nearer to each other than this are one [mm]; numbers, too.
_APART, _ROUNDING = 0.004, 1e-6
#: Words of moves; a number of more digits is rounded [digits].
_ADDRESSES, _DIGITS = "XUCHYVIJRL", 5
#: States of a block that may differ: numbers of motions, of increments, and of compensation.
_STEP, _COMPENSATION = 16, 32

_Hash = NDArray[np.uint64]


class WrittenDifference(NamedTuple):
    """Rows of a pass and of its model, one for one, and the first of them that is written otherwise."""

    rows: Rows
    model: Rows
    first: int


def written_differences(trace: Trace) -> Iterator[WrittenDifference]:
    """The passes that differ from the most frequent one of as many blocks; of those as frequent, from the one above."""
    values = np.stack([trace.blocks.word(address) for address in _ADDRESSES])
    rows = np.flatnonzero(trace.mode.in_polar & ~np.isnan(values).all(axis=0))
    begins = (trace.path.moves_z & ~trace.path.travels) | trace.mode.enters
    first = np.flatnonzero(np.diff(np.cumsum(begins)[rows], prepend=-1))
    count = np.diff(first, append=len(rows))
    chosen = np.flatnonzero((count >= _FEWEST) & (count <= _MOST))
    if len(chosen) < 2:
        return
    number = _mixed(values[:, rows])
    words = np.add.reduce(number * _odd(len(_ADDRESSES))[:, None], axis=0, dtype=np.uint64)
    state = _states(trace)[rows]
    index = np.arange(len(rows)) - np.repeat(first, count)
    total = np.add.reduceat(np.add.reduce(number, axis=0, dtype=np.uint64), first)
    shape = np.add.reduceat(_mixed(index.astype(np.float64)) * (words + state.astype(np.uint64)), first)
    program = trace.blocks.program[rows[first]]
    group = numbered([count[chosen].astype(np.float64), program[chosen].astype(np.float64)])
    for which in np.flatnonzero(np.bincount(group) > 1).tolist():
        passes = chosen[group == which]
        _, begin, frequency = np.unique(shape[passes], return_index=True, return_counts=True)
        order = begin[np.lexsort((begin, -frequency))][:_SHAPES]
        for rank, other in enumerate(passes[order].tolist()):
            own = first[other] + np.arange(count[other])
            for earlier in passes[order[:rank]].tolist():
                model = first[earlier] + np.arange(count[other])
                is_otherwise = words[own] != words[model]
                if total[other] == total[earlier]:
                    row = _difference(is_otherwise, state[own], state[model])
                else:
                    # A block that moves nothing hands its ramp to the next one.
                    is_otherwise |= state[own] % _COMPENSATION != state[model] % _COMPENSATION
                    row = int(np.argmax(is_otherwise)) if np.count_nonzero(is_otherwise) == 1 else None
                    if row is not None and _lacks_word(values[:, rows[model[row]]], values[:, rows[own[row]]]):
                        own, model = model, own
                    if row is not None and not _is_slip(trace, rows[own[row]], rows[model[row]], values):
                        row = None
                if row is not None and trace.run.block[rows[own[row]]] != trace.run.block[rows[model[row]]]:
                    yield WrittenDifference(rows[own], rows[model], row)
                    break


def _mixed(values: Floats) -> _Hash:
    """Numbers as bits without order; 0 for none."""
    bits = np.rint(np.nan_to_num(values, nan=0.0) * 10**_DIGITS).astype(np.int64).astype(np.uint64)
    bits = (bits + np.uint64(1)) * np.uint64(0x9E3779B97F4A7C15)
    bits ^= bits >> np.uint64(29)
    return np.where(np.isnan(values), np.uint64(0), bits * np.uint64(0xBF58476D1CE4E5B9))


def _odd(count: int) -> _Hash:
    return np.asarray(2 * np.arange(count, dtype=np.uint64) + np.uint64(1))


def _states(trace: Trace) -> Rows:
    """What is in force in each row, as one number."""
    compensation = trace.compensation
    phase = 4 * (compensation.side != Side.OFF) + 2 * compensation.starts_up + compensation.cancels
    return np.asarray(trace.axes.motion + _STEP * trace.modal.is_step("X") + _COMPENSATION * phase, np.int64)


def _difference(is_otherwise: NDArray[np.bool_], own: Rows, model: Rows) -> int | None:
    """The first block that differs, where one slip of a code or of two blocks explains that; None where none does."""
    differs = np.flatnonzero(is_otherwise | (own != model))
    phases = own // _COMPENSATION != model // _COMPENSATION
    # G91 holds up to the end of the pass.
    is_of_steps = not is_otherwise.any() and bool(((own ^ model)[differs] == _STEP).all())
    least = 1 if is_of_steps else _ALIKE
    if np.ptp(differs) + 1 != len(differs) or len(own) - len(differs) < least:
        return None
    if max(np.count_nonzero(is_otherwise), np.count_nonzero(phases)) > _DIFFERING:
        return None
    return int(differs[0])


def _lacks_word(ours: Floats, theirs: Floats) -> bool:
    """A block has the words of another one but for one that it lacks."""
    same = (ours == theirs) | (np.isnan(ours) & np.isnan(theirs))
    return bool(np.count_nonzero(~same) == 1 and np.isnan(ours[~same][0]))


def _is_slip(trace: Trace, row: int, model: int, values: Floats) -> bool:
    """A block of a contour leads elsewhere than that of the model, since a word is missing or its number is a slip."""
    if trace.compensation.cancels[row] or not abs(trace.path.end[row] - trace.path.end[model]) > _APART:
        return False
    ours, theirs = values[:, row], values[:, model]
    if _lacks_word(ours, theirs):
        return True
    odd = np.flatnonzero((ours != theirs) & ~(np.isnan(ours) & np.isnan(theirs)))
    if len(odd) != 1 or np.isnan(theirs[odd[0]]):
        return False
    from polarcheck.columns.words.slips import plain_number, slip_of  # few passes differ

    slip = slip_of(plain_number(float(ours[odd[0]])), float(theirs[odd[0]]), _ROUNDING)
    return slip is not None and slip.plain
