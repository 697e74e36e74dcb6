"""
Limits the time that the check of one file may take. Long loops call keep_time, which raises once it is over.

The processor time of the thread counts, so that a file has the same outcome beside other work. Only a check that waits
for a processor, or for a file, _PATIENCE times as long is given up by the clock on the wall.
"""

from __future__ import annotations

import functools
import math
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Protocol, TypeVar

from polarcheck.foundation.errors import StoppedError, TooHardError

#: Up to this size a file has the configured time; a larger file has proportionally more [bytes].
_USUAL_SIZE = 1_000_000
#: How many times the limit of processor time may pass on the wall.
_PATIENCE = 10


def seconds_for(size: int, max_seconds: float) -> float:
    """Return the time limit [s] for a file of this size [bytes], where max_seconds [s] is that of a usual file."""
    return max_seconds * max(1.0, size / _USUAL_SIZE)


def _thread_clock() -> Callable[[], float]:
    """
    Return a clock of the processor time of this thread [s], which other threads may read.

    On Windows and macOS no thread sees the clock of another: they read what the process has used since this thread read
    it last, so that the work of further threads counts there.
    """
    thread = threading.get_ident()
    if sys.platform != "win32" and hasattr(time, "pthread_getcpuclockid"):
        return functools.partial(time.clock_gettime, time.pthread_getcpuclockid(thread))
    of_thread, of_process = time.thread_time(), time.process_time()

    def clock() -> float:
        nonlocal of_thread, of_process
        if threading.get_ident() == thread:
            of_thread, of_process = time.thread_time(), time.process_time()
            return of_thread
        return of_thread + time.process_time() - of_process

    return clock


class Closeable(Protocol):
    """A resource that lives as long as a time limit."""

    def close(self) -> None:
        """Free it: the time limit has ended."""


Helper = TypeVar("Helper", bound=Closeable)


class Limit:
    """
    The time for one file: that of the thread that makes it.

    seconds: the length of the limit [s].
    clock: returns the processor time of that thread [s].
    """

    def __init__(
        self, seconds: float, is_stopped: Callable[[], bool] | None = None, around: Limit | None = None
    ) -> None:
        self.seconds = seconds
        self.clock = _thread_clock()
        self._is_stopped = is_stopped
        self._around = around
        self._helpers: dict[Any, Closeable] = {}
        self._end = self.clock() + seconds
        self._end_of_waiting = time.monotonic() + _PATIENCE * seconds
        self._next_look = -math.inf
        self._is_late = False

    def is_stopped(self) -> bool:
        """Return True once the check is cancelled."""
        return self._is_stopped is not None and self._is_stopped()

    def is_late(self) -> bool:
        """
        Return True once the time is over; the thread that works and one that watches it may ask.

        A thread cannot work for longer than passes on the wall. So its own clock, which costs more, is only looked at
        once it can have reached the end.
        """
        if not self._is_late and (now := time.monotonic()) > self._next_look:
            remaining = self._left(now)
            self._next_look = now + remaining
            self._is_late = remaining < 0
        return self._is_late

    def _left(self, now: float) -> float:
        """Return the least time that is left [s], negative once it is over; now: time.monotonic [s]."""
        remaining = min(self._end - self.clock(), self._end_of_waiting - now)
        return remaining if self._around is None else min(remaining, self._around._left(now))

    def is_over(self) -> bool:
        """Return True once no more work should be done: the time is over, or the check is cancelled."""
        return self.is_late() or self.is_stopped()

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
    Limit the processor time of the code inside [s]; without it, as in most tests, there is no limit.

    is_stopped: cancels the work, by a StoppedError, once it returns True. An outer limit stays in force.
    """
    limit = Limit(seconds, is_stopped, _LIMIT.get())
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
    if limit is not None and limit.is_late():
        raise TooHardError(
            f"the check of this file takes longer than {limit.seconds:g} s of processor time, or "
            f"{_PATIENCE * limit.seconds:g} s in all: --max-seconds gives it more"
        )


def keep_going() -> None:
    """
    Check for cancellation only: for loops with a limit of their own.

    Raises StoppedError once the check is cancelled.
    """
    limit = _LIMIT.get()
    if limit is not None and limit.is_stopped():
        raise StoppedError("stopped")
