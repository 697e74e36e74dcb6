"""Comments that state shape, size, depth or bar, beside what the program makes."""

from __future__ import annotations

import re

import pytest
from cases import looped
from programs import report_of

from polarcheck.columns.words import comment_reader
from polarcheck.columns.words.comment_patterns import PART_SIZE, ROUGHING, TITLE_DIAMETER

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


SHARP_RECTANGLE = (
    "G0 X80. Z2. C0\nG12.1\nG1 X80. C0 F1500\nZ-5. F300\nG42 X24. F200\nC10.\nX-24.\nC-10.\nX24.\nC0\n"
    "G40 X80. F1500\nZ2.\nG13.1\n"
)
PIN = (
    "G0 X70. Z2. C0\nG12.1\nG1 X70. C0 F1500\nZ-5. F300\nG42 X28. F200\nG3 X-16. C0 R11.\nX28. C0 R11.\n"
    "G1 G40 X70. F1500\nZ2.\nG13.1\n"
)
KEYWAY = (
    "G0 X70. Z2. C0\nG12.1\nG1 X70. C0 F1500\nZ-5. F300\nG42 X50. C-5. F200\nX20.\nC5.\nX50.\n"
    "G40 X70. C0 F1500\nZ2.\nG13.1\n"
)


def messages(call: str, *sections: str, units: str = "G21", title: str = "O1") -> list[str]:
    program = f"{title}\n{units} G98\n{call}\n{''.join(sections)}G0 Z50.\nM30\n"
    report = report_of(program, "fanuc-30i", "1:radius=4,nose=0", only=[RULE])
    return [finding.message for finding in report.findings]


@pytest.mark.ci
@looped(
    ("old", "new"),
    [("X-22. C6.351\nC-6.351", "X-23. C6.351\nC-6.351"), ("X0 C12.702", "X1. C12.9"), ("X-22. C6.351", "X-21. C7.")],
)
@looped("machine", ["fanuc-30i", "doosan", "gsk-988"])
def test_a_polygon_with_the_sides_of_the_comment_is_regular(old: str, new: str, machine: str) -> None:
    def told(*sections: str, comment: str = "HEX 22 AF") -> list[str]:
        program = f"O1\nG21 G98\nT0101 ({comment})\n{''.join(sections)}G0 Z50.\nM30\n"
        return [found.message for found in report_of(program, machine, "1:radius=4,nose=0", only=[RULE]).findings]

    uneven = HEXAGON.replace(old, new)
    assert told(HEXAGON) == []
    (message,) = told(uneven)
    assert "states hexagon 22 mm; the polygon here is not regular" in message
    assert told(uneven, comment="HEX 22 AF ROUGH") == []
    assert told(uneven, HEXAGON) == []
    assert told(uneven, comment="6 SIDES, EM8") == []


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


@pytest.mark.ci
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


@pytest.mark.nightly
@looped(
    ("comment", "sections", "message"),
    [
        ("HEX 24 AF", [HEXAGON], "states 24 mm; the part here: hexagon 22 mm across flats"),
        ("SHAFT 24 AF FROM HEX 32", [HEXAGON], "states 24 mm; the part here: hexagon 22 mm across flats"),
        ("HEX 24 AF, MATERIAL HEX 22", [HEXAGON], "states 24 mm; the part here: hexagon 22 mm across flats"),
        ("HEX 24 AF, SQ 30", [HEXAGON], "states 24 mm; the part here: hexagon 22 mm across flats"),
        ("SQ 22", [HEXAGON], "states square 22 mm; the part here: hexagon 22 mm across flats"),
        ("SQ 24", [SHARP_RECTANGLE], "states square 24 mm; the part here: rectangle 20 mm on one side"),
        ("SQ 20 AF", [SHARP_RECTANGLE], "states square 20 mm; the part here: rectangle 24 mm on one side"),
        ("FLATS 24", [FLATS, FLATS.replace("C0", "C180.")], "states 24 mm; the part here: flats 22 mm apart"),
        ("DIA 20 PIN", [PIN], "states 20 mm; the part here: circle 22 mm in diameter"),
        ("ECC DIA 20", [PIN], "states 20 mm; the part here: circle 22 mm in diameter"),
        ("20 DIA ECCENTRIC", [PIN], "states 20 mm; the part here: circle 22 mm in diameter"),
        ("KEYWAY 8", [KEYWAY], "states 8 mm; the part here: keyway 10 mm wide"),
        ("KEYWAY 12 X 5", [KEYWAY], "states 12 mm; the part here: keyway 10 mm wide"),
    ],
)
@looped("form", ["O1 ({})/T0101", "O1/T0101 ({})"])
def test_sizes_in_the_title_and_beside_the_tool(comment: str, sections: list[str], message: str, form: str) -> None:
    title, call = form.format(comment).split("/T")
    (found,) = messages(f"T{call}", *sections, title=title)
    assert found.endswith(message)


