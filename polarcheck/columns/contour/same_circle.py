"""Arcs that end on the circle of other arcs of their contour, and do not run along it."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.passes import Passes
from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import plain_number, slip_of
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, States, cached_property, column_at
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import cross

#: A turn that is meant as a corner [rad].
_CORNER = np.radians(1.5)
#: Points nearer to a circle than this lie on it, and centers so near to each other are one [mm].
_SAME = 0.02
#: Factors by which an R is mistaken: radius for diameter, a point that moved.
_FACTORS = np.array((2.0, 0.5, 10.0, 0.1))
#: A circle is parted at multiples of this angle, and how far off a point may be by rounding [deg].
_ROUND, _ROUNDING = 15, 0.05
#: An R that differs by less than this share is no crowned side of a bar.
_NEAR = 0.15


class IntendedArcs(NamedTuple):
    """
    Arcs that are meant on another circle, n of them.

    move: int[n], the move of the pass. radius: float64[n] [mm], R that is meant, negative above 180 deg.
    center: complex128[n] [mm], its center. tolerance: float64[n] [mm], what rounding leaves open of R.
    """

    move: Rows
    radius: Floats
    center: Points
    tolerance: Floats


class SameCircle(Columns, frozen=True):
    """The arcs of one trace that leave the circle on which they begin and end."""

    trace: Trace
    arcs: Arcs
    passes: Passes

    @cached_property
    def _candidates(self) -> Mask:
        """Per move: a circle, with a corner at one end at least."""
        passes, arcs = self.passes, self.arcs
        is_circle = ~(arcs.is_no_circle | arcs.ends_at_start)[passes.row] & ~np.isnan(passes.center)
        corner = np.nan_to_num(np.fmax(*(np.abs(turn) for turn in passes.turns))) > _CORNER
        return np.asarray(passes.is_arc & is_circle & corner & ~self._runs_back)

    @cached_property
    def _runs_back(self) -> Mask:
        """Per move: an arc that its section runs the other way, too, as a slot that is milled to and fro."""
        passes = self.passes
        section = self.trace.mode.section[passes.row]
        arcs = np.flatnonzero(passes.is_arc & ~np.isnan(passes.center))
        ends = np.stack([passes.start[arcs], passes.end[arcs]], axis=1)
        is_back = passes.motion[arcs] == Motion.CW
        # Of an arc and of the same one run back, these are one.
        way = np.where(is_back[:, None], ends[:, ::-1], ends)
        columns = np.column_stack([way.view(np.float64), passes.center[arcs].real, passes.center[arcs].imag])
        keys = np.column_stack([np.round(columns / _SAME), section[arcs]])
        order = np.lexsort(keys.T)
        number = column_at(len(arcs), order[1:], np.cumsum(np.any(np.diff(keys[order], axis=0) != 0, axis=1)), 0)
        count = int(number.max(initial=-1)) + 1
        runs = [np.bincount(number[is_back == back], minlength=count) > 0 for back in (False, True)]
        return column_at(len(passes.row), arcs, (runs[0] & runs[1])[number], False)

    @cached_property
    def leaves_circle(self) -> IntendedArcs:
        """Arcs with both ends on the circle of an arc beside them, or of one about the center of C."""
        passes = self.passes
        move = np.flatnonzero(self._candidates)
        # What is left of the bar is cut as it stands.
        move = move[np.abs(passes.center[move]) > _SAME]
        if not len(move):
            return _nothing()
        start, end = passes.start[move], passes.end[move]
        center, radius = np.full(len(move), complex("nan+nanj")), np.full(len(move), np.nan)
        of_pass, sense = self._bar
        at_bar = of_pass[passes.number[move]]
        on_bar = (np.abs(np.abs(start) - at_bar) <= _SAME) & (np.abs(np.abs(end) - at_bar) <= _SAME)
        on_bar &= sense[passes.number[move]] == passes.motion[move]
        center[on_bar], radius[on_bar] = 0, at_bar[on_bar]
        near = on_bar & self._is_slip(move, radius)
        adjacent = np.zeros(len(move), bool)
        for neighbor, joint, far in ((passes.beside[0][move], start, end), (passes.beside[1][move], end, start)):
            valid = (
                (neighbor >= 0)
                & passes.is_arc[neighbor]
                & (passes.motion[neighbor] == passes.motion[move])
                & (neighbor != move)
            )
            about = passes.center[neighbor]
            size = np.abs(joint - about)
            fits = valid & (np.abs(np.abs(far - about) - size) <= _SAME) & (np.abs(about - passes.center[move]) > _SAME)
            # In a circle of two halves each of them lies on the circle of the other one.
            fits &= passes.beside[0][move] != passes.beside[1][move]
            # A lens about the center of C: two equal circles at either side of it.
            fits &= np.abs(about + passes.center[move]) > _SAME
            center[fits], radius[fits], adjacent[fits] = about[fits], size[fits], True
        chosen = near | adjacent
        intended = self._intended(move[chosen], center[chosen], radius[chosen])
        # An R that is written as it is meant: of nearly 180 deg, its center is shifted by the rounding of its ends.
        is_other = ~(np.abs(self.arcs.radius[passes.row[intended.move]] - intended.radius) <= _SAME)
        index = np.flatnonzero(chosen)[is_other]
        return self._intended(move[index], center[index], radius[index])

    @cached_property
    def reversed(self) -> Mask:
        """Rows of arcs that end on the circle of such an arc and have its R, and bend the other way."""
        passes, trace = self.passes, self.trace
        move = np.flatnonzero(self._candidates & self.arcs.by_radius[passes.row])
        if not len(move):
            return trace.blocks.nowhere
        start, end, motion = passes.start[move], passes.end[move], passes.motion[move]
        size = np.abs(start - passes.center[move])
        at_bar, sense = self._bar
        number = passes.number[move]
        on_bar = np.abs(np.abs(start) - at_bar[number]) <= _SAME
        on_bar &= (np.abs(np.abs(end) - at_bar[number]) <= _SAME) & (sense[number] != motion)
        chosen = on_bar & (np.abs(size - at_bar[number]) <= _SAME)
        for neighbor, far in ((passes.beside[0][move], end), (passes.beside[1][move], start)):
            about = passes.center[neighbor]
            fits = (neighbor >= 0) & passes.is_arc[neighbor] & (passes.motion[neighbor] != motion)
            fits &= (np.abs(np.abs(far - about) - size) <= _SAME) & (np.abs(about - passes.center[move]) > _SAME)
            joint = np.abs(passes.start[neighbor] - about)
            chosen |= fits & (np.abs(joint - size) <= _SAME) & (passes.beside[0][move] != passes.beside[1][move])
        return trace.blocks.mask_of(passes.row[move[chosen]])

    @cached_property
    def _bar(self) -> tuple[Floats, States]:
        """Per pass the radius of its arcs about the center of C [mm], NaN without any, and their motion."""
        passes = self.passes
        about_axis = passes.is_arc & (np.abs(passes.center) <= _SAME)
        radius, sense = np.full(len(passes.first), np.nan), np.zeros(len(passes.first), np.int16)
        radius[passes.number[about_axis]] = np.abs(passes.start[about_axis])
        sense[passes.number[about_axis]] = passes.motion[about_axis]
        return radius, sense

    def _is_slip(self, move: Rows, radius: Floats) -> Mask:
        """The R that is written is the R that is meant but for a slip, or nearly that."""
        passes = self.passes
        written = np.abs(passes.start[move] - passes.center[move])
        ratio = _ratio(written, radius)
        slip = np.abs(ratio - 1) <= _NEAR
        slip |= (np.abs(ratio[:, None] - _FACTORS) <= 2e-3 * _FACTORS).any(axis=1)
        scale = self.trace.lengths.scale[passes.row[move]]
        for index in np.flatnonzero(~slip & ~np.isnan(radius)).tolist()[:100]:
            unit = float(scale[index])
            mistake = slip_of(plain_number(written[index] / unit), float(radius[index]) / unit, _SAME / unit)
            slip[index] = mistake is not None and mistake.plain
        return np.asarray(slip)

    @cached_property
    def mistaken_together(self) -> IntendedArcs:
        """Arcs of one R, one after the other, on the circle through whose ends that R is mistaken by a factor."""
        passes = self.passes
        following = passes.beside[1]
        candidates = self._candidates
        former = np.flatnonzero(candidates & (following >= 0))
        two = following[former]
        size = np.abs(passes.start - passes.center)
        alike = (
            candidates[two]
            & (passes.motion[former] == passes.motion[two])
            & (np.abs(size[former] - size[two]) <= _SAME)
        )
        alike &= (np.abs(passes.turns[1][former]) > _CORNER) & (former != two)
        former, two = former[alike], two[alike]
        if not len(former):
            return _nothing()
        center = _circumcenter(passes.start[former], passes.end[former], passes.end[two])
        # Two halves of a circle.
        halves = np.abs(passes.start[former] - passes.end[two]) <= _SAME
        center = np.where(halves, (passes.start[former] + passes.end[former]) / 2, center)
        radius = np.abs(passes.end[former] - center)
        ratio = _ratio(size[former], radius)
        chosen = (np.abs(ratio[:, None] - _FACTORS) <= 2e-3 * _FACTORS).any(axis=1)
        # The sides of a rectangle may bulge; a circle is parted at round angles.
        spoke = np.degrees(np.angle(passes.end[former] - center))
        chosen &= np.abs(spoke / _ROUND - np.rint(spoke / _ROUND)) * _ROUND < _ROUNDING
        # The way round the circle is that of the arcs.
        turn = cross(passes.end[former] - passes.start[former], passes.end[two] - passes.end[former])
        chosen &= halves | ((turn > 0) == (passes.motion[former] == Motion.CCW))
        move = np.concatenate([former[chosen], two[chosen]])
        both_center, both_radius = np.tile(center[chosen], 2), np.tile(radius[chosen], 2)
        if not len(move):
            return _nothing()
        move, first = np.unique(move, return_index=True)
        return self._intended(move, both_center[first], both_radius[first])

    def _intended(self, move: Rows, center: Points, radius: Floats) -> IntendedArcs:
        passes = self.passes
        spoke, last = passes.start[move] - center, passes.end[move] - center
        is_ccw = passes.motion[move] == Motion.CCW
        sweep = np.angle(last * spoke.conj()) * np.where(is_ccw, 1, -1) % (2 * np.pi)
        tolerance = 4 * passes.half_of_last_digit[move] + 2e-3
        return IntendedArcs(move, np.where(sweep > np.pi + 2e-3, -radius, radius), center, tolerance)


def _ratio(written: Floats, radius: Floats) -> Floats:
    """By which factor each R is mistaken; an R of 0 is mistaken by none."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(written / radius)


def _circumcenter(first_point: Points, two: Points, three: Points) -> Points:
    """The center of the circle through three points; NaN where they lie on a line."""
    first, second = two - first_point, three - first_point
    area = 2 * cross(first, second)
    with np.errstate(divide="ignore", invalid="ignore"):
        off = (np.abs(first) ** 2 * second - np.abs(second) ** 2 * first) * (-1j) / area
    center: Points = first_point + off
    return center


def _nothing() -> IntendedArcs:
    none = np.zeros(0)
    return IntendedArcs(np.zeros(0, np.int64), none, none.astype(np.complex128), none)
