"""What is in force, and positions, against a loop over the rows that anybody can read."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from polarcheck.columns.filling import before, fill_down, positions

ROW = st.tuples(
    st.sampled_from([math.nan, math.nan, 5.0, -2.5]),
    st.sampled_from([0.0, 0.0, 1.0, -0.5, math.nan]),
    st.booleans(),
    st.sampled_from([math.nan, 7.0]),
)


@pytest.mark.nightly
@given(st.lists(ROW, max_size=12))
def test_positions_are_those_of_a_loop(rows: list[tuple[float, float, bool, float]]) -> None:
    expected, here = [], math.nan
    for absolute, increment, resets, value in rows:
        if not math.isnan(absolute):
            here = absolute if not math.isnan(increment) else math.nan
            here = absolute
        elif math.isnan(increment):
            here = math.nan
        elif resets:
            here = value + increment
        else:
            here += increment
        expected.append(here)
    columns = [np.array([row[number] for row in rows]) for number in range(4)]
    found = positions(
        columns[0].astype(float), columns[1].astype(float), columns[2].astype(bool), columns[3].astype(float)
    )
    np.testing.assert_allclose(found, np.array(expected, float), rtol=1e-12, atol=1e-12)


@pytest.mark.nightly
@given(st.lists(st.tuples(st.integers(0, 9), st.booleans()), max_size=12))
def test_what_is_in_force_is_the_last_that_was_written(rows: list[tuple[int, bool]]) -> None:
    expected, here = [], -1
    for value, written in rows:
        here = value if written else here
        expected.append(here)
    values, written = (np.array([row[number] for row in rows], kind) for number, kind in ((0, np.int64), (1, bool)))
    assert fill_down(values, written, -1).tolist() == expected


def test_before_is_the_row_above_within_a_program() -> None:
    after, starts = np.array([1, 2, 3, 4]), np.array([True, False, True, False])
    assert before(after, starts, 0).tolist() == [0, 1, 0, 3]
    assert before(after, np.zeros(4, bool), 9).tolist() == [9, 1, 2, 3]
    assert before(after[:0], starts[:0], 0).tolist() == []
