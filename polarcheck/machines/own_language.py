"""Words of a control's own language: those that stand for no G code (DIAMOF) get a code that no control has."""

from __future__ import annotations

from collections.abc import Mapping

from msgspec.structs import replace

from polarcheck.machines.code_lists import is_code
from polarcheck.machines.machine import Machine

#: G0.1 to G0.9.
_FREE = [f"G0.{digit}" for digit in range(1, 10)]


def numbered(machine: Machine) -> Machine:
    """
    The machine with its words for radius and diameter as codes, wherever its lists name them.

    Raises ValueError for more words than there are codes, or for one that is too short to be read as a code.
    """
    control, polar = machine.control, machine.polar
    listed = (*control.x_radius_words, *control.x_diameter_words)
    words = [word for word in listed if not is_code(word.partition(" ")[0], "GM") and word not in control.native_words]
    if not words:
        return machine
    code = dict(zip(dict.fromkeys(words), _FREE, strict=False))
    if len(code) < len(set(words)):
        raise ValueError(f"no more than {len(_FREE)} words can stand in x_radius_words and x_diameter_words")

    def coded(listed: list[str]) -> list[str]:
        return [code.get(word, word) for word in listed]

    return replace(
        machine,
        control=replace(
            control,
            native_words={**control.native_words, **code},
            x_radius_words=coded(control.x_radius_words),
            x_diameter_words=coded(control.x_diameter_words),
        ),
        polar=replace(polar, allowed_codes=coded(polar.allowed_codes)),
    )


def shown(native_words: Mapping[str, str], code: str) -> str:
    """The native word for a code such as G13.1, or the code itself."""
    return next((word for word, text in native_words.items() if text == code), code)
