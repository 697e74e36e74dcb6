"""The verdict is about the file: no option changes it into a pass, and reports say what decided."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any
from unittest import mock
from xml.etree import ElementTree as ET

import jsonschema
import pytest
from cases import looped
from click.testing import CliRunner, Result
from programs import ROOT

from polarcheck.commands import main
from polarcheck.files.batch import tasks as batch
from polarcheck.foundation.finding import Interrupted
from polarcheck.reports import Background, formats, render
from polarcheck.reports.pages import json_schema
from polarcheck.rules.rule import load_all

pytestmark = pytest.mark.usefixtures("own_folder")

SAMPLES = ROOT / "sample_programs"
JOB = (SAMPLES / "polarcheck.toml").read_text("utf-8")
RAPID, GOOD = ((SAMPLES / name).read_text("utf-8") for name in ("rapid_in_polar.nc", "hexagon.nc"))
REASON = "PARAMETER 5431 IS SET"


def make(job: str = JOB, **texts: str) -> None:
    for name, text in {"polarcheck__toml": job, **texts}.items():
        Path(name.replace("__", ".")).write_text(text, "utf-8")


def call(*arguments: str, **environment: str) -> Result:
    return CliRunner().invoke(main, ["check", *arguments], env=environment)


def check(*arguments: str, **environment: str) -> dict[str, Any]:
    result = call(*arguments, "--format", "json", **environment)
    shown: dict[str, Any] = json.loads(result.stdout)
    jsonschema.Draft202012Validator(json_schema.schema("report")).validate(shown)
    return {**shown, "code": result.exit_code}


def deselected(report: dict[str, Any]) -> list[str]:
    (file,) = report["files"]
    return [gap["reason"] for gap in file["not_evaluated"] if gap["rule"] == "deselected"]


# ---- no exit policy, no selection makes a pass ----


@pytest.mark.one_in(12)
@pytest.mark.nightly
@pytest.mark.parametrize(
    ("options", "code"),
    [
        ("--fail-on never", 0),
        ("--fail-on error", 1),
        ("--max-warnings 5", 1),
        ("--fail-on never --max-warnings 0", 0),
        ("--strict", 1),
        ("--severity rapid-in-polar=warning --fail-on error", 0),
        ("--severity rapid-in-polar=warning --max-warnings 0", 1),
        ("--severity rapid-in-polar=warning --max-warnings 1", 0),
        ("--severity rapid-in-polar=warning --fail-on never --max-warnings 0", 1),
    ],
)
def test_what_fails_a_file_does_not_hang_on_the_exit_code(options: str, code: int) -> None:
    make(a__nc=RAPID)
    report = check("a.nc", *options.split())
    assert (report["files"][0]["verdict"], report["code"]) == ("fail", code)
    failed = ET.fromstring(call("a.nc", *options.split(), "--format", "junit").stdout)  # noqa: S314
    assert failed.attrib["failures"] == "1"


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("options", "environment", "line"),
    [
        ("--select polar-never-left", {}, "155 rules were deselected by --select polar-never-left"),
        ("--select polar-never-left,overcut", {}, "154 rules were deselected by --select polar-never-left,overcut"),
        ("", {"POLARCHECK_SELECT": "overcut"}, "155 rules were deselected by POLARCHECK_SELECT=overcut"),
        ("--ignore rapid-in-polar", {}, "rapid-in-polar was deselected by --ignore rapid-in-polar"),
        ("--ignore PS0146", {}, "8 rules were deselected by --ignore PS0146"),
        ("", {"POLARCHECK_IGNORE": "overcut"}, "overcut was deselected by POLARCHECK_IGNORE=overcut"),
        ("--severity overcut=off", {}, "overcut was switched off by --severity overcut=off"),
        ("", {"POLARCHECK_SEVERITY": "overcut=off"}, "overcut was switched off by POLARCHECK_SEVERITY=overcut=off"),
        ("--severity overcut=note", {}, "overcut was lowered to a note by --severity overcut=note"),
        ("--set severities.overcut=off", {}, "overcut was switched off by severities.overcut of --set, which gives no"),
    ],
)  # fmt: skip
def test_a_selection_of_rules_is_no_pass(options: str, environment: dict[str, str], line: str) -> None:
    make(a__nc=GOOD)
    report = check("a.nc", *options.split(), **environment)
    assert (report["files"][0]["verdict"], report["code"]) == ("unverified", 0)
    assert [reason[: len(line)] for reason in deselected(report)] == [line]
    assert check("a.nc", *options.split(), "--strict", **environment)["code"] == 1
    told = call("a.nc", *options.split(), **environment).stdout
    assert told.startswith("not evaluated: ")
    assert told.count("\nsettings: ") == 1


@pytest.mark.ci
@looped(
    "options",
    [
        "--select polar-never-left",
        "--ignore rapid-in-polar",
        "--severity rapid-in-polar=off",
        "--severity rapid-in-polar=note",
    ],
    one_in=2,
)
def test_a_program_with_an_error_does_not_pass_without_its_rule(options: str) -> None:
    make(a__nc=RAPID)
    assert check("a.nc", *options.split())["files"][0]["verdict"] == "unverified"


@pytest.mark.nightly
def test_rules_without_weight_are_no_matter() -> None:
    make(a__nc=GOOD)
    for options in ("--ignore start-up-without-move", "--ignore size-by-x-offset", "--severity overcut=error"):
        assert check("a.nc", *options.split())["files"][0]["verdict"] == "pass"
    groups = dict.fromkeys(rule.group for rule in load_all().values())
    assert check("a.nc", "--select", ",".join(groups))["files"][0]["verdict"] == "pass"


def test_a_program_without_a_polar_section_was_not_looked_at_either() -> None:
    make(a__nc="O1\nG0 X50. Z2.\nG1 X50. X51. F0.2\nM30\n")
    assert check("a.nc")["files"][0]["verdict"] == "fail"
    assert check("a.nc", "--ignore", "word-repeated")["files"][0]["verdict"] == "unverified"


@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("written", "line"),
    [
        (f"ignore = {{ rules = ['rapid-in-polar'], reason = '{REASON}' }}", ""),
        ("ignore = ['rapid-in-polar']", "rapid-in-polar was deselected by ignore of polarcheck.toml, which gives"),
        (f"select = {{ rules = ['overcut'], reason = '{REASON}' }}", ""),
        ("select = ['overcut']", "155 rules were deselected by select of polarcheck.toml, which gives no reason"),
        (f"severities = {{ rapid-in-polar = {{ level = 'off', reason = '{REASON}' }} }}", ""),
        (f"severities = {{ rapid-in-polar = {{ level = 'note', reason = '{REASON}' }} }}", ""),
        ("severities = { rapid-in-polar = 'off' }", "rapid-in-polar was switched off by severities.rapid-in-polar of"),
        ("severities = { polar = 'note' }", " rules were lowered to a note by severities.polar of polarcheck.toml"),
        (f"[[programs]]\nfiles = ['*']\nignore = {{ rules = ['polar'], reason = '{REASON}' }}", ""),
        ("[[programs]]\nfiles = ['*']\nignore = ['rapid-in-polar']", "rapid-in-polar was deselected by ignore of"),
    ],
)  # fmt: skip
def test_a_job_file_keeps_the_pass_with_a_reason(written: str, line: str) -> None:
    make(f"{written}\n{JOB}" if "[[" not in written else f"{JOB}\n{written}\n", a__nc=RAPID)
    report = check("a.nc")
    assert report["files"][0]["verdict"] == ("unverified" if line else "pass")
    assert [line in reason for reason in deselected(report)] == [True] * bool(line)
    assert list(report["settings"]["reasons"].values()) == ([] if line else [REASON])


def test_an_option_that_overrides_a_reason_has_none() -> None:
    make(f"ignore = {{ rules = ['rapid-in-polar'], reason = '{REASON}' }}\n{JOB}", a__nc=RAPID)
    assert check("a.nc", "--select", "rapid-in-polar")["files"][0]["verdict"] == "fail"
    # The rule has no weight here, so that 145 others are left.
    assert deselected(check("a.nc", "--select", "overcut")) == ["154 rules were deselected by --select overcut"]


@pytest.mark.ci
def test_a_nearer_file_takes_the_reason_with_the_value() -> None:
    Path("sub").mkdir()
    make(f"ignore = {{ rules = ['rapid-in-polar'], reason = '{REASON}' }}\n{JOB}")
    for nearer, verdict in (
        ("['rapid-in-polar']", "unverified"),
        (f"{{ rules = ['polar'], reason = '{REASON}' }}", "pass"),
    ):
        Path("sub/polarcheck.toml").write_text(f"extend = '..'\nignore = {nearer}\n", "utf-8")
        Path("sub/a.nc").write_text(RAPID, "utf-8")
        assert check("sub/a.nc")["files"][0]["verdict"] == verdict


@pytest.mark.ci
def test_a_profile_gives_its_reason_as_source() -> None:
    for value, verdict in (("'off'", "unverified"), (f"{{ value = 'off', source = '{REASON}' }}", "pass")):
        make(JOB.replace('"fanuc-30i"', "'our.toml'"), a__nc=RAPID)
        Path("our.toml").write_text(f"inherits = 'fanuc-30i'\n[severities]\nrapid-in-polar = {value}\n", "utf-8")
        report = check("a.nc")
        assert report["files"][0]["verdict"] == verdict
        assert ["our.toml, which gives no source" in line for line in deselected(report)] == [True] * (
            verdict != "pass"
        )


@looped(
    ("written", "told"),
    [
        ("ignore = { rules = ['overcut'] }", "polarcheck.toml:1: ignore.reason is missing"),
        ("ignore = { rules = ['overcut'], reason = ' ' }", "ignore.reason: expected a text that says why, found ' '"),
        ("ignore = { rule = ['overcut'], reason = 'x' }", "unknown key ignore.rule; did you mean rules?"),
        ("ignore = 5", 'ignore: expected a list of names, or { rules = ["..."], reason = "..." }, found 5'),
        ("severities = { overcut = { level = 'of', reason = 'x' } }", "overcut.level: expected error, warning, note"),
        ("severities = { overcut = 'of' }", ', note or off, or { level = "off", reason = "..." }'),
        ("max_warnings = -1", "max_warnings: expected a whole number"),
    ],
)  # fmt: skip
def test_a_wrong_reason_is_one_line(written: str, told: str) -> None:
    make(f"{written}\n{JOB}", a__nc=GOOD)
    result = call("a.nc")
    assert (result.exit_code, result.stdout) == (2, "")
    assert told in result.stderr
    assert result.stderr.count("\n") == 1


# ---- warnings over a run ----


@pytest.mark.nightly
def test_warnings_are_counted_over_the_programs_that_share_the_limit() -> None:
    warned = "severities = { rapid-in-polar = 'warning' }\n"
    for folder, most in (("one", 1), ("two", 2)):
        Path(folder).mkdir()
        for name in ("a.nc", "b.nc"):
            Path(folder, name).write_text(RAPID, "utf-8")
        Path(folder, "polarcheck.toml").write_text(f"max_warnings = {most}\n{warned}{JOB}", "utf-8")
    assert call("two").exit_code == 0
    result = call(".")
    assert result.exit_code == 1
    assert "polarcheck: 2 warnings, more than the 1 of one/polarcheck.toml\n" in result.stderr
    assert "two/polarcheck.toml" not in result.stderr
    assert call(".", "--max-warnings", "4").exit_code == 0
    assert "4 warnings, more than the 3 of --max-warnings" in call(".", "--max-warnings", "3").stderr
    assert "more than the 3 of POLARCHECK_MAX_WARNINGS" in call(".", POLARCHECK_MAX_WARNINGS="3").stderr
    assert call("one", "--max-warnings", "-1").exit_code == 2


# ---- what decided ----


@pytest.mark.nightly
def test_reports_say_what_decided() -> None:
    make(f"strict = true\n{JOB}", a__nc=GOOD)
    settings = check(
        "a.nc", "--ignore", "start-up-without-move", "--set", "limits.c_feed=9000", POLARCHECK_FAIL_ON="error"
    )["settings"]
    assert settings == {
        "machine": "fanuc-30i",
        "changes": ["limits.c_feed=9000"],
        "select": [],
        "ignore": ["start-up-without-move"],
        "severities": {},
        "inline": True,
        "fail_on": "error",
        "max_warnings": None,
        "strict": True,
        "baseline": None,
        "configuration": ["polarcheck.toml"],
        "reasons": {},
        "differing": [],
        "diff_base": None,
        "version": settings["version"],
        "sources": {
            "machine": "polarcheck.toml",
            "changes": "--set",
            "ignore": "--ignore",
            "fail_on": "POLARCHECK_FAIL_ON",
            "strict": "polarcheck.toml",
        },
    }
    told = call("a.nc", "--ignore", "start-up-without-move", POLARCHECK_FAIL_ON="error").stdout
    line = "settings: ignore start-up-without-move (--ignore), fail_on error (POLARCHECK_FAIL_ON), strict true (pol"
    assert [each.startswith(line) for each in told.splitlines() if each.startswith("settings")] == [True]
    assert "settings:" not in call("a.nc", "--no-config", "--tool", "1:radius=4").stdout
    for form in ("short", "github", "sarif"):
        assert (
            line
            in call("a.nc", "--ignore", "start-up-without-move", "--format", form, POLARCHECK_FAIL_ON="error").stdout
        )


@pytest.mark.nightly
def test_files_with_settings_of_their_own_say_them() -> None:
    for folder, more in (("one", ""), ("two", "fail_on = 'never'\n")):
        Path(folder).mkdir()
        Path(folder, "a.nc").write_text(RAPID, "utf-8")
        Path(folder, "polarcheck.toml").write_text(more + JOB, "utf-8")
    report = check(".")
    assert report["settings"]["differing"] == ["fail_on", "configuration", "sources"]
    assert report["settings"]["fail_on"] is None
    assert [file["settings"]["fail_on"] for file in report["files"]] == ["warning", "never"]
    assert [file["settings"]["configuration"] for file in report["files"]] == [
        ["one/polarcheck.toml"],
        ["two/polarcheck.toml"],
    ]
    assert [file["verdict"] for file in report["files"]] == ["fail", "fail"]
    assert "settings: fail_on differs between the files (--format json)\n" in call(".").stdout
    assert "settings" not in check("one")["files"][0]
    lines = [json.loads(line) for line in call(".", "--format", "jsonl").stdout.splitlines()]
    assert [line["settings"]["fail_on"] for line in lines if line["type"] == "file"] == ["warning", "never"]


@pytest.mark.nightly
def test_a_file_and_its_machine_have_a_hash() -> None:
    import hashlib

    make(a__nc=GOOD, b__nc=GOOD, c__nc=RAPID)
    files = check(".")["files"]
    assert [file["sha256"] for file in files] == [
        hashlib.sha256(text.encode()).hexdigest() for text in (GOOD, GOOD, RAPID)
    ]
    (same,) = {file["profile_sha256"] for file in files}
    assert check("a.nc", "--set", "limits.c_feed=9000")["files"][0]["profile_sha256"] != same
    assert check("a.nc", "--ignore", "start-up-without-move")["files"][0]["profile_sha256"] == same


@pytest.mark.nightly
def test_reports_name_the_doubtful_keys_that_they_rest_on() -> None:
    profile = "inherits = 'fanuc-30i'\n[control]\nx = { value = 'diameter', source = 'GUESS', doubtful = true }\n"
    codes = "[m_codes]\nlive_tool_on = { value = ['M133'], source = 'GUESS', doubtful = true }\n"
    Path("our.toml").write_text(profile + codes, "utf-8")
    make(JOB.replace('"fanuc-30i"', "'our.toml'"), a__nc=GOOD, b__nc="O1\nM133\nM30\n", c__nc="O1\nG21\nM30\n")
    doubtful = {file["path"]: set(file["doubtful"]) for file in check(".")["files"]}
    assert {"control.x", "compensation.start_up"} <= doubtful["a.nc"]
    assert "m_codes.live_tool_on" not in doubtful["a.nc"]
    assert doubtful["b.nc"] == {"m_codes.live_tool_on", "control.units"}
    assert doubtful["c.nc"] == set()
    assert "doubtful in our: control.units, m_codes.live_tool_on\n" in call("check", "b.nc").stdout
    Path("our.toml").write_text("inherits = 'siemens-transmit'\n", "utf-8")
    Path("d.mpf").write_text("N1 G54 G71 G94\nN2 M30\n", "utf-8")
    keys = set(check("d.mpf", "--machine", "our.toml")["files"][0]["doubtful"])
    assert {"g_codes.work_offset", "g_code_system_b.mm", "g_code_system_b.feed_per_minute"} <= keys
    assert not any(key.startswith(("polar.", "compensation.", "g_code_system_c.")) for key in keys)
    Path("e.mpf").write_text("T8 D1\nG94 S2=1000 M2=3\nG0 X30 C0 Z5\nTRANSMIT\nG1 X20 F300\nTRAFOOF\nM30\n", "utf-8")
    assert "control.x_without_words (parameter 20150[28])" in call("check", "e.mpf", "--machine", "our.toml").stdout
    (of_diameters,) = check("e.mpf", "--machine", "siemens-transmit", "--set", "control.x=diameter")["files"]
    assert not {"control.x", "control.x_without_words"} & set(of_diameters["doubtful"])


# ---- what could not be read or checked ----


def broken() -> None:
    """a.nc is good, b.nc a link to nowhere, c.nc a folder."""
    make(a__nc=GOOD)
    os.symlink("nowhere", "b.nc")  # noqa: PTH211
    Path("c.nc").mkdir()


@pytest.mark.ci
@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
def test_a_link_to_nowhere_is_a_file_that_did_not_pass() -> None:
    broken()
    report = check("a.nc", "b.nc")
    assert report["code"] == 2
    counts = report["summary"]
    assert (counts["files"], counts["pass"], counts["unreadable"]) == (2, 1, 1)
    assert (report["files"][1]["verdict"], report["files"][1]["reason"]) == ("unreadable", "No such file or directory")
    assert report["files"][1]["sha256"] is None
    assert check(".")["summary"]["unreadable"] == 1


@pytest.mark.one_in(12)
@pytest.mark.skipif(os.name == "nt", reason="links need rights there")
@pytest.mark.parametrize(
    ("form", "shown"),
    [
        ("text", "unreadable  b.nc: No such file or directory\n"),
        ("text", "1 of 2 files checked for fanuc-30i: 1 unreadable, 1 pass; no findings\n"),
        ("short", "b.nc:1:1: error: No such file or directory [unreadable]\n\n1 of 2 files"),
        ("concise", "b.nc:1:1: error: No such file or directory [unreadable]\n"),
        ("json", '"verdict": "unreadable",\n      "reason": "No such file or directory"'),
        ("jsonl", '"verdict":"unreadable","reason":"No such file or directory"'),
        ("sarif", '"text": "b.nc: No such file or directory"'),
        ("sarif", '"executionSuccessful": false'),
        ("github", "::error title=unreadable,file=b.nc::b.nc: No such file or directory\n"),
        ("gitlab", '"check_name": "unreadable"'),
        ("junit", '<error type="unreadable" message="No such file or directory">'),
        ("checkstyle", 'message="No such file or directory" source="polarcheck.unreadable"/>'),
    ],
)
def test_every_report_names_what_could_not_be_read(form: str, shown: str) -> None:
    broken()
    result = call("a.nc", "b.nc", "--format", form)
    assert result.exit_code == 2
    assert shown in result.stdout


def test_pages_name_what_could_not_be_read() -> None:
    make(a__nc=GOOD)
    assert call("a.nc", "gone.nc", "-o", "html:pages").exit_code == 2
    index = Path("pages/index.html").read_text("utf-8")
    assert "<tr><td>gone.nc</td>" in index
    assert "No such file or directory" in index
    assert call("gone.nc", "-o", "html:one.html").exit_code == 2
    assert "No such file or directory" in Path("one.html").read_text("utf-8")


@pytest.mark.ci
def test_folders_and_what_takes_too_much_are_named_as_well() -> None:
    make(a__nc=GOOD, b__nc=GOOD + "(MORE)\n" * 200)
    report = check("a.nc", "b.nc", "--max-size", str(len(GOOD)))
    assert [file["verdict"] for file in report["files"]] == ["pass", "unreadable"]
    assert report["files"][1]["reason"].startswith("larger than")
    Path("locked").mkdir()
    scan = os.scandir

    def refused(path: str = ".") -> Any:
        if str(path).endswith("locked"):
            raise PermissionError(13, "Permission denied", path)
        return scan(path)

    with mock.patch("os.scandir", refused):
        report = check(".")
    assert [(file["path"], file["verdict"]) for file in report["files"]][2:] == [("locked", "unreadable")]
    assert (report["code"], report["files"][2]["reason"]) == (2, "Permission denied")


def test_a_bug_and_a_lost_worker_leave_a_file_that_did_not_pass(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=GOOD)
    from polarcheck.files.batch import executors
    from polarcheck.files.settings.of_programs import OfPrograms, Options

    tasks = batch.plan(["a.nc"], OfPrograms(Options()), (), pytest.fail, pytest.fail)
    lost = executors._Schedule(tasks, mock.Mock(), 1)._lost(0)
    assert lost.report is not None
    assert (lost.report.verdict, lost.report.reason) == ("unreadable", "could not be checked: its process ended")

    def fault(*given: object) -> None:
        raise ZeroDivisionError("a fault")

    monkeypatch.setattr(batch.check, "check_runs", fault)
    report = check("a.nc")
    assert report["code"] == 3
    assert report["files"][0]["reason"] == "a fault of polarcheck: ZeroDivisionError: a fault"
    monkeypatch.setattr(batch.check, "check_runs", mock.Mock(side_effect=MemoryError))
    assert check("a.nc")["files"][0]["reason"] == "there is not enough memory to check it"


@pytest.mark.one_in(12)
@pytest.mark.parametrize("form", [form for form in formats() if form not in ("concise", "html")])
def test_every_report_says_that_the_run_was_interrupted(form: str) -> None:
    make(a__nc=GOOD, b__nc=GOOD, c__nc=GOOD)
    outcome = batch.outcome
    reason = "interrupted after 1 of 3 files; these are reported"

    def interrupted(task: batch.Task, *given: Any) -> batch.Outcome:
        if task.path == "b.nc":
            raise KeyboardInterrupt
        return outcome(task, *given)

    with mock.patch.object(batch, "outcome", interrupted):
        result = call("a.nc", "b.nc", "c.nc", "--format", form, "--jobs", "1", "--no-cache")
    assert result.exit_code == 130
    assert reason in result.stderr
    assert reason in result.stdout if form not in ("text", "short") else "1 of 3 files checked" in result.stdout
    if form == "json":
        shown = json.loads(result.stdout)
        assert shown["interrupted"] == {"reason": reason, "checked": 1, "planned": 3, "next_path": "b.nc"}
        jsonschema.Draft202012Validator(json_schema.schema("report")).validate(shown)


def test_an_interruption_before_the_first_file_has_a_place() -> None:
    cut = Interrupted(reason="stopped", checked=0, planned=1)
    report = batch.report([], "fanuc", interrupted=cut)
    assert json.loads(render("gitlab", report, Background()))[0]["location"]["path"] == "."
    assert '<file name=".">' in render("checkstyle", report, Background())
