"""
The finished part beside drawings and shapes: parts known by construction, twins of a program, slips of a known size.

What is expected is measured by shapely, between the outlines of two polygons, or follows from the numbers.
"""

from __future__ import annotations

import cmath
import math
import re
from pathlib import Path
from typing import Any

import ezdxf
import msgspec
import numpy as np
import pytest
import shapely
from cases import looped
from click.testing import CliRunner
from compensation_oracle import simulate
from contour_families import FAMILIES, Program, Twin, program_of
from part_reference import along, judge, read_section
from programs import job_of, report_of, tables_of

from polarcheck.commands import main
from polarcheck.geometry.comparison.measured_path import path_of_curves
from polarcheck.geometry.comparison.rounds import round_pieces
from polarcheck.geometry.tolerances import ADJUSTMENT
from polarcheck.parts.deviations import Deviations
from polarcheck.parts.part_comparison import Comparison
from polarcheck.program.machines import drawing_file
from polarcheck.program.machines.job import Job, Stock
from polarcheck.program.machines.part_keys import DrawnPart
from polarcheck.reports.made_parts.compared_contours import compared

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X150. Z2. C0\nG12.1\n"
TAIL = "G13.1\nG0 X160.\nM30\n"
RULE = "part-differs-from-drawing"


def program(points: list[complex], code: str = "G42", scale: float = 1.0, z: float = -3.0) -> str:
    """A contour from the middle of its last side round all of its points and back; the tool outside for G42."""
    middle = (points[-1] + points[0]) / 2
    away = middle * (1 + 25 / abs(middle)) if code == "G42" else middle * 0.3

    def at(point: complex) -> str:
        return f"X{2 * point.real / scale:.5f} C{point.imag / scale:.5f}"

    head = HEAD if scale == 1 else HEAD.replace("G21", "G20").replace("X150. Z2.", "X5.9 Z.08")
    blocks = [f"G1 {at(away)} F{300 / scale:.2f}", f"Z{z / scale:.4f}", f"{code} {at(middle)}", *map(at, points)]
    blocks += [at(middle), f"G40 {at(away)}", f"Z{2 / scale:.4f}"]
    return head + "\n".join(blocks) + "\n" + (TAIL if scale == 1 else TAIL.replace("X160.", "X6.3"))


def polygon(count: int, apothem: float, off: dict[int, float] | None = None, turn: float = 0.0) -> list[complex]:
    """The corners of a polygon whose sides lie so far from the center; off: what single ones lie farther out."""
    far = [apothem + (off or {}).get(side, 0.0) for side in range(count)]
    normals = [cmath.exp(1j * (turn + 2 * math.pi * side / count)) for side in range(count)]
    corners = []
    for side in range(count):
        one, other = normals[side - 1], normals[side]
        lines = np.array([[one.real, one.imag], [other.real, other.imag]])
        corners.append(complex(*np.linalg.solve(lines, [far[side - 1], far[side]])))
    return [*corners[1:], corners[0]]


def drawn(geometry: Any, scale: float = 1.0) -> Job:
    """A job with a drawing of the outlines of a geometry [mm], in units of so many mm."""
    rings = [
        ring for part in getattr(geometry, "geoms", [geometry]) for ring in (part.exterior, *part.interiors)
    ]  # fmt: skip
    curves = tuple(tuple((np.array(ring.coords) @ np.array([1, 1j]) / scale).tolist()) for ring in rings)
    return msgspec.structs.replace(
        job_of(job={"units": "mm"}), part=[DrawnPart(drawing="a.dxf", curves=curves, scale=scale)]
    )


def comparisons(text: str, radius: float, job: Any, machine: str = "fanuc-30i") -> list[Comparison]:
    tables = tables_of(text, machine, f"1:radius={radius:.6f}", job=job)
    deviations: Deviations = tables["deviations"]
    return deviations.comparisons


def is_sound(one: Program) -> bool:
    verdict = judge(one.text, one.radius, one.part)
    return not verdict.alarms and verdict.depth < 0.003 and not verdict.through and not verdict.wrong_side


def leaves_metal(one: Program, certain: float) -> bool:
    """
    By shapely: what the moves of the tool center clear leaves metal within R of the part, where the cutter reaches, or
    takes some off it on the way to the contour. Up to this distance from the axis there is metal.
    """
    section = read_section(one.text, one.radius)
    moves = [move for move in simulate(section.start, section.blocks).moves if section.heights[move.row] < 0]
    radius = one.radius
    ways = [shapely.LineString([(point.real, point.imag) for point in along(move)]) for move in moves]
    cleared = shapely.union_all([way.buffer(radius, quad_segs=64) for way in ways if way.length])
    reached = one.part.buffer(radius - 0.01, quad_segs=64).buffer(0.01 - radius, quad_segs=64)
    beside = reached.buffer(radius, quad_segs=64) - reached.buffer(0.03, quad_segs=64)
    if one.bar:  # else nobody knows how far the metal reaches
        beside |= shapely.Point(0, 0).buffer(certain - 0.1, quad_segs=256) - reached.buffer(0.1, quad_segs=64)
    beside &= shapely.Point(0, 0).buffer(certain, quad_segs=256)
    stays, cut = beside - cleared, one.part.buffer(-0.03, quad_segs=64) & cleared
    return any(not area.buffer(-0.004).is_empty for area in (stays, cut))


