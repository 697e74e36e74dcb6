"""The blocks of sections without the mode: what stays of each block, and blocks of X and C in its place."""

from __future__ import annotations

import math
import re
from collections.abc import Sequence

import numpy as np

from polarcheck.columns.filling import before, happened
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Floats, Mask, cached_property, stretch
from polarcheck.foundation.states import FEED_MODES, Distance, FeedMode, Motion, Units
from polarcheck.rewrite.unroll.axis_blocks import Steps
from polarcheck.rewrite.unroll.remaining_words import RemainingWords
from polarcheck.rewrite.unroll.unrollable import Stretch
from polarcheck.rewrite.writing.new_blocks import NewBlock, comments_of, next_move_in_motion
from polarcheck.rewrite.writing.outcome import refused_at
from polarcheck.rewrite.writing.pen import MOTION_CODES
from polarcheck.rewrite.writing.style import Style
from polarcheck.rewrite.writing.written_numbers import Numbers
from polarcheck.rules.editing import written_word

#: X1= in the place of X.
_NAMED = re.compile(r"[A-Z]+[0-9]*=", re.IGNORECASE)


class Writer:
    """
    Writes the blocks of one section in the order in which they run; it knows what its blocks have put in force.

    steps, feeds: of the whole program. feed_mode: what F is beside X and C. style: how the program is written.
    """

    def __init__(self, trace: Trace, steps: Steps, feeds: Floats, feed_mode: FeedMode, style: Style) -> None:
        self.trace, self.steps, self.feeds, self.feed_mode, self.style = trace, steps, feeds, feed_mode, style
        self._remaining = RemainingWords(trace)
        self._by_units = {
            units: Numbers(trace.machine, style, units == Units.INCH)
            for units in np.unique(trace.lengths.units[trace.mode.section >= 0]).tolist()
        }

    def of_section(self, section: Stretch) -> list[tuple[int, list[NewBlock] | None]]:
        """
        Return for each row of the section what stands in its place, block by block; None where it stays as it is.

        Comments are among it only where blocks do not run in order.
        """
        trace, enter = self.trace, section.enter
        self._mode = int(trace.feedrate.modal_feed_mode[enter]) if self.says_feed_mode[enter] else 0
        self._distance = int(trace.modal.state("distance")[enter])
        self._motion = self._feed = ""
        self._has_feed = self._has_moved = False
        self._names = self._names_of_axes(section)
        rows = range(enter, section.leave + 1)
        if section.runs_in_order:
            return [(row, self._row(row, section)) for row in rows]
        return self._written_out(rows, section)

    @cached_property
    def says_feed_mode(self) -> Mask:
        """Whether a code above a row, in the same program, says what F is."""
        starts = self.trace.blocks.starts
        return before(happened(self.trace.modal.sets("feed_mode"), starts), starts, False)

    def _written_out(self, rows: Sequence[int], section: Stretch) -> list[tuple[int, list[NewBlock] | None]]:
        """The rows of a section that does not run from top to bottom; comments stand where they run first."""
        written: list[tuple[int, list[NewBlock] | None]] = []
        seen: set[int] = set()
        for row in rows:
            block = int(self.trace.run.block[row])
            blocks = self._row(row, section)
            if blocks is None:
                words = self._remaining.of_row(row)
                blocks = [NewBlock(tuple(words))] if words else []
            comment = "" if block in seen else " ".join(comments_of(self.trace.text, block))
            if comment:
                first = blocks[0].words if blocks else ()
                blocks = [NewBlock(first, comment), *blocks[1:]]
            seen.add(block)
            written.append((row, blocks))
        return written

    def _row(self, row: int, section: Stretch) -> list[NewBlock] | None:
        trace = self.trace
        if row == section.leave:
            return self._leaving(row)
        low, high = stretch(self.steps.row, row, row + 1)
        moves_z = bool(trace.path.moves_z[row]) and low == high
        if low == high and not moves_z and not self._remaining.is_changed(row):
            return None
        remaining = self._remaining.of_row(row)
        if low == high and not moves_z:
            return [NewBlock(tuple(remaining))] if remaining else []
        if moves_z:
            return [self._alone(row, remaining)]
        return [self._step(index, remaining if index == low else ()) for index in range(low, high)]

    # ---- blocks ----

    def _step(self, index: int, remaining: Sequence[str]) -> NewBlock:
        steps, style = self.steps, self.style
        row = int(steps.row[index])
        numbers = self._numbers(row)
        words = [*self._state(row, self.feed_mode), self._motion_word(row, "G1")]
        is_first = not self._has_moved
        self._has_moved = True
        if is_first or style.repeats_axes or steps.radius_step[index] != 0:
            words.append(self._word("X", numbers.of_increments(int(steps.x[index]))))
        if is_first or style.repeats_axes or steps.turn[index] != 0:
            words.append(self._angle(numbers, int(steps.c[index])))
        z = float(steps.z[index])
        if not math.isnan(z):
            words.append(self._word("Z", numbers.of_increments(int(z))))
        is_repeated = style.repeats_feed or self.feed_mode == FeedMode.INVERSE_TIME
        words.append(self._feed_word(numbers, float(self.feeds[index]), is_repeated))
        return self._block(words, remaining)

    def _alone(self, row: int, remaining: Sequence[str]) -> NewBlock:
        """Z alone, as in the mode."""
        trace, numbers = self.trace, self._numbers(row)
        is_rapid = bool(trace.axes.motion[row] == Motion.RAPID)
        words = [
            *self._state(row, None if is_rapid else FeedMode.PER_MINUTE),
            self._motion_word(row, "G0" if is_rapid else "G1"),
        ]
        if np.isnan(trace.path.z[row]):
            raise refused_at(
                self.trace, row, "Z is not known here: it is programmed in increments from an unknown place"
            )
        words.append(self._word("Z", numbers.length(float(trace.path.z[row]))))
        if not is_rapid:
            feed = float(trace.feedrate.feed[row] / trace.lengths.feed_scale[row])
            words.append(self._feed_word(numbers, feed, self.style.repeats_feed))
        return self._block(words, remaining)

    def _leaving(self, row: int) -> list[NewBlock]:
        """What the block that switches the mode off leaves in force: F and its mode, and coordinates or distances."""
        trace = self.trace
        mode = FeedMode(int(trace.feedrate.modal_feed_mode[row]))
        words = self._state(row, mode, int(trace.modal.state("distance")[row]))
        feed = float(trace.feedrate.feed_number[row] / trace.lengths.feed_scale[row])
        if self._has_feed and not math.isnan(feed):
            words.append(self._feed_word(self._numbers(row), feed))
        motion = int(trace.modal.state("motion")[row])
        if motion in (Motion.RAPID, Motion.LINE) and next_move_in_motion(trace, row) is not None:
            words.append(self._motion_word(row, MOTION_CODES[motion]))
        words = [word for word in (*words, *self._remaining.of_row(row)) if word]
        return [self._block(words)] if words else []

    def _block(self, words: Sequence[str], remaining: Sequence[str] = ()) -> NewBlock:
        return NewBlock((*filter(None, words), *remaining))

    # ---- words ----

    def _state(self, row: int, mode: FeedMode | None, distance: int = Distance.ABSOLUTE) -> list[str]:
        words = []
        if distance != self._distance:
            words.append(self._numbers(row).code_for("absolute" if distance == Distance.ABSOLUTE else "incremental"))
            self._distance = distance
        if mode is not None and mode != self._mode:
            words.append(self._numbers(row).code_for(FEED_MODES[mode]))
            self._mode, self._feed = int(mode), ""
        return words

    def _motion_word(self, row: int, code: str) -> str:
        # Not by control.motion_codes: G101 of Okuma is a straight line on the plane, also without the mode.
        word = self._numbers(row).code(code)
        if word == self._motion and not self.style.repeats_motion:
            return ""
        self._motion = word
        return word

    def _angle(self, numbers: Numbers, count: int) -> str:
        machine = self.trace.machine
        least = machine.control.least_increment
        if machine.control.rotary_rolls_over:
            count %= round(360 / least)
        return self._word(machine.polar.rotary_address, numbers.angle(count * least))

    def _word(self, address: str, number: str) -> str:
        name = self._names.get(address[0], address + "=" * (len(address) > 1))
        return name + number

    def _feed_word(self, numbers: Numbers, feed: float, is_repeated: bool = False) -> str:
        text = "F" + numbers.rate(feed)
        if text == self._feed and not is_repeated:
            return ""
        self._feed, self._has_feed = text, True
        return text

    # ---- of the trace ----

    def _numbers(self, row: int) -> Numbers:
        numbers = self._by_units[int(self.trace.lengths.units[row])]
        numbers.line = self.trace.line(row)
        return numbers

    def _names_of_axes(self, section: Stretch) -> dict[str, str]:
        """Names of axes that the section writes with a number, as X1= for X."""
        run, names = self.trace.run, dict[str, str]()
        low, high = stretch(run.row, section.enter, section.leave + 1)
        axes = np.isin(run.words.address[low:high], np.frombuffer(b"XYZC", np.uint8))
        for index in (low + np.flatnonzero(axes)).tolist():
            if name := _NAMED.match(written_word(run, index)):
                names.setdefault(chr(int(run.words.address[index])), name[0])
        return names
