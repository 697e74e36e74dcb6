"""The same contour in several passes, of which one differs from the others in a block or two."""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.columns.contour.passes import Passes, numbered
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Points, Rows, cached_property, different
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.plane import cross

if TYPE_CHECKING:
    from polarcheck.columns.contour.offset_passes import OddPoint
    from polarcheck.columns.contour.written_passes import WrittenDifference

#: Points nearer to each other than this [mm] are the same, and how far off a point is that differs.
_SAME, _OTHER = 1e-4, 0.004
#: Arcs with centers nearer to each other than this [mm] are of one circle: their ends are rounded.
_CIRCLE = 0.05
#: Moves that may differ, and the least number that agree.
_MOST_DIFFERING, _LEAST_AGREEING = 3, 2
#: Digits of a number from which on one other digit is a slip, and no other dimension.
_FINE = 4
#: Different passes with one beginning and end that are compared with each other.
_MOST = 12


class Difference(msgspec.Struct, frozen=True):
    """
    A pass that differs from another one.

    row: the row that differs. other: that of the other pass. is_missing: the other pass has a block more, row `other`.
    first, last: the rows of the other pass. beside: the pass lies beside the other one, but for this point.
    """

    row: int
    other: int
    is_missing: bool
    first: int
    last: int
    beside: OddPoint | None = None


class _Stretch(msgspec.Struct, frozen=True):
    """The moves of each pass that are compared: the first and the last one, and a number of their shape."""

    first: Rows
    last: Rows
    shape: Rows


