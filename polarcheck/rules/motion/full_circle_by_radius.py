from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.path.arcs import Arcs
    from polarcheck.columns.path.axes import PlaneAxes
    from polarcheck.columns.path.path import ProgrammedPath
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.execution.run import Run
    from polarcheck.program.machines.machine import Machine
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "arc by radius that ends where it starts: nothing moves; {of_full_circle}",
    at=("X", "C", "R"),
    subject="",
    is_symptom=True,
)
def full_circle_by_radius(
    blocks: ExecutedBlocks, axes: PlaneAxes, path: ProgrammedPath, arcs: Arcs, machine: Machine
) -> Mask:
    """
    Full circle with R.

    With R an arc that ends at its start is one of 0 degrees: the tool stays where it is, and the circle is not cut.
    Write a full circle with I or J and without an end, or in two arcs.

    Source: FANUC B-62754EN/01, p. 67; builder's guide to G12.1, circular interpolation.

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 X40. C0 R20.   (expect: full-circle-by-radius)
        G1 X60.
        G13.1

    Bad:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 R20.           (expect: full-circle-by-radius)
        G1 X60.
        G13.1

    Good:

        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        G3 I-20.
        G1 X60.
        G13.1
    """
    has_radius = arcs.in_force & blocks.has(machine.arcs.radius_word)
    return has_radius & ~path.moves_z & (~axes.moves_plane | arcs.ends_at_start)


def details(hit: Hit, path: ProgrammedPath, run: Run) -> Details:
    import numpy as np

    before = np.flatnonzero(path.travels[: hit.row])
    is_twice = len(before) > 0 and _words(run, int(before[-1])) == _words(run, hit.row)
    full_circle = f"a full circle needs {hit.centers}, another arc another end"
    return {"of_full_circle": "the block stands twice, delete one" if is_twice else full_circle}


def _words(run: Run, row: int) -> list[str]:
    """The words of a row as they are written, without its N word."""
    import numpy as np

    from polarcheck.rules.wording.written import executed_word

    end = range(*np.searchsorted(run.row, (row, row + 1)).tolist())
    return [executed_word(run, index) for index in end if chr(int(run.words.address[index])) != "N"]
