"""What applies to a program: job files, their entries, what they extend and exclude; `config show` and `init`."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from typing import Any

import click
import jsonschema
import msgspec
import pytest
from cases import looped
from click.testing import CliRunner, Result
from hypothesis import assume, given
from hypothesis import strategies as st
from programs import ROOT

from polarcheck.commands import main
from polarcheck.commands.check import check as check_command
from polarcheck.commands.config import show as show_command
from polarcheck.commands.trace import trace as trace_command
from polarcheck.program.machines import toml_lines
from polarcheck.program.machines.job import Job, Programs, Running, Stock, Tool, WorkOffset
from polarcheck.program.reading.globs import Globs, is_pattern
from polarcheck.reports.pages import json_schema

pytestmark = pytest.mark.usefixtures("own_folder")

RAMP = "G98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\nM30\n"
MILL = "O1\nG21\nT0808\n" + RAMP


def make(*paths: str, text: str = MILL) -> None:
    for path in paths:
        Path(path).parent.mkdir(parents=True, exist_ok=True)
        Path(path).write_text(text, "utf-8", newline="")


def job(text: str, path: str = "polarcheck.toml") -> None:
    make(path, text=text)


def call(*arguments: str, given: str | None = None, **environment: str) -> Result:
    return CliRunner().invoke(main, list(arguments), input=given, env=environment)


def checked(*arguments: str, **environment: str) -> dict[str, dict[str, Any]]:
    """The reports by path."""
    result = call("check", *arguments, "--format", "json", **environment)
    assert not result.stderr, result.stderr
    return {file["path"]: file for file in json.loads(result.stdout)["files"]}


def radii(*arguments: str) -> dict[str, float | None]:
    """The radius of the first polar section, by path."""
    return {path: file["polar_sections"][0]["radius"] for path, file in checked(*arguments).items()}


def shown(path: str, *arguments: str, **environment: str) -> dict[str, tuple[Any, str, str]]:
    """The values of `config show` with kind and origin, by key."""
    result = call("config", "show", path, "--format", "json", *arguments, **environment)
    assert result.exit_code == 0, result.stderr
    return {one["key"]: (one["value"], one["kind"], one["origin"]) for one in json.loads(result.stdout)["values"]}


def refused(*arguments: str) -> str:
    result = call(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1
    return result.stderr.removeprefix("polarcheck: ").rstrip("\n")


# ---- entries for some of the programs ----


@pytest.mark.ci
def test_entries_are_merged_in_their_order_over_what_the_file_says_of_all() -> None:
    make("O1234.nc", "O1299.NC", "O2000.nc", "lathe7/O1234.nc")
    job(
        "[tools.8]\nradius = 4\nnose = 0\n"
        "[[programs]]\nfiles = ['o12*.nc']\n[programs.tools.8]\nradius = 5\n"
        "[[programs]]\nfiles = ['LATHE7\\**']\n[programs.tools.8]\nradius = 6\n"
    )
    assert radii(".") == {"O1234.nc": 5, "O1299.NC": 5, "O2000.nc": 4, "lathe7/O1234.nc": 6}
    assert shown("lathe7/O1234.nc")["tools.8.nose"] == (0, "file", "polarcheck.toml:3")


def test_an_entry_says_all_that_decides_about_a_program() -> None:
    make("a.nc", "b.nc", text=MILL.replace("G13.1\n", "G0 X70.\n"))
    job(
        "machine = 'fanuc'\nselect = ['polar']\n[[programs]]\nfiles = ['b.nc']\nmachine = 'fanuc-30i'\n"
        "severities = { rapid-in-polar = 'note' }\nfail_on = 'never'\nstrict = true\nselect = ['rapid-in-polar']\n"
        "[programs.limits]\nc_feed = 900\n[programs.stock]\ndiameter = 60\n[programs.run.variables]\n100 = 5\n"
    )
    found = checked("a.nc", "b.nc")
    assert {path: (file["machine"], file["verdict"]) for path, file in found.items()} == {
        "a.nc": ("fanuc", "fail"),
        "b.nc": ("fanuc-30i", "unverified"),
    }
    assert {one["rule"] for one in found["b.nc"]["findings"]} <= {"rapid-in-polar"}
    values = shown("b.nc")
    assert values["limits.c_feed"] == (900, "programs", "polarcheck.toml:11, [[programs]] 1")
    assert values["run.variables.100"][0] == 5
    assert values["stock.diameter"][0] == 60


def test_which_severity_fails_is_asked_of_each_file() -> None:
    make("a.nc", "b.nc", text=MILL.replace("C-10.", "G0 C-10."))
    job("select = ['rapid-in-polar']\n[[programs]]\nfiles = ['b.nc']\nfail_on = 'never'\n")
    assert [call("check", name).exit_code for name in ("a.nc", "b.nc")] == [1, 0]
    assert call("check", "b.nc", "--fail-on", "error").exit_code == 1


@pytest.mark.ci
def test_strict_is_asked_of_each_file_and_can_be_taken_back() -> None:
    make("a.nc", "b.nc")
    job("[[programs]]\nfiles = ['b.nc']\nstrict = true\n")
    assert [call("check", name).exit_code for name in ("a.nc", "b.nc", "a.nc")] == [0, 1, 0]
    assert call("check", "b.nc", "--no-strict").exit_code == 0
    assert call("check", "b.nc", POLARCHECK_STRICT="0").exit_code == 0


def test_the_encoding_of_some_programs() -> None:
    make("a.nc", "b.nc")
    Path("b.nc").write_bytes(MILL.replace("O1\n", "O1 (\u5de5\u5177 G0)\n").encode("shift_jis"))
    job("[[programs]]\nfiles = ['b.nc']\nencoding = 'shift_jis'\n")
    assert "(\u5de5\u5177 G0)" in checked("b.nc")["b.nc"]["findings"][0]["block"]
    assert shown("a.nc")["encoding"] == (None, "default", "built-in default")
    job("[[programs]]\nfiles = ['b.nc']\nencoding = 'shift_jus'\n")
    assert refused("check", "a.nc") == (
        "polarcheck.toml:3: encoding: unknown encoding 'shift_jus'; for example utf-8, cp1252, shift_jis"
    )


@looped("name", ["rot13", "base64", "undefined", "utf-8\0"])
def test_a_codec_of_no_text_is_no_encoding(name: str) -> None:
    make("a.nc")
    assert f"unknown encoding {name!r}; for example utf-8" in refused("check", "a.nc", "--encoding", name)
    job(f"encoding = {json.dumps(name)}\n")
    assert ":1: encoding: unknown encoding " in refused("check", "a.nc")


def test_units_of_an_entry_are_those_of_its_own_lengths() -> None:
    make("a.nc", "b.nc")
    job(
        "units = 'mm'\n[tools.8]\nradius = 4\n[stock]\ndiameter = 50.8\n"
        "[[programs]]\nfiles = ['b.nc']\nunits = 'inch'\n[programs.tools.9]\nradius = 0.5\n"
    )
    assert radii("a.nc", "b.nc") == {"a.nc": 4, "b.nc": 4}
    assert shown("b.nc")["stock.diameter"][0] == 2.0
    job("[tools.8]\nradius = 4\n[[programs]]\nfiles = ['b.nc']\nunits = 'inch'\n")
    assert refused("check", "b.nc") == (
        "polarcheck.toml:5: units: tools.8.radius of polarcheck.toml:2 has those of each program; give units there, too"
    )


def test_offset_tables_of_two_lathes_are_not_mixed() -> None:
    make("a.nc", "b.nc")
    make("one.txt", text="G10 P10008 R4.\nG10 P10009 R9.\n")
    make("two.txt", text="G10 P10008 R5.\n")
    job("offsets = 'one.txt'\n[tools.8]\nnose = 0\n[[programs]]\nfiles = ['b.nc']\noffsets = 'two.txt'\n")
    assert "tools.9.radius" in shown("a.nc")
    values = shown("b.nc")
    assert "tools.9.radius" not in values
    assert values["tools.8.radius"] == (5, "programs", "two.txt, named in polarcheck.toml:6, [[programs]] 1")


@pytest.mark.nightly
def test_a_pattern_that_matches_nothing_in_a_folder_that_was_walked_is_a_warning() -> None:
    make("sub/O1234.nc", "sub/deep/O1.nc")
    job("[[programs]]\nfiles = ['O12*.nc', 'O13*.nc']\n", "sub/polarcheck.toml")
    told = ("polarcheck: warning: sub/polarcheck.toml:2: files: no program of this folder matches 'O13*.nc'\n").replace(
        "/", os.sep
    )
    assert [call("check", path, "-q").stderr for path in (".", "sub")] == [told, told]
    assert [call("check", path, "-q").stderr for path in ("sub/deep", "sub/deep/O1.nc")] == ["", ""]


def test_what_applies_to_thousands_is_made_once_for_each_set_of_entries() -> None:
    from polarcheck.files.batch import tasks as batch
    from polarcheck.files.settings.of_programs import OfPrograms, Options

    make(*(f"O{number:04d}.nc" for number in range(60)), text="O1\nM30\n")
    job("[[programs]]\nfiles = ['O000*']\nstrict = true\n[[programs]]\nfiles = ['O0005.nc', 'O0055.nc']\nstrict = true")
    told: list[str] = []
    tasks = batch.plan(["."], OfPrograms(Options()), (), told.append, told.append)
    assert (len(tasks), told) == (60, [])
    assert len({id(task.settings) for task in tasks}) == 4
    assert len({id(task.settings.machine) for task in tasks}) == 1


@looped(
    ("pattern", "path", "matches"),
    [
        ("O12*.nc", "O1234.NC", True),
        ("O12*.nc", "deep/er/o1299.nc", True),
        ("O12*.nc", "O1234.nc.bak", False),
        ("lathe7/**", "Lathe7/x/y.nc", True),
        ("lathe7\\**", "lathe7/y.nc", True),
        ("lathe7/**", "x/lathe7/y.nc", False),
        ("**/lathe7/*.nc", "x/lathe7/y.nc", True),
        ("**/lathe7/*.nc", "lathe7/y.nc", True),
        ("lathe7", "x/lathe7/y/z.nc", True),
        ("lathe7/", "lathe7", False),
        ("./a.nc", "a.nc", True),
        ("./a.nc", "x/a.nc", False),
        ("x/*.nc", "x/y/a.nc", False),
        ("x/**/a.nc", "x/a.nc", True),
        ("../*/a.nc", "a.nc", True),
        ("jobs", "a.nc", False),
        ("O[0-4]?.nc", "O31.nc", True),
        ("O[!0-4]?.nc", "O31.nc", False),
        ("O0001(SB12 *)", "O0001(SB12 RG FRONT)", True),
        ("a[b.nc", "a[b.nc", True),
        ("Gru\u0308n.nc", "GR\u00dcN.nc", True),
        ("*a*b*c", "xaybzc", True),
        ("*a*b*c", "xaybzcd", False),
    ],
)
def test_patterns_mean_files_as_shops_name_them(pattern: str, path: str, matches: bool) -> None:
    base = Path(os.path.realpath("jobs" if pattern == "jobs" else "jo[bs]"))
    program = base / path
    found = Globs(str(base), [pattern])
    assert bool(found.of_file(str(program.parent), program.name)) is matches


@pytest.mark.ci
@given(st.text("ab*?[]!-/.\\ ", min_size=1, max_size=12), st.text("ab/.", min_size=1, max_size=12))
def test_any_pattern_is_compared_with_any_path(pattern: str, path: str) -> None:
    folder, name = os.path.split("/base/" + path)
    assume(is_pattern(pattern))
    assert Globs("/base", [pattern]).of_file(folder, name) <= {0}


def test_a_pattern_that_could_take_for_ever_does_not() -> None:
    found = Globs("/base", ["*a" * 60 + "b", "**/a" * 100 + "/b"])
    assert not found.of_file("/base" + "/a" * 200, "a" * 250)


@looped("pattern", ["", "!O1.nc", " ", "/", "[z-a].nc", "old/[9-0]/*"])
def test_a_pattern_that_means_nothing_is_told(pattern: str) -> None:
    make("a.nc")
    job(f"[[programs]]\nstrict = true\nfiles = [{pattern!r}]\n")
    told = f"expected a pattern such as O12*.nc or lathe7/**, found {pattern!r}"
    assert refused("check", "a.nc") == f"polarcheck.toml:3: files: {told}"
    job(f"exclude = [{pattern!r}]\n")
    assert refused("check", "a.nc") == f"polarcheck.toml:1: exclude: {told}"


# ---- what walks pass over ----


@pytest.mark.nightly
def test_what_is_excluded_is_found_by_no_walk_and_checked_where_it_is_named() -> None:
    make("a.nc", "old/b.nc", "x/old/c.nc", "d.bak.nc", "y/e.nc", "y/z/f.nc")
    job("exclude = ['old', '*.bak.nc', 'y/z']\n")
    assert list(checked(".")) == ["a.nc", "y/e.nc"]
    assert list(checked("old/b.nc", "d.bak.nc", "y/z")) == ["old/b.nc", "d.bak.nc", "y/z/f.nc"]
    assert list(checked("a.nc", "old/b.nc", "d.bak.nc", "y/z/f.nc", "y/z", "--force-exclude")) == ["a.nc"]
    result = call("check", "x")
    assert result.stderr == "polarcheck: nothing to check: x: all NC programs in this folder are excluded\n"
    assert (result.exit_code, result.stdout) == (2, "")


@looped(
    ("text", "key"),
    [
        ("[[programs]]\nstrict = true\nfiles = []\n", "programs.1.files"),
        ("[[part]]\nshape = 'circle'\nfiles = []\ndiameter = 20\n", "part.1.files"),
    ],
)
def test_an_entry_for_no_file_at_all_is_told(text: str, key: str) -> None:
    make("a.nc")
    job(text)
    assert refused("check", "a.nc") == f"polarcheck.toml:3: {key}: expected a list of texts, at least one, found []"


@looped("path", ["old/b.nc", "old", "old/"])
def test_where_all_is_excluded_nothing_is_checked_and_that_is_said(path: str) -> None:
    make("old/b.nc")
    job("exclude = ['old']\n")
    result = call("check", path, "--force-exclude")
    assert result.exit_code == 0
    assert result.stderr == "polarcheck: warning: all that is named is excluded: nothing is checked\n"


@pytest.mark.nightly
@looped(
    ("text", "options", "read", "count"),
    [
        ("", ["--exclude", "old"], ["a.nc", "sub/b.nc", "sub/c.nc"], 2),
        ("", ["--exclude", "OLD", "--exclude", "sub/B*"], ["a.nc", "sub/c.nc"], 3),
        ("exclude = ['old']\n", ["--exclude", "sub"], ["a.nc"], 4),
        ("exclude = ['old']\n", ["--exclude", "a.nc"], ["sub/b.nc", "sub/c.nc"], 3),
    ],
    one_in=3,
)
def test_patterns_of_the_command_line_are_added_to_those_of_the_file(
    text: str, options: list[str], read: list[str], count: int
) -> None:
    make("a.nc", "old/x.nc", "old/y/z.nc", "sub/b.nc", "sub/c.nc", text="O1\nM30\n")
    job(text)
    result = call("check", ".", "--format", "json", *options)
    document = json.loads(result.stdout)
    assert ([file["path"] for file in document["files"]], document["summary"]["excluded"]) == (read, count)
    assert result.stderr == ""
    assert call("check", ".", *options).stdout.endswith(f"; no findings; excluded: {count}\n")
    # They begin at the working folder, and a file that is named is read all the same.
    assert list(checked("old/x.nc", *options)) == ["old/x.nc"]
    assert call("check", "old/x.nc", "--force-exclude", "--exclude", "old").stdout == ""
    assert shown("sub/c.nc", *options)["exclude"][0] == [*(["old"] if text else []), *options[1::2]]


def test_an_option_that_is_no_pattern_is_told() -> None:
    make("a.nc")
    told = "--exclude: expected a pattern such as O12*.nc or lathe7/**, found '!a'"
    assert refused("check", ".", "--exclude", "!a") == told


@pytest.mark.ci
@looped(
    ("text", "options", "told"),
    [
        ("exclude = ['sub', 'gone', '*.bak']\n", [], "polarcheck.toml:1: exclude: {} excludes nothing|'gone'|'*.bak'"),
        (
            "extensions = ['nc', '.tpa']\n",
            [],
            "polarcheck.toml:1: extensions: no file of this folder ends in {}|'.tpa'",
        ),
        ("exclude = ['gone']\n", ["--exclude", "old/**"], "--exclude {} excludes nothing|'old/**'"),
        ("extensions = ['tap']\n", ["--extensions", "nc,sub"], "--extensions: no file ends in {}|'sub'"),
    ],
    one_in=2,
)
def test_a_pattern_of_a_walk_without_effect_is_told_once(text: str, options: list[str], told: str) -> None:
    make("a.nc", "sub/b.nc", "sub/c.nc", text="O1\nM30\n")
    job(text)
    form, *names = told.split("|")
    lines = [f"polarcheck: warning: {form.format(name)}\n" for name in names]
    assert call("check", ".", *options).stderr == "".join(lines)
    # Not where only some of the programs are looked at.
    if not options:
        assert call("check", "sub", "a.nc").stderr == ""


def test_endings_of_a_folder_are_those_of_its_own_job_file() -> None:
    make("a.nc", "l7/b.nc", "l7/P.SUB", "l8/c.nc", "l8/P.SUB", text="O1\nM30\n")
    job("extensions = ['nc', 'sub']\n", "l7/polarcheck.toml")
    assert list(checked(".")) == ["a.nc", "l7/P.SUB", "l7/b.nc", "l8/c.nc"]


@pytest.mark.parametrize(
    ("names", "said"),
    [
        (["old/a.nc", "old/b.nc"], "all NC programs in this folder are excluded"),
        (["P.SUB", "Q.SUB", "old/a.nc"], "no NC programs in this folder, but 2 .sub; --extensions names other endings"),
        (["old/a.B", "a.B"], "no NC programs in this folder, but 1 .b; --extensions names other endings"),
    ],
)
def test_where_nothing_is_left_to_check_that_is_no_success(names: list[str], said: str) -> None:
    make(*names, text="O1234\nG0 X1.\nM30\n")
    job("exclude = ['old']\n")
    assert refused("check", ".") == f"nothing to check: .: {said}"
    # A hook names what git names: that all of it is excluded is as it should be.
    result = call("check", ".", "--force-exclude")
    assert (result.exit_code, result.stderr) == (0, f"polarcheck: warning: .: {said}\n")
    make("now.nc", text="O1\nM30\n")
    assert call("check", ".").exit_code == 0


def show_files(*arguments: str) -> dict[str, str]:
    """What --show-files says of each path: nothing of what is read, else the reason."""
    result = call("check", *arguments, "--show-files", "--format", "json")
    assert (result.exit_code, result.stderr) == (0, "")
    return {entry["path"]: "" if entry["read"] else entry["reason"] for entry in json.loads(result.stdout)["files"]}


def archive() -> None:
    """A folder with a program, and some of each kind that a walk does not read."""
    make(
        "a.nc",
        "P.SUB",
        "Q.SUB",
        "x.lib",
        "1.001",
        "O1234-REV.B",
        "old/b.nc",
        "old/deep/c.nc",
        "d.bak",
        ".cam/x.nc",
        ".git/y.nc",
    )
    make("tools.txt", text="G10 P1 X0 Z0 R4. Q0\nG10 P2 X0 Z0 R5. Q0\n")
    job("offsets = 'tools.txt'\nexclude = ['old', '*.bak']\n")


OF_ARCHIVE = ["not read: 2 .SUB, 1 .001, 1 .B (O1234-REV.B), 1 .lib", "excluded: 3"]


def test_the_files_of_a_folder_are_listed_with_the_reason() -> None:
    archive()
    ending = "the ending {} is none of the extensions"
    assert show_files(".") == {
        "a.nc": "",
        ".cam/": "hidden folders and those of packages are not entered",
        "1.001": ending.format(".001"),
        "O1234-REV.B": ending.format(".B"),
        "P.SUB": ending.format(".SUB"),
        "Q.SUB": ending.format(".SUB"),
        "d.bak": "excluded by polarcheck.toml:2: '*.bak'",
        "old/": "excluded by polarcheck.toml:2: 'old', with 2 programs in it",
        "x.lib": ending.format(".lib"),
        "tools.txt": "an offset table of a job",
    }
    # What is named is read, and each is listed once.
    listed = show_files(".", "P.SUB", "old", "tools.txt", ".")
    assert {path for path, reason in listed.items() if not reason} == {
        *("a.nc", "P.SUB", "old/b.nc", "old/deep/c.nc", "tools.txt")
    }
    assert show_files(".", "--exclude", "a*", "--extensions", "sub")["a.nc"] == "excluded by --exclude 'a*'"
    lines = call("check", ".", "--show-files").stdout.splitlines()
    assert lines[:2] == ["read      a.nc", "not read  .cam/: hidden folders and those of packages are not entered"]
    assert len(call("check", ".", "--show-files", "--format", "jsonl").stdout.splitlines()) == len(lines) == 10


def test_a_subprogram_that_a_program_calls_was_read_there() -> None:
    make("a.nc", text="O1\nM98 <PART>\nM98 P9001\nM30\n")
    make("subs/PART.SUB", "subs/OTHER.SUB", "subs/9001.SUB", text="O9001\nG0 X1.\nM99\n")
    job("machine = 'fanuc-30i'\n[run]\nsubprograms = ['subs']\n")
    for _ in ("checked", "from the cache"):
        document = json.loads(call("check", ".", "--format", "json").stdout)
        counted = {"ending": ".sub", "files": 1, "first": "subs/OTHER.SUB"}
        assert document["summary"]["not_read"] == [counted]
    reason = "the ending .SUB is none of the extensions; programs that call it execute it"
    assert show_files(".")["subs/OTHER.SUB"] == reason


@looped(
    ("option", "told"),
    [
        (["--format", "sarif"], "--show-files: expected --format text, json, jsonl, found sarif"),
        (["--fix"], "--show-files checks nothing: leave --fix out"),
        (["-o", "json:x.json"], "--show-files checks nothing: leave -o out"),
    ],
)
def test_a_list_of_files_is_no_check(option: list[str], told: str) -> None:
    make("a.nc")
    assert refused("check", ".", "--show-files", *option) == told
    assert not Path("x.json").exists()


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    "form", ["text", "short", "github", "json", "jsonl", "html", "concise", "sarif", "gitlab", "junit"]
)
def test_each_format_says_what_was_not_read_or_standard_error_does(form: str) -> None:
    archive()
    result = call("check", ".", "--format", form)
    if form in ("text", "short", "github"):
        assert "; ".join(OF_ARCHIVE) in result.stdout
    elif form in ("json", "jsonl"):
        document = json.loads(result.stdout.splitlines()[-1] if form == "jsonl" else result.stdout)
        summary = document if form == "jsonl" else document["summary"]
        assert summary["excluded"] == 3
        assert summary["not_read"][:2] == [
            {"ending": ".sub", "files": 2, "first": "P.SUB"},
            {"ending": ".001", "files": 1, "first": "1.001"},
        ]
    elif form == "html":
        assert all(f'<p class="none">{line}</p>' in result.stdout for line in OF_ARCHIVE)
    lines = "".join(f"polarcheck: warning: {line}\n" for line in OF_ARCHIVE)
    assert result.stderr.startswith(lines) == (form not in ("text", "short", "github", "json", "jsonl"))
    assert result.stderr.count("not read") <= 1
    assert call("check", ".", "--format", form, "-q").stderr == ""


@pytest.mark.ci
def test_pages_in_a_folder_say_what_was_not_read() -> None:
    archive()
    call("check", ".", "-o", "html:pages", "-q")
    index = Path("pages/index.html").read_text("utf-8")
    assert all(f"<p>{line}</p>" in index for line in OF_ARCHIVE)


@pytest.mark.ci
def test_names_of_files_act_on_no_terminal_and_no_page() -> None:
    name = "O1-\x1b[31m<b>.B<i>"
    make(name, "a.nc")
    assert "\x1b" not in call("check", ".").stdout + call("check", ".", "--show-files").stdout
    assert "<b>" not in call("check", ".", "--format", "html").stdout


def test_endings_beyond_the_first_ones_are_counted_together() -> None:
    make("a.nc", *(f"P.x{number}" for number in range(12)))
    assert ", 1 .x4 (P.x4), 1 .x5 (P.x5), 4 of other endings\n" in call("check", ".", "--format", "short").stdout


@pytest.mark.skipif(sys.platform == "win32", reason="rights are others there")
def test_a_folder_that_is_excluded_is_not_entered() -> None:
    make("a.nc", "old/b.nc")
    job("exclude = ['old']\n")
    told: list[str] = []
    from polarcheck.program.reading import walking

    entered: list[str] = []

    def excluded_in(folder: str) -> Any:
        entered.append(folder)
        return lambda name, is_folder: "old" if is_folder and name == "old" else ""

    assert list(walking.walk(".", walking.EXTENSIONS, told.append, excluded_in)) == ["a.nc"]
    assert entered == ["."]


# ---- a file over another ----


def test_a_file_stands_over_the_one_that_it_extends() -> None:
    make("shop/jobs/O1.nc", "shop/jobs/O2.nc")
    job(
        "machine = 'fanuc-16i'\nexclude = ['O9*']\n[severities]\npolar = 'note'\nrapid-in-polar = 'off'\n"
        "[tools.8]\nradius = 4\nnose = 0\n[[programs]]\nfiles = ['O2*']\n[programs.tools.8]\nradius = 7\n",
        "shop/polarcheck.toml",
    )
    job(
        "extend = '../polarcheck.toml'\n[severities]\npolar = 'warning'\n[tools.8]\nradius = 5\n",
        "shop/jobs/polarcheck.toml",
    )
    values = shown("shop/jobs/O1.nc")
    assert values["tools.8.radius"] == (5, "file", str(Path("shop", "jobs", "polarcheck.toml:5")))
    assert values["tools.8.nose"] == (0, "file", str(Path("shop", "polarcheck.toml:8")))
    assert values["machine"][0] == "fanuc-16i"
    assert values["exclude"][0] == ["O9*"]
    # What is nearer counts, though the table that it stands in names a rule of the group before.
    assert [key for key in values if key.startswith("severities.")] == ["severities.rapid-in-polar", "severities.polar"]
    # An entry of the farther file is farther than what the nearer one says of all.
    assert shown("shop/jobs/O2.nc")["tools.8.radius"][0] == 5


@looped(
    ("files", "told"),
    [
        (
            {"polarcheck.toml": "extend = 'polarcheck.toml'"},
            "polarcheck.toml:1: extend: polarcheck.toml extends itself",
        ),
        (
            {"polarcheck.toml": "\nextend = 'b.toml'", "b.toml": "extend = 'polarcheck.toml'"},
            "b.toml:1: extend: polarcheck.toml extends itself, by way of b.toml",
        ),
        (
            {"polarcheck.toml": "strict = true\nextend = 'gone.toml'"},
            "polarcheck.toml:2: extend: gone.toml: No such file or directory",
        ),
        (
            {"polarcheck.toml": "extend = 'b.toml'", "b.toml": "\n[tools.8]\nraduis = 3"},
            "polarcheck.toml:1: extend: b.toml:3: unknown key tools.8.raduis; did you mean radius?",
        ),
        (
            {"polarcheck.toml": "extend = '0.toml'", **{f"{n}.toml": f"extend = '{n + 1}.toml'" for n in range(12)}},
            "8.toml:1: extend: more than 10 job files, one behind the other",
        ),
    ],
)
def test_what_cannot_be_extended_is_told(files: dict[str, str], told: str) -> None:
    make("a.nc")
    for name, text in files.items():
        job(f"{text}\n", name)
    assert refused("check", "a.nc") == told


@pytest.mark.ci
@pytest.mark.parametrize("written", ["..", "../", "../..", "../polarcheck.toml"])
def test_a_folder_can_be_extended_which_means_the_nearest_file_in_it_or_above(written: str) -> None:
    make("shop/lathe7/jobs/a.nc")
    job("strict = true\nexclude = ['old']\n", "shop/polarcheck.toml")
    where = "shop/lathe7" if written == "../polarcheck.toml" else "shop/lathe7/jobs"
    job(f"extend = '{written}'\nmachine = 'fanuc-30i'\n", f"{where}/polarcheck.toml")
    values = shown("shop/lathe7/jobs/a.nc")
    assert values["strict"] == (True, "file", str(Path("shop", "polarcheck.toml:1")))
    assert values["exclude"] == (["old"], "file", str(Path("shop", "polarcheck.toml:2")))
    assert values["machine"] == ("fanuc-30i", "file", str(Path(where, "polarcheck.toml:2")))


def test_a_folder_without_a_job_file_cannot_be_extended() -> None:
    make("sub/a.nc")
    job("extend = '..'\n", "sub/polarcheck.toml")
    told = "extend: '..': there is no polarcheck.toml in this folder or above it"
    assert refused("check", "sub/a.nc") == f"{Path('sub', 'polarcheck.toml')}:1: {told}"


# ---- a file below another ----


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("outer", "inner", "left"),
    [
        ("machine = 'fanuc-30i'\nstrict = true\nexclude = ['old']\n", "units = 'mm'\n", "machine, strict, exclude"),
        ("strict = true\nmachine = 'fanuc-30i'\n", "machine = 'fanuc'\n", "strict"),
        ("[tools.8]\nradius = 4\n[severities]\npolar = 'note'\n", "strict = true\n", "tools, severities"),
        ("select = ['polar']\n", "[[programs]]\nfiles = ['a*']\nselect = ['feed']\n", "select"),
        ("machine = 'fanuc-30i'\n[limits]\nc_feed = 9000\n", "machine = 'fanuc-30i'\n", "limits"),
        ("machine = 'fanuc-30i'\n[tools.8]\nradius = 4\n[limits]\nc_feed = 9000\n", "machine = 'fanuc-16i'\n", ""),
        ("strict = true\n", "extend = '..'\n", ""),
        ("strict = true\n", "root = true\n", ""),
        ("strict = true\n", "strict = false\n", ""),
        ("units = 'mm'\n[[programs]]\nfiles = ['sub/**']\nstrict = true\n", "", ""),
        ("strict = maybe\n", "machine = 'fanuc'\n", ""),
    ],
)
def test_what_a_nearer_file_leaves_behind_of_the_one_above_is_said_once(outer: str, inner: str, left: str) -> None:
    make("sub/a.nc", "sub/b.nc", "sub/deep/c.nc", text="O1\nM30\n")
    job(outer)
    job(inner, "sub/polarcheck.toml")
    result = call("check", "sub")
    document = json.loads(call("config", "show", "sub/a.nc", "--format", "json").stdout)
    text = call("config", "show", "sub/deep/c.nc").stdout
    if not left:
        assert (result.stderr, document["not_taken_over"]) == ("", None)
        assert "not taken over" not in text
        return
    names = left.split(", ")
    assert result.stderr.count("\n") == 1
    assert all(f" {name}" in result.stderr for name in names)
    assert 'polarcheck.toml do not apply here; extend = ".." takes' in result.stderr.replace("does", "do")
    assert document["not_taken_over"] == {"file": "polarcheck.toml", "keys": names}
    assert f'# not taken over from polarcheck.toml: {left}; extend = ".." would\n' in text


@pytest.mark.ci
def test_several_files_that_leave_the_same_behind_share_a_line() -> None:
    make(*(f"l{number}/a.nc" for number in range(5)), text="O1\nM30\n")
    job("strict = true\n")
    for number in range(5):
        job("machine = 'fanuc'\n", f"l{number}/polarcheck.toml")
    stderr = call("check", ".").stderr
    assert stderr.count("\n") == 1
    assert " and 2 more: strict of polarcheck.toml does not apply here" in stderr
    assert call("check", "l0/a.nc", "--config", "l0/polarcheck.toml").stderr == ""


def test_paths_with_backslashes_are_found_wherever_there_are_slashes() -> None:
    make("jobs/a.nc")
    make("tables/t.txt", text="G10 P10008 R4.5\n")
    make("lathes/l.toml", text="inherits = 'fanuc'\n")
    job("machine = 'lathes\\l.toml'\noffsets = 'tables\\t.txt'\nrun.subprograms = ['.\\tables']\n", "base.toml")
    job("extend = '..\\base.toml'\n", "jobs/polarcheck.toml")
    assert radii("jobs/a.nc") == {"jobs/a.nc": 4.5}


# ---- texts and their lines ----

TEXT = "[tools.8]\nradius = 4.25\n"


@pytest.mark.ci
@looped("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"], one_in=3)
@looped("name", ["polarcheck.toml", "pyproject.toml"])
def test_files_are_read_as_windows_saves_them(encoding: str, name: str) -> None:
    make("a.nc")
    text = TEXT if name == "polarcheck.toml" else TEXT.replace("[tools", "[tool.polarcheck.tools")
    marked = f"\ufeff{text}" if encoding.endswith("e") else text
    Path(name).write_bytes(marked.replace("\n", "\r\n").encode(encoding))
    assert radii("a.nc") == {"a.nc": 4.25}


def test_machine_files_are_read_as_windows_saves_them() -> None:
    make("a.nc")
    Path("l.toml").write_bytes("inherits = 'fanuc'\r\n[limits]\r\nc_feed = 900\r\n".encode("utf-16"))
    assert shown("a.nc", "--machine", "l.toml")["limits.c_feed"] == (900, "machine", "l.toml:3")


def test_what_is_no_text_is_told_with_its_line() -> None:
    make("a.nc")
    Path("polarcheck.toml").write_bytes(b"strict = true\n# M\xfcller\n")
    assert refused("check", "a.nc") == "polarcheck.toml: line 2 is not UTF-8; save the file as UTF-8"


@pytest.mark.ci
@looped(
    ("text", "told"),
    [
        ("\n[tools.8]\nraduis = 3\n", "polarcheck.toml:3: unknown key tools.8.raduis; did you mean radius?"),
        (
            "[[programs]]\nfiles = ['a']\n[[programs]]\nfiles = ['b']\n[programs.tools.8]\nraduis = 3\n",
            "polarcheck.toml:6: unknown key programs.2.tools.8.raduis; did you mean radius?",
        ),
        ("[[programs]]\nstrict = true\n", "polarcheck.toml:1: programs.1.files is missing"),
        ("x = '''\n[tools.8]\n'''\n", "polarcheck.toml:1: unknown key x"),
        ("fail_on = 'warn'\n", "polarcheck.toml:1: fail_on: expected error, warning, note or never, found 'warn'"),
        ("a = 1\n  [tools\n", "polarcheck.toml:2: Expected ']' at the end of a table declaration at column 9"),
        (
            'run.subprograms = ["x\\O"]\n',
            "polarcheck.toml:1: Unescaped '\\' in a string at column 24; write / between folders, or the text in single"
            " quotes",
        ),
        ("machine = 'l.toml'\n", "l.toml:3: unknown key limits.c_fed; did you mean c_feed?"),
        ("[limits]\n\nc_fed = 3\n", "polarcheck.toml:3: unknown key limits.c_fed; did you mean c_feed?"),
        (
            "[[programs]]\nfiles = ['a.nc']\n[programs.limits]\nc_fed = 3\n",
            "polarcheck.toml:4: unknown key limits.c_fed; did you mean c_feed?",
        ),
        ("select = ['polar']\nmachine = 'fanuk'\n", "polarcheck.toml:2: machine: unknown machine 'fanuk'"),
        ("[severities]\npolar = 'off'\npoler = 'off'\n", "polarcheck.toml:3: severities: unknown rule 'poler'"),
    ],
)
def test_faults_are_told_with_file_line_and_key(text: str, told: str) -> None:
    make("a.nc")
    make("l.toml", text="inherits = 'fanuc'\n[limits]\nc_fed = 3\n")
    job(text)
    assert refused("check", "a.nc").startswith(told)


@pytest.mark.parametrize(
    "path", [*sorted((ROOT / "polarcheck" / "program" / "machines").glob("*.toml")), ROOT / "pyproject.toml"]
)
def test_the_line_of_each_key_of_a_file_is_known(path: Path) -> None:
    text = path.read_text("utf-8")
    lines, rows = toml_lines.of_keys(text), text.split("\n")

    def keys(table: dict[str, Any], before: str) -> Any:
        for key, value in table.items():
            yield f"{before}{key}", key
            if isinstance(value, dict):
                yield from keys(value, f"{before}{key}.")

    found = list(keys(tomllib.loads(text), ""))
    assert len(found) > 3
    for name, key in found:
        assert key in rows[lines[name] - 1], name


@pytest.mark.ci
@given(st.text("[]{}=.,#\"'\\\n ab1", max_size=60))
def test_no_text_keeps_the_lines_from_being_looked_for(text: str) -> None:
    lines = toml_lines.of_keys(text)
    assert all(1 <= line <= text.count("\n") + 1 for line in lines.values())


# ---- config show ----


def test_each_value_is_shown_with_where_it_comes_from() -> None:
    make("a.nc")
    make("l.toml", text="inherits = 'fanuc-30i'\n[limits]\nc_feed = 900\n[parameters]\n1430 = 500\n")
    job("machine = 'l.toml'\nfail_on = 'note'\n[[programs]]\nfiles = ['a*']\nignore = ['text']\n")
    values = shown("a.nc", "--tool", "8:radius=3", "--severity", "overcut=off", POLARCHECK_STRICT="1")
    assert {key: values[key][1:] for key in ("machine", "fail_on", "ignore", "tools.8.radius", "strict", "inline")} == {
        "machine": ("file", "polarcheck.toml:1"),
        "fail_on": ("file", "polarcheck.toml:2"),
        "ignore": ("programs", "polarcheck.toml:5, [[programs]] 1"),
        "tools.8.radius": ("command line", "command line --tool"),
        "strict": ("environment", "environment POLARCHECK_STRICT"),
        "inline": ("default", "built-in default"),
    }
    assert values["severities.overcut"] == ("off", "command line", "command line --severity")
    assert values["limits.c_feed"] == (900, "machine", "l.toml:3")
    assert values["limits.keep_out"][1:] == ("machine", "built-in fanuc")
    over = shown("a.nc", "--set", "limits.c_feed=30", "--machine", "fanuc")
    assert over["limits.c_feed"] == (30, "command line", "command line --set")
    assert over["machine"] == ("fanuc", "command line", "command line --machine")


def test_the_text_is_aligned_and_says_which_files_and_entries_apply() -> None:
    make("old/a.nc")
    make("base.toml", text="strict = true\n")
    job("extend = 'base.toml'\nexclude = ['old']\n[[programs]]\nfiles = ['a*', 'b*']\nfail_on = 'error'\n")
    result = call("config", "show", "old/a.nc")
    lines = result.stdout.splitlines()
    assert lines[:4] == [
        "# old/a.nc",
        "# job file: polarcheck.toml extends base.toml",
        "# [[programs]]: polarcheck.toml:4: a*, b*",
        "# excluded: no walk through a folder finds it",
    ]
    assert len({line.index("  # ") for line in lines[6:] if len(line.partition("  #")[0]) < 40}) > 0
    assert re.search(r'^fail_on = "error" +# polarcheck.toml:5, \[\[programs\]\] 1$', result.stdout, re.MULTILINE)
    assert re.search(r"^strict = true +# base.toml:1$", result.stdout, re.MULTILINE)
    assert re.search(r"^encoding = not given +# built-in default$", result.stdout, re.MULTILINE)


def test_a_file_that_is_not_there_is_told_and_what_would_apply_is_shown() -> None:
    result = call("config", "show", "gone.nc", "--no-config")
    assert result.exit_code == 0
    assert result.stderr == ("polarcheck: warning: gone.nc: there is no such file; this is what would apply to it\n")


def test_config_alone_shows_what_it_can() -> None:
    result = call("config")
    assert (result.exit_code, result.stdout) == (2, "")
    assert re.search(r"^  show +Show every value", result.stderr, re.MULTILINE)


@looped("line", ["radius =", "radius =  # R on the offset page of the control, in mm"])
def test_a_line_of_which_only_the_mark_was_taken_away_is_told_to_have_no_value(line: str) -> None:
    make("a.nc")
    job(f"[tools.8]\n{line}\n")
    result = call("check", "a.nc")
    assert result.exit_code == 2
    assert result.stderr.startswith("polarcheck: polarcheck.toml:2: ")
    assert '"radius" has no value behind the =: write one, or # before the line' in result.stderr


def test_what_comes_from_files_acts_on_no_terminal() -> None:
    make("a.nc")
    job('machine = "l\\u001b[31m.toml"\n')
    make("l\x1b[31m.toml", text="inherits = 'fanuc'\n")
    assert "\x1b" not in call("config", "show", "a.nc").stdout


def test_what_decides_how_a_program_is_executed_is_asked_of_each_command_that_reads_one() -> None:
    """All that has a place in [run], in what is read, or in the machine: of check, of trace, of config show."""
    deciding = {
        *("machine", "changes", "tools", "offsets", "units", "config", "no_config", "radius_from_comments", "encoding"),
        *(field for field in Running.__struct_fields__ if field != "variables"),
    }
    commands: dict[str, click.Command] = {"check": check_command, "trace": trace_command, "show": show_command}
    for name, command in commands.items():
        assert deciding <= {parameter.name for parameter in command.params}, name
    of_check = {parameter.name for parameter in check_command.params}
    of_show = {parameter.name for parameter in show_command.params}
    judging = {"select", "ignore", "severities", "fail_on", "strict", "extensions"}
    assert judging <= of_check & of_show


def test_a_trace_is_given_up_where_that_is_asked_for() -> None:
    make("a.nc", text="O1\n#1=0\nWHILE[#1LT50]DO1\n#1=#1+1\nG0 X#1\nEND1\nM30\n")
    lines = [len(call("trace", "a.nc", *more).stdout.splitlines()) for more in ((), ("--max-statements", "20"))]
    assert lines[1] < lines[0]


# ---- init ----


def written(path: str = "polarcheck.toml") -> Any:
    return tomllib.loads(Path(path).read_text("utf-8"))


def uncommented(text: str) -> str:
    """With what can be filled in, where a value stands there."""
    return "\n".join(
        line[1:] if re.match(r"#[\w.]+ = [^ ]|#\[", line) and not line.startswith("#:") else line
        for line in text.splitlines()
    )


@pytest.mark.nightly
def test_init_writes_what_the_programs_tell_and_says_what_is_left() -> None:
    make("O1.nc", "x/O2.nc", text=MILL.replace("T0808", "T0808 (D=8. END MILL)"))
    make("O3.nc", text="O3\nG0 X1.\nM30\n")
    result = call("init")
    assert (result.exit_code, result.stderr) == (0, "")
    lines = result.stdout.splitlines()
    assert lines[0] == "polarcheck.toml written: 2 of 3 programs use the polar mode, with offset 8"
    assert any(line.startswith("  radius of offset 8:") for line in lines)
    assert any(line.startswith("  c_feed of the lathe") for line in lines)
    text = Path("polarcheck.toml").read_text("utf-8")
    assert text.startswith("#:schema ./polarcheck.schema.json\n")
    assert "#radius = 4.0  # O1.nc says D=8. END MILL" in text
    assert written() == {"units": "mm", "limits": {}, "stock": {}, "run": {}, "tools": {"8": {}}}
    assert {file["verdict"] for path, file in checked(".").items() if path != "O3.nc"} == {"unverified"}


@pytest.mark.nightly
def test_what_init_suggests_is_a_job_file_where_the_marks_are_taken_away() -> None:
    make("O1.nc", text=MILL.replace("T0808", "T0808 (D=8. END MILL)"))
    make("O2.nc", text=MILL.replace("T0808", 'T0808 (D=10. "END" MILL)'))
    assert call("init").exit_code == 0
    text = uncommented(Path("polarcheck.toml").read_text("utf-8"))
    # Of the radii of one offset one is meant, and the table and the folder are those of the shop.
    text = re.sub(r"(?m)^(offsets|subprograms) = .*$", "", text)
    text = re.sub(r"(?m)^(radius = .* says .*\n)(radius = .* says .*)$", r"\1", text)
    Path("polarcheck.toml").write_text(text)
    found = written()
    assert found["programs"] == [
        {"files": ["O1.nc"], "tools": {"8": {"radius": 4.0}}},
        {"files": ["O2.nc"], "tools": {"8": {"radius": 5.0}}},
    ]
    assert radii("O1.nc", "O2.nc") == {"O1.nc": 4, "O2.nc": 5}
    jsonschema.validate(found, json_schema.schema("job"))


@pytest.mark.parametrize("there", ["polarcheck.toml", "pyproject.toml"])
def test_init_overwrites_nothing(there: str) -> None:
    text = "[tool.polarcheck]\n"
    make(there, text=text if there == "pyproject.toml" else "strict = true\n")
    before = {path.name: path.read_bytes() for path in Path().iterdir()}
    assert refused("init").startswith(f"{there} is there already")
    assert {path.name: path.read_bytes() for path in Path().iterdir()} == before


def test_init_leaves_a_schema_that_is_there() -> None:
    make("polarcheck.schema.json", text="{}")
    assert "polarcheck.schema.json is there already, and stays as it is" in call("init").stdout
    assert Path("polarcheck.schema.json").read_text() == "{}"


def test_init_without_a_schema_names_none() -> None:
    assert call("init", "--no-schema").exit_code == 0
    assert "schema" not in Path("polarcheck.toml").read_text("utf-8")
    assert not Path("polarcheck.schema.json").exists()


@pytest.mark.nightly
@pytest.mark.parametrize(
    ("folder", "machine"),
    [("haas-lathe", "haas-lathe"), ("hurco", "hurco")],
)
def test_init_finds_out_the_machine_that_alone_reads_the_programs(folder: str, machine: str) -> None:
    for path in (ROOT / "sample_programs" / folder).iterdir():
        if path.suffix == ".nc":
            Path(path.name).write_bytes(path.read_bytes())
    assert "machine:" not in call("init").stdout
    assert written()["machine"] == machine


@pytest.mark.ci
def test_init_leaves_the_machine_open_where_several_read_the_programs() -> None:
    make("O1.nc")
    assert "  machine: which lathe it is" in call("init").stdout
    text = Path("polarcheck.toml").read_text("utf-8")
    assert '\n#machine = "fanuc"\n' in text
    assert "# These read the programs: fanuc, fanuc-16i" in text


@pytest.mark.ci
def test_init_takes_the_machine_that_is_named_from_where_the_file_lies() -> None:
    make("jobs/O1.nc")
    make("l.toml", text="inherits = 'fanuc-30i'\n")
    assert call("init", "jobs", "--machine", "l.toml").exit_code == 0
    assert written("jobs/polarcheck.toml")["machine"] == "../l.toml"
    assert checked("jobs")["jobs/O1.nc"]["machine"] == "l"
    assert refused("init", "--machine", "fanuk").startswith("unknown machine 'fanuk'; did you mean fanuc?")


@pytest.mark.ci
def test_init_tells_of_the_job_file_that_has_applied_so_far() -> None:
    make("jobs/O1.nc")
    job("strict = true\n")
    assert "../polarcheck.toml has applied here so far" in call("init", "jobs").stdout
    assert '\n#extend = "../polarcheck.toml"\n' in Path("jobs/polarcheck.toml").read_text("utf-8")


@pytest.mark.ci
def test_what_programs_say_stays_a_comment_of_one_line() -> None:
    make("O1.nc", text=MILL.replace("T0808", "T0808 (D=8. END MILL \x1b[31m\u202e\x85 x)"))
    result = call("init")
    text = Path("polarcheck.toml").read_text("utf-8")
    assert result.exit_code == 0
    assert not {"\x1b", "\u202e", "\x85"} & set(text + result.stdout)
    assert written()["tools"] == {"8": {}}


def test_init_in_a_folder_without_programs_says_so() -> None:
    result = call("init")
    assert result.exit_code == 0
    assert result.stdout.startswith("polarcheck.toml written: 0 of 0 programs use the polar mode\n")
    assert "no NC programs in this folder; --extensions names other endings" in result.stderr
    assert call("config", "show", "a.nc").exit_code == 0


@pytest.mark.ci
def test_the_endings_by_which_init_has_found_programs_are_those_of_the_next_check() -> None:
    make("a.job7")
    assert call("init", "--extensions", "job7").exit_code == 0
    assert "1 file checked" in call("check", ".").stdout


@pytest.mark.nightly
def test_init_reads_each_program_and_stops_at_none_that_cannot_be_read() -> None:
    make("O1.nc")
    Path("O2.nc").write_bytes(b"\0" * 50 + MILL.encode().replace(b"T0808", b"T0909") + b"\x1a")
    Path("O3.nc").write_bytes(MILL.replace("T0808", "T1212").encode("utf-16"))
    Path("O4.nc").symlink_to("gone") if sys.platform != "win32" else None
    assert call("init").exit_code == 0
    assert set(written()["tools"]) == {"8", "9", "12"}


# ---- the schema, and the page ----


@pytest.mark.ci
@looped(
    ("text", "is_valid"),
    [
        ("extend = 'x.toml'\nexclude = ['old']\n[[programs]]\nfiles = ['a']\ntools = { 8 = { radius = 4 } }\n", True),
        ("[[programs]]\nfiles = ['a']\nlimits = { c_feed = 3 }\nencoding = 'cp1252'\ninline = false\n", True),
        ("[[programs]]\nfiles = ['a']\nlimits = { c_fed = 3 }\n", False),
        ("[[programs]]\nstrict = true\n", False),
        ("[[programs]]\nfiles = ['a']\nextend = 'x'\n", False),
        ("fail_on = 'warn'\n", False),
    ],
)
def test_the_schema_knows_each_key(text: str, is_valid: bool) -> None:
    found = jsonschema.Draft202012Validator(json_schema.schema("job")).is_valid(tomllib.loads(text))
    assert found is is_valid


def test_sample_job_files_fit_the_schema() -> None:
    paths = sorted((ROOT / "sample_programs").rglob("polarcheck.toml"))
    assert len(paths) > 5
    validator = jsonschema.Draft202012Validator(json_schema.schema("job"))
    for path in paths:
        validator.validate(tomllib.loads(path.read_text("utf-8")))


PAGE = ROOT / "docs" / "configuration.md"


def test_the_page_has_each_key() -> None:
    text = PAGE.read_text("utf-8")
    keys = {f"`{field.name}`" for kind in (Job, Programs, Running) for field in msgspec.structs.fields(kind)}
    for name, kind in (("tools", Tool), ("stock", Stock), ("work_offsets", WorkOffset)):
        keys |= {f"`{name}.{field.name}`" for field in msgspec.structs.fields(kind)}
    rows = {cell for line in text.splitlines() if line.startswith("|") for cell in re.findall(r"`[^`]+`", line)}
    nested = {key.replace("`tools.", "`tools.N.").replace("`work_offsets.", "`work_offsets.G54.") for key in keys}
    of_run = {f"`run.{name}`" for name in Running.__struct_fields__}
    wanted = {key for key in nested if key.strip("`") not in Running.__struct_fields__} | of_run
    assert wanted <= rows, sorted(wanted - rows)


@pytest.mark.nightly
def test_each_job_file_of_the_page_is_one() -> None:
    blocks = re.findall(r"```toml\n(.*?)```", PAGE.read_text("utf-8"), re.DOTALL)
    assert len(blocks) > 2
    for block in blocks:
        jsonschema.validate(tomllib.loads(block), json_schema.schema("job"))


# ---- as a process ----


@pytest.mark.ci
def test_a_small_check_loads_nothing_for_it() -> None:
    make("a.nc")
    job(
        "machine = 'fanuc-30i'\nselect = ['polar']\nignore = ['text']\n[tools.8]\nradius = 4\n[limits]\nc_feed = 900\n"
        "[severities]\npolar = 'note'\n[[programs]]\nfiles = ['b.nc']\n"
    )
    code = (
        "import sys; sys.argv = ['polarcheck', 'check', 'a.nc', '-q']\n"
        "from polarcheck.commands import run\n"
        "try: run()\nexcept SystemExit: print(*sorted(name for name in sys.modules if name.startswith('polarcheck')),"
        " file=sys.stderr)"
    )
    environment = {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE_")}
    environment["PYTHONPATH"] = os.fspath(ROOT)
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    loaded = set(result.stderr.split())
    assert not loaded & {
        *(
            "polarcheck.program.machines.toml_lines",
            "polarcheck.checking.survey",
            "polarcheck.program.machines.offset_table",
            "polarcheck.program.machines.offset_page",
        ),
        *("polarcheck.files.settings.origins", "polarcheck.commands.init", "polarcheck.reports.pages.new_job"),
    }
