"""Manual pages, the catalogue of rules, and machine profiles, as text for a terminal."""

from __future__ import annotations

import importlib
import math
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any

import msgspec

from polarcheck.program.machines import profiles
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.own_language import shown
from polarcheck.program.machines.profiles import Profile
from polarcheck.program.reading.excerpt import visible
from polarcheck.rules.vocabulary import kinds

if TYPE_CHECKING:
    from polarcheck.program.machines.parameters import Origin
    from polarcheck.rules.rule import Rule

_COLUMNS = 100
#: The column where the comments of a profile begin.
_COMMENT = 36


def pages(rules: Iterable[Rule], machine: Machine) -> str:
    """Return the manual pages of rules, each under a line with its name, group, severity, and alarm on this machine."""
    return "\n\n".join(_page(rule, machine) for rule in rules) + "\n"


def alarm_pages(rules: Sequence[Rule], count: int, machine: Machine) -> str:
    """Return the manual pages of the first rules of an alarm, and a list of the others that give it."""
    text = pages(rules[:count], machine)
    remaining = rules[count:]
    if not remaining:
        return text
    width = max(len(rule.name) for rule in remaining)
    alarm = visible(machine.alarms[remaining[0].name])
    listed = "".join(f"  {rule.name:<{width}}  {rule.title}\n" for rule in remaining)
    return f"{text}\n{alarm} also stands for, each with a page of its own (polarcheck explain NAME):\n\n{listed}"


def _page(rule: Rule, machine: Machine) -> str:
    alarm = visible(machine.alarms.get(rule.name, ""))
    facts = [rule.group, rule.level(machine.severities)]
    facts += [f"alarm {alarm} on {visible(machine.title)}"] if alarm else []
    head = f"{rule.name} ({', '.join(facts)})"
    return "\n\n".join([f"{head}\n{'=' * len(head)}", *_other_words(rule, machine), rule.page.strip()])


def _other_words(rule: Rule, machine: Machine) -> Iterator[str]:
    """Yield a remark for a page that uses the codes of the default machine, if this machine has other codes."""
    usual, polar = profiles.load(profiles.DEFAULT).machine, machine.polar
    if usual.polar.on[0] not in rule.page:
        return
    begins, ends = (shown(machine.control.native_words, codes[0]) for codes in (polar.on, polar.off))
    words = [] if begins == usual.polar.on[0] else [f"from {begins} to {ends}"]
    if polar.virtual_axis != usual.polar.virtual_axis:
        words.append(f"with {polar.virtual_axis} as its virtual axis")
    if polar.x != usual.polar.x:
        words.append(f"with X as a {polar.x}")
    if words:
        programmed = f"On {visible(machine.title)} the mode is programmed {', '.join(words)}."
        text = f"{programmed} Examples without a machine are those of "
        yield "\n".join(
            textwrap.wrap(f"{text}{usual.title}, with {usual.polar.virtual_axis} as the virtual axis.", _COLUMNS)
        )


def catalogue(rules: Mapping[str, Rule]) -> str:
    """Return all rules by group: severity, name, title."""
    width = max((len(name) for name in rules), default=0)
    lines = []
    group = ""
    for rule in rules.values():
        if rule.group != group:
            group = rule.group
            about = importlib.import_module(f"polarcheck.rules.{group}").__doc__ or ""
            lines += ["", f"{group}: {about.strip()}"]
        lines.append(f"  {rule.severity.name.lower():<7}  {rule.name:<{width}}  {rule.title}")
    return "\n".join(lines[1:]) + "\n"


def catalogue_json(rules: Mapping[str, Rule]) -> str:
    """Return all rules as a JSON array."""
    entries = [
        {
            "name": rule.name,
            "group": rule.group,
            "severity": rule.severity.name.lower(),
            "title": rule.title,
            "source": rule.source,
            "values": {name: kind.value for name, kind in kinds(rule.values).items()},
        }
        for rule in rules.values()
    ]
    return msgspec.json.format(msgspec.json.encode(entries), indent=2).decode() + "\n"


# ---- machines ----


