"""The fewest lines and arcs along a way, each as long as the tolerance allows, with joints at programmed places."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np

from polarcheck.foundation.arrays import Rows, column_at
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.fitted_curves.bends import bend, error
from polarcheck.geometry.fitted_curves.spirals import Samples

#: A line is taken where an arc would reach no farther than this many times as far.
_ARC_GAIN = 1.25
#: Greatest distance, in joints, of a better joint from where the longest element ends.
_FARTHEST_JOINT = 64

#: First and last place, and u as in bends.py.
Element = tuple[int, int, float]


def longest_elements(samples: Samples, tolerance: float, most: float = math.inf) -> list[Element] | None:
    """
    Return lines and arcs that pass all places within the tolerance [mm], one behind the other; None
    where `most` of them do not reach the end.

    Each is as long as possible by doubling and halving, so that the time grows as n log n; then joints move to where
    both elements beside them fit best: the longest one reaches beyond a tangent joint by what the tolerance hides.
    """
    joints = np.flatnonzero(samples.joint)
    elements: list[Element] = []
    start, guess = 0, 8
    while start < len(joints) - 1:
        keep_time()
        if len(elements) >= most:
            return None
        first = int(joints[start])

        def arc(to: int, first: int = first) -> float | None:
            return bend(samples, first, int(joints[to]), tolerance)

        def line(to: int, first: int = first) -> float | None:
            return bend(samples, first, int(joints[to]), tolerance, straight=True)

        end = _longest(arc, start, len(joints) - 1, guess)
        straight = end if line(end) is not None else _longest(line, start, end, max((end - start) // 2, 1))
        far, near = (abs(samples.point[joints[to]] - samples.point[first]) for to in (end, straight))
        is_line = far <= _ARC_GAIN * near or end == start + 1
        end = straight if is_line else end
        u = 0.0 if is_line else arc(end) or 0.0
        elements.append((first, int(joints[end]), u))
        guess, start = max(end - start, 2), end
    return _joined_best(samples, tolerance, elements, joints)


def _longest(fits: Callable[[int], float | None], start: int, last: int, guess: int) -> int:
    """Return the farthest joint up to which an element fits, at least the next one; by doubling, then by halving."""
    good, step = start + 1, max(guess, 1)
    bad = last + 1
    while good < last:
        to = min(start + step, last)
        if to <= good:
            to = good + 1
        if fits(to) is None:
            bad = to
            break
        good, step = to, 2 * (to - start)
    while bad - good > 1:
        middle = (good + bad) // 2
        if fits(middle) is None:
            bad = middle
        else:
            good = middle
    return good


def _joined_best(samples: Samples, tolerance: float, elements: list[Element], joints: Rows) -> list[Element]:
    """Move each joint to where the squares of the distances along both of its elements are least."""
    ordinal = column_at(len(samples), joints, np.arange(len(joints)), 0)
    result = list(elements)
    for k in range(1, len(result)):
        keep_time()
        (first, current, u), (_, last, v) = result[k - 1], result[k]
        if u == 0 and v == 0:
            continue  # a corner: the line ends there

        def both(joint: int, first: int = first, last: int = last, u: float = u, v: float = v) -> float:
            return error(samples, first, joint, tolerance, straight=u == 0) + error(
                samples, joint, last, tolerance, straight=v == 0
            )

        best, least = current, both(current)
        for step in _steps(current, first, last, ordinal):
            for to in (ordinal[best] - step, ordinal[best] + step):
                if ordinal[first] < to < ordinal[last]:
                    joint = int(joints[to])
                    here = both(joint)
                    if here < least:
                        best, least = joint, here
        if best != current:
            new_u = bend(samples, first, best, tolerance, straight=u == 0)
            new_v = bend(samples, best, last, tolerance, straight=v == 0)
            result[k - 1], result[k] = (first, best, new_u or 0.0), (best, last, new_v or 0.0)
    return result


def _steps(joint: int, first: int, last: int, ordinal: Rows) -> Iterator[int]:
    """Yield the steps in which to search for a better joint: halves, then single joints several times."""
    widest = int(min(ordinal[last] - ordinal[joint], ordinal[joint] - ordinal[first], _FARTHEST_JOINT))
    step = widest // 2
    while step > 1:
        yield step
        step //= 2
    yield from (1, 1, 1)
