"""G and M codes as whole numbers, and tables over them."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, trace_of

from polarcheck.program.machines.code_tables import NO_CODE, code, code_numbers, code_set, renumbered, spelled


@looped(("word", "number"), [("G0", 0), ("G12.1", 121), ("G112", 1120), ("M35", 350), ("G54.1", 541)])
def test_a_code_is_ten_times_its_number(word: str, number: int) -> None:
    assert code(word) == number
    assert spelled(word[0], number) == word


def test_written_values_are_codes_where_a_control_could_know_them() -> None:
    value = np.array([1.0, 12.1, 13.10, 1.05, -1.0, 999.9, 1000.0, np.nan, np.inf, 1e300])
    assert code_numbers(value).tolist() == [10, 121, 131, NO_CODE, NO_CODE, 9999, *[NO_CODE] * 4]


def test_a_set_of_codes_holds_its_ranges_and_never_what_is_no_code() -> None:
    table = code_set(["G1", "G17-G19", "G54.1"])
    assert np.flatnonzero(table).tolist() == [10, 170, 180, 190, 541]
    assert not table[NO_CODE]


def test_codes_of_other_numbers_are_read_as_what_they_mean() -> None:
    written = np.array([1010, 10, 1020, NO_CODE], np.int32)
    assert renumbered(written, {"G101": "G1", "G102": "G2"}).tolist() == [10, 10, 20, NO_CODE]
    assert renumbered(written, {}) is written


@pytest.mark.ci
@looped("cycle", ["G81", "G127", "G128", "G256", "G283", "G999"])
def test_a_code_of_any_number_is_a_state(cycle: str) -> None:
    """A builder's cycle by a number above G127, which a column of bytes would hold as another number, or as none."""
    changes = {"g_codes": {"drilling_cycle": ["G83", cycle]}}
    program = f"O1\nG98 G0 X60. Z2. C0\n{cycle} Z-5. F100\nG12.1\nG1 X40.\nC10.\nX60.\nG13.1\nM30\n"
    trace = trace_of(program, changes=changes)
    assert trace.modal.drilling.tolist() == [0, 0, *[int(cycle[1:])] * 2, *[0] * 5]
    assert trace.modal.in_cycle.tolist() == [False] * 2 + [True] * 2 + [False] * 5
    (found,) = report_of(program, changes=changes, only=["modal-state-wrong-at-entry"]).findings
    assert cycle in found.message
    stopped = program.replace("G12.1", "G80\nG12.1")
    assert said(report_of(stopped, changes=changes, only=["modal-state-wrong-at-entry"])) == []
