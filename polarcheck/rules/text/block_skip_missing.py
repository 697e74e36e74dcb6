from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.causes import SECTION_READ_OTHERWISE
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.skipped_blocks import SkippedBlocks
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "{block} has no /, as the blocks before and after it have: with block skip on it is run alone; write /{block}",
    once="program",
    doubts=SECTION_READ_OTHERWISE,
)
def block_skip_missing(skipped_blocks: SkippedBlocks) -> Mask:
    """
    Block without / among optional blocks.

    The blocks of a pass begin with /, so that block skip leaves the pass out, and one among them does not. With block
    skip on the control runs this block alone: the tool goes straight to a corner of the contour, or down, and stays
    there. At least five blocks with / stand around it, and it leads elsewhere than where the tool is without them.

    Source: FANUC B-62754EN/01, optional block skip.

    Bad, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-4.
        G42 X40. C0 F200
        G3 X-40. R20.
        X40. R20.
        G1 G40 X60. F1500
        Z2.
        /Z-4.2
        /G42 X40. C0 F200
        G3 X-40. R20.     (expect: block-skip-missing)
        /G3 X40. R20.
        /G1 G40 X60. F1500
        /Z2.
        G13.1

    Good, tool 1:radius=4:

        T0101
        G98 G0 X60. Z2. C0
        G12.1
        G1 X60. F1500
        Z-4.
        G42 X40. C0 F200
        G3 X-40. R20.
        X40. R20.
        G1 G40 X60. F1500
        Z2.
        /Z-4.2
        /G42 X40. C0 F200
        /G3 X-40. R20.
        /G3 X40. R20.
        /G1 G40 X60. F1500
        /Z2.
        G13.1
    """
    # Compares nothing: which blocks are optional stands in the text.
    return skipped_blocks.lacks_skip
