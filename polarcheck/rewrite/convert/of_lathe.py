"""Words whose numbers belong to the lathe and not to the part: a person decides what they are on another lathe."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from polarcheck.columns.filling import before
from polarcheck.columns.trace import Trace
from polarcheck.foundation.states import FeedMode
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.measures import AxisWord, Measures
from polarcheck.rewrite.convert.number_text import number_of


class OfLathe:
    """The blocks of a program with positions, offsets and limits of its lathe, for another lathe."""

    def __init__(self, trace: Trace, target: Machine, measures: Measures) -> None:
        self.trace, self.target, self.measures = trace, target, measures
        blocks = trace.blocks
        has_axes = blocks.has(*trace.machine.axis_words)
        returns = trace.machine.codes("reference_return")
        self._returns = blocks.codes(*returns[:1])
        of_c_alone = blocks.listed("c_axis_reference") & ~blocks.has(*"XYZUVW")
        self._sets_origin, title = blocks.listed("coordinate_setting"), target.title
        at_machine, sets_values = blocks.listed("machine_coordinates"), blocks.listed("data_input")
        own_point = blocks.codes(*returns[1:]) & ~of_c_alone
        #: Why the whole block of a row is to be decided, by the rows.
        self.reasons = [
            (at_machine & has_axes, f"a position in the coordinates of the machine: choose that of {title}"),
            (own_point, f"a reference point that its builder or user has set: choose that of {title}"),
            (sets_values, f"it sets values that the control keeps, such as offsets: give those of {title}"),
            (self._sets_origin & has_axes, f"it sets the origin by where the tool stands: set that of {title}"),
        ]

    def remarks(self, row: int, axes: Sequence[AxisWord]) -> list[str]:
        """Return what is to be decided of a row whose words stay. axes: its axis words."""
        title = self.target.title
        result = []
        if self._returns[row] and any(not self._is_zero_step(word) for word in axes):
            words = " ".join(self.measures.written(word.index) for word in axes)
            result.append(f"{words}: see that the tool goes free from there to the reference point of {title}")
        if self._sets_origin[row] and self.trace.blocks.has("S")[row]:
            result.append(f"S{self.trace.blocks.word('S')[row]:g}: give the limit of the spindle speed of {title}")
        result += [f"{code}: set this work offset on {title}" for code in self._first_offsets.get(row, ())]
        if row in self._rotary_feeds:
            result.append(
                f"{self._rotary_feeds[row]}: where C moves, F counts otherwise on {title}, or nothing says how"
            )
        if row in self._changes:
            result.append(f"the tool changes at {self._changes[row]}: choose where the turret of {title} turns free")
        return result

    def _is_zero_step(self, word: AxisWord) -> bool:
        number = number_of(self.measures.written(word.index))
        return word.is_step and number is not None and not float(number)

    @cached_property
    def _first_offsets(self) -> dict[int, list[str]]:
        """The first row with each work offset -> the codes of the offsets."""
        trace, seen = self.trace, set[str]()
        result: dict[int, list[str]] = {}
        lists = ("work_offset", "work_offset_extended")
        codes = [code for key in lists for code in trace.machine.codes(key) if code in self.target.codes(key)]
        for index in trace.blocks.code_indices(*codes).tolist():
            row, written = int(trace.run.row[index]), self.measures.written(index).upper()
            number = float(trace.blocks.word("P")[row])
            written += f" P{number:g}" if number == number else ""
            if written not in seen:
                seen.add(written)
                result.setdefault(row, []).append(written)
        return result

    @cached_property
    def _rotary_feeds(self) -> dict[int, str]:
        """The first row outside of sections with each F by which C moves, where it may count otherwise -> its F."""
        trace, ours, theirs = self.trace, self.trace.machine.feed.with_rotary, self.target.feed.with_rotary
        if ours and ours == theirs:
            return {}
        letters = "".join(trace.machine.polar.rotary_words)
        at_feed = trace.axes.at_feed & trace.axes.moves
        other = (trace.modal.state("feed_mode") == FeedMode.INVERSE_TIME) | trace.modal.in_cycle
        moves_c = trace.blocks.has(*letters) & (trace.mode.whole_section < 0) & at_feed & ~other
        rows = np.flatnonzero(moves_c & (trace.path.c_angle != before(trace.path.c_angle, trace.blocks.starts, np.nan)))
        first: dict[str, int] = {}
        for row in rows.tolist():
            number = float(trace.feedrate.feed_number[row] / trace.lengths.feed_scale[row])
            first.setdefault("F" if number != number else f"F{number:g}", row)
        return {row: text for text, row in first.items()}

    @cached_property
    def _changes(self) -> dict[int, str]:
        """The first row in which a tool changes at each known position of the work -> the position, in its words."""
        trace, starts = self.trace, self.trace.blocks.starts
        tool = trace.tools.tool
        changes = trace.blocks.has("T") & (tool != before(tool, starts, 0)) & (tool != 0) & ~starts
        result: dict[int, str] = {}
        for row in np.flatnonzero(changes & (trace.mode.whole_section < 0)).tolist():
            # Behind the change nobody knows where the new tool is.
            x, z = (self.measures.place(row - 1, axis) for axis in "XZ")
            text = f"X{x} Z{z}"
            if x is not None and z is not None and text not in result.values():
                result[row] = text
        return result
