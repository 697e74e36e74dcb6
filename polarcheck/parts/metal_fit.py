"""Where no contour in offset mode is there: the change of a part of the job with which what is cleared would agree."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.columns.metal.milled import Milled
from polarcheck.foundation.time_limit import keep_time
from polarcheck.parts.nominal_parts import NominalParts, is_closed
from polarcheck.parts.part_comparison import SAME_Z, Comparison, Fit

if TYPE_CHECKING:
    from polarcheck.geometry.comparison.deviation import MachinedPart

#: Outlines of the cleared area that are compared with the part.
_MOST = 4


def metal_fit(result: Comparison, nominal_parts: NominalParts, milled: Milled) -> Fit | None:
    """The change with which an outline of what is cleared would agree, or nearly agree; None if there is none."""
    from polarcheck.geometry.comparison.measured_path import path_of_curves
    from polarcheck.geometry.comparison.placements import Freedom, agrees, better_placement

    part, unit = result.part, nominal_parts.unit(result.number, result.row)
    curves = nominal_parts.curves(result.number, unit)
    rings = [number for number, curve in enumerate(curves) if is_closed(curve)]
    paths = [path_of_curves([curves[number]]) for number in sorted(rings, key=lambda number: number != result.curve)]
    freedom = Freedom(part.drawing is not None, not result.angle_not_compared, part.shape == "circle")
    fits = []
    for machined in _outlines(result, milled) if paths else ():
        keep_time()
        if any(agrees(machined, path, result.tolerance) for path in paths):  # it says nothing of the one that differs
            continue
        center = unit * complex(*part.center)
        fit = better_placement(machined, paths, center, result.difference, result.tolerance, freedom)
        if fit is not None:
            fits.append(Fit(*fit))
    return min(fits, key=lambda fit: fit.largest, default=None)


def _outlines(result: Comparison, milled: Milled) -> Iterator[MachinedPart]:
    """The closed outlines of what the largest cutter clears at the depth of a part, the longest first."""
    from polarcheck.geometry.comparison.deviation import machined_part
    from polarcheck.geometry.comparison.measured_path import path_of_outline
    from polarcheck.geometry.comparison.metal_left import polygon_of

    cuts = milled.cuts
    chosen = (cuts.frame == milled.frame_of_section[result.section]) & (cuts.low <= result.z + SAME_Z)
    if result.part.section is not None:
        chosen &= cuts.section == result.part.section - 1
    if not chosen.any():
        return
    outline = milled.cleared(chosen)[0].outline
    chains = [outline[outline.chain == number] for number in np.flatnonzero(outline.closed).tolist()]
    paths = [path_of_outline(chain) for chain in chains]
    for index in sorted(range(len(chains)), key=lambda index: -paths[index].length)[:_MOST]:
        polygon = polygon_of(np.append(paths[index].start, paths[index].start[0]))
        yield machined_part(chains[index], polygon, math.nan)
