"""What runs when a macro runs: variables, assignments, words, arguments, calls."""

from __future__ import annotations

import math

import pytest
from cases import looped
from macro_values import Variables, assign_arguments, called_program, read_statement, same, value, variables

from polarcheck.program.execution.arithmetic import UNKNOWN
from polarcheck.program.execution.expression import Fault
from polarcheck.program.execution.macro import assign, word_value
from polarcheck.program.execution.programs import ProgramName


def test_numbers_of_variables() -> None:
    older, newer = Variables(), Variables(retained_variables=[(500, 999), (98000, 98499)])
    there = [0, 1, 33, 100, 199, 500, 999, 1000, 5021, 7001]
    assert all(older.exists(number) and newer.exists(number) for number in there)
    assert not any(older.exists(number) or newer.exists(number) for number in [-1, 34, 99, 200, 499, 1e30, math.inf])
    assert [some.exists(98000) for some in (older, newer)] == [False, True]
    assert [newer.exists(number) for number in (97999, 98499, 98500)] == [False, True, False]


def test_never_assigned() -> None:
    """Local and common variables are vacant at first; what outlives the power-off may hold anything."""
    some = Variables(given={501: 2.5, 5041: 10.0, 150: None})
    assert [some.value(number) for number in (0, 1, 100, 150, 501, 5041)] == [None, None, None, None, 2.5, 10]
    assert all(same(some.value(number), UNKNOWN) for number in (500, 1000, 5001))
    assert some.write(500, 4.0) is None
    assert some.value(500) == 4


def test_clocks_run_on() -> None:
    some = Variables()
    assert some.write(3001, 0.0) is None
    assert same(some.value(3001), UNKNOWN)
    assert some.write(3003, 1.0) is None
    assert some.value(3003) == 1


def test_levels_of_local_variables() -> None:
    some = variables(v1=1.0, v2=2.0, v100=3.0)
    some.enter({1: 10.0})
    assert (some.depth, some.value(1), some.value(2), some.value(100)) == (1, 10, None, 3)
    some.write(2, 20.0)
    some.write(100, 30.0)
    some.enter({})
    assert (some.depth, some.value(1), some.value(2)) == (2, None, None)
    some.leave()
    assert (some.value(1), some.value(2)) == (10, 20)
    some.leave()
    some.leave()
    assert (some.depth, some.value(1), some.value(2), some.value(100)) == (0, 1, 2, 30)


def test_vacant_is_copied_by_plain_assignment_only() -> None:
    given = variables(v2=7.0, v3=7.0)
    assert assign(read_statement("#2=#1"), given) is None
    assert assign(read_statement("#3=#1+0"), given) is None
    assert (given.value(2), given.value(3)) == (None, 0)


def test_vacant_drops_the_address() -> None:
    words = read_statement("G1 X#1 Y-#1 Z[#1] U[#1+0] V#2 W1.00001").words[1:]
    found = [word_value(word, variables(v2=3.0), 0.001)[0] for word in words]
    assert found == [None, None, None, 0, 3, 1.00001]


def test_round_at_an_address_goes_to_its_least_increment() -> None:
    """The pair of moves of the manual: 1.235 and 2.346 add up only if each is rounded."""
    given = variables(v1=1.2345, v2=2.3456)
    assert value("ROUND[#1]+ROUND[#2]", given, increment=0.001) == pytest.approx(3.581, abs=1e-12)
    assert value("ROUND[#1]+ROUND[#2]", given) == 3
    words = read_statement("G0 X-#1 Y-[ROUND[#1]+ROUND[#2]] Z[#1+#2] M#2").words
    increments = {"X": 0.001, "Y": 0.001, "Z": 0.001, "M": 1}
    found = [word_value(word, given, increments[word.address])[0] for word in words[1:]]
    assert found == [-1.235, -3.581, 3.58, 2]


@pytest.mark.ci
def test_brackets_too_deep_can_be_calculated() -> None:
    block = f"#1={'[' * 10_000}7{']' * 10_000}"
    statement = read_statement(block)
    assert statement.fault == Fault("bracket-levels", 8, 9)
    given = Variables()
    assert assign(statement, given) is None
    assert given.value(1) == 7


def test_assigning_a_variable_of_unknown_number() -> None:
    some = variables(v1=1.0, v100=2.0)
    assert assign(read_statement("#[#500]=7"), some) is None
    assert all(same(some.value(number), UNKNOWN) for number in (1, 2, 100, 101))
    assert assign(read_statement("#1=7"), some) is None
    assert some.value(1) == 7


def test_assigning_by_name_touches_no_number() -> None:
    some = variables(v1=1.0)
    assert assign(read_statement("[#_PARAM]=7"), some) is None
    assert some.value(1) == 1


def test_a_value_that_cannot_be_read_is_unknown() -> None:
    some = variables(v1=1.0)
    assign(read_statement("#1=[2+"), some)
    assert same(some.value(1), UNKNOWN)


FAULTS_OF_ASSIGNING = [
    ("#0=1", "read-only", "#0"),
    ("#5021=1", "read-only", "#5021"),
    ("#[5000+21]=1", "read-only", "#[5000+21]"),
    ("#34=1", "variable-number", "#34"),
    ("#[1/0]=1", "zero-divide", "/"),
    ("#1=1/0", "zero-divide", "/"),
]


@looped(("block", "kind", "at_fault"), FAULTS_OF_ASSIGNING)
def test_fault_of_assigning(block: str, kind: str, at_fault: str) -> None:
    statement, given = read_statement(block), variables(v2=3.0)
    assert statement.fault is None
    fault = assign(statement, given)
    assert fault is not None
    assert (fault.kind, block[fault.start : fault.end]) == (kind, at_fault)
    assert given.value(2) == 3


