"""All faults of a machine file in one run: each is left out in turn, so that the next one shows."""

from __future__ import annotations

import copy
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

from polarcheck.foundation.errors import MachineError, suggestion
from polarcheck.program.machines import profiles, toml_lines, toml_text

#: The most faults of a file that are listed; a file with more is none of a machine.
_MOST = 100
_AT_LINE = re.compile(r"\(at line (\d+),")
#: Two lines of a key or table contradict each other: each of them alone is right.
_TWICE = "Cannot overwrite"


def faults(name: str, check: Callable[[profiles.Profile], None]) -> list[str]:
    """
    Return the faults of a machine file, each as one line with file, line and key; none for a sound file.

    check: raises MachineError for what only others can judge. A fault in a file that it inherits from ends the list.
    """
    path = Path(name)
    try:
        text = toml_text.text_of(path, "machine file")
    except ValueError as error:
        return [f"{path}: {error}"]
    table, text, lines = _table(text, str(path))
    if table is None:
        return lines
    where = toml_lines.of_keys(text)
    of_file = f"{path}: "
    while len(lines) < _MOST:
        try:
            check(profiles.load(name, contents=copy.deepcopy(table)))
        except MachineError as error:
            messages = (str(error), *error.others)
        else:
            break
        lines += messages
        of_this = [message for message in messages if message.startswith(of_file)]
        left_out = [_leave_out(table, toml_lines.key_of(message), message) for message in of_this]
        if not any(left_out):
            break
    located = (toml_lines.located(line, where if line.startswith(of_file) else None) for line in lines[:_MOST])
    return sorted(located, key=_line_number)


def _line_number(message: str) -> int:
    match = re.match(r".+?\.toml:(\d+): ", message)
    return int(match[1]) if match else 0


def _table(text: str, title: str) -> tuple[dict[str, Any] | None, str, list[str]]:
    """
    Return the table of a text, the text with blank lines in the place of those that are no TOML, and their faults; no
    table where one of them is unclear.
    """
    lines: list[str] = []
    remaining = text.split("\n")
    while len(lines) < _MOST:
        try:
            text = "\n".join(remaining)
            return toml_text.parsed(text), text, lines
        except ValueError as error:
            message = str(error)
        lines.append(toml_lines.placed(title, message))
        wrong = _wrong_line(remaining, message)
        if wrong is None:
            break
        remaining[wrong] = ""
    return None, text, lines


def _wrong_line(lines: list[str], message: str) -> int | None:
    """The index of the line at fault, if it can be left out: that of the message, or the one before it."""
    match = _AT_LINE.search(message)
    if match is None:
        return None
    index = min(int(match[1]), len(lines)) - 1
    if message.startswith(_TWICE):
        return index
    before = next((line for line in range(index - 1, -1, -1) if lines[line].strip()), index)
    for line in (index, before):
        if not lines[line].lstrip().startswith("[") and "=" in lines[line] and not _is_toml(lines[line]):
            return line
    return None


def _is_toml(line: str) -> bool:
    try:
        toml_text.parsed(line)
    except ValueError:
        return False
    return True


def _leave_out(table: dict[str, Any], key: str, message: str) -> bool:
    """
    Leave a key out of the table of a file, the element of its list that is no code, or the keys of a group that do not
    go together. Return False where nothing is left out.
    """
    if key == "inherits":
        near = suggestion(str(table.get("inherits")), profiles.names(), 1)
        table["inherits"] = near.removeprefix("; did you mean ").rstrip("?")
        return bool(near)
    if key not in table and "." not in key:
        key = f"parameters.{key}"
    group, _, inner = key.partition(".")
    values = table.get(group)
    if not isinstance(values, dict):
        return table.pop(group, None) is not None
    if not inner:
        named = [name for name in values if name in re.findall(r"\w+", message)]
        for name in named:
            del values[name]
        return bool(named) or table.pop(group, None) is not None
    # A key may have points, and a value may be a table: the longest that there is.
    name = max((name for name in values if f"{inner}.".startswith(f"{name}.")), key=len, default="")
    element = re.search(r": '([^']*+)' is ", message)
    listed = values.get(name)
    if element and isinstance(listed, list) and element[1] in listed:
        listed.remove(element[1])
        return True
    return values.pop(name, None) is not None
