"""How long the check of one file may take. Code that could go on without end calls keep_time, which raises."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Protocol, TypeVar

from polarcheck.errors import StoppedError, TooHardError

#: A file of this size has the seconds asked for, a larger one as many times that [bytes].
_BYTES_OF_A_TURN = 1_000_000


def seconds_for(size: int, asked: float) -> float:
    """How long a file of this size [bytes] may take, where one of usual size may take the seconds asked for [s]."""
    return asked * max(1.0, size / _BYTES_OF_A_TURN)


class Closeable(Protocol):
    """What lasts as long as a time limit."""

    def close(self) -> None:
        """The time limit has ended."""


Helper = TypeVar("Helper", bound=Closeable)


class Limit:
    """
    The time for one file.

    end: when it is over, on the clock of time.monotonic [s].
    seconds: how long it was at the start [s].
    """

    def __init__(self, seconds: float, is_stopped: Callable[[], bool] | None) -> None:
        self.end = time.monotonic() + seconds
        self.seconds = seconds
        self._is_stopped = is_stopped
        self._helpers: dict[Any, Closeable] = {}

    def is_stopped(self) -> bool:
        """Nobody waits for the outcome any more."""
        return self._is_stopped is not None and self._is_stopped()

    def is_over(self) -> bool:
        """No more work should be done."""
        return time.monotonic() > self.end or self.is_stopped()

    def helper(self, make: Callable[[Limit], Helper]) -> Helper:
        """Return the helper of this kind, made at the first call; it is closed when the limit ends."""
        if make not in self._helpers:
            self._helpers[make] = make(self)
        return self._helpers[make]  # type: ignore[return-value]  # made by the line above

    def close(self) -> None:
        """Close all helpers."""
        while self._helpers:
            self._helpers.popitem()[1].close()


_LIMIT: ContextVar[Limit | None] = ContextVar("limit", default=None)


@contextmanager
def time_limit(seconds: float, is_stopped: Callable[[], bool] | None = None) -> Iterator[None]:
    """
    Limit the time of the code inside [s]; without it, as in most tests, there is no limit.

    is_stopped: also ends the work, by a StoppedError, once it returns True. A limit around this one stays in force.
    """
    limit = Limit(seconds, is_stopped)
    around = _LIMIT.get()
    if around is not None:
        limit.end = min(limit.end, around.end)
    token = _LIMIT.set(limit)
    try:
        yield
    finally:
        _LIMIT.reset(token)
        limit.close()


def current_limit() -> Limit | None:
    """The limit that is in force."""
    return _LIMIT.get()


def keep_time() -> None:
    """
    Call in every loop iteration, and before any step that is worse than linear.

    Raises TooHardError once the time is over, StoppedError where nobody waits for the outcome.
    """
    keep_going()
    limit = _LIMIT.get()
    if limit is not None and time.monotonic() > limit.end:
        raise TooHardError(f"the check of this file takes longer than {limit.seconds:g} s: --max-seconds gives it more")


def keep_going() -> None:
    """
    Only look for cancellation: for loops with a bound of their own.

    Raises StoppedError where nobody waits for the outcome any more.
    """
    limit = _LIMIT.get()
    if limit is not None and limit.is_stopped():
        raise StoppedError("stopped")
