"""Walls of two loops of one section that are nearer to each other than the cutter is wide, and loops that are not."""

from __future__ import annotations

import pytest
from cases import looped
from programs import report_of, said, tables_of

MM = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X150. Z2. C0\nG12.1\nG1 F300\n{}\nG13.1\nM30\n"
INCH = MM.replace("G21", "G20").replace("X150. Z2.", "X6. Z.1").replace("F300", "F10.")
SLOT = "G41 X50. C3./X-50./G40 X-70. C0./G41 X-50. C-3./X50./G40 X70. C0."


def program(blocks: str, head: str = MM) -> str:
    return head.format(blocks.replace("/", "\n"))


def found(blocks: str, radius: float, head: str = MM, machine: str = "fanuc") -> list[tuple[str, str]]:
    """The block and the rule of each error."""
    report = report_of(program(blocks, head), machine, f"1:radius={radius}")
    return [(one.block, one.rule) for one in report.findings if one.severity == "error"]


@pytest.mark.nightly
@looped(
    ("blocks", "radius", "head", "machine", "block"),
    [
        (SLOT, 5, MM, "fanuc", "X-50."),
        (SLOT, 3.01, MM, "fanuc", "X-50."),
        (SLOT, 5, MM, "mitsubishi-m700", "X-50."),
        ("G41 X2. C.12/X-2./G40 X-2.8 C0/G41 X-2. C-.12/X2./G40 X2.8 C0", 0.2, INCH, "fanuc", "X-2."),
        # Across, and at a slant.
        ("G41 X6. C-25./C25./G40 X0. C35./G41 X-6. C25./C-25./G40 X0. C-35.", 5, MM, "fanuc", "C25."),
        (
            "G41 X60. C16./X-20. C-24./G40 X-48. C-42.25/G41 X-28. C-36.5/X52. C3.5/G40 X80. C21.75",
            5,
            MM,
            "fanuc",
            None,
        ),
        # A pocket and an island in it.
        (
            "X50. C0/G41 X60. C5./C30./X-60./C-30./X60./C5./G40 X50. C0/"
            "G42 X40. C5./C20./X-40./C-20./X40./C5./G40 X50. C0",
            5.5,
            MM,
            "fanuc",
            None,
        ),
    ],
    one_in=3,
)
def test_two_walls_that_leave_less_than_the_cutter(
    blocks: str, radius: float, head: str, machine: str, block: str | None
) -> None:
    [(first, rule)] = found(blocks, radius, head, machine)
    assert rule == "slot-narrower-than-cutter"
    assert block in (None, first)


@pytest.mark.ci
@looped("tail", ["", "Z-2./{0}", "Z-2./{0}/Z-4./{0}"])
def test_one_finding_for_both_walls_at_all_depths(tail: str) -> None:
    only = ["slot-narrower-than-cutter"]
    report = report_of(program(f"{SLOT}/{tail.format(SLOT)}".rstrip("/")), "fanuc", "1:radius=5", only=only)
    [finding] = report.findings
    assert finding.rule == "slot-narrower-than-cutter"
    assert finding.count == 2 * (1 + tail.count("{0}"))
    assert finding.message.startswith("lines 8 and 11 leave 6 mm for a cutter of 10 mm: it goes 4 mm deep into")
    assert finding.message.endswith("take a cutter of 6 mm at most, or write the walls farther apart")


def test_two_slots_are_two_findings() -> None:
    other = SLOT.replace("C3.", "C23.").replace("C-3.", "C17.").replace("C0.", "C20.")
    assert [rule for _, rule in found(f"{SLOT}/{other}", 5)] == ["slot-narrower-than-cutter"] * 2


def test_round_a_corner_there_is_no_room() -> None:
    """The way round an acute corner leads farther from it than R."""
    tables = tables_of(program(SLOT), "fanuc", "1:radius=5")
    assert tables["slots"].width(7) == pytest.approx(6)
    corner = "X60. C-30./G42 X20. C-14./X0. C4./X-20. C-14./G40 X-60. C-30."
    above = "X-120. C10./G42 X-60. C12.5/X60./G40 X120. C10."
    report = report_of(program(f"{corner}/{above}"), "fanuc", "1:radius=4")
    [finding] = [one for one in report.findings if one.severity == "error"]
    assert finding.message.startswith("line 14 leaves no room to go round the corner of line 9 for a cutter of 8 mm")
    assert "take a smaller cutter" in finding.message


