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
from polarcheck.rewrite.roll.ways import Way

#: C above this share of its limit counts as limited.
_AT_LIMIT = 0.97
#: Speeds that differ by less than this share are one F.
_SAME = 0.04
#: Speeds that spread by more than this share in more than this share of an element were not meant to be one.
_EVEN, _UNEVEN_WAY = 0.15, 0.1
#: F is written with so many digits.
_DIGITS = 3
#: No more different F than this are looked for.
_MOST = 20
#: C counts as limited by the CAM where it is above this share of its highest rate, on at most this share of the way.
_HIGH, _HIGH_WAY = 0.9, 0.3
#: Turns of C from which on its rate is not that of rounding [deg].
_LEAST_TURN = 0.02


class Feeds(msgspec.Struct, frozen=True):
    """
    F of the elements of a stretch.

    of_element: what was meant [mm/min]. by_way: those on the plane without repetition, that of the longest way first.
    slowest, fastest: of the tool along its way, but for a twentieth at each end [mm/min].
    is_even: the tool ran at even speed along each element. slowed: the share of the way on which C was at its limit.
    c_rate: the rate that the CAM seems to have limited C to [deg/min]; inf if none.
    """

    of_element: list[float]
    by_way: list[float]
    slowest: float
    fastest: float
    is_even: bool
    slowed: float
    c_rate: float


def feeds_of(way: Way, elements: list[Element], machine: Machine, unit: float) -> Feeds:
    """
    Return F that was meant for each element; unit: mm per unit of length that F counts.

    It is the median by length of the speeds of the blocks where C was below its limit, one for all elements that were
    run alike; that of the whole way for an element along which the speed changed.
    """
    on_plane = way.length > ZERO
    length = np.hypot(way.length, way.rise) if machine.polar.feed_measures == "space" else way.length
    length = np.where(on_plane, length, way.rise)
    speed, rate = length / way.time, np.abs(way.turn) / way.time
    free = ~(rate > _AT_LIMIT * machine.limits.c_feed) | ~on_plane
    own, even = _own(speed, length, free, elements)
    plane = np.array([each.kind != Motion.NONE for each in elements], bool)
    weight = np.array([length[each.first : each.until].sum() for each in elements])
    both = on_plane & free if (on_plane & free).any() else on_plane
    overall = _median(speed[both], length[both])
    meant = np.where(plane, _grouped(own, weight, plane & even, overall), own)
    written = [nice(feed, unit) if on else feed for feed, on in zip(meant.tolist(), plane.tolist(), strict=True)]
    low, high = _ends(speed[on_plane], length[on_plane])
    ways: dict[float, float] = {}
    for feed, long, on in zip(written, weight.tolist(), plane.tolist(), strict=True):
        if on:
            ways[feed] = ways.get(feed, 0.0) + long
    return Feeds(
        of_element=written,
        by_way=sorted(ways, key=lambda feed: -ways[feed]),
        slowest=low,
        fastest=high,
        is_even=bool(even[plane].all()),
        slowed=float(length[~free].sum() / length[on_plane].sum()),
        c_rate=_limit_of(way, rate, length, on_plane),
    )


def nice(feed: float, unit: float, *, down: bool = False) -> float:
    """F [mm/min] of three digits as it is written; down: not above it."""
    written = feed / unit
    if not written > 0:
        return feed
    step = 10.0 ** (math.floor(math.log10(written)) - _DIGITS + 1)
    count = math.floor(written / step * (1 + 1e-12)) if down else round(written / step)
    return max(count, 1) * step * unit


def _limit_of(way: Way, rate: Floats, length: Floats, on_plane: Mask) -> float:
    """The highest rate of C where it may be a limit: of some of the way, and F follows the speed; else inf."""
    turns = on_plane & (np.abs(way.turn) >= _LEAST_TURN)
    highest = float(rate[turns].max(initial=0.0))
    is_high = on_plane & (rate >= _HIGH * highest)
    # One F per minute in most blocks follows no speed.
    _, counts = np.unique(way.feed[on_plane & ~np.isnan(way.feed)], return_counts=True)
    follows = counts.max(initial=0) <= len(way) / 2
    return highest if follows and 0 < length[is_high].sum() <= _HIGH_WAY * length[on_plane].sum() else math.inf


def _own(speed: Floats, length: Floats, free: Mask, elements: list[Element]) -> tuple[Floats, Mask]:
    """The speed of each element, NaN where C was at its limit all the way; whether it was even."""
    own, even = np.full(len(elements), np.nan), np.ones(len(elements), bool)
    for index, each in enumerate(elements):
        moves = slice(each.first, each.until)
        values, weights = speed[moves][free[moves]], length[moves][free[moves]]
        if len(values):
            own[index] = _median(values, weights)
            others = np.abs(values / own[index] - 1) > _EVEN
            even[index] = weights[others].sum() <= _UNEVEN_WAY * weights.sum()
    return own, even


def _grouped(own: Floats, weight: Floats, even: Mask, overall: float) -> Floats:
    """One F for elements whose speeds are nearly the same; that of the whole way for those that have none."""
    result = np.where(even & ~np.isnan(own), own, overall)
    left = even & ~np.isnan(own)
    center = overall
    for _ in range(_MOST):
        alike = left & (np.abs(own / center - 1) <= _SAME)
        if alike.any():
            result[alike] = _median(own[alike], weight[alike])
            left &= ~alike
        if not left.any():
            break
        center = _median(own[left], weight[left])
    return result


def _median(values: Floats, weights: Floats) -> float:
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    return float(values[order][np.searchsorted(total, total[-1] / 2)])


def _ends(values: Floats, weights: Floats) -> tuple[float, float]:
    """The values below and above which a twentieth of the weights is."""
    order = np.argsort(values)
    total = np.cumsum(weights[order])
    at = np.searchsorted(total, [0.05 * total[-1], 0.95 * total[-1]])
    low, high = values[order][np.minimum(at, len(values) - 1)].tolist()
    return low, high
