"""The lines and arcs of a way as they are written: wide arcs and full circles put together, corners where they are."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Points, Rows
from polarcheck.foundation.states import Motion
from polarcheck.geometry.fitted_curves.bends import bend
from polarcheck.geometry.fitted_curves.elements import Element, longest_elements
from polarcheck.geometry.fitted_curves.spirals import Samples
from polarcheck.geometry.plane import quiet
from polarcheck.geometry.plane_path import PlanePath

#: A closer fit is taken where it needs no more than this many times the elements of the widest tolerance.
_MORE_ELEMENTS = 1.15
#: Ends of a circle that are nearer than this share of the tolerance are one point: a full circle.
_CLOSED = 0.5
#: A full turn, and how near to it an arc comes whose ends are one point [rad].
_TURN, _NEARLY = 2 * math.pi, 0.2


class FittedPath(PlanePath, frozen=True):
    """Lines and arcs, each from the end of the one before. last: int64[n], the sample at which each ends."""

    last: Rows


def fitted(samples: Samples, tolerance: float, noise: float) -> FittedPath:
    """
    Return few lines and arcs that pass all samples within the tolerance [mm] and begin and end at the first and last.

    noise: by how much rounding shifts the samples [mm]. Where that is enough to pass them with hardly more elements, a
    clean contour is behind them, and its joints are where they were: the tolerance would hide them.
    """
    best = longest_elements(samples, tolerance) or []
    most = _MORE_ELEMENTS * max(len(best), 1)
    for closer in (0.5 * tolerance, 1.5 * noise):
        if closer >= tolerance:
            continue
        elements = longest_elements(samples, closer, most)
        if elements is None:
            break
        best = elements
    return _curves(samples, tolerance, best)


def _curves(samples: Samples, tolerance: float, elements: list[Element]) -> FittedPath:
    last, end, center, kind = [], [], [], []
    index = 0
    while index < len(elements):
        first, to, u = elements[index]
        arc = _Arc.of(samples, first, to, u)
        while arc is not None and index + 1 < len(elements) and elements[index + 1][2] * u > 0:
            wider = _wider(samples, tolerance, arc, elements[index + 1])
            if wider is None:
                break
            arc, to, index = wider, elements[index + 1][1], index + 1
        if arc is not None and arc.is_closed and samples.point[to] != samples.point[first]:
            samples, elements = _closed(samples, tolerance, elements, first, to, index)
        last.append(to)
        end.append(complex(samples.point[to]))
        center.append(complex(math.nan, math.nan) if arc is None else arc.center)
        kind.append(int(Motion.LINE if arc is None else Motion.CCW if arc.sweep > 0 else Motion.CW))
        index += 1
    ends = np.array(end, complex)
    start = np.append(samples.point[:1], ends)[: len(ends)]
    return FittedPath(start, ends, np.array(center, complex), np.array(kind, np.int16), np.array(last, np.int64))


class _Arc(msgspec.Struct, frozen=True):
    """An arc from one sample to another. sweep: signed [rad]. is_closed: its ends are one point."""

    first: int
    last: int
    center: complex
    sweep: float
    is_closed: bool = False

    @classmethod
    def of(cls, samples: Samples, first: int, last: int, u: float) -> _Arc | None:
        """Return the arc of an element; None for a line."""
        if u == 0:
            return None
        start = complex(samples.point[first])
        chord = complex(samples.point[last]) - start
        center = start + chord / abs(chord) * complex(abs(chord) / 2, 0.5 / u)
        # With the center on the left (u > 0) the samples lie on the right of the chord: counterclockwise.
        return cls(first, last, center, 2 * math.atan(u * abs(chord)))


def _wider(samples: Samples, tolerance: float, arc: _Arc, element: Element) -> _Arc | None:
    """Return the arc prolonged by the next element if one circle passes all samples of both; else None."""
    beyond = _Arc.of(samples, *element)
    if beyond is None or abs(arc.sweep + beyond.sweep) > _TURN + _NEARLY:
        return None
    first, last = arc.first, element[1]
    start, end = complex(samples.point[first]), complex(samples.point[last])
    point = samples.point[first : last + 1]
    center = _center(point, samples.weight[first : last + 1])
    if center is None:
        return None
    sense = math.copysign(1.0, arc.sweep)
    is_closed = abs(end - start) <= _CLOSED * tolerance and abs(arc.sweep + beyond.sweep) > _TURN - _NEARLY
    if is_closed:
        sweep = sense * _TURN
        radius = abs(start - center)
    else:
        # Both ends have to lie on the circle: its center on the perpendicular bisector of the chord.
        chord = end - start
        across = 1j * chord / abs(chord) if chord else 1.0
        middle = (start + end) / 2
        center = middle + across * ((center - middle) * across.conjugate()).real
        radius = abs(start - center)
        sweep = sense * (math.atan2(*_turn(start - center, end - center, sense)) % _TURN)
        if abs(abs(sweep) - abs(arc.sweep + beyond.sweep)) > _NEARLY:
            return None
    away = np.abs(np.abs(point - center) - radius)
    if (away > tolerance + samples.slack[first : last + 1]).any():
        return None
    z = samples.z[first : last + 1]
    if (z != z[0]).any():
        turned = np.append(0.0, np.cumsum(np.angle((point[1:] - center) * np.conj(point[:-1] - center))))
        if (np.abs(z - (z[0] + (z[-1] - z[0]) * turned / sweep)) > tolerance + samples.slack[first : last + 1]).any():
            return None
    return _Arc(first, last, center, sweep, is_closed)


def _turn(spoke: complex, next_spoke: complex, sense: float) -> tuple[float, float]:
    """Return sine and cosine, times a length, of the turn between two spokes, positive in the sense of the arc."""
    turn = next_spoke * spoke.conjugate()
    return sense * turn.imag, turn.real


@quiet
def _center(point: Points, weight: Floats) -> complex | None:
    """Return the center of the circle with the least squares of |p - c|^2 - r^2; None for points on a line."""
    chosen = point[weight > 0]
    if len(chosen) < 3:
        return None
    origin = chosen.mean()
    p = chosen - origin
    columns = np.stack((p.real, p.imag, np.ones(len(p))), axis=1)
    solution = np.linalg.lstsq(columns, np.abs(p) ** 2, rcond=None)[0]
    center = complex(origin + complex(solution[0], solution[1]) / 2)
    return center if math.isfinite(abs(center)) else None


def _closed(
    samples: Samples, tolerance: float, elements: list[Element], first: int, last: int, index: int
) -> tuple[Samples, list[Element]]:
    """Put the end of a full circle on its start, and the element behind it there, too."""
    point = samples.point.copy()
    point[last] = point[first]
    moved = msgspec.structs.replace(samples, point=point)
    result = list(elements)
    if index + 1 < len(result):
        begin, end, u = result[index + 1]
        new_u = bend(moved, begin, end, tolerance, straight=u == 0)
        if new_u is not None:
            result[index + 1] = begin, end, new_u
    return moved, result
