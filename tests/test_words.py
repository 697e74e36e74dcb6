"""The table of words: what is read, where it stands, and what is wrong with it."""

from __future__ import annotations

import math

import numpy as np
import pytest
import words_oracle as oracle
from cases import looped
from hypothesis import example, given, settings
from hypothesis import strategies as st

from polarcheck.program.reading import words as reader
from polarcheck.program.reading.source import read_source
from polarcheck.program.reading.words import NumberFault, Spans, Text, read_words
from polarcheck.rules.text.bad_number import _FAULTS


def text_of(program: str | bytes, line_comments: str = "") -> Text:
    return read_words(read_source(program if isinstance(program, bytes) else program.encode()), line_comments)


def written(text: Text) -> list[str]:
    """The words as they stand in the text."""
    places = zip(text.words.start.tolist(), text.words.end.tolist(), strict=True)
    return [text.source.excerpt(start, end) for start, end in places]


def in_text(text: Text, spans: Spans) -> list[str]:
    return [text.source.excerpt(int(start), int(end)) for start, end in zip(spans.start, spans.end, strict=True)]


def addresses(text: Text) -> str:
    return "".join(chr(address) if address else "?" for address in text.words.address)


def faults(text: Text) -> list[str]:
    return [NumberFault(int(fault)).name for fault in text.words.fault]


# ---- words, exactly ----


def test_a_block() -> None:
    text = text_of("N10 G1X-1.75 Z.1F7.(MILL)")
    assert addresses(text) == "NGXZF"
    assert written(text) == ["N10", "G1", "X-1.75", "Z.1", "F7."]
    assert text.words.value.tolist() == [10, 1, -1.75, 0.1, 7]
    assert text.words.decimals.tolist() == [0, 0, 2, 1, 0]
    assert text.words.digits.tolist() == [2, 1, 3, 1, 1]
    assert text.words.has_point.tolist() == [False, False, True, True, True]
    assert not text.words.fault.any()


NUMBERS = st.one_of(
    st.from_regex(r"[0-9]{1,15}", fullmatch=True),
    st.from_regex(r"[0-9]{0,7}\.[0-9]{1,8}", fullmatch=True),
    st.from_regex(r"[0-9]{1,8}\.", fullmatch=True),
)
BLANKS = st.sampled_from(["", "", "", " ", "  ", "\t", "\r", "\x7f"])
BETWEEN = st.sampled_from(["", "", "", " ", "\t", "(A1)", " (X2.) ", "\r", "\xa0"])
LINE_ENDS = st.sampled_from(["", "", "", "\n", "\r\n", "\n\r\r", "\n\n", ";\n", "\n(N1)\n"])
WORDS = st.tuples(
    st.sampled_from("ABCDEFHIJKLMPQRSTUVWXYZabcxyz"),
    BLANKS,
    st.sampled_from(["", "-", "+"]),
    NUMBERS,
    BETWEEN,
    LINE_ENDS,
)


@pytest.mark.nightly
@given(st.lists(WORDS, max_size=20))
@settings(max_examples=100, deadline=None)
def test_words_are_read_back_exactly(parts: list[tuple[str, str, str, str, str, str]]) -> None:
    program, places = "O1\n", []
    for address, blank, sign, number, between, line_end in parts:
        start = len(program)
        program += address + blank + sign + number
        places.append((start, len(program)))
        program += between + line_end
    text = text_of(program)
    words = text.words
    assert written(text)[0] == "O1"
    assert list(zip(words.start.tolist()[1:], words.end.tolist()[1:], strict=True)) == places
    assert addresses(text)[1:] == "".join(part[0].upper() for part in parts)
    assert words.value.tolist()[1:] == [float(sign + number) for _, _, sign, number, _, _ in parts]
    assert words.has_point.tolist()[1:] == ["." in part[3] for part in parts]
    assert words.decimals.tolist()[1:] == [len(part[3].partition(".")[2]) for part in parts]
    assert words.digits.tolist()[1:] == [len(part[3].replace(".", "")) for part in parts]
    assert not words.fault.any()
    line = [program.count("\n", 0, start) + 1 for start, _ in places]
    assert text.blocks.line[words.block].tolist()[1:] == line


