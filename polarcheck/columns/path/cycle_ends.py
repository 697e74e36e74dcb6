"""
Cycles of turning end where they began: those of one block, each repeat of them, and the multiple repetitive cycles.

The blocks that a multiple repetitive cycle names by P and Q are its contour. Where they stand behind it the cycle has
run them, and the program goes on behind them from where the cycle began (B-63944EN, multiple repetitive cycles). On
other controls codes begin and end a contour, which a cycle names: NLAP1 G81 .. G80.
"""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before, fill_down, happened, positions
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.modal import ModalStates
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property
from polarcheck.foundation.states import Motion


class CycleEnds(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    blocks: ExecutedBlocks
    modal: ModalStates

    def _in_force(self, *keys: str) -> Mask:
        """A code of group 01 of these lists is in force; of two in a block the last counts."""
        begins = self.blocks.listed(*keys)
        if not begins.any():
            return begins
        is_cycle = self.modal.state("motion") == Motion.CYCLE
        return happened(begins & is_cycle, self.modal.sets("motion") | self.blocks.starts)

    @cached_property
    def returns(self) -> Mask:
        """The row ends where it begins: its X and Z say where a cycle cuts."""
        of_one_block = self._in_force("turning_cycle", "threading_cycle", "facing_cycle")
        return np.asarray(of_one_block | self.blocks.listed("repetitive_cycle"))

    def loses(self, axis: str, increment: str) -> Mask:
        """
        Rows after which it is not known where an axis is: a motion in force whose end is not followed, neither a cycle
        that returns nor a thread cut in one pass, or a drilling cycle that names the axis.
        """
        is_cycle = self.modal.in_cycle
        if not is_cycle.any():
            return is_cycle
        drills = self.modal.drilling != 0
        ends = self.modal.sets("drilling") | self.modal.sets("motion") | self.blocks.starts
        names = happened(drills & self.blocks.has(axis, increment), ends)
        is_followed = self.returns | self._in_force("thread_cutting")
        return np.asarray(is_cycle & np.where(drills, names, ~is_followed))

    @cached_property
    def contour(self) -> Mask:
        """Rows of a contour that codes begin and end, or that stands behind its cycle with no move between."""
        blocks = self.blocks
        begins, ends = blocks.listed("cycle_contour"), blocks.listed("cycle_contour_off") | blocks.starts
        return self._named | (happened(begins, ends) if begins.any() else begins)

    @property
    def _named(self) -> Mask:
        """Rows of a contour that P and Q of a cycle above name."""
        blocks = self.blocks
        names = blocks.listed("repetitive_cycle") & blocks.has("P") & blocks.has("Q") & ~blocks.has("X", "Z")
        rows = np.flatnonzero(names & ~np.isnan(blocks.word("P") + blocks.word("Q")))
        if not len(rows):
            return blocks.nowhere
        moves = np.cumsum(self.modal.uses_axes & blocks.has("X", "Z", "U", "W"))
        first = self._following(blocks.word("P")[rows], rows)
        last = self._following(blocks.word("Q")[rows], first)
        is_whole = (last < len(blocks)) & (moves[first - 1] == moves[rows])
        first, last = first[is_whole], last[is_whole]
        is_whole = blocks.program[last] == blocks.program[rows[is_whole]]
        steps = np.zeros(len(blocks) + 1, np.int64)
        np.add.at(steps, first[is_whole], 1)
        np.add.at(steps, last[is_whole] + 1, -1)
        return np.cumsum(steps)[:-1] > 0

    def _following(self, number: Floats, rows: Rows) -> Rows:
        """The first row behind each of `rows` with this sequence number; the number of rows for none."""
        written, count = self.blocks.word("N"), len(self.blocks)
        numbered = np.flatnonzero(~np.isnan(written))
        keys = np.sort(written[numbered] * (count + 1) + numbered)
        index = np.searchsorted(keys, number * (count + 1) + rows, side="right")
        key = np.append(keys, np.inf)[index]
        is_found = np.floor(key / (count + 1)) == number
        return np.where(is_found, np.where(is_found, key, 0) - number * (count + 1), count).astype(np.int64)

    def without_contours(self, absolute: Floats, steps: Floats) -> tuple[Floats, Floats]:
        """The words of an axis, as filling.positions takes them, where the tool goes by them itself."""
        if not self.contour.any():
            return absolute, steps
        return np.where(self.contour, np.nan, absolute), np.where(self.contour, 0.0, steps)

    def with_contours(self, stays: Floats, absolute: Floats, steps: Floats, resets: Mask, values: Floats) -> Floats:
        """
        An axis after each row: along contours where their words lead from the start of the cycle, elsewhere `stays`.

        The other arguments are those of filling.positions.
        """
        if not self.contour.any():
            return stays
        first = self.contour & ~before(self.contour, self.blocks.starts, False)
        at_start = np.where(first, before(stays, self.blocks.starts, np.nan), values)
        return np.where(self.contour, positions(absolute, steps, resets | first, at_start), stays)

    def before(self, after: Floats) -> Floats:
        """An axis before each row, from where it is after each: behind a contour where its cycle began."""
        above = before(after, self.blocks.starts, np.nan)
        if not self.contour.any():
            return above
        stays = fill_down(after, ~self.contour | self.blocks.starts, np.nan)
        return np.where(self.contour, above, before(stays, self.blocks.starts, np.nan))


def or_of_cycle(place: Floats, of_cycle: Floats) -> Floats:
    """Where an axis goes: in a cycle to the end of its cut, from which it comes back."""
    return np.where(np.isnan(of_cycle), place, of_cycle)
