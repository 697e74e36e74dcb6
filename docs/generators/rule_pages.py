"""docs/rules/: a page for each rule, with its manual page and its findings in its own examples, and their index."""

from __future__ import annotations

import functools
import importlib
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from generators.tables import GENERATED, row, rule_under
from polarcheck.checking import check
from polarcheck.foundation.finding import Finding
from polarcheck.program.machines import profiles, toml_text
from polarcheck.program.machines.job import from_table, with_tool
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.profiles import Profile
from polarcheck.reports.pages.markdown import prose
from polarcheck.rules.examples import Example, examples, options_of
from polarcheck.rules.rule import Rule, load_all

_HEADING = re.compile(r"^(Bad|Good)(?:, (.*))?:$")


def pages(rules: Mapping[str, Rule]) -> Iterator[tuple[str, str]]:
    """Yield path below docs/ and text of each page."""
    yield "rules/index.md", index(rules)
    for rule in rules.values():
        yield f"rules/{rule.group}/{rule.name}.md", page(rule)


def index(rules: Mapping[str, Rule]) -> str:
    """Return the page that lists all rules by group, with links."""
    lines = ["# Rules", "", GENERATED, ""]
    lines += [
        f"{len(rules)} rules. `polarcheck rules` lists them, `polarcheck explain NAME` shows a page at a shell.",
        "Beside a block of an example `(expect: NAME)` says what is found there; it is no part of the program.",
    ]
    for group in dict.fromkeys(rule.group for rule in rules.values()):
        about = (importlib.import_module(f"polarcheck.rules.{group}").__doc__ or "").strip()
        lines += ["", f"## {group}", "", prose(about), "", *rule_under("rule", "severity", "what it finds")]
        for rule in rules.values():
            if rule.group == group:
                lines.append(row(f"[{rule.name}]({group}/{rule.name}.md)", _severity(rule), prose(rule.title)))
    return "\n".join(lines) + "\n"


def page(rule: Rule) -> str:
    """Return the page of one rule."""
    findings = findings_in_examples(rule)
    lines = [f"# {rule.name}", "", GENERATED, "", f"**{prose(rule.title)}.**", ""]
    lines += [f"Group [{rule.group}](../index.md#{rule.group}), severity {_severity(rule)}."]
    if findings:
        lines += ["", "## What it says", "", "Of its examples:", ""]
        lines += [f"- {finding.severity}: {prose(finding.message)}" for finding in _by_message(findings)]
    lines += ["", "## Why", "", *_body(rule)]
    lines += ["", *_alarms(rule)]
    lines += ["## The fix", "", *_fixes(findings)]
    lines += ["", "## Where it is meant so", "", *_allowed(rule)]
    return "\n".join(lines) + "\n"


def findings_in_examples(rule: Rule) -> list[Finding]:
    """Return the findings of the rule in the Bad examples of its page, in their order."""
    bad = [example for example in examples(rule.page) if not example.good]
    # Some rules depend on the findings of others: they find nothing when they run alone.
    findings = _findings(bad, rule, [rule]) or _findings(bad, rule, list(load_all().values()))
    return [finding for finding in findings if finding.rule == rule.name]


def _findings(bad: Sequence[Example], rule: Rule, rules: Sequence[Rule]) -> list[Finding]:
    return [finding for example in bad for finding in _checked(example, rule, rules)]


def _checked(example: Example, rule: Rule, rules: Sequence[Rule]) -> Sequence[Finding]:
    changes: dict[str, Any] = {}
    table: dict[str, Any] = {}
    for setting in example.settings:
        key, _, value = setting.partition("=")
        *folders, last = key.removeprefix("job.").split(".")
        place = table if key.startswith("job.") else changes
        for folder in folders:
            place = place.setdefault(folder, {})
        place[last] = toml_text.parsed(f"value = {value}")["value"]
    name = example.machine or profiles.DEFAULT
    machine = profiles.load(name, changes).machine if changes else _built_in()[name]
    job = from_table(table, rule.name)
    for tool in example.tools:
        job = with_tool(job, tool)
    return check.check_file(example.program.encode(), machine, job, rules, severities=_severities(rule)).findings


