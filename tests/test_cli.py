"""The commands: what they print where, and the exit code."""

from __future__ import annotations

import json
import os
import re
import shlex
import signal
import subprocess
import sys
from functools import partial
from pathlib import Path
from typing import Any

import click
import jsonschema
import msgspec
import pytest
from cases import looped
from click.testing import CliRunner, Result
from programs import ROOT

import polarcheck
from polarcheck.commands import main
from polarcheck.files.batch import tasks as batch
from polarcheck.program.machines import profiles
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.profiles import names
from polarcheck.reports.pages import json_schema
from polarcheck.rules.rule import load_all

#: What processes import is what these tests import, wherever they run.
IMPORTED_FROM = os.fspath(Path(polarcheck.__file__).parent.parent)
RAPID = "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5.\nG1 C-5.\nG13.1\n"
GOOD = RAPID.replace("G0 C5.", "C5.")
COMPENSATED = "T0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG40 X60.\nG13.1\n"
RAPID_ONLY = ("--select", "rapid-in-polar")
RAMP_ONLY = ("--select", "start-up-shorter-than-radius")

pytestmark = pytest.mark.usefixtures("own_folder")


def make(**texts: str) -> None:
    """Files by name, `__` for the point."""
    for name, text in texts.items():
        Path(name.replace("__", ".")).write_text(text, "utf-8", newline="")


def call(*arguments: Any, given: str | None = None, **environment: str) -> Result:
    return CliRunner().invoke(main, [str(argument) for argument in arguments], input=given, env=environment)


def check(*arguments: Any, **options: Any) -> Result:
    return call("check", *arguments, **options)


def findings(*arguments: Any, **options: Any) -> list[tuple[str, str]]:
    """Rule and severity of all findings."""
    shown = json.loads(check(*arguments, "--format", "json", **options).stdout)
    return [(found["rule"], found["severity"]) for file in shown["files"] for found in file["findings"]]


def process(*arguments: str, **options: Any) -> subprocess.Popen[str]:
    environment = {**os.environ, "PYTHONPATH": IMPORTED_FROM, "PYTHONUTF8": "1"}
    command = [sys.executable, "-m", "polarcheck", *arguments]
    pipes = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **options}
    return subprocess.Popen(command, env=environment, text=True, encoding="utf-8", **pipes)


# ---- exit codes ----


def test_findings_fail() -> None:
    make(a__nc=RAPID)
    result = check("a.nc", *RAPID_ONLY)
    assert result.exit_code == 1
    assert "at   a.nc:4:1\n" in result.stdout
    assert "2 | G12.1\n" in result.stdout
    assert "4 | G0 C5.\n       | ^^\n" in result.stdout
    assert result.stderr == ""


def test_a_good_program_passes() -> None:
    make(a__nc=GOOD)
    result = check("a.nc")
    assert (result.exit_code, result.stderr) == (0, "")
    assert result.stdout.startswith("pass  a.nc: no findings, 1 polar section, 6 blocks\n")


@pytest.mark.ci
@looped(
    ("severity", "fail_on", "code"),
    [
        ("error", "error", 1),
        ("error", "never", 0),
        ("warning", "error", 0),
        ("warning", "warning", 1),
        ("note", "warning", 0),
        ("note", "note", 1),
        ("off", "note", 0),
    ],
)
def test_the_least_severity_that_fails_can_be_chosen(severity: str, fail_on: str, code: int) -> None:
    make(a__nc=RAPID)
    result = check("a.nc", *RAPID_ONLY, "--severity", f"rapid-in-polar={severity}", "--fail-on", fail_on)
    assert result.exit_code == code
    # The verdict is about the file, and does not change with what fails the check.
    verdict = "fail" if severity in ("error", "warning") else "unverified|pass"
    assert re.search(rf"^(?:{verdict})  ", result.stdout, re.MULTILINE)


def test_what_is_not_evaluated_fails_only_where_that_is_asked_for() -> None:
    make(a__nc=COMPENSATED)
    result = check("a.nc", *RAMP_ONLY)
    assert result.exit_code == 0
    assert "not evaluated: no radius for T0101" in result.stdout
    assert "unverified  a.nc: no findings" in result.stdout
    assert check("a.nc", *RAMP_ONLY, "--strict").exit_code == 1
    told = check("a.nc", *RAMP_ONLY, "--strict", "--tool", "1:radius=4").stdout
    assert re.findall("not evaluated: .*", told) == [
        "not evaluated: 156 rules were deselected by --select start-up-shorter-than-radius"
    ]


@pytest.mark.nightly
def test_the_offset_table_of_a_job_is_no_program_of_its_folder() -> None:
    table = "%\nG10 P1 R4.\n%\n"
    make(a__nc=GOOD, TOOLOFST__TXT=table, other__txt=table, O0002__nc=table)
    make(polarcheck__toml="offsets = 'TOOLOFST.TXT'\n")
    checked = json.loads(check(".", "--format", "json").stdout)["files"]
    assert [file["path"] for file in checked] == ["O0002.nc", "a.nc", "other.txt"]
    for named in ((".", "TOOLOFST.TXT"), ("TOOLOFST.TXT", ".")):
        assert json.loads(check(*named, "--format", "json").stdout)["summary"]["files"] == 4
    make(polarcheck__toml="offsets = 'O0002.nc'\n")
    assert json.loads(check(".", "--format", "json").stdout)["summary"]["files"] == 4


def test_an_unreadable_file_does_not_stop_the_others() -> None:
    make(a__nc=RAPID, b__nc=GOOD)
    result = check("a.nc", "gone\x1b[2J.nc", "b.nc", *RAPID_ONLY, "--format", "json")
    assert result.exit_code == 2
    assert result.stderr == "polarcheck: gone\\x1b[2J.nc: No such file or directory\n"
    shown = json.loads(result.stdout)
    assert [(file["path"], file["verdict"]) for file in shown["files"]][1] == ("gone\x1b[2J.nc", "unreadable")
    assert shown["files"][1]["reason"] == "No such file or directory"
    assert (shown["summary"]["files"], shown["summary"]["unreadable"]) == (3, 1)


