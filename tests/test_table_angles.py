"""Words of the virtual axis that look like angles: columns by construction."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import report_of, tables_of

from polarcheck.columns.words.angles import Angles

#: The angles that one writes, as a list of its own.
USUAL = [30, 45, 60, 90, 120, 135, 150, 180, 210, 225, 240, 270, 300, 315, 330, 360]


def table(program: str, machine: str = "fanuc", **changes: Any) -> Angles:
    angles: Angles = tables_of(program, machine, changes=changes)["angles"]
    return angles


def lines(angles: Angles, column: str) -> list[int]:
    return angles.trace.blocks.line[getattr(angles, column)].tolist()


def test_usual_angles_are_these_and_no_others() -> None:
    values = [*range(0, 400, 5), 30.5, 44.999, 1000]
    program = "G12.1\n" + "".join(f"C{'-' if value % 2 else ''}{value:.3f}\n" for value in values)
    angles = table(program + "G13.1\n")
    found = angles.trace.blocks.word("C")[angles.is_usual]
    assert np.abs(found).tolist() == USUAL


@looped(
    ("program", "machine", "found"),
    [
        ("C90.\nG12.1\nX90. C90.\nH90.\nG13.1\nC90.\n", "fanuc", [3]),
        # The number as it is written, not the length.
        ("G20\nG12.1\nC90.\nG13.1\n", "fanuc", [3]),
        # The axis is the machine's.
        ("G112\nY90.\nC90.\nG113\n", "haas-lathe", [2]),
        # Where C is no coordinate of a move it is neither length nor angle.
        ("G12.1\nG28 C90.\nG1 C45.\nG13.1\n", "fanuc", [3]),
    ],
)
def test_where_an_angle_is_looked_for(program: str, machine: str, found: list[int]) -> None:
    assert lines(table(program, machine), "is_usual") == found


def test_both_signs_in_one_section() -> None:
    program = "G12.1\nC45.\nC-45.\nC90.\nC30.\nC30.\nG13.1\nG12.1\nC-90.\nC60.\nC-60.\nC15.\nC-15.\nG13.1\n"
    assert lines(table(program), "has_both_signs") == [2, 3, 10, 11]
    assert lines(table("G12.1\nC10.\nG13.1\n"), "has_both_signs") == []
    assert lines(table("G1 X1.\n"), "has_both_signs") == []


def test_a_line_through_the_center_is_no_circle() -> None:
    """Every X of a circle of radius 0 is 0, whatever C is: so is that of a slot along C."""
    slot = "G0 X80. C0\nG12.1\nG1 X0.2 F200\nX0 C-120.\nC-60.\nC60.\nC120.\nC180.\nX80.\nG13.1\n"
    assert not table(slot).series.on_circle.any()
    assert not any(finding.rule == "degrees-in-polar" for finding in report_of(slot).findings)
    points = (
        "G0 X80. C0\nG12.1\nG1 X30. F200\nC36.\nX-11.459 C108.\nX-37.082 C180.\nX-11.459 C252.\nX30. C324.\nG13.1\n"
    )
    assert table(points).series.on_circle.any()


def test_virtual_length_is_in_mm_and_has_no_sign() -> None:
    angles = table("G20\nG12.1\nC-2.\nX1.\nG13.1\n")
    assert angles.virtual_length[2] == pytest.approx(50.8)
    assert np.isnan(angles.virtual_length[[0, 1, 3, 4]]).all()


def test_reach_leaves_out_what_may_be_an_angle() -> None:
    """X is a diameter: 80 reaches 40 mm, and 48 back from C-48; C180 and C-90 are left out."""
    program = "G0 X70. C0\nG12.1\nG1 X-80. F1\nC180.\nC-90.\nG13.1\nG0 X500.\nG12.1\nX20.\nC-48.\nC45.\nG13.1\n"
    program += "G12.1\nC48.\nG13.1\n"
    angles = table(program)
    first, second = angles.trace.mode.section == 0, angles.trace.mode.section == 1
    assert np.unique(angles.reach[first]).tolist() == [40.0]
    assert np.unique(angles.reach[second]).tolist() == [250.0], "X stands at 250 when the second section begins"
    assert np.isnan(angles.reach[~first & ~second]).all(), "in the third section nothing looks like an angle"
    by_c = table("G0 X20. C0\nG12.1\nG1 C-48. F1\nC-360.\nG13.1\n")
    assert np.nanmax(by_c.reach) == 48.0


def test_reach_by_a_plain_loop() -> None:
    generator = np.random.default_rng(3)
    program = []
    for _ in range(6):
        program += ["G0 X40. C0", "G12.1"]
        for _ in range(int(generator.integers(1, 9))):
            program.append(f"G1 X{generator.integers(-99, 99)}. C{generator.choice([*USUAL, 7, -13, 77])}. F100")
        program += ["C-90.", "G13.1"]
    angles = table("\n".join(program) + "\n")
    trace = angles.trace
    farthest = [0.0] * len(trace.mode.sections)
    for row in range(len(trace)):
        section = int(trace.mode.section[row])
        written = trace.blocks.word("C")[row]
        lengths = [abs(trace.path.x[row])] + ([abs(written)] if abs(written) not in USUAL else [])
        if section >= 0:
            farthest[section] = max([farthest[section], *(length for length in lengths if length == length)])
    assert len(farthest) == 6
    inside = trace.mode.section >= 0
    assert angles.reach[inside] == pytest.approx(np.array(farthest)[trace.mode.section[inside]])


def test_a_misplaced_cycle_is_a_drilling_cycle_that_the_profile_does_not_allow() -> None:
    program = "G83 X1. Z-1.\nC90.\nG80\nG12.1\nC90.\nG81 X1. Z-1.\nC90.\nG1 C90.\nG13.1\n"
    assert lines(table(program), "in_misplaced_cycle") == [1, 2, 6, 7]
    allowed = {"allowed_codes": ["G1", "G81"]}
    assert lines(table(program, polar=allowed), "in_misplaced_cycle") == [1, 2]


def moved(*blocks: str, units: str = "G21", machine: str = "fanuc", start: str = "X50. C0") -> list[int]:
    """The lines of the series of a section that look like a turn; its first block is line 4."""
    on, off = ("G112", "G113") if machine == "haas-lathe" else ("G12.1", "G13.1")
    return lines(table("\n".join([units, f"G0 {start}", on, *blocks, off, ""]), machine), "in_series")


@pytest.mark.ci
@looped(
    ("blocks", "count"),
    [
        (["X40. C72.", "C144.", "C216.", "C288.", "C360."], 5),
        (["C-72.", "C-144.", "C-216.", "C-288.", "C-360."], 5),
        (["H72."] * 5, 5),
        # One step before the full turn, since there is the first place again.
        (["C72.", "C144.", "C216.", "C288."], 4),
        (["C40.", "C81.", "C183.", "C300.", "C360."], 5),
        ([f"C{angle / 2}" for angle in range(1, 721)], 720),
        ([f"X{40 + angle % 3 / 10} C{angle * 10}." for angle in range(1, 721)], 720),
        (["C36.", "C72.", "C108.", "C144.", "C180."], 5),
        (["C27.", "C100.", "C270."], 3),
        # A block without the virtual axis does not end it, and what goes back does not belong to it.
        (["C100.", "X39.", "C200.", "X40.", "C360.", "C0"], 5 - 2),
    ],
)
def test_a_steady_way_to_a_full_turn(blocks: list[str], count: int) -> None:
    assert len(moved(*blocks)) == count
    assert len(moved(*blocks, units="G20")) == count
    as_y = [block.replace("C", "Y").replace("H", "V") for block in blocks]
    assert len(moved(*as_y, machine="haas-lathe", start="X50. Y0")) == count


@looped(
    "blocks",
    [
        # A flat, in steps, across the center and on one side of it.
        ["C-180.", "C-120.", "C-60.", "C0", "C60.", "C120.", "C180."],
        [f"C{length}." for length in range(-20, 21, 4)],
        ["C50.", "C100.", "C150.", "C190."],
        # A face that is not along C.
        ["X300. C60.", "X200. C120.", "X100. C180."],
        # Arcs, and a contour with another side.
        ["G2 X60. C60. R90.", "X30. C120. R90.", "X40. C180. R90."],
        ["C60.", "C120.", "C180.", "X-40.", "C0", "C-180.", "X40.", "C0"],
        ["C180.", "C360."],
        [],
    ],
)
def test_a_contour_is_no_steady_way_to_a_full_turn(blocks: list[str]) -> None:
    assert moved(*blocks) == []


@pytest.mark.nightly
@looped("words", ["Y5. C30.", "C30. Y5.", "C30."])
def test_the_word_that_looks_like_an_angle_is_named(words: str) -> None:
    report = report_of(f"G98\nG12.1\nG1 X10. {words} F100\nG13.1\n")
    angle = next(found for found in report.findings if found.rule == "degrees-in-polar")
    assert angle.message.startswith("C30. is a length of 30 mm")


def points(angle: list[float], radius: float, c: list[float]) -> str:
    """Points of a circle on a control of diameters, with these numbers for C."""
    x = 2 * radius * np.cos(np.radians(angle))
    return "\n".join(["G1 F20.", *(f"X{one:.3f} C{two:.3f}" for one, two in zip(x, c, strict=True))])


@looped(
    ("count", "radius", "first", "sense"),
    [(5, 19, 36, 1), (8, 20.8, 22.5, 1), (8, 20.8, 337.5, -1), (6, 12, 30, 1), (12, 30, 15, 1)],
)
@pytest.mark.parametrize("machine", ["fanuc", "doosan"])
def test_points_whose_x_is_that_of_a_circle_at_their_angles(
    count: int, radius: float, first: float, sense: int, machine: str
) -> None:
    angle = [(first + sense * 360 * index / count) % 360 for index in range(count)]
    for scale, units in ((1.0, "G21"), (25.4, "G20")):
        far = f"X{100 / scale:.3f}"
        program = f"{units} G98 G0 {far} C0\nG12.1\n{{}}\nG1 {far} C0\nG13.1\nM30\n"
        found = report_of(program.format(points(angle, radius / scale, angle)), machine).findings
        assert [finding.rule for finding in found if finding.severity != "note"] == ["degrees-in-polar"]
        lengths = [radius / scale * float(np.sin(np.radians(at))) for at in angle]
        assert not table(program.format(points(angle, radius / scale, lengths))).series.on_circle.any()
