"""Overcuts and ramps: programs that are legal, programs that are not, and random contours against plain distances."""

from __future__ import annotations

import itertools
import math
from typing import NamedTuple

import msgspec
import numpy as np
import pytest
import shapely
from cases import looped
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from plane_moves import path_of_rows, points_along, turn_of

from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.cutter_compensation.offset_path import Method, Path, Phase, tool_center_path
from polarcheck.geometry.overcuts.own_loop import TOLERANCE, overcuts
from polarcheck.geometry.segments import Curves

NAN = complex(math.nan, math.nan)
LEFT, RIGHT = Side.LEFT, Side.RIGHT
Block = complex | tuple[Motion, complex, complex]


def ccw(end: complex, center: complex) -> Block:
    return Motion.CCW, end, center


def cw(end: complex, center: complex) -> Block:
    return Motion.CW, end, center


IDLE = NAN  # a block without movement in the plane


class Overcuts(NamedTuple):
    """
    The deepest cut of each move.

    row: int[n], programmed row that is cut. move: int[n]. depth: float64[n] [mm]. place: complex128[n] [mm].
    """

    row: np.ndarray
    move: np.ndarray
    depth: np.ndarray
    place: np.ndarray


class Loop(NamedTuple):
    """A contour from start-up to cancel with the tool center's moves; `alarm` if the control would object to it."""

    contour: Curves
    left: np.ndarray
    path: Curves
    ramps: Curves
    radius: float
    alarm: bool

    def overcuts(self, radius: float | None = None, tolerance: float = TOLERANCE) -> Overcuts:
        sizes = np.full(len(self.path.row), self.radius if radius is None else radius)
        with np.errstate(all="raise", under="ignore"):
            return along(self.contour, self.left, self.path, sizes, tolerance)

    def sweeps(self) -> Overcuts:
        with np.errstate(all="raise", under="ignore"):
            sizes = np.full(len(self.ramps.row), self.radius)
            return swept(self.contour, self.left, self.ramps, sizes)


def loop(
    start: complex, *blocks: Block, side: Side = RIGHT, radius: float = 5.0, number: int = 0, start_up: str = "A"
) -> Loop:
    """The first block is the start-up, the last one the cancel; rows count from 0."""
    rows, here = [], complex(start)
    for row, block in enumerate(blocks):
        kind, end, center = block if isinstance(block, tuple) else (Motion.LINE, complex(block), NAN)
        moves = not math.isnan(complex(end).real)
        end = complex(end) if moves else here
        on = side if row < len(blocks) - 1 else Side.OFF
        rows.append((0, kind, moves, here, end, center, on, row == 0, radius, NAN, False))
        here = end
    path = path_of_rows(rows)
    tool = tool_center_path(path, Method(start_up=start_up))
    programmed = np.flatnonzero(path.moves & (path.side != Side.OFF) & (np.arange(len(rows)) > 0))

    def some(of: Path | object, kept: np.ndarray, kind: np.ndarray, row: np.ndarray) -> Curves:
        columns = (getattr(of, name)[kept] for name in ("start", "end", "center"))
        return Curves(*columns, kind[kept], np.full(len(kept), number), row[kept])

    ramping = (tool.phase == Phase.START_UP) | (tool.phase == Phase.CANCEL)
    return Loop(
        some(path, programmed, path.motion, np.arange(len(rows))),
        np.full(len(programmed), side == LEFT),
        some(tool, np.flatnonzero(tool.phase == Phase.OFFSET), tool.kind, tool.row),
        some(tool, np.flatnonzero(ramping), tool.kind, tool.row),
        radius,
        bool((tool.interferes | tool.no_intersection | tool.inside_arc_too_small).any()),
    )


def polygon(apothem: float, corners: int) -> list[complex]:
    """A regular polygon from the middle of its right side, counterclockwise."""
    corner = apothem / math.cos(math.pi / corners)
    turns = [math.pi / corners * (2 * k + 1) for k in range(corners)]
    return [complex(apothem), *(corner * complex(math.cos(t), math.sin(t)) for t in turns), complex(apothem)]


