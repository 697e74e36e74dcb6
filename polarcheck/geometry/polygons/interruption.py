"""
Ends a step of GEOS when the time is over or the process is interrupted.

GEOS runs without Python: no exception reaches it, and handlers of signals wait until it returns. But all of its long
steps look now and then whether they should stop, for which its C interface has GEOS_interruptRequest. Shapely does not
offer that function; it is called in the library that shapely has loaded, by a thread that waits beside the step.
GEOS may take an interrupt for a failure and try again in another way, so the request is repeated.
"""

from __future__ import annotations

import contextlib
import os
import signal
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import shapely  # type: ignore[import-untyped]

from polarcheck.foundation import time_limit

#: How often the thread looks [s].
_PERIOD = 0.05
#: The signals that end a run; their handlers raise.
_ENDING = {signal.SIGINT, signal.SIGTERM}


@contextlib.contextmanager
def interruptible() -> Iterator[None]:
    """
    A step of GEOS inside ends by a GEOSException soon after the time is over, nobody waits any more, or a signal came.

    Without a time limit nothing is watched.
    """
    limit = time_limit.current_limit()
    if limit is None:
        yield
        return
    watch = limit.helper(_Watch)
    watch.begin()
    try:
        yield
    finally:
        watch.end()


def is_interrupt(error: Exception) -> bool:
    """
    Return True if GEOS was told to stop, rather than failed.

    It has one flag for all threads: whose step looks at it first ends, and that need not be the one that is late.
    """
    return "Interrupted" in str(error)


class _Watch:
    """A thread that lasts as long as a time limit, and interrupts the step that is under way."""

    def __init__(self, limit: time_limit.Limit) -> None:
        self._limit = limit
        self._lock = threading.Lock()
        self._under_way = False
        self._was_requested = False
        self._closed = threading.Event()
        self._signals = _Signals()
        self._thread = threading.Thread(target=self._run, name="interruption", daemon=True)
        self._thread.start()

    def begin(self) -> None:
        """A step begins; what has come before it has been handled."""
        self._signals.forget()
        self._limit.clock()  # where only this thread can read it, the watch counts from here
        self._under_way = True

    def end(self) -> None:
        """The step has ended; a request that came too late must not hit the next one."""
        with self._lock:
            self._under_way = False
            if self._was_requested:
                self._was_requested = False
                _geos().GEOS_interruptCancel()

    def close(self) -> None:
        """The time limit has ended."""
        self._closed.set()
        self._thread.join()
        self._signals.close()

    def _run(self) -> None:
        while not self._closed.wait(_PERIOD):
            if self._under_way and (self._limit.is_over() or self._signals.has_come()):
                geos = _geos()
                if geos is None:
                    return
                with self._lock:
                    if self._under_way:
                        self._was_requested = True
                        geos.GEOS_interruptRequest()


class _Signals:
    """
    The signals that come while Python cannot handle them: Python writes their numbers into a pipe at once.

    Only the main thread is told of signals; on Windows there are no such pipes. Then none ever comes here.
    """

    def __init__(self) -> None:
        self._pipe: tuple[int, int] | None = None
        self._came = False
        if sys.platform == "win32" or threading.current_thread() is not threading.main_thread():
            return
        reading, writing = os.pipe()
        for end in (reading, writing):
            os.set_blocking(end, False)
        self._before = signal.set_wakeup_fd(writing, warn_on_full_buffer=False)
        self._pipe = reading, writing

    def forget(self) -> None:
        """What has come until now does not count any more."""
        self.has_come()
        self._came = False

    def has_come(self) -> bool:
        """A signal has come that ends the run."""
        if self._pipe is not None:
            with contextlib.suppress(BlockingIOError):
                self._came |= bool(_ENDING & set(os.read(self._pipe[0], 1024)))
        return self._came

    def close(self) -> None:
        """Give the place back to whoever had it."""
        if self._pipe is not None:
            signal.set_wakeup_fd(self._before)
            for end in self._pipe:
                os.close(end)
            self._pipe = None


_GEOS: list[Any] = []


def _geos() -> Any:
    """The library of GEOS that shapely uses, None where it cannot be reached."""
    if not _GEOS:
        import ctypes  # only what takes too long needs it

        module = Path(shapely.lib.__file__)
        # The libraries that a module needs are searched with it, but on Windows.
        places = [module, *module.parent.parent.glob("[Ss]hapely.libs/geos_c*")]
        geos = None
        for path in places:
            with contextlib.suppress(OSError):
                library = ctypes.CDLL(str(path))
                if hasattr(library, "GEOS_interruptRequest"):
                    geos = library
                    break
        _GEOS.append(geos)
    return _GEOS[0]
