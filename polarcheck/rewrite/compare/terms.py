"""What two executed programs are compared by: tolerances, what may differ, and what is left out of the comparison."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

import msgspec
import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, Rows
from polarcheck.rules.repair import FEED

#: Angles of C that differ by no more are the same [deg].
ANGLE = 0.001
#: F that differ by no more than this share are the same: mm and inch are rounded otherwise.
FEED_SHARE = 1e-3
#: Numbers that are computed in the same way differ by no more [mm, deg], F by no more than this share.
EXACT = 1e-6
#: Dwells that differ by no more are the same [s]: a control counts thousandths.
DWELL = 1e-3
#: Speeds are whole numbers: those by G96 are rounded where the units are others.
SPEED = 1.0
#: Times of a section that differ by less than this share, or by less than this [s], are the same.
TIME_SHARE, TIME = 2e-3, 0.02


class Change(NamedTuple):
    """What may differ, of FEED, Z and WAY in rules/repair.py, and the lines of the old program in which it may."""

    names: Collection[str]
    lines: range


class Terms(msgspec.Struct, frozen=True):
    """
    Tolerances of a comparison, and its scope.

    tolerance: of lengths [mm]. angle: of C [deg]. feed: of F, as a share.
    left_out: lines of the old file whose moves and orders outside sections are not compared; the moves after them
    continue from there.
    is_rewritten: the new program is the old one for another control. Then sections are compared by the speed of the
    tool center on the plane, not by the programmed F; C is compared at feed only, and after a section it may differ by
    the rounding of the last point.
    has_other_moves: sections are divided into other moves, or compensated otherwise: their paths and orders are
    compared for the program as a whole, and here only their depths, values of F and the state at their beginning.
    changes: what fixes declare to change; a feed also in the moves for which a word in these lines is in force. The way
    of the move before them may differ, too.
    origin: for each line of the new program the line in the old one, from 1; of the old program nothing.
    """

    tolerance: float
    angle: float = ANGLE
    feed: float = FEED_SHARE
    left_out: Collection[int] = ()
    is_rewritten: bool = False
    has_other_moves: bool = False
    changes: Sequence[Change] = ()
    origin: Sequence[int] = ()

    @property
    def is_kept(self) -> bool:
        """True where a rewriter writes what it does not change: what neither program says is the same in both."""
        return self.is_rewritten or self.has_other_moves or bool(self.changes)

    @property
    def of_old(self) -> Terms:
        """The same for the old program alone."""
        return msgspec.structs.replace(self, origin=())

    @property
    def of_new(self) -> Terms:
        """The same for the new program alone."""
        return msgspec.structs.replace(self, left_out=())

    def may_change(self, trace: Trace, name: str) -> Mask:
        """Return a mask of the rows of a program in which a change of this name is declared."""
        lines = lines_before(trace, self.origin)
        may = np.zeros(len(trace), bool)
        for change in self.changes:
            if name in change.names:
                inside = (lines >= change.lines.start) & (lines < change.lines.stop)
                may |= inside
                if name == FEED:
                    may |= np.isin(trace.feedrate.feed_word, trace.feedrate.feed_word[inside & trace.blocks.has("F")])
                    setting = inside & trace.modal.sets("motion")
                    may |= np.isin(trace.modal.motion_word, trace.modal.motion_word[setting])
        return may


def lines_before(trace: Trace, origin: Sequence[int]) -> Rows:
    """
    Return the line of each row in the old program, 0 where there is none.

    origin: for each line of the program of the trace the line in the old one; its own lines without any.
    """
    lines = trace.blocks.line_in_file
    return np.array([0, *origin])[np.minimum(lines, len(origin))] if len(origin) else lines