def spiral(half: float, step: float, turns: int) -> list[complex]:
    """A square spiral inwards, counterclockwise, from the middle of its lower side."""
    left, right, low, high = -half, half, -half, half
    points = [complex(0, low)]
    for _ in range(turns):
        points += [complex(right, low), complex(right, high), complex(left, high)]
        low += step
        points.append(complex(left, low))
        left, right, high = left + step, right - step, high - step
    return [*points, complex(0, low)]


def mirrored(blocks: list[Block]) -> list[Block]:
    other = {Motion.CW: Motion.CCW, Motion.CCW: Motion.CW}
    return [
        (other[block[0]], block[1].conjugate(), block[2].conjugate()) if isinstance(block, tuple) else block.conjugate()
        for block in blocks
    ]


SQUARE = polygon(20, 4)
BELOW_TOP: list[Block] = [
    20 + 20j,
    20 - 20j,
    -20 - 20j,
    -20 + 20j,
    20j,
]  # a square clockwise, from the middle of its top

LEGAL = {
    "manual sample": loop(60, 20, 20 + 10j, ccw(10 + 20j, 10 + 10j), -20 + 20j, -20 - 10j, ccw(-10 - 20j, -10 - 10j),
                          20 - 20j, 20, 60),
    "square": loop(45, *SQUARE, 45),
    "hexagon": loop(45, *polygon(15, 6), 45, radius=4),
    "triangle with acute corners": loop(80, *polygon(12, 3), 80, radius=6),
    "needle": loop(60 + 20j, 30 + 3j, -30, 30 - 3j, 30 + 3j, 60 + 20j, side=RIGHT, radius=5),
    "full circle": loop(40, 20, ccw(20, 0), 40),
    "pocket with corner arcs above R": loop(0, -20j, 15 - 20j, ccw(20 - 15j, 15 - 15j), 20 + 15j,
                                            ccw(15 + 20j, 15 + 15j), -20 + 20j, -20 - 20j, -20j, 0,
                                            side=LEFT, radius=4.9),
    "step up smaller than R": loop(-20, 0, 20, 20 + 2j, 40 + 2j, 60 + 20j, side=LEFT),
    "step down smaller than R": loop(-20, 0, 20, 20 - 2j, 40 - 2j, 60 + 20j, side=LEFT),
    "exact reversal": loop(-20, 0, 40, 10, 10 - 20j, side=LEFT),
    "flat, approach along it": loop(30 + 10j, 16 + 10j, -16 + 10j, -30 + 10j),
    "flat, short approach along it": loop(22 + 10j, 16 + 10j, -16 + 10j, -22 + 10j),
    "flat, slanting approach": loop(30 + 25j, 16 + 10j, -16 + 10j, -30 + 25j),
    "flat, approach a little outwards": loop(40 + 12j, 16 + 10j, -16 + 10j, -40 + 12j),
    "two flats": loop(30 + 10j, 16 + 10j, -16 + 10j, -30 + 10j, -30 - 10j, -16 - 10j, 16 - 10j, 30 - 10j),
    "slot just wide enough": loop(0, -5.005j, 20 - 5.005j, 20 + 5.005j, -20 + 5.005j, -20 - 5.005j, -5.005j, 0,
                                  side=LEFT),
    "approach and exit side by side": loop(45 + 3j, 20 + 0.5j, *SQUARE[1:-1], 20 - 0.5j, 45 - 3j),
    "approach and exit overlap": loop(45, 20 - 2j, *SQUARE[1:-1], 20 + 3j, 45 + 5j),
    "twice round": loop(45, *SQUARE, *SQUARE, 45),
    "twice round, rounded": loop(45, *polygon(15, 6), *[point + 0.0009 for point in polygon(15, 6)], 45),
    **{f"hexagons shrinking by {step}": loop(60, *(p for k in range(4) for p in polygon(30 - k * step, 6)), 60)
       for step in (0.02, 0.5, 3, 5, 7.5)},
    **{f"hexagons growing by {step}": loop(60, *(p for k in range(4) for p in polygon(12 + k * step, 6)), 60)
       for step in (0.5, 3, 5)},
    **{f"spiral inwards by {step}": loop(0, *spiral(30, step, 3), 0, side=LEFT) for step in (0.02, 1, 3, 4.5, 8)},
    **{f"spiral outwards by {step}": loop(0, *spiral(30, step, 3)[::-1], 0) for step in (0.02, 1, 3, 4.5, 8)},
    "spiral of half circles": loop(0, 12, ccw(-14, -1), ccw(16, 1), ccw(-18, -1), ccw(20, 1), ccw(20, 0), 0, side=LEFT),
    "spiral of half circles in wide steps": loop(0, 12, ccw(-16, -2), ccw(20, 2), ccw(-24, -2), ccw(28, 2),
                                                 ccw(-32, -2), ccw(36, 2), 0, side=LEFT),
    "hexagons shrinking to a small boss": loop(60, *(p for size in (10, 7, 4) for p in polygon(size, 6)), 60),
    "circles one in the other": loop(0, 16, ccw(16, 0), 19, ccw(19, 0), 22, ccw(22, 0), 0, side=LEFT),
    **{f"lead in and out on arcs of {size}": loop(
        complex(-size, 60), complex(-size, 20 + size), ccw(20j, (20 + size) * 1j), *BELOW_TOP,
        ccw(complex(size, 20 + size), (20 + size) * 1j), complex(size, 60), side=LEFT) for size in (5.5, 6, 10, 15)},
    "lead in and out along the side": loop(-50 + 20j, -40 + 20j, *BELOW_TOP, 40 + 20j, 50 + 20j, side=LEFT),
    "lead in and out across the side": loop(60j, 40j, 20j, *BELOW_TOP, 40j, 60j, side=LEFT),
    "lead in and out at a slant": loop(-30 + 60j, -20 + 40j, 20j, *BELOW_TOP, 20 + 40j, 30 + 60j, side=LEFT),
    "lead in and out at a slant, backwards": loop(30 + 60j, 20 + 40j, 20j, *BELOW_TOP, -20 + 40j, -30 + 60j, side=LEFT),
    "ramp on and off of type B": loop(0, 20, 20 - 30j, 40 - 60j, side=LEFT, start_up="B"),
}  # fmt: skip


