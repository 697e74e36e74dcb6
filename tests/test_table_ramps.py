"""Start-ups and offset cancels: which are missing, which are shorter than R, and which faults come of another one."""

from __future__ import annotations

import math

import pytest
from cases import looped
from programs import report_of, said, tables_of

HEAD = "T0101\nG98 G0 X60. C0\nG12.1\n"


def lines(program: str, column: str, *tools: str, **more: object) -> list[int]:
    """The lines, from 1 after G12.1, at which a column of ramps holds."""
    tables = tables_of(HEAD + program, "fanuc", *tools, **more)  # type: ignore[arg-type]
    return (tables["trace"].blocks.line[getattr(tables["ramps"], column)] - 3).tolist()


@pytest.mark.nightly
@looped(
    ("program", "start_up", "cancel"),
    [
        ("G41\nG13.1\n", [1], []),
        ("G41\nG40\nG1 X40. F100\nG13.1\n", [1], []),
        ("G41\nG40 X40.\nG13.1\n", [1], []),
        ("G41\nG40\nG1 G41 X40. F100\nG40 X60.\nG13.1\n", [1], []),
        ("G41\nG42\nG13.1\n", [1], []),
        # A move with Z alone is none on the plane.
        ("G1 G41\nZ1. F100\nG13.1\n", [1], []),
        ("G1 G41\nZ1. F100\nX40.\nG40 X60.\nG13.1\n", [], []),
        ("G41\nG0 X40.\nG40 X60.\nG13.1\n", [], []),
        # The second G41 is the one after which a move comes, the first has it too.
        ("G41\nG42\nG1 X40. F100\nG40 X60.\nG13.1\n", [], []),
        ("G1 G41 X40. F100\nC5.\nG40\nG13.1\n", [], [3]),
        ("G1 G41 X40. F100\nC5.\nG40\nG41\nC-5.\nG40 X60.\nG13.1\n", [], [3]),
        ("G1 G41 X40. F100\nC5.\nG40\nZ5.\nX60.\nG13.1\n", [], []),
        ("G1 G41 X40. F100\nC5.\nG40\nG0 X60.\nG13.1\n", [], []),
        # Words that name the present position are no move either.
        ("G1 G42 X60. C0 F100\nX40.\nC5.\nG40 X40. C5.\nX60.\nG13.1\n", [], []),
        ("G1 G42 X60. Z1. F100\nG13.1\n", [1], []),
        ("G1 G42 U0 F100\nG40 X40.\nG13.1\n", [1], []),
        ("G1 G41 X40. F100\nC5.\nG40 X40.\nG13.1\n", [], [3]),
        ("G1 G41 X40. F100\nC5.\nG40 H0\nC5.\nG13.1\n", [], [3]),
        # Without a move there is no offset mode that G40 could end.
        ("G1 X40. F100\nG40\nG13.1\n", [], []),
        # The mode left in offset mode is a fault of its own.
        ("G1 G41 X40. F100\nC5.\nG13.1\n", [], []),
    ],
)
def test_ramps_that_never_come(program: str, start_up: list[int], cancel: list[int]) -> None:
    assert lines(program, "start_up_missing", "1:radius=4") == start_up
    assert lines(program, "cancel_missing", "1:radius=4") == cancel


def test_the_next_section_makes_up_for_nothing() -> None:
    following = "G13.1\nG12.1\nG1 G41 X40. F100\nG40 X60.\nG13.1\n"
    assert lines("G41\n" + following, "start_up_missing") == [1]
    assert lines("G1 G41 X40. F100\nC5.\nG40\n" + following, "cancel_missing") == [3]


@looped(
    ("move", "tool", "short"),
    [
        # From X60 as a diameter: 4 mm are X52; the slanted way is one of 3, 4, 5.
        ("X52.", "1:radius=4", False),
        ("X52.002", "1:radius=4", True),
        # 30 - 26.1 is 3.9 but for a rounding.
        ("X52.2", "1:radius=3.9", False),
        ("C4.", "1:radius=4", False),
        ("C3.999", "1:radius=4", True),
        ("X54. C4.", "1:radius=5", False),
        ("X54. C4.", "1:radius=5.001", True),
        ("X52.002", "1:radius=-4", True),
        ("X52.", "1:radius=-4", False),
        # No way at all is no ramp: the next block that moves is.
        ("X60.", "1:radius=4", False),
        ("X60.002", "2:radius=4", False),
    ],
)
def test_moves_shorter_than_the_radius(move: str, tool: str, short: bool) -> None:
    program = f"G1 G41 {move} F100\nC50.\nG40 X100.\nG13.1\n"
    assert (1 in lines(program, "shorter_than_radius", tool)) == short


