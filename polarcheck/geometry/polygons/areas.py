"""
What shapely makes of areas: joined, cut out of each other, widened. The names are those of shapely.

The cost of each of these steps grows faster than the points that go in, and it may find no answer where points of
areas all but meet. So each is interrupted when the time is over, many areas are taken in portions, and one that is too
large, or for which there is no answer, is a TooHardError. Import late.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]
from shapely.errors import GEOSException  # type: ignore[import-untyped]

from polarcheck.errors import NoAnswerError, TooHardError
from polarcheck.geometry.polygons.interruption import interruptible
from polarcheck.time_limit import keep_time

#: Points that go into one step at most, and of many areas at a time; about a second each.
_MOST, _AT_A_TIME = 1_000_000, 200_000
#: Points of lines whose distance to other lines is asked for at a time.
_PIECES_AT_A_TIME = 4096


def _asked(function: Callable[..., Any], points: int, *arguments: Any, **how: Any) -> Any:
    """What the function makes of these, if there is time for so many points."""
    keep_time()
    if points > _MOST:
        raise TooHardError(f"areas with {points} points are too many to compare: check fewer contours in a file")
    try:
        with interruptible():
            return function(*arguments, **how)
    except GEOSException as error:
        keep_time()  # raises where the time is over: then the step was interrupted
        raise NoAnswerError("the areas of its contours cannot be computed: points of them all but meet") from error


def _of_each(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function that makes one area of each, or of each pair; of arrays an array."""

    def step(*arguments: Any, **how: Any) -> Any:
        columns = np.broadcast_arrays(*arguments)
        points = sum(shapely.get_num_coordinates(column) for column in columns if column.dtype == object)
        if not columns[0].ndim:
            return _asked(function, int(points), *arguments, **how)
        result = np.empty(columns[0].shape, object)
        share = np.cumsum(points) // _AT_A_TIME
        for part in np.split(np.arange(len(result)), np.flatnonzero(np.diff(share)) + 1):
            result[part] = _asked(
                function, int(points[part].max(initial=0)), *(column[part] for column in columns), **how
            )
        return result

    return step


def _with_itself(area: Any) -> Any:
    """What lies twice in it once."""
    return shapely.unary_union(np.asarray(area)[..., None], axis=-1)


union = _of_each(shapely.union)
difference = _of_each(shapely.difference)
intersection = _of_each(shapely.intersection)
buffer = _of_each(shapely.buffer)
make_valid = _of_each(shapely.make_valid)
maximum_inscribed_circle = _of_each(shapely.maximum_inscribed_circle)
with_itself = _of_each(_with_itself)


def union_all(areas: Any, grid_size: float | None = None) -> Any:
    """All of them as one area."""
    return _asked(shapely.union_all, int(np.sum(shapely.get_num_coordinates(areas))), areas, grid_size=grid_size)


def dwithin(one: Any, other: Any, distance: Any) -> Any:
    """Whether each of one lies within the distance of the same of the other [mm]; bool[n]."""
    share = np.cumsum(shapely.get_num_coordinates(other)) // _PIECES_AT_A_TIME
    result = np.zeros(len(other), bool)
    for part in np.split(np.arange(len(other)), np.flatnonzero(np.diff(share)) + 1):
        result[part] = _asked(shapely.dwithin, 0, one[part], other[part], distance=distance[part])
    return result
