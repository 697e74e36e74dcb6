"""`plot --png` and `--svg`: the pictures for documents."""

from __future__ import annotations

import importlib.util
import re
import struct
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import msgspec
import pytest
from pictures_by_hand import finding as by_hand
from pictures_by_hand import hexagon, notch, picture
from test_cli import call, make
from test_pictures import GROOVE, HEXAGON
from test_plot import RADIUS, names_in

from polarcheck.view.picture_data import DrawnPart, FindingPicture, Mark
from polarcheck.view.stills import still as stills
from polarcheck.view.stills.numbering import entries, labels
from polarcheck.view.stills.palette import ABOVE, PLAIN, SHADES, coloring, round_bounds
from polarcheck.view.stills.still import printable, still, wrapped

pytestmark = [pytest.mark.ci, pytest.mark.usefixtures("own_folder")]

SVG = "{http://www.w3.org/2000/svg}"
#: Two sections, and a block outside of them that is wrong.
TWO = HEXAGON.replace("M30\n", "") + HEXAGON.replace("G12.1", "G777\nG12.1")


def svg(path: str) -> tuple[ElementTree.Element, str]:
    """The picture as XML, and all text on it, which matplotlib leaves as comments beside its outlines."""
    return read(Path(path).read_bytes())


def read(data: bytes) -> tuple[ElementTree.Element, str]:
    parser = ElementTree.XMLParser(target=ElementTree.TreeBuilder(insert_comments=True))  # noqa: S314
    root = ElementTree.fromstring(data, parser)  # noqa: S314
    return root, "\n".join(node.text or "" for node in root.iter() if not isinstance(node.tag, str))


@pytest.mark.nightly
def test_a_picture_has_the_width_of_a_page_and_says_what_is_wrong() -> None:
    make(a__nc=GROOVE)
    result = call("plot", "a.nc", *RADIUS, "--png", "a.png", "--svg", "a.svg")
    assert (result.exit_code, result.output) == (0, "")
    data = Path("a.png").read_bytes()
    assert data.startswith(b"\x89PNG")
    assert struct.unpack(">I", data[16:20])[0] == pytest.approx(160 / 25.4 * 200, abs=1)
    root, text = svg("a.svg")
    assert float(root.get("width", "").removesuffix("pt")) == pytest.approx(160 / 25.4 * 72, abs=0.1)
    assert root.findtext(f"{SVG}title") == "polarcheck: a.nc"
    assert "fail: 1 error, 1 polar section" in text
    assert "FANUC" in text
    assert "error, line 7: the cutter goes 2 mm deep into the contour of line 13" in text
    assert "R 4.000 mm (command line)" in text
    assert {"X [mm, diameter]", "C [mm]", "cut too much", "finished part"} <= set(map(str.strip, text.splitlines()))
    # The same program gives the same bytes, and --output takes the format from the ending.
    assert call("plot", "a.nc", *RADIUS, "-o", "b.PNG").exit_code == 0
    assert call("plot", "a.nc", *RADIUS, "-o", "b.svg").exit_code == 0
    assert (Path("b.PNG").read_bytes(), Path("b.svg").read_bytes()) == (data, Path("a.svg").read_bytes())


@pytest.mark.nightly
def test_sections_stand_one_below_the_other_and_can_be_chosen() -> None:
    make(a__nc=TWO)
    assert call("plot", "a.nc", *RADIUS, "--svg", "a.svg").exit_code == 0
    assert call("plot", "a.nc", *RADIUS, "--svg", "b.svg", "--section", "2").exit_code == 0
    both, second = svg("a.svg")[1], svg("b.svg")[1]
    assert "1. lines 3 to 14" in both
    assert "2. lines 18 to 29" in both
    assert "1. lines" not in second
    assert "2. lines 18 to 29" in second
    assert "Drawn: section 2 of 2." in second
    assert "line 17: G777 is no code of this control" in both


