"""The comparison of two revisions as text and JSON."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from polarcheck.foundation.version import __version__
from polarcheck.program.reading.excerpt import head, visible
from polarcheck.reports.pages.painting import Paint
from polarcheck.rewrite.compare.comparison_report import (
    DIFFERS,
    NOT_COMPARED,
    SAME_METAL,
    SAME_WORDS,
    Comparison,
    ComparisonReport,
    Difference,
    SectionPair,
    Side,
)
from polarcheck.rules.wording.part import Sizes

#: Times and rates that differ by less than this share are shown as one.
_SHOWN = 0.005
#: Kinds of differences, in the order of the headline; all others are states.
_KINDS = {
    "section": "sections",
    "path": "path",
    "depth": "depth",
    "feed": "feed",
    "point": "points",
    "order": "orders",
    "place": "orders",
}
_STYLES = {DIFFERS: "fail", NOT_COMPARED: "unverified", SAME_METAL: "pass", SAME_WORDS: "pass"}


def json(comparisons: list[Comparison], only_old: list[str], only_new: list[str]) -> bytes:
    """Return the JSON document."""
    tool = {"name": "polarcheck", "version": __version__}
    report = ComparisonReport(1, tool, comparisons, only_old, only_new)
    return msgspec.json.format(msgspec.json.encode(report), indent=2) + b"\n"


def text(comparison: Comparison, *, inch: bool, paint: Paint) -> str:
    """Return the report of a pair of files; inch: lengths of the headline in inch, else in mm."""
    return "".join(f"{line}\n" for line in _lines(comparison, Sizes(inch), paint))


def _lines(comparison: Comparison, sizes: Sizes, paint: Paint) -> Iterator[str]:
    old, new = comparison.old, comparison.new
    headline = paint(_STYLES[comparison.verdict], _headline(comparison, sizes))
    yield f"{head(old.path)} | {visible(new.path)}: {headline}"
    if old.machine != new.machine:
        yield f"  machines: {visible(old.machine)} | {visible(new.machine)}"
    for section in comparison.sections:
        yield from _section(section)
    if comparison.outside:
        yield "  outside of sections:"
        yield from (f"    {_difference(difference)}" for difference in comparison.outside)
    for entry in comparison.not_compared:
        yield (
            f"  not compared, because {visible(entry.reason)}" if entry.matters else f"  note: {visible(entry.reason)}"
        )


def _headline(comparison: Comparison, sizes: Sizes) -> str:
    unit = "inch" if sizes.inch else "mm"
    if comparison.verdict == SAME_WORDS:
        return "the same but for block numbers, spaces and comments"
    deviation = ""
    if comparison.deviation is not None:
        is_bound = not comparison.is_exact and comparison.deviation > comparison.tolerance
        most = "at most " if is_bound else ""
        # One digit more than the program has.
        value = f"{comparison.deviation / 25.4:.5f}" if sizes.inch else f"{comparison.deviation:.4f}"
        deviation = f"largest deviation {most}{value} {unit}"
    if comparison.verdict == SAME_METAL:
        return f"the same metal{f': {deviation}' if deviation else ''}"
    if comparison.verdict == NOT_COMPARED:
        return f"not compared{f'; what was has a {deviation}' if deviation else ''}"
    return f"differs in {', '.join(_kinds(comparison))}{f'; {deviation} of the path' if deviation else ''}"


def _kinds(comparison: Comparison) -> list[str]:
    """Return the kinds of differences, each once."""
    differing = [
        *comparison.outside,
        *(difference for section in comparison.sections for difference in section.differences),
    ]
    kinds = {_KINDS.get(difference.what, "state at entry") for difference in differing}
    return [kind for kind in dict.fromkeys((*_KINDS.values(), "state at entry")) if kind in kinds]


def _section(section: SectionPair) -> Iterator[str]:
    if section.change == "same":
        return
    yield f"  section {_lines_of(section.old)} | {_lines_of(section.new)}: {section.change}"
    for difference in section.differences:
        if section.change == "changed" or difference.what != "section":
            yield f"    {_difference(difference)}"
    if section.old is not None and section.new is not None:
        changes = [
            f"{name} {_number(before, unit)}, now {_number(after, unit)}"
            for name, before, after, unit in (
                ("time", section.old.time, section.new.time, "s"),
                ("highest C rate", section.old.c_feed, section.new.c_feed, "deg/min"),
            )
            if _differs(before, after)
        ]
        if changes:
            yield f"    {'; '.join(changes)}"


def _lines_of(side: Side | None) -> str:
    return "-" if side is None else f"lines {side.line}-{side.end_line}"


def _differs(before: float | None, after: float | None) -> bool:
    if before is None or after is None:
        return before is not after
    return abs(before - after) > _SHOWN * max(abs(before), abs(after))


def _number(value: float | None, unit: str) -> str:
    return "not known" if value is None else f"{value:.1f} {unit}" if abs(value) < 1000 else f"{value:.0f} {unit}"


def _difference(difference: Difference) -> str:
    lines = [None if line is None else f"line {line}" for line in (difference.old_line, difference.new_line)]
    where = "" if lines == [None, None] else f"{lines[0] or '-'} | {lines[1] or '-'}: "
    return visible(f"{where}{difference.text}")


def single_files(only_old: Sequence[str], only_new: Sequence[str]) -> str:
    """Return a line for each program of two folders that the other one does not have."""
    lines = [f"{head(name)}: only in the old folder\n" for name in only_old]
    return "".join([*lines, *(f"{head(name)}: only in the new folder\n" for name in only_new)])