@functools.cache
def _built_in() -> dict[str, Machine]:
    return {profile.name: profile.machine for profile in profiles.built_in()}


def _severities(rule: Rule) -> dict[str, str]:
    """Return the severities for the examples: a rule of advice is off by default, but its page shows its findings."""
    return {rule.name: rule.severity.name.lower()} if rule.is_advice else {}


def _severity(rule: Rule) -> str:
    level = rule.severity.name.lower()
    return f"{level}, off where nobody asks for it" if rule.is_advice else level


def _by_message(findings: Sequence[Finding], most: int = 3) -> list[Finding]:
    """Return the first finding of each message, at most a few."""
    return list({finding.message: finding for finding in reversed(findings)}.values())[::-1][:most]


def _body(rule: Rule) -> Iterator[str]:
    """Yield the manual page below its title: paragraphs, source, examples under headings."""
    in_code, last = False, ""
    for line in rule.page.strip().split("\n")[2:]:
        heading = _HEADING.match(line)
        if heading:
            kind, conditions = heading.groups()
            yield f"## {kind}" if kind != last else "Or:"
            yield from _judged(conditions)
            last = kind
        elif line.startswith("Source: "):
            yield from ("## Source", "", prose(line.removeprefix("Source: ")))
        else:
            in_code = line.startswith("    ") or (in_code and not line)
            yield line if in_code or not line else prose(line)


def _judged(conditions: str | None) -> Iterator[str]:
    """Yield a line on the machine and the options that an example is judged with."""
    options = options_of(f", {conditions}") if conditions else []
    lathe = "".join(f" for [{value}](../../machines/{value}.md)" for key, value in options if key == "machine")
    words = [f"`--tool {value}`" for key, value in options if key == "tool"]
    words += [f"`--set {value}`" for key, value in options if key == "set" and not value.startswith("job.")]
    words += [
        f"`{value[4:]}` in polarcheck.toml" for key, value in options if key == "set" and value.startswith("job.")
    ]
    if lathe or words:
        yield from ("", f"Judged{lathe}{' with ' if words else ''}{', '.join(words)}:")


def _alarms(rule: Rule) -> Iterator[str]:
    rows = []
    for profile in _machines():
        alarm = profile.machine.alarms.get(rule.name)
        level = profile.machine.severities.get(rule.name)
        if alarm or level:
            link = f"[{profile.name}](../../machines/{profile.name}.md)"
            rows.append(row(link, prose(alarm or ""), level or rule.severity.name.lower()))
    if rows:
        yield from ("## On the machines", "", "Where an alarm is known, or the severity is another one:", "")
        yield from (*rule_under("machine", "alarm", "severity"), *rows, "")


def _machines() -> list[Profile]:
    return sorted(profiles.built_in(), key=lambda profile: profile.name)


def _fixes(findings: Sequence[Finding]) -> Iterator[str]:
    fixes = {finding.fix.title: finding.fix for finding in findings if finding.fix is not None}
    if not fixes:
        yield "None is made by itself: what to write instead stands in the message."
        return
    for fix in fixes.values():
        option = "`--fix`" if fix.safe else "`--fix --unsafe-fixes`"
        yield f"- {prose(fix.title)}: written by {option}, shown by `--diff` ([fixes](../../fixes.md))"


def _allowed(rule: Rule) -> Iterator[str]:
    yield "In one block, with the reason, in that block or alone on the line before it ([silence](../../silence.md)):"
    yield from ("", f"    (POLARCHECK ALLOW {rule.name.upper()} reason)", "")
    yield "For all programs beside a polarcheck.toml, left out:"
    yield from ("", f'    ignore = ["{rule.name}"]', "", "or as a note:", "", "    [severities]")
    yield f'    {rule.name} = "note"'