class PassDifferences(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    passes: Passes

    @cached_property
    def found(self) -> dict[int, Difference]:
        """The differences, by the row that differs. Of two passes a third one beside them shows which is wrong."""
        shown = {difference.row for difference in self._beside}
        differences = [one for group in self._by_group for one in group if not {one.row, one.other} & shown]
        return {difference.row: difference for difference in reversed([*differences, *self._alone, *self._of_words])}

    @property
    def _are_several(self) -> bool:
        """True if two passes are long enough to be contours."""
        return bool(np.count_nonzero(self.passes.last - self.passes.first >= _LEAST_AGREEING) > 1)

    @cached_property
    def _alone(self) -> list[Difference]:
        """The differences of passes that are in no group."""
        return [*self._beside, *self._on_other_side, *self._of_leads]

    @cached_property
    def _beside(self) -> list[Difference]:
        """The passes that lie beside another one but for a point, as a finish and its roughing."""
        if not self._are_several:
            return []
        from polarcheck.columns.contour.offset_passes import odd_points  # imported late: most contours have one pass

        row, number = self.passes.row, self.passes.number
        return [
            Difference(int(row[odd.move]), int(row[odd.model]), False, *self._rows_of(int(number[odd.model])), odd)
            for odd in odd_points(self.passes)
        ]

    @property
    def _of_words(self) -> list[Difference]:
        """The differences of passes that are written otherwise."""
        return [
            Difference(int(rows[first]), int(model[first]), False, int(model[0]), int(model[-1]))
            for rows, model, first in self._written
        ]

    @cached_property
    def _written(self) -> list[WrittenDifference]:
        """Passes that are written otherwise, and of which the points alone tell nothing."""
        if not self._are_several:
            return []
        from polarcheck.columns.contour.written_passes import written_differences  # imported late, as above

        known = np.array([one.row for group in (*self._by_group, self._alone) for one in group], np.int64)
        return [
            other
            for other in written_differences(self.trace)
            if not np.any((known >= other.rows[0]) & (known <= other.rows[-1]))
        ]

    @cached_property
    def _by_group(self) -> list[list[Difference]]:
        """The differences of each group of passes."""
        return [self._differences_of(stretch, group) for stretch, group in self._groups]

    @property
    def _on_other_side(self) -> list[Difference]:
        """
        Passes with G41 where another pass of their section that is the same has G42, or the reverse, at other depths.

        Of both sides the rarer one in the program is wrong, else the later. At one depth both walls of a slot are cut.
        """
        passes, trace = self.passes, self.trace
        first, walls = passes.row[passes.first], np.flatnonzero(passes.is_wall)
        side, z, section = trace.compensation.side[first], trace.path.z[first], trace.mode.section[first]
        if not {Side.LEFT, Side.RIGHT} <= {*side[walls].tolist()}:
            return []
        shapes = [{*passes.shape[walls[side[walls] == one]].tolist()} for one in (Side.LEFT, Side.RIGHT)]
        begins = np.flatnonzero(trace.compensation.side != trace.compensation.side_before)
        differences = []
        for shape in sorted(shapes[0] & shapes[1]):
            alike = walls[passes.shape[walls] == shape]
            for number in alike.tolist():
                beside = alike[(section[alike] == section[number]) & (side[alike] != side[number])]
                same = np.count_nonzero(side[alike] == side[number])
                is_rare = (len(alike) - same, number) > (same, beside.max(initial=-1))
                if not len(beside) or not is_rare or (np.abs(z[beside] - z[number]) <= _OTHER).any():
                    continue
                row, other = (
                    int(begins[np.searchsorted(begins, first[which], "right") - 1]) for which in (number, beside[0])
                )
                differences.append(Difference(row, other, False, *self._rows_of(int(beside[0]))))
        return differences

    @property
    def _of_leads(self) -> list[Difference]:
        """The passes that begin or end with an arc that is tangent in another one of their moves, and not in them."""
        passes, trace = self.passes, self.trace
        is_long = passes.last - passes.first > _LEAST_AGREEING
        if not self._are_several or not (is_long & (passes.is_arc[passes.first] | passes.is_arc[passes.last])).any():
            return []
        from polarcheck.columns.contour.lead_arcs import odd_leads  # imported late, as above

        # What differs is the end of the block before an arc that leads to the contour.
        travels = np.flatnonzero(trace.path.travels)
        ends = passes.row, travels[np.searchsorted(travels, passes.row) - 1]
        leads = ((ends[odd.begins], odd.move, odd.model) for odd in odd_leads(passes))
        return [
            Difference(int(row[move]), int(row[model]), False, *self._rows_of(int(passes.number[model])))
            for row, move, model in leads
        ]

    def _rows_of(self, number: int) -> tuple[int, int]:
        """The first and the last row of a pass."""
        passes = self.passes
        return int(passes.row[passes.first[number]]), int(passes.row[passes.last[number]])

    @cached_property
    def twin(self) -> Rows:
        """
        The same number for all rows of passes that are compared, where one of them differs, and for the rows beside
        them, which are their ramps; -1 for other rows.
        """
        column, passes = np.full(len(self.trace), -1), self.passes
        groups = zip(self._groups, self._by_group, strict=True)
        alike = [[self._rows_of(which) for which in group.tolist()] if found else [] for (_, group), found in groups]
        for one in self._alone:
            which = passes.number[np.searchsorted(passes.row, one.row)]
            alike.append([self._rows_of(int(which)), (one.first, one.last)])
        written = [[(int(rows[0]), int(rows[-1])) for rows in (one.rows, one.model)] for one in self._written]
        travels = np.flatnonzero(self.trace.path.travels)
        # Where a pass is in several, its points count more than its words.
        for ramp in (1, 0):
            for number, stretches in enumerate([*written, *alike]):
                for first, last in stretches:
                    before, behind = np.searchsorted(travels, (first, last)).tolist()
                    near = travels[max(before - ramp, 0) : behind + 1 + ramp]
                    column[near[0] : near[-1] + 1] = number
        return column

    @cached_property
    def differs(self) -> Mask:
        """Rows that differ."""
        return self.trace.blocks.mask_of(sorted(self.found))

    @cached_property
    def _groups(self) -> list[tuple[_Stretch, Rows]]:
        """
        Passes of a program that begin and end at the same points, where there are several shapes of them; and passes
        that do so but for their first and last moves, as where a finishing pass begins beside a roughing pass.
        """
        passes = self.passes
        if not self._are_several:
            return []
        whole = _Stretch(passes.first, passes.last, passes.shape)
        groups = [(whole, group) for group in self._with_ends_alike(whole)]
        long = passes.last - passes.first > _LEAST_AGREEING + 1
        first, last = (np.where(long, end, passes.first) for end in (passes.first + 1, passes.last - 1))
        inner = _Stretch(first, last, passes.shape_of(first, last))
        begins = passes.start[passes.first], passes.end[passes.last]
        for group in self._with_ends_alike(inner):
            if any(np.abs(point[group] - point[group[0]]).max() > _OTHER for point in begins):
                groups.append((inner, group))
        return groups

    def _with_ends_alike(self, stretch: _Stretch) -> list[Rows]:
        """Passes of a program of which some moves begin and end at the same points, with several shapes of them."""
        passes = self.passes
        count = stretch.last - stretch.first + 1
        long = np.flatnonzero(count > _LEAST_AGREEING)
        if len(long) < 2:
            return []
        ends = passes.start[stretch.first[long]], passes.end[stretch.last[long]]
        program = self.trace.blocks.program[passes.row[stretch.first[long]]]
        keys = [np.round(part / _OTHER) for point in ends for part in (point.real, point.imag)]
        group = numbered([*keys, program.astype(np.float64), passes.compensated[long].astype(np.float64)])
        if np.bincount(group).max() < 2:
            return []
        shape = stretch.shape[long]
        order = np.lexsort((shape, group))
        several = group[order][1:][(np.diff(group[order]) == 0) & (np.diff(shape[order]) != 0)]
        return [long[group == number] for number in different(several).tolist()]

    def _differences_of(self, stretch: _Stretch, group: Rows) -> list[Difference]:
        """Each shape against the most frequent one that it differs from in a block or two; the rarer one is wrong."""
        shape = stretch.shape[group]
        kinds, first, count = np.unique(shape, return_index=True, return_counts=True)
        if len(kinds) > _MOST:
            return []
        # The most frequent first; of those as frequent the one above.
        order = np.lexsort((first, -count))
        differences = []
        for rank, kind in enumerate(order.tolist()):
            for model in order[:rank].tolist():
                difference = self._difference(
                    stretch, int(group[first[kind]]), int(group[first[model]]), bool(count[model] > count[kind])
                )
                if difference is not None:
                    differences.append(difference)
                    break
        return differences

    @cached_property
    def _runs_on(self) -> Mask:
        """Per move: the next one of its pass goes on along the same line or circle, so that no corner is between."""
        passes = self.passes
        start, corner, end = passes.start[:-1], passes.end[:-1], passes.end[1:]
        off = ((corner - start) * np.conj(end - start)).imag / np.maximum(np.abs(end - start), _SAME)
        is_ahead = ((corner - start) * np.conj(end - corner)).real > 0
        on_line = ~passes.is_arc[:-1] & ~passes.is_arc[1:] & (np.abs(off) <= _OTHER) & is_ahead
        on_circle = (np.abs(np.diff(passes.center)) <= _CIRCLE) & (np.diff(passes.motion) == 0)
        return np.append((on_line | on_circle) & (np.diff(passes.number) == 0), False)

    def _items(self, stretch: _Stretch, number: int) -> tuple[Rows, Points]:
        """The moves with which lines and arcs of a pass end: of each its end, its center, and its motion."""
        passes = self.passes
        moves = np.arange(stretch.first[number], stretch.last[number] + 1)
        moves = moves[~self._runs_on[moves] | (moves == moves[-1])]
        center = np.where(np.isnan(passes.center[moves]), 0, passes.center[moves])
        return moves, np.stack((passes.end[moves], center, passes.motion[moves].astype(np.complex128)), axis=1)

    def _difference(self, stretch: _Stretch, number: int, model: int, is_rare: bool) -> Difference | None:
        """Where a pass differs from a model of it, if a slip explains that; is_rare: more passes are as the model."""
        (rows, moves), (model_rows, model_moves) = self._items(stretch, number), self._items(stretch, model)
        shorter = min(len(moves), len(model_moves))
        head = _agreeing(moves[:shorter], model_moves[:shorter])
        tail = min(_agreeing(moves[::-1][:shorter], model_moves[::-1][:shorter]), shorter - head)
        differing = len(moves) - head - tail, len(model_moves) - head - tail
        if not 0 < max(differing) <= _MOST_DIFFERING or head + tail < max(_LEAST_AGREEING, max(differing)):
            return None
        if not tail:
            return None
        row, model_row = (int(self.passes.row[ends[head]]) for ends in (rows, model_rows))
        if self.trace.run.block[row] == self.trace.run.block[model_row] and differing[0] == differing[1]:
            return None
        if differing[0] == differing[1]:
            here, there = moves[head : head + differing[0]], model_moves[head : head + differing[0]]
            if np.abs(here - there).max() < _OTHER:
                return None
            explained = is_rare or self._is_slip(here, there, row, model_row)
            explained |= _turns(moves, model_moves, slice(head, head + differing[0] + 1))
        else:
            explained = sorted(differing) == [0, 1]
        if not explained:
            return None
        return Difference(row, model_row, differing[0] < differing[1], *self._rows_of(model))

    def _is_slip(self, here: Points, there: Points, row: int, second_row: int) -> bool:
        """
        One point that differs, or an arc with other words; or a coordinate of several points, where the words are those
        of a slip: a side that is moved on purpose moves two points.
        """
        apart = here[:, 0] - there[:, 0]
        moved = np.abs(apart) > _SAME
        if moved.sum() <= 1:
            return True
        along_x, along_c = bool((np.abs(apart.imag) <= _SAME).all()), bool((np.abs(apart.real) <= _SAME).all())
        if not (along_x or along_c) or np.ptp(np.abs(apart[moved])) > _SAME:
            return False
        blocks = self.trace.blocks
        address = chr(int(self.trace.axes.linear_axis[row])) if along_x else self.trace.axes.virtual_axis_of(row)
        words = float(blocks.word(address)[row]), float(blocks.word(address)[second_row])
        if np.isnan(sum(words)):
            return False
        from polarcheck.columns.words.slips import plain_number, slip_of  # few passes differ

        slip = slip_of(plain_number(words[0]), words[1], _SAME)
        return slip is not None and (slip.plain or len(plain_number(words[0]).strip("-").replace(".", "")) >= _FINE)


def _turns(moves: Points, model: Points, differing: slice) -> bool:
    """A line at a point that differs leads in another direction; those beside a side moved on purpose do not."""
    is_line = (moves[1:, 2] == Motion.LINE) & (model[1:, 2] == Motion.LINE)
    ways = np.diff(moves[:, 0]), np.diff(model[:, 0])
    aside = cross(*ways) / np.maximum(np.maximum(np.abs(ways[0]), np.abs(ways[1])), _SAME)
    turned = np.append(False, is_line & (np.abs(aside) > _OTHER))
    return bool(turned[differing].any())


def _agreeing(first: Points, second: Points) -> int:
    """How many moves agree from the first on."""
    same: Mask = np.all(np.abs(first - second) <= _SAME, axis=1)
    return int(np.argmin(same)) if not same.all() else len(same)
