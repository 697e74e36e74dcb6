"""
The bar before milling: its outside diameter, its face and its bore, and where they are known from.

The job says it, or what the program turns before its first polar section leaves it, or a comment. Lengths in mm,
diameters as such.
"""

from __future__ import annotations

from typing import Literal, NamedTuple

import numpy as np

from polarcheck.columns.filling import before, fill_down
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.stock_comments import StockComments
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, Table, cached_property, different, is_among
from polarcheck.foundation.states import Motion
from polarcheck.geometry.tolerances import ROUNDING
from polarcheck.program.machines.axis_table import INCREMENTS

#: Across corners of a hexagon, by its width across flats.
_CORNERS = 2 / np.sqrt(3)
#: A facing move that ends within this radius of X0 leaves a whole face [mm]: the nose of the tool reaches over it.
_CENTER = 1.5
#: More turning moves than this are not looked at.
_MOST = 4000


class Known(NamedTuple):
    """
    The known sizes of the bar, diameters and lengths in mm.

    smallest: diameter within which there is material for certain; NaN unknown. largest: diameter outside which there is
    none for certain; NaN unknown. bore: inside diameter; NaN where a hole of unknown size is drilled. face: Z of the
    face, NaN unknown. source: who says the diameter. lines: first and last line that turn it; (0, 0) otherwise.
    face_lines: the same of the face.
    """

    smallest: float
    largest: float
    bore: float
    face: float
    source: Literal["job", "turning", "comment", "none"]
    lines: tuple[int, int] = (0, 0)
    face_lines: tuple[int, int] = (0, 0)


_NOTHING = Known(np.nan, np.nan, 0.0, np.nan, "none")


