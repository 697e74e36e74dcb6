"""Leads that go through the contour that they lead to or from, told where the contour goes round the part."""

from __future__ import annotations

import cmath
import math

import pytest
from programs import report_of

HEAD = "O1\nG21 G98 T0505\nG0 X90. C0 Z3.\nG12.1\nG1 G41 X60. C10. F800\nZ-6. F200\n"
SQUARE = (
    "G1 C-15.\nG2 X30. C-20. R5.\nG1 X-30.\nG2 X-40. C-15. R5.\nG1 C15.\nG2 X-30. C20. R5.\nG1 X30.\nG2 X40. C15. R5.\n"
)
END = "G1 G40 X90. C0\nZ3. F800\nG13.1\nG0 X120.\nM30\n"
LEAD_IN, CLOSE, LEAD_OUT = "G3 X40. C0 R10.\n", "G1 C0\n", "G3 X60. C-10. R10.\n"


def told(lead_in: str, close: str, lead_out: str, machine: str = "fanuc-30i") -> list[tuple[str, int]]:
    """The findings of a square of 40 with rounded corners, with their lines."""
    report = report_of(HEAD + lead_in + SQUARE + close + lead_out + END, machine, "5:radius=4")
    return [(finding.rule, finding.line) for finding in report.findings if finding.severity != "note"]


@pytest.mark.ci
@pytest.mark.parametrize("lead_out", ["G1 X-60. C-10.\n", "G1 X20. C-40.\n", "G1 X50.\nX-60. C3.\n"])
@pytest.mark.parametrize("machine", ["fanuc-30i", "fanuc-16i"])
def test_a_lead_out_through_the_part_is_told_in_its_block(lead_out: str, machine: str) -> None:
    line = (HEAD + LEAD_IN + SQUARE + CLOSE + lead_out).count("\n")
    assert told(LEAD_IN, CLOSE, lead_out, machine) == [("contour-crosses-itself", line)]


@pytest.mark.ci
def test_a_lead_in_through_the_part_is_told() -> None:
    assert [rule for rule, _ in told("G1 X-60. C3.\nX40. C0\n", CLOSE, LEAD_OUT)] == ["contour-crosses-itself"]


@pytest.mark.parametrize(
    ("lead_in", "close", "lead_out"),
    [
        (LEAD_IN, CLOSE, LEAD_OUT),
        # In lines and arcs, over the start once more, and where the lead in and the lead out cross.
        ("G1 X40. C0\n", "G1 C-4.\n", "G1 X60. C-10.\n"),
        ("G3 X40. C0 R10.\n", "G1 C-5.\n", "G3 X60. C-15. R10.\n"),
        ("G1 X40. C12.\nC0\n", "G1 C0\n", "C-6.\nX60. C-12.\n"),
        ("G1 X44. C3.\nX40. C0\n", "G1 C0\n", "X60. C10.\n"),
    ],
)
def test_leads_beside_the_part_are_told_nothing(lead_in: str, close: str, lead_out: str) -> None:
    assert "contour-crosses-itself" not in dict(told(lead_in, close, lead_out))


def test_increments_of_which_the_leads_cross_add_up() -> None:
    text = """G21 G90 G98 T0909
G0 X63. Z2. C0
G12.1
G1 X53. C13.202 F800.
Z-5.5
G41 X44. F150.
G91 C-22.404
X-6.062 C-5.25
X-31.876 C-9.201
X-12.124
X-31.876 C9.201
X-6.062 C5.25
C18.404
X6.062 C5.25
X31.876 C9.201
X12.124
X31.876 C-9.201
X10.062 C-8.714
G40 G90 X63. C8. F800.
Z2.
G13.1
M30
"""
    assert report_of(text, "mazak-eia", "9:radius=2.5").findings == []


@pytest.mark.parametrize("degrees", [0, 45, 70])
@pytest.mark.parametrize("side", [1, -1])
def test_sides_that_run_on_beyond_the_corner_where_they_meet_cross_nothing(side: int, degrees: int) -> None:
    octagon = [cmath.rect(15 / math.cos(math.pi / 8), math.radians(45 * k - 22.5)) for k in range(9)]
    path = [35 - 15j, 15 - 11.2j, *octagon[1:], 18.106 - 3.107j, 35 - 3.107j]
    turned = [point * cmath.rect(1, math.radians(degrees)) for point in path]
    start, *moves, end = [f"X{2 * point.real:.3f} C{side * point.imag:.3f}" for point in turned]
    blocks = ["O1", "G21 G98 G40 T0808", "G0 X80. C0 Z2.", "G12.1", f"G1 {start} F1500", "Z-4."]
    blocks += [f"G{42 if side > 0 else 41} {moves[0]} F250", *moves[1:], f"G40 {end}", "Z2.", "G13.1", "M30"]
    for radius in (2, 6):
        assert report_of("\n".join(blocks), "fanuc-30i", f"8:radius={radius}").findings == []