def test_bytes_that_are_not_of_the_encoding_asked_for_are_told() -> None:
    Path("a.nc").write_bytes(b"G0 (\xff)\n")
    result = check("a.nc", "--encoding", "utf-8")
    assert result.exit_code == 2
    assert result.stderr == "polarcheck: a.nc: byte 4 is not utf-8\n"
    assert check("a.nc", "--encoding", "cp1252", *RAPID_ONLY).exit_code == 0


@pytest.mark.ci
def test_a_bug_is_no_finding(monkeypatch: pytest.MonkeyPatch) -> None:
    make(a__nc=GOOD)
    broken = msgspec.structs.replace(load_all()["rapid-in-polar"], function=lambda *tables: 1 / 0)
    monkeypatch.setitem(load_all(), "rapid-in-polar", broken)
    result = check("a.nc")
    assert result.exit_code == 3
    assert result.stdout.startswith("unreadable  a.nc: a fault of polarcheck: ZeroDivisionError: division by zero\n")
    assert result.stderr == (
        "polarcheck: internal error: ZeroDivisionError: division by zero, while checking a.nc; "
        "run with --debug for the traceback\n"
    )
    for arguments in (["check", "--debug", "a.nc"], ["--debug", "check", "a.nc"]):
        traced = call(*arguments)
        assert traced.exit_code == 3
        assert "Traceback (most recent call last)" in traced.stderr
        assert "in _check\n" in traced.stderr


def test_an_interrupt_has_its_own_code(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*given: Any, **named: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(batch, "plan", interrupted)
    result = check("a.nc")
    assert result.exit_code == 130
    assert "internal" not in result.stderr


@pytest.mark.ci
@pytest.mark.skipif(os.name == "nt", reason="other signals there")
def test_an_interrupted_process_says_so_in_a_word() -> None:
    # A shell that starts something in the background has it ignore the interrupt, which is inherited.
    heed = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)
    running = process("check", "-", stdin=subprocess.PIPE, preexec_fn=heed)
    assert running.stdin is not None
    # More than a pipe holds: once it is written, the process is reading, and without an end it waits for more.
    running.stdin.write(GOOD + "\n" * 2**20)
    running.stdin.flush()
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=120)
    assert running.returncode == 130
    assert "Traceback" not in told


@pytest.mark.ci
def test_a_reader_who_goes_away_changes_no_exit_code() -> None:
    make(a__nc=RAPID, b__nc=GOOD)
    for name, code in (("a.nc", 1), ("b.nc", 0)):
        running = process("check", name, *RAPID_ONLY)
        assert running.stdout is not None
        running.stdout.close()
        assert running.stderr is not None
        assert running.stderr.read() == ""
        assert running.wait(120) == code
        running.stderr.close()


# ---- what cannot be understood ----


@pytest.mark.ci
@looped(
    ("arguments", "told"),
    [
        (["--slect", "x"], "No such option"),
        (["--fail-on", "fatal"], "'fatal' is not one of 'error', 'warning', 'note', 'never'"),
        (["--format", "xml"], "'xml' is not one of"),
        (["--select", "rapid-in-poler"], "--select: unknown rule 'rapid-in-poler'; did you mean rapid-in-polar?"),
        (["--ignore", "poler"], "--ignore: unknown rule 'poler'; did you mean polar?"),
        (["--select", "PS9999"], "--select: no rule is known to give alarm PS9999 on FANUC lathe control"),
        (["--select", "polar", "--ignore", "polar"], "no rule is left to check"),
        (["--severity", "rapid-in-polar"], "--severity rapid-in-polar: expected RULE=error|warning|note|off"),
        (["--severity", "rapid-in-polar=fatal"], "expected RULE=error|warning|note|off"),
        (["--severity", "x-y=off"], "--severity: unknown rule 'x-y'"),
        (["--machine", "fanuk"], "unknown machine 'fanuk'; did you mean fanuc?"),
        (["--machine", "mine.toml"], "machine mine.toml: no such file"),
        (["--set", "limits.c_fed=3"], "unknown key limits.c_fed; did you mean c_feed?"),
        (["--set", "limits.c_feed=fast"], "limits.c_feed"),
        (["--set", "c_feed=3"], "--set c_feed=3: expected TABLE.KEY=VALUE as in limits.c_feed=3600"),
        (["--set", "limits.c_feed"], "expected TABLE.KEY=VALUE"),
        (["--tool", "radius=3"], "--tool radius=3: expected NUMBER:KEY=VALUE as in 8:radius=0.375"),
        (["--tool", "8:radus=3"], "--tool 8:radus=3: radus: did you mean radius?"),
        (["--tool", "8:radius=big"], "--tool 8:radius=big: radius: expected a number from -1000 to 1000, found 'big'"),
        (["--tool", "1:radius=4,0"], "--tool 1:radius=4,0: radius: write 4.0, with a decimal point"),
        (["--tool", "8:nose=0,radius=,375"], "radius: write .375, with a decimal point"),
        (["--tool", "8:radius=4,5,nose=0"], "radius: write 4.5, with a decimal point"),
        (["--tool", "T0808:radius=4"], "expected the offset number alone, as in 8:radius=0.375"),
        (["--tool", "-1:radius=4"], "--tool -1:radius=4: expected NUMBER:KEY=VALUE"),
        (["--tool", "0:radius=4"], "--tool 0:radius=4: expected the number of a tool offset, 8 for T0808, found 0"),
        (["--tool", "8:radius=nan"], "radius: expected a number from -1000 to 1000, found nan"),
        (["--tool", "8:diameter=inf"], "diameter: expected a number above 0, 2000 at most, found inf"),
        (["--tool", "8:radius=1e308"], "radius: expected a number from -1000 to 1000, found 1e+308"),
        (["--tool", "8:nose=12"], "nose: expected a whole number from 0 to 9, found 12"),
        (["--tool", "8:mount=foo"], "mount: expected axial or radial, found 'foo'"),
        (["--offsets", "big.txt"], "big.txt:1: offset 8: radius: expected a number from -1000 to 1000, found 1e+30"),
        (["--offsets", "nose.txt"], "nose.txt:1: offset 8: nose: expected a whole number from 0 to 9, found 12"),
        (["--set", "limits.c_feed=-5"], "--set: limits.c_feed: expected a number above 0, found -5"),
        (["--set", "limits.c_feed=nan"], "--set: limits.c_feed: expected a number above 0, found nan"),
        (["--set", "limits.z_maximum=inf"], "--set: limits.z_maximum: expected a number, found inf"),
        (
            ["--set", "severities.rapid=off"],
            "--set: severities.rapid: unknown rule 'rapid'; did you mean "
            "rapid-along-contour, rapid-plunge-into-stock or rapid-through-part?",
        ),
        (["--machine", "haas"], "unknown machine 'haas'; did you mean haas-lathe?"),
        (["--subprograms", "gone"], "'gone' does not exist"),
        (["--subprograms", "a.nc"], "'a.nc' is a file"),
        (["--max-seconds", "nan"], "'--max-seconds': expected a number above 0, found nan"),
        (["--max-seconds", "inf"], "'--max-seconds': expected a number above 0, found inf"),
        (["--offsets", "gone.txt"], "'gone.txt' does not exist"),
        (["--offsets", "a.nc"], "a.nc: no offsets found"),
        (["--config", "gone.toml"], "'gone.toml' does not exist"),
        (["--encoding", "utf-99"], "unknown encoding 'utf-99'"),
        (["--output", "report.json"], "'report.json': expected FORMAT:FILE"),
        (["--output", "xml:a.xml"], "expected FORMAT:FILE, the format one of text, short, concise, checkstyle"),
        (["--units", "cm"], "'cm' is not one of 'mm', 'inch'"),
    ],
    one_in=2,
)
def test_what_means_nothing_is_named_in_one_line(arguments: list[str], told: str) -> None:
    make(a__nc=GOOD, big__txt=f"G10 P10008 R1{'0' * 30}. Q0\n", nose__txt="G10 P10008 R4. Q12\n")
    result = check("a.nc", *arguments)
    assert result.exit_code == 2
    assert result.stdout == ""
    assert result.stderr.startswith("polarcheck: ")
    assert result.stderr.count("\n") == 1
    assert told in result.stderr


