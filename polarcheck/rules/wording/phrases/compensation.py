"""Phrases of the rules about cutter compensation."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.fitting import Fitting
from polarcheck.columns.contour.overcuts import Overcuts
from polarcheck.columns.contour.passes import Passes
from polarcheck.columns.contour.senses import Senses
from polarcheck.columns.contour.slots import Slots
from polarcheck.columns.contour.uncompensated_cuts import UncompensatedCuts
from polarcheck.columns.filling import last_row
from polarcheck.columns.metal.coverage import Coverage
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.offsets import ToolOffsets
from polarcheck.columns.modes.tools import CalledTools
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.compensation import CutterCompensation
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.states import MM_PER_INCH, Motion, Side
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.quantity import in_row
from polarcheck.rules.wording.phrases.common import block_and_line, code_of, move_code, point
from polarcheck.rules.wording.phrases.drawing import deviation as deviation
from polarcheck.rules.wording.phrases.drawing import drawing as drawing
from polarcheck.rules.wording.phrases.offsets import called_tool
from polarcheck.rules.wording.phrases.offsets import offset as offset

#: Cutters in inch have radii of so many parts of an inch, to within a share of a part.
_PARTS_OF_INCH, _NEAR_PART = 64, 0.01
#: A ramp that is short by a mistake in it alone has more than R divided by this.
_SHORT = 4.0


def side(compensation: CutterCompensation, row: int) -> str:
    """G41 or G42, whichever is in force."""
    return f"G{compensation.side[row]}"


def side_in_force(lengths: Lengths, compensation: CutterCompensation, row: int) -> str:
    """G41 or G42, and a negative R, by which it is the other one."""
    radius = float(compensation.radius[row])
    return (
        f"{side(compensation, row)} with the negative R {in_row(radius, lengths, row):length}"
        if radius < 0
        else side(compensation, row)
    )


def remedy(lengths: Lengths, compensation: CutterCompensation, machine: Machine, row: int) -> str:
    """What to write for the cutter to be on the other side."""
    other = "compensation_left" if compensation.side[row] == Side.RIGHT else "compensation_right"
    radius = float(compensation.radius[row])
    shown = f", or R {in_row(-radius, lengths, row):length} in the tool offset" if radius < 0 else ""
    return f"write {code_of(machine, other)}{shown}"


def or_other_sense(trace: Trace, row: int) -> str:
    """`, or G2 for G3 of line 18`, where one code of arcs is in force in all blocks of the contour."""
    moves = np.flatnonzero(trace.path.travels)
    moves = moves[moves > row]
    leave = np.flatnonzero(~trace.compensation.compensates[moves])
    moves = moves[: leave[0]] if len(leave) else moves
    codes = trace.modal.motion_word[moves]
    if not len(moves) or trace.axes.motion[moves[0]] not in (Motion.CW, Motion.CCW) or np.any(codes != codes[0]):
        return ""
    line = int(trace.blocks.line[moves[0]])
    first = int(moves[0])
    written, other = written_sense(trace.axes, trace.machine, first), other_sense(trace.axes, trace.machine, first)
    return f", or {other} for {written} of line {line}"


def cancel(machine: Machine) -> str:
    """G40."""
    return code_of(machine, "compensation_off")


def before(compensation: CutterCompensation, row: int) -> str:
    """G41 or G42, whichever was in force before."""
    return f"G{compensation.side_before[row]}"


def changed_by(tools: CalledTools, run: Run, machine: Machine, row: int) -> str:
    """T0808, `T8 edge 2`, G10 or #2001."""
    if row in run.assigned:
        return run.assigned[row].name
    if tools.calls_offset[row]:
        return called_tool(tools, row)
    return machine.codes("data_input")[0]


