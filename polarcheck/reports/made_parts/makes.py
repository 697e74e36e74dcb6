"""The part that the only section of a file makes, in one line of the text report of a check."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import chain

import msgspec

from polarcheck.foundation.finding import FileReport, Finding
from polarcheck.rules.causes import BESIDE_PART
from polarcheck.rules.rule import Rule, load_all
from polarcheck.rules.tables import Tables

#: Tables that compute the polygons of contours, where a cheaper test does not do.
_WITH_AREAS = ("finished", "coverage", "slots", "overcuts", "part_comments")
#: Groups of rules whose findings leave the path as it is, unless they say what they make doubtful.
_GROUPS = ("feed", "setup", "silence")
#: Rules of these groups that say that the part lies or is sized otherwise.
_DISPLACING = ("origin-off-center", "size-by-x-offset")
#: Rules of other groups that compare what is made with something else: it is made all the same.
_COMPARING = ("part-differs-from-drawing", "comment-contradicts-part")


def with_makes(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """
    The report with the line on what its section makes; without it where a finding makes that doubtful.

    It is left out, too, where the check has needed no polygons: shapely takes longer than the check of a small file.
    That depends on the program alone, never on what the process has loaded before.
    """
    tables = [tables for _, tables in runs]
    if report.sections != 1 or any(len(run["sections"]) != 1 for run in tables) or not all(map(_has_areas, tables)):
        return report
    rules = load_all()
    if any(_is_doubtful(finding, rules) for finding in chain(report.findings, report.silenced)):
        return report
    from polarcheck.reports.made_parts.part_report import in_one_line

    line, *different = dict.fromkeys(map(in_one_line, tables))
    # With block skip on and off it may be two parts.
    return msgspec.structs.replace(report, makes=line) if line and not different else report


def _has_areas(tables: Tables) -> bool:
    computed = dict(tables.computed())
    return any(name in computed and computed[name].has_areas for name in _WITH_AREAS)


def _is_doubtful(finding: Finding, rules: dict[str, Rule]) -> bool:
    """True for a finding that says that the part may be another than what is programmed."""
    if finding.severity == "note":
        return False
    rule = rules[finding.rule]
    if rule.name in _COMPARING:
        return False
    is_of_part = any(what not in BESIDE_PART for what, _ in rule.doubts)
    return is_of_part or rule.group not in _GROUPS or rule.name in _DISPLACING
