"""A drawing in other units, shifted, mirrored, turned or with X as a diameter is told as that, and never agrees."""

from __future__ import annotations

import cmath
import math
import re
from typing import Any

import msgspec
import pytest
import shapely
from cases import looped
from programs import job_of, report_of
from test_deviations import HEAD, RULE, TAIL, drawn, polygon, program

from polarcheck.program.machines.job import Job
from polarcheck.program.machines.part_keys import DrawnPart

EGG = [complex(20, -9), complex(20, 12), complex(-12, 18), complex(-15, -11)]
TURN = cmath.exp(1j * math.radians(30))


def said(text: str, job: Any, radius: float = 3.0, machine: str = "fanuc-30i") -> str:
    """The message of the only finding."""
    (finding,) = report_of(text, machine, f"1:radius={radius:.6f}", job=job, only=[RULE]).findings
    return finding.message


def on(machine: str, text: str) -> str:
    """The same program in the words of another control; that of Haas has X as a radius."""
    if machine != "haas-lathe":
        return text

    def changed(section: re.Match[str]) -> str:
        return re.sub(r"X(-?[\d.]+)", lambda word: f"X{float(word[1]) / 2:.5f}", section[0].replace("C", "Y"))

    return (
        re.sub(r"(?<=G12.1).*?(?=G13.1)", changed, text, flags=re.DOTALL)
        .replace("G12.1", "G112\nG17")
        .replace("G13.1", "G113\nG18")
    )


def drawing(corners: list[complex], scale: float = 1.0) -> Job:
    """A job with a drawing of one contour [mm], in units of so many mm."""
    return drawn(shapely.Polygon([(corner.real, corner.imag) for corner in corners]), scale)


def with_units(job: Job, scale: float) -> Job:
    """The same drawing, whose units are said to be of so many mm."""
    return msgspec.structs.replace(job, part=[msgspec.structs.replace(part, scale=scale) for part in job.part])


CHANGES = {
    "inch": (lambda point: point / 25.4, "The drawing would fit 25.4 times as large (as one in inch): within 0"),
    "mm": (lambda point: point * 25.4, "The drawing would fit 25.4 times as small (as one in mm): within 0"),
    "shifted": (lambda point: point - 12, "The drawing would fit shifted by x 12.000 c 0.000: within 0"),
    "shifted in c": (lambda point: point + 5j, "The drawing would fit shifted by x 0.000 c -5.000: within 0"),
    "both": (
        lambda point: (point - 12 + 1j) / 25.4,
        "The drawing would fit 25.4 times as large (as one in inch) and shifted by x 12.000 c -1.000: within 0",
    ),
    "turned and shifted": (
        lambda point: (point - 12) / TURN,
        "The drawing would fit turned by 30 deg and shifted by x 12.000 c 0.000: within 0",
    ),
    "mirrored and shifted": (
        lambda point: point.conjugate() + 8,
        "The drawing would fit mirrored, with C of the other sign and shifted by x -8.000 c 0.000: within 0",
    ),
    "inch and turned": (
        lambda point: point / 25.4 / TURN,
        "The drawing would fit 25.4 times as large (as one in inch) and turned by 30 deg: within 0",
    ),
    "inch and diameter": (
        lambda point: complex(2 * point.real, point.imag) / 25.4,
        "25.4 times as large (as one in inch) and with half of its X, as diameter and radius are mixed up: within 0",
    ),
    "diameter and shifted": (
        lambda point: complex(2 * point.real, point.imag + 4),
        "with half of its X, as diameter and radius are mixed up and shifted by x 0.000 c -4.000: within 0",
    ),
}


@pytest.mark.ci
@looped("name", CHANGES, one_in=30)
@looped("machine", ["fanuc-30i", "haas-lathe", "siemens-iso"])
def test_a_drawing_that_lies_or_measures_otherwise_is_told_as_that(name: str, machine: str) -> None:
    change, expected = CHANGES[name]
    text = said(on(machine, program(EGG)), drawing([change(corner) for corner in EGG]), machine=machine)
    assert expected in text


@looped("name", CHANGES, one_in=12)
def test_so_it_is_where_the_contour_is_turned(name: str) -> None:
    change, expected = CHANGES[name]
    corners = [corner * cmath.exp(2j) for corner in EGG]
    assert expected in said(program(corners), drawing([change(corner) for corner in corners]))


@pytest.mark.nightly
def test_so_it_is_in_inch() -> None:
    text = program([corner / 2 for corner in EGG], scale=25.4)
    job = msgspec.structs.replace(drawing([corner / 2 - 12.7 for corner in EGG], 25.4), units="inch")
    assert "The drawing would fit shifted by x 0.5000 c 0.0000: within 0" in said(text, job, 3 / 25.4)
    half = drawing([corner / 2 for corner in EGG], 1.0)
    job = msgspec.structs.replace(with_units(half, 25.4), units="inch")
    assert "The drawing would fit 25.4 times as small (as one in mm): within 0" in said(text, job, 3 / 25.4)


@pytest.mark.nightly
@looped("of_file", [25.4, math.nan])
def test_units_of_the_file_and_of_the_program(of_file: float) -> None:
    """A drawing without units has those of the program: one in mm does not fit a program in inch."""
    text = program([corner / 2 for corner in EGG], scale=25.4)
    job = msgspec.structs.replace(with_units(drawing([corner / 2 for corner in EGG]), of_file), units="inch")
    assert "25.4 times as small (as one in mm)" in said(text, job, 3 / 25.4)


