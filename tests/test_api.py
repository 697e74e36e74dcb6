"""The functions for Python: they say what the commands say, take what a job can say, and load nothing before use."""

from __future__ import annotations

import ast
import doctest
import inspect
import json
import re
import subprocess
import sys
import warnings
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import msgspec
import numpy as np
import pytest
from cases import looped
from click.testing import CliRunner
from polarcheck.errors import (
    BaselineError,
    JobError,
    MachineError,
    PolarcheckError,
    PolarcheckWarning,
    SourceError,
    UsageError,
)
from programs import ROOT

import polarcheck
from polarcheck.api import keywords
from polarcheck.commands import main

SAMPLES = sorted(path.name for path in (ROOT / "sample_programs").glob("*.nc"))
HEXAGON = (ROOT / "sample_programs" / "hexagon.nc").read_bytes()
#: The first cut is at C 0, in rapid traverse.
RAPID = "G98 G0 X60. C0\nG12.1\nG1 X40. C5. F100\nG0 C-5.\nG13.1\nM30\n"
#: R is not known before a keyword says it.
OFFSET = "G98 G0 X60. C0 T0808\nG12.1\nG42 G1 X40. F100\nG1 C10.\nG40 X60.\nG13.1\nM30\n"


@pytest.fixture
def samples(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT / "sample_programs")


def by_command(*arguments: str) -> Any:
    result = CliRunner().invoke(main, arguments, catch_exceptions=False)
    return json.loads(result.stdout)


# ---- the command and the function agree ----


@pytest.mark.nightly
@pytest.mark.filterwarnings("ignore::polarcheck.errors.PolarcheckWarning")
def test_check_gives_the_report_of_the_command(samples: None) -> None:
    assert json.loads(polarcheck.render(polarcheck.check("."), "json")) == by_command("check", ".", "--format", "json")


@pytest.mark.nightly
def test_formats_are_those_of_the_command(samples: None) -> None:
    names = ["degrees.nc", "hexagon.nc", "../sample_programs/spiral.nc"]
    report = polarcheck.check(names)
    for form in ("jsonl", "sarif", "junit", "gitlab", "github", "checkstyle"):
        result = CliRunner().invoke(main, ["check", *names, "--format", form, "--no-cache"])
        assert polarcheck.render(report, form) == result.stdout, form


@pytest.mark.nightly
def test_check_of_several_processes_is_the_same(samples: None) -> None:
    paths = [Path(name) for name in SAMPLES[:6]]
    assert polarcheck.check(paths, processes=2) == polarcheck.check(paths)


@pytest.mark.nightly
def test_part_gives_what_the_command_gives(samples: None) -> None:
    files = by_command("part", *SAMPLES, "--format", "json")["files"]
    assert [json.loads(msgspec.json.encode(polarcheck.part(name))) for name in SAMPLES] == files


@pytest.mark.nightly
@pytest.mark.one_in(2)
@pytest.mark.parametrize("which", ["tool", "programmed"])
def test_trace_gives_the_moves_of_the_command(samples: None, which: Any) -> None:
    for name in SAMPLES:
        result = CliRunner().invoke(main, ["trace", name, "--path", which, "--format", "jsonl"])
        moves = [json.loads(line) for line in result.stdout.splitlines()]
        trace = polarcheck.trace(name, which=which)
        assert len(trace) == len(moves)
        for column in ("line", "section", "kind", "path", "radius", "feed", "z", "x_axis", "c_axis", "nearest", "time"):
            same(getattr(trace, column), [move[column] for move in moves])
        for column in ("c_feed", "x_feed", "c_acceleration", "x_acceleration"):
            same(getattr(trace, column), [move[column] for move in moves])
        for column in ("start", "end", "center"):
            points = [complex(*(move[column] or (np.nan, np.nan))) for move in moves]
            np.testing.assert_allclose(getattr(trace, column), points, atol=1e-6)
        assert bool(trace.missing) == (which == "tool" and "is shown as programmed" in result.stderr)


def same(column: np.ndarray[Any, Any], values: list[Any]) -> None:
    if column.dtype.kind == "f":
        expected = np.array(values, float).reshape(column.shape)
        np.testing.assert_allclose(np.where(np.isfinite(column), column, np.nan), expected, atol=1e-6, rtol=1e-9)
    else:
        assert column.tolist() == values


