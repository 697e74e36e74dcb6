from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.foundation.states import Side
from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.mode import PolarMode
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.columns.path.compensation import CutterCompensation
    from polarcheck.foundation.arrays import Mask


@rule(
    WARNING,
    "no tool offset is in force at {switch}",
    at=("on",),
    once="tool call",
    follows={"section": ("offset-changed-in-polar",)},
)
def no_tool_offset_at_entry(
    tools: CalledTools, mode: PolarMode, compensation: CutterCompensation, entry: Entry
) -> Mask:
    """
    Polar mode without a tool offset.

    The offset must be called before the mode and cannot be changed in it. Without one, X is not the distance of the
    cutter center from the spindle axis, and the whole shape is wrong. Call it with the tool, T0808, before the
    approach. Nothing is said in an excerpt that has no T.

    Source: FANUC B-62764EN/01, p. 52; builder's guide to G12.1, cutting tools and tool offset data.

    Bad:

        T0800
        G98 G0 X60. C0
        G12.1             (expect: no-tool-offset-at-entry)
        G1 X40. F200
        C10.
        X60.
        G13.1

    Bad:

        O0001
        G98 G0 X60. C0
        G12.1             (expect: no-tool-offset-at-entry)
        G1 X40. F200
        C10.
        X60.
        G13.1
        M30

    Good:

        T0808
        G98 G0 X60. C0
        G12.1
        G1 X40. F200
        C10.
        X60.
        G13.1
        T0800
    """
    # Where compensation begins without one in the section, offset-number-missing says it better.
    compensated = mode.in_polar & (compensation.side != Side.OFF) & (tools.offset_number == 0)
    missing = mode.enters & (tools.tool_offset_number == 0) & ~tools.is_unknown & entry.expects_offset
    return missing & mode.nowhere_in_section(compensated)
