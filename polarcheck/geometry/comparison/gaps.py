"""Rings of a drawing whose curves do not meet at their ends; lengths in mm, plane points complex, x + 1j*c."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Points, column_at
from polarcheck.geometry.polygons.faces import coordinates

#: Ends farther apart than this do not belong together [mm].
_WIDEST = 1.0
#: Nor are those that are farther apart than this share of the length of a curve.
_SHARE = 0.5
#: Where one curve turns back along another, as the walls of a slot do, it does not go on as that one [rad].
_TURNS_BACK = math.radians(165)


class Gap(NamedTuple):
    """The distance of two ends, and the point between them [mm]."""

    size: float
    place: complex


def widest_gap(curves: Sequence[Points]) -> Gap | None:
    """
    The widest gap of the curves that are rings but for gaps; None where there is no such ring.

    One end goes on at another where each is the nearest to the other, which is near beside the length of both curves.
    """
    opened = [curve for curve in curves if curve[0] != curve[-1]]
    if not opened:
        return None
    end = np.array([point for curve in opened for point in (curve[0], curve[-1])])
    out = end - np.array([point for curve in opened for point in (curve[1], curve[-2])])
    points = shapely.points(coordinates(end))
    tree = shapely.STRtree(points)
    one, nearest = tree.query_nearest(points, max_distance=_WIDEST, exclusive=True, all_matches=False)
    peer = column_at(len(end), one, nearest, -1)
    is_mutual = (peer >= 0) & (peer[peer] == np.arange(len(end)))
    turn, size = np.abs(np.angle(-out[peer] * out.conj())), np.abs(end[peer] - end)
    length = np.repeat([float(np.abs(np.diff(curve)).sum()) for curve in opened], 2)
    peer[~is_mutual | (turn > _TURNS_BACK) | (size > _SHARE * np.minimum(length, length[peer]))] = -1
    gaps = [Gap(float(size[start]), complex(end[peer[start]] + end[start]) / 2) for start in _of_rings(peer.tolist())]
    return max(gaps, default=None, key=lambda gap: round(gap.size, 6))


def _of_rings(peer: list[int]) -> list[int]:
    """
    The ends at the gaps of rings, one of each gap. peer: where each end goes on, -1 for nowhere; 2n and 2n + 1 are
    those of one curve.
    """
    found: list[int] = []
    passed = [False] * len(peer)
    for first in range(0, len(peer), 2):
        ends: list[int] = []
        here = first
        while here >= 0 and not passed[here]:
            passed[here] = passed[here ^ 1] = True
            ends.append(here ^ 1)
            here = peer[here ^ 1]
        if here == first:
            found += ends
    return found
