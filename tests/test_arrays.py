"""Look-ups in arrays against those of NumPy, whose own load what a small check does without."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from polarcheck.arrays import different, is_among

NUMBERS = st.lists(st.one_of(st.integers(-5, 5).map(float), st.floats(allow_nan=False)), max_size=9)


@given(NUMBERS)
def test_different_values_are_those_of_numpy(values: list[float]) -> None:
    assert different(np.array(values)).tolist() == np.unique(values).tolist()


@given(st.one_of(NUMBERS, st.lists(st.just(float("nan")), max_size=2)), NUMBERS)
def test_values_among_others_are_those_of_numpy(values: list[float], wanted: list[float]) -> None:
    assert is_among(np.array(values), wanted).tolist() == np.isin(values, wanted).tolist()


def test_texts_are_found_whatever_their_lengths() -> None:
    assert is_among(np.array(["a", "longer", ""]), ("longer than all", "longer")).tolist() == [False, True, False]
    assert is_among(np.array([], np.str_), ("a",)).tolist() == []
