"""What `polarcheck part` must see: contours that run on past their start, Z not known, ends beside starts."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from cases import looped
from drawn_contours import CONTROLS, Drawn, Element
from overlapped_contours import LEADS, Overlapped, contour, overlapped
from programs import tables_of
from test_cli import call

from polarcheck.foundation.finding import MadeShape
from polarcheck.reports.made_parts.part_report import made_by
from polarcheck.view.section_view import views_of

#: Of what is told of a contour, the share of the length of its walls by which its area may be off: points are rounded,
#: and sides that are straight but for that are one [mm].
ROUNDED = 0.005

BY_MACHINE = {"inch" if control.unit > 1 else control.machine: control for control in CONTROLS}
QUADRILATERAL = [complex(18, 3), complex(2, 16), complex(-17, 5), complex(-3, -14)]


def made(text: str, *tools: str, machine: str = "fanuc", stock: float = 0) -> list[MadeShape]:
    job = {"stock": {"diameter": stock}} if stock else {}
    return made_by(tables_of(text, machine, *tools, job=job))


# ---- contours that run on past their start ----


def is_seen(shape: Overlapped, drift: complex = 0) -> bool:
    """One closed shape is told, and its area and that of the finished part are those of the contour."""
    drawn = shape.drawn
    tables = tables_of(drawn.text(), drawn.machine, *drawn.tools)
    levels, shapes = tables["finished"].levels, made_by(tables)
    if len(levels) != 1 or levels[0].open or len(shapes) != 1:
        return False
    is_pocket, slack = drawn.side == "G41", (ROUNDED + abs(drift)) * shape.around
    areas = [shapes[0].values.get("area", shape.area)]
    areas += [] if is_pocket else [levels[0].polygon.area]
    return shapes[0].inside == is_pocket and all(abs(area - shape.area) <= slack for area in areas)


@pytest.mark.ci
@looped("turned", [0.0, 33.0], one_in=12)
@looped("control", BY_MACHINE)
def test_a_quadrilateral_with_corners_of_chords_that_ends_past_its_start(control: str, turned: float) -> None:
    corners = [cmath.rect(abs(point), cmath.phase(point) + math.radians(turned)) for point in QUADRILATERAL]
    shape = overlapped(corners, 1.5, 16, 0.34, control=BY_MACHINE[control])
    (seen,) = made(shape.drawn.text(), *shape.drawn.tools, machine=shape.drawn.machine)
    assert is_seen(shape), seen.text
    assert "open" not in seen.text


@pytest.mark.nightly
def test_closed_contours_that_end_past_their_start() -> None:
    assert [seed for seed in range(12) if not is_seen(contour(seed))] == []


@pytest.mark.nightly
def test_many_closed_contours_that_end_past_their_start() -> None:
    assert [seed for seed in range(12, 200) if not is_seen(contour(seed))] == []


def test_two_contours_of_one_level_that_end_past_their_start() -> None:
    """A boss and the pocket in it: the one closes by itself, the other by joining its end to its first wall."""
    boss = overlapped(QUADRILATERAL, 1.5, 16, 0.5).drawn.blocks()
    square = [complex(4, 0), complex(0, 4), complex(-4, 0), complex(0, -4)]
    pocket = overlapped(square, 1, 0, 0.5, is_pocket=True, overlap=0).drawn.blocks()
    begin, end = pocket.index("G12.1") + 1, pocket.index("G13.1")
    at = boss.index("G13.1")
    text = "\n".join([*boss[:at], *pocket[begin:end], *boss[at:]])
    shapes = made(text, "1:radius=0.5")
    assert sorted((shape.shape, shape.inside) for shape in shapes) == [("contour", False), ("square", True)]


# ---- contours that end beside their start ----


@pytest.mark.nightly
@looped("control", BY_MACHINE, one_in=9)
def test_a_contour_that_ends_beside_its_start_keeps_its_last_wall(control: str) -> None:
    for number in range(24):
        turned = [cmath.rect(1, math.radians(7 * number)) * point for point in QUADRILATERAL]
        drift = cmath.rect(0.05, math.radians(90 * number + 10))
        overlap = (0, 0.2, 1)[number % 3]
        leads = LEADS[number % 4], LEADS[number // 4 % 4]
        shape = overlapped(turned, 1.5, 0, 2, overlap=overlap, leads=leads, drift=drift, control=BY_MACHINE[control])
        assert is_seen(shape, drift), shape.drawn.text()
    pocket = overlapped(QUADRILATERAL, 1.5, 0, 0.5, is_pocket=True, overlap=0, drift=0.05, control=BY_MACHINE[control])
    assert is_seen(pocket, 0.05)


@pytest.mark.ci
@looped("turned", [0.0, 17.0], one_in=24)
@looped("control", BY_MACHINE)
@looped("drift", [0.05, -0.05, 0.3, -0.3, 0.05j, -0.05j, 0.1 + 0.1j])
def test_a_hexagon_that_ends_beside_its_first_corner(control: str, turned: float, drift: complex) -> None:
    corners = [cmath.rect(20, math.radians(turned + 60 * number)) for number in range(7)]
    off = drift * cmath.rect(1, math.radians(turned))
    ends = [*map(Element, corners[1:-1]), Element(corners[-1] + off)]
    drawn = Drawn("", corners[0], tuple(ends), BY_MACHINE[control], "G42", 1.5 * corners[0], 4, False, False, (2.0,))
    (seen,) = made(drawn.text(), *drawn.tools, machine=drawn.machine)
    assert seen.shape == "hexagon"
    assert not seen.is_regular
    (odd,) = seen.odd
    assert odd.size == pytest.approx(
        40 * math.cos(math.pi / 6) + 2 * (drift * cmath.rect(1, math.pi / 6)).real, abs=0.15
    )


def test_the_walls_of_a_blade_are_not_closed() -> None:
    """They end as near to each other, but run against each other: the blade goes on."""
    text = (
        "G21 G98 G40 T0808\nG0 X80. Z2. C0\nG12.1\nG1 X60. C-0.4 F300\nZ-2.\nG41 X40. C-0.4 F200\nX-10.\n"
        "G2 X-10. C0.4 R0.4\nG1 X40.\nG40 X60.\nZ2.\nG13.1\nM30\n"
    )
    (seen,) = made(text, "8:radius=0.6")
    assert seen.text == "flats 0.800 apart, an arc R0.400 from one to the other, turned by 90 deg; to Z-2.000"


# ---- Z is not known ----


def without_z(text: str) -> str:
    """The program without its Z words."""
    lines = (re.sub(r" ?Z-?[\d.]+", "", line) for line in text.split("\n"))
    return "\n".join(line for line in lines if line)


def hexagon(control: str, turned: float = 0, narrower: float = 1, distance: float = 15) -> Drawn:
    """A hexagon from the middle of a side, its X so many times as large."""
    normals = [cmath.rect(1, math.radians(turned + 60 * number)) for number in range(6)]
    corners = [normal * complex(1, math.tan(math.pi / 6)) * distance for normal in normals]
    points = [complex(point.real * narrower, point.imag) for point in [*corners, (corners[-1] + corners[0]) / 2]]
    away = points[-1] + 12 * normals[0]
    return Drawn("", points[-1], tuple(map(Element, points)), BY_MACHINE[control], "G42", away, 4, False, False, (2.0,))


@pytest.mark.ci
@looped("turned", [0.0, 11.0], one_in=3)
@looped("control", BY_MACHINE)
def test_a_hexagon_without_z_words(control: str, turned: float) -> None:
    drawn = hexagon(control, turned)
    (seen,) = made(without_z(drawn.text()), *drawn.tools, machine=drawn.machine)
    assert (seen.shape, seen.is_regular, seen.z) == ("hexagon", True, None)
    assert seen.text.endswith("; to Z not known")


@pytest.mark.ci
@looped("narrower", [1.0, 0.6, 0.3], one_in=12)
@looped("control", BY_MACHINE)
def test_a_hexagon_without_z_words_as_the_path_of_the_tool(control: str, narrower: float) -> None:
    """All its sides are one level, however short: what they leave is as with Z words."""
    drawn = hexagon(control, narrower=narrower, distance=22)
    text = re.sub(r"G4[02] ", "", drawn.text())
    with_z = made(text, *drawn.tools, machine=drawn.machine)
    seen = made(without_z(text), *drawn.tools, machine=drawn.machine)
    assert [shape.shape for shape in seen] == [shape.shape for shape in with_z]
    assert seen[0].values == with_z[0].values
    assert all(shape.text.endswith("; to Z not known") for shape in seen)


def strokes(down: str, up: str, sides: int = 6) -> str:
    """Flats one after another, each with its own way down and up."""
    blocks = ["G21 G98 G40 T0808", "G0 X80. C0", "G12.1"]
    for number in range(sides):
        normal = cmath.rect(1, 2 * math.pi * number / sides)
        begin, end = (complex(15, along) * normal for along in (-18, 18))
        far, away = (point + 8 * normal for point in (begin, end))
        blocks += [f"G1 X{2 * far.real:.3f} C{far.imag:.3f} F900", down, f"G42 X{2 * begin.real:.3f} C{begin.imag:.3f}"]
        blocks += [f"X{2 * end.real:.3f} C{end.imag:.3f}", f"G40 X{2 * away.real:.3f} C{away.imag:.3f}", up]
    return "\n".join([*blocks, "G13.1", "M30", ""])


def test_flats_by_increments_of_z() -> None:
    (seen,) = made(strokes("W-5.", "W5."), "8:radius=4")
    assert seen.text == "hexagon, 30.000 across flats; to Z not known"


@pytest.mark.nightly
def test_shapes_at_two_depths_by_increments_of_z() -> None:
    """They are told apart, though nobody knows at which Z they are."""
    first = hexagon("fanuc").loop()
    text = "G21 G98 G40 T0101\nG0 X80. C0\nG12.1\nG1 X54. C0 F200\nW-3.\n" + "\n".join(first)
    text += "\nW-3.\nG42 X50. C0\nG3 X50. C0 I-25.\nG1 G40 X70.\nG13.1\nM30\n"
    assert [shape.shape for shape in made(text, "1:radius=4")] == ["hexagon", "circle"]


# ---- numbers without a decimal point ----

ROUND = "{units} G98 G40 T0808\nG0 X{far} Z2. C0\n{on}\nG1 X{far} F300\nZ-.2\nG42 X{x} C0 F200\nG3 X{end} C0 I-{r}\n"
ROUND += "G1 G40 X{far}\nZ2.\n{off}\nM30\n"
IN_MM = {"units": "G21", "far": "180.", "x": "140", "end": "140.", "r": "70.", "on": "G12.1", "off": "G13.1"}
IN_INCH = {**IN_MM, "units": "G20", "far": "7.", "x": "5", "end": "5.", "r": "2.5"}


@pytest.mark.ci
@looped(
    ("words", "machine", "as_meant"),
    [
        (IN_MM, "fanuc", "line 6: X140 is taken as X140., as probably meant; the control reads 0.140"),
        (IN_MM, "siemens-iso", "line 6: X140 is taken as X140., as probably meant; the control reads 0.140"),
        (IN_INCH, "fanuc", "line 6: X5 is taken as X5., as probably meant; the control reads 0.0005"),
        (
            {**IN_MM, "r": "70"},
            "fanuc",
            "line 6: X140 is taken as X140., as probably meant (and 1 more number without a decimal point); "
            "the control reads 0.140",
        ),
        ({**IN_MM, "on": "G112", "off": "G113"}, "haas-lathe", None),  # it reads whole units
        ({**IN_MM, "x": "140."}, "fanuc", None),
    ],
)
def test_a_number_that_is_taken_as_meant_is_told(words: dict[str, str], machine: str, as_meant: str | None) -> None:
    tables = tables_of(ROUND.format_map(words), machine, "8:radius=4")
    (seen,) = made_by(tables)
    assert seen.as_meant == as_meant
    assert seen.shape == "circle"
    (view,) = views_of(tables)
    assert view.remarks == ([as_meant] if as_meant else [])


@pytest.mark.ci
@pytest.mark.usefixtures("own_folder")
def test_the_report_of_the_part_and_its_page_tell_what_is_taken_as_meant() -> None:
    Path("round.nc").write_text(ROUND.format_map(IN_MM))
    said = "line 6: X140 is taken as X140., as probably meant; the control reads 0.140"
    assert f"       but   {said}\n" in call("part", "round.nc", "--tool", "8:radius=4").stdout
    assert said in call("plot", "round.nc", "--tool", "8:radius=4").stdout


# ---- passes that differ ----


def at_depths(control: str, off: dict[int, complex], turned: float = 0, count: int = 3) -> list[MadeShape]:
    """Passes of a hexagon at Z-2, Z-4, ..; in those of `off`, numbered from 0, its second corner is so far away."""
    passes = []
    for number in range(count):
        drawn = hexagon(control, turned)
        corners = list(drawn.elements)
        corners[2] = Element(corners[2].end + off.get(number, 0))
        passes.append(replace(drawn, elements=tuple(corners), depths=(2.0 * number + 2,)).blocks())
    at = passes[0].index(f"Z{drawn.number(2)}")
    begin = next(number for number, block in enumerate(passes[0]) if block == f"Z{drawn.number(-2)}")
    blocks = [*passes[0][:begin], *(block for one in passes for block in one[begin:at]), *passes[0][at:]]
    return made("\n".join(blocks), *drawn.tools, machine=drawn.machine)


@pytest.mark.ci
@looped("turned", [0.0, 20.0], one_in=18)
@looped("control", BY_MACHINE)
def test_a_pass_that_differs_is_told_apart_with_how_much(control: str, turned: float) -> None:
    outward = cmath.rect(1, math.radians(turned + 30 + 120))
    unit = BY_MACHINE[control].unit
    for number in range(3):
        odd, sound = sorted(at_depths(control, {number: -5 * outward}, turned), key=lambda shape: len(shape.depths))
        assert (len(odd.depths), len(sound.depths)) == (1, 2)
        assert odd.depths[0] == pytest.approx(-2.0 * number - 2, abs=0.01)
        assert (sound.shape, sound.is_regular) == ("hexagon", True)
        assert "than at" not in sound.text
        (depth,) = re.findall(r"cuts up to ([\d.]+) deeper than at Z-", odd.text)
        assert float(depth) * unit == pytest.approx(5, abs=0.1)  # the new corner is nearly flat
    odd, _ = at_depths(control, {0: 1 * outward}, turned)
    (more,) = re.findall(r"leaves up to ([\d.]+) more than at Z-", odd.text)
    assert float(more) * unit == pytest.approx(1, abs=0.01)


@pytest.mark.ci
@looped("control", BY_MACHINE, one_in=2)
def test_passes_that_are_the_same_are_one_entry(control: str) -> None:
    (seen,) = at_depths(control, {})
    assert len(seen.depths) == 3


def test_passes_of_the_same_extents_that_differ_are_told_apart() -> None:
    """A groove in one of two passes of a contour: their extents are the same."""
    way = "X30. F200\nC10.\nX10.\nC{depth}\nX-10.\nC10.\nX-30.\nC-10.\nX30.\nC0\n"
    head = "G21 G98 G40 T0808\nG0 X60. Z2. C0\nG12.1\nG1 X50. F300\nZ-2.\nG42 "
    text = head + way.format(depth="4.") + "Z-4.\n" + way.format(depth="3.") + "G40 X50.\nZ2.\nG13.1\nM30\n"
    first, second = made(text, "8:radius=2")
    assert (first.depths, second.depths) == ([-2], [-4])
    assert "leaves up to 1.000 more than at Z-4.000" in first.text


def test_shapes_one_behind_the_other_are_not_compared() -> None:
    text = "G21 G98 G40 T0101\nG0 X80. Z2. C0\nG12.1\nG1 X54. C0 F200\nZ-3.\n" + "\n".join(hexagon("fanuc").loop())
    text += "\nZ-6.\nG42 X50. C0\nG3 X50. C0 I-25.\nG1 G40 X70.\nZ2.\nG13.1\nM30\n"
    assert [shape.text for shape in made(text, "1:radius=4")] == [
        "hexagon, 30.000 across flats; to Z-3.000",
        "circle 50.000; to Z-6.000",
    ]


def test_passes_of_the_path_of_the_tool_that_differ() -> None:
    """What stands within the path is compared; of a pocket what is cleared."""
    corners = [cmath.rect(22, math.radians(60 * number)) for number in range(7)]
    off = [*corners[:2], 0.9 * corners[2], *corners[3:]]
    ways = ("\n".join(f"X{2 * point.real:.3f} C{point.imag:.3f}" for point in way) for way in (off, corners))
    head = "G21 G98 G40 T0808\nG0 X90. Z2. C0\nG12.1\nG1 X80. C0 F300\n"
    boss = head + "".join(f"Z-{number}.\n{way}\n" for number, way in enumerate(ways, 1)) + "X90.\nZ2.\nG13.1\nM30\n"
    told = [shape.text for shape in made(boss, "8:radius=4") if shape.shape in ("hexagon", "polygon")]
    assert len(told) == 2
    assert "cuts up to 1.98" in told[0]
    assert " deeper than at Z-2.000" in told[0]
    way = "X16. C0\nC{c}.\nX-16.\nC-10.\nX16.\nC0\nX6. C0\nC3.\nX-6.\nC-3.\nX6.\nC0\nX0\n"
    pocket = head.replace("X80.", "X0").replace("X90.", "X0") + "Z-2.\n" + way.format(c=10) + "Z-4.\n" + way.format(c=9)
    first, second = made(pocket + "Z2.\nG13.1\nM30\n", "8:radius=4")
    assert "cuts up to 1.000 deeper than at Z-4.000" in first.text
    assert "than at" not in second.text
