"""docs/silence.md says what is so: every program and every command in it is tried, in the order of the page."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path

import pytest
from cases import looped
from click.testing import CliRunner
from programs import ROOT, report_of

from polarcheck.commands import main
from polarcheck.files.baselines.baseline_file import Entry, read

PAGE = (ROOT / "docs" / "silence.md").read_text("utf-8")
PARTS = ["\n".join(line[4:] for line in part.splitlines()) + "\n" for part in re.findall(r"(?:^    .*\n)+", PAGE, re.M)]
PROGRAMS = [part for part in PARTS if "\nG12.1\n" in part]
COMMANDS = [line for part in PARTS if part.startswith("polarcheck ") for line in part.splitlines()]


@looped("program", PROGRAMS)
def test_each_program_passes_by_its_comments_alone(program: str) -> None:
    found = report_of(program, "fanuc", "1:radius=4", only=["polar", "silence"])
    assert found.findings == []
    assert {one.rule for one in found.silenced} == {"rapid-in-polar"}
    assert {one.reason for one in found.silenced} == {"PARAMETER 5431 IS SET"}


@pytest.mark.nightly
@pytest.mark.usefixtures("own_folder")
def test_the_commands_do_what_the_page_says() -> None:
    Path("programs").mkdir()
    Path("programs/O1234.NC").write_text(re.sub(r" ?\(POLARCHECK.*\)", "", PROGRAMS[0]))
    statuses = []
    for line in COMMANDS:
        words = shlex.split(line)
        assert words[0] == "polarcheck"
        result = CliRunner().invoke(main, words[1:])
        assert not result.stderr, line
        statuses.append((words[1], result.exit_code))
    # The first is without the baseline, which is made behind it.
    assert statuses[0] == ("check", 1)
    assert {status for _, status in statuses[1:]} == {0}
    assert {entry.reason for entry in read(Path("polarcheck-baseline.json")).entries} == {"RUN SINCE 2019"}


@pytest.mark.usefixtures("own_folder")
def test_a_job_file_can_say_that_comments_do_not_count() -> None:
    Path("a.nc").write_text(PROGRAMS[0])
    Path("polarcheck.toml").write_text("inline = false\n")
    command = ["check", "a.nc", "--select", "rapid-in-polar"]
    statuses = [CliRunner().invoke(main, [*command, *more]).exit_code for more in ([], ["--inline"])]
    assert statuses == [1, 0]


def test_the_entry_is_one() -> None:
    (entry,) = (json.loads(part) for part in PARTS if part.startswith("{"))
    assert set(entry) < set(Entry.__struct_fields__)
    (found,) = report_of("G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5.\nG1 C-5.\nG13.1\n", only=[entry["rule"]]).findings
    assert (found.fingerprint, found.severity, found.block) == (entry["fingerprint"], entry["severity"], entry["block"])


def test_the_verdict_is_one() -> None:
    (line,) = (part for part in PARTS if part.startswith("pass "))
    assert line.startswith("pass (1 silenced)  O1234.NC: ")
    assert len(PROGRAMS) == 3
    assert len(COMMANDS) == 6
