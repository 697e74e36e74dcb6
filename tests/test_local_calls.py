"""Calls of a part of a program, from an N number to M99: M98 Q100, M98 H1, M97 P100, and M98 P1 Q100 of another one."""

from __future__ import annotations

import numpy as np
import pytest
from cases import looped
from programs import Changes, report_of, said, trace_of

HEAD = "O1\nT0101\nG98 G0 X60. C0\n"
PART = "N100 G1 X10. F200\nX12.\nM99\n"
#: The call and what it calls, on a lathe; X of the moves behind the head.
CALLS = {
    "Q": ("fanuc", "M98 Q100\nM30\n" + PART, [10, 12]),
    "Q L2": ("doosan", "M98 Q100 L2\nM30\n" + PART, [10, 12, 10, 12]),
    "Q of two parts": ("doosan", "M98 Q200\nM98 Q100\nM30\n" + PART + "N200 X14.\nM99\n", [14, 10, 12]),
    "Q in a part": ("doosan", "M98 Q200\nM30\n" + PART + "N200 X14.\nM98 Q100\nX16.\nM99\n", [14, 10, 12, 16]),
    "Q computed": ("fanuc-30i", "#1=100\nM98 Q#1\nM30\n" + PART, [10, 12]),
    "Q above the call": ("fanuc", "GOTO 10\n" + PART + "N10 M98 Q100\nX14.\nM30\n", [10, 12, 14]),
    "P Q of itself": ("doosan", "M98 P1 Q100\nM30\n" + PART, [10, 12]),
    "P Q": ("doosan", "M98 P2 Q100\nM30\nO2\nX50.\n" + PART, [10, 12]),
    "jump out of the part": ("fanuc", "GOTO 10\nN5 X14.\nM99\nN10 M98 Q100\nM30\nN100 X10.\nGOTO 5\n", [10, 14]),
    "H": ("citizen", "M98 H100\nM30\n" + PART, [10, 12]),
    "P H": ("mitsubishi-m700", "M98 P2 H100 L2\nM30\nO2\nX50.\n" + PART, [10, 12, 10, 12]),
    "Haas": ("haas-lathe", "M97 P100 L2\nM30\n" + PART, [10, 12, 10, 12]),
}


@pytest.mark.ci
@looped(("machine", "program", "moves"), CALLS.values(), ids=list(CALLS), one_in=2)
def test_the_part_runs_and_returns(machine: str, program: str, moves: list[float]) -> None:
    trace = trace_of(HEAD + program, machine)
    x = trace.blocks.word("X")
    assert x[~np.isnan(x)].tolist() == [60, *moves]
    rules = {rule for _, rule in said(report_of(HEAD + program, machine))}
    assert not rules & {"unreachable-block", "subprogram-missing", "number-without-point"}


@pytest.mark.ci
@looped(
    ("machine", "program", "finding"),
    [
        ("doosan", "M98 Q100\nM30\n", (4, "jump-target-missing")),
        ("doosan", "M98 Q100\nM98 Q100 L2\nM30\n", (4, "jump-target-missing")),
        ("citizen", "M98 H100\nM30\n", (4, "jump-target-missing")),
        ("haas-lathe", "M97 P100\nM30\n", (4, "jump-target-missing")),
        ("doosan", "M98 P2 Q200\nM30\nO2\n" + PART, (4, "jump-target-missing")),
        ("doosan", "M98 Q100\nM30\nN100 G1 X10. F200\nM98 Q100\nM99\n", (7, "nesting-too-deep")),
        ("doosan", "M98 Q100\nM30\nN100 G1 X10. F200\n", (6, "program-end-missing")),
        ("haas-lathe", "M97 P100\nM30\nN100 G1 X10. F200\n", (6, "program-end-missing")),
        ("siemens-iso", "M98 Q100\nM30\n", (4, "subprogram-missing")),
        ("doosan", "M98\nM30\n", (4, "subprogram-missing")),
    ],
)
def test_one_finding_where_it_cannot_run(machine: str, program: str, finding: tuple[int, str]) -> None:
    assert said(report_of(HEAD + program, machine)) == [finding]


def test_the_message_names_the_program() -> None:
    report = report_of(HEAD + "M98 P2 Q200\nM30\nO2\n" + PART, "doosan")
    assert report.findings[0].message.startswith("M98 P2 Q200 finds no block: there is no N200 in O0002")


def test_an_unknown_number_is_not_evaluated() -> None:
    report = report_of(HEAD + "M98 Q#500\nM30\n" + PART, "doosan")
    assert [found.rule for found in report.findings] == []
    assert any("which program is called" in missing.reason for missing in report.not_evaluated)


@looped("changes", [{"macro": {"sequence_word": ""}}, {"parameters": {"6005#0": 0}}])
def test_a_lathe_may_not_have_it(changes: Changes) -> None:
    report = report_of(HEAD + "M98 Q100\nM30\n" + PART, "doosan", changes=changes)
    assert (4, "subprogram-missing") in said(report)
