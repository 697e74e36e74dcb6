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
    pytest.mark.slow,
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
    tab.set_default_timeout(20_000)
    faults: list[str] = []
    tab.on("pageerror", lambda error: faults.append(str(error)))
    tab.on("console", lambda message: faults.append(message.text))
    tab.clock.install(time=0)
    yield tab
    assert faults == []
    context.close()


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
