"""The page of pictures in a browser: nothing goes wrong or out, choosing shows the same everywhere, and it prints."""

from __future__ import annotations

import json
import math
import re
import shutil
from collections.abc import Callable, Iterator
from importlib import resources
from pathlib import Path
from typing import Any

import msgspec
import pytest
from pictures_by_hand import finding, hexagon, notch, picture

from polarcheck.view.packing import packed
from polarcheck.view.page import page

playwright = pytest.importorskip("playwright.sync_api")
plotly = pytest.importorskip("plotly.offline")
CHROMIUM = shutil.which("chromium")
ARGUMENTS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
#: One browser is enough for all of them.
pytestmark = [
    pytest.mark.ci,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
    pytest.mark.xdist_group("browser"),
]
HOSTILE = "(<script>alert(1)</script> <a href='javascript:alert(1)'>\"b\"</a> \x1b[31m)"


def until(page: Any, holds: Callable[[], bool]) -> None:
    """Wait for something that a page does by itself, however slow the machine is."""
    for _ in range(1200):
        if holds():
            return
        page.wait_for_timeout(50)
    assert holds()


def frames(page: Any) -> None:
    """Wait until the page has drawn what it was about to draw."""
    page.evaluate("() => new Promise((drawn) => requestAnimationFrame(() => requestAnimationFrame(drawn)))")


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield opened
        opened.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A page with a hexagon that is cut into, findings at its second and fourth block, and comments to beware of."""
    blocks = [f"N{number} G1 {HOSTILE}" for number in range(1, 7)]
    found = [finding("too fast", line=2, block=blocks[1]), finding("too deep", line=4, block=blocks[3])]
    whole = picture(hexagon(blocks=blocks, marks=[notch()]), findings=found)
    folder = tmp_path_factory.mktemp("page")
    (folder / "plotly.min.js").write_text(plotly.get_plotlyjs(), "utf-8")
    (folder / "beside.html").write_text(page([whole], script_path="plotly.min.js"), "utf-8")
    (folder / "page.html").write_text(page([whole], library=plotly.get_plotlyjs()), "utf-8")
    return (folder / "page.html").as_uri()


class Opened:
    """A page, what it complained of and what it asked for."""

    def __init__(self, browser: Any, address: str, **more: Any) -> None:
        self.page = browser.new_page(viewport={"width": 1280, "height": 1500}, **more)
        self.said: list[str] = []
        self.asked: list[str] = []
        self.page.on("console", lambda message: self.said.append(message.text))
        self.page.on("pageerror", lambda error: self.said.append(str(error)))
        self.page.on("request", lambda request: self.asked.append(request.url))
        self.page.goto(address)

    def fact(self, label: str, box: str = ".chosen") -> str:
        """What the chosen move, or the one that is pointed at, is told to be."""
        found: str = self.page.locator(f"{box} dt:text-is('{label}') + dd").inner_text()
        return found

    def click_as_told(self, place: tuple[float, float], line: str) -> None:
        """A click where the pointer is told to be at a line; what is told comes some time after the pointer."""
        self.page.mouse.move(*place)
        self.page.locator(f"#hover dt:text-is('line') + dd:has-text('{line}')").wait_for()
        self.page.mouse.click(*place)

    def at(self, x: float, c: float) -> tuple[float, float]:
        """Where a point of the plane [mm, radius] is on the screen."""
        where: list[float] = self.page.evaluate(
            "([x, c]) => { const p = document.querySelector('.face'), l = p._fullLayout, b = p.getBoundingClientRect();"
            " return [b.x + l.xaxis._offset + l.xaxis.l2p(2 * x), b.y + l.yaxis._offset + l.yaxis.l2p(c)]; }",
            [x, c],
        )
        return where[0], where[1]

    def in_time(self, share: float) -> tuple[float, float]:
        """A point of the curves at a share of the time of the section."""
        where: list[float] = self.page.evaluate(
            "(share) => { const p = document.querySelector('.rates'), l = p._fullLayout, b = p.getBoundingClientRect();"
            " const end = Math.max(...p.data[0].x);"
            " return [b.x + l.xaxis._offset + l.xaxis.l2p(share * end), b.y + l.yaxis._offset + 20]; }",
            share,
        )
        return where[0], where[1]


@pytest.fixture
def opened(browser: Any, address: str) -> Iterator[Opened]:
    found = Opened(browser, address)
    found.page.wait_for_selector(".rates .main-svg")
    yield found
    assert found.said == []
    assert found.asked == [address]
    found.page.close()


def test_choosing_shows_the_same_move_everywhere(opened: Opened) -> None:
    page = opened.page
    # The middle of the flat at 60 deg.
    opened.click_as_told(opened.at(9.5, 16.454), "1,")
    assert opened.fact("line").startswith("1,")
    assert opened.fact("line", "#hover").startswith("1,")
    opened.click_as_told(opened.in_time(0.58), "4,")
    assert opened.fact("line").startswith("4,")
    assert opened.fact("finding") == "2"
    assert "too deep" in page.locator(".list li.is-chosen").inner_text()
    assert page.locator("tr.is-chosen[data-finding]").get_attribute("data-finding") == "1"
    page.click("tr[data-finding='0']")
    assert opened.fact("line").startswith("2,")
    assert page.locator(".moves tr.is-chosen").get_attribute("data-move") == "1"
    page.click(".moves tr[data-move='4']")
    assert opened.fact("line").startswith("5,")
    circle = page.evaluate("document.querySelector('.face').layout.shapes.find((shape) => shape.type === 'circle')")
    end = hexagon().moves.end[4]
    assert [circle["x0"], circle["x1"]] == pytest.approx([2 * (float(end[0] or 0) + side) for side in (-4.0, 4.0)])


@pytest.mark.nightly
def test_keys_step_through_moves_and_findings(opened: Opened) -> None:
    lines = []
    keys = ["ArrowRight", "ArrowRight", "ArrowLeft", "End", "Home", "ArrowDown", "ArrowDown", "ArrowUp"]
    for key in keys:
        opened.page.keyboard.press(key)
        lines.append(opened.fact("line").partition(",")[0])
    assert lines == ["1", "2", "1", "6", "1", "2", "4", "2"]
    opened.page.keyboard.press("Escape")
    assert opened.page.locator(".is-chosen").count() == 0


def test_text_of_a_program_is_shown_as_text(opened: Opened) -> None:
    opened.page.keyboard.press("ArrowRight")
    expected = HOSTILE.replace("\x1b", "\\x1b")
    assert opened.fact("block") == f"N1 G1 {expected}"
    assert opened.page.locator(".moves tr[data-move='0'] td").nth(1).inner_text() == f"N1 G1 {expected}"
    assert expected in opened.page.locator("tr[data-finding='0'] code").inner_text()
    assert opened.page.locator("a[href^=javascript]").count() == 0


def test_colors_scales_and_hatching(opened: Opened) -> None:
    page = opened.page
    for name in ("feed", "none", "load"):
        page.select_option(".coloring", name)
    sizes = page.evaluate(
        "(() => { const l = document.querySelector('.face')._fullLayout;"
        " return [l.xaxis.l2p(2) - l.xaxis.l2p(0), l.yaxis.l2p(0) - l.yaxis.l2p(1)]; })()"
    )
    assert sizes[0] == pytest.approx(sizes[1], rel=0.01)
    assert page.locator(".face pattern").count() >= 1
    assert "diameter" in page.locator(".face .xtitle").text_content()
    buttons = page.eval_on_selector_all(".face .modebar-btn", "all => all.map((one) => one.getAttribute('data-title'))")
    assert not [title for title in buttons if re.search("cloud|share|edit|link", title or "", re.IGNORECASE)], buttons


@pytest.mark.nightly
@pytest.mark.parametrize("size", ["A4", "Letter"])
def test_it_prints(browser: Any, address: str, size: str, tmp_path: Path) -> None:
    found = Opened(browser, address)
    found.page.wait_for_selector(".rates .main-svg")
    printed = found.page.pdf(path=tmp_path / "page.pdf", format=size)
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) == 1
    found.page.emulate_media(media="print")
    assert [found.page.locator(name).first.is_visible() for name in (".findings", ".bar", ".aside")] == [
        True,
        False,
        False,
    ]
    assert found.said == []
    found.page.close()


def test_the_library_may_lie_beside_the_page(browser: Any, address: str) -> None:
    found = Opened(browser, address.replace("page.html", "beside.html"))
    found.page.wait_for_selector(".rates .main-svg")
    assert [name.rpartition("/")[2] for name in found.asked] == ["beside.html", "plotly.min.js"]
    assert found.said == []
    found.page.close()


def test_without_scripts_findings_are_read(browser: Any, address: str) -> None:
    context = browser.new_context(java_script_enabled=False)
    found = context.new_page()
    found.goto(address)
    assert found.locator("tr[data-finding]").all_inner_texts()[0].split()[:5] == ["1", "2", "error", "too", "fast"]
    assert found.locator("noscript p").is_visible()
    assert not found.locator(".drawings").is_visible()
    context.close()


#: Columns of every kind that a page packs, and values that it leaves as they are.
COLUMNS: dict[str, Any] = {
    "lengths": [round(0.1 * number**1.5 - 7, 4) for number in range(50)],
    "rates": [math.pi * number for number in range(50)],
    "nulls": [None, *range(40), None, None, 0.25],
    "nothing": [None] * 40,
    "large": [2.0**60, *range(40)],
    "points": [[number / 8, None if number % 7 else -number] for number in range(40)],
    "centers": [None, *([number, 0.5] for number in range(40))],
    "rings": [[[[0.5, number], [1.0, -1.0]]] for number in range(40)],
    "flags": [True, False] * 20,
    "texts": ["7", "8"] * 20,
    "empty": [[] for _ in range(40)],
}


def test_packed_columns_come_out_as_they_went_in(opened: Opened) -> None:
    script = resources.files("polarcheck.view").joinpath("browser", "data.js").read_text("utf-8")
    unpack = f"(text) => {{ {script} return JSON.stringify(unpacked(JSON.parse(text))); }}"
    told = opened.page.evaluate(unpack, json.dumps(packed(COLUMNS)))
    assert json.loads(told, parse_int=float) == COLUMNS
    left = [name for name, column in packed(COLUMNS).items() if column == COLUMNS[name]]
    assert left == ["rates", "large", "centers", "rings", "flags", "texts", "empty"]


@pytest.mark.nightly
def test_a_long_program_is_drawn_from_packed_data(browser: Any, address: str, tmp_path: Path) -> None:
    source = [f"N{number} G1 X{number}." for number in range(1, 20_001)]
    long = msgspec.structs.replace(picture(hexagon()), source=source, source_lines=len(source))
    text = page([long], library=plotly.get_plotlyjs())
    assert '<script type="text/plain" id="data">' in text
    assert len(text) < len(page([picture(hexagon())], library=plotly.get_plotlyjs())) + sum(map(len, source)) / 2
    (tmp_path / "long.html").write_text(text, "utf-8")
    found = Opened(browser, (tmp_path / "long.html").as_uri())
    found.page.wait_for_selector(".rates .main-svg")
    assert found.said == []
    assert found.asked == [(tmp_path / "long.html").as_uri()]
    found.page.close()