@pytest.mark.ci
@looped(
    ("text", "told"),
    [
        ("machin = 'x'\n", "polarcheck.toml:1: unknown key machin; did you mean machine?"),
        ("x =\n", "polarcheck.toml:1: Invalid value"),
        ("[tools.8]\nradius = 'big'\n", "polarcheck.toml:2: tools.8.radius: expected a number"),
        ("machine = 'fanuk'\n", "unknown machine 'fanuk'"),
        ("select = ['poler']\n", "polarcheck.toml:1: select: unknown rule 'poler'"),
        ("ignore = ['poler']\n", "polarcheck.toml:1: ignore: unknown rule 'poler'"),
        ("severities = { poler = 'off' }\n", "polarcheck.toml:1: severities: unknown rule 'poler'"),
        ("[limits]\nc_fed = 3\n", "unknown key limits.c_fed"),
        ("offsets = 'gone.txt'\n", "gone.txt: No such file"),
        (
            "select = ['rapid']\n",
            "polarcheck.toml:1: select: unknown rule 'rapid'; did you mean "
            "rapid-along-contour, rapid-plunge-into-stock or rapid-through-part?",
        ),
        ("tools = 3\n", "polarcheck.toml:1: tools: expected a table, found 3"),
        ("[tools.-1]\nradius = 4\n", "tools.-1: expected the number of a tool offset, 8 for T0808, found -1"),
        ("[tools.T1]\nradius = 4\n", "tools.T1: expected the number of a tool offset, 8 for T0808, found T1"),
        ("[tools.8]\nradus = 4\n", "polarcheck.toml:2: unknown key tools.8.radus; did you mean radius?"),
        (
            "[tools.8]\nradius = '4,5'\n",
            "tools.8.radius: expected a number from -1000 to 1000, found '4,5'; write 4.5,",
        ),
        ("[tools.8]\nradius = nan\n", "tools.8.radius: expected a number from -1000 to 1000, found nan"),
        ("[tools.8]\nmount = 'foo'\n", "polarcheck.toml:2: tools.8.mount: expected axial or radial, found 'foo'"),
        (
            "[work_offsets.G77]\nx = 1\n",
            'polarcheck.toml:1: work_offsets.G77: expected G54 to G59 or "G54.1 P1", found G77',
        ),
        ("[work_offsets.'G55 P1']\nx = 1\n", "work_offsets.G55 P1: expected G54 to G59 or"),
        ("[work_offsets.G54]\nx = inf\n", "work_offsets.G54.x: expected a number from -20000 to 20000, found inf"),
        ("[run]\nsubprograms = ['gone']\n", "polarcheck.toml:2: run.subprograms: there is no folder 'gone'"),
        ("[run]\nsubprograms = 'gone'\n", "run.subprograms: expected a list of texts, found 'gone'"),
        ("[run]\nmax_blocks = 0\n", "run.max_blocks: expected a whole number from 1 to 1e+12, found 0"),
        (f"[tools.8]\nradius = {'9' * 18}\n", "tools.8.radius: expected a number from -1000 to 1000, found 9999"),
        (f"[tools.8]\nradius = {'9' * 400}\n", "tools.8.radius: a whole number has at most 18 digits"),
        (
            "[stock]\ndiameter = 1979-05-27\n",
            "stock.diameter: expected a number above 0, 20000 at most, found 1979-05-27",
        ),
        ("[run]\nmax_seconds = inf\n", "run.max_seconds: expected a number above 0, found inf"),
        ("[run.variables]\n'#100' = 1\n", "run.variables.#100: expected the number of a variable, 100 for #100"),
        ("[run.variables]\n100 = nan\n", "run.variables.100: expected a number, found nan"),
        ("[stock]\ndiameter = inf\n", "stock.diameter: expected a number above 0, 20000 at most, found inf"),
        ("[stock]\nclearance = -2\n", "stock.clearance: expected a number from 0 to 20000, found -2"),
        ("units = 'cm'\n", "polarcheck.toml:1: units: expected mm or inch, found 'cm'"),
        ("[limits]\nc_feed = -5\n", "polarcheck.toml:2: limits.c_feed: expected a number above 0, found -5"),
        ("[limits]\nc_feed = 'fast'\n", "polarcheck.toml:2: limits.c_feed: expected a number"),
    ],
    one_in=6,
)
def test_a_broken_job_file_is_named_with_its_key(text: str, told: str) -> None:
    make(a__nc=GOOD, polarcheck__toml=text)
    result = check("a.nc")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr.count("\n") == 1
    assert told in result.stderr
    assert check("a.nc", "--no-config", *RAPID_ONLY).exit_code == 0


