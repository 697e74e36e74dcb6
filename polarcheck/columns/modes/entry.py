"""The state of the lathe where the polar mode is entered: plane, offsets, positions, stock."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.columns.filling import before, happened, last_row
from polarcheck.columns.modes.origin import Origin
from polarcheck.columns.path.tool_center import ToolCenter
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Floats, Mask, cached_property, column_at, is_among, side_by_side
from polarcheck.foundation.states import STATES, Motion

#: Words and modal groups of G codes that may stand beside a D for the cutter.
_WORDS_BESIDE_D = ("T", "S", "M", "G", "F", "X", "U", "Z", "W")
_BESIDE_D = ("motion", "side", "units", "plane", "feed_mode", "speed")


class Entry(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace
    tool_center: ToolCenter

    # ---- what is known of the program ----

    def happened(self, mask: Mask, since: Mask | None = None) -> Mask:
        """True from a row of the mask or of unknown effect to the next program head or row of `since`."""
        trace = self.trace
        return happened(mask | trace.run.unknown, trace.blocks.starts if since is None else trace.blocks.starts | since)

    @cached_property
    def loses_x(self) -> Mask:
        """Rows after which the position of X is not known: a tool change, a reference return of X."""
        trace = self.trace
        return np.asarray(
            trace.tools.changes_tool | (trace.blocks.listed("reference_return") & trace.blocks.has("X", "U"))
        )

    @cached_property
    def positions_in_mode(self) -> Mask:
        """
        Per G12.1: nothing depends on where the tool stands there, as the first move positions both axes of the plane.

        That is so where C does not turn the plane, and G0 can stand in it: a G0 without compensation, both absolute.
        """
        trace = self.trace
        polar = trace.machine.polar
        if not polar.plane_is_fixed or "G0" not in polar.allowed_codes:
            return np.zeros(len(trace), bool)
        first = trace.mode.first_in_section(trace.axes.moves_plane & trace.mode.in_polar)
        both = trace.path.is_absolute_on_plane & (trace.axes.motion == Motion.RAPID) & ~trace.compensation.compensates
        return trace.blocks.mask_of(trace.mode.sections.enter[trace.mode.section[first & both]])

    @cached_property
    def _is_known(self) -> Mask:
        """No row of unknown effect stands at or above in the program."""
        return ~self.happened(np.zeros(len(self.trace), bool))

    def expects(self, codes: Sequence[str]) -> Mask:
        """
        Rows of programs that would have one of these codes above, were it needed: of whole programs, and of excerpts
        with any of them. Not below a row of unknown effect, and nowhere if the profile names no code.

        Where programs have no head, one that calls a tool and comes to its end is whole.
        """
        if not codes:
            return np.zeros(len(self.trace), bool)
        blocks = self.trace.blocks
        is_whole = blocks.whole_program | blocks.anywhere_in_program(blocks.codes(*codes))
        if not self.trace.machine.writing.program_head:
            is_whole |= blocks.anywhere_in_program(blocks.ends_program) & self.trace.tools.has_called_tool
        return is_whole & self._is_known

    @cached_property
    def expects_offset(self) -> Mask:
        """A T word stands above, or would: in a whole program."""
        trace = self.trace
        return trace.tools.has_called_tool | (trace.blocks.whole_program & self._is_known)

    @cached_property
    def calls_d_before_mode(self) -> Mask:
        """
        A D word outside the mode that can only be meant for the cutter; the program enters the mode with its tool.

        It stands alone, or beside T, S, M codes of the lathe, positions, and G codes of modal states; not beside
        cycles, calls and codes of the builder, which have a D of their own. Above the first T it may be meant for that.
        """
        trace = self.trace
        if not trace.tools.means_cutter_by_d.any():
            return np.zeros(len(trace), bool)
        machine, m_codes = trace.machine, trace.machine.m_codes
        codes = [code for group in _BESIDE_D for key in STATES[group] for code in machine.codes(key)]
        codes += [code for name in m_codes.__struct_fields__ for code in getattr(m_codes, name)]
        plain = trace.blocks.words_at(trace.blocks.code_indices(*codes))
        has_other_code = trace.blocks.with_words(is_among(trace.run.words.address, list(b"GM")) & ~plain)
        calls = (
            trace.tools.means_cutter_by_d
            & trace.blocks.consists_of("D", *_WORDS_BESIDE_D, *machine.polar.rotary_words)
            & ~has_other_code
            & ~trace.modal.in_cycle
        )
        ahead = self._is_before_mode
        above_tool = np.append((trace.tools.changes_tool & ahead)[1:], False) & (trace.tools.tool == 0)
        return np.asarray(calls & (ahead | above_tool))

    @property
    def _is_before_mode(self) -> Mask:
        """Outside the mode, and its program enters the mode before the tool changes."""
        trace = self.trace
        ahead = np.flatnonzero(trace.mode.enters | trace.tools.changes_tool | trace.blocks.ends_program)
        if not len(ahead):
            return np.zeros(len(trace), bool)
        following = np.searchsorted(ahead, np.arange(len(trace)), side="right")
        event = ahead[np.minimum(following, len(ahead) - 1)]
        same = (following < len(ahead)) & (trace.blocks.program[event] == trace.blocks.program)
        return np.asarray(same & trace.mode.enters[event] & (trace.mode.section < 0))

    @cached_property
    def after_section(self) -> Mask:
        """A G13.1 has ended a section of the tool in force."""
        trace = self.trace
        return happened(trace.mode.leaves, trace.tools.changes_tool | trace.blocks.starts)

    # ---- the plane ----

    @cached_property
    def plane_is_right(self) -> Mask:
        """
        Per G12.1: a plane that the profile wants is in force, or is selected in the section before it moves or with its
        first move; also where the program has selected none, and the profile wants none. A row of unknown effect before
        the first move may select it.
        """
        trace, needed = self.trace, self.trace.machine.polar.plane_before
        right = (trace.modal.state("plane") == 0) | trace.modal.has_state("plane", needed) | (not needed)
        selects = trace.mode.first_in_section((trace.blocks.codes(*needed) | trace.run.unknown) & trace.mode.in_polar)
        if selects.any():
            moves = np.flatnonzero(trace.mode.first_in_section(trace.path.moves & trace.mode.in_polar))
            first = column_at(len(trace.mode.sections), trace.mode.section[moves], moves, len(trace))
            rows = np.flatnonzero(selects)
            right[trace.mode.sections.enter[trace.mode.section[rows[rows <= first[trace.mode.section[rows]]]]]] = True
        return np.asarray(right)

    # ---- tool offset, origin ----

    @cached_property
    def origin(self) -> Origin:
        """Where X0 lies."""
        return Origin(self.trace)

    @property
    def origin_shift(self) -> Floats:
        """
        How far the place where the program has the center of C is known to lie off the spindle axis, as written [mm].

        That is X0, or X beside G12.1, which may name the center where nothing else says where X0 lies. NaN where the
        program sets what is not known.
        """
        shift, named = self.origin.shift, self.trace.path.center_shift.real / self.trace.lengths.x_factor
        return np.where((named != 0) & (shift == 0), 0.0, shift + named)

    @property
    def origin_distance(self) -> Floats:
        """The same as a distance, where X is written as a diameter half of it [mm]."""
        factor = self.trace.lengths.x_factor
        above = before(factor, self.trace.blocks.starts, np.nan)
        return self.origin_shift * np.where(np.isnan(above), factor, above)

    # ---- stock and tool ----

    @cached_property
    def first_in_mode(self) -> dict[int, int]:
        """The first row of the mode in which each offset is in force; of a turning tool comments tell the nose."""
        trace = self.trace
        rows = np.flatnonzero(trace.mode.in_polar | trace.mode.enters)
        numbers, first = np.unique(trace.tools.offset_number[rows], return_index=True)
        return dict(side_by_side(numbers, rows[first]))

    @cached_property
    def radius_in_mode(self) -> Floats:
        """
        R of an offset in the mode, given by the job or set by the program [mm], at the first word that calls it.

        Else NaN, and where R is that of a comment.
        """
        trace = self.trace
        radius = np.full(len(trace), np.nan)
        if not (trace.tools.of_job or trace.offsets.sets_offsets) or not len(trace.mode.sections):
            return radius
        called = np.flatnonzero(trace.tools.calls_offset)
        for number, first in zip(*np.unique(trace.tools.offset_number[called], return_index=True), strict=True):
            row = self.first_in_mode.get(int(number))
            if row is not None and not trace.offsets.radius_is_from_comment[row]:
                radius[called[first]] = trace.offsets.radius_of_offset[row]
        return radius

    @cached_property
    def radius_told(self) -> Floats:
        """R that a comment states for an offset with an R of the job or program [mm], at the same word; else NaN."""
        stated = np.full(len(self.trace), np.nan)
        for row in np.flatnonzero(~np.isnan(self.radius_in_mode)).tolist():
            comment = self.trace.offsets.radii_in_comments.get(int(self.trace.tools.offset_number[row]))
            stated[row] = comment.radius if comment else np.nan
        return stated

    @property
    def radius_off_comment(self) -> Floats:
        """
        Difference of R from the R in a comment on the same offset [mm]; NaN without such a comment.

        What R leaves for another tool does not count.
        """
        left = np.zeros(len(self.trace))
        for row in np.flatnonzero(~np.isnan(self.radius_told)).tolist():
            left[row] = self.trace.offsets.metal_left[self.first_in_mode[int(self.trace.tools.offset_number[row])]]
        return np.abs(np.abs(self.radius_in_mode) - left - self.radius_told)

    @property
    def takes_offset_of_other(self) -> Mask:
        """T calls the tool of a section with the offset of another tool."""
        trace, tools = self.trace, self.trace.tools
        calls = last_row(tools.calls_tool, trace.blocks.starts)[trace.mode.sections.enter]
        return tools.takes_offset_of_other & trace.blocks.mask_of(calls[calls >= 0])

    @cached_property
    def is_flat_and_radial(self) -> Mask:
        """The job says of the tool in force that it is a flat end mill that points at the outer diameter."""
        wrong = [n for n, tool in self.trace.tools.of_job.items() if tool.mount == "radial" and tool.shape == "flat"]
        return is_among(self.trace.tools.offset_number, wrong)
