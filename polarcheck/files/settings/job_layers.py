"""
Layers of job files: a file overrides the one that it extends, and its entries for certain programs override the file.

Tables are merged key by key; all other values are replaced by the nearest.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.foundation.errors import JobError
from polarcheck.foundation.record import Remembered, note
from polarcheck.foundation.states import MM_PER_INCH
from polarcheck.program.machines import profiles
from polarcheck.program.machines.job import Job, Tool, from_table
from polarcheck.program.machines.offset_keys import canonical
from polarcheck.program.machines.part_keys import LENGTHS, Part
from polarcheck.program.machines.value_types import display

#: Keys that select files, and are no settings of a program.
_OF_FILES = ("extend", "exclude", "programs", "files", "part", "root")
#: Keys that mean nothing to the files below: how this one is read, and entries with patterns of their own.
_OF_THE_FILE_ITSELF = ("extend", "root", "units", "programs", "part")
#: Decimals of a converted length; further ones are rounding errors.
_DECIMALS = 9
#: Keys of lengths, which are in the units of their file, by table.
_LENGTHS = {"tools": ("radius", "x_wear", "diameter"), "stock": ("diameter", "clearance"), "work_offsets": ("x",)}


class Written:
    """
    The text of a job file, to find the line of a key.

    path: the file.
    prefix: the prefix of its keys in pyproject.toml.
    """

    def __init__(self, path: Path, text: str, prefix: str = "") -> None:
        self.path, self._text, self._prefix = path, text, prefix

    @cached_property
    def _lines(self) -> dict[str, int]:
        from polarcheck.program.machines import toml_lines

        return toml_lines.of_keys(self._text)

    def at(self, key: str) -> str:
        """Return the place of a key or of the nearest table around it, `polarcheck.toml:12`; else the file alone."""
        from polarcheck.program.machines import toml_lines

        line = toml_lines.line_of(f"{self._prefix}{key}", self._lines)
        return f"{self.path}:{line}" if line else str(self.path)


class Layer:
    """
    The values of a job file, or of one of its [[programs]] entries.

    written: the text of the file.
    entry: 0 for the file itself, n for its n-th entry.
    table: the values as written; paths are relative to the folder of the job file.
    """

    def __init__(self, written: Written, table: Mapping[str, Any], entry: int = 0) -> None:
        self.written, self.entry, self._table = written, entry, table
        self._tables: Remembered[str, dict[str, Any]] = Remembered()

    @property
    def title(self) -> str:
        """Return a name for this layer, without a line."""
        return f"{self.written.path}: [[programs]] {self.entry}" if self.entry else str(self.written.path)

    @property
    def machine(self) -> str | None:
        """Return the machine as written; None if this layer names none."""
        machine = self._table.get("machine")
        return None if machine is None else str(machine)

    @property
    def is_root(self) -> bool:
        """Return True if no job file above this one is meant."""
        return bool(self._table.get("root", False))

    @property
    def keys(self) -> list[str]:
        """Return the keys that decide about programs, in the order in which they are written."""
        return [key for key in self._table if key not in _OF_THE_FILE_ITSELF]

    @property
    def excluded(self) -> list[str]:
        """Return the patterns of `exclude`."""
        return list(self._table.get("exclude", ()))

    @property
    def extensions(self) -> list[str]:
        """Return the endings of `extensions`."""
        return list(self._table.get("extensions", ()))

    def at(self, key: str) -> str:
        """Return the place of a key of this layer: `polarcheck.toml:12`."""
        return self.written.at(f"programs.{self.entry}.{key}" if self.entry else key)

    def spelling(self, key: str) -> str:
        """Return a key of the merged job as it is written in this layer: offsets have several spellings."""
        group, _, rest = key.partition(".")
        if group not in ("tools", "work_offsets"):
            return key
        for name in self._table.get(group, {}):
            spelled = canonical(name) if group == "tools" else name.upper()
            if rest == spelled or rest.startswith(f"{spelled}."):
                return f"{group}.{name}{rest[len(spelled) :]}"
        return key

    @property
    def says_units(self) -> bool:
        """Return True if this layer sets the units of its lengths."""
        return "units" in self._table

    @property
    def table(self) -> dict[str, Any]:
        """
        Return the values, with canonical keys of offsets, and with paths relative to the working folder.

        Raises JobError for a folder that does not exist.
        """
        return self._tables.get("", self._resolved)

    def _resolved(self) -> dict[str, Any]:
        values = {key: value for key, value in self._table.items() if key not in _OF_FILES}
        folder = self.written.path.parent
        if "tools" in values:
            values["tools"] = {canonical(name): tool for name, tool in values["tools"].items()}
        if "work_offsets" in values:
            values["work_offsets"] = {name.upper(): value for name, value in values["work_offsets"].items()}
        if "machine" in values:
            values["machine"] = _machine(values["machine"], folder)
        for key in ("offsets", "baseline"):
            if key in values:
                values[key] = str(in_folder(folder, values[key]))
        if "subprograms" in values.get("run", {}):
            folders = [self._folder(folder, written) for written in values["run"]["subprograms"]]
            values["run"] = {**values["run"], "subprograms": folders}
        return values

    def _folder(self, folder: Path, written: str) -> str:
        import os

        path = str(in_folder(folder, written))
        note(path)
        try:
            os.scandir(path).close()
        except (FileNotFoundError, NotADirectoryError, ValueError):
            reason = f"there is no folder {display(written)}"
        except OSError as error:
            reason = f"{display(written)}: {error.strerror}"
        else:
            return path
        raise JobError(f"{self.at('run.subprograms')}: run.subprograms: {reason}")


def in_folder(folder: Path, written: str) -> Path:
    """Return the path of a file or folder that a file in this folder names; backslashes count as slashes, too."""
    path = folder / written
    if "\\" not in written:
        return path
    note(path)
    if not path.exists():
        return folder / written.replace("\\", "/")
    return path


def _machine(name: str, folder: Path) -> str:
    """Return the name of a built-in machine, or the path of a machine file named in a job file."""
    path = in_folder(folder, name)
    if name not in profiles.names() and profiles.is_meant(path, name):
        return str(path)
    return name


class PartLayer(Layer):
    """
    A [[part]] entry of a job file, or of a table in another file.

    number: its number, from 1. table_key: the key of that table, `feature.contour`; empty for the file itself.
    """

    def __init__(self, written: Written, table: Mapping[str, Any], number: int, table_key: str = "") -> None:
        super().__init__(written, {})
        self.number, self._part = number, table
        self._prefix = f"{table_key}." if table_key else ""

    def _resolved(self) -> dict[str, Any]:
        """Return a table with the entry as its only part."""
        entry = dict(self._part)
        if "drawing" in entry:
            entry["drawing"] = str(in_folder(self.written.path.parent, entry["drawing"]))
        return {"part": [entry]}

    def at(self, key: str) -> str:
        """Return the place of a key of the entry, or of the entry itself."""
        return self.written.at(f"{self._prefix}part.{self.number}{key.removeprefix('part')}")


class Merged(msgspec.Struct, frozen=True):
    """
    The merged job of layers.

    job: the job.
    layers: the layers, the nearest last.
    origins: the layer that sets each key.
    """

    job: Job
    layers: tuple[Layer, ...] = ()
    origins: Mapping[str, Layer] = {}

    def at(self, key: str) -> str:
        """Return the place of a value, for an error message."""
        layer = self.origin(key)
        return layer.at(layer.spelling(key)) if layer else str(self.layers[-1].written.path) if self.layers else ""

    def origin(self, key: str) -> Layer | None:
        """Return the layer that sets a value, or the nearest one that sets a value of a table."""
        if key in self.origins:
            return self.origins[key]
        inside = [layer for name, layer in self.origins.items() if name.startswith(f"{key}.")]
        return max(inside, key=self.layers.index) if inside else None


def merged(layers: Sequence[Layer]) -> Merged:
    """Return the merged job of layers, the nearest last. Raises JobError, which names file, line and key."""
    table: dict[str, Any] = {}
    origins: dict[str, Layer] = {}
    listed: dict[str, Tool] = {}
    owners: list[Layer] = []
    for layer in layers:
        values = layer.table
        if "part" in values:
            owners.append(layer)
            values = {"part": [*table.get("part", ()), *values["part"]]}
        if layer.says_units:
            listed = _in_units(values["units"], table, listed, layer, origins)
        if "offsets" in values:
            # A nearer offset table replaces the former one, and overrides tools set by farther layers.
            listed = _listed(layer, values.get("units", table.get("units")))
            for key in listed:
                table.get("tools", {}).pop(key, None)
                for name in [name for name in origins if name.startswith(f"tools.{key}.")]:
                    del origins[name]
        for parts, value in _leaves(values):
            origins[".".join(parts)] = layer
            _put(table, parts, value)
    job = from_table(table, str(layers[-1].written.path) if layers else "")
    if listed:
        job = msgspec.structs.replace(job, tools={**listed, **job.tools})
    if any(part.drawing is not None for part in job.part):
        drawn = [_drawn(part, layer) for part, layer in zip(job.part, owners, strict=True)]
        job = msgspec.structs.replace(job, part=drawn)
    return Merged(job, tuple(layers), origins)


def _drawn(part: Part, layer: Layer) -> Part:
    """Return a part with its drawing, if it has one."""
    if part.drawing is None:
        return part
    from polarcheck.program.machines import drawing_file

    return drawing_file.part_of(Path(part.drawing), f"{layer.at('part.drawing')}: drawing: {part.drawing}", part)


def _leaves(table: Mapping[str, Any], *outer: str) -> Iterator[tuple[tuple[str, ...], Any]]:
    """Yield keys and value of each value of a table, those of nested tables included."""
    for key, value in table.items():
        parts = *outer, key
        if isinstance(value, Mapping) and not _is_whole(parts):
            yield from _leaves(value, *parts)
        else:
            yield parts, value


def _is_whole(parts: tuple[str, ...]) -> bool:
    """Return True for a key whose table is one value: a severity, or a list of rules, with its reason."""
    return parts[0] in ("select", "ignore") or (parts[0] == "severities" and len(parts) > 1)


def _put(table: dict[str, Any], parts: tuple[str, ...], value: Any) -> None:
    *outer, last = parts
    for part in outer:
        table = table.setdefault(part, {})
    # The last entry of a rule counts, so the key moves to the end.
    table.pop(last, None)
    table[last] = value


def _listed(layer: Layer, units: Any) -> dict[str, Tool]:
    """Read the offset table that a layer names."""
    from polarcheck.program.machines import offset_table

    path = layer.table["offsets"]
    return offset_table.read_offset_table(Path(path), f"{layer.at('offsets')}: offsets: {path}", units=units)


def _in_units(
    units: str, table: dict[str, Any], listed: dict[str, Tool], layer: Layer, origins: Mapping[str, Layer]
) -> dict[str, Tool]:
    """
    Convert the lengths so far to the units of a nearer layer; return the converted offset table.

    Raises JobError if their units are unknown.
    """
    before = table.get("units")
    parts_of_job = table.get("part", ())
    lengths = [parts for parts, _ in _leaves(table) if parts[-1] in _LENGTHS.get(parts[0], ())]
    lengths += [("part",)] if any(key in part for part in parts_of_job for key in LENGTHS) else []
    if before == units or not (lengths or listed):
        return listed
    if before is None:
        key = ".".join(lengths[0]) if lengths else "offsets"
        where = origins[key].at(key)
        raise JobError(f"{layer.at('units')}: units: {key} of {where} has those of each program; give units there, too")
    factor = MM_PER_INCH if before == "inch" else 1 / MM_PER_INCH
    for parts in lengths:
        inner = table
        for part in parts[:-1]:
            inner = inner[part]
        if parts == ("part",):
            table["part"] = [_converted(part, factor) for part in parts_of_job]
        else:
            inner[parts[-1]] = round(inner[parts[-1]] * factor, _DECIMALS)
    return {
        key: msgspec.structs.replace(
            tool, radius=round(tool.radius * factor, _DECIMALS), x_wear=round(tool.x_wear * factor, _DECIMALS)
        )
        for key, tool in listed.items()
    }


def _converted(part: Mapping[str, Any], factor: float) -> dict[str, Any]:
    """Return a [[part]] entry with converted lengths."""
    converted = dict(part)
    for key in converted.keys() & LENGTHS:
        value = converted[key]
        converted[key] = (
            [round(length * factor, _DECIMALS) for length in value]
            if isinstance(value, list)
            else round(value * factor, _DECIMALS)
        )
    return converted
