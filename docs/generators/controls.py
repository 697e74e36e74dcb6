"""
docs/controls.md: each control and each of its properties, with its source.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import msgspec

from polarcheck.program.machines import profiles
from polarcheck.program.machines.machine import Machine, meanings
from polarcheck.program.machines.parameters import Origin
from polarcheck.program.machines.profiles import Profile

_COLUMNS = (
    "polar.on",
    "polar.off",
    "polar.virtual_axis",
    "polar.x",
    "arcs.radius_word",
    "polar.plane_before",
    "feed.carried_into_polar",
    "polar.infeed_word",
    "control.g_code_system",
    "control.number_without_point",
)

#: Tables whose keys are those of [g_code_system_a].
_SAME_KEYS = ("g_code_system_b", "g_code_system_c")


def text() -> str:
    """Return the whole page."""
    loaded = [profiles.load(name) for name in profiles.names()]
    lines = [
        "# The controls",
        "",
        "Made from the profiles under `polarcheck/program/machines`; `polarcheck machines NAME` shows one whole.",
        "What a profile does not say itself it inherits. `?` marks what is in doubt; a rule that hangs on it gives",
        "warnings or notes, no errors.",
        "",
        "## At a glance",
        "",
        *_overview(loaded),
    ]
    for profile in loaded:
        lines += ["", f"## {profile.name}", "", *properties(profile)]
    lines += ["", "## What the keys mean", "", *_keys()]
    return "\n".join(lines) + "\n"


def _keys() -> Iterator[str]:
    yield row("key", "meaning")
    yield row("---", "---")
    for field in msgspec.structs.fields(Machine):
        if isinstance(field.type, type) and issubclass(field.type, msgspec.Struct) and field.name not in _SAME_KEYS:
            for key, meaning in meanings(field.type).items():
                yield row(f"`{field.name}.{key}`", meaning)
    for key, meaning in meanings(Machine).items():
        yield row(f"`{key}`", meaning)


def _overview(loaded: list[Profile]) -> Iterator[str]:
    yield row("control", *_COLUMNS)
    yield row(*["---"] * (len(_COLUMNS) + 1))
    for profile in loaded:
        yield row(f"[{profile.name}](#{profile.name})", *(_value(profile, key) for key in _COLUMNS))


def _value(profile: Profile, key: str) -> str:
    group, _, last = key.partition(".")
    origin = profile.origins.get(key)
    mark = " ?" if origin and origin.doubtful else ""
    return f"{shown(getattr(getattr(profile.written, group), last))}{mark}"


def properties(profile: Profile) -> Iterator[str]:
    """Yield the section of a profile: title, notes, and each value that it sets itself, with the source."""
    yield f"{profile.machine.title}. " + (f"Inherits {' < '.join(profile.chain[1:])}." if profile.chain[1:] else "")
    for note in profile.machine.notes:
        yield from ("", f"- {note}")
    origins = {key: origin for key, origin in profile.origins.items() if origin.profile == profile.name and "." in key}
    if origins:
        yield from ("", row("property", "value", "source"), row("---", "---", "---"))
    table = msgspec.to_builtins(profile.written)
    for key, origin in origins.items():
        group, _, last = key.partition(".")
        yield row(f"`{key}`", shown(table[group][last], group), source_of(origin))


def source_of(origin: Origin) -> str:
    """Return the source of a value, preceded by a mark if the value is in doubt."""
    return f"{'? ' if origin.doubtful else ''}{origin.source}"


def shown(value: Any, group: str = "") -> str:
    """Return a value as text for a page."""
    if group == "known_parameters":
        return str(value["title"])
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return "not known" if math.isnan(value) else f"{value:g}"
    if isinstance(value, dict):
        elements = ((key, " ".join(of) if isinstance(of, list | tuple) else of) for key, of in value.items())
        return ", ".join(f"{key} = {element or 'nothing'}" for key, element in elements) or "none"
    if isinstance(value, list | tuple):
        spans = (f"{each[0]}-{each[1]}" if isinstance(each, list | tuple) else str(each) for each in value)
        return ", ".join(spans) or "none"
    return str(value) or "none"


def row(*cells: str) -> str:
    """Return a row of a Markdown table."""
    return f"| {' | '.join(cell.replace('|', '&#124;') for cell in cells)} |"
