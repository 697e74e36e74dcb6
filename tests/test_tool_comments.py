"""Comments that name another tool than the one called, and those that only look so."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said

SECTION = "G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\n"
RULE = "tool-contradicts-comment"


def lines(program: str, machine: str = "fanuc") -> list[int]:
    return [line for line, rule in said(report_of(program, machine, "7:radius=6,nose=0")) if rule == RULE]


@pytest.mark.nightly
@looped(
    "comment",
    [
        "T9 END MILL D12",
        "T09 - EM12",
        "T0909 DRILL 10",
        "TOOL NO. 9 - D12 ENDMILL",
        "TOOL #9 CUTTER 12",
        "T9",
        "t9 end mill",
        "T9: ROUGH TURN",
    ],
    one_in=6,
)
def test_another_tool_in_the_block_of_the_call_or_beside_it(comment: str) -> None:
    assert lines(f"O1\nG21 G98\nT0707 ({comment})\n{SECTION}M30\n") == [3]
    assert lines(f"O1\nG21 G98\n({comment})\nT0707\n{SECTION}M30\n") == [4]
    assert lines(f"O1\nG21 G98\nT0707\n({comment})\n{SECTION}M30\n") == [3]


@pytest.mark.ci
@looped(
    "comment",
    [
        "T7 END MILL D12",
        "T0707 END MILL D12",
        "TOOL 7 END MILL D12",
        "T9 NEXT",
        "T9 END MILL IS SPARE",
        "T9 OR T7 END MILL",
        "T7 END MILL, T9 DRILL",
        "T6 6061 ALUMINUM",
        "T10 TORX D12",
        "TURN DIA 9",
        "END MILL D12",
        "T9.5 DRILL",
        "T SLOT CUTTER 9",
        "TAP M9",
        "9 END MILL",
    ],
    one_in=12,
)
def test_comments_that_contradict_no_call(comment: str) -> None:
    for program in (
        f"O1\nG21 G98\nT0707 ({comment})\n{SECTION}M30\n",
        f"O1\nG21 G98\n({comment})\nT0707\n{SECTION}M30\n",
    ):
        assert lines(program) == []


def test_a_list_of_tools_contradicts_nothing() -> None:
    tools = "(T1 ROUGH TURN)\n(T9 DRILL D10)\n"
    assert lines(f"O1\n{tools}T0707\nG21 G98\n{SECTION}M30\n") == []
    # Nor does one line of it, where the program calls its tool somewhere.
    assert lines(f"O1\nG21 G98\nT0909\nG1 Z-5. F1.\n(T9 DRILL D10)\nT0707\n{SECTION}M30\n") == []
    # Between two calls it may be of either of them.
    assert lines(f"O1\nG21 G98\nT0909\n(T9 DRILL D10)\nT0707\n{SECTION}M30\n") == []


def test_the_number_of_the_offset_may_be_meant() -> None:
    assert lines(f"O1\nG21 G98\nT0907 (T7 END MILL)\n{SECTION}M30\n") == []


def test_a_tool_with_a_name_is_no_number() -> None:
    program = 'G54 G90 G94 G17\nT="MILL_8" D1 ; T9 END MILL\nG0 X60 C0\nTRANSMIT\nG1 G41 X40 F200\nTRAFOOF\nM30\n'
    assert lines(program, "siemens-transmit") == []


def test_the_message_quotes_the_comment() -> None:
    (finding,) = report_of(
        f"O1\nG21 G98\nT0707 (T9 END MILL D12)\n{SECTION}M30\n", "fanuc", "7:radius=6,nose=0", only=[RULE]
    ).findings
    assert finding.message == "T0707 calls tool 7, the comment beside it names T9: (T9 END MILL D12)"
    assert finding.severity == "warning"


def test_what_a_wrong_radius_makes_follows_from_it() -> None:
    section = SECTION.replace("X60.", "X50.")
    report = report_of(f"O1\nG21 G98\nT0707 (EM8)\n{section}M30\n", "fanuc", "7:radius=6,nose=0")
    (finding,) = report.findings
    assert (finding.line, finding.rule, finding.severity) == (3, "radius-contradicts-comment", "error")
    assert {"start-up-shorter-than-radius", "cancel-shorter-than-radius"} <= {one.rule for one in finding.follows}
