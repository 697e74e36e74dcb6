"""Where the tool center meets the center of C: rows that do, moves that stop there, and cuts away from it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import tables_of

ENTRY = "O1 T0101\nG98 G0 X60. C0\nG12.1\n"


def lines(mask: object) -> list[int]:
    return [line for line, hit in enumerate(np.asarray(mask).tolist(), 1) if hit]


def test_the_least_increment_is_that_of_the_units() -> None:
    least = tables_of("G20\nG12.1\nG13.1\nM30\nG21\nM30\n%\n")["trace"].lengths.least_step
    assert least == pytest.approx([0.00254] * 4 + [0.001] * 2)
    changed = tables_of("G21\nM30\n", changes={"control": {"least_increment": 0.0001}})["trace"].lengths.least_step
    assert changed == pytest.approx([0.0001] * 2)


@looped(
    ("program", "meets", "off"),
    [
        ("G1 X-40. F200\nC10.\n", [4], [5]),  # straight through
        ("G1 C.002 F200\nX-40.\n", [], [4, 5]),
        ("G1 C.0005 F200\nX-40.\n", [5], [4]),  # nearer than the least increment
        ("G1 X0 F200\nX60.\nC5.\n", [4], [6]),  # stops there; the way back is not told again
        ("G1 X0 F200\nG13.1\nG12.1\nX20.\n", [4, 7], []),  # each section by itself
        ("G1 X0 F200\nM8\nX-60.\n", [4], []),
        ("G1 X0 F200\nX60.\nX-60.\n", [4, 6], []),
        ("G3 X0 C0 R15.\n", [4], []),
        ("G3 X-60. C0 I-30. J0\n", [], [4]),  # round the center
        ("G3 X60. I-30. J30. C60.\n", [], [4]),
        ("G1 X20. F200\nG3 X-20. I-20. J5. C0.\n", [], [4]),  # no circle: nothing is said of its way
        ("G0 X0\nX60.\nG1 C5. F200\nG13.1\n", [4], [6]),  # rapid traverse stops there, too
    ],
)
def test_what_meets_the_center(program: str, meets: list[int], off: list[int]) -> None:
    center = tables_of(ENTRY + program)["center"]
    assert lines(center.meets_center) == meets
    assert lines(center.cuts_off_center) == off


def test_the_tool_center_counts_and_not_the_contour() -> None:
    """At 5 mm from the center, with R 5 towards it and away from it; where R is not known, it counts as away."""
    program = ENTRY + "G1 C15. F200\n{} X-10.\nC-15.\nX40.\nG40 C20.\n"
    for side, radius, meets in (("G41", 5, [6]), ("G42", 5, []), ("G41", 4.9, [])):
        center = tables_of(program.format(side), "fanuc", f"1:radius={radius}")["center"]
        assert lines(center.meets_center) == meets, (side, radius)
        assert lines(center.cuts_off_center) == [line for line in (4, 5, 6, 7, 8) if line not in meets]
    unknown = tables_of(program.format("G41"))["center"]
    assert lines(unknown.meets_center) == []
    assert 6 in lines(unknown.cuts_off_center)


def test_moves_that_stop_at_the_center() -> None:
    """Also where the start of the way is not known; not where the radius of the tool is not."""
    tables = tables_of("G12.1\nG1 X0 C0 F200\nX40.\nX0\n")
    assert (tables["moves"].row + 1).tolist() == [2, 3, 4]
    assert tables["center"].stops_at_center.tolist() == [True, False, True]
    assert lines(tables["center"].meets_center) == [2, 4]
    compensated = tables_of(ENTRY + "G1 G41 X0 F200\nC20.\nX20.\n")["center"]
    assert not compensated.stops_at_center.any()
    assert not compensated.meets_center.any()


STEPS = st.integers(-3, 3)


@pytest.mark.nightly
@settings(deadline=None)
@given(st.lists(st.tuples(STEPS, STEPS), min_size=1, max_size=8))
def test_lines_through_the_center_are_those_of_a_plain_loop(points: list[tuple[int, int]]) -> None:
    """A line meets the center where it stops there or goes through it, and not where it begins there."""
    program = ENTRY + "".join(f"G1 X{2 * x}. C{c}. F200\n" for x, c in points)
    expected, here = [], (30, 0)
    for line, there in enumerate(points, 4):
        if here != there and (there == (0, 0) or (here != (0, 0) and _between(here, there))):
            expected.append(line)
        here = there
    assert lines(tables_of(program)["center"].meets_center) == expected


def _between(here: tuple[int, int], there: tuple[int, int]) -> bool:
    """Whether the origin lies between two points: as long a way over it as straight."""
    return math.isclose(math.dist(here, there), math.hypot(*here) + math.hypot(*there), rel_tol=1e-12)
