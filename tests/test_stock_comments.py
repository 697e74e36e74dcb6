"""The bar that comments state, and comments that state none."""

from __future__ import annotations

import math

import pytest
from cases import looped
from programs import tables_of

from polarcheck.columns.words.comment_reader import bar_in
from polarcheck.columns.words.stock_comments import StockComments


@looped(
    ("comment", "inch", "diameter"),
    [
        ("BAR DIA 28", False, 28),
        ("STOCK D50", False, 50),
        ("stock: od 50", False, 50),
        ("RD 40", False, 40),
        ("1.25 BAR", True, 31.75),
        ("28MM BAR", False, 28),
        ("BAR D=28.", False, 28),
        ("BAR D=28.5.", False, 28.5),
        ("BAR DIA 28MM X 100", False, 28),
        ('BAR DIA 1-1/4"', False, 31.75),
        ("BAR 12,5", False, 12.5),
        ("40 DIA STOCK", False, 40),
        ("D50 STOCK", False, 50),
        ("\u00d840 BAR", False, 40),
        ("HEX 24 AF FROM BAR DIA 28", False, 28),
        ('MATERIAL: 5-1/2" ALUMINUM BARSTOCK', True, 139.7),
        ("MATERIAL: 2.625 304SS BARSTOCK", True, 66.675),
    ],
)
def test_round_bars(comment: str, inch: bool, diameter: float) -> None:
    bar = bar_in(f"({comment})", inch)
    assert bar is not None
    assert bar.diameter == pytest.approx(diameter)
    assert math.isnan(bar.across_flats)


@looped(
    ("comment", "inch", "across_flats"),
    [
        ("HEX BAR 32", False, 32),
        ("32 HEX BAR", False, 32),
        ("HEX 32 BAR", False, 32),
        ("STOCK HEX 32 AF", False, 32),
        ("1 1/4 HEX BAR", True, 31.75),
        ("HEXAGON BAR 27", False, 27),
    ],
)
def test_hexagon_bars(comment: str, inch: bool, across_flats: float) -> None:
    bar = bar_in(f"({comment})", inch)
    assert bar is not None
    assert bar.across_flats == pytest.approx(across_flats)
    assert math.isnan(bar.diameter)


@looped("inch", [False, True])
@looped(
    "comment",
    [
        '1.25" BORING BAR',
        "JAW PRESSURE: 10 BAR",
        "CHUCK ON 4.27 DIA",
        "10 BAR",
        "70 BAR COOLANT",
        "BORING BAR D16",
        "T5 BAR D12",
        "BAR DIA 16 CCMT",
        "BAR PULLER D20",
        "STOCK 0.5",
        "LEAVE STOCK D5.",
        "SQ BAR 20",
        "BAR 40 X 20",
        "BAR 28 LONG",
        "HEX 24 AF",
        "HEX 24 AF FROM BAR 28",
        "G54=Z0 FACE OF STOCK",
        'MATERIAL: 2.75" OD STEEL TUBING 1.73 L',
        'MATERIAL: 6" OD OR LARGER 6061 ALUMINUM BARSTOCK 3.2"L',
        'MATERIAL: " 6061 ALUMINUM BARSTOCK 2.6"L',
        '3.25 X1.75" 6061 BILLET',
        "3RD 40",
        "BAR 99999999999999999999",
        "BAR DIA 3/7",
    ],
)
def test_comments_that_state_no_bar(comment: str, inch: bool) -> None:
    assert bar_in(f"({comment})", inch) is None


def bars_of(program: str) -> StockComments:
    table: StockComments = tables_of(program)["stock_comments"]
    return table


def test_the_bar_holds_for_its_program() -> None:
    bars = bars_of("O1 (1.25 BAR)\nG20\nT0101\nM30\nO2\n(HEX BAR 32)\n(BAR FEEDER)\nG21\nM30\nO3\nG21\nM30\n")
    assert [(bar.line, bar.text, bar.program) for bar in bars.stated] == [(1, "(1.25 BAR)", 0), (6, "(HEX BAR 32)", 1)]
    assert bars.diameter.tolist()[:4] == [31.75] * 4
    assert bars.across_flats.tolist()[4:7] == [32.0] * 3
    assert bars.comment.tolist() == [0] * 4 + [1] * 3 + [-1] * 3


def test_two_bars_of_one_program_are_none() -> None:
    bars = bars_of("O1 (BAR DIA 28)\nG21\n(BAR DIA 30)\nM30\n")
    assert len(bars.stated) == 2
    assert bars.of_program == {}
    assert bars_of("O1 (BAR DIA 28)\nG21\n(STOCK D28)\nM30\n").of_program[0].diameter == 28


def test_a_program_without_comments_states_none() -> None:
    assert bars_of("O1\nG21\nM30\n").stated == []
    assert bars_of("").stated == []
    assert bars_of("(BAR DIA 28)\n").stated == []
