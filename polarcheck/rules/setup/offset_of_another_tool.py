from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.entry import Entry
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.foundation.arrays import Mask
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{text} calls tool {tool} with the offset of tool {offset}, which line {own} calls, too: is offset {tool} meant?",
    values=("tool", "offset"),
    at=("T",),
    doubts=(("compensation", "tool call"),),
)
def offset_of_another_tool(entry: Entry) -> Mask:
    """
    Tool that is called with the offset of another tool.

    X, Z and R of the section are those of the other tool: the cutter stands elsewhere, and the part gets another size.
    What is found of compensation with this tool is listed under this finding. Nothing is said where the tool is called
    with the offset of its own number elsewhere, and where no tool has the number of the offset: a second offset of one
    tool is usual.

    Source: builder's guide to G12.1, tool offset data.

    Bad, tool 1:radius=8, tool 3:radius=4:

        T0103             (expect: offset-of-another-tool)
        G98 G0 X60. C0
        G12.1
        G1 G42 X41. F200
        C10.
        G40 X60.
        G13.1
        T0303
        G0 X60. C0
        G12.1
        G1 G42 X40. F200
        C10.
        G40 X60.
        G13.1

    Good, tool 1:radius=8, tool 11:radius=4:

        T0101
        G98 G0 X60. C0
        G12.1
        G1 G42 X41. F200
        C10.
        G40 X60.
        G13.1
        T0111
        G0 X60. C0
        G12.1
        G1 G42 X40. F200
        C10.
        G40 X60.
        G13.1
    """
    # Compares nothing: the table compares each T with all others of the program.
    return entry.takes_offset_of_other


def details(hit: Hit, tools: CalledTools) -> Details:
    tool, offset = int(tools.tool[hit.row]), int(tools.tool_offset_number[hit.row])
    own = tools.calls_tool & (tools.tool == offset) & (tools.tool_offset_number == offset)
    return {"tool": tool, "offset": offset, "own": hit.line(int(own.argmax()))}
