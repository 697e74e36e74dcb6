"""Numbers the findings of a section, for the labels on its face and the list below it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from polarcheck.foundation.errors import consecutive, first_of
from polarcheck.foundation.finding import SEVERITIES
from polarcheck.view.picture_data import FindingPicture, Mark, SectionPicture

#: The most entries of a list.
_MOST = 15

Point = tuple[float, float]


class Entry(NamedTuple):
    """
    An entry of the list below a face.

    number: its label on the face, from 1.
    kind: the severity, or the kind of a mark without a finding.
    rule: of the finding; empty for a mark.
    text: the line in the program and what is wrong there.
    places: where it is on the face [mm]; may be empty.
    span: the width of a window that shows it at its own scale [mm]; None if the whole face shows it.
    """

    number: int
    kind: str
    rule: str
    text: str
    places: Sequence[Point]
    span: float | None


def entries(section: SectionPicture, findings: Sequence[FindingPicture]) -> tuple[list[Entry], int]:
    """
    Return the entries of a section, the gravest first, and how many more there are.

    findings: those of the section; silenced ones have no entry.
    """
    reported = [finding for finding in findings if not finding.silenced]
    reported.sort(key=_gravest_first)
    all_entries = [
        *(_of_finding(finding) for finding in reported),
        *(_of_mark(mark) for mark in section.marks if not _is_reported(mark, reported)),
    ]
    numbered = [entry._replace(number=number) for number, entry in enumerate(all_entries[:_MOST], 1)]
    return numbered, max(len(all_entries) - _MOST, 0)


def outside(findings: Sequence[FindingPicture]) -> tuple[list[Entry], int]:
    """Return the entries of findings that no section shows, and how many more there are."""
    drawn, more = [finding for finding in findings if finding.section is None and not finding.silenced], 0
    drawn.sort(key=_gravest_first)
    drawn, more = drawn[:_MOST], max(len(drawn) - _MOST, 0)
    return [_of_finding(finding)._replace(places=()) for finding in drawn], more


def labels(listed: Sequence[Entry], apart: float) -> Iterator[tuple[Point, str, str]]:
    """
    Yield place, text and kind of each label; entries at about the same place share a label.

    apart: the least distance between two labels [mm].
    """
    groups: list[tuple[Point, list[Entry]]] = []
    for entry in listed:
        for point in entry.places:
            group = next((members for center, members in groups if _distance(center, point) < apart), None)
            if group is None:
                groups.append((point, [entry]))
            elif entry not in group:
                group.append(entry)
    for point, members in groups:
        yield point, _as_ranges([entry.number for entry in members]), members[0].kind


def _distance(first: Point, second: Point) -> float:
    return abs(complex(*first) - complex(*second))


def _as_ranges(numbers: Sequence[int]) -> str:
    """Write rising numbers with ranges: 1-3, 5."""
    runs = consecutive(numbers)
    return ", ".join(f"{run[0]}-{run[-1]}" if len(run) > 2 else ", ".join(map(str, run)) for run in runs)


def _gravest_first(finding: FindingPicture) -> tuple[int, int]:
    return -SEVERITIES.get(finding.severity, -1), finding.line


def _of_finding(finding: FindingPicture) -> Entry:
    also = f" (also in {_lines(finding.also)})" if finding.also else ""
    return Entry(
        0, finding.severity, finding.rule, f"line {finding.line}: {finding.message}{also}", finding.places, finding.span
    )


def _lines(lines: Sequence[int]) -> str:
    return f"{'line' if len(lines) == 1 else 'lines'} {first_of([*map(str, lines)], 8)}"


def _of_mark(mark: Mark) -> Entry:
    kind = "left standing" if mark.kind == "left" else mark.kind
    return Entry(0, kind, "", mark.text, [mark.place], 10 * mark.depth or None)


def _is_reported(mark: Mark, findings: Sequence[FindingPicture]) -> bool:
    """Return True if one of the findings is about this mark: at its place, or in both of its blocks."""
    return any(
        (len(mark.lines) > 1 and {finding.line, *finding.also} >= set(mark.lines))
        or any(_distance(point, mark.place) <= mark.depth for point in finding.places)
        for finding in findings
    )
