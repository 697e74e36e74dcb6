"""What contours leave: ribs of known height where they begin and end, gaps in them, strips between their passes."""

from __future__ import annotations

import cmath
import math
import re

import pytest
from cases import looped
from programs import report_of

from polarcheck.foundation.finding import Finding

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X200. Z2. C0\nG12.1\n"
END = "\nG13.1\nM30\n"
MM_PER_INCH = 25.4


def found(section: str, *tools: str, machine: str = "fanuc", head: str = HEAD, **more: object) -> list[Finding]:
    """The findings; `/` separates blocks."""
    text = head + section.replace("/", "\n") + END
    return list(report_of(text, machine, *(tools or ("1:radius=3",)), **more).findings)  # type: ignore[arg-type]


def rules(section: str, *tools: str, **more: object) -> list[tuple[str, str]]:
    return [(finding.block, finding.rule) for finding in found(section, *tools, **more)]  # type: ignore[arg-type]


def at(point: complex, scale: float = 1.0) -> str:
    return f"X{2 * point.real / scale:.5f} C{point.imag / scale:.5f}"


def square(overlap: float, *, side: str = "G42", turn: float = 0.0, scale: float = 1.0, lead: float = 10.0) -> str:
    """A square of 40 with perpendicular leads in offset mode on its right side, and so much overlap."""
    direction, count = cmath.exp(1j * turn), (-1 if side == "G41" else 1)
    points = [20 + lead, 20, 20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20 + 1j * overlap, 20 + lead + 1j * overlap]
    points = [(point if count > 0 else point.conjugate()) * direction for point in map(complex, points)]
    before, after = 40 - 4j * count, 40 + (overlap + 4) * 1j * count
    start, end = before * direction, after * direction
    way = "/".join(f"G1 {at(point, scale)}" for point in points[1:])
    feed = 300 / scale
    return (
        f"G1 {at(start, scale)} F{feed:.2f}/G1 Z{-2 / scale:.4f}/G1 {side} {at(points[0], scale)}/{way}/"
        f"G1 G40 {at(end, scale)}/G1 Z{2 / scale:.4f}"
    )


def rib(overlap: float, radius: float = 3.0) -> float:
    """Two circles of R that touch the side 2R - overlap apart."""
    half = (2 * radius - overlap) / 2
    return radius - math.sqrt(radius**2 - half**2)


def height(finding: Finding) -> float:
    """As the message says it [mm]."""
    told = re.search(r"([\d.]+) (mm|inch) (?:high|thick)", finding.message)
    assert told
    return float(told[1]) * (MM_PER_INCH if told[2] == "inch" else 1)


# ---- ribs ----


def test_the_rib_of_an_overlap_below_two_r() -> None:
    section = "G1 X80. C-4. F300/G42 X60. C0./X40./C20./X-40./C-20./X40./C1./X60./G40 X80. C5."
    [finding] = found(section)
    assert (finding.block, finding.rule, finding.severity) == ("C1.", "material-left", "warning")
    # Centers (23, 3) and (23, -2).
    assert height(finding) == pytest.approx(3 - math.sqrt(9 - 2.5**2), abs=0.001)
    assert "X40 C0.5" in finding.message
    assert "go on 5 mm farther" in finding.message


@pytest.mark.nightly
@looped("overlap", [0, 0.5, 1, 2.5, 4, 5], one_in=20)
@looped("side", ["G41", "G42"])
@looped("turn", [0, 0.7, 2, math.pi / 2])
def test_ribs_by_their_overlap(overlap: float, side: str, turn: float) -> None:
    [finding] = found(square(overlap, side=side, turn=turn))
    assert finding.rule == "material-left"
    assert height(finding) == pytest.approx(rib(overlap), abs=0.005)


