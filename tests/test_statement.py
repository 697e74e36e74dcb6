"""Macro statements: their parts and places, their faults, and bounds against hostile text."""

from __future__ import annotations

import sys
from typing import Any

import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from macro_values import assign_arguments, called_program, read_statement, variables

from polarcheck.program.execution.expression import Fault, decide
from polarcheck.program.execution.macro import assign, word_value
from polarcheck.program.execution.statement import Kind, Number, Statement

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)


def parts(block: str, statement: Statement) -> dict[str, Any]:
    """The parts of a statement, each as the characters that it points at."""
    found: dict[str, Any] = {}
    for name in ("target", "value", "condition", "jump", "loop"):
        part = getattr(statement, name)
        if part is not None:
            found[name] = block[part.start : part.end]
    if statement.words:
        found["words"] = [block[word.start : word.end] for word in statement.words]
    if statement.then:
        found["then"] = (statement.then.kind, parts(block, statement.then))
    return found


@looped(
    ("block", "kind", "expected"),
    [
        ("#1 = 5", Kind.ASSIGN, {"target": "#1", "value": "5"}),
        ("#[#1+2]=#3*SIN[30]", Kind.ASSIGN, {"target": "#[#1+2]", "value": "#3*SIN[30]"}),
        ("[#_NAME]=5", Kind.ASSIGN, {"value": "5"}),
        ("GOTO 10", Kind.GOTO, {"jump": "10"}),
        ("GO#1", Kind.GOTO, {"jump": "#1"}),
        ("IF[#_TIME EQ 2]GOTO5", Kind.IF_GOTO, {"condition": "[#_TIME EQ 2]", "jump": "5"}),
        ("GOTO[#1+10]", Kind.GOTO, {"jump": "[#1+10]"}),
        ("IF[#1 EQ 0]GOTO10", Kind.IF_GOTO, {"condition": "[#1 EQ 0]", "jump": "10"}),
        ("if [#1 ge 0] go 10", Kind.IF_GOTO, {"condition": "[#1 ge 0]", "jump": "10"}),
        (
            "IF[[#6EQ0]AND[#2EQ1]]THEN#8=#2",
            Kind.IF_THEN,
            {"condition": "[[#6EQ0]AND[#2EQ1]]", "then": (Kind.ASSIGN, {"target": "#8", "value": "#2"})},
        ),
        (
            "IF[#1EQ0]TH#2=1",
            Kind.IF_THEN,
            {"condition": "[#1EQ0]", "then": (Kind.ASSIGN, {"target": "#2", "value": "1"})},
        ),
        (
            "IF[#1EQ0]THEN G65 P9 A1.",
            Kind.IF_THEN,
            {"condition": "[#1EQ0]", "then": (Kind.CALL, {"words": ["G65", "P9", "A1."]})},
        ),
        ("WHILE[#1 LT 5]DO 2", Kind.WHILE_DO, {"condition": "[#1 LT 5]", "loop": "DO 2"}),
        ("WH[#1 LT 5]DO2", Kind.WHILE_DO, {"condition": "[#1 LT 5]", "loop": "DO2"}),
        ("DO 3", Kind.DO, {"loop": "DO 3"}),
        ("END1", Kind.END, {"loop": "END1"}),
        ("EN1", Kind.END, {"loop": "EN1"}),
        ("G65 P9810 X#1 F100.", Kind.CALL, {"words": ["G65", "P9810", "X#1", "F100."]}),
        ("G66.1 P1 A5.", Kind.CALL, {"words": ["G66.1", "P1", "A5."]}),
        ("G67", Kind.CALL, {"words": ["G67"]}),
        ("X5. M098 P1000", Kind.CALL, {"words": ["X5.", "M098", "P1000"]}),
        ("M98 <Sub-1> L2", Kind.CALL, {"words": ["M98", "<Sub-1>", "L2"]}),
        ("M99 P#1", Kind.CALL, {"words": ["M99", "P#1"]}),
        ("M198 P1", Kind.CALL, {"words": ["M198", "P1"]}),
        ("DPRNT[X#1[53]*]", Kind.OUTPUT, {}),
        ("POPEN", Kind.OUTPUT, {}),
        (
            "G1 X[#1+2.] Y-#3 Z#[#5+1] F#9",
            Kind.NC,
            {"words": ["G1", "X[#1+2.]", "Y-#3", "Z#[#5+1]", "F#9"]},
        ),
        ("g1x#1y -[#2]", Kind.NC, {"words": ["g1", "x#1", "y -[#2]"]}),
        ("G1 X1 0 . 5 ,C#1", Kind.NC, {"words": ["G1", "X1 0 . 5", ",C#1"]}),
        ("", Kind.NC, {}),
    ],
)
def test_statement(block: str, kind: Kind, expected: dict[str, Any]) -> None:
    plain = read_statement(block)
    assert (plain.fault, plain.kind, parts(block, plain)) == (None, kind, expected)
    headed = f"/ /3 N0120 {block}"
    statement = read_statement(headed)
    assert (statement.fault, statement.kind, parts(headed, statement)) == (None, kind, expected)
    assert statement.skips == (Number(1, 0, 1), Number(3, 2, 4))
    assert statement.sequence_number == Number(120, 5, 10)