def sound_seeds(count: int) -> list[int]:
    """Of each family the first seeds."""
    return [number * len(FAMILIES) + place for place in range(len(FAMILIES)) for number in range(count)]


# ---- parts known by construction ----


@pytest.mark.ci
@looped("seed", sound_seeds(2), one_in=26)
def test_programs_of_all_families_agree_with_their_parts(seed: int) -> None:
    one = program_of(seed)
    found = comparisons(one.text, one.radius, drawn(one.part))
    assert found
    if is_sound(one):
        of_contours = tables_of(one.text, "fanuc-30i", f"1:radius={one.radius:.6f}", job=drawn(one.part))
        assert max(one.difference.largest for one in of_contours["contour_comparisons"].all) < 0.005


@pytest.mark.ci
@looped("seed", sound_seeds(2), one_in=26)
def test_metal_that_stays_or_is_missing_is_found_where_shapely_finds_it(seed: int) -> None:
    one = program_of(seed)
    if not is_sound(one) or one.radius <= ADJUSTMENT + 0.01:
        return
    job = drawn(one.part)
    reach = float(np.abs(shapely.get_coordinates(one.part) @ np.array([1, 1j])).max())
    certain = 1.02 * reach if reach < 1000 else 300.0
    if one.bar:
        job = msgspec.structs.replace(job, stock=Stock(diameter=one.bar))
        certain = one.bar / 2
    curves = [np.array(curve) for curve in job.part[0].curves]  # type: ignore[attr-defined]
    on = round_pieces(path_of_curves(curves), 0.02) >= 0
    turned = reach if on.any() and not on.all() else math.inf
    found = comparisons(one.text, one.radius, job)
    assert any(comparison.differs for comparison in found) == leaves_metal(one, min(certain, turned) - 0.02)


@pytest.mark.nightly
@looped("seed", sound_seeds(1), one_in=13)
@looped("twin", [Twin(turn=0.7), Twin(mirror=True), Twin(inch=True)], ids=["turned", "mirrored", "inch"])
def test_so_do_their_twins_with_the_drawing_of_the_twin(seed: int, twin: Twin) -> None:
    one = program_of(seed, twin)
    if not is_sound(one):
        return
    radius = one.radius / 25.4 if "G20" in one.text else one.radius
    job = msgspec.structs.replace(drawn(one.part, 25.4 if twin.inch else 1.0), units=None)
    tables = tables_of(one.text, "fanuc-30i", f"1:radius={radius:.6f}", job=job)
    assert max(found.difference.largest for found in tables["contour_comparisons"].all) < 0.005


@pytest.mark.ci
@looped(
    ("family", "by"),
    # A cam has thousands of corners: one of the two ways is enough.
    [*((family, by) for family in ("polygons", "crosses") for by in (0.3, -0.2)), ("cams", 0.3)]
    + [("eccentrics", by) for by in (0.3, -0.2)],
    one_in=7,
)
def test_a_larger_or_smaller_drawing_differs_by_what_shapely_says(family: str, by: float) -> None:
    made = (program_of(seed, family=family) for seed in range(100))
    # Pockets are in a plate without end.
    one = next(one for one in made if is_sound(one) and shapely.area(one.wide) < 1e6)
    other = one.wide.buffer(by, quad_segs=200)
    (ring,) = [part.exterior for part in getattr(one.wide, "geoms", [one.wide])]
    (found, *_) = comparisons(one.text, one.radius, drawn(other))
    expected = shapely.hausdorff_distance(ring, other.exterior, densify=0.5 if len(ring.coords) > 99 else 0.002)
    assert found.difference.largest == pytest.approx(expected, abs=0.005)
    assert (found.difference.deep > found.difference.proud) == (by > 0)


# ---- slips of a known size ----


