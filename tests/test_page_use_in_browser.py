"""The page at hand in a browser: zoom, measuring, copying, the source, links, keys, sections side by side."""

from __future__ import annotations

from collections.abc import Iterator
from importlib import resources
from typing import Any

import pytest
from test_page_in_browser import CHROMIUM, browser

playwright = pytest.importorskip("playwright.sync_api")
plotly = pytest.importorskip("plotly.offline")
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
    pytest.mark.xdist_group("browser"),
]
__all__ = ["browser"]

# ---- what is measured, without a page ----

#: A square of 30 across with a corner of R5, a slanted wall, circles of R10 about the center and of R2 beside it.
SHAPES = """
const round = (center, radius) => arcShape(center, radius, 0, 2 * Math.PI, "", "");
const walls = {
  right: lineShape([15, -10], [15, 10], "", ""), left: lineShape([-15, 8], [-15, -8], "", ""),
  slant: lineShape([15, 10], [5, 20], "", ""), nearly: lineShape([-15, 0], [-15.0001, 2], "", ""),
  above: lineShape([15, 5], [15, 9], "", ""), corner: arcShape([10, 10], 5, 0, Math.PI / 2, "", ""),
  bore: round([0, 0], 10), outer: round([0, 0], 12), pin: round([20, 0], 2), inside: round([3, 0], 4),
  zero: pointShape([0, 0], "", ""), point: pointShape([3, 4], "", ""),
};
"""


@pytest.fixture(scope="module")
def blank(browser: Any) -> Iterator[Any]:
    """A page with the scripts that measure alone."""
    opened = browser.new_page()
    folder = resources.files("polarcheck.pictures").joinpath("browser")
    scripts = [folder.joinpath(f"{name}.js").read_text("utf-8") for name in ("shapes", "distances")]
    opened.add_script_tag(content="\n".join([*scripts, SHAPES]))
    yield opened
    opened.close()


@pytest.mark.parametrize(
    ("first", "second", "expected"),
    [
        ("zero", "point", {"distance": 5.0, "angle": 53.1301}),
        ("point", "right", {"to the wall": 12.0}),
        ("right", "point", {"to the wall": 12.0}),
        ("right", "left", {"between the parallel walls": 30.0}),
        ("right", "nearly", {"between the parallel walls": 30.00005}),
        ("right", "slant", {"between the walls": 45.0, "or": 135.0, "they meet at": [15, 10]}),
        ("zero", "slant", {"to the wall": 17.67767}),
        ("zero", "above", {"to the line of the wall, beyond its end": 15.0}),
        ("point", "bore", {"to the arc": 5.0, "to the far side of its circle": 15.0, "to its center": 5.0}),
        ("right", "bore", {"to the arc": 5.0, "to the far side of its circle": 25.0, "to its center": 15.0}),
        ("bore", "outer", {"between the arcs about one center": 2.0}),
        ("bore", "pin", {"between the arcs": 8.0, "between the centers": 20.0, "over both": 32.0}),
        ("bore", "inside", {"between the arcs": 3.0, "between the centers": 3.0, "over both": 20.0}),
        ("inside", "bore", {"between the arcs": 3.0, "between the centers": 3.0, "over both": 20.0}),
        ("corner", None, {"radius": 5.0, "diameter": 10.0, "center": [10, 10], "over": 90.0}),
        ("slant", None, {"length": 14.14214, "angle": 135.0, "from the center": 17.67767, "twice that": 35.35534}),
        ("point", None, {"at": [3, 4], "from the center": 5.0, "angle": 53.1301}),
    ],
)
def test_what_is_measured(blank: Any, first: str, second: str | None, expected: dict[str, Any]) -> None:
    rows = blank.evaluate(f"measured(walls.{first}, {f'walls.{second}' if second else 'null'}).rows")
    found = {label: value for label, _, value in rows if label}
    assert set(found) == set(expected)
    for label, value in expected.items():
        assert found[label] == pytest.approx(value, abs=2e-4), label


def test_arcs_are_read_from_chords_and_polygons_are_not(blank: Any) -> None:
    """A half circle of R20 in 90 chords with its straight side; a hexagon; a circle; a polygon of 40 flats."""
    half, hexagon, circle, polygon = blank.evaluate(
        """() => {
        const around = (count, share) => Array.from({ length: count + 1 }, (_, at) => {
          const angle = (at / count) * share * 2 * Math.PI;
          return [20 * Math.cos(angle) + 3, 20 * Math.sin(angle)].map((value) => Number(value.toFixed(4)));
        });
        const told = ({ kind, radius, center, sweep }) => (kind === "arc" ? [radius, center[0], sweep] : kind);
        return [around(90, 0.5), around(6, 1), around(180, 1), around(40, 1)].map((ring) =>
          shapesOfRing(ring, "", "").map(told));
        }"""
    )
    assert half == [pytest.approx([20, 3, 3.14159], abs=1e-3), "line"]
    assert hexagon == ["line"] * 6
    assert circle == [pytest.approx([20, 3, 6.28319], abs=1e-3)]
    assert polygon == ["line"] * 40
