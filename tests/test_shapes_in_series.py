"""Shapes that several sections cut at equal steps of C are one line of the part."""

import pytest
from programs import tables_of

from polarcheck.foundation.finding import MadeShape
from polarcheck.reports.made_parts.part_report import made_by
from polarcheck.reports.made_parts.shapes_in_series import in_series

pytestmark = [pytest.mark.usefixtures("own_folder"), pytest.mark.ci]


def told(angles: list[float], ends: list[float] | None = None) -> list[MadeShape]:
    sections = [
        f"G0 X60. Z5. C{angle:g}\nG12.1\nG1 G98 X50. C0 F500\nZ-4. F100\nX{end:g}. F150\nX50.\nZ5. F500\nG13.1\n"
        for angle, end in zip(angles, ends or [24.0] * len(angles), strict=True)
    ]
    return [*in_series(made_by(tables_of(f"T0808\n{''.join(sections)}M30\n", "fanuc", "8:radius=3")))]


@pytest.mark.parametrize(
    ("count", "step", "first"), [(6, 60, 0), (4, 90, 15), (3, 120, 300), (5, 72, 7), (6, -60, 0), (4, 30, 10)]
)
def test_slots_at_equal_steps_are_one(count: int, step: int, first: int) -> None:
    (shape,) = told([first + number * step for number in range(count)])
    assert shape.text.startswith(f"{count} slots, {abs(step)} deg apart, the first: pocket: slot 6.000 x 19.000")


@pytest.mark.parametrize("angles", [[0, 60], [0, 60, 130], [0, 100, 210]])
def test_other_slots_are_told_one_by_one(angles: list[float]) -> None:
    assert len(told(angles)) == len(angles)


def test_a_longer_slot_is_told_alone() -> None:
    assert [shape.text.partition(",")[0] for shape in told([0, 60, 120, 180], [24.0, 24.0, 24.0, 20.0])] == [
        "3 slots",
        "pocket: slot 6.000 x 21.000",
    ]