SHORT_AND_LONG = (
    "0 0000000001 99999999 12345678 123456789 1234.5678 12345.678 123456789012345 0.1 .1 1. -0 -.5 0.00000001 "
    "1.0000000 12.345678901234 .12345678 123456.7 +9.9"
)


@looped("number", SHORT_AND_LONG.split())
def test_numbers_have_the_value_that_python_gives_them(number: str) -> None:
    """Up to 15 digits; both the ways that read short and long numbers."""
    words = text_of(f"X{number}").words
    assert words.value.tolist() == [float(number)]
    assert math.copysign(1, words.value[0]) == math.copysign(1, float(number))


def test_a_number_does_not_depend_on_what_stands_before_it() -> None:
    """Eight characters are read at once: digits of the word before must not come in."""
    text = text_of("N99999999X1Y22Z333\n9X1")
    assert text.words.value.tolist()[:4] == [99999999, 1, 22, 333]
    assert math.isnan(text.words.value[4])
    assert text.words.value[5] == 1


def test_blanks_between_digits_are_skipped() -> None:
    text = text_of("G 0 X 1 0 . 5 Z- 3")
    assert text.words.value.tolist() == [0, 10.5, -3]
    assert written(text) == ["G 0", "X 1 0 . 5", "Z- 3"]


def test_lower_case_is_read() -> None:
    text = text_of("g1 x1. ,r2.")
    assert addresses(text) == "GXr"


def test_corner_words_are_addresses_of_their_own() -> None:
    text = text_of("X1.,R5. , C2.,A30. R3.")
    assert addresses(text) == "XrcaR"
    assert written(text) == ["X1.", ",R5.", ", C2.", ",A30.", "R3."]
    assert not len(text.strays)


def test_other_commas_are_strays() -> None:
    text = text_of("X1,Z2")
    assert in_text(text, text.strays) == [","]
    assert addresses(text) == "XZ"


def test_colon_is_o_at_the_head_of_a_block_only() -> None:
    text = text_of(":0012\nG1 X1:2")
    assert addresses(text) == "OGX"
    assert in_text(text, text.strays) == [":"]


def test_colon_with_other_words_is_a_sequence_number() -> None:
    """Source: ISO 6983, alignment block."""
    assert addresses(text_of(":0110 T01 M06\n:0012\nG1\n:")) == "NTMOGO"


def test_block_skip_is_a_word() -> None:
    text = text_of("/G1\n/2 G2\n/-\n")
    assert addresses(text) == "/G/G/"
    assert faults(text) == ["NONE"] * 4 + ["NO_DIGITS"]


# ---- what is wrong ----


@looped(
    ("block", "expected"),
    [
        ("X", ["NO_DIGITS"]),
        ("X Z1", ["NO_DIGITS", "NONE"]),
        ("X-", ["NO_DIGITS"]),
        ("X.", ["NO_DIGITS"]),
        ("X1.5.", ["TWO_POINTS"]),
        ("X1..5", ["TWO_POINTS"]),
        ("X--1", ["TWO_SIGNS"]),
        ("X1-", ["SIGN_AFTER_DIGITS"]),
        ("X.-1", ["SIGN_AFTER_DIGITS"]),
        ("5 X1", ["NO_ADDRESS", "NONE"]),
        ("X\u20135.", ["WRONG_DASH"]),
        ("X\u2212.5", ["WRONG_DASH"]),
        ("X123456789\u2014", ["SIGN_AFTER_DIGITS"]),
        ("X\u2014Z\u2014M35", ["NO_DIGITS", "NO_DIGITS", "NONE"]),
    ],
)
def test_faults(block: str, expected: list[str]) -> None:
    text = text_of(block)
    assert faults(text) == expected
    assert expected[0] in {*_FAULTS, "NONE"}


def test_a_wrong_dash_is_read_as_a_minus() -> None:
    words = text_of("X\u20135.25 Z\u2014123456.7891").words
    assert words.value.tolist() == [-5.25, -123456.7891]


def test_of_a_run_of_unreadable_words_only_the_first_is_reported() -> None:
    text = text_of("G X Z F\nX-- G1 Z..1 F1")
    assert [place for place, bad in zip(written(text), text.words.is_unreadable, strict=True) if bad] == [
        "G",
        "X--",
        "Z..1",
    ]


