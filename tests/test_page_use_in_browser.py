"""The page at hand in a browser: zoom, measuring, copying, the source, links, keys, sections side by side."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Any

import msgspec
import pytest
from pictures_by_hand import HALF, finding, hexagon, picture
from test_page_in_browser import CHROMIUM, Opened, browser, frames, until

from polarcheck.view.page import page
from polarcheck.view.picture_data import DrawnPart, Picture, Writing

playwright = pytest.importorskip("playwright.sync_api")
plotly = pytest.importorskip("plotly.offline")
pytestmark = [
    pytest.mark.ci,
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
    folder = resources.files("polarcheck.view").joinpath("browser")
    scripts = [folder.joinpath(f"{name}.js").read_text("utf-8") for name in ("positions", "shapes", "distances")]
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


@pytest.mark.parametrize(
    ("point", "words", "section", "writing"),
    [
        ([12.25, -3.2], "X24.5 C-3.2", {}, {}),
        ([12.25, -3.2], "X12.25 Y-3.2", {"diameter": False}, {"virtual": "Y"}),
        ([20, -0.00004], "X40. C2=0.", {}, {"virtual": "C2="}),
        ([12.7, 25.4], "X1. C1.", {"units": "inch", "scale": 25.4}, {}),
        (
            [-0.00254, 2.53873],
            "X-0.0002 A0.1999",
            {"units": "inch", "scale": 25.4},
            {"virtual": "A", "virtual_diameter": True},
        ),
        ([10, 14], "X20. Y4.", {}, {"virtual": "Y", "origin": [0, 10]}),
        ([8, 14], "X10. Y0.", {"diameter": False}, {"virtual": "Y", "origin": [8, 4], "turn": 90}),
        ([8, 14], "X16. Y14.", {}, {"virtual": "Y", "origin": None}),
    ],
    ids=["diameter", "radius", "C2", "inch", "both diameters", "zero", "frame", "zero not known"],
)
def test_a_position_in_the_words_of_the_program(
    blank: Any, point: list[float], words: str, section: dict[str, Any], writing: dict[str, Any]
) -> None:
    plain = {"linear": "X", "virtual": "C", "virtual_diameter": False, "origin": [0, 0], "turn": 0}
    whole = {"units": "mm", "scale": 1, "diameter": True, **section, "writing": {**plain, **writing}}
    assert blank.evaluate("([section, point]) => wordsAt(section, point)", [whole, point]) == words


def test_arcs_are_read_from_chords_and_polygons_are_not(blank: Any) -> None:
    """A half circle of R20 with its side; a hexagon; a circle; a polygon of 40 flats; a slot with tangent ends."""
    half, hexagon, circle, polygon, slot = blank.evaluate(
        """() => {
        const around = (count, share) => Array.from({ length: count + 1 }, (_, at) => {
          const angle = (at / count) * share * 2 * Math.PI;
          return [20 * Math.cos(angle) + 3, 20 * Math.sin(angle)].map((value) => Number(value.toFixed(4)));
        });
        const told = ({ kind, radius, center, sweep }) => (kind === "arc" ? [radius, center[0], sweep] : kind);
        const slot = [...around(90, 0.5), ...around(90, 0.5).map(([x, c]) => [6 - x, -50 - c])];
        return [around(90, 0.5), around(6, 1), around(180, 1), around(40, 1), slot].map((ring) =>
          shapesOfRing(ring, "", "").map(told));
        }"""
    )
    assert half == [pytest.approx([20, 3, 3.14159], abs=1e-3), "line"]
    assert hexagon == ["line"] * 6
    assert circle == [pytest.approx([20, 3, 6.28319], abs=1e-3)]
    assert polygon == ["line"] * 40
    end = pytest.approx([20, 3, 3.14159], abs=1e-3)
    assert sorted(slot, key=str) == [end, end, "line", "line"]


# ---- the page ----

LINES = 20_000


def sections_of_two_channels() -> Picture:
    """
    A hexagon in mm with its drawing, and one in inch of another channel, whose virtual axis is Y and whose zero lies
    beside the center; in a program of many lines with findings inside and outside of its sections.
    """
    square = [(14.0, -14.0), (14.0, 14.0), (-14.0, 14.0), (-14.0, -14.0)]
    asked = DrawnPart(title="part.dxf", z=-5.0, agrees=False, rings=[square], lines=[])
    first = hexagon(channel="1", drawing=[asked])
    moves = msgspec.structs.replace(first.moves, line=[line + 10 for line in first.moves.line])
    inch = hexagon(title="Lines 11 to 16", line=11, end_line=16, channel="2", units="inch", scale=25.4, moves=moves)
    inch = msgspec.structs.replace(inch, writing=Writing(virtual="Y", origin=(2.54, 0.0)))
    lines = [f"N{number} G1 X{number / 10} (LINE <{number}>)" for number in range(1, LINES + 1)]
    found = [finding("too fast", also=[4]), finding("lost", line=15_000, section=None, move=None, severity="warning")]
    return picture(first, inch, findings=found, source=lines, source_lines=LINES)


@pytest.fixture(scope="module")
def opened_once(browser: Any, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Opened]:
    """A page with two programs, opened once."""
    file = tmp_path_factory.mktemp("page") / "use.html"
    text = page(
        [sections_of_two_channels(), picture(hexagon(), source=["N1", "N2"], source_lines=2)], plotly.get_plotlyjs()
    )
    file.write_text(text, "utf-8")
    more = {"has_touch": True, "permissions": ["clipboard-read", "clipboard-write"]}
    opened = Opened(browser, f"{file.as_uri()}#L4", **more)
    opened.page.set_viewport_size({"width": 1280, "height": 900})
    opened.page.wait_for_selector(".face .main-svg")
    yield opened
    assert opened.said == []
    assert {name.partition("#")[0] for name in opened.asked} == {file.as_uri()}
    opened.page.close()


@pytest.fixture
def use(opened_once: Opened) -> Opened:
    """The page with line 2 chosen, whichever test ran before; a test leaves behind it what else it finds."""
    opened_once.page.evaluate("location.hash = '#p0L2'")
    opened_once.page.locator("#p0 .lines .is-chosen[data-line='2']").wait_for()
    return opened_once


def window(use: Opened) -> list[float]:
    """Left, right, bottom and top of the window onto the face [program units]."""
    found: list[float] = use.page.evaluate(
        "() => { const l = document.querySelector('.face')._fullLayout; return [...l.xaxis.range, ...l.yaxis.range]; }"
    )
    return found


def chosen_line(use: Opened) -> str:
    """The line that is chosen in the source."""
    return str(use.page.locator("#p0 .lines .is-chosen").get_attribute("data-line"))


def measured(use: Opened) -> dict[str, str]:
    """Label and text of what is measured."""
    texts = use.page.locator(".measured:visible").locator("dt, dd").all_text_contents()
    return dict(zip(texts[::2], texts[1::2], strict=True))


def click(use: Opened, x: float, c: float) -> None:
    use.page.mouse.move(*use.at(x, c))
    use.page.mouse.down()
    use.page.mouse.up()


@pytest.mark.nightly
def test_a_link_leads_to_its_line_and_follows_what_is_chosen(use: Opened) -> None:
    page = use.page
    address = page.url.partition("#")[0]
    page.goto("about:blank")
    page.goto(f"{address}#L4")
    page.wait_for_selector(".face .main-svg")
    assert chosen_line(use) == "4"
    assert use.fact("line", "#p0 .chosen").startswith("4")
    page.keyboard.press("ArrowRight")
    page.wait_for_url("**#p0L5")
    for link, program, line in [("#p1L2", 1, "2"), ("#p0s1L13", 0, "13"), ("#p0L15000", 0, "15000")]:
        page.evaluate("(link) => { location.hash = link; }", link)
        page.locator(f"#p{program} .lines .is-chosen[data-line='{line}']").wait_for()
    for hostile in ("#p7L1", "#L0", "#L999999", "#L1%22%3E", "#p0s9L2x", "#"):
        page.evaluate("(link) => { location.hash = link; }", hostile)
    assert chosen_line(use) == "15000"
    page.keyboard.press("Escape")
    page.evaluate("location.hash = '#p0L1'")
    page.locator("#p0 .lines .is-chosen[data-line='1']").wait_for()


def test_a_new_address_is_followed_while_the_last_one_is_to_be_written(use: Opened) -> None:
    use.page.wait_for_url("**#p0L2")
    use.page.wait_for_timeout(400)  # until nothing is to be written
    use.page.evaluate(
        "() => { const write = window.setTimeout;"
        " window.setTimeout = (run, time) => time === 150 ? (window.writeNow = run) && 1 : write(run, time);"
        " location.hash = '#p0L5'; }"
    )
    use.page.locator("#p0 .lines .is-chosen[data-line='5']").wait_for()
    use.page.evaluate("() => { location.hash = '#p0L7'; window.writeNow(); }")
    use.page.locator("#p0 .lines .is-chosen[data-line='7']").wait_for()
    use.page.reload()
    use.page.wait_for_selector(".face .main-svg")


def test_the_source_of_many_lines_is_chosen_and_found(use: Opened) -> None:
    page = use.page
    page.click("#p0 .lines [data-line='3']")
    assert use.fact("line", "#p0 .chosen").startswith("3")
    signs = {line: page.locator(f"#p0 .lines [data-line='{line}'] .sign").text_content() for line in (1, 2, 4)}
    assert signs == {1: "", 2: "E", 4: "E"}
    assert page.locator("#p0 .lines .in-polar").count() == 12
    page.keyboard.press("/")
    for text, way, line, count in [
        ("15000", "Enter", "15000", "1 of 1"),
        ("line <1999", "Enter", "19990", "2 of 11"),
        ("line <1999", "Shift+Enter", "1999", "1 of 11"),
        ("20001", "Enter", "1999", "no line 20001"),
        ("<script>", "Enter", "1999", "not in the program"),
    ]:
        page.fill("#p0 .find input", text)
        page.keyboard.press(way)
        assert (chosen_line(use), page.locator("#p0 .find output").text_content()) == (line, count)
    assert page.locator("#p0 .lines .row").count() < 120
    page.keyboard.press("Escape")
    for key, line in [("ArrowDown", "2000"), ("End", "20000"), ("PageUp", ""), ("Home", "1"), ("ArrowDown", "2")]:
        page.keyboard.press(key)
        assert chosen_line(use).startswith(line)
    assert "too fast" in (page.locator("#p0 .list .is-chosen").first.text_content() or "")


def test_the_wheel_zooms_at_the_pointer_and_the_face_is_dragged(use: Opened) -> None:
    page = use.page
    page.keyboard.press("0")
    whole = window(use)
    place = use.at(10, 5)
    page.mouse.move(*place)
    page.evaluate("document.querySelector('.face').once('plotly_relayout', () => { window.hasZoomed = true; })")
    page.mouse.wheel(0, -400)
    # Plotly draws once more when the wheel has stopped, and would take a drag before that back.
    until(page, lambda: page.evaluate("window.hasZoomed === true"))
    assert window(use)[0] > whole[0] + 1
    until(page, lambda: use.at(10, 5) == pytest.approx(place, abs=1.5))
    page.mouse.down()
    page.mouse.move(place[0] + 70, place[1] + 40, steps=4)
    page.mouse.up()
    until(page, lambda: use.at(10, 5) == pytest.approx((place[0] + 70, place[1] + 40), abs=1.5))
    page.mouse.dblclick(*place)
    page.wait_for_function(
        "(left) => Math.abs(document.querySelector('.face')._fullLayout.xaxis.range[0] - left) < 1e-6", arg=whole[0]
    )
    for keys in (["+", "-"], ["Shift+ArrowRight", "Shift+ArrowUp", "Shift+ArrowLeft", "Shift+ArrowDown"], ["+", "0"]):
        for number, key in enumerate(keys):
            page.keyboard.press(key)
            assert number + 1 == len(keys) or window(use) != pytest.approx(whole, abs=1e-3), key
        assert window(use) == pytest.approx(whole, abs=1e-3), keys


def test_two_fingers_zoom(use: Opened) -> None:
    page = use.page
    page.keyboard.press("0")
    (x, y), before = use.at(0, 0), window(use)
    session = page.context.new_cdp_session(page)
    for kind, apart in [("Start", 20), ("Move", 40), ("Move", 60)]:
        points = [{"x": x + side * apart, "y": y, "id": number} for number, side in enumerate((-1, 1))]
        session.send("Input.dispatchTouchEvent", {"type": f"touch{kind}", "touchPoints": points})
        frames(page)
    session.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})

    def times() -> float:
        after = window(use)
        return (before[1] - before[0]) / (after[1] - after[0])

    until(page, lambda: times() == pytest.approx(3, rel=0.1))
    assert use.at(0, 0) == pytest.approx((x, y), abs=2)
    page.keyboard.press("0")


def test_measuring_with_the_pointer(use: Opened) -> None:
    page = use.page
    page.keyboard.press("0")
    page.click("#p0 .view-switch button:has-text('Machine')")
    page.click("#p0 .tools button:has-text('Measure')")
    click(use, HALF, 3)
    assert measured(use)["twice that"] == "30.000 mm"
    click(use, -HALF, -3)
    told = measured(use)
    assert told["between the parallel walls"] == "30.000 mm"
    assert (told["dX"], told["dC"]) == ("-60.000 mm, as a diameter", "0.000 mm")
    assert (told["from"], told["to"]) == ("contour, line 6", "contour, line 3")
    click(use, HALF, 8.66)
    click(use, 0, 17.32)
    told = measured(use)
    assert (told["distance"], told["dC"]) == ("17.321 mm", "8.660 mm")
    assert "X30. C8.66" in told["from"]
    click(use, 0, 29.97)
    assert measured(use)["diameter"] == "60.000 mm"
    # A click that measures chooses nothing; a drag still moves the window.
    assert chosen_line(use) == "2"
    page.click("#p0 .measured button:has-text('Copy'):visible")
    assert "diameter 60.000 mm" in page.evaluate("navigator.clipboard.readText()")
    page.keyboard.press("Escape")
    assert "Click two" in measured(use)[""]
    page.touchscreen.tap(*use.at(HALF, 3))
    assert measured(use)["length"] == "17.321 mm"
    page.keyboard.press("Escape")
    page.keyboard.press("Escape")
    assert page.locator(".measured:visible").count() == 0
    assert chosen_line(use) == "2"


def test_measuring_with_the_keys(use: Opened) -> None:
    page = use.page
    page.keyboard.press("0")
    page.mouse.move(5, 5)
    for key in ("m", "ArrowRight", "ArrowUp", "Enter", "ArrowDown", "Enter"):
        page.keyboard.press(key)
    told = measured(use)
    assert float(told["distance"].split()[0]) > 0
    for key in ("Escape", "w", "Enter"):
        page.keyboard.press(key)
    assert "length" in measured(use)
    page.keyboard.press("Escape")
    page.keyboard.press("m")
    assert page.locator(".measured:visible").count() == 0


def test_positions_are_copied_as_words_of_the_program(use: Opened) -> None:
    page = use.page
    page.keyboard.press("0")
    page.mouse.move(5, 5)
    copied = lambda: page.evaluate("navigator.clipboard.readText()")  # noqa: E731
    page.evaluate("location.hash = '#p0L5'")
    page.locator("#p0 .lines .is-chosen[data-line='5']").wait_for()
    page.keyboard.press("c")
    page.locator("#p0 .message:has-text('copied')").wait_for()
    x, c = hexagon().moves.end[4]
    words = re.fullmatch(r"X(-?[\d.]+) C(-?[\d.]+)", copied())
    assert words
    assert [float(word) for word in words.groups()] == pytest.approx([2 * float(x or 0), float(c or 0)], abs=5e-4)
    # Another channel in inch: Y, and a zero 0.1 inch beside the center; where the browser gives no clipboard.
    page.evaluate("() => { navigator.clipboard.writeText = () => Promise.reject(new Error('no')); }")
    page.evaluate("location.hash = '#p0L15'")
    page.locator("#p0 .lines .is-chosen[data-line='15']").wait_for()
    page.keyboard.press("c")
    page.locator("#p0 .message:has-text('Y')").wait_for()
    words = re.fullmatch(r"X(-?[\d.]+) Y(-?[\d.]+)", copied())
    assert words
    assert [float(word) for word in words.groups()] == pytest.approx(
        [2 * (float(x or 0) - 2.54) / 25.4, float(c or 0) / 25.4], abs=5e-5
    )
    page.keyboard.press("l")
    page.locator("#p0 .message:has-text('#p0L15')").wait_for()
    assert copied() == page.url


def test_sections_side_by_side_the_drawing_and_the_list_of_keys(use: Opened) -> None:
    page = use.page
    page.keyboard.press("b")
    columns = page.locator("#p0 .sides .column")
    assert columns.locator("strong").all_text_contents() == ["channel 1", "channel 2"]
    columns.nth(1).locator("button").click()
    assert columns.nth(1).locator("button").get_attribute("aria-pressed") == "true"
    assert page.locator("#p0s1").is_visible()
    assert page.locator("#p0s1 .face .ytitle").text_content() == "Y [inch, from the center of C]"
    columns.nth(0).locator("button").click()
    page.keyboard.press("b")
    assert not columns.nth(0).is_visible()
    shown = "document.querySelector('#p0s0 .face').data.some((trace) => (trace.name || '').includes('part.dxf'))"
    assert page.evaluate(shown)
    page.keyboard.press("d")
    assert not page.evaluate(shown)
    page.keyboard.press("d")
    assert page.evaluate(shown)
    page.keyboard.press("?")
    assert page.locator("#keys").is_visible()
    page.keyboard.press("Escape")
    assert not page.locator("#keys").is_visible()


@pytest.mark.nightly
def test_the_line_of_the_worst_finding_is_in_sight_and_remains_there(browser: Any, tmp_path: Path) -> None:
    """Before anything is chosen, and where what is known of the chosen finding leaves less room for the program."""
    found = [finding("too fast", line=300, move=3, why="It cannot turn so fast. " * 12)]
    whole = picture(hexagon(), findings=found, source=["N1"] * 400, source_lines=400)
    (tmp_path / "one.html").write_text(page([whole], plotly.get_plotlyjs()), "utf-8")
    opened = Opened(browser, (tmp_path / "one.html").as_uri())
    is_within = """([inner, outer, covered]) => {
      const [part, box] = [inner, outer].map((name) => document.querySelector(name)?.getBoundingClientRect());
      if (!part || !box) { return false; }
      const head = document.querySelector(covered);
      const top = box.top + (head ? head.offsetHeight : 0) - 1;
      return part.top >= top && part.top + 15 <= Math.min(box.bottom, innerHeight);
    }"""
    line = ["div.lines [data-line='300']", "div.lines", ".no-heading"]
    opened.page.set_viewport_size({"width": 1280, "height": 720})
    opened.page.reload()
    opened.page.wait_for_function(is_within, arg=line)
    opened.page.click(".list li button")
    opened.page.wait_for_function(is_within, arg=["div.lines .is-chosen", *line[1:]])
    opened.page.wait_for_function(is_within, arg=[".list li.is-chosen .where", ".list", ".list h2"])
    assert opened.said == []
    opened.page.close()
