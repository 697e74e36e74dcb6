"""
The decoders and conversions of msgspec, of which nothing else in the package makes any.

msgspec learns the fields of a class when it first decodes into it, and stores them with the class bit by bit. A second
thread that decodes into the class meanwhile finds half of them, and the process dies (findings/README.md). Here each
type is learnt once, behind a lock, before anything is decoded into it. Encoders need no types: they are used directly.
"""

from __future__ import annotations

import functools
import threading
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
