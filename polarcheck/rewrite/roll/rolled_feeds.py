"""F of the lines and arcs of a section, from the speed that the tool had along the plain moves of X and C."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Mask
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ZERO
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.roll.rolled_elements import Element
from polarcheck.rewrite.roll.ways import AxisMoves

#: C faster than this share of its limit counts as limited.
_AT_LIMIT = 0.97
#: Speeds that differ by at most this share get one F.
_SAME = 0.04
#: The speed of an element is uneven if it is off its median by more than the first on more than the second share of
#: its length.
_EVEN, _UNEVEN_WAY = 0.15, 0.1
#: Significant digits of F.
_DIGITS = 3
#: The most different F of a stretch.
_MOST = 20
#: The CAM seems to have limited C if C is above the first share of its highest rate on at most the second of the path.
_HIGH, _HIGH_WAY = 0.9, 0.3
#: For smaller turns of C its rate is only rounding [deg].
_LEAST_TURN = 0.02


class Feeds(msgspec.Struct, frozen=True):
    """
    F of the elements of a stretch.

    of_element: the intended F of each element [mm/min].
    by_way: the distinct F of elements on the plane, that of the longest path first [mm/min].
    slowest, fastest: speeds of the tool, without the slowest and the fastest twentieth of its path [mm/min].
    is_even: the tool ran at even speed along each element.
    slowed: the share of the path on which C was at its limit.
    c_rate: the rate that the CAM seems to have limited C to [deg/min]; inf if none.
    """

    of_element: list[float]
    by_way: list[float]
    slowest: float
    fastest: float
    is_even: bool
    slowed: float
    c_rate: float


def feeds_of(moves: AxisMoves, elements: list[Element], machine: Machine, unit: float) -> Feeds:
    """
    Return the intended F of each element; unit: mm per unit of length that F counts.

    It is the median, by length, of the speeds of the blocks where C was below its limit. Elements with nearly the same
    speed get one F, an element along which the speed changed that of the whole path.
    """
    on_plane = moves.length > ZERO
    length = np.hypot(moves.length, moves.rise) if machine.polar.feed_measures == "space" else moves.length
    length = np.where(on_plane, length, moves.rise)
    speed, rate = length / moves.time, np.abs(moves.turn) / moves.time
    free = ~(rate > _AT_LIMIT * machine.limits.c_feed) | ~on_plane
    speeds, even = _element_speeds(speed, length, free, elements)
    plane = np.array([element.kind != Motion.NONE for element in elements], bool)
    weight = np.array([length[element.first : element.until].sum() for element in elements])
    both = on_plane & free if (on_plane & free).any() else on_plane
    overall = _quantile(speed[both], length[both])
    intended = np.where(plane, _grouped(speeds, weight, plane & even, overall), speeds)
    written = [nice(feed, unit) if on else feed for feed, on in zip(intended.tolist(), plane.tolist(), strict=True)]
    low, high = (_quantile(speed[on_plane], length[on_plane], share) for share in (0.05, 0.95))
    lengths_by_feed: dict[float, float] = {}
    for feed, long, on in zip(written, weight.tolist(), plane.tolist(), strict=True):
        if on:
            lengths_by_feed[feed] = lengths_by_feed.get(feed, 0.0) + long
    return Feeds(
        of_element=written,
        by_way=sorted(lengths_by_feed, key=lambda feed: -lengths_by_feed[feed]),
        slowest=low,
        fastest=high,
        is_even=bool(even[plane].all()),
        slowed=float(length[~free].sum() / length[on_plane].sum()),
        c_rate=_limit_of(moves, rate, length, on_plane),
    )


def nice(feed: float, unit: float, *, down: bool = False) -> float:
    """F [mm/min] of three digits as it is written; down: not above it."""
    written = feed / unit
    if not written > 0:
        return feed
    step = 10.0 ** (math.floor(math.log10(written)) - _DIGITS + 1)
    count = math.floor(written / step * (1 + 1e-12)) if down else round(written / step)
    return max(count, 1) * step * unit


def _limit_of(moves: AxisMoves, rate: Floats, length: Floats, on_plane: Mask) -> float:
    """The highest rate of C if the CAM may have limited C to it: reached on a part of the path, F varies; else inf."""
    turns = on_plane & (np.abs(moves.turn) >= _LEAST_TURN)
    highest = float(rate[turns].max(initial=0.0))
    is_high = on_plane & (rate >= _HIGH * highest)
    # If most blocks have the same F per minute, F does not follow the speed.
    _, counts = np.unique(moves.feed[on_plane & ~np.isnan(moves.feed)], return_counts=True)
    follows = counts.max(initial=0) <= len(moves) / 2
    return highest if follows and 0 < length[is_high].sum() <= _HIGH_WAY * length[on_plane].sum() else math.inf


def _element_speeds(speed: Floats, length: Floats, free: Mask, elements: list[Element]) -> tuple[Floats, Mask]:
    """The median speed of each element, NaN where C was at its limit all along; a mask of even speeds."""
    speeds, even = np.full(len(elements), np.nan), np.ones(len(elements), bool)
    for index, element in enumerate(elements):
        moves = slice(element.first, element.until)
        values, weights = speed[moves][free[moves]], length[moves][free[moves]]
        if len(values):
            speeds[index] = _quantile(values, weights)
            differs = np.abs(values / speeds[index] - 1) > _EVEN
            even[index] = weights[differs].sum() <= _UNEVEN_WAY * weights.sum()
    return speeds, even


def _grouped(speeds: Floats, weight: Floats, even: Mask, overall: float) -> Floats:
    """One F for elements with nearly the same speed; `overall` for uneven ones and those without a speed."""
    result = np.where(even & ~np.isnan(speeds), speeds, overall)
    remaining = even & ~np.isnan(speeds)
    center = overall
    for _ in range(_MOST):
        alike = remaining & (np.abs(speeds / center - 1) <= _SAME)
        if alike.any():
            result[alike] = _quantile(speeds[alike], weight[alike])
            remaining &= ~alike
        if not remaining.any():
            break
        center = _quantile(speeds[remaining], weight[remaining])
    return result


def _quantile(values: Floats, weights: Floats, share: float = 0.5) -> float:
    """The value below which this share of the weight lies: the weighted median."""
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][min(int(np.searchsorted(total, share * total[-1])), len(values) - 1)])
