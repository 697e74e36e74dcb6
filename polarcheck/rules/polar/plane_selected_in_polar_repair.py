from __future__ import annotations

import numpy as np

from polarcheck.columns.filling import before
from polarcheck.columns.trace import Trace
from polarcheck.program.machines.code_tables import code_numbers
from polarcheck.rules.editing import blocks_behind, is_plain, without, written_word
from polarcheck.rules.repair import Mended, repair


@repair()
def plane_selected_in_polar(trace: Trace, row: int, at: list[int]) -> Mended | None:
    """
    G17, G18 or G19 in the mode is deleted.

    Safe where it names the plane that was in force before G12.1 and comes back at G13.1. Else unsafe: what follows the
    section may rely on the plane that it selects. Where a lathe is set up for one plane in the mode, no other comes
    back by itself: one that stands behind the last move is put behind G113.

    Bad:

        G98 G18 G0 X60. C0
        G12.1
        G18
        G1 X40. F200
        G17 G3 X30. C5. I-5. J0
        G1 X60.
        G13.1

    Good:

        G98 G18 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 X30. C5. I-5. J0
        G1 X60.
        G13.1

    Bad, machine haas-lathe:

        G98 G17 G0 X60. Y0 C0
        G112
        G1 X20. F200
        Y10.
        G18
        G113
        G0 X80.

    Good, machine haas-lathe:

        G98 G17 G0 X60. Y0 C0
        G112
        G1 X20. F200
        Y10.
        G113
        G18
        G0 X80.
    """
    blocks, run = trace.blocks, trace.run
    if not is_plain(run, row) or not at:
        return None
    numbers = code_numbers(run.words.value[at]) // 10
    in_force = int(before(trace.modal.state("plane"), blocks.starts, 0)[row])
    names = ", ".join(written_word(run, index) for index in at)
    if trace.machine.polar.plane_before:
        leave = int(trace.mode.sections.leave[trace.mode.section[row]])
        is_last = not np.any(trace.axes.moves[row:leave])
        if is_last and leave < len(trace) and trace.mode.leaves[leave] and is_plain(run, leave):
            behind = blocks_behind(run.text, int(run.block[leave]), [names])
            return Mended(f"Write {names} behind the section", False, (*without(run, row, at), behind))
    is_safe = bool((numbers == in_force).all())
    return Mended(f"Delete {names}", is_safe, tuple(without(run, row, at)))
