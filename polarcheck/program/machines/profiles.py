"""Machine profiles: read from TOML, each inheriting from another, every value with its source."""

from __future__ import annotations

import functools
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, get_origin

import msgspec

from polarcheck.foundation import record
from polarcheck.foundation.decoding import kept, msgpack_decoder
from polarcheck.foundation.errors import MachineError, suggestion
from polarcheck.program.machines import axis_names, parameters, toml_text
from polarcheck.program.machines.code_lists import FRAME_LISTS
from polarcheck.program.machines.machine import Machine, OwnMachine
from polarcheck.program.machines.parameters import Origin
from polarcheck.program.machines.renamed import RENAMED, refuse
from polarcheck.program.machines.value_types import MisfitError, fitted

FOLDER = Path(__file__).parent
DEFAULT = "fanuc"
#: Files that may stand behind each other by `inherits`; the built-in ones have four.
_LONGEST_CHAIN = 10
#: Tables by name, of which a nearer profile says what differs or is new.
MERGED = ("control.named_axes", "control.spindle_words", "macro.statements")
#: Tables that a profile can leave behind.
_REPLACED = ("alarms", "alarm_codes", "known_parameters", "severities", "notes")

#: Keys of a file that are none of the machine.
_OF_FILES = ("inherits", "replaces")


class UnknownMachineError(MachineError):
    """There is no machine and no file of a name."""


class Profile(msgspec.Struct, frozen=True):
    """
    A machine with the name it was asked for by, its chain of inheritance, and the origin of each value. written: the
    machine in the words of its files, where words of the control's own language are no codes yet. told: what the file
    itself says, by table. inherited: what it says that of, merged, as it stands in the files.
    """

    name: str
    machine: Machine
    written: Machine
    chain: tuple[str, ...]
    origins: Mapping[str, Origin]
    told: Mapping[str, Any]
    inherited: Mapping[str, Any]


def names() -> list[str]:
    """The built-in machines."""
    return list(_names_in(FOLDER))


@functools.cache
def _names_in(folder: Path) -> tuple[str, ...]:
    """Each of thousands of settings asks for them. Path.glob would compile a pattern."""
    return tuple(sorted(name.removesuffix(".toml") for name in os.listdir(folder) if name.endswith(".toml")))  # noqa: PTH208


@functools.cache
def built_in() -> tuple[Profile, ...]:
    """All built-in machines; those from which others inherit come first, to speak for them."""
    return tuple(sorted((load(name) for name in names()), key=lambda profile: len(profile.chain)))


#: Values of a machine, and what told them: a file or an option.
Change = tuple[str, Mapping[str, Any]]


def load(
    name: str, changes: Mapping[str, Any] | Sequence[Change] | None = None, *, contents: dict[str, Any] | None = None
) -> Profile:
    """
    The profile of a built-in machine or of a TOML file of the user's own.

    changes: merged over it; one table, or several with what told each, the nearest first. contents: taken as those of
    the file. Raises MachineError, naming the file or option and the key, for an unknown machine or key, a value that
    does not fit, a circle of inheritance.
    """
    over = [("the command line or job", changes)] if isinstance(changes, Mapping) else changes or []
    over = [(title, table) for title, table in over if table]
    if not over and contents is None and name in names():
        return _built_in_profile(name)
    return _load(name, over, contents)


@functools.cache
def _built_in_profile(name: str) -> Profile:
    """Return a built-in machine as it is; nobody changes it."""
    return _load(name, [], None)


