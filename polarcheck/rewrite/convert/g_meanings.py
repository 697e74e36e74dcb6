"""What G codes of one machine are on another one, by the lists of both profiles that say what a code does."""

from __future__ import annotations

import msgspec

from polarcheck.foundation.states import MOVES, STATES
from polarcheck.program.machines.code_lists import GCodes, GCodeSystem, numbers
from polarcheck.program.machines.code_tables import code, spelled
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown

#: Lists that qualify codes of other lists; they give no meaning of their own.
_NOT_OF_MEANING = (
    "axis_words_no_move",
    "c_axis_reference",
    "feed_is_lead",
    "constant_surface_speed_ended_by",
    "data_input_work_offset",
    "data_input_tool_offset",
)
#: Lists whose effect is compared when the program is read back: the other control may lack the code.
_COMPARED = (*STATES["corner"], *STATES["feed_axes"], *STATES["arc_feed"])
#: List that ends a state -> list that begins it. Where the other control cannot begin it, the end is dropped.
_ENDS = {
    "drilling_cycle_off": "drilling_cycle",
    "scaling_off": "scaling",
    "rotation_off": "rotation",
    "mirror_image_off": "mirror_image",
    "tool_length_offset_off": "tool_length_offset",
}
#: Lists whose codes all do the same: where the other machine has another code in its list, that is written.
_OF_ONE_MEANING = (
    *MOVES.values(),
    *_COMPARED,
    *(key for group in ("plane", "side", "feed_mode", "distance", "units", "speed") for key in STATES[group]),
    *_ENDS,
    "dwell",
)
#: Lists whose codes mean that with other words beside them, and something else alone.
_WITH_WORDS = ("coordinate_setting",)
_LISTS = tuple(key for key in (*GCodes.__struct_fields__, *GCodeSystem.__struct_fields__) if key not in _NOT_OF_MEANING)


class Meaning(msgspec.Struct, frozen=True):
    """
    What a code is on the other machine.

    words: that are written for it. reason: why there are none, as it follows the code in a sentence; or empty.
    note: what is said where a code is left out, since nothing is lost by it; or empty.
    key: of the list that says what it does, or empty.
    """

    words: tuple[str, ...] = ()
    reason: str = ""
    note: str = ""
    key: str = ""


class GMeanings:
    """The G codes of one machine as those of another."""

    def __init__(self, source: Machine, target: Machine) -> None:
        self.source, self.target = source, target
        self._keys: dict[int, tuple[str, int]] = {}
        self._with_words: dict[int, tuple[str, int]] = {}
        for key in _LISTS:
            for index, word in enumerate(source.codes(key)):
                self._keys.setdefault(code(word), (key, index))
                if key in _WITH_WORDS:
                    self._with_words[code(word)] = (key, index)
        for name, equivalent in source.control.motion_codes.items():
            self._keys[code(name)] = self._keys[code(equivalent)]
        # A code that is not in the list of the control is a builder's, and another one on another lathe.
        same_list = source.control.known_codes == target.control.known_codes
        same_system = source.control.g_code_system == target.control.g_code_system
        self._same_codes = set(numbers(source.control.known_codes)) if same_list and same_system else set()
        corner_codes = (numbers(machine.writing.corner_codes) for machine in (source, target))
        self._same_codes |= set.intersection(*map(set, corner_codes))

    def key(self, number: int, has_words: bool = False) -> str:
        """
        The list of the source that says what a code does; empty where none has it.

        has_words: other words than codes stand beside it: G50 S2500 is no end of scaling.
        """
        return self._listed(number, has_words)[0]

    def _listed(self, number: int, has_words: bool) -> tuple[str, int]:
        listed = self._keys.get(number, ("", 0))
        return self._with_words.get(number, listed) if has_words else listed

    def meaning(self, number: int, has_words: bool = False) -> Meaning:
        """What a code, as a whole number (codes.code), is on the other machine."""
        word = spelled("G", number)
        key, index = self._listed(number, has_words)
        if not key:
            if number in self._same_codes:
                return Meaning((self.named(word),))
            return Meaning(reason=f"the profile of {self.source.title} does not say what it does")
        theirs, ours = self.target.codes(key), self.source.codes(key)
        if word in theirs and key in _OF_ONE_MEANING:
            return Meaning((self.named(word),), key=key)
        if key in _OF_ONE_MEANING and theirs:
            return Meaning((self.named(theirs[0]),), key=key)
        if theirs[index : index + 1] == [word]:
            return Meaning((self.named(word),), key=key)
        if key in GCodeSystem.__struct_fields__ and len(theirs) == len(ours):
            return Meaning((self.named(theirs[index]),), key=key)
        if key in _ENDS and not self.target.codes(_ENDS[key]):
            return Meaning(note=f"it ends what {self.target.title} cannot begin", key=key)
        if key in _COMPARED:
            return Meaning(
                note=f"{self.target.title} has no code for it, and moves the tool as fast and along the same path",
                key=key,
            )
        return Meaning(reason=f"the profile of {self.target.title} has no code that does the same", key=key)

    def named(self, word: str) -> str:
        """A code of the other machine as it is written there: G13.1 is TRAFOOF in another language."""
        return shown(self.target.control.native_words, word)
