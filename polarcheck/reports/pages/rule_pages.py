"""docs/rules/: a page for each rule, of its manual page and what it says of its own examples, and their index."""

from __future__ import annotations

import functools
import importlib
import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from polarcheck.checking import check
from polarcheck.checking.examples import Example, examples, options_of
from polarcheck.checking.rule import Rule, load_all
from polarcheck.finding import Finding
from polarcheck.machines import profiles, toml_text
from polarcheck.machines.job import from_table, with_tool
from polarcheck.machines.machine import Machine
from polarcheck.machines.profiles import Profile
from polarcheck.reports.pages.markdown import MADE, prose, row, rule_under

_HEADING = re.compile(r"^(Bad|Good)(?:, (.*))?:$")


def pages(rules: Mapping[str, Rule]) -> Iterator[tuple[str, str]]:
    """Path below docs/ and text of each page."""
    yield "rules/index.md", index(rules)
    for rule in rules.values():
        yield f"rules/{rule.group}/{rule.name}.md", page(rule)


def index(rules: Mapping[str, Rule]) -> str:
    """All rules by group, with links."""
    lines = ["# Rules", "", MADE, ""]
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
    """The page of one rule."""
    said = said_of_examples(rule)
    lines = [f"# {rule.name}", "", MADE, "", f"**{prose(rule.title)}.**", ""]
    lines += [f"Group [{rule.group}](../index.md#{rule.group}), severity {_severity(rule)}."]
    if said:
        lines += ["", "## What it says", "", "Of its examples:", ""]
        lines += [f"- {found.severity}: {prose(found.message)}" for found in _by_message(said)]
    lines += ["", "## Why", "", *_body(rule)]
    lines += ["", *_alarms(rule)]
    lines += ["## The fix", "", *_fixes(said)]
    lines += ["", "## Where it is meant so", "", *_allowed(rule)]
    return "\n".join(lines) + "\n"


def said_of_examples(rule: Rule) -> list[Finding]:
    """What the rule finds in the Bad examples of its page, in their order."""
    bad = [example for example in examples(rule.page) if not example.good]
    # Some rules speak of what others find, or do not.
    said = _said(bad, rule, [rule]) or _said(bad, rule, list(load_all().values()))
    return [found for found in said if found.rule == rule.name]


def _said(bad: Sequence[Example], rule: Rule, rules: Sequence[Rule]) -> list[Finding]:
    return [found for example in bad for found in _findings(example, rule, rules)]


def _findings(example: Example, rule: Rule, rules: Sequence[Rule]) -> Sequence[Finding]:
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
    return check.check_file(example.program.encode(), machine, job, rules, severities=_as_found(rule)).findings


@functools.cache
def _built_in() -> dict[str, Machine]:
    return {profile.name: profile.machine for profile in profiles.built_in()}


def _as_found(rule: Rule) -> dict[str, str]:
    """Advice is off where nobody asks for it; its page shows it."""
    return {rule.name: rule.severity.name.lower()} if rule.is_advice else {}


def _severity(rule: Rule) -> str:
    level = rule.severity.name.lower()
    return f"{level}, off where nobody asks for it" if rule.is_advice else level


def _by_message(said: Sequence[Finding], most: int = 3) -> list[Finding]:
    """Of findings that say the same, the first; and a few of them."""
    return list({found.message: found for found in reversed(said)}.values())[::-1][:most]


def _body(rule: Rule) -> Iterator[str]:
    """The manual page below its title: paragraphs, source, examples under headings."""
    in_code, last = False, ""
    for line in rule.page.strip().split("\n")[2:]:
        heading = _HEADING.match(line)
        if heading:
            kind, given = heading.groups()
            yield f"## {kind}" if kind != last else "Or:"
            yield from _judged(given)
            last = kind
        elif line.startswith("Source: "):
            yield from ("## Source", "", prose(line.removeprefix("Source: ")))
        else:
            in_code = line.startswith("    ") or (in_code and not line)
            yield line if in_code or not line else prose(line)


def _judged(given: str | None) -> Iterator[str]:
    """For which machine, and with what, an example is judged."""
    options = options_of(f", {given}") if given else []
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


def _fixes(said: Sequence[Finding]) -> Iterator[str]:
    fixes = {found.fix.title: found.fix for found in said if found.fix is not None}
    if not fixes:
        yield "None is made by itself: what to write instead stands in the message."
        return
    for fix in fixes.values():
        asked = "`--fix`" if fix.safe else "`--fix --unsafe-fixes`"
        yield f"- {prose(fix.title)}: written by {asked}, shown by `--diff` ([fixes](../../fixes.md))"


def _allowed(rule: Rule) -> Iterator[str]:
    yield "In one block, with the reason, in that block or alone on the line before it ([silence](../../silence.md)):"
    yield from ("", f"    (POLARCHECK ALLOW {rule.name.upper()} reason)", "")
    yield "For all programs beside a polarcheck.toml, left out:"
    yield from ("", f'    ignore = ["{rule.name}"]', "", "or as a note:", "", "    [severities]")
    yield f'    {rule.name} = "note"'
