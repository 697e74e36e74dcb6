"""The origin of each setting of a program, for `polarcheck config show`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import msgspec

from polarcheck.files.settings.declarations import SETTINGS
from polarcheck.files.settings.job_layers import Layer, Merged, PartLayer
from polarcheck.files.settings.of_programs import Applied
from polarcheck.program.machines import profiles, toml_lines
from polarcheck.program.machines.job import Job, PunchedTool, ReasonedRules
from polarcheck.program.machines.parameters import Origin
from polarcheck.program.machines.part_keys import Part


class Value(NamedTuple):
    """
    A setting.

    key: its key in a job file.
    value: None if unknown.
    kind: default, machine, file, programs (an entry of a job file), environment or command line.
    origin: the same as a text that names the file, line and option.
    """

    key: str
    value: Any
    kind: str
    origin: str


#: Keys of a job that are not shown as settings.
_OF_FILES = ("programs", "extend", "root", "exclude", "extensions", "limits")
_DEFAULT = ("default", "built-in default")
#: The setting that each key of a job has the value of; other settings have a part of several keys, or of none.
_OF_KEY = {setting.key: setting for setting in SETTINGS.values() if setting.key}

#: `command line` or `environment` by the name of an option; options that were not set are left out.
Sources = Mapping[str, str]


def values(applied: Applied, sources: Sources, severities: Mapping[str, str]) -> Iterator[Value]:
    """
    Yield the settings of a program, in the order of the keys of a job file, and the limits of its lathe.

    sources: where each option comes from.
    severities: those of the command line, as written.
    """
    job, merged = applied.settings.job, applied.merged
    table = {"machine": applied.settings.name, **_flat(job)}
    for key, value in table.items():
        yield Value(key, value, *_origin(key, job, merged, sources))
    for name, level in severities.items():
        yield Value(f"severities.{name}", level, *_of_option("severities", sources))
    yield from _of_machine(applied, sources)
    yield Value("extensions", job.extensions, *_origin("extensions", job, merged, sources))
    excluding = applied.file.excluding
    excluded = _of_layer(excluding, "exclude") if excluding else _DEFAULT
    yield Value("exclude", excluding.excluded if excluding else [], *excluded)


def _flat(job: Job) -> dict[str, Any]:
    """The values of a job by key; of tables only what is given."""
    values: dict[str, Any] = {}
    for field in msgspec.structs.fields(Job):
        value = getattr(job, field.name)
        if field.name in _OF_FILES or field.name == "machine":
            continue
        if field.name == "tools":
            for key, tool in value.items():
                values |= _differing(f"tools.{key}", tool)
        elif field.name == "work_offsets":
            for key, offset in value.items():
                values[f"work_offsets.{key}.x"] = offset.x
        elif field.name == "part":
            for number, part in enumerate(value, 1):
                values |= _differing(f"part.{number}", part)
        elif field.name == "severities":
            values |= {f"severities.{name}": msgspec.to_builtins(level) for name, level in value.items()}
        elif isinstance(value, ReasonedRules):
            values[field.name] = msgspec.to_builtins(value)
        elif isinstance(value, msgspec.Struct):
            values |= {f"{field.name}.{key}": inner for key, inner in msgspec.structs.asdict(value).items()}
        else:
            values[field.name] = value
    variables = values.pop("run.variables")
    return {**values, **{f"run.variables.{number}": value for number, value in variables.items()}}


def _differing(key: str, table: msgspec.Struct) -> dict[str, Any]:
    return {
        f"{key}.{field.name}": value
        for field in msgspec.structs.fields(Part if isinstance(table, Part) else type(table))
        if (value := getattr(table, field.name)) == value and value not in (None, [], field.default)
    }


def _origin(key: str, job: Job, merged: Merged, sources: Sources) -> tuple[str, str]:
    setting = _OF_KEY.get(key)
    if setting is not None and setting.name in sources:
        return _of_option(setting.name, sources)
    if key.startswith("tools."):
        return _of_tool(key, job, merged, sources)
    if key.startswith("part."):
        return _of_part(key, merged, sources)
    layer = merged.origins.get(key)
    return _of_layer(layer, key) if layer else _DEFAULT


def _of_part(key: str, merged: Merged, sources: Sources) -> tuple[str, str]:
    _, number, last = key.split(".")
    if last == "tolerance" and "tolerance" in sources and not _says_tolerance(merged, int(number), sources):
        return _of_option("tolerance", sources)
    if "drawings" in sources:
        return _of_option("drawing_layers" if last == "layers" else "drawings", sources)
    layer = [layer for layer in merged.layers if isinstance(layer, PartLayer)][int(number) - 1]
    return "file", layer.at(f"part.{last}")


def _says_tolerance(merged: Merged, number: int, sources: Sources) -> bool:
    return "drawings" not in sources and merged.job.part[number - 1].tolerance > 0


def _of_tool(key: str, job: Job, merged: Merged, sources: Sources) -> tuple[str, str]:
    name, _, last = key.removeprefix("tools.").rpartition(".")
    tool, written = job.tools[name], merged.job.tools.get(name)
    if written is None or getattr(written, last) != getattr(tool, last):
        if isinstance(tool, PunchedTool):
            return _of_option("offsets", sources)
        return _of_option("tools", sources)
    if isinstance(written, PunchedTool) and key not in merged.origins:
        layer = merged.origin("offsets")
        kind, origin = _of_layer(layer, "offsets") if layer else _DEFAULT
        return kind, f"{job.offsets}, named in {origin}"
    layer = merged.origins.get(key)
    return _of_layer(layer, key) if layer else _DEFAULT


def _of_option(name: str, sources: Sources) -> tuple[str, str]:
    kind, option = sources.get(name, "command line"), SETTINGS[name].flag
    return kind, f"{kind} {_of_environment(option) if kind == 'environment' else option}"


def _of_environment(option: str) -> str:
    return "POLARCHECK_" + option[2:].upper().replace("-", "_")


def _of_layer(layer: Layer, key: str) -> tuple[str, str]:
    where = layer.at(layer.spelling(key))
    return ("programs", f"{where}, [[programs]] {layer.entry}") if layer.entry else ("file", where)


def _of_machine(applied: Applied, sources: Sources) -> Iterator[Value]:
    """Yield the limits of the lathe, and other values that do not come from a built-in machine."""
    profile, built_in = applied.profile, profiles.names()
    ours = {key: origin for key, origin in profile.origins.items() if origin.profile not in built_in}
    limits = msgspec.structs.asdict(profile.written.limits)
    keys = [*(f"limits.{key}" for key in limits), *(key for key in ours if not key.startswith("limits."))]
    for key in keys:
        group, _, last = key.partition(".")
        value = getattr(profile.written, group)
        for part in [last] if last else []:
            value = value.get(part) if isinstance(value, dict) else getattr(value, part, None)
        origin = profile.origins.get(key)
        yield Value(key, value, *_of_profile(key, origin, applied.merged, sources, built_in))


def _of_profile(
    key: str, origin: Origin | None, merged: Merged, sources: Sources, built_in: list[str]
) -> tuple[str, str]:
    if origin is None:
        return _DEFAULT
    if origin.profile == "--set":
        return _of_option("changes", sources)
    layer = merged.origins.get(key)
    if layer is not None and layer.title == origin.profile:
        return _of_layer(layer, key)
    if origin.profile in built_in:
        return "machine", f"built-in {origin.profile}"
    by = f"parameters.{origin.parameter}" if origin.parameter else key
    return "machine", toml_lines.located(f"{origin.profile}: {by}:").removesuffix(f": {by}:")
