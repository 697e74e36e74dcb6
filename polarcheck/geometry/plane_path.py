"""Paths of lines and arcs on the polar plane: the columns that all tables of moves have, and what follows from them."""

from __future__ import annotations

from typing import Self

import msgspec
import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, Table, runs
from polarcheck.foundation.states import Motion
from polarcheck.geometry import polar
from polarcheck.geometry.plane import angle_between, arc_sweep, quiet
from polarcheck.geometry.tolerances import ZERO


class PlanePath(Table, frozen=True):
    """
    Moves on the polar plane, n of them, in the order in which they run. A table of moves with more columns extends it.

    start, end: complex128[n], plane points [mm, X as radius], NaN unknown. center: complex128[n], NaN for lines.
    kind: int16[n], Motion; what is neither CW nor CCW is a line.
    """

    start: Points
    end: Points
    center: Points
    kind: States

    @property
    def shape(self) -> tuple[Points, Points, Points, States]:
        """start, end, center, kind: what the functions of `polar` and `rates` take."""
        return self.start, self.end, self.center, self.kind

    @property
    def is_arc(self) -> Mask:
        """The move is an arc, of a known center or not."""
        return np.asarray((self.kind == Motion.CW) | (self.kind == Motion.CCW))

    @property
    def is_known(self) -> Mask:
        """Every coordinate of the move is known."""
        return ~(np.isnan(self.start) | np.isnan(self.end) | (self.is_arc & np.isnan(self.center)))

    @property
    def is_still(self) -> Mask:
        """The move stands still on the plane, as Z alone."""
        return np.asarray((self.start == self.end) & ~self.is_arc)

    @property
    def sweep(self) -> Floats:
        """Signed angle of each arc about its center [rad], counterclockwise above 0; 0 for lines."""
        return arc_sweep(*self.shape)

    @property
    def length(self) -> Floats:
        """Length of each move [mm]."""
        return polar.length(*self.shape)

    @property
    def nearest(self) -> Floats:
        """Smallest distance of each move from the center of C [mm]."""
        return polar.nearest(*self.shape)

    @property
    def leaving(self) -> Points:
        """Unit direction of each move at its start."""
        return self._directions(self.start)

    @property
    def arriving(self) -> Points:
        """Unit direction of each move at its end."""
        return self._directions(self.end)

    def _directions(self, point: Points) -> Points:
        turning = np.where(self.kind == Motion.CCW, 1j, -1j)
        vector = np.where(np.isnan(self.center), self.end - self.start, turning * (point - self.center))
        return np.asarray(vector / np.maximum(np.abs(vector), ZERO))

    @quiet
    def points(self, move: Rows, share: Floats) -> Points:
        """
        Return points of moves at shares of their length; where share is 0 or 1 they are start and end exactly.

        An arc whose end is not quite on its circle is a spiral.
        """
        arcs, point = self.is_arc[move].nonzero()[0], np.empty(len(move), np.complex128)
        if len(arcs) < len(move):
            start = self.start[move]
            point[:] = start + (self.end[move] - start) * share
        if len(arcs):
            spoke = self.start - self.center
            growth = np.where(spoke == 0, 0, np.abs(self.end - self.center) / np.maximum(np.abs(spoke), ZERO) - 1)
            of, of_arc = move[arcs], share[arcs]
            angle, turn = self.sweep[of] * of_arc, np.empty(len(arcs), np.complex128)
            turn.real, turn.imag = np.cos(angle), np.sin(angle)
            point[arcs] = self.center[of] + spoke[of] * (1 + growth[of] * of_arc) * turn
        for at, ends in enumerate((self.start, self.end)):
            there = (share == at).nonzero()[0]
            point[there] = ends[move[there]]
        return point

    def turned_by(self, turn: complex | Points) -> Self:
        """Return the moves turned about the center of C by the angle of a number of length 1, or of one per move."""
        columns = {name: getattr(self, name) for name in ("start", "end", "center")}
        # The center of lines stays NaN in its real part alone: equal lines are recognised by that.
        turned = {name: np.where(np.isnan(points), points, points * turn) for name, points in columns.items()}
        return msgspec.structs.replace(self, **turned)

    # ---- closed paths; one whose end is not its start is closed by a straight line ----

    @quiet
    def go_round(self, path: Rows, count: int) -> Mask:
        """Return a boolean for each of `count` paths: it goes round the center. path: that of each move, ascending."""
        first, last = runs(path)
        turns = np.radians(polar.c_sweep(*self.shape))
        turns[last] += angle_between(self.end[last], self.start[first])
        turn = np.bincount(path, weights=turns, minlength=count)
        # A path round the center makes whole turns, any other path makes none.
        return np.asarray(np.abs(turn) > np.pi)

    def goes_round(self) -> bool:
        """Return True if the moves, as one path, go round the center."""
        return bool(self.go_round(np.zeros(len(self), np.int64), 1)[0])

    @property
    def twice_swept(self) -> Floats:
        """Twice the area that the line from the center of C to each move sweeps, counterclockwise above 0 [mm2]."""
        sweep = self.sweep
        bows = np.abs(self.start - self.center) ** 2 * (sweep - np.sin(sweep))
        return np.asarray((self.start.conj() * self.end).imag + np.where(sweep != 0, bows, 0.0))

    def is_on_left(self) -> bool:
        """Return True if the center is on the left: inside a path that encloses its left, outside any other."""
        closing = (self.end[-1].conjugate() * self.start[0]).imag
        return self.goes_round() == bool(self.twice_swept.sum() + closing > 0)


class SpacePath(PlanePath, frozen=True):
    """
    A path with Z. z_start, z_end: float64[n] [mm].

    Where a move does not begin at the end of the one before it, as behind a block that moves Z alone, a straight line
    leads there, which belongs to the later move.
    """

    z_start: Floats
    z_end: Floats

    @property
    def is_known(self) -> Mask:
        """Every coordinate of the move is known, Z as well."""
        return super().is_known & ~np.isnan(self.z_start + self.z_end)
