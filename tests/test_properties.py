"""What a machinist would nod at: the same program written otherwise is the same program."""

from __future__ import annotations

import cmath
import math
import re
from dataclasses import dataclass

import msgspec
import numpy as np
import pytest
from hypothesis import assume, example, given, settings
from hypothesis import strategies as st
from msgspec.structs import replace
from programs import machine_of, moves_of, report_of, tables_of, trace_of

from polarcheck.columns.path.moves import Moves, programmed_moves
from polarcheck.rules.rule import load_all

pytestmark = pytest.mark.ci

LIMITS = {"limits": {"c_feed": 7200.0}}
FANUC = machine_of("fanuc", LIMITS)
EXAMPLES = 40


@dataclass(frozen=True)
class Move:
    """To a plane point by a line, or by an arc about a center."""

    end: complex
    center: complex | None = None
    ccw: bool = True
    feed: float | None = None


def coordinate(low: float, high: float) -> st.SearchStrategy[float]:
    return st.integers(round(low * 500), round(high * 500)).map(lambda n: n / 500)  # X on the diameter: 0.004 mm


@st.composite
def contours(draw: st.DrawFn) -> list[Move]:
    """Lines between points of the plane and quarter arcs whose ends are exact in 0.002 mm."""
    here = complex(40, 0)
    moves = []
    for _ in range(draw(st.integers(1, 8))):
        feed = draw(st.one_of(st.none(), st.sampled_from([50.0, 200.0, 900.0])))
        if draw(st.booleans()):
            radius = draw(coordinate(1, 15))
            turned = draw(st.sampled_from([1, 1j, -1, -1j]))
            ccw = draw(st.booleans())
            center = here - radius * turned
            end = center + radius * turned * (1j if ccw else -1j)
            moves.append(Move(end, center, ccw, feed))
            here = end
        else:
            here = complex(draw(coordinate(-40, 40)), draw(coordinate(-40, 40)))
            moves.append(Move(here, None, True, feed))
    return moves


def words(value: float) -> str:
    return f"{value:.9f}".rstrip("0")


def program(moves: list[Move], *, unit: float = 1.0, incremental: bool = False, x_factor: float = 2.0) -> str:
    lines = [
        "O1",
        "G20" if unit != 1.0 else "G21",
        "T0101",
        f"G98 G0 X{words(80 / unit)} C0. Z{words(5 / unit)}",
        "G12.1",
    ]
    here = complex(40, 0)
    for number, move in enumerate(moves):
        feed = move.feed if move.feed is not None or number else 300.0
        step = move.end - here if incremental else move.end
        x, c = ("U", "H") if incremental else ("X", "C")
        block = f"{x}{words(step.real * x_factor / unit)} {c}{words(step.imag / unit)}"
        if move.center is None:
            block = "G1 " + block
        else:
            to_center = move.center - here
            block = ("G3 " if move.ccw else "G2 ") + block
            block += f" I{words(to_center.real / unit)} J{words(to_center.imag / unit)}"
        if feed is not None:
            block += f" F{words(feed / unit)}"
        lines.append(block)
        here = move.end
    return "\n".join([*lines, "G13.1", f"G0 X{words(90 / unit)}", "M30", ""])


def same_path(ours: Moves, theirs: Moves, tolerance: float = 1e-6, point: float = 1e-12) -> None:
    """
    The same moves but for a tolerance, and for what follows from points that lie apart by no more than `point` [mm].

    C turns by point / L, and its rate changes by F * point / L^2: nothing worth naming far from the center. Near to it
    the last digit decides between a rate of 0, of any size, and an infinite one, and on which side C turns.
    """
    for name in ("start", "end", "center", "feed", "nearest"):
        np.testing.assert_allclose(getattr(ours, name), getattr(theirs, name), 1e-6, tolerance, err_msg=name)
    np.testing.assert_array_equal(ours.kind, theirs.kind)
    near = np.minimum(ours.nearest, theirs.nearest)
    at_center = near < 10 * point
    allowed = tolerance + 4 * np.degrees(ours.feed * point / np.maximum(near, 1e-100) ** 2)
    allowed += 1e-6 * np.where(at_center, 0, theirs.c_feed)
    with np.errstate(invalid="ignore"):  # inf at the center on both sides
        apart = np.where(ours.c_feed == theirs.c_feed, 0, np.abs(ours.c_feed - theirs.c_feed))
    assert (at_center | (apart <= allowed)).all()
    through = np.logical_or.accumulate(at_center)
    for angle, other, at in zip(ours.c_angles, theirs.c_angles, (ours.start, ours.end), strict=True):
        turned = np.where(through, np.mod(angle - other + 180, 360) - 180, angle - other)
        is_center = np.abs(at) < 10 * point
        assert (is_center | (np.abs(turned) <= 1e-4 + 4 * np.degrees(point / np.maximum(np.abs(at), 1e-100)))).all()


