from __future__ import annotations

from polarcheck.checking.editing import is_plain, without, written_word
from polarcheck.checking.repair import Mended, repair
from polarcheck.machines.codes import code_numbers
from polarcheck.table.filling import before
from polarcheck.table.trace import Trace


@repair()
def plane_selected_in_polar(trace: Trace, row: int, at: list[int]) -> Mended | None:
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
    if not is_plain(trace, row) or not at:
        return None
    numbers = code_numbers(trace.run.words.value[at]) // 10
    in_force = int(before(trace.state("plane"), trace.starts, 0)[row])
    names = ", ".join(written_word(trace, index) for index in at)
    is_safe = bool((numbers == in_force).all())
    return Mended(f"Delete {names}", is_safe, tuple(without(trace, row, at)))
