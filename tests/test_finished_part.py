"""What the tool cuts and what not, by whole programs: leads in offset mode, ramps at other heights, the bar."""

from __future__ import annotations

import math
import re

import numpy as np
import pytest
import shapely
from cases import looped
from programs import report_of

from polarcheck.foundation.states import Motion
from polarcheck.geometry.polygons.finished_part import Contours, FinishedParts, finished_parts
from polarcheck.geometry.segments import Curves

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\nG0 X150. Z2. C0\nG12.1\n"
TAIL = "G13.1\nG0 X160.\nM30\n"
#: Leads in offset mode, on arcs, crossing at a corner, overlapping; with R.
SOUND = {
    "leads on arcs": (
        "G1 C-8. F300/G42 X40. F120/X36./G2 X20. C0. R8./G3 I-10. J0./G2 X36. C8. R8./G1 G40 X132.",
        6,
    ),
    "octagon, leads that cross at a corner": (
        "G1 X28.469 C-.987 F360/G42 X24.493 C-1.811/X16.259 C8.129/X0. C11.497/X-16.259 C8.129/X-22.993 C0./"
        "X-16.259 C-8.129/X0. C-11.497/X16.259 C-8.129/X24.493 C1.811/G40 X28.469 C.987",
        0.96,
    ),
    "triangle, leads that cross at a corner": (
        "G1 X34.213 C-3.288 F300/G42 X29.509 C-1.93/X-11.411 C9.883/C-9.883/X29.509 C1.93/G40 X34.213 C3.288",
        1.43,
    ),
    "leads across a side, with an overlap": (
        "G1 X80. C-4. F300/G42 X60. C0./X40./C20./X-40./C-20./X40./C7./X60./G40 X80. C11.",
        3,
    ),
    "the same contour at two depths": (
        "G1 X80. C0. F300/Z-1./G42 X40./C20./X-40./C-20./X40./C0./Z-2./C20./X-40./C-20./X40./C0./G40 X80.",
        5,
    ),
    "roughing and finishing in one loop": (
        "G1 X80. C0. F300/Z-1./G42 X48./C24./X-48./C-24./X48./C0./X40./C20./X-40./C-20./X40./C0./G40 X80.",
        5,
    ),
    "two flats in two loops, each beyond the bar": (
        "G1 X60. C10. F300/G42 X40./X-40./G40 X-60./G1 C-10./G42 X-40./X40./G40 X60.",
        5,
    ),
}


MIRRORED = {"G41": "G42", "G42": "G41", "G2 ": "G3 ", "G3 ": "G2 "}


def whole(blocks: str, scale: float = 1.0, turn: float = 0.0, mirror: bool = False) -> str:
    """The program; in other units, turned round the center [deg], or mirrored with the sides exchanged."""
    lines, x, c = [], 150.0, 0.0
    for block in blocks.split("/"):
        moves = re.search("[XC]", block) is not None
        x, c = (
            float(found[1]) if (found := re.search(rf"{address}(-?[\d.]+)", block)) else now
            for address, now in (("X", x), ("C", c))
        )
        point = complex(x / 2, c) * complex(math.cos(math.radians(turn)), math.sin(math.radians(turn)))
        if moves and turn:
            block = re.sub(r"[XC]-?[\d.]+ ?", "", block).rstrip() + f" X{2 * point.real:.4f} C{point.imag:.4f}"
        if mirror:
            block = re.sub(r"([CJ])(-?)", lambda found: found[1] + ("" if found[2] else "-"), block)
            block = re.sub("G41|G42|G2 |G3 ", lambda found: MIRRORED[found[0]], block)
        if scale != 1:
            block = re.sub(r"([XCZRIJF])(-?[\d.]+)", lambda found: f"{found[1]}{float(found[2]) * scale:.4f}", block)
        lines.append(block)
    head = HEAD if scale == 1 else HEAD.replace("G21", "G20").replace("X150. Z2.", "X5.9 Z.08")
    return head + "\n".join(lines) + "\n" + (TAIL if scale == 1 else TAIL.replace("X160.", "X6.3"))


def errors(program: str, radius: float, **job: object) -> list[tuple[int, str]]:
    report = report_of(program, "fanuc-30i", f"1:radius={radius:.5f}", **job)
    return [(found.line, found.rule) for found in report.findings if found.severity == "error"]