def test_strays() -> None:
    text = text_of("G1 X5$ Z\u00b02 !\n(a$b)\nM30")
    assert in_text(text, text.strays) == ["$", "\u00b0", "!"]


# ---- comments, names, remarks ----


def test_comments() -> None:
    text = text_of("(A) G1 (B (C) X1. ) (D\nZ1 (E()")
    assert in_text(text, text.comments) == ["(A)", "(B (C)", "(D", "(E()"]
    assert text.unclosed.tolist() == [False, False, True, False]
    assert text.nested.tolist() == [False, True, False, True]
    assert addresses(text) == "GXZ"
    assert in_text(text, text.strays) == [")"]


def test_comments_of_other_dialects() -> None:
    text = text_of("G1 X1 ' Z5 ( no\n(it's) Z2\nG0 (a % b) Y1 % c ( d", "'%")
    assert in_text(text, text.comments) == ["' Z5 ( no", "(it's)", "(a % b)", "% c ( d"]
    assert not text.unclosed.any()
    assert addresses(text) == "GXZGY"
    assert not len(text.tape_marks)


@looped("name", ["<A>", "<FLANGE_2.NC>", "<" + "N" * 32 + ">"])
def test_program_names(name: str) -> None:
    text = text_of(f"O{name}\nM98 {name}")
    assert in_text(text, text.names) == [name, name]
    assert addresses(text) == "OM"
    assert faults(text) == ["NONE", "NONE"]


@looped("name", ["<>", "<A", "<" + "N" * 33 + ">", "<A\nB>"])
def test_what_is_no_program_name(name: str) -> None:
    text = text_of(f"O1\nM98 {name}")
    assert not len(text.names)
    assert "<" in in_text(text, text.strays)


SEMICOLONS = [
    ("G1 X1.;", "GX", [], 2),
    ("G1 X1. ; Z2. ; F1", "GXZF", [], 3),
    ("G1 ; X#1 Y[#2+1]", "G", [], 2),
    ("G1 X1. ; go on", "GX", ["; go on"], 1),
    ("G1 X1. ;;; retract 5 mm", "GX", [";;; retract 5 mm"], 1),
    ("G1 X1. ; X2. /", "GX", ["; X2. /"], 1),
    ("; lead", "", ["; lead"], 1),
    ("G1 ; (A)", "G", ["(A)"], 2),
    ("G1 ; X11111111111111111111111111111111111!", "G", ["; X11111111111111111111111111111111111!"], 1),
]


@looped(("line", "expected", "comments", "blocks"), SEMICOLONS)
def test_semicolons(line: str, expected: str, comments: list[str], blocks: int) -> None:
    """The end of the block, or the begin of a remark where the rest does not read as blocks."""
    text = text_of(line + "\nM30")
    assert addresses(text) == expected + "M"
    assert in_text(text, text.comments) == comments
    assert len(text.blocks) == blocks + 1
    assert text.blocks.line.tolist() == [1] * blocks + [2]


# ---- macro statements ----


@looped(
    "block",
    [
        "#100=5",
        "X#1",
        "IF[#1EQ0]GOTO10",
        "N5 GOTO 10",
        "go10",
        "DO1",
        "/2 END1",
        "EN 2",
        "WHILE",
        "Z[1+2]",
        "POPEN",
        "G*2",
    ],
)
def test_macro_blocks_are_left_to_others(block: str) -> None:
    text = text_of(f"G1 X1\n{block}\nG0")
    assert text.blocks.is_macro.tolist() == [False, True, False]
    assert addresses(text) == "GXG"


@looped("block", ["GOOD DOG", "DO IT", "END", "ENDIF", "SHIFT", "E1", "G1 GOTO5", "N5 D1", "G", "D"])
def test_what_is_no_macro_block(block: str) -> None:
    assert not text_of(f"{block}\nX").blocks.is_macro.any()


# ---- what a control stores ----