@pytest.mark.nightly
@looped("count", [1, 2, 3, 4, 5], one_in=4)
def test_ribs_beside_a_lead_of_several_blocks(count: int) -> None:
    """The rib stands at one corner alone, that of the straight lead; the other lead is round."""
    steps = [f"X{40 + 8 * number}." for number in range(count + 1)]
    on, off = "/".join(steps[-2::-1]), "/".join(steps[1:])
    for section in (
        f"G42 {steps[-1]} C0./{on}/C20./X-40./C-20./X40./C1./G2 X54. C8. R7./G1 G40 X100.",
        f"G42 X54. C-7./G2 X40. C0. R7./G1 C20./X-40./C-20./X40./C1./{off}/G40 X100. C5.",
    ):
        [finding] = found(f"G1 X100. C-20. F300/Z-2./{section}")
        assert finding.rule == "material-left"
        # Circles of R 3 and 7 that touch the side 2 mm apart meet so far above it.
        assert height(finding) == pytest.approx(0.106, abs=0.001)


@pytest.mark.ci
def test_a_rib_of_the_second_contour_stands_where_it_is() -> None:
    whole = "G42 X60. C0./X40./C20./X-40./C-20./X40./C15./X60./G40 X80. C5."
    inner = "G42 X60. C0./X20./C10./X-20./C-10./X20./C1./X60./G40 X80. C5."
    assert found(f"G1 X80. C-4. F300/Z-2./{whole}") == []
    [finding] = found(f"G1 X80. C-4. F300/Z-2./{whole}/{inner}")
    assert (finding.rule, finding.block) == ("material-left", "C1.")
    assert "X20 C0.5" in finding.message
    assert height(finding) == pytest.approx(rib(1), abs=0.001)


@pytest.mark.nightly
@looped("overlap", [0, 1, 3])
def test_ribs_in_inch(overlap: float) -> None:
    [finding] = found(
        square(overlap, scale=MM_PER_INCH),
        "1:radius=.118110236",
        head=HEAD.replace("G21", "G20").replace("X200. ", "X8. "),
    )
    assert finding.rule == "material-left"
    assert " inch high" in finding.message
    assert height(finding) == pytest.approx(rib(overlap), abs=0.01)


@pytest.mark.nightly
@looped("machine", ["fanuc-16i", "fanuc-30i", "siemens-iso", "gsk-988"])
def test_ribs_on_other_controls(machine: str) -> None:
    said = [rule for _, rule in rules(square(1), machine=machine, changes={"limits": {"c_feed": 36000}})]
    assert said == ["material-left"]


@pytest.mark.nightly
@looped("overlap", [5.6, 6, 6.5, 9, 15], one_in=2)
def test_nothing_stands_after_an_overlap_of_two_r(overlap: float) -> None:
    """At 5.6 the rib is 7 micrometers high: no witness."""
    assert rules(square(overlap)) == []


@pytest.mark.ci
@looped(
    "contour",
    [
        # Straight onto the contour, and off where it began.
        "G42 X40. C0./C20./X-40./C-20./X40./C0./G40 X80.",
        # Round leads that are tangent to the contour.
        "G42 X54. C-10./G2 X40. C-3. R7./G1 C20./X-40./C-20./X40./C-3./G2 X54. C4. R7./G1 G40 X80.",
        # Along the side, beyond its corners.
        "G42 X40. C-30./C20./X-40./C-20./X50./G40 X80. C-30.",
    ],
)
def test_these_leads_leave_nothing(contour: str) -> None:
    assert rules(f"G1 X80. C-20. F300/Z-2./{contour}/Z2.") == []


def test_inside_corners_of_the_part_are_no_ribs() -> None:
    pocket = "G1 X20. C2. F300/Z-2./G41 X30. C0./C15./X-30./C-15./X30./C0./G40 X20. C-2./Z2."
    cross = (
        "G1 X90. C0. F300/Z-2./G42 X60. C0./C8./X16./C30./X-16./C8./X-60./C-8./X-16./C-30./X16./C-8./X60./C0./"
        "G40 X90./Z2."
    )
    assert rules(pocket) == []
    assert rules(cross) == []


