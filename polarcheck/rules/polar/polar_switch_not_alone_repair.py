from __future__ import annotations

from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
from polarcheck.columns.modes.mode import PolarMode
from polarcheck.columns.modes.mode_words import ModeWords
from polarcheck.columns.path.axes import PlaneAxes
from polarcheck.foundation.states import Motion
from polarcheck.program.execution.run import Run
from polarcheck.program.machines.machine import Machine
from polarcheck.rules.editing import (
    blocks_before,
    is_head,
    is_plain,
    parted,
    skip_sign,
    without,
    words_of,
    written_word,
)
from polarcheck.rules.repair import Mended, repair
from polarcheck.rules.wording.written import switch


@repair()
def polar_switch_not_alone(
    blocks: ExecutedBlocks,
    axes: PlaneAxes,
    mode: PolarMode,
    run: Run,
    machine: Machine,
    mode_words: ModeWords,
    row: int,
) -> Mended | None:
    """
    G12.1 or G13.1 gets a block of its own.

    What is written before the code comes before it, what is written behind it comes behind it; but G codes that cannot
    stand in the mode go to the other side. Safe where nothing beside it moves X or C, or in G0 only, which can stand
    nowhere but outside. Else unsafe: the control may have taken the words on the other side.

    Bad:

        G98 G0 X60. C0
        N20 G12.1 (ON) M8 (COOLANT)
        G1 X40. F200
        C10.
        X60.
        N30 G13.1 G0 Z50.

    Good:

        G98 G0 X60. C0
        N20 G12.1 (ON)
        M8 (COOLANT)
        G1 X40. F200
        C10.
        X60.
        N30 G13.1
        G0 Z50.

    Bad:

        G98 G0 X60. C0
        G12.1 G18
        G1 X40. F200
        C10.
        X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G18
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    if not is_plain(run, row):
        return None
    polar = machine.polar
    own = words_of(run, row)
    is_switch = mode_words.codes(*polar.on, *polar.off)
    switches = [index for index in own if is_switch[index]]
    beside = [index for index in own if not is_switch[index] and not is_head(run, index)]
    if len(switches) != 1 or not beside:
        return None
    (at,) = switches
    enters = bool(mode.enters[row])
    # Words that the profile lets stand beside the code stay there.
    beside = [index for index in beside if not mode_words.may_stand_beside_switch[index]]
    block = int(run.block[row])
    outside = [index for index in beside if _must_be_outside(run, machine, index)]
    out_of_place = [index for index in outside if (index > at) == enters]
    title = f"Write {switch(blocks, machine, row)} in a block of its own"
    if out_of_place:
        if len(out_of_place) < len(beside) or not enters:
            return None
        text = skip_sign(run, row) + " ".join(written_word(run, index) for index in out_of_place)
        edits = [blocks_before(run.text, block, [text]), *without(run, row, out_of_place)]
        return Mended(title, True, tuple(edits))
    starts = run.words.start
    before = [index for index in own if starts[index] < starts[at] and not is_head(run, index)]
    behind = [index for index in beside if starts[index] > starts[at]]
    if not all(_means_something(run, group) for group in (before, behind) if group):
        return None
    # What may stand beside the code stays there where it follows it, else it goes with the others.
    edits = [parted(run, row, at)] if any(index in beside for index in before) else []
    edits += [parted(run, row, behind[0])] if behind else []
    return Mended(title, _is_safe(axes, run, machine, row, before if enters else behind, beside), tuple(edits))


def _must_be_outside(run: Run, machine: Machine, index: int) -> bool:
    """A G code that cannot stand in the mode."""
    from polarcheck.program.machines.code_tables import NO_CODE, code_numbers, code_set

    words = run.words
    if chr(int(words.address[index])) != "G":
        return False
    number = int(code_numbers(words.value[index : index + 1])[0])
    return number != NO_CODE and not code_set(machine.polar.allowed_codes)[number]


def _means_something(run: Run, words: list[int]) -> bool:
    """A block of these words alone: P, Q and the like mean nothing without a code."""
    addresses = {chr(int(run.words.address[index])) for index in words}
    return bool(addresses & set("GMT")) or not addresses & set("DEIJKLPQR")


def _is_safe(axes: PlaneAxes, run: Run, machine: Machine, row: int, outside: list[int], beside: list[int]) -> bool:
    """Nothing beside the code moves the axes of the plane, or only in G0 outside the mode."""
    of_plane = {
        "X",
        "U",
        "Y",
        "V",
        *machine.polar.rotary_words,
        machine.polar.rotary_address,
        machine.polar.virtual_axis,
    }
    moving = [index for index in beside if chr(int(run.words.address[index])) in of_plane]
    in_rapid = bool(axes.motion[row] == Motion.RAPID)
    return all(in_rapid and index in outside for index in moving)
