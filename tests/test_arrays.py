"""Look-ups in arrays against those of NumPy, whose own load what a small check does without."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from polarcheck.foundation.arrays import (
    computed,
    different,
    first_of_each,
    folded,
    is_among,
    is_uniform,
    median,
    repeated,
)

NUMBERS = st.lists(st.one_of(st.integers(-5, 5).map(float), st.floats(allow_nan=False)), max_size=9)


@pytest.mark.nightly
@given(NUMBERS)
def test_different_values_are_those_of_numpy(values: list[float]) -> None:
    assert different(np.array(values)).tolist() == np.unique(values).tolist()


@pytest.mark.ci
@given(NUMBERS)
def test_the_first_of_each_value_is_that_of_numpy(values: list[float]) -> None:
    _, *expected = np.unique(values, return_index=True, return_inverse=True)
    for found, of_numpy in zip(first_of_each(np.array(values)), expected, strict=True):
        assert found.tolist() == of_numpy.tolist()


@pytest.mark.nightly
@given(st.lists(st.tuples(st.integers(0, 3), st.floats(-9, 9)), max_size=12))
def test_folds_of_groups_are_those_of_their_values(pairs: list[tuple[int, float]]) -> None:
    group, values = np.array([number for number, _ in pairs], np.int64), np.array([value for _, value in pairs])
    expected = [min([value for number, value in pairs if number == asked], default=99.0) for asked in range(4)]
    assert folded(np.minimum, group, values, 4, 99.0).tolist() == expected


@pytest.mark.ci
@given(st.one_of(NUMBERS, st.lists(st.just(float("nan")), max_size=2)), NUMBERS)
def test_values_among_others_are_those_of_numpy(values: list[float], wanted: list[float]) -> None:
    assert is_among(np.array(values), wanted).tolist() == np.isin(values, wanted).tolist()


@pytest.mark.ci
@given(st.lists(st.floats(-1e9, 1e9) | st.just(np.nan), min_size=1))
def test_the_median_is_that_of_numpy(values: list[float]) -> None:
    expected = float(np.median(np.array(values)))
    assert median(np.array(values)) == pytest.approx(expected, rel=0, abs=0, nan_ok=True)


def test_texts_are_found_whatever_their_lengths() -> None:
    assert is_among(np.array(["a", "longer", ""]), ("longer than all", "longer")).tolist() == [False, True, False]
    assert is_among(np.array([], np.str_), ("a",)).tolist() == []


def test_a_column_of_one_value_takes_the_memory_of_one_and_cannot_be_written_to() -> None:
    column = repeated(np.float64(2.5), 1000)
    assert column.tolist() == [2.5] * 1000
    assert not column.flags.writeable
    assert isinstance(column.base, bytes)
    assert len(column.base) == 8
    assert repeated(np.int64(3), 0).tolist() == []


@pytest.mark.nightly
@given(NUMBERS, st.floats(allow_nan=False))
@example([1.0], 8.99e307)
@example([float("-inf")], float("inf"))
def test_what_is_computed_once_is_what_is_computed_row_by_row(values: list[float], one: float) -> None:
    column = np.array(values)
    with np.errstate(all="ignore"):  # sums of the largest numbers overflow, and infinities have no difference
        expected = column + np.full(len(values), one)
        found = computed(np.add, column, repeated(np.float64(one), len(values)))
        once = computed(np.add, *[repeated(np.float64(one), 4)] * 2)
    np.testing.assert_array_equal(found, expected)
    assert once.tolist() == [one + one] * 4


@pytest.mark.ci
@given(st.lists(st.sampled_from((1.0, 2.0, float("nan"))), min_size=1, max_size=5))
def test_values_are_one_where_all_are_the_same_or_unknown(values: list[float]) -> None:
    assert is_uniform(np.array(values)) == (len({str(value) for value in values}) == 1)
