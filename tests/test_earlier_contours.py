"""Two tools on one part: what an earlier section takes off a contour that a later one finishes."""

from __future__ import annotations

import cmath
import math
from typing import NamedTuple

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


def losses(*sections: str, unit: int = 21, bar: float | None = None) -> list[float]:
    program = "\n".join(["O1", f"G{unit} G98", "G28 H0", *sections, "M30"])
    radii = (4 / 25.4, 3 / 25.4) if unit == 20 else (4, 3)
    tools = (f"{number}:radius={radius:.5f},nose=0" for number, radius in enumerate(radii, 1))
    job = {"stock": {"diameter": bar}} if bar else {}
    report = report_of(f"{program}\n", "fanuc-30i", *tools, job=job)
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


@pytest.mark.ci
def test_a_face_that_is_turned_between_begins_another_part() -> None:
    turning = "T0303\nG97 S1500 M3\nG0 X60. Z-10.\nG99 G1 X-1. F.15\nG0 X60. Z50.\nG98 M5"
    assert losses(section(1, 6, 26.0), section(2, 6, 28.0)) == [pytest.approx(1)]
    assert losses(section(1, 6, 26.0), turning, section(2, 6, 28.0)) == []


# ---- any closed contour ----


class Loop(NamedTuple):
    """A closed contour: corners in a row, counterclockwise; rounded by a radius [mm]."""

    corners: list[complex]
    radius: float = 0.0
    inside: bool = False


def rectangle(length: float, width: float, radius: float = 0.0, *, inside: bool = False, at: complex = 0) -> Loop:
    x, c = length / 2, width / 2
    return Loop([at + x - 1j * c, at + x + 1j * c, at - x + 1j * c, at - x - 1j * c], radius, inside)


def circle(diameter: float, *, inside: bool = False, at: complex = 0) -> Loop:
    """A circle is a square whose corners meet."""
    return rectangle(diameter, diameter, diameter / 2, inside=inside, at=at)


def milled(tool: int, loop: Loop, c: float = 0, z: float = -6) -> str:
    """A section with a lead to the middle of the last side; a boss is run clockwise, a pocket the other way."""
    order = loop.corners if loop.inside else [*reversed(loop.corners)]
    code, center = ("G3", sum(loop.corners) / len(order)) if loop.inside else ("G2", 0)
    blocks = []
    for number, corner in enumerate(order):
        first, last = (
            corner + (beside - corner) / abs(beside - corner) * loop.radius
            for beside in (order[number - 1], order[(number + 1) % len(order)])
        )
        blocks.append(f"G1 X{2 * first.real:.4f} C{first.imag:.4f}")
        if loop.radius:
            blocks.append(f"{code} X{2 * last.real:.4f} C{last.imag:.4f} R{loop.radius:.4f}")
    middle = (order[-1] + order[0]) / 2
    ahead = (order[0] - order[-1]) / abs(order[0] - order[-1])
    start = center + 1 if loop.inside else middle + 9j * ahead - 9 * ahead
    begin, touch = (f"X{2 * point.real:.4f} C{point.imag:.4f}" for point in (start, middle))
    approach = f"T0{tool}0{tool}\nG97 S2000 M13\nG0 X80. C{c} Z2.\nG12.1\nG1 {begin} F900\nZ{z:.1f} F200"
    retract = f"G40 {begin}\nZ2.\nG1 X80. C0 F1500\nG13.1\nG0 Z50."
    return "\n".join([approach, f"G41 {touch} F400", *blocks, f"G1 {touch}", retract])


def pocket(length: float, width: float, radius: float = 6.0) -> Loop:
    return rectangle(length, width, radius, inside=True)


