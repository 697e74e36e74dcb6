"""The moves of the tool center as a picture tells them, those of Z alone among them: what each is, when it runs."""

from __future__ import annotations

from functools import cached_property
from typing import Any, cast, get_args

import numpy as np

from polarcheck.arrays import Floats, Mask, Points, Rows, States
from polarcheck.checking.places import block_in_line
from polarcheck.geometry.compensation import Phase
from polarcheck.machines.modal import Motion
from polarcheck.pictures.picture import MoveTable, Role
from polarcheck.table.dynamics import Dynamics
from polarcheck.table.moves import Moves, z_along
from polarcheck.table.trace import Trace

ROLES = get_args(Role)
POSITIONING, CUT, START_UP, CANCEL, CORNER, UNKNOWN = map(np.int16, range(len(ROLES)))
#: Characters of a block.
_BLOCK = 120
#: Digits behind the point: of lengths [mm], of rates and shares, and of times [s].
LENGTH, RATE, TIME = 4, 3, 4


class SectionMoves:
    """
    Columns over the moves of a trace, those of Z alone included, section after section.

    On those of Z alone, and in dwells, x and c stand still. of_path: the move of the tool center path that each is, -1
    where it stands still.
    """

    def __init__(self, trace: Trace, dynamics: Dynamics) -> None:
        self.trace = trace
        self.dynamics = dynamics
        self.moves, self.of_path = _with_standing(trace, dynamics)

    def __len__(self) -> int:
        return len(self.moves)

    def _from_path(self, column: Floats, standing: Floats | float) -> Floats:
        """A column over the moves of the path, with values for those that stand still."""
        found = np.append(column, np.nan)[self.of_path]
        return np.where(self.of_path >= 0, found, standing)

    @cached_property
    def true_feed(self) -> Floats:
        """F that runs, the lowest on the way [mm/min]."""
        return self._from_path(self.dynamics.true_feed, self.trace.feed[self.moves.row])

    @cached_property
    def c_feed(self) -> Floats:
        """Highest rate of C [deg/min]."""
        return self._from_path(self.dynamics.c_feed, 0.0)

    @cached_property
    def x_feed(self) -> Floats:
        """Highest rate of X [mm/min]."""
        return self._from_path(self.dynamics.x_feed, 0.0)

    def of_section(self, section: int) -> Rows:
        """The moves of a section, in order."""
        return np.flatnonzero(self.moves.section == section)

    @cached_property
    def is_known(self) -> Mask:
        """The tool center runs there, between points that are known."""
        return np.asarray(self.moves.is_of_tool & ~np.isnan(self.moves.start + self.moves.end))

    @cached_property
    def role(self) -> States:
        """What each is drawn as, an index of ROLES."""
        moves, trace = self.moves, self.trace
        compensated = trace.anywhere_in_section(trace.compensates)[moves.row]
        rapid = trace.motion[moves.row] == Motion.RAPID
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
    def z(self) -> tuple[Floats, Floats]:
        """Before and after each [mm]."""
        return z_along(self.trace, self.moves)

    @cached_property
    def time(self) -> Floats:
        """How long each takes [s]; NaN where that is not known, or has no end."""
        of_row = self.dynamics.time[self.moves.row]
        # The time of a rapid is that of its row, where this is one move.
        alone = np.bincount(self.moves.row, minlength=len(self.trace))[self.moves.row] == 1
        moving = np.append(self.dynamics.at_feed, False)[self.of_path]
        time = np.where(moving, self._from_path(self.dynamics.move_time, np.nan), np.where(alone, of_row, np.nan))
        return np.where(np.isfinite(time) & self.is_known, time, np.nan)

    @cached_property
    def begin(self) -> Floats:
        """When each begins in its section [s]; a move whose time is not known takes none."""
        time, section = np.nan_to_num(self.time), self.moves.section
        done = np.cumsum(time) - time
        first = np.searchsorted(section, section)
        return np.asarray(done - done[first])

    def table(self, chosen: Rows) -> MoveTable:
        """Some of the moves as columns of a page."""
        moves, trace = self.moves, self.trace
        row, limit = moves.row[chosen], trace.machine.limits.c_feed
        numbers = _sequence_numbers(trace)
        written = {one: block_in_line(trace, one, _BLOCK) for one in np.unique(row).tolist()}
        number = {one: numbers.get(one, "") for one in written}
        roles = cast("tuple[Role, ...]", ROLES)
        return MoveTable(
            line=trace.line_in_file[row].tolist(),
            number=[number[one] for one in row.tolist()],
            block=[written[one] for one in row.tolist()],
            role=[roles[one] for one in self.role[chosen].tolist()],
            start=pairs(moves.start[chosen]),
            end=pairs(moves.end[chosen]),
            z=pairs(self.z[0][chosen] + 1j * self.z[1][chosen]),
            feed=numbers_of(np.where(trace.motion[row] == Motion.RAPID, np.nan, trace.programmed_feed[row]), RATE),
            true_feed=numbers_of(self.true_feed[chosen], RATE),
            nearest=numbers_of(moves.nearest[chosen], LENGTH),
            c_feed=numbers_of(self.c_feed[chosen], RATE),
            x_feed=numbers_of(self.x_feed[chosen], RATE),
            share=numbers_of(self.c_feed[chosen] / limit, RATE + 1),
            begin=numbers_of(self.begin[chosen], TIME),
            time=numbers_of(self.time[chosen], TIME),
        )