@pytest.mark.nightly
def test_what_is_cut_later_is_not_left() -> None:
    direct = "G42 X40. C0./C20./X-40./C-20./X40./C0./G40 X80."
    once_more = square(1) + "/G1 X80. C0./Z-2./" + direct + "/Z2."
    by_hand = square(1) + "/G1 X80. C-15./Z-2./X46./C15./X80./Z2."
    deeper = square(1) + "/G1 X80. C0./Z-4./" + direct + "/Z2."
    for section in (once_more, by_hand, deeper):
        assert rules(section) == []
    above = square(1) + "/G1 X80. C0./Z-1./" + direct + "/Z2."
    assert [rule for _, rule in rules(above)] == ["material-left"]


@pytest.mark.ci
def test_what_another_tool_cuts_is_not_left() -> None:
    direct = "G1 X80. C0. F300/Z-2./G42 X40. C0./C20./X-40./C-20./X40./C0./G40 X80./Z2."
    finish = f"G13.1/G0 X200. Z50./T0202/G0 X200. Z2. C0/G12.1/{direct}"
    both = f"{square(1)}/{finish}"
    assert rules(both, "1:radius=3", "2:radius=2") == []
    # Nobody knows what a tool of unknown R takes off.
    assert "material-left" not in [rule for _, rule in rules(both, "1:radius=3")]


def test_the_same_rib_at_several_depths_is_one_finding() -> None:
    one = square(1)
    assert [rule for _, rule in rules("/".join([one, one.replace("Z-2", "Z-4"), one.replace("Z-2", "Z-6")]))] == [
        "material-left"
    ]


def test_the_last_pass_leaves_its_own_rib() -> None:
    """The link to it comes in perpendicularly, the cancel leaves at the end: R high but for a half."""
    passes = "G1 X140. C0. F300/Z-2./G42 X70./C35./X-70./C-35./X70./C0./X60./C30./X-60./C-30./X60./C0./G40 X140./Z2."
    [finding] = found(passes)
    assert finding.rule == "material-left"
    assert height(finding) == pytest.approx(3 - math.sqrt(9 - 1.5**2), abs=0.002)


def test_leads_apart_from_each_other_leave_more_than_a_rib() -> None:
    """Between them nothing is cut at all."""
    section = "G1 X90. C20. F300/Z-2./G42 X60. C15./X40. C0./C20./X-40./C-20./X40./C0./X60. C-15./G40 X90. C-20./Z2."
    [finding] = found(section)
    assert (finding.block, finding.rule) == ("C0.", "material-left")
    assert "a rib more than 6 mm high stays on the contour at X40 C" in finding.message


def test_a_fin_between_leads_and_passes_is_no_part() -> None:
    """A link and a lead cross the first pass, and the face between them sees nothing but backs."""
    first = "X24.748 C-8.035/X30.422 C.696/X24.748 C9.428/X9.893 C14.824/X-8.468/X-23.323 C9.428/X-28.997 C.696"
    first += "/X-23.323 C-8.035/X-8.468 C-13.431/X9.893/X24.748 C-8.035"
    last = "X22.323 C-7.154/X27.424 C.696/X22.323 C8.547/X8.967 C13.398/X-7.542/X-20.897 C8.547/X-25.999 C.696"
    last += "/X-20.897 C-7.154/X-7.542 C-12.006/X8.967/X22.323 C-7.154/X34.271 C-15.376"
    section = f"G1 X52.502 C-16.355 F200/Z-5.34/G42 {first}/{last}/G40 X35.664 C-25.224/Z2."
    [finding] = [one for one in found(section, "1:radius=3.865") if one.rule == "material-left"]
    assert height(finding) > 1.4


def test_beyond_the_bar_nothing_stands() -> None:
    """Both walls of a slot in one loop, with a link beyond the bar that the tool does not reach into."""
    section = (
        "G1 X-66.044 C-19.461 F200/Z-4.88/G41 X-48.04 C-20.804/X59.105 C11.68/X47.043 C21.627/X-60.103 C-10.858/"
        "G40 X-66.044 C-19.461/Z2."
    )
    assert rules(section, "1:radius=4.616", job={"stock": {"diameter": 36.58}}) == []


