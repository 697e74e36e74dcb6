from __future__ import annotations

from polarcheck.columns.modes.switch_slips import SwitchSlips
from polarcheck.program.execution.run import Run
from polarcheck.rules.editing import in_place_of, is_plain, written_word
from polarcheck.rules.repair import Mended, repair


@repair()
def polar_switch_unknown(switch_slips: SwitchSlips, run: Run, row: int, at: list[int]) -> Mended | None:
    """
    G12.1 or G13.1 is written in the place of the code, and of the one that answers it.

    Unsafe: the part is another one with it. Nothing is written where the codes may be those of the builder.

    Bad:

        G98 G0 X60. C0
        G121
        G1 X40. F200
        C10.
        X60.
        G131

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
    """
    slip = switch_slips.slips[row]
    rows = [each for each in (row, slip.answer) if each >= 0]
    if slip.is_of_builder or not all(is_plain(run, each) for each in rows):
        return None
    words = [index for index in switch_slips.words.nonzero()[0].tolist() if run.row[index] in rows]
    edits = [in_place_of(run, index, switch_slips.meant_in(int(run.row[index]))) for index in words]
    names = ", ".join(written_word(run, index) for index in words)
    codes = ", ".join(text for *_, text in edits)
    return Mended(f"Write {codes} for {names}", False, tuple(edits))
