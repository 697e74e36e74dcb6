"""The same sections written for several controls have the same path, rates and times; helices and indexing included."""

from __future__ import annotations

from cases import looped
from twin_sections import CONTROLS, compare


@looped("name", CONTROLS, one_in=12)
@looped("seed", [1, 2])
def test_a_section_is_the_same_on_each_control(name: str, seed: int) -> None:
    compare(seed, name)
