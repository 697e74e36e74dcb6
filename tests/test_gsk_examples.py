"""
The two examples of the GSK description of `G12.1 IP_ P_ Q_ E_`, as printed: they are clean, and each of their wrong
twins, one for every note of the description, gives the one finding that the note speaks of.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cases import looped
from document_programs import GSK_1, GSK_2
from programs import moves_of, report_of, said, trace_of

from polarcheck.foundation.states import FeedMode

SINGLE, CYCLE = GSK_1.text, GSK_2.text
TOOL = "2:radius=5,nose=0"
NOTES = {SINGLE: ["omitted-text", "omitted-text"], CYCLE: ["cancel-shorter-than-radius"]}
"""What is a note in the examples as printed: blocks left out; a cancel that moves nothing."""


def block(program: str, number: str) -> int:
    """The line of a block by its sequence number."""
    return next(line for line, text in enumerate(program.split("\n"), 1) if text.startswith(f"{number} "))


def judged(program: str, *tools: str, **changes: Any) -> list[tuple[int, str]]:
    """Errors and warnings, each with its line."""
    report = report_of(program, "gsk-988", *(tools or (TOOL,)), changes=changes)
    notes = [finding for finding in report.findings if finding.severity == "note"]
    assert {finding.rule for finding in notes} <= {*NOTES[SINGLE], *NOTES[CYCLE]}
    return [one for one in said(report) if one not in [(note.line, note.rule) for note in notes]]


@pytest.mark.ci
@looped("program", [SINGLE, CYCLE], ids=["single", "cycle"])
@looped("tools", [(TOOL,), ()], ids=["with R", "without R"])
def test_the_example_as_printed_is_clean(program: str, tools: tuple[str, ...]) -> None:
    report = report_of(program, "gsk-988", *tools)
    assert [(found.rule, found.severity) for found in report.findings] == [(rule, "note") for rule in NOTES[program]]
    assert report.verdict == ("pass" if tools else "unverified")


def test_a_cancel_without_a_move_is_a_note() -> None:
    """N220 G40 X300.0 stands where the contour ends, and G13.1 takes the offset back."""
    found = report_of(CYCLE, "gsk-988", TOOL).findings
    assert [(one.line, one.rule, one.severity) for one in found] == [
        (block(CYCLE, "N220"), "cancel-shorter-than-radius", "note")
    ]
    assert judged(CYCLE.replace("N220 G40 X300.0", "N220 G40 X340.0")) == []


#: What is wrong, by the words that change, in which block it is found, and as what.
BOTH = [
    # While G42 is in force neither G12.1 nor G13.1 can be commanded.
    ("N220 G40 X", "N220 X", "N230", "polar-switched-in-offset-mode"),
    ("N150 G01", "N145 G12.1;\nN150 G01", "N145", "polar-switched-in-offset-mode"),
    ("N110 G12.1", "N105 G42;\nN110 G12.1", "N110", "polar-switched-in-offset-mode"),
    # The codes of the mode are a closed list, and G00 is none of them.
    ("N220 G40 X", "N220 G40 G00 X", "N220", "rapid-in-polar"),
    ("N120 G42 G01 X", "N120 G42 G00 X", "N120", "rapid-in-polar"),
    ("N150 G01", "N145 G28 U0 H0;\nN150 G01", "N145", "code-not-allowed-in-polar"),
    ("N150 G01", "N145 G32 F1.;\nN150 G01", "N145", "code-not-allowed-in-polar"),
    ("N150 G01", "N145 G76;\nN150 G01", "N145", "code-not-allowed-in-polar"),
    ("N150 G01", "N145 G96 S100;\nN150 G01", "N145", "code-not-allowed-in-polar"),
    ("N150 G01", "N145 G20;\nN150 G01", "N145", "code-not-allowed-in-polar"),
    ("N150 G01", "N145 G18;\nN150 G01", "N145", "plane-selected-in-polar"),
    # The coordinate system cannot be changed in the mode.
    ("N150 G01", "N145 G54;\nN150 G01", "N145", "origin-shifted-in-polar"),
    ("N150 G01", "N145 G50 X100.;\nN150 G01", "N145", "origin-shifted-in-polar"),
    ("N150 G01", "N145 G52 X1.;\nN150 G01", "N145", "origin-shifted-in-polar"),
    ("N150 G01", "N145 G10 P0 X1.;\nN150 G01", "N145", "origin-shifted-in-polar"),
    # Its origin is the center of the rotary axis.
    ("N110 G12.1", "N105 G52 X5.;\nN110 G12.1", "N110", "origin-off-center"),
    # The tool offset is given before G12.1 and cannot be changed in the mode.
    ("N150 G01", "N145 T0101;\nN150 G01", "N145", "offset-changed-in-polar"),
    ("N150 G01", "N145 T0203;\nN150 G01", "N145", "offset-changed-in-polar"),
    # The mode is ended by G13.1.
    ("N230 G13.1;", "", "N110", "polar-never-left"),
    # Of IP, P, Q and E each has its range.
    ("N110 G12.1", "N110 G12.1 P0", "N110", "polar-axis-number-wrong"),
    ("N110 G12.1", "N110 G12.1 P3", "N110", "polar-axis-number-wrong"),
    ("N110 G12.1", "N110 G12.1 U5.", "N110", "polar-shift-incremental"),
    ("N110 G12.1", "N110 G12.1 H5.", "N110", "polar-shift-incremental"),
    ("N230 G13.1", "N230 G13.1 P1", "N230", "polar-switch-not-alone"),
]


@pytest.mark.nightly
@looped("program", [SINGLE, CYCLE], ids=["single", "cycle"], one_in=36)
@looped(("right", "wrong", "number", "rule"), BOTH)
def test_a_wrong_twin_gives_the_one_finding(program: str, right: str, wrong: str, number: str, rule: str) -> None:
    assert program.count(right) == 1
    twin = program.replace(right, wrong)
    assert judged(twin) == [(block(twin, number), rule)]
    report = report_of(twin, "gsk-988", TOOL)
    severity = next(found.severity for found in report.findings if found.rule == rule)
    assert severity == "error"


def test_the_alarm_text_of_a_switch_in_offset_mode_is_that_of_the_control() -> None:
    report = report_of(SINGLE.replace("N220 G40 X", "N220 X"), "gsk-988", TOOL)
    (found,) = (one for one in report.findings if one.rule == "polar-switched-in-offset-mode")
    assert found.alarm == "polar interpolation command in tool nose radius compensation"


@pytest.mark.nightly
@looped(
    ("right", "wrong"),
    [
        ("N210 G01 C0;", "N210 G01 C-10.;"),
        ("N210 G01 C0;", ""),
        ("N200 G03 X300.0 C-80.0 R40.0;\nN210 G01 C0;", ""),
    ],
    one_in=12,
)
@looped("infeed", ["E8", "E-8", "E30"])
def test_with_an_infeed_the_contour_must_be_closed(right: str, wrong: str, infeed: str) -> None:
    """Without one the same contour may be open."""
    twin = CYCLE.replace(right, wrong).replace("E8", infeed)
    assert judged(twin) == [(block(twin, "N110"), "contour-open-with-infeed")]
    for without in ("", "E0"):
        rules = [rule for _, rule in judged(twin.replace(infeed, without))]
        assert "contour-open-with-infeed" not in rules


@pytest.mark.nightly
@looped(("program", "limit", "line"), [(SINGLE, 100, "N130"), (CYCLE, 500, "N150")])
def test_near_the_center_the_rate_of_c_is_an_alarm(program: str, limit: float, line: str) -> None:
    """Note 1: F200 at 45 mm turns C with 255 deg/min, F2000 at 125 mm with 917."""
    rate = {SINGLE: 200 / 45, CYCLE: 2000 / 125}[program]
    assert judged(program, limits={"c_feed": limit}) == [(block(program, line), "c-feed-above-limit")]
    assert judged(program, limits={"c_feed": float(np.degrees(rate)) + 0.01}) == []


@pytest.mark.nightly
@looped(
    ("words", "rule"),
    [
        ("I0 J-20.0", None),
        ("J-20.0", None),
        ("R20.0", None),
        ("I0 K-20.0", "arc-word-of-other-plane"),
        ("K-20.0", "arc-word-of-other-plane"),
    ],
    one_in=2,
)
def test_centers_are_i_and_j_where_x_is_the_linear_axis(words: str, rule: str | None) -> None:
    twin = SINGLE.replace("N160 G03 X-80.0 C20.0 R20.0", f"N160 G03 X-80.0 C20.0 {words}")
    assert judged(twin) == ([] if rule is None else [(block(twin, "N160"), rule)])


@pytest.mark.nightly
@looped("program", [SINGLE, CYCLE], ids=["single", "cycle"])
def test_diameter_or_radius_is_a_parameter(program: str) -> None:
    assert judged(program, parameters={"5450#6": 0}) == []
    assert judged(program, parameters={"5450#6": 1}) == [(block(program, "N110"), "diameter-radius-mixed")]


@pytest.mark.ci
@looped("code", ["G04 X1.", "G65 P9000", "G66 P9000\nG67", "G98", "G40", "G99 F.2\nG98 F200"], one_in=2)
def test_the_codes_of_the_list_can_be_used(code: str) -> None:
    """Each at its place: G40 where no offset is in force."""
    at = "N120" if code == "G40" else "N150"
    twin = f"{SINGLE.replace(at, f'{code}{chr(10)}{at}')}O9000\nM99\n"
    assert judged(twin) == []


@looped(
    ("code", "mode", "f_is_known"),
    [("G98", FeedMode.PER_MINUTE, True), ("G99", FeedMode.PER_REVOLUTION, False)],
)
def test_g98_is_feed_per_minute(code: str, mode: FeedMode, f_is_known: bool) -> None:
    """
    The list of the codes prints "G98, G99: per revolution, per minute", the two meanings the wrong way round: both
    examples give F200 and F2000 on the plane without a code, which are feeds per minute, and in the manuals of the
    control G98 is per minute.
    """
    twin = SINGLE.replace("N100 G00", f"N100 {code} G00")
    trace = trace_of(twin, "gsk-988", TOOL)
    cutting = np.flatnonzero(trace.path.cuts)
    assert (trace.feedrate.feed_mode[cutting] == mode).all()
    assert (trace.feedrate.feed[cutting] == 200).all() == f_is_known
    assert np.isnan(trace.feedrate.feed[cutting]).all() == (not f_is_known)
    rules = [found.rule for found in report_of(twin, "gsk-988", TOOL).findings]
    assert ("feed-per-revolution-in-polar" in rules) == (not f_is_known)


def test_the_place_of_g12_1_is_angle_0() -> None:
    """C30 before the mode: the plane begins there, and C runs on from 30 deg."""
    moves = moves_of(CYCLE, "gsk-988", TOOL)
    assert moves.start[0] == 174
    assert moves.c_angles[0][0] == 30
    turned = moves_of(CYCLE.replace("C30;", "C-75;"), "gsk-988", TOOL)
    assert turned.c_angles[0] - moves.c_angles[0] == pytest.approx(-105)
    assert turned.c_feed == pytest.approx(moves.c_feed)


@pytest.mark.nightly
@looped("plane", ["G17", "G18", "G19", ""])
def test_the_plane_of_before_is_dropped_and_comes_back(plane: str) -> None:
    """Arcs of the mode lie on the polar plane whatever was selected, and one of Z and X after it in that of before."""
    twin = SINGLE.replace("N100 G00", f"N100 {plane} G00").replace("N240 Z100.0;", "N240 G01 Z5. F100;")
    assert judged(twin) == []
    trace = trace_of(twin, "gsk-988", TOOL)
    assert trace.path.is_arc.sum() == 4
    states = trace.modal.state("plane")
    assert states[trace.mode.enters] == states[trace.mode.leaves] == states[-1]


def test_axes_by_number_hold_for_one_section() -> None:
    """P and Q change no parameter: the next G12.1 without them takes those of the parameters."""
    twice = SINGLE.replace("N110 G12.1", "N110 G12.1 P3 Q1").replace(
        "N240 Z100.0;", "N250 G12.1 P1;\nG01 X140. C5. F100;\nX150. C0;\nN260 G13.1;\nN270 G12.1 P3;\nN280 G13.1;"
    )
    trace = trace_of(twice, "gsk-988", TOOL)
    enters = np.flatnonzero(trace.mode.enters)
    linear, rotary = trace.axes.axes_written
    assert linear[enters].tolist() == [3, 1, 3]
    assert rotary[enters].tolist() == [1, 3, 3]
    assert (block(twice, "N270"), "polar-axis-number-wrong") in judged(twice)


@looped(("word", "passes"), [("E8", 3), ("E-8", 3), ("E0", 1), ("", 1), ("E.0009", 1)])
def test_e_is_a_radius_value_without_its_sign(word: str, passes: int) -> None:
    moves = moves_of(CYCLE.replace("E8", word), "gsk-988", TOOL)
    assert len(moves) == 10 * passes
    # 171, 163 and 155 mm along the straight side in X: 8 mm apart on the radius, X in diameters notwithstanding.
    assert moves.end.real[::10].tolist() == [171.0, 163.0, 155.0][3 - passes :]