def test_words_of_a_block() -> None:
    statement = read_statement("O100 G01 X-5 Y+.5 Z[#1] /2 F10.")
    assert [(w.address, w.written, w.has_point, w.code) for w in statement.words[:2]] == [
        ("O", "100", False, "O100"),
        ("G", "01", False, "G1"),
    ]
    assert [(w.address, w.written, w.has_point) for w in statement.words[2:]] == [
        ("X", "-5", False),
        ("Y", "+.5", True),
        ("Z", None, True),
        ("F", "10.", True),
    ]
    assert statement.skips == (Number(2, 24, 26),), "what follows it is skipped, what stands before is not"
    assert [word_value(word, variables(v1=1.23456), 0.001)[0] for word in statement.words[2:]] == [-5, 0.5, 1.235, 10]


def test_numbers_at_the_head_of_a_block() -> None:
    statement = read_statement(":100 N10 N20 X#1")
    assert [(word.address, word.written) for word in statement.words] == [("O", "100"), ("N", "20"), ("X", None)]
    assert statement.sequence_number == Number(10, 5, 8)
    assert read_statement(f"N{'1' * 5000}").sequence_number is not None


def test_a_slash_after_a_variable_is_block_skip_where_words_follow() -> None:
    statement = read_statement("G1 X#1 /2 Y5.")
    assert (statement.fault, statement.skips[0].value, len(statement.words)) == (None, 2, 3)


def test_what_is_meant_is_read_in_spite_of_a_fault() -> None:
    given = variables(v1=1.0, v2=2.0)
    joined = read_statement("IF [#1 GT 0] AND [#2 GT 0] GOTO 5")
    assert joined.condition is not None
    assert joined.jump is not None
    assert decide(joined.condition, given)[0] is True
    assert word_value(read_statement("X#1+#2 Y5.").words[0], given, 0.001)[0] == 3
    without_then = read_statement("IF[#1 EQ 1]#2=8").then
    assert without_then is not None
    assert assign(without_then, given) is None
    assert given.value(2) == 8


