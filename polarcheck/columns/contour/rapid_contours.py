"""Contours that run in rapid traverse at depth, on controls that take G0 in the mode."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, cached_property, column_at, folded
from polarcheck.foundation.states import Motion
from polarcheck.geometry import polar

#: A tip less far below the face than this is above the metal [mm].
_CLEARANCE = 0.01
#: Distances from the center that differ by less are one [mm].
_SAME = 0.02
#: Moves in a row that count as a contour outside offset mode.
_SEVERAL = 3


class RapidContours(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    bar: Bar

    @cached_property
    def along_contour(self) -> Mask:
        """
        Moves in rapid traverse at depth that run where a contour is.

        They come as near to the center as the moves at feed do, in offset mode, or several in a row. Moves that only
        lead away from the center or towards it approach or leave a contour, as do start-ups and offset cancels.
        """
        trace = self.trace
        path, compensation = trace.path, trace.compensation
        at_depth = trace.mode.in_polar & path.travels & (path.z < self._face - _CLEARANCE)
        rapid = at_depth & (trace.axes.motion == Motion.RAPID) & ~trace.modal.in_cycle & ~path.moves_z
        if not rapid.any():
            return np.asarray(rapid)
        nearest = polar.nearest(
            path.start[at_depth], path.end[at_depth], path.center[at_depth], trace.axes.motion[at_depth]
        )
        near = column_at(len(trace), at_depth, nearest, np.nan)
        ramps = compensation.starts_up | compensation.cancels
        at_feed = at_depth & (trace.axes.motion != Motion.RAPID) & ~ramps
        # Without any move at feed the contour is all that the section has.
        reach = folded(np.fmax, trace.mode.section[at_feed], near[at_feed], len(trace.mode.sections) + 1, -np.inf)
        reach[np.isinf(reach)] = np.inf
        inside = rapid & ~ramps & (near < reach[trace.mode.section] + _SAME)
        goes_straight = near >= np.fmin(np.abs(path.start), np.abs(path.end)) - _SAME
        run = np.cumsum(~inside & (path.travels | trace.mode.enters | trace.blocks.starts))
        length = np.bincount(run[inside], minlength=int(run[-1]) + 1)[run]
        in_offset_mode = compensation.compensates & (~goes_straight | (length > 1))
        return np.asarray(inside & (in_offset_mode | (length >= _SEVERAL)))

    @property
    def _face(self) -> float:
        """Z of the face of the bar [mm]; at Z0, as is usual on lathes, where nothing says another."""
        face = self.bar.known.face
        return 0.0 if np.isnan(face) else face
