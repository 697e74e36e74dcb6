"""Macro expressions: their values, vacant and unknown ones, their faults."""

from __future__ import annotations

import math
import re
from typing import Any

import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from macro_values import Variables, expression, same, value, variables

from polarcheck.program.execution.arithmetic import UNKNOWN, Arithmetic, round_to
from polarcheck.program.execution.expression import decide, evaluate
from polarcheck.program.execution.high_level_tokens import HIGH_LEVEL
from polarcheck.program.execution.language_tokens import Tokens
from polarcheck.program.execution.task_tokens import USER_TASK
from polarcheck.program.execution.variable_names import Names

WIDE = Arithmetic(largest=1e308)


@looped(
    ("text", "expected"),
    [
        ("1+2*3", 7),
        ("[1+2]*3", 9),
        ("10-4-3", 3),
        ("100/10/5", 2),
        ("100/10*5", 50),
        ("-2*3", -6),
        ("2*-3", -6),
        ("1--2", 3),
        ("-[1+2]", -3),
        ("-SQRT[9]", -3),
        ("+5", 5),
        ("123", 123),
        (".5+5.", 5.5),
        ("# 1 + 1 2 . 5", 17.5),
        ("#[#1-3]", 8),
        ("-#[1+1]", -8),
        ("#[2.4]", 8),
        ("12 AND 10 + 1", 9),
        ("1 + 12 AND 10", 9),
        ("12 OR 3 * 4", 12),
        ("1 OR 2 + 4", 7),
        ("6 XOR 3", 5),
        ("6 XO 3", 5),
        ("14 AN 7", 6),
        ("17 MOD 5 * 2", 4),
        ("-17 MOD 5", -2),
        ("SIN[30]", 0.5),
        ("SIN[180]", 0),
        ("COS[270]", 0),
        ("COS[-60]", 0.5),
        ("TAN[45]", 1),
        ("SIN[30+60]*2", 2),
        ("ASIN[-1]", 270),
        ("ASIN[.5]", 30),
        ("ACOS[-1]", 180),
        ("ATAN[-1]/[-1]", 225),
        ("ATAN[1]/[-1]", 135),
        ("ATAN[-1]/[1]", 315),
        ("ATAN[-1,-1]", 225),
        ("ATAN[-1]", -45),
        ("ATAN[1]/2", 22.5),
        ("ATAN[1]/[1]/[3]", 15),
        ("ATAN[0]/[-1]", 180),
        ("ATAN[-0]/[-1]", 180),
        ("SQRT[2*8]", 4),
        ("ABS[-3.5]", 3.5),
        ("ROUND[2.5]", 3),
        ("ROUND[-2.5]", -3),
        ("ROUND[1.49]", 1),
        ("FIX[1.2]", 1),
        ("FIX[-1.2]", -1),
        ("FUP[1.2]", 2),
        ("FUP[-1.2]", -2),
        ("FUP[3]", 3),
        ("LN[EXP[2]]", 2),
        ("POW[2,10]", 1024),
        ("POW[-2,3]", -8),
        ("BCD[12]", 18),
        ("BIN[18]", 12),
        ("SI[30]+CO[60]+TA[45]", 2),
        ("AS[1]+AC[1]+AT[1]/[1]", 135),
        ("SQ[4]+AB[-1]+RO[.6]+FI[1.9]+FU[.1]", 6),
        ("LN[EX[1]]+BI[16]+BC[10]", 27),
        ("sin[ 9 0 ]", 1),
    ],
)
def test_value(text: str, expected: float) -> None:
    assert value(text, variables(v1=5.0, v2=8.0)) == pytest.approx(expected, abs=1e-12)


@looped(("text", "expected"), [("ATAN[-1]/[-1]", -135), ("ASIN[-1]", -90), ("ATAN[1]/[-1]", 135)])
def test_signed_angles(text: str, expected: float) -> None:
    assert value(text, arithmetic=Arithmetic(signed_angles=True)) == pytest.approx(expected)


@pytest.mark.parametrize("increment", [1.0, 0.1, 0.01, 0.001, 0.0001])
@given(half=st.integers(-10_000_000, 10_000_000))
@settings(max_examples=50)
def test_a_half_is_rounded_away_from_zero(half: int, increment: float) -> None:
    scale = round(1 / increment)
    whole, rest = divmod(abs(half), 2)
    assert round_to(half / (2 * scale), increment) == math.copysign(whole + rest, half) / scale


