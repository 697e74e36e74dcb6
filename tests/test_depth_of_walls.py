"""How deep a contour is cut whose Z changes along it: the deepest Z of the whole wall, and both ends of a slope."""

from __future__ import annotations

import math

import pytest
from cases import looped
from hexagon_program import CONTROLS, CUTTER, hexagon
from programs import tables_of

from polarcheck.reports.made_parts.part_report import in_one_line

CONTOUR = "X36. C0 F150/C10.392/X0 C20.785/X-36. C10.392/C-10.392/X0 C-20.785/X36. C-10.392/C0"
POCKET = ("G1 X56. F1000/Z-4. F200/G42 " + CONTOUR + "/G40 X56.", "G1 X0 C0 F1000/Z0 F200/G41 X30. F150{}/G40 G1 X0")
TURN = "/G3 I-15. Z{:.3f}"
HALVES = "/G3 X-30. R15. Z{:.3f}/G3 X30. R15. Z{:.3f}"


def helix(turns: int, pitch: float, *, closes: bool) -> str:
    return "".join(TURN.format(-pitch * turn) for turn in range(1, turns + 1)) + "/G3 I-15." * closes


@pytest.mark.ci
@looped("control", CONTROLS)
def test_a_helix_cuts_down_to_its_last_turn(control: str) -> None:
    for turns, pitch in ((2, 2.5), (10, 1.5), (1, 3.0)):
        for closes in (False, True):
            text = POCKET[1].format(helix(turns, pitch, closes=closes))
            line = in_one_line(tables_of(hexagon((POCKET[0], text)), control, CUTTER))
            end, whole = -pitch * turns, -pitch * (turns if closes else turns - 1)
            slope = "" if closes else f", the floor slopes to Z{end:.3f}"
            assert line == f"pocket: circle 30.000, to Z{whole + 0.0:.3f}{slope}"


def test_a_helix_of_halves_is_the_same() -> None:
    halves = "".join(HALVES.format(-turn - 0.5, -turn - 1.0) for turn in range(3))
    line = in_one_line(tables_of(hexagon((POCKET[0], POCKET[1].format(halves))), CONTROLS[0], CUTTER))
    # The first half of the last turn begins at Z-2, where the second one of the turn before has ended.
    assert line == "pocket: circle 30.000, to Z-2.000, the floor slopes to Z-3.000"
    closed = halves + "/G3 X-30. R15./G3 X30. R15."
    line = in_one_line(tables_of(hexagon((POCKET[0], POCKET[1].format(closed))), CONTROLS[0], CUTTER))
    assert line == "pocket: circle 30.000, to Z-3.000"


@looped("control", CONTROLS)
def test_a_floor_that_slopes_has_two_ends(control: str) -> None:
    sloped = CONTOUR.replace("C20.785", "C20.785 Z-4.5").replace("X0 C-20.785", "X0 C-20.785 Z-5.")
    line = in_one_line(tables_of(hexagon((CONTOUR, sloped)), control, CUTTER))
    assert line == "hexagon, 36.000 across flats, to Z-4.000, the floor slopes to Z-5.000"
    assert math.isclose(tables_of(hexagon(), control, CUTTER)["finished"].levels[0].bottom, -4.0)
