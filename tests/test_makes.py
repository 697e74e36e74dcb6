"""The line on what the only section of a file makes, in the text report of a check."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest
from cases import looped
from indexed_programs import Section, flat, polygon, program, tool
from test_cli import call

pytestmark = pytest.mark.usefixtures("own_folder")

#: A second pass at the same depth: the check looks for what one pass cuts of the other, by polygons.
TWICE = (-5.0, -5.0)
HEXAGON = "hexagon, 30.000 across flats"


def line_of(text: str, machine: str = "fanuc", *arguments: str, radius: str = tool(4)) -> str:
    """What the line says; empty without it."""
    Path("a.nc").write_text(text)
    said = call("check", "a.nc", "--no-config", "--machine", machine, "--tool", radius, "--format", "text", *arguments)
    assert said.exit_code in (0, 1), said.output
    lines = [line.strip() for line in said.stdout.splitlines()]
    (told,) = [line for line in lines if line.startswith("makes: ")] or [""]
    return told.removeprefix("makes: ")


def test_a_section_with_a_second_pass_says_what_it_makes() -> None:
    assert line_of(program([Section(polygon(6, 30.0), depths=TWICE)])) == f"{HEXAGON}, to Z-5.000"


def test_in_inch_it_is_in_inch() -> None:
    text = program([Section(polygon(6, 25.4), depths=(-5.08, -5.08))], inch=True)
    assert line_of(text, radius=tool(4, inch=True)) == "hexagon, 1.0000 across flats, to Z-0.2000"


def test_a_turned_one_says_its_angle() -> None:
    assert (
        line_of(program([Section(polygon(6, 30.0, 20.0), depths=TWICE)])) == f"{HEXAGON}, turned by 20 deg, to Z-5.000"
    )


@pytest.mark.ci
@looped("control", ["haas-lathe", "okuma-osp", "siemens-iso"])
def test_other_controls_say_the_same(control: str) -> None:
    assert line_of(program([Section(polygon(6, 30.0), depths=TWICE)], control), control) == f"{HEXAGON}, to Z-5.000"


def test_several_depths_are_one_line() -> None:
    assert line_of(program([Section(polygon(6, 30.0), depths=(-2.0, -2.0, -4.0))])) == f"{HEXAGON}, to Z-4.000"


def test_without_r_the_line_says_so() -> None:
    text = program([Section(polygon(6, 30.0))]).replace("T0808\n", "T0808 (HEX 30 A/F)\n")
    Path("a.nc").write_text(text)
    said = " ".join(call("check", "a.nc").stdout.split())
    assert f"makes: {HEXAGON}, to Z-5.000 (R of T0808 is not known)" in said


def test_a_comment_that_contradicts_the_part_stands_beside_what_is_made() -> None:
    text = program([Section(polygon(6, 30.0))]).replace("T0808\n", "T0808 (HEX 31 A/F)\n")
    assert line_of(text) == f"{HEXAGON}, to Z-5.000"


@pytest.mark.nightly
def test_the_part_that_is_asked_for_needs_areas_too() -> None:
    Path("polarcheck.toml").write_text('[[part]]\nshape = "hexagon"\nacross_flats = 32.0\n')
    Path("a.nc").write_text(program([Section(polygon(6, 30.0))]))
    said = call("check", "a.nc", "--tool", tool(4))
    assert said.exit_code == 1
    assert f"makes: {HEXAGON}, to Z-5.000" in said.stdout, "what differs is made all the same"


# ---- where it is left out ----


def test_a_file_without_need_of_areas_has_no_line() -> None:
    assert line_of(program([Section(polygon(6, 30.0))])) == ""


def test_several_sections_have_no_line() -> None:
    sections = [Section(flat(12.0, 14.0), angle, depths=TWICE) for angle in (0.0, 180.0)]
    assert line_of(program(sections)) == ""


@pytest.mark.nightly
@looped(
    ("block", "written", "is_told"),
    [
        ("X30. C8.6603", "X30. C8.6603 F", False),  # a word without a number
        ("G1 X-30. C8.6603", "G0 X-30. C8.6603", False),  # the control stops, or the tool goes another way
        ("G1 G40 X80. C0", "G1 G40 X30.5", False),  # the ramp is too short
        ("G98 G40 G97", "G40 G97", True),  # the feed mode is not known: the path is the same
    ],
    one_in=2,
)
def test_a_finding_that_makes_the_part_doubtful_leaves_it_out(block: str, written: str, is_told: bool) -> None:
    text = program([Section(polygon(6, 30.0), depths=TWICE)])
    assert block in text
    assert bool(line_of(text.replace(block, written))) == is_told


@pytest.mark.ci
def test_a_contour_that_is_not_known_as_a_whole_has_no_line() -> None:
    text = program([Section(polygon(6, 30.0), depths=TWICE)])
    assert line_of(text.replace("X30. C8.6603", "X#5041 C8.6603")) == ""


@pytest.mark.ci
def test_json_has_the_part_where_it_is_asked_for_and_no_line() -> None:
    Path("a.nc").write_text(program([Section(polygon(6, 30.0), depths=TWICE)]))
    said = call("check", "a.nc", "--tool", tool(4), "-o", "json:a.json", "-o", "jsonl:a.jsonl")
    assert "makes: " in said.stdout
    (file,) = json.loads(Path("a.json").read_text())["files"]
    assert {"makes", "part"}.isdisjoint(file)
    assert '"makes"' not in Path("a.jsonl").read_text()
    (file,) = json.loads(call("check", "a.nc", "--tool", tool(4), "--part", "--format", "json").stdout)["files"]
    assert [one["text"] for one in file["part"]] == [f"{HEXAGON}; to Z-5.000"]


def test_part_says_more_than_the_line() -> None:
    assert line_of(program([Section(polygon(6, 30.0), depths=TWICE)]), "fanuc", "--part") == ""


@pytest.mark.nightly
def test_it_depends_on_the_file_alone() -> None:
    """Neither on the files before it nor on the number of processes."""
    Path("a.nc").write_text(program([Section(polygon(6, 30.0))]))
    Path("b.nc").write_text(program([Section(polygon(6, 30.0), depths=TWICE)]))
    more = ("--tool", tool(4), "--format", "text", "--no-config")
    for jobs in ("1", "2"):
        for paths in (("a.nc", "b.nc"), ("b.nc", "a.nc")):
            lines = call("check", *paths, *more, "--jobs", jobs).stdout.splitlines()
            told = {lines[at - 1].split()[1] for at, line in enumerate(lines) if line.strip().startswith("makes: ")}
            assert told == {"b.nc:"}


@pytest.mark.ci
def test_a_clean_file_with_two_passes_needs_no_more_than_that() -> None:
    """Where the line is left out, what would make it is not loaded."""
    Path("a.nc").write_text(program([Section(polygon(6, 30.0))]))
    code = (
        "import sys, polarcheck.commands\n"
        f"sys.argv = ['polarcheck', 'check', 'a.nc', '--tool', {tool(4)!r}]\n"
        "try:\n    polarcheck.commands.run()\nexcept SystemExit as end:\n    assert not end.code, end.code\n"
        "assert not {'shapely', 'polarcheck.reports.made_parts.part_report'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
