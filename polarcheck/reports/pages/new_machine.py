"""The machine file for a user's lathe: the questions for its builder, with a place for each answer."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from typing import Any

import msgspec

from polarcheck.program.machines.machine import meanings
from polarcheck.program.machines.parameters import Meaning
from polarcheck.program.machines.profiles import MERGED, Profile, load
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports.pages.new_job import COLUMNS, prose, toml
from polarcheck.rules.rule import load_all

#: The keys that a shop may want to set, by table, each with an example for when its value is unknown, or None.
_QUESTIONS: dict[str, dict[str, Any]] = {
    "limits": {
        "c_feed": 3600,
        "c_acceleration": 7200,
        "x_feed": 5000,
        "x_acceleration": 2000,
        "x_rapid": 12000,
        "z_rapid": 24000,
        "c_rapid": 72000,
        "live_tool_speed": 6000,
        "block_time": 0.004,
        "polar_feed": 2000,
        "polar_feed_clamps": True,
        "automatic_override": True,
        "override_share": 90,
        "keep_out": 0.1,
        "x_minimum": -10.0,
        "x_maximum": 200.0,
        "z_minimum": -500.0,
        "z_maximum": 300.0,
    },
    "m_codes": {
        "c_axis_on": ["M35"],
        "c_axis_off": ["M34"],
        "c_axis_clamp": ["M210"],
        "c_axis_unclamp": ["M212"],
        "live_tool_on": ["M33"],
        "live_tool_off": ["M5"],
        "spindle_on": ["M3", "M4"],
        "spindle_off": ["M5"],
        "sub_c_axis_on": ["M135"],
        "sub_c_axis_off": ["M134"],
        "sub_c_axis_clamp": ["M310"],
        "sub_c_axis_unclamp": ["M312"],
        "sub_spindle_on": ["M103", "M104"],
        "sub_spindle_off": ["M105"],
        "tool_change": ["M6"],
        "optional_stop": ["M1"],
        "program_end": ["M2", "M30"],
        "stops_reading_ahead": ["M0", "M1"],
    },
    # Each names a list of G codes; the example is the first code in it.
    "power_on": {
        "motion": "rapid",
        "plane": "plane_zx",
        "feed_mode": "feed_per_revolution",
        "distance": "absolute",
    },
    "feed": {
        "cutting_minimum": 25,
        "cutting_maximum": 250,
        "positioning_minimum": 750,
        "positioning_maximum": 1500,
        "carried_into_polar": "modal",
        **dict.fromkeys(("dwell_words", "dwell_per_revolution")),
    },
    "polar": {
        **dict.fromkeys(("on", "off", "virtual_axis", "virtual_axis_incremental", "x", "virtual_axis_programming")),
        "allowed_codes": ["+G93", "-G80"],
        **dict.fromkeys(
            (
                *("words_beside_switch", "plane_before", "other_axes", "feed_measures", "repeated_z"),
                *("center_error", "linear_axis", "rotary_axis"),
            )
        ),
        "main_spindle_must_stop": None,
    },
    "control": {
        **dict.fromkeys(("g_code_system", "units", "x", "number_without_point", "m_code_limit", "offset_digits")),
        "rotary_rolls_over": None,
        "axes": [],
        "known_codes": ["+G150"],
    },
    "arcs": dict.fromkeys(("tolerance", "sweep_limit")),
    "compensation": {
        **dict.fromkeys(("start_up", "start_up_with_move", "corner", "corner_arc_above", "corner_arc_from")),
        **dict.fromkeys(("read_ahead", "interference", "leaving_cancels")),
    },
}
#: Lists that are written as differences from the inherited list.
_DIFFERING = ("allowed_codes", "known_codes")
#: The comment before the keys of a table.
_HEADS = {
    "m_codes": 'Where a word beside it tells one M code apart, write both: live_tool_on = ["M3 P12"]. The keys with'
    " sub_ are those of a sub-spindle with codes of its own.",
    "power_on": "G codes that are in force when a program begins and selects none",
    "polar": 'Lists of codes may say what differs from the inherited one, + or - before each code: ["+G93", "-G80"].',
}
#: What a setter knows without the builder's manual: table, question, and the keys that answer it. They are numbered
#: from 2: question 1 is the control, from which the file inherits.
_SHORT: tuple[tuple[str, str, tuple[str, ...]], ...] = (
    (
        "control",
        "Is feed per minute G98 and per revolution G99 (A), or G94 and G95 beside G90 and G91 (B)?",
        ("g_code_system",),
    ),
    ("control", "Is X60. a diameter of 60, or a radius?", ("x",)),
    (
        "polar",
        "Which codes begin and end the polar mode; between them, which address has the second axis, and is X60. a"
        " diameter there?",
        ("on", "off", "virtual_axis", "x"),
    ),
    ("limits", "How fast may C turn while it cuts? Turns in a minute times 360.", ("c_feed",)),
    ("limits", "How fast does the live tool turn at most?", ("live_tool_speed",)),
    (
        "m_codes",
        "Which M codes make the spindle the C axis, and the C axis the spindle again?",
        ("c_axis_on", "c_axis_off"),
    ),
    ("m_codes", "Which M codes clamp C for drilling, and release it?", ("c_axis_clamp", "c_axis_unclamp")),
    ("m_codes", "Which M codes start and stop the live tool?", ("live_tool_on", "live_tool_off")),
    ("power_on", "Which feed is in force when the lathe is switched on?", ("feed_mode",)),
)
_TABLE_OF_RADII = (
    "R of the tools is not the lathe's, but that of the job: punch out the offset table of the control, and write"
    ' offsets = "FILE" into polarcheck.toml beside the programs, or [tools.8] with radius = 4.0, and'
    ' machine = "{file}.toml". `polarcheck init` writes that file. All that can be said of a lathe is in the file'
    " that `polarcheck machines new {file} --from {inherits}` writes without --short."
)
_TOOLS = (
    "The tools of the turret, and which are radial or axial, flat or ball, belong to the job: [tools.8] with radius,"
    " mount and shape in polarcheck.toml beside the programs, where machine = names this file. Lists of G codes by what"
    " they do, macro variables and offsets are shown by `polarcheck machines`, and may be given here, too."
)
#: A longer list is broken into several lines [characters].
_LONGEST = 180


def text(name: str, inherits: str) -> str:
    """
    Return a TOML file for a lathe of this name that inherits from a machine; all answers are commented out.

    Raises MachineError for an unknown machine.
    """
    profile = load(inherits)
    lines = [
        *prose(
            f"{name}: a lathe of our own. All that is not said here is as on {profile.machine.title}. Take the # away"
            " from a line to answer it; give a source with { value = ..., source = ... } if you like. Then"
            " `polarcheck machines check` with this file tells whether it is sound, and what is still to be answered.",
        ),
        f"inherits = {_toml(inherits)}",
        f"title = {_toml(name)}",
        *_questions(profile),
        *_doubtful(profile),
        *_parameters(profile),
        *_alarms_and_severities(profile),
        "",
        *prose(_TOOLS),
    ]
    # Text from another file is escaped: a line end in it would end the comment.
    return "\n".join(map(visible, lines)) + "\n"


def short_text(name: str, inherits: str) -> str:
    """
    Return a TOML file with the ten answers that a setter can give, commented out but for the control.

    Raises MachineError for an unknown machine.
    """
    profile = load(inherits)
    lines = [
        *prose(
            f"{name}: a lathe of our own, in ten answers. Behind each # stands what {profile.machine.title} has or,"
            " where that is not known, an example. Take the # away from a line that you can answer, and write what"
            " your lathe has. Then `polarcheck machines check` with"
            " this file tells what is wrong in it.",
        ),
        "",
        *prose("1. Which control? `polarcheck machines` lists them."),
        f"inherits = {_toml(inherits)}",
        f"title = {_toml(name)}",
    ]
    group = ""
    for number, (table, question, keys) in enumerate(_SHORT, 2):
        lines += ["", *([f"[{table}]"] if table != group else []), *prose(f"{number}. {question}")]
        group = table
        meaning = meanings(type(getattr(profile.written, table)))
        for key in keys:
            lines += _answer(key, _example(profile, table, key, _QUESTIONS[table].get(key)), meaning[key])
    lines += ["", *prose(_TABLE_OF_RADII.format(file=name, inherits=inherits))]
    return "\n".join(map(visible, lines)) + "\n"


def _example(profile: Profile, group: str, key: str, answer: Any) -> Any:
    """Return the value of the machine or, where that is not known, the example `answer`."""
    if group == "power_on":
        answer = next(iter(profile.machine.codes(answer)), "")
    value = getattr(getattr(profile.written, group), key)
    if (group, key) == ("control", "x"):
        value = profile.written.control.x_without_words or value
    is_known = value not in ([], "") and value == value and key not in _DIFFERING
    return value if is_known or answer is None else answer


def _questions(profile: Profile) -> Iterator[str]:
    """Yield the tables of _QUESTIONS, with the doubts about what the profile says."""
    for group, keys in _QUESTIONS.items():
        yield from ("", f"[{group}]", *prose(_HEADS.get(group, "")))
        table = getattr(profile.written, group)
        meaning = meanings(type(table))
        doubt = ""
        for key, answer in keys.items():
            origin = profile.origins.get(f"{group}.{key}")
            if origin and origin.doubtful and origin.source != doubt:
                doubt = origin.source
                yield from prose(f"in doubt: {doubt}")
            yield from _answer(key, _example(profile, group, key, answer), meaning[key])
        yield from _in_doubt(profile, group, set(keys))


def _alarms_and_severities(profile: Profile) -> Iterator[str]:
    """Yield the alarm and the severity of each rule, as they are without this file."""
    rules, machine = load_all(), profile.machine
    yield from ("", "[alarms]", *prose("what the control shows, by rule; empty where it shows nothing"))
    for rule in rules.values():
        yield f"#{rule.name} = {_toml(machine.alarms.get(rule.name, ''))}  # {rule.title}"
    yield from ("", "[severities]", *prose("error, warning, note or off, by rule"))
    for rule in rules.values():
        yield f"#{rule.name} = {_toml(rule.level(machine.severities))}  # {rule.title}"


def _doubtful(profile: Profile) -> Iterator[str]:
    """Yield the doubtful keys of the tables without questions."""
    table = msgspec.to_builtins(profile.written)
    for group, values in table.items():
        of_other_system = group.startswith("g_code_system_") and group != profile.machine.system_table
        other_tables = (*_QUESTIONS, "known_parameters", "parameters", "alarms", "severities")
        if isinstance(values, dict) and group not in other_tables and not of_other_system:
            lines = list(_in_doubt(profile, group, set()))
            if lines:
                yield from ("", f"[{group}]", *lines)


def _in_doubt(profile: Profile, group: str, listed: set[str]) -> Iterator[str]:
    """Yield the doubtful keys of a table that are not among those listed already; each doubt once."""
    table = getattr(profile.written, group)
    meaning = meanings(type(table))
    doubt = ""
    for key, value in msgspec.to_builtins(table).items():
        origin = profile.origins.get(f"{group}.{key}")
        if origin and origin.doubtful and key not in listed:
            if origin.source != doubt:
                yield from prose(f"in doubt: {origin.source}")
            doubt = origin.source
            # A merged table is extended, not replaced: one entry shows how.
            sample = dict(list(value.items())[:1]) if f"{group}.{key}" in MERGED else value
            yield from _answer(key, sample, meaning.get(key, ""))


def _answer(key: str, value: Any, meaning: str) -> Iterator[str]:
    """Yield a key and its value, commented out, with its meaning behind it or, if that makes it too long, above."""
    first, *further = _lines(f"#{_toml_key(key)} = {_toml(value)}")
    if further:
        yield from (f"# {meaning}", first, *further)
        return
    line = first
    is_short = len(line) + len(meaning) + 4 <= COLUMNS
    if meaning and not is_short:
        yield f"# {meaning}"
    yield f"{line}  # {meaning}" if meaning and is_short else line


def _lines(line: str) -> list[str]:
    """Break a line with a long list of texts into several commented lines."""
    lines = [""]
    for part in re.split(r'(?<=",)(?=")', line):
        if lines[-1] and len(lines[-1]) + len(part) > _LONGEST:
            lines[-1] = lines[-1].rstrip()
            lines.append("#")
        lines[-1] += part
    return lines


def _parameters(profile: Profile) -> Iterator[str]:
    """Yield the control parameters that can be copied from the screen."""
    if not profile.machine.known_parameters:
        return
    yield from ("", "[parameters]", *prose("as the control shows them; each sets the values that it stands for"))
    for name, meaning in profile.machine.known_parameters.items():
        example = _present(profile, meaning) or next(iter(meaning.values), "3600")
        number = example.isascii() and example.replace(".", "").isdecimal()
        yield f"#{_toml(name)} = {example if number else _toml(example)}  # {meaning.title}"


def _present(profile: Profile, meaning: Meaning) -> str:
    """Return the value that a parameter has on the machine; empty if that is not a number or letter."""
    group, _, key = meaning.key.partition(".")
    value = getattr(getattr(profile.machine, group, None), key, None) if key else None
    if meaning.is_letter:
        return str(value)
    if isinstance(value, bool) or not isinstance(value, int | float) or not meaning.factor or math.isnan(value):
        return ""
    return f"{value / meaning.factor:g}"


def _toml_key(key: str) -> str:
    return key if key.isascii() and key.replace("_", "").replace("-", "").isalnum() else _toml(key)


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        inside = ", ".join(f"{_toml(key)} = {_toml(element)}" for key, element in value.items())
        return f"{{ {inside} }}" if inside else "{ }"
    return toml(value)
