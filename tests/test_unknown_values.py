"""What rests on a variable without a value is not known: to the check, to the part, to comparisons and to rewriters."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from hexagon_program import CONTROLS, CUTTER, hexagon
from programs import report_of, tables_of

from polarcheck.commands import main
from polarcheck.reports.made_parts.part_report import in_one_line, made_by

#: Each with one word of its section, or of what leads to it, made unknown.
UNKNOWN = {
    "R of an arc": ("X0 C20.785/X-36. C10.392", "G3 X0 C20.785 R#500/G1 X-36. C10.392"),
    "center of an arc": ("X0 C20.785/X-36. C10.392", "G3 X0 C20.785 I#500 J0/G1 X-36. C10.392"),
    "G in the contour": ("C0 F150/C10.392", "C0 F150/G#500 X36. C0/C10.392"),
    "G before the section": ("G28 H0", "G#500/G28 H0"),
    "M in the section": ("C0 F150/C10.392", "C0 F150/M#500/C10.392"),
    "M before the section": ("G28 H0", "M#500/G28 H0"),
    "depth": ("Z-4.", "Z-#500"),
    "step of the depth": ("Z-4.", "W-#500"),
    "X of a corner": ("X-36. C10.392", "X-#500 C10.392"),
    "C of a corner": ("/C10.392", "/C#500"),
    "F": ("C0 F150", "C0 F#500"),
    "T": ("T0101", "T#500"),
    "X before the section": ("X60. Z2.", "X#500 Z2."),
    "Z before the section": ("X60. Z2.", "X60. Z#500"),
    "C before the section": ("Z2. C0", "Z2. C#500"),
    "G50": ("G28 H0", "G50 X#500/G28 H0"),
    "G52": ("G28 H0", "G52 X#500/G28 H0"),
    "work offset": ("G28 H0", "G10 L2 P1 X#500/G28 H0"),
    "calculated": ("C20.785", "C[#500*2+1.]"),
    "copied": ("X0 C20.785", "#7=#500/#8=#7+1./X0 C#8"),
    "G in the place of G42": ("G42 X36. C0 F150", "G#500 X36. C0 F150"),
    "G in the place of G12.1": ("/G12.1/", "/G#500/"),
    "G in the place of G13.1": ("/G13.1/", "/G#500/"),
    "which work offset": ("G28 H0", "G10 L2 P#500 X1./G28 H0"),
    "X of the tool": ("G28 H0", "G10 P1 X#500/G28 H0"),
    "which table": ("G28 H0", "G10 L#500 P1 X5./G28 H0"),
}
#: Only controls with these system variables.
OF_VARIABLES = {
    "X of the tool by its variable": ("G28 H0", "#2001=#500/G28 H0"),
    "X of the external offset": ("G28 H0", "#5201=#500/G28 H0"),
}
#: Behind the section, or of no weight for a check; but they may be other metal.
BEHIND = {
    "G50": ("G0 X100. Z50.", "G50 Z#501/G1 X30. F100/G0 X100. Z50."),
    "C": ("G0 X100. Z50.", "G0 X40. Z1. C#501/G1 Z-5. F100/G0 X100. Z50."),
    "R of an arc": ("G0 X100. Z50.", "G0 X40. Z1./G2 X30. Z-5. R#501 F100/G0 X100. Z50."),
    "G": ("G0 X100. Z50.", "G#501 X30./G0 X100. Z50."),
    "T": ("G0 X100. Z50.", "G0 X100. Z50./T#501/G0 X40. Z1."),
    "B": ("G0 X100. Z50.", "G1 B#501 F100/G0 X100. Z50."),
    "an offset": ("G0 X100. Z50.", "G10 P1 Z#501/G0 X100. Z50."),
    "rotation": ("G0 X100. Z50.", "G68 X0 Z0 R#501/G1 X30. F100/G0 X100. Z50."),
    "a cycle": ("G0 X100. Z50.", "G90 X30. Z-5. R#501 F100/G0 X100. Z50."),
    "the number of a work offset": ("G28 H0", "G54.1 P#501/G28 H0"),
    "calculated": ("G0 X100. Z50.", "#7=#501+1./G1 X#7 F100/G0 X100. Z50."),
    "S": ("S3000", "S#501"),
}
#: No section rests on these.
HARMLESS = {
    "S": ("S3000", "S#501"),
    "a dwell": ("G28 H0", "G4 X#501/G28 H0"),
    "a retract": ("X100. Z50.", "X#501 Z#501"),
    "G behind the section": ("G0 X100.", "G#501 X100."),
    "the end": ("M30", "M#501"),
    "a work offset by its number": ("G28 H0", "G54.1 P#501/G28 H0"),
    "an argument of a program that nothing calls": ("M30", "M30/O9/G0 X#24/M99"),
}


def hexagon_of(control: str, *changes: tuple[str, str]) -> str:
    """The hexagon on a control: M13 engages the C axis of most of them, M200 that of Mazak."""
    program = hexagon(*changes)
    return program.replace("G28 H0\n", "M200\nG28 H0\n", 1) if control == "mazak-eia" else program


#: G-code system B has G91 in the place of W, and G92 in that of G50.
OF_SYSTEM_A = ("step of the depth", "G50")


@pytest.mark.nightly
@looped(
    ("control", "name"),
    [pair for pair in itertools.product(CONTROLS, UNKNOWN) if pair[0] != "mazak-eia" or pair[1] not in OF_SYSTEM_A],
    one_in=5,
)
def test_a_check_never_passes_and_says_which_variable(control: str, name: str) -> None:
    report = report_of(hexagon_of(control, UNKNOWN[name]), control, CUTTER)
    assert report.verdict == "unverified"
    assert [finding.rule for finding in report.findings if finding.severity != "note"] == []
    told = [entry.reason for entry in report.not_evaluated if entry.matters]
    assert any("#500" in reason or "sets X to a value that is not known" in reason for reason in told)


@pytest.mark.nightly
@looped(("control", "name"), [*itertools.product(CONTROLS, HARMLESS)])
def test_what_no_section_rests_on_has_no_weight(control: str, name: str) -> None:
    report = report_of(hexagon_of(control, HARMLESS[name]), control, CUTTER)
    assert report.verdict == "pass"
    assert [entry for entry in report.not_evaluated if entry.matters] == []


@pytest.mark.nightly
@looped("name", UNKNOWN)
def test_with_its_value_the_program_is_judged(name: str) -> None:
    """The values that the words had, or 1 for a code: nothing is left to be told of a variable."""
    values = {"T": 101, "F": 150, "calculated": 9.8925, "copied": 19.785, "X of a corner": 36, "C of a corner": 10.392}
    values |= {"depth": 4, "step of the depth": 6, "X before the section": 60, "Z before the section": 2}
    values |= {"R of an arc": 20.8, "center of an arc": 0, "M in the section": 8, "M before the section": 8}
    values |= {"C before the section": 0, "G50": 60, "G52": 0, "work offset": 0}
    program = f"#500={values.get(name, 1)}\n" + hexagon(UNKNOWN[name]).partition("\n")[2]
    report = report_of("O1000\n" + program, "fanuc-30i", CUTTER)
    assert not any("#500 has no value" in entry.reason for entry in report.not_evaluated)


@looped("name", ["R of an arc", "center of an arc", "G in the contour", "depth", "X of a corner", "C of a corner"])
def test_what_is_made_is_not_known(name: str) -> None:
    tables = tables_of(hexagon(UNKNOWN[name]), "fanuc-30i", CUTTER)
    (shape, *_) = made_by(tables)
    assert "not known" in f"{shape.text} {shape.needs}"
    line = in_one_line(tables)
    assert not line or "not known" in line


def write(folder: Path, name: str, program: str) -> str:
    file = folder / f"{name}.nc"
    file.write_text(program, "utf-8")
    return str(file)


OPTIONS = ("--machine", "fanuc-30i", "--tool", CUTTER, "--no-config")


@pytest.mark.nightly
@looped("name", UNKNOWN, one_in=11)
def test_no_comparison_says_the_same_metal(name: str, tmp_path: Path) -> None:
    program = hexagon(UNKNOWN[name])
    old = write(tmp_path, "old", program)
    for other in (program.replace("#500", "#502"), hexagon()):
        new = write(tmp_path, "new", other)
        result = CliRunner().invoke(main, ["compare", *OPTIONS, old, new])
        assert (
            result.exit_code == 2
            or "has become" in result.stdout
            or "is missing" in result.stdout
            or "is added" in result.stdout
        )
        assert "the same metal" not in result.stdout
        assert "not compared, because" in result.stdout


@pytest.mark.nightly
@looped("name", UNKNOWN, one_in=5)
def test_no_rewriter_writes(name: str, tmp_path: Path) -> None:
    file = write(tmp_path, "a", hexagon(UNKNOWN[name]))
    for command in (["unroll", *OPTIONS], ["compensate", "--center", *OPTIONS]):
        result = CliRunner().invoke(main, [*command, file])
        assert (result.exit_code, result.stdout) == (2, "")
    by_machine = ["convert", "--from", "fanuc-30i", "--to", "haas-lathe", "--tool", CUTTER, "--no-config"]
    result = CliRunner().invoke(main, [*by_machine, file])
    assert (result.exit_code, result.stdout) == (2, "")
    assert re.search(r"#500 has no value for \S+ of line \d+: give \[run\.variables\] 500 = \.\.\.", result.stderr)


@looped("name", OF_VARIABLES)
def test_what_a_system_variable_is_set_to(name: str) -> None:
    report = report_of(hexagon(OF_VARIABLES[name]), "fanuc-30i", CUTTER)
    assert (report.verdict, [finding.rule for finding in report.findings]) == ("unverified", [])
    assert any("#500 has no value for #" in entry.reason for entry in report.not_evaluated if entry.matters)


def test_a_system_variable_of_another_tool_has_no_weight() -> None:
    report = report_of(hexagon(("G28 H0", "#2002=#500/G28 H0")), "fanuc-30i", CUTTER)
    assert report.verdict == "pass"


@pytest.mark.nightly
@looped("name", [*BEHIND, *OF_VARIABLES], one_in=5)
def test_no_comparison_says_the_same_of_two_variables(name: str, tmp_path: Path) -> None:
    program = hexagon({**BEHIND, **OF_VARIABLES}[name])
    old, same = write(tmp_path, "old", program), write(tmp_path, "same", program.replace("M30", "M30 (END)"))
    new = write(tmp_path, "new", program.replace("#50", "#51"))
    result = CliRunner().invoke(main, ["compare", *OPTIONS, old, new])
    assert result.exit_code == 2
    assert "not compared, because old: #50" in result.stdout
    assert "the same but for block numbers" in CliRunner().invoke(main, ["compare", *OPTIONS, old, same]).stdout


@pytest.mark.nightly
@looped("name", [name for name in BEHIND if name not in ("calculated", "C")])
def test_the_same_variable_is_the_same_value(name: str, tmp_path: Path) -> None:
    """A statement that no value rests on, and that only one of both has, changes nothing."""
    program = hexagon(BEHIND[name])
    old, new = write(tmp_path, "old", program), write(tmp_path, "new", program.replace("M30", "#3=1.\nM30"))
    result = CliRunner().invoke(main, ["compare", *OPTIONS, old, new])
    assert (result.exit_code, "the same metal" in result.stdout) == (0, True)


@pytest.mark.ci
def test_a_comparison_tells_what_a_system_variable_is_set_to(tmp_path: Path) -> None:
    files = [write(tmp_path, x, hexagon(("G28 H0", f"#5221={x}./G28 H0"))) for x in "12"]
    result = CliRunner().invoke(main, ["compare", *OPTIONS, *files])
    assert (result.exit_code, "#5221=1 has become #5221=2" in result.stdout) == (1, True)


@pytest.mark.nightly
@looped("word", ["H#501", "F#501", "C[#501]"])
def test_a_number_of_a_variable_is_no_number(word: str, tmp_path: Path) -> None:
    block = {"H": "G28 H#501", "F": "G1 X58. F#501", "C": "G0 C[#501]"}[word[0]]
    file = write(tmp_path, "a", hexagon(("G28 H0", f"{block}/G28 H0")))
    options = ["convert", "--from", "fanuc-30i", "--to", "haas-lathe", "--tool", CUTTER, "--no-config"]
    result = CliRunner().invoke(main, [*options, file])
    assert word in result.stdout if result.exit_code < 2 else not result.stdout


@pytest.mark.ci
def test_no_rewriter_writes_one_branch(tmp_path: Path) -> None:
    file = write(tmp_path, "a", hexagon(("G28 H0", "IF[#501GT0]GOTO9/N9G28 H0")))
    for command in (["unroll", *OPTIONS], ["compensate", "--center", *OPTIONS]):
        result = CliRunner().invoke(main, [*command, file])
        assert (result.exit_code, result.stdout) == (2, "")
        assert ":5: the condition depends on a value that is not known" in result.stderr


def test_a_parameter_of_siemens_is_named() -> None:
    program = "R2=R1+5\nT1 D1\nTRANS Z=R1\nG0 G90 G94 G40 X60 Z2 C0\nTRANSMIT\nG1 X20 Y0 F100\nTRAFOOF\nM30\n"
    reasons = [entry.reason for entry in report_of(program, "siemens-transmit", CUTTER).not_evaluated]
    assert any("Z=R1 of line 3" in reason for reason in reasons)


def test_a_variable_that_nothing_sets_is_told_once() -> None:
    head = ("G12.1/", "#107=#112+10.392/G12.1/")
    report = report_of(hexagon(head, ("/C10.392", "/C#107"), ("X-36. C10.392", "X-36. C#107")), "fanuc-30i", CUTTER)
    assert [(finding.rule, "#112" in finding.message) for finding in report.findings] == [("variable-never-set", True)]


def test_a_vacant_variable_is_the_cause_of_the_contour() -> None:
    report = report_of(hexagon(("C20.785", "C#101")), "fanuc-30i", CUTTER)
    assert [finding.rule for finding in report.findings] == ["vacant-variable"]


FLATS = (
    "O1000/G21 G98 G40/T0101/G97 S3000 M13/G28 H0/G0 X70. Z2. C0/Z-4./G12.1/G1 G42 X36. C-40. F150/C40./G40 X70./"
    "X80. F1000/C0/G13.1/G0 Z2./C90./X70./Z-4./G12.1/G1 G42 X36. C-40. F150/C40./G40 X70./X80. F1000/C0/G13.1/"
    "G0 Z50./G0 X100./M5/M30"
)


@pytest.mark.nightly
@looped(("control", "word"), [*itertools.product(("fanuc-30i", "gsk-988", "doosan"), ("C90.", "G13.1"))])
def test_what_lies_between_two_sections_is_no_fault_of_either(control: str, word: str) -> None:
    engaged = FLATS.replace("G28 H0", "M35/G28 H0") if control == "doosan" else FLATS
    assert report_of(engaged.replace("/", "\n"), control, CUTTER).verdict == "pass"
    program = engaged.replace(word, f"{word[0]}#500", 1).replace("/", "\n")
    report = report_of(program, control, CUTTER)
    assert (report.verdict, [finding.rule for finding in report.findings]) == ("unverified", [])


@pytest.mark.ci
@looped("word", ["C#500.", "H#500.5"])
@looped("control", ["fanuc-30i", "gsk-988", "mitsubishi-m700"])
def test_c_is_not_known_after_a_block_that_is_not_executed(control: str, word: str) -> None:
    program = FLATS.replace("C90.", word).replace("/", "\n")
    report = report_of(program, control, CUTTER)
    assert (report.verdict, report.findings) == ("unverified", [])
    line = program.splitlines().index(word) + 1
    assert f"C at the beginning of a section is not known after line {line}, {word}, which is not executed" in str(
        report.not_evaluated
    )
    followed = FLATS.replace("C90.", f"{word}/C90.").replace("/", "\n")
    assert "at the beginning of a section" not in str(report_of(followed, control, CUTTER).not_evaluated)


def test_an_axis_is_nowhere_from_an_unknown_word_on() -> None:
    rows = "O1000/G98 G0 X10. Z5. C30./X#500/X20./Z#500/Z20./C#500/C20./H#500/M30"
    path = tables_of(rows.replace("/", "\n"), "fanuc-30i", CUTTER)["trace"].path
    unknown = [np.flatnonzero(np.isnan(column[1:])).tolist() for column in (path.x, path.z, path.c_angle)]
    assert unknown == [[1], [3], [5, 7, 8]]