def _load(name: str, over: list[Change], contents: dict[str, Any] | None) -> Profile:
    tables: list[tuple[str, dict[str, Any]]] = []
    requested: str | None = name
    folder = Path()
    seen: set[str] = set()
    ours: set[str] = set()
    checks_codes = any(group != "limits" for _, table in over for group in table)
    while requested is not None:
        try:
            path, title = _find(requested, folder)
        except UnknownMachineError as error:
            raise MachineError(f"{tables[-1][0]}: inherits: {error}") if tables else error from None
        # By the file itself: links and `..` give one file names without end.
        if (real := os.path.realpath(path)) in seen:
            raise MachineError(f"{title}: inherits from itself{_by_way_of([name for name, _ in tables[1:]])}")
        if len(seen) == _LONGEST_CHAIN:
            raise MachineError(
                f"{tables[0][0]}: inherits from more than {_LONGEST_CHAIN - 1} files, one behind the other"
            )
        seen.add(real)
        if path.parent == FOLDER:
            table = dict(_built_in(path))
            ours.add(title)
        else:
            table = _read_file(path, title) if contents is None or tables else contents
            if not table:
                heir = f"; {tables[-1][0]} inherits from it" if tables else ""
                raise MachineError(f'{title}: the file is empty; write inherits = "{DEFAULT}" or another machine{heir}')
        tables.append((title, table))
        folder = path.parent
        checks_codes |= folder != FOLDER
        requested = table.pop("inherits", None)
        if requested is not None and not isinstance(requested, str):
            raise MachineError(f"{title}: inherits: expected the name of a machine")
    merged: dict[str, Any] = {}
    origins: dict[str, Origin] = {}
    chain = tuple(title for title, _ in tables)
    tables = [*((title, dict(table)) for title, table in over), *tables]
    inherited: dict[str, Any] = {}
    for title, table in reversed(tables):
        if title == chain[0]:
            inherited = {
                group: dict(values) if isinstance(values, dict) else values for group, values in merged.items()
            }
        before = {key: parameters.value_of(merged, key) for key in MERGED}
        axes = axis_names.axis_names(merged)
        _replace(merged, table.pop("replaces", []), title, origins)
        _merge(merged, table, title, origins, in_plain_form=title in ours)
        if title in chain:
            _forget(merged, table)
        for key, value in before.items():
            _keep(merged, key, value)
        if isinstance(table.get("parameters"), Mapping):
            # After the values of farther profiles, before those of nearer ones: the nearest word counts.
            parameters.apply(merged, table, title, origins)
        control = table.get("control")
        if isinstance(control, Mapping) and "x" in control and "x_without_words" not in control:
            # X of a nearer profile is that of programs without a word such as DIAMOF, too.
            merged["control"].pop("x_without_words", None)
            origins.pop("control.x_without_words", None)
        if axes is not None and axis_names.axis_names(merged) is not None:
            axis_names.follow(merged, table, title, origins, axes)
    written = _convert(merged, origins, [title for title, _ in tables])
    machine = written
    control, g_codes = written.control, written.g_codes
    switches = control.x_radius_words, control.x_diameter_words, control.x_absolute_diameter_words
    if any((*switches, *(getattr(g_codes, key) for key in FRAME_LISTS))):
        from polarcheck.program.machines import own_language

        try:
            machine = own_language.numbered(written)
        except ValueError as error:
            raise MachineError(f"{chain[0]}: control: {error}") from None
    if checks_codes:
        from polarcheck.program.machines.code_check import check_codes

        check_codes(machine, origins, chain)
    if chain[0] not in ours:
        machine = OwnMachine(file=chain[0], **msgspec.structs.asdict(machine))
    return Profile(name, machine, written, chain, origins, tables[len(over)][1], inherited)


def _by_way_of(between: Sequence[str]) -> str:
    """Return the other files of a circle."""
    return f", by way of {', '.join(between)}" if between else ""


def is_meant(path: Path, name: str) -> bool:
    """
    Whether a name means the file at a path: where one lies there, and where something else does that a name of a
    machine cannot mean; reading it then says what it is.
    """
    record.note(path)
    is_path = name.endswith(".toml") or "/" in name or os.sep in name
    return os.path.isfile(path) or (is_path and os.path.lexists(path))  # noqa: PTH113  Path.is_file raises for some names


def _find(name: str, folder: Path) -> tuple[Path, str]:
    built_in = FOLDER / f"{name}.toml"
    if built_in.parent == FOLDER and os.path.isfile(built_in):  # noqa: PTH113  Path.is_file raises for some names
        return built_in, name
    path = folder / name
    if is_meant(path, name):
        return path, str(path)
    if name.endswith(".toml"):
        raise UnknownMachineError(f"machine {name}: no such file")
    near = suggestion(name, names()) or "; `polarcheck machines` lists them"
    raise UnknownMachineError(f"unknown machine {name!r}{near}")


