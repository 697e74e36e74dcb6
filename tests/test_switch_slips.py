"""G121 and G12 in the place of G12.1, and the same of G13.1: one finding, with the code that makes it right."""

from __future__ import annotations

import pytest
from cases import looped
from programs import machine_of, report_of, said

from polarcheck.foundation.finding import Undecided

PROGRAM = "O1\nG98 G40 G97\nT0101\nG0 X60. C0\n{}\nG1 X10. C0 F200\nC5.\nG3 X0. C10. R5.\nG1 X60. C0\n{}\nG0 Z5.\nM30\n"
DIAMETER = {"x": "diameter"}
UNKNOWN = "polar-switch-unknown"


@pytest.mark.nightly
@looped(
    ("on", "off", "line", "severity", "remedy"),
    [
        ("G121", "G13.1", 5, "error", "write G12.1"),
        ("G121", "G131", 5, "error", "write G12.1, and G13.1 for G131 in line 10"),
        ("G121", "G0 X70.", 5, "warning", "write G12.1"),
        ("N10 G12", "G13.1", 5, "error", "write G12.1"),
        ("G12", "G13", 5, "error", "write G12.1, and G13.1 for G13 in line 10"),
        ("G12.1", "G131", 10, "error", "write G13.1"),
        ("G12.1", "G13", 10, "error", "write G13.1"),
        ("G12.1", "G013", 10, "error", "write G13.1"),
    ],
    one_in=3,
)
@looped("machine", ["fanuc", "mitsubishi-m700"])
def test_a_slip_is_one_finding(machine: str, on: str, off: str, line: int, severity: str, remedy: str) -> None:
    report = report_of(PROGRAM.format(on, off), machine, changes={"control": DIAMETER, "polar": DIAMETER})
    assert [(one.line, one.rule, one.severity) for one in report.findings] == [(line, UNKNOWN, severity)]
    assert report.findings[0].message.endswith(remedy)


@looped(("on", "off", "line"), [("G12,1", "G13.1", 5), ("G12.1", "G13,1", 10), ("G12,1", "G13,1", 5)])
def test_a_comma_is_the_only_finding_of_its_kind(on: str, off: str, line: int) -> None:
    report = report_of(PROGRAM.format(on, off))
    assert {one.rule for one in report.findings} == {"stray-character"}
    assert report.findings[0].line == line
    assert report.findings[0].message.partition(" (")[0].endswith(("write 12.1", "write 13.1"))


def test_codes_of_the_builder_are_named_with_their_keys() -> None:
    report = report_of(PROGRAM.format("G121", "G120"))
    assert [(one.line, one.rule, one.severity) for one in report.findings] == [(5, UNKNOWN, "warning")]
    assert 'polar.on = ["G12.1", "G121"] and polar.off = ["G13.1", "G120"]' in report.findings[0].message
    own = {"polar": {"on": ["G12.1", "G121"], "off": ["G13.1", "G120"]}}
    assert said(report_of(PROGRAM.format("G121", "G120"), changes=own)) == []


@looped(
    "blocks",
    ["G121\nG0 X70. Z5.", "G121 X50. Z-5.\nG1 C5. F200", "G12\nG0 Z5.", "G13", "G131"],
)
def test_a_code_without_a_contour_is_no_slip(blocks: str) -> None:
    report = report_of(f"O1\nG98\nT0101\nG0 X60. C0\n{blocks}\nG0 Z5.\nM30\n")
    assert UNKNOWN not in {rule for _, rule in said(report)}


def test_two_slips_are_two_findings() -> None:
    one = "G0 X60. C0\n{}\nG1 X10. C0 F200\nC5.\nX60. C0\n{}\n"
    report = report_of("O1\nG98\nT0101\n" + one.format("G121", "G13.1") + one.format("G12.1", "G131") + "M30\n")
    assert said(report) == [(5, UNKNOWN), (15, UNKNOWN)]


def test_a_contour_that_nothing_has_begun_is_told_beside_a_slip() -> None:
    contour = "G0 X60. C0\n{}\nG1 X10. C0 F200\nC5.\nG3 X0. C10. R5.\nG1 X60. C0\n{}\n"
    report = report_of("O1\nG98\nT0101\n" + contour.format("G121", "G13.1") + contour.format("", "G13.1") + "M30\n")
    assert said(report) == [(5, UNKNOWN), (17, "polar-never-entered")]


def test_words_of_another_language_have_no_such_slips() -> None:
    assert "G12.1" in machine_of("siemens-transmit").polar.on
    report = report_of("G94\nT1 D1\nG0 X60 Y0\nG121\nG1 X10 Y5 F200\nTRAFOOF\nM30\n", "siemens-transmit")
    assert UNKNOWN not in {rule for _, rule in said(report)}


# ---- codes of the builder's own ----

OWN = """O1
T0808
G98 G0 X60. Z2. C0
{on}
G1 G42 X30. F200
C10.
X-30.
C-10.
X30.
C3.
G40 X{leave}
{off}
G0 Z50.
M30
"""


@pytest.mark.nightly
@looped(
    ("on", "off", "leave", "rules"),
    [
        ("G121", "G120", "32.", [(4, "polar-switch-unknown"), (11, "cancel-shorter-than-radius")]),
        ("G121", "G120", "60.", [(4, "polar-switch-unknown")]),
        ("N5 G121", "G120", "60.", [(4, "polar-switch-unknown")]),
        ("G121", "G13.1", "32.", [(4, "polar-switch-unknown")]),
    ],
)
def test_the_contour_is_judged_as_if_they_switched_the_mode(
    on: str, off: str, leave: str, rules: list[tuple[int, str]]
) -> None:
    report = report_of(OWN.format(on=on, off=off, leave=leave), "fanuc", "8:radius=4,nose=0")
    assert (said(report), report.verdict) == (rules, "fail")
    for finding in report.findings[1:]:
        assert finding.message.startswith("if G121 begins the mode: ")
        assert isinstance(finding, Undecided)
        assert finding.fix is None


@pytest.mark.nightly
@looped("machine", ["mitsubishi-m700", "fanuc-30i", "doosan"])
@looped(
    ("before", "block", "rule"),
    [
        ("C10.\nX-30.", "C10.\nG0 X-30.", "rapid-in-polar"),
        ("C10.\nX-30.", "C10.\nG3 X-30. R1.", "arc-radius-too-small"),
        ("C10.\nX-30.", "C10.\nG18\nX-30.", "plane-selected-in-polar"),
    ],
)
def test_so_it_is_on_other_controls_and_with_other_faults(machine: str, before: str, block: str, rule: str) -> None:
    program = OWN.format(on="G121", off="G120", leave="60.").replace(before, block)
    assert block in program
    report = report_of(program, machine, "8:radius=4,nose=0")
    assert UNKNOWN in {finding.rule for finding in report.findings}
    (finding,) = (finding for finding in report.findings if finding.rule == rule)
    assert finding.message.startswith("if G121 begins the mode: ")
    assert isinstance(finding, Undecided)


def test_without_the_rule_nothing_is_supposed() -> None:
    program = OWN.format(on="G121", off="G120", leave="32.")
    job = {"severities": {"polar-switch-unknown": "off"}}
    assert "cancel-shorter-than-radius" not in [rule for _, rule in said(report_of(program, job=job))]
