"""Paths of straight segments: points along them, and distances to them; lengths in mm."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Points, Rows
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.outline import Outline
from polarcheck.geometry.segments import Curves, segments

#: Points along a path, besides the ends of its segments.
_SAMPLES = 2000
#: Four times by how much a chord may leave its arc [mm].
_TOLERANCE = 4e-4


@dataclass(frozen=True, slots=True)
class MeasuredPath:
    """
    Straight segments in a row, n of them.

    start, end: complex128[n] [mm].
    of: int[n], the element or curve that each segment is part of.
    until: float64[n] [mm], the length of the path up to the end of each segment.
    tree: a shapely STRtree of the segments.
    """

    start: Points
    end: Points
    of: Rows
    until: Floats
    tree: Any = field(repr=False)

    @property
    def length(self) -> float:
        """The length of the path [mm]."""
        return float(self.until[-1]) if len(self.until) else 0.0

    def at(self, along: Floats) -> tuple[Points, Rows]:
        """The points at these distances along the path [mm], and the segment of each."""
        which = np.minimum(np.searchsorted(self.until, along), len(self.until) - 1)
        size = np.abs(self.end - self.start)[which]
        share = np.clip(1 - (self.until[which] - along) / size, 0, 1)
        return self.start[which] + (self.end - self.start)[which] * share, which

    def samples(self, count: int = _SAMPLES) -> Floats:
        """Distances along the path [mm] of all ends of segments, and of points between them."""
        between = np.linspace(0, self.length, count)
        return np.unique(np.concatenate([between, np.append(0.0, self.until)]))

    def nearest(self, points: Points) -> tuple[Floats, Points, Rows]:
        """The distance from each point to the path [mm], the nearest point of the path, and its segment."""
        keep_time()
        _, which = self.tree.query_nearest(shapely.points(points.real, points.imag), all_matches=False)
        start, along = self.start[which], (self.end - self.start)[which]
        share = np.clip(((points - start) * along.conj()).real / np.abs(along) ** 2, 0, 1)
        closest = start + along * share
        return np.abs(points - closest), closest, which


def path_of(start: Points, end: Points, of: Rows) -> MeasuredPath:
    """The path of these segments; segments without a length are left out."""
    long = np.abs(end - start) > 0
    start, end, of = start[long], end[long], of[long]
    ends = np.stack([start, end], axis=1)
    tree = shapely.STRtree(shapely.linestrings(np.stack([ends.real, ends.imag], axis=2)))
    return MeasuredPath(start, end, of, np.cumsum(np.abs(end - start)), tree)


def path_of_outline(outline: Outline) -> MeasuredPath:
    """The path along an outline, with fine chords for its arcs; `of` are its elements."""
    chords = segments(Curves(*outline.shape, outline.chain, np.arange(len(outline))), _TOLERANCE)
    return path_of(chords.start, chords.end, chords.move)


def path_of_curves(curves: list[Points]) -> MeasuredPath:
    """The path along the curves of a drawing; `of` are these."""
    of = np.repeat(np.arange(len(curves)), [len(curve) - 1 for curve in curves])
    start, end = (np.concatenate([curve[part] for curve in curves]) for part in (slice(None, -1), slice(1, None)))
    return path_of(start, end, of)
