"""What words and characters say of themselves: columns of the text rules."""

from __future__ import annotations

from collections import Counter

import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import report_of, said

from polarcheck.foundation.finding import Finding


def findings(program: str | bytes, *only: str, **control: int) -> list[Finding]:
    return report_of(program, changes={"control": control}, only=only or ("setup", "text")).findings


def places(program: str | bytes, rule: str, **control: int) -> list[tuple[int, int]]:
    return [(finding.line, finding.column) for finding in findings(program, rule, **control)]


@looped(
    ("block", "expected"),
    [
        ("X1. Z2. X3.", [9]),
        ("X1. X2. X3. Z1. Z2.", [5]),
        ("G1 G40 M3 M8 N5 N6", []),
        ("C1. ,C2. R1. ,R2. ,C3.", [19]),
        ("X1. X", []),
        ("X1. $ X2.", []),
        ("G65 P1 I1. J2. I3. A1. A2.", [24]),
        ("I1. J2. I3.", [9]),
        ("/X1. /Z1.", []),
    ],
)
def test_word_repeated(block: str, expected: list[int]) -> None:
    assert places(block, "word-repeated") == [(1, column) for column in expected]


@looped(
    ("block", "expected"),
    [
        ("G0 G1 X1.", ["G0 and G1"]),
        ("G01 G1 X1.", []),
        ("G0 G90 X1.", []),
        ("G40 G0 G41", ["G40 and G41"]),
        ("G0 G40 G1 G2 G42", ["G0 and G1", "G1 and G2", "G40 and G42"]),
        ("G50 S1000 G51", []),
        ("G1.234 G1", []),
        ("G54 G55", ["G54 and G55"]),
    ],
)
def test_codes_of_one_group(block: str, expected: list[str]) -> None:
    said = [finding.message for finding in findings(block, "codes-of-one-group")]
    assert len(said) == len(expected)
    for text in expected:
        first, _, second = text.partition(" and ")
        assert any(message.startswith(f"{second} and {first} ") for message in said)


FITS = ["X99999999", "X0000000001", "X99999.999", "X1.23456789"]
TOO_LONG = ["X999999999", "X999999.999", "X123456.7891", "N123456789", "X12345678901234567890123456789"]


@looped(("word", "wrong"), [(word, word in TOO_LONG) for word in [*FITS, *TOO_LONG]])
def test_digits_are_counted_in_least_increments(word: str, wrong: bool) -> None:
    assert bool(places(word, "too-many-digits", digit_limit=8)) == wrong


def test_limits_of_words_and_codes() -> None:
    program = "G1 X1. Z1. F1 S1 M3\nG1 X1. Z1. F1\nM3 M8\nM3 M8 M10 M11\n/M3 /M8 M10\n"
    assert places(program, "words-too-many", word_limit=4) == [(1, 15)]
    assert places(program, "too-many-m-codes", m_code_limit=2) == [(4, 7), (5, 9)]
    assert findings(program, "too-many-m-codes", m_code_limit=2)[0].message.startswith("4 M codes")
    assert findings(program, "words-too-many", word_limit=4)[0].message.startswith("6 words")


def test_an_unknown_code_is_reported_once() -> None:
    found = findings("G145\nG0\nG145\nG1.23\nG600 X1\nG12.1\nG112\nG\nG-1\n", "unknown-code")
    assert [(finding.line, finding.severity) for finding in found] == [
        (1, "warning"),
        (4, "error"),
        (5, "warning"),
        (9, "error"),
    ]
    assert found[0].message == (
        "G145 is no code of this control (2 times in this file); if the lathe has it, add it to "
        "control.known_codes in a file of your own (polarcheck machines new)"
    )


