"""The sample programs say what their comments expect, and their reports and paths stay what they are."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import msgspec
import pytest
from cases import looped
from programs import ROOT, expected, report_of, said, tables_of, without_expectations
from syrupy.assertion import SnapshotAssertion

from polarcheck.files.settings import job_files
from polarcheck.foundation.finding import FileReport
from polarcheck.program.machines import profiles
from polarcheck.reports.pages import executed

FOLDER = ROOT / "sample_programs"
SAMPLES = sorted(path for path in FOLDER.rglob("*") if path.suffix in (".nc", ".mpf"))
NAMES = [path.relative_to(FOLDER).as_posix() for path in SAMPLES]
CONTROLS = [name for name in profiles.names() if name != profiles.DEFAULT]


def settings(path: Path) -> dict[str, Any]:
    """The machine and the job that the nearest polarcheck.toml gives a sample."""
    found = job_files.Nearest().of(path)
    assert found is not None
    work = job_files.load(found).merged([(0, 0)]).job
    assert work.machine is not None
    return {"machine": work.machine, "changes": {"limits": work.limits} if work.limits else None, "job": work}


@cache
def report_of_sample(path: Path) -> FileReport:
    given = settings(path)
    return msgspec.structs.replace(
        report_of(path.read_bytes(), **given, path=path.name), machine=Path(given["machine"]).name
    )


@looped("path", SAMPLES, ids=NAMES, one_in=12)
def test_sample_gives_what_it_expects(path: Path) -> None:
    report = report_of_sample(path)
    assert said(report) == expected(path.read_text("utf-8"))
    places = [(finding.line, finding.column) for finding in report.findings]
    assert places == sorted(places), "in the order of the file"


@looped(("path", "name"), zip(SAMPLES, NAMES, strict=True))
def test_report_is_the_golden_one(path: Path, name: str, snapshot: SnapshotAssertion) -> None:
    assert msgspec.json.format(msgspec.json.encode(report_of_sample(path))).decode() == snapshot(name=name)


@pytest.mark.nightly
@looped(("path", "name"), zip(SAMPLES, NAMES, strict=True))
def test_tool_center_path_is_the_golden_one(path: Path, name: str, snapshot: SnapshotAssertion) -> None:
    tables = tables_of(path.read_bytes(), **settings(path), path=path.name)
    assert "".join(executed.as_jsonl(executed.moves(tables["trace"], tables["tool_center"], "tool"))) == snapshot(
        name=name
    )


FAULTY = [path for path in SAMPLES if expected(path.read_text("utf-8"))]


@pytest.mark.nightly
@looped("path", FAULTY, ids=lambda path: path.relative_to(FOLDER).as_posix(), one_in=12)
def test_comments_that_expect_something_are_no_part_of_it(path: Path) -> None:
    text = path.read_text("utf-8")
    assert said(report_of(without_expectations(text), **settings(path))) == expected(text)


def test_there_are_enough_samples_good_and_bad() -> None:
    assert len(SAMPLES) >= 12
    assert len(FAULTY) >= 8
    assert len(SAMPLES) - len(FAULTY) >= 4


@looped("name", CONTROLS)
def test_each_control_has_a_good_and_a_bad_sample(name: str) -> None:
    own = [path for path in SAMPLES if path.parent == FOLDER / name]
    assert {path in FAULTY for path in own} == {True, False}
    assert {settings(path)["machine"] for path in own} == {name}
