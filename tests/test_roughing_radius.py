"""R that is larger than the cutter, since roughing leaves metal: no contradiction, and told of the part."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, tables_of

from polarcheck.reports.made_parts.part_report import made_by

RULE = "radius-contradicts-comment"
HEXAGON = (
    "G0 X60. Z2. C0\nG12.1\nG1 X60. C0 F1500\nZ-5. F300\nG42 X22. F200\nC6.351\nX0 C12.702\nX-22. C6.351\nC-6.351\n"
    "X0 C-12.702\nX22. C-6.351\nC0\nG40 X60. F1500\nZ2.\nG13.1\n"
)


def program(call: str, units: str = "G21") -> str:
    return f"O1\n{units} G98\n{call}\n{HEXAGON}G0 Z50.\nM30\n"


def found(call: str, tool: str) -> list[str]:
    report = report_of(program(call), "fanuc-30i", f"1:{tool},nose=0", only=[RULE, "comment-contradicts-part"])
    return [finding.rule for finding in report.findings]


@pytest.mark.nightly
@looped(
    "call",
    [
        "T0101 (D12 ROUGH)",
        "T0101 (EM12 ROUGHING)",
        "T0101 (EM12, LEAVE 0.3)",
        "T0101 (D12 STOCK 0.3)",
        "T0101 (EM12 0.3 STOCK)",
        "(ROUGH)\nT0101 (EM12)",
        "T0101 (EM12) (LEAVE 0.3 ON WALLS)",
        "T0101 (FRAESER D12 SCHRUPPEN)",
        "T0101 (FRAESER D12 AUFMASS 0,3)",
        "T0101 (FRAISE 12 EBAUCHE)",
        "T0101 (FRAISE 12 SUREPAISSEUR 0.3)",
        "T0101 (FRESA 12 SGROSSATURA)",
        "T0101 (FRESA D12 DESBASTE)",
        "T0101 (EM12 ROUGH, HEX 21 AF)",
    ],
)
def test_roughing_that_leaves_metal(call: str) -> None:
    assert found(call, "radius=6.3") == []
    (entry,) = made_by(tables_of(program(call), "fanuc-30i", "1:radius=6.3,nose=0"))
    assert "to Z-5.000; 0.300 left" in entry.text
    # No roughing leaves as much, or cuts into the part.
    assert found(call, "radius=8") == [RULE]
    assert found(call, "radius=5") == [RULE]


@looped("call", ["T0101 (EM12)", "T0101 (EM12 FINISH)", "T0101 (STOCK D50)\n(T1 EM12)", "T0101 (EM12, HEX 22 AF)"])
def test_another_radius_without_a_word_of_roughing(call: str) -> None:
    assert found(call, "radius=6.3") == [RULE]


def test_the_diameter_of_the_job_beside_a_larger_radius() -> None:
    assert found("T0101 (EM12)", "radius=6.3,diameter=12") == []
    assert found("T0101 (EM16)", "radius=6.3,diameter=12") == [RULE]
    (entry,) = made_by(tables_of(program("T0101"), "fanuc-30i", "1:radius=6.3,diameter=12,nose=0"))
    assert entry.text == "hexagon, 22.000 across flats; to Z-5.000; 0.300 left"
    (entry,) = made_by(tables_of(program("T0101 (EM12)"), "fanuc-30i", "1:radius=6.3,nose=0"))
    assert "left" not in entry.text