def has_nose(blocks: ExecutedBlocks, offsets: ToolOffsets, run: Run, row: int) -> str:
    """Where the program has set the nose type of the offset in force: `is set to`, else `has`."""
    setter = int(offsets.nose_set_in[row])
    return f"is set by {block_and_line(blocks, run, setter)} to" if setter >= 0 else "has"


def allowed(machine: Machine) -> str:
    """The nose types that a mill may have."""
    return " or ".join(str(number) for number in machine.compensation.nose_types)


def start_up(blocks: ExecutedBlocks, path: ProgrammedPath, row: int) -> int:
    """The line of the next move on the plane."""
    return int(blocks.line[row + int(np.argmax(path.travels[row:]))])


def misfit(lengths: Lengths, compensation: CutterCompensation, tool_center: ToolCenter, row: int, count: int) -> str:
    """Why the tool center runs backwards in a row, or in several for the same reason."""
    radius = f"{in_row(abs(float(compensation.radius[row])), lengths, row):length}"
    if not tool_center.interferes_by_rounding[row]:
        return f"the contour is too narrow or too short for R {radius}"
    others = f" and {count - 1} more" if count > 1 else ""
    return (
        f"blocks shorter than their rounding allows with R {radius}, this one{others}; "
        "write longer blocks or arcs, as with a coarser chord tolerance of the post, or more digits"
    )


def written_sense(axes: PlaneAxes, machine: Machine, row: int) -> str:
    """G2 or G3, whichever is in force."""
    return move_code(machine, "arc_clockwise" if axes.motion[row] == Motion.CW else "arc_counterclockwise")


def other_sense(axes: PlaneAxes, machine: Machine, row: int) -> str:
    """The other one."""
    return move_code(machine, "arc_counterclockwise" if axes.motion[row] == Motion.CW else "arc_clockwise")


def corner_of_sense(senses: Senses, passes: Passes, row: int) -> str:
    """The turn at the ends of an arc [deg], in whole degrees."""
    return f"{corner_of_arc(senses, passes, row):.0f}"


def corner_of_arc(senses: Senses, passes: Passes, row: int) -> float:
    """The turn at the ends of an arc [deg], the smaller one where both are known."""
    corner = float(senses.corner[row])
    if np.isnan(corner):
        at = int(np.flatnonzero(passes.row == row)[0])
        corner = float(np.degrees(np.nanmax(np.abs([turn[at] for turn in passes.turns]))))
    return corner


def fit_of_sense(senses: Senses, row: int) -> str:
    """How an arc lies in its contour the other way round."""
    if senses.fits_reversed[row]:
        return "is tangent to the blocks before and after it"
    return "lies on one circle with the other arcs"


def _along(axes: PlaneAxes, lengths: Lengths, path: ProgrammedPath, row: int, length: float, other: float) -> str:
    """
    A way on the plane as the program writes it: along X on the diameter, else as it is; other: another way, from which
    it can be told.
    """
    shown, beside = in_row(length, lengths, row), in_row(other, lengths, row)
    start, end = path.start[row], path.end[row]
    if start.imag == end.imag and start != end and shown.diameter:
        return f"{shown.beside(beside, 'diameter')} in X on the diameter"
    virtual = f" in {axes.virtual_axis_of(row)}" if start.real == end.real and start != end else ""
    return f"{shown.beside(beside, 'length')}{virtual}"


def fault(trace: Trace, row: int) -> str:
    """What is wrong with a ramp that is shorter than R, or never comes."""
    if not trace.path.travels[row]:
        code = (
            trace.machine.codes("compensation_off")[0]
            if trace.compensation.writes_cancel[row]
            else side(trace.compensation, row)
        )
        present = " that leads from the present position" if trace.axes.moves_plane[row] else ""
        return f"is missing: no move on the plane{present} follows {code}"
    radius = abs(float(trace.compensation.radius[row]))
    shown = in_row(radius, trace.lengths, row)
    length = float(trace.path.length[row])
    moved, needed = (
        _along(trace.axes, trace.lengths, trace.path, row, length, radius),
        _along(trace.axes, trace.lengths, trace.path, row, radius, length),
    )
    setter = int(trace.offsets.radius_set_in[row])
    of_program = (
        f", set by {block_and_line(trace.blocks, trace.run, setter)}," if setter >= 0 else _of_offset(trace, row)
    )
    given = shown.beside(in_row(length, trace.lengths, row), "length")
    return f"moves {moved}; with R {given}{of_program} it needs {needed}{_in_inch(trace, row)}"


