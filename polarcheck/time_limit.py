"""How long the check of one file may take: what could go on without end asks here, and gives up by an exception."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import NamedTuple

from polarcheck.errors import StoppedError, TooHardError

#: A file of this size has the seconds asked for, a larger one as many times that [bytes].
_BYTES_OF_A_TURN = 1_000_000


def seconds_for(size: int, asked: float) -> float:
    """How long a file of this size [bytes] may take, where one of usual size may take the seconds asked for [s]."""
    return asked * max(1.0, size / _BYTES_OF_A_TURN)


class _Limit(NamedTuple):
    """When the time is over, on the clock of time.monotonic [s], how long it was [s], and who ends it before that."""

    end: float
    seconds: float
    is_stopped: Callable[[], bool] | None


_LIMIT: ContextVar[_Limit | None] = ContextVar("limit", default=None)


@contextmanager
def time_limit(seconds: float, is_stopped: Callable[[], bool] | None = None) -> Iterator[None]:
    """
    What is done inside has so long [s]; without it, as in most tests, there is no limit.

    is_stopped: asked likewise; once it says so, nobody waits for the outcome any more.
    """
    token = _LIMIT.set(_Limit(time.monotonic() + seconds, seconds, is_stopped))
    try:
        yield
    finally:
        _LIMIT.reset(token)


def keep_time() -> None:
    """
    To be asked in each turn of a loop, and before each step whose cost grows faster than the program.

    Raises TooHardError once the time is over, StoppedError where nobody waits for the outcome.
    """
    keep_going()
    limit = _LIMIT.get()
    if limit is not None and time.monotonic() > limit.end:
        raise TooHardError(f"the check of this file takes longer than {limit.seconds:g} s: --max-seconds gives it more")


def keep_going() -> None:
    """
    To be asked where another bound keeps the time.

    Raises StoppedError where nobody waits for the outcome any more.
    """
    limit = _LIMIT.get()
    if limit is not None and limit.is_stopped is not None and limit.is_stopped():
        raise StoppedError("stopped")
