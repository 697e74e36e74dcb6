"""Machine profiles: read from TOML, each inheriting from another, every value with its source."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_origin

import msgspec

from polarcheck.errors import MachineError
from polarcheck.machines import parameters
from polarcheck.machines.machine import Machine
from polarcheck.machines.parameters import Origin

FOLDER = Path(__file__).parent
DEFAULT = "fanuc"


class Profile(msgspec.Struct, frozen=True):
    """A machine with the name it was asked for by, its chain of inheritance, and the origin of each value."""

    name: str
    machine: Machine
    chain: tuple[str, ...]
    origins: Mapping[str, Origin]


def names() -> list[str]:
    """The built-in machines."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


def load(name: str, changes: Mapping[str, Any] | None = None) -> Profile:
    """
    The profile of a built-in machine or of a TOML file of the user's own; changes are merged over it.

    Raises MachineError, naming the file and the key, for an unknown machine, key, type or circle of inheritance.
    """
    tables: list[tuple[str, dict[str, Any]]] = []
    asked: str | None = name
    folder = Path()
    while asked is not None:
        path, title = _find(asked, folder)
        if any(title == seen for seen, _ in tables):
            raise MachineError(f"{title}: inherits from itself")
        table = _read(path, title)
        tables.append((title, table))
        folder = path.parent
        asked = table.pop("inherits", None)
        if asked is not None and not isinstance(asked, str):
            raise MachineError(f"{title}: inherits: expected the name of a machine")
    merged: dict[str, Any] = {}
    origins: dict[str, Origin] = {}
    if changes:
        tables.insert(0, ("the command line or job", dict(changes)))
    for title, table in reversed(tables):
        _replace(merged, table.pop("replaces", []), title, origins)
        _merge(merged, table, title, origins)
        if isinstance(table.get("parameters"), Mapping):
            # After the values of farther profiles, before those of nearer ones: the nearest word counts.
            parameters.apply(merged, table, title, origins)
    tables = tables[1:] if changes else tables
    return Profile(name, _convert(merged, origins, tables[0][0]), tuple(title for title, _ in tables), origins)


def _find(name: str, folder: Path) -> tuple[Path, str]:
    built_in = FOLDER / f"{name}.toml"
    if name in names():
        return built_in, name
    path = folder / name
    if path.is_file():
        return path, str(path)
    if name.endswith(".toml"):
        raise MachineError(f"machine {name}: no such file")
    raise MachineError(f"unknown machine {name!r}{_suggestion(name, names())}; `polarcheck machines` lists them")


def _read(path: Path, title: str) -> dict[str, Any]:
    import tomllib

    try:
        return tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise MachineError(f"{title}: {error}") from None


def _replace(merged: dict[str, Any], groups: Any, profile: str, origins: dict[str, Origin]) -> None:
    """Drop whole tables of farther profiles: alarm numbers and parameters of another control are not inherited."""
    if not isinstance(groups, list) or not set(map(str, groups)) <= {"alarms", "meanings", "severities", "notes"}:
        raise MachineError(f"{profile}: replaces: expected a list of alarms, meanings, severities, notes")
    for group in groups:
        merged.pop(group, None)
        for key in [key for key in origins if key.partition(".")[0] == group]:
            del origins[key]


def _merge(into: dict[str, Any], table: Mapping[str, Any], profile: str, origins: dict[str, Origin]) -> None:
    """Values of a nearer profile replace those of a farther one; tables are merged key by key."""
    for group, values in table.items():
        if not isinstance(values, Mapping) or "value" in values:
            into[group] = _unwrapped(values, f"{group}", profile, origins)
            continue
        if group not in Machine.__struct_fields__:
            raise MachineError(f"{profile}: unknown table [{group}]{_suggestion(group, Machine.__struct_fields__)}")
        target = into.setdefault(group, {})
        for key, value in values.items():
            target[key] = _unwrapped(value, f"{group}.{key}", profile, origins)


def _unwrapped(value: Any, key: str, profile: str, origins: dict[str, Origin]) -> Any:
    """`{ value = 3, source = "p. 52" }` or a bare value."""
    if not isinstance(value, Mapping) or ("value" not in value and _is_table(key)):
        origins[key] = Origin(profile, "")
        return value
    wrong = set(value) - {"value", "source", "doubtful"}
    if wrong or "value" not in value:
        raise MachineError(f"{profile}: {key}: expected value, source and doubtful, not {', '.join(sorted(value))}")
    origins[key] = Origin(profile, str(value.get("source", "")), bool(value.get("doubtful", False)))
    return value["value"]


def _is_table(key: str) -> bool:
    """Whether the value of a key is a table itself."""
    group, _, last = key.partition(".")
    return group == "meanings" or any(field.name == last and get_origin(field.type) is dict for field in _fields(group))


def _convert(merged: dict[str, Any], origins: Mapping[str, Origin], title: str) -> Machine:
    try:
        return msgspec.convert(merged, Machine)
    except msgspec.ValidationError as error:
        text, _, where = str(error).partition(" - at `$")
        key = where.rstrip("`").lstrip(".")
        if "unknown field" in text:
            unknown = text.split("`")[1]
            known = {field.name for group in Machine.__struct_fields__ for field in _fields(group)}
            dotted = f"{key}.{unknown}" if key else unknown
            profile = origins[dotted].profile if dotted in origins else title
            raise MachineError(f"{profile}: unknown key {dotted}{_suggestion(unknown, known)}") from None
        profile = origins[key].profile if key in origins else title
        raise MachineError(f"{profile}: {key or 'profile'}: {text[:1].lower()}{text[1:]}") from None


def _fields(group: str) -> tuple[msgspec.structs.FieldInfo, ...]:
    kind = {field.name: field.type for field in msgspec.structs.fields(Machine)}[group]
    return msgspec.structs.fields(kind) if isinstance(kind, type) and issubclass(kind, msgspec.Struct) else ()


def _suggestion(wrong: str, known: Any) -> str:
    import difflib

    near = difflib.get_close_matches(wrong, list(known), 1)
    return f"; did you mean {near[0]}?" if near else ""
