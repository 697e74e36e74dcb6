"""The file for a lathe of the user's own: what to ask its builder, with a place for each answer."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator
from typing import Any

import msgspec

from polarcheck.machines.machine import meanings
from polarcheck.machines.parameters import Meaning
from polarcheck.machines.profiles import Profile, load
from polarcheck.reading.excerpt import visible

#: What no control's manual can know, each key with an answer as it may look.
_ASKED: dict[str, dict[str, Any]] = {
    "limits": {
        "c_feed": 3600,
        "c_acceleration": 7200,
        "polar_feed": 2000,
        "polar_feed_clamps": True,
        "automatic_override": True,
        "keep_out": 0.1,
        "x_minimum": -10.0,
        "x_maximum": 200.0,
        "z_minimum": -500.0,
        "z_maximum": 300.0,
    },
    "m_codes": {"c_axis_on": ["M35"], "c_axis_off": ["M34"], "live_tool_on": ["M33"], "live_tool_off": ["M5"]},
    "feed": {
        "cutting_minimum": 25,
        "cutting_maximum": 250,
        "positioning_minimum": 750,
        "positioning_maximum": 1500,
    },
}
_COLUMNS = 100


def text(name: str, inherits: str) -> str:
    """
    A TOML file for a lathe of this name that inherits from a machine; every answer is left out, and can be filled in.

    Raises MachineError for an unknown machine.
    """
    profile = load(inherits)
    lines = [
        *_prose(
            f"{name}: a lathe of our own. All that is not said here is as on {profile.machine.title}. Take the # away"
            " from a line to answer it; give a source with { value = ..., source = ... } if you like.",
        ),
        f"inherits = {_toml(inherits)}",
        f"title = {_toml(name)}",
        *_limits(profile),
        *_doubtful(profile),
        *_parameters(profile),
    ]
    # What comes from another file is data here, too: a line end in it would end the comment.
    return "\n".join(map(visible, lines)) + "\n"


def _limits(profile: Profile) -> Iterator[str]:
    for group, keys in _ASKED.items():
        yield from ("", f"[{group}]")
        meaning = meanings(type(getattr(profile.written, group)))
        for key, answer in keys.items():
            yield from _answer(key, answer, meaning[key])
        yield from _in_doubt(profile, group, set(keys))


def _doubtful(profile: Profile) -> Iterator[str]:
    """What the profile itself is not sure of."""
    table = msgspec.to_builtins(profile.written)
    for group, values in table.items():
        of_other_system = group.startswith("g_code_system_") and group != profile.machine.system_table
        asked_elsewhere = (*_ASKED, "known_parameters", "parameters", "alarms")
        if isinstance(values, dict) and group not in asked_elsewhere and not of_other_system:
            found = list(_in_doubt(profile, group, set()))
            if found:
                yield from ("", f"[{group}]", *found)


def _in_doubt(profile: Profile, group: str, told: set[str]) -> Iterator[str]:
    """The keys of a table that are in doubt and not among those told, each doubt once."""
    table = getattr(profile.written, group)
    meaning = meanings(type(table))
    said = ""
    for key, value in msgspec.to_builtins(table).items():
        origin = profile.origins.get(f"{group}.{key}")
        if origin and origin.doubtful and key not in told:
            if origin.source != said:
                yield from _prose(f"in doubt: {origin.source}")
            said = origin.source
            yield from _answer(key, value, meaning.get(key, ""))


def _answer(key: str, value: Any, meaning: str) -> Iterator[str]:
    """A key and its value, left out, with what it means behind it or, where that is too long, above it."""
    line = f"#{_toml_key(key)} = {_toml(value)}"
    is_short = len(line) + len(meaning) + 4 <= _COLUMNS
    if meaning and not is_short:
        yield f"# {meaning}"
    yield f"{line}  # {meaning}" if meaning and is_short else line


def _parameters(profile: Profile) -> Iterator[str]:
    """The control parameters that can be copied from the screen."""
    if not profile.machine.known_parameters:
        return
    yield from ("", "[parameters]", *_prose("as the control shows them; each sets the values that it stands for"))
    for name, meaning in profile.machine.known_parameters.items():
        example = _present(profile, meaning) or next(iter(meaning.values), "3600")
        number = example.isascii() and example.replace(".", "").isdecimal()
        yield f"#{_toml(name)} = {example if number else _toml(example)}  # {meaning.title}"


def _present(profile: Profile, meaning: Meaning) -> str:
    """What a parameter would be on the machine as its profile is; empty where that is not one number."""
    group, _, key = meaning.key.partition(".")
    value = getattr(getattr(profile.machine, group, None), key, None) if key else None
    if isinstance(value, bool) or not isinstance(value, int | float) or not meaning.factor or math.isnan(value):
        return ""
    return f"{value / meaning.factor:g}"


def _prose(text: str) -> list[str]:
    return [f"# {line}" for line in textwrap.wrap(text, _COLUMNS - 2)]


def _toml_key(key: str) -> str:
    return key if key.isascii() and key.replace("_", "").replace("-", "").isalnum() else _toml(key)


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        inside = ", ".join(f"{_toml(key)} = {_toml(element)}" for key, element in value.items())
        return f"{{ {inside} }}" if inside else "{ }"
    # JSON lets stand as it is what TOML does not, and what acts on a terminal.
    return "".join(
        character if character.isprintable() else f"\\U{ord(character):08x}"
        for character in msgspec.json.encode(value).decode()
    )
