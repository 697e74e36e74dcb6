"""
Rounds of a drawing: turned where no cut runs along them, milled whole where one does.

CUT is a circle of 40, of which an arc is milled; FLATS two flats 30 apart on a round of 40, and METHOD_B those of the
builder's guide, whose arc from one to the other runs outside of the round.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from typing import Any

import guide_programs
import msgspec
import pytest
from cases import looped
from programs import job_of, report_of, tables_of

from polarcheck.foundation.finding import FileReport
from polarcheck.geometry.comparison.measured_path import path_of_curves
from polarcheck.geometry.comparison.rounds import round_pieces
from polarcheck.program.machines.part_keys import DrawnPart
from polarcheck.reports.made_parts.compared_contours import compared

RULE = "part-differs-from-drawing"
Curve = tuple[complex, ...]
CUT = "T0808\nG0 X60. Z2. C0\nG12.1\nG1 G98 G42 X40. C0 F200\nZ-5.\n{arc}\nG1 G40 X{out}60.\nG13.1\n"
HALF, BIT, WHOLE = (
    CUT.format(arc=arc, out=out)
    for arc, out in (
        ("G3 X-40. C0 I-20. J0", "-"),
        ("G3 X39.9280 C1.1993 I-20. J0", ""),
        ("G3 X-40. C0 I-20. J0\nX40. C0 I20. J0", ""),
    )
)
WALL = "G12.1\nG1 G98 C-30. F500\nG42 X30. C-25. F200\nZ-5.\nC{end}\n{then}G40 X{out}60. C30.\nZ2.\nG13.1\n"
FLAT = WALL.format(end="25.", then="", out="")
FLATS = f"T0808\nG0 X60. Z2. C0\n{FLAT}G0 C180.\n{FLAT}"
ARC = "G3 X-30. C13.2288 R20.\nG1 C10.\n"
WITH_ARC = f"T0808\nG0 X60. Z2. C0\n{WALL.format(end='13.2288', then=ARC, out='-')}G0 C180.\n{FLAT}"
SHARE = "G3 X20. C17.3205 R20.\nG1 "
WITH_SHARE = f"T0808\nG0 X60. Z2. C0\n{WALL.format(end='13.2288', then=SHARE, out='')}G0 C180.\n{FLAT}"


def ring(radius: Callable[[float], float], count: int) -> Curve:
    points = [cmath.rect(radius(math.tau * number / count), math.tau * number / count) for number in range(count)]
    return (*points, points[0])


def cubic(start: float, sweep: float, radius: float = 20) -> Curve:
    """An arc as one cubic curve, as CAD writes circles: 0.027 % off for a quarter."""
    handle = 4 / 3 * math.tan(sweep / 4)
    first, last = cmath.rect(1, start), cmath.rect(1, start + sweep)
    poles = (first, first * (1 + 1j * handle), last * (1 - 1j * handle), last)
    shares = [number / 200 for number in range(201)]
    weights = [((1 - t) ** 3, 3 * t * (1 - t) ** 2, 3 * t**2 * (1 - t), t**3) for t in shares]
    return tuple(radius * sum(weight * pole for weight, pole in zip(row, poles, strict=True)) for row in weights)


def cubics(count: int) -> Curve:
    sweep = math.tau / count
    points = [point for number in range(count) for point in cubic(number * sweep, sweep)[:-1]]
    return (*points, points[0])


def rippled(by: float) -> Curve:
    return ring(lambda angle: 20 + by * math.cos(3 * angle), 360)


CIRCLES = {
    "circle": ring(lambda _: 20, 700),
    "four splines": cubics(4),
    "two splines": cubics(2),
    "polyline": ring(lambda _: 20, 72),
    "ripple 0.001": rippled(0.001),
    "ripple 0.004": rippled(0.004),
    "ripple 0.015": rippled(0.015),
}


def flats(half: float, radius: float, arc: Callable[[float, float], Curve] | None = None) -> Curve:
    """Two flats on a round, as one ring."""
    corner, half_angle = math.sqrt(radius**2 - half**2), math.acos(half / radius)
    sweep = math.pi - 2 * half_angle
    chords = [number / 300 for number in range(301)]
    plain = lambda start, sweep: tuple(cmath.rect(radius, start + sweep * share) for share in chords)  # noqa: E731
    upper, lower = ((arc or plain)(half_angle + turn, sweep) for turn in (0, math.pi))
    points = [complex(half, -corner), *upper, *lower]
    return (*points, points[0])


def report(
    text: str, curve: Curve, stock: float | None, *tools: str, units: str = "mm", scale: float = 1
) -> FileReport:
    return report_of(text, "fanuc-30i", *(tools or ("8:radius=4",)), job=drawn(curve, stock, units, scale), only=[RULE])


def drawn(curve: Curve, stock: float | None, units: str = "mm", scale: float = 1) -> Any:
    table: dict[str, Any] = {"units": units, **({"stock": {"diameter": stock}} if stock else {})}
    return msgspec.structs.replace(job_of(job=table), part=[DrawnPart(drawing="a.dxf", curves=(curve,), scale=scale)])


def outcome(found: FileReport) -> str:
    reasons = " ".join(entry.reason for entry in found.not_evaluated if entry.rule == RULE)
    return "error" if found.findings else (reasons or "pass")


@pytest.mark.nightly
@looped("name", list(CIRCLES))
@looped("stock", [None, 50.0, 42.0])
@looped("text", [HALF, BIT], ids=["half", "bit"])
def test_a_share_of_a_circle_is_no_circle(name: str, stock: float | None, text: str) -> None:
    assert outcome(report(text, CIRCLES[name], stock)) != "pass"


@pytest.mark.nightly
@looped("name", ["circle", "four splines", "ripple 0.015"])
def test_nor_is_it_on_a_bar_of_that_size(name: str) -> None:
    for text in (HALF, BIT):
        assert "of the round of a.dxf a part is milled" in outcome(report(text, CIRCLES[name], 40.0))


@pytest.mark.nightly
@looped("name", [name for name in CIRCLES if name != "two splines"], one_in=3)
@looped("stock", [None, 50.0])
def test_a_whole_circle_agrees_with_what_is_nearly_one(name: str, stock: float | None) -> None:
    assert outcome(report(WHOLE, CIRCLES[name], stock)) == "pass"


@pytest.mark.ci
def test_a_circle_of_two_splines_is_too_large() -> None:
    """Between its ends it bulges by 1.84 %."""
    (finding,) = report(WHOLE, CIRCLES["two splines"], None).findings
    bulge = max(abs(point) for point in CIRCLES["two splines"]) - 20
    assert finding.values["largest"] == pytest.approx(bulge, abs=2e-3)
    assert bulge == pytest.approx(0.367, abs=1e-3)


@pytest.mark.nightly
@looped("size", [20.05, 20.5, 24.0])
def test_a_curve_that_lies_beyond_the_bar_is_compared_with_nothing(size: float) -> None:
    """It touches the bar where splines meet; with more of the drawing within the bar, that is compared."""
    outside = ring(lambda angle: 20 + (size - 20) * math.sin(angle) ** 4, 720)
    centers = (text.replace("G42 ", "").replace("40.", "48.") for text in (WHOLE, BIT))
    paths = (text.replace("39.9280 C1.1993", "47.9136 C1.4392").replace("20. J0", "24. J0") for text in centers)
    for text in (WHOLE, BIT, *paths):
        assert "a.dxf lies beyond the bar" in outcome(report(text, outside, 40.0))
    assert "beyond" not in outcome(report(FLATS, flats(15, 20.5), 40.0))


@pytest.mark.nightly
@looped("arc", [None, cubic], ids=["arcs", "splines"])
@looped("stock", [None, 40.0, 50.0])
@looped("text", [FLATS, WITH_ARC], ids=["flats", "with an arc"])
def test_a_round_that_no_cut_touches_is_turned(text: str, stock: float | None, arc: Any) -> None:
    curve = flats(15, 20, arc)
    assert outcome(report(text, curve, stock)) == "pass"
    (told,) = {entry.text for entry in compared(tables_of(text, "fanuc-30i", "8:radius=4", job=drawn(curve, stock)))}
    assert "its round of 40.0" in told
    assert "is not milled" in told


@pytest.mark.nightly
@looped(("stock", "expected"), [(None, "a part is milled"), (40.0, "a part is milled"), (50.0, "error")])
def test_an_arc_between_two_walls_is_milled_whole(stock: float | None, expected: str) -> None:
    assert expected in outcome(report(WITH_SHARE, flats(15, 20), stock))


@pytest.mark.nightly
@looped(("stock", "expected"), [(None, "runs outside"), (1.25, "pass"), (1.29, "pass"), (1.4, "runs outside")])
@looped("unit", ["inch", "mm"])
def test_an_arc_outside_of_the_round_is_in_air_where_the_bar_shows_it(
    stock: float | None, expected: str, unit: str
) -> None:
    text, scale = guide_programs.METHOD_B.replace("G40 G13.1", "G20\nG40 G13.1"), 1.0
    if unit == "mm":
        text, scale = guide_programs.in_mm(guide_programs.METHOD_B), 25.4
    tools = (f"1:radius={0.25 * scale}", "1:nose=0")
    bar = stock * scale if stock else None
    found = report(text, flats(0.5, 0.625), bar, *tools, units=unit, scale=25.4)
    assert expected in outcome(found)


@looped("radius", [1.0, 2.0, 3.0])
def test_the_top_of_a_rounded_corner_is_no_round(radius: float) -> None:
    """Of a hexagon with rounded corners; a hexagon on a round has arcs about the axis."""
    middle, points = (15 - radius) / math.cos(math.pi / 6), []
    for corner in range(6):
        turn = math.pi / 6 + corner * math.pi / 3
        points += [
            cmath.rect(middle, turn) + cmath.rect(radius, turn + share * math.pi / 600) for share in range(-100, 101)
        ]
    import numpy as np

    def pieces(points: list[complex]) -> Any:
        return round_pieces(path_of_curves([np.array([*points, points[0]])]), 0.02)

    assert (pieces(points) < 0).all()
    half = math.pi / 6 - math.acos(15 / 16.5)
    on_round = [
        cmath.rect(16.5, math.pi / 6 + corner * math.pi / 3 + share * half / 40)
        for corner in range(6)
        for share in range(-40, 41)
    ]
    assert len(set(pieces(on_round)[pieces(on_round) >= 0].tolist())) == 6
