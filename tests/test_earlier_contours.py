"""Two tools on one part: what an earlier section takes off a polygon that a later one finishes."""

from __future__ import annotations

import cmath
import math

import pytest
from programs import report_of


def section(tool: int, sides: int, across: float, c: float = 0, z: float = -6, *, inch: bool = False) -> str:
    """A boss of so many sides, run with G41 from a lead on the extension of its first side."""
    corners = [cmath.rect(across / 2 / math.cos(math.pi / sides), -math.tau * k / sides) for k in range(sides)]
    along = (corners[1] - corners[0]) / abs(corners[1] - corners[0])
    unit = 25.4 if inch else 1.0
    begin, *rest = [
        f"X{2 * point.real / unit:.5f} C{point.imag / unit:.5f}"
        for point in [corners[0] - 14 * along, *corners[1:], corners[0]]
    ]
    wide, high, deep = (f"{value / unit:.5f}" for value in (60, 2, z))
    call = f"T0{tool}0{tool}\nG97 S2000 M13\nG0 X{wide} C{c} Z{high}\nG12.1"
    retract = f"G1 Z{high}\nG40 X{wide} C0\nG13.1\nG0 Z50."
    return "\n".join([call, f"G1 G41 {begin} F{500 / unit:.2f}", f"Z{deep}", *rest, retract])


def losses(*sections: str, unit: int = 21) -> list[float]:
    program = "\n".join(["O1", f"G{unit} G98", "G28 H0", *sections, "M30"])
    radii = (4 / 25.4, 3 / 25.4) if unit == 20 else (4, 3)
    tools = (f"{number}:radius={radius:.5f},nose=0" for number, radius in enumerate(radii, 1))
    report = report_of(f"{program}\n", "fanuc-30i", *tools)
    return [finding.values["depth"] for finding in report.findings if finding.rule == "contour-already-cut-into"]


@pytest.mark.parametrize("inch", [False, True])
@pytest.mark.parametrize(
    ("rough", "finish", "loss"),
    [
        ((6, 28.0, 0), (6, 27.0, 30), 27 / math.sqrt(3) - 14),
        ((6, 28.0, 0), (6, 27.0, 15), 27 / math.sqrt(3) * math.cos(math.radians(15)) - 14),
        ((6, 28.0, 0), (6, 27.0, -15), 27 / math.sqrt(3) * math.cos(math.radians(15)) - 14),
        ((6, 28.0, 0), (6, 27.0, 45), 27 / math.sqrt(3) * math.cos(math.radians(15)) - 14),
        ((6, 26.0, 0), (6, 28.0, 0), 1.0),
        ((6, 26.0, 0), (6, 28.0, 60), 1.0),
        ((4, 24.0, 0), (4, 23.0, 45), 11.5 * math.sqrt(2) - 12),
        ((4, 21.0, 0), (4, 22.0, 90), 0.5),
        ((8, 26.0, 0), (8, 25.6, 22.5), 12.8 / math.cos(math.pi / 8) - 13),
        ((6, 27.0, 0), (6, 27.0, 10), 27 / math.sqrt(3) * math.cos(math.radians(20)) - 13.5),
    ],
)
def test_what_an_earlier_tool_took_is_told(
    rough: tuple[int, float, float], finish: tuple[int, float, float], loss: float, inch: bool
) -> None:
    first, second = (section(tool, *size, inch=inch) for tool, size in ((1, rough), (2, finish)))
    assert losses(first, second, unit=20 if inch else 21) == [pytest.approx(loss, abs=0.002)]


@pytest.mark.parametrize(
    ("rough", "finish"),
    [
        ((6, 28.0, 0, -6), (6, 27.0, 0, -6)),
        ((6, 28.0, 0, -6), (6, 27.0, 60, -6)),
        ((4, 24.0, 0, -6), (4, 23.0, 90, -6)),
        ((4, 24.0, 0, -6), (4, 23.0, -180, -6)),
        ((6, 27.0, 0, -6), (6, 27.0, 0, -6)),
        # Chamfers, of another depth and of the same one; a step; twice as many sides.
        ((6, 27.0, 0, -6), (6, 26.0, 30, -1)),
        ((4, 24.0, 0, -6), (4, 30.0, 45, -6)),
        ((4, 30.0, 45, -6), (4, 24.0, 0, -6)),
        ((6, 26.0, 0, -4), (6, 28.0, 0, -9)),
        ((6, 27.0, 0, -6), (6, 27.0, 30, -6)),
        # Another shape, and another part of the workpiece.
        ((4, 24.0, 0, -6), (6, 26.0, 0, -6)),
        ((6, 18.0, 0, -6), (6, 28.0, 0, -6)),
    ],
)
def test_roughing_chamfers_and_steps_are_sound(
    rough: tuple[int, float, float, float], finish: tuple[int, float, float, float]
) -> None:
    assert losses(section(1, *rough), section(2, *finish)) == []


def test_a_face_that_is_turned_between_begins_another_part() -> None:
    turning = "T0303\nG97 S1500 M3\nG0 X60. Z-10.\nG99 G1 X-1. F.15\nG0 X60. Z50.\nG98 M5"
    assert losses(section(1, 6, 26.0), section(2, 6, 28.0)) == [pytest.approx(1)]
    assert losses(section(1, 6, 26.0), turning, section(2, 6, 28.0)) == []
