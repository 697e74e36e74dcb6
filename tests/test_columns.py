"""The columns that a row has by itself or from the rows above it."""

from __future__ import annotations

import math

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of, trace_of

from polarcheck.foundation.states import FeedMode, Motion, Side, Units

PROGRAM = "O1\nG20 G98\nT0808 M3\nG0 X1. Z.5 (FAST)\nG1 X.5 ,R.1 F2\nG2 X.6 R.1\nG41\nM5\nO2\nX9.\n"


def test_words_of_each_row() -> None:
    trace = trace_of(PROGRAM)
    assert trace.blocks.line.tolist() == list(range(1, 11))
    assert trace.blocks.program.tolist() == [0] * 8 + [1] * 2
    assert [trace.blocks.word("X")[row] for row in (3, 4, 5, 9)] == [1, 0.5, 0.6, 9]
    assert np.flatnonzero(trace.blocks.has("Z", "T")).tolist() == [2, 3]
    assert np.flatnonzero(trace.blocks.has(",R")).tolist() == [4]
    assert np.flatnonzero(trace.blocks.has("R")).tolist() == [5]
    assert np.flatnonzero(trace.blocks.codes("G2", "M5")).tolist() == [5, 7]
    words = trace.blocks.words_at(trace.blocks.word_indices("X", "Z"))
    assert np.bincount(trace.run.row[words], minlength=10).tolist() == [0, 0, 0, 2, 1, 1, 0, 0, 0, 1]


def test_what_is_in_force_ends_with_its_program() -> None:
    trace = trace_of(PROGRAM)
    assert trace.modal.state("motion").tolist() == [Motion.NONE] * 3 + [0, 1, 2, 2, 2] + [Motion.NONE] * 2
    assert trace.modal.state("side").tolist() == [Side.OFF] * 6 + [Side.LEFT] * 2 + [Side.OFF] * 2
    assert trace.lengths.units.tolist() == [Units.MM, *[Units.INCH] * 7, Units.MM, Units.MM]
    assert trace.feedrate.feed_mode[[1, 8]].tolist() == [FeedMode.PER_MINUTE] * 2
    assert trace.feedrate.feed_number[[3, 4, 7, 8]] == pytest.approx([math.nan, 50.8, 50.8, math.nan], nan_ok=True)
    assert trace.modal.spindle.tolist() == [False] * 2 + [True] * 5 + [False] * 3
    assert trace.lengths.length_of("X")[[3, 9]].tolist() == [25.4, 9.0]


@looped(
    ("word", "digits", "tool", "offset"),
    [("T0808", 2, 8, 8), ("T1208", 2, 12, 8), ("T8", 2, 0, 8), ("T010203", 3, 10, 203), ("T800", 2, 8, 0)],
)
def test_a_tool_word_names_a_tool_and_an_offset(word: str, digits: int, tool: int, offset: int) -> None:
    trace = trace_of(f"{word}\nG0 X1.\n", changes={"control": {"offset_digits": digits}})
    assert (trace.tools.tool[1], trace.tools.offset_number[1]) == (tool, offset)


@looped("digits", [16, 19, 20, 40, 300, 400])
def test_a_tool_number_of_any_length_calls_nothing(digits: int) -> None:
    """Numbers beyond 64 bits were cast to whole numbers, with a warning on the terminal."""
    program = f"O1\nG21 G98\nT{'1' * digits}\nG0 X60. C0\nM30\n"
    trace = trace_of(program)
    assert not trace.tools.tool.any()
    assert not trace.tools.offset_number.any()
    assert (3, "too-many-digits") in said(report_of(program))


def test_radius_and_cutter_of_the_offset_in_force() -> None:
    program = "G20\nT0101\nG0 X1.\nT0202\nT0300\n"
    trace = trace_of(program, "fanuc", "1:radius=.25", "2:diameter=.5")
    assert trace.compensation.radius == pytest.approx([math.nan, 6.35, 6.35, math.nan, math.nan], nan_ok=True)
    assert trace.offsets.cutter_diameter == pytest.approx([math.nan, 12.7, 12.7, 12.7, math.nan], nan_ok=True)
    metric = trace_of(program, "fanuc", "1:radius=.25", job={"units": "mm"})
    assert metric.compensation.radius[1] == 0.25


def test_a_radius_from_a_comment_where_it_is_asked_for() -> None:
    program = "O1\n(T8 D=12. CR=0. - FLAT END MILL)\nT0808\nG0 X1.\nT0909 (1/2 INCH DIA. CUTTER)\nM30\n"
    asked = trace_of(program, job={"radius_from_comments": True})
    assert asked.compensation.radius[[1, 3]].tolist() == [6.0, 6.35]
    assert asked.offsets.radius_is_from_comment.tolist() == [False, *[True] * 4]
    assert asked.offsets.radii_from_comments[9].comment == "1/2 INCH DIA. CUTTER"
    given = trace_of(program, "fanuc", "8:radius=5", job={"radius_from_comments": True})
    assert given.compensation.radius[1] == 5
    assert not given.offsets.radius_is_from_comment[1]
    assert np.isnan(trace_of(program).compensation.radius).all()


def test_a_column_is_made_once() -> None:
    trace = tables_of(PROGRAM)["trace"]
    assert trace.blocks.word("X") is trace.blocks.word("X")
    assert trace.modal.state("plane") is trace.modal.state("plane")