@looped(
    ("program", "expected"),
    [
        ("G0 X1.", []),
        ("O1\nG0 X1.", [2]),
        ("O1\nG0 X1.\nM02", []),
        ("O1\nG0 X1.\nM99\nO2\nG0 X1.\nZ1.\nO3\nM30", [6]),
        ("%\nG0 X1.\n%", [2]),
        ("O1\nG0 X1.\nGOTO 5", []),
        ("O1\nM98 P2\nM99 P#1", []),
        ("O1\nO1\nG0\nM30", []),
        ("<PART>\nG0\nX1.", [3]),
        ("O1\nM3 M130", [2]),
    ],
)
def test_program_end_missing(program: str, expected: list[int]) -> None:
    assert [line for line, _ in places(program, "program-end-missing")] == expected


def test_stray_characters_of_a_block_are_one_finding() -> None:
    program = "G1 X1. $ &\n(A (B) C1.)\nPROSE $\nX1. % Z1.\n! G0 ; ?"
    found = findings(program, "stray-character")
    assert [(finding.line, finding.message.split()[0]) for finding in found] == [(1, "$"), (4, "%"), (5, "!")]


HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X60. Z2.\n"


@pytest.mark.ci
@looped("character", ["$", "*", "!", "\uff1b", "\u00b0"], one_in=2)
@looped("blocks", [1, 3, 212])
def test_a_foreign_end_of_block_is_one_finding(character: str, blocks: int) -> None:
    program = HEAD + f"X50.{character}\n" * blocks + "#1=5\nM30\n"
    times = f" (in {blocks} blocks)" if blocks > 1 else ""
    told = [(found.line, found.rule, found.message) for found in report_of(program).findings]
    assert told == [(5, "stray-character", f"{character} is no character of a word{times}")]


@looped("character", ["$", "*"])
def test_a_foreign_end_of_block_behind_macro_statements_and_calls(character: str) -> None:
    program = "O1\nT0101\n#1=5\nG0 X#1\nIF[#1 GT 5]GOTO 9\nM98 P2\nN9 M30\nO2\nM99\n".replace("\n", f"{character}\n")
    report = report_of(program)
    assert said(report) == [(1, "stray-character")]
    assert "(in 9 blocks)" in report.findings[0].message
    assert said(report_of(program.replace(character, ""))) == []


def test_stray_characters_stay_apart() -> None:
    program = HEAD + "X50. $\nX51. &\nX52. $\nX53. ?\nX1. % Z1.\nM30\n"
    found = findings(program, "stray-character")
    assert [(one.line, one.message.split()[0], "(in 2 blocks)" in one.message) for one in found] == [
        (5, "$", True),
        (6, "&", False),
        (8, "?", False),
        (9, "%", False),
    ]


HABITS = [
    ("X5.-", "bad-number", "X5.-: a sign behind the digits"),
    ("X", "bad-number", "X: no digits after the address"),
    ("Z\u20131.", "wrong-dash", "Z\u20131. is written with a dash of print; write a minus sign"),
    (
        "X1. X2.",
        "word-repeated",
        "X is written twice in this block: X1. and X2.; the control takes the last: "
        "write one of them, or a block for each",
    ),
    (
        "X1. (A (B)",
        "comment-nested",
        "a parenthesis opens inside this comment; the control closes the comment at the first )",
    ),
    ("X1. (A", "comment-not-closed", "this comment is not closed on its line"),
    ("X1. (\u00dc)", "character-outside-iso-set", "1 character that is not in the ISO set of controls"),
    ("G0 G1 X1. F.1", "codes-of-one-group", "G1 and G0 of one modal group in a block; the control takes the last, G1"),
]


@pytest.mark.ci
@looped(("block", "rule", "message"), HABITS, one_in=2)
def test_a_habit_is_one_finding(block: str, rule: str, message: str) -> None:
    """What stands a few times is told at each place; what stands more often, once, with the number of blocks."""
    few, many = (report_of(HEAD + f"{block}\n" * count + "M30\n").findings for count in (5, 40))
    assert [(found.line, found.rule, found.message) for found in few] == [(5 + i, rule, message) for i in range(5)]
    assert [(found.line, found.rule, found.message) for found in many] == [(5, rule, f"{message} (in 40 blocks)")]
    assert many[0].values["count"] == 40


