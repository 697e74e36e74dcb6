"""A coordinate without a decimal point is told wherever it stands in a program with polar sections, once."""

from __future__ import annotations

import itertools
import re

import pytest
from cases import looped
from hexagon_program import CUTTER, hexagon
from programs import report_of

#: Controls that read least increments.
CONTROLS = ("fanuc-30i", "mazak-eia", "doosan")
#: What is changed; the word that is named; and how many more there are.
LOST = {
    "Z alone before the section": (("G12.1/", "G1 Z-15 F400/G12.1/"), "Z-15", 0),
    "the approach": (("G12.1/", "G0 Z2/G12.1/"), "Z2", 0),
    "the retract": (("X100. Z50.", "X100 Z50"), "X100", 1),
    "approach and retract": (("G12.1/", "G0 Z2/G12.1/"), "Z2", 2),
    "a corner of the contour and the retract": (("C20.785", "C20785"), "C20785", 2),
}
SILENT = {
    "a dwell": ("G28 H0", "G4 P1000/G28 H0"),
    "a dwell by X": ("G28 H0", "G4 X2/G28 H0"),
    "zeros": ("Z2. C0", "Z0 C0"),
    "block numbers": ("G12.1/G1", "N10 G12.1/N20 G1"),
}


@pytest.mark.nightly
@looped(("control", "name"), [*itertools.product(CONTROLS, LOST)])
def test_each_is_looked_at_and_they_are_one_finding(control: str, name: str) -> None:
    change, word, more = LOST[name]
    changes = [change, ("X100. Z50.", "X100 Z50")] if more == 2 else [change]
    found = [
        finding for finding in report_of(hexagon(*changes), control, CUTTER).findings if finding.severity != "note"
    ]
    assert [finding.rule for finding in found] == ["number-without-point"]
    assert found[0].message.startswith(f"{word} has no decimal point")
    assert ("more number" in found[0].message) == (more > 0)
    assert found[0].values["count"] == 1 + more


@pytest.mark.nightly
@looped(("control", "name"), [*itertools.product(CONTROLS, SILENT)])
def test_what_needs_no_point_is_silent(control: str, name: str) -> None:
    report = report_of(hexagon(SILENT[name]), control, CUTTER)
    assert [finding.rule for finding in report.findings if finding.severity != "note"] == []


def test_whole_millimeters_need_no_point() -> None:
    report = report_of(hexagon(("X100. Z50.", "X100 Z50")), CONTROLS[0], CUTTER, changes=WHOLE)
    assert [finding.rule for finding in report.findings] == []


WHOLE = {"control": {"number_without_point": "whole-unit"}}


def counting(step: float) -> str:
    """The hexagon in counts of a step [mm], without a decimal point."""
    return re.sub(r"(?<=[XZC])-?\d+\.\d*", lambda number: f"{float(number[0]) / step:.0f}", hexagon())


@pytest.mark.nightly
@looped("control", ["gsk-988", "fanuc-30i", "mazak-eia"])
def test_a_contour_of_meters_names_the_unit_that_makes_it_small(control: str) -> None:
    """56 mm in counts of 1 um or of 10 um; in whole millimeters, with or without points, nothing is said."""
    for step, size in ((0.001, "in units of 1 um it is 56 mm"), (0.01, "in units of 10 um it is 56 mm")):
        report = report_of(counting(step), control, CUTTER, changes=WHOLE)
        told = [finding.message for finding in report.findings if finding.rule == "number-without-point"]
        assert len(told) == 1
        assert size in told[0]
        assert "feed-implausible" not in {finding.rule for finding in report.findings}
    for plain in (hexagon(), counting(1.0)):
        report = report_of(plain, control, CUTTER, changes=WHOLE)
        assert "number-without-point" not in {finding.rule for finding in report.findings}
