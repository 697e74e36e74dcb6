"""Contours of which a section has cut away the walls or the corners before another section of the same depth."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.finished import Finished
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    cached_property,
    column_at,
    different,
    folded,
    side_by_side,
)
from polarcheck.geometry.tolerances import ROUNDING

if TYPE_CHECKING:
    from polarcheck.geometry.outline import Outline
    from polarcheck.geometry.polygons.lost_walls import Likeness, Samples, Standing

#: Walls of a contour and of what has been cut before differ by wear and rounding [mm]; C differs by rounding [deg].
_SAME_SIZE, _SAME_ANGLE = 0.05, 0.5
#: Two sections of one floor end at the same Z within this [mm], or within this share of their depth, but no more.
_SAME_FLOOR, _SHARE_OF_DEPTH, _MOST_ON_FLOOR = 0.2, 0.1, 0.5
#: A tool that comes again so much farther out clears on; a floor is finished so far beside its wall [mm].
_MOST_LEFT, _BESIDE_WALL = 1.0, 0.3
#: By half of a pitch, a polygon that loses a smaller share of its corners makes chamfers.
_CHAMFER = 0.5
#: A shorter block is no wall [mm].
_SHORT = 1.0
#: A program with more sections than this is not searched.
_MOST_SECTIONS = 100


class Contour(NamedTuple):
    """
    A closed contour at the floor of a section.

    row: of its first block. section: its number. tool: as called. z: [mm]. radius: R of the cutter [mm]. left: metal
    that R leaves for another tool [mm]. inside: it is a pocket. standing: what all contours of its section and depth
    leave. outline, samples: of this contour. All in the frame of the part.
    """

    row: int
    section: int
    tool: int
    z: float
    radius: float
    left: float
    inside: bool
    standing: Standing
    outline: Outline
    samples: Samples


class EarlierContours(Columns, frozen=True):
    """What earlier sections have taken off the contours of one trace; rows of the later contour."""

    trace: Trace
    overcuts: Overcuts
    bar: Bar
    finished: Finished

    @cached_property
    def compared(self) -> Mask:
        """Rows of contours in programs of which several tools mill contours."""
        trace = self.trace
        rows = np.flatnonzero(trace.compensation.offset_mode)
        several = len(different(trace.tools.tool[rows])) > 1 and len(different(trace.mode.section[rows])) > 1
        return np.asarray(trace.compensation.offset_mode & several)

    @cached_property
    def loss(self) -> Floats:
        """By row of a contour, how much of its walls or corners an earlier section has cut off [mm]; 0 for nothing."""
        return column_at(len(self.trace), [*self._hits], [loss for _, loss in self._hits.values()], 0.0)

    def earlier(self, row: int) -> int:
        """The first row of the contour that has cut into the one of this row."""
        return self._hits[row][0]

    @cached_property
    def _hits(self) -> dict[int, tuple[int, float]]:
        """By the first row of a later contour, the first row of the earlier one, and what is lost [mm]."""
        pairs = self._pairs
        hits: dict[int, tuple[int, float]] = {}
        if not pairs:
            return hits
        contours = [*self._contours({section for pair in pairs for section in pair})]
        for later in contours:
            losses = [
                (self._loss(contour, later, contours), contour.row)
                for contour in contours
                if (contour.section, later.section) in pairs
            ]
            loss, row = max(losses, default=(0.0, -1))
            if loss > _SAME_SIZE:
                hits[later.row] = row, loss
        return hits

    @cached_property
    def _pairs(self) -> set[tuple[int, int]]:
        """
        Sections that mill one part of the workpiece to one floor, with other tools or other sizes.

        No turning tool has made another face between them.
        """
        walls, _ = self.overcuts.walls
        trace = self.trace
        section = trace.mode.section[walls.row]
        count = len(trace.mode.sections)
        floor = folded(np.fmin, section, trace.path.z[walls.row], count, np.inf)
        at_floor = trace.path.z[walls.row] <= floor[section] + ROUNDING
        walls, section = walls[at_floor], section[at_floor]
        numbers, first = np.unique(section, return_index=True)
        if not 1 < len(numbers) <= _MOST_SECTIONS:
            return set()
        reach = folded(np.fmax, section, np.abs(walls.end), count, 0.0)
        row = walls.row[first]
        turns = np.cumsum(self.bar.tools.turns)
        face = np.stack(
            [
                trace.blocks.program[row],
                trace.modal.state("work_offset")[row],
                trace.modal.on_sub_spindle[row],
                turns[row],
            ]
        )
        floor, reach, tool = floor[numbers], reach[numbers], trace.tools.tool[row]
        depth = np.abs(floor - (0.0 if np.isnan(self.bar.known.face) else self.bar.known.face))
        one_floor = np.clip(_SHARE_OF_DEPTH * depth, _SAME_FLOOR, _MOST_ON_FLOOR)
        differs = (tool[:, None] != tool) | (np.abs(reach[:, None] - reach) > _SAME_SIZE)
        together = (face[:, :, None] == face[:, None, :]).all(axis=0) & differs
        together &= np.abs(floor[:, None] - floor) <= np.minimum(one_floor[:, None], one_floor) + ROUNDING
        known = trace.path.knows_section_entry[numbers]
        earlier, later = np.nonzero(np.triu(together & known[:, None] & known, 1))
        return set(side_by_side(numbers[earlier], numbers[later]))

    def _contours(self, sections: set[int]) -> Iterator[Contour]:
        """The closed contours at the floor of these sections, in the order of the program."""
        from polarcheck.geometry.polygons.lost_walls import samples_of, standing_of

        trace = self.trace
        levels = [level for level in self.finished.levels if level.section in sections and not np.isnan(level.z)]
        for section in sorted({level.section for level in levels}):
            level = min((one for one in levels if one.section == section), key=lambda one: one.z)
            if level.open or level.tangled or not len(level.outline):
                continue
            level = self.finished.in_frame_of_part(level)
            standing = standing_of(level.polygon, level.outline)
            # Where the bar cuts off corners, the walls between them are one contour.
            chain = np.where(level.outline.closed[level.outline.chain], level.outline.chain, -1)
            for number in dict.fromkeys(chain.tolist()):
                outline = level.outline[chain == number]
                samples = samples_of(outline)
                row = int(outline.row.min())
                yield Contour(
                    row=row,
                    section=section,
                    tool=int(trace.tools.tool[row]),
                    z=level.z,
                    radius=level.radius,
                    left=float(trace.offsets.metal_left[row]),
                    inside=number >= 0 and bool(outline.twice_swept.sum() < 0),
                    standing=standing,
                    outline=outline,
                    samples=samples,
                )

    def _loss(self, earlier: Contour, later: Contour, contours: list[Contour]) -> float:
        """How far walls or corners of the later contour lie beyond what the earlier one leaves [mm]."""
        gone = self._gone(earlier, later)
        if earlier.inside != later.inside or gone.max() <= _SAME_SIZE:
            return 0.0
        # What a section takes off afterwards the contour was not to keep.
        for contour in contours:
            if (later.section, contour.section) in self._pairs:
                gone = np.where(self._gone(contour, later) > _SAME_SIZE, 0.0, gone)
        like = self._likeness(earlier, later)
        if like is None:
            is_air = gone.min() > _SAME_SIZE and gone.max() + 2 * (later.radius - earlier.radius) <= _SAME_SIZE
            return float(gone.min()) if is_air else 0.0
        if not like.is_aligned:
            return float(gone.max()) if self._is_elsewhere(earlier, later, float(gone.max()), contours) else 0.0
        offset = min(like.offset - earlier.left, float(gone.max()))
        if offset > _SAME_SIZE:
            clears_on = earlier.tool == later.tool and offset > _MOST_LEFT
            cuts_floor = later.z < earlier.z - _SAME_SIZE and offset <= _BESIDE_WALL
            return 0.0 if clears_on or cuts_floor or offset >= earlier.radius else offset
        return self._lost_block(later, gone) if like.offset - earlier.left < -_SAME_SIZE else 0.0

    def _gone(self, contour: Contour, other: Contour) -> Floats:
        """How far points of the other contour lie beyond what the first one leaves [mm], where it cuts metal."""
        from polarcheck.geometry.polygons.lost_walls import beyond

        point = other.samples.point
        gone = beyond(point, contour.standing) - contour.left
        is_rim = np.abs(point) >= self.overcuts.bar / 2 - _SAME_SIZE
        return np.where((gone <= 2 * contour.radius) & ~is_rim, gone, 0.0)

    @cached_property
    def _likenesses(self) -> dict[tuple[int, int], Likeness | None]:
        return {}

    def _likeness(self, earlier: Contour, later: Contour) -> Likeness | None:
        """The turns and the offset that lay the later contour along the earlier one."""
        from polarcheck.geometry.polygons.lost_walls import likeness

        key = earlier.row, later.row
        if key not in self._likenesses:
            self._likenesses[key] = likeness(later.samples, later.outline, earlier.standing)
        return self._likenesses[key]

    def _is_elsewhere(self, earlier: Contour, later: Contour, loss: float, contours: list[Contour]) -> bool:
        """The earlier contour is the later one at another C, and the two make no other shape together."""
        like = self._likeness(earlier, later)
        pairs = [(earlier, one) for one in contours] + [(one, later) for one in contours]
        likenesses = [self._likeness(*pair) for pair in pairs if (pair[0].section, pair[1].section) in self._pairs]
        # Two slots that cross, each with a contour before it.
        if like is None or any(one is not None and one.is_aligned for one in likenesses):
            return False
        left, pitch = -like.offset, 360 / len(like.turns)
        if len(like.turns) > 2 and like.turn >= pitch / 2 - _SAME_ANGLE:
            # Half of a pitch makes twice as many sides, or chamfers, where it is meant to.
            distance = np.abs(later.samples.point)
            return _SAME_SIZE < left <= _MOST_LEFT and loss >= _CHAMFER * float(np.ptp(distance))
        return left > _SAME_SIZE or (not later.inside and earlier.tool != later.tool)

    def _lost_block(self, later: Contour, gone: Floats) -> float:
        """The least loss along a whole block [mm] of a contour for which metal is left elsewhere."""
        element = later.samples.element
        is_end = (np.diff(element, prepend=-1) != 0) | (np.diff(element, append=-1) != 0)
        least = folded(np.minimum, element[~is_end], gone[~is_end], len(later.outline), np.inf)
        least[later.outline.length < _SHORT] = 0.0
        return float(np.max(least, initial=0.0, where=np.isfinite(least)))
