"""
Writes docs/images/machine.png: the view of the machine at three moments of a slot that passes near the center.

    python docs/machine_view.py

It needs the extras `plot` and `dev`, and a Chromium on the path.
"""

from __future__ import annotations

import base64
import shutil
import tempfile
from html import escape
from pathlib import Path
from typing import Any

from click.testing import CliRunner
from playwright.sync_api import sync_playwright

from polarcheck.commands import main

PROGRAM = Path("sample_programs/c_axis_too_fast.nc")
IMAGE = Path("docs/images/machine.png")
#: The line of the slot, and the shares of its time that are shown.
LINE, SHARES = 12, (0.05, 0.3, 0.47)
SETTINGS = 'machine = "fanuc-30i"\n\n[limits]\nc_feed = 10800\n\n[stock]\ndiameter = 24\n\n[tools.2]\nradius = 1.5\n'
#: Moves the slider of the player to a share of the time of a line.
SEEK = """([line, share]) => {
  const { moves } = JSON.parse(document.getElementById("data").textContent)[0].sections[0];
  const move = moves.line.indexOf(line), clock = document.querySelector(".clock");
  clock.value = String(moves.begin[move] + share * moves.time[move]);
  clock.dispatchEvent(new Event("input"));
}"""
STYLE = "body { margin: 0; padding: 8px; display: flex; gap: 20px; background: #fff } img { width: 400px }"


def write() -> None:
    """Write the picture."""
    with tempfile.TemporaryDirectory() as folder:
        program, page = Path(folder, PROGRAM.name), Path(folder, "page.html")
        program.write_bytes(PROGRAM.read_bytes())
        Path(folder, "polarcheck.toml").write_text(SETTINGS, "utf-8")
        result = CliRunner().invoke(main, ["plot", str(program), "-o", str(page)])
        if result.exit_code:
            raise SystemExit(result.output)
        with sync_playwright() as started:
            browser = started.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            images = [_phase(browser, page, share) for share in SHARES]
            tab = browser.new_page(viewport={"width": 1256, "height": 430})
            shown = "".join(f'<img src="data:image/png;base64,{escape(image)}">' for image in images)
            tab.set_content(f"<style>{STYLE}</style>{shown}")
            tab.locator("body").screenshot(path=IMAGE)
            browser.close()


def _phase(browser: Any, page: Path, share: float) -> str:
    """Return the view of the machine at a share of the slot, as a PNG in base64."""
    tab = browser.new_page(viewport={"width": 880, "height": 900})
    tab.goto(page.as_uri())
    tab.click(".view-switch button:has-text('Machine')")
    tab.add_style_tag(content=".machine { width: 400px; height: 410px !important }")
    tab.evaluate(SEEK, [LINE, share])
    tab.wait_for_timeout(1000)
    image: bytes = tab.locator(".machine").screenshot()
    tab.close()
    return base64.b64encode(image).decode()


if __name__ == "__main__":
    write()