def test_a_folder_gets_a_picture_of_each_program_beside_pages() -> None:
    make(a__nc=HEXAGON, b__nc="G0 X10.\nM30\n")
    assert call("plot", ".", *RADIUS, "--svg", "drawn").exit_code == 0
    assert names_in("drawn") == ["a.nc.svg", "b.nc.svg"]
    assert "No polar section is drawn." in svg("drawn/b.nc.svg")[1]


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("a.nc", "b.nc", "--png", "x.png"), "--png: a picture is of one program, and these are 2: a folder takes one"),
        (("a.nc", "--png", "x.svg"), "--png x.svg: expected a name that ends in .png, or a folder"),
        (("a.nc", "--svg", "-"), "--svg -: expected a name that ends in .svg, or a folder"),
        (("a.nc", "--svg", "a.nc"), "--svg a.nc: it is read by this run; name another file"),
        (("a.nc", "--svg", "x.svg", "-o", "x.svg"), "--svg x.svg: two reports would be written to this file"),
        (("a.nc", "--svg", "none/x.svg"), "none/x.svg: No such file or directory"),
        (("a.nc", "--svg", "x.svg", "--section", "3"), "--section 3: a.nc has 1 polar section"),
        (("a.nc", "b.nc", "--svg", "x", "--section", "1"), "--section: it is of one program, and these are 2"),
        (("a.nc", "-o", "x.html", "--section", "1"), "--section: it chooses what --png and --svg draw; give one"),
    ],
)
def test_what_cannot_be_drawn_is_one_line(words: tuple[str, ...], said: str) -> None:
    make(a__nc=HEXAGON, b__nc=HEXAGON)
    result = call("plot", *words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.startswith(f"polarcheck: {said}")
    assert result.stderr.count("\n") == 1
    assert not [name for name in names_in(".") if name.endswith(("svg", "png", "html"))]


def test_without_matplotlib_one_line_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=HEXAGON)
    known: Any = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: None if name == "matplotlib" else known(name))
    result = call("plot", "a.nc", "--png", "a.png")
    assert result.exit_code == 2
    assert result.stderr == "polarcheck: --png and --svg need matplotlib, of the extra [plot]: pip install matplotlib\n"


def test_hostile_names_and_words_are_text() -> None:
    name = "a--><script>$x^$ \x1b.nc"
    Path(name).write_text(HEXAGON.replace("F200", "F200 $\\frac{1}$ <b>&amp; --> Q\u65e5", 1), "utf-8")
    assert call("plot", name, *RADIUS, "--svg", "x.svg", "--png", "x.png").exit_code == 0
    root, text = svg("x.svg")
    assert not [node for node in root.iter() if isinstance(node.tag, str) and "script" in node.tag.lower()]
    assert "$x^$" in text
    assert "\x1b" not in text


def colors(root: ElementTree.Element) -> set[str]:
    """The colors of all lines."""
    return {match for node in root.iter() for match in re.findall("stroke: (#[0-9a-f]{6})", node.get("style", ""))}


@pytest.mark.nightly
def test_all_that_is_known_of_a_section_is_drawn() -> None:
    moves = msgspec.structs.replace(
        hexagon().moves,
        share=[0.005, 0.02, 0.05, 0.2, 0.5, 1.01],
        jump=[True, *[False] * 5],
        role=[*["cut"] * 5, "corner"],
    )
    drawing = DrawnPart(
        title="part.dxf",
        z=None,
        agrees=True,
        rings=[[(15.0, 0.0), (0.0, 15.0), (-15.0, 0.0)]],
        lines=[[(-15.0, 0.0), (15.0, 0.0)]],
    )
    left = Mark(kind="left", text="a rib", lines=[2], place=(0.0, 16.0), depth=0.1, rings=[[(0.0, 15.0), (1.0, 16.0)]])
    whole = hexagon(moves=moves, drawing=[drawing], marks=[notch(), left], channel="2", units="inch", scale=25.4)
    found = [
        by_hand("too fast", places=[(16.0, 0.0)], span=1.0),
        by_hand("too fast as well", places=[(-16.0, 0.0)], span=1.0),
        by_hand("too deep", line=3, rule="overcut", places=[(14.0, 0.0)], span=0.5),
        by_hand("elsewhere", line=9, section=None, move=None),
    ]
    head = [("machine", "a lathe"), ("not drawn", "the rest")]
    root, text = read(still(picture(whole, findings=found, head=head, not_evaluated=["no feed"]), "svg"))
    for words in (
        "Lines 1 to 6, offset 1, channel 2", "cutter R 0.1575 inch (command line)", "stock 2.3622 inch across",
        "limit of C 500 deg/min", "X [inch, diameter]", "part asked for", "bar", "C rate, % of its limit",
        "error, line 3: too deep", "left standing, a rib", "Outside the polar sections", "error, line 9: elsewhere",
        "not evaluated: no feed", "not drawn: the rest",
    ):  # fmt: skip
        assert words in text
    # The first of a rule and another one are shown from near by.
    assert re.findall(r"(\d), enlarged", text) == ["1", "3", "4"]
    assert {ABOVE, SHADES[1], SHADES[2], SHADES[4], SHADES[6]} <= colors(root)
    assert SHADES[0] not in re.findall(
        "stroke: (#[0-9a-f]{6})[^}]*?stroke-width: 1.6", ElementTree.tostring(root, "unicode")
    )