@pytest.mark.nightly
@pytest.mark.one_in(3)
@pytest.mark.parametrize(
    ("rough", "finish", "c", "loss"),
    [
        (rectangle(29, 19), rectangle(30, 20), 0, 0.5),
        (rectangle(30.6, 20.6), rectangle(30, 20), 90, 4.7),
        (rectangle(29, 19, 3), rectangle(30, 20, 3), 180, 0.5),
        (circle(26), circle(26.4), 0, 0.2),
        (circle(26.4, inside=True), circle(26, inside=True), 0, 0.2),
        (pocket(30.6, 20.6), pocket(30, 20), 0, 0.3),
        # One wall of the roughing is 1.3 mm nearer than the others.
        (Loop([15.3 - 10.3j, 15.3 + 10.3j, -14 + 10.3j, -14 - 10.3j]), rectangle(30, 20), 0, 1.0),
    ],
)
def test_a_wall_that_is_gone_is_told(rough: Loop, finish: Loop, c: float, loss: float) -> None:
    assert losses(milled(1, rough), milled(2, finish, c)) == [pytest.approx(loss, abs=0.005)]


@pytest.mark.nightly
def test_a_contour_of_another_shape_in_what_is_cleared_is_told() -> None:
    hexagon = section(1, 6, 24.0)
    assert losses(hexagon, milled(2, circle(28))) == [pytest.approx(14 - 12 / math.cos(math.pi / 6), abs=0.005)]
    assert losses(hexagon, milled(2, circle(28), z=-6.8)) == []


@pytest.mark.nightly
def test_an_eccentric_contour_at_another_c_is_told() -> None:
    """Its points turn about X0: one that lies 14 mm off it by 14 * 5 deg, of which 0.2 mm were left."""
    loss = 2 * 8 * math.sin(math.radians(2.5)) - 0.2
    assert losses(milled(1, circle(12.4, at=8)), milled(2, circle(12, at=8), 5)) == [pytest.approx(loss, abs=0.005)]
    assert losses(milled(1, circle(12.4, at=8)), milled(2, circle(12, at=8))) == []


@pytest.mark.parametrize(
    "sections",
    [
        [milled(1, rectangle(30.6, 20.6)), milled(2, rectangle(30, 20), 180)],
        [milled(1, circle(26.4)), milled(2, circle(26), 40)],
        [milled(1, circle(28)), section(2, 6, 27.0)],
        [section(1, 6, 27.0), milled(2, circle(28))],
        [milled(1, pocket(30, 20)), milled(2, pocket(30.6, 20.6))],
        # Clearing on, inward and outward.
        [milled(1, circle(size, inside=True)) for size in (40, 30, 20)],
        [milled(1, circle(size)) for size in (30, 36, 42)],
        # Slots that cross, and pins beside each other.
        [
            milled(tool, pocket(30 + size, 9 + size, 4.45 + size / 2), c)
            for tool, size in ((1, 0), (2, 0.3))
            for c in (0, 90)
        ],
        [milled(1 + (c > 0), circle(12, at=14), c) for c in (0, 120, 240)],
        # A step, a groove above, and a floor that is finished beside its wall.
        [milled(1, rectangle(29, 19), z=-4), milled(2, rectangle(30, 20))],
        [milled(1, rectangle(29, 19), z=-9), milled(2, rectangle(30, 20))],
        [section(1, 6, 26.4, z=-5.8), section(2, 6, 26.6), section(2, 6, 26.0)],
        [section(1, 6, 26.4, z=-5.8), section(2, 6, 26.6)],
    ],
)
def test_allowances_clearing_and_steps_are_sound(sections: list[str]) -> None:
    assert losses(*sections) == []


@pytest.mark.ci
def test_where_the_bar_is_as_large_as_the_contour_nothing_can_be_lost() -> None:
    assert losses(milled(1, circle(37)), milled(2, circle(36)), bar=36) == []
    assert losses(milled(1, circle(35)), milled(2, circle(35.6)), bar=36) == [pytest.approx(0.3, abs=0.005)]


def test_an_allowance_in_z_is_one_floor_and_an_unknown_radius_is_not_evaluated() -> None:
    rough, finish = milled(1, rectangle(29, 19), z=-5.6), milled(2, rectangle(30, 20))
    assert losses(rough, finish) == [pytest.approx(0.5)]
    program = "\n".join(["O1", "G21 G98", "G28 H0", rough.replace("T0101", "T0303"), finish, "M30"])
    report = report_of(f"{program}\n", "fanuc-30i", "2:radius=3,nose=0")
    assert "contour-already-cut-into" in [entry.rule for entry in report.not_evaluated]
