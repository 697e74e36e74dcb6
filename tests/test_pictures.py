"""What is drawn of a program: paths, moves, rates, the part and marks, beside parts that are known by construction."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
import shapely
from cases import looped
from hypothesis import given, settings
from hypothesis import strategies as st
from polarcheck.errors import TooHardError
from programs import job_of, machine_of, report_of

from polarcheck.checking import check
from polarcheck.foundation.states import Motion
from polarcheck.geometry.segments import Curves
from polarcheck.rules.rule import load_all
from polarcheck.view import path_points
from polarcheck.view.picture_data import Drawn, SectionPicture
from polarcheck.view.run_drawing import drawn, split

HEAD = "G21 G98 G40 T0808\nG0 X80. C0 Z2.\nG12.1\n"
END = "G40 X80. F500\nG13.1\nM30\n"
#: A hexagon 30 across flats, cut once round from the middle of a flat.
CORNERS = [(30, 8.660254), (0, 17.320508), (-30, 8.660254), (-30, -8.660254), (0, -17.320508), (30, -8.660254), (30, 0)]
HEXAGON = HEAD + "G1 Z-2. F300\nG42 X30. F200\n" + "".join(f"X{x:.1f} C{c:.6f}\n" for x, c in CORNERS) + END
#: A pocket with a groove 6 wide into it, and a cutter of 8: it cuts 2 deep into both walls of the groove.
GROOVE = (
    HEAD.replace("X80.", "X100.")
    + "G1 C3. F500\nZ-2.\nG41 X60. F200\nX30.\nC20.\nX-20.\nC-20.\nX30.\nC-3.\nX60.\n"
    + END.replace("X80.", "X100.")
)
ARCS = HEAD + "G1 Z-1. F300\nG42 X40. F200\nG3 X-40. C0 I-20. J0\nG3 X40. C0 I20. J0\nG1\n" + END


def drawn_of(program: str | bytes, *tools: str, machine: str = "fanuc", **more: Any) -> Drawn:
    data = program if isinstance(program, bytes) else program.encode()
    job = job_of(*tools, job=more.pop("job", None))
    runs = check.read(data, machine_of(machine, more.pop("changes", None)), job, "x.nc")
    report, found = split(drawn(check.check_runs(runs, list(load_all().values())), runs))
    assert found is not None
    assert type(report).__name__ == "FileReport"
    return found


def section_of(program: str | bytes, *tools: str, **more: Any) -> SectionPicture:
    (section,) = drawn_of(program, *tools, **more).sections
    return section


def points(path: Any) -> np.ndarray[Any, Any]:
    return np.array(
        [complex(np.nan, np.nan) if x is None else complex(x, c) for x, c in zip(path.x, path.c, strict=True)]
    )


def column(values: Any) -> np.ndarray[Any, Any]:
    return np.array([np.nan if value is None else value for value in values], float)


# ---- paths ----


def test_the_tool_runs_r_beside_the_contour() -> None:
    section = section_of(HEXAGON, "8:radius=4")
    tool = points(section.tool)
    # The corners of a hexagon 19 from the center to its flats, between the middles of two of its sides.
    reach = 19 / math.cos(math.pi / 6)
    corners = [reach * np.exp(1j * math.radians(angle)) for angle in (30, 90, 150, 210, 270, 330)]
    assert tool[2:8] == pytest.approx(corners, abs=2e-4)
    assert (tool[0], tool[-1]) == (40, 40)
    assert points(section.programmed)[1] == 15
    assert section.thinned <= 1e-2
    assert section.needs_radius == ""


def test_each_move_is_told_with_what_it_is() -> None:
    moves = section_of(HEXAGON, "8:radius=4").moves
    assert moves.role == ["positioning", "start up", *["cut"] * 7, "cancel"]
    assert moves.block[:2] == ["G1 Z-2. F300", "G42 X30. F200"]
    assert moves.line == [*range(4, 14)]
    assert moves.z == [(2, -2), *[(-2, -2)] * 9]
    assert moves.start[0] == moves.end[0] == (40, 0)
    assert moves.time[:2] == [pytest.approx(60 * 4 / 300), pytest.approx(60 * 21 / 200)]
    assert moves.begin[1:] == pytest.approx(np.cumsum(column(moves.time))[:-1], abs=1e-3)


def test_in_rapid_traverse_f_says_nothing() -> None:
    moves = section_of(HEXAGON.replace("G1 Z-2. F300\n", "G1 Z-2. F300\nG0 X70.\nG1 X60.\n"), "8:radius=4").moves
    assert moves.feed[:3] == [300, None, 300]
    assert moves.role[:3] == ["positioning"] * 3
    assert moves.c_feed[1] is moves.true_feed[1] is moves.time[1] is None


def test_sequence_numbers_are_as_they_are_written() -> None:
    numbered = "".join(f"N{10 * number:04} {line}\n" for number, line in enumerate(HEXAGON.splitlines()))
    assert section_of(numbered, "8:radius=4").moves.number[:2] == ["N0030", "N0040"]


def test_arcs_are_chords_within_what_is_said() -> None:
    section = section_of(ARCS, "8:radius=5")
    tool = points(section.tool)
    round_ = tool[np.abs(np.abs(tool) - 25) < 0.1]
    middle = (round_[1:] + round_[:-1]) / 2
    assert len(round_) > 50
    assert 25 - np.abs(middle).min() <= section.thinned + 1e-4
    assert section.thinned < 0.01


def test_corner_lines_of_the_control_are_told() -> None:
    sharp = HEAD + "G1 Z-1. F300\nG42 X40. F200\nC20.\nX-20. C-30.\nX40. C-10.\nC0\n" + END
    assert "corner" in section_of(sharp, "8:radius=4").moves.role


def distance(point: Any, path: Any) -> Any:
    """From each point to the nearest of some segments, one by one."""
    start, way = path[:-1], np.diff(path)
    length = np.maximum(np.abs(way), 1e-12)
    along = np.clip(((point[:, None] - start) * (way / length).conj()).real, 0, length)
    return np.abs(point[:, None] - start - along * way / length).min(axis=1)


@pytest.mark.nightly
@settings(deadline=None, max_examples=20)
@given(st.integers(0, 2**32 - 1), st.integers(50, 400))
def test_thinned_paths_lie_as_near_as_is_said(seed: int, most: int) -> None:
    random = np.random.default_rng(seed)
    angle = np.linspace(0, 2 * np.pi, 2401)
    wave = sum(random.normal(0, 1 / (k + 1)) * np.cos(k * angle + random.uniform(0, 6)) for k in range(2, 9))
    path = (20 + wave) * np.exp(1j * angle)
    count = len(path) - 1
    line = np.full(count, Motion.LINE, np.int16)
    none = np.full(count, complex(np.nan, np.nan))
    zeros = np.zeros(count, np.int64)
    whole, off = path_points.chords(Curves(path[:-1], path[1:], none, line, zeros, zeros), 0.01, 10_000)
    assert np.allclose(whole.point, path)
    kept = np.zeros(count, bool)
    kept[random.integers(0, count, 10)] = True
    look = (np.arange(count) > count // 2).astype(np.int16)
    found, more = path_points.thinned(whole, kept, look, 1e-5, most)
    assert len(found) < len(whole)
    assert len(found) <= most + 2 * 10 + 8
    assert distance(whole.point, found.point).max() <= more + 1e-9
    # What is kept has both its ends, and its own way.
    at = np.flatnonzero(np.isin(found.move, np.flatnonzero(kept)) & ~found.begins)
    assert found.move[at].tolist() == np.flatnonzero(kept).tolist()
    assert np.allclose(found.point[at - 1], path[found.move[at]])
    assert np.isin(path[count // 2 + 1], found.point)
    assert off <= 0.01


def test_a_path_that_is_short_enough_is_left_as_it_is() -> None:
    assert len(section_of(HEXAGON, "8:radius=4").tool.x) == 10


@pytest.mark.nightly
def test_50_000_short_blocks_make_a_small_picture_that_is_near() -> None:
    count = 50_000
    angle = 2 * np.pi * np.arange(1, count + 1) / count
    far = 20 + 0.5 * np.sin(7 * angle)
    words = zip(2 * far * np.cos(angle), far * np.sin(angle), strict=True)
    blocks = "".join(f"X{x:.4f}C{c:.4f}\n" for x, c in words)
    program = HEAD + "G1 Z-1. F300\nG42 X40. F200\n" + blocks + END
    section = section_of(program, "8:radius=0.5")
    assert section.move_count > count
    assert len(section.tool.x) <= 20_000
    assert len(section.moves.line) <= 20_000
    assert len(section.rates.t) <= 20_100
    tool = points(section.tool)
    assert section.thinned < 0.001
    assert section.thinned < section.played < 0.02
    seen = np.angle(tool[2:-1])
    # The tool runs R outside of the contour, along its normal.
    true = 20 + 0.5 * np.sin(7 * seen)
    slope = 3.5 * np.cos(7 * seen)
    beside = (np.abs(tool[2:-1]) - true) * true / np.hypot(true, slope)
    assert np.abs(beside - 0.5).max() < 0.03
    assert {*section.tool.move} <= {*range(len(section.moves.line))}
    assert max(move for move in section.rates.move if move is not None) < len(section.moves.line)
    # The fastest move stands in the table, and its rate in the curve.
    assert np.nanmax(np.abs(column(section.rates.c_feed))) == pytest.approx(
        np.nanmax(column(section.moves.c_feed)), rel=1e-3
    )


# ---- rates ----


def sampled(section: SectionPicture, times: Any) -> tuple[Any, Any]:
    """C [deg] and X [mm] at some times, from the moves alone: lines and arcs about the center at their feed."""
    moves = section.moves
    points = np.empty(len(times), complex)
    for start, end, begin, time in zip(moves.start, moves.end, moves.begin, moves.time, strict=True):
        inside = (times >= begin) & (times <= begin + time + 1e-9)
        share = (times[inside] - begin) / time
        points[inside] = complex(*start) + share * (complex(*end) - complex(*start))
    return np.degrees(np.unwrap(np.angle(points))), np.abs(points)


@pytest.mark.nightly
def test_rates_are_those_of_a_dense_sampling() -> None:
    section = section_of(HEXAGON.replace("Z-2. F300", "X60. F300"), "8:radius=4")
    curves = section.rates
    t = column(curves.t)
    assert (np.diff(t) >= 0).all()
    times = np.linspace(t[0], t[-1], 50_001)
    angle, far = sampled(section, times)
    step = times[1] - times[0]
    middle = (times[1:] + times[:-1]) / 2
    # Not across the ends of moves, where the rates jump.
    ends = np.array([*section.moves.begin, t[-1]])
    inside = np.abs(middle[:, None] - ends).min(axis=1) > 0.02
    for dense, curve in ((60 * np.diff(angle) / step, curves.c_feed), (60 * np.diff(far) / step, curves.x_feed)):
        drawn_curve = np.interp(middle[inside], t, column(curve))
        assert drawn_curve == pytest.approx(dense[inside], abs=0.004 * np.abs(dense[inside]).max())
    assert np.abs(column(curves.c_feed)).max() == pytest.approx(column(section.moves.c_feed).max(), rel=1e-6)


@pytest.mark.ci
@looped(("i", "sense"), [(-8.0, "G3"), (-8.0, "G2"), (-19.0, "G3")])
def test_rates_on_arcs_off_the_center_have_their_peaks(i: float, sense: str) -> None:
    """A full circle about a point that is not the center of C: C turns fastest where the circle is nearest to it."""
    program = HEAD + f"G1 X40. F1000\n{sense} X40. C0 I{i} J0 F100\nG1 X80.\nG13.1\nM30\n"
    section = section_of(program)
    near, center = abs(20 + 2 * i), 20 + i
    radius = abs(i)
    on_arc = np.array([move == 1 for move in section.rates.move])
    c_feed = column(section.rates.c_feed)[on_arc]
    sign = 1 if sense == "G3" else -1
    turn = (1 + (radius**2 - center**2) / near**2) / (2 * radius)
    assert np.abs(c_feed).max() == pytest.approx(math.degrees(100 * abs(turn)), rel=1e-6)
    assert np.abs(column(section.rates.x_feed)[on_arc]).max() == pytest.approx(100 * min(1, center / radius), rel=2e-3)
    t = column(section.rates.t)[on_arc]
    whole = np.trapezoid(c_feed, t) / 60 if hasattr(np, "trapezoid") else np.trapz(c_feed, t) / 60
    assert whole == pytest.approx(sign * 360 * (radius > center), abs=1.5)


@pytest.mark.ci
def test_where_override_acts_c_is_held_and_f_goes_down() -> None:
    """On a flat 1 from the center F is lowered so that C turns at its limit; what it turns by in all is the same."""
    limits = {"c_feed": 2000.0, "automatic_override": True, "override_share": 100.0}
    program = HEAD + "G1 X2. C10. F500\nC-10. F400\nX80.\nG13.1\nM30\n"
    section = section_of(program, changes={"limits": limits})
    chosen = np.array([move == 1 for move in section.rates.move])
    c_feed, t = np.abs(column(section.rates.c_feed)[chosen]), column(section.rates.t)[chosen]
    feed = column(section.rates.feed)[chosen]
    assert c_feed.max() == pytest.approx(2000)
    assert feed.max() == pytest.approx(400)
    assert feed.min() == pytest.approx(math.radians(2000) * 1, rel=1e-3)
    turned = float(np.sum((c_feed[1:] + c_feed[:-1]) / 2 * np.diff(t)) / 60)
    assert turned == pytest.approx(2 * math.degrees(math.atan(10)), rel=6e-3)
    assert t[-1] - t[0] == pytest.approx(section.moves.time[1], abs=1e-3)
    assert section.moves.true_feed[1] == pytest.approx(math.radians(2000), abs=1e-3)


def test_a_dwell_takes_its_time() -> None:
    moves = section_of(HEXAGON.replace("C0.000000\n", "C0.000000\nG4 P1500\n"), "8:radius=4").moves
    assert moves.time[moves.block.index("G4 P1500")] == 1.5
    assert moves.begin[-1] == pytest.approx(sum(time for time in moves.time[:-1] if time is not None), abs=1e-3)


# ---- the part, and what is wrong with it ----


def test_the_finished_part_is_filled() -> None:
    (part,) = section_of(HEXAGON, "8:radius=4").parts
    assert part.known_outside
    assert (part.z, part.text) == (-2, "Z-2 mm: hexagon, 30.000 across flats")
    ((ring,),) = part.polygons
    assert shapely.Polygon(ring).area == pytest.approx(6 * 15**2 * math.tan(math.pi / 6), rel=1e-4)


@pytest.mark.nightly
def test_of_a_pocket_only_what_is_near_is_shown_unless_the_bar_is_known() -> None:
    (part,) = section_of(GROOVE, "8:radius=2").parts
    assert not part.known_outside
    (of_bar,) = section_of(GROOVE, "8:radius=2", job={"stock": {"diameter": 90.0}}).parts
    assert of_bar.known_outside
    far = np.abs([complex(*point) for point in of_bar.polygons[0][0]])
    assert far.max() == pytest.approx(45, abs=1e-3)


@pytest.mark.nightly
def test_an_overcut_is_the_area_that_the_cutter_takes() -> None:
    marks = section_of(GROOVE, "8:radius=4").marks
    assert [(mark.kind, mark.lines, mark.depth) for mark in marks] == [("overcut", [7, 13], 2), ("overcut", [13, 7], 2)]
    assert marks[0].text == "line 7 cuts 2 mm deep into the contour of line 13"
    # 15 x 2 beside the way, and half a segment 2 high where it begins.
    segment = 16 * math.acos(2 / 4) - 2 * math.sqrt(12)
    for mark, side in zip(marks, (-1, 1), strict=True):
        area = shapely.Polygon(mark.rings[0])
        assert area.area == pytest.approx(30 + segment / 2, abs=0.1)
        assert np.sign(area.centroid.y) == side


@pytest.mark.ci
def test_what_is_left_standing_has_its_place_and_line() -> None:
    text = load_all()["material-left"].page
    program = text.partition("Bad")[2].partition(":\n\n")[2].partition("Good")[0]
    section = section_of("\n".join(line.strip() for line in program.splitlines()), "1:radius=3")
    (mark,) = section.marks
    (found,) = report_of(
        "\n".join(line.strip() for line in program.splitlines()), "fanuc", "1:radius=3", only=["material-left"]
    ).findings
    assert (mark.kind, mark.lines) == ("left", [found.line])
    # The part ends at X40: from there the rib is as high as it is told.
    (ring,) = mark.rings
    assert max(x for x, _ in ring) - 20 == pytest.approx(mark.depth, abs=1e-3)
    assert min(x for x, _ in ring) == 20
    assert "stays behind line" in mark.text


@pytest.mark.ci
def test_a_strip_between_passes_is_as_thick_as_it_is_told() -> None:
    """Round passes at R 30 and R 21.5 with a cutter of 8: half a mm stays between 29.5 and 30."""
    rounds = "G42 X60. F200\nG3 X60. C0 I-30. J0\nG1 X43.\nG3 X43. C0 I-21.5 J0\nG1\n"
    marks = section_of(HEAD + "G1 Z-1. F300\n" + rounds + END, "8:radius=4").marks
    (strip,) = [mark for mark in marks if "strip" in mark.text]
    far = np.abs([complex(*point) for point in strip.rings[0]])
    assert (far.min(), far.max()) == pytest.approx((29.5, 30), abs=5e-3)
    assert strip.depth == pytest.approx(0.5, abs=5e-3)


# ---- what is not known ----


def test_without_r_no_tool_path_is_drawn_in_offset_mode() -> None:
    section = section_of(HEXAGON)
    assert section.moves.role == ["positioning", *["unknown"] * 9]
    assert not [move for move in section.tool.move if move]
    assert "R of T0808 is not known" in section.needs_radius
    assert "--tool 8:radius=..." in section.needs_radius
    assert len(section.programmed.x) == 10
    assert section.time is None
    # What the program is meant to make is known all the same.
    assert [part.text for part in section.parts] == ["Z-2 mm: hexagon, 30.000 across flats"]
    assert "whether the tool makes it was not looked at" in section.makes[0]


def test_a_section_without_compensation_is_run_as_programmed() -> None:
    section = section_of(HEXAGON.replace("G42 ", ""))
    assert {*section.moves.role} == {"cut"}
    assert points(section.tool)[1:] == pytest.approx(points(section.programmed)[1:], abs=1e-4)


def test_without_f_there_are_no_rates_but_paths() -> None:
    section = section_of(HEXAGON.replace(" F300", "").replace(" F200", ""), "8:radius=4")
    assert section.moves.time[:3] == [None] * 3
    assert section.time is None
    assert len(section.tool.x) == 10


def test_where_the_part_is_too_hard_the_path_is_drawn_and_it_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    def never(*arguments: Any) -> Any:
        raise TooHardError("its walls cross too often")

    monkeypatch.setattr("polarcheck.columns.metal.finished.Finished._levels_of", never)
    found = drawn_of(HEXAGON, "8:radius=4")
    assert len(found.sections[0].tool.x) == 10
    assert found.remarks == ["the finished part is not drawn: its walls cross too often"]


def test_a_program_without_a_section_has_no_picture() -> None:
    assert drawn_of("G0 X10.\nM30\n").sections == []
    assert drawn_of("").sections == []


# ---- units, sections, channels, runs ----


def test_an_inch_program_is_the_same_in_mm() -> None:
    inch = (
        "G20 G98 G40 T0808\nG0 X4. C0 Z.1\nG12.1\nG1 Z-.1 F10.\nG42 X1. F8.\nC.5\nX-1.\nC-.5\nX1.\nC0\nG40 X4.\nG13.1\n"
    )
    section = section_of(inch, "8:radius=0.25")
    assert (section.units, section.scale, section.radius) == ("inch", 25.4, 6.35)
    assert np.nanmax(points(section.tool)[1:-1].imag) == pytest.approx(25.4 * 0.75, abs=1e-3)
    assert section.moves.feed[1] == pytest.approx(8 * 25.4)


def test_each_section_is_a_picture_with_its_own_limits() -> None:
    first, second = drawn_of(
        HEXAGON.replace("M30\n", "") + HEXAGON, "8:radius=4", changes={"limits": {"c_feed": 900.0}}
    ).sections
    assert (first.line, first.end_line, second.line, second.end_line) == (3, 14, 17, 28)
    assert first.moves.begin == second.moves.begin
    assert first.c_limit == second.c_limit == 900
    assert max(column(first.moves.share)) == pytest.approx(max(column(first.moves.c_feed)) / 900, abs=1e-4)


@pytest.mark.ci
def test_each_channel_has_its_sections() -> None:
    program = "$1\n" + HEXAGON + "$2\n" + HEXAGON.replace("Z-2.", "Z-4.")
    sections = drawn_of(program, "8:radius=4", changes={"control": {"channel_mark": "$"}}).sections
    assert [section.channel for section in sections] == ["$1", "$2"]
    assert [section.parts[0].z for section in sections] == [-2, -4]
    assert sections[1].line == 20


@pytest.mark.ci
def test_of_two_runs_it_is_said_which_is_drawn() -> None:
    both = drawn_of(HEXAGON.replace("Z-2.", "Z-2.\n/Z-3.\n"), "8:radius=4")
    assert both.skip == "off"
    assert both.sections[0].parts[0].z == -3
    assert drawn_of(HEXAGON, "8:radius=4").skip == ""


def test_findings_are_never_thinned(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("polarcheck.view.section_pictures._OF_PROGRAM", 30)
    monkeypatch.setattr("polarcheck.view.section_pictures._LEAST", 30)
    angle = 2 * np.pi * np.arange(1, 401) / 400
    blocks = [f"X{40 * math.cos(one):.4f}C{20 * math.sin(one):.4f}" for one in angle]
    blocks[137] = "G0" + blocks[137] + "\nG1"
    program = HEAD + "G1 X40. F300\n" + "\n".join(blocks) + "\nX80.\nG13.1\nM30\n"
    section = section_of(program)
    assert section.move_count > 400
    assert len(section.moves.line) < 100
    assert section.remarks == [
        f"the table lists {len(section.moves.line)} of {section.move_count} moves: those that are drawn"
    ]
    assert program.split("\n").index(blocks[137].split("\n")[0]) + 1 in section.moves.line


# ---- data ----


@pytest.mark.nightly
def test_the_same_program_makes_the_same_picture() -> None:
    assert drawn_of(GROOVE, "8:radius=4") == drawn_of(GROOVE, "8:radius=4")


@pytest.mark.nightly
def test_columns_have_one_length_and_are_json() -> None:
    import msgspec

    for program in (HEXAGON, GROOVE, ARCS):
        section = section_of(program, "8:radius=4")
        for table in (section.moves, section.rates, section.tool, section.programmed):
            assert len({len(getattr(table, name)) for name in table.__struct_fields__}) == 1
        data = json.loads(msgspec.json.encode(section))
        assert "NaN" not in json.dumps(data)
        assert msgspec.convert(data, SectionPicture) == section


@pytest.mark.ci
@looped("program", ["G12.1\n", "O1\nG12.1\nG13.1\nM30\n", "T0101\nG0 X50. C0\nG12.1\nG13.1\nG12.1\n"])
def test_a_section_without_moves_has_an_empty_picture(program: str) -> None:
    sections = drawn_of(program, "1:radius=5").sections
    assert [section.move_count for section in sections] == [0] * program.count("G12.1")
