from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.rules.editing import begins_program, blocks_before, is_head, is_plain, separator, skip_sign, words_of
from polarcheck.rules.repair import WAY, Mended, repair
from polarcheck.rules.wording.written import code_of

#: A move goes outward where so much of its length adds to the distance from the center: within 45 deg.
OUTWARD = 0.7


@repair(WAY)
def polar_switched_in_offset_mode(trace: Trace, row: int) -> Mended | None:
    """
    G40 is put before G12.1, or before G13.1 with the last move, where that leads away.

    It leads away where it is straight, and ends where the start-up begins, or goes outward, and farther from the center
    than all other moves since then; else there is no fix. Unsafe: whether compensation should end there only the
    programmer knows.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G42
        N5 G12.1 (ON)
        G1 X40. F200
        C10.
        G40 X60.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G42
        G40
        N5 G12.1 (ON)
        G1 X40. F200
        C10.
        G40 X60.
        G13.1

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        N60 G1 X60.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        N60 G1 G40 X60.
        G13.1
    """
    off = code_of(trace.machine, "compensation_off")
    if trace.mode.enters[row]:
        if not is_plain(trace.run, row) or begins_program(trace.run, row):
            return None
        edit = blocks_before(trace.text, int(trace.run.block[row]), [skip_sign(trace.run, row) + off])
        return Mended(f"Write {off} before it", False, (edit,))
    last = _move_away(trace, row) if trace.mode.leaves[row] else None
    if last is None or not is_plain(trace.run, last):
        return None
    body = [index for index in words_of(trace.run, last) if not is_head(trace.run, index)]
    others = [index for index in body if chr(int(trace.run.words.address[index])) != "G"]
    start = int(trace.run.words.start[(others or body)[0]])
    return Mended(f"Write {off} with the last move", False, ((start, start, off + separator(trace.run, last)),))


def _move_away(trace: Trace, row: int) -> int | None:
    """The last move on the plane before a row, where it leads away from the contour."""
    moving = np.flatnonzero(
        trace.path.travels & (trace.mode.section == trace.mode.section[row - 1]) & (np.arange(len(trace)) < row)
    )
    begins = moving[trace.compensation.starts_up[moving]]
    if not len(begins) or moving[-1] <= begins[-1] or trace.axes.motion[moving[-1]] != Motion.LINE:
        return None
    *path, last = moving[moving >= begins[-1]].tolist()
    end, farthest = trace.path.end[last], float(np.abs(trace.path.end[path]).max())
    leads_back = abs(end - trace.path.start[begins[-1]]) <= ROUNDING
    leads_out = abs(end) - abs(trace.path.start[last]) > OUTWARD * abs(end - trace.path.start[last])
    return int(last) if leads_back or (leads_out and abs(end) > farthest + ROUNDING) else None
