"""Tables that are forgotten behind their last reader: the report stays, and what is asked again is made again."""

from __future__ import annotations

from functools import cached_property
from pathlib import Path

import pytest
from cases import looped
from programs import ROOT, tables_of, tables_of_example

import polarcheck as api
from polarcheck.checking import check, engine
from polarcheck.foundation.finding import FileReport
from polarcheck.rules.examples import examples
from polarcheck.rules.rule import load_all
from polarcheck.rules.tables import TABLES, Tables, made_from

pytestmark = pytest.mark.ci

SAMPLES = ROOT / "sample_programs"
RULES = [rule for rule in load_all().values() if not rule.is_advice]


@pytest.mark.nightly
@looped("path", sorted(SAMPLES.rglob("*.nc")), one_in=24)
def test_what_is_read_behind_the_report_is_made_again(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    data = path.read_bytes()
    of_short = api.check_text(data), api.plot_text(data), api.part_text(data)
    monkeypatch.setattr(check, "_LONG", 0)
    assert (api.check_text(data), api.plot_text(data), api.part_text(data)) == of_short


def forgotten(tables: Tables) -> tuple[FileReport, set[str]]:
    """The report of a program, and the tables of which no column is there behind it, but for those executed."""
    report = check.report_of(check.engine_of(tables, RULES))
    computed = {
        name
        for name, table in tables.computed()
        if any(isinstance(getattr(type(table), key, None), cached_property) for key in getattr(table, "__dict__", ()))
    }
    return report, set(TABLES) - computed - made_from("trace")


def test_all_that_no_finding_reads_is_forgotten(monkeypatch: pytest.MonkeyPatch) -> None:
    program = (SAMPLES / "hexagon.nc").read_bytes()
    of_short, unmade = forgotten(tables_of(program))
    monkeypatch.setattr(check, "_LONG", 0)
    report, unmade_or_forgotten = forgotten(tables_of(program))
    assert report == of_short
    assert unmade_or_forgotten - unmade >= {"tool_center", "dynamics", "ramps", "overcuts", "passes", "bar", "written"}


def test_equal_columns_of_a_long_program_are_one_array(monkeypatch: pytest.MonkeyPatch) -> None:
    program = (SAMPLES / "hexagon.nc").read_bytes()
    reports, shared = [], []
    for many in (engine._MANY_ROWS, 0):
        monkeypatch.setattr(engine, "_MANY_ROWS", many)
        tables = tables_of(program)
        reports.append(check.report_of(check.engine_of(tables, RULES)))
        shared.append(tables["mode"].enters is tables["axes"].switches_on)
        assert tables["mode"].enters is not tables["mode"].leaves
    assert reports[0] == reports[1]
    assert shared == [False, True]


def test_what_a_finding_reads_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(check, "_LONG", 0)
    page = load_all()["start-up-shorter-than-radius"].page
    report, absent = forgotten(tables_of_example(next(example for example in examples(page) if not example.good)))
    assert [finding.rule for finding in report.findings] == ["start-up-shorter-than-radius"]
    assert "ramps" not in absent
