"""The state of the lathe where the polar mode is entered: columns of the setup rules."""

from __future__ import annotations

from typing import Any

import pytest
from cases import looped
from programs import report_of, tables_of, trace_of

from polarcheck.columns.modes.origin import Origin

SECTION = "G12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\n"


def asked(program: str, machine: str = "fanuc", **job: Any) -> list[str]:
    """The setup rules that a program breaks, in the order of the program."""
    return [finding.rule for finding in report_of(program, machine, job=job, only=("setup",)).findings]


@looped(
    ("program", "whole"),
    [
        ("G0 X1.\nM30", [False, False]),
        ("O1\nG0 X1.\nM30", [True, True, True]),
        ("O<PART>\nG0 X1.\nM30", [True, True, True]),
        ("<PART>\nG0 X1.\nM30", [True, True]),
        ("%\nG0 X1.\nM30\n%", [True, True]),
        ("O1\nG0 X1.\nM99", [False, False, False]),
        ("O1\nM98 P2\nM30\nO2\nG0 X1.\nM99", [True, True, True, True, True, True]),
        ("", []),
    ],
)
def test_whole_program(program: str, whole: list[bool]) -> None:
    assert trace_of(program).blocks.whole_program.tolist() == whole


def test_of_an_excerpt_nothing_is_asked() -> None:
    assert asked(SECTION) == []
    assert asked(SECTION, "turning-center") == []
    assert asked("O1\n" + SECTION + "M99") == []


def test_of_a_whole_program_all_is_asked() -> None:
    assert asked("O1\n" + SECTION + "M30") == [
        "no-tool-offset-at-entry",
        "x-unknown-at-entry",
    ]


def test_after_an_unknown_block_nothing_is_asked() -> None:
    assert asked("O1\nM98 P1234\n" + SECTION + "M30") == []
    assert asked("O1\nM98 P1234\n" + SECTION + "M30", "turning-center") == []


@pytest.mark.ci
@looped(
    ("before", "unknown"),
    [
        ("G0 X60.", False),
        ("G0 U-5.", False),
        ("G50 X200. Z100.", False),
        ("G0 X60.\nG28 U0", True),
        ("G28 U0\nG0 X60.", False),
        ("G0 X60.\nG28 W0", False),
        ("G0 X60.\nT0202", True),
        ("G0 X60. T0202", False),
        ("G0 X60.\nT0102", False),
        ("G4 X2.", True),
    ],
)
def test_x_unknown(before: str, unknown: bool) -> None:
    found = asked(f"O1\nT0101\nG0 C0\n{before}\n{SECTION}M30")
    assert found == (["x-unknown-at-entry"] if unknown else [])


def test_c_is_positioned_again_after_it_was_engaged_again() -> None:
    """A spindle that ran in between stands anywhere."""
    first = "O1\nT0101\nM35\nG28 H0\nS1000 M33\nG0 X60. C0\n"
    assert asked(first + SECTION + "M35\nM30", "turning-center") == []
    again = first + SECTION + "M34\nM3\nM5\nM35\nM33\nG0 X60.\n" + SECTION + "M35\nM30"
    assert asked(again, "turning-center") == ["c-axis-not-referenced"]
    referenced = first + SECTION + "M34\nM35\nG28 H0\nM33\nG0 X60.\n" + SECTION + "M35\nM30"
    assert asked(referenced, "turning-center") == []


OFFSETS = {"work_offsets": {"G54": {"x": 0.0}, "G55": {"x": 0.5}, "G54.1 P3": {"x": 1.0}}}


@looped(
    ("before", "name"),
    [
        ("", ""),
        ("G55", "G55"),
        ("G55\nG54", ""),
        ("G54.1 P3", "G54.1 P3"),
        ("G54.1 P3\nG4 P100", "G54.1 P3"),
        ("G54.1 P4", ""),
        ("G54.1 P3\nG54", ""),
        ("G52 X1.", "G52"),
        ("G52 X1.\nG52 Z0", "G52"),
        ("G52 X1.\nG52 X0", ""),
        ("G55\nG52 X1.", "G55 and G52"),
    ],
)
def test_origin(before: str, name: str) -> None:
    tables = tables_of(f"{before}\nG0 X60. C0\n{SECTION}", job=OFFSETS)
    enter = int(tables["sections"].enter[0])
    assert bool(tables["entry"].origin_shift[enter]) == bool(name)
    assert " and ".join(tables["entry"].origin.causes(enter)) == name


@looped(("before", "expected"), [("", True), ("G54.1 P1", False), ("G55", False)])
def test_without_a_work_offset_g54_is_in_force(before: str, expected: bool) -> None:
    tables = tables_of(f"{before}\nG0 X60. C0\n{SECTION}", job={"work_offsets": {"G54": {"x": 1.0}}})
    assert bool(tables["entry"].origin_shift[tables["sections"].enter[0]]) == expected


def test_of_many_work_offsets_those_in_force_at_a_section_count(monkeypatch: pytest.MonkeyPatch) -> None:
    asked_for: list[float] = []
    x_of = Origin._x_of
    monkeypatch.setattr(Origin, "_x_of", lambda own, number: asked_for.append(number) or x_of(own, number))
    many = "".join(f"G10 L20 P{number} X{number}.\n" for number in range(1, 40))
    tables = tables_of(f"{many}G54.1 P7\nG0 X60. C0\n{SECTION}G54.1 P8\nG0 X60. C0\n{SECTION}G54.1 P9\n")
    enter = tables["sections"].enter
    assert tables["entry"].origin_shift[enter].tolist() == [7, 8]
    assert tables["entry"].origin.causes(int(enter[1])) == ["G10 on G54.1 P8"]
    assert asked_for == [1007, 1008]


def test_a_spindle_speed_is_no_shift_of_the_origin(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Origin, "work_offset", None)
    tables = tables_of(f"G50 S2000\nG0 X60. C0\n{SECTION}")
    assert not tables["entry"].origin_shift.any()


INSIDE = ["approach-inside-stock"]


@looped(
    ("units", "x", "expected"),
    [
        ("mm", "43.9", INSIDE),
        ("mm", "44.", []),
        ("mm", "20.", []),  # stays inside: a pocket
        ("inch", "1117.5", INSIDE),
        ("inch", "1117.6", []),
    ],
)
def test_stock_is_in_the_units_of_the_job(units: str, x: str, expected: list[str]) -> None:
    work = {"units": units, "stock": {"diameter": 30, "clearance": 4}, "tools": {"1": {"diameter": 10}}}
    assert asked(f"T0101\nG0 X{x} C0\nG12.1\nG1 X10. F200\nX{x}\nG13.1", **work) == expected


def test_an_unknown_cutter_is_said() -> None:
    job = {"stock": {"diameter": 30}}
    report = report_of(f"T0101\nG0 X60. C0\n{SECTION}", job=job, only=("setup",))
    assert [entry.rule for entry in report.not_evaluated] == ["approach-inside-stock"]
    assert "cutter diameter" in report.not_evaluated[0].reason
