"""What G and M codes mean on a machine: from the lists of its profile, with the source of each."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from polarcheck.editor.analysis import Analysis
from polarcheck.foundation.errors import PolarcheckError
from polarcheck.foundation.states import STATES
from polarcheck.program.machines.code_lists import FRAME_LISTS, GCodes, GCodeSystem, expanded
from polarcheck.program.machines.m_codes import MCodes
from polarcheck.program.machines.machine import Machine, meanings
from polarcheck.program.machines.macro_keys import CODE_LISTS, Macro

#: The codes that switch the mode, in words for people.
_OF_POLAR = {
    "on": "polar coordinate interpolation on",
    "off": "polar coordinate interpolation off",
    "ended_by": "ends polar coordinate interpolation, too",
    "contours_outside": "cuts a contour outside the polar mode, with C in degrees; it is not simulated",
    "planes_not_simulated": "selects another plane in the polar mode, which is not simulated",
    "off_of_other_modes": "begins another mode, which is not simulated",
}
#: What the profile says of these lists is about the list; here it is what a code does.
_OF_KEYS = {
    "g_codes.scaling_off": "scaling off",
    "g_codes.rotation_off": "coordinate system rotation off",
    "g_codes.mirror_image_off": "mirror image off",
    "g_codes.c_axis_reference": "with C or H it takes the C axis to its reference point, the zero of its angle",
    "g_codes.constant_surface_speed_ended_by": "ends the constant surface speed, too",
    "g_codes.axis_words_no_move": "axis words beside it are no end point of a move",
    "g_codes.dwell": "dwell",
    "g_codes.feed_as_machine": "F is along what it is along on this machine without such codes",
    "g_codes.work_offset": "work coordinate system",
    "g_codes.work_offset_extended": "further work coordinate system, selected by the word beside it",
    "g_codes.sub_spindle": "the program is for the sub-spindle from here on",
    "g_codes.sub_spindle_off": "the program is for the main spindle from here on",
    "g_codes.motion_not_followed": "a way that is not simulated: an involute, a spline, a thread",
    "g_codes.feed_is_lead": "F is the lead of a thread, and no feed for later blocks",
    "m_codes.optional_stop": "optional stop",
    "m_codes.stops_reading_ahead": "the control does not read ahead of it",
    "macro.modal_macro_calls_each_block": "each block calls the macro, its words are the arguments, G codes too",
}
_PLURAL = re.compile(r"^(?:further )?codes that (call|end|return|begin)\b")
_CODES = re.compile(r"^codes (?:after|behind|beyond) which ")


class Meaning(NamedTuple):
    """
    What a code does.

    key: of the profile, as `g_codes.rapid`.
    text: in words for people.
    """

    key: str
    text: str


def meanings_of(code: str, machine: Machine) -> list[Meaning]:
    """Return what a code such as `G12.1` or `M35` does on a machine; empty if the profile does not say."""
    return _index(machine).get(code, [])


def is_known(code: str, machine: Machine) -> bool:
    """Return True for a G code of the control, and for an M code that the profile names."""
    return code in known_codes(machine)


def known_codes(machine: Machine) -> Mapping[str, str]:
    """Return all codes of the control, each with its meaning in one line; empty where the profile has none."""
    return machine.cached("codes of the editor", lambda: _known_codes(machine))


def _known_codes(machine: Machine) -> dict[str, str]:
    index = _index(machine)
    listed = [*expanded(machine.control.known_codes), *machine.listed_codes, *machine.polar.on, *machine.polar.off]
    texts = {code: "" for code in expanded(listed) if code[0] in "GM"}
    for code, of_code in index.items():
        texts[code] = "; ".join(meaning.text for meaning in of_code[:2])
    return texts


def source_of(key: str, analysis: Analysis) -> str:
    """Return the source of a key of the profile; empty if it has none."""
    if analysis.settings is None:
        return ""
    name, machine = analysis.settings.name, analysis.settings.machine
    return machine.cached("sources of the editor", lambda: _sources(name)).get(key, "")


def _sources(name: str) -> dict[str, str]:
    from polarcheck.program.machines import profiles

    try:
        return {key: origin.source for key, origin in profiles.load(name).origins.items() if origin.source}
    except PolarcheckError:
        return {}


def _index(machine: Machine) -> Mapping[str, list[Meaning]]:
    return machine.cached("meanings of the editor", lambda: _indexed(machine))


def _indexed(machine: Machine) -> dict[str, list[Meaning]]:
    by_code: dict[str, list[Meaning]] = {}
    for code, meaning in _listed(machine):
        if meaning.key == "g_codes.scaling_off" and code in machine.codes("coordinate_setting"):
            continue
        of_code = by_code.setdefault(code, [])
        if meaning not in of_code:
            of_code.append(meaning)
    return by_code


def _listed(machine: Machine) -> Iterator[tuple[str, Meaning]]:
    for key, text in _OF_POLAR.items():
        yield from _each_code(getattr(machine.polar, key), f"polar.{key}", text)
    for table, of_class in (("g_codes", GCodes), (machine.system_table, GCodeSystem), ("m_codes", MCodes)):
        texts = meanings(of_class)
        # What the group is about comes before what else a code does.
        keys = sorted(texts, key=lambda key: not any(key in states for states in STATES.values()))
        keys.sort(key=lambda key: key in ("constant_surface_speed_ended_by", "axis_words_no_move", "feed_is_lead"))
        for key in keys:
            if key not in FRAME_LISTS or getattr(getattr(machine, table), key):
                yield from _each_code(getattr(getattr(machine, table), key), f"{table}.{key}", texts[key])
    texts = meanings(Macro)
    for key in CODE_LISTS:
        yield from _each_code(getattr(machine.macro, key), f"macro.{key}", texts[key])
    for code, equivalent in machine.control.motion_codes.items():
        yield code, Meaning("control.motion_codes", f"{equivalent} of other controls")


def _each_code(codes: Iterable[object], key: str, text: str) -> Iterator[tuple[str, Meaning]]:
    table, _, name = key.partition(".")
    table = "g_codes" if table.startswith("g_code_") else table
    text = _OF_KEYS.get(f"{table}.{name}", text)
    singular = _CODES.sub("", _PLURAL.sub(lambda match: f"{match[1]}s", text))
    for code in expanded(code for code in codes if isinstance(code, str)):
        if code[:1] in ("G", "M"):
            stop = "program stop; " if (code, name) == ("M0", "stops_reading_ahead") else ""
            yield code.split(" ")[0], Meaning(key, stop + singular)