# A tree is a number, "#n", ("neg", tree), (function, tree) or (operator, tree, tree).
VALUES = {1: 2.5, 2: -4.0, 3: 7.0, 4: 0.125, 5: 12.0}
RANK = {"+": 2, "-": 2, "OR": 2, "XOR": 2, "*": 3, "/": 3, "AND": 3, "MOD": 3}
LEAVES = st.one_of(
    st.integers(0, 999), st.integers(0, 99_999).map(lambda n: n / 100), st.integers(1, 5).map("#{}".format)
)


def trees(leaves: st.SearchStrategy[Any], operators: list[str], functions: list[str]) -> st.SearchStrategy[Any]:
    return st.recursive(
        leaves,
        lambda inner: st.one_of(
            st.tuples(st.sampled_from(operators), inner, inner),
            st.tuples(st.sampled_from([*functions, "neg"]), inner),
        ),
        max_leaves=20,
    )


REAL_TREES = trees(LEAVES, ["+", "-", "*", "/"], ["ABS", "SQRT", "FIX", "FUP"])
WHOLE_TREES = trees(st.integers(0, 4000), ["+", "-", "*", "AND", "OR", "XOR", "MOD"], ["ABS"])


def calculated(tree: Any) -> float:
    """The value of a tree by Python's own arithmetic; ArithmeticError or ValueError where there is none."""
    if isinstance(tree, str):
        return VALUES[int(tree[1:])]
    if not isinstance(tree, tuple):
        return float(tree)
    name, *inner = tree
    a = [calculated(one) for one in inner]
    match name:
        case "neg":
            return -a[0]
        case "ABS":
            return abs(a[0])
        case "SQRT":
            return math.sqrt(a[0])
        case "FIX":
            return float(int(a[0]))
        case "FUP":
            return float(int(a[0])) if a[0] == int(a[0]) else float(int(a[0] + math.copysign(1, a[0])))
        case "+":
            return a[0] + a[1]
        case "-":
            return a[0] - a[1]
        case "*":
            return a[0] * a[1]
        case "/":
            return a[0] / a[1]
    left, right = int(a[0]), int(a[1])
    if max(abs(left), abs(right)) >= 2**32:
        raise OverflowError
    match name:
        case "AND":
            return float(left & right)
        case "OR":
            return float(left | right)
        case "XOR":
            return float(left ^ right)
    assert name == "MOD"
    return float(abs(left) % abs(right)) * (-1 if left < 0 else 1) + (0 if right else left / right)


def bracketed(tree: Any) -> str:
    if not isinstance(tree, tuple):
        return str(tree)
    name, *inner = tree
    if name == "neg":
        return f"[-[{bracketed(inner[0])}]]"
    return (
        f"[[{bracketed(inner[0])}]{name}[{bracketed(inner[1])}]]"
        if len(inner) == 2
        else f"{name}[{bracketed(inner[0])}]"
    )


def sparse(tree: Any, around: int = 0) -> str:
    """The tree with as few brackets as its meaning allows; `around` is the rank below which it needs its own."""
    if not isinstance(tree, tuple):
        return str(tree)
    name, *inner = tree
    if name == "neg":
        alone = not isinstance(inner[0], tuple) or inner[0][0] in ("ABS", "SQRT", "FIX", "FUP")
        return f"-{sparse(inner[0])}" if alone else f"-[{sparse(inner[0])}]"
    if len(inner) == 1:
        return f"{name}[{sparse(inner[0])}]"
    text = f"{sparse(inner[0], RANK[name])} {name} {sparse(inner[1], RANK[name] + 1)}"
    return f"[{text}]" if RANK[name] < around else text


@pytest.mark.nightly
@pytest.mark.one_in(2)
@pytest.mark.parametrize("trees_", [REAL_TREES, WHOLE_TREES], ids=["real", "whole"])
@given(data=st.data())
@settings(max_examples=150, deadline=None)
def test_value_is_that_of_plain_arithmetic(trees_: st.SearchStrategy[Any], data: st.DataObject) -> None:
    tree = data.draw(trees_)
    given_ = variables(**{f"v{number}": one for number, one in VALUES.items()})
    try:
        expected = calculated(tree)
    except (ArithmeticError, ValueError):
        expected = UNKNOWN
    for text in (bracketed(tree), sparse(tree)):
        for spelling in (text, " ".join(text.lower()), text.replace(" ", "")):
            found, fault = evaluate(expression(spelling, levels=1000), given_, WIDE)
            assert same(found, expected), spelling
            assert (fault is not None) == math.isnan(expected), spelling


