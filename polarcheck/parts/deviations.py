"""Deviations of the machined parts from the parts of the job: drawings, or shapes with dimensions."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.contour.skipped_loops import SkipReason
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, cached_property, column_at
from polarcheck.parts.area_comparisons import AreaComparisons
from polarcheck.parts.contour_comparisons import ContourComparisons
from polarcheck.parts.nominal_parts import NominalParts
from polarcheck.parts.part_comparison import Comparison, Fit
from polarcheck.program.machines.part_keys import Part


class Deviations(Columns, frozen=True):
    """Columns of one trace, one value per row: the largest deviation of each part; and all comparisons."""

    trace: Trace
    overcuts: Overcuts
    nominal_parts: NominalParts
    contour_comparisons: ContourComparisons
    area_comparisons: AreaComparisons

    @property
    def parts(self) -> tuple[Part, ...]:
        """The parts that the job asks for."""
        return tuple(self.nominal_parts.job.part)

    @property
    def where(self) -> Mask:
        """Rows in offset mode in the sections for which the job states a part."""
        return self.nominal_parts.in_offset_mode

    @cached_property
    def crosses(self) -> Mask:
        """Rows of loops that cross themselves too often for a part to be computed."""
        return self.overcuts.skipped.rows(self.overcuts.loop, SkipReason.CROSSES)

    @cached_property
    def comparisons(self) -> list[Comparison]:
        """
        All comparisons, in program order: of contours, and of the metal where no contour differs.

        Raises TooHardError if the faces of the contours or their areas cannot be computed.
        """
        if not self.nominal_parts.parts:
            return []
        results = sorted(self.area_comparisons.all, key=lambda result: result.section)
        return [result._replace(fit=self._fit(result)) if result.differs else result for result in results]

    def _fit(self, result: Comparison) -> Fit | None:
        """The change that would make the part agree, or nearly agree; None if there is none."""
        if result.target is None:
            from polarcheck.parts.metal_fit import metal_fit  # imported late: most programs agree

            return metal_fit(result, self.nominal_parts, self.area_comparisons.milled)
        return self.contour_comparisons.fit(result)

    @cached_property
    def _worst(self) -> dict[int, Comparison]:
        """The comparison with the largest difference, by row."""
        worst: dict[int, Comparison] = {}
        for result in self.comparisons:
            if result.differs and (
                result.row not in worst or worst[result.row].difference.largest < result.difference.largest
            ):
                worst[result.row] = result
        return worst

    @cached_property
    def differs(self) -> Mask:
        """Rows at which the largest difference of a part lies."""
        return self.trace.blocks.mask_of(list(self._worst))

    @cached_property
    def largest(self) -> Floats:
        """The largest difference [mm] in the rows of `differs`, 0 elsewhere."""
        largest = [result.difference.largest for result in self._worst.values()]
        return column_at(len(self.trace), [*self._worst], largest, 0.0)

    @cached_property
    def tolerance(self) -> Floats:
        """The tolerance [mm] in the rows of `differs`, NaN elsewhere."""
        tolerances = [result.tolerance for result in self._worst.values()]
        return column_at(len(self.trace), [*self._worst], tolerances, np.nan)

    def of_row(self, row: int) -> Comparison:
        """The comparison reported in a row of `differs`."""
        return self._worst[row]

    def missing(self) -> Iterator[tuple[int, str]]:
        """Parts that nothing was compared with, each by number with the reason; none if a loop is in `crosses`."""
        count = len(self.trace.mode.sections)
        if not count or self.crosses.any():
            return
        compared = {comparison.number for comparison in self.comparisons}
        for number, part in enumerate(self.parts):
            if number in compared:
                continue
            if part.section is not None and part.section > count:
                yield number, f"it is for section {part.section}, and the program has {count}"
            else:
                reason = self.area_comparisons.why_not(number)
                if reason:
                    yield number, reason