PROGRAM = "O0001\nG0 X1.\nM30\n"
REGIONS = [
    (f"%\n{PROGRAM}%\n", [], "OGXM"),
    (f"some title\n%\n{PROGRAM}%\nsome notes 5\n", ["some title\n", "\nsome notes 5\n"], "OGXM"),
    (f"% LEADER\n{PROGRAM}%", [], "OGXM"),
    (f"some title\n{PROGRAM}", ["some title\n"], "OGXM"),
    (f"(TITLE)\n{PROGRAM}", [], "OGXM"),
    (f"G28 U0\n{PROGRAM}", [], "GUOGXM"),
    ("G0 X1.\nM30\n%\nsome notes\n", ["\nsome notes\n"], "GXM"),
    ("%\nG0 X1.\nM30\n%\nG1 done, see T2\n", ["\nG1 done, see T2\n"], "GXM"),
    (f"%\n{PROGRAM}%\n{PROGRAM}%\n", [], "OGXM" * 2),
    (f"%\n{PROGRAM}%\nsome notes\n%\n{PROGRAM}%\n", ["\nsome notes\n"], "OGXM" * 2),
    ("%\nnot much\n%\n", [], "NOTMUCH"),
    ("some text", [], ""),
    ("%\nG0 X1.\nM30%\nsome notes\n", ["\nsome notes\n"], "GXM"),
    ("%\nG0 X1.\nM30 %", [], "GXM"),
    ("\0\0\0\n%\nG0 X1.\nM30\n%\0\0", [], "GXM"),
    (PROGRAM + "\x1asome rest", ["\x1asome rest"], "OGXM"),
    (PROGRAM + "\x1a\0\0\n", [], "OGXM"),
    ("%\n:12\nG0 X1.\n%", [], "OGX"),
    ("some title\n<PART-1>\nG0 X1.\n%", ["some title\n"], "GX"),
]


@looped(("program", "outside", "expected"), REGIONS)
def test_outside(program: str, outside: list[str], expected: str) -> None:
    """Source: B-63524EN/01 p. 649."""
    text = text_of(program)
    assert [part.lstrip("%") for part in in_text(text, text.outside)] == outside
    assert addresses(text) == expected
    assert not len(text.strays)


def test_comments_outside_are_no_comments() -> None:
    text = text_of(f"a (b (c\n%\n{PROGRAM}(D)\n%\nx ; y (z\n")
    assert in_text(text, text.comments) == ["(D)"]
    assert not text.unclosed.any()


def test_tape_marks() -> None:
    text = text_of("%\nO1\nX1 (50%)\nM30 %\n")
    assert text.tape_marks.tolist() == [0, 18]
    assert not len(text.strays)


def test_percent_inside_a_block_ends_what_is_read_of_it() -> None:
    text = text_of("O1\nG1 X1 % Z2 $\nM30\n")
    assert addresses(text) == "OGXM"
    assert in_text(text, text.strays) == ["%"]


@pytest.mark.nightly
def test_a_file_of_many_tape_marks_is_one_program() -> None:
    text = text_of("%\nsome text\n" * 10_001)
    assert not len(text.outside)
    assert len(text.tape_marks) == 10_001


def test_lines_of_points() -> None:
    text = text_of("G1\n.....\n . . .\n..\nX...\nG0")
    assert in_text(text, text.dots) == [".....", ". . ."]
    assert faults(text) == ["NONE", "NO_ADDRESS", "NO_DIGITS", "NONE"]


def test_foreign_characters() -> None:
    text = text_of(b"\0\0%\nG1\tX1.\r\n(D\xfcsen\x07)\nM30\n\x7f%\n")
    assert in_text(text, text.foreign) == ["\0\0", "\xfc", "\x07", "\x7f"]


# ---- pieces ----


@pytest.mark.parametrize("piece", [1, 2, 3, 7])
def test_reading_in_pieces_changes_nothing(piece: int, monkeypatch: pytest.MonkeyPatch) -> None:
    program = "O1\nN1 G1X-1.75,R5. Z.1F7.\n\n5 X1;Y2;\nGOTO 10\n.....\n:5\nX123456789.5(A)Z-2 N5 /2 G1 $,C1.\nM30"
    program += "\nA1.C2R3,R4A5 R,C6\nAACCRR"
    whole = text_of(program)
    monkeypatch.setattr(reader, "_PIECE", piece)
    parts = text_of(program)
    for name in ("address", "value", "decimals", "digits", "has_point", "fault", "block", "start", "end"):
        np.testing.assert_array_equal(getattr(whole.words, name), getattr(parts.words, name), name)
    for name in ("start", "end", "line", "is_macro"):
        np.testing.assert_array_equal(getattr(whole.blocks, name), getattr(parts.blocks, name), name)
    assert in_text(whole, whole.strays) == in_text(parts, parts.strays) == ["$"]
    assert in_text(whole, whole.dots) == in_text(parts, parts.dots) == ["....."]


