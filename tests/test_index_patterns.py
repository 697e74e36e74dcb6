"""One contour at several angles of C: the angle that is off an even division is told, an uneven design is not."""

from __future__ import annotations

from collections.abc import Sequence

import pytest
from programs import report_of

RULE = "nearly-regular-contour"


def program(angles: Sequence[str], comment: str = "SLOTS", without: int = -1) -> list[str]:
    """A slot in a subprogram that is called at each of these angles, but for one of them."""
    calls = [
        line
        for number, angle in enumerate(angles)
        for line in [f"G0 C{angle}", *(["M98 P2"] if number != without else [])]
    ]
    slot = ["G0 X36. Z2.", "G12.1", "G1 X18. C0. F1000", "Z-3. F60", "X28. F120", "Z2. F900", "G13.1", "G0 X60. Z5."]
    return ["O1", f"({comment})", "T0101", "G98 G97 S2500 M13", "G0 X60. Z5.", *calls, "M30", "O2", *slot, "M99"]


def told(lines: list[str]) -> list[tuple[str, str]]:
    """The block and the word that is needed of each finding."""
    findings = report_of("\n".join(lines) + "\n", "fanuc-30i", "1:radius=4").findings
    found = [finding for finding in findings if finding.severity != "note"]
    assert {finding.rule for finding in found} <= {RULE}
    return [(lines[finding.line - 1], str(finding.values.get("word_needed", ""))) for finding in found]


@pytest.mark.parametrize(
    ("angles", "comment"),
    [
        (["0.", "90.", "180.", "270."], "SLOTS"),
        (["0.", "72.", "144.", "216.", "288."], "SLOTS"),
        (["0.", "90.", "180."], "3 SLOTS"),
        (["0.", "120.", "220."], "SLOTS"),
        (["0.", "120.", "180."], "3 DEG"),
        (["0.", "30.", "90.", "200."], "4 SLOTS"),
        (["0.", "90.", "180.", "300."], "SLOTS 14 LONG"),
        (["0.", "90.", "#500", "270."], "4 SLOTS"),
        (["#500", "120.", "250."], "3 SLOTS"),
        (["0.", "72.", "144.", "216.", "[#101+288.]"], "SLOTS"),
    ],
)
def test_angles_that_are_meant_are_not_told(angles: list[str], comment: str) -> None:
    assert told(program(angles, comment)) == []


@pytest.mark.parametrize(
    ("angles", "wrong", "comment", "needed"),
    [
        (["0.", "120.", "220."], 2, "3 SLOTS 8 WIDE", "C240."),
        (["1.", "120.", "240."], 0, "3 SLOTS", "C0."),
        (["0.", "90.", "190.", "270."], 2, "SLOTS", "C180."),
        (["0.", "90.", "180.", "300."], 3, "4 SLOTS", "C270."),
        (["0.", "60.", "120.", "180.", "204.", "300."], 4, "SLOTS", "C240."),
        (["15.", "105.", "159.", "285."], 2, "SLOTS", "C195."),
    ],
)
def test_the_one_angle_off_an_even_division_is_told(angles: list[str], wrong: int, comment: str, needed: str) -> None:
    assert told(program(angles, comment)) == [(f"G0 C{angles[wrong]}", needed)]


@pytest.mark.parametrize("without", range(4))
def test_an_angle_at_which_nothing_is_cut_is_told(without: int) -> None:
    angles = ["0.", "90.", "180.", "270."]
    assert told(program(angles, without=without)) == [(f"G0 C{angles[without]}", "")]


@pytest.mark.parametrize(("without", "comment"), [(0, "3 SLOTS"), (1, "SLOTS"), (2, "SLOTS")])
def test_an_angle_of_three_at_which_nothing_is_cut_is_told(without: int, comment: str) -> None:
    angles = ["0.", "120.", "240."]
    assert told(program(angles, comment, without)) == [(f"G0 C{angles[without]}", "")]


def test_an_angle_at_which_nothing_is_cut_may_be_the_way_home() -> None:
    assert told(program(["0.", "120.", "240."], without=0)) == []
    assert told(program(["0.", "90.", "180."], without=2)) == []
    angles = ["0.", "120.", "240.", "0."]
    assert told(program(angles, without=3)) == []
    assert told(program(["0.", "90.", "180.", "45."], without=3)) == []
