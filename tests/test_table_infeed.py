"""
The infeed cycle of `G12.1 E`: its depth, the gap of its contour and the offsets of its passes, by construction.

The moves of the passes are compared with the manual's own program in test_controls.
"""

from __future__ import annotations

import numpy as np
import pytest
from programs import tables_of

from polarcheck.table.infeed import MOST_PASSES, Infeed

#: Around a square of 20 mm half width, from X60. (30 mm) to the last point and out again.
SQUARE = "G98 G0 X60. C0\nG12.1 {}\nG1 X40. F100\nC20.\nX-40.\nC-20.\nX40.\n{}\nX60.\nG13.1\n"
ENTRY = 1


def table(program: str, machine: str = "gsk-988", *tools: str) -> Infeed:
    infeed: Infeed = tables_of(program, machine, *tools)["infeed"]
    return infeed


@pytest.mark.parametrize(
    ("written", "depth"), [("E4.", 4.0), ("E-4.", 4.0), ("E0", 0.0), ("", 0.0), ("P1", 0.0), ("E", 0.0)]
)
def test_depth_is_a_radius_without_its_sign(written: str, depth: float) -> None:
    infeed = table(SQUARE.format(written, "C0"))
    assert infeed.depth[ENTRY] == depth
    assert infeed.depth.sum() == depth, "no other row has one"


def test_depth_in_inch() -> None:
    assert table("G20\n" + SQUARE.format("E.1", "C0")).depth[ENTRY + 1] == pytest.approx(2.54)


def test_depth_is_that_of_the_section_beginning() -> None:
    infeed = table("E1.\nG12.1\nG1 X10. E2.\nG13.1 E3.\n")
    assert not infeed.depth.any()


@pytest.mark.parametrize(
    ("last", "gap"),
    [
        ("C0", 0.0),
        # The rounding of coordinates to 0.001 mm is no gap; 0.003 mm are.
        ("C.002", 0.0),
        ("C.003", None),
        # It is open where nothing after comes back to (20, 0): measured from the last move, to (30, -4).
        ("C-4.", abs(30 - 4j - 20)),
        ("X36. C3.", abs(30 + 3j - 20)),
    ],
)
def test_gap_is_the_way_back_to_where_the_contour_begins(last: str, gap: float | None) -> None:
    infeed = table(SQUARE.format("E4.", last))
    assert infeed.gap[ENTRY] == pytest.approx(abs(30 + 0.003j - 20) if gap is None else gap)
    assert np.isnan(np.delete(infeed.gap, ENTRY)).all()


@pytest.mark.parametrize("codes", [("G1 ", ""), ("", "G1 "), ("G0 ", "G1 ")])
def test_a_start_up_in_rapid_traverse_leads_to_the_contour(codes: tuple[str, str]) -> None:
    """G0 of the approach in force, or written, gives rapid-in-polar, and beside it no contour that is open."""
    program = "T0202 G98 G0 X60. C0\nG12.1 E4.\n{}G42 X40. C0 F100\n{}C20.\nX-40.\nC-20.\nX40.\nC0\nG40 X60.\nG13.1\n"
    tables = tables_of(program.format(*codes), "gsk-988", "2:radius=1")
    assert tables["infeed"].gap[ENTRY] == 0
    # From 10 mm off the contour it is cut 8, 4 and 0 mm off.
    assert tables["infeed"].offsets(ENTRY).tolist() == [8, 4]
    assert len(tables["moves"]) == len(tables_of(program.format("G1 ", ""), "gsk-988", "2:radius=1")["moves"])


def test_gap_of_a_compensated_contour_ends_with_its_compensation() -> None:
    program = "G98 G0 X60. C0\nG12.1 E4.\nG42 G1 X40. F100\nC20.\nX-40.\nC-20.\nX40.\nC-3.\nG40 X60.\nG13.1\n"
    infeed = table(program, "gsk-988", "2:radius=1")
    assert infeed.gap[ENTRY] == pytest.approx(3.0)


@pytest.mark.parametrize(
    "program",
    [
        "G98 G0 X60. C0\nG12.1 E4.\nG13.1\n",
        "G98 G12.1 E4.\nG1 C20. F100\nC-20.\nG13.1\n",
        SQUARE.format("", "C-4."),
    ],
    ids=["no contour", "X is not known", "no E"],
)
def test_gap_is_not_known(program: str) -> None:
    assert np.isnan(table(program).gap).all()


def test_one_move_has_no_gap() -> None:
    assert table("G98 G0 X60. C0\nG12.1 E4.\nG1 X40. F100\nG13.1\n").gap[ENTRY] == 0.0


@pytest.mark.parametrize(
    ("written", "offsets"),
    [("E4.", [8.0, 4.0]), ("E5.", [5.0]), ("E10.", []), ("E3.", [9.0, 6.0, 3.0]), ("E9.999", [9.999])],
)
def test_passes_lie_whole_depths_off_the_contour(written: str, offsets: list[float]) -> None:
    """The start point lies 10 mm off the contour; a pass through it would cut nothing."""
    infeed = table(SQUARE.format(written, "C0"))
    assert infeed.offsets(ENTRY).tolist() == pytest.approx(offsets)


def test_an_open_contour_has_one_pass() -> None:
    assert len(table(SQUARE.format("E4.", "C-4.")).offsets(ENTRY)) == 0


@pytest.mark.parametrize(("count", "in_part"), [(MOST_PASSES, False), (MOST_PASSES + 1, True)])
def test_of_many_passes_only_some_are_simulated(count: int, in_part: bool) -> None:
    """10 mm and one pass less than there are whole depths in them: the last is the contour itself."""
    depth = 10.0 / (count + 0.5)
    infeed = table(SQUARE.format(f"E{depth:.9f}", "C0"))
    assert len(infeed.offsets(ENTRY)) == count
    assert infeed.is_simulated_in_part.tolist() == [in_part and row == ENTRY for row in range(len(infeed.trace))]
