"""`polarcheck plot` and the format html: which pages are written, where, and what can stand in them."""

from __future__ import annotations

import json
import re
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest
from test_cli import call, check, make
from test_nothing_acts import ACTING, acting
from test_pictures import GROOVE, HEXAGON

from polarcheck.commands import picturing
from polarcheck.view import plotly_script
from polarcheck.view.picture_index import page_names

#: Stands for plotly, of which five megabytes need not be written so often.
PLOTLY = "/* plotly */"
RADIUS = ("--tool", "8:radius=4")

pytestmark = pytest.mark.usefixtures("own_folder")


@pytest.fixture(autouse=True)
def _short_library(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plotly_script, "library", lambda: PLOTLY)


class Page(HTMLParser):
    """What a browser would see: tags with their attributes, the text outside of scripts, and the data."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str | None]] = []
        self.text = self.data = ""
        self._kind: str | None = ""
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += attrs
        if tag in ("script", "style"):
            self._kind = dict(attrs).get("type", tag)

    def handle_endtag(self, tag: str) -> None:
        if tag in ("script", "style"):
            self._kind = ""

    def handle_data(self, data: str) -> None:
        if self._kind == "application/json":
            self.data += data
        elif not self._kind:
            self.text += data


def page(path: str) -> Page:
    return Page(Path(path).read_text("utf-8"))


def names_in(folder: str) -> list[str]:
    return sorted(path.name for path in Path(folder).iterdir())


# ---- where pages go ----


@pytest.mark.ci
def test_a_page_holds_findings_and_pictures_whatever_is_found() -> None:
    make(a__nc=GROOVE)
    result = call("plot", "a.nc", *RADIUS, "-o", "part.html")
    assert (result.exit_code, result.output) == (0, "")
    found = page("part.html")
    assert "the cutter goes 2 mm deep into the contour of line 13" in found.text
    assert "offset 8 with R 4 mm (command line)" in found.text
    assert "left standing: R4.000 of the cutter in 4 inside corners" in found.text
    ((section,),) = [picture["sections"] for picture in json.loads(found.data)]
    assert section["marks"][0]["lines"] == [7, 13]
    (finding,) = json.loads(found.data)[0]["findings"]
    assert section["moves"]["line"][finding["move"]] == finding["line"] == 7
    assert PLOTLY in Path("part.html").read_text("utf-8")


@pytest.mark.nightly
def test_the_page_of_check_is_that_of_plot_and_fails_as_check_does() -> None:
    make(a__nc=GROOVE, b__nc=HEXAGON)
    assert call("plot", "a.nc", *RADIUS, "-o", "plot.html").exit_code == 0
    assert check("a.nc", *RADIUS, "-o", "html:check.html").exit_code == 1
    assert check("b.nc", *RADIUS, "-o", "html:b.html").exit_code == 0
    shown = check("a.nc", *RADIUS, "--format", "html")
    assert shown.exit_code == 1
    assert Path("plot.html").read_bytes() == Path("check.html").read_bytes() == shown.stdout_bytes
    assert call("plot", "a.nc", *RADIUS).stdout_bytes == shown.stdout_bytes


@pytest.mark.nightly
def test_other_formats_beside_it_know_nothing_of_pictures() -> None:
    make(a__nc=GROOVE)
    alone = check("a.nc", *RADIUS, "--format", "json").stdout
    assert check("a.nc", *RADIUS, "--format", "json", "-o", "html:a.html").stdout == alone
    assert check("a.nc", *RADIUS, "--format", "jsonl", "-o", "html:a.html").stdout.count("\n") == 3


@pytest.mark.nightly
def test_a_folder_gets_a_page_for_each_program_and_plotly_once() -> None:
    make(a__nc=GROOVE, b__nc=HEXAGON)
    Path("sub").mkdir()
    Path("sub/A.nc").write_text(HEXAGON)
    assert call("plot", ".", *RADIUS, "-o", "pages").exit_code == 0
    assert names_in("pages") == ["A.nc-2.html", "a.nc.html", "b.nc.html", "index.html", "plotly.min.js"]
    index = page("pages/index.html")
    assert [value for name, value in index.attributes if name == "href"] == ["a.nc.html", "b.nc.html", "A.nc-2.html"]
    assert "sub/A.nc" in index.text
    assert "1 error" in index.text
    assert Path("pages/plotly.min.js").read_text() == PLOTLY
    of_a = Path("pages/a.nc.html").read_text("utf-8")
    assert PLOTLY not in of_a
    assert '"plotly.min.js"' in of_a
    first = {path.name: path.read_bytes() for path in Path("pages").iterdir()}
    # Again, with as many processes as there are programs: not a byte differs, and no page is taken for a program.
    assert check(".", *RADIUS, "-j", "3", "-o", "html:pages", "--format", "concise").exit_code == 1
    assert {path.name: path.read_bytes() for path in Path("pages").iterdir()} == first


def test_one_program_may_have_a_folder_and_a_page() -> None:
    make(b__nc=HEXAGON)
    Path("there").mkdir()
    assert check("b.nc", *RADIUS, "-o", "html:there", "-o", "html:b.html").exit_code == 0
    assert names_in("there") == ["b.nc.html", "index.html", "plotly.min.js"]
    assert "picture" in Path("b.html").read_text("utf-8")


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("plot", "a.nc", "b.nc"), "a page is of one program, and these are 2: -o FOLDER takes a page for each"),
        (("plot", "a.nc", "b.nc", "-o", "x.html"), "-o FOLDER takes a page for each"),
        (("check", "a.nc", "b.nc", "--format", "html"), "these are 2: -o html:FOLDER takes a page for each"),
        (("check", ".", "-o", "html:x.html"), "-o html:FOLDER takes a page for each"),
        (("check", ".", "-o", "html:x", "-o", "html:y"), "-o html:y: pages are written to one folder only"),
        (("plot", "a.nc", "-o", "a.nc"), "-o a.nc: it is read by this run; name another file"),
        (("plot", "a.nc", "-o", "c.nc"), "this is the name of a program or of a job file"),
        (("plot", "a.nc", "-o", "none/x.html"), "none/x.html: No such file or directory"),
        (("plot", "a.nc", "-o", "none/x"), "none/x: No such file or directory"),
        (("plot", "gone.nc", "-o", "x.html"), "gone.nc: No such file or directory"),
    ],
)
def test_what_cannot_be_written_is_one_line(words: tuple[str, ...], said: str) -> None:
    make(a__nc=HEXAGON, b__nc=HEXAGON)
    result = call(*words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith("polarcheck: ")
    assert said in result.stderr
    assert result.stderr.count("\n") == 1
    assert names_in(".") == ["a.nc", "b.nc"]


def test_a_page_is_nothing_for_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=HEXAGON)
    monkeypatch.setattr(picturing, "is_terminal", lambda stream: True)
    result = call("plot", "a.nc")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == "polarcheck: a page is nothing for a terminal: -o FILE.html writes it to a file\n"


def test_without_plotly_it_is_said_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=HEXAGON)
    monkeypatch.setitem(sys.modules, "plotly", None)
    for words in (("plot", "a.nc", "-o", "x.html"), ("check", "a.nc", "-o", "html:x.html")):
        result = call(*words)
        assert result.exit_code == 2
        assert result.stderr == "polarcheck: pictures need plotly, of the extra [plot]: pip install plotly\n"
    assert check("a.nc", *RADIUS).exit_code == 0


def test_an_unreadable_program_costs_only_its_page() -> None:
    make(a__nc=HEXAGON)
    assert call("plot", "a.nc", "gone.nc", *RADIUS, "-o", "pages").exit_code == 2
    assert names_in("pages") == ["a.nc.html", "index.html", "plotly.min.js"]


def test_names_of_pages_are_safe_and_differ() -> None:
    paths = ["a/x.nc", "b/x.nc", "X.NC", "a b&<>\x1b.nc", "index", "..", "-x", "CON", "c\\d.nc", "O1234", "é" * 300]
    names = page_names(paths)
    assert names[:6] == ["x.nc.html", "x.nc-2.html", "X.NC-3.html", "a_b____.nc.html", "index-2.html", "_...html"]
    assert len({name.lower() for name in names}) == len(names)
    assert all(re.fullmatch(r"[A-Za-z0-9_][A-Za-z0-9._-]{0,110}\.html", name) for name in names)
    assert not any(re.match(r"(?i)con\.", name) for name in names)


@pytest.mark.ci
def test_a_page_is_no_program() -> None:
    Path("O1234").write_text(HEXAGON)
    assert call("plot", "O1234", *RADIUS, "-o", "O1234.html").exit_code == 0
    shown = check(".", *RADIUS, "--format", "json").stdout
    assert [file["path"] for file in json.loads(shown)["files"]] == ["O1234"]


# ---- what may stand on them ----


@pytest.mark.ci
@pytest.mark.one_in(5)
@pytest.mark.parametrize(
    "sign", ["</script><script>alert(1)</script>", "<!--<script>", "\u2028\u2029", ACTING, "\x00\x1b"]
)
def test_hostile_comments_change_nothing(sign: str) -> None:
    line = sign.replace("\n", " ").replace("\r", " ").replace(")", "]")
    Path("a.nc").write_bytes(HEXAGON.replace("G42 X30.", f"G0 ({line}) X29. G42").encode("utf-8", "surrogatepass"))
    assert call("plot", "a.nc", *RADIUS, "-o", "x.html").exit_code == 0
    text = Path("x.html").read_bytes()
    assert not acting(text)
    found = page("x.html")
    plain = HEXAGON.replace("G42 X30.", "G0 X29. G42")
    Path("b.nc").write_text(plain)
    assert call("plot", "b.nc", *RADIUS, "-o", "y.html").exit_code == 0
    # A finding of the comment itself is a row of the table, of tags that are there anyway.
    assert {*found.tags} == {*page("y.html").tags}
    assert not [name for name, _ in found.attributes if name.startswith("on")]
    block = json.loads(found.data)[0]["sections"][0]["moves"]["block"][1]
    assert block.startswith("G0 (")
    json.loads(found.data)


@pytest.mark.ci
def test_half_characters_are_spelled_out() -> None:
    Path("a.nc").write_bytes(HEXAGON.replace("F300", "F300 (\xe9\xff)").encode("latin-1"))
    assert call("plot", "a.nc", *RADIUS, "-o", "x.html").exit_code == 0
    Path("b.nc").write_bytes(("\ufeff" + HEXAGON.replace("F300", "F300 (\ud800)")).encode("utf-16-le", "surrogatepass"))
    assert call("plot", "b.nc", *RADIUS, "-o", "y.html").exit_code == 0
    assert json.loads(page("y.html").data)


def test_a_hostile_path_is_text_on_the_index() -> None:
    name = "a<script>&\x1b.nc"
    Path(name).write_text(HEXAGON)
    assert call("plot", ".", *RADIUS, "-o", "pages").exit_code == 0
    index = page("pages/index.html")
    assert "script" not in index.tags
    assert "a<script>&\\x1b.nc" in index.text
    assert not acting(Path("pages/index.html").read_bytes())


@pytest.mark.ci
def test_no_page_asks_for_anything_elsewhere() -> None:
    make(a__nc=GROOVE)
    call("plot", "a.nc", *RADIUS, "-o", "pages")
    for path in Path("pages").glob("*.html"):
        addresses = [value or "" for name, value in page(str(path)).attributes if name in ("src", "href", "action")]
        assert not [one for one in addresses if "//" in one]


@pytest.mark.ci
def test_silenced_findings_and_those_behind_block_skip_are_told() -> None:
    program = GROOVE.replace("X30.\nC20.", "X30. (POLARCHECK ALLOW OVERCUT for a good reason)\nC20.", 1)
    make(a__nc=program.replace("Z-2.", "Z-2.\n/Z-3."))
    call("plot", "a.nc", *RADIUS, "-o", "x.html")
    found = page("x.html")
    assert "silenced (allow: for a good reason)" in found.text
    assert "drawn as run with block skip off" in found.text