@looped(
    ("text", "when_vacant", "when_zero"),
    [
        ("#1", None, 0),
        ("#[1]", None, 0),
        ("#1*5", 0, 0),
        ("#1+#1", 0, 0),
        ("#1+#0", 0, 0),
        ("-#1", 0, 0),
        ("COS[#1]", 1, 1),
        ("#[#1]", None, None),
        ("[#1+5]*2", 10, 10),
    ],
)
def test_vacant_in_an_expression(text: str, when_vacant: float | None, when_zero: float | None) -> None:
    assert same(value(text, variables()), when_vacant)
    assert same(value(text, variables(v1=0.0)), when_zero)


@looped(
    ("condition", "when_vacant", "when_zero"),
    [
        ("#1 EQ #0", True, False),
        ("#1 NE 0", True, False),
        ("#1 EQ 0", False, True),
        ("#1 NE #0", False, True),
        ("#1 GE #0", True, True),
        ("#1 GT 0", False, False),
        ("#1 GT #0", False, False),
        ("#1 LE #0", True, True),
        ("#1 LT 0", False, False),
        ("#1 LT 1", True, True),
        ("#1+0 EQ 0", True, True),
    ],
)
def test_vacant_in_a_condition(condition: str, *, when_vacant: bool, when_zero: bool) -> None:
    """The table of the manual."""
    assert decide(expression(condition), variables()) == (when_vacant, None)
    assert decide(expression(condition), variables(v1=0.0)) == (when_zero, None)


@looped("text", ["#500", "#5021", "#[#500]", "#500*0", "SIN[#500]", "#_TIME", "[#_TIME]+1", "#_A[2]", "ADP[1]"])
def test_unknown_stays_unknown(text: str) -> None:
    assert same(value(text), UNKNOWN)


@looped(
    ("condition", "expected"),
    [
        ("#500 EQ 1", None),
        ("#500 EQ #0", None),
        ("#500 GT 1", None),
        ("[#500 EQ 1] AND [1 EQ 2]", False),
        ("[1 EQ 2] AND [#500 EQ 1]", False),
        ("[#500 EQ 1] AND [1 EQ 1]", None),
        ("[#500 EQ 1] OR [1 EQ 1]", True),
        ("[1 EQ 1] OR [#500 EQ 1]", True),
        ("[#500 EQ 1] OR [1 EQ 2]", None),
        ("[#500 EQ 1] XOR [1 EQ 1]", None),
        ("[1 EQ 2] XOR [1 EQ 1]", True),
        ("[1 EQ 1] XOR [1 EQ 1]", False),
        ("[2 GT 1] AND [2 GE 2]", True),
        ("[2 LT 1] OR [2 LE 1]", False),
        ("[1 EQ 1] AND [1 NE 2] AND [3 GT 4]", False),
        ("1 + 1 EQ 4 / 2", True),
        ("4 EQ 3 + 1", True),
        ("#_TIME EQ 2", None),
    ],
)
def test_condition(condition: str, *, expected: bool | None) -> None:
    assert decide(expression(condition), variables()) == (expected, None)


#: An expression, the kind of its fault, and the step at fault.
FAULTS_OF_CALCULATING = [
    ("2+1/0", "zero-divide", "/"),
    ("1/#1", "zero-divide", "/"),
    ("TAN[90]+SQRT[-4]", "zero-divide", "TAN[90]"),
    ("5 MOD 0", "zero-divide", "MOD"),
    ("TAN[90]", "zero-divide", "TAN[90]"),
    ("TAN[-270]", "zero-divide", "TAN[-270]"),
    ("POW[0,-1]", "zero-divide", "POW[0,-1]"),
    ("SQRT[-4]+1", "negative-square-root", "SQRT[-4]"),
    ("ASIN[1.1]", "arc-function-beyond-one", "ASIN[1.1]"),
    ("ACOS[-2]", "arc-function-beyond-one", "ACOS[-2]"),
    ("LN[0]", "logarithm-not-positive", "LN[0]"),
    ("LN[-1]", "logarithm-not-positive", "LN[-1]"),
    ("EXP[1000]", "overflow", "EXP[1000]"),
    ("POW[10,400]", "overflow", "POW[10,400]"),
    ("POW[10,40]*POW[10,40]", "overflow", "*"),
    ("9" * 50, "overflow", "9" * 50),
    ("5000000000 AND 1", "integer-overflow", "AND"),
    ("BCD[-1]", "argument-out-of-range", "BCD[-1]"),
    ("BCD[123456789]", "argument-out-of-range", "BCD[123456789]"),
    ("BIN[10]", "argument-out-of-range", "BIN[10]"),
    ("POW[-2,.5]", "argument-out-of-range", "POW[-2,.5]"),
    ("#34", "variable-number", "#34"),
    ("#[1-5]", "variable-number", "#[1-5]"),
    ("#99999999999999999999999999", "variable-number", "#99999999999999999999999999"),
]


