"""
Every key of a machine is used: changing it changes what is reported or traced of some program.

The keys stand in the order of the schema, each with a program and the value to which it is changed.
"""

from __future__ import annotations

import dataclasses
import functools
import json
from typing import Any

import msgspec
import pytest
from cases import looped
from programs import report_of, tables_of

from polarcheck.program.machines.machine import Machine
from polarcheck.reports.pages import executed
from polarcheck.rewrite.feeds.table import feed_table

TABLES = {
    field.name: [key.name for key in msgspec.structs.fields(field.type)]
    for field in msgspec.structs.fields(Machine)
    if isinstance(field.type, type)
    and issubclass(field.type, msgspec.Struct)
    and field.name not in ("macro", "writing")
}

#: Keys that no check reads, and why.
NOT_CHECKED = {
    "macro": "each of its keys has its program in test_macro_keys",
    "writing": "no check reads how programs are written: test_pen",
    "control.z_into_part": "test_z_into_part",
    "feed.with_rotary": "no check reads F outside of the mode: test_unroll",
    "alarm_codes": "test_an_alarm_is_shown_at_codes_that_its_text_names",
    "notes": "text for `polarcheck machines` and the page of controls",
    "known_parameters": "read where the profile is loaded; with [parameters] it is used below",
}
#: The codes of another G-code system than the one in force: the keys of all three are the same.
SYSTEMS = ("g_code_system_a", "g_code_system_b", "g_code_system_c")
#: Lists of codes.
LISTS = [f"{table}.{key}" for table in ("g_codes", "g_code_system_a", "m_codes") for key in TABLES[table]]
LISTS += [f"macro.{key}" for key in ("subprogram_calls", "macro_calls", "modal_macro_cancel", "program_returns")]
#: A program with a code of most of them.
RICH = """%
O1
G98 G40 G97 T0101 M6 M35 M3
G54 G17 G53 X0
G28 U0 H0
G10 L2 P1 X0
G52 X1.
G54.1 P1
G50 X100.
G92 X50. Z-5. F1.
G83 Z1. R2.
G80
G51 P2
G68.1 R5.
G68
G96 S100
G0 X60. C0 Z5.
G12.1
G0 X50.
G17
G43 H1
G10 L10 P1 R1.
G10 P1 X5.
G10 L2 P1 X0
G54
G53 X0
G90 G91 G94 G95
G42 G1 X40. F200
C10.
G3 X20. C20. R10.
G2 X30. C10. I5. J0
G41 X20.
G4 X5.
T0202
G40 X60.
G99 G1 X50. F.2
G41 X20.
G13.1
G0 Z100.
M1
M30
%
"""


@dataclasses.dataclass(frozen=True)
class Use:
    """A program that shows a value: machine, tools and the other values (`also`) are the same before and after."""

    value: Any
    program: str
    machine: str = "fanuc"
    tools: tuple[str, ...] = ()
    also: dict[str, dict[str, Any]] = dataclasses.field(default_factory=dict)


def outcome(use: Use, changes: dict[str, Any]) -> tuple[Any, ...]:
    """What is reported and traced of the program, and the highest F of its blocks."""
    return outcome_of(use.program, use.machine, use.tools, json.dumps(changes))


@functools.cache
def outcome_of(program: str, machine: str, tools: tuple[str, ...], as_json: str) -> tuple[Any, ...]:
    """Many keys are shown by the same program on the same machine, of which one outcome is enough."""
    changes = json.loads(as_json)
    report = report_of(program, machine, *tools, changes=changes)
    tables = tables_of(program, machine, *tools, changes=changes)
    traced = tables["trace"], tables["tool_center"]
    return report, list(executed.rows(*traced)), list(executed.moves(*traced, "tool")), feed_table(tables)


