"""
The infeed cycle of `G12.1 E`: its depth, the gap of its contour and the offsets of its passes, by construction.

The moves of the passes are compared with the manual's own program in test_controls.
"""

from __future__ import annotations

import re

import numpy as np
import pytest
from cases import looped
from programs import moves_of, report_of, said, tables_of

from polarcheck.columns.path.infeed import MOST_PASSES, Infeed
from polarcheck.foundation.states import Motion

#: Around a square of 20 mm half width, from X60. (30 mm) to the last point and out again.
SQUARE = "G98 G0 X60. C0\nG12.1 {}\nG1 X40. F100\nC20.\nX-40.\nC-20.\nX40.\n{}\nX60.\nG13.1\n"
ENTRY = 1


def table(program: str, machine: str = "gsk-988", *tools: str, **changes: dict[str, float]) -> Infeed:
    infeed: Infeed = tables_of(program, machine, *tools, changes=changes)["infeed"]
    return infeed


@looped(("written", "depth"), [("E4.", 4.0), ("E-4.", 4.0), ("E0", 0.0), ("", 0.0), ("P1", 0.0), ("E", 0.0)])
def test_depth_is_a_radius_without_its_sign(written: str, depth: float) -> None:
    infeed = table(SQUARE.format(written, "C0"))
    assert infeed.depth[ENTRY] == depth
    assert infeed.depth.sum() == depth, "no other row has one"


def test_depth_in_inch() -> None:
    assert table("G20\n" + SQUARE.format("E.1", "C0")).depth[ENTRY + 1] == pytest.approx(2.54)


@pytest.mark.nightly
@looped(
    ("second", "entry", "reasons"),
    [
        ("", "E4.", 0),
        ("G42 X50.\nC25.\nX-50.\nC-25.\nX50.\nC0\nG40 X100.\n", "E4.", 1),
        ("G42 X50.\nC25.\nX-50.\nC-25.\nX50.\nC0\nG40 X100.\n", "", 0),
        ("X120.\nX100.\n", "E4.", 0),
    ],
)
def test_a_second_contour_of_a_cycle_is_told(second: str, entry: str, reasons: int) -> None:
    """What the control makes of it the description does not say, so that nobody has looked at its passes."""
    contour = "G42 G1 X60. F200\nC30.\nX-60.\nC-30.\nX60.\nC0\nG40 X100.\n"
    program = f"T0202\nG98 G0 X100. C0\nG12.1 {entry}\n{contour}{second}G13.1\n"
    report = report_of(program, "gsk-988", "2:radius=5")
    told = [one for one in report.not_evaluated if one.matters and "for its first contour only" in one.reason]
    assert (len(told), said(report)) == (reasons, [])


@pytest.mark.nightly
@looped(
    ("number", "written", "depth", "is_told"),
    [
        ("least-increment", "E4000", 4.0, True),
        ("least-increment", "E4", 4.0, True),
        ("least-increment", "E4.", 4.0, False),
        ("whole-unit", "E4", 4.0, False),
    ],
)
def test_depth_without_a_point(number: str, written: str, depth: float, is_told: bool) -> None:
    """As X and C: a large number counts least increments, a small one is a slip, each with its finding."""
    program = SQUARE.format(written, "C0.").replace("C0\n", "C0.\n", 1)
    changes = {"control": {"number_without_point": number}}
    infeed = tables_of(program, "gsk-988", changes=changes)["infeed"]
    assert infeed.depth[ENTRY] == pytest.approx(depth)
    assert said(report_of(program, "gsk-988", changes=changes)) == [(2, "number-without-point")] * is_told


def test_depth_is_that_of_the_section_beginning() -> None:
    infeed = table("E1.\nG12.1\nG1 X10. E2.\nG13.1 E3.\n")
    assert not infeed.depth.any()


