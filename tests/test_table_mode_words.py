"""Words in the polar mode and beside its switches, each program with the words that a column must name."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of

from polarcheck.columns.modes.mode_words import ModeWords
from polarcheck.foundation.arrays import Mask

#: The modes of the parametrized programs: rows 0 to 2, then their block at row 3, and the way out.
INTO = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\n"
OUT = "\nX60.\nG13.1\nG53 G17 G43\nG50 X1.\nG10 L2 P1\n"


def table(program: str, machine: str = "fanuc", **changes: Any) -> ModeWords:
    words: ModeWords = tables_of(program, machine, changes=changes)["mode_words"]
    return words


def shown(words: ModeWords, mask: Mask) -> list[str]:
    """The words of a mask as they are written, in the order of the run."""
    run, source = words.trace.run, words.trace.text.source
    assert mask.dtype == bool
    assert len(mask) == len(run.words)
    at = np.flatnonzero(mask)
    return [source.excerpt(int(run.words.start[index]), int(run.words.end[index])) for index in at]


def in_mode(column: str, block: str, machine: str = "fanuc", **changes: Any) -> list[str]:
    """Of one block in the mode the words that a column names and that are not allowed there."""
    words = table(INTO + block + OUT, machine, **changes)
    return shown(words, getattr(words, column) & words.not_allowed)


def test_rows_and_words_lead_to_each_other() -> None:
    words = table("G1 X1. G40\nC2.\n\nX3. X4.\n")
    x = words.trace.blocks.words_at(words.trace.blocks.word_indices("X"))
    assert shown(words, x) == ["X1.", "X3.", "X4."]
    assert words.rows(x).tolist() == [words.trace.blocks.line[row] in (1, 4) for row in range(len(words.trace))]
    assert shown(words, words.in_rows(words.trace.blocks.has("G"))) == ["G1", "X1.", "G40"]
    assert not words.rows(np.zeros(len(x), bool)).any()
    assert not words.in_rows(np.zeros(len(words.trace), bool)).any()


@looped(
    ("names", "found"),
    [
        (("G1",), ["G1", "G01"]),
        (("G54-G59",), ["G54", "G59"]),
        (("G54.1", "M8"), ["M8", "G54.1"]),
        (("M1",), []),
        ((), []),
    ],
)
def test_codes(names: tuple[str, ...], found: list[str]) -> None:
    words = table("G1 G54 M8 X1.\nG01 G54.1 S1\nG59 G60 G10 T0101\n")
    assert shown(words, words.codes(*names)) == found


def test_a_code_that_a_control_numbers_otherwise_is_what_it_means() -> None:
    words = table("G101 X1.\nG1 X2.\n", control={"motion_codes": {"G101": "G1"}})
    assert shown(words, words.codes("G1")) == ["G101", "G1"]


def test_of_each_row_the_words_of_the_name_that_is_given_first() -> None:
    words = table("W1. U2. U3.\nW4.\nG91 W5.\nX6.\nG91 G90\n")
    assert shown(words, words.first_of("U", "W")) == ["U2.", "U3.", "W4.", "W5."]
    assert shown(words, words.first_of("W", "U")) == ["W1.", "W4.", "W5."]
    assert shown(words, words.first_of("G90", "G91", "W")) == ["W1.", "W4.", "G91", "G90"]
    assert shown(words, words.first_of()) == []


# ---- G codes in the mode ----


def test_not_allowed_is_what_the_profile_does_not_name_between_the_switches() -> None:
    program = "G28 U0\nG12.1 G54\nG1 G17 X1.\nG28 G4 M8\nG40 G55.5\nG13.1 G28\nG28 U0\n"
    words = table(program, polar={"allowed_codes": ["G1", "G4", "G40"]})
    assert shown(words, words.not_allowed) == ["G17", "G28", "G55.5"]
    all_of_them = table(program, polar={"allowed_codes": ["G1-G99", "G55.5"]})
    assert shown(all_of_them, all_of_them.not_allowed) == []


def test_a_number_that_is_no_code_is_none_that_is_not_allowed() -> None:
    words = table("G12.1\nG1 X1.\nG1.2345 G-5 G G99999 G28\nG13.1\n")
    assert shown(words, words.not_allowed) == ["G28"]


def test_unknown_codes_are_known_only_where_the_profile_lists_all() -> None:
    program = "G1 G77 G12.1 X1.\nM77\n"
    lists_all = {"known_codes": ["G1-G3", "G12.1"], "unknown_codes_are_errors": True}
    words = table(program, control=lists_all)
    assert shown(words, words.unknown) == ["G77"]
    words = table(program, control=lists_all | {"unknown_codes_are_errors": False})
    assert shown(words, words.unknown) == []


@looped(
    ("column", "block", "found"),
    [
        ("selects_plane", "G17 G18 G19 G16 G20", ["G17", "G18", "G19"]),
        ("selects_plane", "G17.1", []),
        ("sets_length_offset", "G43 H1 G44 G49 G42 G43.1", ["G43", "G44", "G49"]),
        ("sets_coordinates", "G50 S100 G92", ["G50"]),
    ],
)
def test_codes_of_one_purpose(column: str, block: str, found: list[str]) -> None:
    assert in_mode(column, block) == found


def test_the_code_that_sets_coordinates_hangs_on_the_code_system() -> None:
    assert in_mode("sets_coordinates", "G50 S100 G92", control={"g_code_system": "B"}) == ["G92"]


@looped(
    ("block", "found"),
    [
        ("G52 X1.", ["G52"]),
        ("G53 X1.", ["G53"]),
        ("G54", ["G54"]),
        ("G59", ["G59"]),
        ("G54.1 P2", ["G54.1"]),
        ("G51 X1.", []),
        ("G60", []),
        # G50 shifts with axis words; S alone limits the speed, unless something beside it shifts.
        ("G50 X1.", ["G50"]),
        ("G50 H1.", ["G50"]),
        ("G50 S1000", []),
        ("G50 S1000 I1.", []),
        ("G50 S1000 Z1.", ["G50"]),
        ("G55 G50 S1000", ["G55", "G50"]),
        # G10: L2 and L20, or P0 without L; with L10 to L13, or P1 without L, it is a tool offset.
        ("G10 L2 P1 X1.", ["G10"]),
        ("G10 L20 P1 X1.", ["G10"]),
        ("G10 P0 X1.", ["G10"]),
        ("G10 P1 X1.", []),
        ("G10 L3 P1", []),
        ("G10 L10 P0 X1.", []),
        ("G10", []),
    ],
)
def test_shifts_origin(block: str, found: list[str]) -> None:
    assert in_mode("shifts_origin", block) == found


def test_what_the_profile_allows_shifts_nothing() -> None:
    """Nor does G50 with S beside it, which stays a mistake of its own."""
    allowed = {"allowed_codes": ["G1-G4", "G54-G59", "G10"]}
    words = table(INTO + "G55 G50 S1000\nG10 L2 P1" + OUT, polar=allowed)
    assert shown(words, words.shifts_origin) == []


def test_outside_the_mode_nothing_shifts() -> None:
    words = table("G55\nG50 X1.\nG10 L2 P1\nG12.1\nG1 X1.\nG13.1\nG52 X1.\n")
    assert shown(words, words.shifts_origin) == []


@looped(
    ("block", "found"),
    [
        ("G10 L10 P1 R1.", ["G10"]),
        ("G10 L11 P1 R1.", ["G10"]),
        ("G10 L12 P0", ["G10"]),
        ("G10 L13", ["G10"]),
        ("G10 P1 R1.", ["G10"]),
        ("G10 P0 R1.", []),
        ("G10 L2 P1", []),
        ("G10 L14 P1", []),
        ("G10 R1.", []),
        ("G11 P1 R1.", []),
    ],
)
def test_changes_tool_offset(block: str, found: list[str]) -> None:
    assert in_mode("changes_tool_offset", block) == found


# ---- the switches ----


def test_switches_are_those_of_sections() -> None:
    """Not the G13.1 at the head, nor one more after the section."""
    words = table("G13.1\nG12.1\nG1 X1. F1\nG112\nC1.\nG13.1\nG13.1\nM30\n")
    assert words.trace.blocks.line[words.switches].tolist() == [2, 4, 6]


@looped(
    ("block", "machine", "others"),
    [
        ("N10 G12.1", "fanuc", []),
        ("/N10 G12.1", "fanuc", []),
        ("G12.1 (ON)", "fanuc", []),
        ("G12.1 M8", "fanuc", ["M8"]),
        ("G98 G112 X5. S100", "fanuc", ["G98", "X5.", "S100"]),
        ("G12.1 X-", "fanuc", []),
        ("G12.1 X0 P1 E4. Q2 Z1.", "gsk-988", ["Z1."]),
        ("G12.1 X0", "fanuc", ["X0"]),
        ("G12.1 P2", "mazak-eia", []),
    ],
)
def test_what_may_stand_beside_a_switch(block: str, machine: str, others: list[str]) -> None:
    words = table(f"{block}\nG1 X20. F100\nC5.\nG13.1\n", machine)
    beside = words.in_rows(words.switches) & ~words.may_stand_beside_switch
    assert shown(words, beside) == others


def test_codes_beside_a_switch_are_allowed_by_name() -> None:
    words = table("G12.1 M8 G98 M9\nG1 X20. F100\nG13.1\n", polar={"words_beside_switch": ["M8", "G98"]})
    assert shown(words, words.in_rows(words.switches) & ~words.may_stand_beside_switch) == ["M9"]


# ---- the virtual axis ----


@looped(("machine", "found"), [("fanuc", ["Y1.", "V2.", "Y5."]), ("haas-lathe", ["C3.", "H4.", "C5."])])
def test_coordinates_under_the_address_of_other_controls(machine: str, found: list[str]) -> None:
    """Not a Y or C beside G28, where it is no coordinate of a move."""
    words = table("G1 Y1. V2.\nG1 C3. H4.\nG28 Y0 C0\nY5. C5.\n", machine)
    assert shown(words, words.of_other_axis) == found


@looped("code", ["G505", "G54.7", "G12.11"])
def test_a_code_that_no_control_has_is_one_finding(code: str) -> None:
    report = report_of(f"G98 G0 X60. C0\nG12.1\nG1 X40. F100\n{code}\nC5.\nX60.\nG13.1\n")
    assert said(report) == [(4, "unknown-code")]


@pytest.mark.ci
@looped("code", ["G10 L10 P1 R5.", "G10 L2 P1 X0", "G18", "G43 H1", "G0"])
def test_what_has_a_rule_of_its_own_is_not_said_twice(code: str) -> None:
    report = report_of(f"G98 G0 X60. C0\nG12.1\nG1 X40. F100\n{code}\nG1 C5.\nX60.\nG13.1\n")
    assert "code-not-allowed-in-polar" not in {finding.rule for finding in report.findings}
    assert report.findings
