from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.metal.bar import Bar
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.trace import Trace
    from polarcheck.columns.words.written import Written
    from polarcheck.rules.hit import Details, Hit

#: Of a block that is named; more is cut off [characters].
_BLOCK_LENGTH = 60


@rule(
    ERROR,
    "polar mode is never left: {missing_before}",
    values=("other_line",),
    over="sections",
    at=("on",),
    subject="mode",
    follows={"program": ("program-end-missing",)},
)
def polar_never_left(blocks: ExecutedBlocks, mode: PolarMode, written: Written) -> Hits:
    """
    Polar mode still on at the tool change or the end of the program.

    A forgotten G13.1: what follows is read on the polar plane, with C as a length, X across the center and G0 not
    allowed. One fault is reported here, at the G12.1, with the first block that can only stand outside; from there on
    the program is read as if the G13.1 stood before it. Where the control takes tools in the mode while no compensation
    is in force, a tool change says nothing as long as the mode is left later.

    Source: FANUC B-62764EN/01, p. 50; builder's guide to G12.1.

    Bad:

        G98 G0 X60. C0
        G12.1             (expect: polar-never-left)
        G1 X40. F200
        C10.
        X60.
        G0 Z50.
        G28 U0
        M30

    Bad:

        T0101
        G98 G0 X60. C0
        G112              (expect: polar-never-left)
        G1 X40. F200
        C10.
        X60.
        T0202
        G0 X50. C0
        G112
        G1 X40. F200
        C10.
        X60.
        G113

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        G0 Z50.
        G28 U0
        M30
    """
    import numpy as np

    # A program that has lost its end has lost this code with it.
    is_at_end = np.append(blocks.starts, True)[mode.sections.leave]
    return Hits(~mode.sections.left, follows={"program": is_at_end | ~written.lacks_end.any()})


def details(hit: Hit, blocks: ExecutedBlocks, mode: PolarMode, upright: Trace, bar: Bar) -> Details:
    from polarcheck.rules.places import block_in_line
    from polarcheck.rules.wording.metal import turret_at_depth
    from polarcheck.rules.wording.written import switch_off

    leave = int(mode.sections.leave[hit.index])
    off = switch_off(blocks, hit.trace.machine, int(mode.sections.enter[hit.index]))
    if leave >= len(blocks) or blocks.starts[leave]:
        return {"other_line": None, "missing_before": f"{off} is missing at the end of the program"}
    line, block = hit.line(leave), block_in_line(hit.trace.run, leave, _BLOCK_LENGTH)
    beside_part = turret_at_depth(hit, upright, bar, leave)
    return {"other_line": line, "missing_before": f"{off} is missing before line {line}, {block}{beside_part}"}
