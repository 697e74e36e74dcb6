"""Every rule is complete, and its manual page is true."""

from __future__ import annotations

import ast
import functools
import inspect
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from cases import looped
from programs import machine_of, report_of_example, report_of_whole_example, said
from syrupy.assertion import SnapshotAssertion

from polarcheck.foundation.finding import SEVERITIES
from polarcheck.program.machines import profiles
from polarcheck.rules.examples import Example, examples
from polarcheck.rules.rule import OVER, Hits, Rule, load_all

RULES = load_all()


@pytest.mark.one_in(1)
@pytest.mark.parametrize("rule", RULES.values(), ids=list(RULES))
def test_examples_give_exactly_their_findings(rule: Rule) -> None:
    for example in examples(rule.page):
        assert said(report_of_whole_example(example)) == sorted(example.expected), example.program


@looped("rule", RULES.values(), ids=list(RULES))
def test_rule_is_complete(rule: Rule) -> None:
    found = examples(rule.page)
    assert rule.title
    assert rule.source
    assert len(rule.page.split("\n\n")) > 3, "the page says what happens and what to do"
    assert any(not example.good for example in found)
    assert any(example.good for example in found)
    for example in found:
        named = [name for _, name in example.expected]
        assert (rule.name in named) != example.good
        assert example.good <= (not named)
    assert rule.over in OVER
    assert not re.match(r"no-(?!offset|compensation|tool)|disallow", rule.name)


@pytest.mark.ci
@pytest.mark.parametrize("rule", RULES.values(), ids=list(RULES))
@looped("value", [True, False])
def test_a_constant_mask_fails(rule: Rule, value: bool) -> None:
    """A rule that always or never fires is found out by its own examples."""
    from msgspec.structs import replace

    def constant(*arguments: Any) -> Any:
        found = rule.function(*arguments)
        hits = found if isinstance(found, Hits) else Hits(found)
        return replace(hits, mask=np.full_like(hits.mask, value), severity=None, at=None)

    changed = replace(rule, function=constant, follows={})

    def is_right(example: Example) -> bool:
        expected = sorted(place for place in example.expected if place[1] == rule.name)
        try:
            return said(report_of_example(example, only=[changed])) == expected
        except (ValueError, TypeError, IndexError, KeyError, OverflowError):
            return False  # a message about a row that has nothing to say

    assert not all(map(is_right, examples(rule.page)))


@functools.cache
def own_severities(name: str) -> list[list[str]]:
    """The severities of what a rule finds in each of its examples, in the order of the program, without other rules."""
    rule = RULES[name]
    reports = [report_of_example(example, only=[rule]) for example in examples(rule.page)]
    return [[finding.severity for finding in report.findings] for report in reports]


@pytest.mark.nightly
def test_severities_are_the_golden_ones(snapshot: SnapshotAssertion) -> None:
    """A line for each rule: what it is listed with, and what it gives in each of its examples."""
    lines = [
        f"{rule.name} ({rule.severity.name.lower()}): "
        + "; ".join(", ".join(found) or "-" for found in own_severities(rule.name))
        for rule in RULES.values()
    ]
    assert "\n".join(lines) == snapshot


def named_severities(rule: Rule) -> Iterator[str]:
    """Those that stand in its function: as a name, or as an argument of `graded`."""
    for node in ast.walk(ast.parse(inspect.getsource(rule.function))):
        if isinstance(node, ast.Name) and node.id.lower() in SEVERITIES:
            yield node.id.lower()
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "graded":
            yield from (word.arg for word in node.keywords if word.arg in SEVERITIES)


@pytest.mark.ci
@pytest.mark.parametrize("rule", RULES.values(), ids=list(RULES))
def test_each_severity_of_a_rule_is_seen_in_its_examples(rule: Rule) -> None:
    graded = set(named_severities(rule)) - {rule.severity.name.lower()}
    assert not graded or graded <= {severity for found in own_severities(rule.name) for severity in found}


def test_every_alarm_and_severity_of_a_machine_names_a_rule() -> None:
    for name in profiles.names():
        machine = machine_of(name)
        assert set(machine.alarms) | set(machine.severities) <= set(RULES), name
