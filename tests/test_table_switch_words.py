"""Words beside `G12.1 IP_ P_ Q_ E_`: their ranges, as the description gives them, and what they may not be."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from polarcheck.errors import MachineError
from programs import report_of, said, tables_of

from polarcheck.columns.modes.switch_words import SwitchWords
from polarcheck.commands import main
from polarcheck.program.machines import profiles

CONTOUR = "G42 G1 X80. F200\nC40.\nX-80.\nC-40.\nX80.\nC0\nG40 X120.\n"
PROGRAM = f"T0202\nG98 G0 X120. C0\n{{}}\n{CONTOUR}{{}}\n"
INCH = "G20 T0202\nG98 G0 X6. C0\n{}\nG42 G1 X4. F8.\nC2.\nX-4.\nC-2.\nX4.\nC0\nG40 X6.\nG13.1\n"
TOOL = "2:radius=5,nose=0"
AT = 3
"""The line of the G12.1."""


def found(entry: str, leave: str = "G13.1", name: str = "gsk-988", **changes: Any) -> list[tuple[int, str]]:
    return said(report_of(PROGRAM.format(entry, leave), name, TOOL, changes=changes))


def table(entry: str, name: str = "gsk-988", **changes: Any) -> SwitchWords:
    words: SwitchWords = tables_of(PROGRAM.format(entry, "G13.1"), name, TOOL, changes=changes)["switch_words"]
    return words


# ---- P and Q ----

MOST = table("G12.1").trace.axes.most_axes


@looped(
    "words",
    ["P0", "P-1", "P1.5", "Q0", "Q-3", "Q2.5", f"P{MOST + 1}", f"Q{MOST + 1}", "P99", "P1 Q0", "P0 Q99", "Q999999999"],
    one_in=12,
)
def test_what_is_no_axis(words: str) -> None:
    report = report_of(PROGRAM.format(f"G12.1 {words}", "G13.1"), "gsk-988", TOOL)
    assert said(report) == [(AT, "polar-axis-number-wrong")]
    assert report.findings[0].message.endswith(f"no such axis; P and Q take whole numbers from 1 to {MOST}")


@pytest.mark.nightly
@looped("words", ["", "P1", "Q3", "P1 Q3", "Q3 P1", "P1. Q3.", "P2", "Q2", "P3 Q1", f"P1 Q{MOST}"], one_in=2)
def test_what_is_a_pair_of_axes(words: str) -> None:
    assert found(f"G12.1 {words}") == []


@pytest.mark.nightly
@looped(
    ("words", "parameters", "axis"),
    [
        ("P2 Q2", {}, 2),
        # P given equal to the rotary axis in force, and Q to the linear one.
        ("P3", {}, 3),
        ("Q1", {}, 1),
        ("P3", {"5460": 1, "5461": 3}, 3),
        ("P2", {"5460": 1, "5461": 2}, 2),
        ("Q2", {"5460": 2, "5461": 3}, 2),
    ],
)
def test_one_axis_is_not_both(words: str, parameters: dict[str, int], axis: int) -> None:
    program = PROGRAM.format(f"G12.1 {words}", "G13.1")
    report = report_of(program, "gsk-988", TOOL, changes={"parameters": parameters})
    assert said(report) == [(AT, "polar-axis-number-wrong")]
    assert f": axis {axis} would be both the linear and the rotary axis;" in report.findings[0].message


def test_axes_of_another_machine_are_no_fault_of_p() -> None:
    """What P3 clashes with is the axis that the parameter names, whichever that is."""
    assert found("G12.1 P3", parameters={"5461": 2}) == []


def test_p_alone_may_be_anything_elsewhere() -> None:
    """On a lathe whose G12.1 takes P and no Q it names a spindle."""
    assert not table("G12.1 P3", "mazak-eia").names_axis.any()
    assert "polar-axis-number-wrong" not in [rule for _, rule in found("G12.1 P99", name="mazak-eia")]


@looped(("name", "rule"), [("fanuc", "polar-switch-not-alone"), ("gsk-988", "polar-axis-number-wrong")])
def test_words_that_a_control_does_not_take_stay_out_of_place(name: str, rule: str) -> None:
    assert rule in [one for _, one in found("G12.1 P0", name=name)]


def test_axes_by_macro_and_in_a_second_section() -> None:
    again = PROGRAM.format("#1=0\nG12.1 P#1 Q[#1+3]", "G13.1\nG12.1 Q1\nG1 X100. C5.\nX120. C0\nG13.1")
    report = report_of(again, "gsk-988", TOOL)
    assert said(report) == [(4, "polar-axis-number-wrong"), (13, "polar-axis-number-wrong")]


# ---- IP ----


@pytest.mark.nightly
@looped("words", ["U5.", "H5.", "U0", "U5. H5.", "U-2. P1 Q3", "X0 H1."])
def test_the_shift_is_absolute(words: str) -> None:
    report = report_of(PROGRAM.format(f"G12.1 {words}", "G13.1"), "gsk-988", TOOL)
    assert said(report) == [(AT, "polar-shift-incremental")]
    named = " ".join(word for word in words.split() if word[0] in "UH")
    assert report.findings[0].message == (
        f"{named} beside G12.1 is incremental: the shift of the center is taken in absolute words only, X and C"
    )


def test_the_shift_of_another_linear_axis_is_absolute() -> None:
    """Y, of which V is the incremental word, once the profile has it beside G12.1."""
    changes = {"control": {"axes": ["Y", "X", "C"]}, "polar": {"words_beside_switch": ["Y", "C", "P", "Q", "E"]}}
    report = report_of("T0202\nG98 G0 Y60. C0\nG12.1 V5.\nG1 Y20. F100\nC5.\nG13.1\n", "gsk-988", TOOL, changes=changes)
    assert said(report) == [(AT, "polar-shift-incremental")]
    assert report.findings[0].message.endswith("in absolute words only, Y and C")


@pytest.mark.ci
@looped("words", ["X0", "C0", "X0 C0", "X0 C0 P1 Q3"])
def test_an_absolute_shift_is_right(words: str) -> None:
    assert found(f"G12.1 {words}") == []


@looped(("mode", "rules"), [("G90", []), ("G91", ["polar-shift-incremental"])])
def test_in_another_system_the_mode_of_distance_counts(mode: str, rules: list[str]) -> None:
    program = f"T0202\nG94 G90 G0 X120. C0\n{mode}\nG12.1 X0 C0\nG1 X20. C10. F100\nG13.1\n"
    report = report_of(program, "gsk-988", TOOL, changes={"control": {"g_code_system": "B"}})
    assert [rule for _, rule in said(report) if rule == "polar-shift-incremental"] == rules


@pytest.mark.ci
@looped("words", ["U5.", "H5."])
def test_where_nothing_shifts_incremental_words_are_out_of_place(words: str) -> None:
    assert (AT, "polar-switch-not-alone") in found(f"G12.1 {words}", name="fanuc")
    assert (AT, "polar-shift-incremental") not in found(f"G12.1 {words}", name="fanuc")


@pytest.mark.nightly
@looped("words", ["P1", "Q3", "E8.", "X0", "U5.", "P1 Q3 E8."])
def test_words_are_for_the_beginning(words: str) -> None:
    """G13.1 stands alone on this control, too."""
    assert found("G12.1", f"G13.1 {words}") == [(11, "polar-switch-not-alone")]


# ---- E ----

TOO_LARGE = "is too large: {} is the most"


@pytest.mark.ci
@looped(
    ("increments", "program", "inside", "beyond", "most"),
    [
        ((0.001, 0.0001), PROGRAM, "E999999.999", "E1000000.", "999999.999 mm"),
        ((0.0001, 0.00001), PROGRAM, "E99999.9999", "E100000.", "99999.9999 mm"),
        ((0.001, 0.0001), INCH, "E99999.9999", "E100000.", "99999.9999 inch"),
        ((0.0001, 0.00001), INCH, "E9999.99999", "E10000.", "9999.99999 inch"),
    ],
    ids=["IS-B mm", "IS-C mm", "IS-B inch", "IS-C inch"],
    one_in=4,
)
@looped("sign", ["", "-"])
def test_the_four_ranges_of_the_infeed(
    increments: tuple[float, float], program: str, inside: str, beyond: str, most: str, sign: str
) -> None:
    changes = {"control": {"least_increment": increments[0], "least_increment_inch": increments[1]}}
    tool = "2:radius=.2,nose=0"
    for word, rules in ((inside, []), (beyond, ["infeed-out-of-range"])):
        report = report_of(
            program.format(f"G12.1 {word.replace('E', 'E' + sign)}", "G13.1"), "gsk-988", tool, changes=changes
        )
        assert [rule for _, rule in said(report)] == rules
        assert all(found.severity == "error" for found in report.findings)
        assert all(found.message.endswith(TOO_LARGE.format(most)) for found in report.findings)


@pytest.mark.nightly
@looped(
    ("increments", "program", "word", "taken"),
    [
        ((0.001, 0.0001), PROGRAM, "E8.0004", "0.001 mm: 8 mm is taken"),
        ((0.001, 0.0001), PROGRAM, "E-8.0009", "0.001 mm: 8 mm is taken"),
        ((0.001, 0.0001), PROGRAM, "E.0009", "0.001 mm: 0 mm is taken, which is a single pass"),
        ((0.0001, 0.00001), PROGRAM, "E8.0004", None),
        ((0.0001, 0.00001), PROGRAM, "E8.00045", "0.0001 mm: 8.0004 mm is taken"),
        ((0.001, 0.0001), INCH, "E.3001", None),
        ((0.001, 0.0001), INCH, "E.30015", "0.0001 inch: 0.3001 inch is taken"),
        ((0.0001, 0.00001), INCH, "E.30015", None),
        ((0.0001, 0.00001), INCH, "E.300158", "1e-05 inch: 0.30015 inch is taken"),
        ((0.001, 0.0001), PROGRAM, "E8.000", None),
        ((0.001, 0.0001), PROGRAM, "E0.0000", None),
    ],
    one_in=3,
)
def test_digits_below_the_increment_are_dropped(
    increments: tuple[float, float], program: str, word: str, taken: str | None
) -> None:
    changes = {"control": {"least_increment": increments[0], "least_increment_inch": increments[1]}}
    report = report_of(program.format(f"G12.1 {word}", "G13.1"), "gsk-988", "2:radius=.2,nose=0", changes=changes)
    assert [one.rule for one in report.findings] == ([] if taken is None else ["infeed-out-of-range"])
    if taken is not None:
        assert report.findings[0].severity == "warning"
        assert report.findings[0].message.endswith(f"is finer than the least increment, {taken}")


@pytest.mark.nightly
def test_every_number_of_increments_is_taken_as_it_is() -> None:
    """None of them is taken for one with a digit too many, or cut by one, whatever binary fractions make of it."""
    for count in [*range(1, 3000, 37), 12345678, 999999999]:
        words = table(f"G12.1 E{count // 1000}.{count % 1000:03d}")
        assert not (words.infeed_too_fine | words.infeed_too_large).any(), count
        assert np.max(words.infeed.depth) == pytest.approx(count / 1000), count


def test_an_infeed_with_too_many_digits_is_that() -> None:
    assert found("G12.1 E1234567.8901") == [(AT, "too-many-digits")]


def test_an_infeed_of_no_control_has_no_range() -> None:
    assert (AT, "infeed-out-of-range") not in found("G12.1 E1000000.", name="fanuc")


# ---- the parameters ----


@looped("parameter", ["5460", "5461"])
@looped("value", [0, -1, 1.5, 25, 99])
def test_a_parameter_that_is_no_axis_is_one_line(parameter: str, value: float) -> None:
    key = {"5460": "linear_axis", "5461": "rotary_axis"}[parameter]
    text = rf"parameters\.{parameter}: polar\.{key}: expected the number of an axis from 1 to 24, found {value}"
    with pytest.raises(MachineError, match=text):
        profiles.load("gsk-988", {"parameters": {parameter: value}})


@pytest.mark.usefixtures("own_folder")
@looped(
    ("given", "said"),
    [
        ("5460 = 99", "parameters.5460: polar.linear_axis: expected the number of an axis from 1 to 24, found 99"),
        ("5461 = 1", "parameters.5461: polar: linear_axis and rotary_axis are both 1; expected two axes"),
    ],
)
def test_a_wrong_parameter_ends_the_run_with_one_line(given: str, said: str) -> None:
    Path("own.toml").write_text(f"inherits = 'gsk-988'\n[parameters]\n{given}\n", "utf-8")
    Path("part.nc").write_text(PROGRAM.format("G12.1", "G13.1"), "utf-8")
    ended = CliRunner().invoke(main, ["check", "part.nc", "--machine", "own.toml"])
    assert (ended.exit_code, ended.stdout, ended.stderr) == (2, "", f"polarcheck: own.toml:3: {said}\n")


@looped(("parameters", "axis"), [({"5460": 3}, 3), ({"5461": 1}, 1), ({"5460": 2, "5461": 2}, 2)])
def test_parameters_that_name_one_axis_are_one_line(parameters: dict[str, int], axis: int) -> None:
    with pytest.raises(MachineError, match=f"linear_axis and rotary_axis are both {axis}; expected two axes"):
        profiles.load("gsk-988", {"parameters": parameters})
