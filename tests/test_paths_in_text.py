"""`--show path`: known shapes in the characters of a terminal, and the curve of C beside its closed form."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner, Result
from hypothesis import given, settings
from hypothesis import strategies as st

from polarcheck.checking import check
from polarcheck.commands import main
from polarcheck.foundation.arrays import Floats, Points
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, with_tool
from polarcheck.rules.tables import Tables
from polarcheck.view.face_view import face_view
from polarcheck.view.section_view import SectionView, views_of
from polarcheck.view.strip import strip

SAMPLES = Path(__file__).parent.parent / "sample_programs"
NOTHING = np.zeros(0, complex)
HEAD = "G21 G98 G40 T0808\nG0 X60. Z2. C0\nG12.1\n"


def circle(radius: float, center: complex = 0) -> Points:
    return np.asarray(center + radius * np.exp(1j * np.linspace(0, 2 * np.pi, 2000)))


def square(half: float) -> Points:
    side = np.linspace(-half, half, 500)
    return np.concatenate([side + 1j * half, side - 1j * half, half + 1j * side, -half + 1j * side])


def dots(lines: list[str]) -> set[tuple[int, int]]:
    """The dots of Braille patterns, across and down."""
    bits = [(0, 0, 1), (0, 1, 2), (0, 2, 4), (1, 0, 8), (1, 1, 16), (1, 2, 32), (0, 3, 64), (1, 3, 128)]
    return {
        (2 * across + x, 4 * down + y)
        for down, line in enumerate(lines)
        for across, character in enumerate(line.removesuffix(" C0"))
        for x, y, bit in bits
        if 0x2800 <= ord(character) <= 0x28FF and (ord(character) - 0x2800) & bit
    }


def tables(program: str, *tools: str, **limits: float) -> Tables:
    job = Job()
    for tool in tools:
        job = with_tool(job, tool)
    machine = profiles.load("fanuc", [("test", {"limits": limits})] if limits else []).machine
    return check.read(program.encode(), machine, job)[0][1]


def only_view(program: str, *tools: str, **limits: float) -> SectionView:
    (view,) = views_of(tables(program, *tools, **limits))
    return view


# ---- what is seen from in front ----


@looped("radius", [1e-6, 0.5, 30.0, 1e6, 1e300])
def test_a_circle_is_round(radius: float) -> None:
    found = np.array(sorted(dots(face_view(NOTHING, circle(radius), NOTHING, 80, 12, dots=True))))
    across, down = np.ptp(found, axis=0) + 1
    assert down == 12 * 4
    assert abs(across - down) <= 1
    middle = (found.min(axis=0) + found.max(axis=0)) / 2
    off = np.abs(np.hypot(*(found - middle).T) - (down - 1) / 2)
    assert off.max() < 1.0
    lines = face_view(NOTHING, circle(radius), NOTHING, 80, 12, dots=False)
    # Of ASCII a cell is twice as high as it is wide.
    assert len(lines) == 12
    assert abs(max(len(line.removesuffix(" C0")) for line in lines) - 2 * 12) <= 1


@looped("with_dots", [True, False])
def test_a_square_has_its_corners_and_nothing_inside_but_the_center(with_dots: bool) -> None:
    lines = face_view(NOTHING, square(10), NOTHING, 60, 9, dots=with_dots)
    rows = [line.removesuffix(" C0") for line in lines]
    width = len(rows[0])
    assert all(len(row) == width for row in rows)
    assert all(row[0] != " " != row[-1] for row in rows)
    assert " " not in rows[0] + rows[-1]
    inside = "".join(row[1:-1] for row in rows[1:-1])
    assert inside.replace(" ", "") == "+"
    assert lines[len(lines) // 2].endswith(" C0")
    if with_dots:
        found = dots(lines)
        right, bottom = (max(one) for one in zip(*found, strict=True))
        assert {(0, 0), (right, 0), (0, bottom), (right, bottom)} <= found
        assert right == bottom


def test_x_is_to_the_right_and_c_upwards() -> None:
    lines = face_view(NOTHING, np.array([20 + 0j, 10j]), np.array([-5 - 5j]), 40, 12, dots=False)
    places = {one: (line.index(one), row) for row, line in enumerate(lines) for one in "+x" if one in line}
    circles = [(at, row) for row, line in enumerate(lines) for at, one in enumerate(line) if one == "o"]
    (above, right) = sorted(circles, key=lambda place: place[0])
    assert above[0] == places["+"][0]
    assert above[1] < places["+"][1] == right[1]
    assert right[0] > places["+"][0] > places["x"][0]
    assert places["x"][1] > places["+"][1]


def test_the_tool_lies_over_the_contour_which_stands_alone_without_it() -> None:
    both = "".join(face_view(circle(10), circle(20), NOTHING, 40, 12, dots=False))
    assert both.count("o") > both.count(".") > 10
    same = "".join(face_view(circle(10), circle(10), NOTHING, 40, 12, dots=False))
    assert "." not in same
    alone = "".join(face_view(circle(10), NOTHING, NOTHING, 40, 12, dots=False))
    assert alone == same


points = st.lists(
    st.complex_numbers(max_magnitude=1e6, allow_nan=False)
    | st.sampled_from([0j, complex("nan"), complex("inf"), 1e300 + 0j, 5e-324 + 0j]),
    max_size=6,
).map(lambda values: np.array(values, complex))


@pytest.mark.nightly
@settings(max_examples=60)
@given(points, points, points, st.integers(8, 70), st.integers(2, 20), st.booleans())
def test_any_points_fit(
    programmed: Points, tool: Points, marks: Points, columns: int, rows: int, with_dots: bool
) -> None:
    lines = face_view(programmed, tool, marks, columns, rows, dots=with_dots)
    assert 1 <= len(lines) <= rows
    assert max(map(len, lines)) <= columns
    text = "".join(lines)
    assert "+" in text or "x" in text
    assert text.isascii() or with_dots
    assert ("x" in text) == np.isfinite(marks).any()


def test_colors_change_no_character() -> None:
    def paint(style: str, text: str) -> str:
        return f"<{style}>{text}</>"

    plain = face_view(circle(10), circle(20), np.array([20j]), 40, 12, dots=True)
    painted = face_view(circle(10), circle(20), np.array([20j]), 40, 12, dots=True, paint=paint)
    assert [re.sub(r"<[^>]*>", "", line) for line in painted] == plain
    assert {"<error>x</>", "<message>+</>"} <= set(re.findall(r"<error>.*?</>|<message>.*?</>", "".join(painted)))


# ---- the strip ----


def heights(lines: list[str]) -> list[float]:
    """The height of each column in cells, by eighths."""
    width = max(map(len, lines))
    values = {chr(0x2580 + eighth): eighth / 8 for eighth in range(1, 9)} | {"#": 1.0, "_": 0.5}
    columns = zip(*(line.ljust(width) for line in lines), strict=True)
    return [sum(values.get(cell, 0.0) for cell in column) for column in columns]


@looped("with_dots", [True, False])
def test_the_strip_is_as_high_as_its_values(with_dots: bool) -> None:
    time = np.linspace(0, 10, 4001)
    values = 100 * np.sin(time / 10 * np.pi)
    found = heights(strip(time, values, np.nan, 40, 5, dots=with_dots))
    edges = np.linspace(0, 10, 41)
    middle = np.sin(np.clip(np.pi / 2, edges[:-1] * np.pi / 10, edges[1:] * np.pi / 10))
    step = 1 / 8 if with_dots else 1 / 2
    np.testing.assert_allclose(found, 5 * middle, atol=step * 0.51 + 0.01)


def test_the_limit_is_drawn_where_it_is_near() -> None:
    time, values = np.array([0.0, 10.0]), np.array([0.0, 100.0])
    lines = strip(time, values, 50.0, 20, 4, dots=False)
    assert [("-" in line) for line in lines] == [False, True, False, False]
    assert not any("-" in line for line in strip(time, values, 1000.0, 20, 4, dots=False))
    near = strip(time, values, 200.0, 20, 4, dots=False)
    assert near[0] == "-" * 20
    assert max(heights(near)) == 2


def test_one_short_peak_is_never_lost() -> None:
    values = np.zeros(100_000)
    values[12_345] = 7.0
    found = heights(strip(np.arange(100_000.0), values, np.nan, 60, 5, dots=True))
    assert [at for at, height in enumerate(found) if height == 5] == [7]


@looped(
    ("values", "is_empty"),
    [([], True), ([np.nan, np.nan], True), ([0.0, 0.0], True), ([0.0, np.inf], True), ([1.0, np.inf], False)],
)
def test_what_there_is_no_curve_of(values: list[float], is_empty: bool) -> None:
    time = np.arange(float(len(values)))
    assert (strip(time, np.array(values), np.nan, 20, 4, dots=True) == []) == is_empty


# ---- from programs ----


def test_the_curve_of_a_flat_is_that_of_its_closed_form() -> None:
    """On a line at the distance d from the center C turns by F d / r^2."""
    view = only_view(HEAD + "G1 X20. C-15. F600\nC15.\nG13.1\nM30\n", "8:radius=0")
    first = np.hypot(20, 15) / 10
    along = (view.time - first) * 10 - 15
    on_flat = (view.time > first + 0.05) & (view.time < view.time[-1])
    expected = np.degrees(600 * 10 / (10**2 + along**2))
    assert on_flat.sum() > 50
    np.testing.assert_allclose(view.rate[on_flat], expected[on_flat], rtol=0.01)
    assert view.rate.max() == pytest.approx(np.degrees(60), rel=1e-12)
    assert view.time[-1] == pytest.approx(first + 3, abs=0.02)
    assert view.highest_line == 5


def distance_to(points: Points, path: Points) -> Floats:
    return np.abs(points[:, None] - path[None, :]).min(axis=1)


@pytest.mark.nightly
def test_paths_are_those_of_the_program() -> None:
    program = HEAD + "G1 G42 X30. F100\nG3 X30. C0 I-15. J0\nG40 X60.\nG13.1\nM30\n"
    view = only_view(program, "8:radius=4")
    ramp = np.linspace(15, 30, 3000) + 0j
    contour, center = np.append(circle(15), ramp), np.append(circle(19), ramp[ramp.real > 19])
    for found, path in ((view.programmed, contour), (view.tool, center)):
        assert distance_to(found, path).max() < 0.05
        assert distance_to(path, found).max() < 60 / 400 * 2
    assert view.remarks == []


def test_without_the_radius_the_programmed_path_is_shown_and_that_is_said() -> None:
    program = HEAD + "G1 G42 X30. F100\nG3 X30. C0 I-15. J0\nG40 X60.\nG13.1\nM30\n"
    view = only_view(program)
    assert len(view.tool) == 0 < len(view.programmed)
    text = "\n".join(view.lines(80, dots=False))
    assert "oo contour as programmed; no path of the tool is known" in text
    assert "R, or a position, is not known" in text.replace("\n ", "")
    assert "rate of C over time: not known" in text


@pytest.mark.ci
@looped(
    ("program", "said"),
    [
        (HEAD + "G13.1\nM30\n", "+ C0"),
        (HEAD + "G1 X40. F100\nG13.1\nM30\n", "C does not turn"),
        (HEAD + "G1 X-60. F100\nG13.1\nM30\n", "without bound, through the center"),
        (HEAD + "G1 X2000000. C1000000. F100\nC-1000000.\nG13.1\nM30\n", "1000000.000 x 2000000.000 mm"),
        ("G12.1\nG1 C5. F100\nC9.\nG13.1\nM30\n", "not known"),
    ],
)
def test_sections_with_little_or_much_to_show(program: str, said: str) -> None:
    for with_dots in (True, False):
        lines = list(only_view(program).lines(70, dots=with_dots))
        assert max(map(len, lines)) <= 70
        assert said in " ".join(" ".join(lines).split())


def test_of_many_sections_the_first_are_shown_and_the_others_counted() -> None:
    one = "G12.1\nG1 X40. F100\nX60.\nG13.1\n"
    views = list(views_of(tables("G21 G98\nG0 X60. C0\n" + 20 * one + "M30\n")))
    assert len(views) == 12
    assert [view.remarks for view in views[-2:]] == [[], ["8 more sections are not shown"]]


@pytest.mark.nightly
def test_very_many_blocks_are_few_points() -> None:
    angle = np.arange(30_000) / 500
    blocks = "\n".join(f"X{40 * np.cos(one):.4f} C{20 * np.sin(one):.4f}" for one in angle)
    view = only_view(f"{HEAD}G1 F100\n{blocks}\nG13.1\nM30\n")
    assert len(view.tool) < 5000
    assert len(view.time) <= 401
    assert distance_to(circle(20), view.tool).max() < 0.3


# ---- the command line ----


def run(*arguments: str, charset: str = "utf-8", **environment: str) -> Result:
    return CliRunner(charset=charset).invoke(main, [*arguments], env={"TERM": "xterm", **environment})


@pytest.mark.ci
def test_check_shows_paths_behind_the_findings() -> None:
    path = str(SAMPLES / "c_axis_too_fast.nc")
    result = run("check", "--show", "path", path)
    assert result.exit_code == 1
    findings, _, rest = result.stdout.partition(f"{path}: section of lines 9 to 14, offset 2\n")
    assert "error: C axis would turn" in findings
    assert "x end of a block with a finding" in rest
    assert "at most 17189 deg/min in line 12 (limit 10800)" in rest
    assert any(0x2800 < ord(character) < 0x2900 for character in rest)
    assert f"{findings}fail" + rest.rpartition("\nfail")[2] == run("check", path).stdout


@pytest.mark.ci
@looped(("charset", "term"), [("ascii", "xterm"), ("utf-8", "dumb"), ("cp437", "xterm")], one_in=2)
def test_what_a_terminal_cannot_show_is_ascii(charset: str, term: str) -> None:
    for command in ("check", "trace"):
        result = run(command, "--show", "path", str(SAMPLES / "hexagon.nc"), charset=charset, TERM=term)
        assert result.exit_code == 0
        assert result.stdout.isascii()
        assert "oo tool center  .. contour as programmed" in result.stdout


def test_trace_shows_them_in_place_of_the_table() -> None:
    text = run("trace", "--show", "path", "--color", "never", str(SAMPLES / "hexagon.nc")).stdout
    assert text.startswith("section of lines 9 to 22, offset 1\n")
    assert "\x1b" not in text
    assert "\x1b[" in run("trace", "--show", "path", "--color", "always", str(SAMPLES / "hexagon.nc")).stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("check", "--format", "json"), "--show path: expected --format text, found json"),
        (("check", "-o", "json:report.json"), "--show path: expected --format text, found json"),
        (("trace", "--format", "csv"), "--show path: expected --format table, found csv"),
    ],
)
def test_other_formats_have_no_place_for_paths(
    arguments: tuple[str, ...], said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(*arguments, "--show", "path", str(SAMPLES / "hexagon.nc"))
    assert (result.exit_code, result.stderr) == (2, f"polarcheck: {said}\n")
    assert list(tmp_path.iterdir()) == []
