"""The keywords that the functions for Python share: what a job file says, over the job files that are read."""

from __future__ import annotations

import inspect
import os
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any, Literal, TypeAlias, TypedDict, TypeVar

from polarcheck.api.values import flag, length, names, plain, short
from polarcheck.files.settings.declarations import SETTINGS
from polarcheck.files.settings.keyword_layers import keywords
from polarcheck.files.settings.of_programs import Options
from polarcheck.foundation.errors import UsageError, suggestion
from polarcheck.program.machines.job import Running, Stock, Tool, WorkOffset
from polarcheck.program.machines.part_keys import Part
from polarcheck.program.reading.files import display_path

PathName: TypeAlias = str | os.PathLike[str]
Values: TypeAlias = Mapping[str, Any]
Severity: TypeAlias = Literal["error", "warning", "note"]


class ExecutionKeywords(TypedDict, total=False):
    """
    How a program is read and run; what is not given is as polarcheck.toml says, else as the machine has it.

    machine: name of a built-in lathe, or the path of a TOML file.
    changes: other values of the machine by table and key, {"limits.c_feed": 3600}.
    limits: the same for its limits alone, {"c_feed": 3600}; see docs/adding_a_machine.md.
    tools: R of the tool offsets by number, {8: 6.35}, or Tool(radius=6.35, nose=0); by tool and edge, {"MILL_8/1": 4}.
    offsets: file with the offset table of the control.
    units: "mm" or "inch", of the lengths in these keywords; else they are in the units of the job file, else in those
        of each program.
    program_units: "mm" or "inch", of programs with neither G20 nor G21.
    stock: the bar, Stock(diameter=40.0) or {"hexagon": 27.0}.
    work_offsets: where X0 of each work offset lies, {"G54": 0.0}.
    block_skip: "on", "off" or "both", of blocks with /.
    subprograms: folders in which called programs lie, before those of the job file.
    variables: values of #-variables, {500: 1.5}.
    max_blocks, max_statements, max_seconds: where a run is given up; seconds of processor time.
    radius_from_comments: take unknown radii from comments.
    encoding: of the programs; else it is found out.
    config: a job file in place of the nearest polarcheck.toml.
    use_config: False to read no job file.
    """

    machine: PathName
    changes: Values
    limits: Mapping[str, float | bool]
    tools: Mapping[int | str, float | Tool | Values]
    offsets: PathName
    units: Literal["mm", "inch"]
    program_units: Literal["mm", "inch"]
    stock: Stock | Values
    work_offsets: Mapping[str, float | WorkOffset | Values]
    block_skip: Literal["on", "off", "both"]
    subprograms: PathName | Iterable[PathName]
    variables: Mapping[int | str, float]
    max_blocks: int
    max_statements: int
    max_seconds: float
    radius_from_comments: bool
    encoding: str
    config: PathName
    use_config: bool


class PartKeywords(ExecutionKeywords, total=False):
    """
    What programs should make.

    part: shapes and drawings in place of those of the job file, [Part(shape="hexagon", across_flats=27.0)].
    drawings: DXF files in place of them.
    drawing_layers: of each of these only what lies on these layers.
    tolerance: how far a part may differ that has no tolerance itself.
    """

    part: Part | Values | Iterable[Part | Values]
    drawings: PathName | Iterable[PathName]
    drawing_layers: str | Iterable[str]
    tolerance: float


class CheckKeywords(PartKeywords, total=False):
    """
    Which rules run, and what fails.

    select: only these rules, groups or alarms; over what the job file selects and ignores. Rules of weight that are
        left out make a file unverified, unless there is a reason: {"rules": ["text"], "reason": "checked by the DNC"}.
    ignore: all but these, with or without a reason.
    severities: error, warning, note or off by rule, group or alarm; or {"level": "off", "reason": "..."}.
    fail_on, max_warnings, strict: what the command ends with 1 for; no verdict hangs on it. Reports say it.
    inline: False to ignore the allow comments of programs.
    baseline: a file of known findings, which are silenced.
    use_baseline: False to ignore the baseline that a job file names.
    """

    select: str | Iterable[str] | Values
    ignore: str | Iterable[str] | Values
    severities: Mapping[str, Severity | Literal["off"] | Values]
    fail_on: Severity | Literal["never"]
    max_warnings: int
    strict: bool
    inline: bool
    baseline: PathName
    use_baseline: bool


