"""The machine file for a user's lathe: the questions for its builder, with a place for each answer."""

from __future__ import annotations

import functools
import math
import re
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import msgspec

from polarcheck.program.machines.machine import meanings
from polarcheck.program.machines.parameters import Meaning
from polarcheck.program.machines.profiles import MERGED, Profile, load
from polarcheck.program.reading.excerpt import visible
from polarcheck.reports.pages.new_job import COLUMNS, prose, toml
from polarcheck.rules.rule import load_all

#: Lists that are written as differences from the inherited list.
_DIFFERING = ("allowed_codes", "known_codes")
#: A longer list is broken into several lines [characters].
_LONGEST = 180


@functools.cache
def _asked() -> dict[str, Any]:
    """What new_machine.toml says: questions and heads by table, the questions of --short, what belongs to the job."""
    return tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))


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
        *prose(_asked()["of_job"]["whole"]),
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
    # Question 1 is the control, from which the file inherits.
    for number, asked in enumerate(_asked()["short"], 2):
        table = asked["table"]
        lines += ["", *([f"[{table}]"] if table != group else []), *prose(f"{number}. {asked['question']}")]
        group = table
        meaning = meanings(type(getattr(profile.written, table)))
        for key in asked["keys"]:
            lines += _answer(key, _example(profile, table, key), meaning[key])
    lines += ["", *prose(_asked()["of_job"]["short"].format(file=name, inherits=inherits))]
    return "\n".join(map(visible, lines)) + "\n"


def _example(profile: Profile, group: str, key: str) -> Any:
    """Return the value of the machine or, where that is not known, the example."""
    answer = _asked()["questions"][group].get(key, "")
    if group == "power_on":
        answer = next(iter(profile.machine.codes(answer)), "")
    value = getattr(getattr(profile.written, group), key)
    if (group, key) == ("control", "x"):
        value = profile.written.control.x_without_words or value
    is_known = value not in ([], "") and value == value and key not in _DIFFERING
    return value if is_known or answer == "" else answer


def _questions(profile: Profile) -> Iterator[str]:
    """Yield the tables with questions, with the doubts about what the profile says."""
    for group, keys in _asked()["questions"].items():
        yield from ("", f"[{group}]", *prose(_asked()["heads"].get(group, "")))
        table = getattr(profile.written, group)
        meaning = meanings(type(table))
        doubt = ""
        for key in keys:
            origin = profile.origins.get(f"{group}.{key}")
            if origin and origin.doubtful and origin.source != doubt:
                doubt = origin.source
                yield from prose(f"in doubt: {doubt}")
            yield from _answer(key, _example(profile, group, key), meaning[key])
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
        other_tables = (*_asked()["questions"], "known_parameters", "parameters", "alarms", "severities")
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
