"""Coordinates as lengths and angles: which programs are written in least increments, and what their numbers are."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from programs import tables_of, trace_of

POINTED = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX-40.\nG13.1\n"
IN_INCREMENTS = "G98 G0 X60000 C0\nG12.1\nG1 X40000 F200\nC10000\nC-500\nX-40000\nG13.1\n"
WHOLE = "G98 G0 X60 C0\nG12.1\nG1 X40 F200\nC10\nX-40\nG13.1\n"


def programs(*parts: str) -> str:
    return "".join(f"O{number}\n{part}M30\n" for number, part in enumerate(parts, 1))


def in_increments(program: str, **changes: Any) -> list[bool]:
    """Per program of the file."""
    trace = trace_of(program, changes=changes)
    found = [
        set(trace.coordinates.in_increments[trace.blocks.program == number].tolist())
        for number in np.unique(trace.blocks.program)
    ]
    assert all(len(one) == 1 for one in found), "programs as a whole"
    return [one.pop() for one in found]


@looped(
    ("program", "expected"),
    [
        (POINTED, False),
        (WHOLE, False),
        (IN_INCREMENTS, True),
        ("G20\n" + IN_INCREMENTS, True),
        # one slip, wherever it stands
        ("G0 Z1000\n" + POINTED, False),
        (POINTED.replace("C10.\n", "C10.\nZ1000\n"), False),
        (POINTED.replace("X60.", "X60000"), False),
        (WHOLE + "G0 Z1000\n", False),
        ("G20\nG0 Z1000\n" + WHOLE, False),
        ("G0 Z1000\n", False),
        # slips that are no habit
        ("G0 Z1000\n" + POINTED + "G0 Z1000\n", False),
        (POINTED.replace("C10.\n", "C10.\nZ1000\nC5.\nC4.\nZ1000\n"), False),
        # most numbers without a point are small
        (WHOLE.replace("X-40", "Z1000\nZ2000\nX-40"), False),
        # a habit in the mode alone
        ("G0 X100.\nZ50.\nZ20.\nX80.\nX90.\nX100.\nX120.\n" + IN_INCREMENTS, True),
    ],
)
def test_what_most_numbers_say(program: str, expected: bool) -> None:
    assert in_increments(program) == [expected]


def test_each_program_of_a_file_speaks_for_itself() -> None:
    assert in_increments(programs(IN_INCREMENTS, POINTED, IN_INCREMENTS, WHOLE)) == [True, False, True, False]
    trace = trace_of(programs(IN_INCREMENTS, WHOLE))
    assert trace.path.x[[1, 3, 5, 6]].tolist() == [30, 20, 20, -20]
    assert trace.path.x[10 + np.array([0, 2, 3, 4])].tolist() == [30, 20, 20, -20]


SUBPROGRAM = "G1 X40000 F200\nC10000\nC-500\nX-40000\nM99\n"


def test_a_called_program_speaks_with_the_one_that_calls_it() -> None:
    main = "O1\nG98 G0 X60. C0\nZ5.\nG12.1\nM98 P2\nG13.1\nG0 X100.\nM30\nO2\n"
    assert in_increments(main + SUBPROGRAM) == [True]
    two = main.replace("O2\n", "") + main.replace("O1", "O3").replace("O2\n", "") + "O2\n"
    assert in_increments(two + SUBPROGRAM) == [True, True]
    assert in_increments(main + "G1 X40. F200\nC10.\nZ1000\nX-40.\nM99\n") == [False]


def test_a_number_counts_once_however_often_it_is_run() -> None:
    slip = "#1=0\nWHILE[#1LT20]DO1\nG0 Z1000\n#1=#1+1\nEND1\n"
    assert in_increments("O1\n" + slip + POINTED + "M30\n") == [False]
    called = "O1\n" + POINTED + "M98 P200002\nM30\nO2\nG0 Z1000\nM99\n"
    assert in_increments(called) == [False]


def test_what_numbers_are_meant() -> None:
    """In a program in least increments all; in others only those that nothing else can be."""
    trace = trace_of(IN_INCREMENTS)
    assert trace.lengths.length_of("X")[[0, 2, 5]] == pytest.approx([60, 40, -40])
    assert trace.lengths.length_of("C")[[3, 4]] == pytest.approx([10, -0.5])
    slip = trace_of("G0 Z1000\nZ999\nX1000.\nG4 X2000\n" + POINTED)
    assert slip.lengths.length_of("Z")[:2] == pytest.approx([1, 999])
    assert slip.lengths.length_of("X")[[2, 3]] == pytest.approx([1000, 2000])
    assert slip.path.x[4] == 30
    inch = trace_of("G20\n" + IN_INCREMENTS.replace("C0", "C90000"))
    assert inch.lengths.length_of("X")[1] == pytest.approx(6 * 25.4)
    assert inch.path.c_angle[1] == pytest.approx(90), "an angle has the same increments in inch"
    assert inch.lengths.length_of("C")[4] == pytest.approx(25.4)


def test_a_control_that_counts_whole_units_has_no_increments() -> None:
    control = {"number_without_point": "whole-unit"}
    assert in_increments(IN_INCREMENTS, control=control) == [False]
    assert trace_of(IN_INCREMENTS, changes={"control": control}).path.x[0] == 30000


def test_what_is_a_coordinate() -> None:
    program = (
        "G0 X1 Z2\nG4 X3\nG43 H4\nG1 H5 F6\nG3 X1 C1 R7 I8 K9\nG83 Z-10 R2 Q3\nG80\nM8 S9\nG53 X8\nU1 W0 X2. (X5)\n"
    )
    trace = trace_of(program)
    words, found = trace.run.words, trace.coordinates.is_coordinate
    named = [
        f"{chr(address)}{value:g}" for address, value in zip(words.address[found], words.value[found], strict=True)
    ]
    assert named == ["X1", "Z2", "H5", "X1", "C1", "R7", "I8", "K9", "U1", "W0", "X2"]
    found = trace.coordinates.is_unpointed
    assert chr(words.address[found][-1]) == "U"


NUMBERS = st.lists(st.integers(0, 4), max_size=8)


@pytest.mark.nightly
@settings(deadline=None)
@given(NUMBERS)
def test_points_are_counted_by_a_plain_loop(kinds: list[int]) -> None:
    """Without parts: more than one number without a point, more than half of all, more than half of them large."""
    words = ["X5.", "X5", "X5000", "Z-2000", "Z0"]
    program = "G0\n" + "".join(f"{words[kind]}\n" for kind in kinds)
    without = [kind for kind in kinds if kind in (1, 2, 3)]
    large = [kind for kind in kinds if kind in (2, 3)]
    numbers = [kind for kind in kinds if kind != 4]
    expected = len(without) > 1 and 2 * len(without) > len(numbers) and 2 * len(large) > len(without)
    trace = trace_of(program)
    assert trace.coordinates.in_increments.tolist() == [expected] * len(trace)
    read = [5, 0.005 if expected else 5, 5, -2, 0]
    assert [trace.lengths.length_of(words[kind][0])[row] for row, kind in enumerate(kinds, 1)] == [
        read[kind] for kind in kinds
    ]


def test_tables_of_nothing() -> None:
    for program in ("", "%\n%\n", "(X1000)\n"):
        tables = tables_of(program)
        assert not tables["trace"].coordinates.in_increments.any()
        assert not tables["unpointed"].slips.any()
        assert not tables["unpointed"].in_increments.any()
