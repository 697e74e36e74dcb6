"""Corners that a control makes between two moves: an arc tangent to both, or a chamfer between two lines."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats, Mask, Points
from polarcheck.foundation.states import Motion
from polarcheck.geometry.cutter_compensation.corner import Corners, is_straight, meeting, turn
from polarcheck.geometry.plane import dot, quiet
from polarcheck.geometry.plane_path import PlanePath


class CornerPairs:
    """
    Moves before and after corners, n of each; a move ends where its second begins.

    before, after: the moves. radius: R of the arc, float64[n] [mm]; NaN where a chamfer is made. leg: way along each
    line that a chamfer cuts off, float64[n] [mm].
    """

    def __init__(self, before: PlanePath, after: PlanePath, radius: Floats, leg: Floats) -> None:
        self.before, self.after = before, after
        self._corners = Corners(
            point=before.end,
            arriving=before.arriving,
            leaving=after.leaving,
            center_before=before.center,
            center_after=after.center,
            turning_before=_turning(before),
            turning_after=_turning(after),
            fits=np.ones(len(before), bool),
            side=np.ones(len(before)),
            radius=radius,
        )
        self._turned = turn(self._corners)
        self._leg = leg

    @property
    def is_straight(self) -> Mask:
        """The moves are tangent: there is no corner."""
        return is_straight(self._turned)

    @quiet
    def made(self) -> PlanePath:
        """
        The arcs and chamfers; NaN where there is none: at a full reversal, beside an arc that is too small, and where a
        chamfer would meet an arc.

        The center of an arc is where the moves shifted by R to the inner side of the corner meet.
        """
        corners = self._corners
        side = np.where(self._turned.imag > 0, 1.0, -1.0)
        of_arc = Corners(**{name: getattr(corners, name) for name in corners.__struct_fields__} | {"side": side})
        too_small = np.logical_or(
            _is_too_small(self.before, side * corners.radius), _is_too_small(self.after, side * corners.radius)
        )
        center = np.where(too_small, np.nan, meeting(of_arc, self._turned, np.ones(len(side), bool)))
        is_arc = ~np.isnan(corners.radius)
        leg = np.where(self.before.is_arc | self.after.is_arc, np.nan, self._leg)
        touches_before = _touched(self.before, corners.point, corners.arriving, center)
        touches_after = _touched(self.after, corners.point, corners.leaving, center)
        start = np.where(is_arc, touches_before, corners.point - leg * corners.arriving)
        end = np.where(is_arc, touches_after, corners.point + leg * corners.leaving)
        of_side = np.where(side > 0, int(Motion.CCW), int(Motion.CW))
        kind = np.where(is_arc, of_side, int(Motion.LINE)).astype(np.int16)
        return PlanePath(start, end, np.where(is_arc, center, complex("nan+nanj")), kind)

    @quiet
    def cut_off(self, made: PlanePath) -> tuple[Floats, Floats]:
        """How much of the move before and of the move after each corner it replaces [mm]; NaN where it lies beside."""
        before, after = self.before, self.after
        first = PlanePath(made.start, before.end, before.center, before.kind)
        second = PlanePath(after.start, made.end, after.center, after.kind)
        return _along(first, self._corners.arriving), _along(second, self._corners.leaving)


def leg_of_length(before: PlanePath, after: PlanePath, length: Floats) -> Floats:
    """The legs of chamfers between lines from their lengths: both legs are equal, L = leg |d1 + d2| [mm]."""
    across = np.abs(before.arriving + after.leaving)
    return np.asarray(np.divide(length, across, out=np.full(len(length), np.nan), where=across > 0))


def _turning(path: PlanePath) -> Floats:
    return np.where(path.is_arc, np.where(path.kind == Motion.CCW, 1.0, -1.0), 0.0)


def _is_too_small(path: PlanePath, shift: Floats) -> Mask:
    """Arcs that have no circle shifted to their left by so much."""
    return path.is_arc & (np.abs(path.start - path.center) - _turning(path) * shift <= 0)


def _touched(path: PlanePath, point: Points, direction: Points, center: Points) -> Points:
    """Where circles about these centers touch the moves; point, direction: the corner, and unit tangents there."""
    on_line: Points = point + direction * dot(direction, center - point)
    spoke = center - path.center
    on_arc = path.center + spoke * (np.abs(path.start - path.center) / np.abs(spoke))
    return np.where(path.is_arc, on_arc, on_line)


def _along(path: PlanePath, direction: Points) -> Floats:
    """Lengths of moves [mm]; NaN for lines that run against the direction."""
    runs_on = path.is_arc | (dot(path.end - path.start, direction) >= 0)
    return np.where(runs_on, path.length, np.nan)
