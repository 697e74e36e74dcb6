"""The contours in offset mode, each compared with the curve of the job that comes nearest to it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.finished import Finished, Level
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, cached_property
from polarcheck.foundation.time_limit import keep_time
from polarcheck.parts.nominal_parts import NominalParts
from polarcheck.parts.part_comparison import SAME_Z, Comparison, Contour, Fit, Target

if TYPE_CHECKING:
    from polarcheck.geometry.comparison.measured_path import MeasuredPath

#: A contour that differs by more than this share of its size is another one.
_OTHER = 0.1
#: A depth counts if it is farther from the stated one than the nearest depth by no more than this [mm].
_LEAST_INCREMENT = 1e-3
#: A contour is compared in full with this number of curves of a drawing, the nearest ones.
_NEAREST = 4


class ContourComparisons(Columns, frozen=True):
    """The comparisons of the contours of one run."""

    trace: Trace
    overcuts: Overcuts
    finished: Finished
    bar: Bar
    nominal_parts: NominalParts

    @cached_property
    def all(self) -> list[Comparison]:
        """The comparison of each contour. Raises TooHardError if the faces of the contours cannot be computed."""
        if not self.nominal_parts.in_offset_mode.any():
            return []
        results = [comparison for contour in self.contours if (comparison := self._compared(contour)) is not None]
        groups: dict[tuple[int, int], list[int]] = {}
        for index, result in enumerate(results):
            groups.setdefault((result.number, result.curve), []).append(index)
        for members in groups.values():
            best = min(members, key=lambda index: results[index].rank)
            for index in members:
                if index != best and self._is_superseded(results[index], results[best]):
                    results[index] = results[index]._replace(is_superseded=True)
        if np.isnan(self.trace.compensation.radius[self.nominal_parts.in_offset_mode]).any():
            results = [
                result._replace(is_superseded=result.is_superseded or self._only_leaves_more(result))
                for result in results
            ]
        return results

    @cached_property
    def _levels(self) -> list[tuple[Level, bool, bool]]:
        """
        Levels in the frame of the part: each by itself, for parts of one section; put together, for others.
        """
        if all(part.section is None for part in self.nominal_parts.parts):
            return [(level, False, True) for level in self.finished.of_part]
        together = [(level, len(level.sections) == 1, True) for level in self.finished.of_part]
        single = [(level, True, False) for level in self.finished.of_sections_put_together]
        return together + single

    # ---- which contours are compared with what ----

    @cached_property
    def contours(self) -> list[Contour]:
        """All contours of known R, in the frame of the part."""
        return [
            contour
            for level, of_one_section, of_all in self._levels
            if not level.tangled and len(level.outline)
            for contour in self._contours_of(level, of_one_section, of_all)
        ]

    def _contours_of(self, level: Level, of_one_section: bool, of_all: bool) -> Iterator[Contour]:
        from polarcheck.geometry.comparison.deviation import machined_part

        outline, bar = level.outline, self.bar.known.largest / 2
        closed = outline.closed[outline.chain]
        for number in np.unique(outline.chain[closed]).tolist():
            keep_time()
            machined = machined_part(outline[outline.chain == number], level.polygon, bar)
            start, end = machined.way.start - machined.way.start[0], machined.way.end - machined.way.start[0]
            is_pocket = float((start.conj() * end).imag.sum()) < 0
            yield Contour(level, machined, True, is_pocket, of_one_section, of_all)
        if not closed.all():
            machined = machined_part(outline[~closed], level.polygon, bar)
            yield Contour(level, machined, False, False, of_one_section, of_all)

    def _targets(self, contour: Contour) -> list[Target]:
        """The curves that a contour may be meant for: those on its side, or if there are none, those on the other."""
        applying = [number for number in range(len(self.nominal_parts.parts)) if self._applies(number, contour)]
        row = int(contour.level.outline.row[0])
        targets = [target for number in applying for target in self._curves_of(number, row, contour.is_closed)]
        if contour.is_closed:
            same_side = [
                target
                for target in targets
                if target.part.drawing is not None or target.part.is_pocket == contour.is_pocket
            ]
            targets = same_side or targets
        if len(targets) > _NEAREST:
            points, _ = contour.made.way.at(np.linspace(0, contour.made.way.length, 16))
            distances = [float(target.way.nearest(points)[0].mean()) for target in targets]
            targets = [targets[index] for index in np.argsort(distances, kind="stable")[:_NEAREST].tolist()]
        return targets

    def _applies(self, number: int, contour: Contour) -> bool:
        part, level = self.nominal_parts.parts[number], contour.level
        if not (contour.of_one_section if part.section == level.section + 1 else contour.of_all and not part.section):
            return False
        if not math.isnan(part.z):
            stated = self.nominal_parts.z(number, int(level.walls.row[0]))
            off = [abs(peer.z - stated) for peer in self.finished.levels if not math.isnan(peer.z)]
            allowed = self.nominal_parts.z_tolerance(number, int(level.walls.row[0]))
            return abs(level.z - stated) <= min(allowed, min(off, default=0.0) + _LEAST_INCREMENT)
        if part.drawing is not None:
            return True
        sections = set(level.sections)
        depths = [peer.z for peer in self.finished.levels if peer.section in sections and len(peer.outline)]
        return math.isnan(level.z) or level.z <= np.nanmin(depths) + SAME_Z

    def _curves_of(self, number: int, row: int, is_closed: bool) -> list[Target]:
        from polarcheck.geometry.comparison.measured_path import path_of_curves

        part = self.nominal_parts.parts[number]
        scale = self.nominal_parts.unit(number, row)
        key = number, scale, is_closed
        if key not in self._known:
            curves = self.nominal_parts.curves(number, scale)
            rings = [number for number, curve in enumerate(curves) if curve[0] == curve[-1]]
            if not is_closed or not rings or self.nominal_parts.gap(number, row) is not None:
                path = path_of_curves(curves)
                self._known[key] = [Target(number, part, -1, path, scale, False, len(rings) == len(curves))]
            else:
                self._known[key] = [
                    Target(number, part, ring, path_of_curves([curves[ring]]), scale, True, True) for ring in rings
                ]
        return self._known[key]

    @cached_property
    def _known(self) -> dict[tuple[int, float, bool], list[Target]]:
        return {}

    # ---- comparing ----

    def _compared(self, contour: Contour) -> Comparison | None:
        """The contour compared with its nearest curve."""
        from polarcheck.geometry.comparison.deviation import difference

        results: list[Comparison] = []
        for target in self._targets(contour):
            keep_time()
            part, angle, curve = target.part, math.nan, target.way
            angle_not_compared = self.nominal_parts.angle_not_compared(target.number, contour.level.section)
            if angle_not_compared:
                angle, curve = self._turned(contour, target)
            both_ways = target.is_closed and contour.is_closed
            metal = self.nominal_parts.air(target.number, target.scale)
            allowed = self.nominal_parts.tolerance(target.number, int(contour.made.outline.row[0]))
            deviation = difference(contour.made, curve, allowed, both_ways=both_ways, metal=metal)
            row = int(contour.made.outline.row[max(deviation.of, 0)])
            is_other_way = (
                contour.is_closed and target.is_closed and part.drawing is None and part.is_pocket != contour.is_pocket
            )
            if is_other_way:
                # The whole area is wrong, up to its center.
                depth = float(np.abs(curve.start - curve.start.mean()).min())
                deviation = deviation._replace(deep=depth) if contour.is_pocket else deviation._replace(proud=depth)
            partial = not contour.is_closed and target.rings and math.isinf(min(deviation.turned, contour.made.bar))
            results.append(
                Comparison(
                    number=target.number,
                    part=part,
                    curve=target.curve,
                    section=contour.level.section,
                    z=contour.level.z,
                    tolerance=self.nominal_parts.tolerance(target.number, row),
                    difference=deviation,
                    row=row,
                    turned=angle,
                    is_other_way_round=is_other_way,
                    is_partial=partial,
                    angle_not_compared=angle_not_compared,
                    contour=contour,
                    target=target,
                    entry=self.nominal_parts.entry(row),
                )
            )
        results = [deviation for deviation in results if deviation.difference.length]
        return min(results, key=lambda deviation: deviation.difference.mean, default=None)

    def _turned(self, contour: Contour, target: Target) -> tuple[float, MeasuredPath]:
        """The best angle of a shape that may have any angle [rad], and the shape turned by it."""
        from polarcheck.geometry.comparison.alignment import best_turn
        from polarcheck.geometry.comparison.measured_path import path_of

        is_known = bool(self.trace.path.knows_section_entry[contour.level.section])
        center = target.scale * complex(*target.part.center) if is_known else 0j
        path = contour.made.way
        if math.isfinite(self.nominal_parts.air(target.number, target.scale)):
            # Of flats and slots the walls say the angle, not what leads from one to the next.
            lines = ~contour.made.outline.is_arc[path.of]
            path = path_of(path.start[lines], path.end[lines], path.of[lines]) if lines.any() else path
        angle = best_turn(path, target.way, center)
        return angle, _placed(target.way, angle, center)

    def _is_superseded(self, result: Comparison, best: Comparison) -> bool:
        """Another contour agrees, and this one is roughing that leaves material, or is meant for another curve."""
        if result.part.section is not None:
            return result.z > best.z + SAME_Z and result.difference.deep <= result.tolerance
        assert result.target is not None
        target = result.target
        size = float(np.abs(target.way.start - target.way.start.mean()).max())
        return result.difference.deep <= result.tolerance or result.difference.largest > _OTHER * size

    def _only_leaves_more(self, result: Comparison) -> bool:
        return not result.agrees and not result.is_other_way_round and result.difference.deep <= result.tolerance

    def fit(self, result: Comparison) -> Fit | None:
        """The change with which the part would agree, or nearly; None if there is none, or the drawing has gaps."""
        from polarcheck.geometry.comparison.placements import Freedom, better_placement

        contour, target = result.contour, result.target
        if result.is_other_way_round or contour is None or target is None:
            return None
        if self.nominal_parts.gap(result.number, result.row) is not None:
            return None  # to turn and to shift many curves is dear, and a drawing with gaps is to be mended first
        is_drawn = result.part.drawing is not None
        curves = [target.way]
        if is_drawn and target.is_closed:
            candidates = self._curves_of(result.number, int(contour.level.outline.row[0]), contour.is_closed)
            curves += [candidate.way for candidate in candidates if candidate.curve != target.curve]
        freedom = Freedom(is_drawn, math.isnan(result.turned), result.part.shape == "circle")
        center = target.scale * complex(*result.part.center)
        fit = better_placement(contour.made, curves, center, result.difference, result.tolerance, freedom)
        return None if fit is None else Fit(*fit)


def _placed(path: MeasuredPath, angle: float, center: complex) -> MeasuredPath:
    """A path turned about a center [rad]."""
    from polarcheck.geometry.comparison.placements import Placement

    return Placement(turned=angle).of(path, center)
