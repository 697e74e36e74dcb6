"""
How far a contour lies beyond what another one has left standing, and whether one is the other, turned or offset.

Plane points are complex, x + 1j*c, lengths in mm. Import late.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Points, Rows, median
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.outline import Outline
from polarcheck.geometry.polygons.faces import coordinates
from polarcheck.geometry.segments import Curves, segments

#: Chords of arcs [mm].
_CHORD = 0.002
#: Points along an outline, besides those of short elements.
_POINTS = 200
#: Of an offset outline so large a share lies at the same distance [mm], or within a share of it: corners keep their R.
_ALIKE, _EVEN, _AT_CORNERS, _MOST_AT_CORNERS = 0.7, 0.05, 0.5, 0.25
#: Angles nearer to each other than this are one [rad]; a turn by no more is none [deg].
_SAME_ANGLE, _ALIGNED = np.radians(0.25), 0.5


class Standing(NamedTuple):
    """
    What a contour leaves standing.

    polygon: shapely, mm. walls: its programmed edges (shapely). outline: the same as lines and arcs.
    """

    polygon: Any
    walls: Any
    outline: Outline


class Samples(NamedTuple):
    """
    Points along an outline, evenly on each of its elements.

    point: complex128[n]. element: int[n], the number of the element. weight: float64[n], the length that each stands
    for [mm].
    """

    point: Points
    element: Rows
    weight: Floats


def standing_of(polygon: Any, outline: Outline) -> Standing:
    """What stands at a depth, from its polygon and its outline."""
    chords = segments(Curves(*outline.shape, np.zeros(len(outline), np.int64), outline.row), _CHORD)
    ends = np.stack([coordinates(chords.start), coordinates(chords.end)], axis=1)
    walls = shapely.multilinestrings(shapely.linestrings(ends))
    for geometry in (polygon, walls):
        shapely.prepare(geometry)
    return Standing(polygon, walls, outline)


def samples_of(outline: Outline) -> Samples:
    """Points along an outline; each element has both of its ends."""
    length = outline.length
    count = np.maximum(np.ceil(length / max(length.sum(), 1e-9) * _POINTS), 2).astype(np.int64) + 1
    element = np.repeat(np.arange(len(outline)), count)
    number = np.arange(len(element)) - np.repeat(np.cumsum(count) - count, count)
    share = number / (count[element] - 1)
    return Samples(outline.points(element, share), element, (length / count)[element])


def beyond(points: Points, standing: Standing) -> Floats:
    """How far points lie beyond what stands [mm], float64[n]; below 0 how far within its walls."""
    keep_time()
    places = shapely.points(coordinates(points))
    distance = shapely.distance(standing.walls, places)
    return np.asarray(np.where(shapely.intersects(standing.polygon, places), -distance, distance))


class Likeness(NamedTuple):
    """
    How an outline is offset from another one.

    turns: float64[k], by which angles it has to be turned [rad], from -pi to pi. offset: how far it lies beyond the
    other then [mm], below 0 within it.
    """

    turns: Floats
    offset: float

    @property
    def turn(self) -> float:
        """The smallest of the turns [deg]."""
        return float(np.degrees(np.abs(self.turns).min()))

    @property
    def is_aligned(self) -> bool:
        """It lies along the other as it stands."""
        return self.turn <= _ALIGNED


def likeness(samples: Samples, outline: Outline, standing: Standing) -> Likeness | None:
    """The turns that lay an outline along the walls of another one, at one distance; None where there is none."""
    turns, offsets = [], []
    for turn in _candidates(outline, standing.outline).tolist():
        offset = beyond(samples.point * np.exp(1j * turn), standing)
        order = np.argsort(offset)
        half = np.searchsorted(np.cumsum(samples.weight[order]), samples.weight.sum() / 2)
        middle = float(offset[order][half])
        even = max(_EVEN, min(_AT_CORNERS * abs(middle), _MOST_AT_CORNERS))
        if samples.weight[np.abs(offset - middle) <= even].sum() >= _ALIKE * samples.weight.sum():
            turns.append(turn)
            offsets.append(middle)
    return Likeness(np.array(turns), median(np.array(offsets))) if turns else None


def _candidates(outline: Outline, other: Outline) -> Floats:
    """Angles by which the longest element of an outline runs along one of the other, 0 among them [rad]."""
    longest = int(np.argmax(outline.length))
    along = (other.end - other.start)[other.kind == outline.kind[longest]]
    chord = outline.end[longest] - outline.start[longest]
    angles = np.angle(along[np.abs(along) > 0] / chord) if abs(chord) > 0 else np.zeros(0)
    kept = [0.0]
    for angle in angles.tolist():
        turns = np.abs(np.angle(np.exp(1j * (angle - np.array(kept)))))
        if turns.min() > _SAME_ANGLE:
            kept.append(angle)
    return np.array(kept)
