"""What the server says to an extension: the page with the picture, and the verdict of each check."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest
from lsp_editor import Editor, Json
from test_cli import RAPID

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

VERDICTS = {"experimental": {"polarcheck": {"verdict": True}}}
ADDRESS, SOURCES = "https://file.example/plotly.min.js", "https://file.example"


@pytest.fixture
def editor() -> Iterator[Editor]:
    with Editor(capabilities=VERDICTS) as editor:
        yield editor


def verdict_of(editor: Editor, uri: str, version: int = 1) -> Json:
    """The verdict of a version of a document, once it is there."""
    while True:
        for method, params in editor.said:
            if method == "polarcheck/verdict" and (params["uri"], params["version"]) == (uri, version):
                return dict(params)
        editor._next()


def test_each_check_gives_a_verdict(editor: Editor) -> None:
    uri = editor.open("O1.NC", RAPID)
    verdict = verdict_of(editor, uri)
    assert verdict["verdict"] == "fail"
    assert verdict["errors"] == len([mark for mark in editor.published[uri][1] if mark["severity"] == 1]) > 0
    assert verdict["sections"] == 1
    assert verdict["machine"].endswith("(fanuc)")
    editor.change(uri, 2, "O1\nG0 X50.\nM30\n")
    assert verdict_of(editor, uri, 2)["errors"] == 0


def test_a_broken_configuration_is_the_reason(editor: Editor) -> None:
    Path("polarcheck.toml").write_text("nonsense = 1\n", "utf-8")
    verdict = verdict_of(editor, editor.open("O1.NC", RAPID))
    assert verdict["verdict"] == "not checked"
    assert "nonsense" in verdict["reasons"][0]
    answer = editor.ask("polarcheck/picture", {"uri": verdict["uri"]})
    assert answer["code"] == -32803
    assert "nonsense" in answer["message"]


def test_editors_that_know_no_verdict_are_not_sent_any() -> None:
    with Editor() as editor:
        uri = editor.open("O1.NC", RAPID)
        editor.asks("hover", uri)
        assert not [method for method, _ in editor.said if method == "polarcheck/verdict"]


def test_the_picture_is_of_the_unsaved_text(editor: Editor) -> None:
    uri = editor.open("O1.NC", RAPID)
    asked = {"uri": uri, "library": ADDRESS, "sources": SOURCES}
    html = editor.ask("polarcheck/picture", asked)["html"]
    assert f'<script src="{ADDRESS}">' in html
    assert "script-src 'sha256-" in html
    assert f" {SOURCES}; style-src" in html
    assert len(html) < 500_000
    editor.change(uri, 2, "O1\nG0 X50. (A<B>)\nM30\n")
    changed = editor.ask("polarcheck/picture", asked)["html"]
    assert "rapid-in-polar" in html
    assert "rapid-in-polar" not in changed
    assert "<B>" not in changed


def test_without_an_address_the_page_holds_the_library(editor: Editor) -> None:
    library = Path(editor.ask("polarcheck/library", {})["path"]).read_text("utf-8")
    page = editor.ask("polarcheck/picture", {"uri": editor.open("O1.NC", RAPID)})["html"]
    assert len(page) > len(library)
    assert "<script src" not in page


@pytest.mark.parametrize(
    ("params", "code"),
    [
        ({}, -32602),
        (None, -32602),
        ([], -32602),
        ({"uri": 5}, -32602),
        ({"uri": "file:///O1.NC", "library": ["x"]}, -32602),
        ({"uri": "x" * 10_000}, -32602),
        ({"uri": "file:///O2.NC"}, -32803),
    ],
)
def test_wrong_requests_are_refused(editor: Editor, params: Json | None, code: int) -> None:
    assert editor.ask("polarcheck/picture", params)["code"] == code


def test_addresses_are_no_markup(editor: Editor) -> None:
    hostile = '"><script>alert(1)</script>'
    asked = {"uri": editor.open("O1.NC", RAPID), "library": hostile, "sources": hostile + "; script-src *"}
    answer = editor.ask("polarcheck/picture", asked)
    assert answer.get("code") == -32602 or hostile not in answer["html"]


def test_without_plotly_the_answer_says_what_to_install(editor: Editor, monkeypatch: pytest.MonkeyPatch) -> None:
    import importlib.util

    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None)
    answer = editor.ask("polarcheck/library", {})
    assert answer["code"] == -32803
    assert "pip install plotly" in answer["message"]