@pytest.mark.ci
@looped(
    ("side", "off", "turned"),
    [(0, 0.05, None), (1, -0.05, 10.0), (2, 0.05, 10.0), (3, -0.05, None), (4, 0.05, None), (5, -0.05, 10.0)],
    one_in=6,
)
def test_a_side_that_is_off_is_told_with_its_block(side: int, off: float, turned: float | None) -> None:
    text = program(polygon(6, 13.5, {side: off}, math.radians(10)))
    expected = {"shape": "hexagon", "across_flats": 27.0, **({} if turned is None else {"turned": turned})}
    (found,) = report_of(text, "fanuc-30i", "1:radius=4", job={"part": [expected]}, only=[RULE]).findings
    # The contour begins and ends in the middle of the first side.
    lines = {9 + side} | ({15} if side == 0 else set())
    assert found.line in lines
    assert found.values["largest"] == pytest.approx(0.05, abs=0.001)
    assert ("too much stays" if off > 0 else "too much is cut away") in found.message


@pytest.mark.nightly
def test_a_part_agrees_within_the_tolerance_that_is_given() -> None:
    text = program(polygon(6, 13.5, {2: 0.05}))
    for tolerance, count in ((None, 1), (0.049, 1), (0.051, 0)):
        part = {"shape": "hexagon", "across_flats": 27.0, **({} if tolerance is None else {"tolerance": tolerance})}
        findings = report_of(text, "fanuc-30i", "1:radius=4", job={"units": "mm", "part": [part]}, only=[RULE]).findings
        assert len(findings) == count


@pytest.mark.nightly
def test_lengths_are_in_the_units_of_the_program_unless_the_file_says_others() -> None:
    text = program(polygon(6, 12.7), scale=25.4)
    for job, agrees in (({}, True), ({"units": "mm"}, False)):
        part = {"shape": "hexagon", "across_flats": 1.0}
        (found,) = comparisons(text, 4 / 25.4 if not job else 4, {**job, "part": [part]})
        assert found.agrees == agrees


# ---- how it would fit ----

EGG = shapely.Polygon([(20, -9), (20, 12), (-12, 18), (-15, -11)])
CORNERS = [complex(x, c) for x, c in EGG.exterior.coords[:-1]]


@pytest.mark.ci
@looped(
    ("change", "said"),
    [
        # How the part would have to be changed, where the drawing is changed.
        (lambda point: point * cmath.exp(0.3j), "turned by 17.19 deg"),
        (lambda point: point.conjugate(), "mirrored, with C of the other sign"),
        (lambda point: complex(2 * point.real, point.imag), "with twice its X, as diameter and radius are mixed up"),
        (lambda point: complex(point.real / 2, point.imag), "with half of its X, as diameter and radius are mixed up"),
    ],
    ids=["turned", "mirrored", "doubled", "halved"],
    one_in=4,
)
def test_a_part_that_would_fit_is_told_how(change: Any, said: str) -> None:
    corners = [change(point) for point in CORNERS]
    other = shapely.Polygon([(point.real, point.imag) for point in corners])
    (found,) = report_of(program(CORNERS), "fanuc-30i", "1:radius=3", job=drawn(other), only=[RULE]).findings
    assert said in found.message


@pytest.mark.ci
def test_a_shape_that_is_turned_is_told_by_how_much() -> None:
    text = program(polygon(6, 13.5, turn=math.radians(7)))
    part = {"shape": "hexagon", "across_flats": 27.0, "turned": 0.5}
    (found,) = report_of(text, "fanuc-30i", "1:radius=4", job={"part": [part]}, only=[RULE]).findings
    assert "would fit turned by -6.5 deg" in found.message


# ---- which contour, which depth ----


@pytest.mark.ci
def test_a_boss_is_no_pocket() -> None:
    part = {"shape": "square", "across_flats": 40.0, "inside": True}
    (found,) = report_of(
        program(polygon(4, 20.0)), "fanuc-30i", "1:radius=3", job={"part": [part]}, only=[RULE]
    ).findings
    assert "it is a boss, and a pocket is asked for" in found.message
    pocket = program(polygon(4, 20.0), "G41")
    assert [one.agrees for one in comparisons(pocket, 3, {"part": [part]})] == [True]


@pytest.mark.nightly
def test_roughing_is_no_difference_and_a_cut_too_deep_is() -> None:
    rough, final = program(polygon(4, 20.5), z=-3.0), program(polygon(4, 20.0), z=-3.0)
    part = {"shape": "square", "across_flats": 40.0}
    both = rough.replace(TAIL, "G13.1\n") + final.removeprefix("O1\n")
    assert [one.differs for one in comparisons(both, 3, {"part": [part]})] == [False]
    deep = program(polygon(4, 19.9), z=-3.0).replace(TAIL, "G13.1\n") + final.removeprefix("O1\n")
    assert [one.differs for one in comparisons(deep, 3, {"part": [part]})] == [True]
    second = {"part": [{**part, "section": 2}]}
    assert [(one.section, one.differs) for one in comparisons(deep, 3, second)] == [(1, False)]


