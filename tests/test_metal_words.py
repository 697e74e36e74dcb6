"""What is said of the turret at depth, of depths before a call, and of corners that are not simulated."""

from __future__ import annotations

import pytest
from programs import report_of, tables_of

from polarcheck.reports.made_parts.part_report import in_one_line, made_by

pytestmark = pytest.mark.ci

HEAD = "O1/G21 G98 G40/T0101/G97 S3000 M13/G28 H0/G0 X60. Z2. C0/G12.1/G1 X60. C8. F1500/"
HEXAGON = "G42 X24. C-14. F250/C6.928/X0 C13.856/X-24. C6.928/C-6.928/X0 C-13.856/X24. C-6.928/C1./G40 X60. C8. F1500/"
END = "Z2./G13.1/G0 Z50./M30/"


def findings(program: str) -> list[tuple[str, int, str]]:
    report = report_of(program.replace("/", "\n"), "fanuc-30i", "1:radius=6,nose=0", "2:radius=6,nose=0")
    return [(one.rule, one.line, one.message) for one in report.findings if one.severity != "note"]


@pytest.mark.parametrize(("depth", "at_depth"), [("Z-6.", True), ("Z1.", False)])
def test_a_turret_that_turns_at_depth_is_told(depth: str, at_depth: bool) -> None:
    beside = ", and the turret turns beside the part at Z-6"
    cut = HEXAGON.replace("X-24. C6.928/", "X-24. C6.928/T0202/")
    messages = [message for rule, _, message in findings(f"{HEAD}{depth} F300/{cut}{END}") if rule[:6] == "offset"]
    assert [beside in message for message in messages] == [at_depth]
    messages = [message for _, _, message in findings(f"{HEAD}{depth} F300/{HEXAGON}T0202/{END}")]
    assert [beside in message for message in messages] == [at_depth]
    # Another offset of the same tool turns no turret.
    cut = HEXAGON.replace("X-24. C6.928/", "X-24. C6.928/T0102/")
    assert not any("turret" in message for _, _, message in findings(f"{HEAD}{depth} F300/{cut}{END}"))


@pytest.mark.parametrize(
    ("depths", "rule", "line"),
    [
        (("Z-2.", "Z-40.", "Z-6."), "pass-depth-differs", 11),
        (("Z6.",), "cut-in-air", 9),
    ],
)
def test_a_depth_before_a_call_is_told_at_its_block(depths: tuple[str, ...], rule: str, line: int) -> None:
    calls = "".join(f"{depth} F300/M98 P2/" for depth in depths)
    assert [one[:2] for one in findings(f"{HEAD}{calls}{END}O2/{HEXAGON}M99/")] == [(rule, line)]


def test_corners_that_are_not_simulated_are_not_shown_sharp() -> None:
    cut = "G42 X24. C-14. F250/C12. ,R2./X-24. ,C1./C-12./X24./C1./G40 X60. C8. F1500/"
    tables = tables_of(f"{HEAD}Z-6. F300/{cut}{END}".replace("/", "\n"), "fanuc-30i", "1:radius=4,nose=0")
    expected = "corners not simulated: the rounds and chamfers of lines 11, 12 are left out"
    assert {shape.needs for shape in made_by(tables)} == {expected}
    assert in_one_line(tables) == ""


def test_an_engraving_makes_grooves_and_no_islands() -> None:
    frame = "X4. F200/C5./X10./C2./Z1. F500/X0 C-3./Z-.2 F60/G3 X0 C-7. R2. F200/G3 X0 C-3. R2./G1 Z1. F500/"
    program = f"{HEAD}X10. C2./Z-.2 F60/{frame}X-8. C2./Z-.2 F60/C6./Z2./G13.1/M30/".replace("/", "\n")
    engraved = made_by(tables_of(program, "fanuc-30i", "1:radius=.2,nose=0"))
    assert {(shape.shape, shape.z) for shape in engraved} == {("groove", -0.2)}
    # Deeper, it is a boss within its groove.
    milled = made_by(tables_of(program.replace("Z-.2", "Z-2."), "fanuc-30i", "1:radius=.2,nose=0"))
    assert {shape.shape for shape in milled} > {"groove"}
