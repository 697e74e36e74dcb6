"""Numbers without a decimal point: which are reported, and for how many others each stands."""

from __future__ import annotations

from typing import Any

from cases import looped
from programs import report_of, tables_of

POINTED = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX-40.\nG13.1\n"
IN_INCREMENTS = "G98 G0 X60000 C0\nG12.1\nG1 X40000 F200\nC10000\nC-500\nX-40000\nG13.1\n"
HEAD = "O1\nG98 G0 X60. C0\nG12.1\n"


def counts(program: str, column: str, **changes: Any) -> dict[str, int]:
    """What each reported word stands for, by line and word."""
    tables = tables_of(program, changes=changes)
    words, lines = tables["words"], tables["text"].blocks.line
    found = getattr(tables["unpointed"], column)
    return {
        f"{lines[words.block[at]]} {chr(words.address[at])}{words.value[at]:g}": int(found[at])
        for at in found.nonzero()[0]
    }


@looped(
    ("program", "expected"),
    [
        (POINTED, {}),
        # in the mode
        (HEAD + "G1 X40. F200\nC5\nX-40.\nC-5\nX30.\nG13.1\n", {"5 C5": 1, "7 C-5": 1}),
        (HEAD + "G1 X40 F200\nC5\nX-40\nX30.\nG13.1\n", {"4 X40": 1, "5 C5": 1, "6 X-40": 1}),
        (HEAD + "G1 X40 F200\nC5\nX-40.\nC-5.\nG13.1\n", {"4 X40": 1, "5 C5": 1}),
        # blocks that position X and C for the section, and the others
        (
            "G98 G0 X70 Z50\nX60 Z5.\nC5\nM8\nG12.1\nG1 X40. C3. F200\nC8.\nG13.1\nG0 X70\n",
            {"1 X70": 1, "1 Z50": 1, "2 X60": 1, "3 C5": 1, "9 X70": 1},
        ),
        ("G12.1\nG1 X40. C3. F200\nC8.\nG13.1\nG0 X70\n", {"5 X70": 1}),
        (
            "G0 Z5\nW-2\nX7.\nG12.1\nG1 X40. C3. F200\nC8.\nG13.1\nG4 P5\nG0 X70\nZ0\n",
            {"1 Z5": 1, "2 W-2": 1, "9 X70": 1},
        ),
        # beside a number that cannot be read nothing is
        (HEAD + "G1 X40. F200\nX3O.5.O C5\nC8 X--5.\nC6\nG13.1\n", {"7 C6": 1}),
        # 0 is 0
        (HEAD + "G1 X0 C10. F200\nC-10.\nX60.\nG13.1\n", {}),
        # large ones
        ("G0 Z1000\nZ999\n" + POINTED + "G0 U-2000\n", {"1 Z1000": 1, "2 Z999": 1, "9 U-2000": 1}),
        (HEAD + "G1 X40. F200\nC5\nZ1000\nX-40.\nG13.1\n", {"5 C5": 1, "6 Z1000": 1}),
        # but for programs without a section
        ("G0 X60. Z1000\nX50.\n", {}),
        ("O1\nG0 X60. Z1000\nM30\nO2\n" + POINTED + "M30\n", {}),
        # and no other word than coordinates
        ("G0 X200.\nG4 X1000\nG28 U1000\nS2000\nG10 L2 P1 X1000\n" + POINTED, {}),
        # in inch the F of the mode, too
        ("G20\nG0 X60. F5\n" + HEAD + "G1 X40. F8\nC5. F.5\nC6. F0\nG13.1\n", {}),
        (HEAD.replace("G98", "G20 G98") + "G1 X40. F8\nC5. F.5\nC6. F0\nG13.1\nG1 X50. F9\n", {"4 F8": 1}),
        (HEAD.replace("G98", "G20 G99") + "G1 X40. F8\nG13.1\n", {}),
        (IN_INCREMENTS, {}),
        (IN_INCREMENTS.replace("G98", "G20 G98"), {}),
    ],
)
def test_slips(program: str, expected: dict[str, int]) -> None:
    assert counts(program, "slips") == expected


@looped(
    ("program", "expected"),
    [
        (POINTED, {}),
        ("G0 Z1000\n" + POINTED, {}),
        (IN_INCREMENTS, {"1 X60000": 5}),
        ("G0 X100. Z2.\n" + IN_INCREMENTS, {"2 X60000": 5}),
        (f"O1\n{IN_INCREMENTS}M30\nO2\n{POINTED}M30\nO3\n{IN_INCREMENTS}M30\n", {"2 X60000": 5, "19 X60000": 5}),
    ],
)
def test_programs_in_least_increments(program: str, expected: dict[str, int]) -> None:
    assert counts(program, "in_increments") == expected


def test_two_programs_of_a_file_are_told_apart() -> None:
    file = f"O1\n{IN_INCREMENTS}M30\nO2\n{POINTED.replace('C10.', 'C20')}M30\n"
    assert counts(file, "in_increments") == {"2 X60000": 5}
    assert counts(file, "slips") == {"14 C20": 1}


def test_a_word_that_runs_often_counts_once() -> None:
    loop = HEAD + "#1=0\nWHILE[#1LT3]DO1\nG1 X40. C5 F200\nC-5.\nX50.\n#1=#1+1\nEND1\nG13.1\nM30\n"
    assert counts(loop, "slips") == {"6 C5": 1}
    called = "O1\nG98 G0 X60000 C0\nG12.1\nM98 P30002\nG13.1\nM30\nO2\nG1 X40000 C2000 F200\nX50000\nM99\n"
    assert counts(called, "in_increments") == {"2 X60000": 4}


def test_a_word_of_a_macro_statement_lets_another_speak() -> None:
    """Its place is that of the whole statement; it counts all the same."""
    program = HEAD.replace("X60.", "X60000") + "#1=5.\nG1 X40000 C#1 F200\nX30000\nC-2000\nG13.1\n"
    assert counts(program, "in_increments") == {"2 X60000": 4}
    assert counts(program.replace("X60000", "X60."), "in_increments") == {"6 X30000": 3}
    assert counts(HEAD + "#1=5.\nG1 X40 C#1 F200\nX30.\nC-2.\nG13.1\n", "slips") == {}


def test_a_control_that_counts_whole_units_reports_nothing() -> None:
    control = {"number_without_point": "whole-unit"}
    for program in (IN_INCREMENTS, POINTED.replace("C10.", "C20"), HEAD.replace("G98", "G20 G98") + "G1 X4. F8\n"):
        assert counts(program, "slips", control=control) == counts(program, "in_increments", control=control) == {}


def test_the_finding_says_what_the_control_takes() -> None:
    def told(program: str) -> list[tuple[str, str]]:
        found = report_of(program, only=("number-without-point",)).findings
        return [(finding.severity, finding.message) for finding in found]

    text = "{} has no decimal point: the control takes it as {}"
    assert told("G0 Z1000\n" + POINTED) == [("warning", text.format("Z1000", "1 mm"))]
    assert told("G20\nG0 Z1000\n" + POINTED.replace("F200", "F20.")) == [("warning", text.format("Z1000", "0.1 inch"))]
    whole = "; the whole program is read in least increments, 5 of its coordinates have no point"
    assert told(IN_INCREMENTS) == [("note", text.format("X60000", "60 mm") + whole)]
    assert told("G20\n" + IN_INCREMENTS) == [("note", text.format("X60000", "6 inch") + whole)]