#: Straight from the center and to it, and past it by the last digit.
AT_CENTER = [Move(0.002 + 0.002j), Move(30 + 30j), Move(0.004 + 0.004j), Move(40 + 0j)]
THROUGH_CENTER = [Move(0.002 + 0.004j), Move(-20 - 40j), Move(0.002 + 0.004j), Move(0j), Move(15 - 10j), Move(40 + 2j)]
PAST_CENTER = [Move(38 + 39.998j), Move(-38.002 - 40j), Move(-0.002 + 0j), Move(0j), Move(0.002 - 0.002j)]


@pytest.mark.nightly
@given(contours(), st.data())
@settings(max_examples=EXAMPLES, deadline=None)
def test_spelling_changes_nothing(moves: list[Move], data: st.DataObject) -> None:
    text = program(moves)
    spelled = []
    for number, line in enumerate(text.split("\n")):
        if data.draw(st.booleans()) and line:
            line = re.sub(r"\b([GM])(\d)\b", r"\g<1>0\2", line)
        if data.draw(st.booleans()):
            line = line.replace(" ", data.draw(st.sampled_from(["", "  ", "\t"])))
        if data.draw(st.booleans()) and line and not line.startswith("O"):
            line = f"N{10 * number + 10} {line}"
        if data.draw(st.booleans()):
            line += data.draw(st.sampled_from([" (COMMENT G0)", ";", "  "]))
        spelled.append(line)
    other = data.draw(st.sampled_from(["\n", "\r\n", "\n\r\r"])).join(spelled)
    same_path(moves_of(text, FANUC), moves_of(other, FANUC), 0, 0)
    ours, theirs = report_of(text, FANUC), report_of(other, FANUC)
    assert [(f.line, f.rule, f.values) for f in ours.findings] == [(f.line, f.rule, f.values) for f in theirs.findings]


@pytest.mark.nightly
@given(contours())
@example(AT_CENTER)
@example(THROUGH_CENTER)
@example(PAST_CENTER)
@settings(max_examples=EXAMPLES, deadline=None)
def test_incremental_twin_has_the_same_path(moves: list[Move]) -> None:
    same_path(moves_of(program(moves), FANUC), moves_of(program(moves, incremental=True), FANUC))


@pytest.mark.nightly
@given(contours())
@example(AT_CENTER)
@example(THROUGH_CENTER)
@example(PAST_CENTER)
@settings(max_examples=EXAMPLES, deadline=None)
def test_inch_twin_has_the_same_path(moves: list[Move]) -> None:
    # Half of 1e-9 inch of rounding in X and C is 2e-8 mm.
    same_path(moves_of(program(moves), FANUC), moves_of(program(moves, unit=25.4), FANUC), point=2e-8)


@pytest.mark.nightly
@given(contours())
@settings(max_examples=EXAMPLES, deadline=None)
def test_radius_twin_has_the_same_path(moves: list[Move]) -> None:
    by_radius = machine_of("fanuc", {**LIMITS, "polar": {"x": "radius"}})
    same_path(moves_of(program(moves), FANUC), moves_of(program(moves, x_factor=1.0), by_radius))


@pytest.mark.nightly
@given(contours(), st.floats(-math.pi, math.pi))
@settings(max_examples=EXAMPLES, deadline=None)
def test_turning_the_entry_shifts_only_c(moves: list[Move], angle: float) -> None:
    """The C angle at G12.1 turns the whole plane."""
    degrees = round(math.degrees(angle), 3)
    plain = moves_of(program(moves), FANUC)
    turned = moves_of(program(moves).replace("C0.", f"C{degrees:.3f}", 1), FANUC)
    np.testing.assert_array_equal(plain.end, turned.end)
    for ours, theirs in zip(plain.c_angles, turned.c_angles, strict=True):
        np.testing.assert_allclose(theirs - ours, degrees, atol=1e-9)


@pytest.mark.nightly
@given(contours(), st.floats(-math.pi, math.pi))
@settings(max_examples=EXAMPLES, deadline=None)
def test_turning_the_contour_keeps_speed_and_distance(moves: list[Move], angle: float) -> None:
    turn = cmath.exp(1j * angle)

    table = programmed_moves(trace_of(program(moves), FANUC))
    other = replace(table, start=table.start * turn, end=table.end * turn, center=table.center * turn)
    off_center = table.nearest > 1e-3
    np.testing.assert_allclose(other.nearest[off_center], table.nearest[off_center], rtol=1e-6, atol=1e-9)
    np.testing.assert_allclose(other.c_feed[off_center], table.c_feed[off_center], rtol=1e-5)


