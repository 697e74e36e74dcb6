"""Passes written with the same numbers but for a code, a letter or the order of two blocks; or all but one word."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

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


class _Passes(NamedTuple):
    """
    Passes, n of them with m blocks in all.

    rows: int[m]. first, count: int[n], the blocks of each. words, state: [m], what is written, and what is in force.
    total, shape: [n], a number of what is written, in any order and in this one. values: float64[addresses, m].
    """

    trace: Trace
    rows: Rows
    first: Rows
    size: Rows
    words: _Hash
    state: Rows
    total: _Hash
    shape: _Hash
    values: Floats

    def blocks(self, number: int) -> Rows:
        """The blocks of a pass."""
        return np.arange(self.first[number], self.first[number] + self.size[number])

    def kinds(self, keys: list[Rows | _Hash]) -> Iterator[tuple[list[int], list[int]]]:
        """Of passes of equal keys one of each shape, the most frequent first, then the one above; how many have it."""
        chosen = np.flatnonzero((self.size >= _FEWEST) & (self.size <= _MOST))
        program = self.trace.blocks.program[self.rows[self.first]]
        columns = [key[chosen].astype(np.uint64) for key in (*keys, self.size, program)]
        _, group, members = np.unique(np.stack(columns, axis=1), axis=0, return_inverse=True, return_counts=True)
        for which in np.flatnonzero(members > 1).tolist():
            passes = chosen[group.reshape(-1) == which]
            _, begin, frequency = np.unique(self.shape[passes], return_index=True, return_counts=True)
            order = np.lexsort((begin, -frequency))
            yield passes[begin[order]].tolist(), frequency[order].tolist()

    def difference(self, own: Rows, model: Rows, at: int | None) -> WrittenDifference | None:
        """The difference of a pass in one of its blocks; None where both passes run the same block there."""
        if at is None or self.trace.run.block[self.rows[own[at]]] == self.trace.run.block[self.rows[model[at]]]:
            return None
        return WrittenDifference(self.rows[own], self.rows[model], at)

    def with_the_same_numbers(self) -> Iterator[WrittenDifference | None]:
        """The passes that differ from the most frequent one with the same numbers."""
        for passes, _ in self.kinds([self.total]):
            model = self.blocks(passes[0])
            for own in map(self.blocks, passes[1:]):
                at = _difference(self.words[own] != self.words[model], self.state[own], self.state[model])
                yield self.difference(own, model, at)

    def in_one_word(self) -> Iterator[WrittenDifference | None]:
        """The passes that differ from a more frequent one, or one as frequent, in one word."""
        for passes, frequency in self.kinds([]):
            for rank, other in enumerate(passes[:_SHAPES]):
                earlier = (number for number in range(rank) if self.total[passes[number]] != self.total[other])
                models = ((passes[number], frequency[number] == frequency[rank]) for number in earlier)
                found = (self._one_word(other, model, is_as_frequent) for model, is_as_frequent in models)
                yield next((difference for difference in found if difference is not None), None)

    def _one_word(self, other: int, earlier: int, is_as_frequent: bool) -> WrittenDifference | None:
        own, model = self.blocks(other), self.blocks(earlier)
        # A block that moves nothing hands its ramp to the next one.
        differs = self.state[own] % _COMPENSATION != self.state[model] % _COMPENSATION
        differs |= self.words[own] != self.words[model]
        if np.count_nonzero(differs) != 1:
            return None
        at = int(np.argmax(differs))
        if is_as_frequent and _lacks_word(self.values[:, model[at]], self.values[:, own[at]]):
            own, model = model, own
        return self.difference(own, model, at) if self._is_slip(int(own[at]), int(model[at])) else None

    def _is_slip(self, own: int, model: int) -> bool:
        """A block of a contour leads elsewhere than the model's, since a word is missing or its number is a slip."""
        path, row, its_row = self.trace.path, self.rows[own], self.rows[model]
        if self.trace.compensation.cancels[row] or not abs(path.end[row] - path.end[its_row]) > _APART:
            return False
        ours, theirs = self.values[:, own], self.values[:, model]
        if _lacks_word(ours, theirs):
            return True
        odd = np.flatnonzero((ours != theirs) & ~(np.isnan(ours) & np.isnan(theirs)))
        if len(odd) != 1 or np.isnan(theirs[odd[0]]):
            return False
        from polarcheck.columns.words.slips import plain_number, slip_of  # few passes differ

        slip = slip_of(plain_number(float(ours[odd[0]])), float(theirs[odd[0]]), _ROUNDING)
        return slip is not None and slip.plain


def written_differences(trace: Trace) -> Iterator[WrittenDifference]:
    """The passes that are written otherwise than one of as many blocks: the more frequent one, or the one above."""
    word, is_written = trace.blocks.word, np.zeros(len(trace), bool)
    for address in _ADDRESSES:
        is_written |= ~np.isnan(word(address))
    rows = np.flatnonzero(trace.mode.in_polar & is_written)
    begins = (trace.path.moves_z & ~trace.path.travels) | trace.mode.enters
    first = np.flatnonzero(np.diff(np.cumsum(begins)[rows], prepend=-1))
    count = np.diff(first, append=len(rows))
    if np.count_nonzero((count >= _FEWEST) & (count <= _MOST)) < 2:
        return
    values = np.stack([word(address)[rows] for address in _ADDRESSES])
    number = _mixed(values)
    words = np.add.reduce(number * _odd(len(_ADDRESSES))[:, None], axis=0, dtype=np.uint64)
    state = _states(trace)[rows]
    index = np.arange(len(rows)) - np.repeat(first, count)
    total = np.add.reduceat(np.add.reduce(number, axis=0, dtype=np.uint64), first)
    shape = np.add.reduceat(_mixed(index.astype(np.float64)) * (words + state.astype(np.uint64)), first)
    passes = _Passes(trace, rows, first, count, words, state, total, shape, values)
    yield from (one for one in chain(passes.with_the_same_numbers(), passes.in_one_word()) if one is not None)


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
