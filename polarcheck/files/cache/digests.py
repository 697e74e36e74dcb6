"""Digests of the settings with which a program is judged."""

from __future__ import annotations

import enum
import re
import struct
from collections.abc import Iterator, Mapping, Sequence, Set
from pathlib import Path
from types import FunctionType
from typing import Any

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.foundation.digest import blake2b
from polarcheck.rules.rule import Rule

#: Bytes of a digest.
SIZE = 16
#: Fields of Settings that say where values come from; the values themselves stand in the other fields.
_PLACES = ("read", "job_file", "baseline_named_by")


class NoDigestError(Exception):
    """Raised for a value of a type without a digest; what depends on it is not cached."""


def of_settings(settings: Settings) -> bytes:
    """
    Return the digest of all values with which a program is judged.

    The chain of machine files, job files, tables of tools and the options count by the values that they give. Raises
    NoDigestError.
    """
    digest = blake2b(digest_size=SIZE)
    for name in settings.__struct_fields__:
        if name not in _PLACES:
            digest.update(name.encode())
            for piece in _pieces(getattr(settings, name)):
                digest.update(piece)
    return digest.digest()


def _pieces(value: Any) -> Iterator[bytes]:
    """Yield bytes that differ for values that differ, in type or in content."""
    kind = type(value)
    yield kind.__qualname__.encode() + b":"
    if value is None or isinstance(value, (bool, int, str, Path, bytes, enum.Enum)):
        text = value if isinstance(value, bytes) else repr(value).encode("utf-8", "surrogatepass")
        yield struct.pack("<q", len(text)) + text
    elif isinstance(value, float):
        yield struct.pack("<d", value)
    elif isinstance(value, Rule):
        yield from _pieces(value.name)
    elif isinstance(value, msgspec.Struct):
        for name in value.__struct_fields__:
            yield name.encode() + b"="
            yield from _pieces(getattr(value, name))
    elif isinstance(value, Mapping):
        yield struct.pack("<q", len(value))
        for key, content in value.items():
            yield from _pieces(key)
            yield from _pieces(content)
    elif isinstance(value, Set):
        yield from _sequence(sorted(b"".join(_pieces(element)) for element in value))
    elif isinstance(value, Sequence):
        yield from _sequence(value)
    elif isinstance(value, re.Pattern):
        yield from _pieces((value.pattern, value.flags))
    elif isinstance(value, FunctionType) and "<" not in value.__qualname__:
        yield from _pieces((value.__module__, value.__qualname__))
    elif hasattr(value, "dtype") and not value.dtype.hasobject:  # an array of NumPy, which need not be loaded
        yield from _pieces((value.dtype.str, *value.shape, value.tobytes()))
    else:
        raise NoDigestError(kind.__qualname__)


def _sequence(value: Sequence[Any]) -> Iterator[bytes]:
    yield struct.pack("<q", len(value))
    for element in value:
        yield from _pieces(element)
