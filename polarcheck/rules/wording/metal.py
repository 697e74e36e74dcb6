"""The bar, and where a tool goes into metal."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.workpiece import Workpiece
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.hit import Hit


def bar_in_words(hit: Hit, bar: Bar, height: float) -> str:
    """The bar at a height (Z of bar.trace), and what says so: `40 mm, [stock]`, `27.7 mm turned in line 11`."""
    standing = bar.standing(hit.row, height)[-1]
    size, (first, last) = hit.length(standing.diameter), standing.lines
    if standing.source == "turning":
        return f"{size} turned in {f'line {first}' if first == last else f'lines {first} to {last}'}"
    return f"{size}, [stock]" if standing.source == "job" else f"{size}, comment in line {first}"


def bar_diameter(hit: Hit, bar: Bar, height: float) -> float:
    """The diameter of the bar at a height, as Z of bar.trace is [mm]."""
    return bar.standing(hit.row, height)[-1].diameter


def bar_ends_at(hit: Hit, bar: Bar) -> float:
    """The radius of the bar at the depth of the block, the larger where there are two [mm]."""
    rows, z = np.array([hit.row]), bar.trace.path.z[[hit.row]]
    return float(np.where(np.isnan(bar.outer(rows, z)), bar.inner(rows, z), bar.outer(rows, z))[0])


def of_line(trace: Trace, writes: Mask, until: int, row: int = -1) -> str:
    """` of line 7`: the last row up to `until` that writes something, where that is not `row` itself."""
    at = int(last_row(writes, trace.blocks.starts)[until]) if until >= 0 else -1
    return f" of line {int(trace.blocks.line[at])}" if 0 <= at != row else ""


def height_of_move(upright: Trace, row: int) -> float:
    """The height at which the tool is in the way: before the block where it rises, or is not known behind it."""
    before, after = float(upright.path.z_before[row]), float(upright.path.z[row])
    return before if after > before or np.isnan(after) else after


def z_of_move(upright: Trace, row: int) -> float:
    """The same as Z that a program writes."""
    return height_of_move(upright, row) * upright.path.z_sense


def height_in_words(hit: Hit, upright: Trace) -> str:
    """Z at which the cutter is in the way, and the line that says so: `at Z-4 of line 7`, on a way up `up from Z-4`."""
    path, row = upright.path, hit.row
    rises = path.z[row] > path.z_before[row]
    is_before = bool(rises or np.isnan(path.z[row]))
    where = of_line(hit.trace, hit.trace.axes.commands_z, row - is_before, row)
    return f"{'up from' if rises else 'at'} Z{hit.number(z_of_move(upright, row))}{where}"


def through(hit: Hit, workpiece: Workpiece) -> str:
    """`through`, or `if X moves first, through`, of a move of several axes at once."""
    may_miss = workpiece.may_miss_part if workpiece.hits_part[hit.row] else workpiece.may_miss_bar
    return "(if X is faster than Z or C) through" if may_miss[hit.row] else "through"


def turret_at_depth(hit: Hit, upright: Trace, bar: Bar, row: int) -> str:
    """`, and the turret turns beside the part at Z-5`: a T word calls another tool with the cutter below the face."""
    face = 0.0 if np.isnan(bar.known.face) else bar.known.face
    if not (hit.trace.tools.changes_tool[row] and upright.path.z_before[row] < face - ROUNDING):
        return ""
    return f", and the turret turns beside the part at Z{hit.number(hit.trace.path.z_before[row])}"
