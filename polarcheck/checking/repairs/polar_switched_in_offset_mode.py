from __future__ import annotations

from polarcheck.checking.editing import begins_program, blocks_before, is_plain, skip_sign
from polarcheck.checking.phrases.common import code_of
from polarcheck.checking.repair import Mended, repair
from polarcheck.table.trace import Trace


@repair()
def polar_switched_in_offset_mode(trace: Trace, row: int) -> Mended | None:
    """
    G40 is put before G12.1 or G13.1.

    Unsafe: whether compensation should have ended there, or further up, with the move away from the part, only the
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
    """
    if not is_plain(trace, row) or begins_program(trace, row) or not (trace.enters[row] or trace.leaves[row]):
        return None
    off = code_of(trace.machine, "compensation_off")
    edit = blocks_before(trace, int(trace.run.block[row]), [skip_sign(trace, row) + off])
    return Mended(f"Write {off} before it", False, (edit,))
