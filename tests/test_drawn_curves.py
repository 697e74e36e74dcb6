"""Curves of drawings as CAD writes them: those without length, splines that are not clamped, spline frames, units."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cases import looped
from polarcheck.errors import JobError
from programs import job_of, report_of
from test_drawing import Draw, area, curves, written

from polarcheck.program.machines import drawing_file
from polarcheck.program.machines.job import Job

SQUARE = [(10, -10), (10, 10), (-10, 10), (-10, -10)]
RULE = "part-differs-from-drawing"


def length(curve: np.ndarray[Any, Any]) -> float:
    return float(np.abs(np.diff(curve)).sum())


def circle(space: Any) -> None:
    space.add_circle((0, 0), 20)


@pytest.mark.ci
@looped(
    "draw",
    [
        lambda space: space.add_line((1, 1), (1, 1)),
        lambda space: space.add_line((1, 1, 0), (1, 1, 5)),
        lambda space: space.add_open_spline([(1, 1)] * 4),
        lambda space: space.add_spline([(1, 1)] * 4),
        lambda space: space.add_circle((5, 0), 1e-9),
        lambda space: space.add_arc((5, 0), 0, 10, 80),
        lambda space: space.add_lwpolyline([(3, 3), (3, 3)], close=True),
        lambda space: space.add_ellipse((5, 0), (1e-9, 0), 1e-6),
    ],
)
def test_a_curve_without_length_is_passed_over(tmp_path: Path, draw: Draw) -> None:
    with pytest.raises(JobError) as refused:
        drawing_file.read_drawing(written(tmp_path / "a.dxf", draw), "a.dxf")
    assert str(refused.value).startswith("a.dxf: shows no line, arc or curve of a part")
    beside = written(tmp_path / "b.dxf", lambda space: (draw(space), circle(space)))
    (curve,) = curves(beside)
    assert area(curve) == pytest.approx(math.pi * 400, abs=0.1)


@looped("version", ["R12", "R2010"])
def test_a_closed_polyline_may_repeat_its_first_vertex(tmp_path: Path, version: str) -> None:
    def draw(space: Any) -> None:
        polyline = space.add_polyline2d if version == "R12" else space.add_lwpolyline
        polyline([*SQUARE, SQUARE[0]], close=True)

    (curve,) = curves(written(tmp_path / "a.dxf", draw, version))
    assert curve.tolist() == [complex(*corner) for corner in [*SQUARE, SQUARE[0]]]


@pytest.mark.nightly
@looped(("major", "ratio"), [("1e-9", "1e-6"), ("0.0", "1.0"), ("7.25", "0.0"), ("7.25", "1e-9")])
def test_an_ellipse_with_an_axis_of_no_length_is_named(tmp_path: Path, major: str, ratio: str) -> None:
    path = written(tmp_path / "a.dxf", lambda space: (circle(space), space.add_ellipse((5, 0), (7.25, 0), 0.625)))
    path.write_text(path.read_text().replace("\n7.25\n", f"\n{major}\n").replace("\n0.625\n", f"\n{ratio}\n"))
    part = drawing_file.part_of(path, "a.dxf")
    assert len(part.curves) == 1
    assert part.passed_over == "1 ELLIPSE with an axis of no length"
    job = Job(part=[part])
    text = "T0101\nG0 X60. Z2. C0\nG12.1\nG1 G98 G42 X40. C0 F200\nZ-5.\n"
    text += "G3 X-40. I-20. J0\nX40. I20. J0\nG1 G40 X60.\nG13.1\n"
    report = report_of(text, "fanuc-30i", "1:radius=4", job=job_of("1:radius=4", job=job))
    assert RULE not in {finding.rule for finding in report.findings}
    (reason,) = [entry.reason for entry in report.not_evaluated if "ELLIPSE" in entry.reason]
    assert "a.dxf shows 1 ELLIPSE with an axis of no length, which was passed over" in reason


# ---- splines ----


def periodic(count: int, radius: float, degree: int) -> Draw:
    """A uniform closed spline with its control points on a circle."""
    angles = [math.tau * number / count for number in range(count)]
    poles = [(radius * math.cos(angle), radius * math.sin(angle), 0) for angle in angles]
    return lambda space: space.add_spline().set_closed(poles, degree=degree)


@looped("count", [12, 24, 40])
def test_a_closed_uniform_spline_runs_once_round(tmp_path: Path, count: int) -> None:
    """A uniform cubic spline passes each third of its poles at (p + 4 q + r) / 6: here at 20 from the center."""
    radius = 20 * 3 / (2 + math.cos(math.tau / count))
    (curve,) = curves(written(tmp_path / "a.dxf", periodic(count, radius, 3)))
    assert np.abs(curve).max() == pytest.approx(20)
    assert np.abs(curve).min() > 20 - 0.2 * (12 / count) ** 4
    assert length(curve) == pytest.approx(math.tau * 20, abs=0.1 * (12 / count) ** 4 + 0.002)
    assert area(curve) == pytest.approx(math.pi * 400, abs=2 * (12 / count) ** 4 + 0.04)


def test_a_uniform_spline_of_degree_two_touches_the_polygon_of_its_poles(tmp_path: Path) -> None:
    (curve,) = curves(written(tmp_path / "a.dxf", periodic(8, 20, 2)))
    assert np.abs(curve).min() == pytest.approx(20 * math.cos(math.pi / 8), abs=1e-6)
    assert np.abs(curve).max() == pytest.approx(20 * (3 + math.cos(math.pi / 4)) / 4)


@looped(
    ("knots", "start", "end"),
    [
        (range(8), 7 / 6 + 10j / 6, 17 / 6 + 10j / 6),
        ([0, 0, 0, 0, 1, 1, 1, 1], 0, 4),
        ([-3, -3, -3, -3, 1, 2, 3, 4], 0, None),
        ([5, 6, 7, 8, 9, 9, 9, 9], None, 4),
    ],
)
def test_a_spline_ends_where_its_domain_does(
    tmp_path: Path, knots: Any, start: complex | None, end: complex | None
) -> None:
    """At a knot of a uniform cubic spline the curve is at (p + 4 q + r) / 6; at a clamped end it is at the pole."""

    def draw(space: Any) -> None:
        space.add_open_spline([(0, 0), (1, 2), (3, 2), (4, 0)], degree=3).knots = list(knots)

    (curve,) = curves(written(tmp_path / "a.dxf", draw))
    for point, expected in ((curve[0], start), (curve[-1], end)):
        assert expected is None or point == pytest.approx(expected)
    assert length(curve) < 5.3


# ---- polylines of R12 ----


def fitted(bits: int, frame: int, on_curve: int) -> Callable[[Any], None]:
    """A polyline of a circle of 40, with the corners of a square about it as control points."""

    def draw(space: Any) -> None:
        polyline = space.add_polyline2d([], close=True)
        polyline.dxf.flags |= bits
        if frame:
            for corner in ((21, 21), (-21, 21), (-21, -21), (21, -21)):
                polyline.append_vertex(corner, dxfattribs={"flags": frame})
        for number in range(120):
            turn = math.tau * number / 120
            polyline.append_vertex((20 * math.cos(turn), 20 * math.sin(turn)), dxfattribs={"flags": on_curve})

    return draw


@pytest.mark.ci
@looped(("bits", "frame", "on_curve"), [(4, 16, 8), (2, 0, 1), (0, 0, 0)], ids=["spline", "curve", "plain"])
@looped("version", ["R12", "R2000"])
def test_control_points_of_a_polyline_are_no_curve(
    tmp_path: Path, version: str, bits: int, frame: int, on_curve: int
) -> None:
    (curve,) = curves(written(tmp_path / "a.dxf", fitted(bits, frame, on_curve), version))
    assert area(curve) == pytest.approx(60 * 400 * math.sin(math.tau / 120))


def test_nor_are_they_in_a_block_that_is_mirrored(tmp_path: Path) -> None:
    def draw(space: Any) -> None:
        fitted(4, 16, 8)(space.doc.blocks.new("round"))
        for x in (0, 100):
            space.add_blockref("round", (x, 0), dxfattribs={"xscale": -1})

    for curve in curves(written(tmp_path / "a.dxf", draw, "R12")):
        assert area(curve) == pytest.approx(60 * 400 * math.sin(math.tau / 120))


# ---- units ----


@pytest.mark.ci
@looped(
    ("units", "scale"),
    [
        (3, 1609344), (7, 1e6), (8, 25.4e-6), (10, 914.4), (11, 1e-7), (12, 1e-6), (15, 1e4), (16, 1e5),
        (21, 1200e3 / 3937), (22, 100e3 / 3937), (23, 3600e3 / 3937), (24, 5280 * 1200e3 / 3937),
    ],
)  # fmt: skip
def test_each_unit_of_a_dxf_file_is_converted(tmp_path: Path, units: int, scale: float) -> None:
    path = written(tmp_path / "a.dxf", lambda space: space.add_circle((0, 0), 20 / scale), units=units)
    drawing = drawing_file.read_drawing(path, "a.dxf")
    assert drawing.scale == pytest.approx(scale, rel=1e-12)
    assert area(np.array(drawing.curves[0])) * scale**2 == pytest.approx(math.pi * 400, abs=0.1)


@pytest.mark.ci
@looped(
    ("units", "message"),
    [
        (17, "its units are gigameters"), (18, "its units are astronomical units"), (20, "its units are parsecs"),
        (25, "has $INSUNITS 25, which is no unit of a DXF file"), (-1, "has $INSUNITS -1"), (99, "has $INSUNITS 99"),
    ],
)  # fmt: skip
def test_units_of_no_part_are_named(tmp_path: Path, units: int, message: str) -> None:
    with pytest.raises(JobError) as refused:
        drawing_file.read_drawing(written(tmp_path / "a.dxf", circle, units=units), "a.dxf")
    assert message in str(refused.value)


@pytest.mark.nightly
@looped("begin", [0.3, 1.0, -math.pi, math.pi, 5.0])
@looped("turns", [1, -1, 0])
def test_an_ellipse_that_ends_where_it_begins_is_whole(tmp_path: Path, begin: float, turns: int) -> None:
    """As writers have it: from -pi to pi, or from any parameter to that one a turn later."""

    def draw(space: Any) -> None:
        space.add_ellipse((0, 0), (20, 0), 0.75, begin, begin + turns * math.tau)

    (curve,) = curves(written(tmp_path / "a.dxf", draw))
    assert area(curve) == pytest.approx(math.pi * 20 * 15, abs=0.1)
    mirrored = written(tmp_path / "b.dxf", lambda space: _in_block(space, draw, xscale=-1, yscale=0.5))
    assert area(curves(mirrored)[0]) == pytest.approx(math.pi * 20 * 7.5, abs=0.1)


def test_a_part_of_an_ellipse_ends_where_it_is_said(tmp_path: Path) -> None:
    (curve,) = curves(written(tmp_path / "a.dxf", lambda space: space.add_ellipse((0, 0), (20, 0), 0.75, 0.3, 0.31)))
    assert length(curve) == pytest.approx(1e-2 * math.hypot(20 * math.sin(0.305), 15 * math.cos(0.305)), rel=1e-3)


@pytest.mark.nightly
@looped("repeated", [(0,), (5,), (12,), (3, 4), (5, 5), (0, 12)])
def test_a_point_of_a_spline_may_be_given_twice(tmp_path: Path, repeated: tuple[int, ...]) -> None:
    points = [(20 * math.cos(turn * math.pi / 6), 15 * math.sin(turn * math.pi / 6)) for turn in range(13)]
    (plain,) = curves(written(tmp_path / "a.dxf", lambda space: space.add_spline(points)))
    twice = points[:]
    for number in sorted(repeated, reverse=True):
        twice.insert(number, twice[number])
    (curve,) = curves(written(tmp_path / "b.dxf", lambda space: space.add_spline(twice)))
    np.testing.assert_allclose(curve, plain, atol=1e-6)


def _in_block(space: Any, draw: Draw, **placed: float) -> None:
    draw(space.doc.blocks.new("PART"))
    space.add_blockref("PART", (0, 0), dxfattribs=placed)
