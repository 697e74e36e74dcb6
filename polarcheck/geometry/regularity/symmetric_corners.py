"""Where corners should be for a contour to be as symmetric as most of its corners are."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.foundation.arrays import Mask, Points, first_in_run

#: Parts of a turn that are tried: every symmetric turn has one of these in it.
_PARTS = (2, 3, 5, 7, 11, 13)
#: Mirror images along the axes and across; by what the conjugate is turned.
_MIRRORS = (1 + 0j, -1 + 0j, 1j, -1j)
#: Least number, and least share, of points with an image among them for a symmetry to be intended.
_LEAST, _SHARE = 3, 0.45
#: Corners of a regular polygon about the center, and how many of them may be elsewhere.
_FEWEST_SIDES, _MOST_SIDES, _MISSING = 5, 36, 2
#: Guesses nearer to each other than this agree [mm].
_NEAR = 0.05


def missing_places(point: Points, tolerance: float) -> Points:
    """
    Where the images of points lie in which there is none, by each symmetry that most points have.

    point: complex128[n] [mm], each once. tolerance [mm].
    """
    images = [*_images(point, tolerance), *regular_polygons(point, tolerance, _MISSING)]
    places: list[Points] = [image[is_lonely(image, point, tolerance)] for image in images]
    return each_once(np.concatenate([np.zeros(0, np.complex128), *places]), tolerance)


def regular_polygons(point: Points, tolerance: float, missing: int, fewest: int = _FEWEST_SIDES) -> Iterator[Points]:
    """The corners of the regular polygons about the center that points are corners of, all but so many at least."""
    far = np.abs(point)
    for radius in each_once(far + 0j, tolerance).real:
        corner = point[(np.abs(far - radius) <= tolerance) & (far > _NEAR)]
        for sides in range(fewest, _MOST_SIDES + 1):
            if len(corner) < sides - missing:
                break
            turn = np.exp(2j * np.pi * np.arange(sides) / sides)
            for first in corner[: missing + 1]:
                nearest = np.argmin(np.abs((first * turn)[:, None] - point), axis=1)
                there = ~is_lonely(first * turn, point, tolerance)
                if sides - missing <= np.count_nonzero(there) < sides:
                    # All corners say where it lies: each of them is rounded.
                    yield np.mean(point[nearest[there]] * turn[there].conj()) * turn
                    break


def each_once(point: Points, tolerance: float) -> Points:
    """The points without those that repeat an earlier one."""
    if not len(point):
        return point
    near = np.abs(point[:, None] - point) <= tolerance
    return np.asarray(point[np.argmax(near, axis=1) == np.arange(len(point))])


def is_lonely(image: Points, point: Points, tolerance: float) -> Mask:
    """The images in which there is none of the points."""
    return np.asarray(np.abs(image[:, None] - point).min(axis=1) > 2 * tolerance)


def _images(point: Points, tolerance: float) -> Iterator[Points]:
    """The points after each turn and in each mirror that leaves most of them as they are."""
    for part in _PARTS:
        turn = np.exp(2j * np.pi / part)
        center = _common((point[None, :] - turn * point[:, None]).ravel() / (1 - turn), len(point))
        for middle in (0j, *center):
            image = middle + turn * (point - middle)
            if _fits(image, point, tolerance):
                yield image
                yield middle + (point - middle) / turn
                break
    for mirror in (*_MIRRORS, *_turned_mirrors(point)):
        shift = _common((point[None, :] - mirror * point.conj()[:, None]).ravel(), len(point))
        for aside in (0j, *shift):
            image = mirror * point.conj() + aside
            if _fits(image, point, tolerance):
                yield image
                break


def _fits(image: Points, point: Points, tolerance: float) -> bool:
    count = len(point) - int(np.count_nonzero(is_lonely(image, point, tolerance)))
    return count >= max(_LEAST, _SHARE * len(point)) and count < len(point)


def _common(guess: Points, count: int) -> Points:
    """The guess that most agree on, if they are more than chance; else none."""
    cell = np.round(guess / _NEAR)
    order = np.lexsort((cell.imag, cell.real))
    begins = first_in_run(cell[order])
    first = np.flatnonzero(begins)
    size = np.diff(first, append=len(order))
    best = int(np.argmax(size))
    if size[best] < max(_LEAST, _SHARE * count / 2):
        return np.zeros(0, np.complex128)
    near = guess[order[first[best] : first[best] + size[best]]]
    return np.array([near.mean()])


def _turned_mirrors(point: Points) -> Points:
    """The mirror through the center, in any direction, that most pairs of points have."""
    far = np.abs(point)
    same = np.abs(far[:, None] - far) <= _NEAR
    np.fill_diagonal(same, False)
    product = (point[:, None] * point)[same]
    product = product[np.abs(product) > _NEAR]
    return _common(product / np.abs(product) * 10, len(point)) / 10 if len(product) else product
