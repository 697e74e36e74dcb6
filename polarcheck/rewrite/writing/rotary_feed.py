"""What F is in blocks in which linear axes and C move together outside of the polar mode (feed.with_rotary)."""

from __future__ import annotations

import numpy as np

from polarcheck.foundation.arrays import Floats
from polarcheck.geometry.plane import quiet

INVERSE_TIME, OF_C, OF_DIAMETER = "inverse-time", "per-minute-c", "per-minute-diameter"
#: A turn of C of less is none [deg].
_NO_TURN = 1e-9


@quiet
def block_times(
    rule: str, radius_step: Floats, turn: Floats, rise: Floats, feed: Floats, unit: Floats | float = 1.0
) -> Floats:
    """
    Return the time of blocks [min].

    rule: one of feed_keys.WITH_ROTARY.
    radius_step: travel of X as a radius [mm].
    turn: turn of C [deg].
    rise: travel of Z [mm].
    feed: F as written.
    unit: mm per unit of length that F counts.
    """
    if rule == INVERSE_TIME:
        return np.asarray(1 / feed)
    return np.asarray(_counted(rule, radius_step, turn, rise, unit) / feed)


@quiet
def block_feeds(
    rule: str, radius_step: Floats, turn: Floats, rise: Floats, time: Floats, unit: Floats | float = 1.0
) -> Floats:
    """F with which blocks take so long [min]; the inverse of block_times."""
    if rule == INVERSE_TIME:
        return np.asarray(1 / time)
    return np.asarray(_counted(rule, radius_step, turn, rise, unit) / time)


def _counted(rule: str, radius_step: Floats, turn: Floats, rise: Floats, unit: Floats | float) -> Floats:
    """
    Return the length that F per minute counts.

    FANUC has lengths and degrees as one vector: G91 G1 X20. B40. F300. takes sqrt(20^2 + 40^2) / 300 min (operator's
    manuals, G01, from knowledge).
    """
    length = np.hypot(radius_step * (2.0 if rule == OF_DIAMETER else 1.0), rise) / unit
    if rule == OF_C:
        return np.where(np.abs(turn) > _NO_TURN, np.abs(turn), length)
    return np.asarray(np.hypot(length, turn))
