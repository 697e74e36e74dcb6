"""Blocks among optional ones, which begin with /, that have no / of their own."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, cached_property, runs
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ROUNDING

#: Optional blocks on either side, and in all, that show that the block between them is one of them.
_BESIDE, _LEAST = 2, 5


class SkippedBlocks(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    @cached_property
    def _begin_with_slash(self) -> Mask:
        """Per block of the text: block skip leaves it out; / stands first, or behind N."""
        words, count = self.trace.text.words, len(self.trace.text.blocks)
        optional = np.zeros(count, bool)
        slashes = np.flatnonzero(words.address == ord("/"))
        if len(slashes):
            position = slashes - np.searchsorted(words.block, words.block[slashes])
            is_second = (position == 1) & (words.address[slashes - 1] == ord("N"))
            optional[words.block[slashes[(position == 0) | is_second]]] = True
        return optional

    @cached_property
    def _alone(self) -> dict[int, int]:
        """
        Blocks of the text that stand alone between optional ones, each with the number of blocks before it that are.

        Not where another such block stands beside the same optional ones: then some of them alone are left out.
        """
        text, optional = self.trace.text, self._begin_with_slash
        if not optional.any():
            return {}
        filled = text.blocks.is_macro.copy()
        filled[text.words.block] = True
        blocks = np.flatnonzero(filled)
        first, last = runs(optional[blocks])
        count = last - first + 1
        alone = ~optional[blocks[first]] & (count == 1)
        found = {}
        for group in np.flatnonzero(alone[1:-1]).tolist():
            before, after = int(count[group]), int(count[group + 2])
            rivals = alone[[max(group - 1, 0), min(group + 3, len(alone) - 1)]]
            rivals[1] &= group + 3 < len(alone) - 1
            if min(before, after) >= _BESIDE and before + after >= _LEAST and not rivals.any():
                found[int(blocks[first[group + 1]])] = before
        return found

    @cached_property
    def lacks_skip(self) -> Mask:
        """
        Rows of these blocks that stand in a section, or move at feed outside, and that would move the tool where the
        optional blocks are skipped.
        """
        trace, mask = self.trace, np.zeros(len(self.trace), bool)
        for block, before in self._alone.items():
            for row in np.flatnonzero(trace.run.block == block).tolist():
                is_skipped = not row or not self._begin_with_slash[trace.run.block[row - 1]]
                moves = self._moves_from(row, row) if is_skipped else self._moves_from(row, max(row - before, 0))
                at_feed = trace.axes.motion[row] != Motion.RAPID
                mask[row] = moves and (at_feed if is_skipped else self._is_within(row))
        return mask

    def _is_within(self, row: int) -> bool:
        """The row stands in a section, as its neighbours do."""
        section, switches = self.trace.mode.section, self.trace.mode.enters | self.trace.mode.leaves
        return bool(section[row] >= 0 and (section[row - 1 : row + 2] == section[row]).all() and not switches[row])

    def _moves_from(self, row: int, first: int) -> bool:
        """A row leads elsewhere than where the tool stands before another row."""
        path, axes, section = self.trace.path, self.trace.axes, self.trace.mode.section
        if path.moves_z[row] and not abs(path.z[row] - path.z_before[first]) <= ROUNDING:
            return True
        if not axes.moves_plane[row]:
            return False
        if section[row] >= 0 and section[first] == section[row] and not self.trace.mode.enters[first]:
            way = path.end[row] - path.start[first]
            along, across = axes.programs_linear_axis[row], axes.has_virtual_word[row]
            return not abs(complex(way.real * along, way.imag * across)) <= ROUNDING
        # Without G12.1, which is skipped as well, C is an angle.
        x = path.end[row].real if section[row] >= 0 else path.x[row]
        return bool(axes.has_virtual_word[row]) or not abs(x - path.x_before[first]) <= ROUNDING
