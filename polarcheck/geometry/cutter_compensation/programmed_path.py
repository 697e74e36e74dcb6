"""The programmed path as cutter compensation reads it: the blocks that move in the plane, and what lies between."""

from __future__ import annotations

from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, Table, column_at
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.tolerances import ROUNDING, ZERO


class Method(msgspec.Struct, frozen=True):
    """How the control compensates; all from the machine profile."""

    #: Start-up and cancel, No. 5003 #0 SUP, #1 SUV: "A", "B", or "C", where G41 or G40 alone shifts the tool at once.
    start_up: str = "A"
    #: What "C" does in a block with movement: "A" or "B".
    start_up_moving: str = "A"
    #: Blocks N that the control knows, No. 19625, 3 or more: N - 2 without movement do no harm (B-63944EN-2 p. 146).
    read_ahead: int = 3
    #: After a pair of vectors that interferes, No. 5008: "alarm", "erase" (drop vectors, else alarm), "ignore".
    interference: str = "alarm"
    #: Turn [rad] above which an outer corner by intersection becomes an arc.
    arc_above: float = np.pi
    #: Turn [rad] below which an outer corner by an arc becomes an intersection.
    arc_from: float = 0.0
    #: Turn [rad] below which curves that do not meet raise no alarm; rounding to 0.001 mm turns tangents by 1e-4.
    tangent_tolerance: float = 1e-3

    @property
    def ramps_by_next(self) -> bool:
        """Type A: the start-up ends perpendicular to the next block, the cancel begins perpendicular to the last."""
        return (self.start_up_moving if self.start_up == "C" else self.start_up) == "A"

    @property
    def shifts_at_once(self) -> bool:
        """Type C: G41, G42 or G40 in a block without movement moves the tool."""
        return self.start_up == "C"


class Path(Table, frozen=True):
    """
    Rows of the polar sections in order, one per executed block; all arrays of one length n.

    section: int[n]. motion: int16[n], Motion of the row; RAPID counts as LINE.
    moves: bool[n], the row commands X or C, be it by no length; False for Z, M, S, T, dwell alone.
    start, end, center: complex128[n] [mm], programmed plane points; center NaN for lines; NaN = unknown.
    An arc without length and center, as by R with the end at the start, does not move.
    side: int16[n], Side in force after the row's own code. side_written: bool[n], the row has G41 or G42 itself.
    radius: float64[n] [mm], R of the offset in force, signed; NaN = unknown.
    cancel_vector: complex128[n], I + jJ beside G40, else NaN.
    stops_reading: bool[n], the control reads no further (M00, M01, M30, ...) before the row is done.
    corner: int16[n], Corner: how an outer corner at the start of the row is passed.
    """

    section: Rows
    motion: States
    moves: Mask
    start: Points
    end: Points
    center: Points
    side: States
    side_written: Mask
    radius: Floats
    cancel_vector: Points
    stops_reading: Mask
    corner: States


class Programmed(msgspec.Struct, frozen=True):
    """
    The m rows of a Path that move, by a length or round a full circle; all arrays of length m.

    row: into Path. turning: 1 CCW, -1 CW, 0 line. leaving, arriving: unit tangents at start and end.
    full: a full circle. known: points, and R where it counts. side: 1 left, -1 right, with the sign of R. radius: |R|.
    on: G41 or G42 in force. cancel_vector: unit vector of I, J, else NaN. corner: Corner, of the junction before it.

    Of the way to the next row: has_next, in the same section. cancelled: a G40 without movement lies between.
    read: the control knows the next row in time. written: G41 or G42 written again.

    Of the way from the row before: before_on, begins in offset mode. left_over: begins at the vector that a G40
    without movement left. For type C, Path rows without movement that move the tool, else -1: shifts_at, the G41 or G42
    before this row; clears_at, the G40 after it.
    """

    row: Rows
    start: Points
    end: Points
    center: Points
    turning: Floats
    leaving: Points
    arriving: Points
    full: Mask
    known: Mask
    on: Mask
    side: Floats
    radius: Floats
    cancel_vector: Points
    corner: States
    has_next: Mask
    cancelled: Mask
    read: Mask
    written: Mask
    before_on: Mask
    left_over: Mask
    shifts_at: Rows
    clears_at: Rows

    @property
    def is_arc(self) -> Mask:
        """Rows that turn about a center."""
        return np.asarray(self.turning != 0)


def moving_rows(path: Path, method: Method) -> tuple[Programmed, Mask]:
    """The rows that move, and which rows of the path are arcs whose center is their start or end."""
    is_arc, center_on_path = _arcs(path)
    step = path.end - path.start
    distance = np.abs(step)
    still = distance <= ZERO
    full = still & is_arc & ~np.isnan(path.center)
    moving = path.moves & (~still | full)
    row = np.flatnonzero(moving)
    start, end = path.start[row], path.end[row]
    turning = np.where(is_arc[row], np.where(path.motion[row] == Motion.CCW, 1.0, -1.0), 0.0)
    center = np.where(turning != 0, path.center[row], complex(np.nan, np.nan))
    leaving = step[row] / distance[row]
    arriving = leaving.copy()
    arcs = np.flatnonzero(turning)
    leaving[arcs] = _tangent(start[arcs], center[arcs], turning[arcs])
    arriving[arcs] = _tangent(end[arcs], center[arcs], turning[arcs])
    on = path.side[row] != Side.OFF
    radius = path.radius[row]
    programmed = Programmed(
        row=row,
        start=start,
        end=end,
        center=center,
        turning=turning,
        leaving=leaving,
        arriving=arriving,
        full=full[row],
        known=~np.isnan(leaving + arriving) & ~(on & np.isnan(radius)),
        on=on,
        # A negative R exchanges G41 and G42 (FANUC 16/18-C mill manual p. 302).
        side=np.where((path.side[row] == Side.LEFT) ^ (radius < 0), 1.0, -1.0),
        radius=np.abs(radius),
        cancel_vector=_directions_given(path.cancel_vector[row]),
        corner=path.corner[row],
        **_links(path, row, on, method),
    )
    return programmed, center_on_path & path.moves