def test_what_hangs_on_a_radius_that_is_not_known() -> None:
    """Straight ramps; a block without a move is none, and neither is an arc."""
    straight = "G1 G41 X40. F100\nC50.\nG40 X100.\nG13.1\n"
    assert lines(straight, "start_up_judged_by_radius") == [1]
    assert lines(straight, "cancel_judged_by_radius") == [3]
    standing = "G1 G41 X60. F100\nC50.\nG40 C50.\nG13.1\n"
    assert lines(standing, "start_up_judged_by_radius") == [2]
    assert lines(standing, "cancel_judged_by_radius") == []
    on_arc = "G1 X50. F100\nG41 G3 X40. C5. I-5. J0\nG1 X20.\nG40 G2 X30. C0 R9.\nG13.1\n"
    assert lines(on_arc, "start_up_judged_by_radius") == []
    assert lines(on_arc, "cancel_judged_by_radius") == []
    # X is not known before its first word.
    unknown = tables_of("G98\nG12.1\nG1 G41 X40. F100\nC50.\nG40 X100.\nG13.1\n")
    assert math.isnan(unknown["trace"].path.length[2])
    assert unknown["ramps"].start_up_judged_by_radius.tolist() == [False] * 2 + [True] + [False] * 3


#: A contour of lines about the center, from its start-up to its offset cancel, on a sound approach and retract.
AROUND = "{start}G12.1\n{on}C10.\nX-40.\nC-10.\nX40.\nC0\n{off}G13.1\nG0 Z50.\nM30\n"
ON_MM = ("O1\nG21 G40 G97 G98 G18\nT0101\nG0 X140. Z2. C0\n", "1:radius=6")
ON_INCH = ("O1\nG20 G40 G97 G98 G18\nT0101\nG0 X140. Z.1 C0\n", "1:radius=.375")
G40_ALONE, G40_STANDING = "G40\nX140.\n", "G40 X40. C0\nX140.\n"


@pytest.mark.nightly
@looped("machine", ["fanuc", "turning-center", "gsk-988"], one_in=14)
@looped(("start", "tool"), [ON_MM, ON_INCH], ids=["mm", "inch"])
@looped("off", ["G40 X140.\n", G40_ALONE, G40_STANDING, "G40 U0\nX140.\n"])
@looped(
    "on",
    [
        "G01 G42 X140. C0 F50.\nG01 X40.\n",
        "G1 G42 F50.\nX40.\n",
        "G1 G42 U0 H0 F50.\nM8\nX40.\n",
        "G42\nG1 Z-.1 F50.\nX40.\n",
    ],
)
def test_a_block_that_moves_nothing_is_no_ramp(on: str, off: str, start: str, tool: str, machine: str) -> None:
    report = report_of(
        AROUND.format(start=start, on=on, off=off), machine, tool, only=("compensation", "motion", "feed")
    )
    assert [found for found in report.findings if found.severity != "note"] == []


@pytest.mark.nightly
def test_the_move_after_a_standing_block_is_the_ramp() -> None:
    """Of 5 mm along X, in diameters 10 mm, where 6 mm are asked for."""
    program = AROUND.format(start=ON_MM[0], on="G1 X50. F500\nG42 X50. C0\nX40.\n", off="G40 X40.\nX50.\n")
    report = report_of(program, "fanuc", ON_MM[1])
    assert said(report) == [(8, "start-up-shorter-than-radius")]
    follows = [(finding.line, finding.rule) for finding in report.findings[0].follows]
    assert (15, "cancel-shorter-than-radius") in follows


def test_an_arc_after_a_standing_block_is_the_ramp() -> None:
    program = "G1 X50. F200\nG42 X50.\nG3 X40. C5. I-5. J0\nG1 X20.\nG40 C20.\nG13.1\n"
    assert said(report_of(HEAD + program, "fanuc", "1:radius=4")) == [(6, "start-up-on-arc")]


@looped("off", ["G40\n", "G40 X40.\n", "G40 X40. C0\n", "G40 U0\n"], one_in=12)
@looped(("machine", "severity"), [("fanuc", "error"), ("gsk-988", "note"), ("turning-center", "error")])
def test_a_cancel_that_never_comes(off: str, machine: str, severity: str) -> None:
    program = AROUND.format(start=ON_MM[0], on="G1 G42 X40. F50.\n", off=off)
    found = [(one.rule, one.severity) for one in report_of(program, machine, ON_MM[1]).findings if one.line == 12]
    assert found == [("cancel-shorter-than-radius", severity)]


