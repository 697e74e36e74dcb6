"""Limits the time that the check of one file may take. Long loops call keep_time, which raises once it is over."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Protocol, TypeVar

from polarcheck.errors import StoppedError, TooHardError

#: Up to this size a file has the configured time; a larger file has proportionally more [bytes].
_USUAL_SIZE = 1_000_000


def seconds_for(size: int, max_seconds: float) -> float:
    """Return the time limit [s] for a file of this size [bytes], where max_seconds [s] is that of a usual file."""
    return max_seconds * max(1.0, size / _USUAL_SIZE)


class Closeable(Protocol):
    """A resource that lives as long as a time limit."""

    def close(self) -> None:
        """Free it: the time limit has ended."""


Helper = TypeVar("Helper", bound=Closeable)


class Limit:
    """
    The time for one file.

    end: when the time is over, on the clock of time.monotonic [s].
    seconds: the length of the limit [s].
    """

    def __init__(self, seconds: float, is_stopped: Callable[[], bool] | None) -> None:
        self.end = time.monotonic() + seconds
        self.seconds = seconds
        self._is_stopped = is_stopped
        self._helpers: dict[Any, Closeable] = {}

    def is_stopped(self) -> bool:
        """Return True once the check is cancelled."""
        return self._is_stopped is not None and self._is_stopped()

    def is_over(self) -> bool:
        """Return True once no more work should be done: the time is over, or the check is cancelled."""
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
def time_limit(seconds: float, is_stopped: Callable[[], bool] | None = None) -> Iterator[Limit]:
    """
    Limit the time of the code inside [s]; without it, as in most tests, there is no limit.

    is_stopped: cancels the work, by a StoppedError, once it returns True. An outer limit stays in force.
    """
    limit = Limit(seconds, is_stopped)
    around = _LIMIT.get()
    if around is not None:
        limit.end = min(limit.end, around.end)
    token = _LIMIT.set(limit)
    try:
        yield limit
    finally:
        _LIMIT.reset(token)
        limit.close()


def current_limit() -> Limit | None:
    """Return the limit in force, or None."""
    return _LIMIT.get()


def keep_time() -> None:
    """
    Call in every loop iteration, and before any step that is worse than linear.

    Raises TooHardError once the time is over, StoppedError once the check is cancelled.
    """
    keep_going()
    limit = _LIMIT.get()
    if limit is not None and time.monotonic() > limit.end:
        raise TooHardError(f"the check of this file takes longer than {limit.seconds:g} s: --max-seconds gives it more")


def keep_going() -> None:
    """
    Check for cancellation only: for loops with a limit of their own.

    Raises StoppedError once the check is cancelled.
    """
    limit = _LIMIT.get()
    if limit is not None and limit.is_stopped():
        raise StoppedError("stopped")
