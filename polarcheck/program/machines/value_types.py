"""
Converts values of TOML files and options to their types. A message about a value that does not fit uses plain words and
the key as the user writes it: Python types and paths with `[...]` mean nothing to a setter.
"""

from __future__ import annotations

import math
import types
from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

import msgspec

from polarcheck.foundation.decoding import converted
from polarcheck.foundation.errors import UsageError, enumerated, suggestion
from polarcheck.program.machines.toml_text import number_hint

#: Key of `extra` in msgspec.Meta: the expected value in words, where the type and its bounds do not say it well.
EXPECTED = "expected"
#: Every number of a lathe lies between these, and results computed from them stay finite.
SMALLEST, LARGEST = 1e-50, 1e50
#: Limit of counts: columns have 32 bits.
MOST = 10**9
_BEYOND = (LARGEST, MOST)
#: How much of a value a message shows [characters].
_LONGEST = 40

Kind = TypeVar("Kind")


class MisfitError(Exception):
    """
    A value that does not fit its key; the text is one line that begins with the key.

    key: with points between (`tools.8.radius`); empty for the whole file.
    """

    def __init__(self, key: str, text: str) -> None:
        super().__init__(text)
        self.key = key


class KeyedError(UsageError, ValueError):
    """
    Values that each fit their key, but not each other; a UsageError for who makes them in Python.

    key: the one at fault; empty for the whole table.
    """

    def __init__(self, key: str, text: str) -> None:
        super().__init__(text)
        self.key = key


def are_numbers(*values: Any) -> bool:
    """Return True for numbers that floats can be: a value made in Python may be anything."""
    return all(isinstance(value, float) or (isinstance(value, int) and abs(value) <= LARGEST) for value in values)


class _Part(msgspec.Struct, frozen=True):
    """
    A value within a table.

    key: with points between.
    value: the value.
    kind: the type that it should fit.
    """

    key: str
    value: Any
    kind: Any


def fitted(table: Any, kind: type[Kind], key: str = "") -> Kind:
    """
    Convert a table to a type; no number is infinite or NaN. key: the key of the table.

    Raises MisfitError for the first value that does not fit.
    """
    try:
        value = converted(table, kind)
    except msgspec.ValidationError as error:
        misfit = next(_misfits(_Part(key, table, kind)), None)
        raise misfit or MisfitError(key, _plain(error)) from None
    if not _is_finite(table):
        raise next(_misfits(_Part(key, table, kind)))
    return value


def _is_finite(value: Any) -> bool:
    if isinstance(value, Mapping):
        return all(map(_is_finite, value.values()))
    if isinstance(value, list | tuple):
        return all(map(_is_finite, value))
    return not isinstance(value, float) or math.isfinite(value)


def _misfits(part: _Part) -> Iterator[MisfitError]:
    """The values that do not fit, the innermost first: a table fits only if its values do."""
    kind = _member(_bare(part.kind), part.value)
    if isinstance(part.value, Mapping):
        if isinstance(kind, type) and issubclass(kind, msgspec.Struct):
            yield from _of_struct(part, kind)
        elif get_origin(kind) is dict:
            yield from _of_dict(part, kind)
    elif isinstance(part.value, list) and get_origin(kind) is list:
        for number, value in enumerate(part.value, 1):
            key = f"{part.key}.{number}" if isinstance(value, Mapping) else part.key
            yield from _misfits(_Part(key, value, get_args(kind)[0]))
    try:
        converted(part.value, part.kind)
    except msgspec.ValidationError as error:
        yield _misfit(part, error)
    else:
        if isinstance(part.value, float) and not math.isfinite(part.value):
            yield _misfit(part)


def _of_struct(part: _Part, kind: type[msgspec.Struct]) -> Iterator[MisfitError]:
    fields = {field.name: field for field in msgspec.structs.fields(kind)}
    for name, value in part.value.items():
        key = _below(part.key, name)
        if name not in fields:
            yield MisfitError(key, f"unknown key {key}{suggestion(str(name), fields)}")
        else:
            yield from _misfits(_Part(key, value, fields[name].type))
    for name, field in fields.items():
        if field.required and name not in part.value:
            yield MisfitError(_below(part.key, name), f"{_below(part.key, name)} is missing")


def _of_dict(part: _Part, kind: Any) -> Iterator[MisfitError]:
    of_keys, of_values = get_args(kind)
    for name, value in part.value.items():
        key = _below(part.key, name)
        try:
            converted(name, of_keys, strict=False)
        except msgspec.ValidationError:
            yield MisfitError(key, f"{key}: expected {_expected(of_keys)}, found {name}")
        yield from _misfits(_Part(key, value, of_values))