class Bar(Columns, frozen=True):
    """The bar of one run, at its first polar section."""

    trace: Trace
    stock_comments: StockComments

    @cached_property
    def known(self) -> Known:
        """The bar as the job gives it and the program turns it; a comment counts where neither does."""
        trace, stock = self.trace, self.trace.job.stock
        if not len(trace.mode.sections):
            return _NOTHING
        scale = float(np.broadcast_to(trace.lengths.job_scale, len(trace))[trace.mode.sections.enter[0]])
        turned = _NOTHING if stock.unknown else self.turned
        face, face_lines = turned.face, turned.face_lines
        if not np.isnan(stock.face):
            face, face_lines = stock.face * scale, (0, 0)
        bore = stock.bore * scale if stock.bore else turned.bore
        if not np.isnan(stock.diameter):
            diameter = stock.diameter * scale
            smallest = np.fmin(diameter, turned.smallest) if turned.source == "turning" else diameter
            source, lines = ("turning", turned.lines) if smallest < diameter else ("job", (0, 0))
            largest = np.fmin(diameter, turned.largest)
            return Known(float(smallest), float(largest), bore, face, source, lines, face_lines)  # type: ignore[arg-type]
        if not np.isnan(stock.hexagon):
            flats = stock.hexagon * scale
            smallest = np.fmin(flats, turned.smallest)
            return Known(float(smallest), flats * _CORNERS, bore, face, "job", (0, 0), face_lines)
        if turned.source == "none" and not stock.unknown:
            turned = self.stated or turned
        return turned._replace(bore=bore, face=face, face_lines=face_lines)

    @property
    def stated(self) -> Known | None:
        """The bar that a comment states for the program of the first section."""
        row = int(self.trace.mode.sections.enter[0])
        diameter = float(self.stock_comments.diameter[row])
        flats = float(self.stock_comments.across_flats[row])
        if np.isnan(diameter) and np.isnan(flats):
            return None
        comment = int(self.stock_comments.comment[row])
        line = int(self.trace.text.blocks.line[self.trace.text.comments.block[comment]])
        smallest, largest = (diameter, diameter) if np.isnan(flats) else (flats, flats * _CORNERS)
        return Known(smallest, float(largest), 0.0, np.nan, "comment", (line, line))

    @cached_property
    def deepest_turned(self) -> float:
        """The lowest Z that a turning tool cuts before the first section [mm]; inf without any."""
        rows = self._turning_rows
        z = np.concatenate([self.trace.path.z[rows], [np.inf]])
        return float(np.nanmin(z))

    # ---- what the program turns ----

    @cached_property
    def tool_call(self) -> Rows:
        """A number per T word: the same tool may turn first and mill then."""
        return np.cumsum(self.trace.blocks.has("T") | self.trace.blocks.starts)

    @cached_property
    def turns(self) -> Mask:
        """Rows before the first section, of tool calls that neither use C nor drill nor enter the mode."""
        trace = self.trace
        rotary = trace.machine.polar.rotary_words
        uses_c = trace.blocks.has(*rotary) & trace.modal.uses_axes & trace.axes.moves
        uses_c |= trace.blocks.has("Y", "V") & trace.axes.moves
        excluded = uses_c | (trace.modal.drilling != 0) | (trace.mode.section >= 0) | trace.mode.on_cylinder
        call = self.tool_call
        has_other = np.zeros(int(call.max(initial=0)) + 1, bool)
        has_other[call[excluded]] = True
        first = int(trace.mode.sections.enter[0])
        result = ~has_other[call] & trace.tools.has_called_tool
        result[first:] = False
        return np.asarray(result & ~trace.modal.on_sub_spindle)

    @cached_property
    def _x_and_z(self) -> tuple[Floats, Floats, Floats, Floats]:
        """
        X before and after each row, Z before and after each row of turning tools.

        A cycle ends where it began (B-63944EN, canned cycles): X and Z are those before it.
        """
        trace, call = self.trace, self.tool_call
        begins = np.diff(call, prepend=-1) != 0
        cycle = trace.modal.in_cycle | trace.blocks.listed("repetitive_cycle")
        places: list[Floats] = []
        for value in (np.where(cycle, np.nan, axis) for axis in (trace.path.x, trace.path.z)):
            after = fill_down(value, ~np.isnan(value) | begins, np.nan)
            places += [before(after, begins, np.nan), after]
        return places[0], places[1], places[2], places[3]

    @cached_property
    def _turning_rows(self) -> Rows:
        """Feed moves of X or Z by turning tools, known at both ends."""
        at_feed = is_among(self.trace.axes.motion, (Motion.LINE, Motion.CW, Motion.CCW))
        return np.flatnonzero(self.turns & at_feed & ~np.isnan(sum(self._x_and_z)))

    @cached_property
    def turned(self) -> Known:
        """The bar that turning tools leave before the first section."""
        if not self.turns.any():
            return _NOTHING
        segments = _Segments.concatenated([self._of_moves, self._of_cycles])
        if not 0 < len(segments.row) <= _MOST:
            return _NOTHING
        lines = self.trace.blocks.line_in_file
        drills = self._drills_center
        is_bore = self._is_boring(segments)
        bored = segments[is_bore & ~segments.faces]
        bore = np.nan if drills else 0.0
        if len(bored.row):
            widest = float(np.maximum(bored.x_from, bored.x_to).max())
            bore = 2 * widest if widest > 0 else np.nan
        faces = segments[segments.faces & ~is_bore]
        face, face_lines = np.nan, (0, 0)
        if len(faces.row):
            face = float(faces.z_to.min())
            rows = faces.row[faces.z_to <= face + ROUNDING]
            face_lines = int(lines[rows.min()]), int(lines[rows.max()])
        outside = segments[~is_bore & ~segments.faces & (segments.z_to < segments.z_from - ROUNDING)]
        outside = outside[(outside.x_from > 0) & (outside.x_to > 0)]
        if not len(outside.row) or self._has_unknown_cycle:
            return Known(np.nan, np.nan, bore, face, "none", (0, 0), face_lines)
        smallest, largest, rows = self._outside(outside, face)
        if np.isnan(smallest):
            return Known(np.nan, np.nan, bore, face, "none", (0, 0), face_lines)
        return Known(
            smallest, largest, bore, face, "turning", (int(lines[rows.min()]), int(lines[rows.max()])), face_lines
        )

    def _outside(self, outside: _Segments, face: float) -> tuple[float, float, Rows]:
        """Smallest and largest diameter that is left from the face down to the deepest polar cut; rows that cut it."""
        trace = self.trace
        cutting = trace.path.moves_at_feed & ~np.isnan(trace.path.z)
        top = min(face, 0.0) if not np.isnan(face) else 0.0
        deepest = min(float(trace.path.z[cutting].min(initial=top)), top - 2 * ROUNDING)
        ends = np.concatenate([outside.z_from, outside.z_to, [deepest, top]])
        heights = different(np.clip(np.concatenate([ends - ROUNDING, ends + ROUNDING]), deepest, top))
        if len(heights) * len(outside.row) > _MOST * _MOST:
            return np.nan, np.nan, outside.row
        smallest, largest = np.inf, 0.0
        used = np.zeros(len(outside.row), bool)
        for z in heights.tolist():
            x = outside.x_at(z)
            if np.isnan(x).all():
                largest = np.nan
                continue
            least = int(np.nanargmin(x))
            used[least] = True
            smallest, largest = min(smallest, float(x[least])), max(largest, float(x[least]))
        if not used.any() or smallest <= _CENTER:
            return np.nan, np.nan, outside.row
        return 2 * smallest, 2 * largest, outside.row[used]

    @property
    def _of_moves(self) -> _Segments:
        rows = self._turning_rows
        x_from, x_to, z_from, z_to = (column[rows] for column in self._x_and_z)
        faces = (np.abs(z_to - z_from) <= ROUNDING) & (np.abs(x_to) <= _CENTER) & (x_from > x_to + _CENTER)
        return _Segments(rows, x_from, x_to, z_from, z_to, faces)

    @property
    def _of_cycles(self) -> _Segments:
        """Each block of a turning or facing cycle: G90 X.. Z.., G94 X.. Z.. in system A (B-63944EN, canned cycles)."""
        trace = self.trace
        turning, facing = trace.blocks.listed("turning_cycle"), trace.blocks.listed("facing_cycle")
        begins = turning | facing
        if not (begins & self.turns).any():
            return self._of_moves[:0]
        ended = (trace.modal.sets("motion") & ~begins) | trace.tools.changes_tool | trace.blocks.starts
        kind = fill_down(np.where(turning, 1, np.where(facing, 2, 0)), begins | ended, 0)
        in_cycle = (kind > 0) & self.turns
        x = fill_down(trace.lengths.length_of("X") * trace.lengths.x_factor, trace.blocks.has("X") | begins, np.nan)
        z = fill_down(trace.lengths.length_of("Z"), trace.blocks.has("Z") | begins, np.nan)
        first = in_cycle & begins
        x_start, z_start = (fill_down(self._x_and_z[coordinate], first | ended, np.nan) for coordinate in (0, 2))
        steps = trace.blocks.has(INCREMENTS["X"], INCREMENTS["Z"], "R")
        rows = np.flatnonzero(in_cycle & trace.blocks.has("X", "Z") & ~np.isnan(x + z + x_start + z_start) & ~steps)
        faces = kind[rows] == 2
        whole = ~faces | (np.abs(x[rows]) <= _CENTER)
        rows, faces = rows[whole], faces[whole]
        x_from = np.where(faces, x_start[rows], x[rows])
        return _Segments(rows, x_from, x[rows], np.where(faces, z[rows], z_start[rows]), z[rows], faces)

    @property
    def _has_unknown_cycle(self) -> bool:
        """A cycle whose cuts are not among the moves: one that roughs and whose contour is not finished by moves."""
        trace = self.trace
        steps = trace.blocks.has(INCREMENTS["X"], INCREMENTS["Z"], "R")
        unknown = trace.blocks.listed("turning_cycle", "facing_cycle") & steps
        return bool((unknown & self.turns).any())

    @property
    def _drills_center(self) -> bool:
        """A tool drills on X0 before the first section, by a cycle or in Z at feed."""
        trace = self.trace
        first = int(trace.mode.sections.enter[0])
        on_center = np.abs(self._x_and_z[0]) <= _CENTER
        down = trace.path.moves_z & (np.abs(trace.path.x) <= _CENTER) & on_center
        down &= trace.path.z < trace.path.z_before - 1
        cycle = (trace.modal.drilling != 0) | trace.blocks.listed("repetitive_cycle")
        return bool((down | (cycle & on_center))[:first].any())

    def _is_boring(self, segments: _Segments) -> Mask:
        """
        Cuts of tool calls that turn inside: after a cut along Z the tool moves towards the center.

        A tool that turns outside moves away from the center there, but for one that comes down to face.
        """
        trace = self.trace
        in_cycle = trace.modal.in_cycle[segments.row]
        along = np.flatnonzero(
            ~in_cycle & (segments.z_to < min(-ROUNDING, float(segments.z_from.max()) - 1)) & ~segments.faces
        )
        along = along[segments.z_to[along] < segments.z_from[along] - ROUNDING]
        call = self.tool_call
        inside = np.zeros(int(call.max()) + 1, bool)
        inside[call[segments.row[in_cycle & (segments.x_to > self._x_and_z[0][segments.row])]]] = True
        x_before, x_after = self._x_and_z[:2]
        moves_x = np.flatnonzero(trace.axes.moves & (np.abs(x_after - x_before) > ROUNDING))
        for index in along.tolist():
            row = int(segments.row[index])
            following = moves_x[np.searchsorted(moves_x, row, side="right") :][:1]
            if len(following) and call[following[0]] == call[row]:
                x = float(x_after[following[0]])
                inside[call[row]] |= _CENTER < x < segments.x_to[index]
        return np.asarray(inside[call[segments.row]])


class _Segments(Table, frozen=True):
    """
    Cuts of turning tools, n of them.

    row: int[n]. x_from, x_to: float64[n], radius [mm]. z_from, z_to: float64[n] [mm]. faces: bool[n], a whole face.
    """

    row: Rows
    x_from: Floats
    x_to: Floats
    z_from: Floats
    z_to: Floats
    faces: Mask

    def x_at(self, z: float) -> Floats:
        """Radius that each cut leaves at a height [mm]; NaN where it does not reach."""
        low, high = np.minimum(self.z_from, self.z_to), np.maximum(self.z_from, self.z_to)
        span = self.z_to - self.z_from
        share = (z - self.z_from) / np.where(span == 0, 1.0, span)
        x = self.x_from + (self.x_to - self.x_from) * np.clip(share, 0, 1)
        return np.where((z >= low - ROUNDING) & (z <= high + ROUNDING), x, np.nan)
