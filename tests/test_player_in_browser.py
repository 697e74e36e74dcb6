"""The player of a page in a browser: a section played through against `polarcheck trace`, and what it shows beside."""

from __future__ import annotations

import itertools
import json
import math
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from polarcheck.commands import main

playwright = pytest.importorskip("playwright.sync_api")
plotly = pytest.importorskip("plotly.offline")
CHROMIUM = shutil.which("chromium")
ARGUMENTS = ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"]
pytestmark = [
    pytest.mark.nightly,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
    pytest.mark.xdist_group("browser"),
]

#: The machine whose C turns the other way.
REVERSED = 'inherits = "fanuc"\n[polar]\nzero_angle = "at-c0-reversed"\n'
HEAD = "%\nO1\n{units} G98 G40 G18\nT0101\nM5\nG28 H0\nG97 S3000 M13\nG0 {entry} Z-5.\nG12.1\n"
TAIL = "G13.1\nG0 X200. Z50.\nM30\n%\n"
CONTOUR = """G1 X60. C0 F1500
G42 X30. F200
C8.660
X0 C17.321
X-30. C8.660
C-8.660
X0 C-17.321
X30. C-8.660
C0
G40 X60. F1500
"""
ARCS = "G1 X60. C0 F900\nX40. F240\nG3 X-40. C0 R20.\nG2 X-20. C0 I5. J0\nG1 X-44. C12.\n"
#: Each: the entry, the blocks, the units, and options.
SECTIONS = {
    "hexagon": ("X70. C0", CONTOUR, "G21", []),
    "arcs": ("X70. C0", ARCS, "G21", []),
    "near the center": ("X50. C0", "G1 X40. C0.5 F900\nX-40. F200\nC6.\n", "G21", []),
    "inch": ("X3. C0", "G1 X2. C.1 F40.\nX-.4 C.5\nG3 X-.4 C-.5 R.6\n", "G20", []),
    "entry at C50": ("X70. C50.", CONTOUR, "G21", []),
    "C the other way": ("X70. C0", ARCS, "G21", ["--machine", "reversed.toml"]),
    "X on the negative side": ("X-70. C0", "G1 X-60. C0 F1500\nX-40. C15. F200\nX-10. C-20.\n", "G21", []),
}


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as started:
        opened = started.chromium.launch(executable_path=CHROMIUM, args=ARGUMENTS)
        yield opened
        opened.close()


@pytest.fixture
def opened(browser: Any) -> Iterator[Any]:
    """A page whose clock stands still; nothing may go wrong on it."""
    context = browser.new_context(viewport={"width": 1280, "height": 900})
    tab = context.new_page()
    tab.set_default_timeout(120_000)
    faults: list[str] = []
    tab.on("pageerror", lambda error: faults.append(str(error)))
    tab.on("console", lambda message: faults.append(message.text))
    tab.clock.install(time=0)
    yield tab
    assert faults == []
    context.close()


def seek(opened: Any, share: float, place: int = 0) -> None:
    """Set the slider of a section to a share of its length."""
    opened.evaluate(
        "([share, place]) => { const clock = document.querySelectorAll('.clock')[place];"
        " clock.value = String(share * Number(clock.max)); clock.dispatchEvent(new Event('input')); }",
        [share, place],
    )
    opened.clock.run_for(300)


def run(*arguments: str) -> str:
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code in (0, 1), result.output
    return result.stdout


def written(opened: Any, name: str) -> str:
    """The number that stands at a gauge."""
    text: str = opened.locator(f".gauges [data-value='{name}']").inner_text()
    return text


