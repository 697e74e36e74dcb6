"""
Outer corners of controls that go round them by an arc of R, or by the point where both ways meet: G450 and G451.

What is expected is drawn here from the manuals' words (NC programming 6FC5398-2EP40-0BA0 p. 268; W1
6FC5397-0BP40-5BA2 p. 1426), and shares no code with polarcheck.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
import pytest
from cases import looped
from plane_moves import points_along
from programs import moves_of, report_of, tables_of

from polarcheck.columns.path.moves import Moves
from polarcheck.foundation.states import Motion
from polarcheck.geometry.cutter_compensation.offset_path import Phase

MACHINE = "siemens-transmit"
FEED, RADIUS = 300.0, 4.0
HEAD = "T8 D1\nG94 S2=2000 M2=3\nDIAMOF\nG0 X60 C0 Z5\nTRANSMIT\nG17\n{code}\nG1 G42 X{x} Y0 F300\n"
FOOT = "G40 X60\nTRAFOOF\nM30\n"
TOOL = f"8:radius={RADIUS:g}"


class Element(NamedTuple):
    """A line to a point, or an arc about a center (1: counterclockwise, -1: clockwise)."""

    end: complex
    center: complex | None = None
    sense: int = 0


def line(x: float, y: float) -> Element:
    return Element(complex(x, y))


def arc(x: float, y: float, center: complex, sense: int = 1) -> Element:
    return Element(complex(x, y), center, sense)


#: Closed contours from X20 Y0 round C, counterclockwise; all their corners are outer ones but where it is said.
SQUARE = [line(20, 15), line(-20, 15), line(-20, -15), line(20, -15), line(20, 0)]
TRIANGLE = [line(20, 10), line(-20, 0), line(20, -10), line(20, 0)]
HALF_DISC = [line(20, 20), arc(20, -20, 20 + 0j), line(20, 0)]
LENS = [arc(0, 15, 1 - 4.5j), arc(0, -15, 9 + 0j), arc(20, 0, 1 + 4.5j)]
HEXAGON = [line(20 * math.cos(a), 20 * math.sin(a)) for a in np.radians([60, 120, 180, 240, 300, 360])]
NOTCHED = [line(20, 15), line(0, 15), line(0, 5), line(-20, 5), line(-20, -15), line(20, -15), line(20, 0)]
HOLLOW = [line(20, 15), arc(-20, 15, 0 + 30j, -1), line(-20, -15), line(20, -15), line(20, 0)]
SHAPES = {
    "square": SQUARE,
    "triangle": TRIANGLE,
    "half disc": HALF_DISC,
    "lens": LENS,
    "hexagon": HEXAGON,
    "notched": NOTCHED,
    "hollow": HOLLOW,
}


def program(shape: list[Element], code: str) -> str:
    at, blocks = 20 + 0j, []
    for element in shape:
        word = f"X{element.end.real:.9f} Y{element.end.imag:.9f}"
        if element.center is None:
            blocks.append(f"G1 {word}")
        else:
            to = element.center - at
            blocks.append(f"G{3 if element.sense > 0 else 2} {word} I{to.real:.9f} J{to.imag:.9f}")
        at = element.end
    return HEAD.format(code=code, x=20) + "\n".join(blocks) + "\nG1 " + FOOT


def contour_moves(shape: list[Element], code: str, **more: Any) -> Moves:
    moves = moves_of(program(shape, code), MACHINE, TOOL, **more)
    return moves[moves.phase == Phase.OFFSET]


def pieces(shape: list[Element]) -> list[tuple[complex, Element, complex, complex, float]]:
    """Per element: start, the element, its directions at start and end, its length."""
    at, result = 20 + 0j, []
    for element in shape:
        if element.center is None:
            way = element.end - at
            first = last = way / abs(way)
            length = abs(way)
        else:
            radius = abs(at - element.center)
            turn = float(np.angle((element.end - element.center) / (at - element.center))) * element.sense
            turn = turn % math.tau or math.tau
            first, last = ((1j * element.sense * (p - element.center) / radius) for p in (at, element.end))
            length = radius * turn
        result.append((at, element, first, last, length))
        at = element.end
    return result


def distance(points: np.ndarray, shape: list[Element]) -> np.ndarray:
    """From each point to the contour."""
    nearest = np.full(len(points), np.inf)
    for start, element, *_ in pieces(shape):
        if element.center is None:
            way = element.end - start
            share = np.clip(((points - start) * np.conj(way)).real / abs(way) ** 2, 0, 1)
            near = start + share * way
        else:
            seen = np.angle((points - element.center) / (start - element.center)) * element.sense % math.tau
            whole = np.angle((element.end - element.center) / (start - element.center)) * element.sense % math.tau
            on_arc = element.center + (points - element.center) / abs(points - element.center) * abs(
                start - element.center
            )
            ends = np.where(abs(points - start) < abs(points - element.end), start, element.end)
            near = np.where(seen <= whole + 1e-9, on_arc, ends)
        nearest = np.minimum(nearest, abs(points - near))
    return nearest


def sampled(moves: Moves) -> np.ndarray:
    return np.concatenate([points_along(*move, 60) for move in zip(*moves.shape, strict=True)])


@pytest.mark.ci
@looped("shape", SHAPES.values(), ids=SHAPES)
def test_with_g450_the_tool_stays_r_beside_the_contour(shape: list[Element]) -> None:
    """Also at its corners: an arc of R about the programmed point."""
    moves = contour_moves(shape, "G450")
    np.testing.assert_allclose(distance(sampled(moves), shape), RADIUS, atol=1e-6)
    np.testing.assert_allclose(moves.start[1:], moves.end[:-1], atol=1e-9)
    corners = moves[moves.corner]
    np.testing.assert_allclose(np.abs(corners.start - corners.center), RADIUS, atol=1e-9)
    assert (corners.kind == Motion.CCW).all()


@looped("name", ["square", "triangle", "half disc", "lens", "hexagon"])
def test_round_a_convex_contour_the_way_is_longer_by_a_circle_of_r(name: str) -> None:
    """All turns together are 360 deg, of corners and arcs: its length is that of the contour and 2 pi R."""
    shape = SHAPES[name]
    moves = contour_moves(shape, "G450")
    length = sum(piece[-1] for piece in pieces(shape))
    # The hexagon and the lens begin at a corner, beside which the tool comes and goes.
    begun = float(np.angle(pieces(shape)[0][2] / pieces(shape)[-1][3]))
    assert moves.length.sum() == pytest.approx(length + RADIUS * (math.tau - begun), abs=1e-5)
    assert moves.time.sum() == pytest.approx(60 * moves.length.sum() / FEED)


@pytest.mark.ci
@looped("code", ["G450", "G451"])
@looped("name", ["square", "half disc", "lens", "hollow"])
def test_rates_of_c_are_those_of_the_way(name: str, code: str) -> None:
    moves = contour_moves(SHAPES[name], code)
    for move, rate in zip(zip(*moves.shape, strict=True), moves.c_feed, strict=True):
        way = points_along(*move, 4001)
        steps = np.degrees(np.abs(np.angle(way[1:] / way[:-1]))) / np.abs(np.diff(way))
        assert rate == pytest.approx(FEED * steps.max(), rel=1e-3)


@pytest.mark.ci
@looped("shape", SHAPES.values(), ids=SHAPES)
def test_with_g451_both_ways_are_made_longer_up_to_where_they_meet(shape: list[Element]) -> None:
    """A line stays a line beside it, an arc an arc about its center; sharper turns than 100 deg become arcs of R."""
    moves = contour_moves(shape, "G451")
    np.testing.assert_allclose(moves.start[1:], moves.end[:-1], atol=1e-9)
    of_contour = moves[~moves.corner]
    assert len(of_contour) == len(shape)
    every = pieces(shape)
    for (start, element, first, *_), move in zip(every, zip(*of_contour.shape, strict=True), strict=True):
        way = points_along(*move, 20)
        if element.center is None:
            np.testing.assert_allclose(((way - start) * np.conj(first)).imag, -RADIUS, atol=1e-6)
        else:
            on = abs(start - element.center) + element.sense * RADIUS
            np.testing.assert_allclose(abs(way - element.center), on, atol=1e-6)
    turns = [math.degrees(np.angle(after[2] / before[3])) for before, after in pairwise(every)]
    assert moves.corner.sum() == sum(turn > 100.001 for turn in turns)
    if moves.corner.any():
        np.testing.assert_allclose(distance(sampled(moves[moves.corner]), shape), RADIUS, atol=1e-6)


@pytest.mark.ci
@looped(
    ("code", "changes", "arcs"),
    [
        ("", {}, 4),
        ("", {"parameters": {"20150[17]": 2}}, 0),
        ("", {"compensation": {"corner": "lines"}}, 0),
        ("G451", {}, 0),
        ("G451\nG450", {}, 4),
        ("G451", {"parameters": {"20210": 80}}, 4),
        ("G450", {"parameters": {"20230": 95}}, 0),
    ],
)
def test_code_and_machine_say_which_corners(code: str, changes: dict[str, Any], arcs: int) -> None:
    assert contour_moves(SQUARE, code, changes=changes).corner.sum() == arcs


def test_the_code_may_stand_before_the_mode_and_change_within() -> None:
    text = program(SQUARE, "").replace("TRANSMIT", "G451\nTRANSMIT")
    moves = moves_of(text, MACHINE, TOOL)
    assert not moves.corner.any()
    within = moves_of(text.replace("G1 X-20.", "G450 G1 X-20.", 1), MACHINE, TOOL)
    assert within.corner.sum() == 4
    last = moves_of(text.replace("Y0.000000000\n", "Y0.000000000 G450\n"), MACHINE, TOOL)
    assert last.corner.sum() == 1


@pytest.mark.ci
@looped("shape", SHAPES.values(), ids=SHAPES, one_in=7)
def test_the_part_is_the_same_whatever_the_corners(shape: list[Element]) -> None:
    """No overcut, no remnant, the same words for what is made: the arcs touch the corner and cut nothing else."""
    reports = [report_of(program(shape, code), MACHINE, TOOL) for code in ("G450", "G451")]
    assert [[finding.rule for finding in report.findings] for report in reports] == [[], []]
    parts = [
        [level.polygon.area for level in tables_of(program(shape, code), MACHINE, TOOL)["finished"].levels]
        for code in ("G450", "G451")
    ]
    assert parts[0] == pytest.approx(parts[1], rel=1e-6)
