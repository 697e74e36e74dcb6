"""Arcs on the polar plane as they are written: by I and J or by R, and whether that makes a circle."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Points,
    Rows,
    cached_property,
    column_at,
    is_among,
    mask_at,
    repeated,
)
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import angle_between
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.reading.translation import spans

#: One arc alone speaks for the other reading of X where it misses its circle by this many tolerances.
_CLEARLY = 10
#: An arc whose center is nearer to the center of C than this is about it [mm].
_ABOUT_CENTER = 0.02
#: A turn that is no corner [rad].
_SMOOTH = 0.02
#: From so many arcs on it is no single word that is wrong.
_SEVERAL = 3


class Arcs(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    # ---- what is written ----

    @cached_property
    def in_force(self) -> Mask:
        """G2 or G3 is in force in the polar mode, so that axis words would be those of an arc."""
        trace = self.trace
        in_plane = trace.mode.in_polar & trace.axes.is_simulated & trace.modal.uses_axes
        return np.asarray(in_plane & is_among(trace.modal.state("motion"), (Motion.CW, Motion.CCW)))

    @cached_property
    def by_radius(self) -> Mask:
        """Arcs with R."""
        arcs = self.trace.path.is_arc & ~self.trace.path.shape_is_unknown
        return np.asarray(arcs & self.trace.blocks.has(self.trace.machine.arcs.radius_word))

    @cached_property
    def by_center(self) -> Mask:
        """Arcs with I or J and without R, which would count before them (B-62754EN/01 p. 67)."""
        arcs = self.trace.path.is_arc & ~self.trace.path.shape_is_unknown
        return np.asarray(arcs & self.trace.axes.has_center & ~self.by_radius)

    @cached_property
    def has_word_of_other_plane(self) -> Mask:
        """Rows with a center word of another plane: a K with X and C; K0 moves nothing."""
        has_word = self.trace.blocks.with_words(self.trace.axes.other_center_words)
        return np.asarray(has_word & (self.trace.axes.other_center_word != 0))

    @cached_property
    def has_word_of_plane(self) -> Mask:
        """Rows with a word of the polar plane: X, C, or I or J without a K beside them."""
        trace = self.trace
        return np.asarray(
            trace.axes.moves_plane | (trace.axes.has_center & ~trace.blocks.with_words(trace.axes.other_center_words))
        )

    @cached_property
    def ends_at_start(self) -> Mask:
        """Rows that do not move on the plane; False where it is not known."""
        return np.asarray(np.abs(self.trace.path.end - self.trace.path.start) <= ROUNDING)

    # ---- whether it is a circle ----

    def _to_center(self, rows: Rows) -> Points:
        """I + jJ of some rows [mm]; what is not written is 0."""
        if not len(rows):
            return np.zeros(0, np.complex128)
        i, j = self.trace.path.to_center
        to_center = np.nan_to_num(i[rows]) + 1j * np.nan_to_num(j[rows])
        if (corners := self.trace.run.corners) is not None:
            # Where a corner is made, an arc begins elsewhere than its words count from.
            path, rounded = self.trace.path, np.isin(rows, corners.round)
            to_center = np.where(rounded, path.center[rows] - path.start[rows], to_center)
        return np.asarray(to_center)

    def _of_arcs(self, rows: Rows, values: Floats) -> Floats:
        """A column of the values of some rows; NaN for others."""
        if not len(rows):
            return repeated(np.float64(np.nan), len(self.trace))
        return column_at(len(self.trace), rows, values, np.nan)

    @cached_property
    def start_radius(self) -> Floats:
        """Distance of the start of an arc to its center by I and J [mm]; NaN for other rows."""
        rows = np.flatnonzero(self.by_center)
        return self._of_arcs(rows, np.abs(self._to_center(rows)))

    @cached_property
    def end_radius(self) -> Floats:
        """Distance of the end of an arc to its center by I and J [mm]; NaN for other rows and where it is not known."""
        rows = np.flatnonzero(self.by_center)
        return self._of_arcs(
            rows, np.abs(self.trace.path.end[rows] - self.trace.path.start[rows] - self._to_center(rows))
        )

    @cached_property
    def chord(self) -> Floats:
        """Distance from start to end of an arc by R [mm]; NaN for other rows and where it is not known."""
        rows = np.flatnonzero(self.by_radius)
        return self._of_arcs(rows, np.abs(self.trace.path.end[rows] - self.trace.path.start[rows]))

    @cached_property
    def radius(self) -> Floats:
        """R of an arc as written, with its sign [mm]; NaN for other rows."""
        rows = np.flatnonzero(self.by_radius)
        return self._of_arcs(rows, self.trace.lengths.length_of(self.trace.machine.arcs.radius_word)[rows])

    @cached_property
    def is_larger_by_word(self) -> Mask:
        """Arcs by R of which a word of the control's own language takes the larger one."""
        word, run = self.trace.machine.arcs.larger_arc_word, self.trace.run
        mask = np.zeros(len(self.trace), bool)
        if word and np.any(self.radius < 0):
            begins, _ = spans(run.text.source, word)
            blocks = np.searchsorted(run.text.blocks.start, begins, side="right") - 1
            mask = (self.radius < 0) & is_among(run.block, blocks.tolist())
        return np.asarray(mask)

    @cached_property
    def is_about_center(self) -> Mask:
        """Arcs about the center of C, as what is left of a round bar has them."""
        return np.asarray(self.trace.path.is_arc & (np.abs(self.trace.path.center) <= _ABOUT_CENTER))

    @cached_property
    def misfit_section(self) -> Rows:
        """
        The section of rows of which three arcs or more, and half of all, do not reach or do not end on their circle;
        else -1. One word, a unit or the reading of an axis is wrong there in all of them.
        """
        section, tolerance = self.trace.mode.section, self.trace.machine.arcs.tolerance
        arcs = self.by_center | self.by_radius
        bad = np.abs(self.start_radius - self.end_radius) > tolerance
        bad |= self.chord > 2 * np.abs(self.radius) + tolerance
        if not bad.any():
            return repeated(np.int64(-1), len(self.trace))
        total, misfits = (np.bincount(section[rows & (section >= 0)], minlength=1) for rows in (arcs, bad))
        misfits = np.append(misfits, np.zeros(len(total) - len(misfits), np.int64))
        is_whole = np.append((misfits >= _SEVERAL) & (2 * misfits >= total), False)
        return np.where(is_whole[np.minimum(section, len(total))], section, -1)

    @cached_property
    def negative_stops(self) -> Mask:
        """Arcs with a negative R where the control stops at it."""
        stops = self.trace.machine.severities.get("negative-arc-radius") == "error"
        return np.asarray((self.radius < 0) & ~self.is_larger_by_word & stops)

    @cached_property
    def is_off_plane(self) -> Mask:
        """
        Arcs along Z: with no word of the plane, or with one axis of it where no arc of the plane fits.

        Where one fits, the axis that stays where it is was left out, and Z makes a helix of it. Z alone where it stands
        is no arc, unless the word of a center or radius stands beside it.
        """
        trace = self.trace
        one_axis = trace.axes.programs_linear_axis ^ trace.axes.has_virtual_word
        to_start = self.by_radius & self.ends_at_start
        fits_none = ~self.has_word_of_plane | (one_axis & (self._misses_circle | to_start))
        has_center = trace.blocks.has("I", "J", "K", trace.machine.arcs.radius_word)
        moves = trace.path.moves_z | (trace.axes.commands_z & (self.has_word_of_plane | has_center))
        return np.asarray(self.in_force & moves & fits_none)

    @cached_property
    def is_no_circle(self) -> Mask:
        """Arcs about which a finding says that there is no such circle; what follows from their shape means nothing."""
        return np.asarray(self._misses_circle | self.is_off_plane)

    @cached_property
    def _misses_circle(self) -> Mask:
        """Arcs whose center or radius is missing, of another plane, or does not fit their ends."""
        trace, tolerance = self.trace, self.trace.machine.arcs.tolerance
        no_center = ~self.by_radius & ~self.by_center & ~self.ends_at_start & ~trace.path.shape_is_unknown
        return np.asarray(
            (trace.path.is_arc & (no_center | self.has_word_of_other_plane))
            | (self.start_radius <= ROUNDING)
            | (self.end_radius <= ROUNDING)
            | (np.abs(self.start_radius - self.end_radius) > tolerance)
            | (self.chord > 2 * np.abs(self.radius) + tolerance)
        )

    @cached_property
    def sweep(self) -> Floats:
        """Angle of each arc about its own center [deg], 360 for a full circle; NaN for other rows and unknown arcs."""
        trace, rows = self.trace, np.flatnonzero(self.trace.path.is_arc)
        return self._of_arcs(rows, np.abs(np.degrees(trace.path.moves_of(rows).sweep)))

    # ---- diameter or radius ----

    @cached_property
    def x_is_misread(self) -> Mask:
        """
        The rows of sections in which no arc fits as this profile reads X, and all fit with X as the other of diameter
        and radius.
        """
        return self._is_misread(self._step_otherwise, moves_c=False)

    @cached_property
    def c_is_misread(self) -> Mask:
        """The rows of sections in which no arc fits as this profile reads C, and all fit with C half as large."""
        path = self.trace.path
        return self._is_misread(lambda rows: with_half_of_c(path.end[rows] - path.start[rows]), moves_c=True)

    def _is_misread(self, step_otherwise: Callable[[Rows], Points], *, moves_c: bool) -> Mask:
        """
        The rows of sections in which no arc fits, and all fit with other steps.

        Arcs by I and J speak, if the misread axis moves along them: I is a radius in either reading. One of them must
        move both axes, since a quarter of a circle without its C fits by chance. Arcs by R fit often, so that they
        speak only where there are several, and none of them does; of C where each would have a smooth end, since angles
        on a shape are far apart, too. moves_c: it is C that is misread, not X.
        """
        trace = self.trace
        arc = np.flatnonzero(trace.path.is_arc & ~self.is_off_plane & ~trace.axes.makes_corner)
        if not len(arc):
            return np.zeros(len(trace), bool)
        tolerance = trace.machine.arcs.tolerance
        to_center, step = self._to_center(arc), trace.path.end[arc] - trace.path.start[arc]
        other_step = step_otherwise(arc)
        moves = (np.abs(step.real) > tolerance, np.abs(step.imag) > tolerance)
        moves_it, moves_other = moves[::-1] if moves_c else moves
        center, radius = (self.start_radius > ROUNDING)[arc], self.by_radius[arc]
        miss = np.abs(np.abs(to_center) - np.abs(step - to_center))
        miss_otherwise = np.abs(np.abs(to_center) - np.abs(other_step - to_center))
        limit = 2 * np.abs(self.radius[arc]) + tolerance

        def count(of: Mask) -> Rows:
            return np.bincount(trace.mode.section[arc[of]], minlength=len(trace.mode.sections))

        fails, clearly = center & (miss > tolerance), center & (miss > _CLEARLY * tolerance)
        by_center = ((count(fails) > 1) | (count(clearly) > 0)) & (count(fails & moves_other) > 0)
        by_radius = (count(np.abs(step) > limit) > 1) & (count(radius & moves_it & (np.abs(step) <= limit)) == 0)
        closes = center & moves_it & (miss <= tolerance)
        objects = (center & ~(miss_otherwise <= tolerance)) | (np.abs(other_step) > limit)
        if moves_c and (by_radius & ~by_center).any():
            objects |= radius & ~self._have_smooth_end(arc, step_otherwise)
        misread = (by_center | by_radius) & (count(closes | objects) == 0)
        return np.asarray((trace.mode.section >= 0) & misread[trace.mode.section])

    def _have_smooth_end(self, arcs: Rows, step_of: Callable[[Rows], Points]) -> Mask:
        """Arcs by R that go on smoothly from the move before them, or into the one behind, were their steps others."""
        trace = self.trace
        row = np.flatnonzero(trace.path.travels)
        step, kind, radius = step_of(row), trace.axes.motion[row], np.where(self.by_radius, self.radius, np.inf)[row]
        sense = np.where(kind == Motion.CCW, 1.0, -1.0)
        half = sense * np.arcsin(np.minimum(np.abs(step) / np.maximum(np.abs(2 * radius), ROUNDING), 1.0))
        half = np.where(radius < 0, sense * np.pi - half, half)
        leaving, arriving = step * np.exp(-1j * half), step * np.exp(1j * half)
        turn = np.abs(angle_between(arriving[:-1], leaving[1:]))
        is_smooth = (turn <= _SMOOTH) & (np.diff(trace.mode.section[row]) == 0)
        return mask_at(len(trace), row[np.append(is_smooth, False) | np.append(False, is_smooth)])[arcs]

    def _step_otherwise(self, rows: Rows) -> Points:
        """From start to end of some rows [mm], were X the other of diameter and radius; X before G12.1 stays."""
        trace = self.trace
        factor, start, end = (
            np.where(trace.lengths.x_factor[rows] < 1, 2.0, 0.5),
            trace.path.start[rows],
            trace.path.end[rows],
        )
        has_x = trace.blocks.has("X") & ~trace.modal.is_step("X") & (trace.axes.linear_axis == ord("X"))
        had_x = np.append(False, trace.mode.given_in_section(has_x))[:-1]
        x = end.real * factor - start.real * np.where((has_x & ~had_x)[rows], 1.0, factor)
        return np.asarray(x + 1j * (end - start).imag)


def with_half_of_c(points: Points) -> Points:
    """Points or steps whose C is half as large."""
    return np.asarray(points.real + 0.5j * points.imag)
