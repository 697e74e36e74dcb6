"""The same sections written for several controls have the same path, rates and times; helices and indexing included."""

from __future__ import annotations

import pytest
from twin_sections import CONTROLS, compare


@pytest.mark.one_in(12)
@pytest.mark.parametrize("name", CONTROLS)
@pytest.mark.parametrize("seed", [1, 2])
def test_a_section_is_the_same_on_each_control(name: str, seed: int) -> None:
    compare(seed, name)
