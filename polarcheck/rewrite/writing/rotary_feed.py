"""What F is in blocks in which linear axes and C move together outside of the polar mode (feed.with_rotary)."""

from __future__ import annotations

import numpy as np

from polarcheck.checking.settings import Settings
from polarcheck.foundation.arrays import Floats
from polarcheck.geometry.plane import quiet
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.writing.outcome import Refusal, RefusedError

INVERSE_TIME, OF_C, OF_DIAMETER = "inverse-time", "per-minute-c", "per-minute-diameter"
#: A turn of C of less is none [deg].
_NO_TURN = 1e-9


def per_minute(machine: Machine) -> list[str]:
    """Return the meanings of F per minute on a machine, the usual one first; empty where none is known."""
    return [rule for rule in machine.feed.with_rotary if rule != INVERSE_TIME]


def feed_not_known(machine: Machine, what: str, line: int = 0) -> RefusedError:
    """Return the error to raise where a profile does not say what F is. line: that needs it, 0 for all."""
    how = "feed.with_rotary of a machine file says it, or --feed for once"
    return RefusedError([Refusal(line, f"{what} is not known of {machine.title}: {how}")])


def notes_on_feed(settings: Settings, rule: str, feed: str, how: str) -> list[str]:
    """
    Return a note where the meaning of F that was taken does not come from the profile, or is in doubt there.

    rule: one of feed_keys.WITH_ROTARY. feed: as --feed has it. how: what helps against the doubt.
    """
    title = settings.machine.title
    if rule not in settings.machine.feed.with_rotary:
        return [f"F is {feed} as --feed says; the profile of {title} does not say so"]
    return [f"that F is {rule} on {title} is in doubt: {how}"] * ("feed.with_rotary" in settings.doubtful)


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