def _of_offset(trace: Trace, row: int) -> str:
    """` of T0305 in line 7`, where the tool and its offset have two numbers."""
    tools = trace.tools
    if not 0 < tools.tool[row] != tools.offset_number[row] or tools.has_edges[row]:
        return ""
    calls = int(last_row(tools.calls_offset, trace.blocks.starts)[row])
    return f" of {called_tool(tools, row)} in line {int(trace.blocks.line[calls])}" if calls >= 0 else ""


def _in_inch(trace: Trace, row: int) -> str:
    """That a ramp would be long enough in inch, where no code of the unit stands above it, and R is a size in inch."""
    inch, radius = code_of(trace.machine, "inch"), abs(float(trace.compensation.radius[row]))
    ratio, parts = radius / float(trace.path.length[row] or np.inf), radius / MM_PER_INCH * _PARTS_OF_INCH
    if not _SHORT < ratio <= MM_PER_INCH or abs(parts - round(parts)) > _NEAR_PART:
        return ""
    if trace.lengths.scale[row] != 1.0 or np.any(trace.modal.sets("units")[: row + 1]):
        return ""
    metric = code_of(trace.machine, "mm")
    return f"; neither {inch} nor {metric} stands above it: in inch it would be long enough"


def ramp_at_rest(trace: Trace, row: int) -> str:
    """What is said of a start-up whose G41 or G42 stands in a block before it that moves nowhere; empty for others."""
    writes = np.flatnonzero(trace.compensation.writes_side[: row + 1])
    at = int(writes[-1]) if len(writes) else row
    is_idle = trace.axes.moves_plane[at] and not trace.path.travels[at] and trace.mode.in_polar[at]
    if at == row or not is_idle or not trace.compensation.starts_up[row]:
        return ""
    line = int(trace.blocks.line[at])
    return f"; {side(trace.compensation, row)} of line {line} moves nowhere, so that this block is the ramp"


def why(trace: Trace, row: int) -> str:
    """What keeps the control from knowing the move behind the one that ends perpendicular in time."""
    move, following, stop = _until_next_move(trace, row)
    if stop >= 0:
        return f"line {trace.blocks.line[stop]} stops reading ahead"
    count = following - move - 1
    least = trace.machine.compensation.read_ahead - 2
    if move != row:
        rest = f", and {count} blocks behind that move make none on the plane" if count > 1 else ""
        return f"this block moves nowhere, its point is that of the block before{rest}: delete it or correct its words"
    many = f"{count} blocks" if count > 1 else "a block"
    return f"{many} without a move on the plane follow{'' if count > 1 else 's'}, this control reads past {least}"


def blocks_without_move(trace: Trace, row: int) -> int | None:
    """How many blocks without a move on the plane follow the last move; None where one of them stops reading ahead."""
    move, following, stop = _until_next_move(trace, row)
    return following - move - 1 if stop < 0 else None


def _until_next_move(trace: Trace, row: int) -> tuple[int, int, int]:
    """The last row with a move up to a row, the next one, and the first between that stops reading ahead, or -1."""
    blocks, path = trace.blocks, trace.path
    move = _move(path, row)
    following = move + 1
    while following < len(blocks) and trace.mode.in_polar[following] and not path.length[following] > 0:
        following += 1
    stops = np.flatnonzero(blocks.codes(*trace.machine.m_codes.stops_reading_ahead)[move:following])
    return move, following, move + int(stops[0]) if len(stops) else -1


