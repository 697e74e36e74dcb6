"""Paths in space as polylines: lines and arcs of the polar plane with Z, arcs as chords."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, ranges
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.plane_path import SpacePath
from polarcheck.geometry.tolerances import CHORDS_OF_FILE, ZERO

#: The fewest chords of a full circle are three, the flattest chord turns by this angle [rad].
_LEAST_TURN, _LARGEST_TURN = 1e-6, 2 * np.pi / 3


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
    count = _counts(path, sagitta)
    while count.sum() > CHORDS_OF_FILE:
        if len(path) > CHORDS_OF_FILE // 4:
            raise TooHardError(f"a path of {len(path)} moves is too long to compare")
        sagitta *= 4
        count = _counts(path, sagitta)
    move, index = ranges(count)
    share = (index + 1) / count[move]
    ends = share == 1
    z = np.where(ends, path.z_end[move], path.z_start[move] + (path.z_end - path.z_start)[move] * share)
    corners = Polyline(path.points(move, share), z, move, ends)
    begins = Polyline(path.start, path.z_start, np.arange(len(path)), np.ones(len(path), bool))
    both = Polyline.concatenated([begins, corners])
    order = np.argsort(np.append(2 * begins.move, 2 * corners.move + 1), kind="stable")
    return _without_stubs(both[order]), sagitta if path.is_arc.any() else 0.0


def _counts(path: SpacePath, sagitta: float) -> Rows:
    """Chords of each move."""
    radius = np.nan_to_num(np.maximum(np.abs(path.start - path.center), np.abs(path.end - path.center)))
    flat = np.clip(1 - sagitta / np.maximum(radius, ZERO), -1, 1)
    unit = np.clip(2 * np.arccos(flat), _LEAST_TURN, _LARGEST_TURN)
    return np.asarray(np.maximum(np.ceil(np.abs(path.sweep) / unit - ZERO), 1), np.int64)


def _without_stubs(line: Polyline) -> Polyline:
    """Corners where the one before is not; an end of a move that falls away makes the corner before it one."""
    far = np.hypot(np.abs(np.diff(line.point)), np.diff(line.z)) > ZERO
    kept = np.append(True, far)[: len(line)]
    if kept.all():
        return line
    ends = np.maximum.reduceat(line.ends_move.astype(np.int8), np.flatnonzero(kept)).astype(bool)
    short = line[kept]
    return Polyline(short.point, short.z, short.move, ends)