@pytest.mark.ci
@looped("name", LEGAL, one_in=6)
def test_a_legal_program_is_never_found(name: str) -> None:
    legal = LEGAL[name]
    assert len(legal.path.row)
    assert list(legal.overcuts().row) == []
    assert list(legal.sweeps().move) == []


@pytest.mark.ci
@looped("name", sorted({*LEGAL} - {"exact reversal"}), one_in=4)
def test_a_tool_too_large_by_a_hundredth_is_found(name: str) -> None:
    found = LEGAL[name].overcuts(LEGAL[name].radius + 0.01)
    assert len(found.row)
    assert found.depth.max() > 0.0089


@pytest.mark.ci
@looped("name", ["square", "hexagon", "full circle", "manual sample", "two flats"])
def test_the_hundredth_is_measured_on_every_move(name: str) -> None:
    legal = LEGAL[name]
    assert list(legal.overcuts(legal.radius + 0.0005).row) == []
    found = legal.overcuts(legal.radius + 0.01)
    assert set(legal.path.row[found.move]) == set(legal.contour.row)
    assert found.depth == pytest.approx(0.01, abs=0.001)


# ---- where, how deep, by which move ----


def test_two_blocks_without_movement() -> None:
    """facts/compensation.md 8, case 28: a vector perpendicular to the block before the corner cuts the next one."""
    found = loop(-20, 0, 40, IDLE, IDLE, 40 + 30j, 60 + 60j, side=LEFT).overcuts()
    assert list(found.row) == [4, 4]
    assert found.depth == pytest.approx([5, 5])
    assert found.place == pytest.approx([40 + 5j] * 2)
    assert list(found.move) == [0, 1]


