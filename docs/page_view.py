"""
Writes docs/images/page.png: the page of a program whose groove is narrower than the cutter, with the finding chosen.

    python docs/page_view.py

It needs the extras `plot` and `dev`, and a Chromium on the path.
"""

from __future__ import annotations

import shutil
import tempfile
from pathlib import Path

from click.testing import CliRunner
from playwright.sync_api import sync_playwright

from polarcheck.commands import main

PROGRAM = "sample_programs/narrow_groove.nc"
IMAGE = Path("docs/images/page.png")


def write() -> None:
    """Write the picture."""
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder, "page.html")
        result = CliRunner().invoke(main, ["plot", PROGRAM, "-o", str(page)])
        if result.exit_code:
            raise SystemExit(result.output)
        with sync_playwright() as started:
            browser = started.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            tab = browser.new_page(viewport={"width": 1280, "height": 760})
            tab.goto(page.as_uri())
            tab.click(".list li > button")
            tab.click(".windows button:text-is('Whole')")
            tab.mouse.move(0, 0)
            tab.wait_for_timeout(1000)
            tab.screenshot(path=IMAGE)
            browser.close()


if __name__ == "__main__":
    write()