@pytest.mark.ci
@looped(
    ("blocks", "radius"),
    [
        (SLOT, 2.9),
        # The walls at different depths.
        (SLOT.replace("/G41 X-50.", "/Z1./G41 X-50."), 5),
        # A boss roughed and finished, in a loop each.
        (
            "X80. C0/G42 X46. C0/C12./X-46./C-12./X46./C0/G40 X80. C2./"
            "G42 X40. C0/C10./X-40./C-10./X40./C0/G40 X80. C2.",
            5,
        ),
        # A pocket likewise.
        (
            "X8. C1./G41 X30. C0/C12./X-30./C-12./X30./C0/G40 X8. C1./G41 X40. C0/C16./X-40./C-16./X40./C0/G40 X8. C1.",
            5,
        ),
        # Flats in a loop each, whose leads cross each other's walls.
        (
            "/".join(
                (
                    "X90. C-36.",
                    "G42 X40. C-30./C30./G40 X90. C36.",
                    "G42 X60. C20./X-60./G40 X-72. C45.",
                    "G42 X-40. C30./C-30./G40 X-90. C-36.",
                    "G42 X-60. C-20./X60./G40 X72. C-45.",
                )
            ),
            5,
        ),
        # The same wall in two loops.
        ("X80. C-30./G42 X40. C-20./C20./G40 X80. C30./X120./C-30./X80./G42 X40. C-20./C20./G40 X80. C30.", 5),
    ],
    one_in=2,
)
def test_loops_that_cut_nothing_of_each_other(blocks: str, radius: float) -> None:
    assert found(blocks, radius) == []


@pytest.mark.nightly
def test_a_ramp_through_the_wall_of_another_loop() -> None:
    boss = "X-30. C-40./G42 X-20. C-10./X20./C10./X-20./C-10./G40 X-30. C-40."
    other = "G42 X60. C30./X80./C40./X60./C30./G40 X60. C70."
    [(block, rule)] = found(f"X80. C-40./{boss}/{other}", 2)
    assert (block, rule) == ("G42 X60. C30.", "start-up-sweeps-contour")
    report = report_of(program(f"X80. C-40./{boss}/{other}"), "fanuc", "1:radius=2")
    assert "the contour of line" in report.findings[0].message


@looped("text", [program(SLOT).replace("T0101", "T0202"), program(SLOT).replace("G41 ", ""), "O1\nM30\n", ""])
def test_without_radius_or_compensation_nothing_is_compared(text: str) -> None:
    slots = tables_of(text, "fanuc", "1:radius=5")["slots"]
    assert not slots.depth.any()
    assert not slots.ramp_depth.any()
    assert (slots.slot == -1).all()


def test_what_a_wrong_arc_leads_to_is_no_slot() -> None:
    assert said(report_of(program(SLOT.replace("G41 X50.", "G2 R1. G41 X50.")), "fanuc", "1:radius=5")) != []


def test_a_lone_wall_is_not_that_of_a_slot_at_another_depth() -> None:
    """Two slots at two depths; the lone wall is at the depth of the first, and above the middle of the second."""
    ways = [[f"X{2 * way * side:g}." for way in (6, 10, 20, 24)] for side in (1, -1)]
    slots = [
        f"G1 {inside} C0/Z{z}/G41 {near} C1.5/{far}/G40 {outside} C0/G41 {far} C-1.5/{near}/G40 {inside} C0/Z2./"
        for (inside, near, far, outside), z in zip(ways, ("-1.", "-2."), strict=True)
    ]
    inside, near, far, outside = ways[1]
    lone = f"G1 {inside} C0/Z-1./G41 {near} C0/{far}/G40 {outside} C0/Z2./"
    blocks = program(slots[0] + lone + slots[1])
    only = ["slot-narrower-than-cutter"]
    assert said(report_of(blocks, "fanuc", "1:radius=1", only=only)) == []
    (line,) = (number for number, block in enumerate(blocks.splitlines(), 1) if block.startswith("Z-2."))
    ((first, _),) = said(report_of(blocks, "fanuc", "1:radius=1.6", only=only))
    assert first > line
