"""`polarcheck machines check FILE`: says if a machine file is sound, which values have no effect, and what is open."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from typing import TYPE_CHECKING, Any

from polarcheck.program.machines.code_lists import expanded, is_code
from polarcheck.program.machines.m_codes import SWITCHED
from polarcheck.program.machines.machine import Machine, meanings
from polarcheck.program.machines.profiles import Profile, names
from polarcheck.program.machines.written_codes import is_list, without_effect
from polarcheck.program.reading.excerpt import head, visible

if TYPE_CHECKING:
    from polarcheck.rules.rule import Rule

#: Keys that matter, and that the manual of a control cannot answer.
_OPEN_KEYS = (
    *("limits.c_feed", "limits.c_acceleration", "limits.polar_feed", "limits.x_minimum", "limits.x_maximum"),
    *("limits.z_minimum", "limits.z_maximum"),
    *("m_codes.c_axis_on", "m_codes.c_axis_off", "m_codes.live_tool_on", "m_codes.live_tool_off"),
    "power_on.feed_mode",
)
#: Keys that have no effect beside another value: the key, the condition, the reason.
_OVERRULED: tuple[tuple[str, Callable[[Machine], bool], str], ...] = (
    (
        "limits.polar_feed_clamps",
        lambda machine: math.isnan(machine.limits.polar_feed),
        "limits.polar_feed is not known",
    ),
    ("limits.override_share", lambda machine: not machine.limits.automatic_override, "automatic_override is false"),
    ("limits.c_feed_harmless", lambda machine: not math.isnan(machine.limits.c_feed), "limits.c_feed is known"),
    ("limits.c_feed_suspicious", lambda machine: not math.isnan(machine.limits.c_feed), "limits.c_feed is known"),
    ("polar.linear_address", lambda machine: bool(machine.control.axes), "control.axes names the axes"),
    (
        "compensation.start_up_with_move",
        lambda machine: machine.compensation.start_up != "C",
        "it counts beside compensation.start_up = C alone",
    ),
)
_SYSTEMS = ("g_code_system_a", "g_code_system_b", "g_code_system_c")
#: Lists of M codes that switch something on.
_BEGIN = tuple(on for on, _ in SWITCHED)


def text(profile: Profile, rules: Mapping[str, Rule]) -> str:
    """
    Return a line that says that the file is sound, and remarks. A file that could be loaded is sound.

    rules: the rules by name, which the keys of [alarms] and [severities] refer to.
    """
    ancestry = f"inherits {' < '.join(profile.chain[1:])}, " if profile.chain[1:] else ""
    count = len(list(_own_values(profile)))
    doubts = [key for key, origin in profile.origins.items() if origin.doubtful]
    in_doubt = f"{len(doubts)}, marked with ? by `polarcheck machines {profile.name}`" if doubts else "none"
    values = "1 value of its own" if count == 1 else f"{count} values of its own"
    lines = [f"{head(profile.name)}: sound, {ancestry}{values}; in doubt: {in_doubt}"]
    remarks = _remarks(profile, rules) if profile.chain[0] not in names() else ()
    for title, entries in (("to look at", remarks), ("still to be answered", _open(profile))):
        listed = [f"  {line}" for line in entries]
        lines += [f"{title}:", *listed] if listed else []
    return "\n".join(map(visible, lines)) + "\n"


def _own_values(profile: Profile) -> Iterator[tuple[str, Any]]:
    """Yield key and value of what the file itself sets."""
    for group, values in profile.told.items():
        if isinstance(values, Mapping):
            for key, value in values.items():
                if key not in ("source", "doubtful"):
                    yield f"{group}.{key}", value["value"] if isinstance(value, Mapping) and "value" in value else value


def _remarks(profile: Profile, rules: Mapping[str, Rule]) -> Iterator[str]:
    values = dict(_own_values(profile))
    yield from _shared_codes(profile.machine, values)
    for on, off in SWITCHED:
        if f"m_codes.{off}" in values and not getattr(profile.machine.m_codes, on):
            yield f"m_codes.{off}: without m_codes.{on} it has no effect"
    yield from _not_known(profile.machine, values)
    for key, value in values.items():
        if is_list(key):
            group, _, name = key.partition(".")
            for change in without_effect(value, profile.inherited.get(group, {}).get(name)):
                listed = "is inherited" if change[0] == "+" else "is not inherited"
                yield f"{key}: {change} has no effect: {change[1:].strip()} {listed}"
    yield from _overruled(profile, values)
    yield from _of_rules(profile.machine, values, rules)


def _shared_codes(machine: Machine, values: Mapping[str, Any]) -> Iterator[str]:
    """Yield M codes that switch on two things, if the file itself lists one of them."""
    for first, second in combinations(_BEGIN, 2):
        keys = f"m_codes.{first}", f"m_codes.{second}"
        listed = getattr(machine.m_codes, first), getattr(machine.m_codes, second)
        if set(keys) & set(values):
            for code in listed[0]:
                if code in listed[1]:
                    yield f"{keys[0]}: {code} is in {keys[1]}, too{_as_live_tool(first, second, code)}"


def _as_live_tool(first: str, second: str, code: str) -> str:
    if {first, second} != {"live_tool_on", "spindle_on"}:
        return ""
    return f'; it is read as the live tool alone: spindle_on = ["-{code}"] says so'


def _not_known(machine: Machine, values: Mapping[str, Any]) -> Iterator[str]:
    """Yield codes that are allowed in the mode, but unknown to the control."""
    if "polar.allowed_codes" in values:
        codes = set(expanded(filter(is_code, (*machine.control.known_codes, *machine.listed_codes))))
        for code in expanded(machine.polar.allowed_codes):
            if code not in codes:
                yield f"polar.allowed_codes: {code} is no code of this control: it is in no list, nor in known_codes"


def _overruled(profile: Profile, values: Mapping[str, Any]) -> Iterator[str]:
    machine = profile.machine
    for key, is_so, reason in _OVERRULED:
        if key in values and is_so(machine):
            yield f"{key}: it has no effect: {reason}"
    for group in _SYSTEMS:
        if group != machine.system_table and any(key.startswith(f"{group}.") for key in values):
            yield f"[{group}]: it has no effect: control.g_code_system is {machine.control.g_code_system}"
    for name, meaning in machine.known_parameters.items():
        if f"parameters.{name}" in values:
            sets = {meaning.key, *(key for listed in meaning.values.values() for key in listed)} & set(values)
            for key in sorted(sets):
                yield f"parameters.{name}: it does not set {key}: the file gives that itself"


def _of_rules(machine: Machine, values: Mapping[str, Any], rules: Mapping[str, Rule]) -> Iterator[str]:
    alarms = set(machine.alarms.values())
    for key in values:
        table, _, name = key.partition(".")
        if table == "alarms" and rules[name].level(machine.severities) == "off":
            yield f"{key}: it has no effect: severities.{name} is off"
        if table == "alarm_codes" and name not in alarms:
            yield f"{key}: it has no effect: no rule has this alarm in [alarms]"


def _open(profile: Profile) -> Iterator[str]:
    for key in _OPEN_KEYS:
        group, _, name = key.partition(".")
        table = getattr(profile.machine, group)
        value = getattr(table, name)
        if value != value or value in ([], ""):
            yield f"{key}: {meanings(type(table))[name]}"