@pytest.mark.nightly
def test_feeds_gives_the_tables_of_the_command(samples: None) -> None:
    for name in SAMPLES[:8]:
        tables = by_command("feeds", name, "--format", "json")["tables"]
        assert json.loads(msgspec.json.encode(polarcheck.feeds(name).tables)) == tables


@pytest.mark.nightly
def test_passed_is_what_all_verdicts_say() -> None:
    good, bad = ROOT / "sample_programs" / "hexagon.nc", ROOT / "sample_programs" / "degrees.nc"
    reports = [polarcheck.check(paths) for paths in ([good], [good, bad], [bad], [good, ROOT / "none.nc"], [])]
    assert [report.passed for report in reports] == [True, False, False, False, False]
    assert [file.passed for file in reports[1].files] == [True, False]


# ---- a text ----


@pytest.mark.nightly
@pytest.mark.parametrize("text", [HEXAGON, HEXAGON.decode()], ids=["bytes", "str"])
def test_a_text_is_checked_as_its_file(samples: None, text: str | bytes) -> None:
    name, config = "hexagon.nc", "polarcheck.toml"
    assert polarcheck.check_text(text, name=name, config=config) == polarcheck.check(name).files[0]
    assert polarcheck.check_text(text, name=name, use_config=True) == polarcheck.check(name).files[0]
    assert polarcheck.part_text(text, name=name, config=config) == polarcheck.part(name)
    assert polarcheck.feeds_text(text, name=name, config=config) == polarcheck.feeds(name)
    traced, file = polarcheck.trace_text(text, name=name, config=config), polarcheck.trace(name)
    assert traced.c_axis.tolist() == file.c_axis.tolist()
    assert (traced.file, traced.machine) == (file.file, file.machine)


def test_no_job_file_applies_to_a_text_by_itself(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "polarcheck.toml").write_text('machine = "haas-lathe"\n', "utf-8")
    monkeypatch.chdir(tmp_path)
    assert polarcheck.check_text("M30\n").machine == "fanuc"
    assert polarcheck.check_text("M30\n", use_config=True).machine == "haas-lathe"


@looped("text", ["", "\ufeffM30\n", "(\udc80 \ud800)\nM30\n", b"\xff\xfe\x00", "\0" * 9])
def test_any_text_has_a_report(text: str | bytes) -> None:
    report = polarcheck.check_text(text)
    assert report.path == "text"
    assert polarcheck.render(report, "json")


@pytest.mark.nightly
def test_texts_are_checked_in_threads() -> None:
    texts = [RAPID.replace("C5.", f"C{number}.") for number in range(5, 13)]
    with ThreadPoolExecutor(4) as pool:
        assert list(pool.map(polarcheck.check_text, texts)) == [polarcheck.check_text(text) for text in texts]


# ---- what a job can say ----


@looped(
    "tools",
    [
        {8: 4.0},
        {"8": np.float64(4)},
        {np.int64(8): 4},
        {8: polarcheck.Tool(radius=4.0, nose=0)},
        {8: {"radius": 4.0}},
    ],
)
def test_tools_are_numbers_or_tools(tools: Any) -> None:
    trace = polarcheck.trace_text(OFFSET, tools=tools)
    assert trace.radius.tolist() == [4.0] * len(trace)
    assert set(trace.path.tolist()) == {"tool"}
    assert not trace.missing


def test_a_trace_says_that_r_is_missing() -> None:
    trace = polarcheck.trace_text(OFFSET)
    assert "give --tool 8:radius=" in trace.missing
    assert set(trace.path.tolist()) == {"programmed"}


