"""R, I and J in blocks that are no arc: words that nothing uses, since G2 or G3 was forgotten."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.contour.passes import Passes
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, cached_property
from polarcheck.foundation.states import Motion
from polarcheck.geometry.plane import angle_between
from polarcheck.program.machines.code_tables import code_set

#: Lists of G codes that may stand in a block of a contour and give R, I and J no meaning of their own.
_PLAIN = (
    "line",
    "compensation_left",
    "compensation_right",
    "feed_per_minute",
    "feed_per_revolution",
    "absolute",
    "incremental",
)
#: Further slack for the direction of a tangent [rad].
_SLACK = 5e-3


class ArcWords(Columns, frozen=True):
    """Columns of one trace."""

    trace: Trace
    passes: Passes

    @cached_property
    def at(self) -> Mask:
        """Per executed word: R, I or J other than 0 in a straight move on the plane, which the control does not use."""
        trace = self.trace
        of_arcs = trace.blocks.no_words.copy()
        of_arcs[trace.blocks.word_indices(trace.machine.arcs.radius_word)] = True
        for axis in ("X", *trace.axes.other_linear_axes):
            words = trace.blocks.word_indices(*trace.axes.center_words_along(axis))
            of_arcs[words[trace.axes.linear_axis[trace.run.row[words]] == ord(axis)]] = True
        of_arcs &= trace.run.words.value != 0
        if not of_arcs.any():
            return of_arcs
        of_arcs &= self._is_plain_line[trace.run.row]
        corner_words = trace.machine.arcs.corner_words
        if corner_words and of_arcs.any():
            may_be_corner = trace.blocks.words_at(trace.blocks.word_indices(*corner_words))
            of_arcs &= ~may_be_corner | self._is_no_corner[trace.run.row]
        return np.asarray(of_arcs)

    @cached_property
    def _is_plain_line(self) -> Mask:
        """Rows of straight moves on the plane in the mode, with no code beside them that uses such words."""
        trace = self.trace
        plain = code_set([code for key in _PLAIN for code in trace.machine.codes(key)])
        words = trace.blocks.g_words[~plain[trace.blocks.g_codes]]
        is_line = trace.path.on_plane & (trace.axes.motion == Motion.LINE) & trace.mode.in_polar
        return np.asarray(is_line & ~trace.blocks.with_words(words))

    @cached_property
    def rows(self) -> Mask:
        """Rows with such a word."""
        return self.trace.blocks.with_words(self.at)

    @cached_property
    def _is_no_corner(self) -> Mask:
        """
        Lines with R that is no corner at their end, where the control would read one: as an arc they are tangent to
        the moves on both sides, or the corner is too short for it.
        """
        trace, passes = self.trace, self.passes
        previous, following = passes.beside
        move = np.flatnonzero(~passes.is_arc & (following >= 0))
        radius = np.abs(trace.lengths.length_of(trace.machine.arcs.radius_word))[passes.row[move]]
        begins, ends = passes.tangents
        chord = passes.end[move] - passes.start[move]
        length = np.abs(passes.end - passes.start)
        turn = np.abs(angle_between(chord, begins[following[move]]))
        too_short = radius * np.tan(np.minimum(turn, 3.0) / 2) > np.minimum(length[move], length[following[move]])
        into = np.where(previous[move] < 0, np.nan, np.abs(angle_between(ends[previous[move]], chord)))
        fits = (np.abs(into - turn) < _SLACK) & (np.abs(2 * radius * np.sin(into) - length[move]) < _SLACK * radius)
        return trace.blocks.mask_of(passes.row[move[too_short | fits]])

    def sense(self, row: int) -> Motion | None:
        """The arc that the moves beside a row speak for; None where they do not."""
        passes: Passes = self.passes
        index = np.flatnonzero(passes.row == row)
        if not len(index):
            return None
        turns = [float(turn[index[0]]) for turn in passes.turns]
        turns_known: list[float] = [turn for turn in turns if not np.isnan(turn) and abs(turn) > _SLACK]
        if not turns_known or min(turns_known) * max(turns_known) < 0:
            return None
        return Motion.CCW if turns_known[0] > 0 else Motion.CW
