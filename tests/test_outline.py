"""What bounds a finished part, as the lines and arcs of its program."""

from __future__ import annotations

import numpy as np
import pytest
from programs import tables_of

from polarcheck.columns.metal.finished import Finished, Level

HEAD = "G21 G98 G40 T0808\nG0 X80. C0\nG12.1\nG1 Z-2. F300\n"
END = "\nG40 X80.\nG13.1\n"


def levels(body: str, radius: float = 4.0) -> list[Level]:
    tables = tables_of(HEAD + body + END, "fanuc", *([] if np.isnan(radius) else [f"8:radius={radius}"]))
    finished: Finished = tables["finished"]
    return finished.levels


def test_a_square_that_begins_within_a_side_has_an_element_for_each_block() -> None:
    (level,) = levels("G42 X20. F100\nC10.\nX-20.\nC-10.\nX20.\nC0")
    assert level.polygon.area == pytest.approx(400)
    assert level.outline.closed.tolist() == [True]
    assert level.outline.start.round(6).tolist() == [10, 10 + 10j, -10 + 10j, -10 - 10j, 10 - 10j]
    assert not level.outline.is_arc.any()


def test_arcs_are_one_element_with_their_center_and_the_part_on_the_left() -> None:
    (level,) = levels("G42 X20. F100\nG3 X20. C0 I-10. J0\nG1", 4.0)
    assert len(level.outline) == 1
    assert level.outline.radius[0] == pytest.approx(10)
    assert level.polygon.area == pytest.approx(100 * np.pi, rel=1e-3)


def test_each_depth_of_a_section_is_one_level() -> None:
    passes = "G42 X20. F100\nG3 X20. C0 I-10. J0\nG1 Z-4.\nG3 X20. C0 I-10. J0\nG1"
    assert [level.z for level in levels(passes)] == [-2.0, -4.0]


def test_no_level_without_a_radius() -> None:
    assert not levels("G42 X20. F100\nC10.\nX-20.\nC-10.\nX20.\nC0", np.nan)