def _with_standing(trace: Trace, dynamics: Dynamics) -> tuple[Moves, Rows]:
    """
    The moves of the plane and, where they stand among them, those of Z alone and dwells, from a point to the same one;
    and which move of the plane each is, -1 for the others.
    """
    moves = dynamics.moves
    standing = trace.in_polar & ((trace.moves_z & ~trace.travels) | dynamics.dwells)
    row = np.setdiff1d(np.flatnonzero(standing), moves.row)
    if not len(row):
        return moves, np.arange(len(moves))
    # A pass of an infeed cycle runs over rows that the one before it has run over.
    at = np.searchsorted(np.maximum.accumulate(moves.row), row)
    last = np.append(moves.end, complex(np.nan, np.nan))[at - 1]
    follows = np.append(moves.section, -1)[at - 1] == trace.section[row]
    here = np.where(follows, last, trace.end[row])
    nowhere = np.full(len(row), complex(np.nan, np.nan))
    off = np.where(trace.compensates[row], Phase.OFFSET, Phase.CANCELLED)
    known = np.append(moves.known, True)[at - 1]
    still: dict[str, Any] = {
        "row": row,
        "section": trace.section[row],
        "kind": np.int16(Motion.LINE),
        "start": here,
        "end": here,
        "center": nowhere,
        "feed": trace.feed[row],
        "known": np.where(follows, known, True) & ~np.isnan(here),
        "phase": off,
        "corner": False,
        "allowance": 0.0,
    }
    columns = {name: np.insert(getattr(moves, name), at, values) for name, values in still.items()}
    return Moves(entry=moves.entry, **columns), np.insert(np.arange(len(moves)), at, -1)


def _sequence_numbers(trace: Trace) -> dict[int, str]:
    """The N words as they are written, by row."""
    words = trace.run.words
    return {
        int(trace.run.row[index]): trace.text.source.excerpt(int(words.start[index]), int(words.end[index]))
        for index in trace.word_indices("N").tolist()
    }


def numbers_of(column: Floats, digits: int) -> list[float | None]:
    """A column as JSON can hold it: None is unknown, or has no bound."""
    found = np.where(np.isfinite(column), np.round(column, digits) + 0.0, np.nan)
    result: list[float | None] = found.astype(object).tolist()
    for index in np.flatnonzero(np.isnan(found)).tolist():
        result[index] = None
    return result


def pairs(points: Points) -> list[tuple[float | None, float | None]]:
    """Points, or from and to, as pairs [mm]."""
    return list(zip(numbers_of(points.real, LENGTH), numbers_of(points.imag, LENGTH), strict=True))
