"""Sequence names of Okuma programs that are longer than the control takes, and its codes that clamp the C axis."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said

HEAD = "O1\nG0 X100 Z100\n"


@pytest.mark.ci
@looped(
    ("blocks", "is_too_long"),
    [
        ("GOTO NLOOP1\nG0 X50\nNLOOP1 G0 X60\n", True),
        ("IF [VC1 EQ 1] NSTART\nG0 X50\nNSTART G0 X60\n", True),
        ("NLOOP1 G0 X60\nGOTO NLOOP1\n", True),
        ("GOTO NLAP2\nG0 X50\nNLAP1 G0 X60\n", False),
    ],
)
def test_a_long_name_is_said_to_be_too_long(blocks: str, is_too_long: bool) -> None:
    (found,) = [one for one in report_of(f"{HEAD}{blocks}M2\n", "okuma-osp").findings if "jump" in one.rule]
    assert ("N and 4 letters or digits at most" in found.message) == is_too_long
    assert ("there is no label" in found.message) != is_too_long
    changes = {"macro": {"sequence_name_limit": 0}}
    (found,) = report_of(f"{HEAD}{blocks}M2\n", "okuma-osp", changes=changes, only=["jump-target-missing"]).findings
    assert "there is no label" in found.message


def test_a_name_that_fits_is_found() -> None:
    report = report_of(f"{HEAD}GOTO NLAP1\nG0 X50\nNLAP1 G0 X60\nM2\n", "okuma-osp")
    assert not [one for one in report.findings if "jump" in one.rule]


SECTION = """O1
G0 X200 Z200
T080808
M110
{before}
SB=1500 M13
G94 G0 X60 Z2 C0
{inside}G137 C0
G101 X40 Y0 F500
G101 X30 Y10
G101 X-30
G136
M12
M109
M2
"""


@pytest.mark.ci
@looped(
    ("before", "inside", "is_said"),
    [("M146", "", False), ("M147", "", True), ("M147", "M146\n", False), ("", "M147\n", True), ("", "", False)],
)
def test_a_clamped_c_axis_is_said(before: str, inside: str, is_said: bool) -> None:
    found = [
        rule for _, rule in said(report_of(SECTION.format(before=before, inside=inside), "okuma-osp", "8:radius=4"))
    ]
    assert ("c-axis-clamped-in-polar" in found) == is_said