@pytest.mark.ci
@looped("name", SOUND, one_in=12)
@looped("form", ["as it is", "inch", "mirrored"])
def test_sound_programs_cut_nothing(name: str, form: str) -> None:
    blocks, radius = SOUND[name]
    scale = 1 / 25.4 if form == "inch" else 1
    program = whole(blocks, scale, mirror=form == "mirrored")
    assert errors(program, radius * scale) == []


@pytest.mark.ci
@looped("turn", [30, 137, 200], one_in=12)
@looped("name", [name for name in SOUND if " arcs" not in name])
def test_nor_do_they_when_they_are_turned(name: str, turn: float) -> None:
    blocks, radius = SOUND[name]
    assert errors(whole(blocks, turn=turn), radius) == []


@pytest.mark.nightly
@looped("name", [name for name in SOUND if "flats" not in name], one_in=3)
def test_a_ramp_from_the_other_side_cuts_the_part(name: str) -> None:
    blocks, radius = SOUND[name]
    first, rest = blocks.split("/", 1)
    assert errors(whole(re.sub(r"X-?[\d.]+ ?", "", first) + " X-70./" + rest), radius)


# ---- ramps and Z ----

BESIDE = "G1 X20. C-50. F300/G1 Z-3./G42 X40. C-20./G1 Z{}/C20./X-40./C-20./X40./G1 Z{}/G40 X20. C-50."


@pytest.mark.ci
@looped(("depth", "height"), [("-4.", "-3."), ("-10.", "-3."), ("-3.", "2.")])
def test_a_ramp_below_the_face_cuts_what_stands_above_the_contour(depth: str, height: str) -> None:
    """From (10, -50) to (25, -20): 0.528 mm of the corner (20, -20), which is 5 less its distance from that line."""
    way, corner = complex(15, 30), complex(20, -20) - complex(10, -50)
    nick = 5 - abs((corner.conjugate() * way).imag) / abs(way)
    report = report_of(whole(BESIDE.format(depth, height)), "fanuc", "1:radius=5")
    found = [one for one in report.findings if one.rule == "start-up-sweeps-contour"]
    assert [one.line for one in found] == [8]
    assert found[0].values["depth"] == pytest.approx(nick, abs=0.003)
    assert nick == pytest.approx(0.528, abs=0.001)


def test_a_ramp_above_the_face_cuts_nothing() -> None:
    above = BESIDE.replace("G1 Z-3.", "G1 Z1.").format("-4.", "1.")
    assert errors(whole(above), 5) == []


# ---- the bar ----

#: A flat at C10 that ends at X32, a ramp that nicks its end by 0.92 mm.
FLAT = "G1 X60. C8. F300/Z-1./G42 X32. C10./X-32./G40 X-60. C16."


@pytest.mark.ci
@looped(("bar", "found"), [(None, False), (30, False), (37.7, True), (60, True)], one_in=2)
def test_the_bar_says_where_a_flat_ends(bar: float | None, found: bool) -> None:
    """Its end (16, 10) is 18.868 from the center: a bar of 37.7 has its corner just there."""
    job = {"job": {"stock": {"diameter": bar}}} if bar else {}
    assert bool(errors(whole(FLAT), 5, **job)) == found


def test_what_one_loop_takes_away_another_need_not_keep() -> None:
    """The ramp of the second loop leads through the corner that the first one has taken off the bar."""
    slab = "G1 X60. C8. F300/Z-1./G42 X40./X-40./G40 X-60. C12.;G1 X60. C-30./G42 X16. C-20./C-10./C20./G40 X60. C30."
    first, second = slab.split(";")
    assert errors(whole(second.replace("G1 X60. C-30.", "G1 X60. C-30. F300/Z-1.")), 3) == []
    assert errors(whole(first + "/" + second), 3) == []


# ---- what is no contour ----


def test_a_tangle_is_not_evaluated_and_says_so() -> None:
    draw = np.random.default_rng(3)
    moves = "/".join(f"X{draw.uniform(-60, 60):.3f} C{draw.uniform(-30, 30):.3f}" for _ in range(400))
    report = report_of(whole(f"G1 X80. C0. F300/G42 X70./{moves}/G40 X90. C50."), "fanuc", "1:radius=2")
    reasons = [entry.reason for entry in report.not_evaluated if entry.rule == "overcut"]
    assert len(reasons) == 1
    assert "crosses itself more than 4 times a block" in reasons[0]
    assert not [found for found in report.findings if found.rule in ("overcut", "start-up-sweeps-contour")]


