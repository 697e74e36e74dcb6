"""What a verdict rests on: the numbers of each polar section in closed form, and what makes a file unverified."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import pytest
from cases import looped
from programs import report_of
from test_cli import call, make

from polarcheck.foundation.finding import FileReport, PolarSection

HEAD = "O1\nG21 G40 G97 G98 G18\nT0101\n"
INCH = HEAD.replace("G21", "G20")


def square(approach: float, half: float, feed: float, depth: str = "Z-5.", off: str = "G13.1\n", x: int = 2) -> str:
    """Outside round a square, from the middle of one side; x: 2 where X is a diameter. The approach is such an X."""
    wall = f"X{x * half:.4f}"
    return (
        f"G0 X{approach:.4f} Z2. C0\nG12.1\nG1 {depth} F{feed:.4f}\nG42 {wall}\nC{half:.4f}\nX-{wall[1:]}\n"
        f"C{-half:.4f}\n{wall}\nC0.\nG40 X{approach:.4f}\nZ2.\n{off}"
    )


def closed_form(approach: float, half: float, feed: float, radius: float, deep: float = 7) -> dict[str, float]:
    """
    Lengths in the unit of feed and radius: the tool center goes round a square larger by R, and turns at the corner of
    two outside walls in one point. deep: the way of Z down, which it goes up again.
    """
    away, ramp = half + radius, approach / 2 - half
    return {
        "nearest": away,
        "c_feed": math.degrees(feed / away),
        "ramp_used": radius / ramp,
        "time": 60 * (8 * away + 2 * (ramp - radius) + 2 * deep) / feed,
    }


def values(section: PolarSection) -> dict[str, float | None]:
    return {name: getattr(section, name) for name in ("nearest", "c_feed", "ramp_used", "time")}


def sections(program: str, *tools: str, machine: str = "fanuc", **more: Any) -> list[PolarSection]:
    return report_of(program, machine, *tools, **more).polar_sections


# ---- the numbers ----


@pytest.mark.nightly
@looped(
    ("approach", "half", "feed", "radius"),
    [(80, 20, 200, 4), (80, 20, 200, 0), (80, 20, 200, 20), (100, 15, 317, 6.35), (60, 29, 1000, 0.5)],
)
def test_the_numbers_of_a_square(approach: float, half: float, feed: float, radius: float) -> None:
    [found] = sections(f"{HEAD}{square(approach, half, feed)}M30\n", f"1:radius={radius}")
    assert values(found) == pytest.approx(closed_form(approach, half, feed, radius), abs=2e-6)
    assert (found.line, found.end_line, found.c_feed_line) == (5, 15, 8)
    assert (found.units, found.offset, found.radius, found.radius_source) == ("mm", 1, radius, "command line")
    assert found.c_feed_limit is None


@looped(("approach", "half", "feed", "radius"), [(4, 1, 10, 0.25), (3, 0.5, 7.5, 0.375)])
def test_the_same_in_inch(approach: float, half: float, feed: float, radius: float) -> None:
    [found] = sections(f"{INCH}{square(approach, half, feed, 'Z-.2')}M30\n", f"1:radius={radius}")
    expected = closed_form(approach, half, feed, radius, deep=2.2)
    expected["nearest"] *= 25.4
    assert values(found) == pytest.approx(expected, abs=2e-6)
    assert (found.units, found.radius) == ("inch", pytest.approx(25.4 * radius))


@pytest.mark.nightly
@looped("machine", ["fanuc-16i", "fanuc-30i", "doosan", "gsk-988", "siemens-iso"])
def test_other_controls_see_the_same_path(machine: str) -> None:
    [found] = sections(f"{HEAD}{square(80, 20, 200)}M30\n", "1:radius=4", machine=machine)
    assert values(found) == pytest.approx(closed_form(80, 20, 200, 4), abs=2e-6)


def test_where_x_is_a_radius() -> None:
    program = f"O1\nG17 G90 G94 G40 G97\nT0101\n{square(40, 20, 200, x=1)}M30\n"
    [found] = sections(program, "1:radius=4", machine="mitsubishi-m700")
    assert values(found) == pytest.approx(closed_form(80, 20, 200, 4), abs=2e-6)


def test_a_wall_that_goes_by_off_center() -> None:
    """Without compensation: from X20 C-10 to X20 C10 the nearest point is 10 mm away, and C is fastest there."""
    program = f"{HEAD}G0 X60. Z2. C0\nG12.1\nG1 X20. C-10. F500\nC10. F100\nX60. F500\nG13.1\nM30\n"
    [found] = sections(program)
    assert found.nearest == pytest.approx(10)
    assert found.ramp_used is None
    # Fastest at the end of the way in, from (30, 0) to (10, -10): a line that passes at 300 / sqrt 500.
    assert found.c_feed == pytest.approx(math.degrees(500 * 300 / 500**0.5 / 200))
    assert found.c_feed_line == 6
    assert found.time == pytest.approx(60 * (500**0.5 / 500 + 20 / 100 + 20 / 500))


def test_the_ramp_that_needs_most_counts() -> None:
    program = f"{HEAD}{square(80, 20, 200)}M30\n".replace("G40 X80.0000", "G40 X50.")
    [found] = sections(program, "1:radius=4")
    assert found.ramp_used == pytest.approx(4 / 5)
    [found] = sections(program.replace("G40 X50.", "G40 X48."), "1:radius=4")
    assert found.ramp_used == pytest.approx(1)
    assert report_of(program.replace("G40 X50.", "G40 X48."), "fanuc", "1:radius=4").findings == []


def test_the_limit_is_that_of_the_machine() -> None:
    [found] = sections(f"{HEAD}{square(80, 20, 200)}M30\n", "1:radius=4", changes={"limits": {"c_feed": 3600}})
    assert found.c_feed_limit == 3600


# ---- where the radius comes from ----

PROGRAM = f"{HEAD}{square(80, 20, 200)}M30\n"
COMMENTED = PROGRAM.replace("T0101", "T0101 (D=8. END MILL)")


@pytest.mark.ci
@looped(
    ("program", "tools", "job", "expected"),
    [
        (PROGRAM, ["1:radius=4"], {}, (4.0, "command line")),
        (PROGRAM, [], {"tools": {"1": {"radius": 4}}}, (4.0, "job")),
        (PROGRAM, ["1:radius=3"], {"tools": {"1": {"radius": 4}}}, (3.0, "command line")),
        (PROGRAM, [], {}, (None, "none")),
        (PROGRAM, ["2:radius=4"], {}, (None, "none")),
        (COMMENTED, [], {}, (None, "none")),
        (COMMENTED, [], {"radius_from_comments": True}, (4.0, "comment")),
        (COMMENTED, ["1:radius=3.9"], {"radius_from_comments": True}, (3.9, "command line")),
        (PROGRAM.replace("T0101", "G10 P10001 R4. Q0\nT0101"), [], {}, (4.0, "program")),
        (PROGRAM.replace("T0101", "G10 P1 R4. Q0\nT0101"), ["1:radius=3"], {}, (4.0, "program")),
        (COMMENTED.replace("G0 ", "G10 P1 R3.9\nG0 ", 1), [], {"radius_from_comments": True}, (3.9, "program")),
    ],
    one_in=3,
)
def test_where_the_radius_comes_from(
    program: str, tools: list[str], job: dict[str, Any], expected: tuple[float | None, str]
) -> None:
    [found] = sections(program, *tools, job=job)
    assert (found.radius, found.radius_source) == expected


def test_the_offset_that_is_compensated_counts() -> None:
    program = f"{HEAD}{square(80, 20, 200)}T0202\n{square(80, 20, 200)}T0103\n{square(80, 20, 200)}M30\n"
    found = sections(program, "1:radius=4", "2:radius=5", "3:radius=6")
    assert [(one.offset, one.radius, one.nearest) for one in found] == [(1, 4, 24), (2, 5, 25), (3, 6, 26)]


def test_without_a_radius_the_path_of_the_tool_is_not_known() -> None:
    [found] = sections(PROGRAM)
    assert (found.nearest, found.c_feed, found.c_feed_line, found.ramp_used) == (None, None, None, None)


def test_without_a_radius_the_time_of_its_path_is_not_known() -> None:
    assert sections(PROGRAM)[0].time is None


def test_without_compensation_no_radius_is_needed() -> None:
    program = PROGRAM.replace("G42 ", "").replace("G40 X80.", "X80.")
    [found] = sections(program)
    assert values(found) == pytest.approx({**closed_form(80, 20, 200, 0), "ramp_used": None})


@pytest.mark.ci
def test_no_offset_at_all() -> None:
    [found] = sections(PROGRAM.replace("T0101", "T0100").replace("G42 ", ""))
    assert (found.offset, found.radius, found.radius_source) == (None, None, "none")


# ---- which sections ----


def test_several_sections() -> None:
    first, second = sections(f"{HEAD}{square(80, 20, 200)}G0 Z20.\n{square(60, 20, 100)}M30\n", "1:radius=4")
    assert values(first) == pytest.approx(closed_form(80, 20, 200, 4), abs=2e-6)
    assert values(second) == pytest.approx(closed_form(60, 20, 100, 4), abs=2e-6)
    assert [(one.line, one.end_line, one.c_feed_line) for one in (first, second)] == [(5, 15, 8), (18, 28, 21)]


@pytest.mark.ci
@looped("end", ["M30\n", "G0 Z50.\nM30\n", "G28 U0\nM30\n", "T0202\nM30\n"])
def test_a_section_that_is_never_left_ends_before_what_can_only_stand_outside(end: str) -> None:
    [found] = sections(f"{HEAD}{square(80, 20, 200, off='')}{end}", "1:radius=4")
    assert (found.line, found.end_line) == (5, 14)
    assert values(found) == pytest.approx(closed_form(80, 20, 200, 4), abs=2e-6)


def test_a_section_in_a_called_program_counts_each_time() -> None:
    report = report_of(f"{HEAD}M98 P30002\nM30\nO2\n{square(80, 20, 200)}M99\n", "fanuc", "1:radius=4")
    assert report.sections == len(report.polar_sections) == 3
    assert {(found.line, found.end_line) for found in report.polar_sections} == {(8, 18)}
    assert values(report.polar_sections[2]) == pytest.approx(closed_form(80, 20, 200, 4), abs=2e-6)


def test_a_mode_around_a_called_contour() -> None:
    before, contour = square(80, 20, 200).split("G42")
    contour, after = contour.split("G40")
    program = f"{HEAD}{before}M98 P2\nG40{after}M30\nO2\nG42{contour}M99\n"
    [found] = sections(program, "1:radius=4")
    assert values(found) == pytest.approx(closed_form(80, 20, 200, 4), abs=2e-6)
    assert (found.line, found.end_line, found.c_feed_line) == (5, 10, 14)


def test_block_skip_that_changes_the_feed_tells_the_worst_of_both() -> None:
    program = PROGRAM.replace("Z-5. F200.0000\n", "Z-5. F200.0000\n/F100\n")
    found = sections(program, "1:radius=4")
    # Z goes down at 200 before the block that is skipped, and up again at 100.
    slowest = closed_form(80, 20, 100, 4, deep=3.5)["time"] + 60 * 7 / 200
    assert [one.time for one in found] == pytest.approx([slowest])
    assert [one.c_feed for one in found] == pytest.approx([closed_form(80, 20, 200, 4)["c_feed"]])


def test_block_skip_that_moves_nothing_makes_one() -> None:
    assert len(sections(PROGRAM.replace("G12.1", "/M8\nG12.1"), "1:radius=4")) == 1


def test_block_skip_leaves_each_call() -> None:
    program = f"{HEAD}/G4 X1.\nM98 P20002\nM30\nO2\n{square(80, 20, 200)}M99\n"
    report = report_of(program, "fanuc", "1:radius=4")
    assert report.sections == len(report.polar_sections)


def test_a_section_without_moves() -> None:
    [found] = sections(f"{HEAD}G0 X40. Z2. C0\nG12.1\nG13.1\nM30\n")
    assert (found.nearest, found.c_feed, found.ramp_used, found.time) == (None, None, None, 0)


def test_a_program_without_a_section() -> None:
    report = report_of("O1\nG0 X40. Z2.\nM30\n")
    assert (report.polar_sections, report.verdict, report.looked_at) == ([], "pass", ["text", "flow", "position"])


# ---- a radius that contradicts the comment ----


@pytest.mark.ci
@looped(
    ("radius", "contradicts"),
    [
        (4, False),
        (4.249, False),
        (4.251, True),
        (3.751, False),
        (3.749, True),
        (0, False),
        (0.249, False),
        (0.251, True),
        (-0.249, False),
        (-0.251, True),
        (8, True),
        # The adjustment of a builder's guide is of either sign.
        (-0.005, False),
    ],
    one_in=3,
)
def test_a_radius_beyond_wear_contradicts_the_comment(radius: float, contradicts: bool) -> None:
    rules = [found.rule for found in report_of(COMMENTED, "fanuc", f"1:radius={radius}").findings]
    assert ("radius-contradicts-comment" in rules) == contradicts


@pytest.mark.ci
@looped(
    ("radius", "contradicts"),
    [(0.375, False), (0.3848, False), (0.3849, True), (0.3652, False), (0.3651, True), (0.6, True), (0.0098, False)],
    one_in=2,
)
def test_the_bounds_are_the_same_in_inch(radius: float, contradicts: bool) -> None:
    program = f"{INCH}{square(4, 1, 10, 'Z-.2')}M30\n".replace("T0101", "T0101 (3/4 DIA. CUTTER)")
    found = report_of(program, "fanuc", f"1:radius={radius}").findings
    assert ("radius-contradicts-comment" in [one.rule for one in found]) == contradicts
    assert all(one.severity == "warning" for one in found if one.rule == "radius-contradicts-comment")


def test_a_radius_of_a_job_is_held_against_the_comment_too() -> None:
    report = report_of(COMMENTED, job={"tools": {"1": {"radius": 5}}})
    assert [(found.line, found.rule) for found in report.findings] == [(3, "radius-contradicts-comment")]
    assert report.verdict == "fail"


def test_a_radius_from_the_comment_does_not_contradict_it() -> None:
    report = report_of(COMMENTED, job={"radius_from_comments": True})
    assert [found.rule for found in report.findings] == ["radius-from-comment"]


# ---- what matters ----


def matters(report: FileReport) -> set[tuple[str, bool]]:
    return {(missing.rule, missing.matters) for missing in report.not_evaluated}


def test_a_nose_type_that_is_not_given_is_listed_and_a_pass_is_a_pass() -> None:
    report = report_of(PROGRAM, "fanuc", "1:radius=4")
    assert matters(report) == {("nose-type-not-zero", False)}
    assert report.verdict == "pass"
    given = report_of(PROGRAM, "fanuc", "1:radius=4,nose=0")
    assert (given.not_evaluated, given.findings, given.verdict) == ([], [], "pass")


def test_a_radius_that_is_not_given_matters() -> None:
    report = report_of(PROGRAM)
    assert ("overcut", True) in matters(report)
    assert ("start-up-shorter-than-radius", True) in matters(report)
    assert report.verdict == "unverified"
    assert all("--tool 1:" in missing.reason for missing in report.not_evaluated)


@looped(
    ("program", "tools", "job", "rule"),
    [
        (PROGRAM.replace("G12.1", "G7.1 C20.\nG7.1 C0\nG12.1"), ["1:radius=4,nose=0"], {}, "all"),
        (
            PROGRAM.replace("T0101", "T0101 (D=60. MILL)"),
            [],
            {"radius_from_comments": True},
            "start-up-shorter-than-radius",
        ),
        (re.sub(r"F[\d.]+", "F.1", PROGRAM.replace("G98", "G99")), ["1:radius=4,nose=0"], {}, "c-feed-above-limit"),
        ("(generated by PrusaSlicer)\nG28\nG1 X10 E5\nM104 S200\nG1 Y5 E6\nM109 S200\n", [], {}, "all"),
    ],
)
def test_what_could_hide_a_fault_matters(program: str, tools: list[str], job: dict[str, Any], rule: str) -> None:
    report = report_of(program, "fanuc", *tools, job=job)
    assert (rule, True) in matters(report)
    assert report.verdict == "unverified"


@pytest.mark.nightly
def test_findings_that_are_not_listed_do_not_matter() -> None:
    rapids = "G0 X50.\n" * 1200
    program = f"O1\nG21 G98\nT0101\nG0 X60. C0\nG12.1\n{rapids}G13.1\nM30\n"
    report = report_of(program)
    assert ("rapid-in-polar", False) in matters(report)
    assert report.verdict == "fail"


RATE = math.degrees(200 / 24)


@pytest.mark.ci
@looped(
    ("harmless", "verdict"),
    [
        (RATE * (1 + 1e-9), "pass"),
        (RATE * (1 - 1e-9), "unverified"),
        (3600, "pass"),
        (1, "unverified"),
    ],
)
def test_a_missing_limit_matters_above_what_every_axis_manages(harmless: float, verdict: str) -> None:
    report = report_of(PROGRAM, "fanuc", "1:radius=4,nose=0", changes={"limits": {"c_feed_harmless": harmless}})
    assert report.verdict == verdict
    assert matters(report) == ({("c-feed-above-limit", True)} if verdict == "unverified" else set())
    assert report.polar_sections[0].c_feed == pytest.approx(RATE)


@pytest.mark.ci
@looped(
    ("rate", "verdict"), [(3599, "pass"), (3599.99, "pass"), (3600.01, "unverified"), (3601, "unverified")], one_in=2
)
def test_that_is_ten_turns_a_minute_unless_the_machine_says_better(rate: float, verdict: str) -> None:
    program = f"{HEAD}{square(80, 20, math.radians(rate) * 24)}M30\n"
    report = report_of(program, "fanuc", "1:radius=4,nose=0")
    assert report.verdict == verdict
    if verdict == "unverified":
        [missing] = report.not_evaluated
        assert "--set limits.c_feed=" in missing.reason
        assert f"{rate:.0f} deg/min, line 8" in missing.reason
    limited = report_of(program, "fanuc", "1:radius=4,nose=0", changes={"limits": {"c_feed": 3605}})
    assert (limited.verdict, limited.not_evaluated) == ("pass", [])


# ---- the command ----


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    make(a__nc=PROGRAM, b__nc=PROGRAM.replace("T0101", "T0202"))
    return tmp_path


def test_an_offset_table_gives_the_radius(folder: Path) -> None:
    (folder / "offsets.txt").write_text("%\nG10 P10001 X0 Z0 R3.9 Q0\nG10 P1 R.1\n%\n")
    result = call("check", "a.nc", "--offsets", "offsets.txt", "--format", "json")
    [found] = json.loads(result.stdout)["files"][0]["polar_sections"]
    assert (found["radius"], found["radius_source"]) == (4, "offset table")
    assert found["nearest"] == pytest.approx(24)


def test_a_tool_that_no_file_calls_is_said_once(folder: Path) -> None:
    result = call("check", "a.nc", "b.nc", "--tool", "1:radius=4", "--tool", "2:radius=4", "--tool", "99:radius=4")
    assert result.stderr.count("calls offset 99") == 1
    assert "calls offset 1\n" not in result.stderr
    assert "calls offset 2\n" not in result.stderr


@pytest.mark.ci
def test_a_tool_that_another_file_of_the_run_calls_is_none(folder: Path) -> None:
    assert "offset 2" in call("check", "a.nc", "--tool", "2:radius=4").stderr
    assert "offset 2" not in call("check", "a.nc", "b.nc", "--tool", "2:radius=4").stderr


@pytest.mark.ci
def test_a_tool_of_a_job_may_be_for_other_programs(folder: Path) -> None:
    make(polarcheck__toml="[tools.1]\nradius = 4\nnose = 0\n[tools.99]\nradius = 4\n")
    result = call("check", "a.nc")
    assert "99" not in result.stderr
    assert result.exit_code == 0


def test_the_text_says_what_the_pass_rests_on(folder: Path) -> None:
    shown = call("check", "a.nc", "--tool", "1:radius=4", "--strict")
    assert shown.exit_code == 0
    for part in ("mm", "offset 1", "command line", "24", "477", "line 8", "20"):
        assert part in shown.stdout
    assert "no limit given" in shown.stdout
    assert "outside" in shown.stdout
