"""Programs that nobody writes, as fuzzing found them: nothing breaks, nothing is told twice or at any length."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from random import Random

import deep_contours
import fuzz_targets
import msgspec
import pytest
from cases import looped
from fuzz_setups import SETUPS
from programs import report_of, said
from test_cli import process

from polarcheck.foundation.finding import FileReport, Finding

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X80. C0 Z2.\n"
CONTOUR = "G1 G42 X60. C0 F100\nC20.\nG3 X40. C30. R10.\nG1 X-60.\nC-30.\nX60.\nC5.\nG40 X80. C0\n"


def every(report: FileReport) -> Iterator[Finding]:
    """The findings and what follows from them."""
    for found in report.findings:
        yield from (found, *found.follows)


# ---- numbers that no control takes ----

LARGEST = ["POW[10,307]*9", "0-POW[10,308]", "POW[10,155]", "POW[10,18]", "1/POW[10,300]"]


@pytest.mark.ci
@looped("value", LARGEST, one_in=36)
@looped("letters", ["XU", "CH", "ZW", "IJ", "R", "FS", "GM", "T", "PQ", "EK"])
def test_computed_numbers_without_measure_are_unknown(value: str, letters: str) -> None:
    """On a control that calculates up to 1e308, nothing overflows (a warning of NumPy is an error in tests)."""
    for letter in letters:
        word = f"{letter}#1"
        program = f"{HEAD}#1={value}\n{word}\nG12.1\nG1 G42 X60. C0 F100\nC20. {word}\nG3 X40. C30. {word}\n"
        report = report_of(program + "G40 X80.\nG13.1\nM30\n", "fanuc-30i", "1:radius=5")
        assert not any("inf" in found.message.split() for found in every(report))


@pytest.mark.nightly
@looped("digits", [10, 16, 23, 150, 400], one_in=24)
@looped("word", ["X", "C-", "U", "H", "Z", "I", "R", "G3 X40. C30. R", "G3 C30. I", "F", "G", "T", "N"])
def test_written_numbers_without_measure_have_one_cause(word: str, digits: int) -> None:
    program = f"{HEAD}G12.1\n{word}{'9' * digits}\n{CONTOUR}{word}{'9' * digits}\nG13.1\nM30\n"
    report = report_of(program, "fanuc", "1:radius=5")
    assert {5 + 1, 15} & {found.line for found in report.findings}
    assert not any("inf" in found.message.split() for found in every(report))


@pytest.mark.nightly
@looped("word", ["X-#1", "X#1", "U-#1"])
def test_a_position_without_measure_is_not_told_as_a_number(word: str) -> None:
    program = f"O1\nG20 G98 G18\nT0101\n#1=POW[10,308]\nG0 {word} C0 Z2.\nG12.1\nG1 X1. C1. F100\nC-1.\nG13.1\nM30\n"
    report = report_of(program, "fanuc-30i", "1:radius=0", changes={"limits": {"c_feed": 3600}})
    assert "x-not-positive-at-entry" not in dict(map(reversed, said(report)))  # type: ignore[arg-type]
    assert any("position" in missing.reason for missing in report.not_evaluated)


@looped("word", ["F#1", "F"])
def test_a_feed_per_revolution_without_measure_is_not_told_as_a_number(word: str) -> None:
    program = f"O1\n#1=POW[10,308]\nG20 G99 G0 X6. C0\nG1 Z-5. F.1\nZ-6. {word}\nG12.1\nG98 X4.\nC1.\nG13.1\nM30\n"
    report = report_of(program, "fanuc-30i")
    assert not any("nan" in finding.message.split() for finding in every(report))
    assert any("feed is not known" in missing.reason for missing in report.not_evaluated)


def test_a_feed_without_measure_is_not_told_as_a_number() -> None:
    program = f"{HEAD}#1=POW[10,308]\nG12.1\nG1 X2. C1. F#1\nC-1.\nF{'9' * 200}\nC1.\nG13.1\nM30\n"
    report = report_of(program, "fanuc-30i", "1:radius=0", changes={"limits": {"c_feed": 3600}})
    assert not any("inf" in found.message.split() for found in every(report))


@pytest.mark.ci
@looped("digits", [9, 150, 400, 5000], one_in=4)
@looped("statement", ["GOTO{}", "#1={}", "M98 P{}", "M98 P2 L{}", "IF[#1EQ{}]GOTO1", "N{}", "#{}=1", "O{}"])
def test_statements_take_numbers_of_any_length(statement: str, digits: int) -> None:
    report = report_of(f"O1\n{statement.format('9' * digits)}\nM30\nO2\nM99\n", "fanuc-30i")
    assert len(msgspec.json.encode(report)) < 20_000


# ---- what is quoted ----

LONG = 5000
LONG_PROGRAMS = {
    "digits": f"{HEAD}G12.1\nG1 X{'9' * LONG} F100\nG13.1\nM30\n",
    "decimals": f"{HEAD}G12.1\nG1 X1.{'0' * LONG}1 F100\nC1..{'0' * LONG}\nG13.1\nM30\n",
    "code": f"{HEAD}G{'7' * LONG}\nM{'7' * LONG}\nM30\n",
    "letters for digits": f"{HEAD}X1{'O' * LONG}.\nM30\n",
    "program number": f"O{'1' * LONG}\nG12.1\nG0 X1.\nM30\n",
    "program name": f"O<{'A' * LONG}>\nG12.1\nG0 X1.\nM98 <{'B' * LONG}>\nM30\n",
    "jump": f"O1\nGOTO{'1' * LONG}\nM30\n",
    "expression": f"O1\n#1=[{'1+' * LONG}\n#{'9' * LONG}=1\nX[{'[' * LONG}\nM30\n",
    "words": f"{HEAD}G12.1\n{'G0 X1. ' * LONG}\nG13.1\nM30\n",
    "comment": f"{HEAD}(CUTTER 10. DIA {'X' * LONG})\nG12.1\n({'(' * LONG}\nM30\n",
    "strays": f"{HEAD}{'?' * LONG}\nG1 X1.\u2013{'é' * LONG}\nM30\n",
    "outside": f"%\nO1\nM30\n%\n{'G1 X1. ' * LONG}\n",
    "block without end of mode": f"{HEAD}G12.1\nG1 C5. F100\nG0 {'X1. ' * LONG}\nM30\n",
}


@pytest.mark.ci
@looped("name", LONG_PROGRAMS, one_in=12)
@looped("machine", ["fanuc", "haas-lathe", "mitsubishi-m700"])
def test_a_report_quotes_only_the_beginning_of_what_is_long(name: str, machine: str) -> None:
    report = report_of(LONG_PROGRAMS[name], machine, "1:radius=5", job={"radius_from_comments": True})
    assert report.findings
    for found in every(report):
        told = msgspec.structs.replace(found, follows=[])
        assert len(found.message) < 500, found.message
        assert len(msgspec.json.encode(told)) < 1500, told
    assert all(len(program) < 60 for program in report.programs)
    assert all(len(missing.reason) < 500 for missing in report.not_evaluated)


def test_what_is_cut_off_ends_in_dots() -> None:
    report = report_of(LONG_PROGRAMS["digits"], "fanuc")
    (found,) = [one for one in report.findings if one.rule == "too-many-digits"]
    assert found.message.startswith(f"X{'9' * 39} ... has more than")
    assert found.block == f"G1 X{'9' * 196} ..."


# ---- each finding once, and somewhere ----


@looped("program", ["", "%\n%\n", "\n\n", "(ONLY A COMMENT)\n", "%"])
def test_an_empty_file_has_a_place(program: str) -> None:
    (found,) = report_of(program).findings
    assert (found.rule, found.line, found.column, found.end_line) == ("empty-program", 1, 1, 1)
    assert found.end_column == max(len(program.split("\n")[0].rstrip()), 1) + 1


def test_a_file_in_another_language_has_a_place() -> None:
    (found,) = report_of("G92 E0\nG1 X5 Y5 E5\nG1 X6 Y5 E6\n").findings
    assert (found.rule, found.line, found.column, found.end_column) == ("other-dialect", 1, 1, 7)


@pytest.mark.nightly
@looped("slash", ["/C0. F200", "C0. F200", "/C0", "/2 C0"], one_in=3)
def test_block_skip_tells_nothing_twice(slash: str) -> None:
    """What stands alone with block skip off may follow from something else with it on."""
    program = (
        f"T0101\nG98 G0 X80. Z2. C0\nG12.1\nG1 X#0. C5. F500\nG42 X40.{slash}\nX20. C17.32\nX-40. C0.\nG40 X80. C5."
    )
    report = report_of(program, "fanuc-16i", "1:radius=5", "2:radius=3")
    places = [(found.rule, found.line, found.column) for found in every(report)]
    assert len(places) == len(set(places))


# ---- what could take time ----


@pytest.mark.one_in(6)
@pytest.mark.ci
@pytest.mark.parametrize("blank", ["\n", " \n", "%\n", "\r\n", " ", "\n%"])
def test_blank_lines_before_a_called_program_are_read_once(tmp_path: Path, blank: str) -> None:
    """In a process of its own, which is ended if it hangs: read again from each line, this would take hours."""
    (tmp_path / "a.nc").write_text("O1\nG21\nM98 P77\nM30\n", newline="")
    (tmp_path / "O77.nc").write_text(blank * 200_000 + "\nO77\nM99\n", newline="")
    run = process("check", str(tmp_path / "a.nc"), "--no-config", "--subprograms", str(tmp_path), "--format", "concise")
    out, errors = run.communicate(timeout=120)
    assert ("subprogram-missing" in out, errors) == (False, "")


@pytest.mark.parametrize(
    "head", ["O77\n", "%\nO77\n", ":77\n", "\n\n  O0077 (A)\n", "%O77\n", "  % O 77\n", "", "%\n", "\n%\n(SUB)\n"]
)
@pytest.mark.parametrize("encoding", ["ascii", "utf-8-sig", "utf-16"])
def test_a_called_program_has_the_number_of_its_file(tmp_path: Path, head: str, encoding: str) -> None:
    """A head of its own, or none and then that of the call, wherever the tape begins."""
    (tmp_path / "77.nc").write_text(f"{head}G12.1\nG0 X1.\nM99\n%\n", encoding, newline="")
    report = report_of(HEAD + "M98 P77\nM30\n", job={"run": {"subprograms": [str(tmp_path)]}})
    assert said(report) == [(5, "polar-never-left"), (5, "rapid-in-polar")]
    assert f"in 77.nc, line {head.count(chr(10)) + 1}, G12.1" in report.findings[0].message


# ---- sections of called programs ----

CALLED = {
    "as it was found": ("M98 P2\nM30\nO2\nG12.1\nG0 X1.\nM99\n", {"polar-never-left", "rapid-in-polar"}),
    "in the main program": ("G12.1\nG0 X1.\nM30\n", {"polar-never-left", "rapid-in-polar"}),
    "a call in a call": ("M98 P2\nM30\nO2\nM98 P3\nM99\nO3\nG12.1\nG1 X70. C3. F100\nC4.\nM99\n", {"polar-never-left"}),
    "called twice": ("M98 P2\nM98 P2\nM30\nO2\nG12.1\nG1 X70. C3. F100\nC4.\nM99\n", {"polar-never-left"}),
    "repeated": ("M98 P2 L2\nM30\nO2\nG12.1\nG1 X70. C3. F100\nC4.\nM99\n", {"polar-never-left"}),
    "a macro call": ("G65 P2 A1.\nM30\nO2\nG12.1\nG1 X70. C3. F100\nC#1\nM99\n", {"polar-never-left"}),
    "rapid in a macro": ("G65 P2 A1.\nM30\nO2\nG12.1\nG0 X#1\nM99\n", {"polar-never-left", "rapid-in-polar"}),
    "by name": ("M98 <SUB>\nM30\nO<SUB>\nG12.1\nG0 X1.\nM99\n", {"polar-never-left", "rapid-in-polar"}),
    "rapid in the mode": ("G12.1\nM98 P2\nG13.1\nM30\nO2\nG0 X1.\nM99\n", {"rapid-in-polar"}),
    "for an unknown caller": ("M99\nO2\nG12.1\nG0 X1.\nM99\n", {"rapid-in-polar"}),
    "left by G0": ("M99\nO2\nG12.1\nG1 X70. C3. F100\nC4.\nG0 X90.\nM99\n", {"polar-never-left"}),
    "ended in the called one": ("G12.1\nM98 P2\nM30\nO2\nG1 X70. C3. F100\nC4.\nX80. C0\nG13.1\nM99\n", set()),
    "begun in the called one": ("M98 P2\nG1 X70. C3. F100\nC4.\nX80. C0\nG13.1\nM30\nO2\nG12.1\nM99\n", set()),
}


@pytest.mark.ci
@looped("name", CALLED, one_in=6)
@looped("machine", ["fanuc", "fanuc-30i"])
def test_a_section_that_is_begun_in_a_called_program(name: str, machine: str) -> None:
    program, expected = CALLED[name]
    report = report_of(HEAD + program, machine, "1:radius=0")
    assert {rule for _, rule in said(report)} == expected


# ---- contours at several depths ----

#: Contours that run over each other at four depths, none of which closes.
DEPTHS = """T0101
G12.1
G1 G41 X103. C0. F200.
G1 X-51. C-44.
G1 X-51. C44.
G1 X52. C-45.
G1 Z-2.
G1 X-100. C0.
G1 X-53. C-46.
G1 X51. C-44.
G1 Z-3.
G1 X-52. C-45.
G3 X51. C-44. R36.
G1 Z-4.
G1 X-52. C45.
G1 X-51. C-45.
G1 X52. C-45.
G1 Z-4.5
G1 X107. C0.
G1 G40 X129. C0."""


#: The number of the setup with the machine `fanuc` and R 5 in offset 1.
FANUC = next(n for n, setup in enumerate(SETUPS) if (setup.machine, setup.tools[:1]) == ("fanuc", ("1:radius=5",)))


@pytest.mark.nightly
@looped("seed", [None, 368, *range(10)], one_in=12)
def test_contours_at_several_depths_end_in_a_report(seed: int | None) -> None:
    data = DEPTHS.encode() if seed is None else deep_contours.program(Random(seed))  # noqa: S311
    fuzz_targets.commands(data, FANUC)
