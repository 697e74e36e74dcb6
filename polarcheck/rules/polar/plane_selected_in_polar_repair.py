from __future__ import annotations

from polarcheck.checking.editing import is_plain, without, written_word
from polarcheck.checking.repair import Mended, repair
from polarcheck.columns.blocks import ExecutedBlocks
from polarcheck.columns.filling import before
from polarcheck.columns.modal import ModalStates
from polarcheck.execution.run import Run
from polarcheck.machines.codes import code_numbers


@repair()
def plane_selected_in_polar(
    blocks: ExecutedBlocks, modal: ModalStates, run: Run, row: int, at: list[int]
) -> Mended | None:
    """
    G17, G18 or G19 in the mode is deleted.

    Safe where it names the plane that was in force before G12.1 and comes back at G13.1. Else unsafe: what follows the
    section may rely on the plane that it selects.

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
    """
    if not is_plain(run, row) or not at:
        return None
    numbers = code_numbers(run.words.value[at]) // 10
    in_force = int(before(modal.state("plane"), blocks.starts, 0)[row])
    names = ", ".join(written_word(run, index) for index in at)
    is_safe = bool((numbers == in_force).all())
    return Mended(f"Delete {names}", is_safe, tuple(without(run, row, at)))
