"""Reports of more files than one wants to hold in memory, and reports that are written file by file."""

from __future__ import annotations

from pathlib import Path

import pytest
from cases import looped
from programs import ROOT, report_of

from polarcheck import reports
from polarcheck.files.batch import tasks as batch
from polarcheck.files.batch.spool import Spool
from polarcheck.foundation.finding import FileReport
from polarcheck.program.reading import files
from polarcheck.rules.rule import load_all

pytestmark = pytest.mark.ci

SAMPLES = ["rapid_in_polar.nc", "hexagon.nc", "degrees.nc", "narrow_groove.nc", "macro_polygon.nc"]


@pytest.fixture(scope="module")
def found() -> list[tuple[FileReport, dict[int, str]]]:
    """Reports of twelve files, more than text tells one by one, and the lines of each program."""
    made = []
    for number in range(12):
        name = SAMPLES[number % len(SAMPLES)]
        data = (ROOT / "sample_programs" / name).read_bytes()
        report = report_of(data, "fanuc", path=f"{number}/{name}")
        made.append((report, dict(enumerate(data.decode().split("\n"), 1))))
    return made


def spooled(found: list[tuple[FileReport, dict[int, str]]], in_memory: int) -> Spool:
    reports_of = Spool(in_memory)
    for report, lines in found:
        reports_of.add(report, lines)
    return reports_of


@pytest.mark.nightly
@looped("in_memory", [0, 3, 100], one_in=3)
def test_what_is_kept_comes_back_as_often_as_one_likes(
    found: list[tuple[FileReport, dict[int, str]]], in_memory: int
) -> None:
    stored = spooled(found, in_memory)
    expected = [report for report, _ in found]
    assert len(stored.files) == len(expected)
    assert [repr(report) for report in stored.files] == [repr(report) for report in expected]
    assert [report.path for report in stored.files] == [report.path for report in expected]
    assert stored.files[-1].path == expected[-1].path
    assert [report.path for report in stored.files[2:5]] == [report.path for report in expected[2:5]]
    assert dict(stored.lines) == {report.path: lines for report, lines in found}
    assert stored.lines.get("nowhere") is None
    assert len(stored.lines) == len(found)


@looped("form", reports.formats(), one_in=4)
@looped("color", [False, True])
def test_every_format_takes_reports_that_are_not_in_memory(
    found: list[tuple[FileReport, dict[int, str]]], form: str, color: bool
) -> None:
    """Whoever adds a format: report.files is a Sequence, no list, once there are many files."""
    shown = []
    for in_memory in (100, 2):
        stored = spooled(found, in_memory)
        report = batch.report(stored.files, "fanuc")
        background = reports.Background(stored.lines, load_all(), color=color)
        shown += [reports.render(form, report, background), "".join(reports.pieces(form, report, background))]
        parts = reports.parts(form, background)
        if parts is not None:
            shown.append("".join([parts.of_file(*one) for one in found] + [parts.end(report)]))
    assert len(shown[0]) > 500
    assert set(shown) == {shown[0]}


def test_no_files_are_a_report_too() -> None:
    report = batch.report([], "fanuc")
    for form in reports.formats():
        assert "".join(reports.pieces(form, report, reports.Background())) == reports.render(
            form, report, reports.Background()
        )


def test_a_report_that_cannot_be_made_is_no_fault_of_its_file(tmp_path: Path) -> None:
    target = tmp_path / "r.txt"
    target.write_text("old")
    with pytest.raises(RuntimeError, match="cannot be made"):
        files.write(target, ["good", "\ud800"])
    assert target.read_text() == "old"
    assert [path.name for path in tmp_path.iterdir()] == ["r.txt"]
