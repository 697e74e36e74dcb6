"""The polar mode of other controls in a program: the codes that begin it there and not here, and what belongs to it."""

from __future__ import annotations

import functools
from collections.abc import Iterable

import msgspec
import numpy as np

from polarcheck.columns.filling import happened
from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Columns, Mask, Rows, cached_property, is_among, mask_at
from polarcheck.program.machines import profiles
from polarcheck.program.machines.axis_table import AXES
from polarcheck.program.machines.code_lists import is_code
from polarcheck.program.machines.code_tables import CODE_LIMIT, code, code_numbers, code_set
from polarcheck.program.machines.profiles import Profile
from polarcheck.program.reading.translation import spans
from polarcheck.program.reading.words import NumberFault, Words


class Switch(msgspec.Struct, frozen=True):
    """A code or word that begins the mode elsewhere, the rows with it, and the machines that know it."""

    name: str
    rows: Rows
    known_by: tuple[Profile, ...]


class OtherMode(Columns, frozen=True):
    """
    Which rows begin the mode of another control, and whether what follows is meant for it.

    Cheap for a program without such a code: only one that has it makes other machines be looked at.
    """

    trace: Trace

    @cached_property
    def switches(self) -> tuple[Switch, ...]:
        """The codes that begin the mode on other controls, of those that the program executes."""
        trace, words = self.trace, self.trace.run.words
        switches = []
        for name in self._in_text:
            rows = np.flatnonzero(trace.blocks.with_words(self._of_name(name, words)) & ~trace.mode.in_polar)
            if name in trace.machine.polar.on_of_other_meaning:
                rows = rows[~trace.blocks.has(*AXES)[rows]]
            if name in trace.machine.polar.on_of_macros:
                rows = rows[self._is_certain(Switch(name, rows, known_by(name)))[rows]]
            if len(rows):
                switches.append(Switch(name, rows, known_by(name)))
        return tuple(switches)

    @cached_property
    def _in_text(self) -> list[str]:
        """The codes that begin the mode on other controls, of those that stand in the file, executed or not."""
        polar = self.trace.machine.polar
        of_machine = {*polar.on, *self.trace.machine.control.native_words}
        names = [name for name in polar.on_of_other_controls if name not in of_machine and self._stands_in_text(name)]
        return [name for name in names if known_by(name)]

    def _stands_in_text(self, name: str) -> bool:
        if is_code(name):
            stands = bool(self._codes_in_text[code(name)])
            return stands and (name not in self.trace.machine.polar.on_of_macros or self._stands_alone(name))
        return any(self._of_word(name, words).any() for words in self._tables)

    def _stands_alone(self, name: str) -> bool:
        """The code stands somewhere in a block of its own."""
        words = self.trace.text.words
        with_name = words.block[self._of_name(name, words)]
        remaining = words.block[(words.address != ord("N")) & (words.address != ord("O"))]
        return bool(np.any(np.searchsorted(remaining, with_name, "right") - np.searchsorted(remaining, with_name) == 1))

    @cached_property
    def _codes_in_text(self) -> Mask:
        """Over code numbers: the G code stands in the file, executed or not."""
        mask = np.zeros(CODE_LIMIT + 1, bool)
        for words in self._tables:
            mask[code_numbers(words.value[words.address == ord("G")])] = True
        return mask

    @cached_property
    def _tables(self) -> tuple[Words, ...]:
        """The words of the file and those executed, which are the same where nothing is computed, skipped or called."""
        written, executed = self.trace.text.words, self.trace.run.words
        return (written,) if executed is written else (written, executed)

    @cached_property
    def begins(self) -> Mask:
        """The row begins the mode of another control."""
        return self.trace.blocks.mask_of(
            np.concatenate([np.zeros(0, np.int64), *(switch.rows for switch in self.switches)])
        )

    def switch(self, row: int) -> Switch:
        """The code or word in a row that begins the mode elsewhere. Raises IndexError for a row without one."""
        switches = [switch for switch in self.switches if row in switch.rows]
        return switches[0]

    @cached_property
    def is_meant(self) -> Mask:
        """
        Rows that certainly begin the mode, and call no macro: the code that ends it or a move in the mode follows, or
        a word begins it, while macros are called by codes.
        """
        mask = np.zeros(len(self.trace), bool)
        for switch in self.switches:
            mask[switch.rows] = self._is_followed(switch)[switch.rows] if is_code(switch.name) else True
        return mask

    @cached_property
    def may_be_macro(self) -> Mask:
        """The row begins it, and nothing in its program tells whether it is no macro of the builder."""
        if not self.switches:
            return self.begins
        return self.begins & ~self.trace.blocks.anywhere_in_program(self.is_meant)

    def _is_certain(self, switch: Switch) -> Mask:
        """Per row: the code stands alone, and behind it a move in the mode and the code that ends it."""
        _, cuts, ends = self._marks(switch)
        alone = self.trace.blocks.consists_of("G", "O") & ~self.trace.blocks.has("X", "C")
        stretch = np.cumsum(self.trace.blocks.mask_of(switch.rows) | self.trace.blocks.starts)
        has_mark = np.zeros((2, len(self.trace) + 1), bool)
        has_mark[0, stretch[cuts]] = True
        has_mark[1, stretch[ends]] = True
        return np.asarray(alone & (has_mark[0] & has_mark[1])[stretch])

    def _is_followed(self, switch: Switch) -> Mask:
        """Rows from a beginning on to the next one, or to the next program, in which something belongs to the mode."""
        begins, cuts, ends = self._marks(switch)
        stretch = np.cumsum(begins | self.trace.blocks.starts)
        has_mark = mask_at(len(self.trace) + 1, stretch[ends | cuts])
        return has_mark[stretch]

    def _marks(self, switch: Switch) -> tuple[Mask, Mask, Mask]:
        """Rows with the switch, with moves of the virtual axis at feed in its mode, and with what ends it."""
        begins = self.trace.blocks.mask_of(switch.rows)
        ends = self._ends(switch)
        axes = {axis for profile in switch.known_by for axis in profile.machine.polar.virtual_axes}
        codes = (code for profile in switch.known_by for code in profile.machine.control.motion_codes)
        at_feed = self.trace.axes.at_feed | self._has(codes)
        return begins, at_feed & self.trace.blocks.has(*axes) & self._within(begins, ends), ends

    def _ends(self, switch: Switch) -> Mask:
        """Rows with what ends the mode on any of the machines that know the switch."""
        return self._has(off for profile in switch.known_by for off in ends_of(profile, switch.name))

    def _within(self, begins: Mask, ends: Mask) -> Mask:
        """Rows in the mode of the other control: until its end, the next tool, or a section of this control."""
        trace = self.trace
        ends = ends | trace.tools.changes_tool | trace.blocks.ends_program | trace.mode.enters | trace.blocks.starts
        return happened(begins, ends)

    def ends_written(self, row: int) -> list[str]:
        """The codes and words of its own control with which the mode that a row begins ends, if they stand there."""
        switch, trace = self.switch(row), self.trace
        ends = dict.fromkeys(end for profile in switch.known_by for end in ends_of(profile, switch.name))
        stops = trace.tools.changes_tool | trace.blocks.ends_program | trace.blocks.starts | self.begins
        following = np.flatnonzero(stops)
        last = int(np.append(following, len(trace))[np.searchsorted(following, row, "right")])
        of_machine = {*trace.machine.polar.off, *trace.machine.control.native_words}
        return [name for name in ends if name not in of_machine and self._has([name])[row:last].any()]

    def other_axes_written(self, row: int) -> list[str]:
        """The second axes of the moves in the mode that a row begins, where this control has another."""
        polar, switch = self.trace.machine.polar, self.switch(row)
        beginning = self.trace.blocks.mask_of([row])
        within = self._within(beginning, self._ends(switch)) & ~beginning
        if np.any(within & self.trace.blocks.has(*polar.virtual_axes)):
            return []
        axes = dict.fromkeys(axis for profile in switch.known_by for axis in profile.machine.polar.virtual_axes)
        return [axis for axis in axes if np.any(within & self.trace.blocks.has(axis))]

    def machines(self, row: int) -> tuple[Profile, ...]:
        """
        Of the machines that know the code in a row those that read it well: with the words beside it, and with the
        axes of the moves behind it. One speaks for all that read it alike.
        """
        switch = self.switch(row)
        within = self._within(self.trace.blocks.mask_of([row]), self._ends(switch))
        addresses = {chr(self.trace.run.words.address[index]) for index in np.flatnonzero(self.trace.run.row == row)}

        def reads(profile: Profile) -> bool:
            return not is_code(switch.name) or addresses <= {*"GNO/", *profile.machine.polar.words_beside_switch}

        def moves(profile: Profile) -> bool:
            return bool(np.any(within & self.trace.blocks.has(*profile.machine.polar.virtual_axes)))

        candidates = switch.known_by
        for fits in (reads, moves):
            candidates = tuple(filter(fits, candidates)) or candidates
        alike: dict[object, Profile] = {}
        for profile in candidates:
            alike.setdefault(_reading(profile), profile)
        return tuple(alike.values())

    @cached_property
    def words(self) -> Mask:
        """Per executed word: the code or word that begins the mode."""
        mask = np.zeros(len(self.trace.run.words), bool)
        for switch in self.switches:
            mask |= self._of_name(switch.name, self.trace.run.words) & np.isin(self.trace.run.row, switch.rows)
        return mask

    @cached_property
    def explained(self) -> Mask:
        """
        Per word of the file: belongs to the language of a control whose mode the program begins, and is its switches,
        its moves, or a word of its own. That the control does not know it is no fault of its own.
        """
        words = self.trace.text.words
        mask = np.zeros(len(words), bool)
        mode = self.trace.machine.polar
        of_other_meaning = [] if self.switches else [*mode.on_of_other_meaning, *mode.on_of_macros]
        for name in self._in_text:
            for profile in known_by(name) if name not in of_other_meaning else ():
                control, polar = profile.machine.control, profile.machine.polar
                codes = code_set([*polar.on, *polar.off, *control.motion_codes])
                of_g = words.address == ord("G")
                mask[of_g] |= codes[code_numbers(words.value[of_g])]
                for word in control.native_words:
                    mask |= self._of_name(word, words)
        return mask

    @cached_property
    def explained_strays(self) -> Mask:
        """Per stray character of the file: begins a comment on such a control."""
        text = self.trace.text
        signs = [profile.machine.control.line_comments for switch in self.switches for profile in switch.known_by]
        return is_among(text.source.code[text.strays.start], [ord(sign) for sign in signs if sign])

    # ---- codes and native words alike ----

    def _has(self, names: Iterable[str]) -> Mask:
        """Rows with one of these codes or words."""
        mask = np.zeros(len(self.trace), bool)
        for name in dict.fromkeys(names):
            mask |= self.trace.blocks.with_words(self._of_name(name, self.trace.run.words))
        return mask

    def _of_name(self, name: str, words: Words) -> Mask:
        """Per word of the file, or executed word: is this code, or stands in this word."""
        if not is_code(name):
            return self._of_word(name, words)
        mask = words.address == ord("G")
        mask[mask] = code_set([name])[code_numbers(words.value[mask])]
        return np.asarray(mask)

    def _of_word(self, name: str, words: Words) -> Mask:
        """Per word: stands in this word of a control's own language, which reads as letters without digits here."""
        mask = np.zeros(len(words), bool)
        bare = np.flatnonzero(words.fault == NumberFault.NO_DIGITS)
        if not len(bare):
            return mask
        begins, ends = spans(self.trace.text.source, name)
        if not len(begins):
            return mask
        start = words.start[bare]
        mask[bare] = np.searchsorted(begins, start, side="right") > np.searchsorted(ends, start, side="right")
        return mask


@functools.cache
def known_by(name: str) -> tuple[Profile, ...]:
    """The machines that begin the mode by a code or word; a code that only stands for such a word is none of theirs."""
    return tuple(
        profile
        for profile in profiles.built_in()
        if _intended(profile, name) in profile.machine.polar.on
        and name not in profile.written.control.native_words.values()
    )


def ends_of(profile: Profile, name: str) -> list[str]:
    """Codes that end the mode on a machine that begins it by a code or word, in its own language first."""
    control, polar = profile.machine.control, profile.machine.polar
    code = dict(zip(polar.on, polar.off, strict=False)).get(_intended(profile, name), polar.off[0])
    return [*(word for word, text in control.native_words.items() if text == code), code]


def _intended(profile: Profile, name: str) -> str:
    """The code that a word of the machine's own language stands for; a code stands for itself."""
    return profile.machine.control.native_words.get(name, name)


def _reading(profile: Profile) -> tuple[object, ...]:
    """The settings of a machine that decide how it reads a section."""
    mode = profile.machine.polar
    return tuple(mode.virtual_axes), mode.x, tuple(mode.words_beside_switch), profile.machine.arcs.radius_word
