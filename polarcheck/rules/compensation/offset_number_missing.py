from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import ERROR, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.executed_blocks import ExecutedBlocks
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    ERROR,
    "{code} begins and no tool offset is in force, so that R is 0",
    values=("code",),
    gouges=True,
    at=("compensation_left", "compensation_right"),
    once="tool call",
    follows={"section": ("offset-changed-in-polar",)},
)
def offset_number_missing(blocks: ExecutedBlocks, tools: CalledTools, compensation: CutterCompensation) -> Mask:
    """
    Cutter compensation without a tool offset.

    On a lathe R comes with the tool offset: T0808 calls tool 8 with offset 8. With T0800, or no T at all, R is 0, the
    cutter center runs along the contour, and the part is too small by the cutter diameter. In an excerpt without T the
    offset is taken to be called before.

    Source: builder's guide to G12.1, cutter compensation data setting; FANUC B-62764EN/01, p. 52.

    Bad:

        T0800
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200   (expect: offset-number-missing)
        C-10.
        G40 X60.
        G13.1

    Good:

        T0808
        G98 G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        T0800
    """
    # Before an excerpt the tool may have been called.
    called_here = tools.has_called_tool | blocks.whole_program
    return compensation.starts_up & (tools.offset_number == 0) & ~tools.is_unknown & called_here


def details(hit: Hit) -> Details:
    return {"code": hit.side}
