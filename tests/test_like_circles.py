"""Full circles among like ones: one with another I or J than its lead says is told."""

from __future__ import annotations

import tracemalloc

import pytest
from programs import report_of

CENTERS = ((40, 0), (0, 20), (-40, 0), (0, -20))


def pockets(circles: list[str], depths: tuple[str, ...] = ("-3.",)) -> str:
    """Pockets about their centers, each of which is circled so, at these depths."""
    cuts = "".join(
        f"G1 X{x}. C{c}. F1500\n"
        + "".join(f"G1 Z{z} F60\nG41 X{x + 12}. F120\n{circle}\nG1 G40 X{x}.\n" for z in depths)
        + "Z2. F1500\n"
        for circle, (x, c) in zip(circles, CENTERS, strict=False)
    )
    head = "O1\nG21 G98 G40\nT0808\nG97 S3000 M13\nG28 H0\nG0 X50. C0 Z2.\nG12.1\n"
    return f"{head}{cuts}G13.1\nG0 X100. Z50.\nM5\nM30\n"


def told(text: str) -> list[tuple[str, str]]:
    """The line of each finding, and what it says."""
    found = report_of(text, "fanuc-30i", "8:radius=3,nose=0").findings
    return [(finding.rule, text.splitlines()[finding.line - 1]) for finding in found if finding.severity != "note"]


@pytest.mark.parametrize("which", range(4))
@pytest.mark.parametrize("odd", ["G3 I-7. J0", "G3 I-66. J0", "G3 I-60.", "G3 I-8.4"])
def test_one_of_four_is_odd(which: int, odd: str) -> None:
    circles = ["G3 I-6. J0"] * 4
    circles[which] = odd
    assert told(pockets(circles)) == [("circle-center-doubled", odd)]


@pytest.mark.parametrize(
    ("odd", "is_told"), [("G3 I-66.", True), ("G3 I-60.", True), ("G3 I-7.", False), ("G3 I-8.4", False)]
)
def test_of_two_a_slip_of_the_pen_tells_the_odd_one(odd: str, is_told: bool) -> None:
    assert told(pockets(["G3 I-6.", odd])) == [("circle-center-doubled", odd)] * is_told


@pytest.mark.parametrize(
    "circles",
    [
        ["G3 I-6."] * 4,
        # Arcs from the wall on: the lead is shorter than R in all of them.
        ["G3 I-9."] * 4,
        # Of other sizes, each about the point from which the tool comes.
        ["G3 I-6.", "G3 I-6.", "G3 I-6. (LARGER)"],
    ],
)
def test_pockets_that_are_meant_are_told_nothing(circles: list[str]) -> None:
    assert told(pockets(circles)) == []


def test_a_circle_at_two_depths_is_told_once() -> None:
    text = pockets(["G3 I-6."] * 4, ("-3.", "-6."))
    first = text.index("G3 I-6.", text.index("G3 I-6.") + 1)
    assert told(text[:first] + "G3 I-7." + text[first + 7 :]) == [("circle-center-doubled", "G3 I-7.")]


@pytest.mark.parametrize(
    ("depths", "line"), [(["-3.", "-33.", "-3.", "-3."], "Z-33. F60"), (["-3.", "-3.", "-.3"], "Z-.3 F60")]
)
def test_a_pocket_at_another_depth_by_a_slip_of_the_pen_is_told(depths: list[str], line: str) -> None:
    text = pockets(["G3 I-6."] * len(depths)).replace("G1 Z-3.", "G1 Z{}").format(*depths)
    assert told(text) == [("pass-depth-differs", f"G1 {line}")]


@pytest.mark.parametrize("depths", [["-3.", "-4.", "-3.", "-3."], ["-3.", "-6.", "-6.", "-3."]])
def test_a_pocket_may_be_deeper(depths: list[str]) -> None:
    assert told(pockets(["G3 I-6."] * 4).replace("G1 Z-3.", "G1 Z{}").format(*depths)) == []


