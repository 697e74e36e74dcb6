"""
What job files say, laid over each other: a file over the one that it extends, its entries for some programs over it.

Tables are merged key by key; of everything else the nearest counts.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.errors import JobError
from polarcheck.machines import profiles
from polarcheck.machines.fitting import shown
from polarcheck.machines.job import Job, Tool, from_table
from polarcheck.machines.modal import MM_PER_INCH
from polarcheck.machines.offset_keys import canonical
from polarcheck.machines.part import LENGTHS, Part

#: Keys that say which files are meant, and nothing of a program.
_OF_FILES = ("extend", "exclude", "programs", "files", "part")
#: Of a length that was converted: more are noise of the arithmetic.
_DECIMALS = 9
#: Keys of lengths, which are in the units of their file, by table.
_LENGTHS = {"tools": ("radius", "x_wear", "diameter"), "stock": ("diameter", "clearance"), "work_offsets": ("x",)}


class Written:
    """The text of a job file, to tell in which line a key of it stands. prefix: of its keys, within pyproject.toml."""

    def __init__(self, path: Path, text: str, prefix: str = "") -> None:
        self.path, self._text, self._prefix = path, text, prefix

    @cached_property
    def _lines(self) -> dict[str, int]:
        from polarcheck.machines import toml_lines

        return toml_lines.of_keys(self._text)

    def at(self, key: str) -> str:
        """`polarcheck.toml:12`: where a key stands, or the nearest table around it; the file where that is all."""
        from polarcheck.machines import toml_lines

        line = toml_lines.line_of(f"{self._prefix}{key}", self._lines)
        return f"{self.path}:{line}" if line else str(self.path)


class Layer:
    """
    The values of a job file (entry 0), or those of its n-th [[programs]] entry.

    table: as they are written. Files and folders in it begin where the job file lies.
    """

    def __init__(self, written: Written, table: Mapping[str, Any], entry: int = 0) -> None:
        self.written, self.entry, self._table = written, entry, table

    @property
    def title(self) -> str:
        """What tells this layer from others, where its lines are not asked for."""
        return f"{self.written.path}: [[programs]] {self.entry}" if self.entry else str(self.written.path)

    @property
    def excluded(self) -> list[str]:
        """The patterns of what walks pass over."""
        return list(self._table.get("exclude", ()))

    def at(self, key: str) -> str:
        """`polarcheck.toml:12`: where a key of this layer stands."""
        return self.written.at(f"programs.{self.entry}.{key}" if self.entry else key)

    def spelling(self, key: str) -> str:
        """A key of the merged job as it is written here: offsets and work offsets have several spellings."""
        group, _, rest = key.partition(".")
        if group not in ("tools", "work_offsets"):
            return key
        for name in self._table.get(group, {}):
            own = canonical(name) if group == "tools" else name.upper()
            if rest == own or rest.startswith(f"{own}."):
                return f"{group}.{name}{rest[len(own) :]}"
        return key

    @property
    def says_units(self) -> bool:
        """True if the lengths of this layer have units of their own."""
        return "units" in self._table

    @cached_property
    def table(self) -> dict[str, Any]:
        """
        The values, with the keys of offsets as they are compared and with paths from the working folder.

        Raises JobError for a folder that there is not.
        """
        found = {key: value for key, value in self._table.items() if key not in _OF_FILES}
        folder = self.written.path.parent
        if "tools" in found:
            found["tools"] = {canonical(name): tool for name, tool in found["tools"].items()}
        if "work_offsets" in found:
            found["work_offsets"] = {name.upper(): value for name, value in found["work_offsets"].items()}
        if "machine" in found:
            found["machine"] = _machine(found["machine"], folder)
        if "offsets" in found:
            found["offsets"] = str(beside(folder, found["offsets"]))
        if "subprograms" in found.get("run", {}):
            folders = [self._folder(folder, written) for written in found["run"]["subprograms"]]
            found["run"] = {**found["run"], "subprograms": folders}
        return found

    def _folder(self, folder: Path, written: str) -> str:
        import os

        path = str(beside(folder, written))
        try:
            os.scandir(path).close()
        except (FileNotFoundError, NotADirectoryError, ValueError):
            told = f"there is no folder {shown(written)}"
        except OSError as error:
            told = f"{shown(written)}: {error.strerror}"
        else:
            return path
        raise JobError(f"{self.at('run.subprograms')}: run.subprograms: {told}")


def beside(folder: Path, written: str) -> Path:
    """A file or folder that a file in this folder names; with backslashes it is found wherever there are slashes."""
    path = folder / written
    if "\\" in written and not path.exists():
        return folder / written.replace("\\", "/")
    return path


def _machine(name: str, folder: Path) -> str:
    """A built-in machine, or the path of a file beside the job file."""
    path = beside(folder, name)
    if name not in profiles.names() and profiles.is_meant(path, name):
        return str(path)
    return name


class PartLayer(Layer):
    """One [[part]] entry of a job file, the n-th."""

    def __init__(self, written: Written, table: Mapping[str, Any], number: int) -> None:
        super().__init__(written, {})
        self.number, self._part = number, table

    @cached_property
    def table(self) -> dict[str, Any]:
        """The entry, in a list of its own."""
        entry = dict(self._part)
        if "drawing" in entry:
            entry["drawing"] = str(beside(self.written.path.parent, entry["drawing"]))
        return {"part": [entry]}

    def at(self, key: str) -> str:
        """Where a key of the entry stands, or the entry itself."""
        return self.written.at(f"part.{self.number}{key.removeprefix('part')}")


class Merged(msgspec.Struct, frozen=True):
    """The job of some layers; layers: the nearest last. origins: which of them said the value of a key."""

    job: Job
    layers: tuple[Layer, ...] = ()
    origins: Mapping[str, Layer] = {}

    def at(self, key: str) -> str:
        """Where a value stands that is told as wrong."""
        layer = self.origin(key)
        return layer.at(layer.spelling(key)) if layer else str(self.layers[-1].written.path) if self.layers else ""

    def origin(self, key: str) -> Layer | None:
        """The layer that said a value, or the nearest one that said something of a table."""
        if key in self.origins:
            return self.origins[key]
        inside = [layer for name, layer in self.origins.items() if name.startswith(f"{key}.")]
        return max(inside, key=self.layers.index) if inside else None


def merged(layers: Sequence[Layer]) -> Merged:
    """The job of some layers, the nearest last. Raises JobError, which names file, line and key."""
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
            # A table of this lathe takes the place of that of another one, and is nearer than what is said of all.
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
    """A part with its drawing, where it has one."""
    if part.drawing is None:
        return part
    from polarcheck.machines import drawing

    return drawing.part_of(Path(part.drawing), f"{layer.at('part.drawing')}: drawing: {part.drawing}", part)


def _leaves(table: Mapping[str, Any]) -> Iterator[tuple[tuple[str, ...], Any]]:
    """The values of a table and of those in it, with their keys."""
    for key, value in table.items():
        if isinstance(value, Mapping):
            yield from (((key, *parts), inner) for parts, inner in _leaves(value))
        else:
            yield (key,), value


def _put(table: dict[str, Any], parts: tuple[str, ...], value: Any) -> None:
    *outer, last = parts
    for part in outer:
        table = table.setdefault(part, {})
    # The last that names a rule counts: what is nearer stands behind what it takes the place of.
    table.pop(last, None)
    table[last] = value


def _listed(layer: Layer, units: Any) -> dict[str, Tool]:
    """The offset table that a layer names."""
    from polarcheck.machines import offset_table

    path = layer.table["offsets"]
    return offset_table.read(Path(path), f"{layer.at('offsets')}: offsets: {path}", units=units)


def _in_units(
    units: str, table: dict[str, Any], listed: dict[str, Tool], layer: Layer, origins: Mapping[str, Layer]
) -> dict[str, Tool]:
    """
    Have the lengths so far in the units in which a nearer layer gives its own; the offset table, likewise.

    Raises JobError where nobody knows what they are.
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
    """A [[part]] entry with its lengths in other units."""
    found = dict(part)
    for key in found.keys() & LENGTHS:
        value = found[key]
        found[key] = (
            [round(one * factor, _DECIMALS) for one in value]
            if isinstance(value, list)
            else round(value * factor, _DECIMALS)
        )
    return found
