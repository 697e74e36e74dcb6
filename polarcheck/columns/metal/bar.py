"""
The bar before milling: its outside diameter over Z, its face and its bore, and where they are known from.

The job says it, what the program turns before a row takes off, or a comment. Lengths in mm, diameters as such; radii
where the name says so.
"""

from __future__ import annotations

from typing import Literal

import msgspec
import numpy as np

from polarcheck.columns.filling import before, last_row
from polarcheck.columns.metal.turned_cuts import TurnedCuts
from polarcheck.columns.metal.turned_profile import Bounds, Profile
from polarcheck.columns.metal.turning_tools import CENTER, Cuts, TurningTools
from polarcheck.columns.trace import Trace
from polarcheck.columns.words.stock_comments import StockComments
from polarcheck.foundation.arrays import Columns, Floats, Mask, Rows, cached_property, different
from polarcheck.geometry.tolerances import ROUNDING

#: Across corners of a hexagon, by its width across flats.
_CORNERS = 2 / np.sqrt(3)
#: More turning cuts than this are not followed.
_MOST = 4000


class Known(msgspec.Struct, frozen=True):
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


class Standing(msgspec.Struct, frozen=True):
    """
    What stands of the bar for certain.

    diameter: [mm]. height: Z of the lowest place where it does [mm]. source, lines: as in Known.
    """

    diameter: float
    height: float
    source: Literal["job", "turning", "comment"]
    lines: tuple[int, int]


class Turned(msgspec.Struct, frozen=True):
    """
    What is left of the bar before a row.

    profile: None where what was turned is not followed. bore: diameter [mm]; NaN where a hole of unknown size is
    drilled. face: Z, NaN unknown; face_rows: the cuts that leave it.
    """

    profile: Profile | None
    bore: float
    face: float
    face_rows: Rows


