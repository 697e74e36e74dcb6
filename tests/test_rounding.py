"""From which length on rounding cannot turn a block back on the path of the tool center."""

from __future__ import annotations

import numpy as np
from cases import looped

from polarcheck.geometry.rounding import may_turn_back


@looped("way", [1, 1j, -1, np.exp(2.2j)])
@looped(
    ("half", "radius", "limit"),
    [(0.0005, 5.0, 0.1), (0.0005, -5.0, 0.1), (0.0003 + 0.0004j, 5.0, 0.1), (0.00125, 20.0, 0.31622777), (0.5, 2.0, 2)],
)
def test_a_block_turns_back_below_the_length_at_which_its_ends_turn_it_by_more_than_it_is_long(
    half: complex, radius: float, limit: float, way: complex
) -> None:
    """4 half / l of turning takes R * 4 half / l off the way: as much as there is of it at l * l = 4 half * R."""
    start = np.full(3, 7 - 3j)
    end = start + way * limit * np.array([0.5, 0.99, 1.01])
    found = may_turn_back(start, end, np.full(3, half, complex), np.full(3, radius))
    assert found.tolist() == [True, True, False]


def test_what_is_shortened_to_nothing_does_not_turn_back() -> None:
    """4 * 0.5 * 2 is 2 * 2 to the last digit."""
    assert may_turn_back(np.zeros(1, complex), np.array([2 + 0j]), np.array([0.5 + 0j]), np.array([2.0])).tolist() == [
        False
    ]
