"""Ends the process on a signal while no command runs: during imports, and after the report is printed."""

from __future__ import annotations

import contextlib
import errno
import os
import signal
import sys
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NoReturn

#: Exit codes as shells count them: 128 plus the number of the signal.
INTERRUPTED, TERMINATED = 130, 143
#: Messages of dynamic linkers for an extension module that finds no memory.
_OF_LINKER = ("failed to map segment", "annot allocate memory", "cannot map")


def end_on_signals() -> None:
    """
    End the process at once, with one line, on Ctrl-C and on the signals with which a system ends it.

    A signal that the parent process has set to be ignored stays ignored.
    """
    handle(dict.fromkeys(("SIGINT", "SIGTERM", "SIGBREAK"), _end_on))


def handle(handlers: Mapping[str, Callable[[int, Any], None]]) -> None:
    """Set the handlers of signals, by name, that the system has and that the parent process does not ignore."""
    for name, handler in handlers.items():
        number = getattr(signal, name, None)
        if number is not None and signal.getsignal(number) not in (signal.SIG_IGN, None):
            signal.signal(number, handler)


def _end_on(number: int, frame: Any) -> NoReturn:
    if number == signal.SIGINT:
        end(INTERRUPTED, "interrupted")
    end(TERMINATED, "terminated")


class Terminated(KeyboardInterrupt):
    """SIGTERM as an exception, handled like Ctrl-C."""


def end_by(stop: KeyboardInterrupt) -> NoReturn:
    """End with the exit code of an unhandled interrupt."""
    _end_on(signal.SIGTERM if isinstance(stop, Terminated) else signal.SIGINT, None)


def end(status: int, message: str) -> NoReturn:
    """End without an import or allocation that could fail. No buffer is flushed: write all output before."""
    with contextlib.suppress(OSError):
        os.write(2, f"polarcheck: {message}\n".encode())
    os._exit(status)


def leave(statuses: Sequence[int]) -> None:
    """
    End with the first status without freeing each object, which takes 2 % of a small check; call it last of all.

    Returns where there is no status, or where a standard stream cannot be written: Python then says so.
    """
    with contextlib.suppress(OSError, ValueError, AttributeError):  # full, closed, or there is none
        if statuses:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(statuses[0])


def is_of_memory(error: BaseException) -> bool:
    """Return True if an exception means lack of memory; extension modules report it in several ways."""
    if isinstance(error, ImportError):
        return any(words in str(error) for words in _OF_LINKER)
    return isinstance(error, MemoryError) or (isinstance(error, OSError) and error.errno == errno.ENOMEM)
