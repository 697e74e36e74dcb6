"""The columns that a row has by itself or from the rows above it: words, codes, modal states, units, feed."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from polarcheck.arrays import Floats, Mask, Rows, States, is_among
from polarcheck.execution.programs import find_programs
from polarcheck.execution.run import Run
from polarcheck.machines.axes import FIRST_NAMED, NO_AXIS, NOT_NAMED
from polarcheck.machines.codes import code, code_numbers, code_set, modal_tables, renumbered
from polarcheck.machines.job import Job
from polarcheck.machines.machine import Machine
from polarcheck.machines.modal import MM_PER_INCH, NO_FEED, NO_MOVE, STATES, Distance, FeedMode, Motion, Side, Units
from polarcheck.table.filling import fill_down, happened

Column = TypeVar("Column")

_BEFORE = {"motion": Motion.NONE, "side": Side.OFF, "feed_mode": FeedMode.PER_MINUTE, "distance": Distance.ABSOLUTE}


class Columns:
    """Words and states of the rows of one file on one machine for one job."""

    def __init__(self, run: Run, machine: Machine, job: Job) -> None:
        self.run = run
        self.text = run.text
        self.machine = machine
        self.job = job
        self._columns: dict[str, Any] = {}

    def __len__(self) -> int:
        return len(self.run)

    # ---- words ----

    @cached_property
    def _by_address(self) -> tuple[Rows, Rows]:
        """Word indices grouped by address in order of the rows, and where each address begins."""
        address = self.run.words.address
        return np.argsort(address, kind="stable"), np.cumsum(np.bincount(address, minlength=256))

    def word_indices(self, *addresses: str) -> Rows:
        """The words of an address, in order, then those of the next; `,R` is an address of its own."""
        found = [self._words_of(address) for address in addresses]
        return found[0] if len(found) == 1 else np.concatenate((np.zeros(0, np.int64), *found))

    def _words_of(self, address: str) -> Rows:
        order, ends = self._by_address
        if not address:  # of a machine that has none for it
            return order[:0]
        number = self.machine.address_number(address)
        found = order[ends[number - 1] : ends[number]]
        # H beside G43 is the number of an offset, and no increment of C.
        return found[~self.switches_length_offset[self.run.row[found]]] if address == "H" and len(found) else found

    @cached_property
    def words_not_named(self) -> Rows:
        """The words of axes that control.named_axes does not have, in order."""
        return np.flatnonzero(self.run.words.address == NOT_NAMED)

    @cached_property
    def words_of_no_axis(self) -> Rows:
        """The words with = whose names no axis has, as in R1=5, in order."""
        return np.flatnonzero(self.run.words.address == NO_AXIS)

    @cached_property
    def moves_unnamed(self) -> Mask:
        """Has a word of an axis that control.named_axes does not have: it may be any axis of the lathe."""
        return self.with_words(self.words_not_named)

    @cached_property
    def words_not_followed(self) -> Rows:
        """The words of axes that are not followed, by control.named_axes or since it does not have them, in order."""
        address = self.run.words.address
        found = np.flatnonzero((address >= FIRST_NAMED) & (address != NO_AXIS))
        own = [*map(self.machine.address_number, self.machine.polar.axis_addresses)]
        return found[~np.isin(address[found], own)] if len(found) else found

    def words_at(self, indices: Rows) -> Mask:
        """Per executed word: whether it is one of these."""
        found = np.zeros(len(self.run.words), bool)
        found[indices] = True
        return found

    def with_words(self, words: Rows | Mask) -> Mask:
        """Per row: whether it has one of these executed words, given by indices or as a mask."""
        found = np.zeros(len(self), bool)
        found[self.run.row[words]] = True
        return found

    def word(self, address: str) -> Floats:
        """The written value per row, the last where it is repeated; NaN where it is not written."""
        return self._column(f"word {address}", lambda: self._scatter(address, self.run.words.value))

    def distance(self, address: str) -> States | None:
        """Per row what the word of an address says of itself (modal.Distance), 0 where nothing; None in most files."""
        own = self.run.distance
        if own is None:
            return None
        return self._column(f"distance {address}", lambda: self._distance(address, own))

    def _distance(self, address: str, own: NDArray[np.int16]) -> States:
        column = np.zeros(len(self), np.int16)
        at = self.word_indices(address)
        column[self.run.row[at]] = own[at]
        return column

    def has(self, *addresses: str) -> Mask:
        """Whether a row has a word of any of the addresses."""
        return self.with_words(self.word_indices(*addresses))

    def consists_of(self, *addresses: str) -> Mask:
        """Whether a row has words of these addresses and no others; N and block skip may stand beside them."""
        beside = np.zeros(256, bool)
        named = [self.machine.address_number(address) for address in (*addresses, "N", "/") if address]
        beside[named] = True
        return self.has(*addresses) & ~self.with_words(~beside[self.run.words.address])

    def _scatter(self, address: str, values: Floats) -> Floats:
        column = np.full(len(self), np.nan)
        at = self.word_indices(address)
        column[self.run.row[at]] = values[at]
        return column

    def _column(self, name: str, make: Callable[[], Column]) -> Column:
        if name not in self._columns:
            self._columns[name] = make()
        column: Column = self._columns[name]
        return column

    def assigns(self, ranges: Iterable[tuple[int, int]]) -> Mask:
        """Whether a row assigns a variable of an offset in one of these ranges."""
        found = np.zeros(len(self), bool)
        spans = list(ranges)
        for row, assigned in self.run.assigned.items():
            found[row] = any(first <= assigned.variable <= last for first, last in spans)
        return found

    # ---- codes ----

    @cached_property
    def g_words(self) -> Rows:
        """Indices of the G words."""
        return self.word_indices("G")

    @cached_property
    def g_codes(self) -> NDArray[np.int32]:
        """Their codes as whole numbers (codes.code)."""
        written = code_numbers(self.run.words.value[self.g_words])
        return renumbered(written, self.machine.control.motion_codes)

    @cached_property
    def m_words(self) -> Rows:
        """Indices of the M words."""
        return self.word_indices("M")

    @cached_property
    def m_codes(self) -> NDArray[np.int32]:
        """Their codes as whole numbers."""
        return code_numbers(self.run.words.value[self.m_words])

    def code_indices(self, *words: str) -> Rows:
        """
        The executed words that are any of these G or M codes (`G54-G59` is a range).

        `M3 P12` asks for the word beside the code, too. What the machine lists so is not the M code alone.
        """
        found = [np.zeros(0, np.int64)]
        for letter, indices, numbers in (("G", self.g_words, self.g_codes), ("M", self.m_words, self.m_codes)):
            asked = [word for word in words if word[0] == letter and " " not in word]
            if asked:
                found.append(self._of_codes(letter, code_set(asked)))
            found += [
                indices[self._beside(word, indices, numbers)] for word in words if word[0] == letter and " " in word
            ]
        return np.concatenate(found)

    def _of_codes(self, letter: str, asked: Mask) -> Rows:
        """The G or M words, in order, whose codes are asked for (codes.code_set), and listed without another word."""
        order, present, begins = self._by_code[letter]
        found = [
            order[begin:end] for begin, end in (begins[at : at + 2] for at in np.flatnonzero(asked[present]).tolist())
        ]
        if not found:
            return order[:0]
        at = found[0] if len(found) == 1 else np.sort(np.concatenate(found))
        if letter == "G":
            return self.g_words[at]
        return self.m_words[at[~self._with_own_word[at]]]

    @cached_property
    def _by_code(self) -> dict[str, tuple[Rows, NDArray[np.int32], Rows]]:
        """By letter the G or M words grouped by their codes, the codes that there are, and where each begins."""
        found = {}
        for letter, numbers in (("G", self.g_codes), ("M", self.m_codes)):
            order = np.argsort(numbers.astype(np.int16), kind="stable")  # of small numbers in linear time
            rising = numbers[order]
            begins = np.flatnonzero(np.append(True, rising[1:] != rising[:-1])) if len(rising) else order
            found[letter] = order, rising[begins], np.append(begins, len(order))
        return found

    def _beside(self, word: str, indices: Rows, numbers: NDArray[np.int32]) -> Mask:
        """Per G or M word: it is the code of `M3 P12`, and that other word stands in its row."""
        first, _, other = word.partition(" ")
        return np.asarray((numbers == code(first)) & (self.word(other[0])[self.run.row[indices]] == float(other[1:])))

    @cached_property
    def _with_own_word(self) -> Mask:
        """Per M word: the machine lists it with a word that stands beside it."""
        found = np.zeros(len(self.m_words), bool)
        for word in self.machine.m_codes.with_words:
            found |= self._beside(word, self.m_words, self.m_codes)
        return found

    def codes(self, *words: str) -> Mask:
        """Whether a row has any of these G or M codes."""
        return self.with_words(self.code_indices(*words))

    def listed(self, *keys: str) -> Mask:
        """Whether a row has a G code of any of these lists of the machine, as in `reference_return`."""
        return self.codes(*(code for key in keys for code in self.machine.codes(key)))

    @cached_property
    def _modal(self) -> tuple[tuple[str, ...], NDArray[np.uint8], States]:
        return modal_tables(self.machine)

    def state(self, group: str) -> States:
        """The state of a modal group in each row, after its own codes (modal.STATES)."""
        return self._column(f"state {group}", lambda: self._filled(group)[0])

    @cached_property
    def switches_length_offset(self) -> Mask:
        """G43, G44, G49."""
        return self.listed("tool_length_offset", "tool_length_offset_off")

    def has_state(self, group: str, codes: Sequence[str]) -> Mask:
        """Whether the state of a modal group is one that these codes set."""
        _, _, state_of = self._modal
        return is_among(self.state(group), [state_of[code(word)] for word in codes])

    def sets(self, group: str) -> Mask:
        """Whether a row has a code of the group."""
        return self._column(f"sets {group}", lambda: self._filled(group)[1])

    def _filled(self, group: str) -> tuple[States, Mask]:
        names, group_of, state_of = self._modal
        written = np.zeros(len(self), bool)
        values = self._at_power_on(group)
        if group in names:
            chosen = group_of[self.g_codes] == names.index(group) + 1
            rows = self.run.row[self.g_words[chosen]]
            values[rows] = state_of[self.g_codes[chosen]]
            written[rows] = True
        state = fill_down(values, written | self.starts, _BEFORE.get(group, 0))
        self._columns[f"sets {group}"] = written
        self._columns[f"state {group}"] = state
        return state.astype(np.int16), written

    def _at_power_on(self, group: str) -> States:
        """The state that holds before a program has selected one, per row; of an excerpt it is what is usual."""
        states = np.full(len(self), _BEFORE.get(group, 0), np.int16)
        known = getattr(self.machine.power_on, group, "")
        if known:
            states[self.whole_program] = self._modal[2][code(known)]
        return states

    # ---- place in the file ----

    @property
    def starts(self) -> Mask:
        """Rows at which a program begins."""
        return self.run.starts

    @cached_property
    def line(self) -> Rows:
        """Line in the file, from 1."""
        return self.text.blocks.line[self.run.block]

    @cached_property
    def row_of_block(self) -> Rows:
        """Per block of the file the first row that runs it, -1 where none does."""
        rows = np.full(len(self.text.blocks), -1, np.int64)
        rows[self.run.block[::-1]] = np.arange(len(self) - 1, -1, -1)
        return rows

    @cached_property
    def program(self) -> Rows:
        """Number of the program in the file, from 0."""
        return np.cumsum(self.starts) - 1

    @cached_property
    def whole_program(self) -> Mask:
        """
        The row belongs to a main program that is there from its head on: with O number, <name> or %, not left by M99.

        Of an excerpt, and of a subprogram, it is not known what was in force before its first block.
        """
        programs = find_programs(self.text).programs
        first = np.array([program.first for program in programs], np.int64)
        has_head = np.array([program.has_head for program in programs], bool)
        start = self.run.block[np.flatnonzero(self.starts)]
        whole = has_head[np.maximum(np.searchsorted(first, start, side="right") - 1, 0)]
        whole |= len(self.text.tape_marks) > 0
        whole[self.program[self.codes(*self.machine.macro.program_returns) & (self.run.depth == 0)]] = False
        return whole[self.program]

    def anywhere_in_program(self, mask: Mask) -> Mask:
        """Rows of programs in which any row is in the mask."""
        found = np.zeros(int(np.count_nonzero(self.starts)) + 1, bool)
        found[self.program[mask]] = True
        return found[self.program]

    @cached_property
    def ends_program(self) -> Mask:
        """M02, M30."""
        return self.codes(*self.machine.m_codes.program_end)

    # ---- units, feed ----

    @cached_property
    def units(self) -> States:
        """Units.INCH or Units.MM; where the program does not say, those of the job or the machine."""
        assumed = self.job.program_units or self.machine.control.units
        state = self.state("units")
        return np.where(state == 0, Units.INCH if assumed == "inch" else Units.MM, state).astype(np.int16)

    @cached_property
    def scale(self) -> Floats:
        """mm per unit of length."""
        return np.where(self.units == Units.INCH, MM_PER_INCH, 1.0)

    @cached_property
    def modal_feed_mode(self) -> States:
        """FeedMode that the codes say."""
        return self.state("feed_mode")

    @cached_property
    def written_feed(self) -> Floats:
        """The last F as a number [mm per min or per revolution]; NaN before the first."""
        written = self.has("F") & self._takes_feed
        value = np.where(written, self.word("F") * self.scale, np.nan)
        return fill_down(value, written | self.starts, np.nan)

    @cached_property
    def feed_word(self) -> Rows:
        """Where in the file the F in force is written, its first character; -1 before the first."""
        words = self.word_indices("F")
        at = np.full(len(self), -1, np.int64)
        at[self.run.row[words]] = self.run.words.start[words]
        return fill_down(at, (self.has("F") & self._takes_feed) | self.starts, -1)

    @cached_property
    def motion_word(self) -> Rows:
        """Where in the file the code of motion in force is written, its first character; -1 before the first."""
        words = self.code_indices(*(code for key in STATES["motion"] for code in self.machine.codes(key)))
        at = np.full(len(self), -1, np.int64)
        at[self.run.row[words]] = self.run.words.start[words]
        return fill_down(at, self.sets("motion") | self.starts, -1)

    @cached_property
    def _takes_feed(self) -> Mask:
        return ~self.listed(*NO_FEED)

    @cached_property
    def job_scale(self) -> Floats | float:
        """mm per unit of the lengths of the job."""
        return {"mm": 1.0, "inch": MM_PER_INCH}[self.job.units] if self.job.units else self.scale

    # ---- M codes ----

    def switched(self, on: list[str], off: list[str]) -> Mask:
        """What M codes have switched on, in each row after its own."""
        return self._column(f"switched {on} {off}", lambda: self._switched(on, off))

    def _switched(self, on: list[str], off: list[str]) -> Mask:
        return happened(self.codes(*on), self.codes(*off) | self.starts)

    @cached_property
    def spindle(self) -> Mask:
        """The main spindle (on many lathes the live tool too) runs: M3, M4; not by a code listed for the live tool."""
        codes = self.machine.m_codes
        return self.switched([word for word in codes.spindle_on if word not in codes.live_tool_on], codes.spindle_off)

    @cached_property
    def live_tool(self) -> Mask:
        """The live tool runs; always False where the profile names no code."""
        return self.switched(self.machine.m_codes.live_tool_on, self.machine.m_codes.live_tool_off)

    # ---- what the axis words are for ----

    @cached_property
    def uses_axes(self) -> Mask:
        """The axis words of the row are coordinates of a move."""
        return ~self.listed(*NO_MOVE) & ~self.run.unknown

    @cached_property
    def presets_x(self) -> Mask:
        """X is that of the work offset again: what G52 and G50 (G92) have moved is taken back."""
        return np.asarray(self.listed("coordinate_preset") & self.has("X", "U"))

    @cached_property
    def in_cycle(self) -> Mask:
        """A turning or drilling cycle is in force."""
        return np.asarray((self.state("motion") == Motion.CYCLE) | (self.drilling != 0))

    @cached_property
    def drilling(self) -> Rows:
        """The drilling cycle in force (83 for G83), 0 for none; G80 and the codes of group 01 end it (B-62754EN/01)."""
        written = self.sets("drilling")
        state = np.where(written, self.state("drilling"), 0).astype(np.int64)
        return fill_down(state, written | self.sets("motion") | self.starts, 0).astype(np.int64)
