"""Axes that are written with a name and `=`, as in C2=10.: which axis each is, and what is said of others."""

from __future__ import annotations

import re
from operator import attrgetter
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import machine_of, report_of, said, trace_of

from polarcheck.program.execution.custom_macro import read_statement
from polarcheck.program.execution.expression import evaluate
from polarcheck.program.execution.macro import Variables
from polarcheck.program.machines import profiles

#: A contour, with X and C as plain words.
PLAIN = """%
O1
#1=4.
G98 G40 G97 T0101
G50 S2000
G0 X60. C0 Z5.
G12.1
G42 G1 X40. F200
C10.
G3 X20. C20. R10.
G1 X-20.
C-10.
X40. C-10.
C[#1-4.]
G40 X60.
G13.1
G0 Z50. C90.
G28 U0
M30
%
"""
TOOL = "1:radius=4"
ASKED: dict[str, Any] = {"calls": frozenset({"M98"}), "loops": 3, "levels": 5}


def named(program: str, **names: str) -> str:
    """The program with words of some letters under names: C10. as C1=10."""
    for letter, name in names.items():
        program = re.sub(rf"(?<![A-Z#(\[]){letter}(?=[-\d.#\[])", f"{name}=", program)
    return program


@pytest.mark.nightly
@looped("names", [{"C": "C1"}, {"X": "X1"}, {"X": "X1", "C": "C1", "Z": "Z1"}, {"C": "c1"}], one_in=4)
def test_a_named_axis_is_the_address_that_the_machine_gives_it(names: dict[str, str]) -> None:
    """The same positions, side by side with plain words or alone in a block; F and G codes behind them count."""
    program = named(PLAIN, **names)
    assert "=40." in program or "=10." in program
    plain, own = trace_of(PLAIN, "fanuc", TOOL), trace_of(program, "fanuc", TOOL)
    for column in ("path.end", "path.z", "path.c_angle", "feedrate.feed", "compensation.side"):
        read = attrgetter(column)
        assert np.array_equal(read(plain), read(own), equal_nan=True), column
    reports = [report_of(text, "fanuc", TOOL) for text in (PLAIN, program)]
    assert [said(report) for report in reports] == [said(reports[0])] * 2
    assert [report.verdict for report in reports] == ["pass", "pass"]
    assert reports[0].polar_sections == reports[1].polar_sections


@looped(
    ("word", "value"),
    [
        ("C2=#1+5.", 8.0),
        ("X1=[#3*2]", 4.0),
        ("C2=-#1", -3.0),
        ("C2=10.+5.", 15.0),
        ("C2=10.", 10.0),
        ("c2 = 10.", 10.0),
    ],
)
def test_the_value_of_a_named_axis_needs_no_brackets(word: str, value: float) -> None:
    """What stands behind it is read on."""
    statement = read_statement(f"G1 X20. {word} F100", **ASKED)
    assert [one.address for one in statement.words] == ["G", "X", word[:2].upper(), "F"]
    variables = Variables(machine_of().macro)
    variables.enter({1: 3.0, 3: 2.0})
    assert evaluate(statement.words[2].value, variables)[0] == value
    assert statement.fault is None


def read(block: str) -> list[str]:
    """The addresses of a block."""
    return [word.address for word in read_statement(block, **ASKED, names=["CA"]).words]


def test_a_code_and_its_number_are_no_name() -> None:
    """G1 before a name, an N word at the head, and the end of a word of another language."""
    assert read("N10 G1X1=20.C2=10.F100") == ["G", "X1", "C2", "F"]
    assert "C1" not in read("VC1=12.")
    assert read("M2=70 F10.") == ["M2", "F"]
    assert read("C2=") == []


def test_a_name_of_the_machine_may_be_letters_alone() -> None:
    """Others of several letters are words of other languages, which are read as before."""
    assert read("G1 CA=10. X5.") == ["G", "CA", "X"]
    assert "CR" not in read("G1 CR=10. X5.")


def test_a_named_word_is_no_code() -> None:
    """M9=8 is not M98, and M2=70 does not end the program."""
    assert not read_statement("M9=8 P1", **ASKED).call
    report = report_of("%\nO1\nM2=70\nG0 X60. C0\nM30\n%\n")
    assert report.blocks == 4


SECOND = named(PLAIN, C="C2")