FLAT = "O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM30\n"
ARC = "O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nG3 X20. C10. {}\nG1 X60.\nG13.1\nM30\n"
ENGAGED_BEHIND = "O1\nG98 G0 X60. C0\nG12.1\nM35\nG1 X40. F200\nC10.\nX60.\nG13.1\nM30\n"
HALF = "O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nG3 X-40. C0 R20.\nG1 X-60.\nG13.1\nM30\n"
LARGER_ARC = "O1\nG94 G0 X60. C0\nG137 C0\nG101 X20. Y0 F200\nG103 X0 Y-20. L20. CALRG\nG136\nM2\n"
RAMPS = "O1\nT0101\nG98 G0 X100. C0\nG12.1\n{}G1 G42 X40. F200\n{}C20.\nX10.\nC-20.\nX60.\n{}G40 X100.\nG13.1\nM30\n"
CUTTER = ("1:radius=4",)
SETS = "O1\n{}\nT0101\nG98 G0 X100. C0\nG12.1\nG1 G42 X60. F200\nC20.\nG40 X100.\nG13.1\nM30\n"
OTHERS = ["SCALE", "ASCALE", "MIRROR", "AMIRROR"]
EDGES = "T8 D2\nG94 G0 X60 Y0\nDIAMOF\nTRANSMIT\nG17\nG1 G41 X40 F200\nY-20\nG40 X60\nTRAFOOF\nM30\n"
CORNERS = "O1\nT0101\nG98 G0 X100. C0\nG12.1\nG1 C{}. F500\nG41 {}\nG1 G40 X120.\nG13.1\nM30\n"
REVERSED = CORNERS.format(20, "X60. F200\nG3 X58. C10. R6.\nG1 X68. C5.\nX66. C8.")
OUTSIDE = CORNERS.format(20, "X60. F200\nG3 X70. C25. R5.\nG1 X72. C30.")
APART = CORNERS.format(-20, "X48.2 F200\nC0\nG3 X40. C4.1 R4.1\nX34.556 C-1.02 R4.1\nG1 X40.4 C-10.58")
GOUGE = """O1
T0101
G98 G0 X100. C0
G12.1
G1 C3. F500
G41 X60. F200
X30.
C20.
X-20.
C-20.
X30.
C-3.
X60.
G40 X100.
G13.1
M30
"""
ENDED = "O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\n{}\nG13.1\nM30\n"
INFEED = """T0202
G0 X348. C30.
G12.1 E8.
G42 G1 X300. C0 F2000
C80.
X-300.
C-80.
X300.
C0
G40 X340.
G13.1
M30
"""


def inside(block: str) -> str:
    """A program with a block in the polar mode."""
    return f"O1\nG98 G0 X60. C0 Z5.\nG12.1\nG1 X40. F200\n{block}\nC10.\nX60.\nG13.1\nM30\n"


def before(*blocks: str) -> str:
    """A program with blocks before the polar mode."""
    return "O1\nG98 G0 X60. C0 Z5.\n" + "\n".join(blocks) + "\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\nM30\n"