def machine_id(name: str) -> str:
    """The id of a machine: a built-in one is its name, a file of the user's own its file name without `.toml`."""
    return Path(name).name.removesuffix(".toml")


@functools.cache
def _built_in(path: Path) -> dict[str, Any]:
    """
    Return the contents of a built-in file; most profiles inherit from the same ones.

    They are kept decoded, since parsing takes 5 % of a small check.
    """
    data = path.read_bytes()
    decoder = msgpack_decoder(dict[str, Any])
    return kept(path, record.digest(data), lambda: _parsed(data), msgspec.msgpack.encode, decoder.decode)


def _parsed(data: bytes) -> dict[str, Any]:
    import tomllib

    return tomllib.loads(data.decode("utf-8"))


def _read_file(path: Path, title: str) -> dict[str, Any]:
    try:
        return toml_text.read_toml(path, "machine file")
    except ValueError as error:
        from polarcheck.program.machines import toml_lines

        raise MachineError(toml_lines.placed(title, str(error))) from None


def _replace(merged: dict[str, Any], groups: Any, profile: str, origins: dict[str, Origin]) -> None:
    """Drop whole tables of farther profiles: alarm numbers and parameters of another control are not inherited."""
    if not isinstance(groups, list) or not set(map(str, groups)) <= {*_REPLACED, *RENAMED}:
        raise MachineError(f"{profile}: replaces: expected a list of {', '.join(_REPLACED)}")
    for group in groups:
        refuse(group, profile)
        merged.pop(group, None)
        for key in [key for key in origins if key.partition(".")[0] == group]:
            del origins[key]


def _merge(
    into: dict[str, Any], table: Mapping[str, Any], profile: str, origins: dict[str, Origin], *, in_plain_form: bool
) -> None:
    """
    Values of a nearer profile replace those of a farther one; tables are merged key by key.

    in_plain_form: its codes are written as they are compared, which a test says of our own files.

    `source` and `doubtful` of a table hold for those of its values that do not say otherwise.
    """
    for group, values in table.items():
        refuse(group, profile)
        if not isinstance(values, Mapping) or "value" in values:
            into[group] = _unwrapped(values, group, Origin(profile, ""), origins)
            continue
        if group not in Machine.__struct_fields__:
            near = suggestion(group, Machine.__struct_fields__) or _of_job(group)
            raise MachineError(f"{profile}: unknown table [{group}]{near}")
        target = into.setdefault(group, {})
        if not isinstance(target, dict):
            raise MachineError(f"{profile}: {group}: expected a text, found a table")
        origin = _origin(values, Origin(profile, ""), group)
        for key, value in values.items():
            if key not in ("source", "doubtful"):
                dotted = f"{group}.{key}"
                refuse(dotted, profile)
                given = _unwrapped(value, dotted, origin, origins)
                if not in_plain_form or _says_what_differs(given):
                    given = _taken(dotted, given, target.get(key), profile)
                target[key] = given


