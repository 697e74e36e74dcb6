"""Compares two parts of programs: their paths, and what lies outside of their sections."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Rows
from polarcheck.foundation.errors import TooHardError
from polarcheck.geometry.comparison.path_deviation import PathDeviation
from polarcheck.rewrite.compare.compared_sections import Stretch, outside
from polarcheck.rewrite.compare.comparison_report import Difference
from polarcheck.rewrite.compare.differences import deviation_of, differences, length_of
from polarcheck.rewrite.compare.orders import Step
from polarcheck.rewrite.compare.terms import Terms
from polarcheck.rules.wording.written import executed_word


class Measured(msgspec.Struct, frozen=True):
    """
    Two parts compared.

    reason: why they were not compared; empty if they were. not_known: what is not known in both, and therefore left out
    of their paths; empty if nothing is. deviation: of their paths, None where none was measured.
    length: the largest deviation [mm], without the share of C outside sections. differences: what differs.
    """

    reason: str = ""
    not_known: str = ""
    deviation: PathDeviation | None = None
    length: float = 0.0
    differences: Sequence[Difference] = ()


def measured(old: Stretch, new: Stretch, terms: Terms) -> Measured:
    """Compare two parts. Moves that are not known in both are left out; those of one alone are a reason not to."""
    has_other_moves = terms.has_other_moves and old.section >= 0
    not_known = [f"{name}: {part.needs}" for name, part in (("old", old), ("new", new)) if part.needs]
    counts = [np.count_nonzero(~part.path.is_known) for part in (old, new)]
    if not_known and (len(not_known) < len((old, new)) or counts[0] != counts[1]):
        return Measured(not_known[0])
    old, new = old.known, new.known
    try:
        deviation = None if has_other_moves else deviation_of(old, new, terms.tolerance)
    except TooHardError as error:
        return Measured(str(error))
    has_points = not (has_other_moves or terms.changes)
    differing = [*differences(old, new, deviation, terms), *(_points(old, new) if has_points else ())]
    return Measured("", not_known[0] if not_known else "", deviation, length_of(old, deviation), differing)


def outside_compared(
    traces: tuple[Trace, Trace], steps: tuple[Sequence[Step], Sequence[Step]], rows: tuple[Rows, Rows], terms: Terms
) -> Measured:
    """Compare what lies outside sections in these rows of two programs."""
    if terms.is_kept and len(rows[0]):
        radius = abs(float(traces[0].path.x_before[rows[0][0]]))
        angle = math.degrees(2 * terms.tolerance / radius) if radius > terms.tolerance else 0.0
        terms = msgspec.structs.replace(terms, angle=max(terms.angle, angle))
    old = outside(traces[0], steps[0], rows[0], terms.of_old)
    new = _turned_to(old, outside(traces[1], steps[1], rows[1], terms.of_new))
    return measured(old, new, terms)


def _turned_to(old: Stretch, new: Stretch) -> Stretch:
    """Return the new part with C shifted by full turns towards the old one: the C after a section counts its turns."""
    paths = old.path, new.path
    if not len(paths[0]) or not len(paths[1]):
        return new
    turn = 360 * new.c_scale
    by = turn * round(float(paths[0].z_start[0] - paths[1].z_start[0]) / turn)
    path = msgspec.structs.replace(paths[1], z_start=paths[1].z_start + by, z_end=paths[1].z_end + by)
    return msgspec.structs.replace(new, path=path)


def _points(old: Stretch, new: Stretch) -> Iterator[Difference]:
    """Yield a difference where a number has no decimal point, and has one in the other revision."""
    if old.trace.machine != new.trace.machine:
        return
    words = [_coordinates(part) for part in (old, new)]
    if len(words[0]) != len(words[1]):
        return
    lacks = [part.trace.coordinates.is_unpointed[indices] for part, indices in zip((old, new), words, strict=True)]
    differs = np.flatnonzero(lacks[0] != lacks[1])
    if not len(differs):
        return
    before, after = (int(indices[differs[0]]) for indices in words)
    texts = executed_word(old.trace.run, before), executed_word(new.trace.run, after)
    lines = old.line(int(old.trace.run.row[before])), new.line(int(new.trace.run.row[after]))
    without = "old" if lacks[0][differs[0]] else "new"
    text = f"{texts[0]} has become {texts[1]}: without a decimal point the {without} one counts least increments"
    yield Difference("point", text, *texts, "", *lines)


def _coordinates(part: Stretch) -> Rows:
    """Return the coordinates among the executed words of a part."""
    trace, rows = part.trace, part.rows
    if not len(rows):
        return rows
    low, high = np.searchsorted(trace.run.row, (rows[0], rows[-1] + 1))
    indices = np.arange(low, high)[trace.coordinates.is_coordinate[low:high]]
    return indices[np.isin(trace.run.row[indices], rows)]
