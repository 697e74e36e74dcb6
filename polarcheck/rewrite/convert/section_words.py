"""Which words of a block in the polar mode say where the tool goes, and which order something else."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.foundation.arrays import Mask, cached_property, is_among, mask_at
from polarcheck.foundation.states import MOVES, STATES
from polarcheck.program.machines.code_lists import numbers
from polarcheck.program.machines.code_tables import code_numbers
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.g_meanings import GMeanings

#: Lists of codes that the moves say themselves.
_OF_MOVES = (*MOVES.values(), *STATES["distance"], *STATES["plane"])
_OF_GEOMETRY = (*_OF_MOVES, *STATES["side"])
#: Keys of the profile by which the geometry of sections is written.
_OF_CONTROL = (
    *("least_increment", "least_increment_inch", "number_without_point", "motion_codes", "native_words"),
    *("line_comments", "parentheses_are_comments", "g_code_system"),
)
_OF_POLAR = (
    *("x", "virtual_axis", "virtual_axis_incremental", "virtual_axis_programming", "zero_angle", "direction_word"),
    *("center_words", "feed_measures", "other_axes", "repeated_z", "rotary_address", "rotary_incremental"),
)
_OF_WRITING = ("before", "switch", "behind", "end", "behind_end", "rapid_in_mode", "arc_radius", "arc_split", "helices")


class SectionWords:
    """The words of polar sections. is_dwell: a boolean per row: its words count time."""

    def __init__(self, trace: Trace, target: Machine) -> None:
        self.trace, self.target = trace, target
        source = trace.machine
        self._meanings = GMeanings(source, target)
        polar, arcs = source.polar, source.arcs
        centers = [word for pair in polar.center_words.values() for word in pair]
        addresses = {"X", "U", "Z", "W", "F", "I", "J", "K", arcs.radius_word, *polar.axis_addresses, *centers}
        addresses |= {*arcs.made_corners}
        addresses |= {arcs.larger_arc_word[:1]} if arcs.larger_arc_word else set()
        self._addresses = {source.address_number(address) for address in addresses if address}
        letters = {*polar.words_beside_switch, polar.direction_word}
        self._beside_switch = {source.address_number(word) for word in letters if len(word) == 1}
        self._virtual = set(trace.axes.virtual_words.tolist())
        words = trace.run.words
        self._code: list[int] = code_numbers(words.value).tolist()
        self._address: list[int] = words.address.tolist()
        self._keys: dict[int, str] = {}
        self.is_dwell = trace.blocks.listed("dwell")
        self._has_arguments = ~trace.modal.uses_axes | trace.blocks.codes(*trace.machine.macro.flow_codes)
        self._switch_codes = {*numbers(polar.on), *numbers(polar.off), *numbers(polar.ended_by)}

    @cached_property
    def is_plain(self) -> Mask:
        """A boolean per row: its words say where the tool goes and nothing else, and none is computed or for a side."""
        run, writing = self.trace.run, self.trace.machine.writing
        # A block that begins with one of these may be a call or a return in the words of the profile.
        of_calls = {ord(text[0].upper()) for text in (writing.subprogram_call, writing.subprogram_return) if text}
        address = run.words.address
        is_head, is_geometry = is_among(address, [*map(ord, "NO/")]), is_among(address, [*self._addresses - of_calls])
        is_geometry[list(self._virtual)] = True
        codes = np.flatnonzero(address == ord("G"))
        is_geometry[codes] = [self.key(index) in _OF_MOVES for index in codes.tolist()]
        is_plain = mask_at(len(self.trace), run.row[is_geometry])
        is_plain[run.row[~(is_geometry | is_head)]] = False
        return is_plain & ~(self.is_dwell | self._has_arguments | self.trace.text.blocks.is_macro[run.block])

    @property
    def is_same(self) -> bool:
        """Both machines write the geometry of sections in the same words."""
        source, target = self.trace.machine, self.target
        groups = ((_OF_CONTROL, "control"), (_OF_POLAR, "polar"), (_OF_WRITING, "writing"))
        same_keys = all(
            getattr(getattr(source, table), key) == getattr(getattr(target, table), key)
            for keys, table in groups
            for key in keys
        )
        same_codes = all(source.codes(key) == target.codes(key) for key in _OF_GEOMETRY)
        same_corner = source.compensation.corner == target.compensation.corner
        takes_arcs = source.arcs.sweep_limit <= target.arcs.sweep_limit
        same_units = source.control.units == target.control.units
        return same_keys and same_codes and same_corner and takes_arcs and same_units

    def key(self, index: int) -> str:
        """The list of codes that a word stands in; empty for a word that is no G code."""
        if self._address[index] != ord("G"):
            return ""
        code = self._code[index]
        if code not in self._keys:
            self._keys[code] = self._meanings.key(code)
        return self._keys[code]

    def divided(self, row: int, words: Sequence[int], is_switch: bool) -> tuple[list[int], list[int]]:
        """
        Return the words of a row that say where the tool goes, and the others.

        is_switch: the row switches the mode on or off; what stands there for the switch is of the first kind.
        """
        if self.is_dwell[row]:
            return [], list(words)
        if not is_switch and self._has_arguments[row]:
            # R of G10 P3 R4. is no radius.
            geometry = [index for index in words if self.key(index) in _OF_GEOMETRY]
        else:
            geometry = [index for index in words if self._is_geometry(index, is_switch)]
        return geometry, [index for index in words if index not in geometry]

    def _is_geometry(self, index: int, is_switch: bool) -> bool:
        address = self._address[index]
        if address == ord("G"):
            return self.key(index) in _OF_GEOMETRY or self._code[index] in self._switch_codes
        if is_switch and address in self._beside_switch:
            return True
        return address in self._addresses or index in self._virtual
