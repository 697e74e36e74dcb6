"""The moves of the programmed path and of the tool center path inside sections, with what they ask of the lathe."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from polarcheck.columns.path.path import NOWHERE
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import (
    Floats,
    Mask,
    Points,
    Rows,
    States,
    cached_property,
    column_at,
    first_in_run,
    is_among,
    last_in_run,
    mask_at,
    repeated,
    runs,
)
from polarcheck.foundation.states import ArcFeed, Motion
from polarcheck.geometry import polar, rates
from polarcheck.geometry.cutter_compensation import offset_path
from polarcheck.geometry.plane_path import PlanePath
from polarcheck.geometry.tolerances import ZERO

#: Formulas take so many moves at a time: what they compute on the way is as large as the moves themselves.
_AT_A_TIME = 16_384


class Moves(PlanePath, frozen=True, dict=True):
    """
    Moves of the tool center, or as programmed.

    row: the row of the trace that it belongs to. section: its polar section. feed: F in force [mm/min]. rise: way of Z
    beside that on the plane, where F measures both [mm]; 0 where F measures the plane alone. arc_share: share of F with
    which the tool center runs along an arc; 1 elsewhere, and where F is that of the tool center. known: False where the
    radius or a position is unknown. phase: compensation.Phase. corner: a line or an arc that the control adds.
    allowance: what a pass of an infeed cycle leaves on the contour [mm], 0 elsewhere. entry: float64[sections], C angle
    of the linear axis of each section [deg]. c_axis: how C stands to the angles of the plane.
    """

    _shared = ("entry", "c_axis")

    row: Rows
    section: Rows
    feed: Floats
    rise: Floats
    arc_share: Floats
    known: Mask
    phase: States
    corner: Mask
    allowance: Floats
    entry: Floats
    c_axis: polar.CAxis

    @cached_property
    def length(self) -> Floats:
        """Distance on the plane [mm]."""
        return polar.length(*self.shape)

    @property
    def way(self) -> Floats:
        """Distance along which F is measured [mm]: on the plane, or in space."""
        return np.hypot(self.length, self.rise) if self.rise.any() else self.length

    @cached_property
    def plane_share(self) -> Floats:
        """Share of F with which the tool center moves on the plane: 1 unless F measures Z, too, or the contour."""
        if not self.rise.any():
            return self.arc_share
        return self.arc_share * np.divide(self.length, self.way, out=np.ones(len(self)), where=self.rise != 0)

    @cached_property
    def plane_feed(self) -> Floats:
        """Feed on the plane [mm/min]."""
        return np.asarray(self.feed * self.plane_share)

    @cached_property
    def nearest(self) -> Floats:
        """L, smallest distance of the tool center to the center of C [mm]; NaN where it is not known."""
        return self._where_known(polar.nearest)

    @property
    def farthest(self) -> Floats:
        """Largest distance of the tool center to the center of C [mm]; NaN where it is not known."""
        return self._where_known(polar.farthest)

    @cached_property
    def c_feed(self) -> Floats:
        """Highest rate of C on the way [deg/min]; NaN where feed, radius or position is not known."""
        return self._where_known(rates.c_feed, self.plane_feed)

    @property
    def c_acceleration(self) -> Floats:
        """Highest acceleration of C on the way [deg/s2]."""
        return self._where_known(rates.c_acceleration, self.plane_feed)

    @cached_property
    def x_feed(self) -> Floats:
        """Highest rate of X on the way [mm/min, radius]; NaN where feed, radius or position is not known."""
        return self._where_known(rates.x_feed, self.plane_feed)

    @property
    def x_acceleration(self) -> Floats:
        """Highest acceleration of X on the way [mm/s2, radius]."""
        return self._where_known(rates.x_acceleration, self.plane_feed)

    @cached_property
    def is_of_tool(self) -> Mask:
        """The tool center runs there: its path is known or, without G41 and G42, the programmed one."""
        return np.asarray(self.known | (self.phase == offset_path.Phase.CANCELLED))

    @property
    def time(self) -> Floats:
        """How long the move takes [s]."""
        return polar.time(self.way, self.feed * self.arc_share)

    @cached_property
    def c_angles(self) -> tuple[Floats, Floats]:
        """C before and after the move [deg], continuous along the section."""
        return polar.c_angles(*self.shape, self.section, self.entry, self.c_axis)

    def feed_allowed(self, limit: float | Floats) -> Floats:
        """Highest F that keeps C at or below the limit [mm/min]."""
        with np.errstate(divide="ignore", invalid="ignore"):  # Z alone moves: nothing turns C
            return self._where_known(rates.feed_allowed, np.broadcast_to(limit, len(self))) / self.plane_share

    def _where_known(self, function: Callable[..., Floats], *columns: Floats) -> Floats:
        """Return a function of the shape and columns of each move; NaN where the path of the tool is not known."""
        known, values = np.flatnonzero(self.known), np.full(len(self), np.nan)
        of_moves: list[NDArray[Any]] = [*self.shape, *columns]
        for first in range(0, len(known), _AT_A_TIME):
            part = known[first : first + _AT_A_TIME]
            values[part] = function(*(column[part] for column in of_moves))
        return values


def z_along(trace: Trace, moves: Moves) -> tuple[Floats, Floats]:
    """Z before and after each move [mm], NaN unknown; where a block is several moves, it goes as the way does."""
    begins, _, after_move = _shares_of_block(moves.row, moves.length)
    z_from, z_to = trace.path.z_before[moves.row], trace.path.z[moves.row]
    ends = np.append(begins[1:], True)[: len(moves)]
    after = np.where(ends, z_to, z_from + after_move * (z_to - z_from))
    return np.where(begins, z_from, np.append(np.nan, after[:-1])[: len(moves)]), after


def _shares_of_block(row: Rows, length: Floats) -> tuple[Mask, Floats, Floats]:
    """
    The moves with which a block begins, and the share of the way of its block before and after each move.

    The last move of a block without a way has all of it.
    """
    begins, ends, (first, last) = first_in_run(row), last_in_run(row), runs(row)
    distance, count = np.cumsum(np.nan_to_num(length)), last - first + 1
    done = distance - np.repeat((distance - np.nan_to_num(length))[first], count)
    whole = np.repeat(done[ends], count)
    after = np.where(ends, 1.0, np.divide(done, whole, out=np.zeros(len(row)), where=whole > 0))
    return begins, np.where(begins, 0.0, np.append(0.0, after[:-1])[: len(row)]), after


def _rise(trace: Trace, row: Rows, path: PlanePath) -> Floats:
    """
    Distance of Z beside moves of these rows [mm], where F measures it; 0 elsewhere, NaN where Z is not known.

    A block of several moves shares its Z out by their ways on the plane, as z_along does.
    """
    rises = trace.path.rise[row]
    if not rises.any():
        return repeated(np.float64(0), len(row))
    _, from_share, to_share = _shares_of_block(row, path.length)
    return np.asarray(rises * (to_share - from_share))


def per_row(values: Floats, moves: Moves, count: int, none: float, largest: bool = True) -> Floats:
    """
    One value per row of the trace: the largest (smallest) of its moves, NaN if one of them is unknown, `none` without.

    The moves of a row need not be neighbours.
    """
    column = np.full(count, -np.inf if largest else np.inf)
    with np.errstate(invalid="ignore"):  # NaN is meant
        (np.maximum if largest else np.minimum).at(column, moves.row, values)
    return np.where(np.isinf(column) & ~_has(moves, count), none, column)


def _has(moves: Moves, count: int) -> Mask:
    return any_in_row(np.ones(len(moves), bool), moves, count)


def any_in_row(hit: Mask, moves: Moves, count: int) -> Mask:
    """The rows of the trace with a move that is hit."""
    return mask_at(count, moves.row[hit])


def programmed_moves(trace: Trace, of_rows: Mask | bool = True) -> Moves:
    """The programmed path: one move per row that moves on the polar plane; of_rows: the rows wanted, all if True."""
    row = np.flatnonzero(trace.path.on_plane & of_rows)
    start, end = _ends(trace, row)
    return Moves(
        start=start,
        end=end,
        center=trace.path.center[row],
        kind=_kind(trace, row),
        row=row,
        section=trace.mode.section[row],
        feed=trace.feedrate.feed[row],
        rise=trace.path.rise[row],
        arc_share=repeated(np.float64(1), len(row)),
        known=~np.isnan(end - start),
        phase=np.zeros(len(row), np.int16),
        corner=np.zeros(len(row), bool),
        allowance=repeated(np.float64(0), len(row)),
        entry=trace.path.section_entry,
        c_axis=trace.path.c_axis,
    )


def _ends(trace: Trace, row: Rows) -> tuple[Points, Points]:
    """Start and end of the move in each row; NaN where the way between them is not known."""
    unknown = trace.path.shape_is_unknown
    start, end = trace.path.start[row], trace.path.end[row]
    if not unknown.any():
        return start, end
    return np.where(unknown[row], NOWHERE, start), np.where(unknown[row], NOWHERE, end)


def _kind(trace: Trace, row: Rows) -> States:
    """Motion of each move; an arc whose center is not known is followed along its chord."""
    kind = trace.axes.motion[row]
    along_chord = (trace.path.is_arc[row] & np.isnan(trace.path.center[row])) | (kind == Motion.UNKNOWN)
    return np.where(along_chord, Motion.LINE, kind).astype(np.int16)


def compensation_path(trace: Trace, row: Rows) -> offset_path.Path:
    """Some rows as cutter compensation takes them."""
    start, end = _ends(trace, row)
    return offset_path.Path(
        section=trace.mode.section[row],
        motion=_kind(trace, row),
        moves=trace.axes.moves_plane[row],
        start=start,
        end=end,
        center=trace.path.center[row],
        side=trace.compensation.side[row],
        side_written=trace.compensation.writes_side[row],
        radius=trace.compensation.radius[row],
        cancel_vector=_cancel_vector(trace, row),
        corner=trace.compensation.corner[row],
        stops_reading=trace.blocks.codes(*trace.machine.m_codes.stops_reading_ahead)[row],
    )


def tool_center_path(trace: Trace, path: offset_path.Path) -> offset_path.ToolPath:
    """The path of the tool center as this machine compensates."""
    settings = trace.machine.compensation
    return offset_path.tool_center_path(
        path,
        offset_path.Method(
            start_up=settings.start_up,
            start_up_moving=settings.start_up_with_move,
            read_ahead=settings.read_ahead,
            interference=settings.interference,
            tangent_tolerance=settings.tangent_tolerance,
            arc_above=math.radians(settings.corner_arc_above),
            arc_from=math.radians(settings.corner_arc_from),
        ),
    )


def of_tool(trace: Trace, tool: offset_path.ToolPath, row: Rows) -> Moves:
    """The moves of a tool center path; row: the rows of the trace that it was given."""
    rows = row[tool.row]
    return Moves(
        *tool.shape,
        row=rows,
        section=trace.mode.section[rows],
        feed=trace.feedrate.feed[rows],
        rise=_rise(trace, rows, tool),
        arc_share=_arc_share(trace, tool, rows),
        known=tool.known,
        phase=tool.phase,
        corner=tool.corner,
        allowance=repeated(np.float64(0), len(rows)),
        entry=trace.path.section_entry,
        c_axis=trace.path.c_axis,
    )


def _arc_share(trace: Trace, tool: offset_path.ToolPath, row: Rows) -> Floats:
    """Share of F with which the tool center runs along arcs where F is that of the contour: R of its arc by that."""
    where = trace.modal.state("arc_feed")[row]
    if not where.any():
        return repeated(np.float64(1), len(row))
    share = np.ones(len(row))
    of_contour = np.abs(trace.path.start - trace.path.center)[row]
    of_center = np.abs(tool.start - tool.center)
    arcs = (where != ArcFeed.CENTER) & is_among(tool.kind, (Motion.CW, Motion.CCW)) & ~tool.corner & (of_contour > ZERO)
    np.divide(of_center, of_contour, out=share, where=arcs)
    return np.where(where == ArcFeed.INNER_CONTOUR, np.minimum(share, 1.0), share)


def _cancel_vector(trace: Trace, row: Rows) -> Points:
    """I and J beside G40 say where the tool leaves (B-63324EN/03 p. 402)."""
    cancels = np.flatnonzero(trace.compensation.writes_cancel[row])
    i, j = (words[row[cancels]] for words in trace.path.to_center)
    written = ~np.isnan(i) | ~np.isnan(j)
    vector = (np.nan_to_num(i) + 1j * np.nan_to_num(j))[written]
    return column_at(len(row), cancels[written], vector, complex("nan+nanj"))
