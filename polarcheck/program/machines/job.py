"""What belongs to the job: tool offsets, stock, work offsets, how programs are run, what is asked of the check."""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from typing import Annotated, Any, ClassVar, Literal

import msgspec

from polarcheck.foundation.errors import JobError, UsageError, suggestion
from polarcheck.foundation.patterns import lazy_pattern
from polarcheck.program.machines.machine import Machine
from polarcheck.program.machines.offset_keys import OffsetKey, canonical, is_plain_number
from polarcheck.program.machines.part_keys import Part
from polarcheck.program.machines.value_checks import Variable
from polarcheck.program.machines.value_types import EXPECTED, MOST, KeyedError, MisfitError, are_numbers, fitted

#: The file that a job stands in, and the one in which a table [tool.polarcheck] may hold it.
FILE_NAME, PROJECT = "polarcheck.toml", "pyproject.toml"

#: Lengths in the units of the file, mm or inch: no lathe and no cutter is larger.
_LARGEST_CUTTER, _LARGEST_LATHE = 1000, 20_000

#: Blocks and statements that anybody waits for.
_MOST = 10**12


Level = Literal["error", "warning", "note", "off"]
Unit = Literal["mm", "inch"]
Reason = Annotated[str, msgspec.Meta(pattern=r"\S", description="why", extra={EXPECTED: "a text that says why"})]
_Width = Annotated[float, msgspec.Meta(gt=0, le=_LARGEST_LATHE)]
_NotNegative = Annotated[float, msgspec.Meta(ge=0, le=_LARGEST_LATHE)]
_Coordinate = Annotated[float, msgspec.Meta(ge=-_LARGEST_LATHE, le=_LARGEST_LATHE)]
_Bound = Annotated[int, msgspec.Meta(ge=1, le=_MOST)]


