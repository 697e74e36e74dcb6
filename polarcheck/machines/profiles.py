"""Machine profiles: read from TOML, each inheriting from another, every value with its source."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from pathlib import Path
from typing import Any, get_origin

import msgspec

from polarcheck.errors import MachineError
from polarcheck.machines import parameters
from polarcheck.machines.machine import Machine
from polarcheck.machines.parameters import Origin
from polarcheck.machines.renamed import RENAMED, refuse

FOLDER = Path(__file__).parent
DEFAULT = "fanuc"
#: Tables that a profile can leave behind.
_REPLACED = ("alarms", "known_parameters", "severities", "notes")


class Profile(msgspec.Struct, frozen=True):
    """
    A machine with the name it was asked for by, its chain of inheritance, and the origin of each value. written: the
    machine in the words of its files, where words of the control's own language are no codes yet.
    """

    name: str
    machine: Machine
    written: Machine
    chain: tuple[str, ...]
    origins: Mapping[str, Origin]


def names() -> list[str]:
    """The built-in machines."""
    return sorted(path.stem for path in FOLDER.glob("*.toml"))


@functools.cache
def built_in() -> tuple[Profile, ...]:
    """All built-in machines; those from which others inherit come first, to speak for them."""
    return tuple(sorted((load(name) for name in names()), key=lambda profile: len(profile.chain)))


def load(name: str, changes: Mapping[str, Any] | None = None) -> Profile:
    """
    The profile of a built-in machine or of a TOML file of the user's own; changes are merged over it.

    Raises MachineError, naming the file and the key, for an unknown machine, key, type or circle of inheritance.
    """
    tables: list[tuple[str, dict[str, Any]]] = []
    asked: str | None = name
    folder = Path()
    own = any(table != "limits" for table in changes or ())
    while asked is not None:
        path, title = _find(asked, folder)
        if any(title == seen for seen, _ in tables):
            raise MachineError(f"{title}: inherits from itself")
        table = _read(path, title) if path.parent != FOLDER else dict(_built_in(path))
        tables.append((title, table))
        folder = path.parent
        own |= folder != FOLDER
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
    chain = tuple(title for title, _ in tables)
    written = _convert(merged, origins, chain[0])
    machine = written
    if written.control.x_radius_words or written.control.x_diameter_words:
        from polarcheck.machines import own_language

        try:
            machine = own_language.numbered(written)
        except ValueError as error:
            raise MachineError(f"{chain[0]}: control: {error}") from None
    if own:
        from polarcheck.machines.code_check import check_codes

        check_codes(machine, origins, chain)
    return Profile(name, machine, written, chain, origins)


def _find(name: str, folder: Path) -> tuple[Path, str]:
    built_in = FOLDER / f"{name}.toml"
    if built_in.parent == FOLDER and built_in.is_file():
        return built_in, name
    path = folder / name
    if path.is_file():
        return path, str(path)
    if name.endswith(".toml"):
        raise MachineError(f"machine {name}: no such file")
    raise MachineError(f"unknown machine {name!r}{_suggestion(name, names())}; `polarcheck machines` lists them")


@functools.cache
def _built_in(path: Path) -> dict[str, Any]:
    """What stands in a file of ours: most profiles inherit from the same ones."""
    return _read(path, path.stem)


def _read(path: Path, title: str) -> dict[str, Any]:
    import tomllib

    try:
        return tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise MachineError(f"{title}: {error}") from None


def _replace(merged: dict[str, Any], groups: Any, profile: str, origins: dict[str, Origin]) -> None:
    """Drop whole tables of farther profiles: alarm numbers and parameters of another control are not inherited."""
    if not isinstance(groups, list) or not set(map(str, groups)) <= {*_REPLACED, *RENAMED}:
        raise MachineError(f"{profile}: replaces: expected a list of {', '.join(_REPLACED)}")
    for group in groups:
        refuse(group, profile)
        merged.pop(group, None)
        for key in [key for key in origins if key.partition(".")[0] == group]:
            del origins[key]


def _merge(into: dict[str, Any], table: Mapping[str, Any], profile: str, origins: dict[str, Origin]) -> None:
    """
    Values of a nearer profile replace those of a farther one; tables are merged key by key.

    `source` and `doubtful` of a table hold for those of its values that do not say otherwise.
    """
    for group, values in table.items():
        refuse(group, profile)
        if not isinstance(values, Mapping) or "value" in values:
            into[group] = _unwrapped(values, group, Origin(profile, ""), origins)
            continue
        if group not in Machine.__struct_fields__:
            raise MachineError(f"{profile}: unknown table [{group}]{_suggestion(group, Machine.__struct_fields__)}")
        target = into.setdefault(group, {})
        origin = _origin(values, Origin(profile, ""))
        for key, value in values.items():
            if key not in ("source", "doubtful"):
                dotted = f"{group}.{key}"
                refuse(dotted, profile)
                target[key] = _unwrapped(value, dotted, origin, origins)


def _unwrapped(value: Any, key: str, origin: Origin, origins: dict[str, Origin]) -> Any:
    """`{ value = 3, source = "p. 52" }` or a bare value; origin: of a value that says nothing of its own."""
    if not isinstance(value, Mapping) or ("value" not in value and _is_table(key)):
        origins[key] = origin
        return value
    wrong = set(value) - {"value", "source", "doubtful"}
    if wrong or "value" not in value:
        said = ", ".join(sorted(value))
        raise MachineError(f"{origin.profile}: {key}: expected value, source and doubtful, not {said}")
    origins[key] = _origin(value, origin)
    return value["value"]


def _origin(said: Mapping[str, Any], of_table: Origin) -> Origin:
    source, doubtful = said.get("source", of_table.source), said.get("doubtful", of_table.doubtful)
    return Origin(of_table.profile, str(source), bool(doubtful))


def _is_table(key: str) -> bool:
    """Whether the value of a key is a table itself."""
    group, _, last = key.partition(".")
    return group == "known_parameters" or any(
        field.name == last and get_origin(field.type) is dict for field in _fields(group)
    )


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
