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
    comparisons: list[PartComparison] = []
    for _, tables in first_runs(runs):
        with contextlib.suppress(TooHardError):  # the rule says so
            comparisons += compared(tables)
    return msgspec.structs.replace(report, compared=comparisons)


def compared(tables: Tables) -> list[PartComparison]:
    """
    The comparisons of a run, in the order of the program, without those of roughing; empty where the job gives no
    part. Raises TooHardError as the finished part does.
    """
    trace: Trace = tables["trace"]
    deviations: Deviations = tables["deviations"]
    return [
        PartComparison(
            title=comparison.title,
            section_line=int(trace.blocks.line[trace.mode.sections.enter[comparison.section]]),
            z=rounded(comparison.z),
            agrees=comparison.agrees,
            largest=rounded(comparison.difference.largest),
            tolerance=rounded(comparison.tolerance),
            too_much=rounded(comparison.difference.proud),
            cut_away=rounded(comparison.difference.deep),
            at=_point(comparison),
            line=int(trace.blocks.line[comparison.row]),
            turned=rounded(math.degrees(comparison.turned)),
            angle_not_compared=comparison.angle_not_compared or None,
            text=told(trace, comparison),
        )
        for comparison in deviations.comparisons
        if not comparison.is_superseded
    ]


def _point(comparison: Comparison) -> tuple[float | None, float | None]:
    point = comparison.written(comparison.difference.at)
    return rounded(point.real), rounded(point.imag)