COMPENSATED = """O1
G21 G98
T0101
G0 X120. C0 Z5.
G12.1
G1 {on} X60. F500
C{half}
G3 X{inner} C30. R{corner}
G1 X-{inner}
G3 X-60. C{half} R{corner}
G1 C-{half}
G3 X-{inner} C-30. R{corner}
G1 X{inner}
G3 X60. C-{half} R{corner}
G1 C0
G40 X120.
G13.1
G0 X130.
M30
"""


def rounded_square(corner: float, on: str) -> str:
    half = 30 - corner
    return COMPENSATED.format(on=on, half=words(half), inner=words(2 * half), corner=words(corner))


@pytest.mark.nightly
@given(coordinate(0.5, 25), coordinate(0, 12))
@settings(max_examples=EXAMPLES, deadline=None)
def test_a_rounded_square_is_followed_at_its_distance(corner: float, radius: float) -> None:
    table = moves_of(rounded_square(corner, "G42"), FANUC, f"1:radius={radius}")
    assert table.known.all()
    np.testing.assert_allclose(np.max(np.abs(table.end.real[1:-1])), 30 + radius, atol=1e-9)
    arcs = table.kind == 3
    np.testing.assert_allclose(np.abs(table.end - table.center)[arcs], corner + radius, atol=1e-9)


@pytest.mark.nightly
@given(coordinate(0.5, 25), coordinate(0.1, 12))
@settings(max_examples=EXAMPLES, deadline=None)
def test_mirroring_swaps_the_sides(corner: float, radius: float) -> None:
    tool = f"1:radius={radius}"
    text = rounded_square(corner, "G42")
    mirrored = re.sub(r"C(-?)(\d)", lambda m: f"C{'' if m[1] else '-'}{m[2]}", text).replace("C-0", "C0")
    mirrored = mirrored.replace("G42", "G41").replace("G3 ", "G2 ")
    ours, theirs = (moves_of(one, FANUC, tool) for one in (text, mirrored))
    np.testing.assert_allclose(theirs.end, np.conj(ours.end), atol=1e-9)
    np.testing.assert_allclose(theirs.c_feed, ours.c_feed, rtol=1e-9)


@given(coordinate(0.5, 25))
@settings(max_examples=EXAMPLES, deadline=None)
def test_radius_zero_gives_the_programmed_path(corner: float) -> None:
    tables = tables_of(rounded_square(corner, "G42"), FANUC, "1:radius=0")
    ours, programmed = tables["moves"], programmed_moves(tables["trace"])
    moved = programmed.length > 1e-9
    np.testing.assert_allclose(ours.end, programmed.end[moved], atol=1e-9)


@pytest.mark.nightly
@given(contours(), st.floats(500, 20_000), st.floats(1, 3))
@settings(max_examples=EXAMPLES, deadline=None)
def test_raising_a_limit_adds_no_finding(moves: list[Move], limit: float, more: float) -> None:
    text = program(moves)
    low, high = (
        report_of(text, replace(FANUC, limits=replace(FANUC.limits, c_feed=value))) for value in (limit, limit * more)
    )
    assert {(f.line, f.rule) for f in high.findings} <= {(f.line, f.rule) for f in low.findings}


@pytest.mark.nightly
@given(contours())
@settings(max_examples=EXAMPLES, deadline=None)
def test_splitting_a_move_changes_no_finding(moves: list[Move]) -> None:
    split: list[Move] = []
    here = complex(40, 0)
    for move in moves:
        if move.center is None:
            middle = (here + move.end) / 2
            middle = complex(round(middle.real * 1000) / 1000, round(middle.imag * 1000) / 1000)
            exact = abs(middle - (here + move.end) / 2) < 1e-12
            if exact and middle not in (here, move.end):
                split.append(Move(middle, None, True, move.feed))
        split.append(move)
        here = move.end
    # At the center a piece may lie just beside it where the whole lay on it.
    assume(tables_of(program(moves), FANUC)["tool_center"].nearest.min() > 0.02)
    # What is likely to be meant may be another word where a point more is written.
    rules = [rule for name, rule in load_all().items() if name != "nearly-regular-contour"]
    ours, theirs = (report_of(program(path), FANUC, only=rules) for path in (moves, split))
    assert {(f.rule, f.severity) for f in ours.findings} == {(f.rule, f.severity) for f in theirs.findings}


@pytest.mark.nightly
@given(st.binary(max_size=400))
@settings(max_examples=200, deadline=None)
def test_any_bytes_give_a_report(data: bytes) -> None:
    report = report_of(data, FANUC)
    assert msgspec.json.decode(msgspec.json.encode(report))["path"] == "-"


@pytest.mark.nightly
@given(st.text(alphabet="GMXYZCUWHIJKRFTSNO%();/#[]=.-+0123456789 \n<>ABWHILEDOT", max_size=300))
@settings(max_examples=200, deadline=None)
def test_any_text_like_a_program_gives_a_report(text: str) -> None:
    report = report_of(text, FANUC)
    assert msgspec.json.decode(msgspec.json.encode(report))["blocks"] >= 0