def test_one_block_without_movement() -> None:
    assert list(loop(-20, 0, 40, IDLE, 40 + 30j, 20 + 60j, side=LEFT).overcuts().row) == []


def test_slot_narrower_than_the_tool() -> None:
    """Case 38: 6 mm wide, R 5."""
    found = loop(-20, 0, 20, 20 - 4j, 26 - 4j, 26, 46, 60 + 20j, side=LEFT).overcuts()
    assert set(found.row) <= {1, 2, 4, 5}
    assert found.place == pytest.approx(np.where(found.row < 3, 20, 26))
    assert found.depth == pytest.approx(5 - 2**0.5)


@looped("width", [9.99, 9.5, 7])
def test_pocket_narrower_than_the_tool(width: float) -> None:
    half = width / 2
    corners = [complex(20, -half), complex(20, half), complex(-20, half), complex(-20, -half)]
    found = loop(0, -1j * half, *corners, -1j * half, 0, side=LEFT).overcuts()
    assert set(found.row) == {1, 3, 5}
    assert found.depth == pytest.approx(10 - width, abs=1e-6)


def test_inside_arc_smaller_than_the_tool() -> None:
    """Case 40: the tool center's way round the arc is none, and the blocks at both ends are cut."""
    program = loop(-20, 0, 20, ccw(24 + 4j, 20 + 4j), 24 + 30j, 0, side=LEFT)
    found = program.overcuts()
    assert {1, 2, 3} == set(program.path.row[found.move])
    assert found.depth == pytest.approx([1, 1, 1], abs=0.001)


def test_a_groove_in_the_last_pass_is_found() -> None:
    """The passes are no overcut of each other, the groove of the finished contour is one."""
    rough = [30, 30 + 30j, -30 + 30j, -30 - 30j, 30 - 30j, 30]
    fine = [25, 25 + 25j, 4.995 + 25j, 4.995 + 10j, -4.995 + 10j, -4.995 + 25j, -25 + 25j, -25 - 25j, 25 - 25j, 25]
    program = loop(60, *map(complex, rough), *map(complex, fine), 60)
    found = program.overcuts()
    assert {9, 11} <= set(found.row) <= {8, 9, 11, 12}
    assert found.depth == pytest.approx(0.01, abs=1e-6)
    assert list(program.sweeps().move) == []


def test_the_side_and_the_direction_do_not_matter() -> None:
    blocks: list[Block] = [0, 20, 20 - 4j, 26 - 4j, 26, 46, 60 + 20j]
    left = loop(-20, *blocks, side=LEFT).overcuts()
    right = loop(-20, *mirrored([complex(b) for b in blocks]), side=RIGHT).overcuts()
    assert list(right.row) == list(left.row)
    assert right.depth == pytest.approx(left.depth)
    assert right.place == pytest.approx(left.place.conj())


# ---- loops ----


def air(contour: Curves) -> np.ndarray:
    """As far out as the nearer end of the contour."""
    ends = [abs(contour.start[0]), abs(contour.end[-1])] if len(contour) else [0.0]
    return np.full(len(contour), min(ends))


def along(
    contour: Curves,
    left: np.ndarray,
    path: Curves,
    radius: np.ndarray,
    tolerance: float = TOLERANCE,
    is_ramp: bool = False,
) -> Overcuts:
    """Cuts by moves in offset mode."""
    ramps = np.full(len(radius), is_ramp)
    cuts, *_ = overcuts(contour, left, air(contour), contour.loop, path, radius, ramps, tolerance)
    return Overcuts(contour.row[cuts.wall], cuts.move, cuts.depth, cuts.place)


def swept(contour: Curves, left: np.ndarray, ramps: Curves, radius: np.ndarray) -> Overcuts:
    """Cuts by start-ups and offset cancels."""
    return along(contour, left, ramps, radius, is_ramp=True)