@pytest.mark.nightly
def test_a_cancel_too_short_is_an_error_on_every_control() -> None:
    program = AROUND.format(start=ON_MM[0], on="G1 G42 X40. F50.\n", off="G40 X45.\n")
    for machine in ("fanuc", "gsk-988"):
        (found,) = report_of(program, machine, ON_MM[1]).findings
        assert (found.rule, found.severity) == ("cancel-shorter-than-radius", "error")


@looped(
    ("program", "again"),
    [
        ("G1 G41 X40. F100\nC5.\nG42 C-20.\nG40 X80.\nG13.1\n", [3]),
        ("G1 G41 X40. F100\nC5.\nG41 C-20.\nG41\nC-30.\nG40 X80.\nG13.1\n", [3, 4]),
        # Before the first move there is no offset mode, and after G40 none any more.
        ("G41\nG1 G42 X40. F100\nC5.\nG40 X80.\nG41 X40.\nG40 X80.\nG13.1\n", []),
        ("G1 G41 X40. F100\nC5.\nG40\nG41 C-20.\nG40 X80.\nG13.1\n", []),
    ],
)
def test_a_side_written_again(program: str, again: list[int]) -> None:
    assert lines(program, "writes_side_again", "1:radius=4") == again


def test_compensated_moves_are_those_on_the_plane() -> None:
    program = "G1 X50. F100\nG41 X40.\nZ-1.\nC5.\nM8\nG40 X60.\nX70.\nG13.1\n"
    assert lines(program, "compensated", "1:radius=4") == [2, 4]


def test_radius_of_arcs() -> None:
    """By I and J 5 at start and end; the second arc ends 4 from its center, which is the smaller one."""
    program = "G1 X60. F100\nG3 X50. C5. I-5. J0\nX40. C0 I0 J-5.\nG1 X60.\nG2 X50. C-4. I-5. J0\nG13.1\n"
    ramps = tables_of(HEAD + program)["ramps"]
    assert ramps.arc_radius[[4, 5, 7]] == pytest.approx([5, 5, 4])
    assert math.isnan(ramps.arc_radius[6])


#: A pocket of 6 mm by steps: with R 4 each block between the fourth and the ninth is too short.
POCKET = (
    "G1 C20. F500\nG41 X50. F200\nC3.\nX47. C2.598\nX44.804 C1.5\nX44. C0\nX44.804 C-1.5\nX47. C-2.598\nX50. C-3.\n"
    "C-20.\nG40 X90.\nG13.1\n"
)


def test_of_neighbouring_faults_the_first_is_none_of_another() -> None:
    tables = tables_of(HEAD + POCKET, "fanuc", "1:radius=4")
    tool_center, ramps, line = tables["tool_center"], tables["ramps"], tables["trace"].blocks.line - 3
    faulty = line[tool_center.interferes | tool_center.no_intersection].tolist()
    assert len(faulty) > 2
    own = line[(tool_center.interferes | tool_center.no_intersection) & ~ramps.is_consequence].tolist()
    expected = [at for at in faulty if at - 1 not in faulty]
    assert own == expected
    assert len(own) < len(faulty)


@looped(
    ("program", "expected"),
    [
        # An arc of 3 mm at R 4: itself and the moves on both sides.
        ("G1 C20. F500\nG41 X40. F200\nC0\nG3 X46. C-3. R3.\nG1 X60.\nC-9.\nG40 X80.\nG13.1\n", [3, 4, 5]),
        ("G1 C20. F500\nG41 X40. F200\nC5.\nG42 C-20.\nC-30.\nG40 X80.\nG13.1\n", [3, 4, 5]),
        # A start-up on an arc.
        ("G1 X50. F200\nG42 G3 X40. C5. I-5. J0\nG1 X20.\nG40 C20.\nG13.1\n", [1, 2, 3]),
        # Of the next section nothing.
        ("G1 G41 X40. F200\nG3 X46. C-3. R3.\nG13.1\nG12.1\nG1 X20.\nG13.1\n", [1, 2]),
        ("G1 C20. F500\nG41 X40. F200\nC-20.\nG40 X80.\nG13.1\n", []),
    ],
)
def test_what_stands_beside_a_cause(program: str, expected: list[int]) -> None:
    assert lines(program, "is_consequence", "1:radius=4") == expected
