"""Columns of arcs: what is written, whether it is a circle, and which reading of X it speaks for."""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import report_of, tables_of

from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import Tables

HEAD = "G98 G0 X60. C0\nG12.1\nG1 X40. C10. F200\n"
"""Leads to the plane point 20 + 10j."""


def last(program: str, column: str, **changes: Any) -> Any:
    """A column of the arcs in the last row of a program that begins with HEAD."""
    return getattr(tables_of(HEAD + program, changes=changes)["arcs"], column)[-1].item()


@pytest.mark.ci
@looped(
    ("block", "by_radius", "by_center", "of_plane", "of_other_plane"),
    [
        ("G3 X20. C20. R10.", True, False, True, False),
        ("G3 X20. C20. I-10. J0", False, True, True, False),
        ("G3 J5.", False, True, True, False),
        ("G3 X20. C20. I-10. J0 R10.", True, False, True, False),  # R counts before I and J
        ("G3 X20. C20.", False, False, True, False),
        ("G3 X20. C20. K5.", False, False, True, True),
        ("G3 X20. C20. I-10. K0", False, True, True, False),  # K0 moves nothing
        ("G3 Z-5. R10.", False, False, False, False),
        ("G3 Z-5. I5. K5.", False, False, False, True),
        ("G3 Z-5. I5.", False, True, True, False),
        ("G1 X20. R10.", False, False, True, False),
    ],
)
def test_what_is_written(block: str, by_radius: bool, by_center: bool, of_plane: bool, of_other_plane: bool) -> None:
    assert last(block, "by_radius") == by_radius
    assert last(block, "by_center") == by_center
    assert last(block, "has_word_of_plane") == of_plane
    assert last(block, "has_word_of_other_plane") == of_other_plane


def test_arcs_are_in_force_in_the_mode_and_where_axis_words_are_coordinates() -> None:
    program = "G3\n" + HEAD + "G3 X20. C20. R10.\nX40. C10. R10.\nM8\nG4 X1.\nG1 X60.\nG13.1\nG2\n"
    in_force = tables_of(program)["arcs"].in_force.tolist()
    assert [line for line, hit in enumerate(in_force, 1) if hit] == [5, 6, 7]


@looped(
    ("block", "same"),
    [("G3 X40. C10. R5.", True), ("G3 I-5.", True), ("M8", True), ("G3 X40.001 C10. R5.", False), ("G1 C20.", False)],
)
def test_rows_that_end_at_their_start(block: str, same: bool) -> None:
    assert last(block, "ends_at_start") == same


def test_of_an_unknown_position_no_end_is_at_its_start() -> None:
    arcs = tables_of("G12.1\nG3 X20. C0 R5.\n")["arcs"]
    assert not arcs.ends_at_start.any()
    assert np.isnan(arcs.chord).all()
    assert arcs.radius[1] == 5
    assert not arcs.is_no_circle.any()


@looped(
    ("block", "start_radius", "end_radius"),
    [
        ("G3 X20. C20. I-10. J0", 10, 10),
        ("G3 X20. C20. I-10. J5.", math.hypot(10, 5), math.hypot(0, 5)),
        ("G3 X20. C20. J5.", 5, math.hypot(10, 5)),
        ("G3 I0 J0", 0, 0),
        ("G3 X20. C20. R10.", math.nan, math.nan),
        ("G1 X20. C20. I-10. J0", math.nan, math.nan),
    ],
)
def test_radii_at_start_and_end(block: str, start_radius: float, end_radius: float) -> None:
    assert last(block, "start_radius") == pytest.approx(start_radius, nan_ok=True)
    assert last(block, "end_radius") == pytest.approx(end_radius, nan_ok=True)