def together(*loops: Loop) -> tuple[Curves, np.ndarray, Curves, np.ndarray]:
    """Several loops in one call, rows counted through."""

    def joined(parts: list[Curves]) -> Curves:
        shifted = [msgspec.structs.replace(part, row=part.row + 100 * k) for k, part in enumerate(parts)]
        return Curves.concatenated(shifted)

    return (
        joined([each.contour for each in loops]),
        np.concatenate([each.left for each in loops]),
        joined([each.path for each in loops]),
        np.concatenate([np.full(len(each.path.row), each.radius) for each in loops]),
    )


def numbered(of: Loop, number: int) -> Loop:
    def moves(part: Curves) -> Curves:
        return msgspec.structs.replace(part, loop=np.full(len(part.row), number))

    return of._replace(contour=moves(of.contour), path=moves(of.path), ramps=moves(of.ramps))


@looped("numbers", [(0, 1, 2), (7, 3, 5)])
def test_the_same_contour_at_three_depths(numbers: tuple[int, ...]) -> None:
    sizes = [polygon(15, 6), polygon(14.5, 6), polygon(14.5, 6)]
    depths = [numbered(loop(45, *size, 45), number) for size, number in zip(sizes, numbers, strict=True)]
    assert list(along(*together(*depths)).row) == []


@looped("numbers", [(0, 1, 2), (7, 3, 5)])
def test_only_the_loop_at_fault_is_found(numbers: tuple[int, ...]) -> None:
    slot = loop(-20, 0, 20, 20 - 4j, 26 - 4j, 26, 46, 60 + 20j, side=LEFT)
    loops = [
        numbered(each, number) for each, number in zip((LEGAL["square"], slot, LEGAL["hexagon"]), numbers, strict=True)
    ]
    found, alone = along(*together(*loops)), slot.overcuts()
    assert list(found.row) == [100 + row for row in alone.row]
    assert list(found.move) == [len(LEGAL["square"].path.row) + move for move in alone.move]
    assert found.depth == pytest.approx(alone.depth)
    assert found.place == pytest.approx(alone.place)


def test_a_loop_behind_a_long_one_that_goes_round_twice_is_looked_at() -> None:
    """What is written once more is left out, the walls of the loops behind it are not."""
    round_twice = np.exp(2j * np.pi * np.arange(2 * 12_000 + 1) / 12_000)
    rows = np.arange(len(round_twice) - 1)

    def circles(radius: float) -> Curves:
        points = radius * round_twice
        kind = np.full(len(rows), Motion.LINE, np.int16)
        return Curves(points[:-1], points[1:], np.full(len(rows), NAN), kind, np.zeros(len(rows), np.int64), rows)

    slot = numbered(loop(-20, 0, 20, 20 - 4j, 26 - 4j, 26, 46, 60 + 20j, side=LEFT), 1)
    shaft = slot._replace(contour=circles(100), left=np.zeros(len(rows), bool), path=circles(106))
    found, alone = along(*together(shaft, slot)), slot.overcuts()
    assert len(alone.row)
    assert list(found.row) == [100 + row for row in alone.row]
    assert found.depth == pytest.approx(alone.depth)


@pytest.mark.ci
@looped("numbers", [(0, 1, 2), (7, 3, 5)])
def test_loops_above_each_other_do_not_see_each_other(numbers: tuple[int, ...]) -> None:
    slots = [
        loop(-20, 0, 20, 20 - 4j, 26 - 4j, 26, 46, 60 + 20j, side=LEFT),
        loop(-20, 0, 21, 21 - 4j, 28 - 4j, 28, 46, 60 + 20j, side=LEFT),
        loop(-20, 0.5j, 20 + 0.5j, 20 - 4.5j, 29 - 4.5j, 29 + 0.5j, 46, 60 + 20j, side=LEFT),
    ]
    alone = [each.overcuts() for each in slots]
    found = along(*together(*(numbered(each, number) for each, number in zip(slots, numbers, strict=True))))
    assert list(found.row) == [100 * k + row for k, each in enumerate(alone) for row in each.row]
    assert found.depth == pytest.approx(np.concatenate([each.depth for each in alone]))
    assert found.place == pytest.approx(np.concatenate([each.place for each in alone]))


