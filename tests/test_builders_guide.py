"""What the builder's guide to G12.1 (document 000) says, on its own programs and on variations of them."""

from __future__ import annotations

import re

import pytest
from guide_programs import METHOD_A, PROGRAMS, in_mm, without
from programs import Changes, report_of, said

MACHINE = "turning-center"


def found(program: str, *tools: str, job: Changes | None = None, machine: str = MACHINE) -> list[tuple[str, str, str]]:
    """The block, the rule and the severity of each finding."""
    report = report_of(program, machine, *tools, job=job)
    return [(finding.block, finding.rule, finding.severity) for finding in report.findings]


def errors_and_warnings(program: str, *tools: str, machine: str = MACHINE) -> list[tuple[str, str]]:
    return [(block, rule) for block, rule, severity in found(program, *tools, machine=machine) if severity != "note"]


def message(program: str, rule: str, *tools: str, job: Changes | None = None) -> str:
    """The one message of a rule."""
    [finding] = [one for one in report_of(program, MACHINE, *tools, job=job).findings if one.rule == rule]
    return finding.message


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("unit", ["inch", "mm"])
def test_the_programs_of_the_guide_are_right(name: str, unit: str) -> None:
    program, *tools = PROGRAMS[name]
    if unit == "mm":
        number, _, rest = tools[0].partition("=")
        program, tools[0] = in_mm(program), f"{number}={float(rest) * 25.4}"
    assert errors_and_warnings(program, *tools) == []


# ---- a section begins with G12.1 ----


@pytest.mark.parametrize("name", PROGRAMS)
@pytest.mark.parametrize("compensated", [True, False])
@pytest.mark.parametrize("machine", [MACHINE, "fanuc"])
def test_a_section_without_its_g12_1_is_one_finding(name: str, compensated: bool, machine: str) -> None:
    program, *tools = PROGRAMS[name]
    written = re.sub(r"G4[12] ", "", re.sub(r"^G40 X", "X", program, flags=re.MULTILINE).replace("G1 G40 X", "G1 X"))
    for number in range(program.count("G12.1")):
        wrong = without(program if compensated else written, "G12.1", number)
        assert errors_and_warnings(wrong, *tools, machine=machine) == [("G13.1", "polar-never-entered")]


def test_both_sections_without_g12_1_are_two() -> None:
    program = METHOD_A.replace("G12.1\n", "")
    assert errors_and_warnings(program, "1:radius=.25") == [("G13.1", "polar-never-entered")] * 2


ARC = "O1\nG20 G98 G97 T0101\nG0 X2. Z.1 C0\n{}G2 X-2. C.2 R1.01 F5.\n{}\nG13.1\nM30\n"


@pytest.mark.parametrize("between", ["M9", "G0 Z1."])
def test_an_arc_of_c_belongs_into_the_mode(between: str) -> None:
    """Wherever it was left: no lathe turns C on an arc outside."""
    program = ARC.format("", between)
    assert errors_and_warnings(program, "1:radius=0", machine="fanuc") == [("G13.1", "polar-never-entered")]
    assert "C moves on an arc" in report_of(program, "fanuc").findings[-1].message


@pytest.mark.parametrize(
    "program",
    [
        ARC.format("G7.1 C1.\n", "G7.1 C0"),  # on a cylinder
        ARC.format("M98 P9000\n", "M9"),  # which may have entered it
        ARC.format("", "M9").replace("O1\nG20 G98 G97 T0101\n", "G20 G98\n"),  # as may what is not shown
        # C at feed is a groove round the diameter, and the G13.1 stands for safety.
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nX60.\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nG0 X100.\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nG28 U0\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nM1\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nG40 G13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 X50. F50\nC90. F500\nC0\nX60.\nT0202\nG13.1\nM30\n",
        "O1\nG98 T0101\nG0 X60. C0\nG1 C90. F500\nC0\nZ1.\nG13.1\nM30\n",
    ],
)
def test_what_is_no_contour_needs_no_g12_1(program: str) -> None:
    assert "polar-never-entered" not in [rule for _, rule in said(report_of(program, "fanuc"))]
