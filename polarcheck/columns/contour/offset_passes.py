"""Passes that run along another one at one distance, as a finishing pass does along its roughing, but for one point."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.passes import Passes
from polarcheck.foundation.arrays import Floats, Mask, Points, different, first_of_each, median

#: Points are at the distance of the others within this, and one is not from this on [mm]. Largest distance of a finish.
_ALIKE, _ODD, _MOST = 0.012, 0.05, 2.0
#: Corners of a contour, at least, moves of a pass, at most, and shapes of passes that are compared with each other.
_FEWEST, _LONGEST, _MOST_SHAPES = 4, 64, 12
#: Sine of the turn at a point within a straight wall; the largest distance as a multiple of the least.
_STRAIGHT, _UNEVEN = 0.01, 4.0


class OddPoint(NamedTuple):
    """
    A point of a pass that is not at the distance of all others from a model of it.

    move, model: the moves of the passes that end there. offset: distance of the others [mm]. place: where the point
    would be as far from the model, complex [mm]. uneven: how far the other points are from that distance, at most [mm].
    """

    move: int
    model: int
    offset: float
    place: complex
    uneven: float


def odd_points(passes: Passes) -> list[OddPoint]:
    """The passes that lie beside another one of as many moves, but for one point, each once."""
    # Passes are alike in program and sense; each shape is compared once, by the first pass that has it.
    count = passes.last - passes.first + 1
    chosen = np.flatnonzero(passes.is_wall & (count >= _FEWEST) & (count <= _LONGEST))
    chosen = chosen[np.sort(first_of_each(passes.shape[chosen])[0])]
    found: dict[frozenset[int], OddPoint] = {}
    for size in different(count[chosen]).tolist():
        alike = chosen[count[chosen] == size].tolist()
        if not 1 < len(alike) <= _MOST_SHAPES:
            continue
        for model in alike:
            for number in alike if passes.closed[model] else ():
                odd = _odd_point(passes, model, number) if number != model else None
                # Where a point is little off, either of two passes is nearly even beside the other.
                if odd is not None:
                    pair = frozenset((odd.move, odd.model))
                    found[pair] = min(found.get(pair, odd), odd, key=lambda point: point.uneven)
    return list({odd.move: odd for odd in found.values()}.values())


def _odd_point(passes: Passes, model: int, number: int) -> OddPoint | None:
    """The one point of a pass that is elsewhere than beside the ring of its model."""
    ring = np.arange(passes.ring[0][model], passes.ring[1][model] + 1)
    moves = ring - passes.first[model] + passes.first[number]
    if (passes.motion[ring] != passes.motion[moves]).any() or _program(passes, ring[0]) != _program(passes, moves[0]):
        return None
    begins, ends = (1j * tangent[ring] for tangent in passes.tangents)
    if not (begins.all() and ends.all()):
        return None
    walls = np.append(ends[-1], ends), np.append(begins, begins[0])
    apart = np.append(passes.start[moves] - passes.start[ring], passes.end[moves[-1]] - passes.end[ring[-1]])
    for into, out in ((np.zeros(len(apart)),) * 2, tuple(np.round(np.abs(wall.real), 2) for wall in walls)):
        if any(_face_one_way(begins[out[:-1] == kind]) for kind in different(out).tolist()):
            continue
        expected = _expected(apart, walls, (into, out))
        if expected is None:
            continue
        shift, is_corner, distance = expected
        off = np.where(is_corner, np.abs(apart - shift), np.abs(((apart - shift) * walls[0].conj()).real))
        odd = np.flatnonzero(off > _ODD)
        if len(odd) == 1 and np.count_nonzero(is_corner[:-1]) >= _FEWEST and (np.delete(off, odd) <= _ALIKE).all():
            at = int(odd[0])
            move, place = int(moves[0]) + at - 1, passes.start[ring[0]] if not at else passes.end[ring[at - 1]]
            # A point on a side of the pass is no corner that went elsewhere.
            is_on_side = is_corner[at] and abs(passes.turns[1][move]) <= _STRAIGHT
            if move >= passes.first[number] and not is_on_side:
                uneven = float(np.delete(off, odd).max())
                return OddPoint(move, int(ring[0]) + at - 1, distance, complex(place + shift[at]), uneven)
    return None


def _face_one_way(normals: Points) -> bool:
    """Walls that face one way only: nothing but themselves says how far off they are."""
    return bool((np.abs(normals - normals[0]) < _STRAIGHT).all())


def _expected(
    apart: Points, walls: tuple[Points, Points], kinds: tuple[Floats, Floats]
) -> tuple[Points, Mask, float] | None:
    """
    How far each point is shifted as its walls are, whether it is a corner, and the least distance.

    apart: complex128[n] [mm]. walls: the normals of the walls before and behind each point. kinds: float64[n] each, the
    kinds of these walls. None where the distances are none of a finish beside its roughing.
    """
    kind, distance = np.concatenate(kinds), np.concatenate([(apart * wall.conj()).real for wall in walls])
    usual = np.zeros(len(kind))
    for value in different(kind).tolist():
        usual[kind == value] = median(distance[kind == value])
    if usual.min() * usual.max() <= 0 or not _ODD < np.abs(usual).max() <= min(_MOST, _UNEVEN * np.abs(usual).min()):
        return None
    first, second = np.split(usual, 2)
    into, out = walls
    across = (into * out.conj()).imag
    is_corner = np.abs(across) > _STRAIGHT
    shift = np.where(
        is_corner, 1j * (first * out - second * into) / np.where(is_corner, across, 1.0), into * (first + second) / 2
    )
    return shift, is_corner, float(np.abs(usual).min())


def _program(passes: Passes, move: int) -> int:
    return int(passes.trace.blocks.program[passes.row[move]])
