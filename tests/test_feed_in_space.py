"""What F is along: the way on the plane or that in space (polar.feed_measures), of tool center or contour (CFC)."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from path_sampling import point_at, sampled
from programs import report_of, tables_of

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.feed.feed_curve import feed_curve
from polarcheck.foundation.states import Motion
from polarcheck.reports.pages import executed
from polarcheck.rewrite.feeds.table import feed_table

SPACE = {"polar": {"feed_measures": "space", "other_axes": "together"}}

#: A section on each control: what comes before, the code of a line, the word of the virtual axis, what ends it.
#: X is a radius in all of them but the first.
SECTIONS = {
    "fanuc": ("G98 G0 X40. Z5. C0\nG12.1\nG1 X40. C0 F900", "G1", "X40.", "X20.", "C", "G13.1"),
    "haas-lathe": ("G21\nG98 G0 X40. Z5. C0\nG17\nG112\nG1 X20. Y0 F900.", "G1", "X20.", "X10.", "Y", "G113\nG18"),
    "okuma-osp": ("G0 X40. Z5. C0\nG94\nG137 C0\nG17\nG101 X20. Y0 F900", "G101", "X20.", "X10.", "Y", "G136"),
    "siemens-transmit": (
        "G71 G94 G0 X40. Z5. C0\nDIAMOF\nTRANSMIT\nG17\nG1 X20 Y0 F900",
        *("G1", "X20.", "X10.", "Y", "TRAFOOF\nDIAMON"),
    ),
    "mazak-quick-turn": ("G98 G0 X40. Z5. C0\nG17 XC\nG12.1\nG1 X40. C0 F900", "G1", "X40.", "X20.", "C", "G13.1"),
    "citizen": ("G98 G0 X40. Z5. C0\nG12.1 D0 E=C\nG17\nG1 X20. Y0 F900", "G1", "X20.", "X10.", "Y", "G13.1"),
    "hurco": ("G94 G0 X40. Z5. C0\nG7\nG101\nG17\nG1 X20. Y0 F900.", "G1", "X20.", "X10.", "Y", "G109"),
    "fagor-8055t": ("G94 G15\nG0 X20. Z5. C0\nG16 XC\nG1 X20. C0 F900.", "G1", "X20.", "X10.", "C", "G18"),
}
IN_SPACE = {"haas-lathe", "okuma-osp", "siemens-transmit", "hurco", "fagor-8055t"}


def dynamics_of(program: str, machine: str, *tools: str, **more: Any) -> Dynamics:
    found: Dynamics = tables_of(program, machine, *tools, **more)["dynamics"]
    return found


def section(machine: str, *blocks: str) -> str:
    before, line, x, half, virtual, after = SECTIONS[machine]
    written = [
        block.replace("LINE", line).replace("X20.", x).replace("X10.", half).replace("V", virtual) for block in blocks
    ]
    return "\n".join([before, *written, after, "M30", ""])


@pytest.mark.ci
@looped("machine", SECTIONS, one_in=3)
@looped(
    ("blocks", "way", "rise"),
    [
        (("LINE X20. V10. Z-5. F200.",), 10, 10),
        (("LINE X20. V10. Z2. F200.",), 10, 3),
        # A block that repeats Z moves on the plane alone, one that repeats X and the virtual axis is a plunge.
        (("LINE X20. V10. Z5. F200.",), 10, 0),
        (("LINE X20. V0. Z-5. F200.",), 0, 10),
    ],
)
def test_a_ramp_takes_the_time_of_what_f_is_along(machine: str, blocks: tuple[str], way: float, rise: float) -> None:
    dynamics = dynamics_of(section(machine, *blocks), machine)
    row = int(np.flatnonzero(dynamics.trace.feedrate.feed == 200)[0])
    along = math.hypot(way, rise) if machine in IN_SPACE else way or rise
    assert dynamics.time[row] == pytest.approx(60 * along / 200)
    # C turns fastest where the line from (20, 0) along the virtual axis begins.
    on_plane = 200 * way / along
    assert dynamics.tool_center.c_feed[row] == pytest.approx(math.degrees(on_plane / 20))


def inside(*blocks: str) -> str:
    return "\n".join(["O1", "T0101", "G98 G0 X60. Z2. C0", "G12.1", *blocks, "G13.1", "M30", ""])


coordinates = st.integers(-200, 200).map(lambda number: number / 10)


@st.composite
def helices(draw: st.DrawFn) -> str:
    """A contour of lines and arcs at changing depths, left or right of which the tool runs."""
    side = draw(st.sampled_from(["G41", "G42", ""]))
    blocks = [f"G1 {side} X50. C{draw(coordinates)} F{draw(st.integers(100, 900))}"]
    for _ in range(draw(st.integers(1, 4))):
        code = draw(st.sampled_from(["G1", "G2", "G3"]))
        arc = "" if code == "G1" else f" R{draw(st.integers(300, 600)) / 10}"
        depth = draw(st.sampled_from(["", f" Z{draw(coordinates)}"]))
        blocks.append(f"{code} X{2 * draw(coordinates)} C{draw(coordinates)}{arc}{depth}")
    return inside(*blocks, "G1 G40 X80.")


@pytest.mark.nightly
@settings(max_examples=15, deadline=None)
@given(helices(), st.integers(0, 5))
def test_helices_agree_with_dense_sampling(program: str, radius: int) -> None:
    """The way in space of a block is that of all its moves on the plane, corners included, and its Z."""
    dynamics = dynamics_of(program, "fanuc", f"1:radius={radius}", changes=SPACE)
    trace, moves = dynamics.trace, dynamics.moves
    for row in np.unique(moves.row).tolist():
        members = np.flatnonzero(moves.row == row)
        shapes = [tuple(column[index] for column in moves.shape) for index in members.tolist()]
        lengths = [point_at(*shape)[0] for shape in shapes]
        if not moves.known[members].all() or not 0.5 < sum(lengths) < 300:
            continue
        space = math.hypot(sum(lengths), trace.path.z[row] - trace.path.z[row - 1])
        assert dynamics.time[row] == pytest.approx(60 * space / trace.feedrate.feed[row], rel=1e-6)
        for index, shape, length in zip(members.tolist(), shapes, lengths, strict=True):
            if length < 0.5 or length > 100 or moves.nearest[index] < 1:
                continue
            expected = sampled(shape, float(trace.feedrate.feed[row]) * sum(lengths) / space)
            assert float(dynamics.move_time[index]) == pytest.approx(expected.pop("time"), rel=1e-4)
            values = {name: float(getattr(dynamics, name)[index]) for name in expected}
            assert values == pytest.approx(expected, rel=1e-4, abs=1e-3)


#: A helix of one turn about a center 20 mm from that of C, radius 5, 6 mm deep.
HELIX = inside("G1 X50. C0 F300", "G3 X50. C0 I-5. J0 Z-4. F300", "G1 X60.")
WAY, RISE = 2 * math.pi * 5, 6.0
SHARE = WAY / math.hypot(WAY, RISE)


def test_a_helix_in_closed_form() -> None:
    dynamics = dynamics_of(HELIX, "fanuc", "1:radius=0", changes=SPACE)
    move = int(np.flatnonzero(dynamics.moves.kind == Motion.CCW)[0])
    assert dynamics.move_time[move] == pytest.approx(60 * math.hypot(WAY, RISE) / 300)
    # Nearest at 15 mm, where the circle runs at a right angle to the radius.
    assert dynamics.c_feed[move] == pytest.approx(math.degrees(300 * SHARE / 15))
    assert dynamics.true_feed[move] == 300


def test_the_highest_feed_is_that_in_space() -> None:
    limits = {"c_feed": 600.0}
    tables = tables_of(HELIX, "fanuc", "1:radius=0", changes={**SPACE, "limits": limits})
    row = next(row for row in feed_table(tables).rows if "G3" in row.block)
    assert row.allowed == pytest.approx(math.radians(600) * 15 / SHARE, rel=1e-6)
    flat = tables_of(HELIX, "fanuc", "1:radius=0", changes={"limits": limits})
    row = next(row for row in feed_table(flat).rows if "G3" in row.block)
    assert row.allowed == pytest.approx(math.radians(600) * 15, rel=1e-6)


@looped("limits", [{"c_acceleration": 50.0}, {"x_feed": 100.0}])
def test_other_limits_leave_more_feed_by_the_same_share(limits: dict[str, float]) -> None:
    allowed = [
        tables_of(HELIX, "fanuc", "1:radius=0", changes={**changes, "limits": limits})["highest_feeds"].allowed
        for changes in (SPACE, {})
    ]
    row = int(np.flatnonzero(np.isfinite(allowed[1]) & (allowed[0] != allowed[1]))[0])
    assert allowed[0][row] == pytest.approx(allowed[1][row] / SHARE)


def test_override_holds_c_on_a_ramp() -> None:
    """C turns at 90 % of its limit all the way along a chord that asks for more; Z goes along."""
    limits = {"c_feed": 300.0, "automatic_override": True}
    program = inside("G1 X20. C-10. F900", "C10. Z-18. F900", "X60.")
    dynamics = dynamics_of(program, "fanuc", "1:radius=0", changes={**SPACE, "limits": limits})
    row = int(np.flatnonzero(dynamics.trace.path.rise)[0])
    assert dynamics.time[row] == pytest.approx(60 * 90 / 270)
    move = int(np.flatnonzero(dynamics.moves.row == row)[0])
    # The lowest F in space is where C is nearest: 270 deg/min at 10 mm, on a slope of 20 by 20.
    assert dynamics.true_feed[move] == pytest.approx(math.radians(270) * 10 * math.sqrt(2))


def test_trace_and_curve_show_f_and_what_it_leaves() -> None:
    tables = tables_of(HELIX, "fanuc", "1:radius=0", changes=SPACE)
    helix = next(one for one in executed.moves(tables["trace"], tables["tool_center"], "tool") if one.kind == "ccw")
    assert (helix.feed, list(helix.z)) == (300, [2, -4])
    assert helix.time == pytest.approx(60 * math.hypot(WAY, RISE) / 300, abs=1e-5)
    assert helix.c_feed == pytest.approx(math.degrees(300 * SHARE / 15), rel=1e-5)
    curve = feed_curve(tables["dynamics"])
    on_helix = curve.row == int(np.flatnonzero(tables["trace"].path.rise)[0])
    assert curve.feed[on_helix] == pytest.approx(300)
    assert curve.c_feed[on_helix].max() == pytest.approx(helix.c_feed, rel=1e-3)


@pytest.mark.nightly
@looped(
    ("before", "between", "in_space"),
    [
        ("", "", (True, True)),
        ("FGROUP(X,Y)", "", (False, False)),
        ("", "fgroup (y, x) M8", (True, False)),
        ("FGROUP(X,Y)", "FGROUP()", (False, True)),
        ("FGROUP(X,Y)", "N5 FGROUP(X, Y, Z)", (False, True)),
    ],
)
def test_fgroup_names_the_axes_that_f_is_for(before: str, between: str, in_space: tuple[bool, bool]) -> None:
    """NC programming 12/2019 p. 105."""
    blocks = [before, "LINE X20. V10. Z-5. F200.", between, "LINE X20. V0. Z5."]
    # What stands before them is in force there, too.
    report = report_of(program := section("siemens-transmit", *blocks), "siemens-transmit")
    found = dynamics_of(program, "siemens-transmit").move_time[-2:]
    assert found == pytest.approx([60 * (math.hypot(10, 10) if each else 10) / 200 for each in in_space])
    assert report.verdict == "pass"
    assert not report.not_evaluated


def test_fgroup_of_other_axes_is_not_simulated() -> None:
    program = section("siemens-transmit", "FGROUP(X,C)", "LINE X20. V10. Z-5. F200.")
    assert [one.reason for one in report_of(program, "siemens-transmit").not_evaluated] == ["FGROUP is not simulated"]


def test_z_that_is_not_known_leaves_the_rate_open() -> None:
    program = "O1\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10. Z-5.\nX60.\nG13.1\nM30\n"
    report = report_of(program, "fanuc", "1:radius=0", changes={**SPACE, "limits": {"c_feed": 3600}})
    reasons = {one.reason for one in report.not_evaluated if one.rule == "c-feed-above-limit"}
    assert any("where Z stands before is not known" in reason for reason in reasons)
    assert report.polar_sections[0].time_not_known == ["position not known in line 6"]


ROUND = """G71 G94 G0 X120 Z5 C0
T1 D1
TRANSMIT
G17
{} G1 G42 X30 Y0 F200
{}
Y25
G3 X25 Y30 CR=5
{}
G40 X0 Y80
TRAFOOF
M30
"""


@pytest.mark.ci
@looped(
    ("before", "between", "share"),
    [
        ("", "", 1),
        # 808D advanced 01/2014 p. 79: F (R of the contour + R of the tool) / R of the contour.
        ("CFC", "", 11 / 5),
        ("cfc", "CFTCP", 1),
        ("", "CFC", 11 / 5),
        # On the outer side CFIN leaves F alone.
        ("CFIN", "", 1),
    ],
    one_in=2,
)
def test_cfc_is_the_feed_of_the_contour(before: str, between: str, share: float) -> None:
    program = ROUND.format(before, between, "G1 X-30")
    report = report_of(program, "siemens-transmit", "1/1:radius=6")
    dynamics = dynamics_of(program, "siemens-transmit", "1/1:radius=6")
    move = int(np.flatnonzero(dynamics.moves.kind == Motion.CCW)[0])
    assert dynamics.move_time[move] == pytest.approx(60 * 11 * math.pi / 2 / (200 * share))
    # The circle of 11 mm about (25, 25): C turns fastest where it is farthest from the center of C, at 11 + 25 sqrt 2.
    assert dynamics.c_feed[move] == pytest.approx(math.degrees(200 * share / (11 + 25 * math.sqrt(2))))
    assert not [one for one in report.not_evaluated if "CF" in one.reason]


def test_inner_arcs_slow_the_tool_center_down() -> None:
    program = ROUND.format("CFIN", "", "G1 X20\nG2 X10 Y40 CR=10\nG1 Y50")
    moves = dynamics_of(program, "siemens-transmit", "1/1:radius=6").moves
    inner = int(np.flatnonzero(moves.kind == Motion.CW)[0])
    assert moves.time[inner] == pytest.approx(60 * 10 * math.pi / 2 / 200)