@pytest.mark.nightly
@looped(("apothem", "told"), [(14.0, []), (13.0, [True])])
def test_what_a_contour_of_unknown_r_may_take_off_is_no_difference(apothem: float, told: list[bool]) -> None:
    # Of the tool that finishes nobody has said R; what is cut too deep by the first one stays so.
    first, last = program(polygon(6, apothem)), program(polygon(6, 13.5))
    text = first.removesuffix("M30\n") + last.removeprefix("O1\n").replace("T0101", "T0202")
    job = job_of(job={"part": [{"shape": "hexagon", "across_flats": 27.0}]})
    assert [one.differs for one in comparisons(text, 2, job) if one.differs] == told
    assert [one.differs for one in comparisons(first, 2, job)] == [True]


@pytest.mark.ci
def test_each_contour_is_compared_with_the_curve_that_comes_nearest() -> None:
    text = program(polygon(6, 13.5)).replace(TAIL, "G13.1\n") + program(polygon(4, 20.0), z=-8.0).removeprefix("O1\n")
    both = drawn(shapely.MultiPolygon([shapely.Polygon([(p.real, p.imag) for p in polygon(6, 13.5)])]))
    square = drawn(shapely.Polygon([(p.real, p.imag) for p in polygon(4, 20.0)])).part[0]
    curves = (*both.part[0].curves, *square.curves)  # type: ignore[attr-defined]
    job = msgspec.structs.replace(both, part=[DrawnPart(drawing="a.dxf", curves=curves, scale=1.0)])
    found = comparisons(text, 8, job)
    assert [(one.section, one.curve, one.agrees) for one in found] == [(0, 0, True), (1, 1, True)]


@pytest.mark.parametrize(
    ("part", "said"),
    [
        ({"section": 2}, "it is for section 2, and the program has 1"),
    ],
)
def test_what_nothing_is_compared_with_is_not_evaluated(part: dict[str, Any], said: str) -> None:
    job = {"part": [{"shape": "hexagon", "across_flats": 27.0, **part}]}
    report = report_of(program(polygon(6, 13.5)), "fanuc-30i", "1:radius=4", job=job, only=[RULE])
    assert [one.reason for one in report.not_evaluated] == [f"the hexagon asked for was compared with nothing: {said}"]


def test_without_r_nobody_knows_what_is_left() -> None:
    job = {"part": [{"shape": "hexagon", "across_flats": 27.0}]}
    report = report_of(program(polygon(6, 13.5)), "fanuc-30i", job=job, only=[RULE])
    assert [one.reason.partition(":")[0] for one in report.not_evaluated] == ["no radius for T0101"]
    assert not report_of(program(polygon(6, 13.5)), "fanuc-30i", only=[RULE]).not_evaluated


# ---- shapes by their numbers ----


def shaped(part: dict[str, Any], text: str, radius: float = 2.0) -> list[float]:
    return [one.difference.largest for one in comparisons(text, radius, {"part": [part]})]


@pytest.mark.nightly
def test_flats_and_slots_are_compared_along_their_walls() -> None:
    flats = "G1 X60. C10. F300/Z-1./G42 X40./X-40./G40 X-60./G1 C-10./G42 X-40./X40./G40 X60."
    text = HEAD + flats.replace("/", "\n") + "\n" + TAIL
    quarter = {"turned": 90.0}
    assert shaped({"shape": "flats", "across_flats": 20.0, **quarter}, text) == pytest.approx([0], abs=1e-4)
    assert shaped({"shape": "flats", "across_flats": 20.1, **quarter}, text) == pytest.approx([0.05], abs=1e-3)
    assert shaped({"shape": "flats", "across_flats": 20.1, "diameter": 30.0}, text) == pytest.approx([0.05], abs=1e-3)
    assert shaped({"shape": "flats", "distance": 10.0}, text) == pytest.approx([0], abs=1e-4)
    slot = "G1 X80. C0. F300/Z-1./G41 X60. C3./X-60./G40 X-80. C0./G41 X-60. C-3./X60./G40 X80. C0."
    text = HEAD + slot.replace("/", "\n") + "\n" + TAIL
    assert shaped({"shape": "slot", "width": 6.0}, text) == pytest.approx([0], abs=1e-4)
    assert shaped({"shape": "slot", "width": 6.1, "turned": 0.0}, text) == pytest.approx([0.05], abs=1e-3)