def _arcs(path: Path) -> tuple[Mask, Mask]:
    """Rows that turn about a center; arcs that do not, since the center is their start or end (PS0038)."""
    is_arc = (path.motion == Motion.CW) | (path.motion == Motion.CCW)
    rows = np.flatnonzero(is_arc)
    center = path.center[rows]
    near = np.minimum(np.abs(center - path.start[rows]), np.abs(center - path.end[rows])) <= ROUNDING
    on_path = column_at(len(is_arc), rows, near, False)
    return np.asarray(is_arc & ~on_path), on_path


def _tangent(point: Points, center: Points, turning: Floats) -> Points:
    return 1j * turning * _direction(point - center)


def _direction(vector: Points) -> Points:
    """Unit vector; NaN for no or an unknown vector."""
    length = np.abs(vector)
    return vector / np.where(length > 0, length, np.nan)


def _directions_given(vector: Points) -> Points:
    """The same where few are given."""
    result = np.full_like(vector, complex(np.nan, np.nan))
    given = np.flatnonzero(~np.isnan(vector))
    result[given] = _direction(vector[given])
    return result


def _links(path: Path, row: Rows, on: Mask, method: Method) -> dict[str, Any]:
    """The columns of Programmed for the step from one moving row to the next."""
    off = path.side == Side.OFF
    writes_side = path.side_written & ~off
    between, gap = _between(row, len(off))

    def in_gap(values: NDArray[Any]) -> NDArray[Any]:
        """Sum over the rows between each moving row and the next."""
        return np.bincount(gap, values, minlength=len(row))

    has_next = np.append(path.section[row[1:]] == path.section[row[:-1]], False)[: len(row)]
    # A block without movement counts one, a move of no length two (FANUC 16i-LB B-63664EN p. 170).
    tolerated = in_gap(np.where(path.moves[between], 2, 1)) <= max(method.read_ahead, 3) - 2
    stopped = path.stops_reading[row] | (in_gap(path.stops_reading[between]) > 0)
    cancelled = has_next & (in_gap(off[between]) > 0)
    written = in_gap(writes_side[between]) > 0
    written[:-1] |= writes_side[row[1:]]
    before_on = np.append(False, on & has_next & ~cancelled)[:-1]
    left_over = np.append(False, on & has_next & cancelled & (not method.shifts_at_once))[:-1]
    shifts_at, clears_at = np.full(len(row), -1), np.full(len(row), -1)
    if method.shifts_at_once:
        switched_at = _switched_at(path.section, off)[row]
        shifts_at = np.where(on & ~before_on & (switched_at < row), switched_at, -1)
        clears_at = _clears_at(path.section, off, row, on)
    return {
        "has_next": has_next,
        "cancelled": cancelled,
        "read": tolerated & ~stopped,
        "written": written,
        "before_on": before_on | (shifts_at >= 0),
        "left_over": left_over,
        "shifts_at": shifts_at,
        "clears_at": clears_at,
    }


def _between(row: Rows, count: int) -> tuple[Rows, Rows]:
    """The rows between two moving ones, few in most programs, and for each the number of the one before it."""
    between = np.delete(np.arange(count), row)
    gap = np.searchsorted(row, between) - 1
    inside = (gap >= 0) & (gap < len(row) - 1)
    return between[inside], gap[inside]


def _switched_at(section: Rows, off: Mask) -> Rows:
    """Per row, the first row of its section since which no row is off."""
    rows = np.arange(len(off))
    begins = np.append(0, np.where(section[1:] != section[:-1], rows[1:], 0))[: len(off)]
    return np.maximum.accumulate(np.maximum(np.where(off, rows + 1, 0), begins))


def _clears_at(section: Rows, off: Mask, row: Rows, on: Mask) -> Rows:
    """Per moving row, the first row without movement after it in which its side goes off; -1 for none."""
    goes_off = np.flatnonzero(off[1:] & ~off[:-1] & (section[1:] == section[:-1])) + 1
    last = np.searchsorted(row, goes_off, side="right") - 1
    goes_off, last = goes_off[last >= 0], last[last >= 0]
    alone = (row[last] != goes_off) & (section[row[last]] == section[goes_off]) & on[last]
    # Backwards, so that of several G40 the first one stays.
    return column_at(len(row), last[alone][::-1], goes_off[alone][::-1], -1)


def fits(programmed: Programmed, rows: Rows, side: Floats, radius: Floats) -> Mask:
    """Which of these moves leave a path to a tool of this radius [mm] on this side: R inside an arc must be smaller."""
    arcs = np.flatnonzero(programmed.turning[rows])
    of = rows[arcs]
    center = programmed.center[of]
    arc_radius = np.minimum(np.abs(programmed.start[of] - center), np.abs(programmed.end[of] - center))
    inside = side[arcs] * programmed.turning[of] * radius[arcs]
    return column_at(len(rows), arcs, ~(arc_radius - inside <= ROUNDING) | (radius[arcs] == 0), True)