def test_a_work_offset_is_one_of_the_machine() -> None:
    make(a__nc=GOOD, polarcheck__toml="[work_offsets]\nG59.x = 1\n'G54.1 P3'.x = 2\n'g54.1 P48'.x = 3\n")
    assert check("a.nc", *RAPID_ONLY).exit_code == 0
    make(mine__toml="inherits = 'fanuc'\n[g_codes]\nwork_offset = ['G54-G58']\nwork_offset_extended = []\n")
    result = check("a.nc", *RAPID_ONLY, "--machine", "mine.toml")
    assert result.stderr == "polarcheck: polarcheck.toml:2: work_offsets.G59: expected G54 to G58, found G59\n"


@looped("number", ["1", "T1", "t01"])
def test_a_tool_is_given_by_its_offset_number(number: str) -> None:
    make(a__nc=COMPENSATED)
    assert findings("a.nc", *RAMP_ONLY, "--tool", f"{number}:radius=15") == [("start-up-shorter-than-radius", "error")]


@pytest.mark.ci
@looped("radius", ["-.005", "0", "+.0001", "-4."])
def test_tiny_and_negative_radii_are_sound(radius: str) -> None:
    make(a__nc=COMPENSATED, polarcheck__toml=f"[tools.1]\nradius = {float(radius)}\n")
    assert check("a.nc", *RAMP_ONLY).exit_code == 0
    assert check("a.nc", *RAMP_ONLY, "--tool", f"1:radius={radius}", "--no-config").exit_code == 0


def test_a_job_that_is_no_table_is_told() -> None:
    make(a__nc=GOOD, pyproject__toml="[tool]\npolarcheck = 3\n# [tool.polarcheck]\n")
    result = check("a.nc")
    assert (result.exit_code, result.stderr) == (
        2,
        "polarcheck: pyproject.toml: tool.polarcheck: expected a table, found 3\n",
    )