def move_before(trace: Trace, row: int) -> str:
    """The block that ends perpendicular: this one, or one before it."""
    move = _move(trace.path, row)
    return "this block" if move == row else f"line {int(trace.blocks.line[move])}"


def _move(path: ProgrammedPath, row: int) -> int:
    """The last row with a move on the plane, up to a row."""
    return int(np.flatnonzero(path.travels[: row + 1])[-1])


def place(blocks: ExecutedBlocks, axes: PlaneAxes, lengths: Lengths, overcuts: Overcuts, row: int) -> str:
    """Where the row cuts deepest, and into which line."""
    return _contour_at(blocks, axes, lengths, row, *overcuts.cuts.deepest(row))


def swept(blocks: ExecutedBlocks, axes: PlaneAxes, lengths: Lengths, overcuts: Overcuts, slots: Slots, row: int) -> str:
    """The same for the ramp in the row."""
    own = overcuts.sweep_depth[row] >= slots.sweep_depth[row]
    return _contour_at(blocks, axes, lengths, row, *(overcuts if own else slots).sweeps.deepest(row))


def _contour_at(blocks: ExecutedBlocks, axes: PlaneAxes, lengths: Lengths, row: int, into: int, place: complex) -> str:
    """A place on the contour, as the program would write it, and the line of the contour."""
    return f"the contour of line {int(blocks.line[into])} at {point(axes, lengths, place, row)}"


def way_out(lengths: Lengths, fitting: Fitting, row: int) -> str:
    """What to write where the contour is cut into; nothing where finding that out would take too long."""
    try:
        never, largest = bool(fitting.never[row]), float(fitting.radius[row])
    except TooHardError:
        return ""
    if never:
        return "; a smaller one does, too: look for a wrong point of the contour"
    if largest != largest:  # NaN
        return ""
    shown = in_row(int(largest * 1000) / 1000, lengths, row)
    return f"; the contour has room for R {shown:length} at most"


def opposite(blocks: ExecutedBlocks, axes: PlaneAxes, lengths: Lengths, slots: Slots, row: int) -> str:
    """Where the row cuts deepest into the contour of another loop."""
    return _contour_at(blocks, axes, lengths, row, *slots.cuts.deepest(row))


def room(blocks: ExecutedBlocks, lengths: Lengths, slots: Slots, row: int) -> str:
    """How much room the contour of another loop leaves beside the row."""
    into, _ = slots.cuts.deepest(row)
    line, other_line = int(blocks.line[row]), int(blocks.line[into])
    width, across = slots.width(row), float(slots.diameter[row])
    if width >= across:
        return f"line {other_line} leaves no room to go round the corner of line {line}"
    shown = in_row(width, lengths, row).beside(in_row(across, lengths, row), "length")
    return f"lines {line} and {other_line} leave {shown}"


def smaller(lengths: Lengths, slots: Slots, row: int) -> str:
    """The cutter to take instead."""
    width, across = slots.width(row), float(slots.diameter[row])
    if width >= across:
        return "a smaller cutter"
    return f"a cutter of {in_row(width, lengths, row).beside(in_row(across, lengths, row), 'length')} at most"


def bare(axes: PlaneAxes, machine: Machine, row: int) -> str:
    """The code of a move without compensation."""
    key = {Motion.RAPID: "rapid", Motion.LINE: "line", Motion.CW: "arc_clockwise", Motion.CCW: "arc_counterclockwise"}
    return f"{machine.codes(key[Motion(int(axes.motion[row]))])[0]} without compensation"


def from_point(
    blocks: ExecutedBlocks, axes: PlaneAxes, lengths: Lengths, path: ProgrammedPath, mode: PolarMode, row: int
) -> str:
    """` from X32. C0 of line 7`, where a move begins whose start is not that of a cut in the mode."""
    at = int(last_row(blocks.has("X", "U"), blocks.starts)[row - 1]) if row else -1
    if at < 0 or mode.in_polar[at] or not mode.in_polar[row] or not path.travels[row]:
        return ""
    return f" from {point(axes, lengths, complex(path.start[row]), row)} (line {int(blocks.line[at])})"