class Tool(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    An entry of the offset table and what is mounted there; NaN is unknown. source: who says so.

    radius: R of the offset table, with wear
    nose: T of the offset table; 0 for a mill
    x_wear: X of the wear in the offset table
    diameter: of the cutter, where R is not half of it
    teeth: of the cutter, for the chip load
    """

    source: ClassVar[str] = "job"

    # A negative R is the builder's own way to make a contour a little larger.
    radius: Annotated[float, msgspec.Meta(ge=-_LARGEST_CUTTER, le=_LARGEST_CUTTER)] = math.nan
    nose: Annotated[int, msgspec.Meta(ge=0, le=9)] | None = None
    x_wear: _Coordinate = 0.0
    diameter: Annotated[float, msgspec.Meta(gt=0, le=2 * _LARGEST_CUTTER)] = math.nan
    mount: Literal["axial", "radial"] | None = None
    shape: Literal["flat", "ball"] | None = None
    teeth: Annotated[int, msgspec.Meta(ge=1, le=1000)] | None = None


class AskedTool(Tool, frozen=True):
    """One whose R the command line gives."""

    source: ClassVar[str] = "command line"


class PunchedTool(Tool, frozen=True):
    """One that the control has punched out."""

    source: ClassVar[str] = "offset table"


class Stock(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    The bar or blank. unknown: nothing is taken from the turning or the comments of the program either.

    diameter: of a round bar
    hexagon: across flats of a hexagon bar
    bore: inside diameter of a tube
    face: Z of its face before milling
    clearance: between bar and cutter at the approach
    unknown: take no bar from the turning or the comments of programs
    """

    diameter: _Width = math.nan
    hexagon: _Width = math.nan
    bore: _NotNegative = 0.0
    face: _Coordinate = math.nan
    clearance: _NotNegative = 0.0
    unknown: bool = False

    def __post_init__(self) -> None:
        if not are_numbers(self.diameter, self.hexagon, self.bore):
            return
        if not math.isnan(self.diameter) and not math.isnan(self.hexagon):
            raise KeyedError("", "stock: give diameter or hexagon, not both")
        if self.unknown is True and not (math.isnan(self.diameter) and math.isnan(self.hexagon)):
            raise KeyedError("", "stock: unknown = true and a size contradict each other")
        outside = self.hexagon if math.isnan(self.diameter) else self.diameter
        if self.bore >= outside:
            raise KeyedError("", f"stock: bore {self.bore:g} leaves nothing of {outside:g}")


class WorkOffset(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Where X0 of a work offset lies: 0 on the spindle axis."""

    x: _Coordinate = 0.0


class Running(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    How programs are executed, and what a run may take; reaching a bound is a finding, never a hang.

    subprograms: folders in which called programs are looked for, and nowhere else
    max_blocks: executed blocks beyond those of the file
    max_statements: macro statements, calls and returns, likewise
    max_seconds: seconds of processor time for each MB
    variables: values of #-variables, by number
    """

    block_skip: Literal["off", "on", "both"] = "both"
    subprograms: list[str] = []
    max_blocks: _Bound = 200_000
    max_statements: _Bound = 50_000
    max_seconds: Annotated[float, msgspec.Meta(gt=0)] = 8.0
    variables: dict[Variable, float] = {}


class Reasoned(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """A severity with its reason: a rule that is switched off or lowered with a reason leaves the verdict as it is."""

    level: Level
    reason: Reason


class ReasonedRules(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Rules, groups or alarms that are selected or ignored, with the reason, which leaves the verdict as it is."""

    rules: list[str]
    reason: Reason


#: What a job file may write for the severity of a rule, and for `select` and `ignore`.
WrittenLevel = Annotated[
    Level | Reasoned,
    msgspec.Meta(extra={EXPECTED: 'error, warning, note or off, or { level = "off", reason = "..." }'}),
]
WrittenRules = Annotated[
    list[str] | ReasonedRules,
    msgspec.Meta(extra={EXPECTED: 'a list of names, or { rules = ["..."], reason = "..." }'}),
]


def level_of(written: Level | Reasoned) -> str:
    """Return the severity, with or without a reason."""
    return written.level if isinstance(written, Reasoned) else written


def names_of(written: list[str] | ReasonedRules) -> list[str]:
    """Return the names of `select` or `ignore`, with or without a reason."""
    return written.rules if isinstance(written, ReasonedRules) else written


def reason_of(written: object) -> str:
    """Return the reason of a severity, of `select` or of `ignore`; empty without one."""
    return written.reason if isinstance(written, Reasoned | ReasonedRules) else ""


class OfPrograms(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    What a job file says of all its programs or, under [[programs]], of some of them. tools: by the keys of their
    offsets (offset_keys.canonical). work_offsets: by name (G54).

    machine: name or TOML file of the lathe
    units: of the lengths in this file; else the program's own
    program_units: of programs with neither G20 nor G21
    tools: tool offsets by number, 8 for T0808
    radius_from_comments: take R of unknown offsets from comments such as 3/4 DIA. CUTTER
    work_offsets: where X0 of each work offset lies, by its code (G54)
    offsets: file with the offset table of the control, punched out or copied
    select: only these rules, groups or alarms
    ignore: all rules but these, groups or alarms
    severities: severity by rule, group or alarm; with a reason it leaves the verdict as it is
    limits: [limits] of the lathe, over its own
    fail_on: the least severity that fails
    max_warnings: more warnings than this, over the run, fail it
    strict: fail where a file is unverified, too
    encoding: of the programs: cp1252, shift_jis; else found out
    inline: heed comments of programs that allow a finding
    baseline: file of known findings, which `polarcheck baseline create` writes
    """

    machine: str | None = None
    units: Unit | None = None
    program_units: Unit | None = None
    tools: dict[OffsetKey, Tool] = {}
    stock: Stock = Stock()
    run: Running = Running()
    radius_from_comments: bool = False
    work_offsets: dict[str, WorkOffset] = {}
    offsets: str | None = None
    select: WrittenRules = []
    ignore: WrittenRules = []
    severities: dict[str, WrittenLevel] = {}
    limits: dict[str, float | bool] = {}
    fail_on: Literal["error", "warning", "note", "never"] = "warning"
    max_warnings: Annotated[int, msgspec.Meta(ge=0, le=MOST)] | None = None
    strict: bool = False
    encoding: str | None = None
    inline: bool = True
    baseline: str | None = None

    def __post_init__(self) -> None:
        tools: dict[str, Tool] = {}
        written: dict[str, str] = {}
        for name, tool in self.tools.items():
            key = canonical(name)
            if key in tools:
                raise ValueError(f"tools.{written[key]} and tools.{name} are one tool offset")
            tools[key], written[key] = tool, name
        msgspec.structs.force_setattr(self, "tools", tools)


class Programs(OfPrograms, frozen=True):
    """
    What applies to some programs, over what the file says of all; of several entries the last one counts.

    files: patterns of names (O12*.nc) or paths (lathe7/**), relative to this file; capitals are ignored
    """

    files: Annotated[list[str], msgspec.Meta(min_length=1)]


class Job(OfPrograms, frozen=True):
    """
    A job file, or what of it and its entries applies to one program.

    extensions: endings of the programs in a folder, instead of .nc, .tap and others
    exclude: patterns of files and folders that no walk through a folder finds
    extend: another job file, or the folder of one, whose values apply where this has none
    root: no job file of a folder above is meant for these programs
    part: what programs should make; of entries for one section and Z the last one counts
    programs: entries for some of the programs, in their order
    """

    extensions: list[str] = []
    exclude: list[str] = []
    extend: str | None = None
    root: bool = False
    part: list[Part] = []
    programs: list[Programs] = []


def from_table(table: Any, title: str) -> Job:
    """A job from the values of a file. Raises JobError that names the title and the key."""
    try:
        return fitted(table, Job)
    except MisfitError as misfit:
        raise JobError(f"{title}: {misfit}") from None


def with_tool(job: Job, option: str) -> Job:
    """
    The job with one `--tool 8:radius=0.375,nose=0` merged in; T8 is the offset number 8, too, MILL_8/1 a tool's edge.

    Raises UsageError that says what was meant.
    """
    name, pairs = _parts_of_tool(option)
    values: dict[str, Any] = {}
    for pair in pairs.split(","):
        key, equals, value = (part.strip() for part in pair.partition("="))
        if key.isdecimal() and not equals and values:
            last, before = list(values.items())[-1]
            raise UsageError(f"--tool {option}: {last}: write {before}.{key}, with a decimal point")
        if key not in Tool.__struct_fields__ or not equals:
            hint = suggestion(key, Tool.__struct_fields__).removeprefix("; ")
            raise UsageError(f"--tool {option}: {key or 'no key'}: {hint or f'keys are {_KEYS_OF_TOOL}'}")
        values[key] = _number(value)
    known_tool = job.tools.get(canonical(name), Tool())
    kind = AskedTool if "radius" in values else type(known_tool)
    try:
        table = {**_given(msgspec.to_builtins(known_tool)), **values}
        (given,) = fitted({"tools": {name: table}}, Job).tools.values()
    except MisfitError as misfit:
        text = re.sub(rf"^tools\.{re.escape(name)}(\.|: )", "", str(misfit))
        raise UsageError(f"--tool {option}: {text}") from None
    tool = kind(**msgspec.structs.asdict(given))
    return msgspec.structs.replace(job, tools={**job.tools, canonical(name): tool})


_KEYS_OF_TOOL = ", ".join(Tool.__struct_fields__)


def key_of_option(option: str) -> str:
    """
    The key of the offset of a `--tool` option; of T0808 it hangs on the control which digits are the offset.

    Raises UsageError that says what was meant.
    """
    return canonical(_parts_of_tool(option)[0])


def _parts_of_tool(option: str) -> tuple[str, str]:
    """Split an option into name and keys at its colon; a name may hold colons, blanks and quotes."""
    first, colon, rest = option.partition(":")
    name = _plain_number(first.strip(), option) if colon else None
    if name is not None:
        return name, rest
    written, colon, rest = option.rpartition(":")
    quoted = _QUOTED.fullmatch(written.strip())
    name = f"{quoted[1]}{quoted[2] or '/1'}" if quoted else written.strip()
    if not name or _LIKE_NUMBER.fullmatch(name):
        raise UsageError(_expected_number(option))
    return name, rest


def _expected_number(option: str) -> str:
    return f"--tool {option}: expected NUMBER:KEY=VALUE as in 8:radius=0.375"


_QUOTED = lazy_pattern(r'"([^"]+)"(/[0-9]+)?')
_LIKE_NUMBER = lazy_pattern(r"[-+.]++[0-9.]*+|[0-9.]++")


def _plain_number(written: str, option: str) -> str | None:
    digits = written[1:] if written[:1] in ("T", "t") else written
    if not digits.isascii() or not digits.isdecimal():
        return None
    if digits != written and len(digits) > _DIGITS_OF_OFFSET:
        raise UsageError(
            f"--tool {option}: expected the offset number alone, as in {int(digits[-_DIGITS_OF_OFFSET:])}:radius=0.375"
        )
    # Longer numbers are cut: they are too large all the same.
    return digits.lstrip("0")[: _DIGITS_OF_T + 1] or "0"


_DIGITS_OF_T = 8
#: T8 and T08 can only be read in one way.
_DIGITS_OF_OFFSET = 2


def check_tools(job: Job, options: Iterable[str], machine: Machine, where: Callable[[str], str]) -> None:
    """
    Raises UsageError or JobError, which names the option, or the key and where it stands (at), for a tool by its name
    or edge on a machine that has offset numbers alone.
    """
    if machine.has_edges:
        return
    for option in options:
        if not is_plain_number(key_of_option(option)):
            raise UsageError(_expected_number(option))
    for key, tool in job.tools.items():
        if not is_plain_number(key) and isinstance(tool, PunchedTool):
            raise JobError(
                f"the offset table has {key}, an edge or name of a tool; this machine has offset numbers alone"
            )
        if not is_plain_number(key):
            raise JobError(
                f"{where(f'tools.{key}')}: tools.{key}: expected the number of a tool offset, 8 for T0808, found {key}"
            )


def check_work_offsets(job: Job, machine: Machine, where: Callable[[str], str]) -> None:
    """Raises JobError, which names the key and where it stands (at), for a work offset that the machine has not."""
    of_machine = machine.codes("work_offset")
    extended = machine.codes("work_offset_extended")
    for name in job.work_offsets:
        code, _, number = name.upper().partition(" P")
        if code in of_machine if not number else code in extended and number.isdecimal():
            continue
        listed = [code.replace("-", " to ") for code in machine.g_codes.work_offset]
        expected = " or ".join([*listed, *(f'"{code} P1"' for code in extended)]) or "none on this machine"
        raise JobError(f"{where(f'work_offsets.{name}')}: work_offsets.{name}: expected {expected}, found {name}")


def _number(text: str) -> float | str:
    """.25 and +3 are numbers to a machinist."""
    try:
        value = float(text)
    except ValueError:
        return text
    return int(value) if value.is_integer() and abs(value) < _LARGEST_LATHE else value


def _given(values: Mapping[str, Any]) -> dict[str, Any]:
    return {
        key: value
        for key, value in values.items()
        if value is not None and not (isinstance(value, float) and math.isnan(value))
    }
