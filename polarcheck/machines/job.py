"""What belongs to the job: tool offsets, stock, work offsets, how programs are run, what is asked of the check."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

import msgspec

from polarcheck.errors import JobError, UsageError


class Tool(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """An entry of the offset table and what is mounted there; NaN is unknown. source: who says so."""

    source: ClassVar[str] = "job"

    radius: Annotated[float, msgspec.Meta(description="R of the offset table, with wear")] = math.nan
    nose: Annotated[int, msgspec.Meta(ge=0, le=9, description="T of the offset table; 0 for a mill")] | None = None
    diameter: Annotated[float, msgspec.Meta(gt=0, description="of the cutter, where R is not half of it")] = math.nan
    mount: Literal["axial", "radial"] | None = None
    shape: Literal["flat", "ball"] | None = None


class AskedTool(Tool, frozen=True):
    """One whose R the command line gives."""

    source: ClassVar[str] = "command line"


class PunchedTool(Tool, frozen=True):
    """One that the control has punched out."""

    source: ClassVar[str] = "offset table"


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
    before = job.tools.get(int(number), Tool())
    known, kind = msgspec.to_builtins(before), AskedTool if "radius" in values else type(before)
    try:
        tool = msgspec.convert({**_given(known), **values}, kind, strict=False)
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
