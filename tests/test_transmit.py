"""TRANSMIT of Siemens controls: the sense of C, and where a section begins that no C word stands before."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import moves_of, report_of, said, tables_of, trace_of

from polarcheck.columns.path.moves import Moves

MACHINE = "siemens-transmit"
HEAD = "G94 S2=1000 M2=3\nDIAMOF\nG0 X40 {c} Z5\n"
#: A quarter of a turn and back, without compensation.
SECTION = "TRANSMIT\nG17\nG1 X20 Y0 F300\nX0 Y20\nTRAFOOF\n"
SECOND = "{between}\nTRANSMIT\nG1 X30 Y0\nTRAFOOF\nM30\n"
OTHER_SENSE = {"polar": {"zero_angle": "at-c0"}}


def run(program: str, **more: Any) -> Moves:
    return moves_of(program, MACHINE, **more)


@looped(
    ("word", "start", "angles"),
    [
        ("C90", -40j, [90, 0, -90]),
        ("C=DC(90)", -40j, [90, 0, -90]),
        ("SPOS=90", -40j, [90, 0, -90]),
        ("C0", 40, [0, 0, -90]),
        ("C-270", -40j, [-270, -360, -450]),
    ],
)
def test_c_runs_against_the_plane(word: str, start: complex, angles: list[float]) -> None:
    """Machine data 24910 = 1: at C90 the tool stands at -90 deg of the plane, and X20 Y0 is at C0."""
    moves = run(HEAD.format(c=word) + SECTION + "M30\n")
    np.testing.assert_allclose(moves.start[0], start, atol=1e-9)
    np.testing.assert_allclose([moves.c_angles[0][0], *moves.c_angles[1]], angles, atol=1e-9)
    trace = trace_of(HEAD.format(c=word) + SECTION + "M30\n", MACHINE)
    np.testing.assert_allclose(trace.path.c_angle[-1], angles[-1], atol=1e-9)


@looped("changes", [OTHER_SENSE, {"parameters": {"24910": 0}}])
def test_the_owner_says_the_sense_of_c(changes: dict[str, Any]) -> None:
    moves = run(HEAD.format(c="C90") + SECTION + "M30\n", changes=changes)
    np.testing.assert_allclose(moves.start[0], 40j, atol=1e-9)
    np.testing.assert_allclose([moves.c_angles[0][0], *moves.c_angles[1]], [90, 0, 90], atol=1e-9)


@pytest.mark.nightly
@looped(
    ("between", "of_plane", "angle", "angle_of_other_sense"),
    [
        ("", 90, -90, 90),
        ("G0 X20", 90, -90, 90),
        ("M70", 90, -90, 90),
        ("G0 C=IC(90)", 0, 0, 180),
        ("G91 G0 C45\nG90", 45, -45, 135),
        ("G0 C0", 0, 0, 0),
        ("SPOS=180", 180, 180, 180),
    ],
    one_in=2,
)
def test_a_second_section_begins_where_c_stands(
    between: str, of_plane: float, angle: float, angle_of_other_sense: float
) -> None:
    program = HEAD.format(c="C0") + SECTION + SECOND.format(between=between)
    for changes, of_tool, of_c in (
        ({}, of_plane, angle),
        (OTHER_SENSE, angle_of_other_sense, angle_of_other_sense),
    ):
        moves = run(program, changes=changes)
        np.testing.assert_allclose(moves.start[-1], 20 * np.exp(1j * np.radians(of_tool)), atol=1e-9)
        np.testing.assert_allclose(moves.c_angles[0][-1], of_c, atol=1e-9)
        # Both sections lie on the part alike, whatever C was before them.
        assert not (trace_of(program, MACHINE, changes=changes).path.section_entry % 360).any()


def test_where_c_was_never_said_the_second_section_goes_on_from_the_first() -> None:
    program = HEAD.format(c="") + SECTION + SECOND.format(between="G0 Z50")
    assert run(program).start[-1] == pytest.approx(20j)


def test_a_fanuc_begins_its_plane_at_g12_1() -> None:
    program = "G98 G0 X80. C90. Z5.\nG12.1\nG1 X40. C0 F300.\nX0 C20.\nG13.1\nG12.1\nG1 X60. C0\nG13.1\nM30\n"
    moves = moves_of(program, "fanuc")
    assert moves.start[-1] == pytest.approx(20)
    np.testing.assert_allclose(moves.c_angles[1], [90, 180, 180], atol=1e-9)


# ---- F and the units of lengths ----


@looped(
    ("units", "lengths", "feed"),
    [
        ("G70", 25.4, 300),
        ("G71", 1, 300),
        ("G700", 25.4, 7620),
        ("G710", 1, 300),
        ("", 1, 300),
        ("G700 F300\nG70", 25.4, 7620),  # F was read in inch, and stays in force
        ("G70\nG700", 25.4, 7620),
    ],
)
def test_g70_leaves_f_alone(units: str, lengths: float, feed: float) -> None:
    """802D sl BP-N p. 8-139: G70 and G71 do not influence F, G700 and G710 do; the basic system is metric."""
    written = "" if "F" in units else " F300"
    program = f"G94 S2=1000 M2=3\nDIAMOF\n{units}\nG0 X40 C0 Z5\nTRANSMIT\nG17\nG1 X20{written}\nY1\nTRAFOOF\nM30\n"
    moves = run(program)
    assert moves.end[0] == pytest.approx(20 * lengths)
    assert moves.feed == pytest.approx(feed)


@looped(("units", "feed"), [("G70", 7620), ("G71", 7620), ("G710", 300), ("", 7620)])
@looped("changes", [{"parameters": {"10240": 0}}, {"control": {"units": "inch"}}])
def test_on_an_inch_basic_system_f_is_in_inch(units: str, feed: float, changes: dict[str, Any]) -> None:
    program = f"G94 S2=1000 M2=3\nDIAMOF\n{units}\nG0 X2 C0 Z1\nTRANSMIT\nG17\nG1 X1 F300\nY1\nTRAFOOF\nM30\n"
    assert run(program, changes=changes).feed == pytest.approx(feed)


def test_messages_and_fixes_have_f_in_its_own_units() -> None:
    """F3000 under G70 is 3000 mm/min: so it is said, and so is the F that is low enough."""
    program = "G94 S2=1000 M2=3\nDIAMOF\nG70\nG0 X2 C0 Z1\nTRANSMIT\nG17\nG1 X1 F3000\nX.05 Y.1\nX1\nTRAFOOF\nM30\n"
    report = report_of(program, MACHINE, changes={"limits": {"c_feed": 7200}})
    (finding,) = [finding for finding in report.findings if finding.rule == "c-feed-above-limit"]
    assert " mm/min" in finding.message
    assert "inch/min" not in finding.message


# ---- near the pole ----


def test_near_the_pole_the_control_slows_down_by_itself() -> None:
    """A note with the F that remains, limit of C times the distance, and the longer time."""
    program = "G94 S2=1000 M2=3\nDIAMOF\nG0 X30 C0 Z1\nTRANSMIT\nG17\nG1 X20 Y2 F600\nX-20\nX-30\nTRAFOOF\nM30\n"
    changes = {"limits": {"c_feed": 7200}}
    report = report_of(program, MACHINE, changes=changes)
    (finding,) = report.findings
    assert (finding.rule, finding.severity, report.verdict) == ("c-feed-above-limit", "note", "pass")
    remains = 7200 * np.radians(1) * 2
    assert f"{remains:.0f} mm/min" in finding.message
    # On y = 2 C turns by atan; it is held at 7200 deg/min where it would be faster: 600 mm/min / (2 (1 + x^2 / 4)).
    held = np.sqrt(600 / np.radians(7200) * 2 - 4)
    slowed = np.degrees(2 * np.arctan(held / 2)) / 7200 * 60
    whole = slowed + (40 - 2 * held) / 600 * 60
    assert f"takes {whole:.3g} s instead of 4 s" in finding.message
    assert moves_of(program, MACHINE, changes=changes).time.sum() < report_time(program, changes)


def report_time(program: str, changes: dict[str, Any]) -> float:
    dynamics = tables_of(program, MACHINE, changes=changes)["dynamics"]
    return float(np.nansum(dynamics.move_time))


#: As a post writes it: the tool change loses X, and C is nowhere.
POSITIONED_IN_MODE = """%
N1 G94 G17 DIAMOF
T="FRAESER" D1
M6
G54 G0 Y0
TRANSMIT
{first}
G1 X18 Y0 F250
X0 Y20
TRAFOOF
M30
"""


@looped(
    ("first", "is_known"),
    [
        ("G0 Z5\nG0 X40 Y10", True),
        ("G0 X40", False),
        ("G0 X=IC(5) Y10", False),
        ("G1 G41 X40 Y10 F200", False),
    ],
)
def test_a_first_move_in_the_mode_positions_x_and_c(first: str, is_known: bool) -> None:
    """Nothing hangs on the place of the tool at TRANSMIT where a G0 behind it writes both axes."""
    found = report_of(POSITIONED_IN_MODE.format(first=first), MACHINE, only=("setup",)).findings
    assert ["x-unknown-at-entry"] * (not is_known) == [finding.rule for finding in found]


@looped(("machine", "on", "off"), [(MACHINE, "TRANSMIT", "TRAFOOF"), ("haas-lathe", "G112", "G113")])
@looped(
    ("between", "behind", "rule"),
    [
        ("", "G0 X35. Y10.\n", "polar-entered-twice"),
        ("G0 X35. Y10.\n", "", "polar-entered-twice"),
        ("G0 X35. Y10.\nG1 X20. Y0 F300.\nX0 Y20.\nG0 Z50.\nG0 X80. C90.\n", "", "polar-never-left"),
    ],
)
def test_the_mode_switched_on_again_before_the_first_cut_is_one_too_many(
    machine: str, on: str, off: str, between: str, behind: str, rule: str
) -> None:
    """G0 can stand in the mode there: it does not say that the mode was left above it."""
    cuts = f"{between}{on}\n{behind}G1 X20. Y0 F300.\nX0 Y20.\n{off}\n"
    found = report_of(f"G94 G97\nG0 X80. C0 Z5.\n{on}\n{cuts}M30\n", machine, only=("polar",)).findings
    assert [finding.rule for finding in found] == [rule]


@looped(
    ("word", "what"),
    [
        ("SPOS=0", "SPOS positions the spindle, which is the C axis of the mode"),
        ("POS[C]=0", "POS[C] positions the spindle, which is the C axis of the mode"),
        ("SETMS(3) SPOS=0", "SPOS positions another spindle"),
        ("C0", "write Y"),
    ],
)
def test_a_spindle_that_is_positioned_in_the_mode_is_no_coordinate(word: str, what: str) -> None:
    program = HEAD.format(c="C0") + "TRANSMIT\n" + word.replace(" ", "\n") + "\nG1 X20 Y0 F300\nX0 Y20\nTRAFOOF\nM30\n"
    (found,) = report_of(program, MACHINE, only=("wrong-axis-address-in-polar",)).findings
    assert found.message.startswith(word.partition(") ")[2] or word)
    assert what in found.message
    assert "dialect" not in found.message


# ---- another tool in the mode ----

TWO_TOOLS = """T8 D1
G94 S2=1000 M2=3
DIAMOF
G0 X40 C0 Z5
TRANSMIT
G17
G0 X30 Y0
G0 Z-2
G1 G42 X12 Y0 F200
Y10
X-12
Y-10
X12
Y0
G1 {leave}X40
G0 Z2
{tool}
G0 {cancel}{at} Y0
G1 Z-5 F100
G0 Z5
{off}
G0 Z50
M30
"""


def of_two_tools(tool: str, off: str, leave: str = "G40 ", cancel: str = "", at: str = "X10") -> list[tuple[int, str]]:
    program = TWO_TOOLS.format(tool=tool, off=off, leave=leave, cancel=cancel, at=at)
    return said(report_of(program, MACHINE, "8:radius=4,nose=0", "9:radius=3,nose=0"))


@pytest.mark.nightly
@looped("tool", ["T9 D1", 'T="DRILL" D1', "T9", "T9 D1 S2=500", "T9\nM6\nD1"])
def test_a_tool_is_taken_in_the_mode_without_compensation(tool: str) -> None:
    assert of_two_tools(tool, "TRAFOOF") == []
    assert of_two_tools(tool, "TRAFOOF\nG0 X50\nTRANSMIT\nG0 X30 Y0\nTRAFOOF") == []


@pytest.mark.nightly
@looped(
    ("off", "leave", "cancel"),
    [
        ("", "G40 ", ""),
        ("G0 X60", "G40 ", ""),
        ("TRANSMIT\nG0 X30 Y0\nTRAFOOF", "G40 ", ""),
        ("TRAFOOF", "", "G40 "),
    ],
)
def test_else_the_mode_was_to_be_left_before_the_tool(off: str, leave: str, cancel: str) -> None:
    assert (5, "polar-never-left") in of_two_tools("T9 D1", off, leave, cancel)


@pytest.mark.ci
def test_the_second_tool_has_a_contour_of_its_own() -> None:
    """A drill may go into the part of the first tool; in rapid traverse it may not."""
    contour = "G0 X14 Y0\nG0 Z-1\nG1 G42 X5 Y0 F200\nY5\nX-5\nY-5\nX5\nY0\nG40 X14\nG0 Z5"
    assert of_two_tools(f"T9 D1\n{contour}", "TRAFOOF", at="X40") == []
    assert [rule for _, rule in of_two_tools("T9 D1\nG0 X30 Y0\nZ-2\nG0 X3 Y0\nG0 Z5", "TRAFOOF")] != []