@looped(("text", "kind", "at_fault"), FAULTS_OF_CALCULATING)
def test_fault_of_calculating(text: str, kind: str, at_fault: str) -> None:
    result, fault = evaluate(expression(text), Variables())
    assert fault is not None
    assert result != result
    assert (fault.kind, text[fault.start : fault.end]) == (kind, at_fault)


def test_rounding_errors_are_no_faults() -> None:
    """A hair beyond 1 or below 0 comes from binary fractions, not from the program."""
    assert value("ACOS[1.0000000000000002]") == 0
    assert value("SQRT[.1+.2-.3000000000000001]") == 0


@looped(
    ("text", "at"),
    [
        ("#1 * #2 AND 15", "AND"),
        ("#1 AND #2 / 3", "/"),
        ("#1 AND #2 + 3", "+"),
        ("#1 OR #2 + 3", "+"),
        ("#1 - 3 XOR 2", "XOR"),
        ("#1 AND [#2 * 3]", None),
        ("[#1 OR 1] + 2", None),
        ("#1 AND 3 OR 4", None),
        ("#1 * 2 OR 4", None),
        ("#1 * 2 + 4 / 3 - 1", None),
        ("#1 AND 3 EQ #2 * 2", None),
        ("ATAN[#1 AND 3, #2 * 2]", None),
        ("[#1 EQ 1] AND [#2 + 1 EQ 2]", None),
    ],
)
def test_ambiguous(text: str, at: str | None) -> None:
    place = expression(text).mixed
    assert (place and text[place[0] : place[1]]) == at


HIGH_LEVEL_WORDS = {"[": "(", "]": ")", "#": "R", "FIX": "TRUNC", "EQ": "==", "NE": "<>", "GT": ">", "LE": "<="}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1+2*3-8/4", 5),
        ("-[2+3]*-4+1", 21),
        ("17 MOD 5*2", 4),
        ("2*17 MOD 5", 4),
        ("10-4-3", 3),
        ("SIN[30]+COS[60]*TAN[45]", 1),
        ("SQRT[ABS[-16]]", 4),
        ("ROUND[2.5]+FIX[-2.7]", 1),
        ("ASIN[.5]+ACOS[.5]", 90),
        ("#1*2-#3", 2 * 1001 - 1003),
        ("[1+1 EQ 2] AND [3*2 GT 5]", 1),
        ("[1+1 NE 2] OR [3 LE 2]", 0),
        ("[1 EQ 1] XOR [3 GT 2]", 0),
    ],
)
def test_the_same_expression_has_one_value_in_each_language(text: str, expected: float) -> None:
    """Variables hold 1000 more than their number."""
    spelled_out = re.sub("|".join(map(re.escape, HIGH_LEVEL_WORDS)), lambda word: HIGH_LEVEL_WORDS[word[0]], text)
    high_level = Tokens(spelled_out, HIGH_LEVEL, Names(), 20, 1000)
    user_task = Tokens(text.replace("#", "VC").replace("XOR", "EOR"), USER_TASK, Names(), 20, 1000)
    for read in (expression(text), high_level.expression(), user_task.expression()):
        assert read is not None
        value, fault = evaluate(read, Numbered())
        assert (value, fault) == (pytest.approx(expected), None)


class Numbered:
    """Variables that hold 1000 more than their number, by which R1 and #1 are the same."""

    def exists(self, number: float) -> bool:
        return True

    def value(self, number: float) -> float:
        return number % 1000 + 1000
