"""The parts that a job asks for: their curves in mm, their tolerances, and whether their angle can be compared."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Points, cached_property, is_among
from polarcheck.parts.part_comparison import SAME_Z, TOLERANCE
from polarcheck.program.machines.job import Job
from polarcheck.program.machines.part_keys import DrawnPart, Part

if TYPE_CHECKING:
    from polarcheck.geometry.comparison.gaps import Gap

#: How much farther than what is asked for the metal reaches where the bar is not known, as a share.
BEYOND = 1.02
#: Points farther than this [mm] beyond the round that flats are milled on are the path in the air.
ON_ROUND = 0.1


class NominalParts(Columns, frozen=True):
    """The parts of the job of one run."""

    trace: Trace
    job: Job

    @property
    def parts(self) -> tuple[Part, ...]:
        """What the job asks for; none where the program has no polar section."""
        return tuple(self.job.part) if len(self.trace.mode.sections) else ()

    @cached_property
    def in_offset_mode(self) -> Mask:
        """Rows in offset mode in the sections for which the job states a part."""
        sections = [part.section for part in self.job.part]
        if not sections:
            return np.zeros(len(self.trace), bool)
        mask: Mask = self.trace.compensation.offset_mode.copy()
        if None not in sections:
            mask &= is_among(self.trace.mode.section + 1, [number or 0 for number in sections])
        return mask

    def unit(self, number: int, row: int) -> float:
        """The length of a unit of a part [mm]; a drawing without units has those of the program in that row."""
        part = self.job.part[number]
        if isinstance(part, DrawnPart):
            return float(self.trace.lengths.scale[row]) if math.isnan(part.scale) else part.scale
        return self.job_unit(row)

    def job_unit(self, row: int) -> float:
        """The length of a unit of the job [mm]."""
        return float(np.broadcast_to(self.trace.lengths.job_scale, len(self.trace))[row])

    def tolerance(self, number: int, row: int) -> float:
        """The tolerance of a part [mm]."""
        stated = self.job.part[number].tolerance * self.job_unit(row)
        return TOLERANCE if math.isnan(stated) else stated

    def z(self, number: int, row: int) -> float:
        """The Z that is stated [mm], NaN for none."""
        return self.job.part[number].z * self.job_unit(row)

    def z_tolerance(self, number: int, row: int) -> float:
        """How far a depth may lie from the Z that is stated [mm]: the tolerance of the part, TOLERANCE at most."""
        return max(SAME_Z, min(self.tolerance(number, row), TOLERANCE))

    def curves(self, number: int, unit: float) -> list[Points]:
        """The curves of a part [mm], closed ones with their first point once more at the end."""
        part = self.job.part[number]
        if isinstance(part, DrawnPart):
            return [np.array(curve, complex) * complex(unit) for curve in part.curves]
        from polarcheck.parts.nominal_curves import curves_of

        return curves_of(part, unit)

    def gap(self, number: int, row: int) -> Gap | None:
        """The widest gap of a drawing whose curves are rings but for gaps; None for others."""
        unit = self.unit(number, row)
        key = number, unit
        if key not in self._gaps:
            from polarcheck.geometry.comparison.gaps import widest_gap

            is_drawn = self.job.part[number].drawing is not None
            self._gaps[key] = widest_gap(self.curves(number, unit)) if is_drawn else None
        return self._gaps[key]

    @cached_property
    def _gaps(self) -> dict[tuple[int, float], Gap | None]:
        return {}

    def certain_metal(self, number: int, unit: float) -> float:
        """
        The radius up to which metal is certain where flats or a slot have no end [mm]: a little more than the distance
        of the farthest wall; inf for other parts.
        """
        part = self.job.part[number]
        if part.shape == "slot" and math.isnan(part.length):
            center = abs(complex(*part.center))
            return BEYOND * unit * (part.width / 2 + center)
        if part.shape in ("flat", "flats") and math.isnan(part.diameter):
            return BEYOND * unit * part.apothem
        return math.inf

    def air(self, number: int, unit: float) -> float:
        """The radius beyond which only walls are compared, not the path between them [mm]; inf for none."""
        part = self.job.part[number]
        if part.shape in ("flat", "flats") and not math.isnan(part.diameter):
            return part.diameter / 2 * unit + ON_ROUND
        return self.certain_metal(number, unit)

    def entry(self, row: int) -> float:
        """C at the beginning of the section of a row [rad], 0 where it is not known."""
        section = int(self.trace.mode.section[row])
        is_known = section >= 0 and self.trace.path.knows_section_entry[section]
        return math.radians(float(self.trace.path.section_entry[section])) if is_known else 0.0

    def angle_not_compared(self, number: int, section: int) -> str:
        """Why the angle of a part is not compared in a section; empty where it is, or where the part has none."""
        part = self.job.part[number]
        if part.shape == "circle":
            return ""
        if part.drawing is None and math.isnan(part.turned):
            return "[[part]] has no turned"
        if not self.trace.path.knows_section_entry[section]:
            line = int(self.trace.blocks.line[self.trace.mode.sections.enter[section]])
            return f"C at line {line} is not known"
        return ""


def is_closed(curve: Points) -> bool:
    """A curve ends where it begins, and encloses an area."""
    return len(curve) > 3 and bool(curve[0] == curve[-1])
