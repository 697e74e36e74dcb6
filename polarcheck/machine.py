"""The control and the lathe: profiles read from TOML, each inheriting from another, every value with its source."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, get_origin

import msgspec

from polarcheck import parameters
from polarcheck.errors import MachineError
from polarcheck.parameters import Meaning, Origin

FOLDER = Path(__file__).parent / "machines"
DEFAULT = "fanuc"


def _is_code(text: str) -> bool:
    return text[:1] == "G" and text[1:].replace(".", "", 1).isdecimal()


class Control(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    How the control reads a program.

    x: what X words are outside the polar mode. motion_codes: codes of other numbers, by what they mean (G101 = "G1").
    native_words: words of the control's own language, and the text of the same length or shorter that is read in their
    place (TRANSMIT = "G12.1"). x_radius_words, x_diameter_words: what makes X a radius or a diameter from then on, a
    code alone ("G7") or with another word ("G10.9 X0").
    """

    g_code_system: Literal["A", "B", "C"]
    units: Literal["mm", "inch"]
    least_increment: float
    least_increment_inch: float
    number_without_point: Literal["least-increment", "whole-unit"]
    digit_limit: int
    word_limit: int
    m_code_limit: int
    line_comments: str
    offset_digits: int
    known_codes: list[str]
    unknown_codes_are_errors: bool
    x: Literal["diameter", "radius"]
    motion_codes: dict[str, str] = {}
    native_words: dict[str, str] = {}
    x_radius_words: list[str] = []
    x_diameter_words: list[str] = []

    def __post_init__(self) -> None:
        for word, text in self.native_words.items():
            if not word or len(text) > len(word):
                raise ValueError(f"native_words: {text!r} has no room in the place of {word!r}")
        for name, meant in self.motion_codes.items():
            if not _is_code(name) or meant not in ("G0", "G1", "G2", "G3"):
                raise ValueError(f"motion_codes: {name} = {meant!r}: expected a G code and one of G0, G1, G2, G3")


class Polar(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    The polar mode.

    x, virtual_axis_is: what words of the linear and of the virtual axis are in the mode. center_words: of arcs, along
    the linear and along the virtual axis. linear_axis, rotary_axis: their numbers, as P and Q beside G12.1 name them.
    infeed_word: beside G12.1, the depth of each cut of a cycle that goes round the contour; empty where there is none.
    other_on: what begins the polar mode of other controls, by which a program for them is known.
    """

    on: list[str]
    off: list[str]
    switch_words: list[str]
    virtual_axis: str
    virtual_axis_increment: str
    other_virtual_axis: list[str]
    other_virtual_axis_of: str = ""
    other_on: list[str] = []
    x: Literal["diameter", "radius"]
    virtual_axis_is: Literal["radius", "diameter"]
    center_words: tuple[str, str]
    linear_axis: int
    rotary_axis: int
    infeed_word: str
    allowed_codes: list[str]
    plane_before: list[str]
    main_spindle_must_stop: bool


class Arcs(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Circular interpolation."""

    tolerance: float
    radius_word: str
    sweep_limit: float


class Compensation(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Cutter compensation."""

    start_up: Literal["A", "B", "C"]
    start_up_moving: Literal["A", "B"]
    read_ahead: int
    interference: Literal["alarm", "erase"]
    tangent_tolerance: float
    nose_types: list[int]
    overcut_tolerance: float


class Limits(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    What the lathe can do; NaN where the profile does not know. mm, deg, min; accelerations in deg/s2; X as radius.

    automatic_override: the control slows down where C would turn faster than override_share [%] of c_feed.
    """

    c_feed: float = math.nan
    c_feed_suspicious: float
    c_acceleration: float = math.nan
    polar_feed: float = math.nan
    automatic_override: bool = False
    override_share: float
    keep_out: float = math.nan
    x_minimum: float = math.nan
    x_maximum: float = math.nan
    z_minimum: float = math.nan
    z_maximum: float = math.nan


class Feed(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Feeds that the builder recommends [mm/min]; NaN where it does not."""

    cutting_minimum: float = math.nan
    cutting_maximum: float = math.nan
    positioning_minimum: float = math.nan
    positioning_maximum: float = math.nan
    inheritance: Literal["modal", "per-minute-only"] = "modal"


class MCodes(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """The builder's M codes; empty where the profile does not know them."""

    c_axis_on: list[str] = []
    c_axis_off: list[str] = []
    live_tool_on: list[str] = []
    live_tool_off: list[str] = []
    spindle_on: list[str] = []
    spindle_off: list[str] = []
    program_end: list[str]
    stops_reading: list[str]


class Macro(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Custom macro and calls. given: values of variables that the job or machine knows, by number."""

    increment: float
    bracket_levels: int
    loop_numbers: int
    loop_levels: int
    subprogram_levels: int
    macro_levels: int
    repeats_in_p: bool
    second_arguments: bool
    signed_angles: bool
    largest_number: float
    given: dict[int, float] = {}


class Machine(msgspec.Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """
    A lathe: the merged profile. severities: rule -> error, warning, note or off. alarms: rule -> alarm. notes: what is
    not known, or why a rule is silent. meanings: control parameter -> the values that it sets. parameters: those of the
    user's own control, as it shows them (parameters.py).
    """

    title: str
    control: Control
    polar: Polar
    arcs: Arcs
    compensation: Compensation
    limits: Limits
    feed: Feed
    m_codes: MCodes
    macro: Macro
    alarms: dict[str, str] = {}
    severities: dict[str, Literal["error", "warning", "note", "off"]] = {}
    notes: list[str] = []
    meanings: dict[str, Meaning] = {}
    parameters: dict[str, int | float | str] = {}


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
