"""Phrases of the rules about the metal."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.pass_depths import PassDepths
from polarcheck.columns.filling import last_row
from polarcheck.columns.metal.air_cuts import AirCuts, Reason
from polarcheck.columns.metal.bar import Bar
from polarcheck.columns.metal.workpiece import Workpiece
from polarcheck.columns.modes.blocks import ExecutedBlocks
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.lengths import Lengths
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask
from polarcheck.foundation.states import Motion
from polarcheck.program.execution.run import Run
from polarcheck.rules.places import block_in_line
from polarcheck.rules.quantity import in_row
from polarcheck.rules.wording.phrases.comments import comment_on_part as comment_on_part
from polarcheck.rules.wording.phrases.comments import quoted as quoted
from polarcheck.rules.wording.phrases.comments import what_is_made as what_is_made
from polarcheck.rules.wording.phrases.common import code_of
from polarcheck.rules.wording.phrases.misplaced import block_before as block_before
from polarcheck.rules.wording.phrases.misplaced import cancel as cancel
from polarcheck.rules.wording.phrases.misplaced import contour_end_there as contour_end_there
from polarcheck.rules.wording.phrases.misplaced import early_cancel as early_cancel
from polarcheck.rules.wording.phrases.misplaced import leads_where as leads_where
from polarcheck.rules.wording.phrases.misplaced import left_or_right as left_or_right
from polarcheck.rules.wording.phrases.misplaced import line_of_end as line_of_end
from polarcheck.rules.wording.phrases.misplaced import ramp_end as ramp_end
from polarcheck.rules.wording.phrases.misplaced import side as side
from polarcheck.rules.wording.phrases.misplaced import to_position as to_position
from polarcheck.rules.wording.phrases.misplaced import turned as turned
from polarcheck.rules.wording.phrases.misplaced import where_ramps_belong as where_ramps_belong
from polarcheck.rules.wording.phrases.misplaced import where_to_begin as where_to_begin
from polarcheck.rules.wording.phrases.misplaced import wrong_by as wrong_by
from polarcheck.rules.wording.phrases.misplaced import x_meant as x_meant
from polarcheck.rules.wording.phrases.misplaced import x_of_ramp as x_of_ramp
from polarcheck.rules.wording.phrases.passes import crosses_line as crosses_line
from polarcheck.rules.wording.phrases.passes import drift as drift
from polarcheck.rules.wording.phrases.passes import end_of_pass as end_of_pass
from polarcheck.rules.wording.phrases.passes import fit_of_arc as fit_of_arc
from polarcheck.rules.wording.phrases.passes import forgotten_arc as forgotten_arc
from polarcheck.rules.wording.phrases.passes import needed_arc as needed_arc
from polarcheck.rules.wording.phrases.passes import other_pass as other_pass
from polarcheck.rules.wording.phrases.passes import pass_difference as pass_difference
from polarcheck.rules.wording.phrases.passes import words_of_arc as words_of_arc
from polarcheck.rules.wording.phrases.passes import written_arc as written_arc
from polarcheck.rules.wording.phrases.regularity import as_meant as as_meant
from polarcheck.rules.wording.phrases.regularity import misfit as misfit
from polarcheck.rules.wording.phrases.regularity import remedy as remedy

_LONGEST = 40


def way(run: Run, row: int) -> str:
    """The block as it is written: `G0 C120.`"""
    return block_in_line(run, row, _LONGEST)


def cutter(workpiece: Workpiece, lengths: Lengths, row: int) -> str:
    """R of the cutter."""
    return f"{in_row(float(workpiece.radius[row]), lengths, row):length}"


def depth(path: ProgrammedPath, lengths: Lengths, row: int) -> str:
    """Z behind the block, as it would be written."""
    return f"{in_row(float(path.z[row]), lengths, row):length}".partition(" ")[0]


def height(blocks: ExecutedBlocks, axes: PlaneAxes, path: ProgrammedPath, lengths: Lengths, row: int) -> str:
    """Z at which the cutter is in the way, and the line that says so: `at Z-4 of line 7`, on a way up `up from Z-4`."""
    rises = path.z[row] > path.z_before[row]
    is_before = bool(rises or np.isnan(path.z[row]))
    z = f"{in_row(float(path.z_before[row] if is_before else path.z[row]), lengths, row):length}"
    where = _of_line(blocks, axes.commands_z, row - is_before, row)
    return f"{'up from' if rises else 'at'} Z{z.partition(' ')[0]}{where}"


def _of_line(blocks: ExecutedBlocks, writes: Mask, until: int, row: int) -> str:
    """` of line 7`: the last row up to `until` that writes something, where that is not `row` itself."""
    at = int(last_row(writes, blocks.starts)[until]) if until >= 0 else -1
    return f" of line {int(blocks.line[at])}" if 0 <= at != row else ""


def at_depth(trace: Trace, row: int) -> str:
    """What to write where rapid traverse leads through metal: a feed where G0 is still in force, or a retract."""
    axes, blocks = trace.axes, trace.blocks
    if trace.mode.in_polar[row] and axes.motion[row] == Motion.RAPID and not blocks.listed("rapid")[row]:
        where = _of_line(blocks, blocks.listed("rapid"), row, row)
        line = code_of(trace.machine, "line")
        return f"{code_of(trace.machine, 'rapid')}{where} is still in force: write {line} here, or retract Z first"
    return "retract Z first"


def way_down(trace: Trace, bar: Bar, workpiece: Workpiece, row: int) -> str:
    """What to write where rapid traverse leads down into the bar."""
    path, line = trace.path, code_of(trace.machine, "line")
    if trace.axes.moves_plane[row] or path.x[row] != path.x_before[row]:
        return (
            f"write a Z above the metal here, and go down to Z{depth(path, trace.lengths, row)} with {line} and a feed"
        )
    if not workpiece.hits_bar[row] or np.isnan(workpiece.radius[row]):
        return f"write {line} with a feed"
    clear = in_row(bar.known.largest / 2 + float(workpiece.radius[row]), trace.lengths, row)
    where = _of_line(trace.blocks, trace.blocks.has("X", "U"), row, row)
    return f"write {line} with a feed, or stand outside the bar: {clear:diameter} or more in X{where}"


def through(workpiece: Workpiece, row: int) -> str:
    """`through`, or `if X moves first, through`, of a move of several axes at once."""
    may_miss = workpiece.may_miss_part[row] if workpiece.hits_part[row] else workpiece.may_miss_bar[row]
    return "(if X is faster than Z or C) through" if may_miss else "through"


def bar(bar: Bar, lengths: Lengths, row: int) -> str:
    """The bar and where it is known from: `40 mm, [stock]`, `27.7 mm turned in lines 8 to 11`."""
    return _bar(bar, lengths, row)


def _bar(bar: Bar, lengths: Lengths, row: int) -> str:
    known = bar.known
    size = f"{in_row(known.smallest, lengths, row):length}"
    if known.source == "turning":
        first, last = known.lines
        return f"{size} turned in {f'line {first}' if first == last else f'lines {first} to {last}'}"
    return f"{size}, [stock]" if known.source == "job" else f"{size}, comment in line {known.lines[0]}"


def bar_there(bar: Bar, workpiece: Workpiece, lengths: Lengths, row: int) -> str:
    """The bar, or what stands where a pocket is milled."""
    return (
        f"the bar ({_bar(bar, lengths, row)})" if workpiece.hits_bar[row] else "what the pocket still has to take off"
    )


def in_step(pass_depths: PassDepths, lengths: Lengths, row: int) -> str:
    """Z of a pass in step with the others, as it would be written."""
    return f"{in_row(float(pass_depths.expected[row]), lengths, row):length}".partition(" ")[0]


def tip(trace: Trace, row: int) -> str:
    """Z of the tip, in the units of the program."""
    return depth(trace.path, trace.lengths, row)


def more(count: int) -> str:
    """How many moves of a contour there are beside the first one."""
    return f", and in {count - 1} more moves" if count > 1 else ""


def in_air(air_cuts: AirCuts, bar: Bar, trace: Trace, row: int) -> str:
    """What is cut in air, and the witness."""
    z = f"Z{depth(trace.path, trace.lengths, row)}"
    entry = int(trace.mode.sections.enter[trace.mode.section[row]])
    match air_cuts.reason[row]:
        case Reason.DEPTH_MISSING:
            why = "and the retract moves nowhere: a Z word for the depth is missing"
            return f"cuts at {z}, where the section begins, {why}"
        case Reason.SIGN_WRONG:
            above = f"above Z{depth(trace.path, trace.lengths, entry)} of the approach"
            return f"cuts at {z}, {above}, and retracts towards the part: check the sign of Z"
        case Reason.ABOVE_FACE:
            face = f"{in_row(bar.known.face, trace.lengths, row):length}".partition(" ")[0]
            first, last = bar.known.face_lines
            lines = f"line {first}" if first == last else f"lines {first} to {last}"
            source = f"turned in {lines}" if first else "[stock]"
            return f"cuts at {z}, above the face at Z{face} ({source}): the section takes nothing off"
        case Reason.OTHERS_BELOW:
            written = _of_line(trace.blocks, trace.axes.commands_z, row, -1)
            if air_cuts.is_cut_below[row]:
                return f"cuts at {z}{written}, and other cuts are at Z-{z[1:]}: the sign of Z is missing"
            why = "and the program cuts below Z0 elsewhere: a Z word for the depth is missing"
            return f"cuts at {z}{written}, where the section begins, {why}"
        case Reason.OUTSIDE_BAR:
            largest = f"{in_row(bar.known.largest, trace.lengths, row):length}"
            return f"runs outside the bar of {largest} all the way: check the units and X"
        case _:
            angle = float(trace.path.c_angle[entry])
            return f"this section was cut before at the same angle of C ({angle:g} deg): it takes nothing off; index C"
