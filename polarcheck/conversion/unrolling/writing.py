"""The text of sections without the mode: what stays of each block, and the blocks of X and C in its place."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from polarcheck.arrays import Floats, stretch
from polarcheck.checking.editing import is_plain, words_of, written_word
from polarcheck.columns.trace import Trace
from polarcheck.conversion.outcome import Refusal, RefusedError
from polarcheck.conversion.unrolling.steps import Steps, x_factor
from polarcheck.conversion.unrolling.stretches import Stretch
from polarcheck.machines.codes import NO_CODE, code_set
from polarcheck.machines.modal import Distance, FeedMode, Motion

#: Lists of G codes that mean nothing without the mode, or that this writes itself.
_DROPPED = (
    "rapid", "line", "arc_clockwise", "arc_counterclockwise", "plane_xy", "plane_zx", "plane_yz", "compensation_off",
    "compensation_left", "compensation_right", "corner_by_arc", "corner_by_intersection", "feed_inverse_time",
    "feed_per_minute", "feed_per_revolution", "feed_on_plane", "feed_in_space", "feed_as_machine", "feed_at_center",
    "feed_at_contour", "feed_at_inner_contour", "absolute", "incremental", "frame_shift", "frame_shift_added",
    "frame_rotation", "frame_rotation_added",
)  # fmt: skip
#: Lists of G codes whose blocks stay as they are, with all of their words.
_UNTOUCHED = ("dwell",)
_FEED_CODES = {
    FeedMode.INVERSE_TIME: "feed_inverse_time",
    FeedMode.PER_MINUTE: "feed_per_minute",
    FeedMode.PER_REVOLUTION: "feed_per_revolution",
}


class Writer:
    """
    Writes the blocks of one section in the order in which they run; it knows what its blocks have put in force.

    steps, feeds: of the whole program. feed_mode: what F is beside X and C.
    """

    def __init__(self, trace: Trace, steps: Steps, feeds: Floats, feed_mode: FeedMode) -> None:
        self.trace, self.steps, self.feeds, self.feed_mode = trace, steps, feeds, feed_mode
        self._factor = x_factor(trace)
        machine = trace.machine
        polar = machine.polar
        dropped = [code for key in _DROPPED for code in machine.codes(key)]
        self._dropped = code_set([*dropped, *polar.on, *polar.off])
        self._codes = np.full(len(trace.run.words), NO_CODE, np.int32)
        self._codes[trace.blocks.g_words] = trace.blocks.g_codes
        centers = [word for pair in polar.center_words.values() for word in pair]
        self._axes = {*polar.axis_addresses, "X", "U", "Z", "W", *centers, machine.arcs.radius_word, "F"}
        self._axes |= {word for word in (machine.arcs.larger_arc_word, machine.offsets.allowance_word) if word}
        self._numbers = {machine.address_number(address) for address in self._axes if address}
        self._switches = trace.mode.enters | trace.mode.leaves
        macro = machine.macro
        calls = [*macro.subprogram_calls, *macro.macro_calls, *macro.program_returns]
        self._of_call = trace.blocks.words_at(trace.blocks.code_indices(*calls))
        self._mode = self._distance = 0
        self._motion = ""
        self._feed = ""
        self._has_feed = False

    def of_section(self, each: Stretch) -> list[tuple[int, list[str] | None]]:
        """
        Return for each row of the section what stands in its place, block by block; None where it stays as it is.

        Its comments are not among it.
        """
        trace, enter = self.trace, each.enter
        self._mode = int(trace.feedrate.modal_feed_mode[enter])
        self._distance = int(trace.modal.state("distance")[enter])
        self._motion = self._feed = ""
        self._has_feed = False
        return [(row, self._row(row, each)) for row in range(enter, each.leave + 1)]

    def _row(self, row: int, each: Stretch) -> list[str] | None:
        trace = self.trace
        if row == each.leave:
            return self._leaving(row)
        low, high = stretch(self.steps.row, row, row + 1)
        moves_z = bool(trace.path.moves_z[row]) and low == high
        if low == high and not moves_z and not self._has_dropped(row) and not self._calls(row):
            return None
        own = self._stays(row)
        if low == high and not moves_z:
            return [self._joined(own)] if own else []
        blocks = []
        if moves_z:
            blocks.append(self._alone(row, own))
        for index in range(low, high):
            blocks.append(self._step(index, own if index == low else ()))
        return blocks

    def _calls(self, row: int) -> bool:
        """Another program runs behind this row, or the one that called goes on."""
        depth = self.trace.run.depth
        return row + 1 < len(depth) and bool(depth[row + 1] != depth[row])

    def _has_dropped(self, row: int) -> bool:
        if self.trace.blocks.listed(*_UNTOUCHED)[row]:
            return False
        run = self.trace.run
        low, high = stretch(run.row, row, row + 1)
        return any(self._is_dropped(index) for index in range(low, high))

    def _is_dropped(self, index: int) -> bool:
        words = self.trace.run.words
        address = int(words.address[index])
        if address == ord("G"):
            return bool(self._dropped[self._codes[index]])
        return address in self._numbers

    def _stays(self, row: int) -> list[str]:
        """The words that stay of a block, as they are written."""
        run = self.trace.run
        if self.trace.blocks.listed(*_UNTOUCHED)[row]:
            return [written_word(run, index) for index in words_of(run, row)]
        plain = is_plain(run, row)
        beside_offset = self.trace.blocks.listed("compensation_left", "compensation_right")[row]
        # What stands beside the switch, or hands over to a program, has no meaning without it.
        machine_words_alone = self._switches[row] or self._calls(row)
        texts = []
        for index in words_of(run, row):
            letter = chr(int(run.words.address[index]))
            if self._is_dropped(index) or letter in "N/" or (letter == "D" and beside_offset):
                continue
            if machine_words_alone and (letter not in "GMST" or self._of_call[index]):
                continue
            texts.append(written_word(run, index) if plain else self._generated(row, index))
        return texts

    def _generated(self, row: int, index: int) -> str:
        """A word whose text is not that of the word: a value that was computed."""
        words = self.trace.run.words
        address, value = int(words.address[index]), float(words.value[index])
        if chr(address) not in "GMST" or not math.isfinite(value):
            line = int(self.trace.blocks.line_in_file[row])
            raise RefusedError(
                [Refusal(line, "a word of this block cannot be written without the statement around it")]
            )
        return f"{chr(address)}{value:.15g}"

    # ---- blocks ----

    def _joined(self, words: Sequence[str]) -> str:
        return " ".join(word for word in words if word)

    def _step(self, index: int, own: Sequence[str]) -> str:
        steps = self.steps
        is_rapid = bool(steps.is_rapid[index])
        words = [*self._state(None if is_rapid else self.feed_mode), self._motion_word(is_rapid)]
        first = not index or steps.row[index - 1] != steps.row[index]
        if first or steps.radius_step[index] != 0:
            words.append(self._length("X", int(steps.x[index]), int(steps.row[index])))
        if first or steps.turn[index] != 0:
            words.append(self._angle(int(steps.c[index])))
        z = float(steps.z[index])
        if not math.isnan(z):
            words.append(self._length("Z", int(z), int(steps.row[index])))
        if not is_rapid:
            words.append(self._feed_word(float(self.feeds[index]), every=self.feed_mode == FeedMode.INVERSE_TIME))
        return self._joined([*words, *own])

    def _alone(self, row: int, own: Sequence[str]) -> str:
        """Z alone, as in the mode."""
        trace = self.trace
        is_rapid = trace.axes.motion[row] == Motion.RAPID
        words = [*self._state(None if is_rapid else FeedMode.PER_MINUTE), self._motion_word(bool(is_rapid))]
        if np.isnan(trace.path.z[row]):
            line = int(trace.blocks.line_in_file[row])
            raise RefusedError(
                [Refusal(line, "Z is not known here: it is programmed in increments from an unknown place")]
            )
        words.append(self._length("Z", round(float(trace.path.z[row] / trace.lengths.least_step[row])), row))
        if not is_rapid:
            words.append(self._feed_word(float(trace.feedrate.feed[row] / trace.lengths.feed_scale[row])))
        return self._joined([*words, *own])

    def _leaving(self, row: int) -> list[str]:
        """What the block that switches the mode off leaves in force: F and its mode, and coordinates or distances."""
        trace = self.trace
        words = self._state(FeedMode(int(trace.feedrate.modal_feed_mode[row])), int(trace.modal.state("distance")[row]))
        feed = float(trace.feedrate.feed_number[row] / trace.lengths.feed_scale[row])
        if self._has_feed and not math.isnan(feed):
            words.append(self._feed_word(feed))
        words = [*words, *self._stays(row)]
        return [self._joined(words)] if any(words) else []

    def _state(self, mode: FeedMode | None, distance: int = Distance.ABSOLUTE) -> list[str]:
        words = []
        if distance != self._distance:
            key = "absolute" if distance == Distance.ABSOLUTE else "incremental"
            words += self._first_code(key)
            self._distance = distance
        if mode is not None and mode != self._mode:
            words += self._first_code(_FEED_CODES[mode])
            self._mode, self._feed = int(mode), ""
        return words

    def _first_code(self, key: str) -> list[str]:
        codes = self.trace.machine.codes(key)
        if not codes:
            raise RefusedError([Refusal(0, f"{self.trace.machine.title} has no code for that: {key}")])
        return codes[:1]

    def _motion_word(self, is_rapid: bool) -> str:
        word = "G0" if is_rapid else "G1"
        if word == self._motion:
            return ""
        self._motion = word
        return word

    # ---- numbers ----

    def _length(self, address: str, count: int, row: int) -> str:
        return address + number(count, float(self.trace.lengths.least_increment[row]))

    def _angle(self, count: int) -> str:
        machine = self.trace.machine
        least = machine.control.least_increment
        if machine.control.rotary_rolls_over:
            count %= round(360 / least)
        address = machine.polar.rotary_address
        return address + "=" * (len(address) > 1) + number(count, least)

    def _feed_word(self, feed: float, every: bool = False) -> str:
        text = f"F{feed:.4f}".rstrip("0")
        if text == self._feed and not every:
            return ""
        self._feed, self._has_feed = text, True
        return text


def number(count: int, least: float) -> str:
    """So many least increments as a number with a point."""
    decimals = max(0, math.ceil(-math.log10(least) - 1e-9))
    text = f"{count * least:.{decimals}f}"
    return (text.rstrip("0") if "." in text else text + ".").replace("-0.", "-.", 1) if float(text) else "0."
