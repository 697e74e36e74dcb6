"""Bytes to text: encodings, lines, and the way back."""

from __future__ import annotations

import codecs

import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from polarcheck.errors import SourceError, UsageError

from polarcheck.program.reading.source import DASH, OTHER, read_source
from polarcheck.program.reading.words import read_words

PROGRAM = "O0001 (D\u00fcse \u2013 \u00d860)\nG0 X60.\nM30\n"
ENCODED = [
    (PROGRAM.encode(), "utf-8", b""),
    (codecs.BOM_UTF8 + PROGRAM.encode(), "utf-8", codecs.BOM_UTF8),
    (codecs.BOM_UTF16_LE + PROGRAM.encode("utf-16-le"), "utf-16-le", codecs.BOM_UTF16_LE),
    (codecs.BOM_UTF16_BE + PROGRAM.encode("utf-16-be"), "utf-16-be", codecs.BOM_UTF16_BE),
]


@looped(("data", "encoding", "bom"), ENCODED, ids=["utf-8", "bom", "utf-16-le", "utf-16-be"])
def test_encodings_are_recognised(data: bytes, encoding: str, bom: bytes) -> None:
    source = read_source(data)
    assert (source.encoding, source.bom) == (encoding, bom)
    assert source.text == PROGRAM
    assert len(source.code) == len(PROGRAM)
    assert source.encode(source.text) == data
    assert [source.line_text(line) for line in (1, 2, 3)] == PROGRAM.splitlines()


@looped("data", [item[0] for item in ENCODED], ids=["utf-8", "bom", "utf-16-le", "utf-16-be"])
def test_places_are_the_same_in_every_encoding(data: bytes) -> None:
    found = read_words(read_source(data))
    assert (
        found.source.excerpt(int(found.comments.start[0]), int(found.comments.end[0])) == "(D\u00fcse \u2013 \u00d860)"
    )
    assert found.words.value.tolist() == [1.0, 0.0, 60.0, 30.0]
    assert found.blocks.line[found.words.block].tolist() == [1, 2, 2, 3]
    x = found.words.address.tolist().index(ord("X"))
    assert found.source.excerpt(int(found.words.start[x]), int(found.words.end[x])) == "X60."


def test_plain_text_is_ascii_and_other_bytes_are_latin_1() -> None:
    assert read_source(b"G0 X1.").encoding == "ascii"
    source = read_source("G0 X1. (D\u00fcse)".encode("latin-1"))
    assert source.encoding == "latin-1"
    assert source.text == "G0 X1. (D\u00fcse)"


def test_a_mark_that_does_not_fit_is_no_mark() -> None:
    """Three bytes that only look like the beginning of UTF-16."""
    source = read_source(codecs.BOM_UTF16_LE + b"G")
    assert (source.encoding, source.bom) == ("latin-1", b"")


def test_the_encoding_asked_for_is_taken() -> None:
    data = "G0 X1. (\u0414\u0420)".encode("cp1251")
    assert read_source(data, encoding="cp1251").text == "G0 X1. (\u0414\u0420)"
    assert read_source(data).encoding == "latin-1"


def test_a_wrong_encoding_names_the_byte() -> None:
    with pytest.raises(SourceError, match=r"^x\.nc: byte 3 is not utf-8$"):
        read_source(b"G0 \xff", "x.nc", "utf-8")
    with pytest.raises(UsageError, match="unknown encoding 'utf-9'"):
        read_source(b"G0", "x.nc", "utf-9")


def test_codes_of_characters() -> None:
    """Dashes that look like a minus sign share one code, and what has no code of its own another."""
    source = read_source("\u2013\u2014\u2212-\u00d8\u0414".encode())
    assert source.code.tolist() == [DASH, DASH, DASH, ord("-"), 0xD8, OTHER]
    assert read_source(b"X\x96\x97\xff").code.tolist() == [ord("X"), DASH, DASH, 0xFF]


@given(st.binary(max_size=200))
@settings(deadline=None)
def test_every_byte_survives(data: bytes) -> None:
    source = read_source(data)
    assert source.encode(source.text) == data
    assert len(source.code) == len(source.text)
    assert source.excerpt(0, len(source.code)) == source.text


LINE_ENDS = ["\n", "\r\n", "\n\r\r", "\r\r\n", "\r"]


@looped("line_end", LINE_ENDS, ids=repr)
def test_line_numbers_do_not_depend_on_the_line_end(line_end: str) -> None:
    """Source: B-63524EN/01 p. 649 (LF CR CR); Windows; broken transfers."""
    lines = ["%", "O0001", "", "G0 X60. (A)", "M30", "%"]
    source = read_source((line_end.join(lines) + line_end).encode())
    found = read_words(source)
    assert found.blocks.line[found.words.block].tolist() == [2, 4, 4, 5]
    assert [source.line_text(number).strip("\r") for number in range(1, 7)] == lines
    assert [source.line_of(int(start)) for start in found.words.start] == [2, 4, 4, 5]


@pytest.mark.nightly
@given(st.lists(st.sampled_from(["G1", "X1.", "", "(A)", ";"]), max_size=12), st.sampled_from(LINE_ENDS))
@settings(deadline=None)
def test_a_position_lies_on_its_line(lines: list[str], line_end: str) -> None:
    source = read_source(line_end.join(lines).encode())
    assert source.line_starts[0] == 0
    for number, start in enumerate(source.line_starts.tolist(), 1):
        assert source.line_of(start) == number
        assert number == 1 or source.line_of(start - 1) == number - 1
    assert np.all(np.diff(source.line_starts) > 0)


def test_an_empty_file_has_one_line() -> None:
    source = read_source(b"")
    assert source.line_starts.tolist() == [0]
    assert source.line_text(1) == ""
