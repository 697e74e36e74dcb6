"""The bar that a comment states, compared with what the program turns, and with the reach of its contours."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.finished import Finished
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.comment_reader import tolerance_of
from polarcheck.columns.words.stock_comments import StockComments
from polarcheck.foundation.arrays import Columns
from polarcheck.geometry.shapes.side_rings import nearest_of, rings

#: Centers nearer to the axis are on it [mm].
_OFF_AXIS = 0.25


class StatedBars(Columns, frozen=True):
    """The bar of the comment of the program of the first section; that program has one."""

    trace: Trace
    stock_comments: StockComments
    bar: Bar
    finished: Finished

    @property
    def _row(self) -> int:
        return int(self.trace.mode.sections.enter[0])

    @property
    def stated(self) -> float:
        """The diameter, or across the flats of a hexagon [mm]."""
        across_flats = float(self.stock_comments.across_flats[self._row])
        return float(self.stock_comments.diameter[self._row]) if np.isnan(across_flats) else across_flats

    @property
    def _largest(self) -> float:
        """The diameter that no part exceeds [mm]: a hexagon reaches out to its corners."""
        across_flats = float(self.stock_comments.across_flats[self._row])
        size = float(np.fmax(self.stock_comments.diameter[self._row], across_flats * 2 / np.sqrt(3)))
        return size + tolerance_of(size)

    def turned(self) -> Iterator[tuple[int, float]]:
        """The first row that turns to a larger diameter, and that diameter [mm]."""
        stock = self.bar.known
        if stock.source == "turning" and stock.smallest > self._largest:
            turns = np.flatnonzero(self.trace.blocks.line_in_file == stock.lines[0])
            yield int(turns[0]), stock.smallest

    def beyond(self) -> Iterator[tuple[int, float]]:
        """
        The first row of the contour whose part reaches beyond the bar, and the diameter that it needs [mm].

        None where another contour of the program stays within. Straight sides may end beyond the bar, and an arc around
        the axis goes round it; a corner arc there is for nothing, and so is a whole contour.
        """
        radius = self._largest / 2
        if self.bar.known.source != "comment" or not self._may_be_beyond(radius):
            return
        hits = []
        for level in self.finished.levels:
            for ring in rings(level.outline, level.gap) if not (level.tangled or level.open) else ():
                if not ring.closed or ring.inside:
                    continue
                nearest = nearest_of(ring)
                is_beyond = nearest > radius
                is_corner = ~ring.is_line & ~(np.abs(ring.center) <= _OFF_AXIS)
                if not is_beyond.all() and not (is_beyond & is_corner).any():
                    return
                hits.append((int(level.walls.row[0]), 2 * float(nearest[is_beyond].max())))
        yield from hits[:1]

    def _may_be_beyond(self, radius: float) -> bool:
        """A cheap test: some of a contour lies beyond this radius with both ends."""
        walls, _ = self.finished.overcuts.walls
        return bool(((np.abs(walls.start) > radius) & (np.abs(walls.end) > radius)).any())
