"""Every rule is complete, and its manual page is true."""

from __future__ import annotations

import re
import tomllib
from typing import Any

import numpy as np
import pytest

from polarcheck.checking import check
from polarcheck.checking.finding import FileReport
from polarcheck.checking.rule import TABLES, Example, Rule, examples, load_all
from polarcheck.machines import job, profiles

RULES = load_all()
EXAMPLES = [
    pytest.param(rule, example, id=f"{rule.name}-{number}")
    for rule in RULES.values()
    for number, example in enumerate(examples(rule.page))
]


def settings_of(example: Example) -> tuple[dict[str, Any], dict[str, Any]]:
    """What an example sets, for the machine (limits.c_feed=3600) and for the job (job.stock.diameter=60)."""
    values: dict[str, dict[str, Any]] = {"job": {}, "machine": {}}
    for setting in example.settings:
        key, _, value = setting.partition("=")
        side = "job" if key.startswith("job.") else "machine"
        *folders, last = key.removeprefix("job.").split(".")
        table = values[side]
        for folder in folders:
            table = table.setdefault(folder, {})
        table[last] = tomllib.loads(f"value = {value}")["value"]
    return values["machine"], values["job"]


def report_of(example: Example, only: Rule | None = None, program: str | None = None) -> FileReport:
    for_machine, for_job = settings_of(example)
    profile = profiles.load(example.machine or profiles.DEFAULT, for_machine)
    work = job.from_table(for_job, "example")
    for tool in example.tools:
        work = job.with_tool(work, tool)
    rules = [only] if only else list(RULES.values())
    data = (program if program is not None else example.program).encode()
    return check.check_file(data, profile.machine, work, rules, severities=work.severities)


def said(report: FileReport) -> list[tuple[int, str]]:
    return sorted((finding.line, finding.rule) for finding in report.findings)


@pytest.mark.parametrize(("rule", "example"), EXAMPLES)
def test_example_gives_exactly_its_findings(rule: Rule, example: Example) -> None:
    assert said(report_of(example)) == sorted(example.expected)


@pytest.mark.parametrize("rule", RULES.values(), ids=list(RULES))
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
    assert rule.over in TABLES
    assert not re.match(r"no-(?!offset|compensation|tool)|disallow", rule.name)


@pytest.mark.parametrize("rule", RULES.values(), ids=list(RULES))
@pytest.mark.parametrize("value", [True, False])
def test_a_constant_mask_fails(rule: Rule, value: bool) -> None:
    """A rule that always or never fires is found out by its own examples."""
    from msgspec.structs import replace

    def constant(*arguments: Any) -> Any:
        result = rule.function(*arguments)
        mask, columns = result if isinstance(result, tuple) else (result, {})
        return np.full_like(np.asarray(mask), value), columns

    changed = replace(rule, function=constant, unless=())
    verdicts = []
    for example in examples(rule.page):
        expected = sorted(place for place in example.expected if place[1] == rule.name)
        try:
            verdicts.append(said(report_of(example, changed)) == expected)
        except (ValueError, TypeError, IndexError, KeyError, OverflowError):
            verdicts.append(False)  # a message about a row that has nothing to say
    assert not all(verdicts)


def test_every_alarm_and_severity_of_a_machine_names_a_rule() -> None:
    for name in profiles.names():
        profile = profiles.load(name).machine
        assert set(profile.alarms) | set(profile.severities) <= set(RULES), name
