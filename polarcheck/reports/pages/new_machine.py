"""The file for a lathe of the user's own: what to ask its builder, with a place for each answer."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator
from typing import Any

import msgspec

from polarcheck.machines.parameters import Meaning
from polarcheck.machines.profiles import Profile, load

#: What no control's manual can know, with an answer as it may look.
_ASKED: dict[str, dict[str, tuple[Any, str]]] = {
    "limits": {
        "c_feed": (3600, "largest cutting feed of the C axis [deg/min]; 100 turns a minute are 36000"),
        "c_acceleration": (7200, "largest acceleration of the C axis [deg/s2]"),
        "polar_feed": (2000, "largest cutting feed in the polar mode [mm/min]"),
        "automatic_override": (True, "the control slows down by itself where C would turn too fast"),
        "keep_out": (0.1, "how far the tool center should stay away from the center of C [mm]"),
        "x_minimum": (-10.0, "travel of X [mm, radius]"),
        "x_maximum": (200.0, "travel of X [mm, radius]"),
        "z_minimum": (-500.0, "travel of Z [mm]"),
        "z_maximum": (300.0, "travel of Z [mm]"),
    },
    "m_codes": {
        "c_axis_on": (["M35"], "the spindle becomes the C axis"),
        "c_axis_off": (["M34"], "the C axis becomes the spindle"),
        "live_tool_on": (["M33"], "the live tool turns, if it has codes of its own"),
        "live_tool_off": (["M5"], "the live tool stops"),
    },
    "feed": {
        "cutting_minimum": (25, "feeds that the builder recommends for cutting [mm/min]"),
        "cutting_maximum": (250, "feeds that the builder recommends for cutting [mm/min]"),
        "positioning_minimum": (750, "feeds that the builder recommends for positioning in the mode [mm/min]"),
        "positioning_maximum": (1500, "feeds that the builder recommends for positioning in the mode [mm/min]"),
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
    return "\n".join(lines) + "\n"


def _limits(profile: Profile) -> Iterator[str]:
    for group, keys in _ASKED.items():
        yield from ("", f"[{group}]")
        for key, (answer, text) in keys.items():
            yield f"#{key} = {_toml(answer)}  # {text}"
        yield from _in_doubt(profile, group, set(keys))


def _doubtful(profile: Profile) -> Iterator[str]:
    """What the profile itself is not sure of."""
    table = msgspec.to_builtins(profile.machine)
    for group, values in table.items():
        if isinstance(values, dict) and group not in (*_ASKED, "meanings", "parameters", "alarms"):
            found = list(_in_doubt(profile, group, set()))
            if found:
                yield from ("", f"[{group}]", *found)


def _in_doubt(profile: Profile, group: str, told: set[str]) -> Iterator[str]:
    values = msgspec.to_builtins(getattr(profile.machine, group))
    for key, value in values.items():
        origin = profile.origins.get(f"{group}.{key}")
        if origin and origin.doubtful and key not in told:
            yield from _prose(f"in doubt: {origin.source}")
            yield f"#{_toml_key(key)} = {_toml(value)}"


def _parameters(profile: Profile) -> Iterator[str]:
    """The control parameters that can be copied from the screen."""
    if not profile.machine.meanings:
        return
    yield from ("", "[parameters]", *_prose("as the control shows them; each sets the values that it stands for"))
    for name, meaning in profile.machine.meanings.items():
        example = _present(profile, meaning) or next(iter(meaning.values), "3600")
        number = example.replace(".", "").isdecimal()
        yield f"#{_toml(name)} = {example if number else _toml(example)}  # {meaning.title}"


def _present(profile: Profile, meaning: Meaning) -> str:
    """What a parameter would be on the machine as its profile is; empty where that is not one number."""
    group, _, key = meaning.key.partition(".")
    value = getattr(getattr(profile.machine, group), key) if key else math.nan
    return "" if math.isnan(value) else f"{value / meaning.factor:g}"


def _prose(text: str) -> list[str]:
    return [f"# {line}" for line in textwrap.wrap(text, _COLUMNS - 2)]


def _toml_key(key: str) -> str:
    return key if key.replace("_", "").replace("-", "").isalnum() else _toml(key)


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        inside = ", ".join(f"{_toml(key)} = {_toml(element)}" for key, element in value.items())
        return f"{{ {inside} }}" if inside else "{ }"
    return msgspec.json.encode(value).decode()
