"""Contours that are nearly regular or symmetric, and what makes them so: a word, a block, the reading of X."""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.columns.contour.plane_loops import PlaneLoop, loops_of, smooth_share
from polarcheck.columns.path.arcs import with_half_of_c
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Points, Rows, cached_property
from polarcheck.foundation.states import Motion, Side
from polarcheck.foundation.time_limit import keep_time
from polarcheck.geometry.regularity.symmetry import Symmetry
from polarcheck.geometry.tolerances import ROUNDING

if TYPE_CHECKING:
    from polarcheck.columns.contour.correction import Correction
    from polarcheck.columns.contour.correction_search import Corrections


#: A regular contour has a higher order of symmetry than a rectangle, and at least this many corners.
_PLAIN_ORDER, _FEWEST_CORNERS = 2, 5
#: Share of the ends of arcs that may be tangent by chance.
_SMOOTH_BY_CHANCE = 0.25
#: Places at which a tool goes down, and lines that a curve is written as.
_FEWEST_PLACES, _FEWEST_OF_CURVE = 3, 12
#: Sections that may be one contour at several angles of C; nothing may be cut at one of them.
_FEWEST_SECTIONS, _MOST_SECTIONS = 2, 36


class XReading(msgspec.Struct, frozen=True):
    """
    A section that is regular with another reading of X, or of C.

    factor: by which X is to be multiplied, or C where of_c says so. becomes: the symmetry that it then has; None where
    its arcs are tangent.
    """

    factor: float
    becomes: Symmetry | None
    of_c: bool = False


class Regularity(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    @cached_property
    def _loops(self) -> list[tuple[PlaneLoop, Symmetry | None]]:
        """The loops that may be regular, with their symmetry as they are written."""
        return [(loop, loop.symmetry()) for loop in loops_of(self.trace)]

    # ---- X of all words ----

    @cached_property
    def x_readings(self) -> dict[int, XReading]:
        """By section how its contours are regular with X as the other of diameter and radius, and not as it is read."""
        by_section: dict[int, XReading] = {}
        objects: set[int] = set()
        for loop, written in self._loops:
            section = int(self.trace.mode.section[loop.row[-1]])
            reading = self._other_reading(loop, written)
            if reading is not None:
                by_section.setdefault(section, reading)
            elif written is not None and (written.order > _PLAIN_ORDER or smooth_share(loop, loop.point) == 1):
                objects.add(section)
        return {section: reading for section, reading in by_section.items() if section not in objects}

    def _other_reading(self, loop: PlaneLoop, written: Symmetry | None) -> XReading | None:
        """How a loop is regular with all of X twice or half as large."""
        if written is not None and written.order > _PLAIN_ORDER:
            return None
        turn = self.trace.path.frames.turn[loop.row[-1]] if self.trace.path.frames is not None else 1
        if turn != 1:
            return None
        for factor in (2.0, 0.5):
            point = np.asarray(loop.point.real * factor + 1j * loop.point.imag)
            symmetry = loop.symmetry(point)
            if symmetry is None:
                continue
            if symmetry.order > _PLAIN_ORDER and symmetry.corners >= _FEWEST_CORNERS:
                return XReading(factor, symmetry)
            if self._smooths(loop, point):
                return XReading(factor, None)
        return XReading(0.5, None, of_c=True) if self._smooths(loop, with_half_of_c(loop.point)) else None

    def _smooths(self, loop: PlaneLoop, point: Points) -> bool:
        """All arcs of a loop are tangent with other ends, and few are as it is written."""
        return smooth_share(loop, point) == 1 and smooth_share(loop, loop.point) <= _SMOOTH_BY_CHANCE

    @cached_property
    def x_is_misread(self) -> Mask:
        """The rows of sections that are regular with X as the other of diameter and radius."""
        section = self.trace.mode.section
        return np.isin(section, [*self.x_readings]) if self.x_readings else np.zeros(len(section), bool)

    # ---- one word or block ----

    @cached_property
    def known(self) -> dict[Hashable, Corrections]:
        """Corrections by how a contour is written; an edited program begins with those of the program before."""
        return {}

    @cached_property
    def _corrected(self) -> list[tuple[PlaneLoop, Corrections]]:
        """The loops with what may be meant instead of them."""
        loops = [(loop, written) for loop, written in self._loops if written is None or not written.is_turned]
        if not loops:
            return []
        from polarcheck.columns.contour.correction_search import corrections_of

        corrected = []
        for loop, written in loops:
            keep_time()
            corrected.append((loop, corrections_of(self.trace, loop, written, self.known)))
        return corrected

    @property
    def _misplaced(self) -> Iterable[Correction]:
        """What makes the places and depths regular where a tool goes down without compensation."""
        trace, path = self.trace, self.trace.path
        goes_down = path.moves_z & ~path.travels & (path.z < path.z_before - ROUNDING) & trace.mode.in_polar
        rows = np.flatnonzero(goes_down & (trace.compensation.side == Side.OFF) & ~np.isnan(path.end))
        if len(rows) < _FEWEST_PLACES:
            return ()
        from polarcheck.columns.contour.place_patterns import idle, misplaced  # most sections go down once

        return (*misplaced(trace, rows), *idle(trace, rows))

    @property
    def _off_curve(self) -> Iterable[Correction]:
        """What leads back to the curve of the points beside it."""
        path, motion = self.trace.path, self.trace.axes.motion
        if np.count_nonzero((motion == Motion.LINE) & path.travels & path.on_plane) < _FEWEST_OF_CURVE:
            return ()
        from polarcheck.columns.contour.curve_points import off_the_curve  # most contours have a few blocks

        return off_the_curve(self.trace)

    @property
    def _off_division(self) -> Iterable[Correction]:
        """What makes the angles of C even at which sections cut the same."""
        if not _FEWEST_SECTIONS <= len(self.trace.mode.sections) <= _MOST_SECTIONS:
            return ()
        from polarcheck.columns.contour.index_patterns import off_the_division  # most programs have a section or two

        return off_the_division(self.trace)

    @cached_property
    def corrections(self) -> dict[int, Correction]:
        """By row what makes a contour symmetric."""
        by_row = {
            correction.row: correction for correction in (*self._off_curve, *self._misplaced, *self._off_division)
        }
        for _, found in self._corrected:
            for correction in found.symmetric:
                by_row.setdefault(correction.row, correction)
        return by_row

    @cached_property
    def likely(self) -> list[tuple[Rows, Correction]]:
        """The rows of a contour and what makes it more regular, so that it is told where no rule objects to them."""
        return [(loop.row, found.likely) for loop, found in self._corrected if found.likely is not None]

    @cached_property
    def explained(self) -> dict[int, Correction]:
        """By row what explains findings of other rules: checking/explanations.py adds what it finds."""
        return {}

    @cached_property
    def is_wrong(self) -> Mask:
        """Rows with a word that makes a contour irregular, or before which a block is missing."""
        return self.trace.blocks.mask_of(sorted(self.corrections))

    @cached_property
    def wrong_words(self) -> Mask:
        """Per executed word: it makes a contour irregular."""
        words = [correction.word for correction in self.corrections.values() if correction.word >= 0]
        return self.trace.blocks.words_at(np.array(sorted(words), np.int64))
