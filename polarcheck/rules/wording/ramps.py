"""Start-ups and offset cancels, as messages name them, and what is wrong with them."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import last_row
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.rules.hit import Hit
from polarcheck.rules.wording.offsets import called_tool
from polarcheck.rules.wording.written import block_and_line, code_of

#: Cutters in inch have radii of so many parts of an inch, to within a share of a part.
_PARTS_OF_INCH, _NEAR_PART = 64, 0.01
#: A ramp that is short by a mistake in it alone has more than R divided by this.
_SHORT = 4.0


def next_row(mask: Mask, row: int) -> int:
    """The first row of a mask behind a row; the row itself where there is none."""
    behind = mask[row + 1 :]
    return row + 1 + int(behind.argmax()) if behind.any() else row


def ramp_length(hit: Hit) -> float:
    """The length of a ramp; 0 for one that never comes."""
    path = hit.trace.path
    return float(path.length[hit.row]) if path.travels[hit.row] else 0.0


def short_ramp(hit: Hit) -> str:
    """What is wrong with a ramp that is shorter than R, or never comes."""
    trace, row = hit.trace, hit.row
    if not trace.path.travels[row]:
        is_cancel = trace.compensation.writes_cancel[row]
        code = trace.machine.codes("compensation_off")[0] if is_cancel else hit.side
        present = " that leads from the present position" if trace.axes.moves_plane[row] else ""
        return f"is missing: no move on the plane{present} follows {code}"
    radius, length = hit.radius, float(trace.path.length[row])
    setter = int(trace.offsets.radius_set_in[row])
    of_program = f", set by {block_and_line(trace, setter)}," if setter >= 0 else _of_offset(trace, row)
    given = hit.quantity(radius).beside(hit.quantity(length), "length")
    moves, needs = _along(hit, length, radius), _along(hit, radius, length)
    others = _in_inch(trace, row, radius) + increments_in_force(hit)
    return f"moves {moves}; with R {given}{of_program} it needs {needs}{others}"


def _along(hit: Hit, length: float, other: float) -> str:
    """
    A way on the plane as the program writes it: along X on the diameter, else as it is; other: another way, from which
    it can be told.
    """
    shown, beside = hit.quantity(length), hit.quantity(other)
    start, end = hit.trace.path.start[hit.row], hit.trace.path.end[hit.row]
    if start.imag == end.imag and start != end and shown.diameter:
        return f"{shown.beside(beside, 'diameter')} in X on the diameter"
    virtual = f" in {hit.virtual}" if start.real == end.real and start != end else ""
    return f"{shown.beside(beside, 'length')}{virtual}"


def _of_offset(trace: Trace, row: int) -> str:
    """` of T0305 in line 7`, where the tool and its offset have two numbers."""
    tools = trace.tools
    if not 0 < tools.tool[row] != tools.offset_number[row] or tools.has_edges[row]:
        return ""
    calls = int(last_row(tools.calls_offset, trace.blocks.starts)[row])
    return f" of {called_tool(tools, row)} in line {int(trace.blocks.line[calls])}" if calls >= 0 else ""


def _in_inch(trace: Trace, row: int, radius: float) -> str:
    """That a ramp would be long enough in inch, where no code of the unit stands above it, and R is a size in inch."""
    ratio, parts = radius / float(trace.path.length[row] or np.inf), radius / MM_PER_INCH * _PARTS_OF_INCH
    if not _SHORT < ratio <= MM_PER_INCH or abs(parts - round(parts)) > _NEAR_PART:
        return ""
    if trace.lengths.scale[row] != 1.0 or np.any(trace.modal.sets("units")[: row + 1]):
        return ""
    inch, metric = code_of(trace.machine, "inch"), code_of(trace.machine, "mm")
    return f"; neither {inch} nor {metric} stands above it: in inch it would be long enough"


def ramp_at_rest(hit: Hit) -> str:
    """What is said of a start-up whose G41 or G42 stands in a block before it that moves nowhere; empty for others."""
    trace, row = hit.trace, hit.row
    writes = np.flatnonzero(trace.compensation.writes_side[: row + 1])
    at = int(writes[-1]) if len(writes) else row
    is_idle = trace.axes.moves_plane[at] and not trace.path.travels[at] and trace.mode.in_polar[at]
    if at == row or not is_idle or not trace.compensation.starts_up[row]:
        return ""
    return f"; {hit.side} of line {hit.line(at)} moves nowhere, so that this block is the ramp"


def line_before(hit: Hit, said: str = " of") -> str:
    """` of line 12`: the block that has brought the cutter to where a move begins; empty for the block above it."""
    path, rows = hit.trace.path, np.arange(hit.row)
    moves = np.flatnonzero((path.travels | path.moves_x | path.moves_c)[rows])
    return f"{said} line {hit.line(int(moves[-1]))}" if len(moves) and moves[-1] < hit.row - 1 else ""


def start_of_ramp(hit: Hit) -> str:
    """`; it begins at X8.602 C0 of line 12`, of a start-up before which another block than the one above moves."""
    line = line_before(hit) if hit.trace.compensation.starts_up[hit.row] else ""
    return line and f"; it begins at {hit.point(complex(hit.trace.path.start[hit.row]))}{line}"


def increments_in_force(hit: Hit) -> str:
    """
    `; G91 of line 11 is still in force: write G90 if X36. is a position`, where a block above wrote the code and the
    program writes G90, too; else nothing.
    """
    trace, row = hit.trace, hit.row
    blocks, modal = trace.blocks, trace.modal
    address = next((name for name in (hit.linear, hit.virtual) if blocks.has(name)[row]), "")
    if not address or not modal.incremental[row] or modal.sets("distance")[row]:
        return ""
    code, needed = code_of(trace.machine, "incremental"), code_of(trace.machine, "absolute")
    if not np.any(blocks.anywhere_in_program(blocks.listed("absolute"))[row]):
        return ""
    line = hit.line(int(np.flatnonzero(modal.sets("distance")[:row])[-1]))
    return f"; {code} of line {line} is still in force: write {needed} if {hit.written(address)} is a position"


def wrong_by(hit: Hit) -> str:
    """By how much the walls are off that are milled without compensation."""
    radius = abs(float(hit.trace.offsets.radius_of_offset[hit.row]))
    return "off by R" if np.isnan(radius) else f"off by R {hit.length(radius)}"