def test_a_loop_is_judged_by_its_own_radius() -> None:
    contour, left, path, radius = together(numbered(LEGAL["square"], 0), numbered(LEGAL["hexagon"], 1))
    radius[path.loop == 1] += 0.01
    found = along(contour, left, path, radius)
    assert set(path.row[found.move]) == {101, 102, 103, 104, 105, 106, 107}
    assert (path.loop[found.move] == 1).all()


# ---- the unknown, the empty ----


def test_without_moves() -> None:
    none = loop(45, *SQUARE, 45)
    empty = none.path[:0]
    nothing = np.zeros(0)
    assert len(along(none.contour, none.left, empty, nothing).row) == 0
    assert len(along(empty, none.left[:0], none.path, np.full(len(none.path.row), 5.0)).row) == 0
    assert len(along(empty, none.left[:0], empty, nothing).row) == 0
    assert len(swept(none.contour, none.left, empty, nothing).row) == 0
    assert len(swept(empty, none.left[:0], none.ramps, np.full(2, 5.0)).row) == 0


def test_what_is_unknown_is_left_out() -> None:
    slot = loop(-20, 0, 20, 20 - 4j, 26 - 4j, 26, 46, 60 + 20j, side=LEFT)
    assert len(slot.overcuts(math.nan).row) == 0
    assert len(slot.overcuts(0.0).row) == 0
    gone = slot.contour.row == 2
    hidden = msgspec.structs.replace(slot.contour, end=np.where(gone, NAN, slot.contour.end))
    found = along(hidden, slot.left, slot.path, np.full(len(slot.path.row), 5.0))
    assert not len(found.row)  # what lies behind the hole is not known
    arcs = LEGAL["full circle"]
    unknown = msgspec.structs.replace(arcs.contour, center=np.full(1, NAN))
    assert len(along(unknown, arcs.left, arcs.path, np.full(1, 9.0)).row) == 0


def test_a_gap_in_the_path_cuts_nothing() -> None:
    """Rows that are left out leave a gap, whose bridge would run right across the part."""
    square = LEGAL["square"]
    kept = np.isin(square.path.row, [1, 3])
    path = Curves(*(getattr(square.path, name)[kept] for name in ("start", "end", "center", "kind", "loop", "row")))
    shortened = msgspec.structs.replace(path, end=np.where(path.row == 1, path.start + 1j, path.end))
    assert list(along(square.contour, square.left, shortened, np.full(2, 5.0)).row) == []


def test_an_arc_that_misses_its_end_is_followed_to_it() -> None:
    """The tool's path misses its circle alike; 3410 allows some hundredths."""
    contour = Curves(
        *columns([(20, 0 + 20.02j, 0)]), np.array([Motion.CCW], np.int16), np.zeros(1, int), np.zeros(1, int)
    )
    path = Curves(*columns([(25, 0 + 25.02j, 0)]), np.array([Motion.CCW], np.int16), np.zeros(1, int), np.zeros(1, int))
    left = np.array([False])
    assert len(along(contour, left, path, np.full(1, 5.0)).row) == 0
    assert along(contour, left, path, np.full(1, 5.01)).depth == pytest.approx([0.01], abs=0.001)


def columns(moves: list[tuple[complex, complex, complex]]) -> list[np.ndarray]:
    return [np.array(column, dtype=complex) for column in zip(*moves, strict=True)]


# ---- ramps ----


def test_a_start_up_round_an_outside_corner_sweeps_it() -> None:
    """Case 21A: type A goes straight through the corner (20, 0)."""
    found = loop(0, 20, 20 - 30j, 60 - 30j, side=LEFT).sweeps()
    assert list(found.move) == [0]
    assert list(found.row) == [1]
    assert found.depth == pytest.approx([5], abs=0.003)
    assert found.place == pytest.approx([20])


