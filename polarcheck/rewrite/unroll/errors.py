"""Errors of a section that leave open where the tool goes: what is written would be a guess."""

from __future__ import annotations

from collections.abc import Iterator

from polarcheck.checking.check import check_runs
from polarcheck.foundation.finding import SEVERITIES, Severity
from polarcheck.rewrite.writing.original import Original
from polarcheck.rewrite.writing.outcome import Refusal
from polarcheck.rules.rule import load_all

#: Groups of rules about text that a control reads otherwise, or not at all.
_GROUPS = ("text", "macro")
#: Further rules of that kind. Errors of the mode itself, such as a rate of C or a code that it does not allow, end with
#: it; where the path of the tool center is not certain, the columns say so.
_RULES = (
    "arc-center-on-path", "arc-end-off-circle", "arc-off-polar-plane", "arc-radius-too-small", "arc-without-center",
    "arc-word-of-other-plane", "cancel-on-arc", "incremental-word-of-other-code-system", "linear-axis-never-programmed",
    "modal-state-wrong-at-entry", "origin-shifted-in-polar", "polar-axis-number-wrong", "polar-shift-incremental",
    "second-axis-never-programmed", "start-up-on-arc", "wrong-axis-address-in-polar",
)  # fmt: skip


def errors(original: Original) -> Iterator[Refusal]:
    """Yield the errors of a check in sections, whatever their severity is set to, and allow comments aside."""
    rules = [rule for name, rule in load_all().items() if rule.group in _GROUPS or name in _RULES]
    report = check_runs([("", original.tables)], rules, inline=False)
    for finding in report.findings:
        if finding.section_line is not None and SEVERITIES[finding.severity] >= Severity.ERROR:
            yield Refusal(finding.line, f"{finding.message} [{finding.rule}]")
