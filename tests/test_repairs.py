"""What a finding offers to write instead: the edits of its fix, by the examples of each repair and beyond."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise
from pathlib import Path

import pytest
from cases import looped
from programs import report_of, report_of_example, said

from polarcheck.foundation.finding import Edit, FileReport, Finding, Fix
from polarcheck.rules.examples import Example, examples
from polarcheck.rules.repair import CHANGES, repair_of, repairs
from polarcheck.rules.rule import load_all

#: The coverage counts all of its cases: each is a way of its own through the package.
pytestmark = pytest.mark.one_in(1)

PAGES = {name: found.page for name in repairs() for found in [repair_of(name)] if found is not None}


def edited(program: str, fixes: Iterable[Fix | None]) -> str:
    """The program with all edits of some fixes that do not overlap."""
    starts = [0, *(found.end() for found in re.finditer("\n" if "\n" in program else "\r", program)), len(program)]

    def span(edit: Edit) -> tuple[int, int, str]:
        return starts[edit.line - 1] + edit.column - 1, starts[edit.end_line - 1] + edit.end_column - 1, edit.text

    spans = {span(edit) for fix in fixes if fix is not None for edit in fix.edits}
    for start, end, text in sorted(spans, reverse=True):
        program = program[:start] + text + program[end:]
    return program


def fixed(program: str, rule: str, machine: str = "fanuc", *tools: str, **more: object) -> str:
    """The program with the fixes of all findings of one rule."""
    report = report_of(program, machine, *tools, only=[rule], **more)  # type: ignore[arg-type]
    return edited(program, fixes_of(report, rule))


def fixes_of(report: FileReport, rule: str) -> list[Fix | None]:
    return [found.fix for found in report.findings if found.rule == rule]


def fix_of(report: FileReport, rule: str) -> Fix:
    (found,) = fixes_of(report, rule)
    assert found is not None
    return found


# ---- the examples ----


def pairs() -> list[tuple[str, Example, Example]]:
    return [(name, bad, good) for name, page in PAGES.items() for bad, good in list(pairwise(examples(page)))[::2]]


@looped("name", PAGES)
def test_each_repair_is_of_a_rule_and_has_a_page(name: str) -> None:
    found = repair_of(name)
    assert found is not None
    assert found.name == name
    assert name in load_all()
    assert set(found.changes) <= set(CHANGES)
    assert re.match(r"[A-Z].*[^.]\.\n\n(.*\n)*.*(Unsafe|Safe)", found.page)
    kinds = [example.good for example in examples(found.page)]
    assert kinds
    assert kinds == [False, True] * (len(kinds) // 2)


@pytest.mark.nightly
@looped(("name", "bad", "good"), pairs(), one_in=12)
def test_the_fix_makes_the_bad_example_the_good_one(name: str, bad: Example, good: Example) -> None:
    assert (bad.machine, bad.tools, bad.settings) == (good.machine, good.tools, good.settings)
    report = report_of_example(bad)
    fixes = fixes_of(report, name)
    assert fixes
    assert None not in fixes
    assert edited(bad.program, fixes) == good.program
    assert name not in {found.rule for found in report_of_example(good).findings}
    others = [found.rule for found in report.findings if found.rule != name]
    assert sorted(others) == sorted(rule for _, rule in said(report_of_example(good)))


@pytest.mark.nightly
@looped("end", ["\r\n", "\n\r\r", "\r\r\n", "\r"], one_in=14)
@looped(("name", "bad", "good"), pairs())
def test_lines_keep_their_ends(name: str, bad: Example, good: Example, end: str) -> None:
    def with_ends(example: Example) -> Example:
        return Example(
            example.good, example.machine, example.tools, example.settings, example.program.replace("\n", end), ()
        )

    ended = with_ends(bad)
    assert edited(ended.program, fixes_of(report_of_example(ended), name)) == with_ends(good).program


def test_a_finding_without_a_repair_has_no_fix() -> None:
    (found,) = report_of(
        "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG28 U0\nG13.1\n", only=["code-not-allowed-in-polar"]
    ).findings
    assert isinstance(found, Finding)
    assert found.fix is None


def test_g1_in_place_of_g0_is_no_safe_fix_even_where_the_block_has_an_f() -> None:
    report = report_of("G98 G0 X60. C0\nG12.1\nG0 X40. F200\nG1 C5.\nG13.1\n", only=["rapid-in-polar"])
    assert not fix_of(report, "rapid-in-polar").safe


def test_nothing_is_written_before_a_switch_that_is_computed() -> None:
    rule = "polar-switched-in-offset-mode"
    program = "#1=12.1\nT0101\nG98 G0 X60. C0\nG42\nG#1\nG1 X40. F200\nC10.\nG40 X60.\nG13.1\n"
    assert fixes_of(report_of(program, "fanuc", "1:radius=4", only=[rule]), rule) == [None]


@looped(("entry", "is_mended"), [("X60. Z2. C0", True), ("X60. C0", False)])
def test_z_is_moved_only_where_it_is_known_whether_it_goes_in_or_comes_out(entry: str, is_mended: bool) -> None:
    rule = "z-with-plane-axis"
    program = f"G98 G0 {entry}\nG12.1\nG1 X40. Z-5. F200\nC10.\nX60.\nG13.1\n"
    assert [fix is not None for fix in fixes_of(report_of(program, only=[rule]), rule)] == [is_mended]


# ---- programs of other kinds ----

#: Inch and mm, with N words and without blanks, semicolons, comments, block skip; the rule, the machine, the program
#: and what it is with the fixes of that rule.
CASES = [
    (
        "wrong-dash",
        "haas-lathe",
        "G20 G98 G17 G0 X2. Y0\nG112\nG1 X1.5 F8.\nY−1. (X–2.)\nX2.\nG113\n",
        "G20 G98 G17 G0 X2. Y0\nG112\nG1 X1.5 F8.\nY-1. (X–2.)\nX2.\nG113\n",
    ),
    (
        "wrong-dash",
        "fanuc",
        "N1 G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC—14.\nC—15.\nC—16.\nC—17.\nC—18.\nC—19.\nG13.1\n",
        "N1 G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC-14.\nC-15.\nC-16.\nC-17.\nC-18.\nC-19.\nG13.1\n",
    ),
    (
        "wrong-dash",
        "fanuc",
        "G98 G0 X60. C0\nG12.1\nG1 X–40.C–10.F200\nG13.1\nG0 Z–5.\n",
        "G98 G0 X60. C0\nG12.1\nG1 X-40.C-10.F200\nG13.1\nG0 Z-5.\n",
    ),
    (
        "letter-for-digit",
        "turning-center",
        "G20 G98 G0 X2.O CO\nG18\nG12.1\nG1 X1.5 F8.\nC-O.5\nG13.1\n",
        "G20 G98 G0 X2.0 C0\nG18\nG12.1\nG1 X1.5 F8.\nC-0.5\nG13.1\n",
    ),
    (
        "letter-for-digit",
        "fanuc",
        "O0001\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nXI0. (OIL)\nG13.1\nM3O\n",
        "O0001\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nX10. (OIL)\nG13.1\nM30\n",
    ),
    (
        "letter-for-digit",
        "fanuc",
        "O0001\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X4O. F2OO\nC1O.\nC2O.\nC3O.\nC4O.\nC5O.\nGI3.1\nM30\n",
        "O0001\nT0101\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nC20.\nC30.\nC40.\nC50.\nG13.1\nM30\n",
    ),
    (
        "polar-switch-not-alone",
        "gsk-988",
        "G98 G0 X60. C0\nG12.1 P1 Q3 M8\nG1 X40. F200\nC10.\nX60.\nG13.1 P1 Q3\n",
        "G98 G0 X60. C0\nG12.1 P1 Q3\nM8\nG1 X40. F200\nC10.\nX60.\nG13.1 P1 Q3\n",
    ),
    (
        "polar-switch-not-alone",
        "fanuc",
        "G98 G0 X60. C0 Z5.\n/N20M8G12.1(ON)\nG1X40.F200\nC10.\nX60.\n/2 N30G13.1G0Z50.\n",
        "G98 G0 X60. C0 Z5.\n/N20M8\n/G12.1(ON)\nG1X40.F200\nC10.\nX60.\n/2 N30G13.1\n/2G0Z50.\n",
    ),
    (
        "polar-switch-not-alone",
        "fanuc",
        "G20 G98 G18;\nG0 X2.4 C0;\nG12.1 S500; G1 X2.2 F8.;\nC.4;\nX2.4;\nG13.1 M9; M5;\n",
        "G20 G98 G18;\nG0 X2.4 C0;\nG12.1;\nS500; G1 X2.2 F8.;\nC.4;\nX2.4;\nG13.1;\nM9; M5;\n",
    ),
    (
        "polar-switch-not-alone",
        "fanuc",
        "G98 G0 Z5.\nG0 X60. C0 G12.1\nG1 X40. F200\nC10.\nG1 X60. G13.1\nG0 Z50.\n",
        "G98 G0 Z5.\nG0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nG1 X60.\nG13.1\nG0 Z50.\n",
    ),
    (
        "plane-selected-in-polar",
        "mitsubishi-m700",
        "G98 G0 X60. C0\nG12.1\nN5 G17\n/G17\nG1 X40. F200\nG17G3X30.C5.I-5.J0 (ARC)\nX60. G17\nG13.1\n",
        "G98 G0 X60. C0\nG12.1\nN5\nG1 X40. F200\nG3X30.C5.I-5.J0 (ARC)\nX60.\nG13.1\n",
    ),
    (
        "plane-selected-in-polar",
        "turning-center",
        "G20 G98 G18 G0 X2.4 C0\nG12.1\nG18\nG17\nG1 X1.6 F40.\nG1 G41 X.8 C.4 F5.\nC-.4\nG40 X2.4\nG13.1\n",
        "G20 G98 G18 G0 X2.4 C0\nG12.1\nG18\nG1 X1.6 F40.\nG1 G41 X.8 C.4 F5.\nC-.4\nG40 X2.4\nG13.1\n",
    ),
    (
        "plane-selected-in-polar",
        "fanuc",
        "G98 G0 X60. C0;\nG12.1; G17; G1 X40. F200;\nG17 ;\nG1 X60.; G13.1;\n",
        "G98 G0 X60. C0;\nG12.1; G1 X40. F200;\nG1 X60.; G13.1;\n",
    ),
    (
        "polar-switched-in-offset-mode",
        "haas-lathe",
        "G20 G98 G17\nT101\nG0 X4. Y0\nG112\nG1 G41 X2. F8.\nY-1.\nX4.\nG113\n",
        "G20 G98 G17\nT101\nG0 X4. Y0\nG112\nG1 G41 X2. F8.\nY-1.\nG40 X4.\nG113\n",
    ),
    (
        "polar-switched-in-offset-mode",
        "fanuc",
        "T0101\nN1 G98 G0 X60. C0\nN2 G42\n/N3 G12.1\nN4 G1 X40. F200\nN5 C10.\nN6 G40 X60.\n/N7 G13.1\n",
        "T0101\nN1 G98 G0 X60. C0\nN2 G42\n/G40\n/N3 G12.1\nN4 G1 X40. F200\nN5 C10.\nN6 G40 X60.\n/N7 G13.1\n",
    ),
    (
        "polar-switched-in-offset-mode",
        "fanuc",
        "T0101\nG98G0X60.C0\nG12.1\nG1G41X40.F200\nC-10.\nX60.F1000 (OUT)\nG13.1\n",
        "T0101\nG98G0X60.C0\nG12.1\nG1G41X40.F200\nC-10.\nG40X60.F1000 (OUT)\nG13.1\n",
    ),
    (
        "stray-character",
        "siemens-iso",
        "G94 G0 X60. C0\nG12.1\nG1 X40. F200,5\nG13.1\n",
        "G94 G0 X60. C0\nG12.1\nG1 X40. F200.5\nG13.1\n",
    ),
    (
        "stray-character",
        "fanuc",
        "G98 G0 X60. C0 &\nG12.1\nG1 X40,5 C-1,25 F200 ; &\nC0\nG13.1\n",
        "G98 G0 X60. C0 &\nG12.1\nG1 X40.5 C-1.25 F200 ; &\nC0\nG13.1\n",
    ),
    (
        "stray-character",
        "gsk-988",
        "(X1,5)\nG98 G0 X60,0 C0\nG12.1\nG1 X40. F200\nG13.1\n",
        "(X1,5)\nG98 G0 X60.0 C0\nG12.1\nG1 X40. F200\nG13.1\n",
    ),
    (
        # The next move of the section says the F; its limit of C lowers it, and it is written again.
        "rapid-in-polar",
        "fanuc",
        "G98 F999 G0 X60. C0\nG12.1\nG0 X40.\nG1 X39. F200\nG0 C5.\nG1 C-5.\nG13.1\n",
        "G98 F999 G0 X60. C0\nG12.1\nG1 X40. F200\nG1 X39. F200\nG1 C5.\nG1 C-5.\nG13.1\n",
    ),
    (
        "rapid-in-polar",
        "fanuc",
        "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C5. F1000\nG1 C-5. F200\nG13.1\n",
        "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nG1 C5. F1000\nG1 C-5. F200\nG13.1\n",
    ),
    (
        "rapid-in-polar",
        "turning-center",
        "G21 G98 G18 G0 X60. C0\nG12.1\nG18\nG1 X50. F200\nN50G00C12.\nG1C10.\nG0 X60.\nG13.1\nG0 Z50.\n",
        "G21 G98 G18 G0 X60. C0\nG12.1\nG18\nG1 X50. F200\nN50G01C12.F762\nG1C10.F200\nG1 X60. F762\nG13.1\nG0 Z50.\n",
    ),
    (
        "rapid-in-polar",
        "turning-center",
        "G20 G98 G18 G0 X2.4 C0\nG12.1\nG18\nX2.2 (SLOW)\nG1 C.4 F8.\nG13.1\n",
        "G20 G98 G18 G0 X2.4 C0\nG12.1\nG18\nG1 X2.2 F30. (SLOW)\nG1 C.4 F8.\nG13.1\n",
    ),
    (
        "polar-switch-unknown",
        "fanuc",
        "G98 G0 X60. C0\nG12\nG1 X40. F200\nC10.\nX60.\nG13.1\n",
        "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1\n",
    ),
    (
        "polar-switch-unknown",
        "mazak-quick-turn",
        "G98 G0 X60. C0\nG17 XC\nG121\nG1 U-20. F200\nH10.\nX60.\nG131\n",
        "G98 G0 X60. C0\nG17 XC\nG12.1\nG1 U-20. F200\nH10.\nX60.\nG13.1\n",
    ),
    (
        "polar-switch-unknown",
        "turning-center",
        "G20 G98 G18 G0 X2.4 C0\nN5G121(ON)\nG18\nG1 X2. F20.\nC.5\nX2.4\nG131\n",
        "G20 G98 G18 G0 X2.4 C0\nN5G12.1(ON)\nG18\nG1 X2. F20.\nC.5\nX2.4\nG13.1\n",
    ),
    (
        "z-with-plane-axis",
        "haas-lathe",
        "T101\nG20 G98 G17 G0 X2.4 Y0 Z.1\nG112\nG1 G41 X2. Z-.2 F15.\nY.5\nX1.5 Z.1 M9\nG1 G40 X2.4\nG113\n",
        "T101\nG20 G98 G17 G0 X2.4 Y0 Z.1\nG112\nG1 G41 X2. F15.\nZ-.2\nY.5\nZ.1 M9\nX1.5\nG1 G40 X2.4\nG113\n",
    ),
    (
        "z-with-plane-axis",
        "turning-center",
        "G20 G98 G18 G0 X2.4 C0 Z.1\nG12.1\nG18\n/N10G1X2.W-.3F15.(IN)\nC.5\nN20G1X2.4W.3\nG13.1\n",
        "G20 G98 G18 G0 X2.4 C0 Z.1\nG12.1\nG18\n/N10G1X2.F15.(IN)\n/W-.3\nC.5\nN20G1X2.4W.3\nG13.1\n",
    ),
    (
        "z-with-plane-axis",
        "fanuc",
        "T0101\nG98 G0 X60. C0 Z2.;\nG12.1;\nG1 G41 X40. Z-5. F200;\nC-10.;\nG40 X60. Z2.;\nG13.1;\n",
        "T0101\nG98 G0 X60. C0 Z2.;\nG12.1;\nG1 G41 X40. F200;\nZ-5.;\nC-10.;\nZ2.;\nG40 X60.;\nG13.1;\n",
    ),
    (
        "c-feed-above-limit",
        "fanuc",
        "G20 G98 G0 X2.4 C0\nG12.1\nG1 X2. C.2 F20.\nX.2\nC-.2 (CUT)\nX2.\nG13.1\nG1 Z1.\n",
        "G20 G98 G0 X2.4 C0\nG12.1\nG1 X2. C.2 F20.\nX.2 F6.28\nC-.2 (CUT)\nX2.\nG13.1\nG1 Z1. F20.\n",
    ),
    (
        "c-feed-above-limit",
        "haas-lathe",
        "G98 G17 G0 X60. Y0\nG112\nG1 X4. Y5. F100.\nN7Y-5.F500.\nX60.\nG113\n",
        "G98 G17 G0 X60. Y0\nG112\nG1 X4. Y5. F100.\nN7Y-5.F251.\nX60. F500.\nG113\n",
    ),
    (
        "c-feed-above-limit",
        "fanuc",
        "G98 G0 X60. C0\nG12.1\nG1 X40. C2. F500\nX-40.\nC3.\nX40.\nC4.\nG13.1\n",
        "G98 G0 X60. C0\nG12.1\nG1 X40. C2. F500\nX-40. F125\nC3. F500\nX40. F125\nC4. F500\nG13.1\n",
    ),
    (
        "polar-never-left",
        "haas-lathe",
        "G20 G98 G17 G0 X2.4 Y0\nG112\nG1 X2. F8.\nN30Y.5\n\nN40G0Z2.\nM30\n",
        "G20 G98 G17 G0 X2.4 Y0\nG112\nG1 X2. F8.\nN30Y.5\nG113\n\nN40G0Z2.\nM30\n",
    ),
    (
        "polar-never-left",
        "fanuc",
        "O1;\nG98 G0 X60. C0;\nG12.1;\nG1 X40. F200;\nC10.; X60.; G0 Z50.;\nM30;\n",
        "O1;\nG98 G0 X60. C0;\nG12.1;\nG1 X40. F200;\nC10.; X60.;\nG13.1; G0 Z50.;\nM30;\n",
    ),
    (
        "polar-never-left",
        "fanuc",
        "O1\nG98 G0 X60. C0\n/G12.1\nG1 X40. F200\nC10.\nX60.\nM30\nO2\nG12.1\nG1 X5. C2.F200",
        "O1\nG98 G0 X60. C0\n/G12.1\nG1 X40. F200\nC10.\nX60.\n/G13.1\nM30\nO2\nG12.1\nG1 X5. C2.F200\nG13.1",
    ),
    (
        "number-without-point",
        "turning-center",
        "G20 G98 G18 G0 X2.4 C0\nG12.1\nG18\nG1 X2. F8.\nN9C1(ONE)\nX2.4\nG13.1\n",
        "G20 G98 G18 G0 X2.4 C0\nG12.1\nG18\nG1 X2. F8.\nN9C1.(ONE)\nX2.4\nG13.1\n",
    ),
    (
        "number-without-point",
        "fanuc",
        "G98 G0 X60 C0\nG12.1\nG1 X40 C10 F200\nX-40\nX60.\nG13.1\n",
        "G98 G0 X60. C0\nG12.1\nG1 X40. C10. F200\nX-40.\nX60.\nG13.1\n",
    ),
    (
        "number-without-point",
        "fanuc",
        "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC20.\nZ1000\nX-4\nG13.1\n",
        "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC20.\nZ1000\nX-4.\nG13.1\n",
    ),
]


@pytest.mark.ci
@looped(("rule", "machine", "program", "good"), CASES, one_in=8)
def test_fixes_of_programs_of_any_kind(rule: str, machine: str, program: str, good: str) -> None:
    tool = "1:radius=0.2" if "G20" in program else "1:radius=4"
    report = report_of(program, machine, tool, changes={"limits": {"c_feed": 3600}})
    assert edited(program, fixes_of(report, rule)) == good


@looped("rule", PAGES)
def test_each_repair_is_tried_on_three_programs(rule: str) -> None:
    of_rule = [(machine, program) for name, machine, program, _ in CASES if name == rule]
    assert len(of_rule) + sum(not example.good for example in examples(PAGES[rule])) > 3
    assert len({machine for machine, _ in of_rule}) > 1


# ---- where there is no fix ----


@pytest.mark.ci
@looped(
    ("rule", "machine", "program"),
    [
        # Macro: the words do not stand in the file as they are executed.
        ("rapid-in-polar", "fanuc", "#1=5.\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nG0 C#1 F500\nG1 C-5.\nG13.1\n"),
        ("c-feed-above-limit", "fanuc", "#1=500\nG98 G0 X60. C0\nG12.1\nG1 X4. C2. F#1\nX-4.\nG13.1\n"),
        ("z-with-plane-axis", "fanuc", "#1=5.\nG98 G0 X60. Z2. C0\nG12.1\nG1 X40. Z-#1 F200\nC5.\nG13.1\n"),
        # Nobody knows whether Z goes in or comes out.
        ("z-with-plane-axis", "fanuc", "G98 G0 X60. C0\nG12.1\nG1 X40. Z-5. F200\nC5.\nG13.1\n"),
        # No F for positioning, or none to go on with.
        ("rapid-in-polar", "fanuc", "G98 F200 G0 X60. C0\nG12.1\nG0 X40.\nG0 C5.\nG13.1\n"),
        ("rapid-in-polar", "fanuc", "G99 G0 X60. C0\nG12.1\nG1 X40. F.2\nG0 C5.\nG1 C-5.\nG13.1\n"),
        ("stray-character", "fanuc", "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC5.,5\nG13.1\n"),
        ("stray-character", "fanuc", "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC5 &\nG13.1\n"),
        ("rapid-in-polar", "turning-center", "G98 G18 G0 X60. C0\nG12.1\nG18\nG0 X50.\nG1 C5.\nG13.1\n"),
        # G0 is still in force outside the mode.
        ("rapid-in-polar", "turning-center", "G98 G18 G0 X60. C0\nG12.1\nG18\nX50.\nG13.1\nZ50.\n"),
        # The program does not say where the tool should leave the contour.
        (
            "polar-switched-in-offset-mode",
            "fanuc",
            "T0101\nG98 G0 X60. C0\nG12.1\nG1 G41 X40. F200\nC-10.\nG13.1\n",
        ),
        # Numbers of 1000 and more may be least increments; P and Q mean nothing by themselves.
        ("number-without-point", "fanuc", "G98 G0 X60000 C0\nG12.1\nG1 X40000 F200\nC20000\nX-40000\nG13.1\n"),
        # 200 inch/min is no feed of this lathe; 2 inch/min, as the control takes it, is.
        ("number-without-point", "turning-center", "G98 G18 G0 X3. C0\nG12.1\nG18\nG1 X2. F200\nC.5\nG13.1\n"),
        ("polar-switch-not-alone", "gsk-988", "G98 G0 X60. C0\nG12.1\nG1 X40. F200\nC10.\nX60.\nG13.1 P1 Q3\n"),
    ],
    one_in=3,
)
def test_no_fix_where_nobody_can_say_what_to_write(rule: str, machine: str, program: str) -> None:
    report = report_of(program, machine, "1:radius=4", changes={"limits": {"c_feed": 3600}})
    assert None in fixes_of(report, rule)


def test_no_fix_of_a_feed_without_the_limit_of_the_machine() -> None:
    program = "G98 G0 X60. C0\nG12.1\nG1 C.1 F50\nX-40. F1000\nG13.1\n"
    assert fixes_of(report_of(program), "c-feed-above-limit") == [None]


LOOP = "#1=0\nG98 G0 X60. C0\n{}WHILE [#1 LT 2] DO1\n{}\n#1=#1+1\nEND1\nG1 X60. F200\nG13.1\nM30\n"


def test_a_block_that_runs_more_often_has_a_fix_where_its_runs_agree() -> None:
    body = "G1 X40. Z-1. F200\nX50. Z1."
    report = report_of(LOOP.format("Z2.\nG12.1\n", body))
    assert [fix is None for fix in fixes_of(report, "z-with-plane-axis")] == [False, False]


def test_a_block_that_runs_more_often_has_none_where_they_do_not() -> None:
    # On the first way it goes in, on the second it comes out.
    body = "G1 X[40.+#1] F200\nC5.\nG1 X50. Z-1. C[#1]\nZ-2."
    program = LOOP.format("Z2.\nG12.1\n", body).replace("C[#1]", "C0")
    assert fixes_of(report_of(program), "z-with-plane-axis") == [None]


def test_a_block_that_also_runs_outside_the_mode_has_none() -> None:
    program = "O1\nG98 G0 X60. C0\nM98 P2\nG12.1\nG1 X40. F200\nM98 P2\nG1 X60.\nG13.1\nM30\nO2\nG0 X50. F500\nM99\n"
    report = report_of(program)
    assert (11, "rapid-in-polar") in said(report)
    assert fixes_of(report, "rapid-in-polar") == [None]


def test_what_mends_one_state_of_block_skip_must_not_change_the_other() -> None:
    program = "G98 G0 X60. C0\n/G12.1\nG17\nG1 X40. F200\nC10.\nX60.\n/G13.1\n"
    report = report_of(program, only=["plane-selected-in-polar"])
    assert fixes_of(report, "plane-selected-in-polar") == [None]
    skipped = program.replace("/G12.1", "G12.1").replace("/G13.1", "G13.1").replace("G17", "N5 /G17")
    assert fix_of(report_of(skipped, only=["plane-selected-in-polar"]), "plane-selected-in-polar").title == "Delete G17"


def test_a_program_in_another_file_has_no_fix_here(tmp_path: Path) -> None:
    (tmp_path / "O2").write_text("O2\nG17\nM99\n", "utf-8")
    program = "O1\nG98 G0 X60. C0\nG12.1\nG1 X40. F200\nM98 P2\nX60.\nG13.1\nM30\n"
    job = {"run": {"subprograms": [str(tmp_path)]}}
    report = report_of(program, job=job, path=str(tmp_path / "O1"))
    assert fixes_of(report, "plane-selected-in-polar") == [None]


def test_a_channel_of_several_has_its_fixes_where_they_stand() -> None:
    head = "G98 G0 X60. C0\nG12.1\n"
    program = f"$1\n{head}G1 X40. F200\nX60.\nG13.1\n$2\n{head}G17\nG1 X40. F200\nX60.\nG13.1\n"
    report = report_of(program, "fanuc", changes={"control": {"channel_mark": "$"}})
    assert edited(program, fixes_of(report, "plane-selected-in-polar")) == program.replace("G17\n", "")
