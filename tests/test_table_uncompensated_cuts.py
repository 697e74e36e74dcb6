"""Moves with G40 through what the contours of a section leave, and moves that only pass it."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, tables_of

from polarcheck.geometry.overcuts import without_compensation

RULE = "uncompensated-cut-into-part"
MM = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X150. Z2. C0\nG12.1\nG1 X90. C0 F500\n{}\nG13.1\nM30\n"
INCH = MM.replace("G21", "G20").replace("X150. Z2.", "X6. Z.1").replace("X90. C0 F500", "X4. C0 F20.")
HEXAGON = "G42 X40. C0/X20. C17.32/X-20./X-40. C0/X-20. C-17.32/X20./X40. C0/G40 X80. C5."
POCKET = "G41 X40. C0/C16./X-40./C-16./X40./C0/G40 X4. C1."
FLAT = "X90. C-36./Z-3./G42 X40. C-30./C30./G40 X90. C36."


def found(
    blocks: str, head: str = MM, machine: str = "fanuc", radius: float = 5, bar: float | None = None
) -> list[tuple[str, str]]:
    """The block and the severity of each finding of the rule, those that follow from others included."""
    job = {} if bar is None else {"stock": {"diameter": bar}}
    report = report_of(head.format(blocks.replace("/", "\n")), machine, f"1:radius={radius}", job=job)
    findings = [one for first in report.findings for one in (first, *first.follows)]
    return [(one.block, one.severity) for one in findings if one.rule == RULE]


@looped(
    ("blocks", "expected"),
    [
        (f"Z-3./{HEXAGON}/X-80.", ("X-80.", "warning")),
        (f"Z-3./{HEXAGON}/G1 X-60.", ("G1 X-60.", "warning")),
        (f"Z-3./{HEXAGON}/G0 X-80.", ("G0 X-80.", "error")),
        (f"Z-3./{HEXAGON}/G3 X-70. C5. R60.", ("G3 X-70. C5. R60.", "warning")),
        # Deeper than the contour, too near to it, and before it.
        (f"Z-3./{HEXAGON}/Z-5./X-80.", ("X-80.", "warning")),
        (f"Z-3./{HEXAGON}/C-21./X-80.", ("X-80.", "warning")),
        (f"Z-3./X-80./X-80. C40./X90./C0/{HEXAGON}", ("X-80.", "warning")),
        # Down beside the wall, and wholly within the part.
        (f"Z-3./{HEXAGON}/Z2./X46. C0/Z-3./Z2.", ("Z-3.", "warning")),
        (f"Z-3./{HEXAGON}/Z2./X4./Z-4./X-4./Z2.", ("X-4.", "warning")),
        # Out of a pocket.
        (f"Z2./X4. C1./Z-3./{POCKET}/X80.", ("X80.", "warning")),
        (f"Z2./X4. C1./Z-3./{POCKET}/G13.1/G0 X80./G12.1", ("G0 X80.", "error")),
        # Across a flat, whether the bar is known or not.
        (f"{FLAT}/X-90./X90. C0/X-90.", ("X90. C0", "warning")),
        # One deeper contour bounds the part of the other.
        (f"Z-3./{HEXAGON}/Z2./X4. C1./Z-6./G41 X16. C0/C6./X-16./C-6./X16./C0/G40 X4. C1./X30.", ("X30.", "warning")),
    ],
    one_in=12,
)
def test_through_the_part(blocks: str, expected: tuple[str, str]) -> None:
    assert found(blocks) == [expected]


@looped(
    "blocks",
    [
        # Above the contour: a slot or a facing pass.
        f"Z-3./{HEXAGON}/Z-1./X-80.",
        f"Z-3./{HEXAGON}/Z2./X-80.",
        # Round the part, and through stock that lies outside of it.
        f"Z-3./{HEXAGON}/C40./X-80./C-40./X80./C0",
        f"Z-3./X52. C0/C26./X-52./C-26./X52./C0/X80./{HEXAGON}",
        # A hole within the part.
        f"Z-3./{HEXAGON}/Z2./X4./Z-8./Z2.",
        # In a pocket, also one that goes deeper than the boss round it.
        f"Z2./X4. C1./Z-3./X-4./X4./{POCKET}/X-8./Z2.",
        f"Z-3./{HEXAGON}/Z2./X4. C1./Z-6./G41 X16. C0/C6./X-16./C-6./X16./C0/G40 X4. C1./X-4./Z2.",
        # Beside the end of a flat.
        f"{FLAT}/X120./C-36./X48.",
        # Nobody knows where Z is, or which way is taken.
        f"W-3./{HEXAGON}/#1=#5021/Z#1/X-80.",
        f"Z-3./{HEXAGON}/G13.1/G0 X80. C90./X20.",
        f"Z-3./{HEXAGON}/G13.1/G0 Z2./X20.",
        f"Z-3./{HEXAGON}/G13.1/G28 U0/X20.",
    ],
    one_in=12,
)
def test_past_the_part(blocks: str) -> None:
    assert found(blocks) == []


def test_in_inch_and_where_rapid_traverse_is_allowed() -> None:
    hexagon = "Z-.1/G42 X1.6 C0/X.8 C.69/X-.8/X-1.6 C0/X-.8 C-.69/X.8/X1.6 C0/G40 X3.2 C.2"
    assert found(f"{hexagon}/X-3.2", INCH, radius=0.2) == [("X-3.2", "warning")]
    head = MM.replace("G12.1", "G112").replace("G13.1", "G113").replace("C", "Y").replace("Z2. Y0", "Z2. C0")
    blocks = f"Z-3./{HEXAGON}/G0 X-80.".replace("C", "Y")
    report = report_of(head.format(blocks.replace("/", "\n")), "haas-lathe", "1:radius=5", only=[RULE])
    assert ("G0 X-80.", RULE, "error") in [(one.block, one.rule, one.severity) for one in report.findings]
    # One finding for moves of one loop, the worst.
    report = report_of(
        head.format(f"{blocks}/G1 X80./G0 X-80.".replace("/", "\n")), "haas-lathe", "1:radius=5", only=[RULE]
    )
    [finding] = [one for one in report.findings if one.rule == RULE]
    assert (finding.severity, finding.count) == ("error", 3)


@pytest.mark.ci
def test_walls_near_moves_are_found_alike_one_by_one_and_all_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    pocket = "G41 X16. C0/C6./X-16./C-6./X16./C0/G40 X4. C1."
    blocks = f"Z-3./{HEXAGON}/C21./X-80./C60./X90./C0/Z2./X4. C1./Z-6./{pocket}/X30."
    all_at_once = found(blocks)
    monkeypatch.setattr(without_compensation, "_PAIRS_AT_ONCE", 1)
    assert found(blocks) == all_at_once
    assert len(all_at_once) > 1


def test_where_rapid_traverse_is_an_alarm_it_follows_from_that() -> None:
    program = MM.format(f"Z-3./{HEXAGON}/G0 X-80.".replace("/", "\n"))
    [finding] = [one for one in report_of(program, "fanuc", "1:radius=5").findings if one.severity == "error"]
    assert finding.rule == "rapid-in-polar"
    assert [one.rule for one in finding.follows] == [RULE]


@pytest.mark.nightly
@looped(
    ("move", "beginning", "end"),
    [
        ("X-80.", "G1 without compensation leads through the part that the contour of line ", " Z-3; retract Z "),
        ("C-22./X-80.", "G1 without compensation goes 0.32 mm deep into the part that the contour of line ", " Z-3; "),
        ("Z2./X32. C0/Z-3./Z2.", "G1 without compensation goes down into the part that the contour of line ", " Z-3; "),
    ],
)
def test_the_message(move: str, beginning: str, end: str) -> None:
    report = report_of(MM.format(f"Z-3./{HEXAGON}/{move}".replace("/", "\n")), "fanuc", "1:radius=5")
    [message] = [one.message for one in report.findings if one.rule == RULE]
    assert message.startswith(beginning)
    assert end in message


def test_a_bar_that_is_known_bounds_the_part() -> None:
    assert found(f"{FLAT}/X120./C-20./X-120./C20.", bar=50) == [("X-120.", "warning")]
    assert found(f"{FLAT}/X120./C-30.2/X-120./C32.", bar=50) == []


@looped("text", ["O1\nM30\n", "", MM.format(HEXAGON.replace("/", "\n")).replace("T0101", "T0202")])
def test_without_a_contour_or_its_radius_nothing_is_said(text: str) -> None:
    cuts = tables_of(text, "fanuc", "1:radius=5")["uncompensated_cuts"]
    assert not cuts.depth.any()
    assert not cuts.is_rapid.any()


#: The hexagon with its offset cancel left open; at X46 a cutter of R5 is 3 mm from its corner, that is in the part.
OPEN = HEXAGON.removesuffix("X80. C5.")


@pytest.mark.nightly
@looped(
    ("blocks", "expected"),
    [
        # Away from a cancel that is too short, and the block behind that.
        (f"{OPEN}X46. C0/C3.", []),
        (f"{OPEN}X46. C0/C3./C-3.", ["C-3."]),
        (f"{OPEN}X80. C5./X46. C0/C3.", ["X46. C0"]),
        # Wherever it comes from, a cut as deep as the cutter is wide is one.
        (f"{OPEN}X46. C0/X-80.", ["X-80."]),
        # To a start-up that is too short, and the block before that.
        (f"X46. C-3./{HEXAGON}", []),
        (f"X46. C-3./C3./{HEXAGON}", ["X46. C-3."]),
        (f"X46. C-3./X46. C0/X80. C0/{HEXAGON}", ["X46. C0"]),
        # Both ramps, each with its block.
        (f"X46. C-3./{OPEN}X46. C0/C3.", []),
    ],
    one_in=4,
)
def test_beside_a_ramp_that_is_too_short_the_way_is_no_second_mistake(blocks: str, expected: list[str]) -> None:
    assert [block for block, _ in found(f"Z-3./{blocks}")] == expected
