"""Clocks that count work, so that no test rests on how fast the machine is, or on what else it does."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from polarcheck.foundation import time_limit


class Clock:
    """
    Stands in for the module `time` where limits are kept: a look at the wall counts as a piece of work.

    work: returns the processor time after so many looks [s]. wall: returns what has passed on the wall [s]; the same if
    the machine has nothing else to do.
    """

    def __init__(self, work: Callable[[int], float], wall: Callable[[int], float] | None = None) -> None:
        self.looks = self.looks_at_thread = 0
        self._work, self._wall = work, wall or work

    def monotonic(self) -> float:
        self.looks += 1
        return self._wall(self.looks)

    def thread_time(self) -> float:
        self.looks_at_thread += 1
        return self._work(self.looks)

    def process_time(self) -> float:
        return self._work(self.looks)

    def pthread_getcpuclockid(self, thread: int) -> int:
        return 0

    def clock_gettime(self, clock: int) -> float:
        return self.thread_time()

    def use(self, monkeypatch: pytest.MonkeyPatch) -> None:
        """Limits are kept by this clock from here on."""
        monkeypatch.setattr(time_limit, "time", self)


def jump(last: float) -> Callable[[int], float]:
    """The work of a clock that stands still until its last look, and then is behind the end of all limits."""
    return lambda looks: 0.0 if looks <= last else 1e9


def even(looks: float) -> float:
    """The work of a clock that goes on by 1/1024 s at each look."""
    return looks / 1024