@looped("arguments", [["a.nc"], ["gone.nc", "--machine", "fanuc"], ["."], ["-"], ["O1234"]])
def test_a_program_in_the_place_of_a_command_means_check(arguments: list[str]) -> None:
    make(a__nc=GOOD, O1234=GOOD)
    result = call(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    meant = f"did you mean `polarcheck check {' '.join(arguments)}`?"
    assert result.stderr == f"polarcheck: {arguments[0]} is no command; {meant}\n"
    assert "did you mean" not in call("chck").stderr


def test_without_a_command_or_a_path_something_is_missing() -> None:
    assert call().exit_code == 2
    assert "Usage: " in call().stderr
    result = check()
    assert (result.exit_code, result.stderr) == (2, "polarcheck: Missing argument 'PATH...'.\n")


# ---- paths ----


def test_folders_files_and_standard_input_are_checked_in_order_and_once() -> None:
    Path("sub").mkdir()
    make(b__nc=GOOD, a__nc=GOOD)
    Path("sub/O0001").write_text(RAPID, "utf-8")
    result = check("-", "sub", "b.nc", ".", *RAPID_ONLY, "--format", "json", given=RAPID)
    shown = json.loads(result.stdout)
    assert [file["path"] for file in shown["files"]] == ["-", "sub/O0001", "b.nc", "a.nc"]
    assert [file["verdict"] for file in shown["files"]] == ["fail", "fail", "unverified", "unverified"]
    assert shown["summary"] == {
        "files": 4,
        "errors": 2,
        "warnings": 0,
        "notes": 0,
        "silenced": 0,
        "pass": 0,
        "unverified": 2,
        "fail": 2,
        "unreadable": 0,
        "not_read": [],
        "excluded": 0,
    }


def test_a_folder_without_programs_is_a_warning() -> None:
    make(readme__md="")
    result = check(".")
    assert (result.exit_code, result.stdout) == (0, "")
    assert result.stderr.startswith("polarcheck: warning: .: no NC programs in this folder")
    assert json.loads(check(".", "--format", "json").stdout)["files"] == []


def test_extensions_are_those_asked_for() -> None:
    make(a__lst=GOOD, b__nc=GOOD, c__p3=GOOD, polarcheck__toml="extensions = ['p3']\n")
    result = check(".", *RAPID_ONLY, "--format", "json")
    assert [file["path"] for file in json.loads(result.stdout)["files"]] == ["c.p3"]
    result = check(".", *RAPID_ONLY, "--extensions", "LST,.p3", "--format", "json")
    assert [file["path"] for file in json.loads(result.stdout)["files"]] == ["a.lst", "c.p3"]
    assert check("b.nc", "--extensions", "lst", *RAPID_ONLY).stdout.count("unverified  b.nc") == 1


# ---- the job and the machine ----


@pytest.mark.ci
def test_the_nearest_job_applies_and_the_command_line_beats_it() -> None:
    make(a__nc=COMPENSATED, polarcheck__toml="tools.1.radius = 15\n")
    Path("sub").mkdir()
    Path("sub/polarcheck.toml").write_text("tools.1.radius = 4\n", "utf-8")
    Path("sub/b.nc").write_text(COMPENSATED, "utf-8")
    ramp = ("start-up-shorter-than-radius", "error")
    assert findings("a.nc", "sub/b.nc", *RAMP_ONLY) == [ramp]
    assert findings("a.nc", "sub/b.nc", *RAMP_ONLY, "--tool", "1:radius=4") == []
    assert findings("a.nc", "sub/b.nc", *RAMP_ONLY, "--tool", "1:radius=15") == [ramp, ramp]
    assert findings("a.nc", "sub/b.nc", *RAMP_ONLY, "--config", "sub/polarcheck.toml") == []
    assert findings("-", *RAMP_ONLY, given=COMPENSATED) == [ramp]
    assert "no radius for T0101" in check("a.nc", *RAMP_ONLY, "--no-config").stdout


def test_an_offset_table_of_the_control_gives_radii() -> None:
    make(a__nc=COMPENSATED, offsets__txt="%\nG10 P10001 X0 Z0 R15. Q0\n%\n")
    assert findings("a.nc", *RAMP_ONLY, "--offsets", "offsets.txt") == [("start-up-shorter-than-radius", "error")]
    assert findings("a.nc", *RAMP_ONLY, "--offsets", "offsets.txt", "--tool", "1:radius=4") == []


@pytest.mark.ci
def test_rules_and_severities_come_from_the_job_unless_the_command_line_names_others() -> None:
    make(a__nc=RAPID, polarcheck__toml="select = ['rapid-in-polar']\nseverities = { polar = 'note' }\n")
    assert findings("a.nc") == [("rapid-in-polar", "note")]
    assert findings("a.nc", "--severity", "rapid-in-polar=warning") == [("rapid-in-polar", "warning")]
    assert findings("a.nc", "--select", "bad-number") == []
    make(polarcheck__toml="select = ['rapid-in-polar', 'bad-number']\nignore = ['rapid-in-polar']\n")
    assert findings("a.nc") == []
    assert findings("a.nc", *RAPID_ONLY) == [("rapid-in-polar", "error")]


@pytest.mark.ci
@looped("names", ["rapid-in-polar", "RAPID_IN_POLAR", "PS0146", "146"])
def test_rules_are_selected_by_name_group_and_alarm(names: str) -> None:
    make(a__nc=RAPID)
    assert ("rapid-in-polar", "error") in findings("a.nc", "--select", names)
    assert findings("a.nc", "--select", "rapid-in-polar,bad-number", "--ignore", names) == []


def test_a_rule_selected_by_name_is_not_switched_off_by_a_profile() -> None:
    make(a__nc=RAPID, mine__toml="inherits = 'fanuc'\n[severities]\nrapid-in-polar = 'off'\n")
    make(polarcheck__toml="select = ['rapid-in-polar', 'bad-number']\n")
    assert findings("a.nc", "--machine", "mine.toml") == []
    assert findings("a.nc", "--machine", "mine.toml", *RAPID_ONLY) == [("rapid-in-polar", "error")]
    assert findings("a.nc", "--machine", "mine.toml", *RAPID_ONLY, "--severity", "rapid-in-polar=off") == []


def test_limits_of_the_command_line_beat_the_job_which_beats_the_machine() -> None:
    fast = "G98 G0 X60. C0\nG12.1\nG1 X4. C5. F100\nC-5. F500\nG13.1\n"
    make(
        a__nc=fast,
        polarcheck__toml="machine = 'mine.toml'\n",
        mine__toml="inherits = 'fanuc'\n[limits]\nc_feed = 3600\n",
    )
    only = ("--select", "c-feed-above-limit")
    rules = [("c-feed-above-limit", "error")]
    assert findings("a.nc", *only) == rules
    make(polarcheck__toml="machine = 'mine.toml'\n[limits]\nc_feed = 90000\n")
    assert findings("a.nc", *only) == []
    assert findings("a.nc", *only, "--set", "limits.c_feed=3600") == rules


def test_the_machine_of_a_job_lies_beside_it_and_the_report_names_it() -> None:
    Path("sub").mkdir()
    Path("sub/a.nc").write_text(GOOD, "utf-8")
    Path("sub/polarcheck.toml").write_text("machine = 'mine.toml'\n", "utf-8")
    Path("sub/mine.toml").write_text("inherits = 'fanuc-30i'\n", "utf-8")
    only = (*RAPID_ONLY, "--format", "json")
    for path in ("sub/a.nc", "sub"):
        shown = json.loads(check(path, *only).stdout)
        (file,) = shown["files"]
        named = shown["machine"], file["machine"], file["machine_file"]
        assert named == ("mine", "mine", str(Path("sub/mine.toml")))
    asked = check("sub", "--machine", "fanuc-16i", *only)
    assert json.loads(asked.stdout)["machine"] == "fanuc-16i"


@pytest.mark.ci
def test_each_file_has_its_machine_where_the_jobs_name_several() -> None:
    machines = {"one": "fanuc-16i", "two": "fanuc-30i"}
    for folder, machine in machines.items():
        Path(folder).mkdir()
        Path(folder, "a.nc").write_text(GOOD, "utf-8")
        Path(folder, "polarcheck.toml").write_text(f"machine = '{machine}'\n", "utf-8")
    shown = json.loads(check(*machines, *RAPID_ONLY, "--format", "json").stdout)
    assert shown["machine"] is None
    assert [file["machine"] for file in shown["files"]] == ["fanuc-16i", "fanuc-30i"]
    told = check(*machines, *RAPID_ONLY).stdout
    assert "unverified  one/a.nc: no findings, 1 polar section, 6 blocks, for fanuc-16i\n" in told
    assert told.endswith("\n2 files checked for 2 machines: 2 unverified; no findings\n")
    # One that could not be read was judged for no machine.
    assert json.loads(check("one", "gone.nc", *RAPID_ONLY, "--format", "json").stdout)["machine"] == "fanuc-16i"
    asked = check(*machines, *RAPID_ONLY, "--machine", "mitsubishi-m700")
    assert asked.stdout.endswith("\n2 files checked for mitsubishi-m700: 2 unverified; no findings\n")


@pytest.mark.ci
def test_units_are_those_of_programs_that_do_not_say() -> None:
    inch = "G98 G0 X2. C0\nG12.1\nG1 X.2 C.2 F5.\nC-.2\nG13.1\n"
    make(a__nc=inch)
    only = ("--select", "c-feed-above-limit", "--set", "limits.c_feed=1000")
    assert findings("a.nc", *only, "--units", "inch") == findings("a.nc", *only, "--units", "mm")
    messages = {
        unit: json.loads(check("a.nc", *only, "--set", "limits.c_feed=100", "--units", unit, "--format", "json").stdout)
        for unit in ("inch", "mm")
    }
    assert "inch" in str(messages["inch"]["files"][0]["findings"])
    assert "inch" not in str(messages["mm"]["files"][0]["findings"])


# ---- output ----


def test_reports_go_to_files_beside_the_one_on_standard_output() -> None:
    make(a__nc=RAPID)
    result = check("a.nc", *RAPID_ONLY, "-o", "json:out.json", "-o", "concise:out.txt", "--color", "always")
    assert result.exit_code == 1
    assert "\x1b[1;31merror" in result.stdout
    assert Path("out.txt").read_text("utf-8").startswith("a.nc:4:1: error: G0 ")
    assert json.loads(Path("out.json").read_text("utf-8"))["summary"]["errors"] == 1


def test_a_report_that_cannot_be_written_is_told_and_the_other_one_printed() -> None:
    make(a__nc=GOOD)
    result = check("a.nc", *RAPID_ONLY, "-o", "json:no/out.json")
    assert result.exit_code == 2
    assert "no/out.json: No such file or directory" in result.stderr
    assert "unverified  a.nc" in result.stdout


@pytest.mark.nightly
@looped(
    ("arguments", "environment", "colored"),
    [
        ([], {}, False),
        (["--color", "always"], {"NO_COLOR": "1"}, True),
        (["--color", "never"], {"FORCE_COLOR": "1"}, False),
        ([], {"FORCE_COLOR": "1"}, True),
        ([], {"FORCE_COLOR": "1", "NO_COLOR": "1"}, False),
        ([], {"FORCE_COLOR": "1", "NO_COLOR": ""}, True),
        ([], {"POLARCHECK_COLOR": "always"}, True),
    ],
    one_in=3,
)
def test_color_is_the_option_then_no_color_then_force_color(
    arguments: list[str], environment: dict[str, str], colored: bool
) -> None:
    make(a__nc=RAPID)
    result = check("a.nc", *RAPID_ONLY, *arguments, **environment)
    assert ("\x1b[" in result.stdout) == colored
    assert "\x1b[" not in check("a.nc", "--format", "json", *arguments, **environment).stdout


def test_options_come_from_the_environment_too() -> None:
    make(a__nc=RAPID)
    result = check("a.nc", POLARCHECK_SELECT="rapid-in-polar", POLARCHECK_FORMAT="concise", POLARCHECK_FAIL_ON="never")
    assert result.exit_code == 0
    assert re.fullmatch(r"a\.nc:4:1: error: .* \[rapid-in-polar\]\n", result.stdout)
    assert call("rules", POLARCHECK_FORMAT="concise").exit_code == 0
    wrong = check("a.nc", POLARCHECK_FAIL_ON="errors").stderr
    assert wrong.startswith("polarcheck: POLARCHECK_FAIL_ON: Invalid value for '--fail-on': 'errors' is not one of")
    assert check("a.nc", "--fail-on", "errors").stderr.startswith("polarcheck: Invalid value")
    # POLARCHECK_PART is the flag of check; that of init names programs. POLARCHECK_TOLERANCE is of drawings, and would
    # let compare pass by what a part may deviate.
    # Nothing of it overwrites programs.
    without = ("fix", "unsafe_fixes", "parts", "update", "same_up_to", "within", "out", "in_place", "force")
    for command in main.commands.values():
        for option in command.params:
            if isinstance(option, click.Option) and option.name not in without:
                written = max(option.opts, key=len).lstrip("-").upper().replace("-", "_")
                assert option.envvar == f"POLARCHECK_{written}"


@pytest.mark.nightly
def test_the_report_is_long_for_up_to_three_files_and_short_beyond() -> None:
    make(a__nc=RAPID, b__nc=GOOD, c__nc=GOOD)
    long = check(".", *RAPID_ONLY).stdout
    assert long.startswith("error: G0 cannot be used in the polar mode")
    assert long == check(".", *RAPID_ONLY, "--format", "text").stdout
    make(d__nc=COMPENSATED)
    result = check(".", *RAPID_ONLY, "--select", "start-up-shorter-than-radius")
    assert result.exit_code == 1
    assert result.stderr == ""
    first, empty, settings, summary, fails, unverified = result.stdout.splitlines()
    assert re.fullmatch(r"a\.nc:4:1: error: G0 .* \[rapid-in-polar\]", first)
    assert empty == ""
    assert settings == "settings: select rapid-in-polar start-up-shorter-than-radius (--select)"
    assert summary == "4 files checked for fanuc: 1 fail, 3 unverified; 1 error"
    chosen = "polarcheck check --select rapid-in-polar --select start-up-shorter-than-radius"
    assert fails == f"What is wrong with one of them, in full: {chosen} a.nc"
    assert unverified == f"Why one of them is unverified: {chosen} b.nc"
    assert check(".", *RAPID_ONLY, POLARCHECK_FORMAT="text").stdout.startswith("error: G0 cannot")
    assert check(".", *RAPID_ONLY, "--format", "concise").stdout == first + "\n"
    assert check("a.nc", *RAPID_ONLY, POLARCHECK_FORMAT="short").stdout.startswith(first + "\n\nsettings: select rapid")


@pytest.mark.ci
def test_what_shows_a_file_in_full_holds_the_options_that_were_given() -> None:
    make(**dict.fromkeys(("b__nc", "c__nc", "d__nc"), GOOD))
    Path("it's a.nc").write_text(RAPID, "utf-8")
    given = ("--machine", "fanuc-30i", "--set", "limits.c_feed=1000", "--tool", "1:radius=4")
    flags = ("--strict", "--no-config")
    shown = check(
        *flags, *given, "--color", "never", "-o", "json:a.json", ".", *RAPID_ONLY, POLARCHECK_UNITS="mm"
    ).stdout
    command = re.findall(r"in full: polarcheck (.*)", shown)[0]
    assert command == " ".join(("check", *given, "--no-config", *RAPID_ONLY, "--strict")) + " 'it'\"'\"'s a.nc'"
    assert call(*shlex.split(command)).stdout.startswith("error: G0 cannot be used")


def test_the_concise_report_says_elsewhere_that_something_was_not_evaluated() -> None:
    make(a__nc=COMPENSATED)
    result = check("a.nc", *RAMP_ONLY, "--format", "concise")
    assert result.stdout == ""
    assert "some files are unverified" in result.stderr
    assert check("a.nc", *RAMP_ONLY, "--format", "concise", "-q").stderr == ""


def test_names_and_comments_are_data() -> None:
    name = "a\x1b[31m\u202e.nc"
    Path(name).write_text(RAPID.replace("C5.", "C5. (\x1b[2J[red])"), "utf-8")
    for form in ("text", "concise", "json"):
        shown = check(name, *RAPID_ONLY, "--format", form).stdout
        assert "\x1b" not in shown
        assert "\u202e" not in shown
        assert "a\\" in shown


def test_quiet_says_nothing_of_what_is_good() -> None:
    make(a__nc=GOOD)
    result = check("a.nc", *RAPID_ONLY, "-q")
    assert (result.stdout, result.stderr) == ("", "")


# ---- the other commands ----


@looped("name", ["rapid-in-polar", "Rapid_In_Polar"])
def test_explain_shows_the_manual_page(name: str) -> None:
    result = call("explain", name)
    assert result.exit_code == 0
    assert result.stdout.startswith("rapid-in-polar (polar, error, alarm PS0146 on FANUC lathe control)\n====")
    assert load_all()["rapid-in-polar"].page in result.stdout


def test_explain_knows_alarms_of_the_machine_that_is_chosen() -> None:
    for number in ("PS0146", "ps146", "146"):
        assert "rapid-in-polar (polar" in call("explain", number).stdout
    make(
        mine__toml="inherits = 'fanuc'\n[alarms]\nrapid-in-polar = 'P62'\n", polarcheck__toml="machine = 'mine.toml'\n"
    )
    assert "rapid-in-polar (polar" in call("explain", "P62").stdout
    assert "rapid-in-polar (polar" in call("explain", "62", "--machine", "mine.toml").stdout
    result = call("explain", "P62", "--machine", "fanuc")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == "polarcheck: no rule is known to give alarm P62 on FANUC lathe control\n"


def test_explain_of_an_alarm_shows_one_page_and_the_names_of_the_others() -> None:
    page = call("explain", "PS0146").stdout
    assert page.startswith("rapid-in-polar (polar")
    assert page.count("\nSource: ") == 1
    assert "PS0146 also stands for, each with a page of its own (polarcheck explain NAME):\n\n" in page
    assert "\n  plane-selected-in-polar " in page
    assert "also stands for" not in call("explain", "OT0512").stdout


@looped(("block", "first"), [("G17", "plane-selected-in-polar"), ("G28 U0", "code-not-allowed-in-polar")])
def test_explain_of_an_alarm_begins_with_what_a_program_does(block: str, first: str) -> None:
    Path("O1.NC").write_text(f"G98 G0 X60. C0\nG12.1\nG1 X40. F200\n{block}\nC5.\nG13.1\n", "utf-8")
    page = call("explain", "PS0146", "O1.NC").stdout
    assert page.startswith(f"{first} (")
    assert "\n  rapid-in-polar " in page


def test_explain_suggests_the_nearest_name() -> None:
    result = call("explain", "rapid-in-poler")
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == "polarcheck: unknown rule 'rapid-in-poler'; did you mean rapid-in-polar?\n"


@looped("word", ["pass", "unverified", "fail"])
def test_explain_has_a_page_for_each_word_of_a_verdict(word: str) -> None:
    title, line, empty, *text = call("explain", word).stdout.splitlines()
    assert title.startswith(f"{word}: ")
    assert (line, empty) == ("=" * len(title), "")
    assert max(map(len, text)) <= 120
    assert call("explain", word.upper()).stdout == call("explain", word).stdout
    assert title in call("explain", "verdicts").stdout
    for help_of in (["--help"], ["check", "--help"]):
        assert word in call(*help_of).stdout


def test_explain_unverified_names_the_remedy_of_each_reason() -> None:
    page = call("explain", "not evaluated").stdout
    assert page == call("explain", "Not-Evaluated").stdout == call("explain", "unverified").stdout
    remedies = (
        "--tool 8:radius=",
        "--offsets",
        "limits.c_feed=",
        "--subprograms",
        "[run.variables]",
        "--machine",
        "F in",
    )
    assert [remedy for remedy in remedies if remedy not in page] == []
    assert "nose type" in page


@pytest.mark.ci
def test_the_examples_of_the_page_end_as_it_says(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    page = call("explain", "unverified").stdout
    examples = re.findall(r"^    polarcheck (check .*)\n        (\w+)", page, re.MULTILINE)
    assert [verdict for _, verdict in examples] == ["unverified", "pass"]
    for arguments, verdict in examples:
        result = call(*arguments.split())
        assert result.exit_code == 0
        assert re.search(rf"^{verdict}  ", result.stdout, re.MULTILINE)
        assert call(*arguments.split(), "--strict").exit_code == (verdict != "pass")


@looped(
    ("machine", "words"),
    [
        ("fanuc-30i", ""),
        ("haas-lathe", "from G112 to G113, with Y as its virtual axis, with X as a radius"),
        ("siemens-transmit", "from TRANSMIT to TRAFOOF, with Y as its virtual axis, with X as a radius"),
    ],
)
def test_explain_says_how_the_mode_is_programmed_on_the_machine(machine: str, words: str) -> None:
    shown = " ".join(call("explain", "arc-off-polar-plane", "--machine", machine).stdout.split())
    assert (f"the mode is programmed {words}." in shown) == bool(words)
    assert ("Examples without a machine are those of FANUC lathe control" in shown) == bool(words)
    assert "X and C" not in shown
    assert "the mode is programmed" not in call("explain", "empty-program", "--machine", machine).stdout


def test_explain_suggests_what_begins_with_the_word() -> None:
    assert (
        call("explain", "rapid").stderr == "polarcheck: unknown rule 'rapid'; did you mean "
        "rapid-along-contour, rapid-plunge-into-stock or rapid-through-part?\n"
    )
    assert call("explain", "start-up").stderr.endswith(
        "did you mean start-up-on-arc, start-up-shorter-than-radius or start-up-sweeps-contour?\n"
    )
    assert call("explain", "qqqqqq").stderr == "polarcheck: unknown rule 'qqqqqq'; `polarcheck rules` lists them\n"


def test_rules_lists_all_of_them_by_group() -> None:
    known = load_all()
    lines = call("rules").stdout.splitlines()
    assert re.search(
        r"^polar: .+\n(?:  .*\n)*  error    rapid-in-polar +Rapid traverse in", "\n".join(lines), re.MULTILINE
    )
    assert [line.split()[1] for line in lines if line.startswith("  ")] == list(known)
    shown = json.loads(call("rules", "--format", "json").stdout)
    assert [entry["name"] for entry in shown] == list(known)
    keys = ["name", "group", "severity", "title", "source"]
    assert all(list(entry) == [*keys, "values"] and all(entry[key] for key in keys) for entry in shown)
    (rate,) = (entry["values"] for entry in shown if entry["name"] == "c-feed-above-limit")
    assert [rate[name] for name in ("c_feed", "limit", "highest_feed")] == ["deg/min", "deg/min", "mm/min"]


def test_machines_lists_all_of_them() -> None:
    lines = call("machines").stdout.splitlines()
    assert [line.split()[0] for line in lines] == names()
    default = next(line for line in lines if line.startswith(f"{profiles.DEFAULT} "))
    assert default.endswith("FANUC lathe control, the default")
    assert any(line.endswith("< fanuc") for line in lines)


#: Of a machine: what `polarcheck machines` shows as comments.
_LEFT_OUT = ("known_parameters", "notes")


@pytest.mark.one_in(20)
@pytest.mark.ci
@pytest.mark.parametrize("name", names())
def test_a_profile_is_shown_as_a_profile_that_says_the_same(name: str) -> None:
    shown = call("machines", name).stdout
    Path("copy.toml").write_text(shown, "utf-8")
    said, meant = (
        [getattr(profiles.load(of).machine, key) for key in Machine.__struct_fields__ if key not in _LEFT_OUT]
        for of in ("copy.toml", name)
    )
    assert repr(said) == repr(meant)  # NaN differs from itself


def test_a_profile_shows_where_each_value_comes_from() -> None:
    make(mine__toml="inherits = 'fanuc'\nnotes = ['a b c']\n[limits]\nc_feed = { value = 3600, source = 'plate' }\n")
    shown = call("machines", "mine.toml").stdout
    assert re.search(r"^c_feed = 3600\.0 +# mine\.toml: plate$", shown, re.MULTILINE)
    assert re.search(r"^units = \"mm\" +# \? fanuc: assumed where", shown, re.MULTILINE)
    assert re.search(r"^polar_feed = nan +# not known$", shown, re.MULTILINE)
    assert call("machines", "gone").exit_code == 2


def test_the_version_is_shown() -> None:
    assert call("--version").stdout == f"polarcheck {polarcheck.__version__}\n"


# ---- schemas ----


@pytest.mark.one_in(7)
@pytest.mark.ci
@pytest.mark.parametrize("name", ["report", "job", "machine", "feeds", "trace", "comparison", "rewriting"])
def test_schemas_are_valid_and_say_what_they_are(name: str) -> None:
    shown = json.loads(call("schema", name).stdout, parse_constant=pytest.fail)
    jsonschema.Draft202012Validator.check_schema(shown)
    assert shown["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert shown["$id"] == f"urn:polarcheck:{name}:{2 if name == 'report' else 1}"


@pytest.mark.ci
def test_built_in_machines_fit_their_schema_and_wrong_ones_do_not() -> None:
    import tomllib

    valid = jsonschema.Draft202012Validator(json_schema.schema("machine"))
    for path in profiles.FOLDER.glob("*.toml"):
        valid.validate(tomllib.loads(path.read_text("utf-8")))
    for wrong in ({"limits": {"c_fed": 3}}, {"limits": {"c_feed": "fast"}}, {"limits": {"c_feed": {"source": "x"}}}):
        assert not valid.is_valid(wrong)


def test_jobs_fit_their_schema_and_wrong_ones_do_not() -> None:
    valid = jsonschema.Draft202012Validator(json_schema.schema("job"))
    valid.validate(
        {"machine": "fanuc", "tools": {"8": {"radius": 0.375}}, "limits": {"c_feed": 3600}, "select": ["feed"]}
    )
    for wrong in (
        {"machin": "fanuc"},
        {"tools": {"T8": {}}},
        {"limits": {"c_fed": 3}},
        {"severities": {"feed": "bad"}},
    ):
        assert not valid.is_valid(wrong)


def test_a_report_fits_its_schema() -> None:
    make(a__nc=RAPID, b__nc=COMPENSATED)
    result = check(".", "--select", "rapid-in-polar,start-up-shorter-than-radius", "--format", "json")
    shown = json.loads(result.stdout, parse_constant=pytest.fail)
    jsonschema.Draft202012Validator(json_schema.schema("report")).validate(shown)


# ---- what is imported ----


@pytest.mark.ci
@pytest.mark.one_in(12)
@pytest.mark.parametrize(
    ("arguments", "unwanted"),
    [
        (["--help"], {"numpy", "shapely", "rich", "msgspec", "tomllib"}),
        (["--version"], {"numpy", "shapely", "rich", "msgspec", "tomllib"}),
        (["check", "--help"], {"numpy", "shapely", "rich"}),
        (["explain", "unverified"], {"numpy", "shapely", "rich", "polarcheck.rules.rule"}),
        (["explain", "rapid-in-polar"], {"numpy", "shapely", "rich"}),
        (["rules"], {"numpy", "shapely", "rich"}),
        (["machines", "fanuc"], {"numpy", "shapely", "rich"}),
        (["schema", "job"], {"numpy", "shapely", "rich"}),
        (
            ["check", "a.nc", "a.nc", ".", *RAPID_ONLY],
            {
                "shapely",
                "rich",
                "polarcheck.commands.trace",
                "multiprocessing",
                "concurrent.futures.process",
                "asyncio",
            },
        ),
    ],
)
def test_commands_import_what_they_need_and_no_more(arguments: list[str], unwanted: set[str]) -> None:
    make(a__nc=GOOD)
    code = (
        f"import sys; sys.path.insert(0, {IMPORTED_FROM!r}); sys.argv = {['polarcheck', *arguments]}\n"
        "from polarcheck.commands import run\n"
        f"assert sys.modules['polarcheck'].__file__ == {polarcheck.__file__!r}\n"
        "try: run()\n"
        f"except SystemExit as end: print(end.code, *sorted({unwanted!r} & set(sys.modules)), file=sys.stderr)"
    )
    # A process whose coverage is measured imports more.
    unmeasured = {name: value for name, value in os.environ.items() if not name.startswith("COVERAGE_")}
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=unmeasured)
    assert result.stderr.split() == ["0"]


@pytest.mark.ci
def test_standard_output_of_any_encoding_takes_any_program() -> None:
    make(a__nc=RAPID.replace("C5.", "C5. (\u89d2\u5ea6)"))
    running = subprocess.run(
        [sys.executable, "-m", "polarcheck", "check", "a.nc", *RAPID_ONLY],
        env={**os.environ, "PYTHONPATH": IMPORTED_FROM, "PYTHONIOENCODING": "cp1252"},
        capture_output=True,
        check=False,
    )
    assert running.returncode == 1
    assert b"G0 C5. (\\u89d2\\u5ea6)" in running.stdout
    assert running.stderr == b""