def test_different_mistakes_stay_apart() -> None:
    program = HEAD + "X5.-\n" * 6 + "Z5.-\nX5.5.\nX--5.\nX6.-\nM30\n"
    assert places(program, "bad-number") == [(5, 1), (11, 1), (12, 1), (13, 1)]


def test_foreign_characters_are_counted_by_line() -> None:
    program = "\0\0\n\0%\nO1 (\u00c4\u00d6)\nG1 \x01X1\u2013 (\u00fc)\x02\nX\u00b0\nM30\n%\n\u00c4\n"
    found = findings(program, "character-outside-iso-set")
    assert [(finding.line, finding.message.split()[0]) for finding in found] == [(1, "3"), (3, "2"), (4, "3")]


def test_lower_case_is_reported_once() -> None:
    assert places("O1 (abc)\nG0 x1.\nz2. ,r5.\nM30", "lower-case-word") == [(2, 4)]
    assert places("O1\nprose in a line\nX1. r5.\nM30", "lower-case-word") == [(3, 5)]


def test_separators_outside_a_program_are_no_text() -> None:
    assert places("=====\n(A)\nTITLE\n%\nO1\nM30\n%\n-----\n", "text-outside-program") == [(1, 1)]
    assert places("=====\n(A)\n%\nO1\nM30\n%\n-----\n", "text-outside-program") == []


BLOCKS = st.lists(
    st.tuples(st.sampled_from("GXZFMNKJTSx/?"), st.sampled_from(["0", "1", "2", "40", "41", "3.", "", "505", "99"])),
    max_size=8,
)


@pytest.mark.nightly
@given(st.lists(BLOCKS, max_size=6))
@settings(max_examples=100, deadline=None)
def test_repeated_words_are_those_that_a_count_finds(blocks: list[list[tuple[str, str]]]) -> None:
    program = "\n".join("".join(letter + number for letter, number in block) for block in blocks)
    expected = []
    for line, block in enumerate(blocks, 1):
        # A stray character stands between a letter and what is then no number of its own.
        words = [(letter, number) for letter, number in block]
        unreadable = any(letter == "?" or (not number and letter != "/") for letter, number in words)
        counts = Counter(letter.upper() for letter, _ in words if letter not in "GMN/?")
        if not unreadable and any(count > 1 for count in counts.values()):
            expected.append(line)
    assert [line for line, _ in places(program, "word-repeated")] == expected


@looped(
    ("block", "is_mark"),
    [
        ("$1X0X0", True),
        ("$2 X0X0", True),
        ("$0X0X0", False),
        ("$99X0X0", False),
        ("G0$1X0X0", False),
        ("/$1X0X0", False),
    ],
)
def test_a_block_behind_the_mark_of_a_channel_is_read_and_one_with_a_stray_character_is_not(
    block: str, is_mark: bool
) -> None:
    assert bool(places(f"O1\n{block}\nM30\n", "word-repeated")) == is_mark


PARTS = [
    "O1",
    "%",
    "\n",
    "\n",
    "(",
    ")",
    "G12.1",
    "G13.1",
    "G1",
    "X1.",
    "C2.",
    "X",
    "T0101",
    "M3",
    "M35",
    "$",
    "\0",
    "\u00c4",
]
MORE = [
    "....",
    "GOTO1",
    "#1=2",
    "G52X1.",
    "G54.1P1",
    "M99",
    "M30",
    ";",
    "/",
    ":",
    "\u2013",
    "<A>",
    "M98P1",
    "123456789012",
]


@pytest.mark.nightly
@given(
    st.one_of(
        st.binary(max_size=80), st.lists(st.sampled_from(PARTS + MORE)).map(lambda parts: "".join(parts).encode())
    )
)
@settings(max_examples=150, deadline=None)
def test_the_rules_of_text_and_setup_take_any_bytes(data: bytes) -> None:
    for finding in findings(data):
        assert finding.message
        assert finding.line >= 1
        assert finding.column >= 1
