"""What `polarcheck part` must see: contours that run on past their start, Z not known, ends beside starts."""

from __future__ import annotations

import cmath
import math

import pytest
from drawn_contours import CONTROLS
from overlapped_contours import Overlapped, contour, overlapped
from programs import tables_of

from polarcheck.finding import MadeShape
from polarcheck.parts.part_report import made_by

#: Of what is told of a contour, the share of the length of its walls by which its area may be off: points are rounded,
#: and sides that are straight but for that are one [mm].
ROUNDED = 0.005

BY_MACHINE = {"inch" if control.unit > 1 else control.machine: control for control in CONTROLS}
QUADRILATERAL = [complex(18, 3), complex(2, 16), complex(-17, 5), complex(-3, -14)]


def made(text: str, *tools: str, machine: str = "fanuc", stock: float = 0) -> list[MadeShape]:
    job = {"stock": {"diameter": stock}} if stock else {}
    return made_by(tables_of(text, machine, *tools, job=job))


# ---- contours that run on past their start ----


def is_seen(shape: Overlapped) -> bool:
    """One closed shape is told, and its area and that of the finished part are those of the contour."""
    drawn = shape.drawn
    tables = tables_of(drawn.text(), drawn.machine, *drawn.tools)
    levels, shapes = tables["finished"].levels, made_by(tables)
    if len(levels) != 1 or levels[0].open or len(shapes) != 1:
        return False
    is_pocket, slack = drawn.side == "G41", ROUNDED * shape.around
    areas = [shapes[0].values.get("area", shape.area)]
    areas += [] if is_pocket else [levels[0].polygon.area]
    return shapes[0].inside == is_pocket and all(abs(area - shape.area) <= slack for area in areas)


@pytest.mark.parametrize("turned", [0.0, 33.0])
@pytest.mark.parametrize("control", BY_MACHINE)
def test_a_quadrilateral_with_corners_of_chords_that_ends_past_its_start(control: str, turned: float) -> None:
    corners = [cmath.rect(abs(point), cmath.phase(point) + math.radians(turned)) for point in QUADRILATERAL]
    shape = overlapped(corners, 1.5, 16, 0.34, control=BY_MACHINE[control])
    (seen,) = made(shape.drawn.text(), *shape.drawn.tools, machine=shape.drawn.machine)
    assert is_seen(shape), seen.text
    assert "open" not in seen.text


def test_closed_contours_that_end_past_their_start() -> None:
    assert [seed for seed in range(40) if not is_seen(contour(seed))] == []


@pytest.mark.slow
def test_many_closed_contours_that_end_past_their_start() -> None:
    assert [seed for seed in range(40, 1000) if not is_seen(contour(seed))] == []


def test_two_contours_of_one_level_that_end_past_their_start() -> None:
    """A boss and the pocket in it: the one closes by itself, the other by joining its end to its first wall."""
    boss = overlapped(QUADRILATERAL, 1.5, 16, 0.5).drawn.blocks()
    square = [complex(4, 0), complex(0, 4), complex(-4, 0), complex(0, -4)]
    pocket = overlapped(square, 1, 0, 0.5, is_pocket=True, overlap=0).drawn.blocks()
    begin, end = pocket.index("G12.1") + 1, pocket.index("G13.1")
    at = boss.index("G13.1")
    text = "\n".join([*boss[:at], *pocket[begin:end], *boss[at:]])
    shapes = made(text, "1:radius=0.5")
    assert sorted((shape.shape, shape.inside) for shape in shapes) == [("contour", False), ("square", True)]
