"""The sample programs say what their comments expect, and their reports and paths stay what they are."""

from __future__ import annotations

import re
from pathlib import Path

import msgspec
import pytest
from syrupy.assertion import SnapshotAssertion

from polarcheck.checking import check
from polarcheck.checking.finding import FileReport
from polarcheck.checking.rule import load_all
from polarcheck.machines import job, profiles
from polarcheck.machines.machine import Machine
from polarcheck.reports.pages import executed
from polarcheck.table.trace import Trace

FOLDER = Path(__file__).parent.parent / "sample_programs"
SAMPLES = sorted(path for path in FOLDER.rglob("*") if path.suffix in (".nc", ".mpf"))
EXPECT = re.compile(r"\(expect: ([a-z, -]+)\)")
NAMES = [path.relative_to(FOLDER).as_posix() for path in SAMPLES]


def settings(path: Path) -> tuple[Machine, job.Job]:
    found = job.find(path)
    assert found is not None
    work = job.load(found)
    changes = {"limits": work.limits} if work.limits else None
    return profiles.load(work.machine or profiles.DEFAULT, changes).machine, work


def report_of(path: Path) -> FileReport:
    lathe, work = settings(path)
    return check.check_file(path.read_bytes(), lathe, work, list(load_all().values()), path.name)


def trace_of(path: Path) -> Trace:
    lathe, work = settings(path)
    return check.read_traces(path.read_bytes(), lathe, work, path.name)[0][1]


@pytest.mark.parametrize("path", SAMPLES, ids=NAMES)
def test_sample_gives_what_it_expects(path: Path) -> None:
    expected = [
        (number, name.strip())
        for number, line in enumerate(path.read_text("utf-8").split("\n"), 1)
        for found in EXPECT.finditer(line)
        for name in found[1].split(",")
    ]
    report = report_of(path)
    assert sorted((finding.line, finding.rule) for finding in report.findings) == sorted(expected)


@pytest.mark.parametrize("path", SAMPLES, ids=NAMES)
def test_report_is_the_golden_one(path: Path, snapshot: SnapshotAssertion) -> None:
    assert msgspec.json.format(msgspec.json.encode(report_of(path))).decode() == snapshot


@pytest.mark.parametrize("path", SAMPLES, ids=NAMES)
def test_tool_center_path_is_the_golden_one(path: Path, snapshot: SnapshotAssertion) -> None:
    lines = list(executed.as_jsonl(executed.moves(trace_of(path), "tool")))
    assert "".join(lines) == snapshot


def test_there_are_enough_samples_good_and_bad() -> None:
    faulty = [path for path in SAMPLES if EXPECT.search(path.read_text("utf-8"))]
    assert len(SAMPLES) >= 12
    assert len(faulty) >= 8
    assert len(SAMPLES) - len(faulty) >= 4