#: Keywords that Options holds; the others are keys of a job file.
_OF_OPTIONS = (
    *("changes", "config", "drawing_layers", "drawings", "ignore", "select", "subprograms", "tolerance"),
    *("baseline", "use_baseline", "use_config"),
)
#: Keywords that a single value may be given to.
_LISTS = [name for name in _OF_OPTIONS if name in SETTINGS and SETTINGS[name].is_list and name != "changes"]
#: Those whose names may stand beside a reason, {"rules": [...], "reason": "..."}.
_WITH_REASON = ("ignore", "select")
_LARGEST_TOLERANCE = 100.0
_A_LENGTH = f"a length above 0 and up to {_LARGEST_TOLERANCE:g}"
#: The keys that name files or folders; "" for the keyword itself.
_FILES = {setting.name: setting.files for setting in SETTINGS.values()}
_FILES |= {"baseline": ("",), "part": ("drawing", "files")}

Function = TypeVar("Function", bound=Callable[..., Any])


def takes(kind: type) -> Callable[[Function], Function]:
    """Show the keywords of a TypedDict in the signature of a function and in its help."""

    def shown_in(function: Function) -> Function:
        signature = inspect.signature(function)
        parameters = [
            parameter.replace(annotation=_Written(parameter.annotation))
            for parameter in signature.parameters.values()
            if parameter.kind is not inspect.Parameter.VAR_KEYWORD
        ]
        for name, annotation in kind.__annotations__.items():
            written = _Written(getattr(annotation, "__forward_arg__", annotation))
            parameters.append(
                inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=_Written("..."), annotation=written)
            )
        returned = _Written(signature.return_annotation)
        function.__signature__ = signature.replace(  # type: ignore[attr-defined]
            parameters=parameters, return_annotation=returned
        )
        described = [inspect.getdoc(function), *(inspect.getdoc(base) for base in _described_by(kind))]
        function.__doc__ = "\n\n".join(str(text) for text in described)
        return function

    return shown_in