@pytest.mark.nightly
def test_round_corners_and_chamfers() -> None:
    """A square of 20 with R3: written as arcs, by itself, and as a sharp one, which has sqrt(2) - 1 of R more."""
    ends = [(10, 7), (7, 10), (-7, 10), (-10, 7), (-10, -7), (-7, -10), (7, -10), (10, -7)]
    blocks = [
        f"{'G1' if number % 2 == 0 else 'G3'} X{2 * x}. C{c}.{' R3.' if number % 2 else ''}"
        for number, (x, c) in enumerate(ends)
    ]
    text = HEAD + "\n".join(["G1 X60. C0 F300", "Z-1.", "G42 X20. C0", *blocks, "G1 X20. C0", "G40 X60.", ""]) + TAIL
    square = {"shape": "square", "across_flats": 20.0}
    assert shaped({**square, "corner_radius": 3.0}, text) == pytest.approx([0], abs=1e-3)
    assert shaped(square, text) == pytest.approx([3 * (math.sqrt(2) - 1)], abs=1e-3)
    chamfered = 3 * math.sqrt(2) / 2
    assert shaped({**square, "chamfer": 3.0}, text) == pytest.approx([chamfered - 3 * (math.sqrt(2) - 1)], abs=1e-3)
    rectangle = {"shape": "rectangle", "width": 20.0, "length": 20.0, "corner_radius": 3.0, "turned": 90.0}
    assert shaped(rectangle, text) == pytest.approx([0], abs=1e-3)


@pytest.mark.nightly
def test_circles_off_the_center() -> None:
    text = HEAD + "G1 X80. C5. F300\nZ-1.\nG42 X30. C5.\nG3 X30. C5. I-12. J0\nG1 G40 X80.\n" + TAIL
    assert shaped({"shape": "circle", "diameter": 24.0, "center": [3.0, 5.0]}, text) == pytest.approx([0], abs=1e-3)
    assert shaped({"shape": "circle", "diameter": 24.0, "center": [3.0, 4.9]}, text) == pytest.approx([0.1], abs=1e-3)
    assert shaped({"shape": "circle", "diameter": 24.2, "center": [3.0, 5.0]}, text) == pytest.approx([0.1], abs=1e-3)


# ---- from the file to the report ----


@pytest.mark.nightly
@looped(("code", "across", "within"), [("G21", 40.0, "0.001 mm"), ("G20", 2.0, "0.0001 inch")])
def test_nothing_agrees_by_less_than_the_last_digit(code: str, across: float, within: str) -> None:
    words = [f"X{across}", f"C{across / 2}", f"X-{across}", f"C-{across / 2}", f"X{across}", "C0."]
    text = HEAD.replace("G21", code) + f"G1 X{2 * across} C0. F100.\nG42 " + "\n".join(words) + f"\nG40 X{2 * across}\n"
    job = {"part": [{"shape": "square", "across_flats": across}]}
    (found,) = compared(tables_of(text + TAIL, "fanuc-30i", "1:radius=0.1", job=job))
    assert found.text.startswith(f"agrees with the square asked for within {within} (tolerance ")


@pytest.mark.nightly
def test_arcs_are_bulges_in_a_file_and_agreement_is_told_with_its_worst_place(tmp_path: Path) -> None:
    """A D shaft of 30 with its flat 9 from the center."""
    half = math.acos(9 / 15)
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 1
    bulge = math.tan((2 * math.pi - 2 * half) / 4)
    points = [(9 / 25.4, -12 / 25.4, 0, 0, 0), (9 / 25.4, 12 / 25.4, 0, 0, bulge)]
    document.modelspace().add_lwpolyline(points, close=True)
    document.saveas(tmp_path / "d.dxf")
    text = HEAD + "G1 X80. C0. F300\nZ-1.\nG42 X18. C0\nC12.\nG3 X18. C-12. I-9. J-12.\nG1 C0\nG40 X80.\n" + TAIL
    job = msgspec.structs.replace(job_of(), part=[drawing_file.part_of(tmp_path / "d.dxf", "d.dxf")])
    (found,) = compared(tables_of(text, "fanuc-30i", "1:radius=4", job=job))
    assert found.agrees
    assert found.largest == pytest.approx(0, abs=1e-3)
    assert found.text == "agrees with d.dxf within 0.001 mm (tolerance 0.02 mm)"
    near = text.replace("X18. C0\nC12.", "X18.02 C0\nC12.").replace("G1 C0", "G1 X18.02 C0")
    (found,) = compared(tables_of(near, "fanuc-30i", "1:radius=4", job=job))
    # The arc begins 0.01 farther out as well, about a center that is so much nearer.
    assert found.text.startswith("agrees with d.dxf within 0.013 mm (tolerance 0.02 mm), largest at X-29.")
    off = text.replace("X18. C0\nC12.", "X18.1 C0\nC12.").replace("G1 C0", "G1 X18.1 C0")
    (found,) = compared(tables_of(off, "fanuc-30i", "1:radius=4", job=job))
    assert not found.agrees
    assert found.too_much == pytest.approx(0.05, abs=2e-3)


