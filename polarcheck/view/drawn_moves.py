"""The moves of the tool center for a picture, including those of Z alone: their roles and times."""

from __future__ import annotations

from functools import cached_property
from typing import cast, get_args

import numpy as np

from polarcheck.columns.feed.dynamics import Dynamics
from polarcheck.columns.path.moves import Moves, z_along
from polarcheck.columns.path.standing_moves import with_standing
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, States, side_by_side
from polarcheck.foundation.states import Motion
from polarcheck.geometry.cutter_compensation.offset_path import Phase
from polarcheck.geometry.rates import c_feed
from polarcheck.geometry.tolerances import ZERO
from polarcheck.rules.places import block_in_line
from polarcheck.view.picture_data import MoveTable, Role

ROLES = get_args(Role)
POSITIONING, CUT, START_UP, CANCEL, CORNER, UNKNOWN = map(np.int16, range(len(ROLES)))
#: The longest text of a block [characters].
_BLOCK = 120
#: Decimals of lengths [mm], of rates and shares, and of times [s].
LENGTH, RATE, TIME = 4, 3, 6
#: C turns at once by more than this [deg].
_TURNS = 1e-3


class SectionMoves:
    """
    Columns over the moves of a trace, section after section, including those of Z alone and dwells.

    moves: the moves; x and c stand still in moves of Z alone and in dwells.
    of_path: the number of each move in the tool center path, -1 where x and c stand still.
    """

    def __init__(self, trace: Trace, dynamics: Dynamics) -> None:
        self.trace = trace
        self.dynamics = dynamics
        standing = (trace.path.moves_z & ~trace.path.travels) | dynamics.dwells
        self.moves, self.of_path = with_standing(trace, dynamics.moves, trace.mode.in_polar & standing)

    def __len__(self) -> int:
        return len(self.moves)

    def _from_path(self, column: Floats, standing: Floats | float) -> Floats:
        """Extend a column over the moves of the path by values for the moves that stand still."""
        values = np.append(column, np.nan)[self.of_path]
        return np.where(self.of_path >= 0, values, standing)

    @cached_property
    def true_feed(self) -> Floats:
        """Actual feed, the lowest in each move [mm/min]."""
        return self._from_path(self.dynamics.true_feed, self.trace.feedrate.feed[self.moves.row])

    @cached_property
    def c_feed(self) -> Floats:
        """Highest rate of C [deg/min]."""
        return self._from_path(self.dynamics.c_feed, 0.0)

    @cached_property
    def x_feed(self) -> Floats:
        """Highest rate of X [mm/min]."""
        return self._from_path(self.dynamics.x_feed, 0.0)

    def of_section(self, section: int) -> Rows:
        """Return the moves of a section, in order."""
        return np.flatnonzero(self.moves.section == section)

    @cached_property
    def is_known(self) -> Mask:
        """True where the move is one of the tool center, between known points."""
        return np.asarray(self.moves.is_of_tool & ~np.isnan(self.moves.start + self.moves.end))

    @cached_property
    def role(self) -> States:
        """How each move is drawn, an index of ROLES."""
        moves, trace = self.moves, self.trace
        compensated = trace.mode.anywhere_in_section(trace.compensation.compensates)[moves.row]
        rapid = trace.axes.motion[moves.row] == Motion.RAPID
        return np.select(
            [
                ~moves.is_of_tool,
                moves.phase == Phase.START_UP,
                moves.phase == Phase.CANCEL,
                moves.corner,
                rapid | ((moves.phase == Phase.CANCELLED) & compensated),
            ],
            [UNKNOWN, START_UP, CANCEL, CORNER, POSITIONING],
            CUT,
        ).astype(np.int16)

    @cached_property
    def jump(self) -> Mask:
        """C would have to turn at once: at the center of C, in the move or where it begins."""
        moves = self.moves
        before, after = moves.c_angles
        jumps = np.isinf(c_feed(*moves.shape, 1.0))
        follows = moves.section[1:] == moves.section[:-1]
        # Angles are continuous but at the center itself.
        jumps[1:] |= follows & (np.abs(before[1:] - after[:-1]) > _TURNS) & (np.abs(moves.start[1:]) <= ZERO)
        return jumps & self.is_known

    @cached_property
    def z(self) -> tuple[Floats, Floats]:
        """Z before and after each move [mm]."""
        return z_along(self.trace, self.moves)

    @cached_property
    def time(self) -> Floats:
        """Time of each move [s]; NaN if unknown or infinite."""
        of_row = self.dynamics.time[self.moves.row]
        # The time of a rapid is that of its row, if the row has a single move.
        alone = np.bincount(self.moves.row, minlength=len(self.trace))[self.moves.row] == 1
        moving = np.append(self.dynamics.at_feed, False)[self.of_path]
        time = np.where(moving, self._from_path(self.dynamics.move_time, np.nan), np.where(alone, of_row, np.nan))
        return np.where(np.isfinite(time) & self.is_known, time, np.nan)

    @cached_property
    def begin(self) -> Floats:
        """Start of each move within its section [s]; unknown times count as 0."""
        time, section = np.nan_to_num(self.time), self.moves.section
        done = np.cumsum(time) - time
        first = np.searchsorted(section, section)
        return np.asarray(done - done[first])

    def table(self, chosen: Rows) -> MoveTable:
        """Return the chosen moves as columns for a page."""
        moves, trace = self.moves, self.trace
        row, limit = moves.row[chosen], trace.machine.limits.c_feed
        numbers = _sequence_numbers(trace)
        written = {unique_row: block_in_line(trace.run, unique_row, _BLOCK) for unique_row in np.unique(row).tolist()}
        number = {unique_row: numbers.get(unique_row, "") for unique_row in written}
        roles = cast("tuple[Role, ...]", ROLES)
        return MoveTable(
            line=trace.blocks.line_in_file[row].tolist(),
            number=[number[unique_row] for unique_row in row.tolist()],
            block=[written[unique_row] for unique_row in row.tolist()],
            role=[roles[role] for role in self.role[chosen].tolist()],
            start=pairs(moves.start[chosen]),
            end=pairs(moves.end[chosen]),
            z=pairs(self.z[0][chosen] + 1j * self.z[1][chosen]),
            feed=numbers_of(
                np.where(trace.axes.motion[row] == Motion.RAPID, np.nan, trace.feedrate.programmed_feed[row]), RATE
            ),
            true_feed=numbers_of(self.true_feed[chosen], RATE),
            nearest=numbers_of(moves.nearest[chosen], LENGTH),
            c_feed=numbers_of(self.c_feed[chosen], RATE),
            x_feed=numbers_of(self.x_feed[chosen], RATE),
            share=numbers_of(self.c_feed[chosen] / limit, RATE + 1),
            begin=numbers_of(self.begin[chosen], TIME),
            time=numbers_of(self.time[chosen], TIME),
            center=_centers(moves[chosen]),
            jump=self.jump[chosen].tolist(),
            angle=list(zip(*(numbers_of(angle[chosen], RATE) for angle in moves.c_angles), strict=True)),
        )


