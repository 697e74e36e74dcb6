"""Phrases of the rules about the metal."""

from __future__ import annotations

import numpy as np

from polarcheck.checking.phrases.comments import comment_on_part as comment_on_part
from polarcheck.checking.phrases.comments import quoted as quoted
from polarcheck.checking.phrases.comments import what_is_made as what_is_made
from polarcheck.checking.phrases.misplaced import block_before as block_before
from polarcheck.checking.phrases.misplaced import cancel as cancel
from polarcheck.checking.phrases.misplaced import contour_end_there as contour_end_there
from polarcheck.checking.phrases.misplaced import leads_where as leads_where
from polarcheck.checking.phrases.misplaced import left_or_right as left_or_right
from polarcheck.checking.phrases.misplaced import ramp_end as ramp_end
from polarcheck.checking.phrases.misplaced import side as side
from polarcheck.checking.phrases.misplaced import turned as turned
from polarcheck.checking.phrases.misplaced import wrong_by as wrong_by
from polarcheck.checking.phrases.misplaced import x_meant as x_meant
from polarcheck.checking.phrases.passes import crosses_line as crosses_line
from polarcheck.checking.phrases.passes import drift as drift
from polarcheck.checking.phrases.passes import fit_of_arc as fit_of_arc
from polarcheck.checking.phrases.passes import forgotten_arc as forgotten_arc
from polarcheck.checking.phrases.passes import needed_arc as needed_arc
from polarcheck.checking.phrases.passes import other_pass as other_pass
from polarcheck.checking.phrases.passes import pass_difference as pass_difference
from polarcheck.checking.phrases.passes import words_of_arc as words_of_arc
from polarcheck.checking.phrases.passes import written_arc as written_arc
from polarcheck.checking.phrases.regularity import as_meant as as_meant
from polarcheck.checking.phrases.regularity import misfit as misfit
from polarcheck.checking.phrases.regularity import remedy as remedy
from polarcheck.checking.places import block_in_line
from polarcheck.checking.quantity import in_row
from polarcheck.columns.lengths import Lengths
from polarcheck.columns.path import ProgrammedPath
from polarcheck.columns.trace import Trace
from polarcheck.execution.run import Run
from polarcheck.table.air_cuts import AirCuts, Reason
from polarcheck.table.bar import Bar
from polarcheck.table.pass_depths import PassDepths
from polarcheck.table.workpiece import Workpiece

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


def height(path: ProgrammedPath, lengths: Lengths, row: int) -> str:
    """Z at which the cutter is in the way: `at Z-4.`, and on a way up `up from Z-4.`."""
    rises = path.z[row] > path.z_before[row]
    z = f"{in_row(float(path.z_before[row] if rises or np.isnan(path.z[row]) else path.z[row]), lengths, row):length}"
    return f"{'up from' if rises else 'at'} Z{z.partition(' ')[0]}"


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
            why = "and the program cuts below Z0 elsewhere: a Z word for the depth is missing"
            return f"cuts at {z}, where the section begins, {why}"
        case Reason.OUTSIDE_BAR:
            largest = f"{in_row(bar.known.largest, trace.lengths, row):length}"
            return f"runs outside the bar of {largest} all the way: check the units and X"
        case _:
            angle = float(trace.path.c_angle[entry])
            return f"this section was cut before at the same angle of C ({angle:g} deg): it takes nothing off; index C"
