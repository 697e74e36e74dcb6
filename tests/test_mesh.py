"""Contours of blocks so short that the rounding of their ends turns them: one finding, and none for sound ones."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of

from polarcheck.foundation.finding import Finding

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X150. Z2. C0\nG12.1\n"


def circle(radius: float, blocks: int, decimals: int = 3) -> list[str]:
    """Counterclockwise from X on, as a post rounds it."""
    points = radius * np.exp(2j * np.pi * np.arange(blocks + 1) / blocks)
    return [f"X{2 * point.real:.{decimals}f} C{point.imag:.{decimals}f}" for point in points]


def program(contour: list[str], x: float, side: str = "G42", head: str = HEAD) -> str:
    first, *others = contour
    blocks = "\n".join(others)
    return f"{head}G1 X{float(x)} C0. F500.\n{side} {first} F200.\n{blocks}\nG40 X{float(x)} C0.\nG13.1\nM30\n"


def interferences(text: str, tool: str, machine: str = "fanuc") -> list[Finding]:
    report = report_of(text, machine, tool)
    assert {finding.rule for finding in report.findings} <= {"interference"}, said(report)
    return report.findings


@pytest.mark.ci
@looped("machine", ["fanuc", "fanuc-30i", "gsk-988", "siemens-iso"], one_in=4)
def test_a_mesh_is_one_finding_with_its_count(machine: str) -> None:
    [finding] = interferences(program(circle(10, 4000), 60), "1:radius=5", machine)
    assert finding.count > 500
    assert "shorter than their rounding allows" in finding.message
    assert f"this one and {finding.count - 1} more" in finding.message
    assert "coarser chord tolerance" in finding.message


@pytest.mark.nightly
@looped(("radius", "blocks", "tool"), [(10, 4000, 1), (10, 4000, 16), (5, 1000, 5), (40, 4000, 16)], one_in=3)
def test_of_any_size(radius: float, blocks: int, tool: float) -> None:
    [finding] = interferences(program(circle(radius, blocks), 140), f"1:radius={tool}")
    assert finding.count > 30
    assert finding.severity == "error"


@pytest.mark.nightly
def test_a_mesh_in_inch_and_on_the_inner_side() -> None:
    inch = HEAD.replace("G21", "G20").replace("X150. Z2.", "X6. Z.1")
    [finding] = interferences(program(circle(0.4, 4000, 4), 2.4, head=inch), "1:radius=.2")
    assert finding.count > 100
    [finding] = interferences(program(circle(10, 1000), 0.5, "G41"), "1:radius=8")
    assert finding.count > 100


@pytest.mark.ci
def test_a_mesh_that_is_coarse_enough_is_none() -> None:
    assert interferences(program(circle(10, 500), 60), "1:radius=5") == []
    assert interferences(program(circle(10, 2000, 5), 60), "1:radius=5") == []


@pytest.mark.ci
def test_a_true_reversal_beside_a_mesh_is_its_own() -> None:
    """A groove narrower than the cutter in the way out of the mesh."""
    contour = [*circle(10, 4000)[:1001], "X-10. C10.", "X-10. C7.", "X-16. C7.", "X-16. C10.", "X-60. C10.", "X-80."]
    findings = interferences(program(contour, 60).replace("G40 X60.0 C0.", "G40 C30."), "1:radius=5")
    assert sorted("too narrow" in finding.message for finding in findings) == [False, True]


def test_a_meshed_arc_too_narrow_for_the_cutter_is_narrow() -> None:
    """Its blocks are reversed by its radius, not by their rounding, though they are short."""
    for blocks, tool in ((200, 15), (1000, 16)):
        tables = tables_of(program(circle(10, blocks), 0.5, "G41"), "fanuc", f"1:radius={tool}")
        tool_center, ramps = tables["tool_center"], tables["ramps"]
        assert np.mean(tool_center.interferes_by_rounding[tool_center.interferes]) < 0.05
        assert np.sum(tool_center.interferes & ~tool_center.interferes_by_rounding & ~ramps.is_consequence) == 1


def test_a_spur_is_no_rounding() -> None:
    """Back along the same line: the ends lie in a strip of no width, and the tool runs back nevertheless."""
    contour = ["X40. C0.", "C10.001", "C10.003", "C4.", "C10.003", "C20.", "X-40."]
    tables = tables_of(program(contour, 60), "fanuc", "1:radius=5")
    kept = tables["tool_center"].stretch
    rows = np.flatnonzero(tables["trace"].path.travels)
    assert len(np.unique(kept[rows])) >= len(rows) - 1
