"""At a limit nothing is said, just beyond it is: of each rule that has one."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import report_of, tables_of


@dataclass(frozen=True)
class Limit:
    """A rule, a program with a word left open, that word at the limit and just beyond, and what sets the limit."""

    rule: str
    program: str
    at: str
    beyond: str
    changes: Mapping[str, Any] = field(default_factory=dict)
    tool: str = ""


def cut(block: str) -> str:
    """A program that comes to X60 C0 in the mode at F100, and then runs a block."""
    return f"G98 G0 X60. C0\nG12.1\nG1 C5. F100\n{block}\nG13.1\n"


#: A square about the center, with R 4, up to the start-up and from the offset cancel on.
BEFORE, AFTER = (
    "T0101\nG98 G0 X80. C0\nG12.1\n",
    "C-10.\nX-40.\nC10.\nX40.\nC0\n",
)
INSIDE_ARC = "T0101\nG98 G0 X100. C-30.\nG12.1\nG1 G42 X40. F100\nC10.\nG2 X60. C20. R{}\nG1 X80.\nG40 X100.\nG13.1\n"
PAUSE = "T0101\nG98 G0 X80. Z5. C10.\nG12.1\nG1 G41 X40. F100\nC10.\nZ2.\n{}X20.\nG40 X80.\nG13.1\n"
RECOMMENDED = {
    "feed": {
        "cutting_minimum": 100.0,
        "cutting_maximum": 200.0,
        "positioning_minimum": 1000.0,
        "positioning_maximum": 2000.0,
    }
}
TRAVEL = {"limits": {"x_minimum": -10.0, "x_maximum": 200.0, "z_minimum": -20.0, "z_maximum": 50.0}}

LIMITS = [
    Limit("feed-above-polar-limit", cut("C-5. F{}"), "500.", "500.001", {"limits": {"polar_feed": 500.0}}),
    Limit("feed-outside-recommended-range", cut("C-5. F{}"), "200.", "200.001", RECOMMENDED),
    Limit("feed-outside-recommended-range", cut("C-5. F{}"), "100.", "99.999", RECOMMENDED),
    Limit("feed-outside-recommended-range", cut("C-5. F{}"), "1000.", "999.999", RECOMMENDED),
    Limit("feed-outside-recommended-range", cut("C-5. F{}"), "2000.", "2000.001", RECOMMENDED),
    Limit("path-near-center", cut("X{}\nC-5."), "10.", "9.999", {"limits": {"keep_out": 5.0}}),
    Limit("start-up-shorter-than-radius", BEFORE + "G1 G42 X{} F100\n" + AFTER, "72.", "72.002", tool="1:radius=4"),
    Limit(
        "cancel-shorter-than-radius",
        BEFORE + "G1 G42 X40. F100\n" + AFTER + "G40 X{}\nG13.1\n",
        "48.",
        "47.998",
        tool="1:radius=4",
    ),
    Limit("inside-arc-smaller-than-radius", INSIDE_ARC, "10.002", "10.", tool="1:radius=10"),
    Limit("movement-missing-in-offset-mode", PAUSE, "", "M9\n", {"compensation": {"read_ahead": 3}}, tool="1:radius=4"),
    Limit(
        "movement-missing-in-offset-mode",
        PAUSE,
        "M9\n",
        "M9\nM8\n",
        {"compensation": {"read_ahead": 4}},
        tool="1:radius=4",
    ),
    Limit("travel-limit", "G0 X{} Z0\n", "400.", "400.002", TRAVEL),
    Limit("travel-limit", "G0 X{} Z0\n", "-20.", "-20.002", TRAVEL),
    Limit("travel-limit", "G0 X60. Z{}\n", "50.", "50.001", TRAVEL),
    Limit("travel-limit", "G0 X60. Z{}\n", "-20.", "-20.001", TRAVEL),
    Limit("travel-limit", cut("X60. C{}"), "40.", "40.001", {"limits": {"x_maximum": 50.0}}),
    Limit(
        "arc-sweep-above-limit",
        cut("X40. C0\nG3 X{} I-20. J0"),
        "-40. C0",
        "-39. C-4.444",
        {"arcs": {"sweep_limit": 180}},
    ),
    Limit("arc-end-off-circle", cut("X40. C0\nG3 X0 C{} I-20. J0"), "20.02", "20.04"),
    Limit("arc-radius-too-small", cut("X40. C0\nG3 X-40. C0 R{}"), "19.99", "19.98"),
    Limit("second-axis-never-programmed", "G98 G0 X60. C0\nG12.1\nG1 X40. F100\n{}G13.1\n", "X-20.\n", "X-20.\nX20.\n"),
    Limit("degrees-in-polar", "G98 G0 X{0} C0\nG12.1\nG1 X{0} F100\nC-60.\nX40.\nG13.1\n", "60.", "59.9"),
    Limit("z-with-plane-axis", cut("Z-1. C{}"), "5.", "5.001"),
    Limit("x-not-positive-at-entry", "G98 G0 X{} C0\nG12.1\nG13.1\n", "0.002", "0."),
    Limit("origin-off-center", "G52 X{}\nG98 G0 X60. C0\nG12.1\nG13.1\n", "0.", "0.001"),
    Limit("feed-mode-unknown", "O1\nG0 X60. C0\nG12.1\nG1 X40. F{}\nG13.1\nM30\n", "4.999", "5."),
    Limit("feed-mode-unknown", "O1\nG20 G0 X3. C0\nG12.1\nG1 X2. F{}\nG13.1\nM30\n", ".199", ".2"),
    Limit("too-many-digits", "G0 X{}\n", "1234567.8", "12345678.9", {"control": {"digit_limit": 8}}),
    Limit("too-many-m-codes", "M5 M8{}\n", "", " M10", {"control": {"m_code_limit": 2}}),
    Limit("words-too-many", "G40 G80 G97{}\n", "", " M8", {"control": {"word_limit": 3}}),
    Limit("loop-number-out-of-range", "O1\nWHILE[#1 LT 1]DO{0}\n#1=1\nEND{0}\nM30\n", "3", "4"),
    Limit("nesting-too-deep", "O1\n#1={}\nM30\n", "[[[[[5]]]]]", "[[[[[[5]]]]]]"),
    Limit("variable-out-of-range", "O1\n#{}=1\nM30\n", "33", "34"),
    Limit("variable-out-of-range", "O1\n#{}=1\nM30\n", "199", "200"),
]


@pytest.mark.ci
@looped("limit", LIMITS, ids=lambda limit: f"{limit.rule} {limit.at}", one_in=6)
def test_at_the_limit_nothing_is_said(limit: Limit) -> None:
    tools = [limit.tool] if limit.tool else []
    for word, is_beyond in ((limit.at, False), (limit.beyond, True)):
        program = limit.program.format(word)
        report = report_of(program, "fanuc", *tools, changes=limit.changes, only=[limit.rule])
        assert bool(report.findings) == is_beyond, word


RAMPS = [
    ("start-up-shorter-than-radius", "T0101\nG98 G0 X60. C0\nG12.1\nG1 X50. F100\nG41\nG13.1\n"),
    ("cancel-shorter-than-radius", "T0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F100\nC20.\nG40\nG13.1\n"),
]


@looped(("rule", "program"), RAMPS)
@looped(("radius", "is_said"), [("0", False), ("0.001", True), ("1", True)])
def test_without_a_radius_no_ramp_is_missing(rule: str, program: str, radius: str, is_said: bool) -> None:
    report = report_of(program, "fanuc", f"1:radius={radius}", only=[rule])
    assert [finding.rule for finding in report.findings] == [rule] * is_said


@looped(("diameter", "is_said"), [(120.0, False), (119.9, True)])
def test_what_lies_within_the_stock_is_no_angle(diameter: float, is_said: bool) -> None:
    program = "G98 G0 X40. C0\nG12.1\nG1 X25. F100\nC-60.\nX40.\nG13.1\n"
    report = report_of(program, job={"stock": {"diameter": diameter}}, only=["degrees-in-polar"])
    assert bool(report.findings) == is_said


@looped(("code", "severity"), [("G26", "error"), ("G100", "warning"), ("G100.1", "error")])
def test_from_g100_on_an_unknown_code_may_be_a_macro(code: str, severity: str) -> None:
    changes = {"control": {"known_codes": ["G0"]}}
    report = report_of(f"G0 X60.\n{code}\n", changes=changes, only=["unknown-code"])
    assert [finding.severity for finding in report.findings] == [severity]


ON_A_CIRCLE = "G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG3 X-40. C0 R20. F{}\nX40. C0 R20.\nG1 X60.\nG13.1\n"


@pytest.mark.ci
@looped(
    ("share", "severity", "told"),
    [
        (1.0, "warning", "at 352 deg/min with F123., the limit of FANUC lathe control, below which it must stay"),
        (1 - 1e-7, "error", "at 352.36904 deg/min with F123., FANUC lathe control allows 352.36901"),
        (1 - 1e-5, "error", "deg/min with F123., FANUC lathe control allows 352.3"),
        (1 + 1e-7, "", ""),
    ],
)
def test_the_limit_of_c_is_open(share: float, severity: str, told: str) -> None:
    """F < L * R * pi / 180 (B-62764EN/01 p. 52): equality and a hair above show the digits that tell them apart."""
    rate = float(np.nanmax(tables_of(ON_A_CIRCLE.format("123."))["tool_center"].c_feed))
    changes = {"limits": {"c_feed": rate * share}}
    found = report_of(ON_A_CIRCLE.format("123."), changes=changes, only=["c-feed-above-limit"]).findings
    assert [finding.severity for finding in found] == [severity] * bool(severity)
    assert all(told in finding.message for finding in found)


def test_the_highest_feed_told_is_none_that_is_told() -> None:
    """What a message says to write instead gives no finding: not F200 where that turns C at its limit."""
    changes = {"limits": {"c_feed": float(np.degrees(200 / 20))}}
    asked = "200."
    for _ in range(3):
        found = report_of(ON_A_CIRCLE.format(asked), changes=changes, only=["c-feed-above-limit"]).findings
        if not found:
            break
        asked = str(re.search(r"highest F .*?: ([\d.]+) mm/min", found[0].message)[1])  # type: ignore[index]
    assert asked == "199"


LINE = "G98 G0 X60. C0\nG12.1\nG1 X2. C10. F200\nC-10. F300\nX60. F200\nG13.1\n"


def test_the_acceleration_of_c_at_its_limit_is_allowed() -> None:
    most = float(np.nanmax(tables_of(LINE)["tool_center"].c_acceleration))
    for limit, is_above in ((most, False), (most * (1 - 1e-12), True)):
        changes = {"limits": {"c_acceleration": limit, "c_feed": 1e6}}
        report = report_of(LINE, changes=changes, only=["c-acceleration-above-limit"])
        assert bool(report.findings) == is_above


STATES = ["G51 X0 Z0 P500", "G68 X0 Z0 R30.", "G51.1 X0", "G83 X40. C90. Z-10. F100"]


@pytest.mark.ci
@looped(("state", "severity"), [*((state, "error") for state in STATES), ("G96 S120", "warning")])
def test_each_state_by_itself_is_wrong_at_entry(state: str, severity: str) -> None:
    program = f"G98 G0 X60. C0\n{state}\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\n"
    found = report_of(program, only=["modal-state-wrong-at-entry"]).findings
    assert [(finding.line, finding.severity) for finding in found] == [(3, severity)]
    without = program.replace(state, "M8")
    assert not report_of(without, only=["modal-state-wrong-at-entry"]).findings


@looped(("x", "severities"), [("78.", []), ("77.9", ["warning"]), ("76.", ["warning"]), ("75.9", ["error"])])
def test_an_approach_within_the_clearance_alone_is_a_warning(x: str, severities: list[str]) -> None:
    """A bar of 60 and a cutter of 16 touch at X 76; 2 more are to be left free."""
    program = f"T0808\nG98 G0 X{x} C0\nG12.1\nG1 X40. F200\nC10.\nX{x}\nG13.1\n"
    job = {"stock": {"diameter": 60, "clearance": 2}}
    found = report_of(program, "fanuc", "8:diameter=16", job=job, only=["approach-inside-stock"]).findings
    assert [finding.severity for finding in found] == severities


#: A groove of 6 mm, gone round on the outside, which a cutter of R goes 2 R - 6 too deep into.
GROOVE = (
    "T0101\nG98 G0 X100. C0\nG12.1\nG1 C3. F500\nG41 X60. F200\nX30.\nC20.\nX-20.\nC-20.\nX30.\nC-3.\nX60.\n"
    "G40 X100.\nG13.1\n"
)


@pytest.mark.nightly
@looped(("radius", "is_cut"), [(3.0, False), (3.05, True), (3.4, True)])
def test_a_cut_of_less_than_a_millimeter_is_an_overcut(radius: float, is_cut: bool) -> None:
    report = report_of(GROOVE, "fanuc", f"1:radius={radius}", only=["overcut"])
    assert bool(report.findings) == is_cut
