"""
What a cutter touches on its way to a place: parts that must stand, and what still stands of the bar.

All is on the plane that turns with the part, x + 1j*c [mm]. A cutter whose tip is at Z touches what stands at any
height from there up, and less stands the higher one looks: its tip is the height that counts. Import late.
"""

from __future__ import annotations

import functools
from collections.abc import Sequence
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, Table, different
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import coordinates
from polarcheck.geometry.polygons.widened import widened
from polarcheck.geometry.segments import Curves, segments
from polarcheck.geometry.tolerances import ROUNDING, ZERO

#: Greatest gap that rounding of words and chords may leave between two passes [mm].
_TOLERANCE = 0.05
#: A cutter that overlaps less than this is taken as beside the metal [mm2].
_LEAST_AREA = 0.05
#: Corners of the circle of the bar, in a quarter.
_BAR_CORNERS = 128
#: More chords than these are not followed.
_MOST_CHORDS = 20_000


class Sweeps(Table, frozen=True):
    """
    Moves of cutters on the plane of the part, n of them in the order of the program.

    curves: their paths; one of no length is a place. radius: float64[n], R [mm]. tip: float64[n], Z of the tip [mm].
    """

    curves: Curves
    radius: Floats
    tip: Floats


def area_of(sweeps: Sweeps, less: float = 0.0) -> Any:
    """The area that cutters sweep, each with a radius that is smaller by `less` [mm]."""
    covered: list[Any] = []
    curves = sweeps.curves
    is_place = (np.abs(curves.end - curves.start) <= ZERO) & np.isnan(curves.center)
    for radius in different(sweeps.radius).tolist():
        size = radius - less
        if size <= ROUNDING:
            continue
        same = sweeps.radius == radius
        places = different(curves.end[same & is_place])
        covered.extend(shapely.buffer(shapely.points(coordinates(places)), size, quad_segs=24))
        path = curves[same & ~is_place]
        if not len(path):
            continue
        path = as_one_loop(path)
        chords = segments(path, _TOLERANCE)
        if len(chords) > _MOST_CHORDS:
            raise TooHardError(f"{len(chords)} chords of paths are too many to follow the metal")
        if len(chords):
            covered.append(widened(path, chords, size, _TOLERANCE))
    return areas.union_all(np.array(covered, object)) if covered else shapely.from_wkt("POLYGON EMPTY")


def as_one_loop(path: Curves) -> Curves:
    """The same curves as one loop."""
    return Curves(*path.shape, np.zeros(len(path), np.int64), path.row)


@functools.lru_cache(64)
def disc(diameter: float, bore: float = 0.0) -> Any:
    """The cross section of a bar: a shapely polygon."""
    outside = shapely.buffer(shapely.points(0.0, 0.0), diameter / 2, quad_segs=_BAR_CORNERS)
    return shapely.difference(outside, shapely.buffer(shapely.points(0.0, 0.0), bore / 2)) if bore else outside


def turned(area: Any, angle: float) -> Any:
    """An area turned about the center of C; angle [rad]."""
    turn = np.exp(1j * angle)

    def rotate(points: Any) -> Any:
        point = (points[:, 0] + 1j * points[:, 1]) * turn
        return np.column_stack([point.real, point.imag])

    return shapely.transform(area, rotate) if angle else area


def touched(sweep: Sweeps, standing: Any) -> Any:
    """The part of the standing area that a cutter overlaps; None where it is too small to count."""
    hit = areas.intersection(area_of(sweep, _TOLERANCE), standing)
    return hit if shapely.area(hit) > _LEAST_AREA else None


def place_of(area: Any) -> complex:
    """A point within an area, in its largest part."""
    parts = shapely.get_parts(area)
    point = shapely.point_on_surface(parts[np.argmax(shapely.area(parts))])
    return complex(shapely.get_x(point), shapely.get_y(point))


class Removed:
    """
    What moves take off, looked at move by move in their order: the area at each height, joined as it grows.

    sweeps: the moves that cut.
    """

    def __init__(self, sweeps: Sweeps) -> None:
        self.sweeps = sweeps
        self._areas: dict[float, tuple[int, Any]] = {}

    def until(self, row: int, height: float) -> Any:
        """The area that moves before a row have cleared at a height [mm]; rows must not fall."""
        keep_time()
        key = round(height, 4)
        done, area = self._areas.get(key, (0, None))
        until = int(np.searchsorted(self.sweeps.curves.row, row))
        new = np.arange(done, until)
        new = new[self.sweeps.tip[new] <= height + _TOLERANCE]
        if len(new):
            added = area_of(self.sweeps[new])
            area = added if area is None else areas.union(area, added)
        self._areas[key] = until, area
        return area


def hits_on_bar(
    sweeps: Sweeps, bars: Sequence[Sequence[tuple[Any, float]]], cleared: Sweeps, drilled: Rows, holes: Points
) -> tuple[Mask, Points]:
    """
    A mask of the sweeps that lead through what stands of a bar, and where; each clears what it runs through.

    sweeps: rising in rows, moves of one row side by side. bars: for each sweep the cross sections of the bar that it
    may touch, each with its lowest height [mm]. cleared: all moves that cut, rising in rows.
    drilled, holes: rows that drill, rising, and where, of any size.
    """
    removed = Removed(cleared)
    hit, point = np.zeros(len(sweeps), bool), np.full(len(sweeps), np.nan + 0j)
    for number in range(len(sweeps)):
        sweep = sweeps[np.array([number])]
        if _is_at_hole(sweep, holes[: np.searchsorted(drilled, sweep.curves.row[0])]):
            continue
        for bar, height in bars[number]:
            before = removed.until(int(sweep.curves.row[0]), height)
            standing = bar if before is None else areas.difference(bar, before)
            overlap = touched(sweep, standing)
            if overlap is not None:
                hit[number], point[number] = True, place_of(overlap)
    return hit, point


def _is_at_hole(sweep: Sweeps, holes: Points) -> bool:
    """True for a sweep that ends where something was drilled."""
    near = np.abs(holes - sweep.curves.end[0]) <= sweep.radius[0]
    return bool(near.any())


def hits_on_part(sweeps: Sweeps, solid: Any, top: float, level: float, cleared: Sweeps) -> tuple[Mask, Points]:
    """
    A mask of the sweeps that lead through a part that must stand, and where.

    solid: the area that stands. top, level: the heights between which it stands for certain [mm]. cleared: all moves of
    the program that cut: what they take off is no part.
    """
    hit, point = np.zeros(len(sweeps), bool), np.full(len(sweeps), np.nan + 0j)
    removed = Removed(cleared)
    last = int(cleared.curves.row[-1]) + 1 if len(cleared) else 0
    for number in range(len(sweeps)):
        tip = float(sweeps.tip[number])
        if tip > top + _TOLERANCE:
            continue
        taken = removed.until(last, max(tip, level))
        standing = solid if taken is None else areas.difference(solid, taken)
        overlap = touched(sweeps[np.array([number])], standing)
        if overlap is not None:
            hit[number], point[number] = True, place_of(overlap)
    return hit, point


def within(walls: Curves, distance: float, part: Any) -> Any:
    """The area of a part that lies within a distance of its walls [mm]."""
    path = as_one_loop(walls)
    return areas.intersection(part, widened(path, segments(path, _TOLERANCE), distance, _TOLERANCE))
