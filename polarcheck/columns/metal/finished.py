"""The finished part: what contours that are programmed in offset mode leave standing at each depth of each section."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import msgspec
import numpy as np

from polarcheck.columns.contour.overcuts import Overcuts, level_of
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, folded
from polarcheck.geometry.tolerances import CORNER, ROUNDING

#: Decimals of points of the same wall [mm].
_SAME_WALL = 3

if TYPE_CHECKING:
    from polarcheck.geometry.outline import Outline
    from polarcheck.geometry.polygons.finished_part import FinishedParts
    from polarcheck.geometry.segments import Curves


class Level(msgspec.Struct, frozen=True):
    """
    The part that the contours at one Z of one section leave standing.

    section: its number, of several the first. z: the deepest at which the whole wall is cut [mm], NaN where it is not
    known. bottom: the deepest of all [mm], below z where the floor slopes. radius: |R| of the cutter, the
    largest [mm]. polygon: what stands (shapely, mm, x and c as its x and y), with chords for arcs; empty where nothing
    does. open: the polygon ends somewhere beyond the walls, where the part is unknown. gap: width of the gap that was
    closed [mm], 0 for none. tangled: the walls cross so often that they are no contour. outline: the programmed edges
    of the polygon, as lines and arcs. walls: the programmed contours, leads in offset mode included; left: bool, the
    tool runs left of each.
    sections: the numbers of all its sections. angle: of C at G12.1 [deg], which has been added where the level is in
    the frame of the part; NaN where it is not known.
    """

    section: int
    z: float
    radius: float
    polygon: Any
    open: bool
    gap: float
    tangled: bool
    outline: Outline
    walls: Curves
    left: Mask
    sections: tuple[int, ...]
    angle: float
    bottom: float


class Finished(Columns, frozen=True):
    """The finished part of one trace."""

    trace: Trace
    overcuts: Overcuts

    @cached_property
    def levels(self) -> list[Level]:
        """
        One for each section and Z with contours in offset mode whose R is known, in the order of the program.

        Raises TooHardError where their faces cannot be computed.
        """
        walls, left = self.overcuts.walls
        return self._levels_of(walls, left, level_of(self.trace, walls))

    @cached_property
    def of_part(self) -> list[Level]:
        """
        The same in the frame of the part, whose x runs towards C0: turned by C at G12.1.

        Sections at one Z on one face are one level, as flats that are cut one after another with C between them; those
        at whose beginning C is not known are levels of their own, as they are programmed.
        """
        return self._put_together(self.levels)

    @cached_property
    def of_sections_put_together(self) -> list[Level]:
        """The levels of single sections, in the frame of the part, that levels of several sections are joined from."""
        return self._parts_of(self.of_part, self.levels)

    @cached_property
    def meant_put_together(self) -> list[Level]:
        """The same for contours whose R is not known."""
        return self._parts_of(self.meant_of_part, self.meant)

    def _parts_of(self, of_part: list[Level], levels: list[Level]) -> list[Level]:
        """The levels of single sections, in the frame of the part, that levels of several sections are joined from."""
        rows = [level.walls.row for level in of_part if len(level.sections) > 1]
        together = set(np.concatenate(rows).tolist()) if rows else set()
        return [self.in_frame_of_part(level) for level in levels if int(level.walls.row[0]) in together]

    @cached_property
    def meant(self) -> list[Level]:
        """Levels of contours whose R is not known, and taken as 0: the part that the program is intended to make."""
        walls, left = self.overcuts.walls_of_unknown_radius
        return self._levels_of(walls, left, level_of(self.trace, walls))

    @property
    def has_areas(self) -> bool:
        """True once levels with polygons have been computed."""
        computed = vars(self)
        return bool(computed.get("levels") or computed.get("meant"))

    @cached_property
    def meant_of_part(self) -> list[Level]:
        """The same in the frame of the part, joined over sections."""
        return self._put_together(self.meant)

    def _put_together(self, levels: list[Level]) -> list[Level]:
        trace, knows_entry = self.trace, self.trace.path.knows_section_entry
        groups: dict[tuple[float, ...], list[Level]] = {}
        for level in levels:
            row = int(level.walls.row[0])
            face = bool(trace.modal.on_sub_spindle[row]), int(trace.modal.state("work_offset")[row])
            alone = not knows_entry[level.section] or np.isnan(level.z)
            key = (
                (*face, round(level.z, 4), round(level.radius, 1)) if not alone else (float(level.section), float(row))
            )
            groups.setdefault(key, []).append(level)
        result: list[Level] = []
        for group in groups.values():
            turned = [self.in_frame_of_part(level) for level in group]
            if len({level.section for level in group}) > 1:
                joined = self._joined(turned)
                turned = turned if joined is None else [joined]
            result += turned
        return sorted(result, key=lambda level: int(level.walls.row[0]))

    def in_frame_of_part(self, level: Level) -> Level:
        """The level turned by C at G12.1; as it is where that is not known."""
        from polarcheck.geometry.polygons.standing_metal import turned

        angle = float(self.trace.path.section_entry[level.section])
        if not self.trace.path.knows_section_entry[level.section]:
            return msgspec.structs.replace(level, angle=np.nan)
        if not angle:
            return level
        turn = np.exp(1j * np.radians(angle))
        return msgspec.structs.replace(
            level,
            polygon=turned(level.polygon, float(np.radians(angle))),
            outline=level.outline.turned_by(turn),
            walls=level.walls.turned_by(turn),
            angle=angle,
        )

    def _joined(self, levels: list[Level]) -> Level | None:
        """Levels of one Z in the frame of the part as one; None where they leave no part together."""
        from polarcheck.geometry.segments import Curves

        walls = Curves.concatenated([level.walls for level in levels])
        left = np.concatenate([level.left for level in levels])
        (joined,) = self._levels_of(walls, left, np.zeros(len(walls), np.int64))
        sections = tuple(dict.fromkeys(level.section for level in levels))
        alone = joined.tangled or not len(joined.outline)
        if alone:
            return None
        return msgspec.structs.replace(joined, sections=sections, section=sections[0], angle=levels[0].angle)

    def _levels_of(self, walls: Curves, material_left: Mask, level: Rows) -> list[Level]:
        if not len(walls):
            return []
        from polarcheck.geometry.polygons.finished_part import Contours, finished_parts

        trace = self.trace
        # Levels in the order in which the program comes to them.
        _, first, level = np.unique(level, return_index=True, return_inverse=True)
        rank = np.argsort(np.argsort(first))[level]
        radius = folded(np.maximum, rank, np.nan_to_num(np.abs(trace.compensation.radius[walls.row])), len(first), 0.0)
        begins = np.flatnonzero(np.diff(walls.loop, prepend=-1))
        order = np.argsort(rank[begins], kind="stable")
        loops, groups = walls.loop[begins][order], rank[begins][order]
        tolerance = trace.machine.compensation.overcut_tolerance
        parts = finished_parts(
            Contours(walls, material_left, loops, groups, radius, self.overcuts.bar, tolerance, True)
        )
        rows = [np.flatnonzero(rank == number) for number in range(len(radius))]
        return [self._level(parts, number, radius, walls, material_left, chosen) for number, chosen in enumerate(rows)]

    def _level(self, parts: FinishedParts, number: int, radius: Any, walls: Curves, left: Mask, chosen: Rows) -> Level:
        import shapely  # type: ignore[import-untyped]

        from polarcheck.geometry.outline import outline_of

        of_group, shift = parts.group == number, parts.pitch * number
        row = int(walls.row[chosen[0]])
        outline = outline_of(parts.start[of_group] - shift, parts.end[of_group] - shift, parts.move[of_group], walls)
        z, bottom = self._depths(walls[chosen], outline)
        return Level(
            section=int(self.trace.mode.section[row]),
            z=z,
            radius=float(radius[number]),
            polygon=shapely.transform(parts.polygon[number], lambda points: points - [shift, 0.0]),
            open=bool(parts.open[number]),
            gap=float(max(parts.gap[number], parts.beside[number])),
            tangled=bool(parts.tangled[number]),
            outline=outline,
            walls=walls[chosen],
            left=left[chosen],
            sections=(int(self.trace.mode.section[row]),),
            angle=0.0,
            bottom=bottom,
        )

    def _depths(self, walls: Curves, outline: Outline) -> tuple[float, float]:
        """
        The deepest Z at which the whole wall is cut, and the deepest of all [mm].

        A helix cuts the wall down to where its last turn begins, and down to its end where it closes on that depth.
        """
        z_before, z = self.trace.path.z_before[walls.row], self.trace.path.z[walls.row]
        first, bottom = float(z[0]), float(np.min(z))
        is_level = bool(np.all(np.abs(np.append(z, z_before) - first) <= ROUNDING))
        if is_level or np.isnan(np.append(z, z_before)).any() or not len(outline):
            return first, first
        highest = np.fmax(z_before, z)
        if walls.length[highest <= bottom + ROUNDING].sum() >= outline.length.sum() - CORNER:
            return bottom, bottom
        # The same wall in another turn, be it run the other way.
        ends = np.sort_complex(np.stack([walls.start, walls.end], axis=1).round(_SAME_WALL))
        middle = walls.points(np.arange(len(walls)), np.full(len(walls), 0.5)).round(_SAME_WALL)
        _, wall = np.unique(np.column_stack([ends, middle]), axis=0, return_inverse=True)
        wall = wall.ravel()
        cut_to = folded(np.minimum, wall, highest, int(wall.max()) + 1, np.inf)
        return float(np.max(cut_to[wall[np.isin(walls.row, outline.row)]], initial=bottom)), bottom
