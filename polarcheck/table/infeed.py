"""
The infeed cycle of `G12.1 E`: the closed contour is cut in passes, each nearer by E, the last on the contour itself.

What the description says: from the start point to the beginning of the cut, along the contour, then in by E for each
further cycle until the contour is reached; the contour must be closed; E is a radius value, its sign is ignored.
What it leaves open, and what is taken here: a pass is the contour, moved off by a whole multiple of E to the side on
which the tool is, and its F is that of the contour; as many passes are cut as lie between the contour and the start
point, the farthest first; the control goes straight from the end of a pass to the beginning of the next.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
from msgspec.structs import replace

from polarcheck.arrays import Floats, Mask, Rows
from polarcheck.geometry import polar
from polarcheck.machines.modal import Motion, Side
from polarcheck.table.moves import Moves, compensation_path, joined, of_tool, tool_center_path
from polarcheck.table.trace import Trace

#: Points of one contour nearer than this are one [mm]: the rounding of coordinates to 0.001 mm.
CLOSED = 0.002
#: Passes of a section that are simulated, those next to the contour: C turns fastest where the tool is nearest.
MOST_PASSES = 200
MOST_MOVES = 200_000


class Infeed:
    """Columns of one trace, one value per row, and the passes of its cycles."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    @cached_property
    def depth(self) -> Floats:
        """E of the section that each G12.1 begins [mm, radius], without its sign; 0 where there is none."""
        trace, word = self.trace, self.trace.machine.polar.infeed_word
        if not word:
            return np.zeros(len(trace))
        return np.where(trace.enters, np.abs(np.nan_to_num(trace.length_of(word))), 0.0)

    @cached_property
    def _begins(self) -> list[int]:
        """The G12.1 with an E."""
        return np.flatnonzero(self.depth > 0).tolist()

    @cached_property
    def _contours(self) -> dict[int, tuple[Rows, bool]]:
        """Of each G12.1 with an E, the rows of its contour and whether that is closed."""
        return {row: self._contour(int(self.trace.section[row])) for row in self._begins}

    def _contour(self, section: int) -> tuple[Rows, bool]:
        """
        The rows of a section that move in the plane, from the one that leads to the contour to the last of the contour,
        and whether the contour is closed. Without a contour no row, and not closed.
        """
        trace = self.trace
        enter, leave = trace.sections.enter[section], trace.sections.leave[section]
        # A start-up in rapid traverse leads to the contour as one at feed does, which is what was meant.
        leads_or_cuts = trace.cuts | (trace.on_plane & trace.compensates)
        moving = enter + np.flatnonzero(leads_or_cuts[enter:leave])
        if not len(moving):
            return moving, False
        compensated = trace.side[moving] != Side.OFF
        if compensated.any():
            first = int(np.argmax(compensated))
            moving = moving[first : first + int(np.argmin(np.append(compensated[first:], False)))]
        back = 1 + np.flatnonzero(np.abs(trace.end[moving[1:]] - trace.end[moving[0]]) <= CLOSED)
        return (moving[: back[-1] + 1], True) if len(back) else (moving, False)

    @cached_property
    def gap(self) -> Floats:
        """
        From the end of the contour behind each G12.1 with an E to its beginning [mm]; 0 where it is closed, NaN where
        there is no contour or a point of it is not known.
        """
        gap = np.full(len(self.trace), np.nan)
        for row, (contour, closed) in self._contours.items():
            way = self.trace.end[contour] - self.trace.end[contour[:1]]
            if closed:
                gap[row] = 0.0
            elif len(way) and not np.isnan(way).any():
                gap[row] = np.abs(way[-1])
        return gap

    def offsets(self, row: int) -> Floats:
        """How far the passes before the last lie off the contour [mm], the farthest first."""
        contour, closed = self._contours[row]
        if not closed:
            return np.zeros(0)
        depth = float(self.depth[row])
        count = int(min(np.ceil(self._start_distance(contour) / depth - 1e-9) - 1, 1e6))
        return depth * np.arange(max(count, 0), 0, -1.0)

    def _start_distance(self, contour: Rows) -> float:
        """From the start point to the nearest point of the contour [mm]; 0 if unknown."""
        trace, on = self.trace, contour[1:]
        start = trace.start[contour[0]]
        shape = (trace.start[on] - start, trace.end[on] - start, trace.center[on] - start)
        kind = np.where(np.isnan(trace.center[on]), Motion.LINE, trace.motion[on]).astype(np.int16)
        return float(np.nan_to_num(np.min(polar.nearest(*shape, kind))))

    def _simulated(self, row: int, moves_left: int) -> Floats:
        """Of the passes behind a G12.1 those that are simulated: the ones next to the contour."""
        contour, _ = self._contours[row]
        found = self.offsets(row)
        return found[max(len(found) - min(MOST_PASSES, moves_left // max(len(contour), 1)), 0) :]

    def with_passes(self, moves: Moves) -> Moves:
        """The moves of the tool center with the passes that come before the last one."""
        if not self._begins or not len(moves):
            return moves
        moved, first = np.unique(moves.row, return_index=True)
        parts: list[Moves] = []
        done, added = 0, 0
        for row, (contour, _) in self._contours.items():
            found = self._simulated(row, MOST_MOVES - added)
            place = int(np.searchsorted(moved, contour[0])) if len(found) else len(moved)
            if place == len(moved) or moved[place] != contour[0]:
                continue
            at = int(first[place])
            parts.append(_between(moves, done, at))
            cuts = self._passes(contour, found, complex(moves.start[at]))
            parts.append(cuts)
            added += len(cuts)
            start = moves.start.copy()
            start[at] = cuts.end[-1]
            moves = replace(moves, start=start)
            done = at
        return joined([*parts, _between(moves, done, len(moves))])

    def _passes(self, contour: Rows, found: Floats, start: complex) -> Moves:
        """The rounds at some offsets from a start point: the contour as if the cutter were larger by each of them."""
        trace, count = self.trace, len(contour)
        rows, offset = np.tile(contour, len(found)), np.repeat(found, count)
        path = replace(compensation_path(trace, rows), section=np.repeat(np.arange(len(found)), count))
        is_known = np.ones(len(rows), bool)
        if (path.side == Side.OFF).all():
            side = np.full(len(rows), self._side_of_start(contour), np.int16)
            path = replace(path, side=side, radius=offset)
        else:
            # Of an unknown radius the pass shows where it lies to the contour, and is marked as not known.
            is_known = ~np.isnan(path.radius)
            radius = np.nan_to_num(path.radius)
            path = replace(path, radius=np.where(radius < 0, radius - offset, radius + offset))
        tool = tool_center_path(trace, path)
        first = np.flatnonzero(np.diff(tool.row // count, prepend=-1))
        begin = tool.start.copy()
        begin[first] = np.append(start, tool.end[first[1:] - 1])
        return replace(of_tool(trace, tool, rows), start=begin, known=tool.known & is_known[tool.row])

    def _side_of_start(self, contour: Rows) -> Side:
        """The side of the contour on which the start point lies, where the tool center itself is programmed."""
        trace = self.trace
        way = trace.end[contour[1]] - trace.start[contour[1]]
        across = (way.conjugate() * (trace.start[contour[0]] - trace.end[contour[0]])).imag
        return Side.LEFT if across > 0 else Side.RIGHT

    @cached_property
    def is_simulated_in_part(self) -> Mask:
        """G12.1 with an E of which only the passes next to the contour are simulated."""
        rows = np.zeros(len(self.trace), bool)
        rows[[row for row in self._begins if len(self.offsets(row)) > len(self._simulated(row, MOST_MOVES))]] = True
        return rows


def _between(moves: Moves, first: int, end: int) -> Moves:
    index = np.arange(len(moves))
    return moves.chosen((index >= first) & (index < end))