def _centers(moves: Moves) -> list[tuple[float, float] | None]:
    """Return the center of each arc [mm], None for other moves."""
    is_arc = moves.is_arc & ~np.isnan(moves.center)
    rounded = np.round(moves.center, LENGTH) + 0.0
    return [(x, c) if has_center else None for x, c, has_center in side_by_side(rounded.real, rounded.imag, is_arc)]


def _sequence_numbers(trace: Trace) -> dict[int, str]:
    """Return the N words as written, by row."""
    words = trace.run.words
    return {
        int(trace.run.row[index]): trace.text.written(words, index) for index in trace.blocks.word_indices("N").tolist()
    }


def numbers_of(column: Floats, digits: int) -> list[float | None]:
    """Return a column as a list for JSON; None is unknown or infinite."""
    rounded = np.where(np.isfinite(column), np.round(column, digits) + 0.0, np.nan)
    result: list[float | None] = rounded.astype(object).tolist()
    for index in np.flatnonzero(np.isnan(rounded)).tolist():
        result[index] = None
    return result


def pairs(points: Points) -> list[tuple[float | None, float | None]]:
    """Return complex numbers as pairs [mm]: points as (x, c), or (from, to)."""
    return list(zip(numbers_of(points.real, LENGTH), numbers_of(points.imag, LENGTH), strict=True))