PAGE = Path(__file__).parent.parent / "docs" / "drawing.md"


@pytest.mark.nightly
@pytest.mark.skipif(not PAGE.exists(), reason="the pages lie in a checkout")
@pytest.mark.parametrize(("command", "slip"), [("check", "-8.610"), ("part", "-8.660")])
def test_the_page_shows_what_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str, slip: str) -> None:
    text = (PAGE.parent.parent / "sample_programs" / "hexagon.nc").read_text()
    (tmp_path / "O1001.NC").write_text(text.replace("\nC-8.660\n", f"\nC{slip}\n"))
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    corners = [corner * cmath.exp(1j * math.pi / 3) for corner in polygon(6, 15.0)]
    document.modelspace().add_lwpolyline([(corner.real, corner.imag) for corner in corners], close=True)
    document.saveas(tmp_path / "part.dxf")
    monkeypatch.chdir(tmp_path)
    lines = [line.removeprefix("    ") for line in PAGE.read_text("utf-8").splitlines()]
    shown = next(line for line in lines if line.startswith(f"$ polarcheck {command}"))
    result = CliRunner().invoke(main, shown.split()[2:])
    assert result.exit_code == (command == "check")
    said = result.stdout.rstrip().splitlines()
    at = lines.index(shown) + 1
    assert lines[at : at + len(said)] == said


@pytest.mark.nightly
def test_a_job_file_names_drawings_of_some_programs(tmp_path: Path) -> None:
    """Those of other programs are not read; a drawing lies beside its job file, whose line is told for a broken one."""
    for name in ("O1.NC", "O2.NC"):
        (tmp_path / name).write_text(program(polygon(6, 13.5)))
    document = ezdxf.new("R2010")
    document.header["$INSUNITS"] = 4
    document.modelspace().add_circle((0, 0), 13.5)
    document.saveas(tmp_path / "a.dxf")
    entries = '[tools.1]\nradius = 4.0\n\n[[part]]\ndrawing = "a.dxf"\ntolerance = {}\nfiles = ["O1*"]\n'
    job = tmp_path / "polarcheck.toml"

    def checked(name: str) -> Any:
        command = ["check", "--format", "concise", "--select", RULE, str(tmp_path / name)]
        return CliRunner().invoke(main, command)

    job.write_text(entries.format(0.02))
    assert "the part differs from a.dxf by 2.088 mm" in checked("O1.NC").stdout.replace("2.089", "2.088")
    assert checked("O2.NC").exit_code == 0
    job.write_text(entries.format(3.0))
    assert checked("O1.NC").exit_code == 0
    (tmp_path / "a.dxf").write_text("G0 X10.\n")
    assert (
        checked("O1.NC").stderr
        == f"polarcheck: {job}:5: drawing: {tmp_path / 'a.dxf'}: is no DXF file; save the drawing as DXF\n"
    )
    assert checked("O2.NC").exit_code == 0


@pytest.mark.nightly
def test_a_contour_that_does_not_close_leaves_metal() -> None:
    """It ends 0.05 mm beside where it began."""
    open_square = HEAD + "G1 X100. C-4. F500\nZ-1.\nG42 X40. C0\nC20.\nX-40.\nC-20.\nX40.1\nC0\nG40 X80. C5.\n" + TAIL
    job = {"part": [{"shape": "square", "across_flats": 40.0}]}
    (found,) = report_of(open_square, "fanuc-30i", "1:radius=3", job=job, only=[RULE]).findings
    assert found.values["largest"] == pytest.approx(0.05, abs=0.002)
    closed = report_of(open_square.replace("X40.1", "X40."), "fanuc-30i", "1:radius=3", job=job, only=[RULE])
    assert (closed.findings, closed.not_evaluated, closed.verdict) == ([], [], "pass")


def test_a_depth_that_nothing_reaches_differs() -> None:
    job = {"part": [{"shape": "hexagon", "across_flats": 27.0, "z": -9.0}]}
    (found,) = report_of(program(polygon(6, 13.5)), "fanuc-30i", "1:radius=4", job=job, only=[RULE]).findings
    assert "nothing mills its walls" in found.message or "too much stays" in found.message


