"""The workbench of a page: the fault is seen first, on each screen, in light and dark, and by screen readers."""

from __future__ import annotations

import itertools
import math
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
from pictures_by_hand import finding, hexagon, notch, picture
from test_page_in_browser import CHROMIUM, browser

from polarcheck.view.page import page

plotly = pytest.importorskip("plotly.offline")
pytest.importorskip("axe_playwright_python")
pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
    pytest.mark.xdist_group("browser"),
]
__all__ = ["browser"]
#: The edges of elements on the screen: left, right, top, bottom.
_EDGES = """all => all.map((one) => {
    const box = one.getBoundingClientRect();
    return [box.left, box.right, box.top, box.bottom];
})"""
#: The violations that axe-core reports, each with its elements.
_VIOLATIONS = """axe.run(document).then(({ violations }) =>
    violations.map(({ id, nodes }) => `${id}: ${nodes.map((node) => node.html.slice(0, 120))}`))"""
LONG = (
    "C axis would turn at 17189 deg/min with F600, the lathe allows 10800; nearest distance 2 mm; highest F here: 376"
)
#: Where the findings of the page are: the first two at one place, the third beside the hexagon.
PLACES = [(19.0, 0.0), (19.0, 0.002), (0.0, 21.9), (-19.0, 0.0)]


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Ten errors and a warning that is listed last though it is the first; the first error stands for other lines."""
    found = [finding("slow", line=1, severity="warning", places=[PLACES[3]], span=0.05)]
    found += [finding("a reversal", line=2, places=[PLACES[0]], span=0.05, also=[3, 5, *range(100, 170)])]
    found += [finding(LONG, line=2 + number % 4, places=[PLACES[1 + number % 2]]) for number in range(8)]
    found += [finding("behind the section", line=90, move=5, is_beside=True, places=[PLACES[2]])]
    source = [f"N{number} G1" for number in range(1, 200)]
    whole = picture(
        hexagon(marks=[notch()]),
        findings=found,
        source=source,
        source_lines=len(source),
        not_evaluated=["no limit of X"],
    )
    path = tmp_path_factory.mktemp("workbench") / "page.html"
    path.write_text(page([whole], library=plotly.get_plotlyjs()), "utf-8")
    return path.as_uri()


class Screen:
    """A page at a size and in a color scheme, and what it complained of."""

    def __init__(
        self,
        browser: Any,
        address: str,
        size: tuple[int, int] = (1280, 720),
        scheme: str = "light",
        drawn: str = ".face .main-svg",
    ) -> None:
        self.page = browser.new_page(viewport={"width": size[0], "height": size[1]}, color_scheme=scheme)
        self.complaints: list[str] = []
        self.page.on("console", lambda message: self.complaints.append(message.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.goto(address)
        self.page.wait_for_selector(drawn)

    def box(self, selector: str) -> dict[str, float]:
        found: dict[str, float] = self.page.locator(selector).first.bounding_box()
        return found

    def window(self) -> list[float]:
        """The window of the face: left, right, bottom and top in the units of its axes."""
        found: list[float] = self.page.evaluate(
            "(({ xaxis, yaxis }) => [...xaxis.range, ...yaxis.range])(document.querySelector('.face')._fullLayout)"
        )
        return found

    def violations(self) -> list[str]:
        """The findings of axe-core, with the elements."""
        self.page.evaluate(resources.files("axe_playwright_python").joinpath("axe.min.js").read_text("utf-8"))
        found: list[str] = self.page.evaluate(_VIOLATIONS)
        return found


@pytest.mark.parametrize("size", [(1400, 900), (1280, 720), (390, 844)], ids=str)
def test_the_first_screen_shows_head_fault_and_face(browser: Any, address: str, size: tuple[int, int]) -> None:
    screen = Screen(browser, address, size)
    for selector in ("h1", ".verdict", ".list li:first-child > button", ".face .nsewdrag"):
        box = screen.box(selector)
        assert box["y"] >= 0
        assert box["y"] + box["height"] <= size[1], selector
    assert screen.box(".face .nsewdrag")["height"] > 200
    assert screen.page.evaluate("document.documentElement.scrollWidth") <= size[0]
    # No label of the drawing is cut, and no two of an axis are one over the other.
    face = screen.box(".face")
    for axis in ("xtick", "ytick"):
        labels = screen.page.eval_on_selector_all(
            f".face .{axis} text",
            _EDGES,
        )
        assert len(labels) > 2
        for left, right, top, bottom in labels:
            assert face["x"] <= left
            assert right <= face["x"] + face["width"]
            assert bottom <= face["y"] + face["height"]
            assert top >= face["y"]
        pairs = itertools.pairwise(labels)
        assert all(
            one[1] < other[0] or one[0] > other[1] or one[3] < other[2] or one[2] > other[3] for one, other in pairs
        )
    assert screen.complaints == []
    screen.page.close()


def test_findings_are_pins_a_list_and_colored_rows(browser: Any, address: str) -> None:
    screen = Screen(browser, address)
    page = screen.page
    # Errors first: the warning of line 1 is number 11.
    assert page.locator(".list li > button").first.inner_text().split()[:3] == ["1", "line", "2"]
    assert page.locator(".list li > button").last.inner_text().split()[:3] == ["11", "line", "1"]
    pins = {pin.inner_text(): pin for pin in page.locator(".pin").all()}
    assert {*pins} == {"1, 2, 4, 6 +1", "3, 5, 7 +2", "11"}
    boxes = [pin.bounding_box() for pin in pins.values()]
    for place, one in enumerate(boxes):
        for other in boxes[place + 1 :]:
            assert math.dist((one["x"], one["y"]), (other["x"], other["y"])) > 20
    page.click(".list li > button")
    assert page.locator(".list li.is-chosen .unfolded").inner_text().count("\n") > 2
    left, right, bottom, top = screen.window()
    # Its own scale: a window of 0.05 mm, X as a diameter, around its place.
    assert top - bottom == pytest.approx(0.05, rel=0.02) or (right - left) / 2 == pytest.approx(0.05, rel=0.02)
    assert left < 38.0 < right
    assert bottom < 0.0 < top
    # From near by the two at one place have a pin each.
    assert page.locator(".pin").first.inner_text().startswith("1")
    lines = page.locator(".list li.is-chosen .unfolded button")
    assert lines.all_inner_texts()[:3] == ["3", "5", "100"]
    assert lines.last.inner_text() == "and 12 more"
    lines.last.click()
    assert lines.count() == 72
    lines.nth(1).click()
    assert page.locator(".chosen dt:text-is('line') + dd").inner_text().startswith("5")
    page.click(".windows button:text-is('Back')")
    assert screen.window()[1] - screen.window()[0] > 50
    page.click(".pin >> nth=-1")
    assert page.locator(".list li.is-chosen .badge").inner_text() == "11"
    page.click(".text-switch button:text-is('Moves')")
    colors = page.eval_on_selector_all(
        ".moves tr[data-move]", "all => all.map((row) => row.className.split(' ').at(-1))"
    )
    assert colors[1:5] == ["error"] * 4
    # A finding beside the path is at its place, and no move is chosen for it.
    page.locator(".list li > button", has_text="behind the section").click()
    assert page.locator(".chosen dt:text-is('line') + dd").inner_text() == "90"
    assert screen.complaints == []
    page.close()


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_is_read_by_all(browser: Any, address: str, scheme: str) -> None:
    screen = Screen(browser, address, scheme=scheme)
    page = screen.page
    assert screen.violations() == []
    page.click(".list li > button")
    page.click(".view-switch button:text-is('Both')")
    page.click(".text-switch button:text-is('Moves')")
    assert screen.violations() == []
    paper = "document.querySelector('.face')._fullLayout.paper_bgcolor"
    first = page.evaluate(paper)
    page.click(".theme")
    page.click(".theme")
    # From the scheme of the system to light, then to dark.
    assert page.locator(".theme").inner_text() == "Theme: dark"
    dark = page.evaluate(paper)
    assert (first == dark) == (scheme == "dark")
    assert page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(22, 24, 28)"
    assert screen.complaints == []
    page.close()


def test_one_page_of_a4_has_the_picture(browser: Any, address: str, tmp_path: Path) -> None:
    screen = Screen(browser, address, scheme="dark")
    screen.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    screen.page.emulate_media(media="print")
    face, rates = screen.box(".face"), screen.box(".rates")
    # 297 mm less margins are 1031 px; head, face and rates stand above that.
    assert screen.box("header")["y"] < face["y"] < rates["y"]
    assert rates["y"] + rates["height"] < 1031
    assert screen.page.evaluate("document.querySelector('.face')._fullLayout.paper_bgcolor") == "#fff"
    assert screen.page.evaluate("getComputedStyle(document.body).backgroundColor") == "rgb(255, 255, 255)"
    assert screen.page.locator(".pin").first.is_visible()
    screen.page.emulate_media(media="screen")
    screen.page.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert screen.page.evaluate("document.querySelector('.face')._fullLayout.paper_bgcolor") == "#16181c"
    assert screen.complaints == []
    screen.page.close()


def test_a_program_that_is_not_drawn_has_its_findings_beside_its_source(browser: Any, tmp_path: Path) -> None:
    found = [finding("C too fast", line=line, section=None, move=None, is_beside=True) for line in range(1, 13)]
    reason = ("not drawn", "the check of this file takes too long")
    whole = picture(findings=found, source=[f"N{line}" for line in range(1, 40)], source_lines=39, head=[reason])
    path = tmp_path / "plain.html"
    path.write_text(page([whole]), "utf-8")
    screen = Screen(browser, path.as_uri(), drawn=".list li")
    screen.page.locator(".list li > button").nth(2).click()
    assert screen.page.locator(".lines .is-chosen").inner_text().split() == ["3", "E", "N3"]
    assert screen.page.locator(".missing").inner_text() == reason[1]
    assert screen.box(".lines")["x"] > screen.box(".list")["x"] + screen.box(".list")["width"]
    assert screen.violations() == []
    assert screen.complaints == []
    screen.page.close()


def test_many_sections_and_findings_stay_tidy(browser: Any, tmp_path: Path) -> None:
    sections = [hexagon(title=f"lines {number * 6 + 1} to {number * 6 + 6}, offset 1") for number in range(60)]
    angles = [number * 0.1 for number in range(500)]
    found = [
        finding(
            "too fast",
            section=number % 60,
            move=number % 6,
            line=number % 6 + 1,
            places=[(19 * math.cos(angle), 19 * math.sin(angle))],
        )
        for number, angle in enumerate(angles)
    ]
    empty = picture(path="<b>empty</b>.nc")
    path = tmp_path / "many.html"
    path.write_text(page([picture(*sections, findings=found), empty], library=plotly.get_plotlyjs()), "utf-8")
    screen = Screen(browser, path.as_uri())
    page_ = screen.page
    assert page_.locator(".face .main-svg").count() <= 4
    assert page_.locator("#p0 .tabs option").count() == 60
    assert page_.locator("#p0 .list li").count() == 500
    page_.select_option("#p0 .tabs select", "59")
    assert page_.locator(".polar:visible h2").text_content() == "lines 355 to 360, offset 1"
    page_.locator("#p0 .list li > button").nth(61).click()
    assert page_.locator("#p0 .tabs select").input_value() == "1"
    assert not page_.locator("#p1 .stage").is_visible()
    assert page_.locator("#p1 .list").inner_text() == "No findings"
    assert screen.complaints == []
    page_.close()
