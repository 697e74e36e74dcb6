"""The largest R for a loop that is cut into: between parallel walls half of what lies between them."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import tables_of

from polarcheck.columns.contour import fitting_radius
from polarcheck.columns.contour.fitting_radius import Fitting

HEAD, END = "T0101\nG98 G0 X100. C0\n", "M30\n"


def groove(width: float, between: str = "") -> str:
    """A section of 13 blocks: a square of 40, gone round on the outside, with a groove through its middle."""
    half = width / 2
    return (
        f"G12.1\nG1 C{half:.4f} F500\nG41 X60. F200\nX30.\n{between}C20.\nX-20.\nC-20.\nX30.\nC{-half:.4f}\nX60.\n"
        "G40 X100.\nC0\nG13.1\n"
    )


#: The loop of a groove that stands first: from its G41 to its end.
ROWS = slice(4, None)
#: A neck that leads through the part to the other side of its own wall.
THROUGH = "G12.1\nG1 C0 F500\nG42 X40. F200\nC20.\nX-40.\nC-20.\nX40.\nC0\nX0\nX40.\nC.1\nG40 X100.\nG13.1\n"


def fitting_of(sections: str, radius: float = 4.0) -> Fitting:
    found: Fitting = tables_of(HEAD + sections + END, "fanuc", f"1:radius={radius}")["fitting"]
    return found


@looped(
    ("radius", "width"),
    [(3.05, 6), (3.4, 6), (4, 6), (5, 6), (9, 6), (1.55, 3), (5, 3), (9, 3), (0.4, 0.7), (4, 0.7)],
    one_in=12,
)
def test_half_of_a_groove_is_room_for_the_cutter(radius: float, width: float) -> None:
    found = fitting_of(groove(width), radius)
    assert found.radius[ROWS] == pytest.approx(width / 2, rel=0.02)
    assert found.radius[ROWS].max() <= width / 2 + 0.005
    assert np.isnan(found.radius[:4]).all()
    assert not found.never.any()


@pytest.mark.ci
def test_only_loops_that_are_cut_into_are_asked_for() -> None:
    """Of three grooves of 6, 10 and 3 mm the middle one has room for R 4."""
    found = fitting_of(groove(6) + groove(10) + groove(3))
    # A loop ends where the next G41 begins.
    assert found.radius[4:17] == pytest.approx(3, rel=0.02)
    assert np.isnan(found.radius[17:30]).all()
    assert found.radius[30:] == pytest.approx(1.5, rel=0.02)


def test_no_cutter_fits_a_contour_through_its_own_part() -> None:
    found = fitting_of(groove(6) + THROUGH)
    assert not found.never[:15].any()
    assert found.radius[4:17] == pytest.approx(3, rel=0.02)
    assert found.never[17:27].all()
    assert np.isnan(found.radius[17:]).all()


def test_alone_it_is_the_same() -> None:
    found = fitting_of(THROUGH)
    assert found.never[4:14].all()
    assert not found.never[:4].any()
    assert np.isnan(found.radius).all()


@pytest.mark.parametrize("between", ["G3 X40. C15. I0 J0\nG1 X30. C15.\n"])
def test_no_other_r_mends_what_the_control_objects_to(between: str) -> None:
    """An arc round its own start, in a groove that is too narrow."""
    found = fitting_of(groove(6, "C10.\n" + between))
    assert not found.never.any()
    assert np.isnan(found.radius).all()


@pytest.mark.parametrize("sections", ["", groove(10), groove(6).replace("G41 ", "")])
def test_without_a_cut_nothing_is_tried(sections: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(fitting_radius, "Trial", None)
    found = fitting_of(sections)
    assert not found.never.any()
    assert np.isnan(found.radius).all()


def test_a_file_without_a_row_has_no_loop() -> None:
    found: Fitting = tables_of("", "fanuc", "1:radius=4")["fitting"]
    assert len(found.never) == len(found.radius) == 0


@pytest.mark.ci
def test_so_many_rows_are_not_tried(monkeypatch: pytest.MonkeyPatch) -> None:
    rows = int(np.count_nonzero(~np.isnan(fitting_of(groove(6)).radius)))
    for most, is_tried in ((rows, True), (rows - 1, False)):
        monkeypatch.setattr(fitting_radius, "_MANY", most)
        assert bool(np.isnan(fitting_of(groove(6)).radius).all()) != is_tried
