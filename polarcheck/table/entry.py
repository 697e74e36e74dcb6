"""The state of the lathe where the polar mode is entered: spindle, live tool, C axis, offsets, positions, stock."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask
from polarcheck.geometry.corner import ROUNDING
from polarcheck.machines.codes import code_set
from polarcheck.machines.modal import COORDINATE_SETTING, Side
from polarcheck.table.filling import before, fill_down
from polarcheck.table.trace import Trace

_FIRST_WORK_OFFSET = 54


class Entry:
    """Columns of one trace, one value per row."""

    def __init__(self, trace: Trace) -> None:
        self.trace = trace

    # ---- what is known of the program ----

    def _in_program(self, mask: Mask) -> Mask:
        """Whether any row of the program is in the mask."""
        found = np.zeros(int(np.count_nonzero(self.trace.starts)), bool)
        found[self.trace.program[mask]] = True
        return found[self.trace.program]

    def _happened(self, mask: Mask, since: Mask | None = None) -> Mask:
        """Whether a row at or above is in the mask or of unknown effect, from the program head or the last `since`."""
        trace = self.trace
        happened = mask | trace.run.unknown
        written = happened | trace.starts if since is None else happened | trace.starts | since
        return fill_down(happened, written, False).astype(bool)

    def _is_lacking(self, *codes: str) -> Mask:
        """
        Rows of programs that should have had one of these codes before, had it been needed: of whole programs, and of
        excerpts with any of them. Not after a row of unknown effect.
        """
        trace = self.trace
        expected = self.trace.whole_program | self._in_program(trace.codes(*codes))
        return np.asarray(expected & ~self._happened(np.zeros(len(trace), bool)))

    # ---- the C axis ----

    @cached_property
    def c_axis_missing(self) -> Mask:
        """The profile names codes that engage the C axis, and none is in force at G12.1."""
        trace, codes = self.trace, self.trace.machine.m_codes
        if not codes.c_axis_on:
            return np.zeros(len(trace), bool)
        lacking = self._is_lacking(*codes.c_axis_on, *codes.c_axis_off)
        return np.asarray(trace.enters & ~trace.c_axis & lacking)

    @cached_property
    def _engages(self) -> Mask:
        trace = self.trace
        return np.asarray(trace.c_axis & ~before(trace.c_axis, trace.starts, False).astype(bool))

    @cached_property
    def c_axis_not_referenced(self) -> Mask:
        """The C axis is engaged at G12.1 and has not gone to its reference point since."""
        trace = self.trace
        referenced = trace.codes("G28", "G30") & trace.has("C", "H")
        return np.asarray(trace.enters & trace.c_axis & ~self._happened(referenced, self._engages))

    @cached_property
    def c_angle_unknown(self) -> Mask:
        """C has not been positioned before G12.1 in a whole program, or not since it was engaged."""
        trace = self.trace
        positioned = trace.has("C", "H") & (trace.section < 0)
        return np.asarray(trace.enters & self.trace.whole_program & ~self._happened(positioned, self._engages))

    # ---- X ----

    @cached_property
    def x_unknown(self) -> Mask:
        """X has not been positioned before G12.1 in a whole program, or not since a reference return or tool change."""
        trace = self.trace
        sets_x = trace.uses_axes | trace.codes(COORDINATE_SETTING[trace.machine.control.g_code_system])
        lost = trace.changes_tool | (trace.codes("G28", "G30") & trace.has("X", "U"))
        return np.asarray(trace.enters & self.trace.whole_program & ~self._happened(trace.has("X", "U") & sets_x, lost))

    @cached_property
    def x_not_positive(self) -> Mask:
        """X is 0 or below at G12.1."""
        return np.asarray(self.trace.enters & (self.trace.x < ROUNDING))

    # ---- spindle and live tool ----

    @property
    def has_live_tool_codes(self) -> bool:
        """The profile names codes of the live tool, so that M3 and M4 are those of the main spindle."""
        return bool(self.trace.machine.m_codes.live_tool_on)

    @cached_property
    def live_tool_stopped(self) -> Mask:
        """The first cutting move of a section while the live tool is not running."""
        trace, codes = self.trace, self.trace.machine.m_codes
        if not codes.live_tool_on:
            return np.zeros(len(trace), bool)
        lacking = self._is_lacking(*codes.live_tool_on, *codes.live_tool_off)
        return trace.first_in_section(trace.cuts & ~trace.live_tool & lacking)

    @cached_property
    def _of_spindle(self) -> Mask:
        """Over code numbers: of the main spindle or its C axis, and not of the live tool."""
        codes = self.trace.machine.m_codes
        of_live_tool = code_set([*codes.live_tool_on, *codes.live_tool_off])
        return code_set([*codes.spindle_on, *codes.spindle_off, *codes.c_axis_on, *codes.c_axis_off]) & ~of_live_tool

    @cached_property
    def spindle_words(self) -> Mask:
        """Per executed word: a code of the main spindle or of its C axis."""
        return self.trace.words_at(self.trace.m_words[self._of_spindle[self.trace.m_codes]])

    @cached_property
    def spindle_code(self) -> Mask:
        """A code of the main spindle or of its C axis in the mode."""
        found = np.zeros(len(self.trace), bool)
        found[self.trace.run.row[self.spindle_words]] = True
        return found & self.trace.in_polar

    @cached_property
    def c_axis_code(self) -> Mask:
        """A code that engages or releases the C axis, and does nothing to the live tool."""
        codes = self.trace.machine.m_codes
        return self.trace.codes(*codes.c_axis_on, *codes.c_axis_off) & self.spindle_code

    # ---- tool offset, origin ----

    @cached_property
    def offset_missing(self) -> Mask:
        """
        No tool offset is in force at G12.1, in a whole program or after a T word.

        Where compensation begins without one in the section, that says it better.
        """
        trace = self.trace
        called = fill_down(trace.has("T"), trace.has("T") | trace.starts, False).astype(bool)
        missing = trace.enters & (trace.offset_number == 0) & (called | self._is_lacking())
        compensated = trace.section[trace.in_polar & (trace.side != Side.OFF) & (trace.offset_number == 0)]
        return np.asarray(missing & ~np.isin(trace.section, compensated))

    @cached_property
    def _work_offset(self) -> tuple[Floats, NDArray[np.object_]]:
        """Where X0 of the work offset in force lies [mm; 0 where the job does not say], and its name."""
        trace = self.trace
        state = np.where(trace.state("work_offset") == 0, _FIRST_WORK_OFFSET, trace.state("work_offset"))
        is_extended = fill_down(trace.codes("G54.1"), trace.sets("work_offset") | trace.starts, False).astype(bool)
        number = fill_down(trace.word("P"), trace.codes("G54.1"), 0.0)
        shift, name = np.zeros(len(trace)), np.full(len(trace), "", object)
        for offset, origin in trace.job.work_offsets.items():
            written, _, extension = offset.upper().partition(" P")
            named = (
                ~is_extended & (state == _number(written))
                if not extension
                else is_extended & (number == _number(extension))
            )
            shift[named], name[named] = origin.x, offset.upper()
        return shift * trace.job_scale, name

    @property
    def work_offset_shift(self) -> Floats:
        """Where X0 of the work offset in force lies [mm]; 0 where the job does not say."""
        return self._work_offset[0]

    @property
    def work_offset_name(self) -> NDArray[np.object_]:
        """The name of the work offset in force, as the job has it; empty where it has none."""
        return self._work_offset[1]

    @cached_property
    def local_shift(self) -> Floats:
        """X of the G52 in force [mm]."""
        trace = self.trace
        written = trace.codes("G52") & trace.has("X")
        shift = np.where(written, np.nan_to_num(trace.length_of("X")), 0.0)
        return fill_down(shift, written | trace.starts, 0.0).astype(np.float64)

    @cached_property
    def origin_shift(self) -> Floats:
        """How far X0 is known to lie off the spindle axis, as the job or G52 writes it [mm]."""
        return self._work_offset[0] + self.local_shift

    @cached_property
    def origin_off_center(self) -> Mask:
        """X0 lies off the spindle axis at G12.1."""
        if not self.trace.job.work_offsets and not self.trace.codes("G52").any():
            return np.zeros(len(self.trace), bool)
        return np.asarray(self.trace.enters & (np.abs(self.origin_shift) > ROUNDING))

    # ---- stock and tool ----

    @property
    def stock_diameter(self) -> Floats:
        """Of the stock [mm]; NaN where the job gives none."""
        return np.broadcast_to(self.trace.job.stock.diameter * self.trace.job_scale, len(self.trace))

    @property
    def clearance(self) -> Floats:
        """What the job wants between the stock and the tool at the approach, on the diameter [mm]."""
        return np.broadcast_to(self.trace.job.stock.clearance * self.trace.job_scale, len(self.trace))

    @cached_property
    def approaches_stock(self) -> Mask:
        """A G12.1 from which the tool goes to the rim of the stock; a section within, as a pocket, is plunged into."""
        trace = self.trace
        if np.isnan(trace.job.stock.diameter):
            return np.zeros(len(trace), bool)
        farthest = np.full(len(trace.sections) + 1, -np.inf)
        np.fmax.at(farthest, trace.section, np.fmax(np.abs(trace.start), np.abs(trace.end)))
        reach = 2 * farthest[trace.section] + np.nan_to_num(trace.cutter_diameter)
        return np.asarray(trace.enters & (reach > self.stock_diameter + ROUNDING))

    @cached_property
    def x_needed(self) -> Floats:
        """X of the tool center that clears the stock, as a radius [mm]: half of stock, cutter and clearance."""
        return (self.stock_diameter + self.trace.cutter_diameter + self.clearance) / 2

    @cached_property
    def inside_stock(self) -> Mask:
        """The approach stands where the cutter reaches into the stock."""
        return np.asarray(self.approaches_stock & (self.trace.x < self.x_needed - self.clearance / 2 - ROUNDING))

    @cached_property
    def inside_clearance(self) -> Mask:
        """The approach stands nearer to the stock than the clearance."""
        return np.asarray(self.approaches_stock & (self.trace.x < self.x_needed - ROUNDING) & ~self.inside_stock)

    @cached_property
    def flat_from_the_side(self) -> Mask:
        """The tool at G12.1 is a flat end mill that points at the outer diameter."""
        trace = self.trace
        wrong = [n for n, tool in trace.job.tools.items() if tool.mount == "radial" and tool.shape == "flat"]
        return np.asarray(trace.enters & np.isin(trace.offset_number, wrong))


def _number(text: str) -> float:
    digits = text.lstrip("GP ")
    return float(digits) if digits.replace(".", "", 1).isdecimal() else float("nan")
