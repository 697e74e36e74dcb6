from __future__ import annotations

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.editing import begins_program, blocks_before, blocks_behind, skip_sign
from polarcheck.rules.repair import Mended, repair
from polarcheck.rules.wording.written import switch_off


@repair()
def polar_never_left(blocks: ExecutedBlocks, mode: PolarMode, run: Run, machine: Machine, index: int) -> Mended | None:
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
    enter, leave = int(mode.sections.enter[index]), int(mode.sections.leave[index])
    text = skip_sign(run, enter) + switch_off(blocks, machine, enter)
    blocks_of_text, last = run.text.blocks, int(run.block[leave - 1])
    title = f"Write {text} behind the last block of the section"
    if leave >= len(blocks) or blocks.starts[leave]:
        return None if blocks_of_text.is_macro[last] else Mended(title, False, (blocks_behind(run.text, last, [text]),))
    first = int(run.block[leave])
    between = run.text.words.block
    is_next = last < first and not ((between > last) & (between < first)).any()
    if is_next and not blocks_of_text.is_macro[last:first].any():
        return Mended(title, False, (blocks_behind(run.text, last, [text]),))
    if begins_program(run, leave):
        return None
    return Mended(title, False, (blocks_before(run.text, first, [text]),))
