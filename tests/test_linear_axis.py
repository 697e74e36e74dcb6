"""The linear axis of the polar plane: X, or another by 5460, P beside G12.1 or 1533; and the shifted center."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from cases import looped
from polarcheck.errors import MachineError
from programs import machine_of, moves_of, report_of, said, trace_of

from polarcheck.program.machines import profiles

#: The first example of the description of G12.1 with P and Q: a square with rounded corners.
SQUARE = """O0001
T0202
G98 G0 X150. C0 Z0
G12.1
G42 G1 X80. F200
C20.
G3 X40. C40. I-20. J0
G1 X-40.
G3 X-80. C20. R20.
G1 C-20.
G3 X-40. C-40. R20.
G1 X40.
G3 X80. C-20. R20.
G1 C0
G40 X150.
G13.1
G0 Z100.
M30
"""
TOOL = "2:radius=10"
#: Four axes: 2 is Y.
FOUR = {"control": {"axes": ["X", "Y", "Z", "C"]}, "polar": {"rotary_axis": 4}}
THREE = {"control": {"axes": ["X", "Z", "C"]}}


def along(axis: str, center_words: str, program: str = SQUARE) -> str:
    """The program with another linear axis, whose words are radii."""
    other = re.sub(r"X(-?[\d.]+)", lambda found: f"{axis}{float(found[1]) / 2:.3f}", program)
    free = "X" if axis == "Z" else "Z"
    other = other.replace("C0 Z0", f"C0 {free}0").replace("G0 Z100.", f"G0 {free}100.")
    return other.replace("I-20. J0", f"{center_words[0]}-20. {center_words[1]}0")


def shifted(x: float, c: float, program: str = SQUARE) -> str:
    """The program with the center of C at X x (a diameter) and C c."""
    lines = []
    for line in program.split("\n"):
        moved = re.sub(r"X(-?[\d.]+)", lambda found: f"X{float(found[1]) + x:.3f}", line)
        if "G0 " not in line:
            moved = re.sub(r"C(-?[\d.]+)", lambda found: f"C{float(found[1]) + c:.3f}", moved)
        lines.append(moved)
    return "\n".join(lines).replace("G12.1", f"G12.1 X{x:.3f} C{c:.3f}")


def changed(*tables: Mapping[str, Mapping[str, Any]]) -> dict[str, dict[str, Any]]:
    changes: dict[str, dict[str, Any]] = {}
    for table in tables:
        for name, values in table.items():
            changes.setdefault(name, {}).update(values)
    return changes


@looped(
    ("program", "machine", "changes"),
    [
        (SQUARE.replace("G12.1", "G12.1 P1"), "gsk-988", {}),
        (SQUARE.replace("G12.1", "G12.1 P1 Q3"), "gsk-988", THREE),
        (along("Y", "JK").replace("G12.1", "G12.1 P2"), "gsk-988", FOUR),
        (along("Y", "JK"), "gsk-988", changed(FOUR, {"polar": {"linear_axis": 2}})),
        (along("Y", "JK"), "gsk-988", changed(FOUR, {"polar": {"rotary_axis": 4}, "parameters": {"5460": 2}})),
        (along("Y", "JK"), "fanuc-30i", changed(FOUR, {"parameters": {"5460": 2, "5461": 4}, "polar": {}})),
        (along("Z", "KI"), "gsk-988", changed(THREE, {"polar": {"linear_axis": 2}})),
        (SQUARE.replace("G12.1", "G12.1 P1"), "gsk-988", changed(FOUR, {"polar": {"linear_axis": 2}})),
        (along("Y", "JK", shifted(20, 5)).replace("G12.1", "G12.1 P2"), "gsk-988", FOUR),
        (shifted(20, 5), "gsk-988", {}),
        (shifted(-7, 0.25), "gsk-988", {}),
        (shifted(20, 5), "fanuc-30i", {"parameters": {"5450#2": 1}}),
    ],
    one_in=12,
)
def test_twins_are_one_path(program: str, machine: str, changes: dict[str, Any]) -> None:
    """Whichever axis is the linear one, wherever the program has the center: the machine makes the same part."""
    plain, other = moves_of(SQUARE, machine, TOOL), moves_of(program, machine, TOOL, changes=changes)
    for column in ("start", "end", "center", "kind", "nearest", "c_feed"):
        found, meant = getattr(other, column), getattr(plain, column)
        assert np.allclose(found, meant, equal_nan=True), column
    assert said(report_of(program, machine, TOOL, changes=changes)) == []


def test_mitsubishi_names_the_linear_axis() -> None:
    program = "G94 G90 G0 {0}40. C0\nG12.1\nG1 {0}20. C10. F100\nG3 {0}10. C20. {1}-10. {2}0\nG1 {0}40.\nG13.1\n"
    for axis, words in {"X": "IJ", "Y": "JK", "Z": "KI"}.items():
        changes = {"parameters": {"1533": axis}}
        trace = trace_of(program.format(axis, *words), "mitsubishi-m700", changes=changes)
        assert trace.path.center[3] == pytest.approx(10 + 10j)
        assert trace.path.end[3] == pytest.approx(10 + 20j)


@pytest.mark.nightly
@looped(("axis", "own", "other"), [("X", "IJ", "K"), ("Y", "JK", "I"), ("Z", "KI", "J")], one_in=2)
def test_center_words_follow_the_linear_axis(axis: str, own: str, other: str) -> None:
    """I and J, J and K, K and I (B-62764EN/01 p. 51)."""
    number = {"X": 1, "Y": 2, "Z": 3}[axis]
    changes = changed(FOUR, {"polar": {"linear_axis": number}})
    program = along(axis, own) if axis != "X" else SQUARE
    wrong = program.replace(f"{own[0]}-20. {own[1]}0", f"{other}-20. {own[1]}0")
    (finding,) = report_of(wrong, "gsk-988", TOOL, changes=changes).findings
    assert (finding.rule, finding.line) == ("arc-word-of-other-plane", 7)
    assert f"{own[0]} along {axis} and {own[1]} along C" in finding.message


@pytest.mark.ci
@looped(
    ("program", "changes", "told"),
    [
        (SQUARE.replace("G12.1", "G12.1 P2"), {}, "P beside G12.1 is a linear axis that is not known"),
        (SQUARE, {"polar": {"linear_axis": 2}}, "2, the number in polar.linear_axis, is a linear axis that is not"),
        (SQUARE, {"parameters": {"5460": 2}}, "2, the number in parameter 5460, is a linear axis that is not"),
        (SQUARE, {"control": {"axes": ["U", "Z", "C"]}}, "1, the number in polar.linear_axis, is a linear axis"),
    ],
)
def test_a_linear_axis_that_is_not_known(program: str, changes: dict[str, Any], told: str) -> None:
    """One entry stands for all that cannot be judged, and nothing of the section is."""
    report = report_of(program.replace("F200", "F9000"), "gsk-988", TOOL, changes=changes)
    assert [entry.reason.startswith(told) for entry in report.not_evaluated if entry.matters] == [True]
    assert report.verdict == "unverified"


@looped("word", ["P7", "P1.5", "P0", "P4", "Q9", "Q1", "P4 Q1", "P2 Q3", "P4 Q4", "P2 Q2", "P9 Q1"], one_in=12)
def test_a_number_of_no_axis_is_one_finding(word: str) -> None:
    """After it the axes of the parameters are taken, and the section is judged."""
    report = report_of(
        SQUARE.replace("G12.1", f"G12.1 {word}").replace("C-20.\n", "C-20.\nG0 C-20.\nG1\n", 1),
        "gsk-988",
        TOOL,
        changes=FOUR,
    )
    assert [rule for _, rule in said(report)] == ["polar-axis-number-wrong", "rapid-in-polar"]
    assert not [entry for entry in report.not_evaluated if entry.matters]


@pytest.mark.ci
@looped("words", ["P4 Q1", "P2 Q3", "P4", "Q1"])
def test_an_axis_of_the_other_kind_is_none(words: str) -> None:
    """5460 and 5461: the first must be a linear axis, the second a rotary one; what names them must be, too."""
    report = report_of(SQUARE.replace("G12.1", f"G12.1 {words}"), "gsk-988", TOOL, changes=FOUR)
    told = "P is the number of a linear axis and Q that of a rotary one, of 1 X, 2 Y, 3 Z, 4 C"
    assert [finding.message.partition(": ")[2] for finding in report.findings] == [told]


def test_numbers_of_axes_that_nobody_knows_are_not_those_of_the_machine() -> None:
    """P3 Q1 may be right where control.axes is not given, and X and C are not its plane."""
    report = report_of(SQUARE.replace("G12.1", "G12.1 P3 Q1"), "gsk-988", TOOL)
    reasons = [entry.reason for entry in report.not_evaluated if entry.matters]
    assert said(report) == []
    assert [reason.partition(";")[0] for reason in reasons[1:]] == ["Q names another rotary axis than 3"]
    assert reasons[0].startswith("P beside G12.1 is a linear axis that is not known")


@pytest.mark.ci
def test_p_alone_names_no_axis_of_the_plane() -> None:
    """On a lathe whose G12.1 takes P and no Q it is the spindle: the section is judged as without it."""
    program = SQUARE.replace("G98 ", "G98 G40 M200 ").replace("G12.1", "G12.1 P3").replace("F200", "F90000")
    report = report_of(program, "mazak-eia", TOOL, changes={"limits": {"c_feed": 3600}})
    assert "c-feed-above-limit" in [rule for _, rule in said(report)]
    assert not [entry for entry in report.not_evaluated if entry.matters]


def test_another_rotary_axis_is_told() -> None:
    report = report_of(SQUARE.replace("G12.1", "G12.1 Q4"), "gsk-988", TOOL)
    (entry,) = [entry for entry in report.not_evaluated if entry.matters]
    assert "Q names another rotary axis than 3; its angle at the switch and its limits are not followed" in entry.reason
    assert said(report) == []


def test_x_beside_another_linear_axis_moves_by_itself() -> None:
    """Y spans the plane with C: X is one of the other axes, and Y no wrong name of C."""
    program = along("Y", "JK").replace("G12.1\n", "G12.1 P2\n").replace("G1 C0\n", "G1 C0\nX-3.\n")
    plain = along("Y", "JK").replace("G12.1\n", "G12.1 P2\n")
    assert moves_of(program, "gsk-988", TOOL, changes=FOUR).end == pytest.approx(
        moves_of(plain, "gsk-988", TOOL, changes=FOUR).end
    )


@pytest.mark.ci
@looped("entry", ["C0 Z2.", "C0 Y75. Z2.", "C0 Z75."], one_in=12)
@looped("axis", ["Y", "Z"])
@looped("control", ["gsk-988", "mitsubishi-m700", "fanuc-30i"])
def test_a_section_in_x_beside_another_linear_axis_is_one_mistake(control: str, axis: str, entry: str) -> None:
    """P2, 5460 = 2 or 1533 = Y, and every word of the contour is one of X."""
    program = SQUARE.replace("C0 Z0", entry)
    changes = changed(FOUR, {"limits": {"c_feed": 20}})
    if control == "gsk-988":
        program = program.replace("G12.1", f"G12.1 P{'XYZ'.index(axis) + 1}")
    elif control == "fanuc-30i":
        changes = changed(changes, {"parameters": {"5460": "XYZ".index(axis) + 1}})
    else:
        program, changes = program.replace("G98", "G94 G90"), {"parameters": {"1533": axis}}
    (finding,) = report_of(program, control, TOOL, changes=changes).findings
    assert (finding.rule, finding.line, finding.alarm) == ("linear-axis-never-programmed", 4, None)
    assert finding.message.startswith(f"no {axis} word in this section, whose linear axis is {axis}: X moves beside")


def test_one_word_of_the_linear_axis_tells_that_it_is_meant() -> None:
    """C alone, X alone to the depth, and a section that moves nothing are no contour in X."""
    program = "O1\nT0202\nG98 G0 Y75. X150. C0\nG12.1 P2\nG1 {} F200\n{}\nG13.1\nM30\n"
    for words in (("Y70.", "X140. C5."), ("X140.", "X150."), ("C5.", "C0")):
        assert said(report_of(program.format(*words), "gsk-988", TOOL, changes=FOUR)) == []


def test_after_the_shift_x_stands_where_the_program_has_it() -> None:
    """G13.1 leaves X as far from the center of C as it is, in the coordinates of the program."""
    trace = trace_of("G98 G0 X60. C0\nG12.1 X10. C5.\nG1 X50. C20. F100\nX-10.\nG13.1\nU2.\n", "gsk-988")
    center = 5 + 5j
    assert trace.path.start[2] == pytest.approx(25)
    assert trace.path.end[3] == pytest.approx(-5 + 20j - center)
    assert trace.path.x[4] == pytest.approx(abs(-5 + 20j - center) + 5)
    assert trace.path.x[5] == pytest.approx(abs(-5 + 20j - center) + 6)


@looped(
    ("axes", "changes", "told"),
    [
        (["X", "Z", "C"], {"linear_axis": 4}, "polar.linear_axis is 4, but control.axes names no more than 1 X, 2 Z"),
        (["X", "Z", "C"], {"rotary_axis": 9}, "polar.rotary_axis is 9, but control.axes names no more than 1 X, 2 Z"),
        (["X", "C", "Z"], {}, "polar.rotary_axis is 3, but Z is no rotary axis: axes are 1 X, 2 C, 3 Z"),
        (["C", "Z", "B"], {}, "polar.linear_axis is 1, but C is no linear axis: axes are 1 C, 2 Z, 3 B"),
        (["X", "X", "C"], {}, "control.axes names X twice"),
    ],
)
def test_numbers_that_name_no_such_axis_are_refused(axes: list[str], changes: dict[str, int], told: str) -> None:
    with pytest.raises(MachineError, match=re.escape(told)):
        profiles.load("fanuc", {"control": {"axes": axes}, "polar": changes})


def test_axes_of_a_lathe_are_taken() -> None:
    machine = machine_of("fanuc", {"control": {"axes": ["Y", "X", "Z", "B"]}, "parameters": {"5460": 2, "5461": 4}})
    assert machine.linear_address == "X"
    assert machine.linear_address_of(1) == "Y"


@pytest.mark.ci
@looped(("beside", "told"), [("", ["2 mm"]), (" X-2.", []), (" X2.", ["4 mm"])])
def test_a_shift_beside_the_switch_may_take_back_another(beside: str, told: list[str]) -> None:
    """G52 X2. puts X0 off the axis: the center is at X-2 then, and nowhere else."""
    report = report_of(SQUARE.replace("G12.1", f"G52 X2.\nG12.1{beside}"), "gsk-988", TOOL)
    found = [finding.message for finding in report.findings if finding.rule == "origin-off-center"]
    assert len(found) == len(told)
    assert all(length in message for message, length in zip(found, told, strict=True))


@looped(
    ("blocks", "x"),
    [
        ("G52 X2.", 58),
        ("G52 X2.\nG52 X5.", 55),
        ("G52 X2.\nG52 X0", 60),
        ("G52 X2.\nG52 Z5.", 58),
        ("G52 X-2.\nU1.", 63),
        ("G52 X2.\nG0 X60.", 60),
        ("G52 X#500", np.nan),
        ("G52 X#500\nG0 X40.", 40),
        ("G52 X#500\nG52 X0\nG0 X40.\nU1.", 41),
    ],
)
def test_a_place_has_other_coordinates_after_g52(blocks: str, x: float) -> None:
    """X0 is farther by the shift, so that the coordinate of where the tool stands is less."""
    trace = trace_of(f"G98 G0 X60. C0\n{blocks}\nM30\n", "fanuc")
    assert trace.path.x[-1] == pytest.approx(x / 2, nan_ok=True)


def test_g52_before_the_mode_is_one_finding() -> None:
    """Where the tool stands is known after it, so that nothing else is left open."""
    report = report_of(SQUARE.replace("G12.1", "G52 X2.\nG12.1").replace("M30", "G52 X0\nM30"), "fanuc", TOOL)
    assert said(report) == [(5, "origin-off-center")]
    assert not [entry for entry in report.not_evaluated if entry.matters]
