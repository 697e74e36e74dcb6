"""Where the time of a check goes: `--timings`, on standard error, and what is not measured."""

from __future__ import annotations

import importlib
import json
import re
import subprocess
import sys
from functools import cached_property
from pathlib import Path
from typing import Any

import pytest
from click.testing import Result
from test_cli import call

from polarcheck.checking import batch, check, tables, timing
from polarcheck.checking.timing import BEGINS, OF_TABLES, STAGES, Clock, Spent, timed
from polarcheck.machines.job import Job
from polarcheck.machines.profiles import DEFAULT, load
from polarcheck.reports.pages.timings import timings_table
from polarcheck.table.sections import Sections
from polarcheck.table.trace import Trace

SAMPLES = Path(__file__).parent.parent / "sample_programs"
SAMPLE = str(SAMPLES / "rapid_in_polar.nc")
ROW = re.compile(r"(.+?)  +([\d.]+)  +\d+%  +(\S+)  +(\S+)  +(\S+)")


def rows(result: Result) -> dict[str, float]:
    """The CPU time [s] by stage, and its total."""
    return {found[1]: float(found[2]) for line in result.stderr.splitlines() if (found := ROW.fullmatch(line))}


@pytest.fixture
def spent(monkeypatch: pytest.MonkeyPatch) -> list[Spent]:
    """What the process has cost; a test may put another in its place."""
    now = [Spent()]
    monkeypatch.setattr(timing, "_spent", lambda: now[0])
    return now


def test_the_report_and_the_exit_code_are_as_without() -> None:
    plain, result = call("check", SAMPLE), call("check", SAMPLE, "--timings")
    assert plain.exit_code == result.exit_code == 1
    assert plain.stdout == result.stdout
    assert plain.stderr == ""
    found = rows(result)
    assert list(found) == [*STAGES, "total"]
    assert sum(found[stage] for stage in STAGES) == pytest.approx(found["total"], abs=0.0005 * len(STAGES))
    assert all(found[stage] > 0 for stage in ("start", "reading", "columns", "rules"))


def test_several_files_are_added_up() -> None:
    folder = str(SAMPLES / "doosan")
    plain, result = call("check", folder, "--format", "json"), call("check", folder, "--format", "json", "--timings")
    assert plain.stdout == result.stdout
    files = json.loads(plain.stdout)["files"]
    blocks = sum(file["blocks"] for file in files)
    assert len(files) > 1
    assert result.stderr.splitlines()[-1] == f"{len(files)} files, {blocks:,} blocks, in one process"


@pytest.mark.parametrize("other", [("--jobs", "2"), ("--cluster", "tcp://127.0.0.1:1"), ("--watch",)])
def test_one_process_is_measured_and_once(other: tuple[str, ...]) -> None:
    result = call("check", SAMPLE, "--timings", *other)
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"polarcheck: --timings: not with {other[0]}; one process is measured, once\n"


def test_nothing_of_it_is_loaded_where_it_is_not_asked_for() -> None:
    code = (
        "import sys, polarcheck.commands\n"
        f"sys.argv = ['polarcheck', 'check', {SAMPLE!r}]\n"
        "try:\n    polarcheck.commands.run()\nexcept SystemExit:\n    pass\n"
        "loaded = {'polarcheck.checking.timing', 'polarcheck.commands.timing', 'polarcheck.reports.pages.timings'}\n"
        "assert 'polarcheck.checking.batch' in sys.modules\n"
        "assert not loaded & set(sys.modules), loaded\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)


def test_a_stage_is_not_charged_with_those_that_it_calls(spent: list[Spent]) -> None:
    def cost(seconds: float) -> None:
        spent[0] += Spent(seconds, 10, 1)

    clock = Clock()
    reading = clock.charged(lambda: cost(2), "reading")

    def execution() -> None:
        cost(4)
        reading()
        cost(8)

    cost(1)
    clock.charged(execution, "execution")()
    cost(16)
    clock.go_on("report")
    assert clock.spent["start"] == Spent(17, 20, 2)
    assert clock.spent["reading"] == Spent(2, 10, 1)
    assert clock.spent["execution"] == Spent(12, 20, 2)
    assert clock.total() == spent[0]


def test_a_column_that_a_rule_is_the_first_to_ask_for_is_no_rule(
    spent: list[Spent], monkeypatch: pytest.MonkeyPatch
) -> None:
    column = vars(Trace)["side"]
    made = column.func

    def costly(trace: Trace) -> Any:
        spent[0] += Spent(64)
        return made(trace)

    monkeypatch.setattr(column, "func", costly)
    with timed() as clock:
        lathe = load(DEFAULT).machine
        ((_, found),) = check.read(b"G12.1\nG42 G1 X20. F100\nG13.1\n", lathe, Job())
        clock.go_on("rules")
        _ = found["trace"].side
        clock.go_on("report")
    assert clock.spent["columns"].seconds == 64


def test_what_is_measured_is_there_and_is_as_before_afterwards() -> None:
    def members() -> list[object]:
        classes = [tables.Tables, Trace, Sections]
        found = [value for own in classes for value in vars(own).values()]
        return [one.func if isinstance(one, cached_property) else one for one in found] + [vars(batch)["outcome"]]

    before = members()
    with timed():
        inside = members()
    assert members() == before
    assert inside != before
    for place in BEGINS:
        module, _, name = place.partition(":")
        assert callable(getattr(importlib.import_module(module), name))
    for module in OF_TABLES:
        importlib.import_module(f"polarcheck.table.{module}")
    assert {*BEGINS.values(), *OF_TABLES.values(), "columns"} == set(STAGES)


def test_the_table() -> None:
    spent = {"start": Spent(0.25, 2_000_000, 1_000_000), "columns": Spent(0.75, 10_500_000, 0), "report": Spent()}
    assert timings_table(spent, 1, 300).splitlines() == [
        "stage    CPU s  share  blocks/s  touched MB  peak MB",
        "start    0.250    25%     1,200         2.0      1.0",
        "columns  0.750    75%       400        10.5      0.0",
        "report   0.000     0%         -         0.0      0.0",
        "total    1.000   100%       300        12.5      1.0",
        "1 file, 300 blocks, in one process",
    ]


def test_where_the_system_counts_no_memory_none_is_told() -> None:
    told = timings_table({"start": Spent(0.5)}, 2, 0).splitlines()
    assert [line.split() for line in told[1:3]] == [
        ["start", "0.500", "100%", "-", "-", "-"],
        ["total", "0.500", "100%", "-", "-", "-"],
    ]
    assert told[3] == "2 files, 0 blocks, in one process"
