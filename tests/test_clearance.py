"""Whether a tool keeps away from all walls: the plain answer against distances that shapely measures."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import assume, given
from hypothesis import strategies as st

from polarcheck.foundation.states import Motion
from polarcheck.geometry.overcuts import clearance
from polarcheck.geometry.segments import Curves

TOLERANCE = 0.002
COORDINATE = st.integers(-20, 20).map(float)
POINT = st.builds(complex, COORDINATE, COORDINATE)
LINES = st.lists(st.tuples(POINT, POINT, st.integers(0, 1)), min_size=1, max_size=5)


def curves(lines: list[tuple[complex, complex, int]]) -> Curves:
    first, last, loop = (np.array(column) for column in zip(*sorted(lines, key=lambda line: line[2]), strict=True))
    start, end = first.astype(complex), last.astype(complex)
    kind = np.full(len(lines), Motion.LINE, np.int16)
    return Curves(start, end, np.full(len(lines), complex(np.nan, np.nan)), kind, loop, np.arange(len(lines)))


def keeps_away(walls: Curves, ways: Curves, radius: float) -> bool:
    return clearance.keeps_away(walls, ways, np.full(len(ways), radius), TOLERANCE)


@pytest.mark.nightly
@given(LINES, LINES, st.floats(0.1, 30.0))
def test_lines_keep_away_where_their_distance_says_so(
    walls: list[tuple[complex, complex, int]], ways: list[tuple[complex, complex, int]], radius: float
) -> None:
    one, other = ([line for line in lines if line[0] != line[1]] for lines in (walls, ways))
    assume(one and other)
    nearest = min(
        (
            shapely.LineString([(a.real, a.imag), (b.real, b.imag)]).distance(
                shapely.LineString([(c.real, c.imag), (d.real, d.imag)])
            )
            for a, b, loop in one
            for c, d, own in other
            if loop == own
        ),
        default=np.inf,
    )
    assume(abs(nearest - radius + TOLERANCE) > 1e-5)
    assert keeps_away(curves(one), curves(other), radius) == (nearest > radius - TOLERANCE)


def test_lines_that_cross_far_from_their_ends_do_not_keep_away() -> None:
    assert not keeps_away(curves([(-100, 100, 0)]), curves([(-100j, 100j, 0)]), 5.0)
    assert keeps_away(curves([(-100, 100, 0)]), curves([(-100j, 100j, 1)]), 5.0)


def test_what_is_not_known_keeps_away_from_nothing() -> None:
    """A point or a radius that is not known is no way at all, as where an overcut is looked for."""
    assert keeps_away(curves([(0, 1, 0)]), curves([(0, complex(np.nan, np.nan), 0)]), 5.0)
    assert keeps_away(curves([(0, 1, 0)]), curves([(0, 1, 0)]), np.nan)


def test_many_pairs_are_left_to_what_measures_them() -> None:
    walls = curves([(complex(x), complex(x + 1), 0) for x in range(200)])
    assert keeps_away(walls, curves([(100j, 200j, 0)]), 5.0)
    assert not keeps_away(walls, curves([(complex(x, 100), complex(x + 1, 100), 0) for x in range(200)]), 5.0)
