"""What belongs to the job: tool offsets, stock, options. From polarcheck.toml, pyproject.toml or an offset table."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec

from polarcheck.errors import JobError, UsageError

FILE_NAME = "polarcheck.toml"


class Tool(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An entry of the offset table and what is mounted there; NaN is unknown."""

    radius: Annotated[float, msgspec.Meta(description="R of the offset table, with wear")] = math.nan
    nose: Annotated[int, msgspec.Meta(ge=0, le=9, description="T of the offset table; 0 for a mill")] | None = None
    diameter: Annotated[float, msgspec.Meta(gt=0, description="of the cutter, where R is not half of it")] = math.nan
    mount: Literal["axial", "radial"] | None = None
    shape: Literal["flat", "ball"] | None = None


class Stock(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The bar or blank."""

    diameter: Annotated[float, msgspec.Meta(gt=0)] = math.nan
    clearance: Annotated[float, msgspec.Meta(ge=0)] = 0.0


class WorkOffset(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where X0 of a work offset lies: 0 on the spindle axis."""

    x: float = 0.0


class Running(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """How programs are executed, and what a run may take; reaching a bound is a finding, never a hang."""

    block_skip: Literal["off", "on", "both"] = "both"
    subprograms: Annotated[
        list[str], msgspec.Meta(description="folders in which called programs are looked for, and nowhere else")
    ] = []
    max_blocks: Annotated[int, msgspec.Meta(ge=1, description="executed blocks")] = 200_000
    max_statements: Annotated[int, msgspec.Meta(ge=1, description="macro statements, calls and returns")] = 50_000
    max_seconds: Annotated[float, msgspec.Meta(gt=0)] = 20.0
    variables: Annotated[dict[int, float], msgspec.Meta(description="values of #-variables, by number")] = {}


class Job(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A job. tools: by offset number (T0808: 8). work_offsets: by name (G54)."""

    machine: Annotated[str, msgspec.Meta(description="name or TOML file of the lathe")] | None = None
    units: (
        Annotated[
            Literal["mm", "inch"], msgspec.Meta(description="of the lengths in this file; else the program's own")
        ]
        | None
    ) = None
    program_units: (
        Annotated[Literal["mm", "inch"], msgspec.Meta(description="of programs with neither G20 nor G21")] | None
    ) = None
    tools: dict[int, Tool] = {}
    stock: Stock = Stock()
    run: Running = Running()
    radius_from_comments: Annotated[
        bool, msgspec.Meta(description="take R of unknown offsets from comments such as 3/4 DIA. CUTTER")
    ] = False
    work_offsets: dict[str, WorkOffset] = {}
    offsets: (
        Annotated[str, msgspec.Meta(description="offset table punched out by the control (G10 P.. R.. Q..)")] | None
    ) = None
    select: list[str] = []
    ignore: list[str] = []
    severities: dict[str, Literal["error", "warning", "note", "off"]] = {}
    extensions: list[str] = []
    limits: dict[str, float | bool] = {}


def find(path: Path) -> Path | None:
    """The job file of a program: the nearest polarcheck.toml or [tool.polarcheck] from its folder upward."""
    folder = path.resolve() if path.is_dir() else path.resolve().parent
    for candidate in (folder, *folder.parents):
        if (candidate / FILE_NAME).is_file():
            return candidate / FILE_NAME
        project = candidate / "pyproject.toml"
        if project.is_file() and "[tool.polarcheck" in project.read_text("utf-8", "replace"):
            return project
    return None


def load(path: Path) -> Job:
    """The job of a polarcheck.toml or pyproject.toml. Raises JobError with file and key."""
    import tomllib

    try:
        table = tomllib.loads(path.read_text("utf-8"))
    except (OSError, UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
        raise JobError(f"{path}: {error}") from None
    if path.name == "pyproject.toml":
        table = table.get("tool", {}).get("polarcheck", {})
    job = from_table(table, str(path))
    folders = [str(path.parent / folder) for folder in job.run.subprograms]
    job = msgspec.structs.replace(job, run=msgspec.structs.replace(job.run, subprograms=folders))
    if job.offsets is not None:
        listed = read_offsets((path.parent / job.offsets), job.offsets)
        job = msgspec.structs.replace(job, tools={**listed, **job.tools})
    return job


def from_table(table: Mapping[str, Any], title: str) -> Job:
    """A job from the values of a file. Raises JobError that names the title and the key."""
    try:
        return msgspec.convert(dict(table), Job, strict=False)
    except msgspec.ValidationError as error:
        text, _, where = str(error).partition(" - at `$")
        key = where.rstrip("`").lstrip(".")
        if "unknown field" in text:
            unknown = text.split("`")[1]
            known = {field for kind in (Job, Tool, Stock, WorkOffset, Running) for field in kind.__struct_fields__}
            import difflib

            near = difflib.get_close_matches(unknown, known, 1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise JobError(f"{title}: unknown key {f'{key}.{unknown}' if key else unknown}{hint}") from None
        raise JobError(f"{title}: {key or 'file'}: {text[:1].lower()}{text[1:]}") from None


def with_tool(job: Job, option: str) -> Job:
    """
    The job with one `--tool 8:radius=0.375,nose=0` merged in.

    Raises UsageError that says what was meant.
    """
    number, colon, pairs = option.partition(":")
    if not colon or not number.strip().isdecimal():
        raise UsageError(f"--tool {option}: expected NUMBER:KEY=VALUE as in 8:radius=0.375")
    values: dict[str, Any] = {}
    for pair in pairs.split(","):
        key, equals, value = (part.strip() for part in pair.partition("="))
        if key not in Tool.__struct_fields__ or not equals:
            import difflib

            near = difflib.get_close_matches(key, Tool.__struct_fields__, 1)
            meant = f"did you mean {near[0]}?" if near else f"keys are {', '.join(Tool.__struct_fields__)}"
            raise UsageError(f"--tool {option}: {key or 'no key'}: {meant}")
        values[key] = _number(value)
    known = msgspec.to_builtins(job.tools.get(int(number), Tool()))
    try:
        tool = msgspec.convert({**_given(known), **values}, Tool, strict=False)
    except msgspec.ValidationError as error:
        text, _, where = str(error).partition(" - at `$.")
        raise UsageError(f"--tool {option}: {where.rstrip('`')}: {text[:1].lower()}{text[1:]}") from None
    return msgspec.structs.replace(job, tools={**job.tools, int(number): tool})


def _number(text: str) -> float | str:
    """.25 and +3 are numbers to a machinist."""
    try:
        value = float(text)
    except ValueError:
        return text
    return int(value) if value.is_integer() else value


def _given(values: Mapping[str, Any]) -> dict[str, Any]:
    return {
        key: value
        for key, value in values.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }


_OFFSET = re.compile(r"G10\s*P\s*(\d+)((?:\s*[A-Z]\s*[-+]?\d*\.?\d*)*)")
_VALUE = re.compile(r"([RQ])\s*([-+]?\d*\.?\d+|[-+]?\d+\.)")
#: P10001 is the geometry of offset 1, P1 its wear (B-63524EN/01 p. 285).
_GEOMETRY = 10000


def read_offsets(path: Path, title: str) -> dict[int, Tool]:
    """
    The offset table that a control punched out: `G10 P10008 X.. Z.. R.. Q..`; R of geometry and wear are added.

    Raises JobError for a file that cannot be read or holds no offset.
    """
    try:
        text = path.read_bytes().decode("latin-1").upper()
    except OSError as error:
        raise JobError(f"{title}: {error.strerror}") from None
    radius: dict[int, float] = {}
    nose: dict[int, int] = {}
    for match in _OFFSET.finditer(text):
        number = int(match[1]) % _GEOMETRY
        for address, value in _VALUE.findall(match[2]):
            if address == "R":
                radius[number] = radius.get(number, 0.0) + float(value)
            elif int(match[1]) >= _GEOMETRY or number not in nose:
                nose[number] = int(float(value))
    if not radius and not nose:
        raise JobError(f"{title}: no offsets found; expected blocks such as G10 P10008 R0.375 Q0")
    return {
        number: Tool(radius=radius.get(number, math.nan), nose=nose.get(number))
        for number in sorted(radius.keys() | nose.keys())
    }
