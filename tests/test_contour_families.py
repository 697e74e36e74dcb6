"""Programs of the generator of contours: polarcheck and the reference agree, and the reference is right by hand."""

from __future__ import annotations

import itertools
import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import shapely
from cases import looped
from compensation_oracle import Move, simulate
from contour_families import FAMILIES, Program, Twin, program_of
from contour_pieces import Piece, polygon_of
from contour_verdicts import KINDS, TOLD, class_of, compare, compare_seed, twins_of
from part_reference import Verdict, along, cut_of, judge, loops_of, read_section

GENERATOR = Path(__file__).parent.parent / "benchmarks" / "geometry_generator.py"
#: How the names of programs begin that are kept and count for no disagreement.
TOLD_FILES = tuple(kind.replace(", ", "-").replace(" ", "-") for kind in TOLD)
HEAD = "O1/G21 G40 G97 G98 G18/T0101/G0 X150. Z2. C0/G12.1/"
SQUARE = shapely.box(-20, -20, 20, 20)
#: Of each family, so many seeds are compared.
SHARE = 5


def program(blocks: str) -> str:
    """Blocks between the way into the polar mode and the way out of it, as the text of a program."""
    return (HEAD + blocks + "/G13.1/M30/").replace("/", "\n").replace("\n ", "\n")


def disc(radius: float, center: complex = 0j) -> shapely.Polygon:
    return polygon_of([Piece("ccw", center + radius, center + radius, center)])


@pytest.mark.nightly
@looped("family", FAMILIES, one_in=13)
def test_polarcheck_agrees_with_the_reference(family: str) -> None:
    found = [comparison for seed in range(SHARE) for comparison in compare_seed(seed, family)]
    assert [(one.program.seed, one.disagreement, one.says) for one in found if one.disagreement in KINDS] == []


# --- the reference, where the answer is known ---------------------------------------------------------------------


def test_a_line_beside_a_wall_is_as_deep_as_it_is_too_near() -> None:
    move = Move(0, "line", -50 + 23j, 50 + 23j, None, "OFFSET", False)
    assert cut_of(move, 5, SQUARE)[0] == pytest.approx(2)
    assert cut_of(move, 3, SQUARE)[0] == pytest.approx(0)
    assert cut_of(move, 1, SQUARE)[0] == pytest.approx(-2)


def test_a_line_through_the_part_is_as_deep_as_the_radius() -> None:
    assert cut_of(Move(0, "line", -50 + 1j, 50 + 1j, None, "OFFSET", False), 5, SQUARE)[0] == 5


@looped("kind", ["cw", "ccw"])
def test_an_arc_about_a_round_part_is_too_near_allalong(kind: str) -> None:
    quarter = Move(0, kind, 12 + 0j, 12j, 0j, "OFFSET", False)
    assert cut_of(quarter, 5, disc(10))[0] == pytest.approx(3, abs=1e-3)


def test_an_arc_cuts_only_where_it_runs() -> None:
    left, right = disc(4, -20 + 0j), disc(4, 20 + 0j)
    upper = Move(0, "ccw", 10j - 10, 10j - 10, 10j, "OFFSET", False)
    assert cut_of(upper, 9, left)[0] == pytest.approx(9 - (abs(-20 - 10j) - 10 - 4), abs=1e-3)
    short = Move(0, "ccw", 10 + 10j, 20j, 10j, "OFFSET", False)
    assert cut_of(short, 9, right)[0] == pytest.approx(9 - (abs(20 - 10 - 10j) - 4), abs=1e-3)
    assert cut_of(short, 9, left)[0] < 0


def test_a_start_up_from_behind_a_corner_runs_over_it() -> None:
    """Type A ends perpendicular to the next block, so that the way there leads along the face and over the corner."""
    verdict = judge(program("G1 X0. C0. F200/G41 X40. C0./C-30./G40 X150."), 5, shapely.box(-60, -60, 20, 0))
    assert (verdict.alarms, verdict.ramps, verdict.contour) == ({}, pytest.approx(5), pytest.approx(0))


def test_a_slot_in_two_loops_is_cut_by_each_as_far_as_it_is_too_narrow() -> None:
    blocks = "G1 X70. C0. F200/G41 X50. C3./X-50./G40 X-70. C0./G41 X-50. C-3./X50./G40 X70. C0."
    bar = disc(20).difference(shapely.box(-100, -3, 100, 3))
    verdict = judge(program(blocks), 5, bar)
    assert (verdict.contour, verdict.other_loop) == (pytest.approx(4, abs=1e-3), True)
    assert judge(program(blocks), 3, bar).depth == pytest.approx(0, abs=1e-3)


