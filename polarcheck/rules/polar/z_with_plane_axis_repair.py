from __future__ import annotations

from polarcheck.columns.filling import before
from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.columns.path.path import ProgrammedPath
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.code_tables import code_numbers, code_set
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.editing import (
    begins_program,
    blocks_behind,
    is_plain,
    separator,
    skip_sign,
    without,
    words_of,
    written_word,
)
from polarcheck.rules.repair import Mended, Z, repair


@repair(Z)
def z_with_plane_axis(
    blocks: ExecutedBlocks, axes: PlaneAxes, path: ProgrammedPath, run: Run, machine: Machine, row: int
) -> Mended | None:
    """
    Z gets a block of its own: behind the move on the plane where it goes in, before it where it comes out.

    G40, G41 and G42 stay with X and C, all other words at the head. Unsafe: the tool takes another way.

    Bad:

        G98 G0 X60. Z2. C0
        G12.1
        N10 G1 X40. Z-5. F200 (IN)
        C10.
        N20 G1 X60. Z2. (OUT)
        G13.1

    Good:

        G98 G0 X60. Z2. C0
        G12.1
        N10 G1 X40. F200 (IN)
        Z-5.
        C10.
        N20 G1 Z2. (OUT)
        X60.
        G13.1
    """
    if not is_plain(run, row) or begins_program(run, row):
        return None
    depth = float(path.z[row] - before(path.z, blocks.starts, float("nan"))[row])
    if depth != depth and blocks.has("W")[row] and not blocks.has("Z")[row]:
        depth = float(blocks.word("W")[row])
    if not depth:  # nothing moves Z
        return None
    words = run.words
    own = words_of(run, row)
    names = [chr(int(words.address[index])) for index in own]
    of_z = [index for index, name in zip(own, names, strict=True) if name in "ZW"]
    addresses = {"X", "U", *machine.polar.rotary_words, machine.polar.virtual_axis, axes.virtual_axis_of(row)}
    sides = (
        *machine.codes("compensation_off"),
        *machine.codes("compensation_left"),
        *machine.codes("compensation_right"),
    )
    is_side = code_set(sides)[code_numbers(words.value[own])]
    of_plane = [
        index
        for index, name, side in zip(own, names, is_side, strict=True)
        if name in addresses or (name == "G" and side)
    ]
    if depth != depth or not of_z or not of_plane:
        return None
    moved = of_z if depth < 0 else of_plane
    text = skip_sign(run, row) + separator(run, row).join(written_word(run, index) for index in moved)
    edits = [*without(run, row, moved), blocks_behind(run.text, int(run.block[row]), [text])]
    where = "behind" if depth < 0 else "before"
    return Mended(f"Write Z in a block of its own {where} the move on the plane", False, tuple(edits))
