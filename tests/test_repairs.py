"""What a finding offers to write instead: the edits of its fix, by the examples of each repair and beyond."""

from __future__ import annotations

import re
from collections.abc import Iterable
from itertools import pairwise

import pytest
from programs import report_of, report_of_example, said

from polarcheck.checking.examples import Example, examples
from polarcheck.checking.finding import Edit, FileReport, Finding, Fix
from polarcheck.checking.repair import CHANGES, repair_of, repairs
from polarcheck.checking.rule import load_all

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


@pytest.mark.parametrize("name", PAGES)
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


@pytest.mark.parametrize(("name", "bad", "good"), pairs())
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


@pytest.mark.parametrize("end", ["\r\n", "\n\r\r", "\r\r\n", "\r"])
@pytest.mark.parametrize(("name", "bad", "good"), pairs())
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
