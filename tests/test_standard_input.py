"""Standard input that stands for a file: what an editor holds is judged as the file will be."""

from __future__ import annotations

import json
import os
import sys
from pathlib import Path

import pytest
from click.testing import Result
from test_cli import COMPENSATED, GOOD, RAPID, call, check, make, process

pytestmark = pytest.mark.usefixtures("own_folder")

AS_FILE = ("--stdin-filename", "lathe/O1234.NC")
ON_A_LATHE = 'machine = "fanuc-30i"\n[tools.1]\nradius = 4.0\n'


def report(result: Result) -> dict[str, object]:
    (file,) = json.loads(result.stdout)["files"]
    assert isinstance(file, dict)
    return file


def make_lathe() -> None:
    Path("lathe").mkdir()
    Path("lathe/polarcheck.toml").write_text(ON_A_LATHE, "utf-8")


def test_it_is_judged_and_reported_as_the_file_that_it_will_be() -> None:
    make_lathe()
    Path("lathe/O1234.NC").write_text(COMPENSATED, "utf-8")
    of_file = check("lathe/O1234.NC", "--format", "json")
    Path("lathe/O1234.NC").write_text("M30\n", "utf-8")
    of_text = check("-", *AS_FILE, "--format", "json", given=COMPENSATED)
    assert of_text.stdout == of_file.stdout
    assert report(of_text)["machine"] == "fanuc-30i"
    assert report(of_text)["path"] == "lathe/O1234.NC"


def test_the_file_need_not_be_there() -> None:
    make_lathe()
    result = check("-", *AS_FILE, "--select", "rapid-in-polar", "--format", "concise", given=RAPID)
    assert (result.exit_code, result.stderr) == (1, "")
    assert result.stdout.startswith("lathe/O1234.NC:4:1: error: ")
    assert check("-", "--stdin-filename", "no/folder/O1.NC", given=GOOD).exit_code == 0


def test_its_subprograms_are_found_as_those_of_the_file_are() -> None:
    make_lathe()
    Path("lathe/sub").mkdir()
    Path("lathe/sub/O77.NC").write_text("O77\nG0 C5.\nM99\n", "utf-8")
    with Path("lathe/polarcheck.toml").open("a", encoding="utf-8") as job:
        job.write('[run]\nsubprograms = ["sub"]\n')
    calls = RAPID.replace("G0 C5.", "M98 P77")
    found = report(
        check("-", *AS_FILE, "--select", "rapid-in-polar,subprogram-missing", "--format", "json", given=calls)
    )
    assert [one["line"] for one in found["findings"]] == [4]  # type: ignore[attr-defined]


def test_the_same_file_beside_it_is_one_program() -> None:
    make_lathe()
    Path("lathe/O1234.NC").write_text(GOOD, "utf-8")
    both = ("-", f"lathe{os.sep}.{os.sep}O1234.NC")
    found = report(check(*both, *AS_FILE, "--select", "rapid-in-polar", "--format", "json", given=RAPID))
    assert [one["rule"] for one in found["findings"]] == ["rapid-in-polar"]  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["a.nc", *AS_FILE], "--stdin-filename lathe/O1234.NC: expected - among the paths"),
        (["-", "--stdin-filename", ""], "--stdin-filename'"),
        (["-", "--stdin-filename", "-"], "expected the name of a program"),
        (["-", "--stdin-filename", "lathe"], "expected the name of a program"),
        (["-", "--stdin-filename", "a\0b"], "expected the name of a program"),
    ],
)
def test_a_name_that_means_nothing_is_told(arguments: list[str], told: str) -> None:
    make(a__nc=GOOD)
    make_lathe()
    result = check(*arguments, given=GOOD)
    assert (result.exit_code, result.stdout) == (2, "")
    assert told in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_a_report_does_not_take_its_place() -> None:
    result = check("-", "--stdin-filename", "report.txt", "-o", "json:report.txt", given=GOOD)
    assert result.exit_code == 2
    assert "is read by this run" in result.stderr


@pytest.mark.ci
def test_what_cannot_be_read_there_is_told_under_its_name() -> None:
    with process("check", "-", *AS_FILE, "--encoding", "ascii", stdin=-1) as running:
        assert running.stdin is not None
        out, error = running.communicate("(\u00fc)\n", timeout=60)
    assert (running.returncode, error) == (2, "polarcheck: lathe/O1234.NC: byte 1 is not ascii\n")
    assert out == (
        "unreadable  lathe/O1234.NC: byte 1 is not ascii\n\n0 of 1 files checked for fanuc: 1 unreadable; no findings\n"
    )


@pytest.mark.skipif(sys.platform == "win32", reason="names there hold no such characters")
def test_nothing_acts_in_its_name() -> None:
    result = call("check", "-", "--stdin-filename", "a\x1b[31m\nb.nc", "--format", "concise", given=RAPID)
    assert result.exit_code == 1
    assert "\x1b" not in result.stdout
    assert all(line.startswith("a\\x1b[31m\\x0ab.nc:") for line in result.stdout.splitlines())
