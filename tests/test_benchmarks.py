"""What the benchmarks compare with: programs with one fault each, and the same path for readers of mill programs."""

from __future__ import annotations

import re
import sys

import pytest
from programs import ROOT, report_of, said

sys.path.insert(0, str(ROOT / "benchmarks"))

import generate
from one_fault import FAULTS, GOOD, TOOL
from xy_twin import tool_table, twin


def test_the_program_without_a_fault_passes() -> None:
    report = report_of(GOOD, "fanuc", TOOL)
    assert (report.verdict, said(report)) == ("pass", [])


@pytest.mark.parametrize("name", FAULTS)
def test_one_fault_is_found_for_the_right_reason(name: str) -> None:
    fault = FAULTS[name]
    assert GOOD.count(fault.meant) >= 1
    report = report_of(GOOD.replace(fault.meant, fault.written, 1), "fanuc", TOOL)
    assert [rule for _, rule in said(report)] == [fault.rule]
    told = report.findings[0]
    assert re.search(fault.says, f"{told.rule} {told.message}", re.IGNORECASE)


TURNED = "%\nO0001 (X)\nN1 T0404 (MILL)\nN2 G28 U0 W0\nN3 G97 S2000 M33\nN4 G98\nN5 G12.1\nN6 G1 G42 X34.827 C0.217\n"
TURNED += "N7 G3 X34.665 C1.296 R10.14\nN8 G1 G40 X42.\nN9 G13.1\n%\n"


def test_the_twin_has_the_same_blocks_on_a_mill() -> None:
    assert twin(TURNED).splitlines() == [
        *("%", "", "N1 T4 M6", "N2", "N3 S2000", "N4 G94", "N5 G17", "N6 G1 X17.4135 Y0.217"),
        *("N7 G3 X17.3325 Y1.296 R10.14", "N8 G1 X21.", "N9 G18", "%"),
    ]
    compensated = twin(TURNED, compensated=True).splitlines()
    assert (compensated[7], compensated[9]) == ("N6 G1 G42 D4 X17.4135 Y0.217", "N8 G1 G40 X21.")
    assert twin(TURNED, sinumerik=True).splitlines()[8] == "N7 G3 X17.3325 Y1.296 CR=10.14"
    assert tool_table(2.0).splitlines()[3] == "T4 P4 D0.157480"


def test_a_long_step_is_milled_in_several_sections(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(generate, "LONGEST_SECTION", 3000)
    text = generate.program(20_000).decode()
    lines = text.splitlines()
    assert len(lines) == 20_002
    begins = [number for number, line in enumerate(lines) if "G12.1" in line]
    ends = [number for number, line in enumerate(lines) if "G13.1" in line]
    assert len(begins) == len(ends) > 6
    assert max(end - begin for begin, end in zip(begins, ends, strict=True)) <= 3000
    found = report_of(text, "fanuc", *(f"{number}:radius=2,nose=0" for number in range(4, 13)))
    assert said(found) == []