@looped(
    ("last", "gap"),
    [
        ("C0", 0.0),
        # The rounding of coordinates to 0.001 mm is no gap; 0.003 mm are.
        ("C.002", 0.0),
        ("C.003", None),
        # It is open where nothing after comes back to (20, 0): measured from the last move, to (30, -4).
        ("C-4.", abs(30 - 4j - 20)),
        ("X36. C3.", abs(30 + 3j - 20)),
    ],
)
def test_gap_is_the_way_back_to_where_the_contour_begins(last: str, gap: float | None) -> None:
    infeed = table(SQUARE.format("E4.", last))
    assert infeed.gap[ENTRY] == pytest.approx(abs(30 + 0.003j - 20) if gap is None else gap)
    assert np.isnan(np.delete(infeed.gap, ENTRY)).all()


@looped("codes", [("G1 ", ""), ("", "G1 "), ("G0 ", "G1 ")])
def test_a_start_up_in_rapid_traverse_leads_to_the_contour(codes: tuple[str, str]) -> None:
    """G0 of the approach in force, or written, gives rapid-in-polar, and beside it no contour that is open."""
    program = "T0202 G98 G0 X60. C0\nG12.1 E4.\n{}G42 X40. C0 F100\n{}C20.\nX-40.\nC-20.\nX40.\nC0\nG40 X60.\nG13.1\n"
    tables = tables_of(program.format(*codes), "gsk-988", "2:radius=1")
    assert tables["infeed"].gap[ENTRY] == 0
    # From 10 mm off the contour it is cut 8, 4 and 0 mm off.
    assert tables["infeed"].offsets(ENTRY).tolist() == [8, 4]
    assert len(tables["moves"]) == len(tables_of(program.format("G1 ", ""), "gsk-988", "2:radius=1")["moves"])


def test_gap_of_a_compensated_contour_ends_with_its_compensation() -> None:
    program = "G98 G0 X60. C0\nG12.1 E4.\nG42 G1 X40. F100\nC20.\nX-40.\nC-20.\nX40.\nC-3.\nG40 X60.\nG13.1\n"
    infeed = table(program, "gsk-988", "2:radius=1")
    assert infeed.gap[ENTRY] == pytest.approx(3.0)


@looped(
    "program",
    [
        "G98 G0 X60. C0\nG12.1 E4.\nG13.1\n",
        "G98 G12.1 E4.\nG1 C20. F100\nC-20.\nG13.1\n",
        SQUARE.format("", "C-4."),
    ],
    ids=["no contour", "X is not known", "no E"],
)
def test_gap_is_not_known(program: str) -> None:
    assert np.isnan(table(program).gap).all()


def test_one_move_has_no_gap() -> None:
    assert table("G98 G0 X60. C0\nG12.1 E4.\nG1 X40. F100\nG13.1\n").gap[ENTRY] == 0.0


@looped(
    ("written", "offsets"),
    [("E4.", [8.0, 4.0]), ("E5.", [5.0]), ("E10.", []), ("E3.", [9.0, 6.0, 3.0]), ("E9.999", []), ("E9.99", [9.99])],
)
def test_passes_lie_whole_depths_off_the_contour(written: str, offsets: list[float]) -> None:
    """The start point lies 10 mm off the contour; a pass through it would cut nothing."""
    infeed = table(SQUARE.format(written, "C0"))
    assert infeed.offsets(ENTRY).tolist() == pytest.approx(offsets)


def test_an_open_contour_has_one_pass() -> None:
    assert len(table(SQUARE.format("E4.", "C-4.")).offsets(ENTRY)) == 0


@looped(("count", "in_part"), [(MOST_PASSES, False), (MOST_PASSES + 1, True)])
def test_of_many_passes_only_some_are_simulated(count: int, in_part: bool) -> None:
    """10 mm and one pass less than there are whole depths in them: the last is the contour itself."""
    depth = 10.0 / (count + 0.5)
    infeed = table(SQUARE.format(f"E{depth:.9f}", "C0"), control={"least_increment": 1e-9})
    assert len(infeed.offsets(ENTRY)) == count
    assert infeed.is_simulated_in_part.tolist() == [in_part and row == ENTRY for row in range(len(infeed.trace))]


