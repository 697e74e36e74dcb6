"""
Operations of shapely on areas, under the names that shapely gives them.

The time for an operation grows faster than the number of its points, and it may fail where points of areas almost
meet. Each operation is therefore interrupted at the time limit, and many areas are processed in batches. An operation
that is too large or fails raises a TooHardError. Import late.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import shapely  # type: ignore[import-untyped]
from shapely.errors import GEOSException  # type: ignore[import-untyped]

from polarcheck.foundation.errors import NoAnswerError, TooHardError
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.polygons.interruption import interruptible, is_interrupt

#: Most points of one operation, and points of a batch of areas; about a second each.
_MOST, _AT_A_TIME = 1_000_000, 200_000
#: Points of lines compared with other lines in one batch.
_PIECES_AT_A_TIME = 4096


def _bounded(function: Callable[..., Any], points: int, *arguments: Any, **how: Any) -> Any:
    """The result of the function; raises TooHardError for too many points and where the operation fails."""
    keep_time()
    if points > _MOST:
        raise TooHardError(f"areas with {points} points are too many to compare: check fewer contours in a file")
    while True:
        try:
            with interruptible():
                return function(*arguments, **how)
        except GEOSException as error:
            keep_time()  # raises where the time is over: then the step was interrupted
            if is_interrupt(error):
                continue
            if "bad_alloc" in str(error):
                raise MemoryError from error
            raise NoAnswerError("the areas of its contours cannot be computed: points of them all but meet") from error


def _element_wise(function: Callable[..., Any]) -> Callable[..., Any]:
    """A function that applies an operation to each area or pair of areas; for arrays it returns an array."""

    def step(*arguments: Any, **how: Any) -> Any:
        columns = np.broadcast_arrays(*arguments)
        points = sum(shapely.get_num_coordinates(column) for column in columns if column.dtype == object)
        if not columns[0].ndim:
            return _bounded(function, int(points), *arguments, **how)
        result = np.empty(columns[0].shape, object)
        share = np.cumsum(points) // _AT_A_TIME
        for part in np.split(np.arange(len(result)), np.flatnonzero(np.diff(share)) + 1):
            result[part] = _bounded(
                function, int(points[part].max(initial=0)), *(column[part] for column in columns), **how
            )
        return result

    return step


def _with_itself(area: Any) -> Any:
    """Each area or set of lines without its overlaps with itself."""
    return shapely.unary_union(np.asarray(area)[..., None], axis=-1)


union = _element_wise(shapely.union)
difference = _element_wise(shapely.difference)
intersection = _element_wise(shapely.intersection)
symmetric_difference = _element_wise(shapely.symmetric_difference)
buffer = _element_wise(shapely.buffer)
make_valid = _element_wise(shapely.make_valid)
build_area = _element_wise(shapely.build_area)
maximum_inscribed_circle = _element_wise(shapely.maximum_inscribed_circle)
with_itself = _element_wise(_with_itself)


def union_all(areas: Any, grid_size: float | None = None) -> Any:
    """All of them as one area."""
    return _bounded(shapely.union_all, int(np.sum(shapely.get_num_coordinates(areas))), areas, grid_size=grid_size)


def dwithin(first: Any, second: Any, distance: Any) -> Any:
    """A boolean per pair: the first geometry lies within the distance of the second [mm]."""
    share = np.cumsum(shapely.get_num_coordinates(second)) // _PIECES_AT_A_TIME
    result = np.zeros(len(second), bool)
    for part in np.split(np.arange(len(second)), np.flatnonzero(np.diff(share)) + 1):
        result[part] = _bounded(shapely.dwithin, 0, first[part], second[part], distance=distance[part])
    return result