# ---- gaps ----


@pytest.mark.nightly
@looped("gap", [0.1, 1, 3, 5.5], one_in=12)
@looped("side", ["G41", "G42"])
@looped("turn", [0, 0.7])
def test_a_gap_with_leads_side_by_side(gap: float, side: str, turn: float) -> None:
    [finding] = found(square(-gap, side=side, turn=turn))
    assert (finding.rule, finding.severity) == ("contour-not-closed", "warning")
    assert finding.values["gap"] == pytest.approx(gap, abs=1e-4)


def test_the_message_of_a_gap() -> None:
    [finding] = found("G1 X80. F300/Z-2./G42 X40. C0./C20./X-40./C-20./X40./C-1./G40 X80./Z2.")
    assert finding.block == "C-1."
    assert finding.message == (
        "the contour ends at X40 C-1, 1 mm before it is closed: write X40 C0 here, or X40 C-1 in line 8, where it "
        "begins"
    )


def test_a_gap_in_inch() -> None:
    head = HEAD.replace("G21", "G20").replace("X200. ", "X8. ")
    [finding] = found("G1 X3. F12./Z-.1/G42 X1.6 C0/C.8/X-1.6/C-.8/X1.6/C-.04/G40 X3./Z.1", "1:radius=.125", head=head)
    assert finding.message == (
        "the contour ends at X1.6 C-0.04, 0.04 inch before it is closed: write X1.6 C0 here, or X1.6 C-0.04 in line 8, "
        "where it begins"
    )


@pytest.mark.nightly
@looped(
    "contour",
    [
        # Rounding; and a gap through which the cutter goes.
        "G42 X40. C0./C20./X-40./C-20./X40./C-.004/G40 X80.",
        "G42 X40. C0./C20./X-40./C-20./X40./C-7./G40 X80.",
        # A tongue that is machined round its end.
        "G42 X70. C-2./C2./X-20./C-2./X70./G40 X90.",
        # A flat, and a slot.
        "G42 X40. C-50./C50./G40 X80.",
        "G41 X120. C5./X-120./C-5./X120./G40 X140.",
    ],
)
def test_these_are_no_gaps(contour: str) -> None:
    section = f"G1 X140. C0. F300/Z-2./{contour}/Z2."
    assert "contour-not-closed" not in [rule for _, rule in rules(section)]


# ---- strips ----


def rings(*halves: float, loops: bool = False) -> str:
    """Squares one in the other, outermost first; in one loop, the last one closed by an overlap, or in a loop each."""
    around = [f"C{half}/X{-2 * half}/C{-half}/X{2 * half}" for half in halves]
    if loops:
        ways = [f"G42 X{2 * half}/{way}/C0./G40 X140." for half, way in zip(halves, around, strict=True)]
    else:
        closed = [f"X{2 * half}/{way}/C0." for half, way in zip(halves, around, strict=True)]
        ways = [f"G42 {'/'.join(closed)[:-2]}6./G40 X140."]
    return "/".join(["G1 X140. C0. F300", "Z-2.", *ways, "Z2."])


@pytest.mark.ci
@looped("loops", [False, True], one_in=3)
@looped("thickness", [0.5, 1, 2])
def test_rings_between_squares(thickness: float, loops: bool) -> None:
    [finding] = found(rings(36.0, 30.0 - thickness, loops=loops))
    assert finding.rule == "material-left"
    assert height(finding) == pytest.approx(thickness, abs=0.001)
    assert "write passes that are 6 mm apart at most" in finding.message


@looped("loops", [False, True], one_in=12)
@looped("inner", [26.0, 20.0, 30.0, 31.0, 35.0])
def test_passes_near_enough_and_rings_thicker_than_r(inner: float, loops: bool) -> None:
    assert rules(rings(36.0, inner, loops=loops)) == []