#: A block, the kind of its fault, and the characters at fault.
FAULTS_OF_READING = [
    ("#1=", "format", "="),
    ("#1=#2+", "format", "+"),
    ("#1=##2", "format", "##"),
    ("##1=2", "format", "##"),
    ("#1=#-1", "format", "#-"),
    ("#-1=5", "format", "#-"),
    ("#1=[]", "format", "]"),
    ("#1=[2 3 #4]", "format", "#4"),
    ("#1=5--- 2", "format", "-"),
    ("#1=2 EQ 3", "format", "2 EQ 3"),
    ("#1=[#2 EQ 3] + 1", "format", "+"),
    ("#1=[#2 EQ 3] AND 1", "format", "AND"),
    ("#1=SIN[1,2]", "format", ","),
    ("#1=PO[1,2]", "format", "P"),
    ("#1=POW[1,2,3]", "format", ","),
    ("IF[#1 = 5] GOTO 1", "format", "="),
    ("G1 X##1", "format", "##"),
    ("N#1 X5.", "format", "N#1"),
    ("O#1", "format", "O#1"),
    ("[X5.", "format", "["),
    ("#1=5=3", "statement-format", "=3"),
    ("#1=1 #2=2", "statement-format", "#2=2"),
    ("GOTO 10 GOTO 20", "statement-format", "GOTO 20"),
    ("GOTO [1 EQ 1]", "statement-format", "[1 EQ 1]"),
    ("DO", "statement-format", "DO"),
    ("END #1", "statement-format", "END #1"),
    ("#1=SIN 30", "missing-open-bracket", "SIN"),
    ("#1=3]*2", "missing-open-bracket", "]*2"),
    ("IF #1 EQ 0 GOTO 5", "missing-open-bracket", "#"),
    ("IF [#1 GT 0] AND [#2 GT 0] GOTO 5", "missing-open-bracket", "[#1 GT 0] AND [#2 GT 0]"),
    ("G1 X#1+#2 Y5.", "missing-open-bracket", "#1+#2"),
    ("G1 X#1 / 2", "missing-open-bracket", "#1 / 2"),
    ("G1 X-SIN[30]", "missing-open-bracket", "-SIN[30]"),
    ("G1 X#1] Y2.", "missing-open-bracket", "]"),
    ("#1=[#2+3", "missing-close-bracket", "[#2+3"),
    ("#1=SIN[#2", "missing-close-bracket", "SIN[#2"),
    ("G1 X[#1+2. Y5.", "missing-close-bracket", "[#1+2."),
    ("#1 5", "missing-equal", "#1 5"),
    ("#[#1+1]", "missing-equal", "#[#1+1]"),
    ("#1=POW[2]", "missing-comma", "POW[2]"),
    ("IF [#1] GOTO 5", "if-format", "[#1]"),
    ("IF [#1 EQ 1]", "if-format", "]"),
    ("IF [#1 EQ 1] THEN", "if-format", "THEN"),
    ("IF [#1 EQ 1] #2=3", "if-format", "#2=3"),
    ("IF [#1 EQ 1] THEN IF [#2 EQ 2] THEN #3=1", "if-format", "THEN IF [#2 EQ 2] THEN #3=1"),
    ("THEN #1=2", "if-format", "THEN #1=2"),
    ("WHILE [#1 LT 5]", "while-format", "]"),
    ("WHILE [5] DO1", "while-format", "[5]"),
    ("WHILE [#1 LT 5] #1=2", "while-format", "#1=2"),
    ("#1=[[[[[[2]]]]]]", "bracket-levels", "["),
    ("#1=SIN[#[[[[[2]]]]]]", "bracket-levels", "["),
    ("#1=2 G1", "nc-and-macro", "G1"),
    ("G1 X5. #1=2", "nc-and-macro", "#1=2"),
    ("G1 X5. IF[#1 EQ 2]GOTO 5", "nc-and-macro", "IF[#1 EQ 2]GOTO 5"),
    ("GOTO 10 M30", "nc-and-macro", "M30"),
    ("WHILE[#1 LT 5] DO1 X5.", "nc-and-macro", "X5."),
    ("IF [#1 EQ 1] THEN G0 X5.", "nc-and-macro", "G0 X5."),
    ("IF [#1 EQ 1] THEN M98 P1", "nc-and-macro", "M98 P1"),
    ("DO4", "loop-number", "DO4"),
    ("END 0", "loop-number", "END 0"),
    ("WHILE [#1 LT 5] DO 12", "loop-number", "DO 12"),
    ("DO99999999999999999999", "loop-number", "DO99999999999999999999"),
    ("G1 X--5. Y#1", "word-format", "X--5."),
    ("G1 X Y#1", "word-format", "X"),
    ("G1 X1.2.3 Y#1", "word-format", "X1.2.3"),
    ("G1 X5+3 Y#1", "word-format", "X5+3"),
    ("G1 * Y#1", "stray-character", "*"),
    ("M98 <ABC", "stray-character", "<ABC"),
]


@looped(("block", "kind", "at_fault"), FAULTS_OF_READING)
def test_fault_of_reading(block: str, kind: str, at_fault: str) -> None:
    for text, shift in ((block, 0), (f"/2 N10 {block}", 7)):
        fault = read_statement(text).fault
        assert fault is not None
        assert (fault.kind, text[fault.start : fault.end]) == (kind, at_fault)
        assert fault.start >= shift


