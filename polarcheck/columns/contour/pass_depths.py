"""The depths of the passes of a contour: one pass that is far off the steps of the others."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.passes import numbered
from polarcheck.columns.metal.air_cuts import AirCuts, row_of_infeed
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Columns,
    Floats,
    Mask,
    Rows,
    Table,
    cached_property,
    different,
    first_in_run,
    first_of_each,
    median,
)
from polarcheck.geometry.tolerances import ROUNDING

#: A step is far off the others if it is as many times as large.
_FAR = 3.0
#: Passes of a contour that show its step; of fewer, down from Z0, the digits must show what is wrong.
_LEAST, _FEWEST = 3, 2
#: A step that is as many times as large as the least has left out a pass.
_SKIPPED = 1.5
#: More than any sum of sines: below its negative are the numbers of passes that share no point.
_ALONE = 1e6
#: Points that are nearer than this are one [mm].
_SAME = 2e-3
#: A depth is far below the turning if it is as many times as deep, and steep if it is as many times the cutter's width.
_BEYOND, _STEEP = 2.0, 2.5


class Passes(Table, frozen=True):
    """
    Passes, n of them in order: cuts at one Z of one section.

    row: int[n], the first cut. z: float64[n] [mm]. contour: int[n], equal for the same contour of one section. shape:
    int[n], the same of all sections.
    """

    row: Rows
    z: Floats
    contour: Rows
    shape: Rows

    @property
    def are_apart(self) -> bool:
        """Each is of another contour or section."""
        return len(different(self.contour)) == len(self)


class PassDepths(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    air_cuts: AirCuts

    @cached_property
    def passes(self) -> Passes:
        """All passes."""
        trace, rows = self.trace, np.flatnonzero(self.air_cuts.walls)
        if not len(rows):
            return Passes(rows, np.zeros(0), rows, rows)
        z, section = trace.path.z[rows], trace.mode.section[rows]
        first = np.flatnonzero((np.diff(section, prepend=-1) != 0) | (np.abs(np.diff(z, prepend=np.inf)) > ROUNDING))
        if len(first) < _FEWEST:
            return Passes(rows[first], z[first], *np.zeros((2, len(first)), np.int64))
        number = np.repeat(np.arange(len(first)), np.diff(np.append(first, len(rows))))
        point = first_of_each(np.rint(trace.path.end[rows] / _SAME / 4))[1]
        contour = _shapes(number, first_of_each(point * (section.max() + 1) + section)[1])
        return Passes(rows[first], z[first], contour, _shapes(number, point))

    @cached_property
    def expected(self) -> dict[int, float]:
        """
        By the row that goes to the Z of a pass that is off: the Z in step with the other passes [mm].

        NaN where several would be in step. The Z at which the turning ends for a pass in `is_beyond_turning`.
        """
        passes = dict([*self._beyond_turning, *self._of_sections, *self._in_steps])
        return {row_of_infeed(self.trace, row): z for row, z in passes.items()}

    @cached_property
    def is_off(self) -> Mask:
        """Rows that go to the Z of a pass that is off."""
        return self.trace.blocks.mask_of(sorted(self.expected))

    @cached_property
    def is_beyond_turning(self) -> Mask:
        """Of the rows that are off, those that are too deep for the bar, not for the other passes."""
        rows = {row for row, _ in self._beyond_turning} - {row for row, _ in (*self._of_sections, *self._in_steps)}
        return self.trace.blocks.mask_of([row_of_infeed(self.trace, row) for row in sorted(rows)])

    @cached_property
    def _beyond_turning(self) -> list[tuple[int, float]]:
        """
        Passes far below what is turned, or where the bar is wider, much deeper in one step than the cutter is wide, if
        Z with the point a digit to the left lies in what is turned; and the Z at which the turning ends.

        One of these alone may be meant: a shaft is milled across its shoulder, a wall is milled in one pass.
        """
        bar = self.air_cuts.bar
        turned = bar.deepest_turned
        if not np.isfinite(turned) or not len(self.passes):
            return []
        passes = self.passes
        section, z = self.trace.mode.section[passes.row], passes.z * bar.trace.path.z_sense
        step = np.where(np.diff(section, prepend=-1) == 0, np.append(0.0, z[:-1]), 0.0) - z
        width = 2 * self.air_cuts.workpiece.radius[passes.row]
        is_wider = bar.inner(passes.row, z) > bar.inner(passes.row, z / 10) + width / 4
        deep = ((z < _BEYOND * turned) | is_wider) & (z / 10 > turned) & (step > _STEEP * width)
        return [(row, turned * bar.trace.path.z_sense) for row in passes.row[deep].tolist()]

    @cached_property
    def _in_steps(self) -> list[tuple[int, float]]:
        """Passes out of step with the others of their contour, and the Z that would fit; NaN where several would."""
        groups = _groups(self.passes.contour, _FEWEST)
        return [off for group in groups if (off := self._out_of_step(self.passes[group])) is not None]

    def _out_of_step(self, passes: Passes) -> tuple[int, float] | None:
        """
        The pass of a contour that is out of step, and the Z that would fit.

        Of two passes, and where either of several may be the wrong one, the digits must show it. A pass that would have
        to go below the turning is right where another one would not.
        """
        bar, sense = self.air_cuts.bar, self.air_cuts.bar.trace.path.z_sense
        off = _outliers(passes.z * sense)
        if len(off) != 1 or len(passes) < _LEAST:
            scale = float(self.trace.lengths.scale[passes.row[0]]) * sense
            off = [(number, z) for number, z in off if _is_slip(passes.z[number] / scale, z / abs(scale))]
        if len(off) > 1:
            off = [(number, z) for number, z in off if z >= bar.deepest_turned] or off
        if not off:
            return None
        number, z = off[0]
        return int(passes.row[number]), z * sense if len(off) == 1 else np.nan

    @cached_property
    def _of_sections(self) -> list[tuple[int, float]]:
        """
        Of one contour in several sections, in one pass each, the pass at another Z, if that is a slip of the pen; and
        of contours of one tool that are alike, each at a place of its own.
        """
        passes = self.passes
        groups = [group for group in map(passes.__getitem__, _groups(passes.shape, _LEAST)) if group.are_apart]
        rows = [(group.row, group.z) for group in groups] + self._alike
        found: dict[int, float] = {}
        for row, z in rows:
            usual = median(z)
            off = np.flatnonzero(np.abs(z - usual) > ROUNDING)
            if len(off) == 1:
                scale = float(self.trace.lengths.scale[row[off[0]]])
                if _is_slip(float(z[off[0]]) / scale, usual / scale):
                    found.setdefault(int(row[off[0]]), usual)
        return list(found.items())

    @property
    def _alike(self) -> list[tuple[Rows, Floats]]:
        """First rows and Z of contours of one tool that have moves as long, each group of them at other places."""
        trace, rows = self.trace, np.flatnonzero(self.air_cuts.walls)
        begins = first_in_run(np.cumsum(trace.path.moves_z)[rows]).nonzero()[0]
        if len(begins) < _LEAST or np.ptp(trace.path.z[rows]) <= ROUNDING:
            return []
        first, length = rows[begins], trace.path.length[rows]
        sums = [np.add.reduceat(length**power, begins) for power in (0, 1, 2)]
        places = np.add.reduceat(trace.path.end[rows], begins) / sums[0]
        keys = [np.rint(total / _SAME / 10) for total in sums]
        tool = trace.tools.tool_called[first].astype(np.float64)
        like = numbered([*keys, tool])
        at = numbered([np.rint(places.real), np.rint(places.imag)])
        groups = [group for group in _groups(like, _LEAST) if len(different(at[group])) == len(group)]
        return [(first[group], trace.path.z[first[group]]) for group in groups]


def _groups(key: Rows, fewest: int) -> list[Rows]:
    """The numbers of the passes of equal keys, where they are as many."""
    order = np.argsort(key, kind="stable")
    first = first_in_run(key[order]).nonzero()[0]
    return [group for group in np.split(order, first[1:]) if len(group) >= fewest]


def _shapes(number: Rows, point: Rows) -> Rows:
    """
    Per pass a number of its points, without those that no other pass has: the first and the last have leads.

    It is a sum of sines, which is the same for the same points in any order, and for no others.
    """
    size = point.max() + 1
    of_pass, point = np.divmod(different(number * size + point), size)
    weight = np.where(np.bincount(point)[point] > 1, np.sin(point + 1.0), 0.0)
    total = np.bincount(of_pass, weight)
    return first_of_each(np.where(total, total, -_ALONE * (1.0 + np.arange(len(total)))))[1]


def _is_slip(written: float, intended: float) -> bool:
    """The digits of one number are those of the other and one more, or its point is elsewhere."""
    long, short = (f"{abs(value):.5f}".replace(".", "").strip("0") for value in (written, intended))
    if (written < 0) != (intended < 0) or not short:
        return False
    return long == short or any(long[:index] + long[index + 1 :] == short for index in range(len(long)))


def _outliers(z: Floats) -> list[tuple[int, float]]:
    """
    The passes of which all others go down from Z0 in like steps without the one, and the Z that each would have.

    Of two passes at one Z it is the later one, if the next step is as large as two.
    """
    levels = np.append(0.0, z) if z.max() < 0 else z
    if len(levels) < _LEAST:
        return []
    ahead = len(levels) - len(z)
    off: dict[float, tuple[int, float]] = {}
    for number in range(ahead, len(levels)):
        steps = -np.diff(np.delete(levels, number))
        step = float(steps.min())
        if step <= ROUNDING or steps.max() > _FAR * step:
            continue
        before = levels[number - 1] if number else np.inf
        after = levels[number + 1] if number + 1 < len(levels) else -np.inf
        if after + ROUNDING < levels[number] < before - ROUNDING and (
            after > -np.inf or before - levels[number] <= _FAR * steps.max()
        ):
            continue
        is_again = abs(levels[number] - before) <= ROUNDING
        if abs(levels[number] - after) <= ROUNDING:
            continue  # the later one counts
        if is_again and (number + 1 == len(levels) or before - after < _SKIPPED * step):
            continue  # a spring pass
        fits = (before + after) / 2 if np.isfinite(before + after) else before - step if number else after + step
        off[float(levels[number])] = number - ahead, float(fits)
    return list(off.values())