JOBS = {
    "machine": ({"machine": "haas-lathe"}, 'machine = "haas-lathe"'),
    "limits": ({"limits": {"c_feed": 60}}, "limits.c_feed = 60"),
    "changes": ({"changes": {"limits.c_feed": 60}}, "limits.c_feed = 60"),
    "tools": ({"tools": {8: 0.25}, "units": "inch"}, 'units = "inch"\ntools.8.radius = 0.25'),
    "program units": ({"program_units": "inch"}, 'program_units = "inch"'),
    "stock": ({"stock": polarcheck.Stock(hexagon=30.0)}, "stock.hexagon = 30.0"),
    "work offsets": ({"work_offsets": {"G54": 3.0}}, "work_offsets.G54.x = 3.0"),
    "part": ({"part": {"shape": "circle", "diameter": 30}}, 'part = [{shape = "circle", diameter = 30}]'),
    "parts": (
        {"part": [polarcheck.Part(shape="circle", diameter=30.0)], "tolerance": 0.5},
        'part = [{shape = "circle", diameter = 30, tolerance = 0.5}]',
    ),
    "severities": ({"severities": {"rapid-in-polar": "note"}}, 'severities.rapid-in-polar = "note"'),
    "ignore": ({"ignore": "rapid-in-polar"}, 'ignore = ["rapid-in-polar"]'),
    "strict": ({"strict": True, "fail_on": "error"}, 'strict = true\nfail_on = "error"'),
    "block skip": ({"block_skip": "on", "max_blocks": 7}, 'run.block_skip = "on"\nrun.max_blocks = 7'),
    "variables": ({"variables": {500: 1}}, "run.variables.500 = 1"),
}


