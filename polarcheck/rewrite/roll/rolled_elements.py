"""The lines and arcs of a stretch, and Z alone between them."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, mask_at
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.states import Motion
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.fitted_curves.curves import fitted
from polarcheck.geometry.fitted_curves.spirals import Samples, bows, counts, sampled
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import CHORDS_OF_FILE, ZERO
from polarcheck.rewrite.roll.ways import AxisMoves, runs_of


class Element(msgspec.Struct, frozen=True):
    """
    A line or an arc on the part, or a move of only Z.

    kind: Motion; NONE for only Z.
    start, end, center: in the frame of the part [mm]; center NaN unless it is an arc.
    z: depth at its end [mm]; None if Z does not move.
    first, until: first and end of the moves that it replaces.
    """

    kind: int
    start: complex
    end: complex
    center: complex
    z: float | None
    first: int
    until: int

    @property
    def path(self) -> PlanePath:
        """The element as a path of a single move."""
        start, end, center = (np.array([point], complex) for point in (self.start, self.end, self.center))
        return PlanePath(start, end, center, np.array([self.kind], np.int16))


class Fit(msgspec.Struct, frozen=True):
    """
    The lines and arcs that replace a stretch.

    elements: in order.
    bow: the largest distance of a replaced block from the straight line between its ends [mm].
    """

    elements: list[Element]
    bow: float


_NOWHERE = complex(math.nan, math.nan)


def fit_of(moves: AxisMoves, tolerance: float, reserve: float, noise: float) -> Fit:
    """
    Return lines and arcs that pass the ends of all blocks within the tolerance [mm].

    reserve: the part of the tolerance that is kept for rounding the new words [mm].
    noise: the rounding of the words of the blocks [mm].
    Raises TooHardError for a path that needs too many samples.
    """
    elements: list[Element] = []
    bow = 0.0
    for begin, end, is_on_plane in runs_of(moves):
        keep_time()
        if not is_on_plane:
            point = complex(moves.radius[begin] * np.exp(1j * moves.angle[begin]))
            z = float(moves.z[begin])
            elements.append(Element(Motion.NONE, point, point, _NOWHERE, z, begin, end))
            continue
        radius, angle, z_of = (
            np.append(before[begin], ends[begin:end])
            for before, ends in (
                (moves.start_radius, moves.radius),
                (moves.start_angle, moves.angle),
                (moves.z_before, moves.z),
            )
        )
        if counts(radius, angle, tolerance).sum() > CHORDS_OF_FILE:
            raise TooHardError(f"the moves of C take more than {CHORDS_OF_FILE} samples")
        samples = sampled(radius, angle, z_of, tolerance, reserve)
        bow = max(bow, _bow(samples, radius, angle))
        elements += _of_run(samples, begin, tolerance - reserve, noise)
    return Fit(elements, bow)


def _bow(samples: Samples, radius: Floats, angle: Floats) -> float:
    """How far blocks bow of which the contour passes the ends alone [mm]."""
    free = mask_at(len(radius) - 1, samples.block[samples.slack > 0])
    return float(bows(radius, angle)[free].max(initial=0.0))


def _of_run(samples: Samples, first: int, tolerance: float, noise: float) -> list[Element]:
    curves = fitted(samples, tolerance, noise)
    elements = []
    first_sample = 0
    columns = (*curves.shape, curves.last)
    for start, end, center, kind, last in zip(*(column.tolist() for column in columns), strict=True):
        z = samples.z[first_sample : last + 1]
        moves_z = bool((np.abs(z - z[0]) > ZERO).any())
        blocks = int(samples.block[first_sample + 1]), int(samples.block[last]) + 1
        elements.append(
            Element(kind, start, end, center, float(z[-1]) if moves_z else None, first + blocks[0], first + blocks[1])
        )
        first_sample = last
    return elements
