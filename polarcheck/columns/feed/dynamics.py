"""
Rates, accelerations and times of the moves at the F that really runs, and the time of each row.

F that runs is F in force, clamped in the mode where the control does so (Trace.feed), and slowed down where automatic
override acts. A block that moves Z beside X or C takes the time of its way on the plane, or in space, by what F is
along (polar.feed_measures); Z alone the time of its own. In rapid traverse each axis runs at its own rate, and the one
that takes longest counts, be it with a straight way or without (B-63944EN/03, G00). Axes take no time to speed up and
to slow down here: what the servo adds is not known. Neither are tool changes and M codes counted.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import msgspec
import numpy as np

from polarcheck.columns.path.moves import Moves
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, is_among
from polarcheck.foundation.states import FeedMode, Motion
from polarcheck.geometry import polar
from polarcheck.geometry.tolerances import SHARE, ZERO

if TYPE_CHECKING:
    from polarcheck.geometry.automatic_override import Pieces

#: Why the time of a row is not known, in the order in which it is said: the first that holds.
NOT_EXECUTED, PER_REVOLUTION, NO_FEED, RAPIDS, RADIUS, DWELL_IN_TURNS, DWELL, CYCLE, POSITION = (
    "not executed",
    "feed per revolution",
    "no F",
    "rapid traverse",
    "no radius",
    "dwell in turns of a spindle",
    "dwell",
    "cycle",
    "position not known",
)


class Times(msgspec.Struct, frozen=True):
    """
    The total time of a set of rows.

    known: time of the rows whose time is known [s].
    unknown: for the other rows by reason: the reason, the number of rows, and the first row.
    """

    known: float
    unknown: tuple[tuple[str, int, int], ...]

    @property
    def whole(self) -> float:
        """The time of all rows; NaN where that of one of them is not known."""
        return np.nan if self.unknown else self.known


class Dynamics(Columns, frozen=True):
    """Columns over the moves of the tool center (true_feed to x_acceleration) and over the rows of the trace."""

    trace: Trace
    tool_center: ToolCenter

    # ---- the moves of the tool center ----

    @property
    def moves(self) -> Moves:
        """The moves of the tool center."""
        return self.tool_center.moves

    @cached_property
    def at_feed(self) -> Mask:
        """Moves at F: in rapid traverse, at which most controls alarm, F says nothing."""
        return np.asarray(self.trace.axes.motion[self.moves.row] != Motion.RAPID)

    @cached_property
    def c_limit(self) -> float:
        """The rate at which automatic override holds C [deg/min]; NaN where it does not act, or no limit is known."""
        limits = self.trace.machine.limits
        return self.tool_center.c_feed_limit if limits.automatic_override and limits.c_feed > 0 else np.nan

    @cached_property
    def is_slowed(self) -> Mask:
        """Automatic override acts on the way."""
        return np.asarray(self.at_feed & (self.moves.c_feed > self.c_limit * (1 + SHARE)))

    @cached_property
    def pieces(self) -> Pieces:
        """The moves on which it acts, parted where it begins and ends; `move` is of all moves."""
        from polarcheck.geometry import automatic_override  # few machines slow down at the center

        chosen = self.moves[self.is_slowed]
        with_override = automatic_override.pieces(*chosen.shape, chosen.plane_feed, self.c_limit)
        return msgspec.structs.replace(with_override, move=np.flatnonzero(self.is_slowed)[with_override.move])

    def _largest(self, plain: Floats, name: str) -> Floats:
        """Per move the largest of its pieces; NaN in rapid traverse."""
        largest = np.where(self.at_feed, plain, np.nan)
        if self.is_slowed.any():
            largest[self.is_slowed] = 0.0
            np.maximum.at(largest, self.pieces.move, getattr(self.pieces, name)())
        return largest

    @cached_property
    def true_feed(self) -> Floats:
        """F that runs [mm/min], the lowest on the way; 0 through the center under override; NaN unknown, in rapids."""
        feed = np.where(self.at_feed, self.moves.feed, np.nan)
        if self.is_slowed.any():
            feed = np.where(self.is_slowed, self.moves.feed_allowed(self.c_limit), feed)
        return feed

    @cached_property
    def c_feed(self) -> Floats:
        """Highest rate of C on the way [deg/min]; NaN where feed, radius or position is not known."""
        return self._largest(self.moves.c_feed, "c_feed")

    @cached_property
    def c_acceleration(self) -> Floats:
        """Highest acceleration of C within the move [deg/s2]; NaN likewise."""
        return self._largest(self.moves.c_acceleration, "c_acceleration")

    @cached_property
    def x_feed(self) -> Floats:
        """Highest rate of X on the way [mm/min, radius]; NaN likewise."""
        return self._largest(self.moves.x_feed, "x_feed")

    @cached_property
    def x_acceleration(self) -> Floats:
        """Highest acceleration of X within the move [mm/s2, radius]; NaN likewise."""
        return self._largest(self.moves.x_acceleration, "x_acceleration")

    @cached_property
    def move_time(self) -> Floats:
        """Time of each move [s]; NaN where it is not known. The time of a rapid belongs to its row."""
        time = self.time_without_override.copy()
        if self.is_slowed.any():
            time[self.is_slowed] = 0.0
            np.add.at(time, self.pieces.move, self.pieces.time())
        return time

    @property
    def time_without_override(self) -> Floats:
        """The same without override: the tool runs at F in force throughout."""
        is_known = self.at_feed & self.moves.is_of_tool
        return np.where(is_known, self.moves.time, np.nan)

    # ---- the rows ----

    @cached_property
    def on_path(self) -> Mask:
        """Rows with moves of the tool center at F."""
        return self.trace.blocks.mask_of(self.moves.row[self.at_feed])

    @cached_property
    def time(self) -> Floats:
        """How long each row takes [s]; 0 where nothing moves, NaN where it is not known."""
        trace = self.trace
        of_moves = np.where(self.at_feed, self.move_time, 0.0)
        time = np.asarray(np.bincount(self.moves.row, of_moves, minlength=len(trace)), np.float64)
        switches = trace.mode.enters | trace.mode.leaves
        rest = np.flatnonzero(~self.on_path & ~switches & (trace.axes.moves | self.dwells | self._returns))
        at_feed = is_among(trace.axes.motion[rest], (Motion.LINE, Motion.CW, Motion.CCW))
        time[rest] = np.where(at_feed, self._time_of_lines(rest), np.nan)
        rapids = rest[trace.axes.motion[rest] == Motion.RAPID]
        time[rapids] = self._time_of_rapids(rapids)
        time[rest] = np.where(self.dwells[rest], self._dwell_times[0][rest], time[rest])
        time[trace.run.unknown] = np.nan
        return time

    def _time_of_lines(self, rows: Rows) -> Floats:
        """Time of straight moves in X and Z at F per minute; moves of C and arcs outside the mode are not followed."""
        trace = self.trace
        x, z, c = self._axis_distances(rows)
        along_x = np.where(trace.mode.in_polar[rows], 0.0, x)
        is_line = trace.mode.in_polar[rows] | ((trace.axes.motion[rows] == Motion.LINE) & (c <= ZERO))
        return np.where(is_line, polar.time(np.hypot(along_x, z), trace.feedrate.feed[rows]), np.nan)

    def _time_of_rapids(self, rows: Rows) -> Floats:
        """The longest of its axes; one that stands still needs no rate."""
        limits = self.trace.machine.limits
        rates = (limits.x_rapid, limits.z_rapid, limits.c_rapid)
        lengths = self._axis_distances(rows)
        times = [np.where(length <= ZERO, 0.0, 60 * length / rate) for length, rate in zip(lengths, rates, strict=True)]
        longest: Floats = np.max(np.stack(times), axis=0) if len(rows) else np.zeros(0)
        return longest

    def _axis_distances(self, rows: Rows) -> tuple[Floats, Floats, Floats]:
        """Distances that X [mm, radius], Z [mm] and C [deg] move; 0 for an axis that the row does not program."""
        trace = self.trace
        on_plane = trace.axes.moves_plane[rows] & trace.mode.in_polar[rows]
        x = np.where(trace.mode.in_polar[rows], np.abs(trace.path.end[rows]) - np.abs(trace.path.start[rows]), 0.0)
        x = np.where(trace.mode.in_polar[rows], x, trace.path.x[rows] - trace.path.x_before[rows])
        x = np.where(on_plane | trace.axes.programs_linear_axis[rows], x, 0.0)
        z = np.where(trace.path.moves_z[rows], (trace.path.z - trace.path.z_before)[rows], 0.0)
        c = trace.path.c_turn[rows]
        c = np.where(on_plane | trace.blocks.has(*trace.machine.polar.rotary_words)[rows], c, 0.0)
        return np.abs(x), np.abs(z), np.abs(c)

    # ---- dwells, and what is not known ----

    @cached_property
    def dwells(self) -> Mask:
        """Rows with a dwell."""
        return self.trace.blocks.listed("dwell")

    @cached_property
    def _dwell_times(self) -> tuple[Floats, Mask]:
        """How long each dwell takes [s], and those that count turns of a spindle."""
        if not self.dwells.any():
            return np.zeros(len(self.trace)), self.dwells
        # Most programs have none.
        from polarcheck.columns.feed.dwells import in_turns, time_of_dwells

        return time_of_dwells(self.trace), in_turns(self.trace)

    @cached_property
    def _returns(self) -> Mask:
        """Rows that return to a reference position, which is not known."""
        return self.trace.blocks.listed("reference_return", "machine_coordinates") & self.trace.blocks.has(
            "X", "U", "Z", "W"
        )

    @cached_property
    def unknown(self) -> tuple[tuple[str, Mask], ...]:
        """Rows of which the time is not known, by reason; each row stands under one."""
        trace, missing = self.trace, np.isnan(self.time)
        rapid = trace.axes.motion == Motion.RAPID
        needs_feed = missing & ~rapid & ~self.dwells & ~trace.modal.in_cycle & ~self._returns
        no_radius = trace.blocks.mask_of(self.moves.row[~self.moves.is_of_tool])
        no_radius &= np.isnan(trace.compensation.radius_of_move)
        reasons = []
        for reason, mask in (
            (NOT_EXECUTED, trace.run.unknown),
            (DWELL_IN_TURNS, self._dwell_times[1]),
            (DWELL, self.dwells),
            (CYCLE, trace.modal.in_cycle),
            (RAPIDS, rapid | self._returns),
            (PER_REVOLUTION, needs_feed & (trace.feedrate.feed_mode == FeedMode.PER_REVOLUTION)),
            (NO_FEED, needs_feed & np.isnan(trace.feedrate.feed)),
            (RADIUS, no_radius),
            (POSITION, missing),
        ):
            if np.count_nonzero(rows := missing & mask):
                reasons.append((reason, rows))
                missing &= ~rows
        return tuple(reasons)

    def times(self, rows: Rows) -> Times:
        """How long these rows take together."""
        seconds = float(np.nansum(self.time[rows]))
        hit = ((reason, rows[mask[rows]]) for reason, mask in self.unknown)
        return Times(seconds, tuple((reason, len(limited), int(limited[0])) for reason, limited in hit if len(limited)))

    @cached_property
    def section_time(self) -> Floats:
        """Per section how long it takes [s]; NaN where the time of one of its rows is not known."""
        trace, count = self.trace, len(self.trace.mode.sections)
        inside = trace.mode.section >= 0
        return np.asarray(np.bincount(trace.mode.section[inside], self.time[inside], minlength=count), np.float64)
