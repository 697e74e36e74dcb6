"""Loops that a table skips, each with the reason: what they make cannot be computed, or not in bounded time."""

from __future__ import annotations

from enum import IntEnum
from typing import Self

import numpy as np

from polarcheck.foundation.arrays import Mask, Rows, States, Table


class SkipReason(IntEnum):
    """Why a loop is skipped."""

    #: It reaches farther out than any lathe, or has an arc round a point far beyond.
    TOO_FAR = 1
    #: Its arcs are so large that they have too many chords.
    TOO_MANY_CHORDS = 2
    #: It crosses itself, or the loops that it is compared with, so often that no part can be derived from it.
    CROSSES = 3
    #: It lies beside paths that are too long to search for what remains between them.
    PATHS_TOO_LONG = 4


class SkippedLoops(Table, frozen=True):
    """
    Loops of a trace that are skipped, n of them.

    loop: int[n], as loop_of_row numbers them. reason: int16[n], a SkipReason.
    """

    loop: Rows
    reason: States

    @classmethod
    def of(cls, loops: dict[SkipReason, Rows]) -> Self:
        """Loops by the reason to skip them."""
        count = [len(numbers) for numbers in loops.values()]
        number = np.concatenate([np.zeros(0, np.int64), *loops.values()])
        return cls(number, np.repeat(np.array(list(loops), np.int16), count))

    def rows(self, loop: Rows, *reasons: SkipReason) -> Mask:
        """
        Rows whose loop is skipped for one of these reasons.

        loop: int[rows], the loop of each row.
        """
        if not len(self):
            return np.zeros(len(loop), bool)
        return np.isin(loop, self.loop[np.isin(self.reason, reasons)])