GROOVE = ["G3 I-12.5 J0", "G3 I-12.5 J0", "G3 I-12.5 J0"]


def groove(circles: list[str]) -> str:
    """A groove on the face by a circle at each depth."""
    cuts = "".join(f"G1 Z-{depth}. F40\n{circle} F120\n" for depth, circle in enumerate(circles, 1))
    head = "O1\nG21 G98 G40\nT0808\nG97 S3000 M13\nG28 H0\nG0 X25. C0 Z2.\nG12.1\n"
    return f"{head}{cuts}G1 Z2. F800\nG13.1\nG0 X100. Z50.\nM5\nM30\n"


@pytest.mark.parametrize("which", range(3))
@pytest.mark.parametrize("odd", ["G3 I-12.4 J0", "G3 I-15.2 J0", "G3 I12.5 J0", "G3 I-125. J0"])
def test_a_circle_unlike_those_at_other_depths_is_told(which: int, odd: str) -> None:
    circles = [*GROOVE]
    circles[which] = odd
    assert told(groove(circles)) == [("circle-center-doubled", f"{odd} F120")]


@pytest.mark.parametrize("circles", [GROOVE, ["G3 I-12.5", "G3 I-10."], ["G3 I-8.", "G3 I-10.", "G3 I-12.5"]])
def test_circles_at_several_depths_that_are_meant_are_told_nothing(circles: list[str]) -> None:
    assert told(groove(circles)) == []


SIX = [(36, 0.0), (18, 15.588), (-18, 15.588), (-36, 0.0), (-18, -15.588), (18, -15.588)]


def six_holes(old: str = "", new: str = "") -> str:
    cuts = "".join(f"G1 X{x}. C{c} F1500\nZ-4. F50\nG41 X{x + 10}. F110\nG3 I-5.\nG1 G40 X{x}.\nZ2.\n" for x, c in SIX)
    head = "O1\nG21 G98 G40\nT0808\nG97 S3000 M13\nG28 H0\nG0 X50. C0 Z2.\nG12.1\n"
    return f"{head}{cuts.replace(old, new, 1) if old else cuts}G13.1\nG0 X100. Z50.\nM5\nM30\n"


@pytest.mark.ci
@pytest.mark.parametrize(
    ("written", "how"),
    [
        ("C51.588", "two digits are swapped: with C15.588"),
        ("C15.558", "a digit is wrong: with C15.588"),
        ("C1.5588", "the point is at the wrong place: with C15.588"),
        ("", "a word is missing: with C15.588"),
    ],
)
def test_a_place_off_the_polygon_of_the_others_is_told(written: str, how: str) -> None:
    (finding,) = (one for one in report_of(six_holes("C15.588", written), "fanuc-30i", "8:radius=3").findings)
    assert finding.line == six_holes().splitlines().index("G1 X18. C15.588 F1500") + 1
    assert how in finding.message


@pytest.mark.parametrize(("old", "new"), [("", ""), ("X18. C15.588", "X19.284 C15.321"), ("C15.588", "C17.")])
def test_places_that_are_meant_are_told_nothing(old: str, new: str) -> None:
    """One hole of six at 57.27 deg keys the part, and one lies 0.4 farther out."""
    assert told(six_holes(old, new)) == []


@pytest.mark.ci
def test_thousands_of_places_are_no_pattern() -> None:
    """Each of 4,000 places beside each other would be 256 MB."""
    cuts = "".join(f"G1 X{20 + number / 100:.2f} C{number % 7}. F1500\nZ-4. F50\nZ2.\n" for number in range(4000))
    tracemalloc.start()
    try:
        assert told(f"O1\nG21 G98 G40\nT0808\nG0 X50. C0 Z2.\nG12.1\n{cuts}G13.1\nM30\n") == []
        assert tracemalloc.get_traced_memory()[1] < 100e6
    finally:
        tracemalloc.stop()
