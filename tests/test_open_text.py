"""The places of an open buffer: an editor counts lines and characters in its way, reports and controls in theirs."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lsprotocol import types

from polarcheck.editor.open_text import Change, OpenText, path_of
from polarcheck.program.reading import source

UNITS = ("utf-8", "utf-16", "utf-32")
#: All that ends a line for somebody, half a pair, a character of two units, one of three bytes.
PIECES = (
    "G1 X4.",
    "\n",
    "\r\n",
    "\r",
    "\n\r\r",
    "\u2028",
    "\x85",
    "\x0b",
    "\x0c",
    "\x1c",
    "\ud83d",
    "\U0001f600",
    "\u20ac",
    "(\u00fc)",
    "\ufeff",
)
texts = st.lists(st.sampled_from(PIECES), max_size=12).map("".join)


def lines_of(text: str) -> list[str]:
    """The lines as the protocol has them, by another way than the module's."""
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


@pytest.mark.nightly
@given(texts, st.sampled_from(UNITS))
def test_a_place_of_the_editor_leads_there_and_back(text: str, units: str) -> None:
    opened = OpenText(text, units)
    for offset in range(len(opened.text) + 1):
        position = opened.position(offset)
        if opened.text[offset - 1 : offset + 1] != "\r\n":  # between them there is no place
            assert opened.offset(position) == offset
        assert position.line < len(lines_of(opened.text))


@pytest.mark.nightly
@given(texts, st.sampled_from(UNITS))
def test_places_are_lines_and_units(text: str, units: str) -> None:
    opened = OpenText(text, units)
    width = {"utf-8": 1, "utf-16": 2, "utf-32": 4}[units]
    encoding = {"utf-8": "utf-8", "utf-16": "utf-16-le", "utf-32": "utf-32-le"}[units]
    for number, line in enumerate(lines_of(opened.text)):
        for column in range(len(line) + 1):
            position = types.Position(number, len(line[:column].encode(encoding)) // width)
            assert opened.position(opened.offset(position)) == position
        beyond = opened.offset(types.Position(number, 1000))
        assert opened.position(beyond) == types.Position(number, len(line.encode(encoding)) // width)
    assert opened.offset(types.Position(1000, 0)) == len(opened.text)


@pytest.mark.nightly
@given(texts)
def test_lines_of_reports_are_those_of_the_reader(text: str) -> None:
    opened = OpenText(text)
    read = source.read_source(opened.data)
    assert len(read.text) == len(opened.text) - opened.text.startswith("\ufeff")
    for line in range(1, len(read.line_starts) + 1):
        written = read.line_text(line)
        assert opened.line_text(line) == written
        for column in range(1, len(written) + 2):
            place = opened.range_of(line, column, line, column).start
            assert opened.line_of(place) == line
            assert opened.offset_of(line, column) == opened.place_of(int(read.line_starts[line - 1]) + column - 1)
        assert opened.character_of(opened.line_range(line).start) == int(read.line_starts[line - 1])


@pytest.mark.nightly
@given(texts, texts, st.tuples(st.integers(0, 99), st.integers(0, 99)), st.sampled_from(UNITS))
def test_changes_make_the_text_that_the_editor_has(before: str, typed: str, at: tuple[int, int], units: str) -> None:
    opened = OpenText(before, units)
    first, last = sorted(min(place, len(opened.text)) for place in at)
    place = opened.range(first, last)
    first, last = opened.offset(place.start), opened.offset(place.end)
    changes: list[Change] = [types.TextDocumentContentChangePartial(place, typed)]
    assert opened.changed(changes).text == opened.text[:first] + OpenText(typed).text + opened.text[last:]
    whole: Change = types.TextDocumentContentChangeWholeDocument(typed)
    assert opened.changed([*changes, whole]).text == OpenText(typed).text


def test_places_that_are_not_there_are_the_nearest() -> None:
    opened = OpenText("G0\nX1.\n")
    assert opened.offset_of(9, 9) == len(opened.text)
    assert opened.offset_of(0, 0) == 0
    assert opened.line_range(99) == types.Range(types.Position(2, 0), types.Position(2, 0))
    assert opened.range_of(1, 90, 1, 95) == types.Range(types.Position(0, 2), types.Position(0, 2))
    assert OpenText("").line_range(1) == types.Range(types.Position(0, 0), types.Position(0, 0))


@pytest.mark.skipif(sys.platform == "win32", reason="paths of POSIX")
@pytest.mark.parametrize(
    ("uri", "path"),
    [
        ("file:///a/O1.NC", "/a/O1.NC"),
        ("file:///a/b%20c/%C3%BC%23%3F%3B.nc", "/a/b c/\u00fc#?;.nc"),
        ("file:///a;b/c?d#e.nc", "/a;b/c?d#e.nc"),
        ("file://localhost/a.nc", "/a.nc"),
        ("file://server/share/a.nc", "//server/share/a.nc"),
        ("file:/a.nc", "/a.nc"),
        ("file:///a%FF.nc", "/a\udcff.nc"),
        ("untitled:Untitled-1", None),
        ("file:///a%00b", None),
        ("file:", None),
        ("a.nc", None),
        ("", None),
    ],
)
def test_documents_are_files_or_none(uri: str, path: str | None) -> None:
    assert path_of(uri) == (None if path is None else Path(path))


@pytest.mark.ci
@pytest.mark.skipif(sys.platform == "win32", reason="paths of POSIX")
@given(st.text(st.characters(exclude_characters="\0"), min_size=1))
def test_a_path_leads_to_its_document_and_back(name: str) -> None:
    try:
        path = Path("/", name.encode("utf-8", "surrogateescape").decode("utf-8", "surrogateescape"))
    except UnicodeEncodeError:  # half a pair is in no name
        return
    assert path_of(path.as_uri()) == path