def test_radii_are_in_mm_and_no_diameters() -> None:
    arcs = tables_of("G20 G98 G0 X2. C0\nG12.1\nG3 X1. C.5 I-.5 F5.\nX2. C0 R-.5\n")["arcs"]
    assert arcs.start_radius[2] == pytest.approx(12.7)
    assert arcs.end_radius[2] == pytest.approx(12.7)
    assert arcs.chord[3] == pytest.approx(math.hypot(12.7, 12.7))
    assert arcs.radius[3] == pytest.approx(-12.7)


BY_RADIUS = [(20 + 10j, 10 + 20j, 10.0), (20 + 10j, 20 - 10j, -12.5), (5 + 0j, 5 + 4j, 2.0)]


@looped(("start", "end", "radius"), BY_RADIUS)
@looped("code", ["G2", "G3"])
def test_sweep(code: str, start: complex, end: complex, radius: float) -> None:
    """The chord sees the center under the sweep: 2 asin(chord / 2R), or the rest of the turn for a negative R."""
    program = f"G1 X{2 * start.real:.4f} C{start.imag:.4f}\n{code} X{2 * end.real:.4f} C{end.imag:.4f} R{radius:.4f}\n"
    small = 2 * math.asin(abs(end - start) / (2 * abs(radius)))
    expected = small if radius > 0 else math.tau - small
    assert last(program, "sweep") == pytest.approx(math.degrees(expected))


@looped(
    ("block", "sweep"),
    [("G3 I-20.", 360), ("G3 X20. C20. I-10. J0", 90), ("G2 X20. C20. I-10. J0", 270), ("G1 X20.", math.nan)],
)
def test_sweep_about_a_center(block: str, sweep: float) -> None:
    assert last(block, "sweep") == pytest.approx(sweep, nan_ok=True)


@looped(
    ("block", "no_circle"),
    [
        ("G3 X20. C20. I-10. J0", False),
        ("G3 X20. C20. I-10.02 J0", False),
        ("G3 X20. C20. I-10.04 J0", True),
        ("G3 X20. C20. I0 J0", True),
        ("G3 X20. C20. I-10. J10.", True),
        ("G3 I0 J0", True),
        # start or end are the center, and off the circle by less than the tolerance
        ("G3 X40.02 C10. I0 J0", True),
        ("G3 X40.02 C10. I.01 J0", True),
        ("G3 X20. C20. R10.", False),
        ("G3 X20. C20. R7.07", False),
        ("G3 X20. C20. R7.05", True),
        ("G3 X20. C20. R-7.05", True),
        ("G3 X20. C20.", True),
        ("G3 X40. C10.", False),
        ("G3 X20. C20. I-10. J0 K1.", True),
        ("G3 I-10.", False),
        ("G1 X20. C20. I-10. J5. K1.", False),
    ],
)
def test_no_circle(block: str, no_circle: bool) -> None:
    """Within the tolerance of 0.03 mm an end counts as on its circle, and a diameter as reaching."""
    assert last(block, "is_no_circle") == no_circle


TENTHS = st.integers(-60, 60).map(lambda tenths: f"{tenths / 10:.1f}")
WORDS = st.fixed_dictionaries({}, optional=dict.fromkeys("XCIJKR", TENTHS))
OF_CIRCLES = (
    "arc-without-center",
    "arc-word-of-other-plane",
    "arc-center-on-path",
    "arc-end-off-circle",
    "arc-radius-too-small",
)


def hits(tables: Tables, name: str) -> Any:
    return load_all()[name].hits(tables).mask


@pytest.mark.nightly
@settings(deadline=None)
@given(st.lists(st.tuples(st.sampled_from(["G1", "G2", "G3"]), WORDS), max_size=8))
def test_no_circle_is_what_one_of_five_rules_says(blocks: list[tuple[str, dict[str, str]]]) -> None:
    tables = tables_of(HEAD + "".join(code + "".join(map("".join, words.items())) + "\n" for code, words in blocks))
    told = np.logical_or.reduce([hits(tables, name) for name in OF_CIRCLES])
    assert tables["arcs"].is_no_circle.tolist() == told.tolist()


