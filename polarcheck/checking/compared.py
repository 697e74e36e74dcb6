"""The contours of a run beside what the job says they should be, as reports tell them: also those that agree."""

from __future__ import annotations

import math

import msgspec

from polarcheck.checking.phrases.drawing import told
from polarcheck.checking.quantity import rounded
from polarcheck.checking.tables import Tables
from polarcheck.table.deviations import Deviations
from polarcheck.table.trace import Trace


class PartComparison(msgspec.Struct, frozen=True):
    """
    One contour beside a drawing or a shape; lengths in mm, points [x, c] with x as a radius.

    title: the name of the drawing, or the shape. section_line: of the code that begins the section. z: of the contour,
    None if unknown. line: of the block where it differs most, at: where. too_much, cut_away: by how much, at most.
    turned: the angle of a shape that may be turned in any way [deg]. text: all of it in words, in the program's units.
    """

    title: str
    section_line: int
    z: float | None
    agrees: bool
    largest: float | None
    tolerance: float | None
    too_much: float | None
    cut_away: float | None
    at: list[float | None]
    line: int
    turned: float | None
    text: str


def compared(tables: Tables) -> list[PartComparison]:
    """
    What is compared in a run, in the order of the program, without what is only roughing; empty where the job asks for
    nothing. Raises TooHardError as the finished part does.
    """
    trace: Trace = tables["trace"]
    deviations: Deviations = tables["deviations"]
    return [
        PartComparison(
            title=one.title,
            section_line=int(trace.line[trace.sections.enter[one.section]]),
            z=rounded(one.z),
            agrees=one.agrees,
            largest=rounded(one.difference.largest),
            tolerance=rounded(one.tolerance),
            too_much=rounded(one.difference.proud),
            cut_away=rounded(one.difference.deep),
            at=[rounded(one.difference.at.real), rounded(one.difference.at.imag)],
            line=int(trace.line[one.row]),
            turned=rounded(math.degrees(one.turned)),
            text=told(trace, one),
        )
        for one in deviations.comparisons
        if not one.is_superseded
    ]
