"""The programmed path and that of the tool center as moves, and from moves back to rows."""

from __future__ import annotations

import math

import msgspec
import numpy as np
import pytest
from plane_moves import points_along
from programs import moves_of, tables_of, trace_of

from polarcheck.columns.path.moves import Moves, any_in_row, compensation_path, per_row, programmed_moves, z_along
from polarcheck.foundation.states import Motion
from polarcheck.geometry.cutter_compensation.offset_path import Phase

PROGRAM = (
    "T0101\nG98 G0 X60. C0\nG12.1\nG1 X40. F100\nZ1.\nG3 X0 C20. I-20. J0\nG2 X-40. C0 I0\nG1 G42 X-60. F200\n"
    "G40 I5. X-80. C-3.\nM0\nG0 X80.\nG13.1\n"
)


def test_programmed_moves_are_those_on_the_plane() -> None:
    """Rapid traverse too, as the worst case of its straight way; an arc without a center goes along its chord."""
    moves = programmed_moves(trace_of(PROGRAM))
    assert (moves.row + 1).tolist() == [4, 6, 7, 8, 9, 11]
    assert moves.kind.tolist() == [Motion.LINE, Motion.CCW, Motion.CW, Motion.LINE, Motion.LINE, Motion.RAPID]
    assert moves.end.tolist() == [20, 20j, -20, -30, -40 - 3j, 40 - 3j]
    assert moves.start.tolist() == [30, 20, 20j, -20, -30, -40 - 3j]
    assert moves.center[1:3].tolist() == [0, 20j]
    assert moves.feed.tolist() == [100, 100, 100, 200, 200, 200]
    # The center of the second arc is its start, with which it has no way of its own.
    assert moves.known.tolist() == [True] * 6
    assert not moves.corner.any()
    assert not moves.phase.any()
    chord = programmed_moves(trace_of(PROGRAM.replace("I-20. J0", "")))
    assert (chord.kind[1], chord.length[1]) == (Motion.LINE, pytest.approx(20 * math.sqrt(2)))


def test_a_cycle_in_the_mode_is_no_move() -> None:
    trace = trace_of("G98 G0 X60. C0 Z2.\nG12.1\nG1 X40. F100\nG90 X20. Z1.\nG1 C5.\nG13.1\n")
    assert (programmed_moves(trace).row + 1).tolist() == [3, 5]


def test_rows_as_compensation_takes_them() -> None:
    trace = trace_of(PROGRAM, "fanuc", "1:radius=-4")
    row = np.flatnonzero(trace.mode.in_polar)
    path = compensation_path(trace, row)
    line = trace.blocks.line[row]
    assert line.tolist() == list(range(4, 12))
    assert line[path.moves].tolist() == [4, 6, 7, 8, 9, 11]
    assert line[path.side_written].tolist() == [8]
    assert line[path.side == 42].tolist() == [8]
    assert line[path.stops_reading].tolist() == [10]
    assert set(path.radius) == {-4}
    # I and J are a direction beside G40 only; J that is not written is 0.
    assert line[~np.isnan(path.cancel_vector)].tolist() == [9]
    assert path.cancel_vector[5] == 5
    assert path.section.tolist() == [0] * 8


def test_moves_of_the_tool_center_know_their_rows() -> None:
    """An acute outside corner of 45 degrees, the tool on the right: two vectors, the line between is of the latter."""
    program = "T0101\nG98 G0 X60. C-20.\nG12.1\nG1 C-20. F500\nG42 X20. F100\nC20.\nX-20. C0\nG40 X-60.\nG13.1\n"
    moves = moves_of(program, "fanuc", "1:radius=4")
    assert (moves.row + 1).tolist() == [4, 5, 6, 7, 7, 8]
    assert moves.phase.tolist() == [
        Phase.CANCELLED,
        Phase.START_UP,
        Phase.OFFSET,
        Phase.OFFSET,
        Phase.OFFSET,
        Phase.CANCEL,
    ]
    assert moves.corner.tolist() == [False] * 3 + [True] + [False] * 2
    assert moves.feed.tolist() == [500, *[100] * 5]
    assert moves.start[1:].tolist() == pytest.approx(moves.end[:-1].tolist())
    # A = P + R n1 + R d1 and B = P + R n2 - R d2 (facts of the lathe manuals for acute outside corners).
    first, second = 1j, np.exp(-0.75j * math.pi)
    corner = 10 + 20j
    assert moves.start[3] == pytest.approx(corner - 1j * 4 * first + 4 * first)
    assert moves.end[3] == pytest.approx(corner - 1j * 4 * second - 4 * second)


# ---- what moves ask of the lathe ----


def some() -> Moves:
    """Lines and arcs of two sections in turn."""
    program = (
        "G98 G0 X60. C0\nG12.1\nG1 X40. C-7. F300\nC12.\nG3 X0 C20. R26.\nG1 X-30. C-4.\nG2 X10. C-30. R40.\nG13.1\n"
    )
    return programmed_moves(trace_of(program + program.replace("G0 X60. C0", "G0 X50. C90.")))


