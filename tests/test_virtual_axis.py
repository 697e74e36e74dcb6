"""The virtual axis has the addresses of the machine, or those that a word beside G12.1 gives it in one section."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import moves_of, report_of, said, tables_of

HEAD = "O0001\nG98 G40 G97\nT0101\nG0 X60. C0 Z5.\n"
END = "G0 Z100.\nM30\n"
#: A contour with {a} as the address of the virtual axis and {i} as that of its increments.
CONTOUR = "G1 X10. {a}0 F200\n{a}5.\nG3 X5. {a}10. R5.\nG1 {i}2.\nX30.\nG13.1\n"


def section(switch: str, address: str, increment: str) -> str:
    return f"{switch}\nG17\n{CONTOUR.format(a=address, i=increment)}"


@pytest.mark.nightly
@looped(
    ("switch", "address", "increment"),
    [
        ("G12.1 D0 E=C", "Y", "V"),
        ("G12.1 D1 E=C", "C", "H"),
        ("G12.1E=CD1", "C", "H"),
        ("G12.1 D01", "C", "H"),
        ("G12.1", "Y", "V"),
    ],
    one_in=4,
)
def test_a_word_beside_the_switch_chooses_the_address(switch: str, address: str, increment: str) -> None:
    program = HEAD + section(switch, address, increment) + END
    assert said(report_of(program, "citizen", "1:radius=2")) == []
    assert np.array_equal(
        moves_of(program, "citizen").end, moves_of(HEAD + section("G12.1 D0", "Y", "V") + END, "citizen").end
    )
    wrong = "C" if address == "Y" else "Y"
    other = program.replace(f"\n{address}5.", f"\n{wrong}5.")
    report = report_of(other, "citizen", "1:radius=2")
    assert said(report) == [(8, "wrong-axis-address-in-polar")]
    assert f"its second axis is {address} here" in report.findings[0].message
    # What was meant is followed nevertheless.
    assert np.array_equal(moves_of(other, "citizen").end, moves_of(program, "citizen").end)


def test_each_section_has_its_own_form() -> None:
    program = (
        HEAD
        + section("G12.1 D1 E=C", "C", "H")
        + section("G0 C0\nG12.1 D0 E=C", "Y", "V")
        + section("G0 C0\nG12.1", "Y", "V")
        + END
    )
    assert said(report_of(program, "citizen")) == []
    trace = tables_of(program, "citizen")["trace"]
    assert [trace.axes.virtual_axis_of(row) for row in trace.mode.sections.enter] == ["C", "Y", "Y"]
    ends = moves_of(program, "citizen").end.reshape(3, -1)
    assert np.array_equal(ends[0], ends[1])


def test_without_a_word_the_parameter_counts() -> None:
    parameter = {"parameters": {"1517": 1}}
    program = HEAD + section("G12.1 E=C", "C", "H") + END
    assert said(report_of(program, "citizen", changes=parameter)) == []
    beside = HEAD + section("G12.1 D0 E=C", "Y", "V") + END
    assert said(report_of(beside, "citizen", changes=parameter)) == []


def test_a_message_names_the_word_that_would_take_the_address() -> None:
    report = report_of(HEAD + section("G12.1 D0 E=C", "C", "H") + END, "citizen")
    assert [(found.rule, found.message) for found in report.findings] == [
        (
            "wrong-axis-address-in-polar",
            "C0 is no coordinate of the polar plane: its second axis is Y here; beside D1 it would be",
        )
    ]


@pytest.mark.nightly
@looped("word", ["D1 E=A", "D0 E=B", "D2 E=C", "D9"])
@looped(("address", "increment"), [("C", "H"), ("Y", "V")])
def test_a_mode_that_is_not_simulated_is_named_and_not_judged(word: str, address: str, increment: str) -> None:
    # Half of the arcs have no circle: nothing of the section counts.
    program = HEAD + section(f"G12.1 {word}", address, increment).replace("R5.", "R1.") + END
    report = report_of(program, "citizen", "1:radius=2")
    assert said(report) == []
    assert report.verdict == "unverified"
    name = word.split()[-1] if "=C" not in word else word.split()[0]
    assert [(one.rule, one.blocks) for one in report.not_evaluated] == [("all", 1)]
    assert report.not_evaluated[0].reason.startswith(f"{name} beside G12.1 makes another mode of it")


@pytest.mark.ci
def test_rules_of_the_virtual_axis_name_that_of_the_section() -> None:
    program = HEAD + "G12.1 D1 E=C\nG1 X10. F200\nG3 X5. R5.\nG2 X8. R9.\nX-5.\nX5.\nX-5.\nG13.1\n" + END
    report = report_of(program, "citizen")
    assert "no C word in this section" in report.findings[0].message