ROUND_A_SQUARE = "C20./X-40./C-20./X40."


@looped(
    ("before", "first", "depth"),
    [("Z-3.", "Z-4.", 0.528), ("Z-4.", "", 0.528), ("Z2.", "Z-4.", 0.0), ("Z0.", "Z-4.", 0.0), ("", "", 0.528)],
)
def test_a_ramp_cuts_where_it_is_below_the_face(before: str, first: str, depth: float) -> None:
    blocks = ["G1 X20. C-50. F200", before, "G42 X40. C-20.", first, *ROUND_A_SQUARE.split("/"), "G40 X20. C-50."]
    verdict = judge(program("/".join(filter(None, blocks))), 5, SQUARE)
    assert (verdict.ramps, verdict.contour) == (pytest.approx(depth, abs=1e-3), pytest.approx(0))


@looped("overlap", ["", "/C7."])
def test_perpendicular_leads_cut_nothing(overlap: str) -> None:
    blocks = f"G1 X80. C-4. F200/G42 X60. C0./X40./C20./X-40./C-20./X40./C1.{overlap}/X60./G40 X80. C5."
    assert judge(program(blocks), 3, SQUARE).depth == pytest.approx(0)


@looped("radius", [1, 6, 7.9])
def test_leads_on_an_arc_cut_nothing(radius: float) -> None:
    blocks = "G1 C-8. F300/G42 X40. F120/X36./G2 X20. C0. R8./G3 I-10. J0./G2 X36. C8. R8./G1 G40 X132."
    verdict = judge(program(blocks), radius, disc(10))
    assert (verdict.alarms, verdict.depth) == ({}, pytest.approx(0, abs=1e-3))
    assert judge(program(blocks), 8.1, disc(10)).alarms == {"inside_arc_too_small": [9, 11]}


def test_leads_that_cross_at_a_corner_cut_nothing() -> None:
    blocks = "G1 X34.213 C-3.288 F200/G42 X29.509 C-1.93/X-11.411 C9.883/C-9.883/X29.509 C1.93/G40 X34.213 C3.288"
    tip = -5.7055 + (29.509 + 11.411) / 2 * 9.883 / (9.883 + 1.93)  # where the two sides meet on the axis
    triangle = shapely.Polygon([(tip, 0), (-5.7055, 9.883), (-5.7055, -9.883)])
    assert judge(program(blocks), 1.43, triangle).depth == pytest.approx(0, abs=1e-3)


def test_what_the_control_objects_to_is_an_alarm() -> None:
    step = "G1 X-40. C0. F200/G41 X0./X40./C-4./X52./C0./X92./G40 X120. C20."
    assert "interferes" in judge(program(step), 5, shapely.box(-60, -60, 60, -10)).alarms
    arc = "G1 X40. C-30. F200/G42 G3 X60. C-20. I0. J10./G1 C20./G40 X90."
    assert "ramp_on_arc" in judge(program(arc), 5, shapely.box(-20, -20, 20, 20)).alarms
    short = judge(program("G1 X46. C0. F200/G42 X40./C20./X-40./C-20./X40./C0./G40 X80."), 5, SQUARE)
    assert short.short_ramp == pytest.approx(0.4)


def test_a_block_through_the_part_and_the_wrong_side_are_told() -> None:
    blocks = "G1 X80. C0. F200/{} X40. C0./C20./X-40./C-20./X40./C0./G40 X80."
    right, wrong = (judge(program(blocks.format(code)), 3, SQUARE) for code in ("G42", "G41"))
    assert (right.wrong_side, right.through, right.depth) == (False, False, pytest.approx(0))
    assert (wrong.wrong_side, wrong.through, wrong.depth) == (True, False, pytest.approx(3))
    assert judge(program(blocks.format("G42").replace("X-40./", "X-40./X0./")), 3, SQUARE).through


@pytest.mark.ci
@looped("seed", range(0, 39, 4), one_in=6)
def test_samples_along_the_path_say_the_same(seed: int) -> None:
    one = program_of(seed)
    verdict = judge(one.text, one.radius, one.part)
    section = read_section(one.text, one.radius)
    deepest = 0.0
    for move in simulate(section.start, section.blocks).moves:
        points = np.array(along(move))
        for begin, end in itertools.pairwise(points):
            between = np.linspace(begin, end, math.ceil(abs(end - begin) / 0.1) + 1)
            apart = shapely.distance(shapely.points(between.real, between.imag), one.part).min()
            if move.phase != "CANCELLED" and section.heights[move.row] < 0:
                deepest = max(deepest, one.radius - apart)
    assert verdict.depth == pytest.approx(deepest, abs=0.051)
    assert verdict.depth >= deepest - 1e-9