def test_a_cancel_round_an_outside_corner_sweeps_it() -> None:
    found = loop(60 + 30j, 20 + 30j, 20, 0, side=LEFT).sweeps()
    assert list(found.move) == [1]
    assert list(found.row) == [1]
    assert found.place == pytest.approx([20])


def test_a_start_up_over_the_corner_is_found_though_its_end_is_outside() -> None:
    found = loop(10j, 20, 20 - 30j, 60 - 30j, side=LEFT).sweeps()
    assert list(found.move) == [0]
    assert found.depth == pytest.approx([3], abs=0.01)


@looped(("begin", "depth"), [(-30 + 20j, 5), (-20 + 24j, 1)])
def test_a_start_up_along_the_last_side_cuts_it(begin: complex, depth: float) -> None:
    program = loop(begin, 20j, *BELOW_TOP, 60j, side=LEFT)
    found = program.sweeps()
    assert list(found.move) == [0]
    assert found.row[0] in (4, 5)
    assert 0.9 < found.depth[0] <= depth + 1e-6
    assert list(program.overcuts().row) == []


def test_a_cancel_into_the_part_is_found() -> None:
    assert list(loop(45, *SQUARE, -45).sweeps().move) == [1]


def test_a_start_up_right_across_the_part_is_found() -> None:
    found = loop(-45, *SQUARE, 45).sweeps()
    assert list(found.move) == [0]
    assert found.depth == pytest.approx([5])


def test_a_ramp_over_passes_still_to_come_is_none() -> None:
    """A pocket begun at its wall: the start-up crosses where the later turns of the spiral run."""
    assert list(loop(0, *spiral(30, 4, 4), 0, side=LEFT).sweeps().move) == []


# ---- random contours against plain distances ----


def line_of(moves: Curves, which: int) -> shapely.LineString:
    move = moves.start[which], moves.end[which], moves.center[which], moves.kind[which]
    count = 2 + int(abs(turn_of(*move)) * abs(move[0] - move[2]) * 40) if turn_of(*move) else 2
    points = points_along(*move, count)
    return shapely.LineString(np.stack([points.real, points.imag], axis=1))


def depths(of: Loop) -> np.ndarray:
    """How deep each row is cut, by the distance from every move to every row."""
    walls = np.array([line_of(of.contour, k) for k in range(len(of.contour.row))])
    ways = np.array([line_of(of.path, k) for k in range(len(of.path.row))])
    return of.radius - shapely.distance(walls[:, None], ways[None, :]).min(axis=1)


def depths_of_moves(of: Loop) -> np.ndarray:
    """How deep each move cuts the part that a contour of one turn encloses or surrounds."""
    points = [shapely.get_coordinates(line_of(of.contour, k))[:-1] for k in range(len(of.contour.row))]
    ring = shapely.Polygon(np.concatenate(points))
    part = shapely.difference(shapely.box(-200, -200, 200, 200), ring) if of.left[0] == ring.exterior.is_ccw else ring
    return of.radius - np.array([shapely.distance(part, line_of(of.path, k)) for k in range(len(of.path.row))])


def sharpest(blocks: list[Block]) -> float:
    """Smallest angle [rad] that two blocks enclose, on either side."""
    arriving, leaving, here = [], [], complex(0)
    for block in blocks:
        kind, end, center = block if isinstance(block, tuple) else (Motion.LINE, block, NAN)
        turn = 1j if kind == Motion.CCW else -1j
        leaving.append(end - here if kind == Motion.LINE else turn * (here - center))
        arriving.append(end - here if kind == Motion.LINE else turn * (end - center))
        here = end
    corners = zip(arriving[1:-1], leaving[2:], strict=True)
    return min(abs(float(np.angle(-after / before))) for before, after in corners)


