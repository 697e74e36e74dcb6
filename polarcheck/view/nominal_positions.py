"""
What the job asks for, drawings and shapes, where it lies on the face of a section.

Import late: shapely is slow to import.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely  # type: ignore[import-untyped]

from polarcheck.foundation.arrays import Points, side_by_side
from polarcheck.foundation.errors import TooHardError
from polarcheck.parts.deviations import Deviations
from polarcheck.parts.nominal_parts import NominalParts
from polarcheck.parts.part_comparison import Comparison, title_of
from polarcheck.program.machines.part_keys import Part
from polarcheck.rules.tables import Tables
from polarcheck.view.drawn_moves import LENGTH
from polarcheck.view.part_rings import Ring
from polarcheck.view.picture_data import DrawnPart

#: The most points of all curves of a part.
_MOST = 20_000


def drawn_parts(tables: Tables, section: int, tolerance: float) -> list[DrawnPart]:
    """
    Return what the job asks for in a section, as its section writes it, within a tolerance [mm].

    A part that was compared stands as often as that, for each contour once, turned as it was compared.
    """
    nominal: NominalParts = tables["nominal_parts"]
    if not nominal.parts:
        return []
    deviations: Deviations = tables["deviations"]
    try:
        compared = [
            comparison
            for comparison in deviations.comparisons
            if comparison.section == section and not comparison.is_superseded
        ]
    except TooHardError:
        compared = []
    drawn: list[DrawnPart] = []
    for number, part in enumerate(nominal.parts):
        if part.section not in (None, section + 1):
            continue
        curves = nominal.curves(number, nominal.unit(number, int(nominal.trace.mode.sections.enter[section])))
        of_part = [*_nearest([comparison for comparison in compared if comparison.number == number])]
        for comparison in of_part or (None,):
            drawn.append(_drawn(nominal, section, part, curves, comparison, tolerance))
    return drawn


def _nearest(compared: Sequence[Comparison]) -> list[Comparison]:
    """Return of the comparisons of a part one for each way in which it is turned, the worst of them."""
    worst: dict[float, Comparison] = {}
    for comparison in sorted(compared, key=lambda comparison: comparison.agrees):
        worst.setdefault(round(float(np.nan_to_num(comparison.turned)), 6), comparison)
    return list(worst.values())


def _drawn(
    nominal: NominalParts,
    section: int,
    part: Part,
    curves: Sequence[Points],
    comparison: Comparison | None,
    tolerance: float,
) -> DrawnPart:
    row = int(nominal.trace.mode.sections.enter[section])
    angle = -nominal.entry(row) if comparison is None else float(np.nan_to_num(comparison.turned)) - comparison.entry
    rings: list[Ring] = []
    lines: list[Ring] = []
    while sum(map(len, curves)) > _MOST and tolerance < np.inf:
        curves = [_simplified(curve, tolerance) for curve in curves]
        tolerance *= 2
    for curve in curves:
        point = curve * np.exp(1j * angle)
        points = list(side_by_side(np.round(point.real, LENGTH), np.round(point.imag, LENGTH)))
        is_closed = len(points) > 3 and points[0] == points[-1]
        (rings if is_closed else lines).append(points[:-1] if is_closed else points)
    agrees = None if comparison is None else comparison.agrees
    z = None if comparison is None or np.isnan(comparison.z) else round(comparison.z, LENGTH)
    return DrawnPart(title=title_of(part), z=z, agrees=agrees, rings=rings, lines=lines)


def _simplified(curve: Points, tolerance: float) -> Points:
    line = shapely.simplify(shapely.LineString(np.column_stack([curve.real, curve.imag])), tolerance)
    point = shapely.get_coordinates(line)
    return np.asarray(point[:, 0] + 1j * point[:, 1])
