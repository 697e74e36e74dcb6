from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import NOTE, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.offsets import ToolOffsets
    from polarcheck.foundation.arrays import Mask


@rule(
    NOTE,
    "{x_changed_by} changes X of offset {offset_of_block}, which shifts the shape and leaves its size: change R",
    values={"changed_by": "word_of_change", "x_wear": "wear_in_x", "offset": "offset_of_block"},
    at=("X", "U", "T"),
    is_advice=True,
)
def size_by_x_offset(offsets: ToolOffsets) -> Mask:
    """
    Size of what is milled adjusted by the X offset.

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