@pytest.mark.nightly
def test_of_several_contours_each_is_found_in_a_drawing_in_inch() -> None:
    """The curve that comes nearest is another one then."""
    text = program(polygon(6, 13.5)).replace(TAIL, "G13.1\n") + program(polygon(4, 20.0), z=-8.0).removeprefix("O1\n")
    curves = tuple(
        tuple(corner / 25.4 for corner in [*corners, corners[0]])
        for corners in (polygon(6, 13.5), polygon(4, 20.0), polygon(3, 2.0))
    )
    job = msgspec.structs.replace(job_of(), part=[DrawnPart(drawing="a.dxf", curves=curves, scale=1.0)])
    findings = report_of(text, "fanuc-30i", "1:radius=3", job=job, only=[RULE]).findings
    assert findings
    for finding in findings:
        assert "The drawing would fit 25.4 times as large (as one in inch): within 0" in finding.message


@pytest.mark.nightly
@looped(
    ("change", "expected"),
    [
        (lambda point: point / 25.4, "The drawing would fit 25.4 times as large (as one in inch)"),
        (lambda point: point - 12 + 2j, "The drawing would fit shifted by x 12.000 c -2.000"),
        (lambda point: point / TURN, "The part would fit turned by -30 deg"),
    ],
    ids=["inch", "shifted", "turned"],
    one_in=3,
)
def test_of_flats_the_round_of_the_drawing_shows_the_axis(change: Any, expected: str) -> None:
    """A round of 30 with a flat 9 from the center, milled as a wall that ends beyond the bar."""
    text = HEAD + "G1 X80. C-30. F300\nZ-1.\nG42 X18. C-25.\nC25.\nG40 X80. C30.\n" + TAIL
    round_ = shapely.Point(0, 0).buffer(15, quad_segs=100)
    shaft = shapely.intersection(round_, shapely.box(-20, -20, 9, 20))
    corners = [change(complex(x, c)) for x, c in shaft.exterior.coords[:-1]]
    assert expected in said(text, drawing(corners))


def center_path(corners: list[complex]) -> str:
    """The way of the tool center along these corners, without G41 and G42."""
    middle = (corners[-1] + corners[0]) / 2
    away = middle * (1 + 30 / abs(middle))

    def at(point: complex) -> str:
        return f"X{2 * point.real:.5f} C{point.imag:.5f}"

    blocks = [f"G1 {at(away)} F300", "Z-3.", at(middle), *map(at, corners), at(middle), at(away), "Z2."]
    return HEAD + "\n".join(blocks) + "\n" + TAIL


@pytest.mark.nightly
@looped(
    ("change", "expected"),
    [
        (lambda point: point + 12, "The drawing would fit shifted by x -12.000 c 0.000: within 0"),
        (lambda point: point * 25.4, "The drawing would fit 25.4 times as small (as one in mm): within 0"),
        (lambda point: point * TURN, "The part would fit turned by 30 deg: within 0"),
        (
            lambda point: (point - 3j) * 25.4,
            "The drawing would fit 25.4 times as small (as one in mm) and shifted by x 0.000 c 3.000: within 0",
        ),
    ],
    ids=["shifted", "mm", "turned", "both"],
    one_in=12,
)
@looped(("machine", "turn"), [("fanuc-30i", 0.25), ("haas-lathe", 0.0), ("siemens-iso", 0.25)])
def test_so_it_is_without_compensation(change: Any, expected: str, machine: str, turn: float) -> None:
    text = on(machine, center_path(polygon(6, 17.5, turn=turn)))
    assert expected in said(text, drawing([change(corner) for corner in polygon(6, 13.5, turn=turn)]), 4.0, machine)


@pytest.mark.nightly
def test_a_shape_that_is_shifted_or_in_other_units() -> None:
    text = program(polygon(6, 13.5))
    for expected, part in (
        ("The part would fit shifted by x 4.000 c -1.000: within 0", {"across_flats": 27.0, "center": [4.0, -1.0]}),
        ("The hexagon would fit 25.4 times as large (as one in inch): within 0", {"across_flats": 27 / 25.4}),
        ("The hexagon would fit 25.4 times as small (as one in mm): within 0", {"across_flats": 27 * 25.4}),
        ("The part would fit turned by 10 deg: within 0", {"across_flats": 27.0, "turned": 10.0}),
    ):
        assert expected in said(text, {"part": [{"shape": "hexagon", **part}]})


@pytest.mark.nightly
@looped("off", [0.03, 0.06, 0.3, -0.3], one_in=4)
def test_one_side_that_is_off_is_no_shift(off: float) -> None:
    text = program(polygon(4, 20.0, {1: off}))
    assert "would fit" not in said(text, {"part": [{"shape": "square", "across_flats": 40.0}]})


@pytest.mark.nightly
def test_a_shift_is_told_to_the_last_digit_beside_a_small_slip() -> None:
    corners = polygon(6, 13.5, {1: 0.05})
    message = said(program(corners), drawing([corner + 12 for corner in polygon(6, 13.5)]))
    assert "The drawing would fit shifted by x -12.000 c 0.000: within 0.0" in message
