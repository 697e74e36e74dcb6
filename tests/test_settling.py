"""Columns of large programs that hold one value throughout take the memory of one."""

from __future__ import annotations

import numpy as np
import pytest

from polarcheck.checking import engine
from polarcheck.checking.check import check_file, read
from polarcheck.checking.rule import load_all
from polarcheck.checking.settling import Settling
from polarcheck.machines import profiles
from polarcheck.machines.job import Job

PROGRAM = b"""%
O1
G21 G18 G98 G0 X60. C0
G12.1
G1 X20. C5. F100
X2. C-5. K3. F5000
G0 X50. C0
G13.1
M30
%
"""


def test_settling_columns_are_read_as_they_were() -> None:
    machine = profiles.load(profiles.DEFAULT).machine
    ((_, tables),) = read(PROGRAM, machine, Job())
    settling, trace = Settling(tables), tables["trace"]
    columns = {name: getattr(trace, name) for name in ("scale", "in_polar", "local_shift", "sides_are_open", "x")}
    settling.settle()
    for name, column in columns.items():
        assert np.array_equal(getattr(trace, name), column, equal_nan=True), name
    assert trace.scale.strides == (0,)
    assert trace.in_polar is columns["in_polar"]
    other = tables["arcs"].x_is_misread
    assert not other.any()
    settling.settle()
    assert tables["arcs"].x_is_misread is trace.sides_are_open


def test_findings_are_the_same_with_settled_columns(monkeypatch: pytest.MonkeyPatch) -> None:
    machine, rules = profiles.load(profiles.DEFAULT).machine, list(load_all().values())
    plain = check_file(PROGRAM, machine, Job(), rules)
    assert plain.findings
    monkeypatch.setattr(engine, "_LARGE", 0)
    assert check_file(PROGRAM, machine, Job(), rules) == plain


def test_columns_of_texts_stay_as_they_are() -> None:
    """The names of rules in allow comments, where all of many comments name the same."""
    data = b"O1\nG0 X60.\n" + b"X50. (POLARCHECK ALLOW RAPID-IN-POLAR: KNOWN)\nX60.\n" * 6000 + b"M30\n"
    report = check_file(data, profiles.load(profiles.DEFAULT).machine, Job(), list(load_all().values()))
    assert {found.rule for found in report.findings} == {"allow-without-effect"}