# ---- any text ----

LETTERS = [*"XyGOoIN/DET"]
SIGNS = [*" \t\n\n;().-+\u2013\u2212,:$\u00b0\0%", "\r\n"]
PARTS = ["1", "20", "1234567", "00012345678", ",R", "#", "[", "=", "...", "GOTO", "GO", "END1", "DO", "X1.", "Z-2.5"]
LONG = ["F123456.789", "G12.1", "N5 ", ":5"]
GARBAGE = st.lists(st.sampled_from([*LETTERS, *SIGNS, *PARTS, *LONG]), max_size=40)


def as_meant(program: str, text: Text) -> str:
    """The program with the digits that its letters O and I stand for, without text in no parentheses."""
    shown = list(program)
    for start, end in zip(text.prose.start.tolist(), text.prose.end.tolist(), strict=True):
        shown[start:end] = " " * (end - start)
    for start, end in zip(text.comments.start.tolist(), text.comments.end.tolist(), strict=True):
        shown[start:end] = program[start:end]
    for at in text.letters.tolist():
        shown[at] = {"O": "0", "I": "1"}[shown[at].upper()]
    return "".join(shown)


@pytest.mark.nightly
@given(GARBAGE)
@example(["X1.", ";", "X", "Z-2.5"])
@settings(max_examples=300, deadline=None)
def test_any_text_reads_as_one_word_after_another(parts: list[str]) -> None:
    program = "O1\n" + "".join(parts).replace("%", "!")
    text = text_of(program)
    plain = oracle.read(as_meant(program, text))
    words = text.words
    assert addresses(text) == "".join(word.address or "?" for word in plain.words)
    assert faults(text) == [word.fault for word in plain.words]
    assert words.start.tolist() == [word.start for word in plain.words]
    assert words.end.tolist() == [word.last + 1 for word in plain.words]
    assert text.blocks.line[words.block].tolist() == [word.line for word in plain.words]
    for index, word in enumerate(plain.words):
        if word.address:
            assert (words.digits[index], words.decimals[index]) == (word.digits, word.decimals), word
            assert words.has_point[index] == ("." in word.parts)
        if word.digits <= 15:
            assert repr(float(words.value[index])) == repr(word.value), word
    assert text.strays.start.tolist() == plain.strays
    places = zip(text.comments.start.tolist(), text.comments.end.tolist(), text.unclosed, text.nested, strict=True)
    assert sorted(places) == sorted(plain.comments)
    assert list(zip(text.dots.start.tolist(), text.dots.end.tolist(), strict=True)) == plain.dots
    assert not len(text.outside)


@pytest.mark.nightly
@given(
    st.one_of(st.binary(max_size=120), GARBAGE.map(lambda parts: "".join(parts).encode())),
    st.sampled_from(["", "%;", "'"]),
)
@settings(max_examples=150, deadline=None)
def test_any_bytes_are_read(data: bytes, line_comments: str) -> None:
    text = text_of(data, line_comments)
    size, blocks = len(text.source.code), len(text.blocks)
    assert np.all(text.blocks.start <= text.blocks.end)
    assert np.all(np.diff(text.blocks.start) > 0)
    for spans in (text.words, text.comments, text.names, text.strays, text.foreign, text.dots, text.outside):
        assert np.all((spans.start >= 0) & (spans.start < spans.end) & (spans.end <= size))
        assert np.all((spans.block >= 0) & (spans.block < blocks))
        assert np.all(text.blocks.start[spans.block] <= spans.start)
    assert np.all(np.diff(text.words.start) > 0)
    assert len(text.unclosed) == len(text.nested) == len(text.comments)