@pytest.mark.nightly
@looped(
    "comment",
    [
        "HEX 22 AF",
        "HEX 32 BAR",
        "HEX 24 AF STOCK",
        "MATERIAL HEX 32 AF",
        "MATERIAL: SQ 30",
        "SECHSKANT 32 ROH",
        "SHAFT 22 AF FROM HEX 32",
        "22 SW AUS 6KT 32",
        "FROM SQ 40",
        "HEX 22 AF, SQ 20",
        "HEX 24 AF, LEAVE 0.5",
        "HEX 22 AF STOCK 0.3",
        "HEX 24 AF SCHRUPPEN",
        "HEX 24 EBAUCHE",
        "DIA 20",
        "DIA 40 SHAFT",
        "DIA 20 PIN HOLE",
        "KEYWAY 8",
        "ECC 2",
    ],
    one_in=2,
)
@looped("form", ["O1 ({})/T0101", "O1/T0101 ({})"])
def test_sound_titles_and_bars(comment: str, form: str) -> None:
    title, call = form.format(comment).split("/T")
    assert messages(f"T{call}", HEXAGON, title=title) == []


@pytest.mark.ci
def test_a_title_counts_for_one_shape() -> None:
    small = HEXAGON.replace("22.", "20.").replace("6.351", "5.774").replace("12.702", "11.547").replace("Z-5.", "Z-3.")
    deeper = HEXAGON.replace("Z-5.", "Z-8.")
    assert len(messages("T0101", HEXAGON, deeper, title="O1 (HEX 24 AF)")) == 1
    assert len(messages("T0101", HEXAGON, title="O1\n(HEX 24 AF)")) == 1
    assert messages("T0101", HEXAGON, small, title="O1 (HEX 24 AF)") == []
    # Another program may make it.
    assert messages("T0101", HEXAGON, title="O1 (SQ 18)") == []
    assert messages("T0101", SHARP_RECTANGLE, title="O1 (SQ 40 FLANGE)") == []
    # The nearer comment counts, and roughing leaves something.
    assert messages("T0101 (HEX 22 AF)", HEXAGON, title="O1 (HEX 24 AF)") == []
    assert messages("T0101 (EM8 ROUGH)", HEXAGON, title="O1 (HEX 24 AF)") == []
    assert messages("T0101 (EM8 ROUGH)\n(HEX 21 AF)", HEXAGON) == []


@pytest.mark.ci
def test_a_diameter_in_the_title() -> None:
    turning = "T0202\nG97 S500 M3\nG0 X34. Z2.\nG1 X30. F100\nZ-20.\nG0 X60. Z50.\nM5\nT0101"
    (message,) = messages("T0101", PIN, title="O1 (SHAFT DIA 20)")
    assert message.endswith("(SHAFT DIA 20) in line 1 states 20 mm; the part here: circle 22 mm in diameter")
    assert messages("T0101", PIN, title="O1 (SHAFT DIA 40)") == []
    assert messages(turning, PIN, title="O1 (SHAFT DIA 20)") == []
    assert messages("T0101 (DIA 20)", PIN) == []


#: A comment for each way in which a form of sizes can be written, with the words that spare its pattern.
_WITH_FORMS = [
    *(f"{name} 24" for name in ("HEX", "HEXAGON", "SECHSKANT", "6KT", "6-KT", "6KANT", "6-KANT")),
    *(f"{name} AF 24" for name in ("SQ", "SQUARE", "VIERKANT", "4KT", "4-KT", "4KANT", "4-KANT", "OCT", "PENT")),
    *(form for name in ("HEX", "SQ", "OCT", "PENT") for form in (f"24 AF {name}", f"24MM {name}")),
    *("FLATS AT 22", "FLATS ACROSS FLATS 22", "KEYWAY 6"),
    *("DIA 30 BOSS", "PIN DIA 30", "30 DIA ECC", "\u00d830 ROUND ECCENTRIC"),
    *("24 AF", "24 A/F", "24 A.F.", "24 ACROSS THE FLATS", "24 SW", "AF 24", "A/F 24", "SW 24"),
    *("DIA 30", "DIAMETER 30", "\u00d830", "\u230030"),
]


def test_each_comment_of_a_form_has_one_of_its_words() -> None:
    forms = [*PART_SIZE.forms, TITLE_DIAMETER]
    matching = [(form, comment) for form in forms for comment in _WITH_FORMS if re.search(form.pattern, comment)]
    assert {form.pattern for form, _ in matching} == {form.pattern for form in forms}
    assert all(any(word in comment for word in form.words) for form, comment in matching)


def test_each_word_of_roughing_has_one_of_an_allowance() -> None:
    left = "ROUGHING, SEMI FINISH, SEMIFIN, LEAVES, LEAVING, ALLOWANCE, SCHRUPPEN, AUFMASS, UEBERMASS, EBAUCHE"
    for comment in f"{left}, SURepaisseur, SGROSSATURA, SOVRAMETALLO, DESBASTE".upper().split(", "):
        assert re.search(ROUGHING, comment)
        assert comment_reader.allowance_in(comment, in_inch=False) > 0