@pytest.mark.ci
@looped("seed", range(26), one_in=3)
def test_every_wall_of_the_part_is_programmed(seed: int) -> None:
    """So that the part by construction is the one of the program; round the bar nothing is milled."""
    one = program_of(seed)
    section = read_section(one.text, one.radius)
    run = simulate(section.start, section.blocks)
    loops = loops_of(run)
    ways = [along(element) for row, element in run.elements.items() if element.side and not loops[row].ramp]
    written = shapely.union_all([shapely.LineString([(point.real, point.imag) for point in way]) for way in ways])
    walls = one.part.boundary.intersection(shapely.box(-4000, -4000, 4000, 4000))
    if one.bar is not None:
        walls = walls.difference(shapely.Point(0, 0).buffer(one.bar / 2, quad_segs=360).boundary.buffer(0.01))
    assert walls.difference(written.buffer(0.01)).length < 0.01


# --- the generator ------------------------------------------------------------------------------------------------


@pytest.mark.ci
@looped("seed", range(26), one_in=12)
def test_twins_have_the_same_part_and_the_same_path(seed: int) -> None:
    one = program_of(seed)
    assert one == program_of(seed)
    assert one.part.is_valid
    assert one.part.area > 0
    start = read_section(one.text, one.radius)
    for twin in (Twin(inch=True, incremental=False), Twin(inch=False, incremental=True)):
        other = read_section(program_of(seed, twin).text, one.radius)
        assert [block.kind for block in other.blocks] == [block.kind for block in start.blocks]
        ends = [abs(block.end - same.end) for block, same in zip(other.blocks, start.blocks, strict=True)]
        assert max(ends) < 0.003
    area = shapely.area(one.part)
    for twin in twins_of(seed):
        assert program_of(seed, twin).part.area == pytest.approx(area, rel=2e-3)


@pytest.mark.nightly
def test_a_disagreement_is_seen() -> None:
    """Each kind, by a program that polarcheck judges well and a part that is not the one that it makes."""
    blocks = "G1 X80. C0. F200/G42 X40. C0./C20./X-40./C-20./X40./C0./G40 X80."
    sound = Program(0, "", program(blocks), 3.0, SQUARE, SQUARE, None)
    assert (compare(sound).judged, compare(sound).disagreement) == ("sound", "")
    larger = sound._replace(part=SQUARE.union(shapely.box(-5, 22, 5, 30)))
    assert (compare(larger).judged, compare(larger).disagreement) == ("unsound", "missed")

    swept = program("G1 X0. C0. F200/G41 X40. C0./C-30./X0./G40 C-50.")
    cut = sound._replace(text=swept, radius=5.0, part=shapely.box(0, -30, 20, 0))
    assert (compare(cut).judged, compare(cut).disagreement) == ("unsound", "")
    elsewhere = cut._replace(part=shapely.box(900, 0, 901, 1))
    assert (compare(elsewhere).judged, compare(elsewhere).disagreement) == ("sound", "false error")
    shallower = cut._replace(part=shapely.box(0, -30, 20, -2))
    assert (compare(shallower).judged, compare(shallower).disagreement) == ("unsound", "wrong depth")

    groove = "G1 X70. C0. F200/G41 X50. C3./X-20./C-3./X50./G40 X70. C0."
    alarm = sound._replace(text=program(groove), radius=5.0, part=elsewhere.part)
    assert (compare(alarm).judged, compare(alarm).disagreement) == ("alarm", "")


@looped(
    ("judged", "depths"),
    [("sound", (0.0, 0.0)), ("sound", (0.0, 0.004)), ("undecided", (0.0, 0.03)), ("unsound", (0.021, 0.5))],
)
def test_what_hangs_on_a_bar_that_is_not_known_is_undecided(judged: str, depths: tuple[float, float]) -> None:
    verdict = Verdict({}, -1.0, 0.0, 0.0, 0, 0j, False, False, False)
    assert class_of(verdict, *depths) == judged


@pytest.mark.nightly
def test_the_command_prints_a_table_and_keeps_what_differs(tmp_path: Path) -> None:
    command = [sys.executable, GENERATOR, "--count", "3", "--seed", "0", "--family", "polygons", "--keep", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.stdout.splitlines()[1].split()[0] == "polygons"
    assert done.stdout.splitlines()[1].split()[1:] == done.stdout.splitlines()[2].split()[1:]
    assert (done.returncode == 1) == any(not one.name.startswith(TOLD_FILES) for one in tmp_path.iterdir())
