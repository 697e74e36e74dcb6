"""Main spindle, sub-spindle and live tool: codes that a word beside them tells apart, and codes of their own."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cases import looped
from polarcheck.errors import MachineError
from programs import report_of, said, tables_of

from polarcheck.program.machines import profiles

#: One M3 for three spindles, which P tells apart.
BY_P = {
    "spindle_on": ["M3 P11", "M4 P11"],
    "spindle_off": ["M5 P11"],
    "live_tool_on": ["M3 P12", "M4 P12"],
    "live_tool_off": ["M5 P12"],
    "sub_spindle_on": ["M3 P13"],
    "sub_spindle_off": ["M5 P13"],
    "c_axis_on": ["M35"],
    "c_axis_off": ["M34"],
    "sub_c_axis_on": ["M135"],
    "sub_c_axis_off": ["M134"],
}
PROGRAM = "O1\nT0101\n{}\nG28 H0\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\n{}\nX60.\nG13.1\nM5 P12\nM32\nM30\n"
SETUP = ("setup",)


def broken(before: str, inside: str = "", **codes: list[str]) -> list[str]:
    """The setup rules that a program breaks with blocks above its section and in it."""
    program = PROGRAM.format(before.replace(" / ", "\n"), inside)
    return [
        rule for _, rule in said(report_of(program, "fanuc-30i", "1:radius=4", changes={"m_codes": codes}, only=SETUP))
    ]


# ---- codes with a word beside them ----


@pytest.mark.ci
@looped(
    ("before", "rules"),
    [
        ("M5 P11 / M35 / M3 P12 S2000", []),
        ("M5 P11 / M35 / S2000 P12 M3", []),
        ("M5 P11 / M35 / M03 P012 S2000", []),
        ("M3 P11 S500 / M5 P11 / M35 / M3 P12 S2000", []),
        ("M35 / M4 P12 S2000", []),
        ("M35 / M3 P11 S2000", ["main-spindle-running-at-entry"]),
        ("M35 / M3 S2000", ["live-tool-stopped-in-cut"]),
        ("M35 / M3 P12 S2000 / M5 P12", ["live-tool-stopped-in-cut"]),
        ("M35 / M3 M8 P12 S2000", []),
        ("M35 / M3 P12 S2000 / M5 P11", []),
        ("M3 P11 S500 / M5 P12 / M35 / M3 P12", ["main-spindle-running-at-entry"]),
        ("M35 / M3 P13 S500 / M3 P12 S2000", []),
        ("M135 / M3 P13 S500 / M3 P12 S2000", ["main-spindle-running-at-entry"]),
        ("M135 / M3 P11 S500 / M3 P12 S2000", []),
    ],
    one_in=2,
)
def test_p_tells_which_spindle_is_meant(before: str, rules: list[str]) -> None:
    assert broken(before, **BY_P) == rules


@looped(
    ("before", "rules"),
    [
        ("M3 P12 S2000", []),
        ("M3 S2000", ["main-spindle-running-at-entry"]),
        ("M3 P11 S2000", ["main-spindle-running-at-entry"]),
        ("M33 S2000", []),
    ],
)
def test_a_list_may_hold_codes_with_and_without_a_word(before: str, rules: list[str]) -> None:
    """What M3 without P12 starts is what the inherited list says of M3: the main spindle."""
    assert broken(before, live_tool_on=["M3 P12", "M33"], live_tool_off=["M5 P12"]) == rules


def test_a_code_of_the_live_tool_is_none_of_the_main_spindle() -> None:
    """A lathe on which M3 starts what is selected lists it for the live tool beside the inherited M3 of the spindle."""
    assert broken("M35 / M3 S2000", live_tool_on=["M3"], live_tool_off=["M5"]) == []
    assert broken("M35 / M4 S2000 / M3", live_tool_on=["M3"], live_tool_off=["M5"]) == ["main-spindle-running-at-entry"]


def test_a_message_names_the_code_with_its_word() -> None:
    program = PROGRAM.format("M35\nM3 P11 S500", "")
    report = report_of(program, "fanuc-30i", changes={"m_codes": BY_P}, only=SETUP)
    told = {finding.rule: finding.message for finding in report.findings}
    assert told["main-spindle-running-at-entry"].startswith(
        "M3 P11 or M4 P11 is in force at G12.1; write M5 P11 before"
    )
    without = report_of(PROGRAM.format("M35", ""), "fanuc-30i", changes={"m_codes": BY_P}, only=SETUP)
    (stopped,) = (one.message for one in without.findings if one.rule == "live-tool-stopped-in-cut")
    assert stopped.endswith("; M3 P12 or M4 P12 is missing")


def test_the_code_that_is_at_fault_is_the_one_with_its_word() -> None:
    assert broken("M35 / M3 P12 S900", "M5 P11", **BY_P) == ["spindle-code-in-polar"]
    assert broken("M35 / M3 P12 S900", "M3 P12 S900", **BY_P) == []
    assert broken("M35 / M3 P12 S900", "M8 P12", **BY_P) == []


@looped("key", ["program_end", "tool_change", "optional_stop", "stops_reading_ahead"])
def test_a_code_that_acts_by_itself_takes_no_word(key: str) -> None:
    with pytest.raises(MachineError, match=f"m_codes.{key}: 'M30 P1' is no code"):
        profiles.load("fanuc", {"m_codes": {key: ["M30 P1"]}})


@looped("text", ["M3 P", "M3 12", "M3 PP12", "M3 G12", "M3 P1234567890", "P12 M3", "M3-M5 P12", "M3 P12 S1"])
def test_what_is_no_code_with_a_word_is_one_line(text: str) -> None:
    with pytest.raises(MachineError, match=r"m_codes\.live_tool_on: .* is no code"):
        profiles.load("fanuc", {"m_codes": {"live_tool_on": [text]}})


# ---- the sub-spindle ----

SETS: dict[str, list[str]] = {
    "c_axis_on": ["M35"],
    "c_axis_off": ["M34"],
    "sub_c_axis_on": ["M135"],
    "sub_c_axis_off": ["M134"],
    "sub_spindle_on": ["M103"],
    "sub_spindle_off": ["M105"],
    "live_tool_on": ["M33"],
    "live_tool_off": ["M32"],
}


@pytest.mark.ci
@looped(
    ("before", "inside", "rules"),
    [
        ("M135 / M33 S900", "", []),
        ("M35 / M33 S900", "", []),
        ("M33 S900", "", ["c-axis-not-engaged"]),
        ("M135 / M134 / M33 S900", "", ["c-axis-not-engaged"]),
        ("M135 / M34 / M33 S900", "", []),
        ("M35 / M134 / M33 S900", "", []),
        # Of the two spindles the one that is not the C axis may turn.
        ("M135 / M3 S500 / M33 S900", "", []),
        ("M35 / M103 S500 / M33 S900", "", []),
        ("M135 / M103 S500 / M33 S900", "", ["main-spindle-running-at-entry"]),
        ("M135 / M103 S500 / M105 / M33 S900", "", []),
        ("M35 / M3 S500 / M33 S900", "", ["main-spindle-running-at-entry"]),
        # Both engaged: the last one.
        ("M135 / M35 / M103 / M33 S900", "", []),
        ("M35 / M135 / M103 / M33 S900", "", ["main-spindle-running-at-entry"]),
        ("M35 / M135 / M134 / M103 / M33 S900", "", []),
        ("M135 / M33 S900", "M134", ["spindle-code-in-polar"]),
        ("M135 / M33 S900", "M34", []),
        ("M35 / M33 S900", "M134", []),
        ("M35 / M33 S900", "M34", ["spindle-code-in-polar"]),
        ("M135 / M33 S900", "M5", []),
        ("M135 / M33 S900", "M105", ["spindle-code-in-polar"]),
    ],
    one_in=3,
)
def test_a_section_is_on_the_spindle_that_is_engaged(before: str, inside: str, rules: list[str]) -> None:
    assert broken(before, inside, **SETS) == rules


def test_without_codes_of_a_sub_spindle_there_is_none() -> None:
    main = {key: codes for key, codes in SETS.items() if not key.startswith("sub_")}
    assert broken("M135 / M33 S900", **main) == ["c-axis-not-engaged"]
    assert not tables_of(PROGRAM.format("", ""), changes={"m_codes": main})["spindles"].on_sub_spindle.any()


def test_codes_of_a_sub_spindle_alone_do_not_tell_those_of_the_main_one() -> None:
    assert broken("M35 / M33 S900", sub_c_axis_on=["M135"], sub_c_axis_off=["M134"]) == []


def test_the_remedy_is_that_of_the_sub_spindle() -> None:
    report = report_of(PROGRAM.format("M135\nM103 S500\nM33", ""), "fanuc-30i", changes={"m_codes": SETS}, only=SETUP)
    message = next(found.message for found in report.findings if found.rule == "main-spindle-running-at-entry")
    assert message.startswith("M103 is in force at G12.1; write M105 before")


@looped("word", ["H0", "C0", "A0"])
def test_c_of_the_sub_spindle_may_be_referenced_by_another_name(word: str) -> None:
    program = PROGRAM.format("M135\nM33 S900", "").replace("G28 H0", f"G28 {word}")
    found = said(report_of(program, "fanuc-30i", changes={"m_codes": SETS}, only=["c-axis-not-referenced"]))
    assert not found
    on_main = program.replace("M135", "M35")
    found = said(report_of(on_main, "fanuc-30i", changes={"m_codes": SETS}, only=["c-axis-not-referenced"]))
    assert bool(found) == (word == "A0")


# ---- the clamp ----

CLAMPS: dict[str, Any] = {
    "c_axis_on": ["M200"],
    "c_axis_off": ["M202"],
    "c_axis_clamp": ["M210"],
    "c_axis_unclamp": ["M212"],
    "sub_c_axis_on": ["M300"],
    "sub_c_axis_off": ["M302"],
    "sub_c_axis_clamp": ["M310"],
    "sub_c_axis_unclamp": ["M312"],
}


@pytest.mark.ci
@looped(
    ("before", "inside", "clamped"),
    [
        ("M200 / M210", "", True),
        ("M200 / M210 / M212", "", False),
        ("M200", "", False),
        ("M200", "M210", True),
        ("M210 / M200", "", False),
        ("M200 / M310", "", False),
        ("M300 / M310", "", True),
        ("M300 / M210", "", False),
        ("M300 / M310 / M312", "", False),
        ("M200 / M210 / M98 P77", "", False),
    ],
)
def test_the_clamp_is_that_of_the_spindle_of_the_section(before: str, inside: str, clamped: bool) -> None:
    program = PROGRAM.format(before.replace(" / ", "\n"), inside).replace("\nX60.", "\nX50. C-10.\nX60.")
    found = said(report_of(program, changes={"m_codes": CLAMPS}, only=["c-axis-clamped-in-polar"]))
    assert len(found) == clamped


def test_a_slot_along_x_is_cut_with_the_clamp_on() -> None:
    program = "M200\nM210\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nX-40.\n{}G13.1\n"
    asked = {"changes": {"m_codes": CLAMPS}, "only": ["c-axis-clamped-in-polar"]}
    assert not report_of(program.format(""), **asked).findings  # type: ignore[arg-type]
    assert len(report_of(program.format("C5.\n"), **asked).findings) == 1  # type: ignore[arg-type]


def test_a_run_without_codes_of_a_clamp_is_never_clamped() -> None:
    assert not np.any(tables_of(PROGRAM.format("M210", ""))["spindles"].clamped)


#: Turning, then milling with another tool: what stands between, and whether something may turn there.
TURNED = (
    "O1\n{turning}T0202\n{before}G98 G0 X60. Z2. C0\nG12.1\nG1 X50. F500\nZ-2.\nG42 X40. F200\n"
    "C10.\nX-40.\nC-10.\nX40.\nC0\nG40 X50.\nZ2.\nG13.1\nM30\n"
)
TURNING = "T0101\nG97 S1200 M3\nG99 G1 X50. Z-20. F0.2\nG0 Z20.\n"


@looped(
    ("turning", "before", "is_told"),
    [
        (f"{TURNING}M5\n", "", True),
        (f"{TURNING}M5\n", "M8\nG97 S2500\n", True),
        (f"{TURNING}M5\n", "G97 S2500 M13\n", False),
        (f"{TURNING}M5\n", "S2500 M3\n", False),
        # What the tool was started with before M5 runs on.
        (TURNING, "S2500 M13\nM5\n", False),
        # Nobody knows what ran before.
        ("M5\n", "", False),
        ("", "", False),
        (TURNING, "", False),
    ],
)
@pytest.mark.parametrize("machine", ["fanuc", "siemens-iso"])
def test_nothing_turns_behind_m5_that_nothing_has_started(
    turning: str, before: str, is_told: bool, machine: str
) -> None:
    text = TURNED.format(turning=turning, before=before)
    in_inch = text.replace("O1\n", "O1\nG20\n").replace("0.2\n", ".008\n")
    mirrored = text.replace("G42", "G41").replace("C10.", "C-10.").replace("C-10.\nX40.", "C10.\nX40.")
    for program in (text, in_inch, mirrored):
        found = [at for at in said(report_of(program, machine, "2:radius=4", only=SETUP)) if at[1].startswith("live")]
        line = text[: text.index("X50. F500")].count("\n") + 1 + ("G20\n" in program)
        assert found == [(line, "live-tool-stopped-in-cut")] * is_told
