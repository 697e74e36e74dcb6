"""Cuts into the contour, taken back to rows: grooves and corners whose depth follows from R and one width."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of

from polarcheck.columns.contour.overcuts import CutsOfRows, loop_of_row, objected
from polarcheck.geometry.overcuts import own_loop
from polarcheck.rules.tables import Tables

#: A groove of 6 mm between C3 and C-3 through the middle of a square of 40, gone round on the outside.
GROOVE = (
    "T0101\nG98 G0 X100. C0\nG12.1\nG1 C3. F500\nG41 X60. F200\nX30.\nC20.\nX-20.\nC-20.\nX30.\nC-3.\nX60.\n"
    "G40 X100.\nG13.1\n"
)


def depths(tables: Tables, column: str = "depth") -> dict[int, float]:
    """By line, where there is any."""
    values = getattr(tables["overcuts"], column)
    return {int(tables["trace"].blocks.line[row]): float(values[row]) for row in np.flatnonzero(values)}


@pytest.mark.ci
@looped(("radius", "depth"), [(4, 2), (5, 4), (3.002, 0.004), (3, 0)])
def test_a_groove_narrower_than_the_cutter(radius: float, depth: float) -> None:
    """The tool center runs R from one wall, that is 6 - R from the other one: 2 R - 6 too near."""
    tables = tables_of(GROOVE, "fanuc", f"1:radius={radius}", changes={"compensation": {"overcut_tolerance": 0.003}})
    expected = {line: pytest.approx(depth, abs=0.003) for line in (6, 12)} if depth else {}
    assert {line: found for line, found in depths(tables).items() if line in (6, 12)} == expected
    assert set(depths(tables)) == ({6, 12} if depth else set())


@pytest.mark.ci
def test_loops_are_searched_alike_one_by_one_and_all_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    body = GROOVE.partition("G41")[2].partition("G13.1")[0]
    deeper = "".join(f"G1 Z{-depth}. C3.\nG41{body}" for depth in (1, 2, 3))
    program = f"T0101\nG98 G0 X100. Z2. C0\nG12.1\nG1 C3. F500\n{deeper}G13.1\n"
    found = []
    for at_once in (1, 20_000):
        monkeypatch.setattr(own_loop, "_AT_ONCE", at_once)
        cuts = tables_of(program, "fanuc", "1:radius=4")["overcuts"].cuts
        found.append([getattr(cuts, column).tolist() for column in ("row", "into", "depth", "place")])
    assert found[0] == found[1]
    assert len(set(found[0][0])) == 6


def test_who_is_cut_into_and_where() -> None:
    tables = tables_of(GROOVE, "fanuc", "1:radius=4")
    line, overcuts = tables["trace"].blocks.line, tables["overcuts"]
    # The wall opposite begins or ends in a corner, which is of two blocks.
    for row, wall, blocks in ((5, -3, (11, 12)), (11, 3, (6, 7))):
        into, place = overcuts.cuts.deepest(row)
        assert line[into] in blocks
        assert place.imag == wall
        assert 15 <= place.real <= 30
    assert max(overcuts.cuts.depth[overcuts.cuts.row == 5]) == overcuts.depth[5]


def test_the_deepest_of_the_cuts_of_a_row() -> None:
    depth = np.array([0.5, 0.7, 0.6, 0.9])
    cuts = CutsOfRows(np.array([3, 3, 3, 5]), np.array([1, 2, 8, 4]), depth, np.array([1j, 2j, 3j, 4j]))
    assert cuts.deepest(3) == (2, 2j)
    assert cuts.deepest(5) == (4, 4j)


def test_up_to_the_tolerance_nothing_is_cut() -> None:
    for tolerance, found in ((1.9, True), (2.1, False)):
        changes = {"compensation": {"overcut_tolerance": tolerance}}
        assert bool(depths(tables_of(GROOVE, "fanuc", "1:radius=4", changes=changes))) == found


@looped("program", [GROOVE.replace("G41 ", ""), GROOVE.replace("T0101", "T0202"), "O1\nM30\n", ""])
def test_without_compensation_or_radius_nothing_is_cut(program: str) -> None:
    overcuts = tables_of(program, "fanuc", "1:radius=4")["overcuts"]
    assert not overcuts.depth.any()
    assert not overcuts.sweep_depth.any()
    assert len(overcuts.cuts.row) == len(overcuts.sweeps.row) == 0


def test_where_the_control_objects_nothing_else_is_said() -> None:
    """A groove with its end in the mode: the tool center would run against the program, which the control sees."""
    program = (
        "T0101\nG98 G0 X100. C0\nG12.1\nG1 C20. F500\nG41 X60. F200\nC3.\nX40.\nC-3.\nX60.\nC-20.\nG40 X100.\nG13.1\n"
    )
    tables = tables_of(program, "fanuc", "1:radius=4")
    trace, tool_center = tables["trace"], tables["tool_center"]
    assert trace.blocks.line[tool_center.interferes].tolist() == [8]
    assert trace.blocks.line[objected(trace, tool_center)].tolist() == [7, 8, 9]
    assert len(tables["overcuts"].cuts.row)
    assert depths(tables) == {}


# ---- loops ----


def test_loops_reach_from_start_up_to_cancel_and_from_depth_to_depth() -> None:
    program = (
        "G98 G0 X60. C0\nG12.1\nG1 G42 X40. F100\nC10.\nZ-1.\nX20.\nM8\nG40 X60.\nG42 X40.\nC5.\nG40 X60.\nG13.1\n"
        "G12.1\nG42 X40.\nC10.\nG40 X60.\nG13.1\n"
    )
    trace = tables_of(program)["trace"]
    loops = loop_of_row(trace).tolist()
    own = [None, None, "a", "a", "b", "b", "b", None, "c", "c", None, None, None, "d", "d", None, None]
    assert [loop == -1 for loop in loops] == [name is None for name in own]
    assert len({(name, loop) for name, loop in zip(own, loops, strict=True) if name}) == len({*own}) - 1


def test_walls_at_another_depth_are_not_cut() -> None:
    """The groove, with its second wall below the first."""
    program = GROOVE.replace("C-20.\n", "C-20.\nZ-1.\n")
    assert depths(tables_of(program, "fanuc", "1:radius=4")) == {}


# ---- start-up and offset cancel ----

#: From the center of the square to its corner (30, 0), beside which type A ends: straight over it, all of R deep.
OVER_CORNER = "T0101\nG98 G0 X20. Z2. C0\nG12.1\n{}G1 G41 X60. C0 F200\n{}C-30.\nX20.\nG40 C-50.\nG13.1\n"


def test_a_start_up_over_a_corner() -> None:
    tables = tables_of(OVER_CORNER.format("", ""), "fanuc", "1:radius=5")
    assert depths(tables, "sweep_depth") == {4: pytest.approx(5, abs=0.006)}
    into, place = tables["overcuts"].sweeps.deepest(3)
    assert (tables["trace"].blocks.line[into], place) == (5, pytest.approx(30))
    assert depths(tables) == {}


def test_a_start_up_above_the_part_sweeps_nothing() -> None:
    assert depths(tables_of(OVER_CORNER.format("G1 Z1. F100\n", "Z-1.\n"), "fanuc", "1:radius=5"), "sweep_depth") == {}


@looped(("z", "sweeps"), [("0", False), ("-0.1", True), ("0.1", False)])
def test_the_face_is_at_z0(z: str, sweeps: bool) -> None:
    """At Z0 a ramp runs in air, above a contour that lies deeper; just below there is material."""
    tables = tables_of(OVER_CORNER.format(f"G1 Z{z} F100\n", "Z-1.\n"), "fanuc", "1:radius=5")
    assert bool(depths(tables, "sweep_depth")) == sweeps


@looped("z", ["0", "-1.", "2."])
def test_a_ramp_at_the_depth_of_its_contour_sweeps_it(z: str) -> None:
    tables = tables_of(OVER_CORNER.format(f"G1 Z{z} F100\n", ""), "fanuc", "1:radius=5")
    assert depths(tables, "sweep_depth") == {5: pytest.approx(5, abs=0.006)}


def test_an_offset_cancel_over_a_corner_belongs_to_its_loop() -> None:
    program = "T0101\nG98 G0 X20. C-50.\nG12.1\nG1 C-50. F100\nG42 C-30. F200\nX60.\nC0\n{}X20.\nG13.1\n"
    tables = tables_of(program.format("G40 "), "fanuc", "1:radius=5")
    assert depths(tables, "sweep_depth") == {8: pytest.approx(5, abs=0.006)}
    for retract in ("Z5.\nG40 ", "G40 Z5.\n"):
        assert depths(tables_of(program.format(retract), "fanuc", "1:radius=5"), "sweep_depth") == {}


def test_a_loop_that_is_overcut_anyway_has_no_swept_corner() -> None:
    """The groove, with a start-up past the end of its other wall."""
    program = GROOVE.replace("G1 C3. F500\nG41 X60. F200", "G1 C-30. F500\nG41 X60. C3. F200")
    tables = tables_of(program, "fanuc", "1:radius=4")
    assert set(depths(tables)) == {6, 12}
    assert 4 in tables["overcuts"].sweeps.row
    assert depths(tables, "sweep_depth") == {}
    wide = program.replace("C3.", "C5.").replace("C-3.\n", "C-5.\n")
    assert set(depths(tables_of(wide, "fanuc", "1:radius=4"), "sweep_depth")) == {5}


# ---- radii that adjust a path of the tool center ----

FLATS = """O1
G20 G40 G97 G98 G18
T0808
G0 X2.15 Z.1 C0
G12.1
G1 C.5339 F60.
G1 G41 X1.75 F7.
Z-.88
G1 C-.5339
G2 X-1.75 R1.025 F60.
G1 C.5339 F7.
G1 G40 X-2.15 F60.
G13.1
G0 X2.5
M30
"""
#: A square from the middle of its side and back, with the end over the beginning.
SQUARE = (
    "O1\nG21 G40 G97 G98 G18\nT0808\nG0 X90. Z2. C0\nG12.1\nG1 G42 X50. F200\nC25.\nX-50.\nC-25.\nX50.\nC25.\n"
    "X-50.\nG40 C50.\nG13.1\nG0 X100.\nM30\n"
)


@pytest.mark.ci
@looped("radius", ["-.005", ".005", "0", "-.01", ".01", "-.0002", ".0002", "-.001"], one_in=12)
@looped("machine", ["fanuc", "haas-lathe", "gsk-988"])
def test_an_adjusted_path_of_the_center_has_no_walls(radius: str, machine: str) -> None:
    """The guide's own sample, an inch program; and a contour in mm, with as many mm and with inches."""
    groups = ("compensation", "feed", "motion")
    assert said(report_of(FLATS, machine, f"8:radius={radius}", only=groups)) == []
    assert said(report_of(SQUARE, machine, f"8:radius={radius}", only=groups)) == []
    in_mm = f"8:radius={float(radius) * 25.4:.4f}"
    assert said(report_of(SQUARE, machine, in_mm, only=groups)) == []


@pytest.mark.ci
def test_a_cutter_on_the_wrong_side_is_one_all_the_same() -> None:
    """A negative R exchanges the sides: a cutter of that size goes through the part."""
    assert (12, "start-up-sweeps-contour") in said(report_of(FLATS, "fanuc", "8:radius=-.15"))
    assert said(report_of(FLATS, "fanuc", "8:radius=.15", only=["compensation"])) == []