class Traced:
    """The axes at each time, by closed form from the moves of `polarcheck trace`."""

    def __init__(self, document: dict[str, Any], side: int) -> None:
        self.moves = document["moves"]
        self.side = side

        # C runs with the turn about the center, or against it.
        turns = max(((move, self.turn(move, 1.0)) for move in self.moves), key=lambda each: abs(each[1]))
        self.sense = math.copysign(1, turns[1] * (turns[0]["c_axis"][1] - turns[0]["c_axis"][0]))

    @property
    def time(self) -> float:
        return math.fsum(move["time"] for move in self.moves)

    def at(self, time: float) -> tuple[complex, float, float]:
        """The place on the plane [mm], C [deg] and X as a radius [mm]."""
        for move in self.moves:
            if time <= move["time"] or move is self.moves[-1]:
                break
            time -= move["time"]
        share = min(time / move["time"], 1.0)
        place = self.place(move, share)
        return place, move["c_axis"][0] + self.sense * self.turn(move, share), self.side * abs(place)

    def turn(self, move: dict[str, Any], share: float) -> float:
        """The turn about the center up to a share of a move [deg], summed over small steps."""
        places = [self.place(move, share * number / 400) for number in range(401)]
        return math.fsum(math.degrees(cphase(after / before)) for before, after in itertools.pairwise(places))

    @staticmethod
    def place(move: dict[str, Any], share: float) -> complex:
        start, end = complex(*move["start"]), complex(*move["end"])
        if move["kind"] == "line":
            return start + share * (end - start)
        center = complex(*move["center"])
        sweep = cphase((end - center) / (start - center))
        if move["kind"] == "ccw":
            sweep %= 2 * math.pi
        else:
            sweep = -(-sweep % (2 * math.pi))
        turn = complex(math.cos(share * sweep), math.sin(share * sweep))
        return center + (start - center) * turn


def cphase(value: complex) -> float:
    return math.atan2(value.imag, value.real)


