"""Where the axes stand after each row, by programs whose positions are known by construction."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, trace_of

NAN = math.nan


def after(program: str, axis: str, **more: object) -> list[float]:
    """x [radius], z or c_angle after each block."""
    trace = trace_of(program, **more)  # type: ignore[arg-type]
    found: list[float] = getattr(trace.path, axis).tolist()
    return found


@looped(
    ("program", "axis", "expected"),
    [
        ("G0 X60.\nU-20.\nZ1.\nX10. U5.\n", "x", [30, 20, 20, 5]),
        ("G20\nG0 X1.\nU.2\n", "x", [NAN, 12.7, 15.24]),
        ("G0 Z5.\nW-7.\nG1 Z1.\n", "z", [5, -2, 1]),
        ("G0 U10.\nX20.\nU10.\n", "x", [NAN, 10, 15]),
        # A reference return, another work offset and a tool change leave an axis anywhere; G50 says where it stands.
        ("G0 X60.\nG28 U0\nG0 U2.\nX10.\n", "x", [30, NAN, NAN, 5]),
        ("G0 X60.\nG55\nU2.\n", "x", [30, NAN, NAN]),
        ("T0101\nG0 X60. Z2.\nT0202\nU2.\n", "x", [NAN, 30, NAN, NAN]),
        ("G0 X60.\nG50 X40.\nU2.\n", "x", [30, 20, 21]),
        ("G0 X60.\nG4 X2.\nU2.\n", "x", [30, 30, 31]),
        ("O1\nG0 X60.\nM30\nO2\nU2.\n", "x", [NAN, 30, 30, NAN, NAN]),
        ("G0 C30.\nH15.\nG28 H0\nH5.\n", "c_angle", [30, 45, 0, 5]),
    ],
)
def test_positions_outside_the_mode(program: str, axis: str, expected: list[float]) -> None:
    assert after(program, axis) == pytest.approx(expected, nan_ok=True)


def test_incremental_codes_of_system_b() -> None:
    program = "G90 G0 X60. Z5.\nG91 X-20. Z1.\nG90 X10.\n"
    changes = {"control": {"g_code_system": "B"}}
    assert after(program, "x", changes=changes) == [30, 20, 5]
    assert after(program, "z", changes=changes) == [5, 6, 6]


def test_the_plane_begins_at_c0_and_turns_c_about_its_center() -> None:
    trace = trace_of("G98 G0 X60. C90.\nG12.1\nG1 X40. F100\nC20.\nX-40.\nU80. H-40.\nG13.1\nG0 U10.\n")
    assert trace.path.end[1:6].tolist() == [30, 20, 20 + 20j, -20 + 20j, 20 - 20j]
    assert trace.path.start[2:6].tolist() == [30, 20, 20 + 20j, -20 + 20j]
    assert np.isnan(trace.path.end[[0, 7]]).all()
    # From 45 deg over 90 to 135, then through the center: half a turn, to -45 or 315.
    assert trace.path.c_angle[:5] == pytest.approx([90, 90, 90, 135, 225])
    assert trace.path.c_angle[5] % 360 == pytest.approx((90 - 45) % 360)
    assert trace.path.length[2:6] == pytest.approx([10, 20, 40, math.hypot(40, 40)])
    # The mode is left with X where the tool stands, on the positive side.
    assert trace.path.x[[6, 7]] == pytest.approx([math.hypot(20, 20), math.hypot(20, 20) + 5])


def test_centers_of_arcs_by_i_and_j_and_by_r() -> None:
    program = "G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG3 X0 C20. I-20. J0\nG2 X40. C0 R20.\nG1 X60.\nG13.1\n"
    trace = trace_of(program)
    assert trace.path.is_arc.tolist() == [False] * 3 + [True, True] + [False] * 2
    assert trace.path.center[3] == 0
    assert abs(trace.path.center[4]) == pytest.approx(0, abs=1e-9)
    other_way = trace_of(program.replace("G2 X40.", "G3 X40."))
    assert other_way.path.center[4] == pytest.approx(20 + 20j)
    assert np.isnan(trace.path.center[[2, 5]]).all()
    assert trace.path.length[3] == pytest.approx(10 * math.pi)


@looped(("reading", "x"), [("diameter", 20.0), ("radius", 40.0)])
def test_x_in_the_mode_is_what_the_profile_says(reading: str, x: float) -> None:
    trace = trace_of("G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG13.1\n", changes={"polar": {"x": reading}})
    assert (trace.path.x[0], trace.path.end[2]) == (30, x)
    assert trace.lengths.x_factor.tolist() == [0.5, *[x / 40] * 2, 0.5]


def test_side_and_ramps_of_a_section() -> None:
    program = (
        "G98 T0101\nG0 X60. C0\nG12.1\nG42 G1 X40. F100\nC10.\nX20.\nG40 X60.\nG13.1\nG41\nG12.1\nG1 X10.\nG13.1\n"
    )
    trace = trace_of(program)
    assert np.flatnonzero(trace.compensation.starts_up).tolist() == [
        3
    ]  # G41 before G12.1 has a finding, and does nothing in it
    assert np.flatnonzero(trace.compensation.cancels).tolist() == [6]
    assert np.flatnonzero(trace.compensation.offset_mode).tolist() == [4, 5, 6]
    assert np.flatnonzero(trace.path.cuts).tolist() == [3, 4, 5, 6, 10]


# ---- H beside G43 is the number of an offset ----

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\n"
CUT = "G12.1\n{}G1 X40. F200\n{}C10.\nX60.\nG13.1\nG0 Z50.\nM30\n"
LENGTH_OFFSETS = ["G43 H01", "G43 H1", "G44 H02.", "G49 H0", "H1 G43"]


@pytest.mark.ci
@looped("block", LENGTH_OFFSETS, one_in=5)
@looped("at", [0, 1])
@looped("units", ["G21", "G20"])
def test_a_length_offset_in_the_mode_moves_nothing_on_the_plane(block: str, at: int, units: str) -> None:
    program = HEAD.replace("G21", units) + "G0 X60. Z2. C0\n" + CUT
    blocks = ["", ""]
    plain = trace_of(program.format(*blocks))
    blocks[at] = f"{block}\n"
    trace = trace_of(program.format(*blocks))
    added = trace.blocks.listed("tool_length_offset", "tool_length_offset_off")
    assert not trace.path.travels[added].any()
    assert not trace.axes.moves_plane[added].any()
    np.testing.assert_array_equal(trace.path.end[~added], plain.path.end)
    np.testing.assert_array_equal(trace.path.c_angle[~added], plain.path.c_angle)
    found = report_of(program.format(*blocks), only=("polar", "compensation", "feed", "setup"))
    assert said(found) == [(6 + at, "tool-length-offset-in-polar")]


@pytest.mark.nightly
@looped("block", LENGTH_OFFSETS, one_in=2)
def test_a_length_offset_positions_no_c(block: str) -> None:
    assert after(f"G0 C30.\n{block}\nH5.\n", "c_angle") == [30, 30, 35]
    program = f"{HEAD}{block}\nG0 X60. Z2.\n" + CUT.format("", "")
    assert (6, "c-angle-unknown-at-entry") in said(report_of(program))
    assert "c-angle-unknown-at-entry" not in {rule for _, rule in said(report_of(program.replace("Z2.\n", "Z2. H0\n")))}


def test_a_length_offset_is_no_word_of_the_other_axis() -> None:
    """Haas calls the virtual axis Y, and C and H are words of other controls."""
    program = HEAD.replace(" G18", "") + "G0 X60. Z2. C0\nG17\nG112\nG43 H01\nG1 X40. F200\nY10.\nX60.\nG113\nM30\n"
    assert said(report_of(program, "haas-lathe", only=("polar",))) == []


# ---- the virtual axis under the address of another control ----

SQUARE = "G1 X40. F200\n{0}10.\nX-40.\n{0}-10.\nX40.\n{1}10.\nX60.\n"
AROUND = "O1\nG40 G97 G98\nT0101\nG0 X60. Z2. C0\n{2}\n" + SQUARE + "{3}\nG0 Z50.\nM30\n"


@pytest.mark.ci
@looped(
    ("machine", "parameters", "own", "others", "switches"),
    [
        ("fanuc", {}, "CH", "YV", ("G12.1", "G13.1")),
        ("mitsubishi-m700", {"1517": 0}, "YV", "CH", ("G12.1", "G13.1")),
        ("mitsubishi-m700", {"1517": 1}, "CH", "YV", ("G12.1", "G13.1")),
        ("haas-lathe", {}, "YV", "CH", ("G112", "G113")),
    ],
    one_in=2,
)
def test_a_wrong_address_of_the_virtual_axis_is_read_as_it_was_meant(
    machine: str, parameters: dict[str, int], own: str, others: str, switches: tuple[str, str]
) -> None:
    """One finding for the section, and the path that the program means: no way through the center."""
    changes = {"parameters": parameters}
    right, wrong = (AROUND.format(*addresses, *switches) for addresses in (own, others))
    meant, read = (trace_of(program, machine, changes=changes) for program in (right, wrong))
    np.testing.assert_array_equal(read.path.end, meant.path.end)
    np.testing.assert_array_equal(read.path.c_angle, meant.path.c_angle)
    groups = ("polar", "compensation", "feed", "motion")
    plain, found = (said(report_of(program, machine, changes=changes, only=groups)) for program in (right, wrong))
    # H is an increment in G-code system A only.
    others_said = [one for one in plain if one[1] != "incremental-word-of-other-code-system"]
    assert found == sorted([*others_said, (7, "wrong-axis-address-in-polar")])


@pytest.mark.nightly
def test_one_wrong_address_among_right_ones() -> None:
    """A slip in one block; beside the right address the right one counts."""
    program = AROUND.format("C", "H", "G12.1", "G13.1")
    plain = trace_of(program)
    for slip in ("C10.\nX-40.", "Y10.\nX-40."), ("C-10.", "Y-10."), ("H10.", "V10."), ("H10.", "H10. Y3."):
        np.testing.assert_array_equal(trace_of(program.replace(*slip)).path.end, plain.path.end)
        assert len(report_of(program.replace(*slip), only=("polar", "feed", "motion")).findings) == 1