@looped(
    ("block", "expected"),
    [
        (
            "G65 P1 A1 B2 C3 D7 E8 F9 H11 I4 J5 K6 M13 Q17 R18 S19 T20 U21 V22 W23 X24 Y25 Z26",
            {number: number for number in [*range(1, 10), 11, 13, *range(17, 27)]},
        ),
        ("G65 P1 A1. B2. I-3. I4. D5.", {1: 1, 2: 2, 4: -3, 7: 5}),
        ("G65 P1 D5. I-3. I4.", {4: -3, 7: 4}),
        ("G65 P1 K6. J5.", {6: 6, 8: 5}),
        ("G65 P1 J5. I7. K9.", {5: 5, 7: 7, 9: 9}),
        ("G65 P1 I1. I2. I3. K4.", {4: 1, 7: 2, 10: 3, 12: 4}),
        ("G65 P1 " + "I1. J2. K3. " * 10, dict(zip(range(4, 34), [1, 2, 3] * 10, strict=True))),
        ("G65 P1 A#1 B#2 C-#1", {1: 8, 3: -8}),
        ("G66 P1 L3 A1.", {1: 1}),
        ("G0 X5. G65 P1 A1.", {1: 1}),
        ("G65 <NAME> A1. A2.", {1: 2}),
        ("G66.1 P1 G1 X5.", {24: 5}),
    ],
)
def test_arguments(block: str, expected: dict[int, float]) -> None:
    found = assign_arguments(read_statement(block), variables(v1=8.0))
    assert (found.values, found.fault) == (expected, None)


def test_ten_sets_of_arguments_and_no_more() -> None:
    block = "G65 P1 " + "I1. J2. K3. " * 11
    found = assign_arguments(read_statement(block), Variables())
    assert found.fault is not None
    assert found.fault.start == block.index("I1.", len(block) - 12)
    assert max(found.values) == 33


def test_arguments_without_a_point() -> None:
    statement = read_statement("G65 P1 A1 X1 Y1. Z#1")
    increments = {"X": 0.001, "Y": 0.001, "Z": 0.001}
    assert assign_arguments(statement, variables(v1=5.0)).values == {1: 1, 24: 1, 25: 1, 26: 5}
    assert assign_arguments(statement, variables(v1=5.0), increments=increments).values == {
        1: 1,
        24: 0.001,
        25: 1,
        26: 5,
    }


def test_arguments_of_specification_one_only() -> None:
    statement = read_statement("G65 P1 K6. I4. I7.")
    assert assign_arguments(statement, Variables(), second_arguments=False).values == {4: 7, 6: 6}


FAULTS_OF_CALLING = [
    ("G65 P1 A1. G90", "argument-address", "G90"),
    ("G65 P1 N5 A1.", "argument-address", "N5"),
    ("G65 P1 O5 A1.", "argument-address", "O5"),
    ("G65 P1 P2 A1.", "argument-address", "P2"),
    ("G66 P1 L2 A1. L3", "argument-address", "L3"),
    ("G65 P1 ,C5.", "argument-address", ",C5."),
    ("G65 P1 " + "I1. " * 11, "argument-sets", "I1."),
    ("G65 P1 A[1/0]", "zero-divide", "/"),
]


@looped(("block", "kind", "at_fault"), FAULTS_OF_CALLING)
def test_fault_of_an_argument(block: str, kind: str, at_fault: str) -> None:
    fault = assign_arguments(read_statement(block), Variables()).fault
    assert fault is not None
    assert (fault.kind, block[fault.start : fault.end]) == (kind, at_fault)


@looped(
    ("block", "repeats_in_p", "program", "repeats"),
    [
        ("M98 P1000", True, 1000, 1),
        ("M98 P0001", True, 1, 1),
        ("M98 P7 L3", True, 7, 3),
        ("M98 P68003", True, 8003, 6),
        ("M98 P0031000", True, 1000, 3),
        ("M98 P99991234", True, 1234, 9999),
        ("M98 P00011000", True, 1000, 1),
        ("M98 P68003", False, 68003, 1),
        ("M98 P68003 L2", False, 68003, 2),
        ("M98 P#1", True, 8003, 6),
        ("M98 P1 L#2", True, 1, 1),
        ("M98 P1 L-2", True, 1, 0),
        ("M98 P1 L#500", True, 1, None),
        ("M98 P#500", True, None, 1),
        ("G65 P68003 L2 A1.", True, 68003, 2),
        ("M198 P20001", True, 1, 2),
    ],
)
def test_called_program(block: str, *, repeats_in_p: bool, program: int | None, repeats: int | None) -> None:
    call = called_program(read_statement(block), variables(v1=68003.0), repeats_in_p=repeats_in_p)
    assert (call.program, call.repeats, call.fault) == (ProgramName(program, None), repeats, None)


def test_called_by_name() -> None:
    call = called_program(read_statement("M98 <sub-1> L2"), Variables())
    assert (call.program, call.repeats, call.fault) == (ProgramName(None, "sub-1"), 2, None)


@looped("block", ["M98", "G65 A1.", "M98 P0", "M98 P-5", "M98 P123456789", "M98 P10000", "M98 P#1"])
def test_call_without_a_program_number(block: str) -> None:
    call = called_program(read_statement(block), Variables())
    assert call.program == ProgramName(None, None)
    assert call.fault is not None
    assert call.fault.kind == "program-number"
