"""How far the machine axes go in each row, and where a way beyond a limit begins."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import tables_of

from polarcheck.rules.rule import load_all

INF, NAN = math.inf, math.nan
PROGRAM = """\
O1 T0101
G0 Z5. C0
X60.
G12.1
G1 C40. F200
X-60.
M8
Z-3.
G3 X-60. C-40. I30. J-40.
G1 C0
G13.1
G0 U10. W-2.
G28 U0
"""
FARTHEST = [-INF, -INF, 30, -INF, 50, 50, -INF, -INF, 50, 50, -INF, 35, -INF]
NEAREST = [INF, INF, 30, INF, 30, 40, INF, INF, 50, 30, INF, 35, INF]
"""By hand: the contour goes 30, 30 + 40j, -30 + 40j, round the center to -30 - 40j, -30."""


def test_x_in_the_mode_is_the_distance_to_the_center_and_outside_as_programmed() -> None:
    travel = tables_of(PROGRAM, changes={"limits": {"x_maximum": 40}})["travel"]
    assert travel.most_x == pytest.approx(FARTHEST)
    assert travel.least_x == pytest.approx(NEAREST)
    assert travel.moves_x.tolist() == [math.isfinite(far) for far in FARTHEST]
    assert np.flatnonzero(travel.is_limited_in_x).tolist() == [1, 2, 4, 5, 7, 8, 9, 11]


def test_z_is_the_programmed_one() -> None:
    travel = tables_of(PROGRAM, changes={"limits": {"z_minimum": -20}})["travel"]
    assert travel.z == pytest.approx([NAN] + [5] * 6 + [-3] * 4 + [-5] * 2, nan_ok=True)


@looped(
    ("limits", "x", "z"),
    [
        ({}, False, False),
        ({"x_minimum": 0}, True, False),
        ({"x_maximum": 0.001}, True, False),
        ({"z_minimum": 0}, False, True),
        ({"z_maximum": 0}, False, True),
    ],
)
def test_what_has_no_limits_is_not_looked_at(limits: dict[str, float], x: bool, z: bool) -> None:
    travel = tables_of(PROGRAM, changes={"limits": limits})["travel"]
    assert travel.is_limited_in_x.any() == x
    assert np.isfinite(travel.most_x).any() == x
    assert np.isfinite(travel.least_x).any() == x
    assert np.isfinite(travel.z).any() == z


def test_where_the_tool_center_is_not_known_x_is_not() -> None:
    program = "O1 T0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. C10. F200\nC-10.\nG40 X60.\nG13.1\n"
    limits = {"limits": {"x_maximum": 40}}
    assert np.isnan(tables_of(program, changes=limits)["travel"].most_x).tolist() == [False] * 3 + [True] * 3 + [False]
    known = tables_of(program, "fanuc", "1:radius=4", changes=limits)["travel"].most_x
    assert not np.isnan(known).any()


WAYS = st.lists(st.sampled_from(["X70.", "X80.", "X90.", "X-10.", "Z-20.", "Z-21.", "Z30.", "M8", "M30", "Z0 X99."]))


@pytest.mark.nightly
@settings(deadline=None)
@given(WAYS)
def test_each_way_out_is_told_once_as_a_plain_loop_tells_it(blocks: list[str]) -> None:
    """Of each axis by itself; another program begins anew."""
    limits = {"x_maximum": 40, "x_minimum": 0, "z_minimum": -20}
    tables = tables_of("G0\n" + "".join(f"{block}\n" for block in blocks), changes={"limits": limits})
    expected, is_out = [], {"X": False, "Z": False}
    for line, block in enumerate(blocks, 2):
        told = False
        for word in block.split():
            axis, value = word[0], float(word[1:])
            if word == "M30":
                is_out = {"X": False, "Z": False}
            if axis not in is_out:
                continue
            beyond = not 0 <= value <= 80 if axis == "X" else value < -20
            told |= beyond and not is_out[axis]
            is_out[axis] = beyond
        if told:
            expected.append(line)
    found = load_all()["travel-limit"].hits(tables).mask
    assert tables["trace"].blocks.line[found].tolist() == expected