@pytest.mark.one_in(3)
@pytest.mark.parametrize("name", SECTIONS)
def test_a_section_played_through_agrees_with_the_trace(
    opened: Any, name: str, tmp_path: Path, monkeypatch: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    entry, blocks, units, options = SECTIONS[name]
    Path("a.nc").write_text(HEAD.format(units=units, entry=entry) + blocks + TAIL)
    Path("reversed.toml").write_text(REVERSED)
    radius = "radius=.15" if units == "G20" else "radius=4"
    options = ["--tool", f"1:{radius}", *(options or ["--machine", "fanuc"])]
    traced = Traced(json.loads(run("trace", "a.nc", *options, "--format", "json")), -1 if "X-70" in entry else 1)
    run("plot", "a.nc", *options, "-o", "a.html")
    opened.goto(Path("a.html").absolute().as_uri())
    opened.clock.pause_at(60_000)
    inch = 25.4 if units == "G20" else 1.0
    digits = 1e-3 if inch == 1 else 1e-4 * inch

    speed = 10 if traced.time > 20 else 2
    opened.select_option(".player .speed", str(speed))
    opened.keyboard.press("Space")
    seen = []
    for _ in range(10):
        opened.clock.run_for(round(traced.time / 10.3 / speed * 1000))
        time = float(opened.locator(".player .clock").input_value())
        place, c_axis, x_axis = traced.at(time)
        x, c = re.findall(r"[XC](-?[\d.]+)", written(opened, "part"))
        assert abs(complex(float(x) / 2, float(c)) * inch - place) < 0.01 + digits, time
        assert float(written(opened, "angle")) == pytest.approx(c_axis, abs=0.1), time
        assert float(written(opened, "axis")) / 2 * inch == pytest.approx(x_axis, abs=0.01 + digits), time
        seen.append(time)
    assert seen == sorted(set(seen))
    assert seen[-1] > 0.85 * traced.time
    # At its end it stands.
    opened.clock.run_for(4000)
    assert float(opened.locator(".player .clock").input_value()) == pytest.approx(traced.time, abs=0.002)
    assert opened.locator(".player-note").inner_text() == "End of the section."


#: Through the center; with G42 and no R; at an F that is not known.
ODD = """%
O1
G21 G98 G40 G18
T0101
G28 H0
G97 S3000 M13
G0 X50. Z-1. C0
G12.1
G1 X40. F1500
X-40. F200
G13.1
T0202
G0 X70. Z-3. C0
G12.1
G1 X60. C0 F1500
G42 X30. F200
C8.660
G40 X60. C40. F1500
G13.1
T0303
G0 X70. Z-3. C30.
G12.1
G1 X60. C0 F#900
G3 X-60. R30.
G13.1
M30
%
"""


def test_what_is_not_known_is_shown_and_said(opened: Any, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    Path("odd.nc").write_text(ODD)
    run("plot", "odd.nc", "--tool", "1:radius=3", "--tool", "3:radius=2", "--machine", "fanuc", "-o", "odd.html")
    opened.goto(Path("odd.html").absolute().as_uri())
    opened.clock.pause_at(60_000)
    shown = opened.locator(".polar:visible")

    # C turns at once at the center: while that is shown, the time of the machine stands still.
    opened.select_option(".polar:visible .speed", "1")
    seek(opened, 0.2 / (0.2 + 12 + 12 + 1.5))
    assert shown.locator("[data-value='angle']").inner_text() == "0.000"
    length = float(shown.locator(".clock").get_attribute("max"))
    seek(opened, (0.2 + 6.0 * 2 - 6.0 + 0.75) / length)
    assert shown.locator(".time").inner_text() == "0:06.2 of 0:12.2"
    assert float(shown.locator("[data-value='angle']").inner_text()) == pytest.approx(90, abs=1)
    assert shown.locator("[data-value='c_feed']").inner_text() == "180 deg at once"
    assert "turn 180 deg at once" in shown.locator(".player-note").inner_text()
    seek(opened, 1.0)
    assert shown.locator("[data-value='angle']").inner_text() == "180.000"
    assert shown.locator("[data-value='axis']").inner_text() == "40.000"

    # The next section plays by itself; without R a point moves along the programmed path, and no time is claimed.
    opened.keyboard.press("n")
    opened.clock.run_for(2200)
    assert opened.locator(".polar:visible").get_attribute("data-section") == "1"
    assert "at its F" in shown.locator(".player-note").inner_text()
    assert shown.locator(".time").inner_text() == "0:00.2 of at least 0:00.2"
    assert "R of the cutter is not known" in shown.locator(".machine").inner_text()
    assert shown.locator(".running").inner_text() == "line 16: G42 X30. F200"

    # Without F and with an arc: places and axes are known, rates are not.
    opened.keyboard.press("n")
    opened.clock.run_for(150)
    opened.keyboard.press("Space")
    seek(opened, 0.8, 2)
    x, c = map(float, re.findall(r"[XC](-?[\d.]+)", shown.locator("[data-value='part']").inner_text()))
    assert math.hypot(x / 2, c) == pytest.approx(30, abs=0.02)
    expected = 30 + math.degrees(math.atan2(c, x / 2))
    assert float(shown.locator("[data-value='angle']").inner_text()) == pytest.approx(expected, abs=0.01)
    assert shown.locator("[data-value='c_feed']").inner_text() == "not known"
    assert shown.locator(".time").inner_text() == "time not known"
    # A move that is chosen elsewhere: the tool stands at its end.
    opened.keyboard.press("Home")
    opened.clock.run_for(300)
    assert shown.locator("[data-value='part']").inner_text() == "X60.000 C0.000"


#: The pixels of a canvas, of 4 bytes each.
PIXELS = """() => {
  window.pixels = (name) => {
    const shown = document.querySelector(name), { width, height } = shown;
    const canvas = Object.assign(document.createElement("canvas"), { width, height });
    const pen = canvas.getContext("2d", { willReadFrequently: true });
    pen.drawImage(shown, 0, 0);
    return pen.getImageData(0, 0, width, height);
  };
}"""
#: The places on a canvas that have the color of the cutter: their mean [px of the page] and number.
CUTTER = """(name) => {
  const { data, width, height } = window.pixels(name);
  let [x, y, count] = [0, 0, 0];
  for (let at = 0; at < data.length; at += 4) {
    const [red, green, blue, alpha] = data.slice(at, at + 4);
    if (alpha > 150 && red > 150 && green > 120 && blue < 100 && red > green + 40) {
      x += (at / 4) % width; y += Math.floor(at / 4 / width); count += 1;
    }
  }
  const box = document.querySelector(name).getBoundingClientRect();
  return [box.x + (x / count) * box.width / width, box.y + (y / count) * box.height / height, count];
}"""
#: Stores the pixels of a canvas, or returns the share that differs clearly from those stored before.
CHANGED = """([name, moment]) => {
  window.stored = window.stored || {};
  const { data } = window.pixels(name), before = window.stored[moment];
  window.stored[moment] = data;
  return before ? data.filter((value, at) => Math.abs(value - before[at]) > 40).length / data.length : 0;
}"""


def test_both_views_draw_the_cutter_and_the_metal(opened: Any, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.nc").write_text(HEAD.format(units="G21", entry="X70. C0") + CONTOUR + TAIL)
    run("plot", "a.nc", "--tool", "1:radius=4", "--machine", "fanuc", "-o", "a.html")
    opened.goto(Path("a.html").absolute().as_uri())
    opened.clock.pause_at(60_000)
    opened.evaluate(PIXELS)
    # Nothing covers the face, and nothing runs, before it is wanted.
    assert opened.evaluate(CUTTER, "canvas.over")[2] == 0
    opened.click(".view-switch button:has-text('Both')")
    opened.clock.run_for(500)
    places, axes = [], []
    for share in (0.3, 0.6, 0.95, 0.6, 0.3):
        seek(opened, share)
        x, c = map(float, re.findall(r"[XC](-?[\d.]+)", written(opened, "part")))
        across, down = opened.evaluate(
            "([x, c]) => { const face = document.querySelector('.face'), { xaxis, yaxis } = face._fullLayout;"
            " const box = face.getBoundingClientRect();"
            " return [box.x + xaxis._offset + xaxis.l2p(x), box.y + yaxis._offset + yaxis.l2p(c)]; }",
            [x, c],
        )
        # The path of the block has the color of the cutter, too: the mean is near, not exact.
        on_face = opened.evaluate(CUTTER, "canvas.over")
        assert math.dist(on_face[:2], (across, down)) < 30
        places.append(opened.evaluate(CUTTER, ".machine canvas"))
        axes.append(float(written(opened, "axis")))
        # Back at an earlier time there is the metal of that time.
        assert opened.evaluate(CHANGED, [".machine canvas", share]) < 0.001
        changed = opened.evaluate(CHANGED, [".machine canvas", "before"])
        assert changed == 0 or changed > 0.01
    # The cutter stands on the X axis, and goes along it as X does.
    assert max(place[1] for place in places) - min(place[1] for place in places) < 2
    (first, _, _), (second, _, _), (third, _, _) = places[:3]
    assert (second - first) / (axes[1] - axes[0]) == pytest.approx((third - first) / (axes[2] - axes[0]), rel=0.15)

    # Steps of time and of speed by keys.
    opened.focus(".player .clock")
    time = float(opened.locator(".clock").input_value())
    opened.keyboard.press(".")
    opened.keyboard.press(">")
    opened.keyboard.press(".")
    assert float(opened.locator(".clock").input_value()) == pytest.approx(time + 0.1 + 0.2, abs=1e-6)
    opened.keyboard.press("<")
    opened.keyboard.press(",")
    assert float(opened.locator(".clock").input_value()) == pytest.approx(time + 0.2, abs=1e-6)


#: Counts what is drawn in each frame.
COUNTED = """() => {
  window.drawn = [0];
  for (const name of ["lineTo", "arc", "stroke", "fill", "drawImage", "fillText"]) {
    const original = CanvasRenderingContext2D.prototype[name];
    CanvasRenderingContext2D.prototype[name] = function (...given) {
      window.drawn[window.drawn.length - 1] += 1;
      return original.apply(this, given);
    };
  }
  const next = () => { window.drawn.push(0); requestAnimationFrame(next); };
  requestAnimationFrame(next);
}"""


def test_a_frame_draws_a_bounded_number_of_lines(opened: Any, tmp_path: Path, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    count = 5000
    turns = [math.tau * 20 * number / count for number in range(count)]
    radii = [28 - 25 * number / count for number in range(count)]
    spiral = [f"X{2 * r * math.cos(a):.3f} C{r * math.sin(a):.3f}\n" for r, a in zip(radii, turns, strict=True)]
    Path("a.nc").write_text(HEAD.format(units="G21", entry="X60. C0") + "G1 F400 " + "".join(spiral) + TAIL)
    run("plot", "a.nc", "--tool", "1:radius=2", "--machine", "fanuc", "-o", "a.html")
    opened.goto(Path("a.html").absolute().as_uri())
    opened.clock.pause_at(60_000)
    opened.click(".view-switch button:has-text('Both')")
    opened.clock.run_for(500)
    opened.select_option(".speed", "10")
    opened.click(".player .play")
    opened.clock.run_for(200)
    opened.evaluate(COUNTED)
    opened.clock.run_for(1000)
    playing = opened.evaluate("window.drawn")
    seek(opened, 1.0)
    opened.clock.run_for(500)
    after = opened.evaluate("window.drawn")
    assert max(playing) < 1000
    # A leap is swept over several frames.
    assert max(after) < 3000
    assert sum(after) - sum(playing) > count
