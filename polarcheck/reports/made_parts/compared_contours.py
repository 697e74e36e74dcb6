"""The contours of a run beside what the job says they should be, as reports tell them: also those that agree."""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence

import msgspec

from polarcheck.checking.channel_reports import first_runs
from polarcheck.columns.trace import Trace
from polarcheck.foundation.errors import TooHardError
from polarcheck.foundation.finding import FileReport, PartComparison
from polarcheck.parts.deviations import Deviations
from polarcheck.parts.part_comparison import Comparison
from polarcheck.rules.quantity import rounded
from polarcheck.rules.tables import Tables
from polarcheck.rules.wording.drawing import told


def compared_in(report: FileReport, runs: Sequence[tuple[str, Tables]]) -> FileReport:
    """The report with the contours that are compared, in its first run and in each channel."""
    found: list[PartComparison] = []
    for _, tables in first_runs(runs):
        with contextlib.suppress(TooHardError):  # the rule says so
            found += compared(tables)
    return msgspec.structs.replace(report, compared=found)


def compared(tables: Tables) -> list[PartComparison]:
    """
    What is compared in a run, in the order of the program, without what is only roughing; empty where the job asks for
    nothing. Raises TooHardError as the finished part does.
    """
    trace: Trace = tables["trace"]
    deviations: Deviations = tables["deviations"]
    return [
        PartComparison(
            title=one.title,
            section_line=int(trace.blocks.line[trace.mode.sections.enter[one.section]]),
            z=rounded(one.z),
            agrees=one.agrees,
            largest=rounded(one.difference.largest),
            tolerance=rounded(one.tolerance),
            too_much=rounded(one.difference.proud),
            cut_away=rounded(one.difference.deep),
            at=_at(one),
            line=int(trace.blocks.line[one.row]),
            turned=rounded(math.degrees(one.turned)),
            angle_not_compared=one.angle_not_compared or None,
            text=told(trace, one),
        )
        for one in deviations.comparisons
        if not one.is_superseded
    ]


def _at(one: Comparison) -> tuple[float | None, float | None]:
    place = one.written(one.difference.at)
    return rounded(place.real), rounded(place.imag)
