"""In which line of a TOML file a key stands: tomllib reads values and forgets where they were."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from polarcheck.program.machines import toml_text

#: `(at line 3, column 5)`, as tomllib ends a message.
_AT_LINE = re.compile(r" \(at line (\d+), column (\d+)\)")
_BLANK = re.compile(r"(?:[ \t\r\n]|#[^\n]*+)*+")
_PART = r"""(?:"((?:[^"\\\n]|\\.)*+)"|'([^'\n]*+)'|([A-Za-z0-9_-]++))"""
_PARTS = re.compile(_PART)
_KEY = re.compile(rf"{_PART}(?:[ \t]*+\.[ \t]*+{_PART})*+[ \t]*+")
# In a text of several lines one or two quotes may stand before the three that end it.
_VALUE = re.compile(
    r'"""(?:[^\\"]|\\[\s\S]|"(?!""))*+"{3,5}'
    r"|'''(?:[^']|'(?!''))*+'{3,5}"
    r'|"(?:[^"\\\n]|\\.)*+"'
    r"|'[^'\n]*+'"
    r"|[^\s,\[\]{}#\"'][^,\n\]}#]*+"
)
#: Parts of a key, those of the tables around it included: more are refused (toml_text), and cost their square here.
_MOST_PARTS = 30


class _UnclearError(Exception):
    """What stands there is not understood: no line is better than a wrong one."""


def of_keys(text: str) -> dict[str, int]:
    """
    The lines, from 1, of the keys of a text that tomllib reads: by key with points between (`tools.8.radius`), tables
    and the tables that hold them included. Of a list of tables the second one is `programs.2`.

    Empty where anything in it is not understood; a key is left out that two may have.
    """
    try:
        keys = list(_Scanner(text).keys())
    except (_UnclearError, RecursionError, IndexError):
        return {}
    lines: dict[str, int] = {}
    whole: dict[str, tuple[str, ...]] = {}
    doubtful: set[str] = set()
    line, seen = 1, 0
    for position, key in keys:
        line += text.count("\n", seen, position)
        seen = position
        for length in range(1, len(key) + 1):
            name = ".".join(key[:length])
            if whole.setdefault(name, key[:length]) != key[:length]:
                doubtful.add(name)
            lines.setdefault(name, line)
    return {name: line for name, line in lines.items() if name not in doubtful}


def line_of(key: str, lines: Mapping[str, int]) -> int | None:
    """The line of a key, else of the nearest table around it that there is; None where nobody knows. lines: of_keys."""
    while key:
        if key in lines:
            return lines[key]
        key = key.rpartition(".")[0]
    return None


def placed(title: str, said: str) -> str:
    """`polarcheck.toml:3: ...` for what tomllib says of a file (title), which names the line at its end."""
    match = _AT_LINE.search(said)
    if match is None:
        return f"{title}: {said}"
    return f"{title}:{match[1]}: {said[: match.start()]} at column {match[2]}{said[match.end() :]}"


def located(said: str, lines: Mapping[str, int] | None = None) -> str:
    """
    Return a message about a key of a machine file, with its line: `lathe.toml:12: limits.c_fed: ...`.

    lines: of_keys of its text, where that is known.
    """
    match = _OF_FILE_AND_KEY.match(said)
    if match is None:
        return said
    try:
        lines_of_keys = of_keys(toml_text.text_of(match[1], "machine file")) if lines is None else lines
    except ValueError:
        return said
    key = match[2].strip("\"'")
    if "no meaning is known for" in said:
        key = f"parameters.{key}"
    elif (first := re.match(r": (\w+) ", said[match.end() :])) and f"{key}.{first[1]}" in lines_of_keys:
        key = f"{key}.{first[1]}"  # of keys that do not go together
    line = line_of(key, lines_of_keys)
    return f"{match[1]}:{line}{said[match.end(1) :]}" if line else said


def key_of(said: str) -> str:
    """Return the key that a message about a machine file names; empty where it names none."""
    match = _OF_FILE_AND_KEY.match(said)
    return match[2].strip("\"'") if match else ""


#: The file, and the key as the different faults name it.
_OF_FILE_AND_KEY = re.compile(
    r"(.+?\.toml): (?:unknown key |unknown table \[|(?:parameters: )?no meaning is known for )?([^\s:;\]]+)"
)


class _Scanner:
    """Goes through a text once, from statement to statement."""

    def __init__(self, text: str) -> None:
        self.text, self.at = text, 0
        #: How many tables each list of tables has had, with the numbers of those around it.
        self.count: dict[tuple[str, ...], int] = {}

    def keys(self) -> Iterator[tuple[int, tuple[str, ...]]]:
        """The places of all keys, and their parts."""
        table: tuple[str, ...] = ()
        self._skip()
        while self.at < len(self.text):
            start = self.at
            if self.text.startswith("[", start):
                table = self._header()
                yield start, table
            else:
                key = (*table, *self._key())
                yield start, key
                yield from self._value(key)
            self._skip()

    def _header(self) -> tuple[str, ...]:
        marks = "[[" if self.text.startswith("[[", self.at) else "["
        self.at += len(marks)
        key = self._key("]")
        if not self.text.startswith("]" * len(marks), self.at - 1):
            raise _UnclearError
        self.at += len(marks) - 1
        *outer, last = key
        around = self._numbered(outer)
        name = (*around, last)
        if marks == "[":
            return self._numbered(key)
        self.count[name] = self.count.get(name, 0) + 1
        return (*name, str(self.count[name]))

    def _numbered(self, key: list[str] | tuple[str, ...]) -> tuple[str, ...]:
        """A key of which the parts that are lists of tables have the number of the last one behind them."""
        path: tuple[str, ...] = ()
        for part in key:
            path = (*path, part)
            if path in self.count:
                path = (*path, str(self.count[path]))
        return path

    def _key(self, end: str = "=") -> tuple[str, ...]:
        self._skip()
        match = _KEY.match(self.text, self.at)
        parts = _PARTS.findall(match[0]) if match else []
        if match is None or len(parts) > _MOST_PARTS or any("\\" in basic for basic, _, _ in parts):
            raise _UnclearError
        self.at = match.end() + 1
        if self.text[self.at - 1] != end:
            raise _UnclearError
        return tuple(map("".join, parts))

    def _value(self, key: tuple[str, ...]) -> Iterator[tuple[int, tuple[str, ...]]]:
        """Go behind a value; the keys of the tables in it."""
        self._skip()
        if end := {"{": "}", "[": "]"}.get(self.text[self.at]):
            yield from self._elements(end, key)
        elif match := _VALUE.match(self.text, self.at):
            self.at = match.end()
        else:
            raise _UnclearError

    def _elements(self, end: str, key: tuple[str, ...]) -> Iterator[tuple[int, tuple[str, ...]]]:
        self.at += 1
        number = 0
        while True:
            self._skip()
            if self.text[self.at] == end:
                self.at += 1
                return
            number += 1
            start = self.at
            if len(key) > _MOST_PARTS:
                raise _UnclearError
            if end == "}":
                inner = (*key, *self._key())
                yield start, inner
                yield from self._value(inner)
            else:
                inner = (*key, str(number))
                if self.text[start] == "{":
                    yield start, inner
                yield from self._value(inner)
            self._skip()
            if self.text[self.at] == ",":
                self.at += 1
            elif self.text[self.at] != end:
                raise _UnclearError

    def _skip(self) -> None:
        match = _BLANK.match(self.text, self.at)
        self.at = match.end() if match else self.at