TWO_SPINDLES = {
    "m_codes": {
        "c_axis_on": ["M35"],
        "sub_c_axis_on": ["M135"],
    }
}
CLAMPED_SUB = {"m_codes": {"sub_c_axis_on": ["M135"], "sub_c_axis_clamp": ["M310"]}}
RUNNING_SUB = {"m_codes": {"sub_c_axis_on": ["M135"], "sub_spindle_on": ["M103"]}}
FEED_ON_ARC = CORNERS.format(20, "G64 X60. F200\nG61 G3 X70. C25. R5.\nG1 X72. C30.")
RAMP_IN_SPACE = inside("G451 G450 X50. Z1.")
USES = {
    "title": Use("lathe of ours", FLAT.replace("F200", "F9000"), also={"limits": {"c_feed": 100}}),
    "control.g_code_system": Use("B", FLAT.replace("G98", "G99")),
    "control.units": Use("inch", FLAT),
    "control.least_increment": Use(0.0001, FLAT.replace("40.", "40000")),
    "control.least_increment_inch": Use(0.001, FLAT.replace("40.", "40000").replace("G98", "G98 G20")),
    "control.number_without_point": Use("whole-unit", FLAT.replace("40.", "40")),
    "control.digit_limit": Use(5, FLAT.replace("40.", "123456.")),
    "control.word_limit": Use(3, FLAT),
    "control.m_code_limit": Use(1, FLAT.replace("G98", "G98 M8 M9")),
    "control.line_comments": Use(";", inside("; G0 X1.")),
    "control.channel_mark": Use("", FLAT.replace("G98", "$1\nG98").replace("M30", "M30\n$2\nG0 X5.\nM30")),
    "control.wait_mark": Use("", inside("!2L10")),
    "control.radius_offset_digits": Use(2, FLAT.replace("G98", "T020101\nG98"), tools=("1:radius=3", "2:radius=4")),
    "control.offset_digits": Use(1, FLAT.replace("G98", "T0112\nG98"), tools=("12:radius=3", "2:radius=4")),
    "control.unknown_codes_are_errors": Use(False, before("G150")),
    "control.x": Use("radius", FLAT),
    "control.known_codes": Use(["G0-G119"], before("G160")),
    "control.motion_codes": Use({"G101": "G1"}, inside("G101 C5.")),
    "control.native_words": Use({"POLAR": "G12.1"}, FLAT.replace("G12.1", "POLAR")),
    "control.parentheses_are_comments": Use(False, FLAT.replace("C0", "C0 (APPROACH)")),
    "control.blanks_in_numbers": Use(False, FLAT.replace("C0", "C 0").replace("X40.", "X4 0.")),
    "g_codes.constant_surface_speed_ended_by": Use(["G98"], before("G96 S100", "G98")),
    "control.units_of_lengths_alone": Use(["G20"], before("G20")),
    "control.x_radius_words": Use(["G7"], before("G7", "X50.")),
    "control.x_diameter_words": Use(["G8"], before("G8", "X50."), also={"control": {"x": "radius"}}),
    "control.x_absolute_diameter_words": Use(["G8"], before("G8", "X50."), also={"control": {"x": "radius"}}),
    "control.x_without_words": Use("radius", FLAT, also={"control": {"x_radius_words": ["G7"]}}),
    "g_codes.rapid": Use(["G0", "G150"], inside("G150 X50.")),
    "g_codes.line": Use(["G1", "G150"], FLAT.replace("G1 ", "G150 ")),
    "g_codes.arc_clockwise": Use(["G2", "G150"], ARC.replace("G3", "G150").format("R15.")),
    "g_codes.arc_counterclockwise": Use(["G3", "G150"], ARC.replace("G3", "G150").format("R15.")),
    "g_codes.motion_not_followed": Use(["G150"], inside("G150 C5.")),
    "g_codes.plane_xy": Use([], before("G17"), also={"polar": {"plane_before": ["G18"]}}),
    "g_codes.plane_zx": Use([], before("G18"), also={"polar": {"plane_before": ["G17"]}}),
    "g_codes.plane_yz": Use([], before("G19"), also={"polar": {"plane_before": ["G17"]}}),
    "g_codes.corner_by_arc": Use(["G450"], OUTSIDE.replace("G41", "G450 G41"), tools=CUTTER),
    "g_codes.corner_by_intersection": Use(["G451"], OUTSIDE.replace("G41", "G451 G41"), tools=CUTTER),
    "g_codes.compensation_off": Use([], OUTSIDE, tools=CUTTER),
    "g_codes.compensation_left": Use([], OUTSIDE, tools=CUTTER),
    "g_codes.compensation_right": Use([], RAMPS.format("", "", ""), tools=CUTTER),
    "g_codes.feed_inverse_time": Use([], before("G93")),
    "g_codes.feed_on_plane": Use(["G450"], RAMP_IN_SPACE, also={"polar": {"feed_measures": "space"}}),
    "g_codes.feed_in_space": Use(["G450"], RAMP_IN_SPACE),
    "g_codes.feed_at_contour": Use(["G64"], FEED_ON_ARC, tools=CUTTER),
    "g_codes.feed_at_inner_contour": Use(["G64"], FEED_ON_ARC, tools=CUTTER),
    "g_codes.feed_at_center": Use(["G61"], FEED_ON_ARC, tools=CUTTER, also={"g_codes": {"feed_at_contour": ["G64"]}}),
    "g_codes.feed_as_machine": Use(["G450"], RAMP_IN_SPACE, also={"g_codes": {"feed_in_space": ["G451"]}}),
    "g_codes.constant_surface_speed": Use([], before("G96 S100")),
    "g_codes.constant_surface_speed_off": Use([], before("G96 S100", "G97")),
    "g_codes.work_offset": Use(["G54-G58"], before("G59")),
    "g_codes.work_offset_extended": Use([], before("G54.1 P1")),
    "g_codes.drilling_cycle": Use([], before("G83 Z1. R2.")),
    "g_codes.drilling_cycle_off": Use([], before("G83 Z1. R2.", "G80")),
    "g_codes.frame_shift": Use(["TRANS", "MOVED"], EDGES.replace("G17", "MOVED X1 Y2"), "siemens-transmit"),
    "g_codes.frame_shift_added": Use(["ATRANS", "MOVED"], EDGES.replace("G17", "MOVED X1 Y2"), "siemens-transmit"),
    "g_codes.frame_rotation": Use(["ROT", "TURNED"], EDGES.replace("G17", "TURNED RPL=30"), "siemens-transmit"),
    "g_codes.frame_rotation_added": Use(["AROT", "TURNED"], EDGES.replace("G17", "TURNED RPL=30"), "siemens-transmit"),
    "g_codes.frame_not_simulated": Use([*OTHERS, "SHEAR"], EDGES.replace("G17", "SHEAR X0"), "siemens-transmit"),
    "g_codes.scaling": Use([], before("G51 P2")),
    "g_codes.scaling_off": Use([], before("G51 P2", "G50")),
    "g_codes.rotation": Use([], before("G68.1 R5.")),
    "g_codes.rotation_off": Use([], before("G68.1 R5.", "G69.1")),
    "g_codes.mirror_image": Use([], before("G51.1 X0")),
    "g_codes.mirror_image_off": Use([], before("G51.1 X0", "G50.1")),
    "g_codes.tool_length_offset": Use([], inside("G43 H1")),
    "g_codes.tool_length_offset_off": Use([], inside("G49")),
    "g_codes.dwell": Use([], inside("G4 X5.")),
    "g_codes.data_input": Use([], inside("G10 P1 X5.")),
    "g_codes.data_input_work_offset": Use([], inside("G10 L2 P1 X0")),
    "g_codes.data_input_tool_offset": Use([], inside("G10 L10 P1 R1.")),
    "g_codes.reference_check": Use([], before("G27 X0")),
    "g_codes.reference_return": Use([], before("G28 U0")),
    "g_codes.sub_spindle": Use(["G150"], RAMPS.format("", "", "").replace("T0101", "T0101\nG150"), tools=CUTTER),
    "g_codes.sub_spindle_off": Use(
        ["G15"],
        RAMPS.format("", "", "").replace("T0101", "T0101\nG14\nG15"),
        tools=CUTTER,
        also={"g_codes": {"sub_spindle": ["G14"]}},
    ),
    "g_codes.c_axis_reference": Use([], before("M35", "G28 H0"), also={"m_codes": {"c_axis_on": ["M35"]}}),
    "g_codes.local_shift": Use([], before("G52 X1.")),
    "g_codes.machine_coordinates": Use([], before("G53 X0")),
    "g_codes.cylindrical_interpolation": Use([], before("G7.1 C20.")),
    "g_codes.axis_words_no_move": Use([], before("G31 X0")),
    "g_code_system_a.inch": Use([], before("G20")),
    "g_code_system_a.mm": Use([], before("G21"), also={"control": {"units": "inch"}}),
    "g_code_system_a.feed_per_minute": Use([], before("G99", "G98")),
    "g_code_system_a.feed_per_revolution": Use([], before("G99")),
    "g_code_system_a.absolute": Use(
        ["G190"], inside("G191 C5.\nG190"), also={"g_code_system_a": {"incremental": ["G191"]}}
    ),
    "g_code_system_a.incremental": Use(["G191"], inside("G191 C5.")),
    "g_code_system_a.thread_cutting": Use([], before("G32 Z1. F1.")),
    "g_code_system_a.turning_cycle": Use([], before("G90 X50. Z-5.")),
    "g_code_system_a.threading_cycle": Use([], before("G92 X50. Z-5. F1.")),
    "g_code_system_a.facing_cycle": Use([], before("G94 X50. Z-5.")),
    "g_code_system_a.repetitive_cycle": Use([], before("G71 U1. R1.")),
    "g_codes.cycle_contour": Use(["G81"], before("G81", "G1 X80. F.1", "G80")),
    "g_codes.cycle_contour_off": Use(
        ["G80"], before("G85", "G1 X80. F.1", "G80"), also={"g_codes": {"cycle_contour": ["G85"]}}
    ),
    "g_code_system_a.coordinate_setting": Use([], before("G50 X0")),
    "g_code_system_a.coordinate_preset": Use([], before("G52 X1.", "G50.3 X0")),
    "g_code_system_a.feed_is_lead": Use([], before("G76 X50. F100").replace(" F200", "")),
    "control.rotary_rolls_over": Use(True, FLAT.replace("M30", "G0 C350.\nM30"), also={"limits": {"c_rapid": 9000}}),
    "control.axes": Use(["Y", "X", "C"], FLAT),
    "control.named_axes": Use({"C1": ""}, inside("C1=5.")),
    "control.spindle_words": Use({"S3": "live"}, inside("S3=500")),
    "polar.on": Use(["G112"], FLAT),
    "polar.off": Use(["G113"], FLAT),
    "polar.ended_by": Use(["G18"], FLAT.replace("G13.1", "G18")),
    "polar.on_of_other_controls": Use([], "O1\nG98 G0 X60. C0\nG137 C0\nG1 X40. Y0 F200\nY10.\nG136\nM30\n"),
    "polar.on_of_other_meaning": Use(["G137"], "O1\nG98 G0 X60. C0\nG137 X50.\nG1 Y10. F200\nG136\nM30\n"),
    "polar.on_of_macros": Use([], "O1\nG98 G0 X60. C0\nG101\nG1 Y10. F200\nM30\n"),
    "polar.sub_spindle_plane": Use(
        "as-main",
        RAMPS.format("", "", "").replace("T0101", "T0101\nG14").replace("12.1", "112").replace("13.1", "113"),
        "haas-lathe",
        ("1:radius=4,nose=0",),
    ),
    "polar.off_of_other_modes": Use(["G138"], "O1\nT0101\nG138\nG1 G41 X40. C0 F200\nC10.\nG40 X60.\nG13.1\nM30\n"),
    "polar.contours_outside": Use(["G1"], before("G1 X50. C10. F100")),
    "polar.direction_word": Use("C", FLAT),
    "polar.words_beside_switch": Use(["X"], FLAT.replace("G12.1", "G12.1 X0")),
    "polar.planes_not_simulated": Use(["G16"], inside("G16 C9.")),
    "polar.not_simulated_beside": Use(
        ["K"], FLAT.replace("G12.1", "G12.1 K1"), also={"polar": {"words_beside_switch": ["K"]}}
    ),
    "polar.virtual_axis_by_word": Use({"D1": ["Y", "V"]}, FLAT.replace("G12.1", "G12.1 D1")),
    "polar.rotary_address": Use("A", FLAT),
    "polar.rotary_incremental": Use("E", before("G28 H0", "G0 H5.")),
    "polar.virtual_axis": Use("Y", FLAT),
    "polar.virtual_axis_incremental": Use("V", inside("H5.")),
    "polar.virtual_axis_of_other_controls": Use([], inside("Y5.")),
    "polar.other_controls": Use("lathes of ours", inside("Y5.")),
    "polar.x": Use("radius", FLAT),
    "polar.virtual_axis_programming": Use("diameter", FLAT),
    "polar.zero_angle": Use("at-c0", FLAT.replace("C0", "C30.")),
    "polar.other_axes": Use("forbidden", inside("X50. Z1.")),
    "polar.feed_measures": Use("space", inside("X50. Z1.")),
    "polar.repeated_z": Use("forbidden", inside("G1 Z1.\nX50. Z1.")),
    "polar.center_words": Use({"X": ["J", "K"], "Y": ["J", "K"], "Z": ["K", "I"]}, ARC.format("I-10. J0")),
    "polar.linear_address": Use("Y", FLAT),
    "polar.center_error": Use(-5, FLAT.replace("X40.", "X4.").replace("C10.", "C3.")),
    "polar.linear_axis": Use(2, FLAT, "gsk-988"),
    "polar.rotary_axis": Use(4, FLAT.replace("G12.1", "G12.1 Q3"), "gsk-988"),
    "polar.infeed_word": Use("", INFEED, "gsk-988", ("2:radius=10",)),
    "polar.allowed_codes": Use(["G1", "G64"], inside("G64")),
    "polar.plane_before": Use(["G17"], before("G18")),
    "polar.z_of_machine": Use(True, inside("G53 Z0")),
    "polar.engaged_behind": Use(True, ENGAGED_BEHIND, also={"m_codes": {"c_axis_on": ["M35"]}}),
    "polar.main_spindle_must_stop": Use(True, before("M3")),
    "arcs.tolerance": Use(1, ARC.format("I-10.1 J0")),
    "arcs.radius_word": Use("L", ARC.format("R10.")),
    "arcs.corner_words": Use(["R"], CORNERS.format(20, "G40 X60. R1.\nX50. R1.\nC30.\nG13.1"), tools=CUTTER),
    "arcs.made_corners": Use({",R": "radius"}, FLAT.replace("C10.", "C10. ,R2.")),
    "arcs.sweep_limit": Use(45, ARC.format("I-10. J0")),
    "arcs.takes_sweep_limit": Use(False, HALF, also={"arcs": {"sweep_limit": 180}}),
    "arcs.larger_arc_word": Use("", LARGER_ARC, "okuma-osp"),
    "compensation.start_up": Use("B", OUTSIDE, tools=CUTTER),
    "compensation.start_up_with_move": Use("B", OUTSIDE, tools=CUTTER, also={"compensation": {"start_up": "C"}}),
    "compensation.read_ahead": Use(5, RAMPS.format("", "M8\nM9\n", ""), tools=CUTTER),
    "compensation.interference": Use("erase", REVERSED, tools=CUTTER),
    "compensation.tangent_tolerance": Use(0.5, APART, tools=CUTTER),
    "compensation.corner": Use("arc", OUTSIDE, tools=CUTTER),
    "compensation.corner_arc_above": Use(10, OUTSIDE, tools=CUTTER, also={"compensation": {"corner": "intersection"}}),
    "compensation.corner_arc_from": Use(170, OUTSIDE, tools=CUTTER, also={"compensation": {"corner": "arc"}}),
    "compensation.leaving_cancels": Use(True, CORNERS.format(20, "X60. F200\nC5.\nG40\nG13.1\nG12.1"), tools=CUTTER),
    "compensation.nose_types": Use([0], RAMPS.format("", "", ""), tools=("1:radius=4,nose=9",)),
    "compensation.overcut_tolerance": Use(20, GOUGE, tools=CUTTER),
    "limits.c_feed": Use(100, FLAT),
    "limits.c_feed_harmless": Use(100, FLAT),
    "limits.c_feed_suspicious": Use(100, FLAT),
    "limits.c_acceleration": Use(0.01, FLAT),
    "limits.x_feed": Use(100, FLAT),
    "limits.x_acceleration": Use(0.01, FLAT),
    "limits.x_rapid": Use(5000, inside("G0 X50.\nG1"), also={"limits": {"c_rapid": 9000}}),
    "limits.z_rapid": Use(5000, inside("G0 Z6.\nG1")),
    "limits.c_rapid": Use(9000, inside("G0 C10.\nG1"), also={"limits": {"x_rapid": 5000}}),
    "limits.polar_feed": Use(100, FLAT),
    "limits.polar_feed_clamps": Use(False, FLAT, also={"limits": {"polar_feed": 100}}),
    "limits.automatic_override": Use(True, FLAT, also={"limits": {"c_feed": 100}}),
    "limits.override_share": Use(50, FLAT, also={"limits": {"c_feed": 100, "automatic_override": True}}),
    "limits.live_tool_speed": Use(1000, FLAT.replace("G1", "S2000\nG1")),
    "limits.block_time": Use(0.1, inside("\n".join(f"C{n / 100:.2f}" for n in range(12)) + "\nC10.")),
    "limits.keep_out": Use(5, FLAT.replace("X40.", "X4.").replace("C10.", "C3.")),
    "limits.x_minimum": Use(25, FLAT),
    "limits.x_maximum": Use(25, FLAT),
    "limits.z_minimum": Use(10, inside("Z1.")),
    "limits.z_maximum": Use(0, inside("Z1.")),
    "feed.cutting_minimum": Use(500, FLAT, also={"feed": {"positioning_minimum": 700}}),
    "feed.cutting_maximum": Use(100, FLAT, also={"feed": {"positioning_minimum": 700}}),
    "feed.positioning_minimum": Use(700, FLAT, also={"feed": {"cutting_maximum": 100}}),
    "feed.positioning_maximum": Use(150, FLAT, also={"feed": {"cutting_maximum": 100}}),
    "feed.carried_into_polar": Use("per-minute-only", FLAT.replace("G98", "G99").replace("F200", "F.2")),
    "feed.dwell_words": Use({"P": "hundredths"}, inside("G4 P50")),
    "feed.dwell_per_revolution": Use("turns", inside("G99 G4 P50\nG98")),
    "power_on.motion": Use("G1", "O1\nG98 X60. C0 F200\nG12.1\nX40.\nC10.\nG13.1\nM30\n"),
    "power_on.plane": Use("G18", FLAT, also={"polar": {"plane_before": ["G17"]}}),
    "power_on.feed_mode": Use("G99", FLAT.replace("G98 ", "")),
    "power_on.distance": Use("G91", FLAT.replace("G98", "G94"), also={"control": {"g_code_system": "B"}}),
    "m_codes.c_axis_on": Use(["M35"], FLAT),
    "m_codes.c_axis_off": Use(["M34"], before("M35", "M34"), also={"m_codes": {"c_axis_on": ["M35"]}}),
    "m_codes.live_tool_on": Use(["M33"], FLAT),
    "m_codes.live_tool_off": Use(["M32"], before("M33", "M32"), also={"m_codes": {"live_tool_on": ["M33"]}}),
    "m_codes.spindle_on": Use([], before("M3")),
    "m_codes.spindle_off": Use([], before("M3", "M5")),
    "m_codes.c_axis_clamp": Use(["M210"], before("M210")),
    "m_codes.c_axis_unclamp": Use(["M212"], before("M210", "M212"), also={"m_codes": {"c_axis_clamp": ["M210"]}}),
    "m_codes.sub_c_axis_on": Use(["M135"], before("M135"), also={"m_codes": {"c_axis_on": ["M35"]}}),
    "m_codes.sub_c_axis_off": Use(["M134"], before("M135", "M134"), also=TWO_SPINDLES),
    "m_codes.sub_c_axis_clamp": Use(["M310"], before("M135", "M310"), also=TWO_SPINDLES),
    "m_codes.sub_c_axis_unclamp": Use(["M312"], before("M135", "M310", "M312"), also=CLAMPED_SUB),
    "m_codes.sub_spindle_on": Use(["M103"], before("M135", "M103"), also=TWO_SPINDLES),
    "m_codes.sub_spindle_off": Use(["M105"], before("M135", "M103", "M105"), also=RUNNING_SUB),
    "m_codes.spindle_orientation": Use([], inside("M19")),
    "m_codes.tool_change": Use([], ENDED.format("M6")),
    "m_codes.optional_stop": Use([], ENDED.format("G28 U0\nM1")),
    "m_codes.program_end": Use(["M30"], FLAT.replace("M30", "M2")),
    "m_codes.stops_reading_ahead": Use([], RAMPS.format("", "M1\n", ""), tools=CUTTER),
    "offsets.called_by": Use("last-digits", EDGES, "siemens-transmit", ("8/2:radius=2",)),
    "offsets.edge_after_tool": Use(2, EDGES.replace(" D2", ""), "siemens-transmit", ("8/2:radius=2",)),
    "offsets.called_in_polar": Use("never", EDGES.replace("G17", "D1"), "siemens-transmit", ("8/2:radius=2",)),
    "offsets.allowance_word": Use("", EDGES.replace("G41", "G41 OFFN=1"), "siemens-transmit", ("8/2:radius=2",)),
    "offsets.geometry_from": Use(20000, SETS.format("G10 P10001 R4.")),
    "offsets.geometry": Use([11], SETS.format("G10 L10 P1 R4.")),
    "offsets.wear": Use([], SETS.format("G10 L10 P1 R4.\nG10 L11 P1 R-.1")),
    "offsets.radius_alone": Use([], SETS.format("G10 L12 P1 R4.\nG10 L10 P1 R9.")),
    "offsets.radius_geometry_variables": Use([], SETS.format("#2901=4.")),
    "offsets.radius_wear_variables": Use([], SETS.format("#2201=4.")),
    "offsets.nose_variables": Use([], SETS.format("#2301=3")),
    "offsets.x_geometry_variables": Use([], SETS.format("#2701=#2701-.1"), "turning-center"),
    "offsets.x_wear_variables": Use([], SETS.format("#2001=-.1"), "turning-center"),
    "offsets.work_shift_variable": Use(0, SETS.format("#2501=1.")),
    "offsets.work_offset_variable": Use(5301, SETS.format("#5221=1.")),
    "offsets.work_offset_extended_variable": Use(14001, SETS.format("#7001=1.\nG54.1 P1")),
    "offsets.work_offset_step": Use(40, SETS.format("#5221=1.")),
    "frames.angle_word": Use("P", EDGES.replace("G17", "ROT RPL=30"), "siemens-transmit"),
    "frames.ended_by_switch": Use(False, EDGES.replace("DIAMOF", "TRANS X5"), "siemens-transmit"),
    "alarms": Use({"rapid-in-polar": "A1"}, inside("G0 X50.")),
    "severities": Use({"rapid-in-polar": "note"}, inside("G0 X50.")),
    "parameters": Use({"3410": 1000}, ARC.format("I-10.1 J0")),
}


