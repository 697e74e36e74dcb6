"""The page in a view of an editor, in a browser with the object that such a view has: the cursor, both ways."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from pictures_by_hand import finding, hexagon, picture
from test_page_in_browser import CHROMIUM, browser, frames

from polarcheck.view.page import page

playwright = pytest.importorskip("playwright.sync_api")
plotly = pytest.importorskip("plotly.offline")
pytestmark = [
    pytest.mark.ci,
    pytest.mark.skipif(CHROMIUM is None, reason="there is no chromium here"),
    pytest.mark.xdist_group("browser"),
]
__all__ = ["browser"]

VIEW = """
window.sent = [];
window.acquireVsCodeApi = () => ({ postMessage: (message) => window.sent.push(message) });
document.addEventListener("DOMContentLoaded", () => document.body.classList.add("vscode-dark"));
"""


#: Sends a message, and waits until the one behind it has come.
SEND = """
(message) => new Promise((come) => {
  window.sent = [];
  window.addEventListener("message", ({ data }) => data === "last" && come());
  window.postMessage(message, "*");
  window.postMessage("last", "*");
})
"""


def test_the_page_follows_the_cursor_and_leads_to_blocks(browser: Any, tmp_path: Path) -> None:
    path = tmp_path / "page.html"
    path.write_text(page([picture(hexagon(), findings=[finding("too fast", line=2)])], plotly.get_plotlyjs()), "utf-8")
    opened = browser.new_page()
    errors: list[str] = []
    opened.on("pageerror", lambda error: errors.append(str(error)))
    opened.add_init_script(VIEW)
    opened.goto(path.as_uri())
    opened.wait_for_function("window.sent.some((message) => message.kind === 'ready')")

    def chosen() -> str:
        return str(opened.locator(".chosen").first.inner_text())

    def send(message: Any) -> None:
        opened.evaluate(SEND, message)
        frames(opened)

    # It has the colors of the editor.
    assert opened.locator("html").get_attribute("data-theme") == "dark"
    opened.evaluate("document.body.className = 'vscode-light'")
    opened.wait_for_function("document.documentElement.dataset.theme === 'light'")
    # The cursor chooses a block, and is not sent back.
    send({"kind": "line", "line": 4})
    assert chosen().split()[1].startswith("4")
    assert opened.evaluate("window.sent") == []
    for message in (None, 5, {"kind": "line"}, {"kind": "line", "line": "5"}, {"kind": "other", "line": 5}):
        send(message)
        assert chosen().split()[1].startswith("4")
    # A finding leads to its block.
    opened.evaluate("window.sent = []")
    opened.locator("[data-finding]:visible").first.click()
    assert opened.evaluate("window.sent") == [{"kind": "line", "line": 2}]
    # What is shown is kept as the page is drawn anew, once its face has settled.
    opened.wait_for_function("() => new Promise((done) => setTimeout(() => done(true), 1000))")
    opened.get_by_role("button", name="Machine").first.click()
    send({"kind": "keep"})
    (kept,) = opened.evaluate("window.sent")
    assert (kept["kind"], kept["kept"]["line"], kept["kept"]["view"]) == ("kept", 2, "machine")
    opened.reload()
    opened.wait_for_function("window.sent.some((message) => message.kind === 'ready')")
    send({"kind": "restore", "kept": kept["kept"]})
    assert opened.locator(".polar").first.get_attribute("data-view") == "machine"
    assert chosen().split()[1].startswith("2")
    assert opened.evaluate("window.sent") == []
    assert errors == []
    opened.close()
