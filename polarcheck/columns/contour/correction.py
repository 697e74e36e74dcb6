"""A correction of one word or block of a contour."""

from __future__ import annotations

from typing import NamedTuple


class Correction(NamedTuple):
    """
    What makes a contour regular, tangent or closed.

    row: of the block. word: the executed word that is wrong, -1 where a word or a block is missing or too many. text:
    as it is to be written. why: the slip. remedy: where the text goes, as in `with X30.`. becomes: what the contour is
    then, as in `it would be closed`. of: what the word does not fit.
    """

    row: int
    word: int
    text: str
    why: str
    remedy: str
    becomes: str
    of: str = "contour"

    def moved(self, rows: int, words: int) -> Correction:
        """The same so many rows and words later."""
        return self._replace(row=self.row + rows, word=self.word + words if self.word >= 0 else -1)
