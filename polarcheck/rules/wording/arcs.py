"""Words of arcs: G2 and G3, R, and I and J."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.path.arcs import Arcs
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import MOVES, Motion
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown
from polarcheck.rules.wording.written import move_code, written


def arc_code(trace: Trace, row: int, reverse: bool = False) -> str:
    """G2 or G3, whichever is in force; reverse: the other one."""
    is_clockwise = bool(trace.axes.motion[row] == Motion.CW) != reverse
    return move_code(trace.machine, "arc_clockwise" if is_clockwise else "arc_counterclockwise")


def still_in_force(trace: Trace, row: int, *, says_line: bool = True) -> str:
    """`: G3 of line 12 is still in force, write G1`, where the block of an arc writes no code; else nothing."""
    start = int(trace.modal.motion_word[row])
    code = np.flatnonzero(trace.run.words.start == start)
    if start < 0 or not len(code) or trace.run.block[row] == trace.run.block[trace.run.row[code[0]]]:
        return ""
    line = int(trace.blocks.line[trace.run.row[code[0]]])
    remedy = f", write {move_code(trace.machine, 'line')}" if says_line else ""
    return f": {arc_code(trace, row)} of line {line} is still in force{remedy}"


def arc_in_force_before(trace: Trace, row: int) -> tuple[str, str]:
    """
    The first word of an arc in a block, as R, and the code of arcs that was in force before it.

    Both are "" where nothing of an arc stands there; so is the code where no arc was in force.
    """
    words = (trace.machine.arcs.radius_word, *trace.axes.center_words(row))
    word = next((word for word in words if not np.isnan(trace.blocks.word(word)[row])), "")
    motion = trace.modal.state("motion")[row - 1] if row and word else Motion.LINE
    code = move_code(trace.machine, MOVES[int(motion)]) if motion in (Motion.CW, Motion.CCW) else ""
    return word, code


def written_arc(trace: Trace, arcs: Arcs, row: int) -> str:
    """The words of an arc that say where its center is: `R8.`, or `I-4. J0`."""
    blocks, run = trace.blocks, trace.run
    if arcs.by_radius[row]:
        word = written(blocks, run, row, trace.machine.arcs.radius_word)
        return f"{radius_word(trace.machine)}{word[1:]}" if word.startswith("=") else word
    words = (word for word in trace.axes.center_words(row) if not np.isnan(blocks.word(word)[row]))
    return " ".join(written(blocks, run, row, word) for word in words)


def radius_word(machine: Machine) -> str:
    """The address of R as the control's own language has it: R, or CR=."""
    return shown(machine.control.native_words, machine.arcs.radius_word)
