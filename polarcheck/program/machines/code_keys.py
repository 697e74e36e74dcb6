"""Which keys of a machine hold lists of codes, by the form of what stands in them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Final

from polarcheck.program.machines.code_lists import GCodes, GCodeSystem
from polarcheck.program.machines.m_codes import PLAIN_M_CODES, MCodes
from polarcheck.program.machines.macro_keys import CODE_LISTS

#: By the table, as in each of the mappings: lists of G codes, in which `G54-G59` is a range.
RANGES: Final[Mapping[str, tuple[str, ...]]] = {
    "control": ("known_codes", "units_of_lengths_alone"),
    "polar": ("allowed_codes", "off_of_other_modes", "contours_outside", "planes_not_simulated"),
    "writing": ("corner_codes",),
    "g_codes": GCodes.__struct_fields__,
    "g_code_system_a": GCodeSystem.__struct_fields__,
    "g_code_system_b": GCodeSystem.__struct_fields__,
    "g_code_system_c": GCodeSystem.__struct_fields__,
}
#: Lists of G and M codes, each written by itself.
SINGLE: Final[Mapping[str, tuple[str, ...]]] = {
    "polar": ("on", "off", "ended_by", "plane_before"),
    "m_codes": PLAIN_M_CODES,
}
#: Lists of M codes, of which some are told apart by a word beside them: M3 P11, M3 P12.
WITH_WORDS: Final[Mapping[str, tuple[str, ...]]] = {
    "m_codes": tuple(key for key in MCodes.__struct_fields__ if key not in PLAIN_M_CODES)
}
#: Lists of addresses and codes.
MIXED: Final[Mapping[str, tuple[str, ...]]] = {"polar": ("words_beside_switch",)}
#: Lists of words of which some are codes.
WORDS: Final[Mapping[str, tuple[str, ...]]] = {"polar": ("on_of_other_controls", "on_of_other_meaning", "on_of_macros")}
#: Those whose type says what can stand in them.
TYPED: Final[Mapping[str, tuple[str, ...]]] = {
    "control": ("x_radius_words", "x_diameter_words", "x_absolute_diameter_words"),
    "macro": CODE_LISTS,
}
EVERY: Final = frozenset(
    f"{table}.{key}"
    for lists in (RANGES, SINGLE, WITH_WORDS, MIXED, WORDS, TYPED)
    for table, keys in lists.items()
    for key in keys
)
