"""`polarcheck machines check FILE`: whether a machine file is sound, what has no effect in it, what is still open."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from itertools import combinations
from typing import TYPE_CHECKING, Any

from polarcheck.machines.code_lists import expanded, is_code
from polarcheck.machines.m_codes import SWITCHED
from polarcheck.machines.machine import Machine, meanings
from polarcheck.machines.profiles import Profile, names
from polarcheck.machines.written_codes import is_list, without_effect
from polarcheck.reading.excerpt import visible

if TYPE_CHECKING:
    from polarcheck.checking.rule import Rule

#: What no manual of a control tells, and much hangs on.
_ASKED = (
    *("limits.c_feed", "limits.c_acceleration", "limits.polar_feed", "limits.x_minimum", "limits.x_maximum"),
    *("limits.z_minimum", "limits.z_maximum"),
    *("m_codes.c_axis_on", "m_codes.c_axis_off", "m_codes.live_tool_on", "m_codes.live_tool_off"),
    "power_on.feed_mode",
)
#: Values beside which others have no effect: those, whether it is so, and the reason.
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
#: Lists of M codes that begin something.
_BEGIN = tuple(on for on, _ in SWITCHED)


def text(profile: Profile, rules: Mapping[str, Rule]) -> str:
    """
    One line that the file is sound, which it is if it could be loaded, and what else is to be said of it.

    rules: by name, for what they are listed with.
    """
    behind = f"inherits {' < '.join(profile.chain[1:])}, " if profile.chain[1:] else ""
    own = len(list(_own(profile)))
    doubts = [key for key, origin in profile.origins.items() if origin.doubtful]
    in_doubt = f"{len(doubts)}, marked with ? by `polarcheck machines {profile.name}`" if doubts else "none"
    values = "1 value of its own" if own == 1 else f"{own} values of its own"
    lines = [f"{profile.name}: sound, {behind}{values}; in doubt: {in_doubt}"]
    remarks = _remarks(profile, rules) if profile.chain[0] not in names() else ()
    for title, found in (("to look at", remarks), ("still to be answered", _open(profile))):
        told = [f"  {line}" for line in found]
        lines += [f"{title}:", *told] if told else []
    return "\n".join(map(visible, lines)) + "\n"


def _own(profile: Profile) -> Iterator[tuple[str, Any]]:
    """The values that the file itself gives, by key."""
    for group, values in profile.told.items():
        if isinstance(values, Mapping):
            for key, value in values.items():
                if key not in ("source", "doubtful"):
                    yield f"{group}.{key}", value["value"] if isinstance(value, Mapping) and "value" in value else value


def _remarks(profile: Profile, rules: Mapping[str, Rule]) -> Iterator[str]:
    own = dict(_own(profile))
    yield from _shared_codes(profile.machine, own)
    for on, off in SWITCHED:
        if f"m_codes.{off}" in own and not getattr(profile.machine.m_codes, on):
            yield f"m_codes.{off}: without m_codes.{on} it has no effect"
    yield from _not_known(profile.machine, own)
    for key, value in own.items():
        if is_list(key):
            group, _, name = key.partition(".")
            for change in without_effect(value, profile.inherited.get(group, {}).get(name)):
                listed = "is inherited" if change[0] == "+" else "is not inherited"
                yield f"{key}: {change} has no effect: {change[1:].strip()} {listed}"
    yield from _overruled(profile, own)
    yield from _of_rules(profile.machine, own, rules)


def _shared_codes(machine: Machine, own: Mapping[str, Any]) -> Iterator[str]:
    """M codes that begin two things, as far as the file itself says so."""
    for first, second in combinations(_BEGIN, 2):
        keys = f"m_codes.{first}", f"m_codes.{second}"
        listed = getattr(machine.m_codes, first), getattr(machine.m_codes, second)
        if set(keys) & set(own):
            for code in listed[0]:
                if code in listed[1]:
                    yield f"{keys[0]}: {code} is in {keys[1]}, too{_as_live_tool(first, second, code)}"


def _as_live_tool(first: str, second: str, code: str) -> str:
    if {first, second} != {"live_tool_on", "spindle_on"}:
        return ""
    return f'; it is read as the live tool alone: spindle_on = ["-{code}"] says so'


def _not_known(machine: Machine, own: Mapping[str, Any]) -> Iterator[str]:
    """Codes that are allowed in the mode, and that the control does not have."""
    if "polar.allowed_codes" in own:
        known = set(expanded(filter(is_code, (*machine.control.known_codes, *machine.listed_codes))))
        for code in expanded(machine.polar.allowed_codes):
            if code not in known:
                yield f"polar.allowed_codes: {code} is no code of this control: it is in no list, nor in known_codes"


def _overruled(profile: Profile, own: Mapping[str, Any]) -> Iterator[str]:
    machine = profile.machine
    for key, is_so, reason in _OVERRULED:
        if key in own and is_so(machine):
            yield f"{key}: it has no effect: {reason}"
    for group in _SYSTEMS:
        if group != machine.system_table and any(key.startswith(f"{group}.") for key in own):
            yield f"[{group}]: it has no effect: control.g_code_system is {machine.control.g_code_system}"
    for name, meaning in machine.known_parameters.items():
        if f"parameters.{name}" in own:
            sets = {meaning.key, *(key for values in meaning.values.values() for key in values)} & set(own)
            for key in sorted(sets):
                yield f"parameters.{name}: it does not set {key}: the file gives that itself"


def _of_rules(machine: Machine, own: Mapping[str, Any], rules: Mapping[str, Rule]) -> Iterator[str]:
    shown = set(machine.alarms.values())
    for key in own:
        table, _, name = key.partition(".")
        if table == "alarms" and rules[name].level(machine.severities) == "off":
            yield f"{key}: it has no effect: severities.{name} is off"
        if table == "alarm_codes" and name not in shown:
            yield f"{key}: it has no effect: no rule has this alarm in [alarms]"


def _open(profile: Profile) -> Iterator[str]:
    for key in _ASKED:
        group, _, name = key.partition(".")
        table = getattr(profile.machine, group)
        value = getattr(table, name)
        if value != value or value in ([], ""):
            yield f"{key}: {meanings(type(table))[name]}"