def test_colors_are_those_of_the_page() -> None:
    """At a bound a value is not above it; without a limit the classes are round, or each value has its own."""
    whole = hexagon()
    share = [0.01, 0.0100011, 0.05, 1.0, 1.01, None]
    roles: Any = ["cut", "cut", "cut", "cut", "positioning", "cut"]
    shown = coloring(
        msgspec.structs.replace(whole, moves=msgspec.structs.replace(whole.moves, share=share, role=roles))
    )
    assert list(shown.moves) == [SHADES[0], SHADES[1], SHADES[2], SHADES[7], PLAIN, PLAIN]
    assert (shown.title, shown.has_limit) == ("C rate, % of its limit", True)
    free = msgspec.structs.replace(whole.moves, share=[None] * 6, c_feed=[10.0, 10.0, 20.0, 30.0, None, 0.0])
    shown = coloring(msgspec.structs.replace(whole, moves=free))
    assert (list(shown.bounds), shown.title) == ([0.0, 10.0, 20.0, 30.0], "C rate, deg/min")
    assert list(shown.moves) == [SHADES[2], SHADES[2], SHADES[5], SHADES[7], PLAIN, SHADES[0]]
    assert round_bounds([float(number) for number in range(3, 500)]) == [5, 10, 20, 50, 100, 200, 499]
    assert coloring(msgspec.structs.replace(whole, moves=msgspec.structs.replace(free, c_feed=[7.0] * 6))).shades == [
        SHADES[5]
    ]


def test_without_r_of_the_cutter_the_picture_says_what_to_give() -> None:
    moves = msgspec.structs.replace(hexagon().moves, role=["unknown"] * 6, share=[None] * 6)
    bare = {"radius": None, "stock": None, "keep_out": None, "c_limit": None, "time": None, "parts": [], "bar": []}
    unknown = hexagon(moves=moves, needs_radius="give --tool 8:radius=5", makes=["hexagon"], **bare)
    _, text = read(still(picture(unknown), "svg"))
    assert "give - -tool 8:radius=5" in text  # as a comment of XML can hold it
    assert "path, cutter not known" in text
    assert "% of its limit" not in text
    empty = msgspec.structs.replace(unknown.tool, x=[], c=[], move=[])
    assert b"start" not in still(picture(hexagon(tool=empty, programmed=empty)), "svg")


def test_of_very_many_sections_the_first_are_drawn(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stills, "MOST", 1)
    make(a__nc=TWO)
    result = call("plot", "a.nc", *RADIUS, "--svg", "a.svg")
    assert result.exit_code == 0
    assert result.stderr == "polarcheck: warning: a.nc: the picture has 1 of 2 sections; --section N chooses others\n"
    assert "Drawn: section 1 of 2." in svg("a.svg")[1]


def finding(line: int, severity: str = "error", **more: Any) -> FindingPicture:
    fixed = {"rule": "r", "message": "wrong", "block": "", "why": "", "alarm": "", "fix": "", "section": 0, "move": 0}
    return FindingPicture(**{**fixed, "silenced": "", "line": line, "severity": severity, **more})  # type: ignore[arg-type]


def test_the_gravest_findings_come_first_and_near_ones_share_a_label() -> None:
    from types import SimpleNamespace

    section: Any = SimpleNamespace(marks=[])
    findings = [
        finding(9, "warning", places=[(1.0, 1.0), (20.0, 0.0)]),
        finding(30, places=[(1.1, 1.0)], also=[40, 50]),
        finding(20, places=[(1.0, 1.1)]),
        finding(5, silenced="allow"),
    ]
    listed, more = entries(section, findings)
    assert [(entry.number, entry.text[:8]) for entry in listed] == [(1, "line 20:"), (2, "line 30:"), (3, "line 9: ")]
    assert listed[1].text == "line 30: wrong (also in lines 40, 50)"
    assert more == 0
    assert [(text, kind) for _, text, kind in labels(listed, 4.0)] == [("1-3", "error"), ("3", "warning")]
    listed, more = entries(section, [finding(line) for line in range(100)])
    assert (len(listed), more) == (15, 85)


def test_text_is_broken_within_its_width() -> None:
    lines = wrapped(f"{'x' * 400} and more", 50, 8, most=4)
    assert len(lines) == 4
    assert lines[-1].endswith(" ...")
    assert wrapped("one two three", 500, 8) == ["one two three"]
    assert wrapped("one two three", 12, 8) == ["one two", "three"]
    assert printable("a\tb\x1b\u65e5") == "a b\\x1b\ufffd"