QUARTER = "G3 X20. C20. I-10. J0\n"
"""From 20 + 10j about 10 + 10j to 10 + 20j; with X as a radius it would miss."""


def misread(program: str, x: str) -> bool:
    arcs = tables_of(program, changes={"polar": {"x": x}})["arcs"]
    assert len(set(arcs.x_is_misread[2:].tolist())) == 1, "all rows of a section or none"
    return bool(arcs.x_is_misread[-1])


@looped(
    ("program", "x", "expected"),
    [
        (HEAD + QUARTER, "diameter", False),
        (HEAD + QUARTER, "radius", True),
        (HEAD.replace("X40.", "X20.") + QUARTER.replace("X20.", "X10."), "diameter", True),
        (HEAD.replace("X40.", "X20.") + QUARTER.replace("X20.", "X10."), "radius", False),
        # a quarter without its C fits by chance
        (HEAD + "G3 X24. I-8. J6.\n", "diameter", False),
        # one arc that fits as it is read speaks for all
        (HEAD + QUARTER + "G1 X40. C10.\nG3 X20. C10. I-10. J0\n", "radius", False),
        # a full circle and an arc along C alone say nothing
        (HEAD + "G3 I-10.\n", "radius", False),
        (HEAD + "G3 C-10. J-10.\n", "radius", False),
        # of arcs by R it takes two that do not reach, and none that does
        (HEAD + "G3 X20. C20. R10.\n", "radius", False),
        (HEAD + "G3 X20. C20. R10.\nG1 X-20.\nG3 X-40. C10. R10.\n", "radius", True),
        (HEAD + "G3 X20. C20. R10.\nG1 X-20.\nG3 X-40. C10. R10.\nG1 X-42.\nG3 X-40. C8. R10.\n", "radius", False),
    ],
)
def test_x_is_misread(program: str, x: str, expected: bool) -> None:
    assert misread(program, x) == expected


DIRECTIONS = st.integers(0, 359).filter(lambda degrees: abs(degrees % 90 - 45) > 2)
"""Of the centers of quarters that move X and C by more than the tolerance."""


@pytest.mark.nightly
@settings(deadline=None)
@given(st.lists(st.tuples(st.integers(1, 19), DIRECTIONS), min_size=2, max_size=6))
def test_a_program_for_the_other_reading_is_known_by_its_arcs(quarters: list[tuple[int, int]]) -> None:
    """Quarters of any size and direction, written with X as a diameter: true as such, misread as radii."""
    program, point, misses = HEAD, 20 + 10j, []
    for radius, direction in quarters:
        to_center = radius * cmath.exp(1j * math.radians(direction))
        end = point + to_center - to_center * 1j
        program += f"G3 X{2 * end.real:.3f} C{end.imag:.3f} I{to_center.real:.3f} J{to_center.imag:.3f}\n"
        step = complex(2 * (end - point).real, (end - point).imag)
        misses.append(abs(radius - abs(step - to_center)))
        point = end
    assert not misread(program, "diameter")
    if min(misses) > 1:
        assert misread(program, "radius")
    elif min(misses) < 0.02:
        assert not misread(program, "radius")


def test_arcs_of_wrong_radius_are_one_fault_only_where_many_of_a_section_are() -> None:
    """Through 6 good arcs and 2 wrong ones there are two slips; three wrong ones of three are one."""
    good, wrong = ("G3 X20. C10. R11.\nG1 X40. C0\n", "G3 X20. C10. R6.\nG1 X40. C0\n")
    head = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\n"

    def lines(arcs: str) -> list[int]:
        report = report_of(f"{head}{arcs}G1 X60.\nG13.1\n", "fanuc", only=["arc-radius-too-small"])
        return [finding.line for finding in report.findings]

    assert lines(6 * good + 2 * wrong) == [16, 18]
    assert lines(3 * wrong) == [4]
