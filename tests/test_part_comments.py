"""Comments that state shape, size, depth or bar, beside what the program makes."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of

RULE = "comment-contradicts-part"
HEXAGON = (
    "G0 X60. Z2. C0\nG12.1\nG1 X60. C0 F1500\nZ-5. F300\nG42 X22. F200\nC6.351\nX0 C12.702\nX-22. C6.351\nC-6.351\n"
    "X0 C-12.702\nX22. C-6.351\nC0\nG40 X60. F1500\nZ2.\nG13.1\n"
)
FLATS = "G0 X60. Z2. C0\nG12.1\nG1 X60. C-25. F1500\nZ-5. F300\nG42 X22. F200\nC25.\nG40 X60. F1500\nZ2.\nG13.1\n"
RECTANGLE = (
    "G0 X60. Z2. C0\nG12.1\nG1 X60. C0 F1500\nZ-5. F300\nG42 X20. F200\nC14.\nG3 X12. C18. R4.\n"
    "G1 X-12.\nG3 X-20. C14. R4.\n"
    "G1 C-14.\nG3 X-12. C-18. R4.\nG1 X12.\nG3 X20. C-14. R4.\nG1 C0\nG40 X60. F1500\nZ2.\nG13.1\n"
)


def messages(call: str, *sections: str, units: str = "G21") -> list[str]:
    program = f"O1\n{units} G98\n{call}\n{''.join(sections)}G0 Z50.\nM30\n"
    report = report_of(program, "fanuc-30i", "1:radius=4,nose=0", only=[RULE])
    return [finding.message for finding in report.findings]


@pytest.mark.ci
@looped(
    ("comment", "made"),
    [
        ("HEX 24 AF", "hexagon 22 mm across flats"),
        ("24 AF HEX", "hexagon 22 mm across flats"),
        ("EM8 HEX 24", "hexagon 22 mm across flats"),
        ("AF 24", "hexagon 22 mm across flats"),
        ("HEX 15/16 AF", "hexagon 22 mm across flats"),
        ("SQ 22", "hexagon 22 mm across flats"),
        ("DEPTH 6", "the cut is 5 mm deep"),
        ("HEX 22 AF, 0.5 DEEP", "the cut is 5 mm deep"),
    ],
    one_in=5,
)
@looped("form", ["T0101 ({})", "({})\nT0101", "T0101\n({})", "(T1 {})\nG97\nT0101"])
def test_another_size_shape_or_depth(comment: str, made: str, form: str) -> None:
    (message,) = messages(form.format(comment), HEXAGON)
    assert made in message
    assert f"{comment})" in message


@pytest.mark.ci
@looped(
    "comment",
    [
        "HEX 22 AF",
        "HEX 22.1 AF",
        "HEX 25.4",
        "AF 22",
        "DEPTH 5",
        "5 DEEP",
        "5.2 DEEP",
        "ROUGH HEX 24 AF",
        "HEX BAR 24",
        "HEX SOCKET 24",
        "FLATS 24",
        "DIA 30 BOSS",
        "HEX 24 AF DONE IN OP1",
        "DEPTH OF CUT 2",
        "T2 HEX 24 AF",
        "BAR DIA 26",
        "6 SIDES",
    ],
    one_in=2,
)
def test_what_contradicts_nothing(comment: str) -> None:
    assert messages(f"T0101 ({comment})", HEXAGON) == []


def test_a_comment_of_another_tool_or_section_is_not_of_this_one() -> None:
    assert messages("T0202 (HEX 24 AF)\nG1 Z2. F100\nT0101", HEXAGON) == []
    assert messages("(HEX 24 AF)\nG97 S100\nT0101", HEXAGON) == []
    assert messages("T0101", HEXAGON, "(HEX 24 AF)\n") == []
    assert len(messages("T0101", "(HEX 24 AF)\n", HEXAGON)) == 1
    # The nearest one counts.
    assert messages("T0101 (HEX 24 AF)", "(HEX 22 AF)\n", HEXAGON) == []
    assert len(messages("T0101 (HEX 22 AF)", "(HEX 24 AF)\n", HEXAGON)) == 1


def test_a_size_that_another_section_reaches_contradicts_nothing() -> None:
    small = HEXAGON.replace("22.", "20.").replace("6.351", "5.774").replace("12.702", "11.547")
    assert messages("T0101 (HEX 20 AF)", HEXAGON, "T0102\n", small) == []


def test_two_flats() -> None:
    turned = FLATS.replace("C0", "C180.")
    assert messages("T0101 (FLATS 22)", FLATS, turned) == []
    assert messages("T0101 (FLAT 11)", FLATS) == []


def test_a_depth_from_a_face_of_the_program() -> None:
    deep = HEXAGON.replace("Z-5.", "Z-15.")
    assert len(messages("T0101 (5 DEEP)", deep)) == 1
    assert messages("T0303\nG0 X50. Z-10.\nG1 X0 F100\nG0 Z50.\nT0101 (5 DEEP)", deep) == []
    # Where the tool comes from below Z0 nobody knows where the face is.
    assert messages("T0101 (5 DEEP)", deep.replace("Z2.", "Z-1.")) == []


def test_a_bar_smaller_than_the_part() -> None:
    (message,) = messages("(BAR DIA 27)\nT0101", RECTANGLE)
    assert "the contour reaches beyond it" in message
    assert messages("(BAR DIA 40)\nT0101", RECTANGLE) == []
    assert messages("(BAR DIA 24)\nT0101", HEXAGON) == [], "corners of a hexagon may be cut off by the bar"
    (message,) = messages("(STOCK D18)\nT0101", HEXAGON)
    assert "(STOCK D18) in line 3 states 18 mm" in message


def test_a_bar_that_a_rectangle_overshoots_is_one_with_two_flats() -> None:
    sharp = RECTANGLE
    for arc in ("G3 X12. C18. R4.", "G3 X-20. C14. R4.", "G3 X-12. C-18. R4.", "G3 X20. C-14. R4."):
        sharp = sharp.replace(arc + "\n", "")
    sharp = (
        sharp.replace("C14.\n", "C18.\n")
        .replace("X-12.", "X-20.")
        .replace("C-14.\n", "C-18.\n")
        .replace("X12.", "X20.")
    )
    assert messages("(BAR DIA 27)\nT0101", sharp.replace("G1 X", "X").replace("G1 C", "C")) == []


def test_a_bar_smaller_than_what_is_turned() -> None:
    turning = "T0202\nG97 S500 M3\nG0 X34. Z2.\nG1 X30. F100\nZ-20.\nG0 X60. Z50.\nM5\nT0101"
    (message,) = messages(f"(BAR DIA 25)\n{turning}", HEXAGON)
    assert "the program turns to 30 mm here" in message
    assert messages(f"(BAR DIA 32)\n{turning}", HEXAGON) == []


def test_sizes_in_inch() -> None:
    section = HEXAGON
    for old, new in (
        ("60.", "2.4"),
        ("22.", "1."),
        ("6.351", ".2887"),
        ("12.702", ".5774"),
        ("Z-5.", "Z-.2"),
        ("Z2.", "Z.1"),
        ("F1500", "F60."),
        ("F300", "F10."),
        ("F200", "F8."),
    ):
        section = section.replace(old, new)
    report = lambda comment: report_of(  # noqa: E731
        f"O1\nG20 G98\nT0101 ({comment})\n{section}M30\n", "fanuc-30i", "1:radius=.15,nose=0", only=[RULE]
    )
    assert report("HEX 1.0 AF").findings == []
    assert report("HEX 25.4MM AF").findings == []
    (finding,) = report("HEX 1-1/8 AF").findings
    assert finding.message.startswith("(HEX 1-1/8 AF) in line 3 states 1.125 inch; the part here: hexagon 1 inch")
    assert finding.severity == "warning"