@looped(
    ("head", "written", "depth"),
    [
        ("", "E8.0009", 8.0),
        ("", "E.0009", 0.0),
        ("", "E.001", 0.001),
        ("G20\n", "E.10009", 2.54),
        ("G20\n", "E.00009", 0.0),
    ],
)
def test_what_is_finer_than_the_least_increment_is_dropped(head: str, written: str, depth: float) -> None:
    infeed = table(head + SQUARE.format(written, "C0"))
    assert infeed.depth.max() == pytest.approx(depth)
    assert len(infeed.passes.nonzero()[0]) == (depth > 0)


# ---- how many passes, in closed form ----


def circle(code: str, radius: float, start: float, infeed: float, way: str = "G3") -> str:
    """Once round a circle about the center, from a start point on X and back to it; X in diameters."""
    x, s = 2 * radius, 2 * start
    half = f"{way} X{{:.4f}} C0 R{radius:.4f}\n"
    rounds = half.format(-x) + half.format(x)
    contour = f"{code} G1 X{x:.4f} C0 F200\n{rounds}G40 G1 X{s:.4f} C0\n"
    return f"T0202\nG98 G0 X{s:.4f} C0\nG12.1 E{infeed:.4f}\n{contour}G13.1\n"


def radii_by_steps(radius: float, cutter: float, start: float, infeed: float) -> list[float]:
    """Where the tool center goes round: out (or in) from the contour by E as long as the start point lies beyond."""
    outward = 1 if start > radius else -1
    found = [radius + outward * cutter]
    while outward * (start - (found[-1] + outward * infeed)) > 1e-6:
        found.append(found[-1] + outward * infeed)
    return found[::-1]


def radii_of(program: str, *tools: str, arcs: int = 2, **changes: object) -> list[float]:
    """Those of the arcs of the tool center, one for each pass, which has so many arcs."""
    moves = moves_of(program, "gsk-988", *tools, changes=changes)
    round_about = moves[np.isin(moves.kind, (Motion.CW, Motion.CCW))]
    radius = np.abs(round_about.start - round_about.center)
    assert np.abs(round_about.center).max() < 1e-3
    assert radius == pytest.approx(np.repeat(radius[::arcs], arcs), abs=1e-3)
    return [round(float(value), 5) for value in radius[::arcs]]


CIRCLES = [
    # radius of the contour, R, start point, E
    (150.0, 5.0, 174.0, 8.0),
    (150.0, 5.0, 174.0, 5.0),
    (150.0, 5.0, 174.0, 7.0),
    (150.0, 5.0, 174.0, 23.9),
    (150.0, 0.0, 174.0, 8.0),
    (150.0, 4.0, 174.0, 10.0),
    (60.0, 5.0, 50.0, 4.0),
    (60.0, 4.0, 50.0, 8.0),
    (60.0, 5.0, 20.0, 8.0),
    (60.0, 5.0, 10.0, 2.5),
    (60.0, 0.0, 50.0, 3.0),
]


@pytest.mark.nightly
@looped(("radius", "cutter", "start", "infeed"), CIRCLES, one_in=4)
@looped("way", ["G3", "G2"])
def test_passes_of_a_circle(radius: float, cutter: float, start: float, infeed: float, way: str) -> None:
    """Outside and inside, G41 and G42, both ways round: none is beyond the start point, R counts, the steps are E."""
    code = "G42" if (start > radius) == (way == "G3") else "G41"
    found = radii_of(circle(code, radius, start, infeed, way), f"2:radius={cutter}")
    assert found == pytest.approx(radii_by_steps(radius, cutter, start, infeed))
    assert all(abs(one - radius) < abs(start - radius) for one in found)
    other = {"G41": "G42", "G42": "G41"}[code]
    mirrored = radii_of(circle(other, radius, start, infeed, way), f"2:radius={-cutter}")
    assert mirrored == pytest.approx(found) or cutter == 0, "R below 0 is the other side"