@pytest.mark.nightly
@looped(("step", "leaves"), [(5.5, False), (5.9, False), (6.5, True), (8, True), (9.5, False)], one_in=3)
def test_circles_one_in_the_other(step: float, leaves: bool) -> None:
    circles = "/".join(f"G1 G42 X{2 * size}/G3 I{-size}/G1 G40 X140." for size in (20.0 + step, 20.0))
    said = found(f"G1 X140. C0. F300/Z-2./{circles}/Z2.")
    assert [finding.rule for finding in said] == ["material-left"] * leaves
    if leaves:
        assert height(said[0]) == pytest.approx(step - 6, abs=0.01)


@pytest.mark.nightly
@looped(("pitch", "leaves"), [(5.5, False), (7.0, True)])
def test_a_spiral(pitch: float, leaves: bool) -> None:
    """Of half circles, inwards, with a full turn at its end."""
    sizes = [45 - pitch / 2 * number for number in range(5)]
    arcs = "/".join(
        f"G3 X{2 * (-1) ** (number + 1) * size} I{-((-1) ** number) * (sizes[number] + size) / 2}"
        for number, size in enumerate(sizes[1:])
    )
    section = f"G1 X160. C0. F300/Z-2./G42 X90./{arcs}/G3 I{-sizes[-1]}/G1 G40 X160./Z2."
    assert [rule for _, rule in rules(section)] == ["material-left"] * leaves


@pytest.mark.nightly
def test_the_bar_ends_what_may_stand() -> None:
    """The outer pass runs beyond the bar, and there is no ring."""
    circles = "/".join(f"G1 G42 X{2 * size}/G3 I{-size}/G1 G40 X140." for size in (28.0, 20.0))
    section = f"G1 X140. C0. F300/Z-2./{circles}/Z2."
    assert rules(section, job={"stock": {"diameter": 52.0}}) == []
    assert [rule for _, rule in rules(section, job={"stock": {"diameter": 80.0}})] == ["material-left"]


def test_a_ring_that_is_cut_without_compensation_is_none() -> None:
    circles = "/".join(f"G1 G42 X{2 * size}/G3 I{-size}/G1 G40 X140." for size in (28.0, 20.0))
    between = "G1 X54./G3 I-27./G1 X140."
    assert rules(f"G1 X140. C0. F300/Z-2./{circles}/{between}/Z2.") == []


def test_the_middle_of_a_pocket_is_no_strip() -> None:
    assert rules("G1 X12. C0. F300/Z-2./G41 X20./G3 I-10./G1 G40 X12./Z2.", "1:radius=4") == []


@pytest.mark.nightly
@looped(("island", "leaves"), [(16.0, True), (17.0, True), (18.5, False), (13.0, False)], one_in=3)
def test_a_ring_between_a_pocket_and_its_island(island: float, leaves: bool) -> None:
    """Neither of the two passes lies behind the other; a ramp cuts through what stays between them."""
    pocket = "G1 X46. C0. F300/Z-2./G41 X60./G3 I-30./G1 G40 X46./Z2."
    boss = f"X46./Z-2./G42 X{2 * island}/G3 I{-island}/G1 G40 X46./Z2."
    said = found(f"{pocket}/{boss}")
    assert [finding.rule for finding in said] == ["material-left"] * leaves
    if leaves:
        assert height(said[0]) == pytest.approx(18 - island, abs=0.1)


def test_without_a_cutter_nothing_is_left() -> None:
    assert "material-left" not in [rule for _, rule in rules(square(1), "1:radius=0")]
    assert "material-left" not in [rule for _, rule in rules(square(1), "2:radius=3")]


def test_a_loop_to_which_the_control_objects_is_not_judged() -> None:
    keyway = "G1 X80. F300/Z-2./G41 X60. C3./X20./C-3./X60./G40 X80. C0/Z2."
    assert "material-left" not in [rule for _, rule in rules(keyway, "1:radius=4")]