@pytest.mark.nightly
@looped(("half", "by", "what"), [(10.05, 0.071, "stays"), (9.95, 0.05, "is cut away")])
def test_a_boss_that_the_path_of_the_tool_makes_is_compared_as_a_boss(half: float, by: float, what: str) -> None:
    """No contour in offset mode says on which side of the drawn square the part is: what is cleared does."""
    h = half + 3
    path = f"G1 X100. C0 F300/Z-3./X{2 * h:.3f}/C{h:.3f}/X-{2 * h:.3f}/C-{h:.3f}/X{2 * h:.3f}/C0/X100./Z2./"
    job = msgspec.structs.replace(drawn(shapely.box(-10, -10, 10, 10)), stock=Stock(diameter=30))
    (difference,) = report_of(
        HEAD + path.replace("/", "\n") + TAIL, "fanuc-30i", "1:radius=3", job=job, only=[RULE]
    ).findings
    assert f"by {by} mm" in difference.message
    assert f"too much {what}" in difference.message


def along_square(center: complex, half: float, *more: complex) -> str:
    """The center of the tool along a square, and on to more points."""
    start = center + half
    corners = [center + half * complex(x, c) for x, c in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    return cut(start, *corners, start, *more)


def cut(*points: complex) -> str:
    """The center of the tool along points, 3 mm deep."""
    first, *others = [f"X{2 * point.real:.3f} C{point.imag:.3f}\n" for point in points]
    return f"G1 {first}F300 Z-3.\n{''.join(others)}Z2.\n"


def opening(center: complex, half: float) -> Any:
    """A square pocket whose corners are those of a cutter with R 2."""
    middle = shapely.points(center.real, center.imag)
    return shapely.buffer(middle, half - 2, cap_style="square").buffer(2, quad_segs=64)


def messages(text: str, part: Any) -> list[str]:
    job = msgspec.structs.replace(drawn(part), stock=Stock(diameter=60))
    return [one.message for one in report_of(text, "fanuc-30i", "1:radius=2", job=job, only=[RULE]).findings]


@pytest.mark.nightly
@looped("off", [0.1, 0.5])
def test_of_two_pockets_alike_the_one_that_is_off_is_compared_with_its_own(off: float) -> None:
    """It is not off by 30 mm, where the other one lies; and it is no fault of the disc that it lies in."""
    part = shapely.Point(0, 0).buffer(30, quad_segs=128).difference(opening(15, 5) | opening(-15, 5))
    made = along_square(15 + off, 3, 15 + off) + along_square(-15, 3, -15)
    (message,) = messages(HEAD + made + TAIL, part)
    assert f"by {off:g} mm, 0.02 mm is allowed" in message
    assert f"would fit shifted by x {off:.3f} c 0.000" in message
    assert f"pocket: square, 10.000 across flats, corners R2.000, center {15 + off:.3f} off the axis" in message


#: A disc with a pocket round an island, and another pocket: what its program does beside, and what is said of it.
WITH_ISLAND = {
    "nothing": ((7, 5, 3), "", None),
    "wide pocket": ((7.1, 5, 3), "", "0.141 mm.*cut away.*pocket: square, 18.200 across flats"),
    "small island": ((7, 4.9, 3), "", "0.1 mm.*cut away.*makes: square, 5.800 across flats"),
    "large island": ((7, 5.1, 3), "", "0.141 mm.*too much stays.*makes: square, 6.200 across flats"),
    "wide other pocket": ((7, 5, 3.1), "", "0.141 mm.*cut away.*pocket: square, 10.200 across flats"),
    "wall of the pocket": ((7, 5, 3), cut(15 + 7j, 15 + 8j), "by 1 mm.*cut away at X30 C10"),
    "wall of the other pocket": ((7, 5, 3), cut(-15, -11), "by 1 mm.*cut away at X-18 C0"),
    "land": ((7, 5, 3), cut(-2 - 20j, 2 - 20j), "by 11.889 mm.*cut away at X-4 C-18"),
    "island": ((7, 5, 3), cut(15 + 7j, 15 + 4j), "by 1 mm.*cut away at X30 C2"),
}


@pytest.mark.nightly
@looped("fault", WITH_ISLAND, one_in=18)
@looped("turn", [1, 1j], ids=["along X", "along C"])
def test_an_island_hides_no_fault_of_another_pocket(fault: str, turn: complex) -> None:
    (wide, around, other), more, expected = WITH_ISLAND[fault]
    island = shapely.box(12, -3, 18, 3)
    part = shapely.Point(0, 0).buffer(30, quad_segs=128).difference(opening(15, 9).difference(island) | opening(-15, 5))
    made = along_square(15, wide) + along_square(15, around) + along_square(-15, other, -15) + more
    if turn != 1:
        part = shapely.transform(part, lambda points: points[:, ::-1] * [-1, 1])
        made = re.sub(r"X(\S+) C(\S+)", lambda word: f"X{-2 * float(word[2]):.3f} C{float(word[1]) / 2:.3f}", made)
        expected = expected and re.sub(r" at X.*", "", expected)
    found = messages(HEAD + made + TAIL, part)
    assert len(found) == (expected is not None)
    for message in found:
        assert re.search(expected or "", message)
        assert "would fit" not in message


#: Corners of a pocket and of a boss with an inside corner, and what is drawn: inside corners with this radius.
POCKET = [complex(x, c) for x, c in ((4, 4), (-4, 4), (-4, -4), (4, -4))]
BOSS = [complex(x, c) for x, c in ((15, -8), (15, 2), (3, 2), (3, 9), (-15, 9), (-15, -8))]


@pytest.mark.nightly
@looped("scale", [1.0, 25.4], ids=["mm", "inch"], one_in=10)
@looped(
    ("drawn_radius", "radius", "agrees"), [(2, 2, True), (2, 1.5, False), (3, 2, False), (0, 2, True), (1, 2, True)]
)
def test_a_sharp_corner_of_the_program_is_round_where_r_of_the_cutter_is_drawn(
    drawn_radius: float, radius: float, agrees: bool, scale: float
) -> None:
    """A cutter leaves its own R in inside corners; a smaller one cuts into a larger round."""
    boss = shapely.Polygon([(corner.real, corner.imag) for corner in BOSS])
    boss = boss.buffer(drawn_radius, quad_segs=64, join_style="mitre", mitre_limit=9).buffer(
        -drawn_radius, quad_segs=64
    )
    pocket = shapely.box(-4, -4, 4, 4).buffer(-drawn_radius).buffer(drawn_radius, quad_segs=64)
    disc = shapely.Point(0, 0).buffer(30, quad_segs=128)
    in_bar = msgspec.structs.replace(drawn(disc.difference(pocket)), stock=Stock(diameter=60))
    for job, text in ((in_bar, program(POCKET, "G41", scale)), (drawn(boss), program(BOSS, "G42", scale))):
        found = report_of(text, "fanuc-30i", f"1:radius={radius}", job=job, only=[RULE]).findings
        assert [one.rule for one in found] == ([] if agrees else [RULE])


def slot(angle: float, half: float, z: float) -> str:
    """A straight cut through the center, so long on either side of it."""
    end = cmath.rect(half, math.radians(angle))
    words = [f"X{sign * 2 * end.real:.4f} C{sign * end.imag:.4f}" for sign in (1, -1)]
    return f"G1 {words[0]} F300\nZ{z}\n{words[1]}\nZ2.\n"


def test_a_slot_shorter_than_the_cutter_is_wide_leaves_its_ends() -> None:
    """In a bar of 20 it reaches 6 mm to each side: 4 mm stay."""
    job = {"part": [{"shape": "slot", "width": 8.0, "z": -3.0}], "stock": {"diameter": 20}}
    text = HEAD + slot(0, 2, -3.0) + TAIL
    (difference,) = report_of(text, "fanuc-30i", "1:radius=4", job=job, only=[RULE]).findings
    assert "by 4 mm, 0.02 mm is allowed: too much stays at X-20 C0" in difference.message


def test_a_slot_is_placed_by_its_own_depth_not_by_a_deeper_groove() -> None:
    """The groove ends 2 mm from the center, which is 1 mm off the middle of the slot: so far it cuts into its wall."""
    job = {"part": [{"shape": "slot", "width": 8.0, "z": -3.0}], "stock": {"diameter": 40}}
    text = HEAD + slot(30, 25, -3.0) + slot(0, 2, -6.0) + TAIL
    (difference,) = report_of(text, "fanuc-30i", "1:radius=4", job=job, only=[RULE]).findings
    assert difference.values["largest"] == pytest.approx(1, abs=0.002)
    assert report_of(text.replace(slot(0, 2, -6.0), ""), "fanuc-30i", "1:radius=4", job=job, only=[RULE]).findings == []


@pytest.mark.nightly
@looped(("z", "is_compared"), [("-3.015625", True), ("-3.016", False), ("-2.984375", True)], one_in=2)
def test_a_depth_belongs_to_a_part_up_to_its_tolerance(z: str, is_compared: bool) -> None:
    text = program(polygon(6, 13.5)).replace("Z-3.0000", f"Z{z}")
    part = {"shape": "hexagon", "across_flats": 27.0, "z": -3.0, "tolerance": 0.015625}
    assert [one.contour is not None for one in comparisons(text, 4, {"part": [part]})] == [is_compared]


@pytest.mark.nightly
@looped("seed", [1, 10])
def test_the_bar_of_the_job_bounds_what_is_compared(seed: int) -> None:
    """Flats, slots and keyways that end beyond it."""
    one = program_of(seed)
    assert one.bar is not None
    assert is_sound(one)
    job = msgspec.structs.replace(drawn(one.part), stock=Stock(diameter=one.bar))
    found = comparisons(one.text, one.radius, job)
    assert max(comparison.difference.largest for comparison in found) < 0.005
