from __future__ import annotations

from polarcheck.checking.editing import begins_program, blocks_before, blocks_behind, skip_sign
from polarcheck.checking.phrases.common import switch_off
from polarcheck.checking.repair import Mended, repair
from polarcheck.table.trace import Trace


@repair()
def polar_never_left(trace: Trace, index: int) -> Mended | None:
    """
    G13.1 is put behind the last block of the section.

    That is before the block that the message names. Unsafe: where the section should end, only the programmer knows.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        (RETRACT)
        G0 Z50.
        M30

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        (RETRACT)
        G0 Z50.
        M30
    """
    enter, leave = int(trace.sections.enter[index]), int(trace.sections.leave[index])
    text = skip_sign(trace, enter) + switch_off(trace, enter)
    blocks, last = trace.text.blocks, int(trace.run.block[leave - 1])
    title = f"Write {text} behind the last block of the section"
    if leave >= len(trace) or trace.starts[leave]:
        return None if blocks.is_macro[last] else Mended(title, False, (blocks_behind(trace, last, [text]),))
    first = int(trace.run.block[leave])
    between = trace.text.words.block
    is_next = last < first and not ((between > last) & (between < first)).any()
    if is_next and not blocks.is_macro[last:first].any():
        return Mended(title, False, (blocks_behind(trace, last, [text]),))
    if begins_program(trace, leave):
        return None
    return Mended(title, False, (blocks_before(trace, first, [text]),))