def changed(key: str, use: Use) -> dict[str, Any]:
    table, _, name = key.partition(".")
    changes: dict[str, Any] = {group: dict(values) for group, values in use.also.items()}
    if name:
        changes.setdefault(table, {})[name] = use.value
    else:
        changes[table] = use.value
    return changes


@pytest.mark.nightly
@looped("key", USES, one_in=150)
def test_changing_a_key_changes_a_result(key: str) -> None:
    use = USES[key]
    assert outcome(use, use.also) != outcome(use, changed(key, use))


def test_no_key_is_forgotten() -> None:
    keys = {field.name for field in msgspec.structs.fields(Machine)} - set(TABLES)
    keys |= {f"{table}.{key}" for table, names in TABLES.items() for key in names if table not in SYSTEMS[1:]}
    assert keys == set(USES) | set(NOT_CHECKED)
    assert not set(USES) & set(NOT_CHECKED)


@pytest.mark.nightly
@looped("key", LISTS, one_in=90)
def test_a_list_may_be_empty_or_hold_codes_of_ones_own(key: str) -> None:
    """No rule counts on a code to be there; what is listed is no unknown code."""
    table, _, name = key.partition(".")
    job = {"work_offsets": {"G55": {"x": 1.0}, "G54.1 P1": {"x": 1.0}}}
    empty = report_of(RICH, "fanuc", "1:radius=4", changes={table: {name: []}}, job=job)
    assert empty.findings
    if table.startswith("g_") and "data_input_" not in name:
        own = report_of("G250\n", changes={table: {name: ["G250-G252"]}}, only=["unknown-code"])
        assert not own.findings
