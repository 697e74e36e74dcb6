"""What two executed programs are compared by: tolerances, and what is left out of the comparison."""

from __future__ import annotations

from collections.abc import Collection

import msgspec

#: Angles of C that differ by no more are the same [deg].
ANGLE = 0.001
#: F that differ by no more than this share are the same: mm and inch are rounded otherwise.
FEED = 1e-3


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
    """

    tolerance: float
    angle: float = ANGLE
    feed: float = FEED
    left_out: Collection[int] = ()
    is_rewritten: bool = False
    has_other_moves: bool = False

    @property
    def is_kept(self) -> bool:
        """True where a rewriter writes what it does not change: what neither program says is the same in both."""
        return self.is_rewritten or self.has_other_moves
