"""The lines above polar sections, with time, rates and radius of each."""

from __future__ import annotations

import math
from collections.abc import Iterable

from lsprotocol import types

from polarcheck.editor.analysis import Analysis
from polarcheck.foundation.finding import PolarSection, radius_origin
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.reading.excerpt import visible


def code_lenses(analysis: Analysis) -> list[types.CodeLens]:
    """Return a line above each G12.1: time, highest rate of C and its limit, radius."""
    if analysis.report is None:
        return []
    return [
        types.CodeLens(analysis.text.line_range(line), types.Command(visible(summary(section, runs)), ""))
        for line, (section, runs) in sections_by_line(analysis.report.polar_sections).items()
    ]


def sections_by_line(sections: Iterable[PolarSection]) -> dict[int, tuple[PolarSection, int]]:
    """
    Return for each line where sections begin the one with the highest rate of C, and their number.

    An unknown rate counts as the highest.
    """
    by_line: dict[int, list[PolarSection]] = {}
    for section in sections:
        by_line.setdefault(section.line, []).append(section)

    def rate(section: PolarSection) -> float:
        return math.inf if section.c_feed is None else section.c_feed

    return {line: (max(group, key=rate), len(group)) for line, group in by_line.items()}


def summary(section: PolarSection, runs: int = 1) -> str:
    """Return a line on a polar section, in the units of the program; runs: how often it is run."""
    limit = f" of {section.c_feed_limit:.0f}" if section.c_feed_limit is not None else ""
    line = f" in line {section.c_feed_line}" if section.c_feed_line is not None else ""
    rate = "rate of C not known" if section.c_feed is None else f"C {section.c_feed:.0f}{limit} deg/min{line}"
    if section.center_line:
        rate += f", no angle at the center in line {section.center_line}"
    time = "time not known" if section.time is None else f"{section.time:.1f} s"
    if section.time_not_known:
        prefix = f"{section.time_known:.1f} s without" if section.time_known else "time not known:"
        time = f"{prefix} {', '.join(section.time_not_known)}"
    channel = f"{section.channel}: " if section.channel else ""
    often = f" | the highest of {runs} runs" if runs > 1 else ""
    return f"{channel}{time} | {rate} | {_radius(section)}{often}"


def _radius(section: PolarSection) -> str:
    if section.offset is None:
        return "no tool offset"
    if section.radius is None:
        return f"R of offset {section.offset} not known"
    is_inch = section.units == "inch"
    radius = section.radius / MM_PER_INCH if is_inch else section.radius
    origin = radius_origin(section.radius_source)
    return f"R {radius:.{4 if is_inch else 3}f} {section.units} (offset {section.offset}, {origin})"
