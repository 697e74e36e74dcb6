"""A part of a job compared with what is made: the result, and what was compared."""

from __future__ import annotations

import cmath
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.machines.part_keys import Part

if TYPE_CHECKING:
    from polarcheck.columns.metal.finished import Level
    from polarcheck.geometry.comparison.deviation import Difference, MachinedPart
    from polarcheck.geometry.comparison.measured_path import MeasuredPath
    from polarcheck.geometry.comparison.placements import Placement
    from polarcheck.geometry.shapes.shape import Shape

#: Tolerance of a part whose job states none [mm].
TOLERANCE = 0.02
#: Depths nearer to each other than this are equal [mm]: the Z of a program in inch has four digits.
SAME_Z = 5e-3
#: Differences that are equal to this number of digits count as equal [mm].
_DIGITS = 4


class Fit(NamedTuple):
    """
    A change with which the part would agree.

    placement: the change of what the job asks for.
    largest: the largest difference after the change [mm].
    """

    placement: Placement
    largest: float


class Target(NamedTuple):
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
    way: MeasuredPath
    scale: float
    is_closed: bool
    rings: bool


class Contour(NamedTuple):
    """
    A closed contour of a level, or all open contours of a level together.

    of_one_section: parts for a section are compared with it. of_all: parts for any section are.
    """

    level: Level
    made: MachinedPart
    is_closed: bool
    is_pocket: bool
    of_one_section: bool
    of_all: bool


class Comparison(NamedTuple):
    """
    A part of the job compared with a contour, or with the metal that is left.

    number: index of the part in the job.
    part: the part of the job.
    curve: index of the curve in the drawing, -1 for all curves.
    section: number of the section of the contour.
    z: Z of the contour [mm].
    tolerance: allowed difference [mm].
    difference: of what is made from the curve, in the frame of the part.
    row: the row where the difference is largest.
    entry: C at G12.1 of the section of that row [rad], 0 where it is not known: places are written less this angle.
    turned: angle of a shape whose angle is not compared [rad], NaN for other shapes.
    angle_not_compared: why the angle is not compared; empty where it is, or where the shape has none.
    is_other_way_round: a boss where a pocket should be, or the reverse.
    is_partial: the contour is open though all drawn curves are closed; only its walls are compared.
    island: the program mills along the walls of a pocket alone: whether something stands in its middle is not known.
    is_made: cuts come near to its walls.
    is_superseded: roughing, or not the nearest contour, or it leaves material that a contour of unknown R may remove.
    contour, target: what was compared; None where only areas were.
    fit: the change with which the part would agree; None for none.
    made: what is made in its place, where only areas were compared.
    """

    number: int
    part: Part
    curve: int
    section: int
    z: float
    tolerance: float
    difference: Difference
    row: int
    entry: float = 0.0
    turned: float = float("nan")
    angle_not_compared: str = ""
    is_other_way_round: bool = False
    is_partial: bool = False
    island: bool = False
    is_made: bool = True
    is_superseded: bool = False
    contour: Contour | None = None
    target: Target | None = None
    fit: Fit | None = None
    made: tuple[Shape, ...] = ()

    @property
    def agrees(self) -> bool:
        """The difference is within the tolerance."""
        return not self.is_other_way_round and self.difference.largest <= self.tolerance + ROUNDING

    @property
    def differs(self) -> bool:
        """The difference is reported."""
        return not self.agrees and not self.is_superseded

    @property
    def row_outside(self) -> int:
        """The row that cuts outside of the round of the drawing; -1 for none."""
        outside = self.difference.outside
        return -1 if self.contour is None or outside < 0 else int(self.contour.made.outline.row[outside])

    @property
    def rank(self) -> tuple[bool, bool, float, float]:
        """The comparison of the lowest rank is the nearest; of those that are as near, the deepest."""
        return self.is_superseded, self.is_other_way_round, round(self.difference.largest, _DIGITS), self.z

    @property
    def title(self) -> str:
        """The name of the drawing, or the shape, that the contour is compared with."""
        return title_of(self.part)

    def written(self, point: complex) -> complex:
        """A point in the frame of the part as its section would write it [mm]."""
        return point * cmath.exp(-1j * self.entry)


def title_of(part: Part) -> str:
    """The name of the drawing with its layers, or the shape."""
    if part.drawing is None:
        return f"the {part.shape} asked for"
    return Path(part.drawing).name + (f" ({', '.join(part.layers)})" if part.layers else "")
