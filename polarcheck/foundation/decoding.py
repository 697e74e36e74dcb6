"""
The decoders and conversions of msgspec, of which nothing else in the package makes any.

msgspec learns the fields of a class when it first decodes into it, and stores them with the class bit by bit. A second
thread that decodes into the class meanwhile finds half of them, and the process dies (findings/README.md). Here each
type is learnt once, behind a lock, before anything is decoded into it. Encoders need no types: they are used directly.

What takes longer to make than to decode is kept where Python keeps compiled modules.
"""

from __future__ import annotations

import contextlib
import functools
import os
import sys
import threading
from collections.abc import Callable
from importlib.util import cache_from_source
from pathlib import Path
from typing import Any, TypeVar

import msgspec

Kind = TypeVar("Kind")

_LEARNING = threading.RLock()


def converted(value: Any, kind: type[Kind], *, strict: bool = True) -> Kind:
    """
    Convert tables, lists, texts and numbers to a type. Texts that are keys may stand for numbers.

    strict: False if a text may stand for a number everywhere.

    Raises msgspec.ValidationError for what does not fit.
    """
    json_decoder(kind)  # what msgspec learns of a type serves all ways to decode
    return msgspec.convert(value, kind, strict=strict, str_keys=True)


def json_decoder(kind: type[Kind]) -> msgspec.json.Decoder[Kind]:
    """Return the decoder from JSON to a type."""
    with _LEARNING:
        decoder: msgspec.json.Decoder[Kind] = _json_decoder(kind)  # type: ignore[arg-type]  # a type is hashable
        return decoder


def msgpack_decoder(kind: type[Kind]) -> msgspec.msgpack.Decoder[Kind]:
    """Return the decoder from MessagePack to a type."""
    with _LEARNING:
        decoder: msgspec.msgpack.Decoder[Kind] = _msgpack_decoder(kind)  # type: ignore[arg-type]  # likewise
        return decoder


@functools.cache
def _json_decoder(kind: Any) -> Any:
    return msgspec.json.Decoder(kind)


@functools.cache
def _msgpack_decoder(kind: Any) -> Any:
    return msgspec.msgpack.Decoder(kind)


def kept(
    source: Path,
    digest: bytes,
    make: Callable[[], Kind],
    encode: Callable[[Kind], bytes],
    decode: Callable[[bytes], Kind],
) -> Kind:
    """Return what is kept beside a source file under a digest of all sources, or else make it and keep it."""
    file = Path(cache_from_source(source)).with_suffix(".kept")
    with contextlib.suppress(OSError, ValueError, EOFError, TypeError):  # none, or damaged
        data = file.read_bytes()
        if data.startswith(digest):
            return decode(data[len(digest) :])
    made = make()
    if not sys.dont_write_bytecode:
        with contextlib.suppress(OSError):
            file.parent.mkdir(exist_ok=True)
            new = file.with_suffix(f".{os.getpid()}")
            new.write_bytes(digest + encode(made))
            new.replace(file)
    return made
