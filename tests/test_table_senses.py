"""Arcs with the wrong one of G2 and G3, and contours that mean their notches."""

from __future__ import annotations

import re

import numpy as np
import pytest
from cases import looped
from programs import report_of

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X150. Z2. C0\nG12.1\nG1 Z-5. F300.\n"
END = "Z2.\nG13.1\nM30\n"
BY_RADIUS = (
    "G42 X40. C0. F200./C10./G3 X20. C20. R10./G1 X-20./G3 X-40. C10. R10./G1 C-10./G3 X-20. C-20. R10./G1 X20./"
    "G3 X40. C-10. R10./G1 C0./G40 X80."
)
BY_CENTER = (
    "G42 X40. C0. F200./C10./G3 X20. C20. I-10. J0./G1 X-20./G3 X-40. C10. I0. J-10./G1 C-10./G3 X-20. C-20. I10. J0./"
    "G1 X20./G3 X40. C-10. I0. J10./G1 C0./G40 X80."
)
POCKET = "X20. C0./" + BY_RADIUS.replace("G42", "G41").replace("C0./G40 X80.", "C1./G40 X20.")
RULE = "arc-sense-reversed"


def swapped(section: str, *numbers: int) -> str:
    """The section with the other code in these of its arcs."""
    count = iter(range(100))
    return re.sub(r"G3\b", lambda found: "G2" if next(count) in numbers else found[0], section)


def told(section: str, tool: float, machine: str = "fanuc", head: str = HEAD) -> list[tuple[str, str, str]]:
    """The blocks, rules and severities."""
    text = head + section.replace("/", "\n") + "\n" + END
    report = report_of(text, machine, f"1:radius={tool}")
    return [(found.block, found.rule, found.severity) for found in report.findings]


def hexagon(radius: float, decimals: int, *wrong: int, scale: float = 1.0) -> str:
    """Across corners 40, each rounded; the lines are slanted, so that no end is exact."""
    corner = 20 * np.exp(2j * np.pi * np.arange(6) / 6)
    reach = radius / np.tan(np.pi / 3)
    middle = (corner[5] + corner[0]) / 2

    def words(point: complex) -> str:
        return f"X{2 * point.real * scale:.{decimals}f} C{point.imag * scale:.{decimals}f}"

    blocks = [f"G42 {words(middle)} F200."]
    for number, point in enumerate(corner):
        before, after = corner[number - 1] - point, corner[(number + 1) % 6] - point
        start, end = (point + reach * way / abs(way) for way in (before, after))
        code = "G2" if number in wrong else "G3"
        blocks += [f"G1 {words(start)}", f"{code} {words(end)} R{radius * scale:.{decimals}f}"]
    return "/".join([*blocks, f"G1 {words(middle)}", f"G40 {words(2.2 * middle)}"])


@looped("number", range(4), one_in=12)
@looped("section", [BY_RADIUS, BY_CENTER, POCKET], ids=["R", "I J", "pocket"])
def test_one_of_four_corners(section: str, number: int) -> None:
    [(block, rule, severity)] = told(swapped(section, number), 4)
    assert (rule, severity) == (RULE, "warning")
    assert block.startswith("G2")


@pytest.mark.nightly
@looped("machine", ["fanuc-16i", "fanuc-30i", "gsk-988", "siemens-iso"], one_in=3)
def test_on_other_controls(machine: str) -> None:
    assert [rule for _, rule, _ in told(swapped(BY_RADIUS, 2), 4, machine)] == [RULE]


@pytest.mark.nightly
@looped(("radius", "decimals"), [(3, 3), (3, 2), (0.5, 3), (0.5, 2), (8, 3)], one_in=5)
def test_ends_that_are_rounded(radius: float, decimals: int) -> None:
    assert told(hexagon(radius, decimals), radius / 2) == []
    assert [rule for _, rule, _ in told(hexagon(radius, decimals, 2), radius / 2)] == [RULE]


@pytest.mark.ci
def test_in_inch() -> None:
    head = HEAD.replace("G21", "G20").replace("X150. Z2.", "X6. Z.1").replace("Z-5.", "Z-.2").replace("F300.", "F12.")
    section = hexagon(3, 4, 4, scale=1 / 25.4).replace("F200.", "F8.")
    assert [rule for _, rule, _ in told(section, 0.05, head=head)] == [RULE]


@pytest.mark.nightly
@looped("section", [swapped(BY_RADIUS, 1), swapped(BY_CENTER, 1)], ids=["R", "I J"])
def test_a_notch_too_narrow_for_the_cutter_follows(section: str) -> None:
    [(_, rule, severity)] = told(section, 12)
    assert (rule, severity) == (RULE, "error")


@pytest.mark.ci
def test_the_rest_of_a_circle_needs_no_other_arc() -> None:
    """By I and J a single corner that is the wrong way round goes back along both its walls."""
    section = "G42 X40. C0. F200./C10./G2 X20. C20. I-10. J0./G1 X-40./C-20./X40./C0./G40 X80."
    assert [rule for _, rule, _ in told(section, 4)] == [RULE]


@looped(
    "section",
    [
        BY_RADIUS,
        BY_CENTER,
        POCKET,
        # ears at all corners, at two of them; a single one in a contour without another arc
        BY_RADIUS.replace("G3", "G2"),
        swapped(BY_RADIUS, 0, 2),
        "G42 X40. C0. F200./C10./G2 X20. C20. R10./G1 X-40./C-20./X40./C0./G40 X80.",
        # a hook and a relief groove between two lines in line with each other
        BY_RADIUS.replace("G1 X-20./", "G1 X6./G2 X-6. R3./G1 X-20./"),
        BY_RADIUS.replace("G1 X-20./", "G1 X6./G3 X-6. R3./G1 X-20./"),
        # a dogbone in the corner of a pocket: tangent to neither wall, one way round or the other
        POCKET.replace("G1 X-20./G3 X-40. C10. R10./", "G1 X-32./G2 X-40. C16. R2.829/G1 C10./"),
    ],
    one_in=12,
)
def test_contours_that_mean_their_arcs(section: str) -> None:
    assert RULE not in [rule for _, rule, _ in told(section, 1.5)]


@pytest.mark.ci
def test_each_depth_is_a_contour_of_its_own() -> None:
    """The same mistake at two depths is the only one at each."""
    around = swapped(BY_RADIUS, 1).split("/", 1)[1].replace("/G40 X80.", "")
    section = f"G42 X40. C0. F200./{around}/Z-6./{around}/G40 X80."
    assert [rule for _, rule, _ in told(section, 4)] == [RULE, RULE]


@pytest.mark.ci
def test_without_compensation_nothing_is_said() -> None:
    section = swapped(BY_RADIUS, 1).replace("G42 ", "").replace("G40 ", "")
    assert RULE not in [rule for _, rule, _ in told(section, 4)]


@pytest.mark.ci
def test_a_radius_is_not_needed() -> None:
    text = HEAD + swapped(BY_RADIUS, 1).replace("/", "\n") + "\n" + END
    assert [found.rule for found in report_of(text).findings if found.severity == "warning"] == [RULE]
