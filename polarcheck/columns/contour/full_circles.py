"""Full circles whose I and J are others than what the program round them says."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Points, Rows, cached_property
from polarcheck.foundation.states import Side
from polarcheck.geometry.tolerances import ROUNDING

#: Points nearer to each other than this are one [mm].
_SAME = 2e-3
#: I and J that may be meant, as shares of those that are written.
_SHARES = (0.5, 2.0)
#: Circles at other depths that say where the center of one is.
_LEAST_LIKES = 2
#: More circles than these are compared with nothing.
_MOST = 2000


class Intended(NamedTuple):
    """
    The circle that was meant.

    share: its I and J by those that are written. center: its center [mm]. other: a row with a like circle round the
    point from which the tool came to it; -1 where the center is that of C.
    """

    share: float
    center: complex
    other: int


class FullCircles(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    arcs: Arcs

    @cached_property
    def row(self) -> Rows:
        """Full circles by I and J, of known center."""
        path = self.trace.path
        circles = self.arcs.by_center & self.arcs.ends_at_start & ~self.arcs.is_no_circle & self.trace.mode.is_followed
        return np.flatnonzero(circles & ~np.isnan(path.start + path.center))

    @cached_property
    def _lead(self) -> Rows:
        """Per circle the move of its section that ends where it begins; -1 where there is none."""
        path, section = self.trace.path, self.trace.mode.section
        moves = np.append(-1, np.flatnonzero(path.travels))
        before = moves[np.searchsorted(moves, self.row) - 1]
        joined = (before >= 0) & (section[before] == section[self.row]) & ~path.is_arc[before]
        return np.where(joined & (np.abs(path.end[before] - self._start) <= _SAME), before, -1)

    @cached_property
    def _came_from(self) -> Points:
        """Per circle the point from which one move leads to its start, and another one back behind it; else NaN."""
        path, section = self.trace.path, self.trace.mode.section
        moves = np.append(np.flatnonzero(path.travels), -1)
        after = moves[np.searchsorted(moves[:-1], self.row, side="right")]
        origin = np.where(self._lead >= 0, path.start[self._lead], complex("nan+nanj"))
        returns = (after >= 0) & (section[after] == section[self.row]) & (np.abs(path.end[after] - origin) <= _SAME)
        return np.where(returns, origin, complex("nan+nanj"))

    def _is_round_axis(self, index: int) -> bool:
        """
        A circle that is not round the center of C is meant to be. An eccentric one may have these sizes, too.

        Another circle is round it; or G41 or G42 leads from inside to it, and its center is not where the tool comes
        from; or from outside, and it would go farther from the center of C than the tool has come from.
        """
        path, section = self.trace.path, self.trace.mode.section
        row, lead = int(self.row[index]), int(self._lead[index])
        if (np.abs(path.center[self.row]) <= _SAME).any():
            return True
        if lead < 0 or self.trace.compensation.side[row] == Side.OFF:
            return False
        center, size = complex(path.center[row]), abs(path.center[row] - path.start[row])
        earlier = path.start[:row][path.travels[:row] & (section[:row] == section[row])]
        is_inside = abs(complex(path.start[lead]) - center) < size
        return bool(is_inside or abs(center) + size > np.abs(earlier).max(initial=0) + ROUNDING)

    @property
    def _start(self) -> Points:
        return self.trace.path.start[self.row]

    @cached_property
    def intended(self) -> dict[int, Intended]:
        """By row the circles with another center than what is round them says."""
        path = self.trace.path
        intended: dict[int, Intended] = {}
        if not 0 < len(self.row) <= _MOST:
            return intended
        start, center, origin = self._start, path.center[self.row], self._came_from
        is_round_origin = np.abs(center - origin) <= _SAME
        call = self.trace.tools.tool_called[self.row]
        # Several circles round one center, of other sizes, say that it is meant.
        same = np.abs(center[:, None] - center) <= _SAME
        is_shared = (same & (np.abs(np.abs(center - start)[:, None] - np.abs(center - start)) > _SAME)).any(axis=1)
        for index in np.flatnonzero((np.abs(center) > _SAME) & ~is_round_origin & ~is_shared).tolist():
            for share in _SHARES:
                point = complex(start[index] + (center[index] - start[index]) * share)
                likes = np.flatnonzero(is_round_origin & (call == call[index]))
                if abs(point) <= _SAME and abs(start[index]) > ROUNDING and self._is_round_axis(index):
                    intended[int(self.row[index])] = Intended(share, point, -1)
                elif abs(point - origin[index]) <= _SAME and len(likes):
                    intended[int(self.row[index])] = Intended(share, point, int(self.row[likes[0]]))
            if int(self.row[index]) not in intended and (
                found := self._round_origin(index, is_round_origin) or self._at_other_depths(index)
            ):
                intended[int(self.row[index])] = found
        return intended

    def _round_origin(self, index: int, is_round_origin: Mask) -> Intended | None:
        """The circle round the point from which the tool comes, where other circles are, as far from such points."""
        start, origin = complex(self._start[index]), complex(self._came_from[index])
        center, call = complex(self.trace.path.center[self.row[index]]), self.trace.tools.tool_called[self.row]
        reach, share = abs(origin - start), (origin - start) / (center - start)
        as_far = np.abs(np.abs(self._came_from - self._start) - reach) <= _SAME
        likes = np.flatnonzero(is_round_origin & as_far & (call == call[index]))
        if not len(likes) or not abs(share.imag) * abs(center - start) <= _SAME:
            return None
        if len(likes) == 1:
            from polarcheck.columns.words.slips import plain_number, slip_of  # few circles are odd

            scale = float(self.trace.lengths.scale[self.row[index]])
            slip = slip_of(plain_number(abs(center - start) / scale), reach / scale, _SAME)
            if not (slip is not None and slip.plain) and abs(share + 1) * reach > _SAME:
                return None
        return Intended(share.real, origin, int(self.row[likes[0]]))

    def _at_other_depths(self, index: int) -> Intended | None:
        """The circle that others of the tool are, from the same point at other depths, all round one center."""
        trace, start, center = self.trace, self._start, self.trace.path.center[self.row]
        z, call = trace.path.z[self.row], trace.tools.tool_called[self.row]
        likes = np.flatnonzero((np.abs(start - start[index]) <= _SAME) & (call == call[index]))
        likes = likes[likes != index]
        if len(likes) < _LEAST_LIKES or np.abs(center[likes] - center[likes[0]]).max() > _SAME:
            return None
        share = complex((center[likes[0]] - start[index]) / (center[index] - start[index]))
        is_elsewhere = abs(center[likes[0]] - center[index]) > _SAME and np.abs(z[likes] - z[index]).min() > ROUNDING
        is_along = abs(share.imag) * abs(center[index] - start[index]) <= _SAME
        return (
            Intended(share.real, complex(center[likes[0]]), int(self.row[likes[0]]))
            if is_elsewhere and is_along
            else None
        )

    @cached_property
    def is_misplaced(self) -> Mask:
        """Rows of these circles."""
        return self.trace.blocks.mask_of(sorted(self.intended))
