"""Times, rates and accelerations of what the axes do, against dense sampling of positions and against closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from cases import looped
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from path_sampling import sampled
from programs import tables_of

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.foundation.states import Motion
from polarcheck.geometry import automatic_override, polar
from polarcheck.reports.pages import executed, trace_columns

RATES = ("c_feed", "x_feed", "c_acceleration", "x_acceleration")
RAPIDS = {"limits": {"x_rapid": 6000, "z_rapid": 12000, "c_rapid": 18000}}


def dynamics_of(program: str, *tools: str, **more: Any) -> Dynamics:
    found: Dynamics = tables_of(program, "fanuc", *tools, **more)["dynamics"]
    return found


def inside(*blocks: str) -> str:
    return "\n".join(["O1", "T0101", "G98 G0 X60. Z2. C0", "G12.1", *blocks, "G13.1", "M30", ""])


def row_of(dynamics: Dynamics, line: int) -> int:
    return int(np.flatnonzero(dynamics.trace.blocks.line == line)[0])


@looped("rolls_over", [False, True])
def test_an_angle_of_c_is_reached_the_shorter_way_where_c_rolls_over(rolls_over: bool) -> None:
    """The example of B-63534EN/02 p. 531: distances are turned as they are written."""
    blocks = {"C-150.": 150, "C540.": 30, "C-620.": 80, "H380.": 380, "H-840.": 840}
    as_written = (150, 690, 1160, 380, 840)
    program = "\n".join(["O1", "G28 H0", "G0 C0", *(f"G0 {block}" for block in blocks), "M30", ""])
    changes = {**RAPIDS, "parameters": {"1008#0": int(rolls_over)}}
    dynamics = dynamics_of(program, changes=changes)
    way = [dynamics.time[row_of(dynamics, line)] * RAPIDS["limits"]["c_rapid"] / 60 for line in range(4, 9)]
    assert way == pytest.approx(list(blocks.values()) if rolls_over else as_written)
    # Behind three turns in the mode C0 is where C stands.
    around = inside(*["G1 X40. F900", "G3 I-20. J0", "I-20. J0", "I-20. J0"]).replace("M30", "G0 C0\nM30")
    dynamics = dynamics_of(around, changes=changes)
    turned = dynamics.time[row_of(dynamics, 10)] * RAPIDS["limits"]["c_rapid"] / 60
    assert turned == pytest.approx(0 if rolls_over else 1080)


# ---- the moves ----

coordinates = st.integers(-200, 200).map(lambda number: number / 10)


@st.composite
def contours(draw: st.DrawFn) -> str:
    """A contour of lines and arcs, left or right of which the tool runs."""
    blocks = [
        f"G1 {draw(st.sampled_from(['G41', 'G42', '']))} X50. C{draw(coordinates)} F{draw(st.integers(100, 900))}"
    ]
    for _ in range(draw(st.integers(1, 4))):
        code = draw(st.sampled_from(["G1", "G2", "G3"]))
        arc = "" if code == "G1" else f" R{draw(st.integers(300, 600)) / 10}"
        blocks.append(f"{code} X{2 * draw(coordinates)} C{draw(coordinates)}{arc}")
    return inside(*blocks, "G1 G40 X80.")


@pytest.mark.nightly
@settings(max_examples=15, deadline=None)
@given(contours(), st.integers(0, 5))
def test_moves_agree_with_dense_sampling(program: str, radius: int) -> None:
    dynamics = dynamics_of(program, f"1:radius={radius}")
    moves = dynamics.moves
    # On a longer one, as of a spike that compensation makes, differences of positions have too few digits.
    is_sampled = moves.known & (moves.length > 0.5) & (moves.length < 100) & (moves.nearest > 1)
    for index in np.flatnonzero(is_sampled).tolist():
        move = tuple(column[index] for column in moves.shape)
        expected = sampled(move, float(moves.feed[index]))
        told = {name: float(getattr(dynamics, name)[index]) for name in RATES}
        assert float(dynamics.move_time[index]) == pytest.approx(expected.pop("time"), rel=1e-4)
        assert told == pytest.approx(expected, rel=1e-4, abs=1e-3)


points = st.tuples(coordinates, coordinates).map(lambda pair: complex(*pair))


@pytest.mark.nightly
@settings(max_examples=20, deadline=None)
@given(points, points, st.floats(-2, 2), st.sampled_from([Motion.LINE, Motion.CW, Motion.CCW]), st.floats(0.1, 0.95))
def test_override_agrees_with_dense_sampling(
    start: complex, end: complex, away: float, kind: int, share: float
) -> None:
    assume(abs(end - start) > 5)
    center = (start + end) / 2 + 1j * (end - start) * away if kind != Motion.LINE else complex("nan+nanj")
    shape = (*(np.array([point]) for point in (start, end, center)), np.array([kind], np.int16))
    assume(polar.nearest(*shape)[0] > 1)
    free = sampled((start, end, center, kind), 300)
    assume(free["c_feed"] > 1)
    allowed = free["c_feed"] * share
    pieces = automatic_override.pieces(*shape, np.array([300.0]), allowed)
    expected = sampled((start, end, center, kind), 300, allowed, 20_001)
    assert pieces.time().sum() == pytest.approx(expected["time"], rel=1e-4)
    assert pieces.c_feed().max() == pytest.approx(expected["c_feed"], rel=1e-4)
    assert pieces.x_feed().max() == pytest.approx(expected["x_feed"], rel=1e-3, abs=1e-3)
    # The highest is often at the very place where override begins or ends, which is left out of the samples.
    for name in ("c_acceleration", "x_acceleration"):
        told = float(getattr(pieces, name)().max())
        assert expected[name] * (1 - 1e-3) - 1e-3 <= told <= expected[name] * 1.05 + 1e-3


def test_override_on_a_line_in_closed_form() -> None:
    """C turns at 3240 deg/min while r^2 < d F / w, and the tool runs at F before and behind."""
    program = inside("G1 X20. C1. F1000", "X-20.")
    limits = {"c_feed": 3600, "automatic_override": True}
    dynamics = dynamics_of(program, changes={"limits": limits})
    move = int(np.flatnonzero(dynamics.moves.row == row_of(dynamics, 6))[0])
    turn = math.radians(3240)
    reach = math.sqrt(1000 / turn - 1)
    seconds = 60 * (2 * (10 - reach) / 1000 + 2 * math.atan(reach) / turn)
    assert dynamics.move_time[move] == pytest.approx(seconds)
    assert dynamics.true_feed[move] == pytest.approx(turn)
    assert dynamics.c_feed[move] == pytest.approx(3240)
    plain = dynamics_of(program, changes={"limits": {"c_feed": 3600}})
    assert plain.move_time[move] == pytest.approx(60 * 20 / 1000)


def test_the_trace_shows_what_runs() -> None:
    tables = tables_of(
        inside("G1 X20. C1. F1000", "X-20."), "fanuc", changes={"limits": {"c_feed": 3600, "automatic_override": True}}
    )
    runs, trace = tables["dynamics"], (tables["trace"], tables["tool_center"])
    shown = list(executed.moves(*trace, "tool"))
    assert [one.time for one in shown] == pytest.approx(runs.move_time.tolist(), abs=1e-6)
    assert shown[1].c_feed == pytest.approx(3240)
    aligned = "".join(trace_columns.moves_table(*trace, "tool", None, None))
    assert "3240" in aligned
    # What is programmed asks for more.
    assert list(executed.moves(*trace, "programmed"))[1].c_feed == pytest.approx(math.degrees(1000))


def test_through_the_center_the_tool_waits_for_half_a_turn() -> None:
    limits = {"c_feed": 3600, "automatic_override": True}
    dynamics = dynamics_of(inside("G1 X-60. F600"), changes={"limits": limits})
    assert dynamics.move_time[-1] == pytest.approx(60 * (60 / 600 + 180 / 3240))


def test_a_clamped_feed_is_the_one_that_runs() -> None:
    dynamics = dynamics_of(inside("G1 X40. F600", "C10."), changes={"limits": {"polar_feed": 150}})
    assert dynamics.true_feed.tolist() == [150, 150]
    assert dynamics.move_time.tolist() == pytest.approx([60 * 10 / 150, 60 * 10 / 150])


# ---- the rows ----


@looped(
    ("block", "seconds"),
    [
        ("G1 Z-5.", 60 * 7 / 200),
        ("G1 X30. Z-5.", 60 * 5 / 200),
        ("G4 P1500", 1.5),
        ("G4 X2.5", 2.5),
        ("G4 U.5", 0.5),
        ("G4", 0),
        ("G4 X1500", 1.5),
        ("M8", 0),
        # C turns by 45 deg and X goes out from 20 to 28.28.
        ("G0 C20.", max(60 * 45 / 18000, 60 * (math.hypot(20, 20) - 20) / 6000)),
        ("G0 Z-10.", 60 * 12 / 12000),
    ],
)
def test_the_time_of_a_block(block: str, seconds: float) -> None:
    dynamics = dynamics_of(inside("G1 X40. F200", block), changes=RAPIDS)
    assert dynamics.time[row_of(dynamics, 6)] == pytest.approx(seconds)


@looped(
    ("block", "reason"),
    [
        ("G4 P1.5", "dwell"),
        ("G4 X1. P500", "dwell"),
        ("G4 F2.", "dwell"),
        ("G0 C20.", "rapid traverse"),
        ("G99 G1 C20.", "feed per revolution"),
        ("G1 G41 C20.", "no radius"),
        ("G1 F0 C20.", None),
    ],
)
def test_what_is_not_known_of_a_time_is_said(block: str, reason: str | None) -> None:
    dynamics = dynamics_of(inside("G1 X40. F200", block), changes={})
    row = row_of(dynamics, 6)
    if reason is None:
        assert math.isinf(dynamics.time[row])
        return
    assert math.isnan(dynamics.time[row])
    told = dynamics.times(np.flatnonzero(dynamics.trace.mode.section >= 0))
    assert [(one[0], one[2]) for one in told.unknown][:1] == [(reason, row)]
    assert told.known == pytest.approx(60 * 10 / 200)
    assert math.isnan(told.whole)
    assert math.isnan(dynamics.section_time[0])


def test_the_time_of_a_program_with_rapids_and_turning() -> None:
    program = "O1\nG98 G0 X60. Z2. C0\nG1 X40. Z-13. F100\nG0 X100. Z50.\nM30\n"
    dynamics = dynamics_of(program, changes=RAPIDS)
    rows = np.arange(len(dynamics.trace))
    told = dynamics.times(rows)
    # Nobody knows where the lathe stands before the first block.
    assert [one[:2] for one in told.unknown] == [("rapid traverse", 1)]
    assert told.known == pytest.approx(60 * math.hypot(10, 15) / 100 + max(60 * 30 / 6000, 60 * 63 / 12000))
    assert dynamics_of(program).times(rows).known == pytest.approx(60 * math.hypot(10, 15) / 100)


def test_inch_and_mm_take_the_same_time() -> None:
    inch = "O1\nG20 G98 G0 X2. Z.1 C0\nG12.1\nG1 X1. F5.\nC.25\nZ-.1\nG4 X1.\nG13.1\nM30\n"
    mm = "O1\nG21 G98 G0 X50.8 Z2.54 C0\nG12.1\nG1 X25.4 F127.\nC6.35\nZ-2.54\nG4 X1.\nG13.1\nM30\n"
    assert dynamics_of(inch).section_time == pytest.approx(dynamics_of(mm).section_time)
