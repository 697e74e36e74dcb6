"""The closed shapes that a job asks for, each beside the metal that mills leave of it."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.milled import Milled
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, cached_property
from polarcheck.parts.contour_comparisons import ContourComparisons
from polarcheck.parts.nominal_features import NominalFeatures, PlacedFeature
from polarcheck.parts.nominal_parts import NominalParts
from polarcheck.parts.part_comparison import SAME_Z, Comparison

if TYPE_CHECKING:
    from polarcheck.geometry.comparison.deviation import Difference
    from polarcheck.geometry.shapes.shape import Shape
    from polarcheck.parts.metal_differences import AreaDifference, Feature


class AreaComparisons(Columns, frozen=True):
    """
    The comparisons of one run, of contours and of areas.

    A contour that differs says what is wrong: the areas of its curve are not looked at.
    """

    trace: Trace
    milled: Milled
    bar: Bar
    nominal_parts: NominalParts
    nominal_features: NominalFeatures
    contour_comparisons: ContourComparisons

    @cached_property
    def all(self) -> list[Comparison]:
        """
        All comparisons: that of the nearest contour of each curve with the difference of its areas.

        Raises TooHardError where the areas cannot be computed.
        """
        results = list(self.contour_comparisons.all)
        placed = self.nominal_features.all
        if not placed:
            return results
        compared = list(self._differences(placed))
        for feature, _, difference in compared:
            results = [self._as_left(result, feature, difference) for result in results]
        contours = tuple(results)
        for feature, contour, difference in compared:
            comparison = self._comparison(feature, contour, difference, contours)
            if comparison is not None and contour < 0:
                results.append(comparison)
            elif comparison is not None:
                results[contour] = comparison
        return results

    def _differences(self, placed: Sequence[PlacedFeature]) -> Iterator[tuple[Feature, int, AreaDifference]]:
        """The features, the indices of their contours, -1 for none, and the difference of the metal from each."""
        from polarcheck.parts.metal_differences import differences

        for frame in sorted({shape.frame for shape in placed}):
            of_frame = self.milled.cuts.frame == frame
            features = [shape for shape in placed if shape.frame == frame]
            chosen = [
                shape.feature._replace(cuts=shape.feature.cuts[of_frame], own_cuts=shape.feature.own_cuts[of_frame])
                for shape in features
            ]
            for shape, difference in zip(features, differences(chosen, self.milled.cuts[of_frame]), strict=True):
                yield shape.feature, shape.contour, difference

    @staticmethod
    def _as_left(result: Comparison, feature: Feature, metal: AreaDifference) -> Comparison:
        """
        The comparison of a contour, without what the cutter does not cut away: a corner that is sharp in the program
        and round in the drawing is as it should be where R of the cutter rounds it.
        """
        is_own = result.number == feature.number and (feature.curve < 0 or result.curve in (-1, feature.curve))
        is_closed = result.contour is not None and result.contour.is_closed and not result.is_other_way_round
        is_deep = result.difference.deep > result.tolerance
        if not (is_own and is_closed and is_deep and metal.is_made and metal.deep.size == 0):
            return result
        return result._replace(difference=result.difference._replace(deep=0.0))

    def why_not(self, number: int) -> str:
        """Why a part was compared with nothing; empty where another reason is given."""
        part = self.nominal_parts.parts[number]
        is_known = ~np.isnan(self.trace.compensation.radius[self.nominal_parts.in_offset_mode])
        if not is_known.all():
            return ""
        unknown = np.flatnonzero(self.milled.is_unknown)
        if len(unknown):
            return f"R or a place of the cutter of line {int(self.trace.blocks.line[unknown[0]])} is not known"
        if not self.nominal_features.cuts_of(part).any():
            return "nothing is milled there"
        if self.nominal_parts.gap(number, int(self.trace.mode.sections.enter[0])) is not None:
            return "its curves do not meet, and no contour comes near to them"
        return "its curves do not close, and no contour comes near to them"

    def _comparison(
        self, feature: Feature, index: int, metal: AreaDifference, results: Sequence[Comparison]
    ) -> Comparison | None:
        """The changed comparison of the contour, or a comparison of areas in its place; None for no change."""
        from polarcheck.geometry.comparison.deviation import Difference

        peers = [result for result in results if result.number == feature.number]
        if any(
            result.differs and (index < 0 or result.curve in (-1, feature.curve) or feature.curve < 0)
            for result in peers
        ):
            return None
        if feature.may_be_absent and not metal.is_made:
            return None
        base = results[index] if index >= 0 else None
        if metal.is_none and base is not None:
            is_partial = base.is_partial and not feature.excess_is_judged
            difference = self._with_rounds(base.difference, feature)
            return base._replace(is_partial=is_partial, island=metal.island.size > 0, difference=difference)
        if metal.is_none and not feature.excess_is_judged:
            return None
        proud, deep, is_made = (
            metal.proud.size,
            metal.deep.size,
            metal.is_made or base is not None or (feature.rounds is not None and feature.rounds.is_broken),
        )
        if metal.is_none:
            proud = min(metal.off, feature.tolerance) if is_made else metal.off
        difference = Difference(
            proud=proud,
            proud_at=metal.proud.place,
            deep=deep,
            deep_at=metal.deep.place,
            mean=0.0,
            length=1.0,
        )
        difference = self._with_rounds(difference, feature)
        row = metal.proud_row if proud >= deep else metal.deep_row
        if row < 0:
            row = int(
                self.milled.cuts.curves.row[self.nominal_features.cuts_of(self.nominal_parts.parts[feature.number])][0]
            )
        if base is not None:
            return base._replace(
                difference=difference, row=row, is_partial=False, contour=None, entry=self.nominal_parts.entry(row)
            )
        section = int(self.trace.mode.section[row])
        return Comparison(
            number=feature.number,
            part=self.nominal_parts.parts[feature.number],
            curve=feature.curve,
            section=section,
            z=feature.z,
            tolerance=feature.tolerance,
            difference=difference,
            row=row,
            entry=self.nominal_parts.entry(row),
            angle_not_compared=self.nominal_parts.angle_not_compared(feature.number, section),
            island=metal.is_none and metal.island.size > 0,
            is_made=is_made or not metal.is_none,
            made=() if metal.is_none and is_made else self._made(feature),
        )

    def _with_rounds(self, difference: Difference, feature: Feature) -> Difference:
        """A difference with what all cuts leave of the round of the drawing, and whether it lies beyond the bar."""
        import shapely  # type: ignore[import-untyped]

        rounds = feature.rounds
        if rounds is None:
            return difference
        bar, drawn = self.bar.known.largest / 2, shapely.boundary(feature.area)
        farthest = np.hypot(*shapely.get_coordinates(drawn).T).max(initial=0)
        is_beyond = shapely.distance(drawn, shapely.Point(0, 0)) > bar - feature.tolerance
        is_beyond &= bool(farthest > bar + feature.tolerance)
        return difference._replace(turned=rounds.turned_radius, is_broken=rounds.is_broken, is_beyond=is_beyond)

    def _made(self, feature: Feature) -> tuple[Shape, ...]:
        """The shapes that stand, or are cleared, in the place of a feature."""
        from polarcheck.geometry.shapes.grooves import shapes_of_cleared

        cuts = self.milled.cuts
        chosen = (cuts.low <= feature.z + SAME_Z) & self.nominal_features.cuts_of(
            self.nominal_parts.parts[feature.number]
        )
        if not chosen.any():
            return ()
        cleared, radius = self.milled.cleared(chosen)
        shapes = shapes_of_cleared(cleared.outline, cleared.across, radius, self.bar.known.smallest)
        alike = [shape for shape in shapes if shape.inside == feature.is_pocket]
        # What lies farther off than the part is large was not meant for it, where something nearer is made.
        middle, size = complex(feature.area.centroid.x, feature.area.centroid.y), math.sqrt(feature.area.area / math.pi)
        if alike and abs(alike[0].middle - middle) > size:
            alike.sort(key=lambda shape: abs(shape.middle - middle))
        return tuple(alike[:1])