def _misfit(part: _Part, error: Exception | None = None) -> MisfitError:
    if isinstance(part.value, Mapping) and error is not None and isinstance(error.__cause__, ValueError):
        text = _plain(error).removeprefix(f"{part.key}: ")  # the message of the type
        if isinstance(error.__cause__, KeyedError) and error.__cause__.key:
            part = msgspec.structs.replace(part, key=_below(part.key, error.__cause__.key))
    else:
        text = f"expected {_expected(part.kind)}{_beyond(part)}, found {display(part.value)}{_advice(part)}"
    return MisfitError(part.key, f"{part.key}: {text}" if part.key else text)


def _plain(error: Exception) -> str:
    text = str(error).partition(" - at `$")[0]
    return f"{text[:1].lower()}{text[1:]}"


def _below(key: str, name: object) -> str:
    return f"{key}.{name}" if key else str(name)


def _bare(kind: Any) -> Any:
    """A type without its bounds, and without the None of an optional value."""
    while get_origin(kind) is Annotated:
        kind = get_args(kind)[0]
    if get_origin(kind) in (Union, types.UnionType):
        members = [member for member in get_args(kind) if member is not type(None)]
        return _bare(members[0]) if len(members) == 1 else kind
    return kind


def _member(kind: Any, value: Any) -> Any:
    """Return the member of a union that a table or list is meant as; any other type as it is."""
    if get_origin(kind) not in (Union, types.UnionType):
        return kind
    for member in map(_bare, get_args(kind)):
        is_table = get_origin(member) is dict or (isinstance(member, type) and issubclass(member, msgspec.Struct))
        if is_table if isinstance(value, Mapping) else isinstance(value, list) and get_origin(member) is list:
            return member
    return kind


_PLAIN = {bool: "true or false", float: "a number", int: "a whole number", str: "a text"}
_PLURAL = {float: "numbers", int: "whole numbers", str: "texts"}


def _expected(kind: Any) -> str:
    """The expected value of a type, in words."""
    arguments = get_args(kind)
    if get_origin(kind) in (Union, types.UnionType):
        return " or ".join(_expected(member) for member in arguments if member is not type(None))
    if get_origin(kind) is Annotated:
        metas = [meta for meta in arguments[1:] if isinstance(meta, msgspec.Meta)]
        texts = [meta.extra[EXPECTED] for meta in metas if meta.extra and EXPECTED in meta.extra]
        return str(texts[0]) if texts else _expected(arguments[0]) + "".join(map(_bounds, metas))
    if get_origin(kind) is Literal:
        return enumerated(map(str, arguments), "or")
    if get_origin(kind) in (list, tuple):
        of_what = _PLURAL.get(_bare(arguments[0]), "values")
        return (
            f"a list of {of_what}, of length {len(arguments)}" if get_origin(kind) is tuple else f"a list of {of_what}"
        )
    return _PLAIN.get(kind, "a table")


def _bounds(meta: msgspec.Meta) -> str:
    """The expected range, in words; limits that are out of reach are left out."""
    if meta.min_length:
        return ", at least one"
    most = meta.le if meta.le not in _BEYOND else None
    least = meta.ge if meta.ge != -LARGEST else None
    if least is not None and most is not None:
        return f" from {least:g} to {most:g}"
    text = f" of {least:g} or more" if least is not None else f" above {_named(meta.gt)}" if meta.gt is not None else ""
    return f"{text}, {most:g} at most" if most is not None else text


def _beyond(part: _Part) -> str:
    """The limit that is out of reach, for a value beyond it."""
    limits = [meta.le for meta in get_args(part.kind)[1:] if isinstance(meta, msgspec.Meta) and meta.le in _BEYOND]
    is_number = isinstance(part.value, int | float) and math.isfinite(part.value)
    return f", up to {limits[0]:g}" if limits and is_number and abs(part.value) > limits[0] else ""


def _named(limit: float) -> str:
    """The limit as text; SMALLEST is 0."""
    return f"{limit:g}" if limit != SMALLEST else "0"


def display(value: Any) -> str:
    """A value as TOML writes it, shortened."""
    if isinstance(value, Mapping):
        return "a table"
    if isinstance(value, bool):
        return str(value).lower()
    text = f"{value:.12g}" if isinstance(value, float) else repr(value) if isinstance(value, str | list) else str(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}..."


def _advice(part: _Part) -> str:
    """How to write a number that was given as a text, and one value or table where a list is expected."""
    kind, value = _bare(part.kind), part.value
    if get_origin(kind) is list and isinstance(value, Mapping):
        return f"; write [[{part.key}]]"
    if get_origin(kind) is list and isinstance(value, str) and len(value) <= _LONGEST:
        return f'; write ["{value}"]' if "\\" not in value else f"; write ['{value}']"
    return number_hint(value) if kind is float and isinstance(value, str) else ""
