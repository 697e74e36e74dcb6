"""A report of one file, with what is drawn of it, as a page shows it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import chain
from typing import TYPE_CHECKING

from polarcheck.pictures.picture import Drawn, FindingPicture, Picture, SectionPicture
from polarcheck.reports import SEVERITIES, counted
from polarcheck.reports.pages.resting import resting
from polarcheck.reports.text import first_sentence, verdict

if TYPE_CHECKING:
    from polarcheck.finding import FileReport, Finding
    from polarcheck.reports import Background

_NOTHING = Drawn(sections=[], skip="", remarks=[])
#: How what a verdict rests on begins, and the label of it.
_LABELS = {"rests on ": "judged for", "section of ": "section", "not judged, but without weight: ": "not judged"}


def picture(file: FileReport, background: Background) -> Picture:
    """What a page shows of a file; without pictures where none were asked for."""
    drawn = background.drawn.get(file.path, _NOTHING)
    places = [_Place(section) for section in drawn.sections]
    findings = sorted([*file.findings, *file.silenced], key=lambda found: (found.line, found.column))
    return Picture(
        path=file.path,
        verdict=verdict(file),
        summary=_summary(file),
        head=list(_head(file, drawn, background)),
        not_evaluated=list(_not_evaluated(file)),
        findings=[_finding(found, places, background) for found in findings],
        sections=drawn.sections,
    )


def _summary(file: FileReport) -> str:
    severities = [found.severity for found in file.findings]
    told = [counted(severities.count(one), one) for one in SEVERITIES if one in severities] or ["no findings"]
    return ", ".join([*told, counted(file.sections, "polar section"), counted(file.blocks, "block")])


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
    """One line for each reason, with the rules that it silences."""
    reasons: dict[str, list[str]] = {}
    blocks: dict[str, int] = {}
    for missing in file.not_evaluated:
        if missing.matters:
            channel = f"channel {missing.channel}: " if missing.channel else ""
            reasons.setdefault(channel + missing.reason, []).append(missing.rule)
            blocks[channel + missing.reason] = max(blocks.get(channel + missing.reason, 0), missing.blocks)
    for reason, rules in reasons.items():
        yield f"{reason} ({counted(blocks[reason], 'block')}; {', '.join(dict.fromkeys(rules))})"


class _Place:
    """Where findings stand in a section: the first move of each line."""

    def __init__(self, section: SectionPicture) -> None:
        self.section = section
        self.first: dict[int, int] = {}
        for number, line in enumerate(section.moves.line):
            self.first.setdefault(line, number)

    def is_of(self, found: Finding) -> bool:
        """Whether a finding belongs to the section."""
        if (found.channel or "") not in ("", self.section.channel):
            return False
        if found.section_line is not None:
            return found.section_line == self.section.line
        return self.section.line <= found.line <= self.section.end_line


def _finding(found: Finding, places: Sequence[_Place], background: Background) -> FindingPicture:
    from polarcheck.finding import Silenced

    rule = background.rules.get(found.rule)
    of = [number for number, place in enumerate(places) if place.is_of(found)]
    # A program that is called twice makes a section each time.
    with_move = [number for number in of if found.line in places[number].first]
    section = next(chain(with_move, of), None)
    by = ""
    if isinstance(found, Silenced):
        by = f"{found.by}: {found.reason}" if found.reason else found.by
    return FindingPicture(
        rule=found.rule,
        severity=found.severity,
        message=found.told,
        line=found.line,
        block=found.block,
        why=first_sentence(rule.page) if rule else "",
        alarm=found.alarm or "",
        fix=found.fix.title if found.fix is not None else "",
        section=section,
        move=None if section is None else places[section].first.get(found.line),
        silenced=by,
    )
