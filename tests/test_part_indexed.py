"""What is told of sections with C between them: put together in the frame of the part, with the angle of each."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from cases import looped
from indexed_programs import NAMES, Section, flat, polygon, program, tool
from programs import tables_of
from test_cli import call

from polarcheck.foundation.finding import MadeShape
from polarcheck.reports.made_parts.part_report import made_by

pytestmark = pytest.mark.usefixtures("own_folder")

VARIATIONS = [*((name, False) for name in NAMES), ("fanuc", True), ("haas-lathe", True), ("siemens-iso", True)]


def made(
    sections: list[Section], control: str = "fanuc", inch: bool = False, radius: float = 3.0, stock: float = 0.0
) -> list[MadeShape]:
    job = {"stock": {"diameter": stock / (25.4 if inch else 1)}} if stock else {}
    return made_by(tables_of(program(sections, control, inch), control, tool(radius, inch), job=job))


def angles(shape: MadeShape) -> list[float | None]:
    return [one.angle for one in shape.sections]


def flats(count: int, distance: float = 12.0, half: float = 22.0, first: float = 0.0) -> list[Section]:
    return [Section(flat(distance, half), (first + number * 360 / count) % 360) for number in range(count)]


@pytest.mark.one_in(16)
@pytest.mark.ci
@pytest.mark.parametrize(("control", "inch"), VARIATIONS)
@pytest.mark.parametrize("first", [0.0, 15.0])
@pytest.mark.parametrize(("count", "name"), [(3, "triangle"), (4, "square"), (6, "hexagon"), (8, "octagon")])
def test_flats_with_c_between_them_are_one_shape(count: int, name: str, first: float, control: str, inch: bool) -> None:
    (shape,) = made(flats(count, first=first), control, inch)
    assert shape.shape == name
    assert shape.is_regular
    assert shape.values["across_flats"] == pytest.approx(24.0, abs=0.004)
    assert shape.values["turned"] == pytest.approx(first, abs=0.02)
    assert angles(shape) == [first + number * 360 / count for number in range(count)]
    assert (shape.line, shape.end_line) == (shape.sections[0].line, shape.sections[0].end_line)


@pytest.mark.one_in(12)
@pytest.mark.ci
@pytest.mark.parametrize(("control", "inch"), VARIATIONS)
@pytest.mark.parametrize("first", [0.0, 30.0])
def test_two_flats_are_a_part_with_two_flats(first: float, control: str, inch: bool) -> None:
    (shape,) = made(flats(2, half=14.0, first=first), control, inch)
    assert (shape.shape, shape.values["flats"]) == ("flats", 2)
    assert shape.values["apart"] == pytest.approx(24.0, abs=0.004)
    assert shape.values["turned"] == pytest.approx(first, abs=0.02)
    (shape,) = made(flats(2, half=25.0, first=first), control, inch, stock=32.0)
    assert shape.values["apart"] == pytest.approx(24.0, abs=0.004)


def test_the_words_name_lines_and_angles() -> None:
    (shape,) = made(flats(3))
    assert shape.text == (
        "triangle, 24.000 across flats, sizes are twice the distance of a side from the middle; to Z-5.000; "
        "by the sections of lines 8, 17, 26 at C0, C120, C240"
    )


def test_many_angles_are_told_by_their_step() -> None:
    (shape,) = made(flats(12, half=6.0))
    assert shape.text.endswith(" at C0 to C330, 30 deg apart")
    assert len(shape.sections) == 12


def test_a_loop_has_its_sections_in_one_line() -> None:
    lines = program(flats(1)).splitlines()
    first, last = lines.index("G0 X80. C0 Z2."), lines.index("G13.1")
    section = [line.replace("C0 Z2.", "C[#1] Z2.") for line in lines[first : last + 1]]
    loop = ["#1=0", "WHILE[#1 LT 360]DO1", *section, "#1=#1+120", "END1"]
    text = "\n".join([*lines[:first], *loop, *lines[last + 1 :]]) + "\n"
    (shape,) = made_by(tables_of(text, "fanuc", tool(3)))
    assert shape.text.endswith("by the section of line 10 at C0, C120, C240")
    assert angles(shape) == [0.0, 120.0, 240.0]


def test_incremental_indexing_is_the_same() -> None:
    text = program(flats(3)).replace("C120. Z2.", "H120. Z2.").replace("C240. Z2.", "H120. Z2.")
    (shape,) = made_by(tables_of(text, "fanuc", tool(3)))
    assert (shape.shape, angles(shape)) == ("triangle", [0.0, 120.0, 240.0])


@pytest.mark.ci
def test_each_depth_is_put_together() -> None:
    depths = (-2.0, -4.0, -6.0)
    sections = [section._replace(depths=depths) for section in flats(3)]
    (shape,) = made(sections)
    assert shape.depths == [*depths]
    sections[2] = sections[2]._replace(depths=depths[:2])
    triangle, *rest = made(sections)
    assert (triangle.shape, triangle.depths, len(triangle.sections)) == ("triangle", [-2.0, -4.0], 3)
    assert all(shape.depths == [-6.0] for shape in rest)
    assert [angle for shape in rest for angle in angles(shape)] == [0.0, 120.0]


@pytest.mark.ci
@looped(("control", "inch"), VARIATIONS, one_in=4)
@looped(("entry", "written"), [(10.0, 0.0), (120.0, 0.0), (20.0, 15.0), (350.0, 0.0)])
def test_c_at_the_switch_is_added_to_the_angle(entry: float, written: float, control: str, inch: bool) -> None:
    (shape,) = made([Section(polygon(6, 30.0, written), entry)], control, inch)
    assert shape.values["turned"] == pytest.approx((entry + written) % 60, abs=0.02)
    assert angles(shape) == [entry]
    assert f"; C{entry:g} at " in shape.text


@pytest.mark.ci
@looped(("control", "inch"), VARIATIONS, one_in=2)
@looped("entry", [90.0, 180.0])
def test_places_are_those_of_the_part(entry: float, control: str, inch: bool) -> None:
    square = [point + 14 for point in polygon(4, 8.0)]
    (shape,) = made([Section([*square[:-1], square[0]], entry, approach=40.0)], control, inch, radius=2.0)
    x, c = {90.0: (0.0, 14.0), 180.0: (-14.0, 0.0)}[entry]
    assert (shape.values.get("center_x"), shape.values.get("center_c")) == (
        pytest.approx(x, abs=0.004),
        pytest.approx(c, abs=0.004),
    )


@pytest.mark.ci
@looped(("control", "inch"), [("siemens-iso", False), ("siemens-iso", True)])
@looped("written", [0.0, 10.0])
def test_c_that_nobody_knows_is_told_as_such(written: float, control: str, inch: bool) -> None:
    (shape,) = made([Section(polygon(6, 30.0, written), None)], control, inch)
    assert angles(shape) == [None]
    how = ", turned by 10 deg from C at G12.1, which is not known;" if written else ", C at G12.1 is not known;"
    assert how in shape.text
    (shape,) = made([Section(polygon(72, 30.0), None)], control, inch)
    assert "not known" in shape.text or shape.shape == "circle"


def test_flats_whose_angles_nobody_knows_are_told_one_by_one() -> None:
    shapes = made([section._replace(angle=None) for section in flats(2)], "siemens-iso")
    assert len(shapes) == 2
    assert all(angles(shape) == [None] for shape in shapes)


def test_a_shape_in_a_shape_keeps_its_own_section() -> None:
    pocket = polygon(4, 16.0)
    sections = [Section(polygon(6, 40.0), 10.0), Section(pocket, 20.0, side=41, approach=4.0)]
    outside, inside = made(sections, radius=2.0)
    assert (outside.shape, outside.inside, angles(outside)) == ("hexagon", False, [10.0])
    assert (inside.shape, inside.inside, angles(inside)) == ("square", True, [20.0])
    assert outside.line < inside.line


@pytest.mark.one_in(12)
@pytest.mark.parametrize(("control", "inch"), VARIATIONS)
@pytest.mark.parametrize("first", [0.0, 15.0])
def test_flats_that_close_no_polygon_are_told_with_their_angles(first: float, control: str, inch: bool) -> None:
    entries = [first + angle for angle in (0.0, 60.0, 120.0, 180.0, 240.0)]
    (shape,) = made([Section(flat(12.0, 14.0), angle) for angle in entries], control, inch)
    assert (shape.shape, shape.values["flats"]) == ("flats", 5)
    assert shape.values["distance"] == pytest.approx(12.0, abs=0.003)
    assert [shape.values[f"turned_{number}"] for number in range(1, 6)] == pytest.approx(entries)
    assert angles(shape) == entries
    assert f" at C{first:g}, C{first + 60:g}, C{first + 120:g}, C{first + 180:g}, C{first + 240:g}" in shape.text


def test_what_has_no_name_together_is_told_one_by_one() -> None:
    sections = [Section(flat(distance, 22.0), angle) for distance, angle in ((10.0, 0.0), (12.0, 100.0), (13.0, 240.0))]
    (shape,) = made(sections)
    assert "3 flats, 10.000 at 0 deg, 12.000 at 100 deg and 13.000 at 240 deg from the center;" in shape.text
    shapes = made([Section(polygon(6, 30.0)), Section(flat(10.0, 20.0), 30.0)])
    assert [(shape.shape, angles(shape)) for shape in shapes] == [("hexagon", [0.0]), ("flats", [30.0])]


@pytest.mark.ci
@looped(("control", "inch"), VARIATIONS, one_in=2)
def test_a_flat_of_several_that_is_off_is_told_with_its_line(control: str, inch: bool) -> None:
    sections = flats(6, half=14.0)
    sections[4] = sections[4]._replace(points=flat(12.1, 14.0))
    (shape,) = made(sections, control, inch)
    assert (shape.shape, len(shape.odd)) == ("hexagon", 1)
    assert shape.odd[0].size == pytest.approx(24.2, abs=0.004)
    assert shape.sections[4].line < shape.odd[0].line < shape.sections[4].end_line


def test_flats_at_uneven_angles_are_told_together_each_with_its_direction() -> None:
    (shape,) = made([Section(flat(12.0, 22.0), angle) for angle in (0.0, 100.0, 240.0)])
    assert [shape.values[f"turned_{number}"] for number in (1, 2, 3)] == pytest.approx([0.0, 100.0, 240.0])
    assert shape.text.startswith("3 flats, 12.000 from the center at 0, 100 and 240 deg; to Z-5.000; by the sections")


def test_roughing_and_finishing_of_one_shape_are_one() -> None:
    (shape,) = made([Section(polygon(6, 30.0)), Section(polygon(6, 30.0))])
    assert len(shape.sections) == 2
    assert shape.text == "hexagon, 30.000 across flats; to Z-5.000; by the sections of lines 8, 23"
    finished, rough = made([Section(polygon(6, 31.0)), Section(polygon(6, 30.0))])
    assert sorted(shape.values["across_flats"] for shape in (finished, rough)) == pytest.approx([30, 31], abs=0.001)


# ---- without compensation ----


def path(distance: float, angle: float, radius: float = 8.0) -> Section:
    return Section([complex(distance + radius, -40), complex(distance + radius, 40)], angle, side=40, approach=60.0)


@pytest.mark.one_in(12)
@pytest.mark.ci
@pytest.mark.parametrize(("control", "inch"), VARIATIONS)
@pytest.mark.parametrize("first", [0.0, 10.0])
def test_paths_of_the_center_are_put_together_likewise(first: float, control: str, inch: bool) -> None:
    (shape,) = made([path(12.0, first + angle) for angle in (0.0, 120.0, 240.0)], control, inch, 8.0, stock=40.0)
    assert shape.shape == "triangle"
    assert shape.values["across_flats"] == pytest.approx(24.0, abs=0.004)
    assert shape.values["turned"] == pytest.approx(first, abs=0.02)
    assert len(shape.sections) == 3
    (shape,) = made([path(12.0, first + angle) for angle in (0.0, 180.0)], control, inch, 8.0, stock=40.0)
    assert shape.values["apart"] == pytest.approx(24.0, abs=0.004)


@pytest.mark.ci
@looped("entry", [5.0, 10.0, 45.0])
def test_a_closed_path_is_the_same_at_any_angle(entry: float) -> None:
    shape, *_ = made([Section(polygon(6, 46.0), entry, side=40, approach=60.0)], radius=8.0)
    assert (shape.shape, shape.is_regular) == ("hexagon", True)
    assert shape.values["across_flats"] == pytest.approx(30.0, abs=0.004)
    assert shape.values["turned"] == pytest.approx(entry, abs=0.02)


def test_slots_with_c_between_them_stay_slots() -> None:
    sections = [Section([10 + 0j, 20 + 0j], angle, side=40, approach=10.0) for angle in (0.0, 90.0, 180.0, 270.0)]
    shapes = made(sections)
    assert [shape.shape for shape in shapes] == ["slot"] * 4
    places = [complex(shape.values["center_x"], shape.values["center_c"]) for shape in shapes]
    assert places == [pytest.approx(place) for place in (15, 15j, -15, -15j)]


# ---- reports ----


def test_json_has_the_sections() -> None:
    Path("a.nc").write_text(program(flats(3)))
    said = json.loads(call("part", "a.nc", "--tool", tool(3), "--format", "json").stdout)
    (shape,) = said["files"][0]["part"]
    assert shape["sections"] == [
        {"line": 8, "end_line": 15, "angle": 0.0},
        {"line": 17, "end_line": 24, "angle": 120.0},
        {"line": 26, "end_line": 33, "angle": 240.0},
    ]


@pytest.mark.one_in(8)
@pytest.mark.nightly
@pytest.mark.parametrize("inch", [False, True])
@pytest.mark.parametrize("control", ["fanuc", "haas-lathe"])
@pytest.mark.parametrize("entry", [0.0, 20.0])
def test_a_section_that_no_part_is_for_is_told_as_what_it_makes(entry: float, control: str, inch: bool) -> None:
    sections = [Section(polygon(6, 25.4), entry), Section(polygon(4, 20.32), entry, depths=(-2.54,))]
    Path("a.nc").write_text(program(sections, control, inch))
    size = 1.0 if inch else 25.4
    Path("polarcheck.toml").write_text(f'[[part]]\nshape = "hexagon"\nacross_flats = {size}\nsection = 1\n')
    arguments = ("a.nc", "--machine", control, "--tool", tool(4, inch))
    said = call("part", *arguments)
    assert said.exit_code == 0, said.stdout
    words = " ".join(said.stdout.split())
    assert f"square, {'0.8000' if inch else '20.320'} across flats" in words
    assert words.count("but compared with nothing: no [[part]] is for this section") == 1
    assert words.index("square") < words.index("compared with nothing")
    (file,) = json.loads(call("part", *arguments, "--format", "json").stdout)["files"]
    assert [shape["is_compared"] for shape in file["part"]] == [True, False]


# ---- init --part ----


def of_init(sections: list[Section], control: str = "fanuc", inch: bool = False) -> str:
    Path("a.nc").write_text(program(sections, control, inch))
    return call("init", "--part", "a.nc", "--machine", control, "--tool", tool(3, inch)).stdout


@pytest.mark.one_in(14)
@pytest.mark.ci
@pytest.mark.parametrize(("control", "inch"), VARIATIONS)
@pytest.mark.parametrize("first", [0.0, 15.0])
def test_what_sections_make_together_agrees_with_the_part_that_is_written_of_it(
    first: float, control: str, inch: bool
) -> None:
    entry = of_init(flats(3, first=first), control, inch)
    assert "section =" not in entry, "no section makes it alone"
    Path("polarcheck.toml").write_text(entry)
    said = call("part", "a.nc", "--machine", control, "--tool", tool(3, inch))
    assert said.exit_code == 0, said.stdout
    assert "agrees with the triangle asked for" in said.stdout


def test_an_angle_that_nobody_knows_is_no_part_of_the_entry() -> None:
    assert "turned" not in of_init([Section(polygon(6, 30.0, 10.0), None)], "siemens-iso").partition("[[part]]")[2]
    assert "turned = 30" in of_init([Section(polygon(6, 30.0, 10.0), 20.0)])


def test_flats_at_unequal_angles_have_no_entry() -> None:
    entry = of_init([Section(flat(12.0, 14.0), angle) for angle in (0.0, 60.0, 120.0, 180.0, 240.0)])
    assert "\n[[part]]" not in entry
