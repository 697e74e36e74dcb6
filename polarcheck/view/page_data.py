"""Turns the report of a file and its drawings into the data of a page."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import TYPE_CHECKING

from polarcheck.foundation.errors import counted
from polarcheck.foundation.finding import UNREADABLE
from polarcheck.reports.pages.resting import resting
from polarcheck.reports.text import first_sentence, severities, verdict
from polarcheck.view.picture_data import Drawn, FindingLocation, FindingPicture, Picture, key_of

if TYPE_CHECKING:
    from polarcheck.foundation.finding import FileReport, Finding
    from polarcheck.reports import Background

_NOTHING = Drawn(sections=[], skip="", remarks=[])
_NOWHERE = FindingLocation(section=None, move=None, places=[], span=None, also=[], is_beside=True)
#: The label of each line on what a verdict rests on, by how the line begins.
_LABELS = {"rests on ": "judged for", "section of ": "section", "not judged, but without weight: ": "not judged"}


def picture(file: FileReport, background: Background) -> Picture:
    """Return the data of a file's page; without pictures if none were requested."""
    drawn: Drawn = background.drawn.get(file.path, _NOTHING)
    findings = sorted([*file.findings, *file.silenced], key=lambda finding: (finding.line, finding.column))
    return Picture(
        path=file.path,
        verdict=verdict(file),
        summary=_summary(file),
        head=list(_head(file, drawn, background)),
        not_evaluated=list(_not_evaluated(file)),
        findings=[_finding(finding, drawn, background) for finding in findings],
        sections=drawn.sections,
        source=drawn.source,
        source_line=drawn.source_line,
        source_lines=drawn.source_lines,
    )


def _summary(file: FileReport) -> str:
    if file.verdict == UNREADABLE:
        return file.reason or ""
    findings = severities(Counter(finding.severity for finding in file.findings))
    return ", ".join([findings, counted(file.sections, "polar section"), counted(file.blocks, "block")])


def _head(file: FileReport, drawn: Drawn, background: Background) -> Iterator[tuple[str, str]]:
    settings = background.settings.get(file.path)
    if settings is not None:
        yield "machine", f"{settings.machine.title} ({file.machine})"
    if file.programs:
        yield "program", ", ".join(file.programs)
    for line in resting(file):
        label = next((label for begin, label in _LABELS.items() if line.startswith(begin)), "")
        yield label, line.removeprefix(next((begin for begin in _LABELS if line.startswith(begin)), ""))
    if drawn.skip:
        yield "block skip", f"drawn as run with block skip {drawn.skip}; what the other run differs in is told only"
    for remark in drawn.remarks:
        yield "not drawn", remark


def _not_evaluated(file: FileReport) -> Iterator[str]:
    """Yield one line for each reason, with the rules that were not evaluated for it."""
    reasons: dict[str, list[str]] = {}
    blocks: dict[str, int] = {}
    for gap in file.not_evaluated:
        if gap.matters:
            channel = f"channel {gap.channel}: " if gap.channel else ""
            reasons.setdefault(channel + gap.reason, []).append(gap.rule)
            blocks[channel + gap.reason] = max(blocks.get(channel + gap.reason, 0), gap.blocks)
    for reason, rules in reasons.items():
        yield f"{reason} ({counted(blocks[reason], 'block')}; {', '.join(dict.fromkeys(rules))})"


def _finding(finding: Finding, drawn: Drawn, background: Background) -> FindingPicture:
    from polarcheck.foundation.finding import Silenced

    rule = background.rules.get(finding.rule)
    location = drawn.places.get(key_of(finding), _NOWHERE)
    by = ""
    if isinstance(finding, Silenced):
        by = f"{finding.by}: {finding.reason}" if finding.reason else finding.by
    return FindingPicture(
        rule=finding.rule,
        severity=finding.severity,
        message=finding.full_message,
        line=finding.line,
        block=finding.block,
        why=first_sentence(rule.page) if rule else "",
        alarm=finding.alarm or "",
        fix=finding.fix.title if finding.fix is not None else "",
        section=location.section,
        move=location.move,
        silenced=by,
        places=location.places,
        span=location.span,
        also=location.also,
        is_beside=location.is_beside,
    )