class Bar(Columns, frozen=True):
    """The bar of one run."""

    trace: Trace
    stock_comments: StockComments

    @cached_property
    def known(self) -> Known:
        """The bar at the first polar section, from its face down to the deepest polar cut."""
        trace = self.trace
        if not len(trace.mode.sections):
            return _NOTHING
        turned = self._before(int(trace.mode.sections.enter[0]))
        lines = trace.blocks.line_in_file

        def span(rows: Rows) -> tuple[int, int]:
            return (int(lines[rows.min()]), int(lines[rows.max()])) if len(rows) else (0, 0)

        unknown = Known(np.nan, np.nan, turned.bore, turned.face, "none", (0, 0), span(turned.face_rows))
        if turned.profile is None:
            largest = 2 * self._of_job.outer
            return unknown if np.isnan(largest) else msgspec.structs.replace(unknown, largest=largest, source="job")
        top = min(turned.face, 0.0) if not np.isnan(turned.face) else 0.0
        deepest = min(self._deepest_cut, top - 2 * ROUNDING)
        smallest, largest, rows = turned.profile.between(deepest, top)
        of_job = not np.isnan(self._of_job.outer)
        if not (len(rows) or of_job) or smallest <= (0 if of_job else CENTER):
            stated = None if len(rows) or self.trace.job.stock.unknown else self.stated
            return (
                msgspec.structs.replace(stated, bore=turned.bore, face=turned.face, face_lines=unknown.face_lines)
                if stated
                else unknown
            )
        is_turned = (len(rows) > 0 and smallest < self._of_job.inner) or not of_job
        return msgspec.structs.replace(
            unknown,
            smallest=2 * smallest,
            largest=2 * largest if np.isfinite(largest) else np.nan,
            source="turning" if is_turned else "job",
            lines=span(rows) if is_turned else (0, 0),
        )

    @cached_property
    def _deepest_cut(self) -> float:
        path = self.trace.path
        return float(path.z[path.moves_at_feed & ~np.isnan(path.z)].min(initial=0.0))

    @cached_property
    def _of_job(self) -> Bounds:
        """The bar that the job gives, as radii [mm]; NaN for none."""
        stock, scale = self.trace.job.stock, self._scale
        if not np.isnan(stock.hexagon):
            flats = stock.hexagon * scale / 2
            return Bounds(flats, float(flats * _CORNERS))
        return Bounds(stock.diameter * scale / 2, stock.diameter * scale / 2)

    @property
    def _scale(self) -> float:
        """mm per unit of length of the job."""
        trace = self.trace
        return float(np.broadcast_to(trace.lengths.job_scale, len(trace))[trace.mode.sections.enter[0]])

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

    @property
    def face_as_written(self) -> float:
        """Z of the face, as a program writes it [mm]; NaN where it is not known."""
        return self.known.face * self.trace.path.z_sense

    @cached_property
    def deepest_turned(self) -> float:
        """The lowest Z that a turning tool cuts before the first section [mm]; inf without any."""
        if not len(self.trace.mode.sections):
            return np.inf
        enter = self.trace.mode.sections.enter[0]
        rows, cuts = self.tools.moving_rows, self.turned_cuts.cuts
        of_moves = self.trace.path.z[rows[rows < enter]]
        of_cycles = cuts.low[(cuts.row < enter) & cuts.is_surface & np.isfinite(cuts.low)]
        return float(np.nanmin(np.concatenate([of_moves, of_cycles, [np.inf]])))

    # ---- what is turned before a row ----

    @cached_property
    def tools(self) -> TurningTools:
        """The tools that turn."""
        return TurningTools(self.trace)

    @cached_property
    def turned_cuts(self) -> TurnedCuts:
        """The cuts of turning tools."""
        return TurnedCuts(self.trace, self.tools)

    @cached_property
    def _cuts(self) -> Cuts:
        return Cuts.none() if self.trace.job.stock.unknown else self.turned_cuts.cuts

    @cached_property
    def _epoch(self) -> Rows:
        """
        Per row a number that is the same where the bar is: it counts the cuts and drillings before the row.

        A program that begins behind the end of another has a bar of its own.
        """
        events = np.zeros(len(self.trace) + 1, np.int64)
        np.add.at(events, self._cuts.row + 1, 1)
        events[self._begins_anew] += 1
        if not self.trace.job.stock.unknown:
            events[self.turned_cuts.unknown_rows + 1] += 1
            events[min(self.tools.first_drilled + 1, len(self.trace))] += 1
        return np.cumsum(events[:-1])

    @cached_property
    def _begins_anew(self) -> Mask:
        """Rows at which a program begins behind the end of another."""
        blocks = self.trace.blocks
        return np.append(blocks.starts & before(blocks.ends_program, np.zeros(len(self.trace), bool), False), False)

    @cached_property
    def _states(self) -> dict[int, Turned]:
        return {}

    def _before(self, row: int) -> Turned:
        """What is left of the bar before a row."""
        epoch = int(self._epoch[row])
        if epoch not in self._states:
            self._states[epoch] = self._turned_before(row)
        return self._states[epoch]

    def _turned_before(self, row: int) -> Turned:
        trace, stock = self.trace, self.trace.job.stock
        start = max(int(last_row(self._begins_anew[:-1], np.zeros(len(trace), bool))[row]), 0)
        cuts = self._cuts[(self._cuts.row >= start) & (self._cuts.row < row)]
        follows = not stock.unknown
        faces = cuts[cuts.is_face & ~cuts.is_bore]
        face, face_rows = np.nan, faces.row[:0]
        if len(faces):
            face = float(faces.low.min())
            face_rows = faces.row[faces.low <= face + ROUNDING]
        face_of_job = stock.face * self._scale * trace.path.z_sense
        if not np.isnan(face_of_job) and not face_of_job >= face:
            face, face_rows = face_of_job, faces.row[:0]
        bored = cuts[cuts.is_bore]
        bore = np.nan if follows and start <= self.tools.first_drilled < row else 0.0
        if len(bored):
            widest = float(np.fmax(bored.x_low, bored.x_high).max())
            bore = 2 * widest if widest > 0 else np.nan
        bore = float(np.fmax(stock.bore * self._scale, bore)) if stock.bore else bore
        unknown = self.turned_cuts.unknown_rows if follows else faces.row[:0]
        lost = bool(((unknown >= start) & (unknown < row)).any()) or len(cuts) > _MOST or self._is_parted(faces, start)
        top = 0.0 if np.isnan(face) else face
        profile = None if lost else Profile(cuts[~cuts.is_bore], self._of_job, top)
        return Turned(profile, bore, face, face_rows)

    def _is_parted(self, faces: Cuts, start: int) -> bool:
        """A tool has faced to the center below what was milled before: the part is off, the bar another piece."""
        trace = self.trace
        milled = np.flatnonzero(trace.mode.in_polar & trace.path.cuts & (np.arange(len(trace)) >= start))
        lowest = np.append(-np.inf, np.minimum.accumulate(np.fmin(trace.path.z[milled], np.inf)))
        return bool((faces.low < lowest[np.searchsorted(milled, faces.row)] - ROUNDING).any())

    def _reach(self, rows: Rows, tip: Floats) -> tuple[Floats, Floats]:
        inner, outer = np.full(len(rows), np.nan), np.full(len(rows), np.nan)
        source = self.known.source
        if source == "comment":
            inner[:], outer[:] = self.known.smallest / 2, self.known.largest / 2
        if source in ("comment", "none"):
            return inner, outer
        epochs = self._epoch[rows]
        for epoch in different(epochs).tolist():
            chosen = np.flatnonzero(epochs == epoch)
            profile = self._before(int(rows[chosen[0]])).profile
            if profile is not None:
                inner[chosen], outer[chosen] = profile.reach(tip[chosen])
        return inner, outer

    def inner(self, rows: Rows, tip: Floats) -> Floats:
        """
        The radius within which there is metal for certain between the tip of a tool and the face, before a row [mm].

        tip: float64[n], Z [mm]. NaN where nothing is known of the bar.
        """
        return self._reach(rows, tip)[0]

    def outer(self, rows: Rows, tip: Floats) -> Floats:
        """
        The radius outside of which there is no metal for certain [mm]; NaN where that is not known.

        Above Z0 with an unknown face it is that of all depths: the face may lie higher.
        """
        outer = self._reach(rows, tip)[1]
        if np.isnan(self.known.face):
            outer = np.where(tip >= 0, self.known.largest / 2, outer)
        return np.where(np.isinf(outer), np.nan, outer)

    def bore(self, rows: Rows) -> Floats:
        """The diameter of the bore before each row [mm]; NaN where a hole of unknown size is drilled."""
        epochs = self._epoch[rows]
        bore = np.full(len(rows), np.nan)
        for epoch in different(epochs).tolist():
            chosen = np.flatnonzero(epochs == epoch)
            bore[chosen] = self._before(int(rows[chosen[0]])).bore
        return bore

    def standing(self, row: int, tip: float) -> list[Standing]:
        """What stands of the bar between a tip and the face, before a row: the largest last; empty if not known."""
        known, turned = self.known, self._before(row)
        if known.source == "comment":
            return [Standing(known.smallest, tip, "comment", known.lines)]
        if turned.profile is None or known.source == "none":
            return []
        lines, standing = self.trace.blocks.line_in_file, []
        for radius, height, cut in turned.profile.steps(tip):
            line = int(lines[cut])
            if cut >= 0:
                standing.append(Standing(2 * radius, height, "turning", (line, line)))
            elif np.isnan(self._of_job.inner):
                standing.append(Standing(2 * radius, height, "turning", known.lines))
            else:
                standing.append(Standing(2 * radius, height, "job", (0, 0)))
        return standing
