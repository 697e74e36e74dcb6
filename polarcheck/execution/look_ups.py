"""
Notes which called programs were looked for in the folders of a job.

A result depends on those that are not there, too.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from hashlib import blake2b
from typing import NamedTuple

#: Bytes of a digest.
_SIZE = 16


class LookUp(NamedTuple):
    """
    A called program that was looked for.

    number, name: how the call names it; one of them is None.
    files: path and digest of the files that can hold it; none if there is none.
    """

    number: int | None
    name: str | None
    files: tuple[tuple[str, bytes], ...]


_NOTED: ContextVar[list[LookUp] | None] = ContextVar("look_ups", default=None)


@contextmanager
def noted() -> Iterator[list[LookUp]]:
    """Yield a list to which every look-up by the code inside is added."""
    look_ups: list[LookUp] = []
    token = _NOTED.set(look_ups)
    try:
        yield look_ups
    finally:
        _NOTED.reset(token)


def note(called: tuple[int | None, str | None], files: Sequence[tuple[str, bytes]]) -> None:
    """Note a look-up for the code that asked for it. files: path and content of the files that can hold the program."""
    look_ups = _NOTED.get()
    if look_ups is not None:
        look_ups.append(LookUp(*called, tuple((file, digest(data)) for file, data in files)))


def digest(data: bytes) -> bytes:
    """Return the digest of the content of a file."""
    return blake2b(data, digest_size=_SIZE).digest()
