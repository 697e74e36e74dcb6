"""
The metal that mills leave beside what a job asks for: areas that must stand, and areas that must be gone.

A contour may agree with its nearest curve and leave scrap: the other wall of a slot is not milled, a pass at another
depth cuts into the part, or the tool runs on the wrong side. All cuts of all sections count here. Lengths in mm, in the
frame of the part. Import late: shapely takes its time.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.columns.metal.milled import Cuts
from polarcheck.foundation.arrays import Floats, Mask
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.comparison.metal_left import (
    NOTHING,
    Extreme,
    area_to_clear,
    area_to_keep,
    cleared_by,
    disc,
    empty,
    farthest,
    grown,
    is_inside,
    joined,
    off_wall,
    reachable,
)
from polarcheck.geometry.comparison.rounds import Rounds
from polarcheck.geometry.polygons import areas
from polarcheck.geometry.polygons.faces import coordinates
from polarcheck.geometry.segments import segments
from polarcheck.parts.part_comparison import SAME_Z

#: What the chords of rounds may add to a difference, beside the tolerance [mm].
_CHORDS = 0.004
#: Far from the walls metal counts that is twice as thick as this, and that lies no nearer to the round of the bar [mm].
_RIM = 0.1
#: A program clears the middle of a pocket itself where it clears more than this share of it.
_ROUGHED = 0.75
#: A wall is made where cuts come near to more than this share of it; the rest may be that of other features.
_MADE = 0.05
#: Areas are apart where they share no more than this of the smaller one.
_SHARED = 0.01


class Feature(NamedTuple):
    """
    A closed shape that a job asks for.

    number: the number of the part in the job.
    curve: the number of the curve in its drawing.
    area: what it encloses (shapely).
    is_pocket: the part stands around it.
    may_be_absent: another tool may make it.
    z: its depth [mm].
    radius: R of the tool that mills it [mm].
    tolerance: the allowed difference [mm].
    certain: up to this distance from the axis there is metal before milling [mm].
    most: beyond this distance there is none, inf where that is not known [mm].
    excess_is_judged: all that may clear something there is known.
    is_bar_known: metal far from the walls is compared as well.
    is_solid: there is no hole where it is to be cleared.
    cuts: bool per cut, those in its sections.
    own_cuts: bool per cut, those without the contours of other parts.
    pockets: the pockets that it lies in, by their number and curve; `differences` finds them.
    beyond: the area farther from the axis than `certain` in which there is metal for certain; None for none.
    rounds: the round of its drawing and all cuts; None for a shape.
    """

    number: int
    curve: int
    area: Any
    is_pocket: bool
    may_be_absent: bool
    z: float
    radius: float
    tolerance: float
    certain: float
    most: float
    excess_is_judged: bool
    is_bar_known: bool
    is_solid: bool
    cuts: Mask
    own_cuts: Mask
    pockets: frozenset[tuple[int, int]] = frozenset()
    beyond: Any = None
    rounds: Rounds | None = None


class AreaDifference(NamedTuple):
    """
    How the metal differs from a feature.

    proud: metal that should be gone.
    deep: metal that is missing.
    proud_row, deep_row: the row of the cut that comes nearest, -1 for none.
    off: the distance of the machined wall from the nominal one [mm].
    island: metal in the middle of a pocket of which the program mills the walls alone: it may be gone before.
    is_made: cuts come within the tolerance of its wall.
    """

    proud: Extreme
    deep: Extreme
    proud_row: int
    deep_row: int
    off: float
    island: Extreme
    is_made: bool

    @property
    def is_none(self) -> bool:
        """The metal is as it should be."""
        return self.proud.size == self.deep.size == 0


def differences(features: Sequence[Feature], cuts: Cuts) -> list[AreaDifference]:
    """The difference of each feature. Raises TooHardError where areas are too many."""
    cleared = _Cleared(cuts)
    is_there = [
        not shape.may_be_absent or _is_made(_off_wall(shape, cleared.at_depth_of(shape)), shape.radius / 2)
        for shape in features
    ]
    pockets = [shape for shape in itertools.compress(features, is_there) if shape.is_pocket]
    features = [shape._replace(pockets=_pockets_around(shape, pockets)) for shape in features]
    present = [*itertools.compress(features, is_there)]
    results = []
    for feature in features:
        keep_time()
        results.append(_difference(feature, present, cleared))
    return results


class _Cleared:
    """Areas that cuts clear, by their choice."""

    def __init__(self, cuts: Cuts) -> None:
        self.cuts = cuts
        self._known: dict[bytes, Any] = {}

    def by(self, chosen: Mask) -> Any:
        key = chosen.tobytes()
        if key not in self._known:
            cuts = self.cuts[chosen]
            self._known[key] = cleared_by(cuts.curves, cuts.radius) if len(cuts) else empty()
        return self._known[key]

    def at_depth_of(self, feature: Feature) -> Any:
        return self.by(self.cuts.low <= feature.z + SAME_Z)


def _difference(feature: Feature, features: Sequence[Feature], cleared: _Cleared) -> AreaDifference:
    cuts, tolerance = cleared.cuts, _allowed(feature)
    off = _off_wall(feature, cleared.at_depth_of(feature))
    proud, island = NOTHING, NOTHING
    if feature.excess_is_judged:
        proud, island = _excess(feature, features, cleared)
    deep, deep_row = _lack(feature, features, cleared)
    at_depth = cuts.low <= feature.z + SAME_Z
    proud_row = nearest_row(cuts, at_depth if at_depth.any() else cuts.low < np.inf, proud.place) if proud.size else -1
    is_made = _is_made(off, tolerance + _CHORDS)
    return AreaDifference(proud, deep, proud_row, deep_row, float(off.max(initial=0.0)), island, is_made)


def _allowed(feature: Feature) -> float:
    """The allowed difference, with what chords may add to it [mm]."""
    return max(feature.tolerance, _CHORDS) + _CHORDS


def _excess(feature: Feature, features: Sequence[Feature], cleared: _Cleared) -> tuple[Extreme, Extreme]:
    """Metal at the depth of a feature that should be gone; and what stands in a pocket that is not cleared here."""
    tolerance = _allowed(feature)
    gone = cleared.at_depth_of(feature)
    around = _parts_around(feature, features)
    metal = areas.union(disc(feature.certain), around)
    if feature.beyond is not None:
        metal = areas.union(metal, feature.beyond)
    near = areas.intersection(area_to_clear(feature.area, feature.radius, tolerance, feature.is_pocket), metal)
    stays = areas.difference(_cleared_of_others(near, feature, features), gone)
    side = areas.intersection(feature.area, metal) if feature.is_pocket else areas.difference(metal, feature.area)
    whole = areas.difference(_cleared_of_others(side, feature, features), gone)
    if not feature.is_solid:
        return farthest(stays, whole, feature.area), NOTHING
    limit = reachable(feature.area, feature.radius, feature.is_pocket)
    far = areas.intersection(whole, limit) if feature.is_pocket else areas.difference(whole, limit)
    far = areas.intersection(far, areas.union(disc(feature.certain - _RIM), grown(around, -_RIM)))
    far = grown(grown(far, -_RIM), _RIM)
    middle = grown(feature.area, -2 * feature.radius - tolerance)
    is_roughed = shapely.area(areas.intersection(gone, middle)) > _ROUGHED * shapely.area(middle)
    if feature.is_bar_known or (feature.is_pocket and is_roughed):
        return farthest(joined([stays, far]), whole, feature.area), NOTHING
    if not feature.is_pocket:
        far = areas.intersection(far, grown(around, -_RIM))
        return farthest(joined([stays, far]), whole, feature.area), NOTHING
    return farthest(stays, whole, feature.area), farthest(far, far, feature.area)


def _lack(feature: Feature, features: Sequence[Feature], cleared: _Cleared) -> tuple[Extreme, int]:
    """Metal of a part, or around a pocket, that is cut away at its depth or above; and the row that cuts it, or -1."""
    worst, row = NOTHING, -1
    for z in _heights(feature, features):
        lacks = _lacking(feature, features, cleared, z)
        extreme = farthest(lacks, lacks, feature.area)
        if extreme.size <= worst.size:
            continue
        lacks = _without_shared(lacks, feature, features, cleared)
        extreme = farthest(lacks, lacks, feature.area)
        if extreme.size > worst.size:
            worst, row = extreme, nearest_row(cleared.cuts, _cuts_down_to(feature, features, cleared, z), extreme.place)
    return worst, row


def _heights(feature: Feature, features: Sequence[Feature]) -> list[float]:
    """The depths of a feature and of those above it, at which missing metal is searched, the lowest first."""
    return sorted({peer.z for peer in features if peer.z >= feature.z - SAME_Z})


def _cuts_down_to(feature: Feature, features: Sequence[Feature], cleared: _Cleared, z: float) -> Mask:
    """The cuts that may cut away what stands: above the highest of all depths each one, below it those no higher."""
    cuts = feature.own_cuts if feature.is_pocket else feature.cuts
    is_highest = z == _heights(feature, features)[-1]
    return cuts if is_highest else cuts & (cleared.cuts.high <= z + SAME_Z)


def _lacking(feature: Feature, features: Sequence[Feature], cleared: _Cleared, z: float) -> Any:
    """The area, just above a height, that should stand of a part or around a pocket and is cut away."""
    chosen = _cuts_down_to(feature, features, cleared, z)
    if not chosen.any():
        return empty()
    stands = _must_stand(feature, features, z)
    if np.isfinite(feature.most):
        stands = areas.intersection(stands, disc(feature.most))
    return areas.intersection(stands, cleared.by(chosen))


def _without_shared(lacks: Any, feature: Feature, features: Sequence[Feature], cleared: _Cleared) -> Any:
    """
    What is missing of a feature, less what is missing of another one as well and lies nearer to the wall of that: a
    pocket that is milled too wide is no fault of the part around it. What is as near to both belongs to the first.
    """
    pieces, is_later = shapely.get_parts(lacks), False
    for peer in features:
        if peer is feature:
            is_later = True
            continue
        if peer.may_be_absent:
            continue
        far, far_of_peer = (shapely.distance(pieces, shapely.boundary(shape.area)) for shape in (feature, peer))
        is_nearer = far_of_peer < far - _CHORDS if is_later else far_of_peer <= far + _CHORDS
        if is_nearer.any():
            keep_time()
            of_peer = joined([_lacking(peer, features, cleared, z) for z in _heights(peer, features)])
            rest = shapely.area(areas.difference(pieces, grown(of_peer, _CHORDS)))
            pieces = pieces[~is_nearer | (rest > _SHARED * shapely.area(pieces))]
    return joined([*pieces])


def _off_wall(feature: Feature, gone: Any) -> Floats:
    """The distances of points of its wall from the edge of a cleared area [mm]."""
    return off_wall(gone, feature.area, feature.radius, feature.certain - 2 * _CHORDS, feature.is_pocket)


def _is_made(off: Floats, by: float) -> bool:
    return not len(off) or float((off <= by).mean()) > _MADE


def _parts_around(feature: Feature, features: Sequence[Feature]) -> Any:
    """Other parts, where there is metal for certain before milling; none around an island in a pocket."""
    peers = [peer for peer in features if peer is not feature]
    if any(peer.is_pocket and is_inside(feature.area, peer.area, feature.tolerance) for peer in peers):
        return empty()
    return joined([peer.area for peer in peers if not peer.is_pocket])


def _are_apart(first: Any, second: Any) -> bool:
    both = shapely.area(areas.intersection(first, second))
    return bool(both <= _SHARED * min(shapely.area(first), shapely.area(second)))


def _pockets_around(feature: Feature, pockets: Sequence[Feature]) -> frozenset[tuple[int, int]]:
    """The pockets that a feature lies in, by their number and curve."""
    keep_time()
    remaining = (pocket for pocket in pockets if pocket is not feature)
    return frozenset(
        (pocket.number, pocket.curve) for pocket in remaining if is_inside(feature.area, pocket.area, _allowed(feature))
    )


def _must_stand(feature: Feature, features: Sequence[Feature], z: float) -> Any:
    """The area that must stand of a part, or around a pocket, just above a height."""
    tolerance = _allowed(feature)
    stands = area_to_keep(feature.area, feature.radius, tolerance, feature.is_pocket)
    for peer in features:
        if peer is feature or peer.z > z + SAME_Z:
            continue
        if peer.is_pocket:
            if feature.is_pocket or (peer.number, peer.curve) not in feature.pockets:
                stands = areas.difference(stands, grown(peer.area, tolerance))
        # Around a part there is nothing; around an island that holds in its own pocket only.
        elif peer.pockets <= feature.pockets and (feature.is_pocket or not _are_apart(feature.area, peer.area)):
            stands = areas.intersection(stands, grown(peer.area, -tolerance))
    return stands


def _cleared_of_others(area: Any, feature: Feature, features: Sequence[Feature]) -> Any:
    """An area beside the walls of a feature, without what other features need or keep the cutter from."""
    for peer in features:
        if peer is feature:
            continue
        if peer.is_pocket:
            if not feature.is_pocket and is_inside(feature.area, peer.area, feature.tolerance):
                area = areas.intersection(area, reachable(peer.area, feature.radius, True))
        elif feature.is_pocket:
            if is_inside(peer.area, feature.area, feature.tolerance):
                around = areas.difference(feature.area, peer.area)
                area = areas.intersection(area, reachable(around, feature.radius, True))
        elif not is_inside(feature.area, peer.area, feature.tolerance):
            both = joined([feature.area, peer.area])
            area = areas.difference(area, reachable(both, feature.radius, False))
    return area


def nearest_row(cuts: Cuts, chosen: Mask, point: complex) -> int:
    """The row of the cut that comes nearest to a point."""
    selected = cuts[chosen]
    chords = segments(selected.curves, _CHORDS)
    if not len(chords):
        return int(selected.curves.row[0]) if len(selected) else -1
    lines = shapely.linestrings(np.stack([coordinates(chords.start), coordinates(chords.end)], axis=1))
    far = shapely.distance(lines, shapely.points(point.real, point.imag))
    return int(selected.curves.row[chords.move[int(np.argmin(far))]])


def distance_of_wall(feature: Feature, cuts: Cuts) -> float:
    """The mean distance from the wall of a feature to the edge of what cuts clear [mm]; inf where they reach none."""
    off = _off_wall(feature, cleared_by(cuts.curves, cuts.radius) if len(cuts) else empty())
    return float(off.mean()) if len(off) else np.inf


def directions_of(cuts: Cuts, chosen: Mask, most: int = 8) -> list[float]:
    """The directions of the longest straight cuts [deg], from 0 to 180."""
    curves = cuts.curves[chosen & np.isnan(cuts.curves.center)]
    vector = curves.end - curves.start
    angle = np.round(np.degrees(np.angle(vector)) % 180, 3) % 180
    distinct, number = np.unique(angle, return_inverse=True)
    length = np.bincount(number.ravel(), weights=np.abs(vector), minlength=len(distinct))
    return [float(distinct[index]) for index in np.argsort(-length, kind="stable")[:most]]
