"""
Arcs that are not tangent at their ends, where the blocks on both sides, and the other arcs of the contour, show which
arc would be.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from polarcheck.columns.contour.passes import LEADS, Passes
from polarcheck.columns.contour.same_circle import IntendedArcs, SameCircle
from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.slips import plain_number, slip_of
from polarcheck.foundation.arrays import Columns, Floats, Mask, Points, Rows, cached_property, column_at, different
from polarcheck.foundation.states import Motion, Units
from polarcheck.geometry.plane import angle_between

#: A turn that is meant as a corner [rad], and this many times what rounding turns a tangent by.
_CORNER, _CLEARLY = np.radians(1.5), 4
#: The same of an arc that may be meant the other way round.
_CORNER_REVERSED = np.radians(10)
#: A contour with a single arc: from this turn on a factor alone speaks for another R [rad].
_SHARP = np.radians(5)
#: Further slack for the direction of a tangent [rad], as from an I that is rounded to another digit.
_SLACK = 2e-3
#: Arcs that are nearly straight, or nearly a full circle, have no R that can be read from their neighbours [rad].
_FLAT = 0.02
#: Centers nearer to each other than this [mm], and radii, are the same.
_SAME = 0.02
#: Factors by which an R is mistaken: radius for diameter, a point that moved.
_FACTORS = (2.0, 0.5, 10.0, 0.1)
#: Ratios that differ by less than this share are one factor.
_LIKE = 0.02
#: The least step of R on drawings, in mm and in inch.
_STEP, _STEP_INCH = 0.5, 1 / 32
#: Passes in which arcs are judged.
_MOST = 2000


class _Candidates(NamedTuple):
    """
    The judged arcs, n of them: circles with a move on either side.

    move: int[n], the move of the pass. tolerance: float64[n] [rad], by which rounding turns a tangent.
    radius: float64[n] [mm], with its sign, of the arc that would be tangent on both sides; NaN where none is.
    center: complex128[n] [mm], of that arc.
    """

    move: Rows
    tolerance: Floats
    radius: Floats
    center: Points


class Tangency(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    arcs: Arcs
    passes: Passes
    same_circle: SameCircle

    @cached_property
    def _candidates(self) -> _Candidates:
        passes, arcs = self.passes, self.arcs
        previous, following = passes.beside
        is_circle = ~(arcs.is_no_circle | arcs.ends_at_start)[passes.row] & ~np.isnan(passes.center)
        move = np.flatnonzero(passes.is_arc & is_circle & (previous >= 0) & (following >= 0))
        begins, ends = passes.tangents
        start, end, written = passes.start[move], passes.end[move], passes.center[move]
        chord, digit = end - start, 2 * passes.half_of_last_digit[move]
        half_chord, radius = np.abs(chord) / 2, np.abs(start - written)
        length = self.trace.path.length[passes.row]
        shortest = np.minimum(length[previous[move]], length[following[move]])
        apart = np.sqrt(np.maximum(radius**2 - half_chord**2, digit * radius))
        with np.errstate(divide="ignore", invalid="ignore"):
            tolerance = np.asarray(_SLACK + digit * (1 / shortest + 1 / apart + 1 / half_chord))
            fits_within = _SLACK + digit * (1 / shortest + 1 / half_chord)
            into, out = angle_between(ends[previous[move]], chord), angle_between(chord, begins[following[move]])
            half = (into + out) / 2
            fits = (np.abs(into - out) <= 2 * fits_within) & (np.abs(half) > _FLAT) & (np.abs(half) < np.pi - _FLAT)
            fits &= (half > 0) == (passes.motion[move] == Motion.CCW)
            size = np.where(fits, half_chord / np.sin(np.abs(half)), np.nan)
            direction = chord / np.abs(chord) * np.exp(-1j * half)
        center = start + 1j * np.sign(half) * size * direction
        # Half a circle is one by either sign.
        signed = np.where(np.abs(half) > np.pi / 2 + fits_within, -size, size)
        return _Candidates(move, tolerance, signed, center)

    # ---- as it is written ----

    @cached_property
    def is_tangent(self) -> Mask:
        """Arcs that are tangent to the moves on both sides."""
        candidates, (into, out) = self._candidates, self.passes.turns
        turn = np.maximum(np.abs(into), np.abs(out))[candidates.move]
        return self._column(candidates.move[turn <= candidates.tolerance])

    def _column(self, moves: Rows) -> Mask:
        return self.trace.blocks.mask_of(self.passes.row[moves])

    # ---- with the other sense ----

    @cached_property
    def _corners(self) -> Floats:
        """Per judged arc the smaller of the turns at its ends [rad]."""
        return np.asarray(np.min([np.abs(turn[self._candidates.move]) for turn in self.passes.turns], axis=0))

    @cached_property
    def _fits_reversed(self) -> Mask:
        """Judged arcs in offset mode that turn a corner at either end, and are tangent on both sides if reversed."""
        passes, (move, tolerance, *_) = self.passes, self._candidates
        start, end, center = passes.start[move], passes.end[move], passes.center[move]
        # By R it is the other circle through both ends, by I and J the same circle the other way round.
        center = np.where(self.arcs.by_radius[passes.row[move]], start + end - center, center)
        turning = np.where(passes.motion[move] == Motion.CCW, -1j, 1j)
        previous, following = (neighbor[move] for neighbor in passes.beside)
        into = angle_between(passes.tangents[1][previous], turning * (start - center))
        out = angle_between(turning * (end - center), passes.tangents[0][following])
        is_tangent = np.maximum(np.abs(into), np.abs(out)) <= tolerance
        is_corner = self._corners > np.maximum(_CORNER_REVERSED, _CLEARLY * tolerance)
        return np.asarray(is_tangent & is_corner & passes.compensated[passes.number[move]])

    @cached_property
    def fits_reversed(self) -> Mask:
        """Arcs in offset mode that turn a corner at either end, where the other sense is tangent on both sides."""
        return self._column(self._candidates.move[self._fits_reversed])

    @cached_property
    def is_reversed(self) -> Mask:
        """
        The only arcs of their pass that fit reversed, of which another arc is tangent; and those that go round the rest
        of the circle, back along the blocks on both sides, which is never intended.
        """
        candidates, number = self._candidates, self.passes.number[self._candidates.move]
        tangent, fitting = (
            np.bincount(number[of_pass], minlength=len(self.passes.first))[number]
            for of_pass in (self.is_tangent[self.passes.row[candidates.move]], self._fits_reversed)
        )
        back = self._corners >= np.pi - candidates.tolerance
        back &= self.arcs.sweep[self.passes.row[candidates.move]] > 180
        return self._column(candidates.move[self._fits_reversed & (back | ((tangent > 0) & (fitting == 1)))])

    # ---- as it would be ----

    @cached_property
    def _misfits(self) -> Rows:
        """The judged arcs, by their number there, for which another arc is meant."""
        passes, candidates = self.passes, self._candidates
        into, out = (np.abs(turn[candidates.move]) for turn in passes.turns)
        corner = np.minimum(into, out)
        candidate = ~np.isnan(candidates.radius) & (corner > np.maximum(_CORNER, _CLEARLY * candidates.tolerance))
        # Arcs about the center of C are what is left of the bar.
        candidate &= np.abs(passes.center[candidates.move]) > _SAME
        # Two equal circles at either side of it are a lens.
        candidate &= np.abs(passes.center[candidates.move] + candidates.center) > _SAME
        number = passes.number[candidates.move]
        chosen = [self._misfits_of(which, candidate) for which in different(number[candidate])[:_MOST].tolist()]
        return np.concatenate([np.zeros(0, np.int64), *chosen])

    def _misfits_of(self, number: int, candidate: Mask) -> Rows:
        """Candidates of a pass where the rest of the pass shows that another arc is intended."""
        passes, candidates = self.passes, self._candidates
        begin, until = np.searchsorted(passes.number[candidates.move], (number, number + 1)).tolist()
        of_contour = np.arange(begin, until)
        wrong = of_contour[candidate[begin:until]]
        written, size = passes.center[candidates.move], self._written[candidates.move]
        single = [
            index
            for index in wrong.tolist()
            if not _shares_circle(
                written[index],
                abs(size[index]),
                np.delete(written[of_contour], index - begin),
                np.delete(np.abs(size[of_contour]), index - begin),
            )
        ]
        if not single:
            return np.zeros(0, np.int64)
        limit = candidates.tolerance[of_contour]
        previous, following = (neighbor[candidates.move[of_contour]] for neighbor in passes.beside)
        into, out = (np.abs(turn[candidates.move[of_contour]]) <= limit for turn in passes.turns)
        tangent_before = into & out
        if not tangent_before.any() and len(single) == len(of_contour) > 1:
            return np.array(single) if self._all_mistaken(of_contour) else np.zeros(0, np.int64)
        chosen = []
        for index in single:
            move = candidates.move[index]
            tangent = (into | (previous == move)) & (out | (following == move)) & (of_contour != index)
            tangent_count, corners = int(tangent.sum()), len(of_contour) - 1 - int(tangent.sum())
            needed, had = float(candidates.radius[index]), float(size[index])
            near = self._tolerance_of(index)
            is_sign = abs(needed + had) <= near
            is_like = bool((np.abs(size[of_contour][tangent] - needed) <= near).any())
            is_factor = any(abs(abs(needed) * factor - abs(had)) <= near * factor for factor in _FACTORS)
            is_slip = is_factor or self._is_mistyped(index, near)
            if tangent_count >= 2:
                is_reported = (
                    is_sign
                    or corners == 0
                    or (is_slip and tangent_count >= corners)
                    or (is_like and tangent_count > corners)
                )
            else:
                # One end of a slot may be flatter than the other one on purpose.
                sharp = min(abs(passes.turns[0][move]), abs(passes.turns[1][move])) > _SHARP
                is_reported = is_sign or (is_slip and is_like) or (is_factor and corners == 0 and sharp)
            if is_reported:
                chosen.append((needed < 0, index))
        # Of two halves of a circle each would fit the other one: the shorter way round is meant.
        return np.array([index for is_long, index in chosen if not is_long or len(chosen) == 1], np.int64)

    def _all_mistaken(self, chosen: Rows) -> bool:
        """No arc of a pass is tangent, and all would be with an R that is mistaken in the same way."""
        candidates = self._candidates
        needed, had = candidates.radius[chosen], self._written[candidates.move[chosen]]
        ratio = np.abs(had / needed)
        near = max(self._tolerance_of(index) for index in chosen.tolist())
        if np.ptp(ratio) > 2 * near / np.abs(needed).min():
            return False
        if (np.abs(ratio.mean() - np.array(_FACTORS)) <= 2 * near / np.abs(needed).min() * ratio.mean()).any():
            return True
        row = self.passes.row[candidates.move[chosen[0]]]
        step = _STEP_INCH if self.trace.lengths.units[row] == Units.INCH else _STEP
        whole = needed / self.trace.lengths.scale[row] / step
        return bool(len(chosen) > 2 and np.ptp(had) <= near and (np.abs(whole - np.rint(whole)) <= near / step).all())

    @cached_property
    def _leads(self) -> IntendedArcs:
        """Leads with a corner at the contour, of which the R of a lead that is tangent to it would make no corner."""
        passes, arcs = self.passes, self.arcs
        has_leads = passes.compensated & passes.closed & (passes.last - passes.first >= LEADS)
        first, last = (ends[has_leads] for ends in (passes.first, passes.last))
        move, wall = np.append(first, last), np.append(first + 1, last - 1)
        is_circle = passes.is_arc & ~(arcs.is_no_circle | arcs.ends_at_start)[passes.row] & ~np.isnan(passes.center)
        chosen = is_circle[move] & ~passes.in_ring[move] & (passes.tangents[0][wall] != 0)
        move, wall, is_out = move[chosen], wall[chosen], wall[chosen] < move[chosen]
        chord, digit = passes.end[move] - passes.start[move], 2 * passes.half_of_last_digit[move]
        corner = np.abs(np.where(is_out, passes.turns[0][move], passes.turns[1][move]))
        along = np.where(is_out, passes.tangents[1][wall], passes.tangents[0][wall])
        half = np.where(is_out, 1, -1) * angle_between(along, chord)
        with np.errstate(divide="ignore", invalid="ignore"):
            slack = _SLACK + digit * (1 / np.abs(chord) + 1 / self.trace.path.length[passes.row[wall]])
            radius = np.abs(chord) / 2 / np.sin(np.abs(half))
            near = digit / np.sin(np.abs(half)) + radius * slack / np.tan(np.abs(half)) + 1e-3
        is_tangent = corner <= slack + digit / np.abs(self._written[move])
        fits = (corner > np.maximum(_CORNER, _CLEARLY * slack)) & (np.abs(half) > _FLAT) & (np.abs(half) < np.pi / 2)
        fits &= (half > 0) == (passes.motion[move] == Motion.CCW)
        models = np.append(np.abs(self._written[move[is_tangent]]), np.inf)
        move, chord, half, digit, radius, near = (part[fits] for part in (move, chord, half, digit, radius, near))
        model = models[np.abs(models - radius[:, None]).argmin(axis=1)]
        is_like = np.abs(model - radius) <= near
        move, chord, half, digit, model = (part[is_like] for part in (move, chord, half, digit, model))
        center = passes.start[move] + 1j * np.sign(half) * model * chord / np.abs(chord) * np.exp(-1j * half)
        return IntendedArcs(move, model, center, digit)

    def _tolerance_of(self, index: int) -> float:
        """Uncertainty by rounding of the R that would be tangent [mm]."""
        candidates, passes = self._candidates, self.passes
        move, needed = candidates.move[index], abs(float(candidates.radius[index]))
        half = np.arcsin(min(1.0, abs(passes.end[move] - passes.start[move]) / 2 / needed))
        slack = min(float(candidates.tolerance[index]), 0.05)
        return float(2 * passes.half_of_last_digit[move] / np.sin(half) + needed * slack / np.tan(half) + 1e-3)

    def _is_mistyped(self, index: int, near: float) -> bool:
        """The R that would be tangent is the one that is written but for a slip that no other design explains."""
        candidates = self._candidates
        row = self.passes.row[candidates.move[index]]
        scale = float(self.trace.lengths.scale[row])
        had, needed = (abs(float(of[index])) / scale for of in (self._written[candidates.move], candidates.radius))
        slip = slip_of(plain_number(had), needed, near / scale)
        return slip is not None and slip.plain

    @cached_property
    def _written(self) -> Floats:
        """Per move R of an arc as it is written, or the distance to its center, negative above 180 deg [mm]."""
        passes = self.passes
        size = np.abs(passes.start - passes.center)
        return np.where(self.arcs.sweep[passes.row] > 180 + 1e-3, -size, size)

    @cached_property
    def _intended(self) -> IntendedArcs:
        """All arcs where another one is intended: on the circle of other arcs, else tangent to its neighbours."""
        candidates, chosen = self._candidates, self._misfits
        tolerance = np.array([self._tolerance_of(index) for index in chosen.tolist()])
        tangent = IntendedArcs(candidates.move[chosen], candidates.radius[chosen], candidates.center[chosen], tolerance)
        parts = [self.same_circle.mistaken_together, self.same_circle.leaves_circle, tangent, self._leads]
        parts = [part for part in parts if len(part.move)] or [tangent]
        if len(parts) == 1:
            return parts[0]
        move, first = np.unique(np.concatenate([part.move for part in parts]), return_index=True)
        columns = (np.concatenate([part[column] for part in parts])[first] for column in range(1, 4))
        return IntendedArcs(move, *columns)

    @cached_property
    def misfits(self) -> Mask:
        """Arcs that turn a corner where another R, or center, would be tangent, as the rest of the contour shows."""
        return self._column(self._intended.move)

    def _of_meant(self, values: Floats) -> Floats:
        return column_at(len(self.trace), self.passes.row[self._intended.move], values, np.nan)

    @cached_property
    def radius_needed(self) -> Floats:
        """R of the arc that is meant, negative above 180 deg [mm]; NaN for rows that are no misfits."""
        return self._of_meant(self._intended.radius)

    @cached_property
    def center_needed(self) -> Points:
        """Its center [mm]."""
        return column_at(
            len(self.trace), self.passes.row[self._intended.move], self._intended.center, complex("nan+nanj")
        )

    @cached_property
    def radius_tolerance(self) -> Floats:
        """Uncertainty of that R by rounding [mm]."""
        return self._of_meant(self._intended.tolerance)

    @cached_property
    def on_circle(self) -> Mask:
        """Misfits that are meant on the circle of other arcs."""
        circle = self.same_circle
        return self._column(np.concatenate([circle.mistaken_together.move, circle.leaves_circle.move]))

    @cached_property
    def of_leads(self) -> Mask:
        """Misfits that lead to or from a contour."""
        return self._column(self._leads.move)

    @cached_property
    def corner(self) -> Floats:
        """The larger turn at the ends of an arc that does not fit [deg]."""
        into, out = (np.abs(turn[self._intended.move]) for turn in self.passes.turns)
        return self._of_meant(np.degrees(np.fmax(into, out)))

    @cached_property
    def size(self) -> Rows:
        """
        The same number for misfits of a section that one mistake explains; -1 for other rows.

        One R stands for one other R, or several are mistaken by one factor.
        """
        number = np.full(len(self.trace), -1)
        rows = np.flatnonzero(self.misfits)
        if len(rows):
            written = column_at(len(self.trace), self.passes.row, self._written, 0.0)
            with np.errstate(divide="ignore", invalid="ignore"):  # an R of 0 is a factor of nothing
                ratio = np.abs(written[rows] / self.radius_needed[rows])
                factor = np.array(_FACTORS)[np.argmin(np.abs(np.log(ratio[:, None] / np.array(_FACTORS))), axis=1)]
            of_factor = (np.abs(ratio / factor - 1) < _LIKE) & (self.radius_needed[rows] * written[rows] > 0)
            keys = np.stack(
                (
                    self.trace.mode.section[rows],
                    np.where(of_factor, factor, 0),
                    np.where(of_factor, 0, written[rows].round(2)),
                    np.where(of_factor, 0, self.radius_needed[rows].round(1)),
                )
            )
            number[rows] = np.unique(keys, axis=1, return_inverse=True)[1].reshape(-1)
        return number

    def alike(self, row: int) -> Mask:
        """Misfits that the mistake of this one explains, and that need its R."""
        needed = self.radius_needed
        return np.asarray((self.size == self.size[row]) & (np.abs(needed - needed[row]) <= self.radius_tolerance[row]))


def _shares_circle(center: complex, radius: float, centers: Points, radii: Floats) -> bool:
    """One of the other arcs lies on the same circle, so that the corners between them are cut off from it."""
    return bool(((np.abs(centers - center) <= _SAME) & (np.abs(radii - radius) <= _SAME)).any())