def test_levels_of_brackets_are_a_bound_of_the_control() -> None:
    assert read_statement("#1=[[[[[1]]]]]").fault is None
    assert read_statement("#1=[[[[[1]]]]]", levels=4).fault == Fault("bracket-levels", 7, 8)
    assert read_statement("#1=[[[1]]]+[[[2]]]+[[[3]]]", levels=3).fault is None


@looped(("rest", "kind"), [("+", "format"), (" G1", "nc-and-macro")])
def test_a_worse_fault_goes_before_brackets_too_deep(rest: str, kind: str) -> None:
    fault = read_statement(f"#1=[[[[[[1]]]]]]{rest}").fault
    assert fault is not None
    assert fault.kind == kind


@looped("block", ["#1=" + "1+" * 50 + "1", "X#1" * 50, "/" * 50, "O1" * 50, "X[" + "1+" * 50 + "1]"])
def test_size_is_bounded(block: str) -> None:
    assert read_statement(block, size=200).fault is None or block.startswith("O")
    short = read_statement(block, size=20)
    assert len(short.words) + len(short.skips) <= 21
    assert short.fault is not None
    assert short.fault.kind == "too-long"


@pytest.mark.nightly
def test_size_is_bounded_where_nobody_asks_for_it() -> None:
    statement = read_statement("X1" * 20_100)
    assert len(statement.words) == 20_000
    assert statement.fault is not None
    assert statement.fault.kind == "too-long"


HOSTILE = [
    "1",
    "X",
    "X1",
    "X#",
    "X#1",
    "X#1+",
    "X#1/",
    "[",
    "]",
    "#[",
    "SIN[",
    "-",
    "1-",
    ".",
    "/",
    "N1",
    "O1",
    "AND",
    "é",
]
HOSTILE += ["ATAN[1]/[", "POW[1,", "IF[1EQ1]TH", "GOTO", "<", ">", "<A>", " ", "#_A", "=", "X[1+", "1EQ", "X1.1"]


@pytest.mark.ci
@looped("head", ["", "#1=", "IF[", "G1X["], one_in=80)
@looped("part", HOSTILE)
def test_reading_takes_linear_time(part: str, head: str) -> None:
    """Twice the text takes at most about twice the calls; and a very long block comes to an end."""

    def work(count: int) -> int:
        calls = 0

        def counted(*_: object) -> None:
            nonlocal calls
            calls += 1

        before = sys.getprofile()
        sys.setprofile(counted)
        try:
            read_statement(head + part * count)
        finally:
            sys.setprofile(before)
        return calls

    assert work(400) <= 2.1 * work(200) + 50
    statement = read_statement(head + part * (30_000 // len(part)), size=5_000)
    assert len(statement.words) + len(statement.skips) <= 5_001


SIGNS = [*"#[]=+-*/,.<>:;%()019XYIJPNO \t\0", "é", "#_A"]
NAMES = [
    "33",
    "100",
    "G1",
    "G65",
    "M98",
    "IF",
    "WHILE",
    "DO",
    "END",
    "GOTO",
    "THEN",
    "EQ",
    "AND",
    "OR",
    "SIN",
    "ATAN",
    "POW",
]
MACRO_TEXT = st.lists(st.sampled_from(SIGNS + NAMES), max_size=40).map("".join)


@pytest.mark.nightly
@given(block=st.one_of(MACRO_TEXT, st.text(max_size=60)))
@settings(max_examples=400, deadline=None)
def test_reading_and_running_never_fail(block: str) -> None:
    statement = read_statement(block)
    given_ = variables(v1=1.0)
    faults = [statement.fault, assign(statement, given_)]
    for word in statement.words:
        assert 0 <= word.start < word.end <= len(block)
        faults.append(word_value(word, given_, 0.001)[1])
    if statement.condition:
        faults.append(decide(statement.condition, given_)[1])
    if statement.call:
        faults += [assign_arguments(statement, given_).fault, called_program(statement, given_).fault]
    for fault in faults:
        assert fault is None or (0 <= fault.start < fault.end <= len(block))
