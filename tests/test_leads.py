"""Leads of every form: a sound contour is silent, and what one word spoils is told with the word."""

from __future__ import annotations

import cmath
import math
import re

import pytest
from cases import looped
from programs import report_of, tables_of

from polarcheck.reports.made_parts.part_report import made_by

CUTTER = "8:radius=6,nose=0"
_HEAD = "G21 G98 G40\nT0808\nG97 S3000 M13\nG28 H0\nG0 X80. C0 Z2.\nG12.1\nG1 "
_END = "\nZ2. F1500\nG13.1\nG0 Z50.\nM5\nM30\n"
#: Where the way from X80 C0 to the lead goes near the center.
_OF_APPROACH = {"path-through-center", "c-feed-above-limit"}


def block(point: complex) -> str:
    return f"X{2 * point.real:.3f} C{point.imag:.3f}"


def program(corners: list[complex], form: str, before: float = 7.0, behind: float = 9.0) -> str:
    """The contour from outside, counterclockwise, with G42; before and behind: the lengths of its leads [mm]."""
    first, second, last = corners[0], corners[1], corners[-1]
    along, back = (second - first) / abs(second - first), (first - last) / abs(first - last)
    out, out_back = along * -1j * 12, back * -1j * 12
    middle = (first + second) / 2
    start, end, approach, retract = {
        "on extensions": (first - along * before, first + back * behind, out, out_back),
        "crossing, aslant": (first - along * before, first + back * behind, out - along * 3, out_back + back * 4),
        "from the corner": (first, first + back * behind, out - along * 8, out_back),
        "within a side": (middle, middle, out, out),
        "overlapping": (middle, middle + along * 3, out, out),
    }[form]
    around = [*corners[1:], *([] if form in ("on extensions", "crossing, aslant", "from the corner") else [first]), end]
    if form == "from the corner":
        around = [*corners[1:], first + back * behind]
    words = [f"{block(start + approach)} F1500", "Z-4. F300", f"G42 {block(start)} F250", *map(block, around)]
    return _HEAD + "\n".join([*words, f"G40 {block(end + retract)}"]) + _END


def polygon(sides: int, turned: float = 0.5, size: float = 20.0) -> list[complex]:
    return [cmath.rect(size, 2 * math.pi * (number + turned) / sides) for number in range(sides)]


CHAMFERED = [
    complex(*corner)
    for corner in ((22, -10), (22, 10), (17, 15), (-17, 15), (-22, 10), (-22, -10), (-17, -15), (17, -15))
]
FORMS = ("on extensions", "crossing, aslant", "from the corner", "within a side", "overlapping")
SHAPES = {
    "hexagon": polygon(6),
    "hexagon, turned": polygon(6, 0.31),
    "octagon": polygon(8),
    "square": polygon(4),
    "pentagon": polygon(5, 0.2),
    "chamfered": CHAMFERED,
    "irregular": [20 - 9j, 18 + 8j, 5 + 17j, -14 + 15j, -21 - 2j, -9 - 16j],
}


@pytest.mark.nightly
@looped(("shape", "form"), [(shape, form) for shape in SHAPES for form in FORMS], one_in=23)
def test_a_sound_contour_is_silent(shape: str, form: str) -> None:
    for start in range(len(SHAPES[shape])):
        corners = SHAPES[shape][start:] + SHAPES[shape][:start]
        report = report_of(program(corners, form), "fanuc-30i", CUTTER)
        found = {finding.rule for finding in report.findings if finding.severity != "note"}
        assert found <= _OF_APPROACH, (start, form)


@pytest.mark.nightly
@looped(("sides", "form"), [(sides, form) for sides in (6, 8, 10) for form in FORMS], one_in=17)
def test_one_odd_corner_is_told_with_its_value(sides: int, form: str) -> None:
    """Whatever the wrong number is, and wherever the corner stands but beside the leads."""
    for at in range(2, sides - 1):
        corners = polygon(sides, 0.31)
        meant = block(corners[at])
        corners[at] += 2.3 + 1.1j
        report = report_of(program(corners, form), "fanuc-30i", CUTTER)
        (told,) = [finding.message for finding in report.findings if finding.rule == "nearly-regular-contour"]
        words = re.findall(r"[XC]-?[\d.]+", told.partition("with ")[2])
        near = {word[0]: float(word[1:]) for word in meant.split()}
        assert words, told
        assert all(abs(float(word[1:]) - near[word[0]]) < 0.002 for word in words), (at, meant, told)


@pytest.mark.ci
@looped("form", FORMS)
def test_a_hexagon_with_all_x_as_radii_is_told_whatever_its_leads(form: str) -> None:
    corners = [complex(point.real / 2, point.imag) for point in polygon(6)]
    report = report_of(program(corners, form), "fanuc-30i", CUTTER)
    assert "diameter-radius-mixed" in [finding.rule for finding in report.findings]


@pytest.mark.ci
@looped(
    ("corner", "text"),
    [
        ("X40. C26.", "square, 52.000 across flats, 1 corner chamfered 6.000, 3 sharp; to Z-3.000"),
        ("G3 X40. C26. R6.\nG1", "square, 52.000 across flats, 1 corner R6.000, 3 sharp; to Z-3.000"),
    ],
)
def test_one_corner_that_is_otherwise_is_a_marking(corner: str, text: str) -> None:
    body = f"X80. F1000\nZ-3. F200\nG42 X52. C0 F150\nC20.\n{corner}\nX-52. C26.\nC-26.\nX52.\nC0\nG40 X80."
    (made,) = made_by(tables_of(_HEAD + body + _END, "fanuc-30i", "8:radius=4"))
    assert made.text == text
    assert report_of(_HEAD + body + _END, "fanuc-30i", "8:radius=4,nose=0").verdict == "pass"


@pytest.mark.ci
@pytest.mark.parametrize(
    "way",
    [
        "G3 X0 C14. R14. F100\nG2 X28. C0 R14.",
        "G3 X0 C14. I-14. J0 F100\nG2 X28. C0 I0 J-14.",
        "G3 X0 C14. R14. F100\nG2 X-20. C24. R10.\nG3 X0 C14. R10.\nG2 X28. C0 R14.",
        "G3 X0 C14. R14. F100\nG1 Z-4. F40\nG2 X28. C0 R14. F100\nG1 Z-5. F40\nG3 X0 C14. R14. F100",
    ],
)
def test_a_slot_milled_to_and_fro_is_no_reversed_arc(way: str) -> None:
    walls = (
        "\nG1 Z1. F500\nX28. C0\nZ-3. F40\nG41 X36. C0 F100\nG3 X0 C18. R18.\nX0 C10. R4."
        "\nG2 X20. C0 R10.\nG3 X36. C0 R4.\nG3 X31.177 C9. R18.\nG1 G40 X24.249 C7."
    )
    for behind in ("\nG1", walls):
        text = _HEAD + "X28. C0 F500\nZ-3. F40\n" + way + behind + _END
        report = report_of(text, "fanuc-30i", "8:radius=3,nose=0")
        assert "arc-sense-reversed" not in [finding.rule for finding in report.findings]
