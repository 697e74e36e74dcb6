"""What programs from outside have around the mode: speeds by the number of a spindle, and codes that engage C."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said

CONTOUR = "G42 X30. F200\nC10.\nX-30.\nC-10.\nX30.\nC0\nG40 X60.\n"
MITSUBISHI = "O1\nG94 G40 G90\n{spindle}\nG28 H0\nG0 X60. Z1. C0 T0808\nG12.1\nG1 " + CONTOUR + "G13.1\nM30\n"
FAGOR = "G90 G94\nT8 D8\nM45 S500\nG0 X100 Z5\n{before}G0 X60 C0\nG1 " + CONTOUR + "G18\nM50\nM30\n"
MAZAK = "O1\nG94\nG0 X100. Z5. T0808\n{engages}G0 X60. C0\n{tool}G12.1\nG1 " + CONTOUR + "G13.1\nM30\n"


@pytest.mark.ci
@looped("spindle", ["M83 S3=2000", "S3=2000\nM83", "G97 M83 S2 = 2000", "M83 S4=[1000+500]", "#100=2000\nM83 S3=#100"])
def test_a_speed_by_the_number_of_a_spindle_is_read_on_a_mitsubishi(spindle: str) -> None:
    report = report_of(MITSUBISHI.format(spindle=spindle), "mitsubishi-m700", "8:radius=4,nose=0")
    assert (report.verdict, said(report), [one for one in report.not_evaluated if one.matters]) == ("pass", [], [])


@looped("spindle", ["M83 S9=2000", "M83 R3=2000"])
def test_a_spindle_that_it_cannot_have_is_not(spindle: str) -> None:
    report = report_of(MITSUBISHI.format(spindle=spindle), "mitsubishi-m700", "8:radius=4,nose=0")
    assert report.verdict == "unverified"


@pytest.mark.ci
@looped(
    ("before", "rule"),
    [
        ("G15\nG16 XC\n", ""),
        ("G16 XC\n", "c-axis-not-engaged"),
        ("G15\n", "contour-outside-polar-mode"),
        ("", "contour-outside-polar-mode"),
    ],
)
def test_a_fagor_needs_g15_and_g16(before: str, rule: str) -> None:
    report = report_of(FAGOR.format(before=before), "fagor-8055t", "8:radius=4,nose=0")
    assert [one.rule for one in report.findings] == [rule] * bool(rule)


def test_an_excerpt_may_have_had_it_before() -> None:
    excerpt = FAGOR.format(before="G16 XC\n").replace("M30\n", "").replace("T8 D8\n", "")
    assert "c-axis-not-engaged" not in [rule for _, rule in said(report_of(excerpt, "fagor-8055t", "8:radius=4"))]


@pytest.mark.nightly
@looped(
    ("machine", "tool"), [("mazak-eia", ""), ("mazak-quick-turn", "M203 S2000\n"), ("mazak-integrex", "M3 S2000\n")]
)
def test_a_mazak_without_m200_is_warned_of(machine: str, tool: str) -> None:
    found = report_of(MAZAK.format(engages="", tool=tool), machine, "8:radius=4").findings
    assert [one.severity for one in found if one.rule == "c-axis-not-engaged"] == ["warning"]
    found = report_of(MAZAK.format(engages="M200\n", tool=tool), machine, "8:radius=4").findings
    assert "c-axis-not-engaged" not in [one.rule for one in found]
