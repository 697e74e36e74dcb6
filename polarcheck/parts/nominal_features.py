"""The shapes of a job as areas, each where its program makes it: what stands, its depth, and which cuts count."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.milled import Milled
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Points, cached_property, is_among
from polarcheck.parts.contour_comparisons import ContourComparisons
from polarcheck.parts.nominal_parts import BEYOND, NominalParts, is_closed
from polarcheck.parts.part_comparison import SAME_Z
from polarcheck.program.machines.part_keys import Part

if TYPE_CHECKING:
    from polarcheck.parts.metal_differences import Feature

#: How far from the axis flats and slots without an end reach, as a multiple of all that is cut.
_ENDLESS = 4.0
#: Another placement of a shape is taken if it is nearer by this [mm], or turned by this [deg].
_BETTER = 1e-3
#: Depths of sections that are tried.
_DEPTHS = 8


class PlacedFeature(NamedTuple):
    """
    A shape as an area.

    frame: of the cuts that it is compared with (milled.py). contour: the comparison of its contour, by its place
    among all; -1 for none.
    """

    frame: int
    feature: Feature
    contour: int


class NominalFeatures(Columns, frozen=True):
    """The shapes of the job of one run."""

    trace: Trace
    milled: Milled
    bar: Bar
    overcuts: Overcuts
    nominal_parts: NominalParts
    contour_comparisons: ContourComparisons

    @cached_property
    def all(self) -> list[PlacedFeature]:
        """The features of all parts of which something is milled."""
        return [feature for number in range(len(self.nominal_parts.parts)) for feature in self._features(number)]

    def cuts_of(self, part: Part) -> Mask:
        """The cuts in the sections of a part."""
        section = self.milled.cuts.section
        return np.ones(len(section), bool) if part.section is None else section == part.section - 1

    def _matched(self, number: int) -> dict[int, int]:
        """The index of the nearest contour among the comparisons, by curve of a part."""
        results, best = self.contour_comparisons.all, dict[int, int]()
        for index, result in enumerate(results):
            if result.number == number and (result.curve not in best or result.rank < results[best[result.curve]].rank):
                best[result.curve] = index
        return best

    def _features(self, number: int) -> list[PlacedFeature]:
        """The closed curves of a part: the frame of each, and the comparison of its contour, -1 for none."""
        part, matched = self.nominal_parts.parts[number], self._matched(number)
        chosen = self.cuts_of(part)
        if not chosen.any():
            return []
        results = self.contour_comparisons.all
        nearest = min(matched.values(), key=lambda index: results[index].rank, default=-1)
        section = results[nearest].section if nearest >= 0 else int(self.milled.cuts.section[chosen][0])
        frame = int(self.milled.frame_of_section[section])
        chosen = chosen & (self.milled.cuts.frame == frame)
        if part.drawing is not None:
            angle = results[nearest].turned if nearest >= 0 else math.nan
            features = self._of_drawing(number, matched, 0.0 if math.isnan(angle) else angle, section, chosen)
        else:
            features = [(self._of_shape(number, nearest, section, chosen), nearest)]
        return [PlacedFeature(frame, feature, contour) for feature, contour in features]

    def _of_shape(self, number: int, index: int, section: int, chosen: Mask) -> Feature:
        part = self.nominal_parts.parts[number]
        row = int(self.trace.mode.sections.enter[section])
        unit = self.nominal_parts.unit(number, row)
        results, curves = self.contour_comparisons.all, self.nominal_parts.curves(number, unit)
        angle = results[index].turned if index >= 0 else math.nan
        feature = self._feature(number, -1, index, section, chosen)._replace(
            area=self._area(part, curves, unit, 0.0 if math.isnan(angle) else angle),
            is_pocket=part.is_pocket,
            certain=self._certain(number, curves, unit),
            most=self._most(number, curves, unit),
        )
        if index < 0:
            return self._best_placed(feature, curves, unit, section)
        return feature

    def _of_drawing(
        self, number: int, matched: dict[int, int], angle: float, section: int, chosen: Mask
    ) -> list[tuple[Feature, int]]:
        """The closed curves of a drawing, each with the comparison of its contour."""
        from polarcheck.geometry.comparison.metal_left import is_circle, is_inside, polygon_of
        from polarcheck.parts.milled_rings import MilledRings

        row = int(self.trace.mode.sections.enter[section])
        if self.nominal_parts.gap(number, row) is not None:
            return []  # where its corners are is not drawn
        curves = self.nominal_parts.curves(number, self.nominal_parts.unit(number, row))
        curves = [curve * np.exp(1j * angle) for curve in curves]
        rings = {ring: polygon_of(curve) for ring, curve in enumerate(curves) if is_closed(curve)}
        if not rings:
            return self._of_open_curves(number, curves, matched.get(-1, -1), section, chosen)
        depth = {
            ring: sum(is_inside(area, outer) for outer in rings.values() if outer is not area)
            for ring, area in rings.items()
        }
        reach = max(float(np.abs(curves[ring]).max()) for ring in rings)
        tolerance = self.nominal_parts.tolerance(number, row)
        milled = MilledRings({ring: curves[ring] for ring in rings}, self.milled.cuts[chosen], tolerance)
        bar = self._bar_radius
        certain = min(BEYOND * reach if math.isnan(bar) else bar, milled.rounds.radius)
        beyond, features = None if math.isnan(bar) else milled.sectors(bar), []
        for ring, area in rings.items():
            index = matched.get(ring, -1)
            # Holes are drilled, and the outermost ring may be that of the bar.
            is_of_bar = depth[ring] == 0 and not reach < bar - float(self.milled.cuts.radius[chosen].max())
            may_be_absent = index < 0 and bool(matched) and (is_circle(area) or is_of_bar)
            may_be_absent = may_be_absent and not milled.is_cut(ring)
            if index < 0:
                index = matched.get(-1, -1)
            feature = self._feature(number, ring, index, section, chosen)
            feature = feature._replace(
                area=area,
                certain=certain,
                may_be_absent=may_be_absent,
                beyond=beyond,
                rounds=milled.rounds,
            )
            features.append((feature if index >= 0 else self._nearest([feature]), index))
        features = self._with_roles(features, depth)
        if not matched and len(features) == 1:
            return [(self._as_boss_or_pocket(features[0][0]), -1)]
        return features

    def _of_open_curves(
        self, number: int, curves: list[Points], index: int, section: int, chosen: Mask
    ) -> list[tuple[Feature, int]]:
        """Curves that end in the air: on one side of each there is the part, on the other what is milled."""
        from polarcheck.geometry.comparison.metal_left import sides_of

        far = _ENDLESS * max(self._reach, *(float(np.abs(curve).max()) for curve in curves))
        nearest = max(float(np.abs(curve).min()) for curve in curves)
        bar = self._bar_radius
        certain = BEYOND * nearest if math.isnan(bar) else bar
        feature = self._feature(number, -1, index, section, chosen)._replace(
            area=sides_of(curves, far), certain=certain, most=min(self._most_of_bar, certain)
        )
        return [(self._as_boss_or_pocket(feature), index)]

    def _as_boss_or_pocket(self, feature: Feature) -> Feature:
        """A ring that no contour is compared with: a part or a pocket, whichever differs less."""
        from polarcheck.parts.metal_differences import differences

        cuts = self.milled.cuts[feature.cuts]
        tried = []
        for is_pocket in (False, True):
            chosen = np.ones(len(cuts), bool)
            (difference,) = differences([feature._replace(is_pocket=is_pocket, cuts=chosen, own_cuts=chosen)], cuts)
            tried.append((difference.proud.area + difference.deep.area, is_pocket))
        return feature._replace(is_pocket=min(tried)[1])

    def _with_roles(self, rings: list[tuple[Feature, int]], depth: dict[int, int]) -> list[tuple[Feature, int]]:
        """
        The rings as parts or pockets: as they are milled, but by turns where one of two would not be there.

        depth: by the number of a ring, how many others enclose it.
        """
        from polarcheck.geometry.comparison.metal_left import is_inside

        result: list[tuple[Feature, int]] = []
        for feature, index in sorted(rings, key=lambda ring: depth[ring[0].curve]):
            contour = self.contour_comparisons.all[index].contour if index >= 0 else None
            around = [outer for outer, _ in result if is_inside(feature.area, outer.area)]
            is_pocket = contour.is_pocket if contour is not None else bool(around) and not around[-1].is_pocket
            if around and is_pocket == around[-1].is_pocket:
                # A part stands on a part, and a pocket lies in a pocket.
                lower = around[-1].z - feature.z
                is_pocket ^= lower >= -SAME_Z if not is_pocket else lower <= SAME_Z
            result.append((feature._replace(is_pocket=is_pocket), index))
        return result

    def _feature(self, number: int, curve: int, index: int, section: int, chosen: Mask) -> Feature:
        """The feature without its area."""
        from polarcheck.parts.metal_differences import Feature

        contour = self.contour_comparisons.all[index].contour if index >= 0 else None
        radius = contour.level.radius if contour is not None else 0.0
        row = int(self.trace.mode.sections.enter[section])
        return Feature(
            number=number,
            curve=curve,
            area=None,
            is_pocket=False,
            may_be_absent=False,
            z=self._depth(number, index, row, chosen),
            radius=float(radius or self.milled.cuts.radius[chosen].max()),
            tolerance=self.nominal_parts.tolerance(number, row),
            certain=math.nan,
            most=self._most_of_bar,
            excess_is_judged=self._is_all_known(section),
            is_bar_known=self.bar.known.source != "none",
            is_solid=not self.milled.is_drilled and self.bar.known.bore == 0,
            cuts=chosen,
            own_cuts=chosen & ~self._of_other_contours(number),
        )

    def _depth(self, number: int, index: int, row: int, chosen: Mask) -> float:
        stated = self.nominal_parts.z(number, row)
        if not math.isnan(stated):
            low = self.milled.cuts.low[chosen]
            nearest = float(low[np.argmin(np.abs(low - stated))])
            return nearest if abs(nearest - stated) <= self.nominal_parts.z_tolerance(number, row) else stated
        of_contour = self.contour_comparisons.all[index].z if index >= 0 else math.nan
        return float(self.milled.cuts.low[chosen].min()) if math.isnan(of_contour) else of_contour

    def _is_all_known(self, section: int) -> bool:
        """All that is cut on the face is known, and how its sections are turned to each other."""
        return not self.milled.is_unknown.any() and bool(self.milled.is_alone_on_face[section])

    def _of_other_contours(self, number: int) -> Mask:
        """Cuts along contours of other parts, and round parts: those may lie beside a pocket."""
        loops = [
            np.unique(self.overcuts.loop[contour.made.outline.row])
            for contour in self.contour_comparisons.contours
            if contour.is_closed and not contour.is_pocket
        ]
        loops += [
            np.unique(self.overcuts.loop[result.contour.made.outline.row])
            for result in self.contour_comparisons.all
            if result.number != number and result.contour is not None
        ]
        if not loops:
            return np.zeros(len(self.milled.cuts), bool)
        return is_among(self.overcuts.loop[self.milled.cuts.curves.row], np.concatenate(loops).tolist())

    # ---- areas ----

    def _area(self, part: Part, curves: list[Points], unit: float, turned: float) -> Any:
        """The area of a shape, turned about its center [rad]; open shapes reach far beyond all cuts."""
        from polarcheck.geometry.comparison.metal_left import disc, polygon_of, within_lines

        center = complex(*part.center) * unit
        curves = [center + (curve - center) * np.exp(1j * turned) for curve in curves]
        if len(curves) == 1 and is_closed(curves[0]):
            return polygon_of(curves[0])
        far = disc(_ENDLESS * self._reach)
        if part.shape == "slot":
            return within_lines(far, [curves[0], curves[1][::-1]])
        return within_lines(far, curves)

    @property
    def _reach(self) -> float:
        curves = self.milled.cuts.curves
        return float(np.abs(np.concatenate([curves.start, curves.end])).max() + self.milled.cuts.radius.max())

    @property
    def _bar_radius(self) -> float:
        """Up to here there is metal for certain; NaN where the bar is not known."""
        return self.bar.known.smallest / 2

    def _certain(self, number: int, curves: list[Points], unit: float) -> float:
        """The radius up to which there is certainly metal before milling [mm]."""
        part = self.nominal_parts.parts[number]
        bar, round_ = self._bar_radius, part.diameter / 2 * unit
        if part.shape in ("flat", "flats") and not math.isnan(round_):
            return float(np.fmin(bar, round_))
        if not math.isnan(bar):
            return bar
        if len(curves) == 1 and is_closed(curves[0]):
            return BEYOND * float(np.abs(curves[0]).max())
        return self.nominal_parts.certain_metal(number, unit)

    @property
    def _most_of_bar(self) -> float:
        """Beyond this distance from the axis there is no metal; inf where the bar is not known."""
        return float(np.fmin(self.bar.known.largest / 2, math.inf))

    def _most(self, number: int, curves: list[Points], unit: float) -> float:
        """The same; where flats and slots end is known where the bar is."""
        part = self.nominal_parts.parts[number]
        if len(curves) == 1 and is_closed(curves[0]) and part.shape not in ("flat", "flats"):
            return self._most_of_bar
        return float(np.fmin(self._most_of_bar, self._certain(number, curves, unit)))

    def _best_placed(self, feature: Feature, curves: list[Points], unit: float, section: int) -> Feature:
        """
        The feature where its wall is nearest to that of what is cleared: at the depth of some section, and, where its
        angle is not compared, at an angle at which one of its walls runs as some straight cut does.
        """
        from polarcheck.parts.metal_differences import directions_of

        part = self.nominal_parts.parts[feature.number]
        cuts = self.milled.cuts[feature.cuts]
        period = 360.0 / (part.count_of_sides or 2)
        tried = [0.0]
        if self.nominal_parts.angle_not_compared(feature.number, section):
            for angle in directions_of(cuts, cuts.low <= cuts.low.max()):
                for quarter in (0.0, 90.0, 180.0, 270.0):
                    turn = (angle + quarter) % period
                    if all(abs(turn - earlier) > _BETTER for earlier in tried):
                        tried.append(turn)
        turns = sorted(tried, key=lambda turn: min(turn, period - turn))
        places = [feature._replace(area=self._area(part, curves, unit, math.radians(turn))) for turn in turns]
        return self._nearest(places)

    def _nearest(self, places: list[Feature]) -> Feature:
        """
        Of the places of a feature, each at the depth of some section, that which is nearest to what is cleared there.
        """
        from polarcheck.parts.metal_differences import distance_of_wall

        feature, cuts = places[0], self.milled.cuts[places[0].cuts]
        depths = [feature.z]
        if math.isnan(self.nominal_parts.parts[feature.number].z):
            depths = sorted(
                {round(float(cuts.low[cuts.section == section].min()), 6) for section in set(cuts.section.tolist())}
            )
        best, least = feature, math.inf
        for z in depths[:_DEPTHS]:
            at_depth = cuts[np.abs(cuts.low - z) <= SAME_Z]
            if not len(at_depth):
                continue
            for placed in places:
                candidate = placed._replace(z=z, radius=float(at_depth.radius.max()))
                far = distance_of_wall(candidate, at_depth)
                if far < least - _BETTER:
                    best, least = candidate, far
        return best
