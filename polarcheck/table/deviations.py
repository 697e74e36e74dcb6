"""How the finished part differs from what the job asks for: from a drawing, or from a shape with its numbers."""

from __future__ import annotations

import cmath
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

#: How far a part may differ where nobody says [mm].
TOLERANCE = 0.02
#: Depths that are nearer to each other [mm] are one: the Z of a part in a job is written to the least increment.
_SAME_Z = 1e-3
#: A contour that differs by more than this share of its size is another one.
_OTHER = 0.1
#: What a part would differ by if it were placed otherwise is worth telling if it is so small a share of what it does.
_FAR_LESS = 0.05
#: Curves of a drawing that a contour is compared with in full, those that come nearest.
_NEAREST = 4


class Fit(NamedTuple):
    """
    How a part would have to be changed to agree.

    mirrored: C with the other sign. turned: after that [rad]. factor: X times this. largest: by how much it then
    differs [mm].
    """

    turned: float
    mirrored: bool
    factor: float
    largest: float


class Comparison(NamedTuple):
    """
    One contour beside what it should be.

    number: of the part in the job. curve: which one of its drawing, -1 for all. section, z: of the contour. tolerance:
    [mm]. difference: of part and drawing. row: of the block where it is largest. turned: by how much a shape is turned
    that may be turned in any way [rad], NaN for others. is_other_way_round: a boss where a pocket should be, or the
    reverse. is_partial: a contour that does not close, along its walls alone, though all that is drawn does.
    is_superseded: roughing, or another contour than the one that comes nearest; or it leaves more than is asked for,
    and a contour whose R is not known may take that off.
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
        """Within the tolerance."""
        return not self.is_other_way_round and self.difference.largest <= self.tolerance + ROUNDING

    @property
    def differs(self) -> bool:
        """It is worth telling."""
        return not self.agrees and not self.is_superseded

    @property
    def title(self) -> str:
        """What it is compared with: the name of the drawing, or the shape."""
        return title_of(self.part)


def title_of(part: Part) -> str:
    """The name of the drawing, or the shape."""
    return Path(part.drawing).name if part.drawing is not None else f"the {part.shape} asked for"


class _Target(NamedTuple):
    """
    A curve of a drawing, or all of them (-1), that a contour may be. scale: [mm] per unit of the part. is_closed: the
    curve is. rings: all of its curves are.
    """

    number: int
    part: Part
    curve: int
    way: Way
    scale: float
    is_closed: bool
    rings: bool


class _Chain(NamedTuple):
    """A contour that is closed, or all of a level that are open."""

    level: Level
    made: Made
    is_closed: bool
    is_pocket: bool


class Deviations:
    """Columns of one trace, one value per row: by how much the part differs where it does so most; and comparisons."""

    def __init__(self, trace: Trace, overcuts: Overcuts, finished: Finished, job: Job) -> None:
        self.trace = trace
        self.overcuts = overcuts
        self.finished = finished
        self.parts = job.part

    @cached_property
    def asked(self) -> Mask:
        """Rows in offset mode, where the job says what they should make."""
        sections = [part.section for part in self.parts]
        if not sections:
            return np.zeros(len(self.trace), bool)
        asked: Mask = self.trace.compensation.offset_mode.copy()
        if None not in sections:
            asked &= np.isin(self.trace.mode.section + 1, np.array(sections))
        return asked

    @cached_property
    def crosses(self) -> Mask:
        """Rows of loops that cross themselves too often to have a part."""
        return self.overcuts.skipped.rows(self.overcuts.loop, SkipReason.CROSSES)

    @cached_property
    def comparisons(self) -> list[Comparison]:
        """In the order of the program. Raises TooHardError where the faces of the contours cannot be computed."""
        if not self.asked.any():
            return []
        found = [
            comparison
            for level in self.finished.levels
            if not level.tangled and len(level.outline)
            for chain in self._chains(level)
            if (comparison := self._compared(chain)) is not None
        ]
        groups: dict[tuple[int, int], list[int]] = {}
        for index, one in enumerate(found):
            groups.setdefault((one.number, one.curve), []).append(index)
        for members in groups.values():
            best = min(members, key=lambda index: (found[index].is_other_way_round, found[index].difference.largest))
            for index in members:
                if index != best and self._is_superseded(found[index], found[best]):
                    found[index] = found[index]._replace(is_superseded=True)
        if np.isnan(self.trace.compensation.radius[self.asked]).any():
            found = [one._replace(is_superseded=one.is_superseded or self._only_leaves_more(one)) for one in found]
        return [one._replace(fit=self._fit(one)) if one.differs else one for one in found]

    @cached_property
    def _worst(self) -> dict[int, Comparison]:
        """By row the comparison that differs most there."""
        worst: dict[int, Comparison] = {}
        for one in self.comparisons:
            if one.differs and (one.row not in worst or worst[one.row].difference.largest < one.difference.largest):
                worst[one.row] = one
        return worst

    @cached_property
    def differs(self) -> Mask:
        """Rows where a part differs most."""
        column = np.zeros(len(self.trace), bool)
        column[list(self._worst)] = True
        return column

    @cached_property
    def largest(self) -> Floats:
        """By how much [mm], 0 elsewhere."""
        column = np.zeros(len(self.trace))
        for row, one in self._worst.items():
            column[row] = one.difference.largest
        return column

    @cached_property
    def tolerance(self) -> Floats:
        """By how much it may differ there [mm], NaN elsewhere."""
        column = np.full(len(self.trace), np.nan)
        for row, one in self._worst.items():
            column[row] = one.tolerance
        return column

    def of_row(self, row: int) -> Comparison:
        """The comparison that is told in a row which differs."""
        return self._worst[row]

    def missing(self) -> Iterator[tuple[int, str]]:
        """The parts that nothing was compared with, and why; not where R is unknown, or walls are tangled."""
        if not len(self.trace.mode.sections):
            return
        compared = {one.number for one in self.comparisons}
        levels = self.finished.levels
        told = self.crosses.any() or bool(np.isnan(self.trace.compensation.radius[self.asked]).any())
        for number, part in enumerate(self.parts):
            if number in compared or told:
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
        """The curves that a contour may be; where none is on its side, those on the other one."""
        applying = [number for number, part in enumerate(self.parts) if self._applies(part, chain.level)]
        row = int(chain.level.outline.row[0])
        found = [target for number in applying for target in self._curves_of(number, row, chain.is_closed)]
        if chain.is_closed:
            right = [one for one in found if one.part.drawing is not None or one.part.is_pocket == chain.is_pocket]
            found = right or found
        if len(found) > _NEAREST:
            points, _ = chain.made.way.at(np.linspace(0, chain.made.way.length, 16))
            far = [float(target.way.nearest(points)[0].mean()) for target in found]
            found = [found[index] for index in np.argsort(far, kind="stable")[:_NEAREST].tolist()]
        return found

    def _applies(self, part: Part, level: Level) -> bool:
        if part.section not in (None, level.section + 1):
            return False
        if not math.isnan(part.z):
            return self._is_at(part, level)
        if part.drawing is not None:
            return True
        depths = [one.z for one in self.finished.levels if one.section == level.section and len(one.outline)]
        return math.isnan(level.z) or level.z <= np.nanmin(depths) + _SAME_Z

    def _is_at(self, part: Part, level: Level) -> bool:
        z = part.z * self._scale(part, int(level.walls.row[0]))
        return abs(level.z - z) <= _SAME_Z

    def _scale(self, part: Part, row: int) -> float:
        """mm per unit of what a job says of a part."""
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
        """The contour beside the curve that comes nearest to it."""
        from polarcheck.geometry.comparison.deviation import difference, turned_radius

        found: list[Comparison] = []
        for target in self._targets(chain):
            keep_time()
            part, angle, way = target.part, math.nan, target.way
            if part.drawing is None and part.shape != "circle" and math.isnan(part.turned):
                angle, way = self._turned(chain, target)
            both = target.is_closed and chain.is_closed
            one = difference(chain.made, way, both_ways=both)
            row = int(chain.made.outline.row[max(one.of, 0)])
            wrong = chain.is_closed and target.is_closed and part.drawing is None and part.is_pocket != chain.is_pocket
            if wrong:
                # Not even the middle is as it should be.
                depth = float(np.abs(way.start - way.start.mean()).min())
                one = one._replace(deep=depth) if chain.is_pocket else one._replace(proud=depth)
            given = part.tolerance * self._scale(part, row)
            tolerance = TOLERANCE if math.isnan(given) else given
            where = chain.level.section, chain.level.z, tolerance
            partial = not chain.is_closed and target.rings and math.isinf(min(turned_radius(way), chain.made.bar))
            found.append(
                Comparison(target.number, part, target.curve, *where, one, row, angle, wrong, partial, False, None)
            )
            self._chain_of[target.number, target.curve, row, one.at] = chain, target
        found = [one for one in found if one.difference.length]
        return min(found, key=lambda one: one.difference.mean, default=None)

    @cached_property
    def _chain_of(self) -> dict[tuple[int, int, int, complex], tuple[_Chain, _Target]]:
        return {}

    def _turned(self, chain: _Chain, target: _Target) -> tuple[float, Way]:
        """The best angle of a shape that may be turned in any way [rad], and the shape turned by it."""
        from polarcheck.geometry.comparison.alignment import best_turn

        center = target.scale * complex(*target.part.center)
        angle = best_turn(chain.made.way, target.way, center)
        return angle, _placed(target.way, angle, False, 1.0, center)

    def _is_superseded(self, one: Comparison, best: Comparison) -> bool:
        """Another contour agrees, and this one leaves more, as roughing does; or it is another one altogether."""
        if one.part.section is not None:
            return one.z > best.z + _SAME_Z and one.difference.deep <= one.tolerance
        _, target = self._chain_of[one.number, one.curve, one.row, one.difference.at]
        size = float(np.abs(target.way.start - target.way.start.mean()).max())
        return one.difference.deep <= one.tolerance or one.difference.largest > _OTHER * size

    def _only_leaves_more(self, one: Comparison) -> bool:
        return not one.agrees and not one.is_other_way_round and one.difference.deep <= one.tolerance

    def _fit(self, one: Comparison) -> Fit | None:
        """How the part would have to be placed to agree, or nearly so; None where it would not."""
        from polarcheck.geometry.comparison.alignment import best_turn
        from polarcheck.geometry.comparison.deviation import difference

        if one.part.shape == "circle" or not math.isnan(one.turned):
            return None
        chain, target = self._chain_of[one.number, one.curve, one.row, one.difference.at]
        center = target.scale * complex(*one.part.center)
        enough = max(one.tolerance, _FAR_LESS * one.difference.largest)
        for mirrored, factor in ((False, 1.0), (True, 1.0), (False, 2.0), (False, 0.5)):
            keep_time()
            if one.part.drawing is None and (mirrored or factor != 1):
                break
            way = _placed(target.way, 0.0, mirrored, factor, center)
            angles = [best_turn(chain.made.way, way, center)] if factor == 1 else [0.0]
            for angle in [0.0, *angles] if mirrored else angles:
                turned = _placed(way, angle, False, 1.0, center)
                found = difference(chain.made, turned, both_ways=target.is_closed and chain.is_closed)
                if found.length and found.largest <= enough:
                    return Fit(angle if mirrored else -angle, mirrored, 1 / factor, found.largest)
        return None


def _placed(way: Way, angle: float, mirrored: bool, factor: float, center: complex) -> Way:
    """A way turned about a center [rad], or mirrored first, with C of the other sign, or with its X multiplied."""
    from polarcheck.geometry.comparison.measured_path import way_of

    def moved(points: Points) -> Points:
        points = points.conj() if mirrored else points
        points = factor * points.real + 1j * points.imag
        return center + (points - center) * cmath.exp(1j * angle)

    return way_of(moved(way.start), moved(way.end), way.of)
