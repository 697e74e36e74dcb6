"""What M codes of one machine are on another one, by the lists of both profiles that say what a code does."""

from __future__ import annotations

import numpy as np

from polarcheck.columns.trace import Trace
from polarcheck.program.machines.code_lists import expanded
from polarcheck.program.machines.code_tables import spelled
from polarcheck.program.machines.m_codes import OF_EVERY_LATHE, MCodes
from polarcheck.program.machines.machine import Machine
from polarcheck.rewrite.convert.g_meanings import Meaning

#: Lists whose codes differ by the direction of the spindle, in this order.
_BY_SENSE = ("live_tool_on", "spindle_on", "sub_spindle_on")
#: M codes with one meaning on every lathe.
_OF_EVERY_LATHE = frozenset(expanded(OF_EVERY_LATHE))
_LISTS = tuple(
    key
    for key in MCodes.__struct_fields__
    if key not in ("stops_reading_ahead", "optional_stop", "program_end", "tool_change")
)
_LIVE = {"spindle_on": "live_tool_on", "spindle_off": "live_tool_off"}
#: What each list is in a sentence.
_TITLES = {
    "c_axis_on": "engages the C axis",
    "c_axis_off": "releases the C axis",
    "c_axis_clamp": "clamps the C axis",
    "c_axis_unclamp": "unclamps the C axis",
    "live_tool_on": "starts the live tool",
    "live_tool_off": "stops the live tool",
    "spindle_on": "starts the main spindle",
    "spindle_off": "stops the main spindle",
    "sub_c_axis_on": "engages the C axis of the sub-spindle",
    "sub_c_axis_off": "releases the C axis of the sub-spindle",
    "sub_c_axis_clamp": "clamps the C axis of the sub-spindle",
    "sub_c_axis_unclamp": "unclamps the C axis of the sub-spindle",
    "sub_spindle_on": "starts the sub-spindle",
    "sub_spindle_off": "stops the sub-spindle",
    "spindle_orientation": "orients the main spindle",
}


class MMeanings:
    """The M codes of a program as those of another machine."""

    def __init__(self, trace: Trace, target: Machine, turns_live_tool: np.typing.NDArray[np.bool_]) -> None:
        self.trace, self.source, self.target = trace, trace.machine, target
        self._turns_live_tool = turns_live_tool
        codes = trace.machine.m_codes
        self._keys: dict[str, list[tuple[str, int]]] = {}
        for key in _LISTS:
            for index, word in enumerate(getattr(codes, key)):
                self._keys.setdefault(word, []).append((key, index))

    def meaning(self, row: int, number: int) -> Meaning:
        """What an M code of a row, as a whole number (codes.code), is on the other machine."""
        word = spelled("M", number)
        listed, argument = self._listed(row, word)
        if not listed:
            if word in _OF_EVERY_LATHE:
                return Meaning((word,))
            return Meaning(reason=f"the profile of {self.source.title} does not say what it does")
        key, index = self._chosen(row, listed)
        theirs = getattr(self.target.m_codes, key)
        if word in theirs and not argument:
            return Meaning((word,), key=key)
        if key in _BY_SENSE and index >= len(theirs):
            theirs = []
        if not theirs:
            return Meaning(
                reason=f"it {_TITLES[key]}, and the profile of {self.target.title} names no code for that", key=key
            )
        return Meaning(tuple(theirs[index if key in _BY_SENSE else 0].split()), key=key)

    def word_beside(self, row: int, number: int) -> str:
        """The other word of a code such as M3 P12, where its row has it; empty without."""
        return self._listed(row, spelled("M", number))[1]

    def _listed(self, row: int, word: str) -> tuple[list[tuple[str, int]], str]:
        for listed in self._keys:
            first, _, argument = listed.partition(" ")
            if argument and first == word and self.trace.blocks.word(argument[0])[row] == float(argument[1:]):
                return self._keys[listed], argument
        return self._keys.get(word, []), ""

    def _chosen(self, row: int, listed: list[tuple[str, int]]) -> tuple[str, int]:
        """Which list applies in a row if several have the code; M3 starts a live tool without a code of its own."""
        keys = dict(listed)
        runs = row > 0 and bool(self.trace.modal.live_tool[row - 1])
        if "live_tool_off" in keys and len(keys) > 1:
            remaining = [key for key in keys if key != "live_tool_off"]
            key = "live_tool_off" if runs else remaining[0]
            return key, keys[key]
        key, index = listed[0]
        has_word = self.target.writing.live_tool_speed not in ("", "S")
        if key in _LIVE and self._turns_live_tool[row] and (has_word or getattr(self.target.m_codes, _LIVE[key])):
            # A live tool with a speed of its own has a start of its own, be it that no profile names it.
            key = _LIVE[key]
        return key, index
