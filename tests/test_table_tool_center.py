"""The tool center per row: what the control objects to, how near it comes to the center, what it asks of C."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import tables_of

from polarcheck.rules.tables import Tables

HEAD = "T0101\nG98 G0 X100. C0\nG12.1\nG1 C20. F500\n"
TAIL = "G40 X100.\nG13.1\n"
OBJECTIONS = ("inside_arc_too_small", "interferes", "no_intersection", "movement_missing", "arc_center_on_path")


def tables_with(program: str, *tools: str, **more: Any) -> Tables:
    return tables_of(HEAD + program + TAIL, "fanuc", *(tools or ("1:radius=4",)), **more)


@looped(
    ("program", "column", "lines"),
    [
        # An arc of 3 mm, the tool on its inner side; at R 2.5 it fits.
        ("G41 X60. F200\nC0\nG3 X66. C-3. R3.\nG1 X80.\n", "inside_arc_too_small", [7]),
        ("G41 X60. F200\nC0\nG2 X54. C-3. R3.\nG1 X40.\n", "inside_arc_too_small", []),
        # A slot of 6 mm with a bottom.
        ("G41 X60. F200\nC3.\nX40.\nC-3.\nX60.\nC-20.\n", "interferes", [8]),
        ("G41 X60. F200\nC5.\nX40.\nC-5.\nX60.\nC-20.\n", "interferes", []),
        # At a distance of 4 from C20 down the tool center passes an arc of radius 5 round the end of the line.
        ("G41 X60. F200\nC0\nG3 X70. C0 R5.\nG1 C-20.\n", "no_intersection", [6]),
        # Two blocks without a way on the plane, and one.
        ("G41 X60. F200\nM8\nM9\nC-20.\n", "movement_missing", [5]),
        ("G41 X60. F200\nM8\nC-20.\n", "movement_missing", []),
        ("G41 X60. F200\nC-10.\nM0\nX20.\n", "movement_missing", [6]),
        ("G41 X60. F200\nC0\nG3 X66. C-3. I0 J0\nG1 X80.\n", "arc_center_on_path", [7]),
    ],
)
def test_what_the_control_objects_to(program: str, column: str, lines: list[int]) -> None:
    tables = tables_with(program)
    for name in OBJECTIONS:
        found = tables["trace"].blocks.line[getattr(tables["tool_center"], name)].tolist()
        assert found == (lines if name == column else []), name


def test_what_a_profile_reads_ahead() -> None:
    program = "G41 X60. F200\nM8\nM9\nC-20.\n"
    tables = tables_with(program, changes={"compensation": {"read_ahead": 4}})
    assert not tables["tool_center"].movement_missing.any()


def test_without_a_radius_nothing_is_found() -> None:
    tables = tables_with("G41 X60. F200\nC3.\nX40.\nC-3.\nX60.\nC-20.\n", "1:nose=0")
    assert not any(getattr(tables["tool_center"], name).any() for name in OBJECTIONS)


# ---- distance and speed ----

#: Along X = 20 from C 20 to C -15; with R 4 outside at X = 24, from C 20 to the corner at C -19.
FLAT = "G41 X40. F240\nC-15.\nX-40.\n"


def test_distance_and_rate_of_a_flat() -> None:
    tables = tables_with(FLAT)
    tool_center, row = tables["tool_center"], 5
    assert tool_center.nearest[row] == pytest.approx(24)
    assert tool_center.farthest[row] == pytest.approx(abs(24 + 20j))
    # F = L * omega at the nearest point.
    assert tool_center.c_feed[row] == pytest.approx(math.degrees(240 / 24))
    # The rate is F L / (L2 + s2); its slope is greatest where s is L / sqrt 3: (F / L)2 * 3 sqrt 3 / 8.
    assert tool_center.c_acceleration[row] == pytest.approx(math.degrees((4 / 24) ** 2 * 3 * math.sqrt(3) / 8))


def test_rows_without_a_move() -> None:
    tool_center = tables_with(FLAT)["tool_center"]
    for row in (0, 1, 2, 8):
        assert (tool_center.nearest[row], tool_center.farthest[row]) == (math.inf, -math.inf)
        assert (tool_center.c_feed[row], tool_center.c_acceleration[row]) == (0, 0)
        assert tool_center.feed_allowed[row] == math.inf


@looped("tool", ["1:nose=0", "2:radius=4"])
def test_without_a_radius_the_compensated_rows_are_not_known(tool: str) -> None:
    tables = tables_with(FLAT, tool)
    for column in ("nearest", "farthest", "c_feed", "c_acceleration", "feed_allowed"):
        unknown = np.isnan(getattr(tables["tool_center"], column))
        assert (np.flatnonzero(unknown) + 1).tolist() == [5, 6, 7, 8], column


def test_without_a_feed_the_rates_are_not_known() -> None:
    program = "T0101\nG98 G0 X40. C0\nG12.1\nG1 C5.\nG13.1\n"
    tool_center = tables_of(program)["tool_center"]
    assert tool_center.nearest[3] == 20
    assert np.isnan(tool_center.c_feed[3])
    assert math.degrees(tool_center.feed_allowed[3] / 20) == pytest.approx(tool_center.c_feed_limit)


@looped(
    ("limits", "limit"),
    [
        ({"c_feed": 3600}, 3600),
        ({"c_feed": 3600, "automatic_override": True, "override_share": 80}, 2880),
        ({"c_feed": 3600, "automatic_override": True, "override_share": 150}, 3600),
        ({"c_feed": 3600, "automatic_override": False, "override_share": 80}, 3600),
        ({"c_feed_suspicious": 7200}, 7200),
    ],
)
def test_limit_of_c(limits: dict[str, Any], limit: float) -> None:
    tool_center = tables_with(FLAT, changes={"limits": limits})["tool_center"]
    assert tool_center.c_feed_limit == limit
    assert tool_center.feed_allowed[5] == pytest.approx(24 * math.radians(limit))


def test_override_leaves_c_its_share_of_the_limit() -> None:
    limits = {"c_feed": 600, "automatic_override": True, "override_share": 80}
    tool_center = tables_with(FLAT, changes={"limits": limits})["tool_center"]
    rate = math.degrees(240 / 24)
    assert rate > 480
    assert tool_center.override[5] == pytest.approx(100 * 480 / rate)
    assert tool_center.true_feed[5] == pytest.approx(240 * 480 / rate)
    assert tool_center.override[[0, 1, 2, 8]].tolist() == [100] * 4
    without = tables_with(FLAT, changes={"limits": {"c_feed": 480}})["tool_center"]
    assert set(without.override) == {100}
    assert without.true_feed[5] == 240


def test_the_row_has_the_worst_of_its_moves() -> None:
    """An acute outside corner: the line that the control adds is the row's nearest to the center, or its fastest."""
    tables = tables_with("G42 X20. C-20. F100\nC20.\nX-20. C0\n", changes={"limits": {"c_feed": 600}})
    moves, tool_center = tables["moves"], tables["tool_center"]
    several = [row for row in set(moves.row.tolist()) if (moves.row == row).sum() > 1]
    assert several
    for row in several:
        own = moves.row == row
        assert tool_center.nearest[row] == moves.nearest[own].min()
        assert tool_center.farthest[row] == moves.farthest[own].max()
        assert tool_center.c_feed[row] == moves.c_feed[own].max()
        assert tool_center.feed_allowed[row] == moves.feed_allowed(600.0)[own].min()