def test_columns_of_moves_agree_with_points_along_them() -> None:
    moves = some()
    assert len(moves) == 10
    assert moves.section.tolist() == [0] * 5 + [1] * 5
    for at in range(len(moves)):
        shape = tuple(complex(column[at]) for column in (moves.start, moves.end, moves.center))
        points = points_along(*shape, int(moves.kind[at]), 20_001)
        assert np.abs(points).min() == pytest.approx(moves.nearest[at], abs=1e-5)
        assert np.abs(points).max() == pytest.approx(moves.farthest[at], abs=1e-5)
        length = np.abs(np.diff(points)).sum()
        assert length == pytest.approx(moves.length[at], rel=1e-6)
        assert moves.time[at] == pytest.approx(length / 300 * 60, rel=1e-6)
        angles = np.degrees(np.unwrap(np.angle(points)))
        before, after = (column[at] for column in moves.c_angles)
        assert after - before == pytest.approx(angles[-1] - angles[0], abs=1e-6)
        # F 300 mm/min over 20,000 even ways.
        rate = np.abs(np.diff(angles)).max() / (length / 20_000) * 300
        assert moves.c_feed[at] == pytest.approx(rate, rel=1e-3)
        assert moves.feed_allowed(1000.0)[at] == pytest.approx(300 * 1000 / moves.c_feed[at])


def test_c_goes_on_from_move_to_move_and_begins_where_its_section_does() -> None:
    before, after = some().c_angles
    assert before[[0, 5]] == pytest.approx([0, 90])
    assert before[1:5] == pytest.approx(after[:4])
    assert before[6:] == pytest.approx(after[5:9])


def test_what_is_not_known_of_a_move() -> None:
    moves = moves_of(PROGRAM, "fanuc")
    assert moves.known.tolist() == [row + 1 not in (8, 9) for row in moves.row]
    for column in (moves.nearest, moves.farthest, moves.c_feed, moves.c_acceleration, moves.feed_allowed(1.0)):
        assert np.isnan(column[~moves.known]).all()
        assert not np.isnan(column[moves.known]).any()


# ---- from moves to rows ----


def test_one_value_per_row_of_moves_in_any_order() -> None:
    moves = some()[np.array([True] * 6 + [False] * 4)]
    moves = msgspec.structs.replace(moves, row=np.array([4, 1, 4, 3, 1, 4]))
    values = np.array([5.0, 2.0, 7.0, np.nan, -1.0, 6.0])
    assert per_row(values, moves, 6, 0.0).tolist()[:3] == [0, 2, 0]
    assert per_row(values, moves, 6, 0.0).tolist()[4:] == [7, 0]
    smallest = per_row(values, moves, 6, math.inf, largest=False)
    assert smallest.tolist()[:3] == [math.inf, -1, math.inf]
    assert smallest[4] == 5
    assert np.isnan(smallest[3])
    assert any_in_row(values > 4, moves, 6).tolist() == [False] * 4 + [True, False]


def test_an_endless_value_of_a_move_is_none_of_a_row_without() -> None:
    moves = some()
    column = per_row(np.full(len(moves), np.inf), moves, 20, 0.0, largest=False)
    assert set(np.flatnonzero(column)) == set(moves.row.tolist())


def test_chosen_and_joined() -> None:
    moves = some()
    odd = np.arange(len(moves)) % 2 == 1
    parts = [moves[odd], moves[~odd]]
    assert [len(part) for part in parts] == [5, 5]
    together = Moves.concatenated(parts)
    assert together.end.tolist() == [*moves.end[odd], *moves.end[~odd]]
    assert together.row.tolist() == [*moves.row[odd], *moves.row[~odd]]
    assert together.entry.tolist() == moves.entry.tolist()


def test_z_goes_as_the_way_does_where_a_block_is_several_moves() -> None:
    """Round an acute corner on its outer side the tool center makes more than one move for a block."""
    program = "T0101\nG98 G0 X100. Z2. C0\nG12.1\nG1 G42 X60. F100\nC30. Z-1.\nX-60. C0 Z-9.\nG40 X-100.\nG13.1\n"
    tables = tables_of(program, "fanuc", "1:radius=4")
    trace, moves = tables["trace"], tables["moves"]
    z_from, z_to = z_along(trace, moves)
    assert z_from[0] == 2
    assert z_from[1:].tolist() == z_to[:-1].tolist()
    several = [row for row in set(moves.row.tolist()) if (moves.row == row).sum() > 1]
    assert several
    before = dict(zip([*range(1, len(trace))], trace.path.z[:-1].tolist(), strict=True))
    for row in set(moves.row.tolist()):
        own = moves.row == row
        share = np.cumsum(moves.length[own]) / moves.length[own].sum()
        assert z_to[own] == pytest.approx(before[row] + share * (trace.path.z[row] - before[row]))