@pytest.mark.nightly
@looped(("radius", "cutter", "start", "infeed"), CIRCLES, one_in=2)
def test_passes_of_twins(radius: float, cutter: float, start: float, infeed: float) -> None:
    """The same in inch, with numbers fine enough, and with X as a radius in the mode."""
    code = "G42" if start > radius else "G41"
    # A pass through the start point is none, and in inch its numbers would be as near to that as their digits are.
    start += 0.01 if start > radius else -0.01
    program = circle(code, radius, start, infeed)
    expected = pytest.approx(radii_by_steps(radius, cutter, start, infeed), abs=1e-3)
    inch = "G20\n" + re.sub(r"([XRE])(-?[\d.]+)", lambda word: f"{word[1]}{float(word[2]) / 25.4:.8f}", program)
    fine = {"least_increment_inch": 1e-8}
    assert radii_of(inch, f"2:radius={cutter / 25.4:.9f}", control=fine) == expected
    before, mode = program.split("G12.1")
    halved = re.sub(r"X(-?[\d.]+)", lambda word: f"X{float(word[1]) / 2}", mode)
    assert radii_of(f"{before}G12.1{halved}", f"2:radius={cutter}", parameters={"5450#6": 1}) == expected


@pytest.mark.ci
@looped("angle", [0.0, 30.0, 137.0, 250.0])
@looped(("start", "code"), [(62.0, "G42"), (25.0, "G41")])
def test_passes_of_a_turned_twin(angle: float, start: float, code: str) -> None:
    """Begun from any direction: the number of passes hangs on the distance alone."""
    degrees = [0, 0, 120, 240, 360, 0]
    points = np.array([start, 40, 40, 40, 40, start]) * np.exp(1j * np.radians(np.add(degrees, angle)))
    begin, first, *arcs, out = (f"X{2 * point.real:.4f} C{point.imag:.4f}" for point in points)
    contour = f"{code} {first}\n" + "".join(f"G3 {arc} R40.\n" for arc in arcs)
    head = f"T0202\nG98 G0 X{2 * start} C0\nG12.1 E4.\nG1 {begin} F200\n"
    found = radii_of(f"{head}{contour}G40 G1 {out}\nG13.1\n", "2:radius=3", arcs=3)
    assert found == pytest.approx(radii_by_steps(40, 3, start, 4), abs=1e-3)


@looped(
    ("start", "widths"),
    [
        ("X68. C0.", [30.0, 25.0, 20.0]),
        # Off a corner: 19.8 mm from it, 14 mm from the lines of both sides; the corner of a pass lies as far out.
        ("X68. C34.", [30.0, 25.0, 20.0]),
        ("X72. C36.", [35.0, 30.0, 25.0, 20.0]),
        # No pass lies between the contour and a start point on the other side of it.
        ("X20. C0.", [20.0]),
    ],
)
def test_no_pass_is_beyond_the_start_point(start: str, widths: list[float]) -> None:
    sides = "C20.\nX-40.\nC-20.\nX40.\nC0\n"
    head = f"T0202\nG98 G0 X200. C0\nG12.1 E5.\nG1 {start} F100\n"
    moves = moves_of(f"{head}G42 X40. C0\n{sides}G40 {start}\nG13.1\n", "gsk-988", "2:radius=0")
    far = moves.end[moves.row == 7]
    assert np.abs(far.real) == pytest.approx(widths)


# ---- passes are checked as the contour is ----

POCKET = """T0202
G98 G0 X20. C0
G12.1 E{}
G41 G1 X80. F600
C40.
X-80.
C-40.
X80.
C0
G40 X20.
G13.1
"""


