"""Contours that are nearly regular or symmetric, and what makes them so: a word, a block, the reading of X."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from polarcheck.arrays import Columns, Mask
from polarcheck.columns.trace import Trace
from polarcheck.geometry.regularity.symmetry import Symmetry
from polarcheck.table.plane_loops import PlaneLoop, loops_of
from polarcheck.time_limit import keep_time

if TYPE_CHECKING:
    from polarcheck.table.correction_search import Correction


class Regularity(Columns, frozen=True):
    """Columns of one trace, one value per row."""

    trace: Trace

    @cached_property
    def _loops(self) -> list[tuple[PlaneLoop, Symmetry | None]]:
        """The loops that may be regular, with their symmetry as they are written."""
        return [(loop, loop.symmetry()) for loop in loops_of(self.trace)]

    # ---- one word or block ----

    @cached_property
    def corrections(self) -> dict[int, Correction]:
        """By row what makes a contour regular."""
        found: dict[int, Correction] = {}
        for loop, written in self._loops:
            if written is not None and written.is_turned:
                continue
            keep_time()
            from polarcheck.table.correction_search import correction_of

            correction = correction_of(self.trace, loop, written)
            if correction is not None:
                found.setdefault(correction.row, correction)
        return found

    @cached_property
    def is_wrong(self) -> Mask:
        """Rows with a word that makes a contour irregular, or before which a block is missing."""
        return self.trace.blocks.mask_of(np.array(sorted(self.corrections), np.int64))

    @cached_property
    def wrong_words(self) -> Mask:
        """Per executed word: it makes a contour irregular."""
        words = [correction.word for correction in self.corrections.values() if correction.word >= 0]
        return self.trace.blocks.words_at(np.array(sorted(words), np.int64))
