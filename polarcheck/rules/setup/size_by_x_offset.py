from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.foundation.arrays import Mask
    from polarcheck.program.execution.run import Run
    from polarcheck.rules.hit import Details, Hit


@rule(
    NOTE,
    "{x_changed_by} changes X of offset {offset}, which shifts the shape and leaves its size: change R",
    values=("changed_by", "x_wear", "offset"),
    at=("X", "U", "T"),
    is_advice=True,
)
def size_by_x_offset(offsets: ToolOffsets) -> Mask:
    """
    Milled size that is adjusted by the X offset.

    In the polar mode C turns the part about the center of the spindle, where X0 must stay the center of the cutter. An
    X offset that is changed, as it is after turning, displaces the shape on every side of the part instead of making it
    smaller or larger. Change R of the tool offset: .005 less for flats that are .005 too far apart. X of the geometry,
    where the tool has been touched off, and a wear of 0 are as they should be. Of a job with an offset table, or with
    `[tools.8] x_wear`, the wear counts that it holds.

    Source: builder's guide to G12.1, adjusting the part size.

    Bad, machine turning-center, tool 8:radius=.25, tool 8:nose=0:

        G10 P8 U-.005      (expect: size-by-x-offset)
        T0808
        M33 S1000
        G98 G0 X2. C0
        G12.1
        G1 G41 X1. F5.
        C-.5
        G40 X2.
        G13.1

    Bad, machine turning-center, tool 8:radius=.25, tool 8:nose=0, tool 8:x_wear=-.005:

        T0808              (expect: size-by-x-offset)
        M33 S1000
        G98 G0 X2. C0
        G12.1
        G1 G41 X1. F5.
        C-.5
        G40 X2.
        G13.1

    Good, machine turning-center, tool 8:radius=.25, tool 8:nose=0:

        G10 P10008 X-5.25 Z-3.1
        G10 P8 X0 C-.005
        G10 P9 U-.005
        T0808
        M33 S1000
        G98 G0 X2. C0
        G12.1
        G1 G41 X1. F5.
        C-.5
        G40 X2.
        G13.1
    """
    # Compares nothing: what is set of which offset is a list of settings, and no column.
    return offsets.sizes_by_x


def details(hit: Hit, blocks: ExecutedBlocks, tools: CalledTools, offsets: ToolOffsets, run: Run) -> Details:
    from polarcheck.rules.wording.offsets import job_scale, shown_offset

    numbers = offsets.offset_settings.number[offsets.offset_settings.row == hit.row]
    word = _x_word(hit, blocks, run)
    wear = None if word else tools.of_job[int(tools.offset_number[hit.row])].x_wear * job_scale(hit.trace, hit.row)
    return {
        "changed_by": word,
        "x_wear": wear,
        "offset": shown_offset(tools, int(numbers[0] if len(numbers) else tools.offset_number[hit.row])),
        "x_changed_by": word or f"the wear in X of the offset table, {hit.length(wear)},",
    }


def _x_word(hit: Hit, blocks: ExecutedBlocks, run: Run) -> str:
    """The word or the variable that sets X of a tool offset; empty for the wear of the job's table."""
    if hit.row in run.assigned:
        return run.assigned[hit.row].name
    address = next((address for address in "XU" if blocks.has(address)[hit.row]), "")
    return hit.written(address) if blocks.listed("data_input")[hit.row] and address else ""
