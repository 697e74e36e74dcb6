"""
The path of the tool center as columns: faults that the control would report, the distance to the center of C, and the
turning of the C axis.
"""

from __future__ import annotations

import msgspec
import numpy as np

from polarcheck.columns.path.infeed import Infeed
from polarcheck.columns.path.moves import Moves, compensation_path, of_tool, per_row, tool_center_path
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, Points, Rows, cached_property, last_in_run
from polarcheck.foundation.states import Motion, Side
from polarcheck.geometry.cutter_compensation.offset_path import Path, ToolPath
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import SHARE

#: The share of R that must fit beside a stretch of many blocks for their rounding to be what is wrong.
_SURELY = 7 / 8
#: Columns of a ToolPath that have an element for each move, beside those of PlanePath.
_PER_MOVE = "row", "phase", "corner", "known"


class OtherRadius(msgspec.Struct, frozen=True):
    """
    Another R for some of the rows.

    rows: those that have it; no other row is compensated. group: per row of the trace, equal for rows that are
    compensated together. radius: per row, with its sign [mm]; of the other sign it is the other side.
    """

    rows: Mask
    group: Rows
    radius: Floats


class ToolCenter:
    """
    Columns over the rows of the trace, each from the moves of the tool center in that row; and those moves.

    other_radius: the R to run with instead of that in force, without the passes of infeed cycles; None for the path
    that the program makes.
    """

    def __init__(self, trace: Trace, infeed: Infeed, *, other_radius: OtherRadius | None = None) -> None:
        self.trace = trace
        self.infeed = infeed
        self.other_radius = other_radius

    @cached_property
    def radius(self) -> Floats:
        """R with its sign [mm], NaN where it is not known."""
        in_force, trial = self.trace.compensation.radius, self.other_radius
        return in_force if trial is None else np.where(trial.rows, trial.radius, in_force)

    @cached_property
    def _rows(self) -> Rows:
        """The rows of the trace that are compensated: those in the mode, of another R those that have it."""
        in_polar, trial = self.trace.mode.in_polar, self.other_radius
        return np.flatnonzero(in_polar if trial is None else in_polar & trial.rows)

    @property
    def _programmed(self) -> Path:
        """Not stored: it is large, and needed again only where the tool interferes."""
        path, trial = compensation_path(self.trace, self._rows), self.other_radius
        if trial is None:
            return path
        return msgspec.structs.replace(path, section=trial.group[self._rows], radius=trial.radius[self._rows])

    @cached_property
    def _path(self) -> ToolPath:
        """Without the last move of a section that goes on elsewhere, where it ran back: its end hangs on the next."""
        path = tool_center_path(self.trace, self._programmed)
        open_ends = path.interferes & self._goes_on_elsewhere[self._rows] if path.interferes.any() else path.interferes
        if not open_ends.any():
            return path
        kept = ~open_ends[path.row]
        moves = {name: getattr(path, name)[kept] for name in (*PlanePath.__struct_fields__, *_PER_MOVE)}
        return msgspec.structs.replace(path, **moves, interferes=path.interferes & ~open_ends)

    @property
    def _goes_on_elsewhere(self) -> Mask:
        """The last move of each section that no G13.1 of this program leaves."""
        trace, sections = self.trace, self.trace.mode.sections
        is_open = np.append(~sections.left | sections.returned, False)
        rows = np.flatnonzero(trace.path.on_plane & is_open[trace.mode.section])
        return trace.blocks.mask_of(rows[last_in_run(trace.mode.section[rows])])

    @cached_property
    def moves(self) -> Moves:
        """The moves of the tool center inside sections."""
        moves = of_tool(self.trace, self._path, self._rows)
        return self.infeed.with_passes(moves) if self.other_radius is None else moves

    # ---- what the control would object to while it compensates ----

    def _in_trace(self, in_path: Mask) -> Mask:
        """A mask over the rows of the trace from a mask over the rows of the path."""
        return self.trace.blocks.mask_of(self._rows[in_path])

    @cached_property
    def inside_arc_too_small(self) -> Mask:
        """An arc on whose inner side the tool does not fit: its radius is not above R."""
        return self._in_trace(self._path.inside_arc_too_small)

    @cached_property
    def interferes(self) -> Mask:
        """The tool center would run against the program."""
        return self._in_trace(self._path.interferes)

    @cached_property
    def _kept(self) -> Mask:
        """The rows of the path at whose ends the contour bends by more than the rounding of its points."""
        from polarcheck.geometry.rounding import kept_ends  # asked for where the tool would run back

        path = self._programmed
        return kept_ends(path.start, path.end, _goes_on(path), self._half_of_last_digit)

    @cached_property
    def _half_of_last_digit(self) -> Points:
        return self.trace.lengths.half_of_last_digit(self._rows)

    @cached_property
    def stretch(self) -> Rows:
        """The number of the straight stretch of each row; blocks that rounding alone parts lie in one."""
        ends = np.ones(len(self.trace), np.int64)
        if self.interferes.any():
            ends[self._rows] = self._kept
        return np.cumsum(ends) - ends

    @cached_property
    def interferes_by_rounding(self) -> Mask:
        """
        Moves that interfere only because of the rounding of their points to the last digit.

        Where blocks are so short that this digit turns them by more than the contour does, a part that is convex has
        inside corners, too tight for the cutter.
        """
        if not self.interferes.any():
            return self.interferes
        path, kept = self._programmed, self._kept
        rows = np.flatnonzero(kept)
        first = np.append(0, rows[:-1] + 1)
        # What rounding still turns the stretches by is a share of what the contour turns them by.
        radius = path.radius[rows] * np.where(rows > first, _SURELY, 1.0)
        stretches = msgspec.structs.replace(path[rows], start=path.start[first], radius=radius)
        straight = tool_center_path(self.trace, stretches)
        faulty = straight.interferes | straight.no_intersection | straight.inside_arc_too_small
        by_rounding = self._in_trace(self._path.interferes & ~faulty[np.searchsorted(rows, np.arange(len(kept)))])
        from polarcheck.geometry.rounding import may_turn_back

        # Among many such blocks a few that rounding may well turn round tell nothing, whatever is left of them.
        short = self._in_trace(may_turn_back(path.start, path.end, self._half_of_last_digit, path.radius))
        really = self.interferes & short & ~by_rounding
        most = self.trace.mode.count_in_section(by_rounding) > self.trace.mode.count_in_section(really)
        return np.asarray(by_rounding | (really & np.append(most, False)[self.trace.mode.section]))

    @cached_property
    def no_intersection(self) -> Mask:
        """The paths of the tool center do not meet at the inside corner at the end of the row."""
        return self._in_trace(self._path.no_intersection)

    @cached_property
    def movement_missing(self) -> Mask:
        """The control does not know the next move in time, so that the row ends perpendicular, which is wrong there."""
        return self._in_trace(self._path.movement_missing)

    @cached_property
    def waits_for_movement(self) -> Mask:
        """
        movement_missing, in the block that is the reason where there is one: the first behind it whose words for the
        plane move nothing.
        """
        trace, missing = self.trace, self.movement_missing
        if not missing.any():
            return missing
        idle = trace.axes.moves_plane & ~trace.path.travels & ~trace.path.moves_z & trace.mode.in_polar
        moved, waiting = np.cumsum(trace.path.travels), np.flatnonzero(idle)
        rows = np.flatnonzero(missing)
        last_waiting = np.append(waiting, -1)[np.searchsorted(waiting, rows)]
        has_reason = (last_waiting >= 0) & (moved[last_waiting] == moved[rows])
        return trace.blocks.mask_of(np.where(has_reason, last_waiting, rows))

    @cached_property
    def arc_center_on_path(self) -> Mask:
        """An arc whose center is its start or its end."""
        return self._in_trace(self._path.arc_center_on_path)

    # ---- where it runs and how fast ----

    def _of_moves(self, values: Floats, none: float, largest: bool = True) -> Floats:
        return per_row(values, self.moves, len(self.trace), none, largest)

    @cached_property
    def nearest(self) -> Floats:
        """Smallest distance of the tool center to the center of C [mm]; inf without movement, NaN unknown."""
        return self._of_moves(self.moves.nearest, np.inf, largest=False)

    @cached_property
    def farthest(self) -> Floats:
        """Largest distance of the tool center to the center of C [mm]; -inf without movement, NaN unknown."""
        return self._of_moves(self.moves.farthest, -np.inf)

    @cached_property
    def c_feed(self) -> Floats:
        """Highest rate of C [deg/min]; 0 without movement, NaN unknown."""
        return self._of_moves(self.moves.c_feed, 0.0)

    @cached_property
    def c_acceleration(self) -> Floats:
        """Highest acceleration of C [deg/s2]; 0 without movement, NaN unknown."""
        return self._of_moves(self.moves.c_acceleration, 0.0)

    @cached_property
    def x_acceleration(self) -> Floats:
        """Highest acceleration of X [mm/s2, radius]; 0 without movement, NaN unknown."""
        return self._of_moves(self.moves.x_acceleration, 0.0)

    @cached_property
    def c_feed_limit(self) -> float:
        """Limit of C [deg/min]: the machine's own, of which automatic override takes a share; else a suspicious one."""
        limits = self.trace.machine.limits
        if np.isnan(limits.c_feed):
            return limits.c_feed_suspicious
        return limits.c_feed * (min(limits.override_share, 100) / 100 if limits.automatic_override else 1)

    @cached_property
    def exceeds_c_feed_limit(self) -> Mask:
        """C would turn faster than its limit."""
        return np.asarray(self.c_feed > self.c_feed_limit * (1 + SHARE))

    @cached_property
    def is_at_c_feed_limit(self) -> Mask:
        """C would turn at the machine's own limit, which F < L * R * pi / 180 leaves out (B-62764EN/01 p. 52)."""
        limits = self.trace.machine.limits
        if np.isnan(limits.c_feed) or limits.automatic_override:
            return np.zeros(len(self.trace), bool)
        return np.asarray(np.abs(self.c_feed - self.c_feed_limit) <= self.c_feed_limit * SHARE)

    @cached_property
    def feed_allowed(self) -> Floats:
        """F that turns C at its limit [mm/min]; inf without movement."""
        return self._of_moves(self.moves.feed_allowed(self.c_feed_limit), np.inf, largest=False)

    @cached_property
    def override(self) -> Floats:
        """
        Share of F that automatic override leaves in each row [%]; 100 where the machine has none or it does not act.

        It acts where C would turn faster than override_share of its limit, and leaves that (B-64120EN/01 p. 280).
        """
        limits = self.trace.machine.limits
        share = np.full(len(self.trace), 100.0)
        if limits.automatic_override and not np.isnan(limits.c_feed):
            np.divide(100 * self.c_feed_limit, self.c_feed, out=share, where=~(self.c_feed <= self.c_feed_limit))
        return share

    @cached_property
    def true_feed(self) -> Floats:
        """F that automatic override leaves [mm/min]."""
        return np.asarray(self.trace.feedrate.feed * self.override / 100)


def _goes_on(path: Path) -> Mask:
    """Straight moves in offset mode that nothing parts from such a move before them."""
    plain = path.moves & (path.motion == Motion.LINE) & (path.side != Side.OFF) & ~path.side_written
    plain &= ~np.isnan(path.start + path.end) & ~path.stops_reading
    joins = plain[1:] & plain[:-1] & (path.section[1:] == path.section[:-1]) & (path.side[1:] == path.side[:-1])
    return np.append(np.zeros(min(len(plain), 1), bool), joins & (path.radius[1:] == path.radius[:-1]))


def moves_of(tool_center: ToolCenter) -> Moves:
    """The moves of the tool center, as a table of its own."""
    return tool_center.moves