def test_a_section_on_an_axis_that_is_not_followed_is_not_judged() -> None:
    """Named, never read as C 2; what stands outside the section changes nothing."""
    report = report_of(SECOND, "fanuc", TOOL)
    assert (report.verdict, said(report)) == ("unverified", [])
    (missing,) = [one for one in report.not_evaluated if one.matters]
    assert missing.reason.startswith("C2, from line 9 on, is not followed, nothing of its section is judged")
    engaged = {"m_codes": {"c_axis_on": ["M35"]}}
    assert said(report_of(SECOND, "fanuc", TOOL, changes=engaged)) == []


@pytest.mark.nightly
def test_an_axis_that_is_not_followed_shifts_no_other() -> None:
    """C2 between the blocks of another section, outside and within it."""
    outside = PLAIN.replace("G28 U0", "G0 C2=90.\nG28 C2=0").replace("G0 X60. C0", "G0 C2=45.\nG0 X60. C2=10. C0")
    report = report_of(outside, "fanuc", TOOL)
    assert (report.verdict, said(report)) == ("pass", [])
    inside = PLAIN.replace("X40. C-10.", "X40. C-10. B2=5.")
    trace = trace_of(inside, "fanuc", TOOL)
    assert np.array_equal(trace.path.end, trace_of(PLAIN, "fanuc", TOOL).path.end, equal_nan=True)
    (missing,) = [one for one in report_of(inside, "fanuc", TOOL).not_evaluated if one.matters]
    assert missing.reason.startswith("B2, from line 13 on, is not followed, its section is judged without it")


@pytest.mark.nightly
def test_a_name_that_the_machine_does_not_have_is_told_with_its_remedy() -> None:
    """Each name once; a machine that names it says nothing."""
    program = PLAIN.replace("G0 X60. C0", "G0 C7=45.\nG0 X60. C0 V9=1. C7=0")
    reasons = [one.reason for one in report_of(program, "fanuc", TOOL).not_evaluated if one.matters]
    assert [reason.partition(",")[0] for reason in reasons] == ["C7", "V9"]
    assert all("control.named_axes" in reason for reason in reasons)
    names = {"C7": "", "V9": ""}
    assert report_of(program, "fanuc", TOOL, changes={"control": {"named_axes": names}}).verdict == "pass"
    assert machine_of("fanuc", {"control": {"named_axes": names}}).control.named_axes["C1"] == "C"


def test_of_many_names_some_are_told_one_by_one() -> None:
    """A hostile file has any number of them."""
    blocks = "\n".join(f"G0 {letter}{number}=1." for letter in "ABUVW" for number in range(4, 30))
    missing = report_of(f"%\nO1\n{blocks}\nM30\n%\n").not_evaluated
    assert len(missing) == 21
    assert missing[-1].reason.startswith("each of 110 more axes")


@looped("names", [{"c2": "C"}, {"C2": "C2"}, {"C": "X"}, {"C2": 1}, "C2", {"C-2": ""}])
def test_names_that_cannot_be_are_one_line(names: object) -> None:
    """The key is named."""
    with pytest.raises(profiles.MachineError, match=r"control\.named_axes"):
        profiles.load("fanuc", {"control": {"named_axes": names}})


@pytest.mark.nightly
@looped("block", ["R1=5.", "R1=R2*2", "r1=R2*2 X5.", "M2=70", "S3=2000 F5.", "L1=AC(10)"], one_in=5)
def test_a_word_of_another_language_is_told_and_is_no_mistake(block: str) -> None:
    """It is read as no code, and as no axis of the lathe."""
    report = report_of(PLAIN.replace("G50 S2000", block), "fanuc", TOOL)
    assert said(report) == []
    (missing,) = [one for one in report.not_evaluated if one.matters]
    assert missing.reason.startswith(f"{block[:2].upper()}, from line 5 on, is no word of this lathe")


def test_a_modal_macro_is_called_where_a_named_axis_moves() -> None:
    """G66 calls behind blocks that move an axis; a variable of another language moves none."""
    program = "%\nO1\nG66 P2\n{}\nG67\nM30\nO2\nG4 X1.\nM99\n%\n"
    rows = [len(trace_of(program.format(block))) for block in ("C1=5.", "B9=5.", "R1=5.", "F1=5.")]
    assert rows[0] == rows[1] > rows[2] == rows[3]