class _Written(str):
    """A type or a default as it is written in the source; help shows it without quotes."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def _described_by(kind: type) -> list[type]:
    """Return the TypedDicts whose keywords a TypedDict has, the most basic last."""
    order: list[type] = [CheckKeywords, PartKeywords, ExecutionKeywords]
    return order[order.index(kind) :]


def options(function: str, kind: type, values: Mapping[str, Any], **more: Any) -> Options:
    """
    Return the options of keywords.

    function: its name, for messages.
    kind: the TypedDict of the keywords that it takes.
    more: further fields of the options.

    Raises UsageError, which names the function and the keyword at fault.
    """
    kinds = kind.__annotations__
    for name in values:
        if name not in kinds:
            raise UsageError(f"{function}: unknown keyword {name}{suggestion(name, kinds)}")
    table = {
        name: plain(f"{function}: {name}", value, files=_FILES.get(name, ()))
        for name, value in values.items()
        if value is not None
    }
    for name in _LISTS:
        if name in table and not (name in _WITH_REASON and isinstance(table[name], dict)):
            table[name] = names(f"{function}: {name}", table[name])
    for name in ("baseline", "config", "machine", "offsets", "encoding"):
        if not isinstance(table.get(name, ""), str):
            raise UsageError(f"{function}: {name}: expected a name or a path, found {short(values[name])}")
    if "encoding" in table and not _is_encoding(table["encoding"]):
        raise UsageError(
            f"{function}: encoding: unknown encoding {short(values['encoding'])}; for example utf-8, cp1252"
        )
    for name in ("use_baseline", "use_config"):
        flag(f"{function}: {name}", table.get(name, True))
    if "\0" in table.get("config", ""):
        raise UsageError(f"{function}: config: no file can have the name {short(table['config'])}")
    if "tolerance" in table:
        length(f"{function}: tolerance", table["tolerance"], _LARGEST_TOLERANCE, _A_LENGTH)
    # What has a reason stays a value of the job, where reasons belong.
    of_options = {
        name: table.pop(name)
        for name in _OF_OPTIONS
        if name in table and not (name in _WITH_REASON and isinstance(table[name], dict))
    }
    _check(function, of_options)
    job = _job(function, table)
    changes = of_options.pop("changes", {})
    of_job = keywords(function, job, changes)
    levels = job.pop("severities", {})
    reasoned = {name: level for name, level in levels.items() if not isinstance(level, str)}
    if reasoned:
        job["severities"] = reasoned
    of_options["changes"] = tuple(f"{key}={value}" for key, value in changes.items())
    of_options["severities"] = tuple(f"{name}={level}" for name, level in levels.items() if name not in reasoned)
    named = {name: f"{function}: {name} " for name in ("changes", "select", "ignore", "severities", "baseline")}
    paths: dict[str, Any] = {name: Path(of_options[name]) for name in ("baseline", "config") if name in of_options}
    if "drawings" in of_options:
        paths["drawings"] = [Path(path) for path in of_options["drawings"]]
    return Options(**{**of_options, **paths, **more}, named=named, keywords=of_job)


def _is_encoding(name: str) -> bool:
    from polarcheck.program.reading.source import is_encoding  # late: it loads NumPy

    return is_encoding(name)


def _job(function: str, table: dict[str, Any]) -> dict[str, Any]:
    """Return keywords as the tables of a job file. Raises UsageError for a tool that is neither R nor a table."""
    of_run = {name: table.pop(name) for name in Running.__struct_fields__ if name in table}
    if of_run:
        table["run"] = of_run
    for name, key in (("tools", "radius"), ("work_offsets", "x")):
        entries = table.get(name, {})
        if not isinstance(entries, dict):
            raise UsageError(f"{function}: {name}: expected {key} by {_KEYED[name]}, found {short(entries)}")
        for of, entry in entries.items():
            if not isinstance(entry, dict) and not _is_number(entry):
                raise UsageError(
                    f"{function}: {name}.{of}: expected {key} as a number, or a table, found {short(entry)}"
                )
        if entries:
            table[name] = {of: {key: entry} if _is_number(entry) else entry for of, entry in entries.items()}
    if isinstance(table.get("part"), dict):
        table["part"] = [table["part"]]
    return table


_KEYED = {"tools": "tool offset as {8: 6.35}", "work_offsets": 'code as {"G54": 0.0}'}


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _check(function: str, values: Mapping[str, Any]) -> None:
    """Raise UsageError for values of keywords that no job file has."""
    if not isinstance(values.get("changes", {}), dict):
        raise UsageError(f"{function}: changes: expected keys with values, found {short(values['changes'])}")
    for folder in values.get("subprograms", ()):
        if not os.path.isdir(folder):  # noqa: PTH112  Path.is_dir raises for some names
            raise UsageError(f"{function}: subprograms: there is no folder {display_path(folder)}")


def paths_of(function: str, paths: PathName | Iterable[PathName]) -> list[str]:
    """
    Return paths as texts; a file with the name `-` is a file.

    Raises UsageError for what is no path.
    """
    listed: Iterable[Any] = [paths] if isinstance(paths, str | os.PathLike | bytes) else paths
    try:
        each = iter(listed)  # an array without dimensions is Iterable, too
    except TypeError:
        each = None
    if each is None or isinstance(listed, Mapping):
        raise UsageError(f"{function}: expected {_A_PATH}, found {short(paths)}")
    return [path_of(function, path) for path in each]


_A_PATH = "the path of a program or folder"


def path_of(argument: str, path: Any, expected: str = _A_PATH) -> str:
    """Return a path as a text, as paths_of does."""
    name = plain(argument, path, files=[""]) if isinstance(path, str | os.PathLike) else None
    if not isinstance(name, str) or not name:
        raise UsageError(f"{argument}: expected {expected}, found {short(path)}")
    return os.path.join(os.curdir, name) if name == "-" else name  # noqa: PTH118