@st.composite
def contours(draw: st.DrawFn, most: int = 10) -> tuple[list[Block], Side, float]:
    """A closed contour that does not cross itself, from the middle of a side, with some arcs; the side; R."""
    gaps = draw(st.lists(st.floats(0.3, 1), min_size=3, max_size=most))
    assume(max(gaps) / sum(gaps) < 0.48)
    turns = np.cumsum(gaps) / sum(gaps) * 2 * np.pi
    sizes = draw(st.lists(st.floats(8, 30), min_size=len(gaps), max_size=len(gaps)))
    corners = [complex(np.round(size * np.exp(1j * turn), 3)) for size, turn in zip(sizes, turns, strict=True)]
    middle = (corners[-1] + corners[0]) / 2
    blocks: list[Block] = [middle, corners[0]]
    for before, after in itertools.pairwise(corners):
        bulge = draw(st.sampled_from([0, 0, 0, 1.05, 1.5, 3, -1.05, -1.5, -3]))
        half = (after - before) / 2
        if bulge:
            center = before + half + 1j * half * math.copysign(math.sqrt(bulge**2 - 1), bulge)
            blocks.append((Motion.CCW if bulge > 0 else Motion.CW, after, center))
        else:
            blocks.append(after)
    blocks.append(middle)
    assume(sharpest(blocks) > math.radians(1))
    side = draw(st.sampled_from([LEFT, RIGHT]))
    return blocks, side, draw(st.floats(0.3, 6))


def around(blocks: list[Block], side: Side, radius: float) -> Loop:
    inward = 1j if side == LEFT else -1j
    first, second = complex(blocks[0]), complex(blocks[1])
    begin = first + inward * (second - first) / abs(second - first) * (radius + 4)
    return loop(begin, *blocks, begin, side=side, radius=radius)


def is_simple(of: Loop) -> bool:
    points = [shapely.get_coordinates(line_of(of.contour, k))[:-1] for k in range(len(of.contour.row))]
    return bool(shapely.LinearRing(np.concatenate(points)).is_simple)


@pytest.mark.nightly
@settings(max_examples=120, deadline=None)
@given(contours())
def test_random_contours_of_one_turn(drawn: tuple[list[Block], Side, float]) -> None:
    """The part is inside or outside: found is exactly what comes nearer to it than R."""
    program = around(*drawn)
    assume(len(program.path.row) and is_simple(program))
    found = program.overcuts()
    depth = dict(zip(found.move, found.depth, strict=True))
    for move, expected in enumerate(depths_of_moves(program)):
        if expected > TOLERANCE + 0.0012:
            assert depth.get(move, 0) == pytest.approx(expected, abs=0.0012)
        elif expected < TOLERANCE - 0.0012:
            assert move not in depth


@pytest.mark.nightly
@settings(max_examples=60, deadline=None)
@given(contours(most=6), st.lists(st.floats(0.05, 0.9), min_size=1, max_size=4), st.booleans())
def test_random_passes_one_in_the_other(
    drawn: tuple[list[Block], Side, float], steps: list[float], shrinking: bool
) -> None:
    """Only the pass that the part keeps is judged, whichever comes first: the largest pocket, the smallest boss."""
    blocks, side, radius = [block if isinstance(block, complex) else block[1] for block in drawn[0]], drawn[1], drawn[2]
    reach = max(abs((b.conjugate() * (b - a)).imag / abs(b - a)) for a, b in itertools.pairwise(blocks))
    factors = 1 - np.cumsum([0, *steps]) * 2 * radius / reach
    factors = factors[factors > 0.3][:: 1 if shrinking else -1]
    assume(len(factors) > 1)
    passes = [[block * factor for block in blocks] for factor in factors]
    assume(is_simple(around(passes[0], side, radius)))
    assume(all(depths(around(each, side, radius)).max() < 1e-6 for each in passes))
    whole = around([block for each in passes for block in each], side, radius)
    assume(not whole.alarm)
    kept = int(np.argmax(factors) if side == LEFT else np.argmin(factors))
    first = kept * len(blocks) + 1
    expected = {
        int(row)
        for row, depth in zip(whole.contour.row, depths(whole), strict=True)
        if first <= row < first + len(blocks) - 1 and depth > TOLERANCE
    }
    # On their way round the corners of the step to the next pass the tool may well cut the wall opposite.
    assert set(whole.overcuts().row) == expected
