"""The moves on the polar plane: centers of arcs, what travels at all, and how far."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from polarcheck.arrays import Floats, Mask, Points, States, is_among
from polarcheck.geometry import polar
from polarcheck.geometry.tolerances import ZERO
from polarcheck.machines.modal import Distance, Motion
from polarcheck.table.positions import NOWHERE, Positions


class PlaneMoves(Positions):
    """The columns of the moves on the plane; see the properties."""

    @cached_property
    def to_center(self) -> tuple[Floats, Floats]:
        """
        From the start of an arc to its center along the linear and the virtual axis [mm]; NaN where not written.

        Where the word says that it is a coordinate, I=AC(10), it is one of the program.
        """
        along, across = super().to_center
        if self.run.distance is None:
            return along, across
        start = self.start + self.center_shift
        if self.frames is not None:
            start = np.conj(self.frames.turn) * (start - self.frames.shift)
        is_place, is_place_across = (
            self._of_axis(lambda axis, at=at: self.is_coordinate_of_center(axis, at))  # type: ignore[misc]
            for at in (0, 1)
        )
        along = np.where(is_place, along * self.x_factor - start.real, along)
        return along, np.where(is_place_across, across - start.imag, across)

    def is_coordinate_of_center(self, axis: str, at: int) -> Mask:
        """Whether a word of the center of an arc is a coordinate; at: 0 along the linear axis, 1 along the other."""
        own = self.distance(self._center_words(axis)[at])
        return np.zeros(len(self), bool) if own is None else own == Distance.ABSOLUTE

    @cached_property
    def center(self) -> Points:
        """Center of an arc on the polar plane [mm]; NaN for lines and where it cannot be known."""
        arcs = self.is_arc
        center = np.full(len(self), NOWHERE)
        if not arcs.any():
            return center
        i, j = (words[arcs] for words in self.to_center)
        written = ~np.isnan(i) | ~np.isnan(j)
        start, end, kind = self.start[arcs], self.end[arcs], self.motion[arcs]
        to_center = np.nan_to_num(i) + 1j * np.nan_to_num(j)
        if self.frames is not None:
            to_center = to_center * self.frames.turn[arcs]
        by_center = np.where(written, start + to_center, NOWHERE)
        radius = self.length_of(self.machine.arcs.radius_word)[arcs]
        by_radius = polar.center_from_radius(start, end, radius, kind, np.inf)
        center[arcs] = np.where(np.isnan(radius), by_center, by_radius)
        return center

    @cached_property
    def is_arc(self) -> Mask:
        """An arc on the polar plane."""
        return self.in_polar & self.moves_plane & is_among(self.motion, (Motion.CW, Motion.CCW))

    @cached_property
    def travels(self) -> Mask:
        """
        A move on the polar plane of some length, round a full circle, or of a length that is not known.

        Words that name the present position are no movement (B-63664EN p. 170), nor is an arc by R to its start.
        """
        still = np.abs(self.end - self.start) <= ZERO
        is_full = self.is_arc & ~np.isnan(self.center)
        return np.asarray(self.in_polar & self.moves_plane & (~still | is_full))

    @cached_property
    def length(self) -> Floats:
        """Way of the row on the polar plane [mm]; 0 where it does not move there, NaN where unknown."""
        moving = self.in_polar & self.moves_plane
        length = np.zeros(len(self))
        length[moving] = polar.length(*self._move(moving))
        return length

    def _move(self, rows: Mask) -> tuple[Points, Points, Points, States]:
        return self.start[rows], self.end[rows], self.center[rows], self.motion[rows]
