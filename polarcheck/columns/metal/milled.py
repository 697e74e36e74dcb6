"""Cuts of mills in the frame of the part: all moves at feed of all sections, turned by C at G12.1."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.path.moves import z_along
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, Table, cached_property, is_among
from polarcheck.geometry.segments import Curves
from polarcheck.geometry.tolerances import ADJUSTMENT, ROUNDING

if TYPE_CHECKING:
    from polarcheck.geometry.polygons.cleared import Cleared

#: A tip less far below the face than this cuts nothing [mm].
_CLEARANCE = 0.01


class Cuts(Table, frozen=True):
    """
    Moves of cutters along Z at feed below the face, n of them in the order of the program.

    curves: their paths in the frame of the part, whose x runs towards C0; a Z move alone is a place. radius:
    float64[n], R [mm]. low, high: float64[n], Z of the tip [mm]. section: int[n]. frame: int[n], cuts of one frame lie
    on one plane; a section at whose beginning C is not known has a frame of its own, as it is programmed.
    """

    curves: Curves
    radius: Floats
    low: Floats
    high: Floats
    section: Rows
    frame: Rows


class Milled(Columns, frozen=True):
    """Cuts of the mills of one trace in their sections."""

    trace: Trace
    tool_center: ToolCenter
    bar: Bar

    @cached_property
    def radius(self) -> Floats:
        """R of the cutter in force [mm], NaN where it is not known or only adjusts a path."""
        offsets = self.trace.offsets
        radius = np.fmax(np.abs(offsets.radius_of_offset), offsets.cutter_diameter / 2)
        return np.where(radius > ADJUSTMENT + ROUNDING, radius, np.nan)

    @cached_property
    def frame_of_section(self) -> Rows:
        """The frame of each section: its spindle, its work offset, and where C is not known the section itself."""
        trace, enter = self.trace, self.trace.mode.sections.enter
        alone = np.where(trace.path.knows_section_entry, -1, np.arange(len(enter)))
        keys = np.stack([trace.modal.on_sub_spindle[enter], trace.modal.state("work_offset")[enter], alone], axis=1)
        _, first, number = np.unique(keys, axis=0, return_index=True, return_inverse=True)
        return np.asarray(np.argsort(np.argsort(first))[number.ravel()])

    @cached_property
    def is_alone_on_face(self) -> Mask:
        """Sections on whose face all sections have one frame; a boolean per section."""
        trace, enter = self.trace, self.trace.mode.sections.enter
        face = 1000 * trace.modal.state("work_offset")[enter] + trace.modal.on_sub_spindle[enter]
        frames = np.unique(np.stack([face, self.frame_of_section], axis=1), axis=0)[:, 0]
        return np.asarray((face[:, None] == frames).sum(axis=1) == 1)

    @cached_property
    def is_along_z(self) -> Mask:
        """Rows of tools along Z, in planes that are followed."""
        trace = self.trace
        radial = [number for number, tool in trace.tools.of_job.items() if tool.mount == "radial"]
        is_followed = trace.mode.is_followed & ~trace.mode.on_cylinder
        return np.asarray(is_followed & ~is_among(trace.tools.offset_number, radial))

    @cached_property
    def is_unknown(self) -> Mask:
        """Rows that cut, and whose R or place is not known."""
        trace, moves = self.trace, self.tool_center.moves
        cuts = trace.mode.in_polar & trace.path.cuts & self.is_along_z
        is_known = trace.blocks.mask_of(moves.row[moves.is_of_tool & ~np.isnan(moves.start + moves.end)])
        return np.asarray(cuts & (np.isnan(self.radius) | ~is_known))

    @property
    def is_drilled(self) -> bool:
        """Holes may be drilled before a section: what they take off is not known."""
        trace, first = self.trace, self.trace.mode.sections.enter
        drills = (trace.modal.drilling != 0) & (trace.mode.section < 0)
        return bool(drills[: int(first[-1])].any()) if len(first) else False

    @property
    def top(self) -> float:
        """Z of the face [mm]: that of the bar, else Z0 where a tool goes below it, else inf."""
        face = self.bar.known.face
        if not np.isnan(face):
            return face
        z = self.trace.path.z[self.trace.mode.in_polar & self.trace.path.cuts]
        return 0.0 if np.nanmin(np.append(z, np.inf)) < 0 else np.inf

    @cached_property
    def cuts(self) -> Cuts:
        """All cuts of known R and place. Where no Z is known, all are at Z0; else those of unknown Z are left out."""
        trace, moves = self.trace, self.tool_center.moves
        z_from, z_to = z_along(trace, moves)
        low, high = np.fmin(z_from, z_to), np.fmax(z_from, z_to)
        at_feed = trace.path.cuts & self.is_along_z & ~np.isnan(self.radius)
        chosen = at_feed[moves.row] & moves.is_of_tool & ~np.isnan(moves.start + moves.end)
        if np.isnan(low[chosen]).all():
            low, high = np.zeros(len(moves)), np.zeros(len(moves))
        else:
            chosen &= low < self.top - _CLEARANCE
        section = moves.section[chosen]
        chosen_moves = moves[chosen].turned_by(trace.path.section_turn[section])
        return Cuts(
            curves=Curves(*chosen_moves.shape, np.zeros(len(section), np.int64), chosen_moves.row),
            radius=self.radius[chosen_moves.row],
            low=low[chosen],
            high=high[chosen],
            section=section,
            frame=self.frame_of_section[section],
        )

    def cleared(self, chosen: Mask) -> tuple[Cleared, float]:
        """The area cleared by the largest of these cutters, and its R [mm]. Raises TooHardError as `cleared` does."""
        from polarcheck.geometry.polygons.cleared import cleared

        radius = float(self.cuts.radius[chosen].max())
        return cleared(self.cuts.curves[chosen & (self.cuts.radius == radius)], radius), radius