# ---- contours that do not close: squares of 40, the tool outside ----


def part_of(points: list[complex], radius: float, turn: complex = 1, mirrored: bool = False) -> FinishedParts:
    """The part of one contour from point to point, the tool right of it; mirrored left."""
    path = turn * np.array(points, complex)
    path = path.conj() if mirrored else path
    count = len(path) - 1
    rows, zeros = np.arange(count), np.zeros(count, np.int64)
    kind = np.full(count, Motion.LINE, np.int16)
    curves = Curves(path[:-1], path[1:], np.full(count, np.nan + 0j), kind, zeros, rows)
    one = np.zeros(1, np.int64)
    return finished_parts(Contours(curves, np.full(count, mirrored), one, one, np.array([radius]), np.nan, 0.001))


def test_a_contour_at_places_that_are_not_known_takes_no_part_away() -> None:
    """It stands before a square of 40 with a gap of 2, which is closed as if it were alone."""
    corners = np.array([20 + 1j, 20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j, 20 - 1j])
    start, end = np.append(np.nan, corners[:-1]), np.append(np.nan, corners[1:])
    loop, kind = np.array([0, 1, 1, 1, 1, 1]), np.full(6, Motion.LINE, np.int16)
    curves = Curves(start, end, np.full(6, np.nan + 0j), kind, loop, np.arange(6))
    group = np.zeros(2, np.int64)
    parts = finished_parts(Contours(curves, np.zeros(6, bool), np.arange(2), group, np.array([3.0]), np.nan, 0.001))
    assert parts.gap == pytest.approx([2])
    assert shapely.area(parts.polygon[0]) == pytest.approx(1600)


ROUND = [20 + 20j, -20 + 20j, -20 - 20j, 20 - 20j]
#: A gap of 2 in the middle of the right side, whose ends are so far off each other sideways.
STEP = {aside: [20 + aside + 1j, 20 + aside + 20j, *ROUND[1:], 20 - 1j] for aside in (0.0, 1.1, 1.2)}
OUTWARDS = [26 + 1j, 20 + 1j, *ROUND, 20 - 1j, 26 - 1j]
INWARDS = [14 + 1j, 20 + 1j, *ROUND, 20 - 1j, 14 - 1j]
ONE_INWARDS = [26 + 1j, 20 + 1j, *ROUND, 20 - 1j, 14 - 1j]
OTHER_INWARDS = [14 + 1j, 20 + 1j, *ROUND, 20 - 1j, 26 - 1j]


@pytest.mark.ci
@looped("mirrored", [False, True], one_in=3)
@looped("turn", [1, -1j, np.exp(0.7j)])
@looped(
    ("points", "radius", "gap", "area"),
    [
        (STEP[0.0], 3.0, 2.0, 1600.0),
        (STEP[0.0], 1.01, 2.0, 1600.0),
        (STEP[0.0], 0.99, 0.0, None),  # the tool goes through
        (OUTWARDS, 3.0, 2.0, 1600.0),
        (OUTWARDS, 0.99, 0.0, None),
        # 30 degrees off the way, less and more.
        (STEP[1.1], 3.0, math.hypot(2, 1.1), 1600.0 + 1.1 * 20),
        (STEP[1.2], 3.0, 0.0, None),
        # Leads with the tool between them are the walls of a slot.
        (INWARDS, 3.0, 0.0, None),
        (ONE_INWARDS, 3.0, 0.0, None),
        (OTHER_INWARDS, 3.0, 0.0, None),
        # What is less than the tolerance is no gap, whatever its direction.
        ([20 + 0.0004j, *ROUND, 20 - 0.0004j], 3.0, 0.0, 1600.0),
        ([20.0008, 20.0008 + 20j, *ROUND[1:], 20], 3.0, 0.0, 1600.0),
    ],
)
def test_a_gap_on_the_way_of_the_contour_is_bridged(
    points: list[complex], radius: float, gap: float, area: float | None, turn: complex, mirrored: bool
) -> None:
    part = part_of(points, radius, turn, mirrored)
    assert part.gap.tolist() == pytest.approx([gap])
    if area is not None:
        assert not part.open[0]
        assert shapely.area(part.polygon[0]) == pytest.approx(area, abs=0.05)


def test_a_gap_of_twice_r_is_not_bridged() -> None:
    assert part_of(STEP[0.0], 1.0).gap.tolist() == [0]
