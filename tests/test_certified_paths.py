"""Paths of programs beside golden traces and other paths: what is the same, and what is said of the rest."""

from __future__ import annotations

import cmath
import math
from itertools import pairwise
from typing import Any

import msgspec
import pytest
from cases import looped

from polarcheck.geometry.comparison import polyline
from polarcheck.rewrite.certify.golden import GoldenMove, GoldenTrace
from polarcheck.rewrite.certify.near_path import with_golden, with_other
from polarcheck.rewrite.certify.tool_path import tool_path

#: The coverage counts all cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

Move = dict[str, Any]
TOLERANCE = 0.01


def square(section: int = 0, entry: float | None = 0.0, turned: float = 0.0, **fields: Any) -> list[Move]:
    """The moves round a square, turned on its plane [deg]; entry: C at the beginning."""
    corners = [complex(*corner) * cmath.rect(1, math.radians(turned)) for corner in CORNERS]
    return [
        {
            "section": section,
            "kind": "line",
            "start": [start.real, start.imag],
            "end": [end.real, end.imag],
            "center": None,
            "z": [-3.0, -3.0],
            "path": "tool",
            "feed": 200.0,
            "c_axis": [None if entry is None else entry + math.degrees(cmath.phase(start)), None],
            **fields,
        }
        for start, end in pairwise(corners)
    ]


CORNERS = ((30, 0), (10, 0), (10, 10), (-10, 10), (-10, -10), (10, -10), (10, 0), (30, 0))


def path(*moves: Move) -> Any:
    return tool_path(msgspec.convert(list(moves), list[GoldenMove]))


def golden(ours: list[Move], before: list[Move]) -> list[str]:
    traces = [GoldenTrace(msgspec.convert(moves, list[GoldenMove])) for moves in (ours, before)]
    return with_golden(*traces, 1, TOLERANCE, "a.jsonl").reasons


def other(ours: list[Move], theirs: list[Move]) -> tuple[list[str], list[str]]:
    compared = with_other(path(*ours), path(*theirs), TOLERANCE, "case")
    return compared.reasons, compared.remarks


def halved(moves: list[Move]) -> list[Move]:
    """Each move as two."""
    pieces = []
    for move in moves:
        middle = [(one + two) / 2 for one, two in zip(move["start"], move["end"], strict=True)]
        pieces += [{**move, "end": middle}, {**move, "start": middle, "c_axis": [None, None]}]
    return pieces


def test_the_same_moves_and_their_halves_are_the_same() -> None:
    assert golden(square(), square()) == golden(halved(square()), square()) == []
    assert golden(square(entry=None), square(entry=None)) == []
    assert golden(square(z=[None, None]), square(z=[None, None])) == []
    assert golden([], []) == []


@looped(
    ("ours", "said"),
    [
        (square()[:-1], "line 0: 20.000 mm from a.jsonl"),
        (square()[::-1], "line 0: "),
        (square(entry=30.0), "section 1: it is turned by 30.000 deg against a.jsonl"),
        (square(entry=None), "section 1: C at its beginning is known there alone, as 0.000 deg"),
        (square(turned=2.0), "section 1: it is turned by 2.000 deg against a.jsonl"),
        (square(z=[-3.0, None]), "section 1: a position is not known in this program"),
        (square(path="programmed"), "R of a cutter is not known in this program: its path is the programmed one"),
        (square() + square(1), "the path has 2 polar sections, a.jsonl has 1 polar section"),
        (square(feed=None), "line 0: F is not known, in a.jsonl 200 mm/min"),
        (square()[:3] + square(feed=180.0)[3:], "line 0: F is 180 mm/min, in a.jsonl 200 mm/min"),
        ([], "the path has 0 polar sections"),
    ],
)
def test_what_differs_from_a_golden_trace(ours: list[Move], said: str) -> None:
    first, *more = golden(ours, square())
    assert first.startswith(said)
    assert not more


def test_c_that_the_golden_trace_alone_lacks() -> None:
    assert golden(square(entry=5.0), square(entry=None)) == [
        "section 1: C at its beginning is known here alone, as 5.000 deg"
    ]


@looped(
    ("ours", "theirs"),
    [
        (square(entry=30.0), square()),
        (square(turned=30.0), square()),
        (square(turned=30.0, entry=-30.0), square()),
        (square(entry=30.0) + square(1, 150.0), square() + square(1, 120.0)),
        # A plane that stands still on the part, and one that begins anew in each section.
        (square(turned=10.0) + square(1, 0.0, turned=130.0), square() + square(1, 120.0)),
        (square(feed=None), square()),
    ],
)
def test_the_same_path_up_to_one_turn(ours: list[Move], theirs: list[Move]) -> None:
    assert other(ours, theirs) == ([], [])


@looped(
    ("ours", "theirs", "said"),
    [
        (
            square() + square(1, 90.0),
            square() + square(1, 120.0),
            "section 2: it is turned by -30.000 deg against case",
        ),
        (square() + square(1, turned=90), square() + square(1, 120.0), "section 2: it is turned by -30.000 deg"),
        (square(z=[-3.0, -3.5]), square(), "line 0: 0.500 mm from case"),
        (square(), square()[:-1], "line 0: 20.000 mm from case"),
    ],
)
def test_another_path_than_that_of_a_case(ours: list[Move], theirs: list[Move], said: str) -> None:
    (reason,), remarks = other(ours, theirs)
    assert reason.startswith(said)
    assert not remarks


def test_what_is_not_compared_is_a_remark() -> None:
    reasons, remarks = other(square() + square(1, None), square() + square(1, 120.0))
    assert reasons == []
    assert remarks == ["section 2: its angle is not compared, C at its beginning is not known"]
    assert other(square(z=[None, None]), square(z=[None, None])) == (
        [],
        ["section 1: Z is not compared, it is not known"],
    )


def test_a_path_that_is_too_long_is_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(polyline, "CHORDS_OF_FILE", 4)
    for reason, *_ in (golden(square(), square()), other(square(), square())[0]):
        assert "too long to compare" in reason or "mm from" in reason


def plunged(z: float) -> list[Move]:
    """The square, and Z alone behind it."""
    x = square()[-1]["end"]
    return [*square(), {**square()[-1], "start": x, "end": x, "z": [-3.0, z], "c_axis": [None, None]}]


def test_z_alone_belongs_to_a_golden_trace() -> None:
    assert golden(plunged(2.0), plunged(2.0)) == []
    assert any("mm from a.jsonl" in reason for reason in golden(plunged(-9.0), plunged(2.0)))
    assert any("mm from a.jsonl" in reason for reason in golden(plunged(-9.0), square()))


def test_a_golden_trace_of_an_earlier_version_holds_no_z_alone() -> None:
    traces = [msgspec.convert(moves, list[GoldenMove]) for moves in (plunged(2.0), square())]
    compared = with_golden(GoldenTrace(traces[0]), GoldenTrace(traces[1], is_old=True), 1, TOLERANCE, "a.jsonl")
    assert [reason.endswith("certify --update") for reason in compared.reasons] == [True]


def test_rapid_traverse_is_no_feed() -> None:
    slow, fast = square(x_feed=100.0), square(x_feed=None)
    assert golden(fast, slow) == ["line 0: F is rapid traverse, in a.jsonl 200 mm/min"]
    assert golden(square(x_feed=None, feed=300.0), fast) == []
