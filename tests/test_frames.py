"""Frames: TRANS, ATRANS, ROT and AROT shift and turn what is programmed; OFFN is added to R."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import moves_of, report_of, said, trace_of

from polarcheck.foundation.arrays import Points

MACHINE = "siemens-transmit"
HEAD = "T8 D1\nG94 G0 X{x} {c}Z20\n{before}DIAMOF\nTRANSMIT\nG17\n"
FOOT = "G40 G1 X60 Y0\nTRAFOOF\nDIAMON\nM30\n"
#: The example of the programming manual to TRANSMIT, its square with an allowance and without.
SQUARE = "G1 X10 Y-10 G41 OFFN={0} F300\nX-10\nY10\nX10\nY-10\nG0 Z20 G40 OFFN=0\n"
MANUAL = HEAD.format(x=40, c="C45 ", before="G451\n") + "ROT RPL=-45\nATRANS X-2 Y10\n" + SQUARE + "TRAFOOF\nM30\n"


def face(body: str, *, x: float = 120, c: str = "", before: str = "") -> str:
    return HEAD.format(x=x, c=c, before=before) + body + FOOT


def ends(program: str, **more: Any) -> list[complex]:
    """Where the moves of the programmed path end, but the last, which leaves the contour."""
    trace = trace_of(program, MACHINE, "8:radius=2", **more)
    return [complex(point) for point in trace.path.end[trace.path.on_plane]][:-1]


def near(found: list[complex], expected: list[complex]) -> bool:
    return len(found) == len(expected) and bool(np.allclose(found, expected, atol=1e-9))


# ---- where the moves end ----


@pytest.mark.ci
@looped(
    ("body", "expected"),
    [
        ("ATRANS X5 Y-3\nG1 X10 Y10 F200\n", [15 + 7j]),
        ("TRANS X5 Y-3\nG1 X10 F200\nY10\n", [15 + 0j, 15 + 7j]),
        ("TRANS X5\nATRANS Y3\nATRANS X1\nG1 X10 Y10 F200\n", [16 + 13j]),
        ("TRANS X5\nTRANS Y3\nG1 X10 Y10 F200\n", [10 + 13j]),
        ("TRANS X5 Y3\nTRANS\nG1 X10 Y10 F200\n", [10 + 10j]),
        ("TRANS X5 Y3\nROT\nG1 X10 Y10 F200\n", [10 + 10j]),
        ("ROT RPL=90\nG1 X10 Y5 F200\n", [-5 + 10j]),
        ("ROT Z90\nG1 X10 Y5 F200\n", [-5 + 10j]),
        ("ROT RPL=30\nAROT RPL=60\nG1 X10 Y5 F200\n", [-5 + 10j]),
        ("ROT RPL=30\nROT RPL=90\nG1 X10 Y5 F200\n", [-5 + 10j]),
        ("ROT RPL=90\nATRANS X1 Y2\nG1 X10 Y5 F200\n", [-7 + 11j]),
        ("TRANS X1 Y2\nAROT RPL=90\nG1 X10 Y5 F200\n", [-4 + 12j]),
        ("ROT RPL=90\nTRANS X1 Y2\nG1 X10 Y5 F200\n", [11 + 7j]),
        # The lathe does not move where the frame turns: one coordinate leaves the other where it is then.
        ("G1 X20 Y10 F200\nROT RPL=90\nG1 X4\n", [20 + 10j, 20 + 4j]),
        ("G1 X20 Y10 F200\nROT RPL=90\nG1 Y4\n", [20 + 10j, -4 + 10j]),
        ("G1 X20 Y10 F200\nATRANS X7 Y7\nG1 X4\n", [20 + 10j, 11 + 10j]),
        ("G1 X20 Y10 F200\nROT RPL=90\nG91 X3\nY2\n", [20 + 10j, 20 + 13j, 18 + 13j]),
        ("G1 X20 Y10 F200\nROT RPL=90\nG91 X3\nROT\nX3\n", [20 + 10j, 20 + 13j, 23 + 13j]),
        ("G1 X20 Y10 F200\nROT RPL=90\nAROT RPL=90\nG91 X3\n", [20 + 10j, 17 + 10j]),
        ("G1 X20 Y10 F200\nATRANS X7\nATRANS Z5\nG91 X3\n", [20 + 10j, 23 + 10j]),
    ],
    one_in=2,
)
def test_a_frame_shifts_and_turns_what_is_programmed(body: str, expected: list[complex]) -> None:
    assert near(ends(face(body)), expected)
    assert near(ends(face(body).lower()), expected)


def test_the_center_of_an_arc_turns_with_the_frame() -> None:
    program = face("ROT RPL=90\nATRANS X3 Y4\nG1 X20 Y0 F200\nG3 X10 Y10 I-10 J0\nG2 X20 Y20 CR=10\n")
    trace = trace_of(program, MACHINE, "8:radius=2")
    centers = trace.path.center[trace.path.is_arc]
    assert np.allclose(centers, [1j * (13 + 4j), 1j * (23 + 14j)])
    assert np.allclose(abs(trace.path.end[trace.path.is_arc] - centers), 10)


@pytest.mark.nightly
@settings(max_examples=25, deadline=None)
@given(
    st.lists(st.tuples(st.integers(-30, 30), st.integers(-30, 30)), min_size=1, max_size=8),
    st.floats(-400, 400).map(lambda angle: round(angle, 3)),
    st.tuples(st.integers(-20, 20), st.integers(-20, 20)),
    st.booleans(),
)
def test_a_contour_in_a_frame_is_the_contour_turned_by_formula(
    points: list[tuple[int, int]], angle: float, shift: tuple[int, int], first: bool
) -> None:
    turn, by = np.exp(1j * math.radians(angle)), complex(*shift)
    words = f"ROT RPL={angle}\nATRANS X{shift[0]} Y{shift[1]}\n"
    if first:
        words = f"TRANS X{shift[0]} Y{shift[1]}\nAROT RPL={angle}\n"
    body = "".join(f"G1 X{x} Y{y} F200\n" for x, y in points)
    trace = trace_of(face(words + body), MACHINE)
    found = trace.path.end[trace.axes.moves_plane & trace.mode.in_polar][:-1]
    plain = np.array([complex(*point) for point in points])
    assert np.allclose(found, turn * plain + by if first else turn * (plain + by), atol=1e-6)


def path(program: str, machine: str) -> tuple[Points, Points]:
    moves = moves_of(program, machine, "8:radius=4")
    return moves.start, moves.end


@looped("angle", [0, 30, -77.5, 180])
def test_a_section_with_frames_has_the_tool_center_path_of_its_twin_without(angle: float) -> None:
    contour = [30 - 20j, 30 + 20j, -30 + 20j, -30 - 20j, 30 - 20j]
    turn, shift = np.exp(1j * math.radians(angle)), 3 - 5j
    frames = f"ROT RPL={angle}\nATRANS X3 Y-5\n"
    outside = 50 - 20j
    blocks = [("G1", outside), ("G1 G42", contour[0]), *(("G1", point) for point in contour[1:]), ("G1 G40", 30 - 45j)]
    body = "".join(f"{code} X{point.real:g} Y{point.imag:g} F200\n" for code, point in blocks)
    own = HEAD.format(x=120, c="", before="G451\n") + frames + body + "TRAFOOF\nDIAMON\nM30\n"
    turned = [(code, turn * (point + shift)) for code, point in blocks]
    words = "".join(f"{code} X{2 * point.real:.9f} C{point.imag:.9f} F200\n" for code, point in turned)
    twin = f"T0808\nG98 G0 X120. C0 Z20.\nG12.1\n{words}G13.1\nM30\n"
    for ours, theirs in zip(path(own, MACHINE), path(twin, "fanuc"), strict=True):
        assert np.allclose(ours, theirs, atol=1e-6)


# ---- the example of the manual ----


@looped("allowance", [1, 2.5])
def test_the_example_of_the_manual_runs_round_its_square(allowance: float) -> None:
    program = MANUAL.format(allowance)
    report = report_of(program, MACHINE, "8:radius=2", changes={"limits": {"c_feed": 100_000}})
    # Nothing on the plane follows G40, which is good here, and good to know.
    assert [(one.line, one.rule, one.severity) for one in report.findings] == [
        (14, "cancel-shorter-than-radius", "note")
    ]
    assert report.verdict == "pass"
    assert report.polar_sections[0].radius == 2
    moves = moves_of(program, MACHINE, "8:radius=2")
    distance = 10 + 2 + allowance
    turn = np.exp(-1j * math.pi / 4)
    own = np.conj(turn) * moves.end - (-2 + 10j)
    assert np.allclose(own[1:4], distance * np.array([-1 - 1j, -1 + 1j, 1 + 1j]) + [0, 0, 0])
    assert np.allclose(own[0], 10 - distance * 1j)


def test_the_tool_stands_where_c_has_turned_the_part_to() -> None:
    program = face("G1 X30 Y0 F200\n", c="C45 ")
    trace = trace_of(program, MACHINE)
    assert np.allclose(trace.path.start[trace.path.on_plane][0], 60 * np.exp(-1j * math.pi / 4))
    turned = trace_of(program, MACHINE, changes={"polar": {"zero_angle": "at-c0"}})
    assert np.allclose(turned.path.start[turned.path.on_plane][0], 60 * np.exp(1j * math.pi / 4))
    zero = trace_of(program, MACHINE, changes={"polar": {"zero_angle": "at-switch"}})
    assert np.allclose(zero.path.start[zero.path.on_plane][0], 60)
    for c in ("", "C0 ", "C360 ", "C-720 "):
        trace = trace_of(face("G1 X30 Y0 F200\n", c=c), MACHINE)
        assert trace.path.start[trace.path.on_plane][0] == 60


def test_each_section_begins_at_the_angle_that_c_has_there() -> None:
    section = "G0 X120 C{}\nDIAMOF\nTRANSMIT\nG17\nG1 X30 Y5 F200\nTRAFOOF\nDIAMON\n"
    trace = trace_of("T8 D1\nG94\n" + section.format(90) + section.format(180), MACHINE)
    assert np.allclose(trace.path.start[trace.path.on_plane], [-60j, -60])


# ---- what is not simulated ----


@pytest.mark.ci
@looped("word", ["MIRROR X0", "AMIRROR Y0", "SCALE X2 Y2", "ASCALE X.5", "ROT X30", "AROT Y10"], one_in=2)
def test_other_frames_are_not_evaluated_by_name(word: str) -> None:
    report = report_of(face(f"{word}\nG1 X20 Y10 F200\n"), MACHINE)
    assert report.verdict == "unverified"
    assert [one.reason for one in report.not_evaluated if f"{word} in line 6 is not simulated" in one.reason]
    assert said(report) == []
    trace = trace_of(face(f"{word}\nG1 X20 Y10 F200\nTRANS\nG1 X20 Y10\n"), MACHINE)
    assert [math.isnan(point.real) for point in trace.path.end[trace.axes.moves_plane & trace.mode.in_polar]] == [
        True,
        False,
        False,
    ]


@pytest.mark.ci
def test_a_frame_that_ends_before_the_mode_is_none_of_its_own() -> None:
    for word in ("MIRROR Z0\n", "ROT RPL=30\n", "TRANS X10 Z5\n", "SCALE X2\n"):
        report = report_of(face("G1 X20 Y10 F200\n", before=word), MACHINE, changes={"limits": {"c_feed": 1e6}})
        assert (report.verdict, said(report)) == ("pass", []), word


def test_an_allowance_that_changes_in_offset_mode_is_not_evaluated_by_name() -> None:
    body = "G1 G41 X40 Y10 F200\nY0\nY-10 OFFN=1\nY-20\n"
    reasons = " ".join(one.reason for one in report_of(face(body), MACHINE, "8:radius=2").not_evaluated)
    assert "OFFN=1 in line 8 changes what is added to R in offset mode" in reasons
    reasons = " ".join(
        one.reason for one in report_of(face(body.replace(" OFFN=1", "")), MACHINE, "8:radius=2").not_evaluated
    )
    assert "is added to R" not in reasons


def test_an_allowance_counts_with_compensation_alone() -> None:
    plain = "G1 X40 Y10 F200 OFFN=3\nY-20\n"
    assert np.allclose(moves_of(face(plain), MACHINE).end, moves_of(face(plain.replace(" OFFN=3", "")), MACHINE).end)


# ---- the origin ----


@pytest.mark.ci
def test_a_frame_that_outlives_the_switch_puts_the_origin_off_center() -> None:
    kept = {"frames": {"ended_by_switch": False}, "limits": {"c_feed": 1e6}}
    report = report_of(face("G1 X20 Y10 F200\n", before="TRANS X10 Z5\n"), MACHINE, changes=kept)
    assert [(one.line, one.rule) for one in report.findings] == [(5, "origin-off-center")]
    assert "TRANS puts X0 5 mm off the spindle axis at TRANSMIT" in report.findings[0].message
    for harmless in ("TRANS Z5\n", "TRANS X10\nTRANS\n", "TRANS X10\nTRANS Z5\n"):
        report = report_of(face("G1 X20 Y10 F200\n", before=harmless), MACHINE, changes=kept)
        assert said(report) == [], harmless
    trace = trace_of(face("G1 X20 Y10 F200\n", before="TRANS X10\n"), MACHINE, changes=kept)
    assert trace.path.end[trace.path.on_plane][0] in (25 + 10j, 30 + 10j)


@pytest.mark.ci
def test_a_work_offset_in_the_mode_is_said_where_it_is_another() -> None:
    assert said(report_of(face("G54\nG1 X20 Y10 F200\n"), MACHINE)) == []
    assert said(report_of(face("G54\nG1 X20 Y10 F200\n", before="G54\n"), MACHINE)) == []
    report = report_of(face("G55\nG1 X20 Y10 F200\n", before="G54\n"), MACHINE)
    assert said(report) == []
    assert "G55 in line 7 selects another work offset in the mode" in str(report.not_evaluated)
    assert "work offset" not in str(report_of(face("G54\nG1 X20 Y10 F200\n"), MACHINE).not_evaluated)
    fanuc = "G54 G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG54\nC10.\nX60.\nG13.1\n"
    assert [rule for _, rule in said(report_of(fanuc))] == ["origin-shifted-in-polar"]


# ---- how it is read ----


def test_words_of_frames_are_read_in_any_spelling() -> None:
    body = "N70 rot rpl=90\nN80AROT RPL=0\nn90 ATRANS X1Y2 ; SHIFT\nG1 X10 Y5 F200\n"
    assert near(ends(face(body)), [-7 + 11j])
    assert said(report_of(face(body), MACHINE, changes={"limits": {"c_feed": 1e6}})) == []


def test_z_is_shifted_too() -> None:
    trace = trace_of("G0 Z10\nTRANS Z5\nG0 Z1\nATRANS Z2\nG91 Z1\nG90 Z0\nTRANS\nZ3\n", MACHINE)
    assert trace.path.z.tolist() == [10, 10, 6, 6, 7, 7, 7, 3]


@pytest.mark.nightly
def test_many_frames_are_followed_one_after_the_other() -> None:
    body = "".join(f"AROT RPL=90\nG91 X{number % 7} Y1\n" for number in range(20_000))
    trace = trace_of(face("G1 X20 Y10 F200\n" + body + "G90\n"), MACHINE)
    steps = sum(1j ** (number + 1) * (number % 7 + 1j) for number in range(20_000))
    last = trace.path.end[trace.axes.moves_plane & trace.mode.in_polar][-2]
    assert abs(last - (20 + 10j + steps)) < 1e-4


def test_a_negative_radius_is_the_longer_arc() -> None:
    body = "G1 X20 Y0 F200\nG3 X0 Y-20 CR={}20\n"
    for sign, center in (("-", 0), ("", 20 - 20j)):
        trace = trace_of(face(body.format(sign)), MACHINE)
        assert np.allclose(trace.path.center[trace.path.is_arc], center)
    report = report_of(face(body.format("-")), MACHINE, changes={"limits": {"c_feed": 1e6}})
    assert said(report) == []


#: After the example of Job Planning to TRANSMIT: a square roughed and finished, shifted and turned.
JOB_PLANNING = """\
N10 T1 D1 G54 G17 G90 F500 G94
N20 G0 X20 Z10 SPOS=45
N30 TRANSMIT
N40 ROT RPL=-45
N50 ATRANS X-2 Y10
N60 G1 X10 Y-10 G41 OFFN=1
N70 X-10
N80 Y10
N90 X10
N100 Y-10
N110 G0 Z20 G40 OFFN=0
N120 T2 D1 X15 Y-15
N130 Z10 G41
N140 G1 X10 Y-10
N150 X-10
N160 Y10
N170 X10
N180 Y-10
N190 Z20 G40
N200 TRANS
N210 TRAFOOF
N220 G0 X20 Z10 SPOS=45
N230 M30
"""


@pytest.mark.nightly
@looped("offsets", [(), ("1:radius=2", "2:radius=2"), ("1:radius=1.5", "2:radius=1")])
def test_the_example_of_a_shop_has_no_fault(offsets: tuple[str, ...]) -> None:
    """Without DIAMON and DIAMOF its X20 is what the machine data say: here 20 from the center, as in the mode."""
    report = report_of(JOB_PLANNING, MACHINE, *offsets)
    assert not [one for one in report.findings if one.severity == "error"]
    assert report.sections == 1
    distances = [abs(point) for point in ends(JOB_PLANNING)]
    assert np.allclose(distances[:5], np.abs([8, -12 + 0j, -12 + 20j, 8 + 20j, 8 + 0j]))
