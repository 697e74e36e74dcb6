"""Each control behaves as its manual says: its examples, tables and cycles, and what a wrong machine shows."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from document_programs import GSK_1, M700V
from programs import machine_of, moves_of, report_of, said, tables_of, trace_of

from polarcheck.foundation.finding import FileReport
from polarcheck.foundation.states import Motion
from polarcheck.program.reading import source, translation
from polarcheck.reports.pages.executed import rows

GSK_CYCLE = """
T0202
G0 X348. C30.
G12.1 E8.
G42 G1 X300. C0 F2000
C80.
G3 X220. C120. R40.
G1 X-220.
G3 X-300. C80. R40.
G1 C-80.
G3 X-220. C-120. R40.
G1 X220.
G3 X300. C-80. R40.
G1 C0
G40 X300.
G13.1
"""
LSIS = """
G112 % Polar coordinate interpolation mode On
G01 C10 F100
G01 X-8 % feed
G03 X-10. C8. R2.
G113
"""
HAAS = """
G20 G98 G0 X3. C0
G17
G112
G1 X.875 Y0. F5.
Y.5
G3 X.25 Y1.125 R.625
G1 X-.75
G0 Z.1
G113
"""


# ---- diameter or radius ----


@looped(
    ("program", "name", "right"),
    [
        (M700V.text, "mitsubishi-m700", "radius"),
        (GSK_1.text, "gsk-988", "diameter"),
        (GSK_CYCLE, "gsk-988", "diameter"),
    ],
    ids=["M700V", "GSK, once round", "GSK, infeed cycle"],
)
def test_the_example_of_the_manual_closes_in_one_reading_of_x(program: str, name: str, right: str) -> None:
    assert machine_of(name).polar.x == right
    for reading in ("diameter", "radius"):
        tables = tables_of(program, name, changes={"polar": {"x": reading}, "control": {"x": reading}})
        assert tables["trace"].path.is_arc.any()
        assert tables["arcs"].is_no_circle.any() == (reading != right), reading


@pytest.mark.ci
def test_the_haas_example_is_a_quarter_of_a_circle_with_x_as_a_radius() -> None:
    tables = tables_of(HAAS, "haas-lathe")
    trace = tables["trace"]
    assert trace.path.center[trace.path.is_arc] == pytest.approx(25.4 * (0.25 + 0.5j))
    assert np.nanmax(tables["arcs"].sweep) == pytest.approx(90)
    assert np.nanmax(tables_of(HAAS, "haas-lathe", changes={"polar": {"x": "diameter"}})["arcs"].sweep) < 80
    rules = {finding.rule for finding in report_of(HAAS, "haas-lathe").findings}
    assert not rules & {"rapid-in-polar", "wrong-axis-address-in-polar", "plane-selected-in-polar"}


def test_the_lsis_example_is_a_quarter_of_a_circle_with_x_as_a_radius() -> None:
    """Its only arc is written with R, which a shorter chord fits, too: the quarter is what tells."""
    tables = tables_of(LSIS, "lsis")
    assert np.nanmax(tables["arcs"].sweep) == pytest.approx(90)
    trace = tables["trace"]
    assert trace.path.center[trace.path.is_arc] == pytest.approx(-8 + 8j)
    as_diameter = tables_of(LSIS, "lsis", changes={"polar": {"x": "diameter"}})
    assert np.nanmax(as_diameter["arcs"].sweep) < 80
    assert not report_of(LSIS, "lsis").findings


@pytest.mark.nightly
@looped("name", ["gsk-988", "fanuc-16i", "turning-center"], one_in=2)
def test_the_m700v_example_is_wrong_where_x_is_a_diameter(name: str) -> None:
    rules = {finding.rule for finding in report_of(M700V.text, name).findings}
    assert rules & {"arc-end-off-circle", "diameter-radius-mixed"}


def test_x_follows_the_words_that_switch_it() -> None:
    program = "G90 G94 G0 X40. C0\n{}\nG12.1\nG1 X20. F200\nG13.1\n{}\nG0 X40.\n"
    trace = trace_of(program.format("G10.9 X0", "G10.9 X1"), "mazak-eia")
    assert trace.path.x.tolist() == [20, 20, 20, 20, 20, 20, 20]
    trace = trace_of(program.format("", ""), "mazak-eia")
    assert trace.path.x.tolist() == [20, 20, 10, 10, 20]
    trace = trace_of("G0 X40 Y0\nDIAMOF\nTRANSMIT\nG1 X20 F9\nTRAFOOF\nDIAMON\nG0 X40\n", "siemens-transmit")
    assert trace.path.x.tolist() == [20, 20, 20, 20, 20, 20, 20]


# ---- F in the mode and after it: both tables of M700V p. 73 ----

PER_MINUTE = {"B": "G94", "A": "G98"}
PER_REVOLUTION = {"B": "G95", "A": "G99"}


def system_of(system: str) -> dict[str, dict[str, str]]:
    """G-code list 2 of Mitsubishi is system A, with G98 and G99; list 3 is system B, with G94 and G95."""
    return {"control": {"g_code_system": system}}


def table_program(mode: str, in_mode: str, system: str) -> str:
    before = {"per minute": PER_MINUTE, "per revolution": PER_REVOLUTION}[mode][system]
    value = {"per minute": 100, "per revolution": 0.2}[mode]
    return f"{before}\nG1 X50. Z5. F{value}\nG0 X40. C0\nG12.1\nG1 X30. {in_mode}\nX20.\nG13.1\nG1 X30.\n"


def feeds(mode: str, in_mode: str, system: str) -> tuple[float, float, FileReport]:
    """F at the first cutting move in the mode [mm/min], F in force after it, and the report."""
    program, changes = table_program(mode, in_mode, system), system_of(system)
    trace = trace_of(program, "mitsubishi-m700", changes=changes)
    return (
        float(trace.feedrate.feed[4]),
        float(trace.feedrate.feed_number[7]),
        report_of(program, "mitsubishi-m700", changes=changes),
    )


@pytest.mark.ci
@looped("system", ["A", "B"], one_in=2)
@looped(
    ("mode", "in_mode", "used", "after", "alarm"),
    [
        ("per minute", "", 100, 100, None),  # no F in the mode, G94(G98): previous F is used, and stays
        ("per revolution", "", np.nan, 0.2, "P62"),  # no F in the mode, G95(G99): P62; F just before G12.1
        ("per minute", "F300", 300, 300, None),  # F in the mode, G94(G98): commanded F is used, and stays
        ("per revolution", "F300", 300, 0.2, None),  # F in the mode, G95(G99): per minute; F just before G12.1
    ],
)
def test_feed_in_the_mode_and_after_it(
    mode: str, in_mode: str, used: float, after: float, alarm: str | None, system: str
) -> None:
    in_polar, behind, report = feeds(mode, in_mode, system)
    np.testing.assert_equal(in_polar, used)
    assert behind == after
    found = [(finding.rule, finding.alarm, finding.line) for finding in report.findings if finding.severity == "error"]
    assert found == ([("feed-lost-from-per-revolution", "P62", 5)] if alarm else [])


@pytest.mark.ci
@looped("system", ["A", "B"])
@looped(
    ("mode", "in_mode", "inside", "behind"),
    [
        ("per minute", "", ("per minute", 100), ("per minute", 100)),
        ("per revolution", "", ("per minute", None), ("per revolution", 0.2)),
        ("per minute", "F300", ("per minute", 300), ("per minute", 300)),
        ("per revolution", "F300", ("per minute", 300), ("per revolution", 0.2)),
    ],
)
def test_the_executed_table_shows_how_f_is_read(
    mode: str, in_mode: str, inside: tuple[str, float | None], behind: tuple[str, float], system: str
) -> None:
    """Each cell of both tables: in the mode F is per minute (note 1), after it what stands in the last column."""
    tables = tables_of(table_program(mode, in_mode, system), "mitsubishi-m700", changes=system_of(system))
    table = list(rows(tables["trace"], tables["tool_center"]))
    assert [(row["feed_mode"], row["f"]) for row in (*table[4:6], table[7])] == [inside, inside, behind]
    assert [row["feed"] for row in table[4:6]] == [inside[1]] * 2


@looped("system", ["A", "B"])
def test_the_first_move_at_feed_of_z_alone_needs_an_f_in_each_list_of_codes(system: str) -> None:
    program = table_program("per revolution", "", system).replace("G1 X30. \n", "G1 Z-5.\nX30. F200\n", 1)
    assert "Z-5." in program
    report = report_of(program, "mitsubishi-m700", changes=system_of(system))
    errors = [(found.rule, found.alarm, found.line) for found in report.findings if found.severity == "error"]
    assert errors == [("feed-lost-from-per-revolution", "P62", 5)]


def test_last_of_several_feeds_of_the_mode_stays_after_it() -> None:
    program = "G94 F100\nG0 X40. C0\nG12.1\nG1 X30. F300\nX20. F400\nG13.1\nG1 X30.\n"
    assert trace_of(program, "mitsubishi-m700").feedrate.feed_number[-1] == 400
    again = "G95 F0.2\nG0 X40. C0\nG12.1\nG1 X30. F300\nG13.1\nG12.1\nG1 X30. F500\nG13.1\nG1 X30.\n"
    assert trace_of(again, "mitsubishi-m700").feedrate.feed_number[-1] == 0.2
    written = "G95 F0.2\nG0 X40. C0\nG12.1\nG1 X30. F300\nG13.1\nG1 X30. F0.3\n"
    assert trace_of(written, "mitsubishi-m700").feedrate.feed_number[-1] == 0.3


def test_f_is_one_modal_word_on_other_controls() -> None:
    trace = trace_of("G99 F0.2\nG0 X40. C0\nG12.1\nG1 X30. F300\nG13.1\nG1 X30.\n", "fanuc")
    assert trace.feedrate.feed_number[-1] == 300


# ---- the infeed cycle ----


def test_infeed_cycle_pass_by_pass() -> None:
    """X348 is 24 mm outside of the contour at X300: passes at 16 and 8 mm, then the contour."""
    moves = moves_of(GSK_CYCLE, "gsk-988", "2:radius=0")
    assert len(moves) == 30
    assert moves.start[0] == 174
    for number, offset in enumerate((16, 8, 0)):
        cut = moves[np.arange(len(moves)) // 10 == number]
        assert cut.end[0] == pytest.approx(150 + offset)
        assert cut.end[-1] == pytest.approx(cut.end[0]), "the pass closes"
        corners = cut.kind == Motion.CCW
        assert np.abs(cut.start - cut.center)[corners] == pytest.approx(40 + offset)
        assert cut.start.imag.max() == pytest.approx(120 + offset)
        assert cut.known.all()
        assert cut.nearest.min() == pytest.approx(120 + offset)
        assert cut.c_feed.max() == pytest.approx(np.degrees(2000 / (120 + offset)))
    assert moves.start[1:] == pytest.approx(moves.end[:-1]), "the path has no gap"
    turned = moves.c_angles[1] - moves.c_angles[0]
    assert turned.sum() == pytest.approx(3 * 360)
    assert moves.c_angles[0][0] == 30


def test_infeed_cycle_with_a_cutter() -> None:
    moves = moves_of(GSK_CYCLE, "gsk-988", "2:radius=10")
    # The start point at 174 is that of the tool center: a pass at 176 would lie beyond it.
    assert sorted({round(float(value), 6) for value in moves.end.real[::10]}) == [160, 168]
    unknown = moves_of(GSK_CYCLE, "gsk-988")
    assert len(unknown) == 30
    assert not unknown.known.any()


@pytest.mark.ci
@looped(
    ("infeed", "passes"),
    [("", 1), ("E0", 1), ("E8.", 3), ("E-8.", 3), ("E12.", 2), ("E24.", 1), ("E30.", 1), ("E5.", 5)],
)
def test_how_many_passes(infeed: str, passes: int) -> None:
    moves = moves_of(GSK_CYCLE.replace("E8.", infeed), "gsk-988", "2:radius=0")
    assert len(moves) == 10 * passes


@looped(
    ("infeed", "passes"),
    [("E8.", [171, 163, 155]), ("E5.", [170, 165, 160, 155]), ("E7.", [169, 162, 155]), ("E23.9", [155])],
)
def test_the_first_pass_is_not_beyond_the_start_point(infeed: str, passes: list[float]) -> None:
    """From X348 with R 5 round X300: all between 174 and 155, E apart."""
    moves = moves_of(GSK_CYCLE.replace("E8.", infeed), "gsk-988", "2:radius=5")
    assert moves.end.real[::10] == pytest.approx(passes)


def test_infeed_cycle_along_the_path_of_the_tool_center() -> None:
    """Without G41 and G42 the passes lie on the side from which the tool comes."""
    square = "G98 G0 X{} C0\nG12.1 E4.\nG1 X40. F100\nC20.\nX-40.\nC-20.\nX40.\nC0\nX{}\nG13.1\n"
    outside = moves_of(square.format("60.", "60."), "gsk-988")
    assert outside.end[0] == 28
    assert np.abs(outside.end).max() == pytest.approx(abs(28 + 28j))
    inside = moves_of(square.format("20.", "20."), "gsk-988")
    assert inside.end[0] == 12
    assert np.abs(inside.end).min() == pytest.approx(10)


@pytest.mark.ci
def test_every_pass_is_checked() -> None:
    """A pass that the contour alone would hide: inside a pocket the first passes are nearest to the center."""
    pocket = "G98 G0 X4. C0\nG12.1 E4.\nG1 X40. F100\nC20.\nX-40.\nC-20.\nX40.\nC0\nG13.1\n"
    limit = {"limits": {"c_feed": 700}}
    of_passes, of_contour = (
        [found.values["c_feed"] for found in report_of(program, "gsk-988", changes=limit).findings]
        for program in (pocket, pocket.replace(" E4.", ""))
    )
    assert max(of_passes) > max([0.0, *of_contour])


def test_what_is_not_simulated_is_said() -> None:
    program = GSK_CYCLE.replace("G12.1 E8.", "G12.1 Q3 E.001")
    reasons = [entry.reason for entry in report_of(program, "gsk-988", "2:radius=0").not_evaluated]
    assert any(reason.startswith("of an infeed cycle only the passes next to the contour") for reason in reasons)
    assert not any(reason.startswith("Q names") for reason in reasons)
    moves = moves_of(program, "gsk-988", "2:radius=0")
    assert len(moves) == 10 * 201


@pytest.mark.ci
def test_an_open_contour_is_one_pass() -> None:
    program = GSK_CYCLE.replace("G1 C0\nG40 X300.", "G1 C-10.\nG40 X340.")
    moves = moves_of(program, "gsk-988", "2:radius=10")
    assert len(moves) < 15
    (finding,) = report_of(program, "gsk-988", "2:radius=10").findings
    assert (finding.line, finding.rule) == (4, "contour-open-with-infeed")
    assert [one.rule for one in finding.follows] == ["contour-not-closed", "nearly-regular-contour"]


@pytest.mark.nightly
def test_infeed_is_a_word_of_one_control() -> None:
    assert not tables_of(GSK_CYCLE, "fanuc")["infeed"].depth.any()
    assert (4, "polar-switch-not-alone") in said(report_of(GSK_CYCLE, "fanuc"))


# ---- automatic override ----

FAST = "G98 G0 X60. C0\nG12.1\nG1 X4. C5. F100\nC-5. F500\nG13.1\n"


@pytest.mark.ci
def test_excess_speed_is_an_alarm_or_an_override() -> None:
    off = report_of(FAST, "fanuc-30i", changes={"parameters": {"1422": 3600}}).findings[0]
    assert (off.rule, off.severity, off.alarm) == ("c-feed-above-limit", "error", "OT0512")
    parameters = {"1422": 3600, "5450#1": 1, "5463": 80}
    on = report_of(FAST, "fanuc-30i", changes={"parameters": parameters}).findings[0]
    assert (on.rule, on.severity, on.alarm) == ("c-feed-above-limit", "warning", None)
    # C turns at 500 / 2 mm, that is 14324 deg/min; 80 % of 3600 is 2880, a share of 20.1 %.
    assert "20 %, 100 mm/min" in on.message


def test_override_and_true_feed() -> None:
    tool_center = tables_of(FAST, "fanuc", changes={"limits": {"c_feed": 3600, "automatic_override": True}})[
        "tool_center"
    ]
    rate = float(np.degrees(500 / 2))
    assert tool_center.override[3] == pytest.approx(100 * 3240 / rate)
    assert tool_center.true_feed[3] == pytest.approx(500 * 3240 / rate)
    assert tool_center.override[2] == 100
    assert (tables_of(FAST, "fanuc", changes={"limits": {"c_feed": 3600}})["tool_center"].override == 100).all()
    slightly = tables_of(FAST, "fanuc", changes={"limits": {"c_feed": rate / 0.95, "automatic_override": True}})
    assert slightly["tool_center"].override[3] == pytest.approx(100 * 90 / 95)


# ---- words of other controls ----


def test_native_words_keep_every_position() -> None:
    words = {"TRANSMIT": "G12.1", "CR=": "R", "TRAFOOF": "G13.1", "AB": ""}
    text = "N10 transmit\nG3X5CR=2.5 XTRANSMIT TRANSMITX\nTRAFOOF(1) AB CAB AB1\n"
    found = translation.translated(source.read_source(text.encode()), words)
    assert found.code.tobytes() == b"N10 G00012.1\nG3X5  R2.5 XTRANSMIT TRANSMITX\nG0013.1(1)    CAB AB1\n"
    assert found.excerpt(4, 12) == "transmit"
    assert translation.translated(found, {}) is found


def test_words_of_ones_own_need_no_code() -> None:
    program = "G0 X60. Y0\nG1 X40. F9\nRADIUS\nX20.\nDIAM\nX20.\n"
    words = {"x_radius_words": ["RADIUS"], "x_diameter_words": ["DIAM"]}
    trace = trace_of(program, "fanuc", changes={"control": words})
    assert trace.path.x.tolist() == [30, 20, 20, 20, 20, 10]


def test_messages_name_the_native_word() -> None:
    program = "G0 X60 Y0\nTRANSMIT\nG1 X40 F9\nY5\nM30\n"
    finding = next(f for f in report_of(program, "siemens-transmit").findings if f.rule == "polar-never-left")
    assert "TRAFOOF is missing" in finding.message
    assert finding.block == "TRANSMIT"


def test_codes_of_other_numbers_move() -> None:
    program = "G94 G0 X120. C0\nG137 C0\nG101 X20. Y0 F200\nG101 Y10.\nG103 X10. Y20. L10.\nG136\n"
    trace = trace_of(program, "okuma-osp")
    assert trace.axes.motion.tolist()[2:5] == [Motion.LINE, Motion.LINE, Motion.CCW]
    assert trace.path.center[4] == pytest.approx(10 + 10j)
    assert trace.path.end[4] == pytest.approx(10 + 20j)


def test_virtual_axis_as_a_diameter() -> None:
    trace = trace_of(
        "G98 G0 X60. C0\nG12.1\nG1 X40. C20. F100\nG13.1\n", "fanuc", changes={"parameters": {"5450#0": 1}}
    )
    assert trace.path.end[2] == 20 + 10j


# ---- alarms ----


@pytest.mark.ci
@looped(
    ("code", "alarm"),
    [
        *((code, "PS0146") for code in ("G0", "G17", "G28 U0", "G31 X3.", "G32 Z-5.", "G52 X0", "G53 X0", "G68")),
        *((code, "PS0146") for code in ("G83 X40. C90. Z-1.", "G90 X20. Z-5.", "G92 X20. Z-1.", "G94 X20. Z-5.")),
        *((code, None) for code in ("G10 L2 P1 X0", "G20", "G43 H1", "G54", "G61", "G80", "G93", "G96 S100")),
    ],
    one_in=12,
)
def test_an_alarm_is_shown_at_codes_that_its_text_names(code: str, alarm: str | None) -> None:
    """What the mode does not allow is an error whichever it is; its number is told where that is proved."""
    program = f"G98 G0 X60. C0\nG12.1\nG1 X40. F100\n{code}\nG1 C5.\nX60.\nG13.1\n"
    (finding,) = report_of(program, "fanuc-30i").findings
    assert (finding.line, finding.severity, finding.alarm) == (4, "error", alarm)
    (finding,) = report_of(program, "fanuc-16i").findings
    assert finding.alarm == "146"


def test_a_code_of_another_system_is_another_alarm() -> None:
    """G94 is a cycle of system A, and allowed in systems B and C."""
    program = "G90 G94 G0 X60. C0\nG12.1\nG1 X40. F100\nG94\nG1 C5.\nX60.\nG13.1\n"
    assert report_of(program, "fanuc-30i", changes={"control": {"g_code_system": "B"}}).findings == []


@pytest.mark.ci
@looped(
    ("program", "name", "rule", "alarm"),
    [
        ("G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG0 C5.\nG1 C0\nG13.1\n", "fanuc-16i", "rapid-in-polar", "146"),
        ("G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG0 C5.\nG1 C0\nG13.1\n", "fanuc-30i", "rapid-in-polar", "PS0146"),
        ("G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG0 C5.\nG1 C0\nG13.1\n", "turning-center", "rapid-in-polar", "PS0146"),
        ("T0101\nG98 G0 X60. C0\nG41\nG12.1\nG13.1\n", "fanuc-16i", "polar-switched-in-offset-mode", "145"),
        ("T0101\nG98 G0 X60. C0\nG41\nG12.1\nG13.1\n", "fanuc-30i", "polar-switched-in-offset-mode", "PS0146"),
        ("T0101\nG94 G0 X60. C0\nG41\nG12.1\nG13.1\n", "mitsubishi-m700", "polar-switched-in-offset-mode", "P485"),
        ("T0101\nG98 G0 X60. C0\nG41\nG12.1\nG13.1\n", "gsk-988", "polar-switched-in-offset-mode", "polar "),
        ("G94 G0 X60. C0\nG12.1\nG1 X40. F100\nG12.1\nG13.1\n", "mitsubishi-m700", "polar-entered-twice", "P486"),
        ("G94 G0 X60. C0\nG12.1\nG1 X40. F9\nG28 X0\nG13.1\n", "mitsubishi-m700", "code-not-allowed-in-polar", "P481"),
        ("G94 G0 X60. C0\nG12.1\nG1 X40. F100\nG18\nG13.1\n", "mitsubishi-m700", "plane-selected-in-polar", "P485"),
        ("G94 G0 X60. C0\nG12.1\nG1 X40.\nG13.1\n", "mitsubishi-m700", "feed-missing-in-polar", "P62"),
        ("G98 G0 X60. C0\nG112\nG1 X40. Y5. F9\nG2 X30. Y9. R1.\nG113\n", "haas-lathe", "arc-radius-too-small", "302"),
    ], one_in=3,
)  # fmt: skip
def test_alarm_of_the_control(program: str, name: str, rule: str, alarm: str) -> None:
    found = [finding for finding in report_of(program, name).findings if finding.rule == rule]
    assert [str(finding.alarm).startswith(alarm) for finding in found] == [True]


@looped("name", ["haas-lathe", "siemens-transmit"])
def test_rapid_traverse_is_silent_where_the_control_takes_it(name: str) -> None:
    on, off = machine_of(name).polar.on[0], machine_of(name).polar.off[0]
    program = f"G17 G98 G0 X60. C0\n{on}\nG0 X40. Y0\nG1 Y5. F100\n{off}\n"
    assert "rapid-in-polar" not in {finding.rule for finding in report_of(program, name).findings}


# ---- the wrong machine ----


def other(program: str, name: str) -> str:
    """What a finding says of other machines that read the program well."""
    told = [finding.message.partition("; it reads well on ")[2] for finding in report_of(program, name).findings]
    (said,) = [text for text in told if text] or [""]
    return said


@pytest.mark.nightly
def test_a_program_for_another_machine_is_known() -> None:
    assert "--machine mitsubishi-m700" in other(M700V.text, "fanuc")
    assert "X is a radius" in other(M700V.text, "fanuc")
    assert "--machine haas-lathe" in other(HAAS, "fanuc")
    assert "Y is the second axis" in other(HAAS, "fanuc")


@pytest.mark.ci
def test_a_program_under_its_own_machine_is_left_alone() -> None:
    for program, name in (
        (M700V.text, "mitsubishi-m700"),
        (GSK_1.text, "gsk-988"),
        (LSIS, "lsis"),
        (HAAS, "haas-lathe"),
    ):
        assert not other(program, name)


@pytest.mark.nightly
def test_a_program_that_no_machine_reads_well_gets_no_advice() -> None:
    """All sixteen readings of the arcs of en.cncarea.com fail."""
    program = (
        "G94\nT0101\nG0 X120. C0\nG12.1\nG1 G42 X40. F100.\nG3 X0 C40. I-20.\nG1 X-25.\nG3 X-40. C25. K-15.\nG1 C0\n"
    )
    assert not other(program + "G3 X20. I20.\nG1 G40 X120.\nG13.1\n", "mitsubishi-m700")


def test_messages_name_the_virtual_axis_of_the_control() -> None:
    program = "T0101\nG98 G17 G0 X60. C0\nG112\nG1 Y5. F200\nG41 Y7.\nX20.\nG40 Y30.\nG113\n"
    found = report_of(program, "haas-lathe", "1:radius=5", "1:nose=0", changes={"control": {"units": "mm"}}).findings
    assert "2 mm in Y" in next(f.message for f in found if f.rule == "start-up-shorter-than-radius")


@pytest.mark.nightly
@looped(
    ("name", "units", "axis", "severity", "said_of_z"),
    [
        ("fanuc", "", "C", "warning", "Z moves on its own there, not on the line in space"),
        ("fanuc-16i", "G20 ", "C", "warning", "Z moves on its own"),
        ("turning-center", "", "C", "error", "this lathe cannot move Z together with the plane"),
        ("doosan", "", "C", "note", "Z moves on its own"),
        ("haas-lathe", "", "Y", "note", "one more corner"),
        ("okuma-osp", "", "Y", "note", "one more corner"),
    ],
)
def test_what_z_does_beside_x_hangs_on_the_lathe(
    name: str, units: str, axis: str, severity: str, said_of_z: str
) -> None:
    polar = machine_of(name).polar
    side = "G41 " if polar.other_axes == "together" else ""
    program = f"{units}G98 G0 X2.4 Z.1 C0\n{polar.on[0]}\nG1 {side}X1.5 {axis}.4 Z-.5 F40.\nX2.4\n{polar.off[0]}\n"
    (found,) = [one for one in report_of(program, name).findings if one.rule == "z-with-plane-axis"]
    assert found.severity == severity
    assert said_of_z in found.message
    assert f"X1.5 {axis}.4 Z-.5 in one block" in found.message


# ---- what one lathe forbids and another takes ----


def graded(program: str, name: str, *rules: str) -> list[tuple[int, str, str]]:
    found = report_of(program, name, "8:radius=1").findings
    return [(one.line, one.severity, one.rule) for one in found if one.rule in rules]


HEAD = "O1\nG20 G40 G97 {}\nT0808\nM5\nM35\nG28 H0\nM33 S900\nG98 G0 X2.4 Z.1 C0\n"
GUIDE = HEAD + "G12.1\n{}G1 {}X1.6 F40.\n{}C.3\nX2.4\nG13.1\nM30\n"
PLANES = "plane-selected-in-polar", "plane-wrong-at-entry"


@pytest.mark.ci
@looped(
    ("before", "behind", "beside", "later", "expected"),
    [
        ("G18", "", "", "", []),
        ("G17", "G18\n", "", "", []),
        ("", "G18\n", "", "", []),
        ("G17", "", "G18 ", "", []),
        ("G18", "", "", "G18 ", []),
        ("G17", "", "", "G18 ", [(9, "error", "plane-wrong-at-entry")]),
        ("G17", "", "", "", [(9, "error", "plane-wrong-at-entry")]),
        ("G18", "G17\n", "", "", [(10, "error", "plane-selected-in-polar")]),
        ("G18", "", "", "G19 ", [(11, "error", "plane-selected-in-polar")]),
    ],
    one_in=2,
)
def test_g18_may_stand_right_behind_g12_1_where_the_guide_wants_it(
    before: str, behind: str, beside: str, later: str, expected: list[tuple[int, str, str]]
) -> None:
    assert graded(GUIDE.format(before, behind, beside, later), "turning-center", *PLANES) == expected


@pytest.mark.ci
@looped(
    ("name", "plane", "severity"),
    [
        ("fanuc", "G18", ["error"]),
        ("doosan", "G18", ["note"]),
        ("mazak-eia", "G17", []),
        ("mazak-eia", "G19", ["warning"]),
        ("haas-lathe", "G17", []),
    ],
)
def test_a_plane_in_the_mode_is_graded_as_posts_and_shops_do_it(name: str, plane: str, severity: list[str]) -> None:
    on, off = machine_of(name).polar.on[0], machine_of(name).polar.off[0]
    program = f"O1\nG17 G98 G0 X50. Z2. C0\n{on}\n{plane}\nG1 X40. F200\n{off}\nM30\n"
    assert [found[1] for found in graded(program, name, "plane-selected-in-polar")] == severity


def test_an_unknown_code_from_100_on_may_be_a_macro_of_the_builder() -> None:
    program = "O1\nG0 X50. Z2.\nG150 X1.\nG199\nG250\nG9.5\nG150.5\nM30\n"
    expected = [(3, "warning"), (4, "warning"), (5, "warning"), (6, "error"), (7, "error")]
    for name in ("fanuc", "fanuc-16i", "doosan"):
        assert [found[:2] for found in graded(program, name, "unknown-code")] == expected


def test_words_beside_g112_are_a_note_where_nothing_forbids_them() -> None:
    program = "O1\nG17 G98 G0 X50. Z2. C0\n{} M8\nG1 X40. F200\n{} M9\nM30\n"
    rule = "polar-switch-not-alone"
    told = graded(program.format("G112", "G113"), "haas-lathe", rule)
    assert [(line, severity) for line, severity, _ in told] == [(3, "note"), (5, "note")]
    told = graded(program.format("G12.1", "G13.1"), "fanuc", rule)
    assert [(line, severity) for line, severity, _ in told] == [(3, "error"), (5, "error")]


def test_codes_that_a_haas_has() -> None:
    program = "O1\nG14\nG17 G98 G390\nG0 X50. Z2. C0 Y0\nG112\nG1 X20. F200\nG391 X-5. Y3.\nG390 X10.\nG113\nM30\n"
    report = report_of(program, "haas-lathe")
    assert not {"unknown-code", "code-not-allowed-in-polar"} & {found.rule for found in report.findings}
    trace = tables_of(program, "haas-lathe", changes={"control": {"units": "mm"}})["trace"]
    assert trace.path.end[[5, 6, 7]] == pytest.approx([20, 15 + 3j, 10 + 3j])


@pytest.mark.ci
@looped("name", ["fanuc", "fanuc-16i", "gsk-988", "turning-center"])
def test_feed_per_revolution_in_the_mode_is_a_note_where_the_documents_allow_it(name: str) -> None:
    told = graded("O1\nG99 G0 X50. Z2. C0\nG12.1\nG1 X40. F.1\nG13.1\nM30\n", name, "feed-per-revolution-in-polar")
    assert [(line, severity) for line, severity, _ in told] == [(4, "note")]


@pytest.mark.nightly
@looped("plane", ["G17 XC", "G17XC", "G17 UH", "G17 U H", "G17 X C", "G91 G17 XU\nG90"])
def test_a_mazak_selects_the_plane_with_its_axes(plane: str) -> None:
    program = f"O1\nG94 G0 X50. Z2. C0\n{plane}\nG12.1\nG1 X40. F200\nG13.1\nM30\n"
    assert not {"bad-number", "plane-wrong-at-entry"} & {
        found.rule for found in report_of(program, "mazak-eia").findings
    }


# ---- the clamp of the feed, GSK parameters 5450#1 and 5462 ----


@pytest.mark.ci
@looped(
    ("on", "severity", "text", "rate"),
    [
        (1, "warning", "F is 2000 mm/min, GSK 988T/TA/TB lathe control clamps it at 500 mm/min in the polar mode", 500),
        (
            0,
            "note",
            "F is 2000 mm/min, GSK 988T/TA/TB lathe control runs it as programmed, since limits.polar_feed_clamps is "
            "off: no clamp at 500 mm/min in the polar mode",
            2000,
        ),
    ],
)
def test_the_clamp_is_switched_by_a_parameter(on: int, severity: str, text: str, rate: float) -> None:
    changes = {"parameters": {"5450#1": on, "5462": 500}}
    report = report_of(GSK_CYCLE, "gsk-988", "2:radius=5,nose=0", changes=changes)
    (found,) = (one for one in report.findings if one.rule == "feed-above-polar-limit")
    assert (found.severity, found.message) == (severity, text)
    # The nearest the tool comes is 125 mm, in the middle of a straight side.
    assert report.polar_sections[0].c_feed == pytest.approx(np.degrees(rate / 125))


@pytest.mark.nightly
@looped("on", [0, 1])
def test_the_alarm_of_c_is_an_alarm_beside_the_clamp(on: int) -> None:
    """Note 1: beyond the limit of C the control stops; no parameter of this one slows C down."""
    changes = {"parameters": {"5450#1": on, "5462": 500}, "limits": {"c_feed": 200}}
    report = report_of(GSK_CYCLE, "gsk-988", "2:radius=5,nose=0", changes=changes)
    (found,) = (one for one in report.findings if one.rule == "c-feed-above-limit")
    assert found.severity == "error"
    rate, word = ("229", "F2000 of line 5 clamped at 500 mm/min,") if on else ("917", "F2000 of line 5,")
    assert f"C axis would turn at {rate} deg/min with {word}" in found.message
    assert "slows" not in found.message
    enough = {**changes, "limits": {"c_feed": 230}}
    rules = [rule for _, rule in said(report_of(GSK_CYCLE, "gsk-988", "2:radius=5,nose=0", changes=enough))]
    assert ("c-feed-above-limit" in rules) == (not on)


@pytest.mark.ci
@looped("limit", [0, 2000, 3000])
def test_an_f_up_to_the_clamp_says_nothing(limit: int) -> None:
    """5462 of 0 is no limit of its own."""
    changes = {"parameters": {"5450#1": 1, "5462": limit}}
    rules = [rule for _, rule in said(report_of(GSK_CYCLE, "gsk-988", "2:radius=5,nose=0", changes=changes))]
    assert "feed-above-polar-limit" not in rules


HAAS_HEAD = "%\nO1\nG20 G40 G97 G98\nM5\nM154\nT0101\nG17\nP2500 M133\n"
HAAS_TAIL = "G113\nG18\nG0 Z.1\nM135\nM155\nM30\n%\n"
HAAS_ABSOLUTE = """G0 X4. C0 Z-.25
G112
G1 X1.5 Y0. F15.
G1 G42 X.875 Y0. F5.
Y.5
G3 X.25 Y1.125 R.625
G1 X-.75
G3 X-.875 Y1. R.125
G1 Y-1.125
X.875
Y0.
G1 G40 X1.5
"""
HAAS_STEPS = """{0} G0 X4. C0 Z-.25
G112
G1 X1.5 Y0. F15.
{1}
G1 G42 X-.625 F5.
Y.5
G3 X-.625 Y.625 R.625
G1 X-1.
G3 X-.125 Y-.125 R.125
G1 Y-2.125
X1.75
Y1.125
{0} G1 G40 X1.5
"""


@pytest.mark.nightly
@looped(
    ("absolute", "incremental"),
    [("G390", "G391"), ("g390", "g391"), ("G390.", "G391."), ("N5 G0390", "G0391"), ("G390 M9", "G40 G391")],
    one_in=4,
)
def test_g390_and_g391_are_executed(absolute: str, incremental: str) -> None:
    """Axis words as coordinates and as distances: the same tool center path, whichever way the codes are spelled."""
    twin = HAAS_HEAD + HAAS_ABSOLUTE + HAAS_TAIL
    program = HAAS_HEAD + HAAS_STEPS.format(absolute, incremental) + HAAS_TAIL
    ours, theirs = (moves_of(text, "haas-lathe", "1:radius=.25,nose=0") for text in (program, twin))
    for column in ("start", "end", "center", "kind", "c_feed"):
        np.testing.assert_allclose(getattr(ours, column), getattr(theirs, column), atol=1e-9, equal_nan=True)
    reports = [report_of(text, "haas-lathe", "1:radius=.25,nose=0") for text in (program, twin)]
    assert [[rule for _, rule in said(report) if rule != "lower-case-word"] for report in reports] == [[], []]


def test_g391_outside_the_mode_moves_by_steps_too() -> None:
    program = HAAS_HEAD + "G0 X6. C0 Z1.\nG391\nX-2. Z-.5 C30.\nG390\nG112\nG1 X1. Y0. F15.\n" + HAAS_TAIL
    trace = trace_of(program, "haas-lathe")
    row = int(np.flatnonzero(trace.mode.enters)[0])
    np.testing.assert_allclose(
        [trace.path.x[row], trace.path.z[row], trace.path.c_angle[row]], [2 * 25.4, 0.5 * 25.4, 30.0]
    )


def test_g391_left_in_force_is_no_coordinate() -> None:
    """Else the contour would be that of the twin, which it is not."""
    steps = HAAS_STEPS.format("G390", "G391").replace("G390 G1 G40", "G1 G40")
    moves = moves_of(HAAS_HEAD + steps + HAAS_TAIL, "haas-lathe", "1:radius=.25,nose=0")
    np.testing.assert_allclose(moves.end[-1].real, (0.875 + 1.5) * 25.4, atol=1e-9)