@pytest.mark.nightly
@pytest.mark.one_in(12)
@pytest.mark.parametrize(("given", "written"), JOBS.values(), ids=JOBS)
def test_a_keyword_says_what_a_job_file_says(
    given: dict[str, Any], written: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.nc").write_text(RAPID + "/" + OFFSET, "utf-8")
    plain = polarcheck.check("a.nc")
    (tmp_path / "polarcheck.toml").write_text(written + "\n", "utf-8")
    by_file = polarcheck.check("a.nc").files[0]
    (by_keyword,) = polarcheck.check("a.nc", use_config=False, **given).files
    assert findings(by_keyword) == findings(by_file)
    assert by_keyword.polar_sections == by_file.polar_sections
    assert by_keyword.machine == by_file.machine
    assert plain.files[0].machine == "fanuc"


def findings(report: polarcheck.FileReport) -> list[Any]:
    return [(finding.rule, finding.severity, finding.message) for finding in report.findings]


REASON = "checked by the DNC"
SELECTIONS: dict[str, tuple[dict[str, Any], str, str]] = {
    "select": ({"select": "text"}, "unverified", "deselected by polarcheck.check_text(): select text"),
    "ignore": ({"ignore": ["polar", "text"]}, "unverified", "deselected by polarcheck.check_text(): ignore polar,text"),
    "severity": (
        {"severities": {"overcut": "off"}},
        "unverified",
        "by polarcheck.check_text(): severities overcut=off",
    ),
    "ignore with a reason": ({"ignore": {"rules": ["polar"], "reason": REASON}}, "pass", ""),
    "severity with a reason": ({"severities": {"overcut": {"level": "off", "reason": REASON}}}, "pass", ""),
}


@pytest.mark.nightly
@looped(("given", "verdict", "why"), SELECTIONS.values(), ids=SELECTIONS)
def test_rules_that_are_left_out_need_a_reason(given: dict[str, Any], verdict: str, why: str) -> None:
    report = polarcheck.check_text(HEXAGON, tools={1: 4.0}, limits={"c_feed": 10800}, machine="fanuc-30i", **given)
    assert report.verdict == verdict
    assert why in "".join(missing.reason for missing in report.not_evaluated)


@pytest.mark.ci
def test_settings_of_a_report_name_the_keywords(samples: None) -> None:
    settings = polarcheck.check("hexagon.nc", limits={"c_feed": 60}, changes={"limits.x_feed": 9}, strict=True).settings
    assert (settings.changes, settings.strict, settings.max_warnings) == (("limits.x_feed=9",), True, None)
    assert settings.sources == {
        "changes": "polarcheck.check(): changes",
        "machine": "polarcheck.toml",
        "strict": "polarcheck.check()",
    }


def test_a_keyword_lies_over_the_job_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.nc").write_text(OFFSET, "utf-8")
    (tmp_path / "polarcheck.toml").write_text("[tools]\n8 = {radius = 1.0, nose = 0}\n9 = {radius = 2.0}\n", "utf-8")
    (section,) = polarcheck.check("a.nc", tools={8: 4}).files[0].polar_sections
    assert (section.radius, section.radius_source) == (4.0, "job")
    (section,) = polarcheck.check("a.nc", tools={7: 4}).files[0].polar_sections
    assert section.radius == 1.0


@pytest.mark.nightly
def test_parts_stand_in_place_of_those_of_the_file(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.nc").write_bytes(HEXAGON)
    (tmp_path / "polarcheck.toml").write_text(
        'tools.1.radius = 4\npart = [{shape = "circle", diameter = 30}]\n', "utf-8"
    )
    wrong, right = polarcheck.part("a.nc"), polarcheck.part("a.nc", part={"shape": "hexagon", "across_flats": 30})
    assert [finding.rule for finding in wrong.findings] == ["part-differs-from-drawing"]
    assert not right.findings
    assert [comparison.agrees for comparison in right.compared] == [True]


def test_folders_of_subprograms_and_variables_of_a_job(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "O9001.nc").write_text("O9001\nG1 X40. F100\nM99\n", "utf-8")
    text = "O1\nG98 G0 X60. C0\nG12.1\nM98 P9001\nG13.1\nM30\n"
    assert len(polarcheck.trace_text(text, subprograms="lib", which="programmed")) == 1
    assert len(polarcheck.trace_text(text, which="programmed")) == 0


# ---- errors ----

WRONG: dict[str, tuple[type[PolarcheckError], dict[str, Any], str]] = {
    "unknown keyword": (UsageError, {"tols": {}}, "unknown keyword tols; did you mean tools?"),
    "tool": (UsageError, {"tools": {8: "4"}}, "tools.8: expected radius as a number, or a table, found '4'"),
    "tools": (UsageError, {"tools": [4]}, "tools: expected radius by tool offset as {8: 6.35}, found [4]"),
    "key of tool": (UsageError, {"tools": {8: {"radus": 1}}}, "unknown key tools.8.radus; did you mean radius?"),
    "machine": (MachineError, {"machine": "fanucc"}, "machine: unknown machine 'fanucc'; did you mean fanuc?"),
    "no name": (UsageError, {"machine": 30}, "machine: expected a name or a path, found 30"),
    "rule": (UsageError, {"select": "rapid-in-polr"}, "select: unknown rule 'rapid-in-polr'"),
    "ignored": (UsageError, {"ignore": ["rapid-in-polr"]}, "ignore: unknown rule 'rapid-in-polr'"),
    "names": (UsageError, {"select": 5}, "select: expected names, found 5"),
    "level": (UsageError, {"severities": {"rapid-in-polar": "of"}}, "severities.rapid-in-polar: expected error,"),
    "severity": (UsageError, {"severities": {"rapid": "off"}}, "severities: unknown rule 'rapid'"),
    "change": (
        MachineError,
        {"changes": {"limits.c_fed": 3}},
        "changes: unknown key limits.c_fed; did you mean c_feed",
    ),
    "changed": (UsageError, {"changes": {"c_feed": 3}}, "changes: expected keys TABLE.KEY as limits.c_feed, found"),
    "changes": (UsageError, {"changes": ["a"]}, "changes: expected keys with values, found ['a']"),
    "limit": (MachineError, {"limits": {"c_feed": -3}}, "limits.c_feed: expected a number above 0, found -3"),
    "folder": (UsageError, {"subprograms": ["nowhere"]}, "subprograms: there is no folder nowhere"),
    "stock": (UsageError, {"stock": {"diameter": -1}}, "stock.diameter: expected a number above 0"),
    "layers": (UsageError, {"drawing_layers": "a"}, "drawing_layers: give the drawing by drawings, too"),
    "tolerance": (UsageError, {"tolerance": 0}, "tolerance: expected a length above 0 and up to 100, found 0"),
    "run": (UsageError, {"block_skip": "maybe"}, "block_skip: expected off, on or both, found 'maybe'"),
    "encoding": (UsageError, {"encoding": "utf-99"}, "encoding: unknown encoding 'utf-99'"),
    "use_config": (UsageError, {"use_config": 1}, "use_config: expected True or False, found 1"),
    "work offset": (JobError, {"work_offsets": {"G99": 1}}, "work_offsets.G99: expected G54 to G59"),
    "offsets": (JobError, {"offsets": Path("none.txt")}, "offsets: none.txt: No such file"),
}


@looped(("kind", "given", "text"), WRONG.values(), ids=WRONG)
def test_a_wrong_keyword_is_named_in_one_line(kind: type[PolarcheckError], given: dict[str, Any], text: str) -> None:
    with pytest.raises(kind) as caught:
        polarcheck.check_text("M30\n", **given)
    assert str(caught.value).startswith(f"polarcheck.check_text(): {text}")
    assert "\n" not in str(caught.value)


@looped(
    ("call", "text"),
    [
        (lambda: polarcheck.check(5), "polarcheck.check(): expected the path of a program or folder, found 5"),
        (
            lambda: polarcheck.check(b"a.nc"),
            "polarcheck.check(): expected the path of a program or folder, found b'a.nc'",
        ),
        (
            lambda: polarcheck.check(["a.nc", ""]),
            "polarcheck.check(): expected the path of a program or folder, found ''",
        ),
        (lambda: polarcheck.check(".", processes=0), "processes: expected a whole number from 1, found 0"),
        (lambda: polarcheck.check_text(5), "polarcheck.check_text(): expected a program as str or bytes, found int"),
        (lambda: polarcheck.trace_text("M30", which="cut"), "which: expected tool or programmed, found 'cut'"),
        (lambda: polarcheck.trace_text("M30", block_skip="both"), "block_skip: expected on or off, found both"),
        (lambda: polarcheck.trace_text("M30").polyline(0), "polyline: expected a tolerance above 0, found 0"),
        (lambda: polarcheck.trace("none.nc"), "none.nc: No such file or directory"),
        (lambda: polarcheck.machine("none.toml"), "machine none.toml: no such file"),
        (lambda: polarcheck.render(polarcheck.check_text("M30"), "pdf"), "form: expected one of text, short,"),
        (lambda: polarcheck.render(polarcheck.part_text("M30"), "json"), "expected a report of check, found MadePart"),
    ],
)
def test_a_wrong_argument_is_named_in_one_line(call: Any, text: str) -> None:
    with pytest.raises(PolarcheckError) as caught:
        call()
    assert text in str(caught.value)


def test_a_file_that_cannot_be_read(tmp_path: Path) -> None:
    report = polarcheck.check([tmp_path / "none.nc", ROOT / "sample_programs" / "hexagon.nc"])
    assert [file.verdict for file in report.files] == ["unreadable", "pass"]
    assert report.files[0].reason == "No such file or directory"
    with pytest.raises(SourceError, match="No such file"):
        polarcheck.part(tmp_path / "none.nc")


def test_a_file_may_be_called_as_standard_input_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "-").write_text("M30\n", "utf-8")
    assert [file.path for file in polarcheck.check("-").files] == ["./-"]


def test_an_empty_folder_is_told(tmp_path: Path) -> None:
    with pytest.warns(PolarcheckWarning, match="no NC programs in this folder") as told:
        report = polarcheck.check(tmp_path)
    assert not report.files
    assert told[0].filename == __file__


@pytest.mark.ci
def test_a_walk_says_what_it_leaves_out(tmp_path: Path) -> None:
    for name in ("a.nc", "b.nc", "P.SUB"):
        (tmp_path / name).write_text(RAPID, "utf-8")
    with pytest.warns(PolarcheckWarning, match=r"polarcheck.check\(\): exclude 'z\*' excludes nothing"):
        report = polarcheck.check(tmp_path, exclude=[f"{tmp_path}/b.nc", "z*"], use_config=False)
    assert [Path(file.path).name for file in report.files] == ["a.nc"]
    assert polarcheck.check(tmp_path, extensions="SUB", use_config=False).summary.files == 1
    with pytest.raises(SourceError, match="nothing to check: "):
        polarcheck.check(tmp_path, exclude=f"{tmp_path}/*.nc", use_config=False)
    with pytest.raises(UsageError, match=r"polarcheck.check\(\): exclude: expected a pattern such as O12"):
        polarcheck.check(tmp_path, exclude="")


@pytest.mark.nightly
def test_known_findings_are_silenced_as_the_command_does(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.nc").write_text(RAPID, "utf-8")
    (tmp_path / "b.nc").write_text(RAPID + RAPID, "utf-8")
    assert CliRunner().invoke(main, ["baseline", "create", "a.nc", "-o", "known.json"]).exit_code == 0
    command = by_command("check", ".", "--format", "json", "--baseline", "known.json")
    report = polarcheck.check(".", baseline=Path("known.json"))
    assert [(file["verdict"], len(file["silenced"])) for file in command["files"]] == [
        (file.verdict, len(file.silenced)) for file in report.files
    ]
    assert [file.verdict for file in report.files] == ["pass", "fail"]
    assert polarcheck.check_text(RAPID, name="a.nc", baseline="known.json").verdict == "pass"
    assert polarcheck.check_text(RAPID, name="a.nc", baseline="known.json", use_baseline=False).verdict == "fail"
    (tmp_path / "a.nc").write_text("M30\n", "utf-8")
    with pytest.warns(PolarcheckWarning, match="known finding no longer occurs: rapid-in-polar in a.nc"):
        polarcheck.check("a.nc", baseline="known.json")
    with pytest.raises(BaselineError, match=r"none\.json"):
        polarcheck.check("a.nc", baseline="none.json")


def test_a_fault_of_polarcheck_is_raised(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("polarcheck.checking.check.check_runs", lambda *_: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        polarcheck.check_text("M30\n")


# ---- the trace ----


def test_a_trace_is_selected_like_a_column() -> None:
    trace = polarcheck.trace_text(RAPID)
    assert [len(trace[:1]), len(trace[trace.c_feed > 0]), len(trace[np.array([0, 1])])] == [1, 1, 2]
    assert trace[:1].machine == trace.machine
    assert repr(trace) == "<Trace of text: 2 moves in 1 sections on fanuc>"


def test_a_polyline_keeps_to_its_arcs_and_breaks_between_sections() -> None:
    text = "G98 G0 X60. C0\n" + 2 * "G12.1\nG1 X40. F100\nG3 X-40. C0 R20.\nG13.1\nG0 X60. C0\n" + "M30\n"
    points = polarcheck.trace_text(text).polyline(0.01)
    assert np.flatnonzero(np.isnan(points)).tolist() == [len(points) // 2]
    on_arc = points[np.abs(points) < 20.0001]
    middle = (on_arc[1:] + on_arc[:-1]) / 2
    assert np.abs(on_arc).min() > 19.999
    assert np.abs(middle[np.abs(middle) > 1]).min() > 19.99
    assert not len(polarcheck.trace_text("M30\n").polyline())


def test_a_trace_of_several_channels() -> None:
    section = "G98 G0 X60. C0\nG12.1\nG1 X40. F100\nG13.1\nM30\n"
    trace = polarcheck.trace_text(f"O1\n$1\n{section}$2\n{section}", machine="citizen")
    assert sorted(set(trace.channel.tolist())) == ["$1", "$2"]


def test_a_trace_gives_moves_and_columns_of_one_dimension() -> None:
    trace = polarcheck.trace("sample_programs/hexagon.nc")
    moves = list(trace)
    assert [move.line for move in moves] == trace.line.tolist()
    assert repr(trace[-1]) == repr(moves[-1]) == repr(trace[np.int64(len(trace) - 1)])
    assert [move.z for move in trace[2:4]] == [tuple(pair) for pair in trace.z[2:4].tolist()]
    with pytest.raises(IndexError):
        trace[len(trace)]
    columns = trace.to_dict()
    assert {column.shape for column in columns.values()} == {(len(trace),)}
    assert np.array_equal(columns["end_x"] + 1j * columns["end_c"], trace.end)
    assert np.array_equal(columns["c_to"], trace.c_axis[:, 1])


@looped("select", [lambda trace: trace, lambda trace: trace[1:], lambda trace: trace[trace.c_feed > 0]])
def test_columns_are_read_only(select: Any) -> None:
    trace = select(polarcheck.trace("sample_programs/hexagon.nc"))
    for column in (*(getattr(trace, name) for name in trace._columns()), *trace.to_dict().values()):
        with pytest.raises(ValueError, match="read-only"):
            column[:1] = column[:1]


# ---- programs written anew ----


@pytest.mark.ci
def test_the_functions_write_what_the_commands_write(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    source = ROOT / "sample_programs" / "hexagon.nc"
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.nc").write_bytes(source.read_bytes())
    tool: dict[str, Any] = {"tools": {1: 4.0}}
    cases: list[tuple[Any, list[str]]] = [
        (polarcheck.convert("a.nc", to="okuma-osp", **tool), ["convert", "--to", "okuma-osp"]),
        (polarcheck.convert_text(source.read_bytes(), to="okuma-osp", **tool), ["convert", "--to", "okuma-osp"]),
        (polarcheck.unroll("a.nc", feed="per-minute", chord_error=0.05, **tool),
         ["unroll", "--feed", "per-minute", "--chord-error", "0.05"]),
        (polarcheck.compensate("a.nc", center=True, **tool), ["compensate", "--center"]),
    ]  # fmt: skip
    for outcome, arguments in cases:
        command, *rest = arguments
        done = CliRunner().invoke(main, [command, "a.nc", *rest, "--tool", "1:radius=4"])
        assert done.stdout_bytes == outcome.data
        assert done.exit_code == bool(outcome.decisions)
    plain = polarcheck.unroll_text(source.read_text("utf-8"), feed="per-minute", chord_error=0.05, **tool)
    assert b"G12.1" in polarcheck.roll_text(plain.data, feed="per-minute", **tool).data
    page = polarcheck.plot("a.nc")
    assert "<html" in page
    assert polarcheck.plot_text(source.read_text("utf-8"), name="a.nc") == page


@looped(
    ("call", "message"),
    [
        (lambda: polarcheck.convert_text("M30", to="okum"), "okuma-osp"),
        (lambda: polarcheck.convert_text("M30", to=3), "to: expected the name of a lathe"),  # type: ignore[arg-type]
        (lambda: polarcheck.convert_text("M30", to="fanuc", accept="control.y"), "accept: expected one of"),
        (lambda: polarcheck.unroll_text("M30", chord_error=0), "chord_error: expected a length above 0"),
        (lambda: polarcheck.unroll_text("M30", feed="slow"), "feed: expected one of"),  # type: ignore[arg-type]
        (lambda: polarcheck.unroll_text("M30"), "there is no polar section in it"),
        (lambda: polarcheck.roll_text("M30", keep_c=1), "keep_c: expected True or False"),  # type: ignore[arg-type]
        (lambda: polarcheck.compensate_text("M30", center=True, side="left"), "with center the program says"),
        (lambda: polarcheck.plot_text("M30", tols={}), "unknown keyword tols"),  # type: ignore[call-arg]
    ],
)
def test_a_wrong_argument_of_a_rewriter_is_named(call: Any, message: str) -> None:
    with pytest.raises(polarcheck.errors.PolarcheckError, match=re.escape(message)) as error:
        call()
    assert "\n" not in str(error.value)


# ---- what is public ----


@pytest.mark.ci
def test_import_loads_nothing() -> None:
    code = (
        "import sys; before = set(sys.modules); import polarcheck; dir(polarcheck)\n"
        "new = {name.partition('.')[0] for name in set(sys.modules) - before}\n"
        "assert not new & {'numpy', 'click', 'msgspec', 'shapely'}, new\n"
        "polarcheck.machine('fanuc'); polarcheck.Tool(radius=1.0); polarcheck.errors.UsageError\n"
        "assert not {'numpy', 'click', 'rich'} & set(sys.modules)\n"
        "polarcheck.check_text('M30')\n"
        "assert not {'click', 'rich', 'shapely'} & set(sys.modules)\n"
    )
    subprocess.run([sys.executable, "-W", "error", "-c", code], check=True, cwd=ROOT)


def test_type_checkers_and_python_see_the_same_names() -> None:
    tree = ast.parse(Path(polarcheck.__file__).read_text("utf-8"))
    guarded = next(node for node in tree.body if isinstance(node, ast.If))
    imports = [node for node in guarded.body if isinstance(node, ast.ImportFrom)]
    seen = {str(alias.asname): f"{node.module}.{alias.name}" for node in imports for alias in node.names}
    assert seen.keys() == set(polarcheck.__all__)
    for name, place in seen.items():
        module, _, own = place.rpartition(".")
        expected = sys.modules[place] if name == "errors" else getattr(sys.modules[module], own, None)
        assert getattr(polarcheck, name) is expected, name
    assert set(polarcheck.__all__) <= set(dir(polarcheck))


def test_no_module_has_the_name_of_a_function() -> None:
    functions = {name for name in polarcheck.__all__ if inspect.isfunction(getattr(polarcheck, name))}
    modules = {path.stem for path in (ROOT / "polarcheck").iterdir()}
    assert len(functions) >= 21
    assert not functions & modules


def test_the_errors_have_their_public_name_before_they_are_loaded() -> None:
    code = (
        "import sys, warnings, polarcheck\n"
        "assert 'polarcheck.foundation' not in sys.modules\n"
        "warnings.simplefilter('error', polarcheck.errors.PolarcheckWarning)\n"
        "from polarcheck.errors import UsageError\n"
        "import pickle, polarcheck.errors\n"
        "assert polarcheck.errors.UsageError is UsageError is type(pickle.loads(pickle.dumps(UsageError('a'))))\n"
        "print(UsageError.__module__, polarcheck.__version__)\n"
    )
    run = subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True)
    assert run.stdout.split() == ["polarcheck.errors", polarcheck.__version__]


def test_what_is_not_public_is_not_there() -> None:
    with pytest.raises(AttributeError, match="module 'polarcheck' has no attribute 'chek'"):
        polarcheck.chek  # type: ignore[attr-defined]  # noqa: B018


PUBLIC = [getattr(polarcheck, name) for name in polarcheck.__all__ if inspect.isfunction(getattr(polarcheck, name))]


@looped("function", PUBLIC, ids=lambda function: function.__name__)
def test_help_names_every_keyword(function: Any) -> None:
    document, signature = inspect.getdoc(function) or "", inspect.signature(function)
    for name in signature.parameters:
        assert name in document, name
    assert "Raises" in document or not signature.parameters
    assert "Unpack" not in str(signature)


def test_every_option_of_a_job_is_a_keyword() -> None:
    """What the command line can say of a program, a caller of Python can say, too."""
    from polarcheck.files.settings.of_programs import Options

    other = {"severities": "severities", "units": "program_units"}
    known = {*keywords.CheckKeywords.__annotations__}
    left = {other.get(name, name) for name in Options.__struct_fields__} - known
    left -= {*inspect.signature(polarcheck.check).parameters}
    assert left == {"extras", "keywords", "named", "gives_verdicts"}


def test_warnings_are_no_errors_of_a_clean_folder(samples: None) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        polarcheck.check("hexagon.nc")


# ---- the page and the notebook ----


@pytest.mark.ci
@pytest.mark.parametrize(("page", "least"), [("docs/api.md", 20), ("README.md", 4)])
def test_examples_of_the_pages_are_right(page: str, least: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    failed, run = doctest.testfile(
        str(ROOT / page), module_relative=False, optionflags=doctest.NORMALIZE_WHITESPACE, encoding="utf-8"
    )
    assert run >= least
    assert not failed


def test_the_page_names_all_that_is_public() -> None:
    page = (ROOT / "docs" / "api.md").read_text("utf-8")
    for name in (*polarcheck.__all__, *keywords.CheckKeywords.__annotations__, *polarcheck.Trace.__struct_fields__):
        assert re.search(rf"\b{name}\b", page) or name in ("__version__", "file"), name


@pytest.mark.nightly
def test_the_notebook_runs(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(ROOT)
    notebook = json.loads((ROOT / "docs" / "plot_a_section.ipynb").read_text("utf-8"))
    cells = [cell for cell in notebook["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] or cell["execution_count"] for cell in cells)
    names: dict[str, Any] = {}
    for cell in cells:
        exec(compile("".join(cell["source"]), "plot_a_section.ipynb", "exec"), names)  # noqa: S102  our own
    assert len(names["paths"].data) == 2
    assert names["limit"] == 10800.0
    assert capsys.readouterr().out.startswith("line ")
