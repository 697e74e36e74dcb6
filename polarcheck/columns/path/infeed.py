"""
The infeed cycle of `G12.1 E`: the closed contour is cut in passes, each nearer by E, the last on the contour itself.

What the description says: from the start point to the beginning of the cut, along the contour, then in by E for each
further cycle until the contour is reached; the contour must be closed; E is a radius value, its sign is ignored.
It leaves open, and is assumed here: a pass is the contour, moved off by a whole multiple of E to the side on
which the tool is, and its F is that of the contour; as many passes are cut as lie between the contour and the start
point, the farthest first; the control goes straight from the end of a pass to the beginning of the next.

How many these are: the start point is one of the tool center, and lies d off the contour, on the side of the tool. The
tool center of the pass k E off the contour runs R + k E off it. The first pass is an infeed from the start point, too,
so that R + k E < d: there are ceil((d - R) / E) - 1 of them before the contour itself, inside as outside. One that is
through the start point but for the rounding of coordinates is none. R is 0 where the tool center itself is programmed,
and where R is unknown. Where the contour lies between the start point and the tool there is none; and round a corner,
where the tool center swings out by more than R + k E, none beyond the start point.

A pass that runs along arcs or corners into which R and its offset together do not fit has a finding and no moves.
"""

from __future__ import annotations

import msgspec
import numpy as np
from msgspec.structs import replace

from polarcheck.columns.path.moves import Moves, compensation_path, of_tool, tool_center_path
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, column_at, first_in_run, repeated
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.cutter_compensation.offset_path import ToolPath
from polarcheck.geometry.plane_path import PlanePath

#: Points of one contour nearer than this are one [mm]: the rounding of coordinates to 0.001 mm.
CLOSED = 0.002
#: Passes of a section that are simulated, those next to the contour: C turns fastest where the tool is nearest.
MOST_PASSES = 200
MOST_MOVES = 200_000
#: Rounding error of a whole number of least increments, as a share of one.
CUT = 1e-6


class _Cycle(msgspec.Struct, frozen=True):
    """
    The simulated passes of one cycle.

    contour: rows of the trace, those of its contour.
    offsets: float64[passes] [mm], distance of each pass from the contour, the farthest first.
    rows: rows of the trace, those of the contour repeated for each pass.
    tool: the tool center path; its `row` is an index of `rows`.
    known: bool[rows], the path is known.
    unfit: bool[passes, contour], moves that the control would reject.
    """

    contour: Rows
    offsets: Floats
    rows: Rows
    tool: ToolPath
    known: Mask
    unfit: Mask

    @property
    def is_unfit(self) -> Mask:
        """Passes with any move that the control would reject."""
        return np.asarray(self.unfit.any(axis=1))


