"""What rests on a variable without a value is not known: to the check, to the part, to comparisons and to rewriters."""

from __future__ import annotations

import itertools
import re
from pathlib import Path

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
}
#: No section rests on these.
HARMLESS = {
    "S": ("S3000", "S#501"),
    "a dwell": ("G28 H0", "G4 X#501/G28 H0"),
    "a retract": ("X100. Z50.", "X#501 Z#501"),
    "G behind the section": ("G0 X100.", "G#501 X100."),
    "a work offset by its number": ("G28 H0", "G54.1 P#501/G28 H0"),
    "an argument of a program that nothing calls": ("M30", "M30/O9/G0 X#24/M99"),
}


#: G-code system B has G91 in the place of W, and G92 in that of G50.
OF_SYSTEM_A = ("step of the depth", "G50")


@looped(
    ("control", "name"),
    [pair for pair in itertools.product(CONTROLS, UNKNOWN) if pair[0] != "mazak-eia" or pair[1] not in OF_SYSTEM_A],
)
def test_a_check_never_passes_and_says_which_variable(control: str, name: str) -> None:
    report = report_of(hexagon(UNKNOWN[name]), control, CUTTER)
    assert report.verdict == "unverified"
    assert [finding.rule for finding in report.findings if finding.severity != "note"] == []
    told = [entry.reason for entry in report.not_evaluated if entry.matters]
    assert any("#500" in reason or "sets X to what is not known" in reason for reason in told)


@looped(("control", "name"), [*itertools.product(CONTROLS, HARMLESS)])
def test_what_no_section_rests_on_has_no_weight(control: str, name: str) -> None:
    report = report_of(hexagon(HARMLESS[name]), control, CUTTER)
    assert report.verdict == "pass"
    assert [entry for entry in report.not_evaluated if entry.matters] == []


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


@pytest.mark.ci
@looped("name", UNKNOWN)
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


@pytest.mark.ci
@looped("name", UNKNOWN)
def test_no_rewriter_writes(name: str, tmp_path: Path) -> None:
    file = write(tmp_path, "a", hexagon(UNKNOWN[name]))
    for command in (["unroll", *OPTIONS], ["compensate", "--center", *OPTIONS]):
        result = CliRunner().invoke(main, [*command, file])
        assert (result.exit_code, result.stdout) == (2, "")
    by_machine = ["convert", "--from", "fanuc-30i", "--to", "haas-lathe", "--tool", CUTTER, "--no-config"]
    result = CliRunner().invoke(main, [*by_machine, file])
    assert (result.exit_code, result.stdout) == (2, "")
    assert re.search(r"#500 has no value for \S+ of line \d+: give \[run\.variables\] 500 = \.\.\.", result.stderr)


def test_a_variable_that_nothing_sets_is_told_once() -> None:
    head = ("G12.1/", "#107=#112+10.392/G12.1/")
    report = report_of(hexagon(head, ("/C10.392", "/C#107"), ("X-36. C10.392", "X-36. C#107")), "fanuc-30i", CUTTER)
    assert [(finding.rule, "#112" in finding.message) for finding in report.findings] == [("variable-never-set", True)]


def test_a_vacant_variable_is_the_cause_of_the_contour() -> None:
    report = report_of(hexagon(("C20.785", "C#101")), "fanuc-30i", CUTTER)
    assert [finding.rule for finding in report.findings] == ["vacant-variable"]