@pytest.mark.ci
def test_the_rate_of_c_on_a_pass_is_named() -> None:
    """The pass 24 mm off a wall at 40 mm runs 11 mm off the center: 600 / 11 mm is 3125 deg/min."""
    report = report_of(POCKET.format("8."), "gsk-988", "2:radius=5,nose=0", changes={"limits": {"c_feed": 2000}})
    assert said(report) == [(5, "c-feed-above-limit")]
    found = report.findings[0]
    assert found.severity == "error"
    assert (
        "nearest distance 11 mm; highest F for its 5 blocks, on the pass 24 mm off the contour: 383 mm/min"
        in found.message
    )
    alone = report_of(POCKET.format("0"), "gsk-988", "2:radius=5,nose=0", changes={"limits": {"c_feed": 2000}})
    assert said(alone) == []


SLOT = """T0202
G98 G0 X{} C0
G12.1 E{}
G42 G1 X80. F200
C40.
X20.
{}
C40.
X-80.
C-40.
X80.
C0
G40 X{}
G13.1
"""
ROUND = "C38.\nG2 X-20. R10.\nG1"
SHARP = "C30.\nX-20.\n"


@pytest.mark.nightly
@looped(
    ("start", "infeed", "inner", "unfit"),
    [
        # The groove is 20 mm wide: R 5 and 4 mm fit, with 8 mm they do not.
        ("120.", "4.", ROUND, (2, "2 of 4 passes", "already 8 mm off it with R 5 mm")),
        ("120.", "4.", SHARP, (2, "2 of 4 passes", "already 8 mm off it with R 5 mm")),
        ("120.", "1.5", ROUND, (2, "6 of 10 passes", "already 6 mm off it with R 5 mm")),
        ("98.", "2.", ROUND, None),
        ("98.", "2.", SHARP, None),
        ("120.", "0", ROUND, None),
    ],
    one_in=4,
)
def test_passes_that_do_not_fit_are_one_finding(
    start: str, infeed: str, inner: str, unfit: tuple[int, str, str] | None
) -> None:
    program = SLOT.format(start, infeed, inner, start)
    report = report_of(program, "gsk-988", "2:radius=5,nose=0")
    assert said(report) == ([] if unfit is None else [(3, "infeed-pass-does-not-fit")])
    if unfit is not None:
        assert report.findings[0].severity == "warning"
        assert report.findings[0].message.startswith(unfit[1])
        assert unfit[2] in report.findings[0].message


@pytest.mark.ci
def test_passes_that_do_not_fit_in_two_sections_are_two_findings() -> None:
    one = SLOT.format("120.", "4.", ROUND, "120.").removeprefix("T0202\n")
    report = report_of(f"T0202\n{one}{one}", "gsk-988", "2:radius=5,nose=0")
    assert [rule for _, rule in said(report)] == ["infeed-pass-does-not-fit"] * 2


@pytest.mark.nightly
def test_a_pass_does_not_fit_where_the_contour_does_not() -> None:
    """R 11 in an arc of 10 is the fault of the contour, from which that of its passes follows."""
    report = report_of(SLOT.format("120.", "4.", ROUND, "120."), "gsk-988", "2:radius=11,nose=0")
    assert "infeed-pass-does-not-fit" not in [rule for _, rule in said(report)]
    follows = [one.rule for found in report.findings for one in found.follows]
    assert "infeed-pass-does-not-fit" in follows


@pytest.mark.ci
def test_without_a_radius_passes_are_not_judged() -> None:
    report = report_of(SLOT.format("120.", "4.", ROUND, "120."), "gsk-988")
    assert "infeed-pass-does-not-fit" not in [rule for _, rule in said(report)]
    assert "infeed-pass-does-not-fit" in [entry.rule for entry in report.not_evaluated]


@pytest.mark.ci
def test_a_stock_that_is_cleared_is_cleared_by_all_passes() -> None:
    """A pass that runs outside of the bar cuts air; a start point inside of it has a finding of its own."""
    program = POCKET.replace("X20.", "X140.").replace("G41", "G42").format("4.")
    tool = "2:radius=5,nose=0,diameter=10"
    assert said(report_of(program, "gsk-988", tool, job={"stock": {"diameter": 115}})) == []
    assert said(report_of(program, "gsk-988", tool, job={"stock": {"diameter": 135}})) == [(3, "approach-inside-stock")]
