"""Words of a control's own language: those that stand for no G code (DIAMOF) get a code that no control has."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec.structs import replace

from polarcheck.program.machines.code_lists import FRAME_LISTS, is_code
from polarcheck.program.machines.machine import Machine

#: G0.1 to G0.9, which words of three letters have room for as G.1, and behind them G9.1 to G9.9.
_FREE = [f"G{number}.{digit}" for number in (0, 9) for digit in range(1, 10)]
#: Lists of [control] and of [g_codes] that may hold such words; those of one that is not simulated share a code.
_OF_CONTROL = ("x_radius_words", "x_diameter_words", "x_absolute_diameter_words")
*_FRAMES, _NOT_SIMULATED = FRAME_LISTS


def numbered(machine: Machine) -> Machine:
    """
    The machine with its words for radius, diameter and frames as codes, wherever its lists name them.

    Raises ValueError for more words than there are codes, or for one that is too short to be read as a code.
    """
    control, polar, g_codes = machine.control, machine.polar, machine.g_codes
    of_control = {key: getattr(control, key) for key in _OF_CONTROL}
    of_frames = {key: getattr(g_codes, key) for key in (*_FRAMES, _NOT_SIMULATED)}
    singles = [*of_control.values(), *(of_frames[key] for key in _FRAMES)]
    groups = [*([word] for listed in singles for word in listed), of_frames[_NOT_SIMULATED]]
    native = [[word for word in group if _needs_code(word, control.native_words)] for group in groups]
    word_groups = list(dict.fromkeys(tuple(group) for group in native if group))
    if not word_groups:
        return machine
    taken = control.native_words.values()
    unused = [code for code in _FREE if code not in taken and _short(code) not in taken]
    if len(word_groups) > len(unused):
        raise ValueError(f"no more than {len(unused)} words of its own can stand in x_radius_words and lists like it")
    code = {word: free for group, free in zip(word_groups, unused, strict=False) for word in group}

    def coded(listed: list[str]) -> list[str]:
        return [code.get(word, word) for word in listed]

    written = {word: free if len(word) >= len(free) else _short(free) for word, free in code.items()}
    return replace(
        machine,
        control=replace(
            control,
            native_words={**control.native_words, **written},
            **{key: coded(listed) for key, listed in of_control.items()},
        ),
        polar=replace(polar, allowed_codes=coded(polar.allowed_codes)),
        g_codes=replace(g_codes, **{key: coded(listed) for key, listed in of_frames.items()}),
    )


def _needs_code(word: str, native_words: Mapping[str, str]) -> bool:
    return not is_code(word.partition(" ")[0], "GM") and word not in native_words


def _short(code: str) -> str:
    """A code for a word of three letters: G.1 is G0.1."""
    return code.replace("G0.", "G.")


def shown(native_words: Mapping[str, str], code: str) -> str:
    """The native word for a code such as G13.1, or the code itself."""
    return next((word for word, text in native_words.items() if text in (code, _short(code))), code)
