"""Digests of what an outcome depends on: the code, the settings of a program, its content."""

from __future__ import annotations

import enum
import os
import re
import struct
import sys
from collections.abc import Iterator, Mapping, Sequence, Set
from functools import cache
from hashlib import blake2b
from importlib.util import find_spec
from pathlib import Path
from types import FunctionType
from typing import Any

import msgspec

from polarcheck.checking.settings import Settings
from polarcheck.foundation.version import __version__
from polarcheck.rules.rule import Rule

#: Bytes of a digest.
SIZE = 16
#: Fields of Settings that say where values come from; the values themselves stand in the other fields.
_PLACES = ("read", "job_file", "baseline_named_by")
#: Libraries that compute results.
_LIBRARIES = ("numpy", "shapely", "msgspec")
_FOLDER = Path(__file__).parents[2]


class NoDigestError(Exception):
    """Raised for a value of a type without a digest; what depends on it is not cached."""


@cache
def of_code() -> bytes:
    """Return the digest of the program that judges: version, size and time of each of its files, libraries, Python."""
    digest = blake2b(digest_size=SIZE // 2)
    for part in (__version__, sys.version, sys.platform, *sorted(_states(str(_FOLDER)))):
        digest.update(part.encode("utf-8", "surrogatepass") + b"\0")
    for name in _LIBRARIES:
        spec = find_spec(name)
        if spec is not None and spec.origin:
            status = Path(spec.origin).stat()
            digest.update(
                f"{name} {spec.origin} {status.st_size} {status.st_mtime_ns}\0".encode("utf-8", "surrogatepass")
            )
    return digest.digest()


def _states(folder: str) -> Iterator[str]:
    """Yield a text for each source file below a folder: its path, size and time."""
    with os.scandir(folder) as entries:
        for entry in entries:
            if entry.name.endswith((".py", ".toml", ".so", ".pyd")):
                status = entry.stat()
                yield f"{entry.path} {status.st_size} {status.st_mtime_ns}"
            elif "." not in entry.name and entry.name != "__pycache__" and entry.is_dir():
                yield from _states(entry.path)


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