def machine_list() -> str:
    """Return the built-in machines: name, title, and the profiles from which each inherits."""
    loaded = [profiles.load(name) for name in profiles.names()]
    rows = []
    for profile in loaded:
        default = ", the default" if profile.name == profiles.DEFAULT else ""
        rows.append(
            (profile.name, profile.machine.title + default, "".join(f"< {name} " for name in profile.chain[1:]))
        )
    first, second = (max(len(row[column]) for row in rows) for column in (0, 1))
    return "".join(f"{name:<{first}}  {title:<{second}}  {chain}".rstrip() + "\n" for name, title, chain in rows)


def profile_text(profile: Profile) -> str:
    """Return the merged profile as TOML, each value with the profile that sets it and its source."""
    lines = [
        f"# {visible(' < '.join(profile.chain))}",
        "# Each value with the profile that it comes from and its source. ? marks what may be different on",
        "# your lathe: see its manuals. nan is not known, and what needs it is not evaluated.",
        "# Change a value with --set TABLE.KEY=VALUE, or in a profile of your own that inherits this one.",
        "",
    ]
    table = {name: getattr(profile.written, name) for name in profile.written.__struct_fields__}
    parameters, notes = table.pop("known_parameters", {}), table.pop("notes", [])
    for note in notes:
        lines += textwrap.wrap(visible(note), _COLUMNS, initial_indent="# - ", subsequent_indent="#   ")
    lines += [""] if notes else []
    groups = {
        name: msgspec.to_builtins(table.pop(name)) for name in list(table) if not isinstance(table[name], str | list)
    }
    for key, value in table.items():
        lines += _entry(key, value, profile.origins.get(key))
    for group, values in groups.items():
        lines += ["", f"[{group}]"] if values else []
        for key, value in values.items():
            lines += _entry(key, value, profile.origins.get(f"{group}.{key}"))
    if parameters:
        lines += ["", "# Parameters of the control that the table [parameters] of a profile of your own may give:"]
        lines += [visible(f"#   {number:<8}{meaning.title}") for number, meaning in parameters.items()]
    return "\n".join(lines) + "\n"


def _entry(key: str, value: Any, origin: Origin | None) -> Iterator[str]:
    """Yield `key = value  # profile: source`, on several lines if it is long."""
    *first, last = _assignment(key, value)
    yield from map(visible, first)
    comment = [f"# {visible(line)}" for line in textwrap.wrap(_source(value, origin), _COLUMNS - _COMMENT - 2)]
    if len(last) >= _COMMENT - 1 and (len(comment) > 1 or len(last) + len(comment[0]) > _COLUMNS - 2):
        yield visible(last)
        last = ""
    for line in comment:
        yield f"{visible(last):<{_COMMENT - 2}}  {line}"
        last = ""


def _source(value: Any, origin: Origin | None) -> str:
    if origin is None:
        return "not known" if isinstance(value, float) and math.isnan(value) else "where no profile says otherwise"
    text = f"{origin.profile}: {origin.source}" if origin.source else origin.profile
    return f"? {text}" if origin.doubtful else text


def _assignment(key: str, value: Any) -> list[str]:
    """Return the lines of `key = value`; a list is broken between its elements."""
    if isinstance(value, dict):
        return [f"{_toml_key(key)} = {{ value = {_toml(value)} }}"]
    if not isinstance(value, list):
        return [f"{_toml_key(key)} = {_toml(value)}"]
    lines = [f"{_toml_key(key)} = ["]
    for index, element in enumerate(value):
        text = _toml(element) + ("," if index + 1 < len(value) else "")
        if len(lines[-1]) + len(text) + 2 > _COLUMNS:
            lines.append("   ")
        lines[-1] += text if lines[-1].endswith("[") else f" {text}"
    lines[-1] += "]"
    return lines


def _toml_key(key: Any) -> str:
    return str(key) if re.fullmatch(r"[\w-]+", str(key), re.ASCII) else _toml(str(key))


def _toml(value: Any) -> str:
    if isinstance(value, dict) and value:
        return f"{{ {', '.join(f'{_toml_key(key)} = {_toml(element)}' for key, element in value.items())} }}"
    return str(value) if isinstance(value, float) and not math.isfinite(value) else msgspec.json.encode(value).decode()
