"""Every kind of fault has its rule, and a program in which that rule and no other reports it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import report_of, said, tables_of

from polarcheck.columns.words.macro_faults import RULES, Faults
from polarcheck.program.execution.kinds import KINDS
from polarcheck.rules.rule import load_all

#: Kind -> the statement at fault, on line 3.
_ONE_STATEMENT = {
    "format": "#1=5*",
    "statement-format": "#1=5 [2",
    "missing-open-bracket": "#1=SIN 30",
    "missing-close-bracket": "#1=[5+2",
    "missing-equal": "#1 5",
    "missing-comma": "#1=POW[5]",
    "if-format": "IF[1 EQ 2]#1=5",
    "while-format": "WHILE[1 EQ 2]#1=5",
    "too-long": "G0 X[" + "+".join(["1"] * 5_001) + "]",
    "bracket-levels": "#1=[[[[[[5]]]]]]",
    "nc-and-macro": "G0 X40. #1=5",
    "zero-divide": "#1=5/0",
    "overflow": "#1=EXP[200]",
    "integer-overflow": "#1=9999999999 AND 1",
    "negative-square-root": "#1=SQRT[2-6]",
    "arc-function-beyond-one": "#1=ACOS[2]",
    "logarithm-not-positive": "#1=LN[#2]",
    "argument-out-of-range": "#1=POW[-8,.5]",
    "variable-number": "#50=1",
    "read-only": "#5021=1",
    "word-vacant": "G0 X#1",
    "program-number": "M98 P0",
    "program-not-found": "M98 P3",
    "call-target-not-found": "M98 Q20",
    "sequence-number-not-found": "GOTO 20",
    "sequence-number-vacant": "GOTO #1",
    "loop-without-end": "WHILE[1 EQ 2]DO1",
    "end-without-loop": "END1",
    "mixed-logic": "#1=3+4 AND 6",
}
_SUB = "O2\nG0 X30.\n{}\nM99{}\n"
_COUNTS = "#1=0\nN10 G0 X#1\n#1=#1+1\nIF[1 EQ 1]GOTO 10"
#: Kind -> statements from line 3 on, what stands behind the M30, and the lines of the findings.
_OTHERS: dict[str, tuple[str, str, list[int]]] = {
    "loop-number": ("WHILE[1 EQ 2]DO4\nEND4", "", [3, 4]),
    "loops-crossed": ("DO1\nDO2\nIF[1 EQ 1]GOTO 9\nEND1\nN9", "", [4]),
    "loop-inside-itself": ("WHILE[1 EQ 2]DO1\nWHILE[1 EQ 2]DO1\nEND1\nEND1", "", [4]),
    "loop-levels": ("WHILE[1 EQ 2]DO1\nWHILE[1 EQ 2]DO2\nEND2\nEND1", "", [4]),
    "argument-address": ("G65 P2 A1. G1", _SUB.format("", ""), [3]),
    "argument-sets": ("G65 P2" + " I1." * 11, _SUB.format("", ""), [3]),
    "call-levels": ("M98 P2", _SUB.format("M98 P2", ""), [7]),
    "return-target-not-found": ("M98 P2", _SUB.format("", " P20"), [8]),
    "too-many-repeats": ("M98 P2 L9999", _SUB.format("", ""), [3]),
    "nothing-changes": ("N10 G0 X40.\nIF[1 EQ 1]GOTO 10", "", [4]),
    "too-many-blocks": (_COUNTS, "", [5]),
    "too-many-statements": (_COUNTS, "", [4]),
    "runs-too-long": (_COUNTS, "", [6]),
    "sequence-number-twice": ("IF[1 EQ 2]GOTO 10\nN10\nN10", "", [3]),
    "loop-never-run": ("WHILE[1 EQ 2]DO1\nG0 X40.\nEND1", "", [3]),
    "never-run": ("GOTO 10\nG0 X40.\nN10", "", [4]),
}
FAULTS = {kind: (statement, "", [3]) for kind, statement in _ONE_STATEMENT.items()} | _OTHERS
#: Kinds that no rule reports.
UNREPORTED = {"word-format": "G0 X[20] Z--5.", "stray-character": "G0 X[20] ? Y5."}
#: Kinds of the languages of other controls.
OF_LANGUAGES = {"label-not-found", "label-too-long", "structure-without-end", "end-without-structure"}
#: Bounds that some of them reach, and limits of the control.
RUNNING: dict[str, dict[str, Any]] = {
    "too-many-repeats": {"max_blocks": 100},
    "too-many-blocks": {"max_blocks": 100},
    "too-many-statements": {"max_statements": 100},
    "runs-too-long": {"max_seconds": 1e-9},
}
CHANGES = {"loop-levels": {"macro": {"loop_levels": 1}}}


def test_the_table_has_all_kinds_and_only_rules_that_there_are() -> None:
    assert set(RULES) == KINDS == set(FAULTS) | set(UNREPORTED) | OF_LANGUAGES
    macro = {name for name, rule in load_all().items() if rule.group == "macro"}
    assert set(RULES.values()) == macro | {""}


@looped("kind", UNREPORTED)
def test_what_other_dialects_write_is_found_and_is_no_fault(kind: str) -> None:
    program = f"O1\nG0 X50.\n{UNREPORTED[kind]}\nM30\n"
    assert not report_of(program, only=["macro"]).findings
    faults: Faults = tables_of(program)["faults"]
    assert set(faults.kind) == {kind}
    assert set(faults.rule) == {""}


@looped(
    ("machine", "block", "name"),
    [
        ("fanuc-30i", "G1 X=60.", "X=60."),
        ("fanuc-30i", "G1 X=", "X="),
        ("fanuc-30i", "X=C", "X=C"),
        ("fanuc-30i", "G1 X60. CR=10.", "CR=10."),
        ("fanuc-30i", "G1 X60. Z#1 Y--5.", "Y--5."),
        ("citizen", "G1 X60. E=S", "E=S"),
        ("mazak-quick-turn", "G1 X = 60.", "X=60."),
    ],
)
def test_a_word_of_which_nobody_knows_what_the_control_makes_is_not_evaluated_by_name(
    machine: str, block: str, name: str
) -> None:
    report = report_of(f"O1\n#1=0\nG98 G0 X50.\n{block} F100\nM30\n", machine, only=["macro"])
    assert [(told.reason, told.matters) for told in report.not_evaluated] == [(f"{name} is not simulated", True)]
    assert report.verdict == "unverified"


def test_nothing_is_judged_by_an_axis_whose_word_was_lost() -> None:
    program = "G98 G40\nT0101\nG0 X120. C0 Z5.\nG12.1\nG1 X=40. F200\nC10.\nX120.\nG13.1\nM30\n"
    path = tables_of(program, "fanuc-30i", "1:radius=5")["trace"].path.end
    assert np.isnan(path[4:6]).all()


@pytest.mark.ci
@looped("kind", sorted(FAULTS), one_in=6)
def test_a_kind_is_reported_by_its_rule(kind: str) -> None:
    statements, behind, lines = FAULTS[kind]
    program = f"O1\nG0 X50.\n{statements}\nM30\n{behind}"
    job = {"run": RUNNING.get(kind, {})}
    report = report_of(program, changes=CHANGES.get(kind), job=job)
    assert said(report) == [(line, RULES[kind]) for line in lines]  # type: ignore[index]
    faults: Faults = tables_of(program, changes=CHANGES.get(kind), job=job)["faults"]
    assert set(faults.kind) == {kind}
    assert not any("{" in finding.message for finding in report.findings)


def test_a_rule_reports_a_place_once() -> None:
    """The divisor is 0 at first, then the result too large: one place, one rule, one finding; the table has both."""
    program = "O1\n#1=0\n#2=EXP[100]\nN10 #3=#2/#1\n#1=EXP[-20]\n#4=#4+1\nIF[#4 LT 2]GOTO 10\nM30\n"
    assert said(report_of(program)) == [(4, "arithmetic-error")]
    faults: Faults = tables_of(program)["faults"]
    assert list(zip(faults.kind, faults.rule, strict=True)) == [("zero-divide", "arithmetic-error"), ("overflow", "")]


GIVE = "; [run.variables] in polarcheck.toml gives variables, as in 500 = 1.5"


@looped(
    ("statement", "reason"),
    [
        ("#3000=1(RADIUS)", f"the program stops itself with #3000{GIVE}"),
        ("#3006=1(TURN)", f"the program stops itself with #3006{GIVE}"),
        (
            "IF[#500 EQ 1]GOTO 20",
            f"the condition depends on a value that is not known, and is taken as not fulfilled{GIVE}",
        ),
        ("M98 P#500", f"which program is called depends on a value that is not known{GIVE}"),
        ("M99 P20", "M99 P in the main program jumps and is taken as the end: check what follows it yourself"),
    ],
)
def test_what_a_run_does_not_know_is_said(statement: str, reason: str) -> None:
    report = report_of(f"O1\nG0 X50.\n{statement}\nN20 M30\n")
    assert [(entry.rule, entry.reason, entry.blocks) for entry in report.not_evaluated] == [("all", reason, 1)]


def test_messages_show_long_statements_in_part() -> None:
    (finding,) = report_of(f"O1\n#1=SQRT[-1{'+0' * 500}]\nM30\n").findings
    assert finding.message.startswith("#1=SQRT[-1+0+0")
    assert len(finding.message) < 200


@pytest.mark.nightly
@looped("machine", ["fanuc", "gsk-988", "siemens-iso"])
def test_an_if_that_a_control_does_not_know_is_one_finding(machine: str) -> None:
    is_siemens = machine.startswith("siemens")
    head = "G0 X80." if is_siemens else "#1=6\nIF [#1 GT 5]\nG0 X80."
    report = report_of(f"O1\nG21 G40 G97\n{head}\nELSE\nG0 X70.\nENDIF\nM30\n", machine)
    assert [found.rule for found in report.findings] == ["loop-unbalanced" if is_siemens else "macro-syntax"]


@pytest.mark.nightly
@looped(
    ("machine", "blocks", "rule"),
    [
        ("fanuc", "#2=FOO+1\n#3=FOO*2", "macro-syntax"),
        ("fanuc", "FOO(1)\nFOO(2)", "bad-number"),
        ("okuma-osp", "X=FOO\nZ=FOO", "vacant-variable"),
        ("fanuc", "G1 X#101 F100\nZ#101", "vacant-variable"),
    ],
)
def test_a_name_that_is_not_known_is_one_finding(machine: str, blocks: str, rule: str) -> None:
    report = report_of(f"O1\nG21 G40 G97\n{blocks}\nM30\n", machine)
    assert [(found.rule, found.count) for found in report.findings if found.severity != "note"] == [(rule, 2)]
    other = report_of(f"O1\nG21 G40 G97\n{blocks.replace('FOO', 'BAR', 1).replace('#101', '#102', 1)}\nM30\n", machine)
    assert [found.rule for found in other.findings if found.severity != "note"] == [rule, rule]
