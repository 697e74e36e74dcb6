"""
What callers of the functions for Python give, as plain values, and how messages show it.

Every function here raises a UsageError for a value that does not fit, in one line that begins with `place`.
"""

from __future__ import annotations

import itertools
import math
import numbers
import os
import reprlib
from collections.abc import Collection, Iterable, Mapping
from typing import Any

import msgspec

from polarcheck.foundation.errors import UsageError

#: Tables and lists within each other, digits of a whole number: the limits of TOML files (toml_text.py).
_DEEPEST, _BEYOND = 12, 10**18
#: Values of a list or table.
_MOST = 1_000_000
#: Characters of a value in a message.
_LONGEST = 60


def plain(argument: str, value: Any, level: int = 0, *, files: Collection[str] = ()) -> Any:
    """
    Return a value as a TOML file would give it: tables, lists, numbers and texts. A key that is None is left out.

    argument: the function, the keyword and the key, for messages.
    files: keys whose texts name files, and may contain bytes that are no characters; "" for the value itself.
    """
    if level > _DEEPEST:
        raise UsageError(f"{argument}: expected {_DEEPEST} tables and lists within each other at most")
    if isinstance(value, msgspec.Struct):
        fields = {field.name: (getattr(value, field.name), field.default) for field in msgspec.structs.fields(value)}
        value = {name: inner for name, (inner, default) in fields.items() if not _is(inner, default)}
    if isinstance(value, Mapping):
        return _table(argument, value, level, files)
    if isinstance(value, os.PathLike):
        value = _path(argument, value)
    if isinstance(value, str):
        return _text(argument, value, names_file="" in files)
    if isinstance(value, bool):
        return value
    if isinstance(value, numbers.Number):
        return _number(argument, value)
    if isinstance(value, Iterable) and not isinstance(value, bytes | bytearray | memoryview):
        return [plain(argument, inner, level + 1, files=files) for inner in _elements(argument, value)]
    raise UsageError(f"{argument}: expected a text, a number, a list or a table, found {short(value)}")


def _is(value: Any, default: Any) -> bool:
    """Return True for the default of a field; NaN is unknown, and empty lists and tables are defaults."""
    if isinstance(value, float):
        return math.isnan(value) or value == default
    return value is None or value is default or (isinstance(value, list | dict) and not value)


def _table(argument: str, value: Mapping[Any, Any], level: int, files: Collection[str]) -> dict[str, Any]:
    table = {}
    for key, inner in value.items():
        if isinstance(key, numbers.Integral):
            name = str(_number(argument, key))
        elif isinstance(key, str) and key.isprintable():
            name = key
        else:
            raise UsageError(f"{argument}: expected texts or whole numbers as keys, found {short(key)}")
        if inner is not None:
            table[name] = plain(f"{argument}.{name}", inner, level + 1, files=[""] if name in files else files)
    return table


def _path(argument: str, value: os.PathLike[Any]) -> Any:
    try:
        return os.fspath(value)
    except TypeError:
        raise UsageError(f"{argument}: expected a path, found {short(value)}") from None


def _text(argument: str, value: str, *, names_file: bool) -> str:
    try:
        value.encode("utf-8", "surrogateescape" if names_file else "strict")
    except UnicodeEncodeError:
        raise UsageError(f"{argument}: expected a text of characters, found {short(value)}") from None
    return value


def _number(argument: str, value: Any) -> int | float:
    if isinstance(value, numbers.Integral):
        number = int(value)
        if abs(number) >= _BEYOND:
            raise UsageError(f"{argument}: expected a number of 18 digits at most, found {short(number)}")
        return number
    try:
        return float(value)  # a Decimal is no numbers.Real
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"{argument}: expected a number, found {short(value)}") from None


def _elements(argument: str, value: Iterable[Any]) -> Iterable[Any]:
    try:
        elements = [*itertools.islice(value, _MOST + 1)]
    except TypeError:  # an array without dimensions
        raise UsageError(f"{argument}: expected a list, found {short(value)}") from None
    if len(elements) > _MOST:
        raise UsageError(f"{argument}: expected {_MOST} values at most")
    return elements


def names(argument: str, value: Any) -> list[str]:
    """Return the names of a keyword that takes one or several, of files, too; none for None."""
    listed = [] if value is None else plain(argument, value, files=[""])
    listed = [listed] if isinstance(listed, str) else listed
    if not isinstance(listed, list) or not all(isinstance(element, str) for element in listed):
        raise UsageError(f"{argument}: expected names, found {short(value)}")
    return listed


def flag(argument: str, value: Any) -> bool:
    """Return True or False."""
    if not isinstance(value, bool):
        raise UsageError(f"{argument}: expected True or False, found {short(value)}")
    return value


def whole(argument: str, value: Any, least: int, default: int) -> int:
    """Return a whole number; the default for None."""
    number = default if value is None else value
    if isinstance(number, bool) or not isinstance(number, numbers.Integral) or number < least:
        raise UsageError(f"{argument}: expected a whole number from {least}, found {short(value)}")
    return int(_number(argument, number))


def length(argument: str, value: Any, most: float, expected: str) -> float:
    """Return a number above 0. expected: the same in words, with its unit."""
    number = value if isinstance(value, float) or value is None else plain(argument, value)
    if isinstance(number, bool) or not isinstance(number, int | float) or not 0 < number <= most:
        raise UsageError(f"{argument}: expected {expected}, found {short(value)}")
    return float(number)


def choice(argument: str, value: Any, choices: Collection[str], default: str) -> str:
    """Return one of some texts; the default for None."""
    if value is None:
        return default
    if not isinstance(value, str) or value not in choices:
        expected = " or ".join(choices) if len(choices) == 2 else f"one of {', '.join(choices)}"
        raise UsageError(f"{argument}: expected {expected}, found {short(value)}")
    return value


class _Short(reprlib.Repr):
    """Values of any depth and size, and of any class, in a few characters."""

    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxlong = self.maxother = self.maxlist = self.maxdict = self.maxtuple = _LONGEST

    def repr_int(self, value: int, level: int) -> str:
        """Return a whole number; Python refuses to write more than some thousand digits."""
        return super().repr_int(value, level) if abs(value) < 10**_LONGEST else f"a number of {_digits(value)} digits"


def _digits(value: int) -> int:
    return int(math.log10(abs(value))) + 1


_SHORT = _Short()


def short(value: Any) -> str:
    """Return a value as messages show it: in one line without control characters, shortened."""
    text = " ".join(_SHORT.repr(value).split())
    text = text if text.isprintable() else ascii(text)[1:-1]
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."