def way_round(blocks: ExecutedBlocks, axes: PlaneAxes, machine: Machine, row: int) -> str:
    """What to write where a move without compensation leads through the part."""
    if axes.motion[row] == Motion.RAPID and not blocks.listed("rapid")[row] and blocks.has("F")[row]:
        return (
            f"{machine.codes('rapid')[0]} is still in force: write {machine.codes('line')[0]} here, or retract Z first"
        )
    return "retract Z above the part first, or go round it"


def goes(
    mode: PolarMode,
    lengths: Lengths,
    path: ProgrammedPath,
    compensation: CutterCompensation,
    uncompensated_cuts: UncompensatedCuts,
    row: int,
) -> str:
    """How far a move without compensation goes into the part."""
    depth, radius = float(uncompensated_cuts.depth[row]), abs(float(compensation.radius[row]))
    if depth >= radius:
        return "leads through" if path.travels[row] or not mode.in_polar[row] else "goes down into"
    return f"goes {in_row(depth, lengths, row):length} deep into"


def cut_part(
    blocks: ExecutedBlocks,
    axes: PlaneAxes,
    lengths: Lengths,
    path: ProgrammedPath,
    uncompensated_cuts: UncompensatedCuts,
    row: int,
) -> str:
    """The part that a move without compensation cuts, and where."""
    into, place = uncompensated_cuts.cuts.deepest(row)
    at = point(axes, lengths, place, row)
    z = f"{in_row(float(path.z[row]), lengths, row):length}".split()[0]
    return f"the part that the contour of line {int(blocks.line[into])} leaves, at {at} Z{z}"


def contour_end(axes: PlaneAxes, lengths: Lengths, path: ProgrammedPath, row: int) -> str:
    """The point to which the row leads."""
    return point(axes, lengths, complex(path.end[row]), row)


def contour_start(axes: PlaneAxes, lengths: Lengths, coverage: Coverage, row: int) -> str:
    """The point at which the contour that ends in the row began."""
    return point(axes, lengths, complex(coverage.begins[row]), row)


def line_of_start(blocks: ExecutedBlocks, path: ProgrammedPath, coverage: Coverage, row: int) -> int:
    """The line of the move that leads to the start of the contour that ends in the row."""
    first = int(coverage.begins_in[row])
    before = np.flatnonzero(path.travels[:first])
    return int(blocks.line[before[-1] if len(before) else first])


def left(axes: PlaneAxes, lengths: Lengths, compensation: CutterCompensation, coverage: Coverage, row: int) -> str:
    """What is left standing beside the row, and what to write."""
    ribs, strips = coverage.ribs, coverage.strips
    radius = abs(float(compensation.radius_of_move[row]))
    if strips.height[row] > ribs.height[row]:
        thickness, place = float(strips.height[row]), point(axes, lengths, complex(strips.place[row]), row)
        apart, most = (in_row(length, lengths, row) for length in (2 * radius + thickness, 2 * radius))
        return (
            f"a strip {in_row(thickness, lengths, row):length} thick stays at {place} between passes {apart:length} "
            f"apart: with R {in_row(radius, lengths, row):length} write passes that are {most:length} apart at most"
        )
    height, width = (in_row(float(column[row]), lengths, row) for column in (ribs.height, ribs.width))
    place = point(axes, lengths, complex(ribs.place[row]), row)
    more = "more than " if ribs.height[row] >= 2 * radius else ""
    return (
        f"a rib {more}{height:length} high stays on the contour at {place}, "
        f"where no tool touches it: let the contour go on {width:length} farther beyond its start before the tool "
        "leaves it"
    )
