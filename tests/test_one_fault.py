"""One fault in a program as it is written for a lathe is one finding, and the program without it has none."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said

OKUMA = """$COVER.MIN%
O0100
(SQUARE WITH ONE ROUND CORNER, MILLED ON THE FACE)
N1
G50 S2000
G0 X600. Z400.
M110
M146
T010101
G97 G94 G40
G0 X120. C0 Z5.
SB=1500 M13
M15
G137 C0
G17
G101 X45. Y0 F1500
G101 Z-3. F100
G101 G42 X25. Y0 F200
G101 Y10.
G103 X15. Y20. L10.
G101 X-25.
Y-20.
X25.
Y0
G101 G40 X45.
G101 Z5. F1500
G136
M12
G0 X600. Z400.
M109
M2
%
"""
#: What is changed into what, the line of the finding and its rule.
OKUMA_FAULTS = {
    "G136 missing": ("G136\n", "", 14, "polar-never-left"),
    "G136 missing, M109 first": (
        "G136\nM12\nG0 X600. Z400.\nM109",
        "M109\nG97 S500 M3\nG0 X600. Z400.\nM12",
        14,
        "polar-never-left",
    ),
    "G136 before the end of the contour": (
        "X25.\nY0\n",
        "X25.\nG136\nG137 C0\nY0\n",
        24,
        "polar-switched-in-offset-mode",
    ),
    "G137 missing": ("G137 C0\n", "", 26, "polar-never-entered"),
    "C of G137 missing": ("G137 C0", "G137", 14, "direction-word-missing"),
    "G137 twice": ("G17\n", "G137 C0\nG17\n", 15, "polar-entered-twice"),
    "G40 missing at the end": ("G101 G40 X45.", "G101 X45.", 27, "polar-switched-in-offset-mode"),
    "G42 left in force": ("G97 G94 G40", "G97 G94 G42", 14, "polar-switched-in-offset-mode"),
    "G41 for G42": ("G42", "G41", 18, "side-of-compensation-mirrored"),
    "L too small": ("L10.", "L5.", 20, "arc-radius-too-small"),
    "more than half a turn": ("L10.", "L-10.", 20, "arc-sweep-above-limit"),
    "R for L": ("L10.", "R10.", 20, "arc-without-center"),
    "L missing": (" L10.", "", 20, "arc-without-center"),
    "center beside the arc": ("L10.", "I-9. J0", 20, "arc-end-off-circle"),
    "a full circle": ("G103 X15. Y20. L10.", "G103 I-10. J0", 20, "arc-sweep-above-limit"),
    "C for Y": ("Y10.", "C10.", 19, "wrong-axis-address-in-polar"),
    "C for Y, another place": (
        "Y10.\nG103 X15. Y20. L10.",
        "C12.\nG103 X17. Y20. L8.",
        19,
        "wrong-axis-address-in-polar",
    ),
    "C for Y in an arc by L": ("X15. Y20. L", "X15. C20. L", 20, "wrong-axis-address-in-polar"),
    "C for Y in an arc by I and J": ("X15. Y20. L10.", "X15. C20. I-10. J0", 20, "wrong-axis-address-in-polar"),
    "C for Y in the first move": ("X45. Y0 F1500", "X45. C0 F1500", 16, "wrong-axis-address-in-polar"),
    "C for Y as a distance": ("G101 Y10.\n", "G91\nG101 C10.\nG90\n", 20, "wrong-axis-address-in-polar"),
    "C for Y from a variable": ("G101 Y10.\n", "VC1=10\nG101 C=VC1\n", 20, "wrong-axis-address-in-polar"),
    "H for Y": ("G101 Y10.\n", "G101 H10.\n", 19, "wrong-axis-address-in-polar"),
    "rapid traverse": ("G101 X45. Y0 F1500", "G0 X45. Y0", 16, "rapid-in-polar"),
    "F missing": (
        "F1500\nG101 Z-3. F100\nG101 G42 X25. Y0 F200",
        "\nG101 Z-3.\nG101 G42 X25. Y0",
        16,
        "feed-missing-in-polar",
    ),
    "M110 missing": ("M110\n", "", 13, "c-axis-not-engaged"),
    "M13 missing": ("SB=1500 M13\n", "", 15, "live-tool-stopped-in-cut"),
    "no offset": ("T010101", "T000100", 18, "offset-number-missing"),
    "no offset with R": ("T010101", "T000101", 18, "offset-number-missing"),
    "surface speed": ("G97 G94", "G96 S100 G94", 14, "modal-state-wrong-at-entry"),
    "start-up too short": ("G101 G42", "G101 X28. Y0\nG101 G42", 19, "start-up-shorter-than-radius"),
    "T in the mode": ("G101 X-25.", "T020202\nG101 X-25.", 21, "offset-changed-in-polar"),
    "zero shift in the mode": ("G101 X-25.", "G50 X100.\nG101 X-25.", 21, "origin-shifted-in-polar"),
    "M109 before G136": ("G136\nM12\n", "M109\nG136\nM12\n", 27, "spindle-code-in-polar"),
    "inside arc too small": (
        "G101 Y10.\nG103 X15. Y20. L10.",
        "G101 Y10.\nG102 X29. Y14. L4.\nG103 X15. Y20. L16.",
        20,
        "inside-arc-smaller-than-radius",
    ),
    "M2 missing": ("M2\n", "", 30, "program-end-missing"),
}

HAAS = """O00001 (ONE ROUND CORNER)
G20 G40 G97 G98
M5
M154
G28 H0
T0101
G17
P2500 M133
G0 X4. C0 Z.1
G112
G17
G0 X1.5 Y0.
G1 Z-.25 F15.
G1 G42 X.875 Y0. F5.
G1 Y.5
G3 X.25 Y1.125 R.625
G1 X-.75
G3 X-.875 Y1. R.125
G1 Y-1.125
X.875
Y0.
G1 G40 X1.5
G0 Z.1
G113
G18
M135
M155
M30
"""
HAAS_FAULTS = {
    "G113 missing": ("G113\n", "", 10, "polar-never-left"),
    "G113 missing, M155 first": ("G113\nG18\nM135\nM155\n", "M155\nG18\nG0 X6.\nM135\n", 10, "polar-never-left"),
    "G112 twice": ("G112\nG17\n", "G112\nG112\nG17\n", 11, "polar-entered-twice"),
    "C for Y": ("Y.5\n", "C.5\n", 15, "wrong-axis-address-in-polar"),
    "C for Y, another place": (
        "Y.5\nG3 X.25 Y1.125 R.625",
        "C.6\nG3 X.35 Y1.125 R.525",
        15,
        "wrong-axis-address-in-polar",
    ),
    "C for Y in an arc": ("X.25 Y1.125 R.625", "X.25 C1.125 R.625", 16, "wrong-axis-address-in-polar"),
    "C for Y in an arc by I and J": ("X.25 Y1.125 R.625", "X.25 C1.125 I-.625 J0", 16, "wrong-axis-address-in-polar"),
    "C for Y in the first move": ("G0 X1.5 Y0.", "G0 X1.5 C0.", 12, "wrong-axis-address-in-polar"),
    "H for Y": ("G1 Y.5\n", "G1 H.5\n", 15, "wrong-axis-address-in-polar"),
    "R too small": ("R.625", "R.3", 16, "arc-radius-too-small"),
    "G40 missing": ("G1 G40 X1.5", "G1 X1.5", 24, "polar-switched-in-offset-mode"),
    "G41 for G42": ("G42", "G41", 14, "side-of-compensation-mirrored"),
}


@pytest.mark.ci
@looped(
    ("machine", "program", "tool"),
    [("okuma-osp", OKUMA, "1:radius=5,nose=0"), ("haas-lathe", HAAS, "1:radius=.25,nose=0")],
)
def test_the_program_without_a_fault_has_no_finding(machine: str, program: str, tool: str) -> None:
    report = report_of(program, machine, tool)
    assert (report.verdict, said(report)) == ("pass", [])


@pytest.mark.nightly
@looped("fault", OKUMA_FAULTS, one_in=12)
def test_one_fault_is_one_finding(fault: str) -> None:
    written, meant, line, rule = OKUMA_FAULTS[fault]
    assert written in OKUMA
    report = report_of(OKUMA.replace(written, meant, 1), "okuma-osp", "1:radius=5,nose=0")
    assert said(report) == [(line, rule)]


@looped("fault", HAAS_FAULTS, one_in=12)
def test_one_fault_in_inches_is_one_finding(fault: str) -> None:
    written, meant, line, rule = HAAS_FAULTS[fault]
    assert written in HAAS
    report = report_of(HAAS.replace(written, meant, 1), "haas-lathe", "1:radius=.25,nose=0")
    assert said(report) == [(line, rule)]
