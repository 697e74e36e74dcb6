"""The comparison of two revisions as text and JSON."""

from __future__ import annotations

from collections.abc import Iterator

import msgspec

from polarcheck import __version__
from polarcheck.checking.phrases.part import Sizes
from polarcheck.pictures.painting import Paint
from polarcheck.reading.excerpt import visible
from polarcheck.revisions.report import (
    DIFFERS,
    NOT_COMPARED,
    SAME_METAL,
    SAME_WORDS,
    Comparison,
    Difference,
    SectionPair,
    Side,
)

#: Times and rates that differ by less than this share are shown as one.
_SHOWN = 0.005
_STYLES = {DIFFERS: "bold red", NOT_COMPARED: "bold yellow", SAME_METAL: "bold green", SAME_WORDS: "bold green"}


class ComparisonReport(msgspec.Struct, frozen=True):
    """
    The JSON document of `polarcheck compare`.

    schema: its version. files: a comparison for each pair of files. only_old, only_new: programs of two folders that
    the other one does not have.
    """

    schema: int
    tool: dict[str, str]
    files: list[Comparison]
    only_old: list[str] = []
    only_new: list[str] = []


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
    yield f"{visible(old.path)} | {visible(new.path)}: {paint(_headline(comparison, sizes), _STYLES[comparison.verdict])}"
    if old.machine != new.machine:
        yield f"  machines: {visible(old.machine)} | {visible(new.machine)}"
    for section in comparison.sections:
        yield from _section(section, sizes)
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
        most = "" if comparison.is_exact or comparison.deviation == 0 else "at most "
        deviation = f"largest deviation {most}{_fine(comparison.deviation, sizes)} {unit}"
    if comparison.verdict == SAME_METAL:
        return f"the same metal{f': {deviation}' if deviation else ''}"
    if comparison.verdict == NOT_COMPARED:
        return "not compared"
    return f"differs{f': {deviation}' if deviation else ''}"


def _fine(value: float, sizes: Sizes) -> str:
    """A deviation with a digit more than a program has."""
    return f"{value / 25.4:.5f}" if sizes.inch else f"{value:.4f}"


def _section(section: SectionPair, sizes: Sizes) -> Iterator[str]:
    if section.change == "same":
        return
    yield f"  section {_lines_of(section.old)} | {_lines_of(section.new)}: {section.change}"
    for difference in section.differences:
        if difference.what != "section":
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
