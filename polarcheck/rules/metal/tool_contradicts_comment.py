from __future__ import annotations

from typing import TYPE_CHECKING

from polarcheck.rules.rule import WARNING, Hits, rule

if TYPE_CHECKING:
    from polarcheck.columns.modes.tools import CalledTools
    from polarcheck.columns.words.tool_comments import ToolComments
    from polarcheck.rules.hit import Details, Hit


@rule(
    WARNING,
    "{T} calls tool {tool:whole}, the comment beside it names T{tool_named}: {comment}",
    values=("tool", "tool_named", "comment"),
    at=("T",),
)
def tool_contradicts_comment(tool_comments: ToolComments) -> Hits:
    """
    Another tool is called than the comment names.

    The turret swings in a tool that the section was not written for. Call the tool of the comment, with its offset, or
    mend the comment.

    What counts is a comment that begins with the number of a tool and says of it which it is, in the block of the T
    word or alone on the line beside it. A line of a list of tools, the next tool that is made ready, and a number that
    is that of the offset contradict nothing.

    Source: programs of shops, which write the tool beside its call, as in T0808 (T8 3/4 END MILL).

    Bad, tool 7:radius=6:

        O1
        G21 G98
        T0707 (T9 END MILL D12)    (expect: tool-contradicts-comment)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        M30

    Bad, tool 7:radius=6:

        O1
        G21 G98
        (T9 - END MILL D12)
        T0707    (expect: tool-contradicts-comment)
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        M30

    Good, tool 7:radius=6:

        O1
        (T1 - ROUGH TURN CNMG)
        (T9 - DRILL D12)
        T0707 (T07 END MILL D12)
        G21 G98
        G0 X60. C0
        G12.1
        G1 G41 X40. F200
        C-10.
        G40 X60.
        G13.1
        (T9 NEXT)
        T0709 (T9 END MILL D12)
        M30
    """
    return Hits(tool_comments.comment >= 0, values={"tool_named": tool_comments.named_tool})


def details(hit: Hit, tools: CalledTools, tool_comments: ToolComments) -> Details:
    from polarcheck.rules.wording.written import comment_in_words

    comment = comment_in_words(hit.trace.text, int(tool_comments.comment[hit.row]))
    return {"tool": tools.tool[hit.row], "comment": comment}