class Infeed(Columns, frozen=True):
    """Columns of one trace, one value per row, and the passes of its cycles."""

    trace: Trace

    @cached_property
    def written(self) -> Floats:
        """E beside each G12.1 [mm, radius], without its sign and as it is written; NaN where there is none."""
        trace, word = self.trace, self.trace.machine.polar.infeed_word
        if not word:
            return repeated(np.float64(np.nan), len(trace))
        return np.where(trace.mode.enters, np.abs(trace.lengths.length_of(word)), np.nan)

    @cached_property
    def depth(self) -> Floats:
        """
        E of the section that each G12.1 begins [mm, radius], without its sign; 0 where there is none.

        The control drops what is finer than its least increment, so that an E below that is none.
        """
        written, step = self.written, self.trace.lengths.least_step
        if not np.any(written > 0):
            return repeated(np.float64(0), len(written))
        return np.nan_to_num(np.floor(written / step + CUT) * step)

    @cached_property
    def _begins(self) -> list[int]:
        """The G12.1 with an E."""
        return np.flatnonzero(self.depth > 0).tolist()

    @cached_property
    def _contours(self) -> dict[int, tuple[Rows, bool]]:
        """The rows of the contour of each G12.1 with an E, and True if the contour is closed."""
        return {row: self._contour(int(self.trace.mode.section[row])) for row in self._begins}

    def _contour(self, section: int) -> tuple[Rows, bool]:
        """
        The rows of a section that move in the plane, from the one that leads to the contour to the last of the contour,
        and whether the contour is closed. Without a contour no row, and not closed.
        """
        trace = self.trace
        enter, leave = trace.mode.sections.enter[section], trace.mode.sections.leave[section]
        # A start-up in rapid traverse leads to the contour as one at feed does, which is what was meant.
        leads_or_cuts = trace.path.cuts | (trace.path.on_plane & trace.compensation.compensates)
        moving = enter + np.flatnonzero(leads_or_cuts[enter:leave])
        if not len(moving):
            return moving, False
        compensated = trace.compensation.side[moving] != Side.OFF
        if compensated.any():
            first = int(np.argmax(compensated))
            moving = moving[first : first + int(np.argmin(np.append(compensated[first:], False)))]
        back = 1 + np.flatnonzero(np.abs(trace.path.end[moving[1:]] - trace.path.end[moving[0]]) <= CLOSED)
        return (moving[: back[-1] + 1], True) if len(back) else (moving, False)

    @cached_property
    def gap(self) -> Floats:
        """
        From the end of the contour behind each G12.1 with an E to its beginning [mm]; 0 where it is closed, NaN where
        there is no contour, a point of it is not known, or a row of unknown effect in its section may close it.
        """
        if not self._contours:
            return repeated(np.float64(np.nan), len(self.trace))
        gap = np.full(len(self.trace), np.nan)
        unknown = self.trace.mode.anywhere_in_section(self.trace.run.unknown)
        for row, (contour, closed) in self._contours.items():
            distances = self.trace.path.end[contour] - self.trace.path.end[contour[:1]]
            if closed:
                gap[row] = 0.0
            elif len(distances) and not np.isnan(distances).any() and not unknown[row]:
                gap[row] = np.abs(distances[-1])
        return gap

    def offsets(self, row: int) -> Floats:
        """Distances of the passes before the last from the contour [mm], the farthest first."""
        return np.asarray(self.depth[row] * np.arange(self._counts_before_last[row], 0, -1.0))

    @cached_property
    def _counts_before_last(self) -> dict[int, int]:
        """The number of passes before the last of each G12.1 with an E."""
        return {row: self._count_before_last(row) for row in self._begins}

    def _count_before_last(self, row: int) -> int:
        contour, closed = self._contours[row]
        if not closed:
            return 0
        return max(int(min(np.ceil((self._room(contour) - CLOSED) / self.depth[row]) - 1, 1e6)), 0)

    def _seen_from(self, point: complex, contour: Rows) -> PlanePath:
        """The contour from a point instead of the center of C."""
        trace, on = self.trace, contour[1:]
        kind = np.where(np.isnan(trace.path.center[on]), Motion.LINE, trace.axes.motion[on]).astype(np.int16)
        return PlanePath(trace.path.start[on] - point, trace.path.end[on] - point, trace.path.center[on] - point, kind)

    def _room(self, contour: Rows) -> float:
        """From the tool center at the start point to where it runs along the contour [mm]: d - R; 0 if unknown."""
        trace = self.trace
        path = self._seen_from(complex(trace.path.start[contour[0]]), contour)
        side, radius = (
            int(trace.compensation.side[contour[0]]),
            float(np.nan_to_num(trace.compensation.radius[contour[0]])),
        )
        if side == Side.OFF:
            radius = 0.0
        elif path.is_on_left() != ((side == Side.LEFT) == (radius >= 0)):
            return 0.0
        return float(np.nan_to_num(np.min(path.nearest))) - abs(radius)

    @cached_property
    def _cycles(self) -> dict[int, _Cycle]:
        """The cycles with passes before the last, by their G12.1."""
        cycles: dict[int, _Cycle] = {}
        added = 0
        for row, (contour, _) in self._contours.items():
            offsets = self._simulated(row, MOST_MOVES - added)
            if len(offsets):
                cycle = self._passes(contour, offsets)
                cycles.update({row: cycle} if len(cycle.offsets) else {})
                added += len(cycle.tool.row)
        return cycles

    def _simulated(self, row: int, moves_left: int) -> Floats:
        """The simulated passes of a G12.1, by their distances: those next to the contour."""
        contour, _ = self._contours[row]
        offsets = self.offsets(row)
        return offsets[max(len(offsets) - min(MOST_PASSES, moves_left // max(len(contour), 1)), 0) :]

    def with_passes(self, moves: Moves) -> Moves:
        """The moves of the tool center with the passes that come before the last one."""
        if not self._begins or not len(moves):
            return moves
        moved, first = np.unique(moves.row, return_index=True)
        parts: list[Moves] = []
        done = 0
        for cycle in self._cycles.values():
            index = int(np.searchsorted(moved, cycle.contour[0]))
            if index == len(moved) or moved[index] != cycle.contour[0]:
                continue
            first_move = int(first[index])
            cuts = self._moves(cycle, complex(moves.start[first_move]))
            if not len(cuts):
                continue
            parts.append(_between(moves, done, first_move))
            parts.append(cuts)
            start = moves.start.copy()
            start[first_move] = cuts.end[-1]
            moves = replace(moves, start=start)
            done = first_move
        return Moves.concatenated([*parts, _between(moves, done, len(moves))])

    def _moves(self, cycle: _Cycle, start: complex) -> Moves:
        """The moves of the passes that fit, in order, from a start point; the path of other passes is not known."""
        tool, number = cycle.tool, cycle.tool.row // len(cycle.contour)
        allowance, is_known = cycle.offsets[number], tool.known & cycle.known[tool.row]
        rounds = replace(of_tool(self.trace, tool, cycle.rows), known=is_known, allowance=allowance)
        fits = ~cycle.is_unfit[number]
        rounds, number = rounds[fits], number[fits]
        first = np.flatnonzero(first_in_run(number))
        begin = rounds.start.copy()
        begin[first] = np.append(start, rounds.end[first[1:] - 1])[: len(first)]
        return replace(rounds, start=begin)

    def _passes(self, contour: Rows, offsets: Floats) -> _Cycle:
        """The passes at these offsets: the contour with a cutter that is larger by each offset."""
        cycle = self._rounds(contour, offsets)
        beyond = self._beyond_start(cycle) & ~cycle.is_unfit
        return self._rounds(contour, offsets[~beyond]) if beyond.any() else cycle

    def _rounds(self, contour: Rows, offsets: Floats) -> _Cycle:
        trace, count = self.trace, len(contour)
        rows, offset = np.tile(contour, len(offsets)), np.repeat(offsets, count)
        path = replace(compensation_path(trace, rows), section=np.repeat(np.arange(len(offsets)), count))
        is_known = np.ones(len(rows), bool)
        if (path.side == Side.OFF).all():
            side = np.full(len(rows), self._side_of_start(contour), np.int16)
            path = replace(path, side=side, radius=offset)
        else:
            # With an unknown radius the pass only shows its place beside the contour; it is marked as not known.
            is_known = ~np.isnan(path.radius)
            radius = np.nan_to_num(path.radius)
            path = replace(path, radius=np.where(radius < 0, radius - offset, radius + offset))
        tool = tool_center_path(trace, path)
        unfit = ((tool.inside_arc_too_small | tool.interferes | tool.no_intersection) & is_known).reshape(-1, count)
        # The way to the contour is no part of it, and has rules of its own.
        unfit[:, :1] = False
        return _Cycle(contour, offsets, rows, tool, is_known, unfit)

    def _beyond_start(self, cycle: _Cycle) -> Mask:
        """Passes that do not lie between the contour and the start point."""
        trace, tool, count = self.trace, cycle.tool, len(cycle.contour)
        start = complex(trace.path.start[cycle.contour[0]])
        inside = self._seen_from(start, cycle.contour).goes_round()
        on = tool.row % count > 0
        group = tool.row[on] // count
        path = PlanePath(tool.start[on] - start, tool.end[on] - start, tool.center[on] - start, tool.kind[on])
        return np.asarray(path.go_round(group, len(cycle.offsets)) != inside)

    def _side_of_start(self, contour: Rows) -> Side:
        """The side of the contour on which the start point lies, where the tool center itself is programmed."""
        path = self._seen_from(complex(self.trace.path.start[contour[0]]), contour)
        return Side.LEFT if path.is_on_left() else Side.RIGHT

    # ---- passes that do not fit ----

    def _counts(self, counts: dict[int, int]) -> Rows:
        if not counts:
            return repeated(np.int64(0), len(self.trace))
        return column_at(len(self.trace), list(counts), list(counts.values()), 0)

    @cached_property
    def passes(self) -> Rows:
        """How many passes are simulated behind each G12.1 with an E, the contour itself among them; 0 elsewhere."""
        return self._counts({row: len(cycle.offsets) + 1 for row, cycle in self._cycles.items()})

    @cached_property
    def unfit(self) -> Rows:
        """The number of passes along arcs or corners into which the tool does not fit at that offset."""
        return self._counts({row: int(cycle.is_unfit.sum()) for row, cycle in self._cycles.items()})

    @cached_property
    def least_unfit(self) -> dict[int, tuple[float, int]]:
        """For each G12.1 with such passes: the offset of the nearest one [mm], and its first row at fault."""
        least = {}
        for row, cycle in self._cycles.items():
            bad = np.flatnonzero(cycle.is_unfit)
            if len(bad):
                row_at_fault = int(cycle.contour[np.argmax(cycle.unfit[bad[-1]])])
                least[row] = float(cycle.offsets[bad[-1]]), row_at_fault
        return least

    @cached_property
    def judged_by_radius(self) -> Mask:
        """G12.1 with an E whose passes depend on R: along a closed contour with G41 or G42."""
        rows = self.trace.blocks.mask_of(
            [row for row, (contour, _) in self._contours.items() if self._is_compensated(contour)]
        )
        return np.asarray(rows & (self.gap == 0))

    def _is_compensated(self, contour: Rows) -> bool:
        return bool((self.trace.compensation.side[contour] != Side.OFF).any())

    @cached_property
    def has_further_contour(self) -> Mask:
        """G12.1 with an E behind whose contour, offset cancel included, another is cut with compensation."""
        trace, mask = self.trace, np.zeros(len(self.trace), bool)
        for row, (contour, _) in self._contours.items():
            if not len(contour) or trace.compensation.side[contour[0]] == Side.OFF:
                continue
            side = trace.compensation.side[contour[-1] : trace.mode.sections.leave[trace.mode.section[row]]]
            mask[row] = bool((side[int(np.argmax(side == Side.OFF)) :] != Side.OFF).any() and (side == Side.OFF).any())
        return mask

    @cached_property
    def is_simulated_in_part(self) -> Mask:
        """G12.1 with an E with more passes than are simulated."""
        before_last = self._counts_before_last
        rows = [row for row in self._begins if before_last[row] > len(self._simulated(row, MOST_MOVES))]
        return self.trace.blocks.mask_of(rows)


def _between(moves: Moves, first: int, end: int) -> Moves:
    index = np.arange(len(moves))
    return moves[(index >= first) & (index < end)]