def _says_what_differs(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and str(value[0]).startswith(("+", "-"))


def _taken(key: str, value: Any, inherited: Any, profile: str) -> Any:
    from polarcheck.program.machines import written_codes

    try:
        return written_codes.taken(key, value, inherited)
    except written_codes.ListError as error:
        raise MachineError(f"{profile}: {key}: {error}") from None


def _keep(merged: dict[str, Any], key: str, inherited: Any) -> None:
    """Have what a nearer profile gives of a table beside what is inherited of it: it names what differs or is new."""
    value = parameters.value_of(merged, key)
    if isinstance(value, Mapping) and isinstance(inherited, Mapping):
        group, _, last = key.partition(".")
        merged[group][last] = {**inherited, **value}


def _unwrapped(value: Any, key: str, origin: Origin, origins: dict[str, Origin]) -> Any:
    """`{ value = 3, source = "p. 52" }` or a bare value; origin: of a value that says nothing of its own."""
    if not isinstance(value, Mapping) or ("value" not in value and _is_table(key)):
        origins[key] = origin
        return value
    wrong = set(value) - {"value", "source", "doubtful"}
    if wrong or "value" not in value:
        said = ", ".join(sorted(value))
        raise MachineError(f"{origin.profile}: {key}: expected value, source and doubtful, not {said}")
    origins[key] = _origin(value, origin, key)
    return value["value"]


def _origin(said: Mapping[str, Any], of_table: Origin, key: str) -> Origin:
    source, doubtful = said.get("source", of_table.source), said.get("doubtful", of_table.doubtful)
    if not isinstance(doubtful, bool):
        raise MachineError(f"{of_table.profile}: {key}.doubtful: expected true or false, found {doubtful!r}")
    return Origin(of_table.profile, str(source), bool(doubtful))


def _is_table(key: str) -> bool:
    """Return True if the value of a key is a table itself."""
    group, _, last = key.partition(".")
    return group == "known_parameters" or any(
        field.name == last and get_origin(field.type) is dict for field in _fields(group)
    )


def _forget(merged: dict[str, Any], table: Mapping[str, Any]) -> None:
    """Leave out what a profile gives as NaN: not known, whatever the profile that it inherits from says."""
    for group, values in table.items():
        for key in values if isinstance(values, Mapping) and isinstance(merged[group], dict) else ():
            value = merged[group].get(key)
            if isinstance(value, float) and math.isnan(value) and _may_be_unknown(group, key):
                del merged[group][key]


def _may_be_unknown(group: str, key: str) -> bool:
    default = next((field.default for field in _fields(group) if field.name == key), None)
    return isinstance(default, float) and math.isnan(default)


def _convert(merged: dict[str, Any], origins: Mapping[str, Origin], titles: Sequence[str]) -> Machine:
    """titles: of the profiles and what else has told values, the nearest first."""
    try:
        return fitted(merged, Machine)
    except MisfitError as misfit:
        raise MachineError(_objection(misfit, origins, titles)) from None


def _objection(misfit: MisfitError, origins: Mapping[str, Origin], titles: Sequence[str]) -> str:
    """A value that does not fit, by the file in which it stands and the parameter by which it was given."""
    text = str(misfit)
    # A key of a table, or those of a group that do not go together.
    at_fault = [key for key in origins if f"{misfit.key}.".startswith(f"{key}.")] or [
        key for key in origins if key.startswith(f"{misfit.key}.") and key.partition(".")[2] in text.split()
    ]
    of_fault = sorted((origins[key] for key in at_fault), key=lambda origin: titles.index(origin.profile))
    if not of_fault and text.endswith("is missing"):
        # The fault of the file that inherits from none.
        return f'{titles[-1]}: {text}; inherits = "{DEFAULT}" or another machine would give it'
    title = of_fault[0].profile if of_fault else titles[0]
    given = [f"parameters.{origin.parameter}" for origin in of_fault if origin.parameter and origin.profile == title]
    if given:
        return f"{title}: {' and '.join(given)}: {text}"
    if text.startswith("unknown key"):
        text = _unknown_key(misfit.key, origins) or text
    return f"{title}: {text}"


def _unknown_key(written: str, origins: Mapping[str, Origin]) -> str:
    """Return the hint for a key of another table, or for the number of a parameter."""
    key = written.rpartition(".")[2]
    if f"known_parameters.{key}" in origins:
        return f"unknown key {written}; it is a parameter of the control: write it under [parameters]"
    elsewhere = [f"{group}.{key}" for group in Machine.__struct_fields__ if key in _names(group)]
    if elsewhere:
        return f"unknown key {written}; did you mean {elsewhere[0]}?"
    if key != written:
        return ""
    near = suggestion(key, (*Machine.__struct_fields__, *_OF_FILES)) or _of_job(key)
    return f"unknown key {written}{near}"


def _of_job(key: str) -> str:
    from polarcheck.program.machines.job import Job

    return "; it belongs to the job, polarcheck.toml" if key in Job.__struct_fields__ else ""


def _fields(group: str) -> tuple[msgspec.structs.FieldInfo, ...]:
    kind = {field.name: field.type for field in msgspec.structs.fields(Machine)}[group]
    return msgspec.structs.fields(kind) if isinstance(kind, type) and issubclass(kind, msgspec.Struct) else ()


def _names(group: str) -> set[str]:
    return {field.name for field in _fields(group)}
