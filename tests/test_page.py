"""The page of pictures as text: what it says without its scripts, and that nothing in it is markup but its own."""

from __future__ import annotations

import json
import re
from html.parser import HTMLParser
from importlib import resources
from typing import Any

import pytest
from cases import looped
from pictures_by_hand import finding, hexagon, notch, picture

from polarcheck.view.page import page

LIBRARY = "var Plotly = {};"
HOSTILE = [
    "(</script><script>alert(1)</script>)",
    "(<img src=x onerror=alert(1)>)",
    "(\"quoted\" 'single' &amp; &lt;b&gt;)",
    "(\x1b[31mred\x07 \u202eback \u2028 line)",
    "(<a href='javascript:alert(1)'>here</a> ]]> <!-- $title ${data})",
    "(half \ud83d of a character)",
]


class Reader(HTMLParser):
    """A page as a browser takes it apart: its elements, the text outside of scripts, the text of each script."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.text = ""
        self.scripts: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        if tag == "script":
            self.scripts.append("")

    def handle_data(self, data: str) -> None:
        if self.lasttag == "script":
            self.scripts[-1] += data
        elif self.lasttag != "style":
            self.text += data

    def named(self, tag: str) -> list[dict[str, str | None]]:
        return [attributes for name, attributes in self.elements if name == tag]


def data_of(text: str) -> Any:
    return json.loads(Reader(text).scripts[0])


def test_without_scripts_the_page_tells_the_head_the_findings_and_what_is_made() -> None:
    found = [finding("C too fast", why="It stops.", alarm="OT512", fix="Lower F"), finding("known", silenced="allow")]
    made = hexagon(marks=[notch()])
    read = Reader(page([picture(made, findings=found, not_evaluated=["no limit of X"])], library=LIBRARY))
    told = [
        "hexagon.nc",
        "fail",
        "a lathe",
        "no limit of X",
        "C too fast",
        "It stops.",
        "Lower F",
        "c-feed-above-limit",
    ]
    told += ["hexagon, 30.000 across flats", "R 4.000 mm (command line)", "line 3 cuts 1.000 mm into line 6", "OT512"]
    told += ["X28.000 C0.000", "error, silenced (allow)", "C 500 deg/min", "need a browser that runs scripts"]
    assert [text for text in told if text not in read.text] == []
    assert len(read.named("noscript")) == 2


def test_why_there_is_no_path_of_the_tool_is_told() -> None:
    read = Reader(page([picture(hexagon(radius=None, needs_radius="no radius for T0101"))], library=LIBRARY))
    assert "no radius for T0101" in read.text
    assert "cutter" not in read.text


def test_lengths_are_told_in_the_units_of_the_program() -> None:
    inch = hexagon(units="inch", scale=25.4, radius=6.35, stock=50.8, marks=[notch()])
    text = Reader(page([picture(inch)], library=LIBRARY)).text
    assert "R 0.2500 inch" in text
    assert "2.0000 inch across" in text
    assert f"X{2 * 14 / 25.4:.4f} C0.0000" in text


@pytest.mark.ci
@looped("text", HOSTILE)
def test_text_of_a_program_is_never_markup(text: str) -> None:
    hostile = finding(text, rule=text, block=text, why=text, alarm=text, fix=text, silenced=text, severity="error")
    section = hexagon(title=text, radius_source=text, channel=text, needs_radius=text, blocks=[text] * 6)
    whole = picture(section, findings=[hostile], path=text, head=[(text, text)], not_evaluated=[text], summary=text)
    plain = picture(
        hexagon(channel="c", needs_radius="n"),
        findings=[finding("m", why="w", alarm="a", fix="f", silenced="s")],
        not_evaluated=["n"],
        head=[("a", "b")],
    )
    made, expected = page([whole], library=LIBRARY), page([plain], library=LIBRARY)
    assert [name for name, _ in Reader(made).elements] == [name for name, _ in Reader(expected).elements]
    # Half characters are none of UTF-8, and what acts on a terminal or turns text around is spelled out.
    assert not set(made.encode().decode()) & set("\x1b\x07\u202e\u2028")
    assert {attribute for _, attributes in Reader(made).elements for attribute in attributes} == {
        attribute for _, attributes in Reader(expected).elements for attribute in attributes
    }
    assert data_of(made)[0]["sections"][0]["moves"]["block"][0].startswith("(")
    assert text.partition("\x1b")[0].partition("\ud83d")[0] in Reader(made).text


def test_data_is_read_back_as_it_was() -> None:
    section = data_of(page([picture(hexagon(marks=[notch()]), findings=[finding("<b>")])], library=LIBRARY))[0]
    assert section["findings"][0]["message"] == "<b>"
    tool = section["sections"][0]["tool"]
    assert tool["x"] == hexagon().tool.x
    assert section["sections"][0]["marks"][0]["place"] == [14.0, 0.0]


def test_a_library_stands_once_in_the_page_or_beside_it() -> None:
    within = page([picture(hexagon()), picture(hexagon())], library=LIBRARY)
    assert within.count(LIBRARY) == 1
    assert not any("src" in attributes for attributes in Reader(within).named("script"))
    beside = Reader(page([picture(hexagon())], script_path="plotly.min.js"))
    assert [attributes["src"] for attributes in beside.named("script") if "src" in attributes] == ["plotly.min.js"]


def test_a_page_allows_its_own_scripts_and_asks_nobody_for_anything() -> None:
    text = page([picture(hexagon())], library=LIBRARY)
    policy = re.findall(r'Content-Security-Policy" content="([^"]+)"', text)
    assert len(policy) == 1
    assert policy[0].startswith("default-src 'none'; script-src 'sha256-")
    assert "unsafe-eval" not in policy[0]
    assert "'unsafe-inline'" not in policy[0].partition("style-src")[0]
    assert not re.findall(r"https?://", text)


def test_the_same_pictures_make_the_same_page() -> None:
    made = [page([picture(hexagon(marks=[notch()]), findings=[finding("found")])], library=LIBRARY) for _ in range(2)]
    assert made[0] == made[1]


def test_all_scripts_and_styles_are_part_of_the_page_and_no_name_is_defined_twice() -> None:
    """The scripts share one scope: a second function of a name would take the place of the first."""
    folder = resources.files("polarcheck.view").joinpath("browser")
    texts = {file.name: file.read_text("utf-8") for file in folder.iterdir()}
    made = page([picture(hexagon())], library=LIBRARY)
    parts = [name for name in texts if name.endswith((".js", ".css"))]
    assert [name for name in parts if texts[name].strip() not in made] == []
    names = re.findall(r"^(?:async )?(?:function|const|let|class) +(\w+)", "\n".join(texts.values()), re.MULTILINE)
    assert [name for name in set(names) if names.count(name) > 1] == []
