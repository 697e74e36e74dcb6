"""How the finished part differs from the part of the job: a drawing, or a shape with dimensions."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from polarcheck.arrays import Floats, Mask, Points
from polarcheck.columns.trace import Trace
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.machines.job import Job
from polarcheck.machines.part import DrawnPart, Part
from polarcheck.table.finished import Finished, Level
from polarcheck.table.overcuts import Overcuts
from polarcheck.table.skipped_loops import SkipReason
from polarcheck.time_limit import keep_time

if TYPE_CHECKING:
    from polarcheck.geometry.comparison.deviation import Difference, Made
    from polarcheck.geometry.comparison.measured_path import Way
    from polarcheck.geometry.comparison.placements import Placement

#: Tolerance of a part whose job states none [mm].
TOLERANCE = 0.02
#: Depths nearer to each other than this are equal [mm]: a job states the Z of a part to the least increment.
_SAME_Z = 1e-3
#: A contour that differs by more than this share of its size is another one.
_OTHER = 0.1
#: A contour is compared in full with this number of curves of a drawing, the nearest ones.
_NEAREST = 4


class Fit(NamedTuple):
    """
    A change with which the part would agree.

    placement: the change of what the job asks for.
    largest: the largest difference after the change [mm].
    """

    placement: Placement
    largest: float


class Comparison(NamedTuple):
    """
    A contour compared with a curve of the job.

    number: index of the part in the job.
    part: the part of the job.
    curve: index of the curve in the drawing, -1 for all curves.
    section: number of the section of the contour.
    z: Z of the contour [mm].
    tolerance: allowed difference [mm].
    difference: of the contour from the curve.
    row: the row where the difference is largest.
    turned: angle of a shape that may have any angle [rad], NaN for other shapes.
    is_other_way_round: a boss where a pocket should be, or the reverse.
    is_partial: the contour is open though all drawn curves are closed; only its walls are compared.
    is_superseded: roughing, or not the nearest contour, or it leaves material that a contour of unknown R may remove.
    fit: the change with which the part would agree; None for none.
    """

    number: int
    part: Part
    curve: int
    section: int
    z: float
    tolerance: float
    difference: Difference
    row: int
    turned: float
    is_other_way_round: bool
    is_partial: bool
    is_superseded: bool
    fit: Fit | None

    @property
    def agrees(self) -> bool:
        """The difference is within the tolerance."""
        return not self.is_other_way_round and self.difference.largest <= self.tolerance + ROUNDING

    @property
    def differs(self) -> bool:
        """The difference is reported."""
        return not self.agrees and not self.is_superseded

    @property
    def title(self) -> str:
        """The name of the drawing, or the shape, that the contour is compared with."""
        return title_of(self.part)


def title_of(part: Part) -> str:
    """The name of the drawing, or the shape."""
    return Path(part.drawing).name if part.drawing is not None else f"the {part.shape} asked for"


class _Target(NamedTuple):
    """
    A curve of the job that a contour may be meant for.

    number: index of the part in the job.
    part: the part of the job.
    curve: index of the curve in the drawing, -1 for all curves.
    way: the curve [mm].
    scale: [mm] per unit of the part.
    is_closed: the curve is closed.
    rings: all curves of the part are closed.
    """

    number: int
    part: Part
    curve: int
    way: Way
    scale: float
    is_closed: bool
    rings: bool


class _Chain(NamedTuple):
    """A closed contour of a level, or all open contours of a level together."""

    level: Level
    made: Made
    is_closed: bool
    is_pocket: bool


class Deviations:
    """Columns of one trace, one value per row: the largest differences of the part; and all comparisons."""

    def __init__(self, trace: Trace, overcuts: Overcuts, finished: Finished, job: Job) -> None:
        self.trace = trace
        self.overcuts = overcuts
        self.finished = finished
        self.parts = job.part

    @cached_property
    def asked(self) -> Mask:
        """Rows in offset mode in the sections for which the job states a part."""
        sections = [part.section for part in self.parts]
        if not sections:
            return np.zeros(len(self.trace), bool)
        mask: Mask = self.trace.compensation.offset_mode.copy()
        if None not in sections:
            mask &= np.isin(self.trace.mode.section + 1, np.array(sections))
        return mask

    @cached_property
    def crosses(self) -> Mask:
        """Rows of loops that cross themselves too often to have a part."""
        return self.overcuts.skipped.rows(self.overcuts.loop, SkipReason.CROSSES)

    @cached_property
    def comparisons(self) -> list[Comparison]:
        """All comparisons, in program order. Raises TooHardError if the faces of the contours cannot be computed."""
        if not self.asked.any():
            return []
        results = [
            comparison
            for level in self.finished.levels
            if not level.tangled and len(level.outline)
            for chain in self._chains(level)
            if (comparison := self._compared(chain)) is not None
        ]
        groups: dict[tuple[int, int], list[int]] = {}
        for index, result in enumerate(results):
            groups.setdefault((result.number, result.curve), []).append(index)
        for members in groups.values():
            best = min(
                members, key=lambda index: (results[index].is_other_way_round, results[index].difference.largest)
            )
            for index in members:
                if index != best and self._is_superseded(results[index], results[best]):
                    results[index] = results[index]._replace(is_superseded=True)
        if np.isnan(self.trace.compensation.radius[self.asked]).any():
            results = [
                result._replace(is_superseded=result.is_superseded or self._only_leaves_more(result))
                for result in results
            ]
        return [result._replace(fit=self._fit(result)) if result.differs else result for result in results]

    @cached_property
    def _worst(self) -> dict[int, Comparison]:
        """The comparison with the largest difference of each row, by row."""
        worst: dict[int, Comparison] = {}
        for result in self.comparisons:
            if result.differs and (
                result.row not in worst or worst[result.row].difference.largest < result.difference.largest
            ):
                worst[result.row] = result
        return worst

    @cached_property
    def differs(self) -> Mask:
        """Rows where the difference of a part is largest."""
        column = np.zeros(len(self.trace), bool)
        column[list(self._worst)] = True
        return column

    @cached_property
    def largest(self) -> Floats:
        """The largest difference in such a row [mm], 0 elsewhere."""
        column = np.zeros(len(self.trace))
        for row, result in self._worst.items():
            column[row] = result.difference.largest
        return column

    @cached_property
    def tolerance(self) -> Floats:
        """The tolerance in such a row [mm], NaN elsewhere."""
        column = np.full(len(self.trace), np.nan)
        for row, result in self._worst.items():
            column[row] = result.tolerance
        return column

    def of_row(self, row: int) -> Comparison:
        """The comparison that is reported in a row that differs."""
        return self._worst[row]

    def missing(self) -> Iterator[tuple[int, str]]:
        """Parts that no contour was compared with, each with the reason; none if R is unknown or walls are tangled."""
        if not len(self.trace.mode.sections):
            return
        compared = {comparison.number for comparison in self.comparisons}
        levels = self.finished.levels
        has_other_reason = self.crosses.any() or bool(np.isnan(self.trace.compensation.radius[self.asked]).any())
        for number, part in enumerate(self.parts):
            if number in compared or has_other_reason:
                continue
            count = len(self.trace.mode.sections)
            if part.section is not None and part.section > count:
                yield number, f"it is for section {part.section}, and the program has {count}"
            elif not any(part.section in (None, level.section + 1) for level in levels):
                yield number, "no contour in offset mode is there to compare with it"
            elif not math.isnan(part.z) and not any(self._is_at(part, level) for level in levels):
                yield number, "no contour lies at its Z"
            else:
                yield number, "each contour comes nearer to another part"

    # ---- which contours are compared with what ----

    def _chains(self, level: Level) -> Iterator[_Chain]:
        from polarcheck.geometry.comparison.deviation import made_of

        outline, bar = level.outline, self.overcuts.bar / 2
        closed = outline.closed[outline.chain]
        for number in np.unique(outline.chain[closed]).tolist():
            keep_time()
            made = made_of(outline[outline.chain == number], level.polygon, bar)
            start, end = made.way.start - made.way.start[0], made.way.end - made.way.start[0]
            yield _Chain(level, made, True, float((start.conj() * end).imag.sum()) < 0)
        if not closed.all():
            yield _Chain(level, made_of(outline[~closed], level.polygon, bar), False, False)

    def _targets(self, chain: _Chain) -> list[_Target]:
        """The curves that a contour may be meant for: those on its side, or if there are none, those on the other."""
        applying = [number for number, part in enumerate(self.parts) if self._applies(part, chain.level)]
        row = int(chain.level.outline.row[0])
        targets = [target for number in applying for target in self._curves_of(number, row, chain.is_closed)]
        if chain.is_closed:
            same_side = [
                target
                for target in targets
                if target.part.drawing is not None or target.part.is_pocket == chain.is_pocket
            ]
            targets = same_side or targets
        if len(targets) > _NEAREST:
            points, _ = chain.made.way.at(np.linspace(0, chain.made.way.length, 16))
            distances = [float(target.way.nearest(points)[0].mean()) for target in targets]
            targets = [targets[index] for index in np.argsort(distances, kind="stable")[:_NEAREST].tolist()]
        return targets

    def _applies(self, part: Part, level: Level) -> bool:
        if part.section not in (None, level.section + 1):
            return False
        if not math.isnan(part.z):
            return self._is_at(part, level)
        if part.drawing is not None:
            return True
        depths = [other.z for other in self.finished.levels if other.section == level.section and len(other.outline)]
        return math.isnan(level.z) or level.z <= np.nanmin(depths) + _SAME_Z

    def _is_at(self, part: Part, level: Level) -> bool:
        z = part.z * self._scale(part, int(level.walls.row[0]))
        return abs(level.z - z) <= _SAME_Z

    def _scale(self, part: Part, row: int) -> float:
        """The length of a unit of the job for a part [mm]."""
        return float(np.broadcast_to(self.trace.lengths.job_scale, len(self.trace))[row])

    def _curves_of(self, number: int, row: int, is_closed: bool) -> list[_Target]:
        from polarcheck.geometry.comparison.measured_path import way_of_curves

        part = self.parts[number]
        scale = self._scale(part, row)
        if isinstance(part, DrawnPart):
            scale = float(self.trace.lengths.scale[row]) if math.isnan(part.scale) else part.scale
        key = number, scale, is_closed
        if key not in self._known:
            curves = self._drawn(part, scale)
            rings = [number for number, curve in enumerate(curves) if curve[0] == curve[-1]]
            if not is_closed or not rings:
                way = way_of_curves(curves)
                self._known[key] = [_Target(number, part, -1, way, scale, False, len(rings) == len(curves))]
            else:
                self._known[key] = [
                    _Target(number, part, ring, way_of_curves([curves[ring]]), scale, True, True) for ring in rings
                ]
        return self._known[key]

    @cached_property
    def _known(self) -> dict[tuple[int, float, bool], list[_Target]]:
        return {}

    def _drawn(self, part: Part, scale: float) -> list[Points]:
        if isinstance(part, DrawnPart):
            return [np.array(curve, complex) * complex(scale) for curve in part.curves]
        from polarcheck.geometry.comparison.nominal import curves_of

        return curves_of(part, scale)

    # ---- comparing ----

    def _compared(self, chain: _Chain) -> Comparison | None:
        """The contour compared with its nearest curve."""
        from polarcheck.geometry.comparison.deviation import difference, turned_radius

        results: list[Comparison] = []
        for target in self._targets(chain):
            keep_time()
            part, angle, way = target.part, math.nan, target.way
            if part.drawing is None and part.shape != "circle" and math.isnan(part.turned):
                angle, way = self._turned(chain, target)
            both_ways = target.is_closed and chain.is_closed
            deviation = difference(chain.made, way, both_ways=both_ways)
            row = int(chain.made.outline.row[max(deviation.of, 0)])
            is_other_way = (
                chain.is_closed and target.is_closed and part.drawing is None and part.is_pocket != chain.is_pocket
            )
            if is_other_way:
                # The whole area is wrong, up to its center.
                depth = float(np.abs(way.start - way.start.mean()).min())
                deviation = deviation._replace(deep=depth) if chain.is_pocket else deviation._replace(proud=depth)
            stated = part.tolerance * self._scale(part, row)
            tolerance = TOLERANCE if math.isnan(stated) else stated
            place = chain.level.section, chain.level.z, tolerance
            partial = not chain.is_closed and target.rings and math.isinf(min(turned_radius(way), chain.made.bar))
            results.append(
                Comparison(
                    target.number, part, target.curve, *place, deviation, row, angle, is_other_way, partial, False, None
                )
            )
            self._chain_of[target.number, target.curve, row, deviation.at] = chain, target
        results = [deviation for deviation in results if deviation.difference.length]
        return min(results, key=lambda deviation: deviation.difference.mean, default=None)

    @cached_property
    def _chain_of(self) -> dict[tuple[int, int, int, complex], tuple[_Chain, _Target]]:
        return {}

    def _turned(self, chain: _Chain, target: _Target) -> tuple[float, Way]:
        """The best angle of a shape that may have any angle [rad], and the shape turned by it."""
        from polarcheck.geometry.comparison.alignment import best_turn

        center = target.scale * complex(*target.part.center)
        angle = best_turn(chain.made.way, target.way, center)
        return angle, _placed(target.way, angle, center)

    def _is_superseded(self, result: Comparison, best: Comparison) -> bool:
        """Another contour agrees, and this one is roughing that leaves material, or is meant for another curve."""
        if result.part.section is not None:
            return result.z > best.z + _SAME_Z and result.difference.deep <= result.tolerance
        _, target = self._chain_of[result.number, result.curve, result.row, result.difference.at]
        size = float(np.abs(target.way.start - target.way.start.mean()).max())
        return result.difference.deep <= result.tolerance or result.difference.largest > _OTHER * size

    def _only_leaves_more(self, result: Comparison) -> bool:
        return not result.agrees and not result.is_other_way_round and result.difference.deep <= result.tolerance

    def _fit(self, result: Comparison) -> Fit | None:
        """The change with which the part would agree, or nearly agree; None if there is none."""
        from polarcheck.geometry.comparison.placements import Freedom, better_placement

        if result.is_other_way_round:
            return None
        chain, target = self._chain_of[result.number, result.curve, result.row, result.difference.at]
        is_drawn = result.part.drawing is not None
        curves = [target.way]
        if is_drawn and target.is_closed:
            others = self._curves_of(result.number, int(chain.level.outline.row[0]), chain.is_closed)
            curves += [other.way for other in others if other.curve != target.curve]
        freedom = Freedom(is_drawn, math.isnan(result.turned), result.part.shape == "circle")
        center = target.scale * complex(*result.part.center)
        fit = better_placement(chain.made, curves, center, result.difference, result.tolerance, freedom)
        return None if fit is None else Fit(*fit)


def _placed(way: Way, angle: float, center: complex) -> Way:
    """A way turned about a center [rad]."""
    from polarcheck.geometry.comparison.placements import Placement

    return Placement(turned=angle).of(way, center)
