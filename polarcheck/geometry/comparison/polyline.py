"""Paths in space as polylines: lines and arcs of the polar plane with Z, arcs as chords."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, Table
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.states import Motion
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.plane import arc_sweep
from polarcheck.geometry.tolerances import CHORDS_OF_FILE, ZERO

#: The fewest chords of a full circle are three, the flattest chord turns by this angle [rad].
_LEAST_TURN, _LARGEST_TURN = 1e-6, 2 * np.pi / 3


class SpacePath(Table, frozen=True):
    """
    A path in the order in which it is run, n moves.

    start, end: complex128[n], plane points [mm, X as radius]. center: complex128[n], NaN for lines.
    kind: int16[n], Motion; what is neither CW nor CCW is a line. z_start, z_end: float64[n] [mm].

    Where a move does not begin at the end of the one before it, as behind a block that moves Z alone, a straight line
    leads there, which belongs to the later move.
    """

    start: Points
    end: Points
    center: Points
    kind: States
    z_start: Floats
    z_end: Floats

    @property
    def is_known(self) -> Mask:
        """The moves of which every coordinate is known."""
        is_arc = (self.kind == Motion.CW) | (self.kind == Motion.CCW)
        points = self.start + self.end + self.z_start + self.z_end
        return np.asarray(~np.isnan(points) & ~(is_arc & np.isnan(self.center)))


class Polyline(Table, frozen=True):
    """
    Corners of a polyline, n + 1 for n segments; no segment is shorter than ZERO.

    point: complex128[n + 1] [mm]. z: float64[n + 1] [mm]. move: int[n + 1], the move of the segment that ends in the
    corner; 0 for the first one. ends_move: the corner is the end of a move, not of a chord.
    """

    point: Points
    z: Floats
    move: Rows
    ends_move: Mask

    @property
    def length(self) -> Floats:
        """Way from the first corner to each [mm]."""
        steps = np.hypot(np.abs(np.diff(self.point)), np.diff(self.z))
        return np.append(0.0, np.cumsum(steps))


def polyline(path: SpacePath, sagitta: float) -> tuple[Polyline, float]:
    """
    Return the corners of a path, and how far chords leave their arcs at most [mm]; every move must be known.

    sagitta: how far they should [mm]; where that takes too many chords it is more. Raises TooHardError for a path of
    more moves than chords are allowed.
    """
    keep_time()
    is_arc = (path.kind == Motion.CW) | (path.kind == Motion.CCW)
    spoke = np.where(is_arc, path.start - path.center, 0)
    last = np.where(is_arc, path.end - path.center, 0)
    sweep = np.where(is_arc, arc_sweep(path.start, path.end, np.where(is_arc, path.center, 0), path.kind), 0.0)
    radius = np.maximum(np.abs(spoke), np.abs(last))
    count = _counts(sweep, radius, sagitta)
    while count.sum() > CHORDS_OF_FILE:
        if len(path) > CHORDS_OF_FILE // 4:
            raise TooHardError(f"a path of {len(path)} moves is too long to compare")
        sagitta *= 4
        count = _counts(sweep, radius, sagitta)
    move = np.repeat(np.arange(len(path)), count)
    share = (np.arange(len(move)) - np.repeat(np.cumsum(count) - count, count) + 1) / count[move]
    # An end that is not quite on the circle is reached in a spiral.
    growth = np.where(is_arc, np.abs(last) / np.maximum(np.abs(spoke), ZERO) - 1, 0.0)[move]
    turned = spoke[move] * (1 + growth * share) * np.exp(1j * sweep[move] * share)
    ends = share == 1
    point = np.where(ends, path.end[move], np.where(is_arc, path.center, 0)[move] + turned)
    z = path.z_start[move] + (path.z_end - path.z_start)[move] * share
    corners = Polyline(point, np.where(ends, path.z_end[move], z), move, ends)
    begins = Polyline(path.start, path.z_start, np.arange(len(path)), np.ones(len(path), bool))
    both = Polyline.concatenated([begins, corners])
    order = np.argsort(np.append(2 * begins.move, 2 * corners.move + 1), kind="stable")
    return _without_stubs(both[order]), sagitta if is_arc.any() else 0.0


def _counts(sweep: Floats, radius: Floats, sagitta: float) -> Rows:
    """Chords of each move."""
    flat = np.clip(1 - sagitta / np.maximum(radius, ZERO), -1, 1)
    unit = np.clip(2 * np.arccos(flat), _LEAST_TURN, _LARGEST_TURN)
    return np.asarray(np.maximum(np.ceil(np.abs(sweep) / unit - ZERO), 1), np.int64)


def _without_stubs(line: Polyline) -> Polyline:
    """Corners where the one before is not; an end of a move that falls away makes the corner before it one."""
    far = np.hypot(np.abs(np.diff(line.point)), np.diff(line.z)) > ZERO
    kept = np.append(True, far)[: len(line)]
    if kept.all():
        return line
    ends = np.maximum.reduceat(line.ends_move.astype(np.int8), np.flatnonzero(kept)).astype(bool)
    short = line[kept]
    return Polyline(short.point, short.z, short.move, ends)
