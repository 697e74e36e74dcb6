"""Blocks in the polar mode with computed words, which stay as they are where the other machine counts them alike."""

from __future__ import annotations

import re
from collections.abc import Sequence
from fractions import Fraction

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import stretch
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.measures import Measures, fraction
from polarcheck.rewrite.convert.number_text import number_of
from polarcheck.rewrite.convert.section_words import SectionWords
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rewrite.writing.pen import MOTION_CODES, Pen

_PLAIN_FEED = re.compile(r"F\s*+=?\s*+[\d.]", re.IGNORECASE)


class ComputedBlocks:
    """
    The words of blocks with macro expressions, word by word.

    measures: of both machines. words: of the sections.
    """

    def __init__(self, trace: Trace, target: Machine, measures: Measures, words: SectionWords) -> None:
        self.trace, self.target, self.measures, self.words = trace, target, measures, words
        self.source = trace.machine
        self._has_macros = bool(trace.text.blocks.is_macro.any())

    def is_computed(self, row: int) -> bool:
        """A word of the block that says where the tool goes is computed."""
        if not self.trace.text.blocks.is_macro[self.trace.run.block[row]]:
            return False
        low, high = stretch(self.trace.run.row, row, row + 1)
        geometry, _ = self.words.divided(row, range(low, high), is_switch=False)
        return any(number_of(self.measures.written(index)) is None for index in geometry)

    def has_computed_feed(self, row: int) -> bool:
        """F in force in a row is computed."""
        offset = int(self.trace.feedrate.feed_word[row]) if self._has_macros else -1
        if offset < 0:
            return False
        blocks = self.trace.text.blocks
        block = int(blocks.start.searchsorted(offset, side="right")) - 1
        text = self.trace.text.source.excerpt(offset, int(blocks.end[block]))
        return bool(blocks.is_macro[block]) and not _PLAIN_FEED.match(text)

    def motion(self, row: int) -> str:
        """The code of the motion of a row: G1."""
        code = MOTION_CODES.get(int(self.trace.axes.motion[row]), "")
        if code == "G0" and not self.target.writing.rapid_in_mode:
            raise refused_at(self.trace, row, "rapid traverse in the mode to a computed place is not converted")
        return code

    def written(self, row: int, words: Sequence[int], pen: Pen) -> list[str]:
        """
        The axis words, words of arcs and F of a block, in their order.

        Raises RefusedError for computed words that the other machine counts otherwise.
        """
        if self.trace.modal.incremental[row]:
            raise refused_at(self.trace, row, "distances in a block with computed words are not converted")
        address = self.trace.run.words.address
        return [
            self._word(row, index, pen) for index in words if not self.words.key(index) and address[index] != ord("G")
        ]

    def _word(self, row: int, index: int, pen: Pen) -> str:
        letter = chr(int(self.trace.run.words.address[index]))
        name, ratio = self._counted(row, letter, pen)
        number = self.measures.number(row, index, ratio)
        written = self.measures.written(index)
        if number is None and ratio != 1:
            raise refused_at(
                self.trace, row, f"{written} is computed, and has to be another number there: write numbers"
            )
        if letter == "F" and number is not None:
            number = self.measures.with_feed_point(number)
        return f"{name}{'=' * (len(name) > 1 and not name.endswith('='))}{written[1:] if number is None else number}"

    def _counted(self, row: int, letter: str, pen: Pen) -> tuple[str, Fraction]:
        """The address of a word on the other machine, and what its number is multiplied by."""
        unit = self.measures.unit_ratio(row)
        virtual = self.trace.axes.virtual_axis_of(row)
        if letter == "X":
            return pen.linear, unit * fraction(float(self.trace.lengths.x_factor[row])) * pen.factors[0]
        if letter == virtual:
            of_source = 2 if self.source.polar.virtual_axis_programming == "diameter" else 1
            return pen.virtual, unit * Fraction(pen.factors[1], of_source)
        if letter == "Z":
            return "Z", unit
        if letter == "F":
            return "F", self.measures.unit_ratio(row, of_feed=True)
        centers = self.source.polar.center_words["X"]
        if letter in centers and "center" in self.target.writing.arcs_by:
            return self.target.polar.center_words["X"][centers.index(letter)], unit
        if letter == self.source.arcs.radius_word and "radius" in self.target.writing.arcs_by:
            return self.target.writing.arc_radius, unit
        raise refused_at(self.trace, row, f"{letter} in a block with computed words is not converted")
