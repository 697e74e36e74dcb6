"""docs/machines/: a page for each machine, with how it is programmed and what is in doubt, and their index."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import msgspec

from generators.controls import shown
from generators.tables import GENERATED, row, rule_under
from polarcheck.program.machines import profiles
from polarcheck.program.machines.machine import Machine, meanings
from polarcheck.program.machines.parameters import Origin
from polarcheck.program.machines.profiles import Profile
from polarcheck.reports.pages.markdown import prose

#: The keys that a programmer looks up first, by heading.
_FIRST = {
    "The polar mode": (
        "polar.on",
        "polar.off",
        "polar.ended_by",
        "polar.words_beside_switch",
        "polar.virtual_axis",
        "polar.virtual_axis_incremental",
        "polar.virtual_axis_by_word",
        "polar.virtual_axis_programming",
        "polar.rotary_address",
        "polar.x",
        "polar.zero_angle",
        "polar.other_axes",
        "polar.feed_measures",
        "polar.repeated_z",
        "polar.plane_before",
        "polar.main_spindle_must_stop",
        "polar.infeed_word",
        "polar.allowed_codes",
        "feed.carried_into_polar",
        "feed.dwell_words",
        "feed.dwell_per_revolution",
    ),
    "The control": (
        "control.g_code_system",
        "control.units",
        "control.least_increment",
        "control.number_without_point",
        "control.x",
        "control.offset_digits",
        "control.line_comments",
        "control.channel_mark",
        "arcs.radius_word",
        "arcs.sweep_limit",
        "compensation.start_up",
        "compensation.read_ahead",
        "compensation.interference",
    ),
}


def pages() -> Iterator[tuple[str, str]]:
    """Yield path below docs/ and text of each page."""
    loaded = [profiles.load(name) for name in profiles.names()]
    yield "machines/index.md", index(loaded)
    for profile in loaded:
        yield f"machines/{profile.name}.md", page(profile, loaded)


def index(loaded: Sequence[Profile]) -> str:
    """Return the page that lists all machines, with links."""
    lines = ["# Machines", "", GENERATED, ""]
    lines += [
        "`--machine NAME` names one of these, `polarcheck machines NAME` shows it whole. Your own lathe is",
        "a file that inherits from one of them and says its limits:",
        f"`polarcheck machines new lathe3 --from {profiles.DEFAULT}`",
        "([a lathe of your own](../getting_started.md#your-own-lathe)). All values with their sources:",
        "[the controls](../controls.md).",
        "",
        *rule_under("machine", "title", "on, off", "virtual axis", "X in the mode", "inherits"),
    ]
    for profile in loaded:
        polar = profile.written.polar
        on, off = (" ".join(f"`{code}`" for code in codes) for codes in (polar.on, polar.off))
        inherits = " < ".join(f"[{name}]({name}.md)" for name in profile.chain[1:])
        title = profile.machine.title + (" (the default)" if profile.name == profiles.DEFAULT else "")
        link = f"[{profile.name}]({profile.name}.md)"
        lines.append(row(link, prose(title), f"{on}, {off or 'none'}", polar.virtual_axis, polar.x, inherits))
    return "\n".join(lines) + "\n"


def page(profile: Profile, loaded: Sequence[Profile]) -> str:
    """Return the page of one machine."""
    lines = [f"# {profile.name}", "", GENERATED, "", f"**{prose(profile.machine.title)}.**"]
    chain = " < ".join(f"[{name}]({name}.md)" for name in profile.chain[1:])
    heirs = ", ".join(f"[{heir.name}]({heir.name}.md)" for heir in loaded if profile.name in heir.chain[1:2])
    lines += [f"It inherits from {chain}: what it does not say itself is theirs."] if chain else []
    lines += [f"From it inherit {heirs}."] if heirs else []
    lines += ["", f"    polarcheck check --machine {profile.name} O1234.NC"]
    lines += [f"    polarcheck machines new lathe3 --from {profile.name}"]
    if profile.machine.notes:
        lines += ["", *(f"- {prose(note)}" for note in profile.machine.notes)]
    for heading, keys in _FIRST.items():
        lines += ["", f"## {heading}", "", *_table(profile, [key for key in keys if _is_said(profile, key)])]
    lines += ["", "## Limits", "", "`--set KEY=VALUE` or `[limits]` in polarcheck.toml says what your lathe has.", ""]
    lines += _table(profile, [f"limits.{key}" for key in profile.written.limits.__struct_fields__])
    lines += ["", "## Alarms", "", *_alarms(profile)]
    others = {f"g_code_system_{letter}" for letter in "abc" if letter != profile.written.control.g_code_system.lower()}
    doubtful = [key for key, origin in profile.origins.items() if origin.doubtful and "." in key]
    doubtful = [key for key in doubtful if key.partition(".")[0] not in others]
    lines += ["", "## In doubt", ""]
    lines += (
        [
            "What hangs on these gives warnings or notes, no errors. Look them up in the manual of your lathe, and say",
            "them in a machine file of your own.",
            "",
            *rule_under("key", "value", "source"),
            *(row(f"`{key}`", _value(profile, key), _source(profile, key)) for key in doubtful),
        ]
        if doubtful
        else ["Nothing."]
    )
    return "\n".join(lines) + "\n"


def _table(profile: Profile, keys: Sequence[str]) -> Iterator[str]:
    yield from rule_under("key", "value", "what it is", "source")
    for key in keys:
        yield row(f"`{key}`", _value(profile, key), prose(_meaning(key)), _source(profile, key))


def _is_said(profile: Profile, key: str) -> bool:
    value = _plain(profile, key)
    return value not in ("", [], {}) and not (isinstance(value, float) and math.isnan(value))


def _plain(profile: Profile, key: str) -> Any:
    group, _, last = key.partition(".")
    return msgspec.to_builtins(getattr(profile.written, group)).get(last)


def _value(profile: Profile, key: str) -> str:
    return prose(shown(_plain(profile, key), key.partition(".")[0]))


def _meaning(key: str) -> str:
    group, _, last = key.partition(".")
    table = next(field.type for field in msgspec.structs.fields(Machine) if field.name == group)
    return meanings(table).get(last, "")


def _source(profile: Profile, key: str) -> str:
    origin: Origin | None = profile.origins.get(key)
    if origin is None:
        return ""
    of = f"{origin.profile}: " if origin.profile != profile.name else ""
    return prose(f"{'? ' if origin.doubtful else ''}{of}{origin.source}")


def _alarms(profile: Profile) -> Iterator[str]:
    alarms: Mapping[str, str] = profile.machine.alarms
    if not alarms:
        yield "No numbers of alarms are known: findings name none."
        return
    by_alarm: dict[str, list[str]] = {}
    for name, alarm in alarms.items():
        by_alarm.setdefault(alarm, []).append(name)
    yield from ("`polarcheck explain` takes the number of an alarm, too.", "", *rule_under("alarm", "rules"))
    for alarm, names in sorted(by_alarm.items()):
        yield row(prose(alarm), ", ".join(f"`{name}`" for name in names))
