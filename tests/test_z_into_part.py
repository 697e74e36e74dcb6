"""Z that goes into the part upward, as on main spindles of sliding headstocks: depths, faces and the bar follow it."""

from __future__ import annotations

import math

import pytest
from cases import looped
from programs import Changes, report_of, tables_of

from polarcheck.reports.made_parts.part_report import in_one_line, made_by

TOOL = "1:radius=4,nose=0"
UP: Changes = {"control": {"z_into_part": "plus"}}
DOWN: Changes = {"control": {"z_into_part": "minus"}}
CONTOUR = "G42 X14. F200\nC4.041\nX0 C8.083\nX-14. C4.041\nC-4.041\nX0 C-8.083\nX14. C-4.041\nC0\nG40 X60. F1500\n"
TURNING = "T0202\nG97 S2000 M3\nG0 X22. Z-0.5\nG1 X-1. F100\nG0 X20. Z-1.\nG1 X18. F100\nZ20.\nG0 X30.\nZ-1.\nM5\n"


def milling(*depths: str, begin: str = "-1.", retract: str = "-1.", rapid: bool = False) -> str:
    passes = "".join(f"Z{depth} F300\n{CONTOUR}" for depth in depths)
    down = f"G0 X14.\nZ{depths[0]}\nG1 X60. F1500\n" if rapid else ""
    return f"T0101 G97 S2000 M13\nG0 X60. Z{begin} C0\n{down}G12.1\nG1 X60. C0 F1500\n{passes}Z{retract}\nG13.1\n"


def program(*parts: str) -> str:
    return f"O1\nG21 G98\n{''.join(parts)}G0 X60. Z-1.\nM30\n"


def mirrored(text: str) -> str:
    """The same with every Z the other way."""
    return text.replace("Z-", "Z#").replace("Z", "Z-").replace("Z-#", "Z")


def said(text: str, changes: Changes | None = None, stock: float = math.nan) -> list[str]:
    job = {} if math.isnan(stock) else {"stock": {"diameter": stock}}
    report = report_of(text, "fanuc-30i", TOOL, changes=changes, job=job)
    return [f"{finding.rule}: {finding.message}" for finding in report.findings]


@pytest.mark.nightly
@looped("stock", [math.nan, 18.0, 20.0, 26.0])
@looped(
    "text",
    [
        program(TURNING, milling("6.")),
        program(TURNING, milling("2.", "4.", "6.")),
        program(TURNING, milling("6.", begin="-4.", retract="-4.")),
        program(TURNING, milling("12.")),
        program(TURNING.replace("X18. F100\nZ20.", "X12. F100\nZ8.\nX18.\nZ20."), milling("6.", begin="-2.")),
        program(TURNING.replace("G0 X22. Z-0.5\nG1 X-1. F100\n", ""), milling("6.")),
        program(TURNING, milling("6."), "T0303\nG97 S800 M3\nG0 X24. Z22.\nG1 X-1. F50\nG0 X60.\n"),
    ],
)
def test_sound_programs(stock: float, text: str) -> None:
    assert said(text, stock=stock) == []
    assert said(text, UP, stock) == []
    assert said(mirrored(text), stock=stock) == []


@pytest.mark.nightly
@looped(
    ("text", "rule", "word"),
    [
        (program(TURNING, milling("-6.")), "cut-in-air", "cuts at Z-6"),
        (program(TURNING, milling("-6.", begin="-8.", retract="-8.")), "cut-in-air", "above the face at Z-0.5"),
        (program(TURNING, milling("6.", retract="6.") + "G0 X10.\n"), "rapid-through-part", "Z6"),
        (program(TURNING, milling("6.", rapid=True)), "rapid-plunge-into-stock", "Z6"),
    ],
)
def test_slips_are_those_of_the_mirrored_program(text: str, rule: str, word: str) -> None:
    found = said(text, stock=20.0)
    assert [one for one in found if one.startswith(rule) and word in one], found
    other = said(mirrored(text), stock=20.0)
    assert [one.partition(":")[0] for one in found] == [one.partition(":")[0] for one in other]
    assert [one for one in other if mirrored(word) in one]


def test_what_is_made_is_told_to_its_deepest_z() -> None:
    tables = tables_of(program(TURNING, milling("2.", "4.", "6.")), "fanuc-30i", TOOL)
    (entry,) = made_by(tables)
    assert entry.text == "hexagon, 14.000 across flats; to Z6.000 in 3 passes from Z2.000, 2.000 each"
    assert entry.z == 6
    assert in_one_line(tables) == "hexagon, 14.000 across flats, to Z6.000"


@pytest.mark.ci
def test_the_face_of_the_job_is_as_the_program_writes_it() -> None:
    job = {"stock": {"diameter": 20.0, "face": -0.5}}
    text = program(milling("-6.", begin="-8.", retract="-8."))
    (finding,) = report_of(text, "fanuc-30i", TOOL, changes=UP, job=job).findings
    assert "cuts at Z-6, above the face at Z-0.5 ([stock])" in finding.message
    sound = program(milling("6."))
    assert report_of(sound, "fanuc-30i", TOOL, changes=UP, job=job).findings == []


def test_a_tool_that_cuts_on_its_way_out_shows_nothing() -> None:
    for facing in ("", "G0 X22. Z0\nG1 X-1. F100\nG0 Z2.\n"):
        out = f"T0202\nG97 S2000 M3\n{facing}G0 X20. Z-20.\nG1 X18. F100\nZ2.\nG0 X30.\nM5\n"
        assert said(program(out, milling("-6.", begin="2.", retract="2."))) == []


def test_a_retract_alone_shows_nothing() -> None:
    turned = mirrored(TURNING)
    text = program(turned, milling("6.", begin="2.", retract="2."))
    assert [one for one in said(text) if one.startswith("cut-in-air: cuts at Z6, above Z2")]


def test_turning_against_the_machine_is_not_judged() -> None:
    for text, changes in ((program(TURNING, milling("-6.")), DOWN), (mirrored(program(TURNING, milling("-6."))), UP)):
        report = report_of(text, "fanuc-30i", TOOL, changes=changes)
        assert report.findings == []
        (entry,) = [entry for entry in report.not_evaluated if "z_into_part" in entry.reason]
        assert not entry.matters
        assert report.verdict == "pass"
