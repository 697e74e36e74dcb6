"""The path of the tool center as arrays, made of the moves of a trace or of a golden trace."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows
from polarcheck.foundation.states import FeedMode, Motion
from polarcheck.reports.pages.executed import Move
from polarcheck.rewrite.certify.golden import GoldenMove
from polarcheck.rewrite.compare.compared_sections import FedPath

_KINDS = {"line": Motion.LINE, "cw": Motion.CW, "ccw": Motion.CCW}


class ToolPath(FedPath, frozen=True):
    """
    Moves of the tool center; row is the line of the block, 0 in a golden trace.

    section: number of the polar section, counted over all channels.
    is_programmed: the programmed path in the place of the tool's, since R is unknown.
    turned: float64[sections], angle of the plane of each section on the part [deg]; NaN unknown.
    """

    _shared = ("turned",)

    section: Rows
    is_programmed: Mask
    turned: Floats

    def of_section(self, number: int) -> ToolPath:
        """Return the moves of a section, with the angles of all of them."""
        return self[self.section == number]

    def by_degrees(self, angle: float) -> ToolPath:
        """Return the moves turned about the center of C by an angle [deg]."""
        return self.turned_by(np.exp(1j * np.radians(angle)))

    @property
    def farthest(self) -> float:
        """The largest distance of its corners from the center of C [mm]."""
        return float(np.abs(self.end).max(initial=0.0))


def tool_path(moves: Sequence[Move] | Sequence[GoldenMove], sense: int = 1) -> ToolPath:
    """
    Return the path of moves.

    sense: 1 where C of the machine grows with the angle on the plane, -1 where it falls.
    """
    names: dict[tuple[object, int], int] = {}
    section = np.array([names.setdefault((move.channel, move.section), len(names)) for move in moves], np.intp)
    start, end = _points([move.start for move in moves]), _points([move.end for move in moves])
    c_from = _numbers([move.c_axis[0] for move in moves])
    turned = np.full(len(names), np.nan)
    angles = (sense * c_from - np.degrees(np.angle(start)) + 180) % 360 - 180
    for row in np.flatnonzero(~np.isnan(angles) & (np.abs(start) > _CENTER))[::-1]:
        turned[section[row]] = angles[row]
    return ToolPath(
        start=start,
        end=end,
        center=_points([move.center or (None, None) for move in moves]),
        kind=np.array([_KINDS.get(move.kind, Motion.LINE) for move in moves], np.int16),
        z_start=_numbers([move.z[0] for move in moves]),
        z_end=_numbers([move.z[1] for move in moves]),
        row=np.array([getattr(move, "line", 0) for move in moves], np.intp),
        rapid=np.array([move.x_feed is None and move.feed is not None for move in moves], bool),
        feed_mode=np.full(len(moves), FeedMode.PER_MINUTE, np.int16),
        feed=_numbers([move.feed for move in moves]),
        section=section,
        is_programmed=np.array([move.path == "programmed" for move in moves], bool),
        turned=turned,
    )


#: Nearer to the center than this [mm] a point has no direction.
_CENTER = 1e-3


def _numbers(values: Sequence[float | None]) -> Floats:
    return np.array([np.nan if value is None else value for value in values], np.float64)


def _points(pairs: Sequence[Sequence[float | None]]) -> Points:
    return np.asarray(_numbers([pair[0] for pair in pairs]) + 1j * _numbers([pair[1] for pair in pairs]))
