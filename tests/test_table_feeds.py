"""F in the polar mode: whether one is in force, where it changes, and what the acceleration of C leaves of it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import report_of, tables_of

PER_MINUTE_ONLY = {"feed": {"carried_into_polar": "per-minute-only"}}


def lines(program: str, column: str, changes: dict[str, Any] | None = None) -> list[int]:
    """The lines of cutting moves in which a column holds; each line of these programs is a row."""
    tables = tables_of(program, changes=changes)
    found = getattr(tables["feeds"], column) & tables["trace"].path.cuts
    return (np.flatnonzero(found) + 1).tolist()


@looped(
    ("program", "expected"),
    [
        ("O1\nG98 G0 X60. C0\nG12.1\nG1 X40.\nC10. F200\nC5.\nX60. F0\nX50.\nG13.1\n", [4, 7, 8]),
        ("O1\nG98 G0 X60. C0\nG1 Z5. F100\nG12.1\nG1 X40.\nC10.\nG13.1\n", []),
        ("O1\nG98 G0 X60. C0 F100\nM30\nO2\nG0 X60. C0\nG12.1\nG1 X40.\nG13.1\n", [7]),  # of another program
        ("G98 G0 X60. C0\nG12.1\nG1 X40.\nG13.1\n", [3]),  # an excerpt that shows where it begins
        ("G12.1\nG1 X40.\nC10.\nG13.1\n", []),  # what stands before it may have given one
        ("G12.1\nG1 X40. F0\nC10.\nG13.1\n", [2, 3]),
        ("O1\nM98 P7777\nG12.1\nG1 X40.\nG13.1\n", []),  # so may a program that is not there
        ("O1\nG0 X60. C0\nG4 F100\nG12.1\nG1 X40.\nG13.1\n", []),
    ],
)
def test_missing(program: str, expected: list[int]) -> None:
    assert lines(program, "missing") == expected


TURNED = "O1\nG99 G0 X60. C0\nG1 Z-5. F.2\nG12.1\n"


@looped(
    ("program", "expected"),
    [
        (TURNED + "X40.\nC10.\nX30. F200\nC5.\nG13.1\n", [5, 6]),
        (TURNED + "X40. F200\nC10.\nG13.1\nG12.1\nX40.\nG13.1\n", [9]),  # each section wants its own
        (TURNED + "G98\nX40.\nC10. F200\nG13.1\n", [6]),
        (TURNED.replace("G99", "G98") + "X40.\nC10.\nG13.1\n", []),
    ],
)
def test_lost(program: str, expected: list[int]) -> None:
    """Where F per revolution is not taken over; elsewhere it never is lost."""
    assert lines(program, "lost", PER_MINUTE_ONLY) == expected
    assert lines(program, "lost") == []


def test_an_f_begins_where_it_is_not_that_of_the_cutting_move_before() -> None:
    program = (
        "G98 G0 X60. C0 F50\nG12.1\nG1 X40.\nC10. F200\nC5. F200\nF100\nM8\nC4.\nG0 C3.\nG1 C2.\nZ5. F80\nC1.\n"
        "G13.1\nG12.1\nG1 C5. F80\nG13.1\n"
    )
    assert lines(program, "begins") == [3, 4, 8, 12, 15]


NEAR = "G98 G0 X60. C0\nG12.1\nG1 X2. C10. F200\nC-10. F300\nX60. F{}\nM8\nG13.1\n"


def test_the_f_that_the_acceleration_of_c_allows() -> None:
    """On a line at the distance d it asks for 0.6495 F^2 / d^2: allowed is F * sqrt(limit / that)."""
    limit = 500.0
    allowed = tables_of(NEAR.format("200"), changes={"limits": {"c_acceleration": limit}})["feeds"]
    column = allowed.allowed_by_acceleration
    asked = math.degrees(3 * math.sqrt(3) / 8 * (300 / 60) ** 2)  # at d = 1
    assert column[3] == pytest.approx(300 * math.sqrt(limit / asked))
    assert column[[2, 4, 5]] == pytest.approx([200, 200, 200])
    assert np.isnan(column[:2]).all()
    assert (np.flatnonzero(allowed.is_limited_in_acceleration) + 1).tolist() == [3, 4, 5]


def test_without_a_limit_of_the_acceleration_any_f_is_allowed() -> None:
    feeds = tables_of(NEAR.format("200"))["feeds"]
    assert np.isinf(feeds.allowed_by_acceleration).all()
    assert np.isinf(feeds.allowed_by_x_acceleration).all()
    assert not feeds.is_limited_in_acceleration.any()


def test_without_any_acceleration_no_f_is_allowed_but_where_c_keeps_its_rate() -> None:
    column = tables_of(NEAR.format("0"), changes={"limits": {"c_acceleration": 0}})["feeds"].allowed_by_acceleration
    assert column[[2, 3, 4]].tolist() == [0, 0, 0]


# ---- the clamp of the mode ----

CLAMP = {"limits": {"polar_feed": 500, "polar_feed_clamps": True}}
NO_CLAMP = {"limits": {"polar_feed": 500, "polar_feed_clamps": False}}
FAST = "O1\nG98 G0 X60. C0\nG1 Z-1. F2000\nG12.1\nG1 X40.\nC10. F200\nX60. F800\nG4 X1.\nG13.1\nG1 Z5. F900\n"


@looped("name", ["fanuc", "gsk-988"])
def test_f_of_the_mode_is_clamped_and_f_outside_is_not(name: str) -> None:
    trace = tables_of(FAST, name, changes=CLAMP)["trace"]
    assert trace.feedrate.feed[2:].tolist() == [2000, 2000, 500, 200, 500, 500, 800, 900]
    assert trace.feedrate.programmed_feed[2:].tolist() == [2000, 2000, 2000, 200, 800, 800, 800, 900]
    off = tables_of(FAST, name, changes=NO_CLAMP)["trace"]
    assert (
        off.feedrate.feed[2:].tolist()
        == off.feedrate.programmed_feed[2:].tolist()
        == trace.feedrate.programmed_feed[2:].tolist()
    )


def test_an_unknown_f_or_limit_clamps_nothing() -> None:
    per_revolution = tables_of("O1\nG99 G0 X60. C0\nG12.1\nG1 X40. F.2\nG13.1\n", changes=CLAMP)["trace"]
    assert np.isnan(per_revolution.feedrate.feed).all()
    no_limit = tables_of(FAST, changes={"limits": {"polar_feed_clamps": True}})["trace"]
    assert no_limit.feedrate.feed[2:].tolist() == no_limit.feedrate.programmed_feed[2:].tolist()


@looped("units", ["G21", "G20"])
def test_rates_and_times_are_those_of_the_clamped_f(units: str) -> None:
    """As if the lower F were written; in inch as well, the limit being in mm/min."""
    scale = 25.4 if units == "G20" else 1
    program = f"O1\n{units} G98 G0 X{60 / scale:.8f} C0\nG12.1\nG1 X{{}} F{{}}\nC{10 / scale:.8f}\nG13.1\n"
    asked = program.format(f"{40 / scale:.8f}", f"{1500 / scale:.8f}")
    written = program.format(f"{40 / scale:.8f}", f"{500 / scale:.8f}")
    clamped, plain = (tables_of(text, changes=CLAMP)["moves"] for text in (asked, written))
    assert clamped.feed == pytest.approx([500, 500])
    for column in ("feed", "c_feed", "x_feed", "c_acceleration", "x_acceleration", "time"):
        assert getattr(clamped, column) == pytest.approx(getattr(plain, column)), column
    unclamped = tables_of(asked, changes=NO_CLAMP)["moves"]
    assert unclamped.c_feed == pytest.approx(3 * clamped.c_feed)
    assert unclamped.time == pytest.approx(clamped.time / 3)


# ---- F of feed per revolution that is read per minute ----

LEFT_OVER = "feed-of-revolution-per-minute"
M700 = "mitsubishi-m700"


def told(blocks: str, machine: str, system: str = "") -> list[tuple[int, str]]:
    """Line and message of each finding of the rule."""
    changes = {"control": {"g_code_system": system}} if system else None
    report = report_of("\n".join(["O1", *blocks.split("/"), "M30"]), machine, changes=changes)
    return [(found.line, found.message) for found in report.findings if found.rule == LEFT_OVER]


@pytest.mark.nightly
@looped(
    ("blocks", "machine", "line", "number"),
    [
        # The F of before, written again in a mode in which every F is per minute.
        ("G95 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G1 X40. F.1/C5./G13.1", M700, 5, "0.1"),
        ("G95 G0 X60. Z2. C0/G1 Z1. F2./G12.1/G1 X40. F2./C5./G13.1", M700, 5, "2"),
        ("G95 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G1 Z-1. F.15/X40. F200/C5./G13.1", M700, 5, "0.15"),
        # A code of feed per revolution in the mode, and an F that could be nothing else.
        ("G94 G0 X60. Z2. C0/G12.1/G95 G1 X40. F.2/C5./G13.1", M700, 4, "0.2"),
        ("G95 G0 X60. Z2. C0/G12.1/G1 X40. F.2/C5./G13.1", M700, 4, "0.2"),
        # The F of before is taken over, since feed per minute is in force at G12.1.
        ("G95 G0 X60. Z2. C0/G1 Z1. F.1/G94/G12.1/G1 X40./C5./G13.1", M700, 6, "0.1"),
        ("G95 G0 X60. Z2. C0/G1 Z1. F.1/G94/G12.1/G1 Z-1./X40./C5./G13.1", M700, 6, "0.1"),
        # Everywhere: G98 changes what the number means.
        ("G99 G0 X60. Z2. C0/G1 Z1. F.1/G98/G12.1/G1 X40./C5./G13.1", "fanuc", 6, "0.1"),
        ("G99 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G98 G1 X40./C5./G13.1", "fanuc-16i", 5, "0.1"),
        ("G99 G0 X60. Z2. C0/G1 Z1. F.1/G98/G12.1/G1 X40. F.1/C5./G13.1", "fanuc", 6, "0.1"),
        ("G99 G0 X60. Z2. C0/G1 Z1. F.1/G98/G0 X60./G12.1/G1 Z-1./X40./G13.1", "fanuc", 7, "0.1"),
    ],
    one_in=2,
)
def test_f_of_feed_per_revolution_is_read_per_minute(blocks: str, machine: str, line: int, number: str) -> None:
    ((found, message),) = told(blocks, machine)
    assert (found, message.startswith(f"{number} mm/min here: F")) == (line, True)


def test_the_same_with_g98_and_g99_of_the_other_list_of_codes() -> None:
    assert len(told("G99 G0 X60. Z2. C0/G1 Z1. F.1/G98/G12.1/G1 X40./C5./G13.1", M700, "A")) == 1
    assert len(told("G99 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G1 X40. F.1/C5./G13.1", M700, "A")) == 1


@pytest.mark.nightly
@looped(
    ("blocks", "machine"),
    [
        ("G95 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G1 X40. F100/C5./G13.1/G1 X60.", M700),
        ("G95 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G1 X40. F2./C5./G13.1", M700),  # slow, and not the F of before
        ("G95 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G1 X40./C5./G13.1", M700),  # P62, and nothing moves
        ("G94 G0 X60. Z2. C0/G1 Z1. F.5/G12.1/G1 X40./C5./G13.1", M700),  # nothing is per revolution
        ("G94 G0 X60. Z2. C0/G12.1/G95 G1 X40. F200/C5./G13.1", M700),  # as every F of the mode
        ("G94 G0 X60. Z2. C0/G12.1/G1 X40. F.5/C5./G13.1/G95 G1 X60. F100", M700),
        ("G99 G0 X60. Z2. C0/G1 Z1. F200/G98/G12.1/G1 X40./C5./G13.1", "fanuc"),  # G98 forgotten above, put right
        ("G99 G0 X60. Z2. C0/G1 Z1. F.1/G98 F200/G12.1/G1 X40./C5./G13.1", "fanuc"),
        ("G99 G0 X60. Z2. C0/G1 Z1. F.1/G12.1/G1 X40./C5./G13.1", "fanuc"),  # per revolution still
        ("G98 G0 X60. Z2. C0/G12.1/G1 X40. F.5/C5./G13.1", "fanuc"),
        ("G98 G0 X60. Z2. C0/G12.1/G1 X40. F200/C5./G13.1/G99 G1 X60. F.2", "fanuc"),
    ],
    one_in=2,
)
def test_f_that_is_meant_as_it_is_read(blocks: str, machine: str) -> None:
    assert told(blocks, machine) == []


def test_a_feed_left_over_that_the_builder_would_not_recommend_is_one_finding() -> None:
    start = "O1\nM5\nM35\nG28 H0\nG97 S2000 M33\nG99 G0 X3. Z.2 C0\nG1 Z.1 F.008\n"
    report = report_of(f"{start}G98\nG12.1\nG1 X2.\nC.5\nG13.1\nM30\n", "turning-center")
    feeds = [(found.rule, [one.rule for one in found.follows]) for found in report.findings if "feed" in found.rule]
    assert feeds == [(LEFT_OVER, ["feed-outside-recommended-range"])]
